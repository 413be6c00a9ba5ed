// Stock from text: the command's --stock option and the Python module's stock().
//
//   100x60x12                    a block of 100 mm in X, 60 in Y, 12 in Z; zero at the lower left of its top
//   100x60x12 at centre bottom   zero elsewhere: lower-left, lower-centre, lower-right, centre-left, centre,
//                                centre-right, top-left, top-centre, top-right; at the top or the bottom
//   0,0,-12 to 100,60,0          its lowest and its highest corner in work coordinates
//   min 0,0,-12 max 100,60,0     the same
//   block 4in 2in 19mm zero top  words between are allowed, and a unit after each length: mm or in
//   4 x 2 x 0.75 in              a single unit after the last length applies to all
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/stock/stock.h"
#include "kerf/stock/stock_body.h"

namespace kerf {

/// Reads such a text. Appends an error with the expected form, and returns nothing, for anything else, for
/// edges that are not above 0, and for numbers that are not finite. `where` is the origin of the error.
std::optional<Stock> read_stock_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

/// Reads a body of stock from a file's bytes: a mesh (.stl .3mf .glb .obj) or left-over stock (.kstock),
/// by the ending of the name. Appends an error and returns nothing for other or damaged files.
std::optional<Stock> read_stock_file(std::string_view bytes, const std::string& name,
                                     Diagnostics& diagnostics);
/// ".stl .3mf .glb .obj .kstock": whether a name has such an ending.
bool is_stock_file(std::string_view name);
bool is_left_file(std::string_view name);
/// The bytes of a .kstock file.
std::string write_left_file(const LeftColumns& left);

/// Reads "x", "x y=30 z=-6" or "about y x=50": half a turn about an axis parallel to X (through the
/// given y and z) or to Y (through x and z); by default through the centre of the block.
std::optional<StockMove> read_flip_option(std::string_view text, const Origin& where,
                                          Diagnostics& diagnostics);
/// Reads "d=40 length=100 x=0 y=0 z=0": a round bar from X0 to X100 that turns about an axis along X at Y0
/// Z0; x, y and z are optional, default 0.
std::optional<RoundBar> read_rotary_option(std::string_view text, const Origin& where,
                                           Diagnostics& diagnostics);
/// Reads "10,0,-3": a shift in mm.
std::optional<Point3> read_shift_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

}  // namespace kerf

// Stock told in words: the text of the command's --stock option and of the Python module's stock().
//
//   100x60x12                    a block of 100 mm in X, 60 in Y, 12 in Z; zero at the lower left of its top
//   100x60x12 at centre bottom   zero elsewhere: lower-left, lower-centre, lower-right, centre-left, centre,
//                                centre-right, top-left, top-centre, top-right; at the top or the bottom
//   0,0,-12 to 100,60,0          its lowest and its highest corner in work coordinates
//   min 0,0,-12 max 100,60,0     the same
//   block 4in 2in 19mm zero top  words between are fine, and a unit behind each length: mm or in
//   4 x 2 x 0.75 in              a unit behind the last length alone is that of all
#pragma once

#include <optional>
#include <string_view>

#include "kerf/diagnostics.h"
#include "kerf/stock.h"

namespace kerf {

/// Reads such a text. Appends an error that says what was expected, and returns nothing, for anything else,
/// for edges that are not above 0, and for numbers that are not finite. `where` is the error's place.
std::optional<Stock> read_stock_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

}  // namespace kerf

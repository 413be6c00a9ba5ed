// Files of a workshop: its tools, its stock, its machines and materials.
//
// Tools from files: Kerf's TOML tool files and the built-in table.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/path/machine.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/material.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// The built-in tools: data/tools.toml, compiled in. Vendor, generated and program numbers are
/// keys.
const ToolTable& built_in_tools();

/// Reads a TOML tool file (docs/manual/tools.md) into `table`. All errors are reported with their location;
/// tools without an error are kept. `file_name` is for the messages.
void read_tool_file(std::string_view text, std::string_view file_name, ToolTable& table,
                    Diagnostics& diagnostics);

/// Reads a tool from text: "square d=3.175 flute=12.7", "V d=12.7 angle=90", the name of a built-in tool,
/// or its number. `where` is the origin of the errors.
std::optional<Tool> read_tool_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

/// A key of tool files and options other than the dimensions of the shape (parameters_of).
struct ToolKey {
  std::string_view name, meaning;
};
const std::vector<ToolKey>& tool_keys();
/// The short names of a key for a shape: "d" and "dia" for the diameter; "r" for the radius of the shape.
std::vector<std::string_view> short_names_of(std::string_view key, const ToolShape& shape);

// Stock from text: the command's --stock option and the Python module's stock().
//
//   100x60x12                    a block of 100 mm in X, 60 in Y, 12 in Z; zero at the lower left of its top
//   100x60x12 at centre bottom   zero elsewhere: lower-left, lower-centre, lower-right, centre-left, centre,
//                                centre-right, top-left, top-centre, top-right; at the top or the bottom
//   0,0,-12 to 100,60,0          its lowest and its highest corner in work coordinates
//   min 0,0,-12 max 100,60,0     the same
//   block 4in 2in 19mm zero top  words between are allowed, and a unit after each length: mm or in
//   4 x 2 x 0.75 in              a single unit after the last length applies to all

/// Reads such a text. Appends an error with the expected form, and returns nothing, for anything else, for
/// edges that are not above 0, and for numbers that are not finite. `where` is the origin of the error.
std::optional<Stock> read_stock_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

/// Reads a body of stock from a file's bytes: a mesh (.stl .3mf .glb .obj) or left-over stock (.kstock),
/// by the ending of the name. Appends an error and returns nothing for other or damaged files. Nothing,
/// without an error, if stopped.
std::optional<Stock> read_stock_file(std::string_view bytes, const std::string& name,
                                     Diagnostics& diagnostics, Progress* progress = nullptr);
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

// Machines from files: TOML profiles and GRBL's `$$` output; the built-in ones of data/machines.

/// Reads a machine file; its kind is detected from the text ("$110=3000" on a line is GRBL's). Missing
/// settings are those of a default Machine. All errors are reported with their location (TOML profiles:
/// docs/manual/machine.md); nothing is returned then. `file_name` is for the messages.
std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);

/// The names of the built-in machines, "grbl_router".
std::vector<std::string> built_in_machine_names();

/// The machine of a file or, if there is none of that path, the built-in one of that name. Errors as by
/// read_machine_file(), and if there is neither.
std::optional<Machine> load_machine(const std::string& file_or_name, Diagnostics& diagnostics);

// Materials from files: data/materials.toml, compiled in.

/// The built-in materials (docs/manual/machine.md).
const std::vector<Material>& built_in_materials();
/// Reads a file of materials in the form of data/materials.toml. All errors are reported with their location.
std::vector<Material> read_material_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);
/// The built-in material of a name, compared by fold_name; an unknown name is an error with a hint.
std::optional<Material> material_named(std::string_view name, Diagnostics& diagnostics);

}  // namespace kerf

// Reading and writing tool libraries of other programs: LinuxCNC's tool.tbl, Carbide Create's CSV, Fusion's
// JSON (and its .tools, a zip of it), FreeCAD's .fctb and .fctl, CAMotics' project JSON, Vectric's .vtdb.
// Writing tools as Kerf's TOML.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/tool/tool.h"

namespace kerf {

enum class ToolLibraryKind : std::uint8_t {
  kerf,
  linuxcnc,
  carbide_create,
  fusion,
  freecad,
  camotics,
  freecad_library,
  vectric
};
std::string_view to_string(ToolLibraryKind kind);

/// The kind of a library, detected from its text; nothing if it is none.
std::optional<ToolLibraryKind> library_kind_of(std::string_view bytes);

struct ToolLibraryOptions {
  double unit_mm = 1.0;  // mm per unit of files without a unit (tool.tbl): 1 or 25.4
  int first_number = 1;  // for tools without a number; used numbers are skipped
  /// Returns the text of a tool bit that a FreeCAD library (.fctl) names. Without it they are skipped.
  std::function<std::optional<std::string>(const std::string& name)> read_bit = {};
};

/// Reads a library of any kind into `table`. Unsupported tools are skipped with a warning that gives the
/// reason; assumptions are reported in notes. Errors: a damaged file or an unknown format.
void read_tool_library(std::string_view bytes, std::string_view file_name, const ToolLibraryOptions& options,
                       ToolTable& table, Diagnostics& diagnostics);

/// Searches tool bits as FreeCAD does: next to the library and in the folder Bit beside it or beside its
/// folder.
std::function<std::optional<std::string>(const std::string&)> tool_bits_of(const std::string& library_path);

/// The tools as a Kerf tool file; reading it gives the same tools.
std::string write_tool_file(const ToolTable& table);
/// The tools as LinuxCNC's tool table, diameters in units of `unit_mm` mm. The comment of each line has all
/// sizes of the tool, so that reading the table gives the same tools. Notes name those for which a line is
/// too short.
std::string write_linuxcnc_table(const ToolTable& table, double unit_mm, Diagnostics& diagnostics);

/// A file of a library: the library itself, or a tool bit beside it.
struct LibraryFile {
  std::string name;
  std::string bytes;
};
struct LibraryForm {
  std::string_view name;   // "fusion"
  std::string_view title;  // "Fusion library"
  std::vector<std::string_view> endings;
  ToolLibraryKind kind;
};
/// The forms that write_tool_library writes, "kerf" first.
const std::vector<LibraryForm>& library_forms();
/// By its name, or by the ending of a file; nullptr if there is none.
const LibraryForm* library_form_named(std::string_view name);
const LibraryForm* library_form_of_ending(std::string_view file_name);

struct WrittenLibrary {
  std::vector<LibraryFile> files;
  std::vector<int> tools;  // their numbers
};

/// Writes the tools in a form, `name` being that of the library's file. Reading the files gives the same
/// tools; a warning names what the form cannot hold. Tools whose cutting part it cannot hold are left out.
/// Nothing, with an error, if none is left or the form cannot be written.
WrittenLibrary write_tool_library(const ToolTable& table, const LibraryForm& form, const std::string& name,
                                  double unit_mm, Diagnostics& diagnostics);

}  // namespace kerf

// Common to the library readers: a tool as described by another program, and its conversion.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/tool_libraries.h"

namespace kerf::detail {

/// Lengths in mm, angles in degrees; 0: unknown.
struct LibraryTool {
  std::optional<int> number;
  std::string shape;  // a name of shape_named
  double diameter = 0, flute = 0, corner_radius = 0, tip_diameter = 0, neck_diameter = 0, neck_length = 0,
         shank_diameter = 0, shank_length = 0, holder_diameter = 0, holder_length = 0;
  double cut_height = 0;
  double angle = 0;  // as in the shape of that name (kerf/tool/tool.h)
  int teeth = 0;
  std::string name, description;
  Origin where;
};

/// The shape and the diameter: written as the name of a tool that has none, and read as no description.
std::string short_name(const LibraryTool& tool);

/// Between the sizes of a tool and its description, in the comments of a tool.tbl that Kerf has written.
inline constexpr std::string_view kBeforeDescription = " / ";

class LibraryWriter {
 public:
  LibraryWriter(std::string_view file_name, const ToolLibraryOptions& options, ToolTable& table,
                Diagnostics& diagnostics);
  void add(const LibraryTool& tool);
  /// Adds a tool that is known with all of its sizes.
  void add(Tool tool, const LibraryTool& described);
  /// After the last tool: tools without a number of their own get the next ones that no other tool has.
  void finish();
  /// Warns that a tool is skipped, with the reason.
  void skip(const Origin& where, std::string_view name, std::string_view reason);
  Origin location(std::size_t line) const;
  const std::string& file() const { return file_; }
  const ToolLibraryOptions& options() const { return options_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  struct Waiting {
    Tool tool;
    std::optional<int> twice;  // its number, which a tool before it has
    Origin where;
  };
  void keep(int number, Tool tool);
  std::string file_;
  const ToolLibraryOptions& options_;
  ToolTable& table_;
  Diagnostics& diagnostics_;
  std::set<int> given_;
  std::vector<Waiting> waiting_;
  int next_ = 1;
};

/// The tool as the writers of libraries need it: shapes of other names that have the same profile as one of
/// LibraryTool are that one (a bowl is a bull nose, a chamfer or a flat groove a V).
LibraryTool described(int number, const Tool& tool);

/// What programs show in their lists, which is never empty: the description, else the short name. Where a
/// form has but one text, the name of the tool comes before the short one.
std::string description_of(const LibraryTool& tool);
std::string title_of(const LibraryTool& tool);

/// The tools of a library to be written, in the order of their numbers.
using LibraryTools = std::vector<LibraryTool>;
std::string carbide_csv(const LibraryTools& tools);
std::string fusion_library(const LibraryTools& tools);
std::string freecad_bit(const LibraryTool& tool);
/// `files[i]` is the bit of `tools[i]`.
std::string freecad_library(const LibraryTools& tools, const std::vector<std::string>& files);
std::string camotics_project(const LibraryTools& tools);
/// A database of Vectric's programs; nothing, with an error, if Kerf is built without SQLite.
std::optional<std::string> vectric_database(const LibraryTools& tools, Diagnostics& diagnostics);

void read_vectric_database(std::string_view bytes, LibraryWriter& out);
inline constexpr std::string_view kDatabaseMark{"SQLite format 3\0", 16};  // the first bytes

void read_linuxcnc_table(std::string_view text, LibraryWriter& out);
void read_carbide_csv(std::string_view text, LibraryWriter& out);
void read_json_library(std::string_view text, ToolLibraryKind kind, LibraryWriter& out);
/// The kind of a library in JSON; nothing if the text is not one.
std::optional<ToolLibraryKind> json_library_kind(std::string_view text);

}  // namespace kerf::detail

// Origins: the location in the user's text, drawing or script that caused something.
//
// Every step of a toolpath and every diagnostic has an origin. Steps store a 4-byte `OriginId`; the table
// of origins has 16 bytes per origin, 16 MB for a million G-code lines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

namespace kerf {

namespace stored {
struct Access;  // of files, which store every member (src/job/stored)
}

/// A location in a text file: line and column count from 1; column 0 means the whole line.
struct TextLocation {
  std::string file;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  bool operator==(const TextLocation&) const = default;
};

/// A location in a drawing: x and y in mm, in the drawing's world coordinates.
struct DrawingLocation {
  std::string file;
  std::string layer;
  std::string handle;
  double x = 0.0;
  double y = 0.0;
  std::string entity = {};  ///< "LINE"; empty: not specified
  bool operator==(const DrawingLocation&) const = default;
};

/// A call of Kerf's interface from a script; file and line of the script, empty and 0 if unknown.
struct CallLocation {
  std::string file;
  std::uint32_t line = 0;
  std::string call;
  bool operator==(const CallLocation&) const = default;
};

using Origin = std::variant<std::monostate, TextLocation, DrawingLocation, CallLocation>;

/// "part.nc:12:5", "plate.dxf: layer 8999, LINE 2F, at 10, 20" ("handle 2F" where the kind of entity is not
/// specified), "job.py:7 (cutline)"; empty for no origin.
std::string to_string(const Origin& origin);

/// Index into an OriginTable; 0 is "unknown".
enum class OriginId : std::uint32_t { none = 0 };

/// Compact table of origins. It only grows; ids stay valid. File names are stored once.
class OriginTable {
 public:
  OriginTable();

  /// Returns the index of a file name, for `text()`; the same name gives the same index.
  std::uint32_t file(std::string_view name);
  /// A location in a text; `file` comes from `file()`. Equal ones are not merged: call it once per line or
  /// word.
  OriginId text(std::uint32_t file, std::uint32_t line, std::uint32_t column);
  OriginId add(const Origin& origin);
  /// A further id of the location of `id`, for another caller; takes less memory than adding it again.
  OriginId add_again(OriginId id);
  /// Records that `caller` caused `inner` (an include, a call of a function or sub-path).
  void set_caller(OriginId inner, OriginId caller);

  Origin resolve(OriginId id) const;
  /// The callers of `id`, innermost first; usually empty.
  std::vector<Origin> callers(OriginId id) const;
  /// Line of a text or call origin; 0 for others.
  std::uint32_t line(OriginId id) const;

  /// The names of all files, by their index.
  const std::vector<std::string>& files() const { return files_; }
  /// Gives a file another name, which no other file has.
  void rename_file(std::uint32_t index, const std::string& name);

  std::size_t size() const { return records_.size(); }
  void reserve(std::size_t count) { records_.reserve(count); }

 private:
  friend struct stored::Access;
  enum class Kind : std::uint32_t { none, text, dxf, call };
  struct Record {
    std::uint32_t file = 0;
    std::uint32_t line = 0;    // dxf: index into dxf_
    std::uint32_t column = 0;  // call: index into calls_
    Kind kind = Kind::none;
  };
  std::vector<Record> records_;
  std::vector<std::string> files_;
  std::unordered_map<std::string, std::uint32_t> file_index_;
  std::vector<DrawingLocation> dxf_;
  std::vector<std::string> calls_;
  std::unordered_map<std::string, std::uint32_t> call_index_;
  std::unordered_map<std::uint32_t, OriginId> callers_;
};

}  // namespace kerf

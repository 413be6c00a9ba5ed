// The tags of a DXF file, ASCII or binary: pairs of a group code and a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/pace.h"

#include "kerf/base/diagnostics.h"

namespace kerf::dxf {

/// How a group's value is stored in a binary file.
enum class ValueKind : std::uint8_t { text, real, int16, int32, int64, byte, chunk };
/// Nothing for a group code that does not exist in any version of the format.
std::optional<ValueKind> value_kind(int group);

/// Reads one tag after the other. Comments (999) are skipped. A line without a group code where one is
/// expected is an error; reading continues at the next entity, and `breaks()` is incremented.
class TagReader {
 public:
  /// `bytes` must stay valid. `file` is for messages.
  TagReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics,
            Progress* progress = nullptr);

  /// False at the end of the bytes, and once the work is to stop.
  bool next();
  /// The next call of next() returns the current tag again.
  void repeat() { repeat_ = true; }

  int group() const { return group_; }
  bool is(int group, std::string_view text) const { return group_ == group && text_ == text; }
  /// The value as in the file, not decoded; empty for numbers of binary files. Type names and the like
  /// (groups 0, 2, 9) are trimmed.
  std::string_view text() const { return text_; }
  /// The value as a number; nothing, with an error, if it is not one.
  std::optional<double> number();
  /// As number(), for values that must be integers of 32 bits.
  std::optional<int> integer();
  /// The value as text, also of numbers in binary files.
  std::string value_text() const;
  /// The value as a handle, a hexadecimal number; 0 if it is not one.
  std::uint64_t handle() const;

  bool binary() const { return binary_; }
  bool stopped() const { return pace_.stopped(); }
  /// Line of the group code, or the byte offset in a binary file.
  std::size_t position() const { return position_; }
  /// Line of the value, or the byte offset of the tag.
  std::size_t value_position() const { return position_ + (binary_ ? 0 : 1); }
  /// Append to the diagnostics; position 0 is the whole file.
  Diagnostic& error(Code code, std::size_t position, const std::string& message);
  Diagnostic& warning(Code code, std::size_t position, const std::string& message);
  /// "line 12", "byte 300".
  std::string position_text(std::size_t position) const;
  std::size_t breaks() const { return breaks_; }
  std::size_t comments() const { return comments_; }
  const std::string& file() const { return file_; }

 private:
  Origin origin_at(std::size_t position) const;
  std::string located(std::size_t position, const std::string& message) const;
  bool next_line(std::string_view& line);
  bool next_ascii();
  bool cut_off(const std::string& where);
  bool next_binary();
  bool binary_group();
  bool binary_value(ValueKind kind);
  bool binary_stop(const std::string& what);
  bool group_broken(std::string_view line);
  bool resume();
  std::optional<double> number_with_comma();
  template <class Integer>
  bool take(Integer& value);

  const std::string& file_;
  Diagnostics& diagnostics_;
  Pace pace_;
  const char* at_ = nullptr;
  const char* start_ = nullptr;
  const char* end_ = nullptr;
  char line_end_ = '\n';
  bool binary_ = false;
  bool one_byte_groups_ = false;  // binary files before R13
  bool repeat_ = false;
  bool numeric_ = false;  // binary: the value is in number_
  int group_ = -1;
  double number_ = 0.0;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t lines_ = 0;  // read so far
  std::size_t breaks_ = 0;
  std::size_t comments_ = 0;
};

}  // namespace kerf::dxf

// Tags from lines of text or from AutoCAD's binary form.
#include "codec/drawing/dxf_tags.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf::dxf {
namespace {

constexpr std::string_view kSentinel{"AutoCAD Binary DXF\r\n\x1a\0", 22};
constexpr int kComment = 999;
constexpr std::size_t kQuoted = 40;  // characters of a faulty value in a message

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// An invalid value for a message: printable and shortened.
std::string quoted(std::string_view text) {
  std::string made = "\"";
  for (const char c : text.substr(0, kQuoted)) made += c >= ' ' && c <= '~' ? c : '?';
  return made + (text.size() > kQuoted ? "...\"" : "\"");
}

/// A group code, possibly with blanks around it; nothing for other lines.
std::optional<int> group_of(std::string_view line) {
  line = without_blanks(line);
  const bool negative = !line.empty() && line.front() == '-';
  if (negative) line.remove_prefix(1);
  if (line.empty() || line.size() > 4) return std::nullopt;
  int value = 0;
  for (const char c : line) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return negative ? -value : value;
}

/// LINE, ACAD_TABLE, 3DFACE and the like, which follow a group code 0.
bool is_type_name(std::string_view line) {
  bool letter = false;
  for (const char c : without_blanks(line)) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (!upper && !(c >= '0' && c <= '9') && c != '_') return false;
    letter = letter || upper;
  }
  return letter;
}

/// Types, names of layers, blocks etc. and variables, which are trimmed.
bool is_name(int group) { return group == 0 || group == 2 || (group >= 6 && group <= 9); }

}  // namespace

std::optional<ValueKind> value_kind(int group) {
  struct Range {
    int first, last;
    ValueKind kind;
  };
  static constexpr Range kRanges[] = {
      {0, 9, ValueKind::text},        {10, 59, ValueKind::real},      {60, 79, ValueKind::int16},
      {90, 99, ValueKind::int32},     {100, 109, ValueKind::text},    {110, 149, ValueKind::real},
      {160, 169, ValueKind::int64},   {170, 179, ValueKind::int16},   {210, 239, ValueKind::real},
      {270, 289, ValueKind::int16},   {290, 299, ValueKind::byte},    {300, 309, ValueKind::text},
      {310, 319, ValueKind::chunk},   {320, 369, ValueKind::text},    {370, 389, ValueKind::int16},
      {390, 399, ValueKind::text},    {400, 409, ValueKind::int16},   {410, 419, ValueKind::text},
      {420, 429, ValueKind::int32},   {430, 439, ValueKind::text},    {440, 459, ValueKind::int32},
      {460, 469, ValueKind::real},    {470, 481, ValueKind::text},    {999, 1003, ValueKind::text},
      {1004, 1004, ValueKind::chunk}, {1005, 1009, ValueKind::text},  {1010, 1059, ValueKind::real},
      {1060, 1070, ValueKind::int16}, {1071, 1071, ValueKind::int32},
  };
  for (const Range& range : kRanges)
    if (group >= range.first && group <= range.last) return range.kind;
  return std::nullopt;
}

TagReader::TagReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics,
                     Progress* progress)
    : file_(file), diagnostics_(diagnostics), pace_(progress, "reading the drawing") {
  start_ = at_ = bytes.data();
  end_ = start_ + bytes.size();
  binary_ = bytes.starts_with(kSentinel);
  if (binary_) {
    at_ += kSentinel.size();
    // The first tag is 0 SECTION: one zero byte before the S, or two.
    one_byte_groups_ = end_ - at_ >= 2 && at_[1] != 0;
    return;
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) at_ += 3;
  if (bytes.find('\n') == std::string_view::npos) line_end_ = '\r';
}

Origin TagReader::origin_at(std::size_t position) const {
  return TextLocation{file_, binary_ ? 0 : static_cast<std::uint32_t>(position), 0};
}

Diagnostic& TagReader::error(Code code, std::size_t position, const std::string& message) {
  return diagnostics_.error(code, origin_at(position), located(position, message));
}

Diagnostic& TagReader::warning(Code code, std::size_t position, const std::string& message) {
  return diagnostics_.warning(code, origin_at(position), located(position, message));
}

/// The message with the byte offset in a binary file, since origins have none.
std::string TagReader::located(std::size_t position, const std::string& message) const {
  return binary_ && position > 0 ? fmt::format("byte {}: {}", position, message) : message;
}

std::string TagReader::position_text(std::size_t position) const {
  return fmt::format("{} {}", binary_ ? "byte" : "line", position);
}

bool TagReader::next() {
  if (repeat_) {
    repeat_ = false;
    return true;
  }
  const auto done = static_cast<std::size_t>(at_ - start_), all = static_cast<std::size_t>(end_ - start_);
  while (!pace_.stops(done, all) && (binary_ ? next_binary() : next_ascii())) {
    if (group_ != kComment) return true;
    ++comments_;
  }
  group_ = -1;
  return false;
}

// --------------------------------------------------------------------------------------------------- ASCII

bool TagReader::next_line(std::string_view& line) {
  if (at_ == end_) return false;
  const auto* stop =
      static_cast<const char*>(std::memchr(at_, line_end_, static_cast<std::size_t>(end_ - at_)));
  if (stop == nullptr) stop = end_;
  line = {at_, static_cast<std::size_t>(stop - at_)};
  at_ = stop == end_ ? end_ : stop + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++lines_;
  return true;
}

bool TagReader::next_ascii() {
  std::string_view line;
  if (!next_line(line)) return false;
  position_ = lines_;
  const auto group = group_of(line);
  if (!group) return group_broken(line);
  group_ = *group;
  if (!next_line(text_)) return cut_off(fmt::format("after group code {}, without its value", group_));
  if (is_name(group_)) text_ = without_blanks(text_);
  // A last line without its end may be the start of a longer one.
  if (at_ == end_ && at_[-1] != line_end_ && !is(0, "EOF")) cut_off("in a value");
  return true;
}

/// Reports that the file ends too early.
bool TagReader::cut_off(const std::string& where) {
  if (group_ != 0) {
    error(codes::dxf_group_code, lines_, "the file ends " + where);
    ++breaks_;
  }
  return false;
}

/// The end of the file if only blank lines are left, else an error.
bool TagReader::group_broken(std::string_view line) {
  const bool blank = without_blanks(line).empty();
  while (without_blanks(line).empty() || without_blanks(line) == "\x1a")
    if (!next_line(line)) return false;
  if (blank && group_of(line)) {
    warning(codes::dxf_group_code, position_, "blank line instead of a group code; skipped");
    at_ = line.data();
    --lines_;
    return next_ascii();
  }
  position_ = lines_;
  error(codes::dxf_group_code, position_, fmt::format("expected a group code, found {}", quoted(line)));
  ++breaks_;
  return resume();
}

/// Continues at the next line with a 0 that is followed by a name in capitals.
bool TagReader::resume() {
  std::string_view line;
  while (next_line(line)) {
    const char* const after = at_;
    if (without_blanks(line) != "0" || !next_line(text_)) continue;
    if (is_type_name(text_)) {
      position_ = lines_ - 1;
      group_ = 0;
      text_ = without_blanks(text_);
      return true;
    }
    at_ = after;
    --lines_;
  }
  return false;
}

// -------------------------------------------------------------------------------------------------- binary

template <class Integer>
bool TagReader::take(Integer& value) {
  if (static_cast<std::size_t>(end_ - at_) < sizeof(Integer)) return false;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Integer); ++i)
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(at_[i])) << (8 * i);
  value = static_cast<Integer>(bits);
  at_ += sizeof(Integer);
  return true;
}

bool TagReader::binary_stop(const std::string& what) {
  error(codes::dxf_group_code, position_, what + "; the rest of the file is not read");
  ++breaks_;
  at_ = end_;
  return false;
}

bool TagReader::binary_group() {
  constexpr std::uint8_t kTwoBytesFollow = 255;
  if (one_byte_groups_) {
    std::uint8_t group = 0;
    if (!take(group)) return false;
    group_ = group;
    if (group != kTwoBytesFollow) return true;
  }
  std::uint16_t group = 0;
  if (!take(group)) return false;
  group_ = group;
  return true;
}

bool TagReader::next_binary() {
  position_ = static_cast<std::size_t>(at_ - start_);
  if (at_ == end_) return false;
  if (!binary_group()) return binary_stop("the file ends in a group code");
  const auto kind = value_kind(group_);
  if (!kind) return binary_stop(fmt::format("there is no group code {}", group_));
  numeric_ = *kind != ValueKind::text && *kind != ValueKind::chunk;
  text_ = {};
  if (!binary_value(*kind)) return binary_stop(fmt::format("the file ends in the value of group {}", group_));
  return true;
}

bool TagReader::binary_value(ValueKind kind) {
  std::uint64_t bits = 0;
  std::uint32_t four = 0;
  std::uint16_t two = 0;
  std::uint8_t one = 0;
  switch (kind) {
    case ValueKind::text: {
      const auto* stop = static_cast<const char*>(std::memchr(at_, 0, static_cast<std::size_t>(end_ - at_)));
      if (stop == nullptr) return false;
      text_ = {at_, static_cast<std::size_t>(stop - at_)};
      at_ = stop + 1;
      return true;
    }
    case ValueKind::chunk:
      if (!take(one) || end_ - at_ < one) return false;
      at_ += one;
      return true;
    case ValueKind::real:
      if (!take(bits)) return false;
      std::memcpy(&number_, &bits, sizeof number_);
      return true;
    case ValueKind::int16:
      if (!take(two)) return false;
      number_ = static_cast<std::int16_t>(two);
      return true;
    case ValueKind::int32:
      if (!take(four)) return false;
      number_ = static_cast<std::int32_t>(four);
      return true;
    case ValueKind::int64:
      if (!take(bits)) return false;
      number_ = static_cast<double>(static_cast<std::int64_t>(bits));
      return true;
    case ValueKind::byte:
      if (!take(one)) return false;
      number_ = one;
      return true;
  }
  return false;
}

// -------------------------------------------------------------------------------------------------- values

/// "12,5", as written by programs that use the number format of the system.
std::optional<double> TagReader::number_with_comma() {
  const std::string_view text = without_blanks(text_);
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.size() > kQuoted) return std::nullopt;
  std::string with_point(text);
  with_point[comma] = '.';
  const auto value = parse_number(with_point);
  if (value)
    warning(codes::dxf_decimal_comma, value_position(),
            fmt::format("{} has a decimal comma; read as {}", quoted(text_), with_point))
        .hint =
        "DXF requires a decimal point; check the regional settings of the program that wrote the file";
  return value;
}

std::optional<double> TagReader::number() {
  if (numeric_ && std::isfinite(number_)) return number_;
  if (!binary_) {
    if (const auto value = parse_number(text_)) return value;
    if (const auto value = parse_number(without_blanks(text_))) return value;
    if (const auto value = number_with_comma()) return value;
  }
  const std::string value = binary_ ? "the value" : quoted(text_);
  error(codes::dxf_number, value_position(),
        fmt::format("{} of group {} is not a finite number", value, group_));
  return std::nullopt;
}

std::optional<int> TagReader::integer() {
  const auto value = number();
  if (!value) return std::nullopt;
  if (std::abs(*value) <= 2147483647.0 && *value == std::floor(*value)) return static_cast<int>(*value);
  error(codes::dxf_number, value_position(),
        fmt::format("{:g} of group {} is not an integer of 32 bits", *value, group_));
  return std::nullopt;
}

std::string TagReader::value_text() const {
  return binary_ && numeric_ ? exact_text(number_) : std::string(text_);
}

std::uint64_t TagReader::handle() const {
  const std::string_view text = without_blanks(text_);
  if (text.size() > 16) return 0;
  std::uint64_t value = 0;
  for (const char c : text) {
    const int digit = c >= '0' && c <= '9'                     ? c - '0'
                      : (c | 0x20) >= 'a' && (c | 0x20) <= 'f' ? (c | 0x20) - 'a' + 10
                                                               : -1;
    if (digit < 0) return 0;
    value = value << 4 | static_cast<unsigned>(digit);
  }
  return value;
}

}  // namespace kerf::dxf

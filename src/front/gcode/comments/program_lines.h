// The lines of a program as the detection of its kind reads them: words in capitals without blanks and
// comments.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>

namespace kerf::gcode {

inline constexpr std::size_t kMaxWordBytes =
    64 * 1024;  // examined from the start, lines that are comments excluded
inline constexpr std::size_t kMaxTotalBytes = 1024 * 1024;  // with them: slicers store pictures in comments
inline constexpr std::size_t kMaxEvidenceChars = 60;

/// Lines with one kind of evidence: their number, and the first of them.
struct Evidence {
  int count = 0;
  std::uint32_t line = 0;
  std::string text;

  void add(std::uint32_t number, std::string_view what) {
    if (count++ > 0) return;
    line = number;
    text = what.substr(0, kMaxEvidenceChars);
  }
  explicit operator bool() const { return count > 0; }
};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A line in capitals without comments and blanks.
inline std::string words_of(std::string_view line) {
  std::string text;
  int depth = 0;
  for (const char c : line) {
    if (c == ';') break;
    if (c == '(') ++depth;
    if (depth == 0 && c != ' ' && c != '\t' && c != '\r')
      text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (c == ')' && depth > 0) --depth;
  }
  return text;
}

/// The number that follows a letter, as text; empty where the letter is absent.
inline std::string_view after(std::string_view line, char letter) {
  const std::size_t at = line.find(letter);
  if (at == std::string_view::npos) return {};
  std::size_t end = at + 1;
  while (end < line.size() && (is_digit(line[end]) || line[end] == '.' || line[end] == '-')) ++end;
  return line.substr(at + 1, end - at - 1);
}

/// Start of a line without its number.
inline std::size_t after_number(std::string_view line) {
  std::size_t at = !line.empty() && line[0] == 'N' ? 1 : 0;
  while (at < line.size() && is_digit(line[at])) ++at;
  return at;
}

/// Iterates over the lines up to the limits above.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : text_(text.substr(0, kMaxTotalBytes)) {}
  bool next() {
    if (text_.empty() || word_bytes_ > kMaxWordBytes) return false;
    const std::size_t end = text_.find_first_of("\r\n");
    line = text_.substr(0, end);
    const bool pair = end != std::string_view::npos && text_.substr(end, 2) == "\r\n";
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + (pair ? 2 : 1));
    ++number;
    comment = line.find_first_of("(;");
    if (comment != 0) word_bytes_ += line.size() + 1;
    return true;
  }
  std::string_view line;
  std::size_t comment = 0;  // start of the line's comment
  std::uint32_t number = 0;

 private:
  std::string_view text_;
  std::size_t word_bytes_ = 0;
};

}  // namespace kerf::gcode

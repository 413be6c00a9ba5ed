// Splits text into words with line numbers, for STL and OBJ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kerf::mesh_format {

class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::uint32_t line() const { return line_; }
  /// Bytes read so far.
  std::size_t position() const { return at_; }
  /// The next word, on this line or a later one; empty at the end of the text.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
    return word();
  }
  /// The next word of the line; empty at its end.
  std::string_view next_in_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && is_blank(text_[at_])) ++at_;
    return word();
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
};

}  // namespace kerf::mesh_format

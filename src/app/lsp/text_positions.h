// Lines of a text, and their columns in bytes and in the units of the protocol (UTF-16).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::app::lsp {

/// A word in a text: line from 0, columns in bytes from 0.
struct Span {
  std::size_t line = 0, start = 0, end = 0;
};

class TextLines {
 public:
  /// The text must outlive this.
  explicit TextLines(std::string_view text);
  std::size_t count() const { return starts_.size(); }
  /// Without its end; empty beyond the last line.
  std::string_view line(std::size_t number) const;

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

/// The number of UTF-16 units before a byte of a line, and back.
std::size_t units_before(std::string_view line, std::size_t byte);
std::size_t byte_of(std::string_view line, std::size_t units);

/// The file of a "file:" address, and back; a text of another scheme as it is.
std::string path_of_address(std::string_view address);
std::string address_of_path(std::string_view path);

}  // namespace kerf::app::lsp

// What a program prints while it is read, for the console of a page.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kerf::app::view {

/// Bytes of the end of a program's output that a page shows.
inline constexpr std::size_t kShownOutput = 65'536;

/// The end of `text` that a page shows.
std::string shown_end(std::string_view text);

/// Collects lines, and drops those that a page will not show.
class Printed {
 public:
  void add(std::string_view line);
  std::string text() const { return shown_end(text_); }
  void clear() { text_.clear(); }

 private:
  std::string text_;
};

}  // namespace kerf::app::view

// Small helpers for texts that people read.
#pragma once

#include <string>
#include <string_view>

namespace kerf::app {

/// "a, b, c" of any list of words.
template <class Words>
std::string joined(const Words& words, std::string_view separator) {
  std::string text;
  for (const auto& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

}  // namespace kerf::app

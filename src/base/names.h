// Names with several spellings: "Lower-Left", "lower left" and "LOWERLEFT" are one name.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// `name` in small letters without spaces, hyphens, underscores; "center" becomes "centre". For comparing
/// only.
std::string fold_name(std::string_view name);
/// "a, b or c": a list of words for messages; `last` precedes the last one.
std::string list_text(const std::vector<std::string>& words, std::string_view last = "or");
/// "a, b, c": any words with a separator between them.
template <class Words>
std::string joined(const Words& words, std::string_view separator) {
  std::string text;
  for (const auto& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}
/// `text` without white space (characters up to the blank) at both ends.
std::string_view trim(std::string_view text);
/// `text`, or its first `max_bytes` bytes (whole characters of UTF-8) and "..." where it is longer: texts of
/// users in messages.
std::string clipped(std::string_view text, std::size_t max_bytes = 300);

}  // namespace kerf

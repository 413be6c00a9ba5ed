// The ending of a file name, by which front ends and forms of output are chosen.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace kerf {

/// An ASCII letter in small letters.
constexpr char small_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

constexpr char capital_letter(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// From the last dot of the last part of a path on, in small letters: ".nc"; empty if there is none.
inline std::string ending_of(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return {};
  std::string ending(path.substr(dot));
  for (char& c : ending) c = small_letter(c);
  return ending;
}

/// Whether a file name ends in `ending` (in small letters), whatever its case.
inline bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  const std::string_view end = name.substr(name.size() - ending.size());
  return std::equal(end.begin(), end.end(), ending.begin(),
                    [](char a, char b) { return small_letter(a) == b; });
}

}  // namespace kerf

// The ending of a file name, by which front ends and forms of output are chosen.
#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// From the last dot of the last part of a path on, in small letters: ".nc"; empty if there is none.
inline std::string ending_of(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return {};
  std::string ending(path.substr(dot));
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return ending;
}

}  // namespace kerf

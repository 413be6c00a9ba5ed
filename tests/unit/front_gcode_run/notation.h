// The notation of the tables in tests/data/gcode: splitting lines, and comparing numbers.
#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace kerf {

inline std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (std::size_t end; (end = text.find(separator, start)) != std::string::npos;
       start = end + separator.size())
    parts.push_back(text.substr(start, end - start));
  parts.push_back(text.substr(start));
  return parts;
}

/// Words equal, numbers within `slack`.
inline bool same(const std::string& a, const std::string& b, double slack) {
  const auto left = split(a, " "), right = split(b, " ");
  if (left.size() != right.size()) return false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (left[i] == right[i]) continue;
    char* end = nullptr;
    const double x = std::strtod(left[i].c_str(), &end);
    if (*end != 0 || !(std::abs(x - std::strtod(right[i].c_str(), nullptr)) <= slack)) return false;
  }
  return true;
}

/// A program of a table: '|' is a line end.
inline std::string program_text(std::string program) {
  for (char& c : program)
    if (c == '|') c = '\n';
  return program;
}

}  // namespace kerf

// Hints for misspelt words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// "did you mean pocket?" if one of `known` is similar to `word`, otherwise `otherwise`.
std::string guess(std::string_view word, const std::vector<std::string>& known, std::string otherwise = {});
/// "; did you mean pocket?", the end of a message; empty if none is similar.
std::string guess_at_end(std::string_view word, const std::vector<std::string>& known);

}  // namespace kerf

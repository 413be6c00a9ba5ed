// The parts of a text: words of a list, lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The words between the commas of a text, without white space around them.
std::vector<std::string> words_of_list(std::string_view text);
/// The lines that are not empty.
std::vector<std::string> lines_of(std::string_view text);

}  // namespace kerf

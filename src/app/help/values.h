// What the value of an option can be, for completion: files by their endings, folders, known words.
#pragma once

#include <string>
#include <vector>

#include "app/options/description.h"

namespace kerf::app {

struct KnownWord {
  std::string word, meaning;  // "102", "square 3.175 mm"
};

struct KnownValues {
  std::vector<KnownWord> words;
  bool files = false, folders = false;
  std::vector<std::string> endings;  // of the files, with their dot; none: all files
};
/// Of an option with a value, or of a positional argument, of the command "tools show".
KnownValues known_values(const std::string& command, const OptionDescription& option);

}  // namespace kerf::app

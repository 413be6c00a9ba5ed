// The parts of a text between separators.
#include "base/split.h"

#include <algorithm>

#include "base/names.h"

namespace kerf {
namespace {

template <class Visit>
void for_each_part(std::string_view text, char separator, Visit visit) {
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    visit(text.substr(start, end - start));
    start = end + 1;
  }
}

}  // namespace

std::vector<std::string> words_of_list(std::string_view text) {
  std::vector<std::string> words;
  for_each_part(text, ',', [&](std::string_view part) { words.emplace_back(trim(part)); });
  return words;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for_each_part(text, '\n', [&](std::string_view part) {
    if (!part.empty()) lines.emplace_back(part);
  });
  return lines;
}

}  // namespace kerf

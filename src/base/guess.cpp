// Hints from the most similar of the known words.
#include "base/guess.h"

#include <fmt/format.h>
#include <utility>

#include "base/number.h"

namespace kerf {

std::string guess(std::string_view word, const std::vector<std::string>& known, std::string otherwise) {
  const auto close = did_you_mean(word, known);
  return close ? fmt::format("did you mean {}?", *close) : std::move(otherwise);
}

std::string guess_at_end(std::string_view word, const std::vector<std::string>& known) {
  const std::string text = guess(word, known);
  return text.empty() ? text : "; " + text;
}

}  // namespace kerf

// Words that may follow in a text, with what they mean.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/lsp/symbols.h"

namespace kerf::app::lsp {

struct Proposal {
  std::string word;
  std::string meaning;  // one line; may be empty
  bool is_function = false;
};

/// The words of the language, the keys of the operation at this line of a job, and what the text and its
/// includes define.
std::vector<Proposal> proposals(Script script, std::string_view text, std::size_t line);

/// What a key of a job, a G or M code, or a function of the language means; empty if nothing is known.
std::string meaning_of(Script script, std::string_view text, std::size_t line, const std::string& word);

}  // namespace kerf::app::lsp

// Languages of messages, for commands that replace a program which has them.
#pragma once

#include <cstdint>
#include <string_view>

namespace kerf {

enum class Language : std::uint8_t { english, german };

/// A message in both languages, in the syntax of fmt::format.
struct Bilingual {
  std::string_view english, german;
  constexpr std::string_view in(Language language) const {
    return language == Language::german ? german : english;
  }
};

}  // namespace kerf

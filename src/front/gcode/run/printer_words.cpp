// The words of a printer's commands, as Marlin and Klipper write them: S95, S=95, SPEED=95.
#include "front/gcode/run/printer_words.h"

#include <algorithm>

#include "base/names.h"
#include "base/number.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxValue = 1e9;
constexpr std::size_t kMaxWords = 8;
constexpr std::size_t kMaxLineBytes = 200;  // before an E word

bool starts_number(std::string_view text) {
  return !text.empty() &&
         (text[0] == '-' || text[0] == '+' || text[0] == '.' || (text[0] >= '0' && text[0] <= '9'));
}

/// A line before its E word: a motion, without the start of a comment. G92 E0 only sets the coordinate.
bool is_motion(std::string_view line) {
  const std::size_t code = line.find_first_of("Gg");
  return code != std::string_view::npos && line.find_first_not_of(" \tNn0123456789") == code &&
         line.substr(code + 1, 2) != "92" && line.find_first_of(";(") == std::string_view::npos;
}

}  // namespace

std::optional<std::vector<CommandWord>> command_words(std::string_view text, bool with_names) {
  std::vector<CommandWord> words;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    const std::size_t sign = with_names ? word.find('=') : 0;
    if (sign == std::string_view::npos || words.size() == kMaxWords) return std::nullopt;
    const auto value = parse_number(word.substr(sign + 1));
    if (!value || !(*value >= 0.0 && *value <= kMaxValue)) return std::nullopt;
    words.push_back({fold_name(with_names ? word.substr(0, sign) : word.substr(0, 1)), *value});
  }
  if (words.empty()) return std::nullopt;
  return words;
}

std::optional<double> value_of(const std::vector<CommandWord>& words, std::string_view name) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.name == name; });
  return found == words.end() ? std::nullopt : std::optional(found->value);
}

CommandParts command_parts(std::string_view command) {
  const std::size_t end = std::min(command.find_first_of(" \t"), command.size());
  return {fold_name(command.substr(0, end)), command.substr(end)};
}

bool extrudes(std::string_view program) {
  for (std::size_t e = program.find_first_of("Ee"); e != std::string_view::npos;
       e = program.find_first_of("Ee", e + 1)) {
    if (!starts_number(program.substr(e + 1))) continue;
    const std::size_t first = e - std::min(e, kMaxLineBytes);
    const std::string_view before = program.substr(first, e - first);
    if (is_motion(before.substr(before.find_last_of("\r\n") + 1))) return true;  // npos + 1 is 0
  }
  return false;
}

}  // namespace kerf::gcode

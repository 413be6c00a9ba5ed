// M201, M203, M204, M205 (Marlin, RepRapFirmware), M566 (RepRapFirmware), SET_VELOCITY_LIMIT (Klipper).
#include "front/gcode/run/printer_limits.h"

#include <algorithm>
#include <optional>

#include "base/names.h"
#include "base/number.h"
#include "front/gcode/run/printer_words.h"

namespace kerf::gcode {
namespace {

using Word = CommandWord;

void set(step::MotionLimits& limits, std::size_t i, double value) {
  limits.values[i] = value;
  limits.given |= 1u << i;
}

/// The words as values, in the order of `letters`; nothing with another word.
std::vector<step::MotionLimits> by_letters(LimitKind kind, const std::vector<Word>& words,
                                           std::string_view letters, double factor) {
  step::MotionLimits limits{kind};
  for (const Word& word : words) {
    const std::size_t i = word.name.size() == 1 ? letters.find(word.name[0]) : std::string_view::npos;
    if (i == std::string_view::npos) return {};
    set(limits, i, word.value * factor);
  }
  return {limits};
}

/// M204: S is the acceleration of beads and travel; P, R and T those of beads, retractions and travel.
/// Klipper has one for all, of P and T the smaller one.
std::vector<step::MotionLimits> accelerations(const std::vector<Word>& words, GcodeDialect dialect,
                                              double scale) {
  step::MotionLimits limits{LimitKind::acceleration};
  if (words.size() == 1 && words[0].name == "s") {
    for (const std::size_t i : {0u, 2u}) set(limits, i, words[0].value * scale);
    return {limits};
  }
  auto list = by_letters(LimitKind::acceleration, words, "prt", scale);
  if (dialect != GcodeDialect::klipper || list.empty()) return list;
  if ((list[0].given & 5u) != 5u) return {};
  const double smaller = std::min(list[0].values[0], list[0].values[2]);
  for (const std::size_t i : {0u, 2u}) set(limits, i, smaller);
  return {limits};
}

/// M205: X, Y, Z and E are jerks, J is the junction deviation.
std::vector<step::MotionLimits> jerks(const std::vector<Word>& words, double scale) {
  std::vector<Word> jerk, deviation;
  for (const Word& word : words) (word.name == "j" ? deviation : jerk).push_back(word);
  auto limits =
      jerk.empty() ? std::vector<step::MotionLimits>{} : by_letters(LimitKind::jerk, jerk, "xyze", scale);
  if (!jerk.empty() && limits.empty()) return {};
  if (!deviation.empty()) {
    limits.push_back({LimitKind::junction_deviation});
    set(limits.back(), 0, deviation.back().value * scale);
  }
  return limits;
}

/// The limit of a word; nothing for other words and values. Klipper's limits hold for beads and travel alike.
/// Its VELOCITY holds for X and Y together; here it is the limit of each.
std::optional<step::MotionLimits> velocity_limit(std::string_view text) {
  const auto words = command_words(text, true);
  if (!words || words->size() != 1) return std::nullopt;
  const Word& word = words->front();
  step::MotionLimits limits;
  if (word.name == "velocity") {
    limits.kind = LimitKind::axis_speed;
    for (const std::size_t i : {0u, 1u}) set(limits, i, word.value);
  } else if (word.name == "accel") {
    limits.kind = LimitKind::acceleration;
    for (const std::size_t i : {0u, 2u}) set(limits, i, word.value);
  } else if (word.name == "squarecornervelocity") {
    limits.kind = LimitKind::corner_speed;
    set(limits, 0, word.value);
  } else {
    return std::nullopt;
  }
  return limits;
}

/// SET_VELOCITY_LIMIT, word by word; what is no limit of a step is passed on.
LimitCommand velocity_limits(std::string_view name, std::string_view text) {
  LimitCommand command;
  std::string others;
  for (std::string_view rest = trim(text); !rest.empty(); rest = trim(rest)) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest.remove_prefix(word.size());
    if (const auto limit = velocity_limit(word))
      command.list.push_back(*limit);
    else
      others += " " + std::string(word);
  }
  if (!others.empty()) command.rest = std::string(name) + others;
  return command;
}

}  // namespace

bool sets_no_minimum_feed(std::string_view command) {
  const std::size_t end = std::min(command.find_first_of(" \t"), command.size());
  const auto words = command_words(command.substr(end), false);
  return fold_name(command.substr(0, end)) == "m205" && words &&
         std::all_of(words->begin(), words->end(),
                     [](const Word& w) { return (w.name == "s" || w.name == "t") && w.value == 0.0; });
}

LimitCommand read_limits(std::string_view command, GcodeDialect dialect, double scale) {
  const std::size_t end = std::min(command.find_first_of(" \t"), command.size());
  const std::string_view name = command.substr(0, end), rest = command.substr(end);
  if (dialect == GcodeDialect::klipper && fold_name(name) == fold_name("SET_VELOCITY_LIMIT"))
    return velocity_limits(name, rest);
  if (name.empty() || (name[0] != 'M' && name[0] != 'm')) return {};
  const auto code = parse_number(name.substr(1));
  if (!code || (*code != 201 && *code != 203 && *code != 204 && *code != 205 && *code != 566)) return {};
  const auto words = command_words(rest, false);
  if (!words) return {};
  const double per_second = dialect == GcodeDialect::reprap ? scale / 60.0 : scale;
  if (*code == 201) return {by_letters(LimitKind::axis_acceleration, *words, "xyze", scale), {}};
  if (*code == 203) return {by_letters(LimitKind::axis_speed, *words, "xyze", per_second), {}};
  if (*code == 204) return {accelerations(*words, dialect, scale), {}};
  if (*code == 205) return {jerks(*words, scale), {}};
  if (dialect != GcodeDialect::reprap) return {};
  return {by_letters(LimitKind::jerk, *words, "xyze", per_second), {}};
}

}  // namespace kerf::gcode

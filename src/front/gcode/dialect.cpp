// Which controller a program is for: told by its remarks, else by words that only one kind of machine has.
#include <algorithm>
#include <cctype>
#include <set>
#include <string>

#include "kerf/gcode.h"
#include "kerf/names.h"

namespace kerf {
namespace {

constexpr std::size_t kLookedAt = 64 * 1024;  // bytes from the begin
constexpr int kFewMoves = 8;                  // a program is told by what more moves than these do
constexpr std::size_t kFewPowers = 3;

struct Name {
  std::string_view name;
  GcodeDialect dialect;
};
constexpr Name kNames[] = {
    {"linuxcnc", GcodeDialect::rs274},    {"rs274", GcodeDialect::rs274},    {"grbl", GcodeDialect::grbl},
    {"grblhal", GcodeDialect::grbl},      {"fluidnc", GcodeDialect::grbl},   {"carbide", GcodeDialect::grbl},
    {"smoothieware", GcodeDialect::grbl}, {"mach3", GcodeDialect::mach3},    {"mach4", GcodeDialect::mach3},
    {"fanuc", GcodeDialect::fanuc},       {"haas", GcodeDialect::fanuc},     {"laser", GcodeDialect::laser},
    {"marlin", GcodeDialect::marlin},     {"klipper", GcodeDialect::klipper}};

/// Remarks that name the controller or a program that writes for one kind only.
constexpr Name kRemarks[] = {{"LIGHTBURN", GcodeDialect::laser},
                             {"LASERGRBL", GcodeDialect::laser},
                             {"LASERWEB", GcodeDialect::laser},
                             {"LASER TOOL", GcodeDialect::laser},
                             {"KLIPPER", GcodeDialect::klipper},
                             {"FLAVOR:MARLIN", GcodeDialect::marlin},
                             {"GCODE_FLAVOR = MARLIN", GcodeDialect::marlin},
                             {"MACH3", GcodeDialect::mach3},
                             {"MACH 3", GcodeDialect::mach3},
                             {"MACH2", GcodeDialect::mach3},
                             {"GRBL", GcodeDialect::grbl},
                             {"CARBIDE CREATE", GcodeDialect::grbl}};

/// The profile that a file says it was written with: Kerf's own posts begin with "(Kerf 0.1.0, laser)".
std::optional<GcodeDialect> written_by_kerf(std::string_view remark) {
  constexpr std::string_view kOwn = "KERF ";
  const std::size_t own = remark.find(kOwn);
  const std::size_t comma = own == std::string_view::npos ? own : remark.find(", ", own);
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view name = remark.substr(comma + 2);
  return dialect_named(name.substr(0, name.find_first_of(") \t")));
}

/// The controller that a remark (in capitals) names, if any.
std::optional<GcodeDialect> remarked_in(std::string_view remark) {
  if (const auto own = written_by_kerf(remark)) return own;
  for (const Name& entry : kRemarks)
    if (remark.find(entry.name) != std::string_view::npos) return entry.dialect;
  return std::nullopt;
}

/// What is counted over the lines.
struct Signs {
  int heated = 0, words_of_klipper = 0;
  int powered_moves = 0, deep_moves = 0;
  bool beam = false, numbered = false, calls = false;
  std::set<std::string, std::less<>> powers;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A line in capitals without remarks and blanks.
std::string bare(std::string_view line) {
  std::string text;
  int depth = 0;
  for (const char c : line) {
    if (c == ';') break;
    if (c == '(') ++depth;
    if (depth == 0 && c != ' ' && c != '\t' && c != '\r')
      text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (c == ')' && depth > 0) --depth;
  }
  return text;
}

/// The number that follows a letter, as text; empty where the letter is absent.
std::string_view after(std::string_view line, char letter) {
  const std::size_t at = line.find(letter);
  if (at == std::string_view::npos) return {};
  std::size_t end = at + 1;
  while (end < line.size() && (is_digit(line[end]) || line[end] == '.' || line[end] == '-')) ++end;
  return line.substr(at + 1, end - at - 1);
}

void look_at(const std::string& line, Signs& signs) {
  if (line.empty()) return;
  const std::string_view code = after(line, 'M');
  for (const std::string_view heating : {"104", "109", "140", "190", "82", "83"})
    if (line[0] == 'M' && code == heating) ++signs.heated;
  const bool command = line.size() > 4 && line.find('_') != std::string::npos && !is_digit(line[1]);
  if (command && line.find('#') == std::string::npos && line[0] != 'O') ++signs.words_of_klipper;
  signs.beam = signs.beam || code == "3" || code == "4" || code == "03" || code == "04";
  signs.calls = signs.calls || code == "98" || code == "99";
  signs.numbered = signs.numbered || (line[0] == 'O' && line.size() > 4 && is_digit(line[1]));
  const bool moves = line.find_first_of("XY") != std::string::npos;
  if (line.find('Z') != std::string::npos) ++signs.deep_moves;
  const std::string_view power = after(line, 'S');
  if (!moves || power.empty()) return;
  ++signs.powered_moves;
  if (signs.powers.size() <= kFewPowers) signs.powers.emplace(power);
}

GcodeDialect told_by(const Signs& signs) {
  if (signs.heated > 1) return signs.words_of_klipper > 0 ? GcodeDialect::klipper : GcodeDialect::marlin;
  const bool beam = signs.beam && signs.powered_moves > kFewMoves && signs.powers.size() >= kFewPowers;
  if (beam && signs.deep_moves * kFewMoves < signs.powered_moves) return GcodeDialect::laser;
  if (signs.numbered && signs.calls) return GcodeDialect::fanuc;
  return GcodeDialect::rs274;
}

}  // namespace

std::string_view to_string(GcodeDialect dialect) {
  switch (dialect) {
    case GcodeDialect::grbl: return "GRBL";
    case GcodeDialect::mach3: return "Mach3";
    case GcodeDialect::fanuc: return "Fanuc";
    case GcodeDialect::laser: return "laser";
    case GcodeDialect::marlin: return "Marlin";
    case GcodeDialect::klipper: return "Klipper";
    case GcodeDialect::rs274: break;
  }
  return "LinuxCNC";
}

std::optional<GcodeDialect> dialect_named(std::string_view name) {
  const std::string folded = fold_name(name);
  for (const Name& entry : kNames)
    if (entry.name == folded) return entry.dialect;
  return std::nullopt;
}

const std::vector<std::string>& dialect_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Name& entry : kNames) all.emplace_back(entry.name);
    return all;
  }();
  return names;
}

GcodeDialect guess_dialect(std::string_view text) {
  text = text.substr(0, kLookedAt);
  Signs signs;
  std::optional<GcodeDialect> remarked;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    look_at(bare(line), signs);
    const std::size_t remark = line.find_first_of("(;");
    if (remark == std::string_view::npos) continue;
    std::string capitals(line.substr(remark));
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const bool better = !remarked || *remarked == GcodeDialect::grbl;
    if (const auto named = remarked_in(capitals); named && better) remarked = named;
  }
  const GcodeDialect told = told_by(signs);
  const bool plain_remark = !remarked || *remarked == GcodeDialect::grbl;
  return told != GcodeDialect::rs274 && plain_remark ? told : remarked.value_or(told);
}

}  // namespace kerf

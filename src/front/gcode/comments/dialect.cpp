// Which controller a program is for: told by its remarks, else by words that only one kind of machine has.
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <set>
#include <string>

#include "kerf/gcode_dialect.h"
#include "kerf/names.h"

namespace kerf {
namespace {

constexpr std::size_t kLookedAt = 64 * 1024;       // bytes from the begin, remarks left aside
constexpr std::size_t kMostRemarks = 1024 * 1024;  // bytes with them: slicers put pictures there
constexpr std::size_t kShown = 60;                 // characters of what told it
constexpr int kFewMoves = 8;                       // a program is told by what more moves than these do
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

/// Lines of one kind: how many, and the first of them.
struct Sign {
  int count = 0;
  std::uint32_t line = 0;
  std::string text;

  void add(std::uint32_t number, std::string_view what) {
    if (count++ > 0) return;
    line = number;
    text = what.substr(0, kShown);
  }
  explicit operator bool() const { return count > 0; }
};

/// What is counted over the lines.
struct Signs {
  Sign heating, extruding, klipper_command;
  Sign beam, powered_move;
  Sign number, call;
  int deep_moves = 0;
  std::set<std::string, std::less<>> powers;
};

/// A remark that names a controller; none where `sign` is empty.
struct Remark {
  GcodeDialect dialect = GcodeDialect::rs274;
  Sign sign;
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

bool is_heating(std::string_view code) {
  for (const std::string_view heating : {"104", "109", "140", "190", "82", "83"})
    if (code == heating) return true;
  return false;
}

/// "O1001" alone, as Fanuc's programs begin; O-words have letters behind their label.
bool is_program_number(const std::string& line) {
  return line[0] == 'O' && line.size() > 4 && std::all_of(line.begin() + 1, line.end(), is_digit);
}

/// `line` is bare; `raw` is the same as it stands there.
void look_at(const std::string& line, std::string_view raw, std::uint32_t number, Signs& signs) {
  if (line.empty()) return;
  const std::string_view code = after(line, 'M');
  if (line[0] == 'M' && is_heating(code)) signs.heating.add(number, "M" + std::string(code));
  const bool command = line.size() > 4 && line.find('_') != std::string::npos && !is_digit(line[1]);
  if (command && line.find('#') == std::string::npos && line[0] != 'O')
    signs.klipper_command.add(number, raw.substr(0, raw.find_first_of(" \t=;(")));
  if (code == "3" || code == "4" || code == "03" || code == "04")
    signs.beam.add(number, "M" + std::string(code));
  if (code == "98" || code == "99") signs.call.add(number, "M" + std::string(code));
  if (is_program_number(line)) signs.number.add(number, line);
  const bool moves = line.find_first_of("XY") != std::string::npos;
  if (line[0] == 'G' && !after(line, 'E').empty()) signs.extruding.add(number, "E");
  if (line.find('Z') != std::string::npos) ++signs.deep_moves;
  const std::string_view power = after(line, 'S');
  if (!moves || power.empty()) return;
  signs.powered_move.add(number, "S");
  if (signs.powers.size() <= kFewPowers) signs.powers.emplace(power);
}

std::string place_of(const Sign& sign) { return fmt::format("{} in line {}", sign.text, sign.line); }

DialectGuess told_by(const Signs& s) {
  if (s.heating.count > 1 && s.extruding && s.klipper_command)
    return {GcodeDialect::klipper, place_of(s.heating) + " and " + place_of(s.klipper_command),
            s.heating.line};
  if (s.heating.count > 1 && s.extruding)
    return {GcodeDialect::marlin, place_of(s.heating) + " and " + place_of(s.extruding), s.heating.line};
  const bool beam = s.beam && s.powered_move.count > kFewMoves && s.powers.size() >= kFewPowers;
  if (beam && s.deep_moves * kFewMoves < s.powered_move.count)
    return {GcodeDialect::laser, fmt::format("{} and the S words of its moves", place_of(s.beam)),
            s.beam.line};
  if (s.number && s.call)
    return {GcodeDialect::fanuc, place_of(s.number) + " and " + place_of(s.call), s.number.line};
  return {};
}

/// Of printers, a remark alone says nothing: a mill may cut the model of a klipper.
bool is_borne_out(GcodeDialect dialect, const Signs& signs) {
  const bool printer = dialect == GcodeDialect::marlin || dialect == GcodeDialect::klipper;
  return !printer || signs.heating || signs.extruding;
}

/// Control bytes and quotes do not belong in a message.
std::string quoted(std::string_view remark) {
  std::string text = "\"";
  for (const char c : remark.substr(0, kShown))
    text += static_cast<unsigned char>(c) < ' ' || c == '"' ? ' ' : c;
  return text + '"';
}

/// Walks over the lines; those that are remarks alone do not count against what is looked at.
class LineWalk {
 public:
  explicit LineWalk(std::string_view text) : text_(text.substr(0, kMostRemarks)) {}
  bool next() {
    if (text_.empty() || words_ > kLookedAt) return false;
    const std::size_t end = text_.find_first_of("\r\n");
    line = text_.substr(0, end);
    const bool pair = end != std::string_view::npos && text_.substr(end, 2) == "\r\n";
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + (pair ? 2 : 1));
    ++number;
    remark = line.find_first_of("(;");
    if (remark != 0) words_ += line.size() + 1;
    return true;
  }
  std::string_view line;
  std::size_t remark = 0;  // where the line's remark begins
  std::uint32_t number = 0;

 private:
  std::string_view text_;
  std::size_t words_ = 0;
};

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

DialectGuess guess_dialect(std::string_view text) {
  Signs signs;
  Remark remarked;
  for (LineWalk walk(text); walk.next();) {
    look_at(bare(walk.line), walk.line, walk.number, signs);
    if (walk.remark == std::string_view::npos) continue;
    const std::string_view remark = walk.line.substr(walk.remark);
    std::string capitals(remark);
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const bool better = !remarked.sign || remarked.dialect == GcodeDialect::grbl;
    const auto named = remarked_in(capitals);
    if (!named || !better || (remarked.sign && *named == remarked.dialect)) continue;
    remarked = {*named, {}};
    remarked.sign.add(walk.number, quoted(remark));
  }
  const DialectGuess told = told_by(signs);
  if (!is_borne_out(remarked.dialect, signs)) remarked = {};
  const bool plain_remark = !remarked.sign || remarked.dialect == GcodeDialect::grbl;
  if (!remarked.sign || (told.dialect != GcodeDialect::rs274 && plain_remark)) return told;
  return {remarked.dialect, place_of(remarked.sign), remarked.sign.line};
}

}  // namespace kerf

// Names of dialects and of the centres of arcs, and the detection of a program's dialect: from its comments,
// else from words that only one kind of machine has.
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <initializer_list>
#include <set>
#include <string>

#include "base/ending.h"
#include "base/names.h"
#include "front/gcode/comments/program_lines.h"
#include "path/own_header.h"
#include "path/printer_firmware.h"

#include "kerf/program/gcode_options.h"

namespace kerf {
namespace {

using namespace gcode;

// A laser program has more than so many motions with S words, and fewer than 1 / so many of them in Z.
constexpr int kExtrusions = 3;  // motions with E that make a print of a program without heating and spindle
constexpr int kLaserMotions = 8;
constexpr std::size_t kLaserPowers = 3;  // minimum number of different S words
// So has a program without Z words and tools that has S0, or starts and stops the spindle, this often.
constexpr int kLaserSwitches = 2;

struct Name {
  std::string_view name;
  GcodeDialect dialect;
};
constexpr Name kNames[] = {
    {"linuxcnc", GcodeDialect::rs274},    {"rs274", GcodeDialect::rs274},  {"grbl", GcodeDialect::grbl},
    {"grblhal", GcodeDialect::grbl},      {"fluidnc", GcodeDialect::grbl}, {"carbide", GcodeDialect::grbl},
    {"smoothieware", GcodeDialect::grbl}, {"carvera", GcodeDialect::grbl}, {"maslow", GcodeDialect::grbl},
    {"tinyg", GcodeDialect::rs274},       {"g2core", GcodeDialect::rs274}, {"mach3", GcodeDialect::mach3},
    {"mach4", GcodeDialect::mach3},       {"fanuc", GcodeDialect::fanuc},  {"haas", GcodeDialect::haas},
    {"laser", GcodeDialect::laser}};

GcodeDialect dialect_of(PrinterLanguage language) {
  switch (language) {
    case PrinterLanguage::klipper: return GcodeDialect::klipper;
    case PrinterLanguage::reprap: return GcodeDialect::reprap;
    case PrinterLanguage::marlin: break;
  }
  return GcodeDialect::marlin;
}

/// Names of controllers, and of programs that write for one dialect only.
constexpr Name kNamesInComments[] = {
    {"LIGHTBURN", GcodeDialect::laser},      {"LASERGRBL", GcodeDialect::laser},
    {"LASERWEB", GcodeDialect::laser},       {"LASER TOOL", GcodeDialect::laser},
    {"KLIPPER", GcodeDialect::klipper},      {"REPRAPFIRMWARE", GcodeDialect::reprap},
    {"FLAVOR:MARLIN", GcodeDialect::marlin}, {"GCODE_FLAVOR = MARLIN", GcodeDialect::marlin},
    {"MACH3", GcodeDialect::mach3},          {"MACH 3", GcodeDialect::mach3},
    {"MACH2", GcodeDialect::mach3},          {"GRBL", GcodeDialect::grbl},
    {"CARBIDE CREATE", GcodeDialect::grbl}};

/// The profile of a file that Kerf has written: its posts start with "(Kerf 0.1.0, linuxcnc)", or
/// "(Kerf 0.1.0, linuxcnc for a laser)", whose M3, M4 and S are those of a beam; a post of another name says
/// as which it is read, "(Kerf 0.1.0, mymill for grbl)".
std::optional<GcodeDialect> written_by_kerf(std::string_view comment) {
  constexpr std::string_view kOwn = "KERF ";
  const std::size_t own = comment.find(kOwn);
  const std::size_t comma = own == std::string_view::npos ? own : comment.find(", ", own);
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view name = comment.substr(comma + 2);
  if (fold_name(name).find(fold_name(kForBeam)) != std::string::npos) return GcodeDialect::laser;
  const auto word_at = [name](std::size_t start) {
    const std::string_view rest = name.substr(start);
    return dialect_named(rest.substr(0, rest.find_first_of(") \t")));
  };
  std::string in_capitals(kForDialect);
  for (char& c : in_capitals) c = capital_letter(c);
  const std::size_t read_as = name.find(in_capitals);
  return read_as == std::string::npos ? word_at(0) : word_at(read_as + in_capitals.size());
}

bool has_any_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

/// "(VENDOR: HAAS AUTOMATION)", "(MACHINE: HAAS VF2)", "(POST: HAAS NGC)": not each "HAAS", which also makes
/// tools.
bool names_haas(std::string_view comment) {
  return comment.find("HAAS") != std::string_view::npos &&
         has_any_of(comment,
                    {"VENDOR", "MACHINE", "POST", "CONTROL", "MODEL", "AUTOMATION", "HAAS VF", "HAAS NGC"}) &&
         !has_any_of(comment, {"LINUXCNC", "MACH3", "GRBL", "TOOL", "END MILL"});
}

/// The dialect of a comment in capitals that names a controller or its program.
std::optional<GcodeDialect> dialect_of_comment(std::string_view comment) {
  if (names_haas(comment)) return GcodeDialect::haas;
  for (const Name& entry : kNamesInComments)
    if (comment.find(entry.name) != std::string_view::npos) return entry.dialect;
  return std::nullopt;
}

struct WordEvidence {
  Evidence heating, extruding, klipper_command;
  Evidence beam, motion_with_power, motion;
  Evidence program_number, call;
  Evidence fan, probe;
  int fan_stops = 0, heights_set = 0;
  Evidence haas;                    // a code of Haas' controls alone
  Evidence torch;                   // a comment that names a torch or a water jet
  bool is_torch_post = false;       // it names its post or tool
  Evidence macro;                   // a statement or word of Fanuc's and Haas' controls alone
  bool has_power = false;           // an S word
  bool has_words = false;           // a line with more than %
  bool starts_with_number = false;  // the program's number precedes all other words
  bool has_fanuc_form = false;      // "X10.", or G80 and a motion code on one line
  int motions_in_z = 0, beads = 0, stops = 0, zero_powers = 0, tools = 0;
  std::set<std::string, std::less<>> powers;
};

/// A comment that names a controller; none if `evidence` is empty.
struct CommentEvidence {
  GcodeDialect dialect = GcodeDialect::rs274;
  Evidence evidence;
};

bool is_heating(std::string_view code) {
  for (const std::string_view heating : {"104", "109", "140", "190", "82", "83"})
    if (code == heating) return true;
  return false;
}

/// "O1001" alone, the first line of Fanuc's programs; O-words have letters after their label.
bool is_program_number(const std::string& line) {
  return line[0] == 'O' && line.size() > 4 && std::all_of(line.begin() + 1, line.end(), is_digit);
}

/// "WHILE[#1LT3]DO1", "IF[#1EQ0]GOTO20", "GOTO5" and "G65P9010" at the start of a line, ",R5" within it;
/// empty for other lines. LinuxCNC's words of these names follow the O of their label.
std::string_view macro_word(std::string_view line) {
  const std::string_view text = line.substr(after_number(line));
  for (const std::string_view word : {"WHILE[", "IF[", "GOTO", "G65P"}) {
    const bool found = text.substr(0, word.size()) == word;
    if (found && text.size() > word.size())
      return word.back() == '[' ? word.substr(0, word.size() - 1) : word;
  }
  for (const std::string_view word : {",R", ",C"}) {
    const std::size_t at = text.find(word);
    const std::string_view value = at == std::string_view::npos ? std::string_view() : text.substr(at + 2);
    if (at != 0 && !value.empty() && (is_digit(value[0]) || value[0] == '.' || value[0] == '#')) return word;
  }
  return {};
}

/// Whether a line has this code, wherever in it.
bool has_code(std::string_view line, std::string_view code) {
  for (std::size_t at = line.find(code); at != std::string_view::npos; at = line.find(code, at + 1)) {
    const std::size_t end = at + code.size();
    if (end == line.size() || (!is_digit(line[end]) && line[end] != '.')) return true;
  }
  return false;
}

/// "G154P3", "G187", "G150" and "G13D1": codes of Haas' controls alone; G12 and G13 of Mach3 have no D.
std::string_view haas_code(std::string_view line) {
  for (const std::string_view code : {"G154", "G187", "G150"})
    if (has_code(line, code) && (code != "G154" || !after(line, 'P').empty())) return code;
  for (const std::string_view code : {"G12", "G13"})
    if (has_code(line, code) && !after(line, 'D').empty()) return code;
  return {};
}

/// "X10.", or "G0G17G40G49G80": LinuxCNC refuses G0 and G80 on one line.
bool has_fanuc_form(std::string_view line) {
  for (std::size_t at = line.find('.'); at != std::string_view::npos; at = line.find('.', at + 1)) {
    const bool is_last = at + 1 == line.size() || (!is_digit(line[at + 1]) && line[at + 1] != '.');
    if (at > 0 && is_digit(line[at - 1]) && is_last) return true;
  }
  const std::string_view code = after(line, 'G');
  return (code == "0" || code == "00") && line.find("G80") != std::string_view::npos;
}

/// G0 to G3, which have no E word on mills.
bool is_straight_or_arc(const std::string& line) {
  const std::string_view code = after(line, 'G');
  return (code.size() == 1 || (code.size() == 2 && code[0] == '0')) && code.back() <= '3';
}

/// "0", "0.0" and so on.
bool is_zero(std::string_view number) {
  return !number.empty() && number.find_first_not_of("0.") == std::string_view::npos;
}

/// Adds a line's words to the evidence. `line` is in capitals without blanks (words_of), `raw` the original.
void count_words(const std::string& line, std::string_view raw, std::uint32_t number, WordEvidence& found) {
  if (line.empty()) return;
  const std::string_view code = after(line, 'M');
  if (line[0] == 'M' && is_heating(code)) found.heating.add(number, "M" + std::string(code));
  const bool command = line.size() > 4 && line.find('_') != std::string::npos && !is_digit(line[1]);
  if (command && line.find('#') == std::string::npos && line[0] != 'O')
    found.klipper_command.add(number, raw.substr(0, raw.find_first_of(" \t=;(")));
  if (code == "3" || code == "4" || code == "03" || code == "04")
    found.beam.add(number, "M" + std::string(code));
  if (code == "106" && !after(line, 'S').empty()) found.fan.add(number, "M106");
  if (code == "107") ++found.fan_stops;
  for (const std::string_view probe : {"G31", "G38.2", "G28.1"})
    if (has_code(line, probe) && !after(line, 'Z').empty()) found.probe.add(number, probe);
  if (after(line, 'G') == "92" && !after(line, 'Z').empty()) ++found.heights_set;
  if (code == "98" || code == "99") found.call.add(number, "M" + std::string(code));
  if (is_program_number(line)) {
    found.starts_with_number = found.starts_with_number || !found.has_words;
    found.program_number.add(number, line);
  }
  found.has_words = found.has_words || line[0] != '%';
  if (found.starts_with_number && !found.has_fanuc_form) found.has_fanuc_form = has_fanuc_form(line);
  if (const std::string_view word = macro_word(line); !word.empty()) found.macro.add(number, word);
  if (const std::string_view haas = haas_code(line); !haas.empty()) found.haas.add(number, haas);
  const bool moves = line.find_first_of("XY") != std::string::npos;
  if (line[0] == 'G' && !after(line, 'E').empty()) {
    found.extruding.add(number, "E");
    if (moves && is_straight_or_arc(line)) ++found.beads;
  }
  if (line.find('Z') != std::string::npos) ++found.motions_in_z;
  const std::string_view power = after(line, 'S');
  if (code == "5" || code == "05") ++found.stops;
  if (is_zero(power)) ++found.zero_powers;
  found.has_power = found.has_power || !power.empty();
  if (line.find('T') != std::string::npos || code == "6" || code == "06") ++found.tools;
  if (moves) found.motion.add(number, "X");
  if (!moves || power.empty()) return;
  found.motion_with_power.add(number, "S");
  if (found.powers.size() <= kLaserPowers) found.powers.emplace(power);
}

/// A beam that is switched on and off between motions in X and Y alone.
bool is_switched(const WordEvidence& e) {
  const bool is_often =
      e.zero_powers >= kLaserSwitches || (e.beam.count >= kLaserSwitches && e.stops >= kLaserSwitches) ||
      (e.zero_powers > 0 && e.motion_with_power);  // M3 S0, and the power in the lines of the cuts
  return e.beam && is_often && e.motion && e.motions_in_z == 0 && e.tools == 0;
}

/// A beam that the output for a fan switches, as on Marlin: M106 S255 and M107 between motions in X and Y.
bool is_switched_as_fan(const WordEvidence& e) {
  return e.fan.count >= kLaserSwitches && e.fan_stops >= kLaserSwitches && e.motion && !e.beam &&
         e.tools == 0 && e.motions_in_z == 0;
}

/// A torch: it touches off, sets the height, and M3 and M5 without a speed are its arc.
bool is_torch(const WordEvidence& e) {
  return e.probe && e.probe.text == "G31" && e.heights_set > 0 && e.beam && e.stops > 0 && !e.has_power &&
         e.tools == 0;
}

/// A program whose comments name a torch or a water jet, and whose spindle starts and stops around cuts.
bool is_named_torch(const WordEvidence& e) {
  return e.torch && e.beam && e.stops > 0 && (e.is_torch_post || e.probe || e.beam.count >= kLaserSwitches);
}

std::string location_of(const Evidence& e) { return fmt::format("{} in line {}", e.text, e.line); }

DialectGuess guess_from_words(const WordEvidence& e) {
  if (e.heating && e.extruding && e.klipper_command)
    return {GcodeDialect::klipper, location_of(e.heating) + " and " + location_of(e.klipper_command),
            e.heating.line};
  if (e.heating && e.extruding)
    return {GcodeDialect::marlin, location_of(e.heating) + " and " + location_of(e.extruding),
            e.heating.line};
  if (e.beads >= kExtrusions && !e.beam)
    return {GcodeDialect::marlin, location_of(e.extruding), e.extruding.line};
  const bool beam = e.beam && e.motion_with_power.count > kLaserMotions && e.powers.size() >= kLaserPowers;
  if (beam && e.motions_in_z * kLaserMotions < e.motion_with_power.count)
    return {GcodeDialect::laser, fmt::format("{} and the S words of its motions", location_of(e.beam)),
            e.beam.line};
  if (is_switched(e))
    return {GcodeDialect::laser,
            fmt::format("{}, switched on and off without motions in Z", location_of(e.beam)), e.beam.line};
  if (is_switched_as_fan(e))
    return {GcodeDialect::laser,
            fmt::format("{}, switched on and off without motions in Z", location_of(e.fan)), e.fan.line};
  if (is_torch(e))
    return {GcodeDialect::laser,
            fmt::format("{} to touch off, and {} without a speed: a torch", location_of(e.probe),
                        location_of(e.beam)),
            e.probe.line, true};
  if (e.haas) return {GcodeDialect::haas, location_of(e.haas), e.haas.line};
  if (e.macro) return {GcodeDialect::fanuc, location_of(e.macro), e.macro.line};
  if (e.program_number && e.call)
    return {GcodeDialect::fanuc, location_of(e.program_number) + " and " + location_of(e.call),
            e.program_number.line};
  if (e.starts_with_number && e.has_fanuc_form)
    return {GcodeDialect::fanuc, location_of(e.program_number) + ", the program's number",
            e.program_number.line};
  return {};
}

/// ";header_type: cnc" in files for the CNC module of Snapmaker, whose controller is a Marlin.
bool is_snapmaker_header(std::string_view comment) {
  constexpr std::string_view kKey = "HEADER_TYPE:";
  const std::size_t at = comment.find(kKey);
  return at != std::string_view::npos && trim(comment.substr(at + kKey.size())) == "CNC";
}

/// A comment alone does not make a printer's program: a mill may cut a model of the ship klipper.
bool is_plausible(GcodeDialect dialect, const WordEvidence& e) {
  return !is_printer(dialect) || e.heating || e.extruding;
}

/// A comment for a message, without control characters and quotes.
std::string quoted(std::string_view comment) {
  std::string text = "\"";
  for (const char c : comment.substr(0, kMaxEvidenceChars))
    text += static_cast<unsigned char>(c) < ' ' || c == '"' ? ' ' : c;
  return text + '"';
}

}  // namespace

std::string_view to_string(GcodeDialect dialect) {
  switch (dialect) {
    case GcodeDialect::grbl: return "GRBL";
    case GcodeDialect::mach3: return "Mach3";
    case GcodeDialect::fanuc: return "Fanuc";
    case GcodeDialect::haas: return "Haas";
    case GcodeDialect::laser: return "laser";
    case GcodeDialect::marlin: return "Marlin";
    case GcodeDialect::klipper: return "Klipper";
    case GcodeDialect::reprap: return "RepRapFirmware";
    case GcodeDialect::rs274: break;
  }
  return "LinuxCNC";
}

std::optional<GcodeDialect> dialect_named(std::string_view name) {
  const std::string folded = fold_name(name);
  for (const Name& entry : kNames)
    if (entry.name == folded) return entry.dialect;
  for (const PrinterFirmware& firmware : printer_firmwares())
    if (firmware.name == folded) return dialect_of(firmware.language);
  return std::nullopt;
}

std::optional<ArcCentres> arc_centres_named(std::string_view name) {
  if (name == "offsets") return ArcCentres::offsets;
  return name == "absolute" ? std::optional(ArcCentres::absolute) : std::nullopt;
}

const std::vector<std::string>& dialect_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Name& entry : kNames) all.emplace_back(entry.name);
    for (const PrinterFirmware& firmware : printer_firmwares()) all.emplace_back(firmware.name);
    return all;
  }();
  return names;
}

namespace {

struct FirmwareSetting {
  std::string_view key;
  const PrinterFirmware* (*firmware)(std::string_view value);
};
/// "; gcode_flavor = klipper", which PrusaSlicer writes at the end, ";FLAVOR:RepRap" of Cura, and the name of
/// RepRapFirmware in a comment. Other firmwares are known by the words of the program.
constexpr FirmwareSetting kSettings[] = {
    {"gcode_flavor", firmware_of_gcode_flavor},
    {"FLAVOR:", firmware_of_flavor},
    {"RepRapFirmware", [](std::string_view) { return firmware_of_gcode_flavor("RepRapFirmware"); }}};

/// The firmware that a setting of a slicer names, wherever in the file it is.
DialectGuess guess_from_setting(std::string_view text) {
  for (const FirmwareSetting& setting : kSettings)
    for (std::size_t at = text.find(setting.key); at != std::string_view::npos;
         at = text.find(setting.key, at + 1)) {
      const std::size_t start = text.find_last_of("\r\n", at) + 1;  // npos + 1 is 0
      const std::string_view line = text.substr(start, text.find_first_of("\r\n", at) - start);
      if (line[0] != ';') continue;
      const std::size_t sign = std::min(line.find_first_of("=:"), line.size() - 1);
      const PrinterFirmware* firmware = setting.firmware(trim(line.substr(sign + 1)));
      if (firmware == nullptr) continue;
      const auto number =
          1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(start), '\n');
      return {dialect_of(firmware->language), fmt::format("\"{}\" in line {}", trim(line), number),
              static_cast<std::uint32_t>(number)};
    }
  return {};
}

}  // namespace

DialectGuess guess_dialect(std::string_view text) {
  WordEvidence words;
  CommentEvidence named;
  bool own = false;
  for (LineScanner scanner(text); scanner.next();) {
    count_words(words_of(scanner.line), scanner.line, scanner.number, words);
    if (scanner.comment == std::string_view::npos) continue;
    const std::string_view comment = scanner.line.substr(scanner.comment);
    std::string capitals(comment);
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (has_any_of(capitals, {"PLASMA", "TORCH", "WATERJET", "WATER JET", "JET CUTTING"})) {
      words.torch.add(scanner.number, quoted(comment));
      words.is_torch_post = words.is_torch_post || has_any_of(capitals, {"POST", "SHEETCAM", "CUTTING"});
    }
    if (own) continue;  // what wrote the file knows better than the names in its comments
    auto writer = written_by_kerf(capitals);
    if (!writer && is_snapmaker_header(capitals)) writer = GcodeDialect::marlin;
    if (writer) {
      own = true, named = {*writer, {}};
      named.evidence.add(scanner.number, quoted(comment));
      continue;
    }
    const bool better = !named.evidence || named.dialect == GcodeDialect::grbl;
    const auto dialect = dialect_of_comment(capitals);
    if (!dialect || !better || (named.evidence && *dialect == named.dialect)) continue;
    named = {*dialect, {}};
    named.evidence.add(scanner.number, quoted(comment));
  }
  const DialectGuess guess = guess_from_words(words);
  if ((words.heating || words.extruding) && !own)
    if (DialectGuess setting = guess_from_setting(text); setting.line > 0) return setting;
  if (!own && is_named_torch(words))
    return {GcodeDialect::laser, location_of(words.torch) + " and " + location_of(words.beam),
            words.torch.line, true};
  if (!own && !is_plausible(named.dialect, words)) named = {};
  const bool weak = !named.evidence || named.dialect == GcodeDialect::grbl;
  if (!named.evidence || (guess.dialect != GcodeDialect::rs274 && weak)) return guess;
  return {named.dialect, location_of(named.evidence), named.evidence.line};
}

}  // namespace kerf

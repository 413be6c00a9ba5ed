// The options of `kerf adjustz`.
#include "app/options/adjustz_options.h"

#include <algorithm>
#include <string_view>

#include "app/options/slash_options.h"
#include "base/codes/pathdxf.h"
#include "base/number.h"

namespace kerf::app {
namespace {

constexpr SlashOption kOptions[] = {
    {'h', "help", false, "This text", "Dieser Text"},
    {'m', "max-correction", true, "Maximum correction of heights in mm; required",
     "Maximale Korrektur der Höhen in mm; notwendig"},
    {'x', "show-lines", true, "Print the lines of the program that match this expression",
     "Zeilen des Programms ausgeben, die diesem Ausdruck entsprechen"},
    {'l', "language", true, "en or de; default: the system's", "en oder de; Standard: die des Systems"},
    {'\0', "measured", true,
     "Heights by position from this file (console log of GRBL, PROBEOPEN of LinuxCNC, ...)",
     "Höhen nach Position aus dieser Datei (GRBL-Protokoll, PROBEOPEN von LinuxCNC, ...)"},
    {'\0', "work-offset", true, "X,Y,Z of the work zero in machine coordinates, for such a log",
     "X,Y,Z des Werkstücknullpunkts in Maschinenkoordinaten, für ein solches Protokoll"},
};

constexpr Bilingual kOffset{"--work-offset takes X,Y,Z", "--work-offset hat die Form X,Y,Z"};
constexpr Bilingual kRequired{"Missing required /m value", "Der notwendige Wert /m fehlt"};

}  // namespace

std::optional<std::array<double, 3>> parse_offset(std::string_view text) {
  std::array<double, 3> offset{};
  for (double& value : offset) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto number = parse_number(text.substr(0, comma));
    if (!number) return std::nullopt;
    value = *number;
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return text.empty() ? std::optional(offset) : std::nullopt;
}

AdjustzCommandLine parse_adjustz_options(const std::vector<std::string>& words) {
  AdjustzCommandLine out;
  SlashArguments arguments(words, kOptions, codes::adjustz_option, {".dxf", ".txt", ".gcode"}, out.problems);
  out.language = arguments.use_language();
  while (const auto argument = arguments.next()) {
    if (argument->option == nullptr) {
      out.files.push_back(argument->value);
      continue;
    }
    const std::string_view name = argument->option->name;
    const std::string& value = argument->value;
    if (name == "help") out.help = true;
    if (name == "max-correction")
      if (const auto n = arguments.positive(value, name)) out.max_correction = mm(*n);
    if (name == "show-lines") out.shown_lines = value;
    if (name == "measured") out.measured = value;
    if (name == "work-offset" && !(out.work_offset = parse_offset(value))) arguments.complain(kOffset);
  }
  if (!(out.max_correction > Length())) arguments.complain(kRequired);
  return out;
}

std::vector<OptionDescription> adjustz_option_descriptions() { return option_descriptions(kOptions); }

std::string adjustz_usage(Language language) {
  return (language == Language::german ? "Aufruf: kerf adjustz [Optionen] Dateien\n\nOptionen:\n"
                                       : "Usage: kerf adjustz [options] files\n\nOptions:\n") +
         option_table(kOptions, language);
}

}  // namespace kerf::app

// The options of `kerf pathdxf`.
#include "app/options/pathdxf_options.h"

#include <fmt/format.h>
#include <functional>
#include <optional>
#include <string_view>

#include "app/options/slash_options.h"
#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf::app {
namespace {

constexpr SlashOption kOptions[] = {
    {'h', "help", false, "This text", "Dieser Text"},
    {'f', "feed", true, "Milling speed in mm/min for paths without F",
     "Fräsgeschwindigkeit in mm/min für Pfade ohne F", true, true},
    {'z', "probe-feed", true, "Probing speed in mm/min; default: /f",
     "Messgeschwindigkeit in mm/min; Standard: /f"},
    {'v', "rapid-speed", true, "Speed of rapids (sweeps) in mm/min, for the statistics",
     "Geschwindigkeit der Leerfahrten in mm/min, für die Statistik", true},
    {'s', "rapid-height", true, "Height of rapids in mm for paths without S",
     "Sweephöhe in mm für Pfade ohne S", true, true},
    {'o', "rapid-height", true, {}, {}},
    {'c', "check", false, "Check all paths of the DXF files, write nothing",
     "Alle Pfade der DXF-Dateien prüfen, nichts schreiben"},
    {'x', "show-texts", true, "Report the elements of texts that match this expression",
     "Elemente zu Texten ausgeben, die diesem Ausdruck entsprechen"},
    {'d', "folder", true, "Search this folder for sub-paths too; may be repeated",
     "Unterpfade auch in diesem Verzeichnis suchen; mehrfach möglich"},
    {'n', "path-names", true, "Expression for path names; default ([0-9]{4})[.]([0-9]+)([A-Z])",
     "Ausdruck für Pfadnamen; Standard ([0-9]{4})[.]([0-9]+)([A-Z])", false, true},
    {'p', "file-patterns", true, "Expression for patterns in file names; default ([0-9]{4})(?:[.]([0-9]+))?",
     "Ausdruck für Muster in Dateinamen; Standard ([0-9]{4})(?:[.]([0-9]+))?", false, true},
    {'e', "restrict", true, "PARENT:CHILD: paths that match PARENT may embed those that match CHILD only",
     "PFAD:UNTERPFAD: passende Pfade dürfen nur passende Unterpfade einbetten", false, true},
    {'\0', "define", true, "X=VALUE: value of a variable of the path itself; may be repeated",
     "X=WERT: Wert einer Variablen des Pfades selbst; mehrfach möglich"},
    {'l', "language", true, "en or de; default: the system's", "en oder de; Standard: die des Systems"},
    {'\0', "probe", true, "g38.2 or g38.3 (default): whether a probe without contact is an error",
     "g38.2 oder g38.3 (Standard): ob eine Messung ohne Kontakt ein Fehler ist"},
    {'\0', "svg", true,
     "Write a sheet for the workshop to this SVG file: true size, order, depths, probes, faults",
     "Werkstattblatt in diese SVG-Datei: Originalgröße, Reihenfolge, Tiefen, Z-Probes, Fehlerstellen"},
    {'\0', "output", true, "Write the program, if it is the only file, to this file; - is standard output",
     "Das Programm, wenn es die einzige Datei ist, in diese Datei schreiben; - ist die Standardausgabe"},
    {'\0', "explain", false, "Print hints and notes with the messages", "Hinweise zu den Meldungen ausgeben"},
};

constexpr Bilingual kProbe{"--probe takes g38.2 or g38.3", "--probe ist g38.2 oder g38.3"};
constexpr Bilingual kRequired{"{} missing or not > 0", "{} fehlt oder ist nicht > 0"};
constexpr Bilingual kOneDash{"standard output takes one output", "Die Standardausgabe ist für eine Ausgabe"};
constexpr Bilingual kOneDrawing{"{} takes one drawing", "{} ist für eine einzige Zeichnung"};

/// Reads the value of an option as a number above 0; nothing where it is none.
using ReadNumber = std::function<std::optional<double>(std::string_view name, const std::string& value)>;

/// The options that change what is milled.
void apply_to_drawing(std::string_view name, const std::string& value, const ReadNumber& number,
                      PathDrawingOptions& out) {
  const auto feed = [&](std::optional<Feed>& target) {
    if (const auto n = number(name, value)) target = mm_per_min(*n);
  };
  if (name == "feed") feed(out.feed);
  if (name == "probe-feed") feed(out.probe_feed);
  if (name == "rapid-speed") feed(out.rapid_speed);
  if (name == "rapid-height")
    if (const auto n = number(name, value)) out.rapid_height = mm(*n);
  if (name == "path-names") out.path_names = value;
  if (name == "file-patterns") out.file_patterns = value;
  if (name == "define") out.variables.push_back(value);
  if (name == "restrict") out.restrictions.push_back(value);
}

void apply(std::string_view name, const std::string& value, SlashArguments& arguments,
           PathdxfCommandLine& out) {
  PathdxfOptions& run = out.run;
  apply_to_drawing(
      name, value,
      [&](std::string_view option, const std::string& text) { return arguments.positive(text, option); },
      run);
  if (name == "help") out.help = true;
  if (name == "explain") out.explain = true;
  if (name == "svg") out.sheet = value;
  if (name == "output") out.output = value;
  if (name == "check") run.selection = PathdxfSelection::check_all;
  if (name == "show-texts") run.shown_texts = value;
  if (name == "folder") run.folders.push_back(value);
  if (name == "probe") {
    run.probe = value == "g38.2" ? ProbeKind::contact_or_error : ProbeKind::contact;
    if (value != "g38.2" && value != "g38.3") arguments.complain(kProbe);
  }
}

}  // namespace

PathdxfCommandLine parse_pathdxf_options(const std::vector<std::string>& words) {
  PathdxfCommandLine out;
  out.run.comments = PathdxfComments::trace;
  SlashArguments arguments(words, kOptions, codes::pathdxf_option, {".dxf"}, out.problems);
  out.run.language = arguments.use_language();
  while (const auto argument = arguments.next()) {
    if (argument->option == nullptr)
      out.files.push_back(argument->value);
    else
      apply(argument->option->name, argument->value, arguments, out);
  }
  if (!out.run.feed) arguments.complain(kRequired, "/f");
  if (!out.run.rapid_speed) arguments.complain(kRequired, "/v");
  if (!out.run.rapid_height) arguments.complain(kRequired, "/s");
  if (out.sheet == "-" && out.output == "-") arguments.complain(kOneDash);
  if (out.files.size() < 2) return out;
  if (!out.sheet.empty()) arguments.complain(kOneDrawing, "--svg");
  if (!out.output.empty()) arguments.complain(kOneDrawing, "--output");
  return out;
}

void add_drawing_options(CommandParser& parser, PathDrawingOptions& out) {
  for (const SlashOption& option : kOptions) {
    const std::string name = fmt::format("--{}", option.name);
    // A command's own option of that name has precedence, such as the feed of probing.
    if (!option.reads || parser.find_option(name)) continue;
    const auto read = [&out, name, key = option.name](const std::string& value) {
      std::string problem;
      const auto number = [&](std::string_view, const std::string& text) {
        const auto n = comma_number(text);
        if (!n || !(*n > 0.0)) problem = fmt::format("\"{}\" is not a number above 0", clipped(text));
        return n;
      };
      apply_to_drawing(key, value, number, out);
      out.given.push_back(name);
      return problem;
    };
    parser.add_parsed(name, read, fmt::format("Path drawings: {}", option.english)).value_name("VALUE");
  }
}

std::vector<OptionDescription> pathdxf_option_descriptions() { return option_descriptions(kOptions); }

std::string pathdxf_usage(Language language) {
  return (language == Language::german ? "Aufruf: kerf pathdxf [Optionen] DXF-Dateien\n\nOptionen:\n"
                                       : "Usage: kerf pathdxf [options] DXF files\n\nOptions:\n") +
         option_table(kOptions, language);
}

}  // namespace kerf::app

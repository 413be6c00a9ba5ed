// The options of `kerf pathdxf`.
#include "app/options/pathdxf_options.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <system_error>

#include "kerf/number.h"

namespace kerf::app {
namespace {

struct Option {
  char letter;  // '\0': none
  std::string_view name;
  bool takes_value;
  std::string_view english, german;
};

constexpr Option kOptions[] = {
    {'h', "help", false, "This text", "Dieser Text"},
    {'f', "feed", true, "Milling speed in mm/min; required", "Fräsgeschwindigkeit in mm/min; notwendig"},
    {'z', "probe-feed", true, "Probing speed in mm/min; default: /f",
     "Messgeschwindigkeit in mm/min; Standard: /f"},
    {'v', "rapid-speed", true, "Speed of rapids (sweeps) in mm/min, for the statistics; required",
     "Geschwindigkeit der Leerfahrten in mm/min, für die Statistik; notwendig"},
    {'s', "rapid-height", true, "Height of rapids in mm for paths without S; required (also /o)",
     "Sweephöhe in mm für Pfade ohne S; notwendig (auch /o)"},
    {'c', "check", false, "Check all paths of the DXF files, write nothing",
     "Alle Pfade der DXF-Dateien prüfen, nichts schreiben"},
    {'x', "show-texts", true, "Report the elements of texts that match this expression",
     "Elemente zu Texten ausgeben, die diesem Ausdruck entsprechen"},
    {'d', "folder", true, "Search this folder for sub-paths too; may be repeated",
     "Unterpfade auch in diesem Verzeichnis suchen; mehrfach möglich"},
    {'n', "path-names", true, "Expression for path names; default ([0-9]{4})[.]([0-9]+)([A-Z])",
     "Ausdruck für Pfadnamen; Standard ([0-9]{4})[.]([0-9]+)([A-Z])"},
    {'p', "file-patterns", true, "Expression for patterns in file names; default ([0-9]{4})(?:[.]([0-9]+))?",
     "Ausdruck für Muster in Dateinamen; Standard ([0-9]{4})(?:[.]([0-9]+))?"},
    {'l', "language", true, "en or de; default: the system's", "en oder de; Standard: die des Systems"},
    {'\0', "probe", true, "g38.2 or g38.3 (default): whether a probe without contact is an error",
     "g38.2 oder g38.3 (Standard): ob eine Messung ohne Kontakt ein Fehler ist"},
    {'\0', "explain", false, "Print hints and notes with the messages", "Hinweise zu den Meldungen ausgeben"},
};

constexpr std::string_view kDxf = ".dxf";

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool ends_in_dxf(std::string_view text) {
  if (text.size() < kDxf.size()) return false;
  const std::string_view end = text.substr(text.size() - kDxf.size());
  return std::equal(end.begin(), end.end(), kDxf.begin(), [](char a, char b) { return lower(a) == b; });
}

/// Whether an argument that starts with a slash is an absolute path: of a file that exists, or one of a DXF
/// file in a folder.
bool is_absolute_file(const std::string& argument) {
  std::error_code error;
  if (std::filesystem::is_regular_file(argument, error) ||
      std::filesystem::is_regular_file(argument + std::string(kDxf), error))
    return true;
  const std::size_t slash = argument.rfind('/');
  return slash > 0 && ends_in_dxf(argument) &&
         std::filesystem::is_directory(argument.substr(0, slash), error);
}

class Parser {
 public:
  explicit Parser(const std::vector<std::string>& arguments) : arguments_(arguments) {
    out_.run.comments = PathdxfComments::trace;
    out_.run.language = system_language();
  }

  PathdxfCommandLine parse() {
    for (; at_ < arguments_.size(); ++at_) take(arguments_[at_]);
    if (!out_.run.feed) complain("/f missing or not > 0");
    if (!out_.run.rapid_speed) complain("/v missing or not > 0");
    if (!out_.run.rapid_height) complain("/s missing or not > 0");
    return std::move(out_);
  }

 private:
  static PathdxfLanguage system_language() {
    for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"})
      if (const char* value = std::getenv(name); value != nullptr && *value != '\0')
        return language_of(value);
    return PathdxfLanguage::english;
  }
  static PathdxfLanguage language_of(std::string_view text) {
    const bool german = text.size() >= 2 && lower(text[0]) == 'd' && lower(text[1]) == 'e';
    return german ? PathdxfLanguage::german : PathdxfLanguage::english;
  }

  void complain(std::string message) { out_.problems.error(Code::pathdxf_option, {}, std::move(message)); }

  void take(const std::string& argument) {
    if (argument.empty()) return;
    const bool slash = argument[0] == '/';
    if ((!slash && argument[0] != '-') || (slash && is_absolute_file(argument))) {
      out_.files.push_back(argument);
      return;
    }
    if (argument.size() == 1) return complain("Missing value after option " + argument);
    if (argument.substr(0, 2) == "--") return take_long(argument.substr(2));
    const char letter = lower(argument[1]) == 'o' ? 's' : lower(argument[1]);
    if (letter == '?') {
      out_.help = true;
      return;
    }
    for (const Option& option : kOptions) {
      if (option.letter != letter) continue;
      std::optional<std::string> value;
      if (option.takes_value && !(value = value_of(argument.substr(2), argument.substr(0, 2)))) return;
      return apply(option, value.value_or(""));
    }
    complain(fmt::format("Option {} not supported", argument.substr(0, 2)));
  }

  void take_long(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    for (const Option& option : kOptions) {
      if (option.name != name) continue;
      std::optional<std::string> value;
      const std::string attached = equals == std::string::npos ? "" : text.substr(equals + 1);
      if (option.takes_value && !(value = value_of(attached, "--" + name))) return;
      return apply(option, value.value_or(""));
    }
    complain(fmt::format("Option --{} not supported", name));
    std::vector<std::string> names;
    for (const Option& option : kOptions) names.emplace_back(option.name);
    if (const auto close = did_you_mean(name, names)) complain(fmt::format("did you mean --{}?", *close));
  }

  /// The rest of the word, or else the next word.
  std::optional<std::string> value_of(const std::string& attached, const std::string& option) {
    if (!attached.empty()) return attached;
    if (at_ + 1 < arguments_.size()) return arguments_[++at_];
    complain(fmt::format("Missing value for option {}", option));
    return std::nullopt;
  }

  std::optional<double> number(const std::string& value, std::string_view name) {
    std::string text = value;
    std::replace(text.begin(), text.end(), ',', '.');
    const auto number = parse_number(text);
    if (!number) complain(fmt::format("Option value {} for --{} is not a number", value, name));
    if (number && *number < 0.0) complain(fmt::format("Option value {} for --{} is not >= 0", value, name));
    return number && *number > 0.0 ? number : std::nullopt;
  }

  void apply(const Option& option, const std::string& value) {
    PathdxfOptions& run = out_.run;
    const std::string_view name = option.name;
    const auto feed = [&](std::optional<Feed>& target) {
      if (const auto n = number(value, name)) target = mm_per_min(*n);
    };
    if (name == "help") out_.help = true;
    if (name == "explain") out_.explain = true;
    if (name == "feed") feed(run.feed);
    if (name == "probe-feed") feed(run.probe_feed);
    if (name == "rapid-speed") feed(run.rapid_speed);
    if (name == "rapid-height")
      if (const auto n = number(value, name)) run.rapid_height = mm(*n);
    if (name == "check") run.selection = PathdxfSelection::check_all;
    if (name == "show-texts") run.shown_texts = value;
    if (name == "folder") run.folders.push_back(value);
    if (name == "path-names") run.path_names = value;
    if (name == "file-patterns") run.file_patterns = value;
    if (name == "language") run.language = language_of(value);
    if (name == "probe") {
      run.probe = value == "g38.2" ? ProbeKind::contact_or_error : ProbeKind::contact;
      if (value != "g38.2" && value != "g38.3") complain("--probe takes g38.2 or g38.3");
    }
  }

  const std::vector<std::string>& arguments_;
  std::size_t at_ = 0;
  PathdxfCommandLine out_;
};

}  // namespace

PathdxfCommandLine parse_pathdxf_options(const std::vector<std::string>& arguments) {
  return Parser(arguments).parse();
}

std::string pathdxf_usage(PathdxfLanguage language) {
  const bool german = language == PathdxfLanguage::german;
  std::string text = german ? "Aufruf: kerf pathdxf [Optionen] DXF-Dateien\n\nOptionen:\n"
                            : "Usage: kerf pathdxf [options] DXF files\n\nOptions:\n";
  for (const Option& o : kOptions) {
    const std::string_view value = o.takes_value ? " ..." : "";
    const std::string letter = o.letter == '\0' ? std::string() : fmt::format("/{}{}", o.letter, value);
    text += fmt::format("    {:<7} {:<20} {}\n", letter, fmt::format("--{}{}", o.name, value),
                        german ? o.german : o.english);
  }
  return text;
}

}  // namespace kerf::app

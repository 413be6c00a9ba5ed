// Files of printers and filaments: reading, writing, and the choice by name.
#include <cassert>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "base/utf8.h"
#include "embedded_printer_files.h"
#include "formats/printer_keys.h"
#include "path/printer_firmware.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

using detail::NumberKey;

constexpr std::size_t kMaxProfiles = 1000;

class PrinterReader {
 public:
  PrinterReader(std::string_view file_name, Diagnostics& diagnostics)
      : file_(file_name), diagnostics_(diagnostics) {}

  PrinterTable read(std::string_view text) {
    if (text.size() > limits::kMaxProfileBytes) {
      diagnostics_.error(codes::machine_value, TextLocation{file_, 0, 0},
                         "a printer file is limited to 1 MB");
      return {};
    }
    const toml::parse_result parsed = toml::parse(text, std::string_view(file_));
    if (!parsed) {
      diagnostics_.error(codes::machine_value, location(parsed.error().source()),
                         std::string(parsed.error().description()));
      return {};
    }
    PrinterTable table;
    for (const auto& [key, node] : parsed.table()) {
      const toml::array* list = node.as_array();
      if (key == "printer" && list != nullptr)
        entries(*list, table.printers);
      else if (key == "filament" && list != nullptr)
        entries(*list, table.filaments);
      else
        diagnostics_.error(codes::machine_key_unknown, location(key.source()),
                           "expected only [[printer]] and [[filament]] here");
    }
    return table;
  }

 private:
  Origin location(const toml::source_region& at) const {
    return TextLocation{file_, at.begin.line, at.begin.column};
  }
  void wrong(const toml::key& key, const toml::node& node, std::string_view expected) {
    diagnostics_.error(codes::machine_value, location(node.source()),
                       fmt::format("{} must be {}", key.str(), expected));
  }

  template <class Profile>
  void entries(const toml::array& list, std::vector<Profile>& target) {
    for (const toml::node& node : list) {
      const toml::table* table = node.as_table();
      if (table == nullptr || target.size() >= kMaxProfiles) {
        diagnostics_.error(codes::machine_value, location(node.source()),
                           fmt::format("expected a table, and at most {} of them", kMaxProfiles));
        return;
      }
      target.push_back(entry<Profile>(*table));
    }
  }

  template <class Profile>
  Profile entry(const toml::table& table) {
    Profile profile;
    for (const auto& [key, node] : table)
      if (!words(key, node, profile) && !numbers(key, node, profile)) unknown<Profile>(key);
    if (profile.name.empty())
      diagnostics_.error(codes::machine_value, location(table.source()), "the name is missing").hint =
          "name = \"my printer\"";
    return profile;
  }

  void text(const toml::key& key, const toml::node& node, std::string& target) {
    const auto value = node.value_exact<std::string>();
    if (!value || value->empty() || value->size() > limits::kMaxNameBytes ||
        value->find_first_of("\r\n") != std::string::npos)
      return wrong(key, node, "a text in quotes, in one line");
    target = *value;
  }
  void texts(const toml::key& key, const toml::node& node, std::vector<std::string>& target) {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() > limits::kMaxTemplateLines)
      return wrong(key, node, "a list of texts");
    for (const toml::node& entry : *list) {
      const auto value = entry.value_exact<std::string>();
      if (!value || value->find_first_of("\r\n") != std::string::npos)
        return wrong(key, entry, "a list of texts, each in one line");
      target.push_back(*value);
    }
  }

  bool words(const toml::key& key, const toml::node& node, FilamentProfile& profile) {
    if (key == "name") return text(key, node, profile.name), true;
    if (key == "names") return texts(key, node, profile.names), true;
    return false;
  }
  bool words(const toml::key& key, const toml::node& node, PrinterProfile& profile) {
    if (key == "name") return text(key, node, profile.name), true;
    if (key == "names") return texts(key, node, profile.names), true;
    if (key == "start") return texts(key, node, profile.start), true;
    if (key == "end") return texts(key, node, profile.end), true;
    if (key != "firmware") return false;
    const auto value = node.value_exact<std::string>();
    std::vector<std::string_view> names;
    for (const PrinterFirmware& firmware : printer_firmwares()) names.push_back(firmware.name);
    if (value && std::find(names.begin(), names.end(), *value) != names.end())
      profile.firmware = *value;
    else
      wrong(key, node, "one of: " + joined(names, ", "));
    return true;
  }

  static const auto& keys_of(const PrinterProfile&) { return detail::printer_numbers(); }
  static const auto& keys_of(const FilamentProfile&) { return detail::filament_numbers(); }

  template <class Profile>
  bool numbers(const toml::key& key, const toml::node& node, Profile& profile) {
    for (const NumberKey<Profile>& known : keys_of(profile)) {
      if (known.name != key.str()) continue;
      double values[4] = {};
      if (read_numbers(node, known, values))
        known.set(profile, values);
      else
        wrong(key, node,
              fmt::format("{} from {} to {} ({})",
                          known.count == 1 ? std::string("a number") : fmt::format("{} numbers", known.count),
                          number_text(known.low, 6), number_text(known.high, 6), known.unit));
      return true;
    }
    return false;
  }
  template <class Profile>
  static bool read_numbers(const toml::node& node, const NumberKey<Profile>& key, double* values) {
    const toml::array* list = node.as_array();
    if (key.count == 1 ? list != nullptr : list == nullptr || list->size() != key.count) return false;
    for (std::size_t i = 0; i < key.count; ++i) {
      const toml::node& value = list != nullptr ? *list->get(i) : node;
      if (!value.is_number()) return false;
      values[i] = value.value<double>().value_or(NAN);
      if (!(values[i] >= key.low && values[i] <= key.high)) return false;
    }
    return true;
  }

  template <class Profile>
  void unknown(const toml::key& key) {
    std::vector<std::string> known{"name", "names"};
    if constexpr (std::is_same_v<Profile, PrinterProfile>)
      known.insert(known.end(), {"firmware", "start", "end"});
    for (const auto& number : keys_of(Profile{})) known.emplace_back(number.name);
    diagnostics_
        .error(codes::machine_key_unknown, location(key.source()),
               fmt::format("unknown key \"{}\"", key.str().substr(0, 40)))
        .hint = "keys: " + joined(known, ", ");
  }

  std::string file_;
  Diagnostics& diagnostics_;
};

template <class Profile>
const Profile* find(std::string_view name, const std::vector<Profile>& list) {
  const std::string asked = fold_name(name);
  for (const Profile& profile : list) {
    if (fold_name(profile.name) == asked) return &profile;
    for (const std::string& other : profile.names)
      if (fold_name(other) == asked) return &profile;
  }
  return nullptr;
}

/// From the table of a file, else from the built-in one. An unknown name is an error.
template <class Profile>
const Profile* find(std::string_view name, const char* what, const std::vector<Profile>& given,
                    const std::vector<Profile>& built_in, Diagnostics& diagnostics) {
  if (const Profile* found = find(name, given)) return found;
  if (const Profile* found = find(name, built_in)) return found;
  std::vector<std::string> known;
  for (const auto* list : {&given, &built_in})
    for (const Profile& profile : *list) known.push_back(profile.name);
  diagnostics
      .error(codes::machine_value, CallLocation{"", 0, "--printer"},
             fmt::format("unknown {} \"{}\"{}", what, name.substr(0, 40), guess_at_end(name, known)))
      .hint = "known: " + list_text(known) + ", and those of files (.toml)";
  return nullptr;
}

/// A text in quotes of TOML.
std::string in_quotes(std::string_view text) {
  std::string made = "\"";
  for (const char32_t c : from_utf8(text)) {
    const bool scalar = c < 0xD800 || (c > 0xDFFF && c <= 0x10FFFF);
    if (c == '"' || c == '\\')
      made += '\\', made += static_cast<char>(c);
    else if (c >= 0x20 && c < 0x7f)
      made += static_cast<char>(c);
    else
      made += fmt::format("\\U{:08X}", scalar ? static_cast<std::uint32_t>(c) : 0xFFFDu);
  }
  return made + '"';
}

std::string lines_text(const char* key, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = fmt::format("{} = [\n", key);
  for (const std::string& line : lines) text += "  " + in_quotes(line) + ",\n";
  return text + "]\n";
}

template <class Profile>
std::string numbers_text(const Profile& profile, const std::vector<NumberKey<Profile>>& keys) {
  std::string text;
  for (const NumberKey<Profile>& key : keys) {
    const std::vector<double> values = key.get(profile);
    if (values.empty()) continue;
    std::string numbers;
    for (const double v : values) numbers += (numbers.empty() ? "" : ", ") + number_text(v, 6);
    const std::string line = fmt::format("{} = {}", key.name, key.count > 1 ? "[" + numbers + "]" : numbers);
    text += fmt::format("{:<45} # {}\n", line, key.unit);
  }
  return text;
}

}  // namespace

PrinterTable read_printer_file(std::string_view text, std::string_view file_name, Diagnostics& diagnostics) {
  return PrinterReader(file_name, diagnostics).read(text);
}

const PrinterTable& built_in_printers() {
  static const PrinterTable all = [] {
    Diagnostics diagnostics;
    PrinterTable read =
        read_printer_file(embedded::printer_files[0].bytes, "data/printers.toml", diagnostics);
    assert(diagnostics.list().empty());  // a test reports the fault
    return read;
  }();
  return all;
}

std::optional<PrinterChoice> printer_named(std::string_view name, const PrinterTable& table,
                                           Diagnostics& diagnostics) {
  const std::size_t colon = std::min(name.find(':'), name.size());
  const std::string_view printer = name.substr(0, colon),
                         filament = name.substr(std::min(colon + 1, name.size()));
  const PrinterTable& built_in = built_in_printers();
  PrinterChoice choice;
  if (printer.empty() && table.printers.empty()) {
    diagnostics.error(codes::machine_value, CallLocation{"", 0, "--printer"}, "the file has no [[printer]]");
    return std::nullopt;
  }
  const PrinterProfile* found =
      printer.empty() ? &table.printers.front()
                      : find(printer, "printer", table.printers, built_in.printers, diagnostics);
  if (found == nullptr) return std::nullopt;
  choice.printer = *found;
  if (!filament.empty()) {
    const FilamentProfile* wanted =
        find(filament, "filament", table.filaments, built_in.filaments, diagnostics);
    if (wanted == nullptr) return std::nullopt;
    choice.filament = *wanted;
  } else if (table.filaments.size() == 1) {
    choice.filament = table.filaments.front();
  }
  return choice;
}

PrinterLimits limits_of(const PrinterChoice& choice) {
  PrinterLimits made;
  made.bed = choice.printer.bed;
  if (choice.filament.min_nozzle > 0.0) made.min_celsius = choice.filament.min_nozzle;
  for (const VolumeFlow flow : {choice.printer.max_flow, choice.filament.max_flow})
    if (flow > VolumeFlow{})
      made.max_flow = made.max_flow > VolumeFlow{} ? std::min(made.max_flow, flow) : flow;
  return made;
}

std::string write_printer_file(const PrinterChoice& choice) {
  const PrinterProfile& printer = choice.printer;
  std::string text =
      "# A printer and its filament, for kerf check, info and post --printer.\n\n[[printer]]\n";
  text += fmt::format("name = {}\nfirmware = {}\n", in_quotes(printer.name), in_quotes(printer.firmware));
  text += numbers_text(printer, detail::printer_numbers());
  text += lines_text("start", printer.start) + lines_text("end", printer.end);
  if (choice.filament.name.empty()) return text;
  text += fmt::format("\n[[filament]]\nname = {}\n", in_quotes(choice.filament.name));
  return text + numbers_text(choice.filament, detail::filament_numbers());
}

std::string post_of(const PrinterChoice& choice) {
  const PrinterProfile& printer = choice.printer;
  const FilamentProfile& filament = choice.filament;
  std::string text =
      fmt::format("base = {}\nname = {}\n", in_quotes(printer.firmware), in_quotes(printer.name));
  const Length diameter = filament.diameter > Length{} ? filament.diameter : printer.filament;
  if (diameter > Length{}) text += fmt::format("[printer]\nfilament = {}\n", number_text(diameter.mm(), 6));
  text += "[variables]\n";
  const double nozzle = filament.first_nozzle > 0.0 ? filament.first_nozzle : filament.nozzle;
  const double bed = filament.first_bed > 0.0 ? filament.first_bed : filament.bed;
  if (nozzle > 0.0) text += fmt::format("nozzle = {}\n", number_text(nozzle, 3));
  if (bed > 0.0) text += fmt::format("bed = {}\n", number_text(bed, 3));
  if (printer.start.empty() && printer.end.empty()) return text;
  std::vector<std::string> header = printer.start;
  // Whatever modes the printer's own lines leave.
  if (!header.empty()) header.insert(header.end(), {"{units}", "G90", "{extruder}", "{extruder_zero}"});
  return text + "[templates]\n" + lines_text("header", header) + lines_text("footer", printer.end);
}

}  // namespace kerf

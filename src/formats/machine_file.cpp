// Machine files: detects their kind, and reads Kerf's TOML profiles.
#include <cmath>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "embedded_machine_files.h"
#include "formats/machine_settings.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

class ProfileReader {
 public:
  ProfileReader(std::string_view file_name, Diagnostics& diagnostics)
      : file_(file_name), diagnostics_(diagnostics) {}

  void read(const toml::table& root, Machine& machine) {
    for (const auto& [key, node] : root) {
      if (!read_word(key.str(), node, machine) && !read_numbers(key.str(), node, machine)) unknown(key);
    }
  }

 private:
  Origin location(const toml::source_position& at) const { return TextLocation{file_, at.line, at.column}; }

  void wrong(std::string_view key, const toml::node& node, std::string_view expected) {
    diagnostics_.error(codes::machine_value, location(node.source().begin),
                       fmt::format("{} must be {}", key, expected));
  }

  void unknown(const toml::key& key) {
    std::vector<std::string> known{"name", "controller", "laser", "rapids"};
    for (const detail::MachineSetting& setting : detail::machine_settings()) known.emplace_back(setting.name);
    Diagnostic& error =
        diagnostics_.error(codes::machine_key_unknown, location(key.source().begin),
                           fmt::format("unknown key \"{}\" of a machine", key.str().substr(0, 40)));
    error.hint = guess(key.str(), known, "the keys are listed in docs/manual/machine.md");
  }

  bool read_word(std::string_view key, const toml::node& node, Machine& machine) {
    if (key != "name" && key != "controller" && key != "laser" && key != "rapids") return false;
    const auto text = node.value_exact<std::string>();
    if (key == "name") {
      if (text) machine.name = *text;
      if (!text) wrong(key, node, "a text in quotes");
    } else if (key == "controller") {
      machine.controller = text == "other" ? Controller::other : Controller::grbl;
      if (text != "other" && text != "grbl") wrong(key, node, "\"grbl\" or \"other\"");
    } else if (key == "rapids") {
      machine.rapids_by_axis = text == "by-axis";
      if (text != "straight" && text != "by-axis") wrong(key, node, "\"straight\" or \"by-axis\"");
    } else {
      machine.laser = text == "follows" ? LaserDrive::follows : LaserDrive::stops;
      if (text != "follows" && text != "stops") wrong(key, node, "\"stops\" or \"follows\"");
    }
    return true;
  }

  bool read_numbers(std::string_view key, const toml::node& node, Machine& machine) {
    for (const detail::MachineSetting& setting : detail::machine_settings()) {
      if (setting.name != key) continue;
      double values[3] = {0.0, 0.0, 0.0};
      if (numbers_of(node, setting, values))
        setting.set(machine, values);
      else
        wrong(
            key, node,
            fmt::format("{} from {} to {}: {}",
                        setting.count == 1 ? "a number" : fmt::format("a list of {} numbers", setting.count),
                        number_text(setting.low, 5), number_text(setting.high, 5), setting.meaning));
      return true;
    }
    return false;
  }

  static bool number_of(const toml::node& node, const detail::MachineSetting& setting, double& value) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number) || *number < setting.low || *number > setting.high) return false;
    value = *number;
    return true;
  }

  static bool numbers_of(const toml::node& node, const detail::MachineSetting& setting, double* values) {
    if (setting.count == 1) return number_of(node, setting, values[0]);
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != setting.count) return false;
    for (std::size_t i = 0; i < setting.count; ++i) {
      if (!number_of(*list->get(i), setting, values[i])) return false;
    }
    return true;
  }

  std::string file_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics) {
  const std::string name(file_name);
  if (text.size() > limits::kMaxProfileBytes) {
    diagnostics.error(codes::machine_file, TextLocation{name, 0, 0}, "a machine file is limited to 1 MB");
    return std::nullopt;
  }
  if (detail::has_grbl_settings(text)) return detail::read_grbl_settings(text, file_name, diagnostics);
  const toml::parse_result result = toml::parse(text, name);
  constexpr std::string_view kHint =
      "expected a profile (docs/manual/machine.md), or GRBL's $$ output ($110=3000 etc.), as text or JSON";
  if (!result) {
    const auto& at = result.error().source().begin;
    diagnostics
        .error(codes::machine_file, TextLocation{name, at.line, at.column},
               std::string(result.error().description()))
        .hint = kHint;
    return std::nullopt;
  }
  if (result.table().empty()) {
    diagnostics.error(codes::machine_file, TextLocation{name, 0, 0}, "the file contains no machine setting")
        .hint = kHint;
    return std::nullopt;
  }
  const std::size_t errors = diagnostics.errors();
  Machine machine;
  machine.controller = Controller::other;
  ProfileReader(file_name, diagnostics).read(result.table(), machine);
  return diagnostics.errors() == errors ? std::optional(machine) : std::nullopt;
}

std::vector<std::string> built_in_machine_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < embedded::machine_files_count; ++i)
    names.push_back(stem_of(embedded::machine_files[i].name));
  return names;
}

std::optional<Machine> load_machine(const std::string& file_or_name, Diagnostics& diagnostics) {
  if (file_or_name == "-" || exists(file_or_name)) {
    const auto file = InputFile::open(file_or_name, diagnostics);
    return file ? read_machine_file(file->bytes(), file_or_name, diagnostics) : std::nullopt;
  }
  const std::vector<std::string> names = built_in_machine_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == file_or_name)
      return read_machine_file(embedded::machine_files[i].bytes, file_or_name, diagnostics);
  diagnostics
      .error(codes::file_unreadable, TextLocation{file_or_name, 0, 0},
             "no such file, and no built-in machine of this name" + guess_at_end(file_or_name, names))
      .hint = "built-in machines: " + joined(names, ", ");
  return std::nullopt;
}

}  // namespace kerf

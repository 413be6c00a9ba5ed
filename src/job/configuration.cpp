// Reads kerf.toml and the user's config.toml.
#include "job/configuration.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

#include "base/codes/files.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/guess.h"
#include "base/number.h"
#include "base/toml.h"
#include "job/load_material.h"
#include "job/named.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

namespace kerf {
namespace {

using Form = ConfigKey::Form;
constexpr const char* kFileName = "kerf.toml";
constexpr std::string_view kFolders = "folders";
constexpr const char* kEnding = ".toml";
constexpr int kMaxFoldersAbove = 100;

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

/// The user's file: in $XDG_CONFIG_HOME, ~/.config, or %APPDATA%; empty if there is none of them.
std::string user_file() {
  std::string folder = variable("XDG_CONFIG_HOME");
  if (folder.empty()) folder = variable("APPDATA");
  if (folder.empty() && !variable("HOME").empty()) folder = path_in(variable("HOME"), ".config");
  return folder.empty() ? std::string() : path_in(path_in(folder, "kerf"), "config.toml");
}

/// "~" and "~/shop" as paths in the home folder.
std::string in_home(const std::string& path) {
  const bool has_tilde = path == "~" || path.starts_with("~/") || path.starts_with("~\\");
  const std::string home = variable("HOME").empty() ? variable("USERPROFILE") : variable("HOME");
  if (!has_tilde || home.empty()) return path;
  return path.size() <= 2 ? home : path_in(home, path.substr(2));
}

/// kerf.toml in the folder, or in the nearest one above it.
std::optional<std::string> work_file(const std::string& folder) {
  std::string at = normal_path(absolute_path(folder.empty() ? "." : folder));
  for (int n = 0; n < kMaxFoldersAbove; ++n) {
    const std::string file = path_in(at, kFileName);
    if (is_regular_file(file)) return file;
    const std::string above = parent_of(at);
    if (above.empty() || above == at) break;
    at = above;
  }
  const std::string root = std::string("/") + kFileName;
  return is_regular_file(root) ? std::optional(root) : std::nullopt;
}

}  // namespace

/// Reads one file after the other; a value that an earlier file has is not replaced.
class ConfigReader {
 public:
  ConfigReader(Configuration& out, Diagnostics& diagnostics) : out_(out), diagnostics_(diagnostics) {}

  void read(const std::string& file) {
    const auto input = InputFile::open(file, diagnostics_, limits::kMaxProfileBytes);
    if (!input) return;
    file_ = file;
    out_.files_.push_back(file);
    const toml::parse_result parsed = toml::parse(input->bytes(), file);
    if (!parsed) {
      const auto& at = parsed.error().source().begin;
      diagnostics_.error(codes::config_file, TextLocation{file, at.line, at.column},
                         std::string(parsed.error().description()));
      return;
    }
    read_table(parsed.table(), false);
  }

 private:
  void read_table(const toml::table& table, bool of_folders) {
    for (const auto& [key, node] : table) {
      if (!of_folders && key.str() == kFolders && node.is_table()) {
        read_table(*node.as_table(), true);
        continue;
      }
      const ConfigKey* const known = key_named(key.str(), of_folders);
      if (known == nullptr)
        report_unknown(key, of_folders);
      else if (auto texts = texts_of(*known, node); texts.empty())
        error(node.source().begin, fmt::format("{} must be {}", known->key, expected(known->form)));
      else if (out_.find(known->key) == nullptr)
        out_.values_.push_back({known->key, std::move(texts), file_, node.source().begin.line,
                                node.source().begin.column, of_folders});
    }
  }

  static const ConfigKey* key_named(std::string_view name, bool of_folders) {
    for (const ConfigKey& key : config_keys())
      if (key.key == name && (key.form == Form::folder) == of_folders) return &key;
    return nullptr;
  }

  void report_unknown(const toml::key& key, bool of_folders) {
    std::vector<std::string> names;
    for (const ConfigKey& known : config_keys())
      if ((known.form == Form::folder) == of_folders) names.emplace_back(known.key);
    if (!of_folders) names.emplace_back(kFolders);
    error(key.source().begin, fmt::format("unknown key \"{}\"", std::string(key.str().substr(0, 60)))).hint =
        guess(key.str(), names);
  }

  Diagnostic& error(const toml::source_position& at, std::string message) {
    return diagnostics_.error(codes::config_file, TextLocation{file_, at.line, at.column},
                              std::move(message));
  }

  static std::string_view expected(Form form) {
    switch (form) {
      case Form::files: return "a text, or a list of texts";
      case Form::number: return "a number, or a text with a unit";
      case Form::units: return "\"mm\" or \"inch\"";
      case Form::text:
      case Form::file:
      case Form::folder: break;
    }
    return "a text";
  }

  /// Files are seen from the folder of the configuration, if they are there. What follows the file in
  /// "shop.toml:birch" is kept.
  std::string seen_from_here(const std::string& text) const {
    const std::string name = in_home(text);
    const std::size_t end = end_of_material_file(name).value_or(name.size());
    const std::string beside = path_beside(file_, name.substr(0, end));
    return exists(beside) ? beside + name.substr(end) : name;
  }

  std::vector<std::string> texts_of(const ConfigKey& key, const toml::node& node) const {
    const auto text = node.value_exact<std::string>();
    switch (key.form) {
      case Form::number:
        if (const auto number = node.is_number() ? node.value<double>() : std::nullopt)
          return {exact_text(*number)};
        break;
      case Form::units:
        if (text && *text != "mm" && *text != "inch") return {};
        break;
      case Form::file:
        if (text && !text->empty()) return {seen_from_here(*text)};
        break;
      case Form::folder:
        if (text && !text->empty()) return {path_beside(file_, in_home(*text))};
        break;
      case Form::files: return files_of(node);
      case Form::text: break;
    }
    return text && !text->empty() ? std::vector<std::string>{*text} : std::vector<std::string>();
  }

  std::vector<std::string> files_of(const toml::node& node) const {
    if (const auto text = node.value_exact<std::string>(); text && !text->empty())
      return {seen_from_here(*text)};
    std::vector<std::string> files;
    const toml::array* const list = node.as_array();
    if (list == nullptr) return {};
    for (const toml::node& element : *list) {
      const auto text = element.value_exact<std::string>();
      if (!text) return {};
      files.push_back(seen_from_here(*text));
    }
    return files;
  }

  Configuration& out_;
  Diagnostics& diagnostics_;
  std::string file_;
};

const std::vector<ConfigKey>& config_keys() {
  static const std::vector<ConfigKey> keys{
      {"machine", "the machine: a file or a name", "--machine", Form::file},
      {"post", "the controller that programs are written for, where no option and no job names one", "",
       Form::file},
      {"units", "the unit of lengths in texts, and of programs that are written: mm or inch", "--inch",
       Form::units},
      {"tools", "tool files", "--tools", Form::files},
      {"material", "the material, for the chip load that is checked", "--material", Form::file},
      {"spoilboard", "thickness of the board below the stock that may be cut into", "--spoilboard",
       Form::number},
      {"resolution", "distance of the columns of simulations", "--resolution", Form::number},
      {"machines", "folder of machine files, which are then found by their names", "", Form::folder},
      {"posts", "folder of post files", "", Form::folder},
      {"printers", "folder of printer files: --printer mine:PLA", "", Form::folder},
      {"materials", "folder of material files: --material birch", "", Form::folder},
  };
  return keys;
}

Configuration Configuration::load(const std::string& folder, Diagnostics& diagnostics) {
  Configuration out;
  ConfigReader reader(out, diagnostics);
  const auto work = work_file(folder);
  if (work) reader.read(*work);
  if (const std::string user = user_file(); !user.empty() && is_regular_file(user)) reader.read(user);
  return out;
}

const ConfigValue* Configuration::find(std::string_view key) const {
  const auto found =
      std::find_if(values_.begin(), values_.end(), [&](const ConfigValue& v) { return v.key == key; });
  return found == values_.end() ? nullptr : &*found;
}

std::optional<std::string> Configuration::file_named(std::string_view key, const std::string& name) const {
  const ConfigValue* const folder = find(key);
  const std::size_t colon = std::min(name.find(':'), name.size());
  const std::string start = name.substr(0, colon);
  if (folder == nullptr || start.empty() || start != file_name_of(start) || !extension_of(start).empty())
    return std::nullopt;
  const std::string file = path_in(folder->texts.front(), start + kEnding);
  return is_regular_file(file) ? std::optional(file + name.substr(colon)) : std::nullopt;
}

std::vector<std::string> Configuration::files_in(std::string_view key) const {
  constexpr std::size_t kMaxFiles = 1000;
  std::vector<std::string> files;
  const ConfigValue* const folder = find(key);
  const auto names = folder == nullptr ? std::nullopt : names_in(folder->texts.front(), kMaxFiles);
  if (!names) return files;
  for (const std::string& name : *names)
    if (has_ending(name, kEnding)) files.push_back(path_in(folder->texts.front(), name));
  std::sort(files.begin(), files.end());
  return files;
}

Configuration configuration_unless_off(const std::string& folder, Diagnostics& diagnostics) {
  if (!variable("KERF_NO_CONFIG").empty()) return {};
  Configuration found = Configuration::load(folder, diagnostics);
  check_values(found, diagnostics);
  return found;
}

Configuration& used_configuration() {
  static Configuration of_process;
  return of_process;
}

}  // namespace kerf

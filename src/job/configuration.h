// What holds for a folder of work or for a user: the values of kerf.toml, for options that the command line
// does not give.
//
//   machine = "router.toml"      # beside kerf.toml, in a folder of [folders], or a built-in name
//   post = "grbl"
//   units = "inch"
//   tools = ["shop.toml"]
//
//   [folders]
//   machines = "machines"
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"

namespace kerf {

/// One value of a configuration, and where it is written.
struct ConfigValue {
  std::string_view key;
  std::vector<std::string> texts;  // as the option takes them; of `tools` one for each file
  std::string file;
  std::uint32_t line = 0, column = 0;
  bool is_folder = false;  // a key of [folders]
};

class Configuration {
 public:
  /// The files that apply to work in `folder`: kerf.toml there or in a folder above it, then config.toml of
  /// the user. Values of the first precede. Errors have file, line and column.
  static Configuration load(const std::string& folder, Diagnostics& diagnostics);

  const std::vector<ConfigValue>& values() const { return values_; }
  const ConfigValue* find(std::string_view key) const;
  /// "machines" and "router": the file router.toml in the folder of machines; nothing if there is none, or
  /// `name` has a folder or an ending. What follows a colon is kept: "mine:PLA" is "printers/mine.toml:PLA".
  std::optional<std::string> file_named(std::string_view key, const std::string& name) const;
  /// The .toml files in a folder of the configuration, by name.
  std::vector<std::string> files_in(std::string_view key) const;
  /// The files that were read.
  const std::vector<std::string>& files() const { return files_; }

 private:
  friend class ConfigReader;
  std::vector<ConfigValue> values_;
  std::vector<std::string> files_;
};

/// A key of a configuration file.
struct ConfigKey {
  std::string_view key, meaning;
  std::string_view option;  // that gets its value; empty: none
  enum class Form : std::uint8_t { text, file, files, number, units, folder } form = Form::text;
};
const std::vector<ConfigKey>& config_keys();

/// Of the work in `folder`, with an error for each value that cannot hold; empty where the variable
/// KERF_NO_CONFIG is set.
Configuration configuration_unless_off(const std::string& folder, Diagnostics& diagnostics);

/// The configuration of this process, in whose folders names are searched; empty but in a command, which sets
/// it once before its work.
Configuration& used_configuration();

}  // namespace kerf

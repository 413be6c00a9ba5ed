// kerf config: the values of the configuration files, and where each is written.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "base/names.h"
#include "job/configuration.h"
#include "job/record/configuration.h"
#include "job/record/record.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
};

Status run(Console& console) {
  const Configuration& all = used_configuration();
  if (console.json()) {
    console.print_json(text_of(record_of(all), Layout::indented));
    return Status::done;
  }
  for (const std::string& file : all.files()) console.print(fmt::format("file         {}\n", file));
  if (all.files().empty()) console.print("no kerf.toml here or above, and no config.toml of the user\n");
  for (const ConfigKey& key : config_keys())
    if (const ConfigValue* const value = all.find(key.key))
      console.print(fmt::format("{:<12} {}  ({}:{})\n", value->key, joined(value->texts, ", "), value->file,
                                value->line));
  return Status::done;
}

std::string help_text() {
  std::string text =
      "  kerf config                          what applies in this folder, and from which file\n\nKeys:\n";
  for (const ConfigKey& key : config_keys())
    text += fmt::format("  {:<12} {}{}\n", key.key,
                        key.form == ConfigKey::Form::folder ? "in [folders]: " : "", key.meaning);
  return text +
         "\nThe file kerf.toml beside the work, or in a folder above it, precedes config.toml in the folder "
         "kerf\n"
         "of $XDG_CONFIG_HOME (~/.config; %APPDATA% on Windows). An option precedes both; --no-config and "
         "the\n"
         "variable KERF_NO_CONFIG switch both off.\n";
}

}  // namespace

Command add_config(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "config", "Show the values of kerf.toml and of the user's config.toml", help_text(),
                  options->output);
  return {parser, &options->output, [options](Console& console) { return run(console); }};
}

}  // namespace kerf::app

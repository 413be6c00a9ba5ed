// The kerf command: selects and runs the subcommand, and returns its exit status.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/adjustz.h"
#include "app/commands/commands.h"
#include "app/commands/gcmc.h"
#include "app/commands/pathdxf.h"
#include "app/options/common.h"
#include "app/report/terminal_progress.h"
#include "app/version.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/system.h"
#include "job/configuration.h"
#include "job/record/record.h"

namespace kerf::app {
namespace {

const char* const kExamples = R"(
Examples:
  kerf simulate part.nc -o part.png    what a program cuts, as a picture
  kerf check part.nc                   its hazards; exit status 3 if there are any
  kerf info part.nc                    size, time, tools, feeds, stock
  kerf view part.nc                    the part in a browser, while the program is edited
  kerf post --to grbl part.ngc         the program for another controller
  kerf tools show 102                  a tool of the built-in table
  kerf help simulate                   the options of a command

Exit status: 0 success, warnings included; 1 errors in the input; 2 wrong usage; 3 hazards found by check.
)";

const char* const kToolsExamples = R"(
Examples:
  kerf tools list                      number, shape, dimensions and names of every tool
  kerf tools show 102                  one tool: its dimensions, its profile, a sketch
  kerf tools show "V d=12.7 angle=90"  a tool given as for --tool
  kerf tools shapes                    the shapes and keys of such a description
)";

std::vector<Command> add_commands(CommandParser& root) {
  std::vector<Command> commands{add_simulate(root), add_check(root),   add_compare(root), add_info(root),
                                add_steps(root),    add_outline(root), add_post(root),    add_run(root),
                                add_level(root),    add_cut(root),     add_view(root),    add_lsp(root),
                                add_config(root)};
  CommandParser tools = root.add_command("tools", "The tool table: list, show, shapes, import, export");
  tools.require_command();
  tools.set_footer(kToolsExamples);
  commands.push_back(add_tools_list(tools));
  commands.push_back(add_tools_show(tools));
  commands.push_back(add_tools_shapes(tools));
  commands.push_back(add_tools_import(tools));
  commands.push_back(add_tools_export(tools));
  CommandParser printer = root.add_command("printer", "Printers and filaments: list, import");
  printer.require_command();
  commands.push_back(add_printer_list(printer));
  commands.push_back(add_printer_import(printer));
  commands.push_back(add_completion(root));
  commands.push_back(add_man(root));
  root.add_command("gcmc", "Compile a gcmc program (has gcmc's options; see kerf gcmc --help)");
  root.add_command("pathdxf", "Compile path drawings (has PathDxf2GCode's options; see kerf pathdxf --help)");
  root.add_command(
      "adjustz",
      "Correct heights by measured values (has PathGCodeAdjustZ's options; see kerf adjustz --help)");
  return commands;
}

Status run_asked(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (!command.parser.is_given()) continue;
    catch_interrupts();
    Console console(*command.output);
    const Status status = command.run(console);
    if (console.finish()) return status;
    console.error("cannot write to standard output");
    return Status::input_errors;
  }
  return Status::wrong_usage;
}

/// Drop-in commands: they have the arguments of the program that they replace, which CommandLine cannot
/// parse. A link to kerf with that program's name runs the command.
struct DropIn {
  std::string_view command, program;
  int (*run)(const std::vector<std::string>& arguments, Progress* progress);
};
constexpr DropIn kDropIns[] = {{"gcmc", "gcmc", gcmc_command},
                               {"pathdxf", "PathDxf2GCode", pathdxf_command},
                               {"adjustz", "PathGCodeAdjustZ", adjustz_command}};

std::optional<int> run_drop_in(int argc, char** argv) {
  const std::string file = argc > 0 ? argv[0] : "";
  const std::string called = extension_of(file) == ".exe" ? stem_of(file) : file_name_of(file);
  for (const DropIn& drop_in : kDropIns) {
    const bool is_link = called == drop_in.program || called == drop_in.command;
    if (!is_link && (argc < 2 || std::string_view(argv[1]) != drop_in.command)) continue;
    catch_interrupts();
    InterruptOnly progress;
    return drop_in.run({argv + (is_link ? 1 : 2), argv + argc}, &progress);
  }
  return std::nullopt;
}

constexpr std::string_view kNoConfig = "--no-config";

constexpr std::string_view kColor = "--color";

/// Takes --color WHEN or --color=WHEN out of the words. Other words after it are left to the command:
/// --color is a name of --colour, too.
void take_color(std::vector<std::string>& words) {
  const std::string joined_form = std::string(kColor) + "=";
  for (auto word = words.begin(); word != words.end() && *word != "--"; ++word) {
    const bool is_joined = word->starts_with(joined_form);
    if (!is_joined && (*word != kColor || std::next(word) == words.end())) continue;
    if (!choose_colours(is_joined ? word->substr(joined_form.size()) : *std::next(word))) continue;
    words.erase(word, word + (is_joined ? 1 : 2));
    return;
  }
}

/// The folder of the work: that of the first word that names a file, else the current one.
std::string folder_of_work(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (!word.empty() && word.front() != '-' && is_regular_file(word)) return parent_of(word);
  return {};
}

/// Loads the configuration, unless an option or a variable switches it off. False with errors.
bool load_configuration(std::vector<std::string>& words, Diagnostics& diagnostics) {
  const auto flag = std::find(words.begin(), words.end(), kNoConfig);
  const bool is_off = flag != words.end();
  if (flag != words.end()) words.erase(flag);
  if (!is_off) used_configuration() = configuration_unless_off(folder_of_work(words), diagnostics);
  return !diagnostics.has_errors();
}

/// The values of the configuration as those of options.
std::vector<OptionDefault> option_defaults() {
  std::vector<OptionDefault> defaults;
  for (const ConfigValue& value : used_configuration().values()) {
    const auto key = std::find_if(config_keys().begin(), config_keys().end(),
                                  [&](const ConfigKey& k) { return k.key == value.key; });
    const std::string origin = fmt::format("{}:{}", value.file, value.line);
    if (key->form == ConfigKey::Form::units)
      defaults.push_back({"--" + value.texts.front(), {"true"}, origin});
    else if (!key->option.empty())
      defaults.push_back({std::string(key->option), value.texts, origin});
  }
  return defaults;
}

int run(int argc, char** argv) {
  if (const auto status = run_drop_in(argc, argv)) return *status;
  CommandLine root("kerf",
                   "Kerf: toolpaths for routers, mills, lasers and printers: simulated, checked, written.",
                   version_text());
  root.set_footer(kExamples);
  root.require_command();
  bool no_config = false;  // is taken out of the words before they are parsed
  root.add_flag(std::string(kNoConfig), no_config, "Do not read kerf.toml and the user's config.toml");
  std::string color = "auto";  // likewise
  root.add_text(std::string(kColor), color,
                "Colours in messages: auto (on a terminal, unless NO_COLOR is set), always or never");
  const std::vector<Command> commands = add_commands(root);
  std::vector<std::string> words(argv + 1, argv + argc);
  take_color(words);
  Diagnostics faults;
  if (!load_configuration(words, faults)) {
    Console console{OutputOptions{}};
    return static_cast<int>(fail(console, faults, Status::input_errors));
  }
  const CommandLine::Result result = root.parse(with_script_arguments(words), option_defaults());
  if (result.outcome == CommandLine::Outcome::answered) return static_cast<int>(Status::done);
  if (result.outcome == CommandLine::Outcome::parsed) return static_cast<int>(run_asked(commands));
  const bool json = std::find(argv + 1, argv + argc, std::string_view("--json")) != argv + argc;
  OutputOptions output;
  output.json = json;
  Console console(output);
  console.error(result.problem);
  if (json) {
    Diagnostics usage;
    usage.error(codes::usage, {}, result.problem);
    console.print_json(text_of(Record{{"diagnostics", record_of(usage)}}, Layout::indented));
    console.finish();
  }
  fmt::print(stderr, "try: kerf {}{}--help\n", result.command, result.command.empty() ? "" : " ");
  return static_cast<int>(Status::wrong_usage);
}

}  // namespace
}  // namespace kerf::app

int main(int argc, char** argv) {
  kerf::prepare_streams();
  try {
    return kerf::app::run(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "kerf: error: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "kerf: error: {}\n", error.what());
  }
  return static_cast<int>(kerf::app::Status::input_errors);
}

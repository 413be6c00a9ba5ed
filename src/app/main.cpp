// The kerf command: finds the subcommand, runs it, and turns what it says into an exit status.
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/gcmc.h"
#include "app/options/command.h"
#include "app/options/usage.h"
#include "app/report/terminal_progress.h"

#include "kerf/program.h"

namespace kerf::app {
namespace {

const char* const kExamples = R"(
Examples:
  kerf simulate part.nc -o part.png    what a program cuts, as a picture
  kerf check part.nc                   what would go wrong; exit status 3 if anything
  kerf info part.nc                    size, time, tools, feeds, stock
  kerf post --to grbl part.ngc         the program for another controller
  kerf tools show 102                  a tool that Kerf knows
  kerf help simulate                   all about one command

Exit status: 0 done (warnings allowed), 1 errors in the input, 2 wrong usage, 3 check found hazards.
)";

const char* const kToolsExamples = R"(
Examples:
  kerf tools list                      number, shape, size and names of every tool
  kerf tools show 102                  one tool: its measures, its profile, a sketch
  kerf tools show "V d=12.7 angle=90"  a tool told in words, as --tool takes it
  kerf tools shapes                    the shapes, and all keys for such words
)";

std::vector<Command> add_commands(CLI::App& root) {
  std::vector<Command> commands{add_simulate(root), add_check(root),   add_compare(root), add_info(root),
                                add_steps(root),    add_outline(root), add_post(root)};
  CLI::App* tools =
      root.add_subcommand("tools", "The tools that Kerf knows: list, show, shapes, import, export");
  tools->require_subcommand(1);
  tools->footer(kToolsExamples);
  commands.push_back(add_tools_list(*tools));
  commands.push_back(add_tools_show(*tools));
  commands.push_back(add_tools_shapes(*tools));
  commands.push_back(add_tools_import(*tools));
  commands.push_back(add_tools_export(*tools));
  root.add_subcommand("gcmc", "Compile a gcmc program (takes gcmc's own options; see kerf gcmc --help)");
  return commands;
}

/// What `kerf help simulate` stands for: `kerf simulate --help`. A word that is no command ends it without
/// --help, so that the parser says what is wrong; words behind a whole command are passed over.
std::vector<std::string> help_words(const CLI::App& root, const std::vector<std::string>& asked) {
  std::vector<std::string> words;
  const CLI::App* app = &root;
  for (const std::string& word : asked) {
    if (app->get_subcommands([](const CLI::App*) { return true; }).empty()) break;
    const auto named = app->get_subcommands([&](const CLI::App* c) { return c->get_name() == word; });
    words.push_back(word);
    if (named.empty()) return words;
    app = named.front();
  }
  words.push_back("--help");
  return words;
}

/// The words of the command line; `kerf help` and no argument at all are `kerf --help`.
std::vector<std::string> arguments_of(int argc, char** argv, const CLI::App& root) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) words = {"help"};
  if (words.front() == "help") words = help_words(root, {words.begin() + 1, words.end()});
  return {words.rbegin(), words.rend()};  // the order in which CLI11 takes them
}

Status run_asked(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    catch_interrupts();
    Console console(*command.output);
    const Status status = command.run(console);
    if (console.finish()) return status;
    console.complain("cannot write to standard output");
    return Status::input_errors;
  }
  return Status::wrong_usage;
}

/// Commands that take the arguments of the program that they stand in for, which no common parser
/// understands. A link to kerf with that program's name is that program.
std::optional<int> run_drop_in(int argc, char** argv) {
  const std::string called = argc > 0 ? argv[0] : "";
  const bool is_link = called.substr(folder_of(called).size()) == "gcmc";
  if (!is_link && (argc < 2 || std::string_view(argv[1]) != "gcmc")) return std::nullopt;
  catch_interrupts();
  InterruptOnly progress;
  return gcmc_command({argv + (is_link ? 1 : 2), argv + argc}, &progress);
}

int run(int argc, char** argv) {
  if (const auto status = run_drop_in(argc, argv)) return *status;
  CLI::App root(
      "Kerf: describe what a router, mill, laser or printer shall make; see it cut before it is cut.",
      "kerf");
  root.set_version_flag("--version", "kerf " KERF_VERSION, "Print the version");
  root.footer(kExamples);
  root.require_subcommand(1);
  const std::vector<Command> commands = add_commands(root);
  try {
    root.parse(arguments_of(argc, argv, root));
  } catch (const CLI::Success& asked) {  // --help, --version
    return root.exit(asked);
  } catch (const CLI::ParseError& error) {
    Console({}).complain(usage_message(root, error));
    const CLI::App& app = reached(root);
    const std::string name =
        &app == &root
            ? ""
            : (app.get_parent() == &root ? "" : app.get_parent()->get_name() + " ") + app.get_name() + " ";
    fmt::print(stderr, "try: kerf {}--help\n", name);
    return static_cast<int>(Status::wrong_usage);
  }
  return static_cast<int>(run_asked(commands));
}

}  // namespace
}  // namespace kerf::app

int main(int argc, char** argv) {
  try {
    return kerf::app::run(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "kerf: error: not enough memory for this work\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "kerf: error: {}\n", error.what());
  }
  return static_cast<int>(kerf::app::Status::input_errors);
}

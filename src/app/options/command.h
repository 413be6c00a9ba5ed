// What a subcommand of `kerf` is: a name and options for the command line, and what it does. One file each
// (cmd_*.cpp); a new one is a function declared here and a line in main.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/options/parser.h"
#include "app/report/console.h"

namespace kerf::app {

/// The exit statuses of every subcommand; scripts and `kerf check` in CI rely on them.
enum class Status : int { done = 0, input_errors = 1, wrong_usage = 2, hazards = 3, interrupted = 130 };

struct Command {
  CommandParser parser;  // knows whether it is asked for
  OutputOptions* output = nullptr;
  std::function<Status(Console&)> run;
};

Command add_simulate(CommandParser& root);
Command add_info(CommandParser& root);
Command add_check(CommandParser& root);
Command add_compare(CommandParser& root);
Command add_steps(CommandParser& root);
Command add_outline(CommandParser& root);
Command add_post(CommandParser& root);
Command add_tools_list(CommandParser& tools);
Command add_tools_show(CommandParser& tools);
Command add_tools_shapes(CommandParser& tools);
Command add_tools_import(CommandParser& tools);
Command add_tools_export(CommandParser& tools);

/// Makes a subcommand with its examples below the options in the help, and the options all have (--json,
/// --quiet).
CommandParser new_command(CommandParser& parent, const std::string& name, const std::string& summary,
                          const std::string& examples, OutputOptions& output);

/// Ends a run without a result: the messages as text, or with --json as an object that holds nothing else.
Status fail(Console& console, const Diagnostics& diagnostics, Status status);
/// Says that the user stopped the work, and which status that is.
Status tell_stopped(Console& console);

/// An option whose value is a finite number from `low` to `high`; anything else is wrong usage.
Option add_number(CommandParser& parser, const std::string& name, double& value, double low, double high,
                  const std::string& unit, const std::string& summary);
/// An option whose value is a length from `low` to `high` mm, told in mm or with its unit ("0.01in").
Option add_length(CommandParser& parser, const std::string& name, double& mm, double low, double high,
                  const std::string& summary);
/// The option --threads; 0 stands for all.
Option add_threads(CommandParser& parser, double& threads);
/// The positional FILE of the commands that read a program.
Option add_program(CommandParser& parser, std::string& file);
/// An option that may be given several times, one value each time.
Option add_repeated(CommandParser& parser, const std::string& name, std::vector<std::string>& values,
                    const std::string& kind, const std::string& summary);

}  // namespace kerf::app

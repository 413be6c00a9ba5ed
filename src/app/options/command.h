// What a subcommand of `kerf` is: a name and options for the command line, and what it does. One file each
// (cmd_*.cpp); a new one is a function declared here and a line in main.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "app/report/console.h"

namespace kerf::app {

/// The exit statuses of every subcommand; scripts and `kerf check` in CI rely on them.
enum class Status : int { done = 0, input_errors = 1, wrong_usage = 2, hazards = 3, interrupted = 130 };

struct Command {
  CLI::App* app = nullptr;  // says whether it was asked for, and keeps its options
  OutputOptions* output = nullptr;
  std::function<Status(Console&)> run;
};

Command add_simulate(CLI::App& root);
Command add_info(CLI::App& root);
Command add_check(CLI::App& root);
Command add_compare(CLI::App& root);
Command add_steps(CLI::App& root);
Command add_outline(CLI::App& root);
Command add_post(CLI::App& root);
Command add_tools_list(CLI::App& tools);
Command add_tools_show(CLI::App& tools);
Command add_tools_shapes(CLI::App& tools);
Command add_tools_import(CLI::App& tools);
Command add_tools_export(CLI::App& tools);

/// Makes a subcommand with its examples below the options in the help, and the options all have (--json,
/// --quiet).
CLI::App* new_command(CLI::App& parent, const std::string& name, const std::string& summary,
                      const std::string& examples, OutputOptions& output);

/// Ends a run without a result: the messages as text, or with --json as an object that holds nothing else.
Status fail(Console& console, const Diagnostics& diagnostics, Status status);
/// Says that the user stopped the work, and which status that is.
Status tell_stopped(Console& console);

/// An option whose value is a finite number from `low` to `high`; anything else is wrong usage.
CLI::Option* add_number(CLI::App& app, const std::string& name, double& value, double low, double high,
                        const std::string& unit, const std::string& summary);
/// An option whose value is a length from `low` to `high` mm, told in mm or with its unit ("0.01in").
CLI::Option* add_length(CLI::App& app, const std::string& name, double& mm, double low, double high,
                        const std::string& summary);
/// The option --threads; 0 stands for all.
CLI::Option* add_threads(CLI::App& app, double& threads);
/// The positional FILE of the commands that read a program.
CLI::Option* add_program(CLI::App& app, std::string& file);
/// An option that may be given several times, one value each time.
CLI::Option* add_repeated(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                          const std::string& kind, const std::string& summary);

}  // namespace kerf::app

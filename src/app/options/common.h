// Options that several commands have, and the commands' common form.
#pragma once

#include <string>
#include <vector>

#include "app/options/parser.h"
#include "app/report/console.h"

namespace kerf::app {

/// Adds a subcommand with --json and --quiet, and with its examples below the options in the help.
CommandParser new_command(CommandParser& parent, const std::string& name, const std::string& summary,
                          const std::string& examples, OutputOptions& output);

/// An option whose value is a finite number from `low` to `high`; anything else is wrong usage.
Option add_number(CommandParser& parser, const std::string& name, double& value, double low, double high,
                  const std::string& unit, const std::string& summary);
/// An option whose value is a length from `low` to `high` mm, in mm or with its unit ("0.01in").
Option add_length(CommandParser& parser, const std::string& name, double& mm, double low, double high,
                  const std::string& summary);
/// An option whose value is a feed from `low` to `high` mm/min, in mm/min or with its unit ("60ipm").
Option add_feed(CommandParser& parser, const std::string& name, double& mm_per_min, double low, double high,
                const std::string& summary);
/// The option --threads; 0: all.
Option add_threads(CommandParser& parser, double& threads);
/// The option --mesh-tolerance of commands that write meshes.
Option add_mesh_tolerance(CommandParser& parser, double& mm);
/// The option --layer-height of a print.
Option add_layer_height(CommandParser& parser, double& mm);
/// The options of tools, stock and fixtures, without effect on a print.
inline constexpr const char* kCuttingOptions[] = {"--tool",       "--tools",      "--stock",
                                                  "--stock-mesh", "--stock-left", "--flip",
                                                  "--shift",      "--fixture",    "--rotary"};
/// A warning for each option that is given without effect.
void warn_unused(const std::vector<Option>& options, const std::string& why, const std::string& hint,
                 Diagnostics& diagnostics);
/// The positional FILE of the commands that read a program.
Option add_program(CommandParser& parser, std::string& file);
/// The option -o of commands that write one file; `out` stays empty for standard output, "-".
Option add_output(CommandParser& parser, std::string& out, OutputOptions& output, const std::string& summary);
/// The option -o of commands that write several files.
Option add_outputs(CommandParser& parser, std::vector<std::string>& out, OutputOptions& output,
                   const std::string& summary);
/// An option for another output than -o; "-" is standard output.
Option add_other_output(CommandParser& parser, const std::string& name, std::string& out,
                        OutputOptions& output, const std::string& summary);
/// FILE..., one or more programs.
Option add_programs(CommandParser& parser, std::vector<std::string>& files);
/// An option that may be given several times, one value each time.
Option add_repeated(CommandParser& parser, const std::string& name, std::vector<std::string>& values,
                    const std::string& kind, const std::string& summary);

}  // namespace kerf::app

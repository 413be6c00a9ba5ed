// The job: a program with the tools and the stock it is done with, gathered from options, tool files, the
// program's own comments and the built-in table. info, check and simulate all begin with it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/bodies.h"
#include "app/options/command.h"
#include "app/options/reading.h"

#include "kerf/program.h"
#include "kerf/report.h"
#include "kerf/stock.h"
#include "kerf/tool.h"

namespace kerf::app {

/// The options as told.
struct ToolOptions {
  std::vector<std::string> specs;  // --tool [N=]SPEC
  std::vector<std::string> files;  // --tools FILE
};
struct JobOptions {
  std::string file;
  ToolOptions tools;
  std::optional<std::string> stock;  // --stock SPEC
  std::string machine;               // --machine FILE
  BodyOptions bodies;
  ReadingOptions reading;  // --dialect, --strict
};
void add_job_options(CommandParser& parser, JobOptions& options);
/// --tool and --tools alone, for the commands that need no stock.
void add_tool_options(CommandParser& parser, ToolOptions& options);
/// The program and the files of stock and fixtures, which no output may replace.
std::vector<std::string> input_files(const JobOptions& options);
/// --machine, for the commands that make use of one.
void add_machine_option(CommandParser& parser, JobOptions& options);
/// Text for the help of the commands that take --tool, and of those that take --stock.
extern const char* const kToolHelp;
extern const char* const kStockHelp;

/// The options read.
struct ToolSettings {
  std::map<int, Tool> numbered;          // --tool N=SPEC
  std::optional<Tool> any_number;        // --tool SPEC
  ToolTable table;                       // built in and from files
  std::map<int, std::string> from_file;  // which numbers of the table came from which --tools file
};
struct JobSettings {
  ToolSettings tools;
  std::optional<Stock> stock;
  BodySettings bodies;
  InputOptions input;  // for load_program, with the machine
};
/// Reads the tool and stock options. What the command line got wrong goes to `usage`, what files got wrong to
/// `diagnostics`.
ToolSettings read_tool_options(const ToolOptions& options, Diagnostics& usage, Diagnostics& diagnostics);
JobSettings read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics);

/// What a front end needs to know of the tools: their diameters, for cutter compensation.
decltype(InputOptions::tool_diameter) diameters_of(const ToolSettings& settings);
/// The tools that a program changes to or describes, by number, as far as they are known.
std::map<int, Tool> used_tools(const LoadedProgram& program, const ToolSettings& settings);

enum class ToolSource { unknown, option, comment, file, built_in };
std::string_view to_string(ToolSource source);
enum class StockSource { unknown, option, file, program, assumed };
std::string_view to_string(StockSource source);

struct Job {
  LoadedProgram program;  // its path begins with a tool change where --tool had to give one
  PathReport report;
  ToolTable tools;                         // those used and known
  std::map<int, ToolSource> tool_sources;  // of every number used
  std::optional<Stock> stock;
  StockSource stock_source = StockSource::unknown;
  std::vector<Fixture> fixtures;
  std::optional<RoundBar> bar;  // instead of the stock: a fourth axis turns it
};

/// How bad an unknown tool is: info goes on, simulate cannot, check has a hazard of its own for it.
enum class UnknownTool { warning, error, told_elsewhere };
/// Puts a job together. Unknown tools and an assumed stock are told in `diagnostics`; where there is no stock
/// and no cut to put one around, `stock` stays empty without a message.
Job make_job(LoadedProgram program, const JobSettings& settings, const ReportOptions& report,
             UnknownTool unknown, Diagnostics& diagnostics);

/// Warns where a job that cuts has removed nothing from a stock that was told: a wrong zero, unit or corner.
void tell_untouched(const Job& job, Volume removed, Diagnostics& diagnostics);

/// What helps where nobody knows the shape of a tool.
std::string hint_for_unknown(int tool);
/// A tool in a few words: "square 3.175 mm".
std::string short_name(const Tool& tool);

}  // namespace kerf::app

// A job: a program with its tools and its stock, and its simulation.
//
//   Diagnostics diagnostics;
//   std::optional<Program> program = load_program("part.nc", {}, diagnostics);
//   Job job = make_job(std::move(*program), {}, UnknownTool::error, diagnostics);
//   if (!diagnostics.has_errors())
//     std::optional<JobRun> run = run_job(job, {.resolution = mm(0.1)}, diagnostics);
//
// Tools and stock are searched in this order: given by the caller, the program's comments, files, the
// built-in table. If no stock is found, a block around the cuts is assumed; UnknownTool::assume does the same
// for tools. The job stores the sources.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kerf/formats/workshop_files.h"
#include "kerf/job/findings.h"
#include "kerf/job/program.h"
#include "kerf/path/estimate.h"
#include "kerf/path/report.h"
#include "kerf/sim/print.h"
#include "kerf/sim/rotary.h"
#include "kerf/sim/simulate.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

// ---- settings

struct ToolChoices {
  std::map<int, Tool> numbered;          // for one number each; precede all others
  std::optional<Tool> any_number;        // for every number not in `numbered`
  ToolTable table = built_in_tools();    // and tool files
  std::map<int, std::string> from_file;  // the numbers of `table` that came from a file, and its name
};
/// Adds a tool given as "[N=]SPEC": "square d=3.175 flute=12.7" for every number, "2=V d=12.7 angle=90" for
/// tool 2, "2=301" for the built-in tool 301. Errors have the origin `where`.
void add_tool(const std::string& text, const Origin& where, ToolChoices& choices, Diagnostics& diagnostics);
/// Adds the tools of a file to the table: a tool file (kerf/formats/workshop_files.h), or a library of
/// another program (formats/tool_libraries.h), in mm if it has no unit.
void add_tool_file(const std::string& file, ToolChoices& choices, Diagnostics& diagnostics);
/// The tools' diameters for cutter compensation: the value of ProgramOptions::tool_diameter.
decltype(ProgramOptions::tool_diameter) diameters_of(const ToolChoices& choices);

struct JobSettings {
  ToolChoices tools;
  std::optional<Stock> stock;
  std::optional<Stock> stock_file;  // read from a file; precedes `stock`
  std::optional<StockMove> move;    // of the stock, whatever its source
  std::vector<Fixture> fixtures;
  Length spoilboard;                     // thickness of the board below the stock that may be cut into
  std::optional<RoundBar> bar;           // instead of the stock: turned by a fourth axis
  std::optional<AxisRates> rapid_rates;  // SimulationOptions; of the machine
  Length usual_spoilboard{};             // where neither `spoilboard` nor the program has one
};
/// A stock from a mesh or a left-over stock file; nothing, with an error, if it cannot be read or is stopped.
std::optional<Stock> load_stock(const std::string& file, Diagnostics& diagnostics,
                                Progress* progress = nullptr);

// ---- the job

enum class ToolSource { unknown, option, comment, program, file, built_in, assumed };
std::string_view to_string(ToolSource source);
enum class StockSource { unknown, option, file, program, assumed };
std::string_view to_string(StockSource source);

/// Material is cut from a block or a mesh (milling), cut from a turning bar (rotary), or added (print).
enum class JobKind { milling, rotary, print };

struct Job {
  JobKind kind = JobKind::milling;
  Program program;  // with a tool change inserted before motions without a tool, if a tool is given for them
  PathReport report;
  ToolTable tools;                         // those used and known
  std::map<int, ToolSource> tool_sources;  // of every number used
  std::optional<int> start_tool;           // of a tool change inserted before the first motion
  std::optional<Stock> stock;
  StockSource stock_source = StockSource::unknown;
  std::vector<Fixture> fixtures;
  Length spoilboard;                     // cuts below the floor that end inside of it are not hazards
  std::optional<RoundBar> bar;           // instead of the stock
  std::optional<AxisRates> rapid_rates;  // SimulationOptions; of the machine
  std::optional<PathHazard>
      z_downwards;  // set if Z seems to count downwards: other findings are then unreliable
};

/// What becomes of a tool of unknown shape: an error, a warning and no tool, or a warning and an assumed tool
/// (path/assumed_tool.h). A laser's beam is always assumed, without a warning.
enum class UnknownTool { error, warning, assume };
/// Makes a job. Unknown tools and an assumed stock are reported in `diagnostics`; without a stock and without
/// cuts `stock` is empty, without a diagnostic.
Job make_job(Program program, const JobSettings& settings, UnknownTool unknown, Diagnostics& diagnostics);
/// A job of a program that prints (is_print): it has neither tools nor stock.
Job make_print_job(Program program);
/// A print job if the program prints, else make_job().
Job make_job_or_print(Program program, const JobSettings& settings, UnknownTool unknown,
                      Diagnostics& diagnostics);

/// Adds the tools of a program to those of the programs that it is joined with. Empty, or where a number has
/// two shapes what is wrong: a message that names both. `known` is as it was then.
std::string add_tools_of(const std::map<int, Tool>& tools, std::map<int, Tool>& known);
/// False, with an error, if a tool of the options cuts otherwise than the one for which a cutting job has
/// made its paths. A tool with the same cutting part, but with a holder, is none.
bool fits_tools_of_job(const Program& program, const ToolChoices& choices, Diagnostics& diagnostics);
/// The tools that a program changes to or describes, by number, as far as they are known.
std::map<int, Tool> used_tools(const Program& program, const ToolChoices& choices);
/// The tool of motions before the first tool change, if it is known, and the number with which a comment
/// describes it: 0 where the program changes tools later.
std::optional<std::pair<int, Tool>> start_tool(const Program& program, const ToolChoices& choices);
/// Makes the tools that a job of the program would use, as far as they are known, its own.
void keep_tools(Program& program, const ToolChoices& choices);
/// The program of a job with the tools, the stock and the fixtures of the job as its own, for a .kerf file.
/// An assumed tool or stock is not: the next job assumes it again.
Program program_of(const Job& job);
/// A tool in a few words: "square 3.175 mm", "V 20 mm, 60 degrees". Readers of tool comments understand it.
std::string short_name(const Tool& tool);

// ---- simulation

struct RunOptions {
  Length resolution = {};  // of the columns; 0: by the size of stock or print
  unsigned threads = 0;    // 0: all; the result does not depend on it
  /// Of a print; nothing: from the program's comments, else its steps in Z.
  std::optional<Length> layer_height = {};
  bool volumes_by_tool = false;  // SimulationOptions::volumes_by_tool
};

struct JobRun {
  std::variant<Simulation, RotarySimulation, PrintSimulation> result;  // by Job::kind
  std::vector<Finding> findings;  // hazards of the material or the print, and of the fixtures

  const Simulation& milling() const { return std::get<Simulation>(result); }
  const RotarySimulation& rotary() const { return std::get<RotarySimulation>(result); }
  const PrintSimulation& print() const { return std::get<PrintSimulation>(result); }
};
/// Simulates the job. Nothing, with an error, if that is impossible, or if it is stopped.
/// The run refers to the job's toolpath: the job must exist unchanged, and at the same address, as long as
/// the run.
std::optional<JobRun> run_job(const Job& job, const RunOptions& options, Diagnostics& diagnostics,
                              Progress* progress = nullptr);

/// Warns if a job that cuts removes nothing from a stock that was given: a wrong zero, unit or corner.
void warn_untouched(const Job& job, Volume removed, Diagnostics& diagnostics);
/// Warns if the cuts of a job fill a stock that was given only if they are read in the other unit: inches for
/// a program that names no unit, millimetres for one in inches whose cuts are larger than the stock.
void warn_units(const Job& job, Diagnostics& diagnostics);

// ---- time

/// Times as planned by the machine's controller, or, without a machine, from feeds and rapid rates alone.
struct JobTimes {
  TimeEstimate estimate;
  std::string machine;  // its name; empty: not planned
  bool planned() const { return !machine.empty(); }
  /// Those of a tool; nothing: before the first tool change.
  const TimeFigures& of_tool(std::optional<int> tool) const;
};
JobTimes times_of(const Job& job, const Machine* machine);

/// Whether the deepest cut of a tool below the top of the stock exceeds its flute length.
bool deeper_than_flute(const Job& job, const ToolFigures& figures);

}  // namespace kerf

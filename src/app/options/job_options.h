// The options of a job: its tools, its stock, its fixtures and its machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/parser.h"
#include "app/options/program_options.h"

#include "kerf/job/job.h"

namespace kerf::app {

/// The options as given.
struct ToolOptions {
  std::vector<std::string> specs;  // --tool [N=]SPEC
  std::vector<std::string> files;  // --tools FILE
};
struct BodyOptions {
  std::string mesh;                   // --stock-mesh FILE
  std::string left;                   // --stock-left FILE
  std::optional<std::string> flip;    // --flip SPEC
  std::optional<std::string> shift;   // --shift X,Y,Z
  std::vector<std::string> fixtures;  // --fixture SPEC or FILE
  double spoilboard = 0.0;            // --spoilboard MM
  std::optional<Option> spoilboard_option;
  std::optional<std::string> rotary;  // --rotary SPEC
};
struct JobOptions {
  std::string file;
  ToolOptions tools;
  std::optional<std::string> stock;  // --stock SPEC
  std::string machine;               // --machine FILE
  bool inch = false, mm = false;     // --inch, --mm
  BodyOptions bodies;
  ReadingOptions reading;
};

/// FILE, the tools, --stock and how the program is read.
void add_job_options(CommandParser& parser, JobOptions& options);
/// The same for several programs, whose names `files` receives; JobOptions::file is set for each in turn.
void add_job_options(CommandParser& parser, JobOptions& options, std::vector<std::string>& files);
/// --tool and --tools alone, for the commands that need no stock.
void add_tool_options(CommandParser& parser, ToolOptions& options);
/// Stock from files, and fixtures; after add_job_options.
void add_body_options(CommandParser& parser, BodyOptions& options);
/// The same with --spoilboard and --rotary, for the commands that report hazards.
void add_setup_options(CommandParser& parser, BodyOptions& options);
/// --machine, for the commands that use a machine profile.
void add_machine_option(CommandParser& parser, JobOptions& options);
/// --inch and --mm, for the commands that print lengths as text.
void add_unit_options(CommandParser& parser, JobOptions& options);
/// The units of lengths in texts: as given, else those of the program.
ProgramUnits units_of_text(const JobOptions& options, const Program& program);
// For the help of the commands that take these options.
extern const char* const kToolHelp;
extern const char* const kStockHelp;
extern const char* const kBodyHelp;
extern const char* const kRotaryHelp;

/// The options as arguments of load_program and make_job.
struct JobInputs {
  JobSettings job;
  ProgramOptions program;
};
/// Reads the options. Errors of the command line go to `usage`, errors of files to `diagnostics`, and that
/// `progress` has stopped the reading of a body.
JobInputs read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics,
                           Progress* progress = nullptr);
ToolChoices read_tool_options(const ToolOptions& options, Diagnostics& usage, Diagnostics& diagnostics);
/// The reading options of a program that uses these tools.
ProgramOptions program_options(const ReadingOptions& options, const ToolChoices& tools);
/// The program and the files of stock and fixtures, which no output may replace.
std::vector<std::string> input_files(const JobOptions& options);

}  // namespace kerf::app

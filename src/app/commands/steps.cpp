// kerf steps: the toolpath of a program as JSON lines, for other programs.
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/program_options.h"
#include "app/report/terminal_progress.h"
#include "app/report/text_out.h"
#include "base/codes/files.h"
#include "job/record/record.h"

#include "kerf/job/program.h"

namespace kerf::app {
namespace {

constexpr std::size_t kStepsBetweenInterrupts = 4096;  // checks of the interrupt flag
constexpr std::size_t kBufferBytes = 1 << 16;

struct Options {
  OutputOptions output;
  std::string file, out;
  ToolOptions tools;
  ReadingOptions reading;
};

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  const ToolChoices tools = read_tool_options(options.tools, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  TerminalProgress progress(console);
  const auto program =
      load_program(options.file, program_options(options.reading, tools), diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  console.show(diagnostics, Console::Channel::always_text);  // stdout is only for steps
  if (!program || diagnostics.has_errors()) return Status::input_errors;

  if (!options.out.empty() && is_same_file(options.out, options.file)) {
    usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
    return fail(console, usage, Status::wrong_usage);
  }
  TextOut out(options.out);
  std::string buffer =
      text_of(Record{{"kerf_steps", 1}, {"units", "mm"}, {"source", program->source}}, Layout::line);
  std::optional<int> tool;
  for (std::size_t i = 0; i < program->path.size(); ++i) {
    if (program->path[i].kind() == StepKind::tool_change) tool = program->path[i].tool_change().tool;
    buffer += text_of(record_of_step(program->path, i, tool), Layout::line);
    if (i % kStepsBetweenInterrupts == 0 && interrupted()) return report_stopped(console);
    if (buffer.size() < kBufferBytes) continue;
    out.write(buffer);
    buffer.clear();
  }
  out.write(buffer);
  if (out.finish()) return Status::done;
  console.error(out.error_text());
  return Status::input_errors;
}

const char* const kExamples =
    R"(  kerf steps part.nc
  kerf steps part.nc --tool 1="square d=6"      G41 and G42 need the tool
  kerf steps part.nc | grep '"step":"tool"'

Prints a line {"kerf_steps":1,"units":"mm","source":FILE}, then one JSON object per step: complete absolute
positions in mm, feeds in mm/min, and the file, line and column of the step. Nothing is printed for a program
with errors.
)";

}  // namespace

Command add_steps(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "steps", "Print the toolpath of a program as JSON lines",
                                     kExamples + std::string(kToolHelp), options->output);
  parser.option("--json").description("No effect: each step is a JSON object in any case");
  parser.option("--quiet").description("No progress bar or notes; warnings and errors stay");
  add_program(parser, options->file);
  add_output(parser, options->out, options->output, "The file to write (default: -, standard output)");
  add_tool_options(parser, options->tools);
  add_reading_options(parser, options->reading);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app

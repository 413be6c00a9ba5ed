// `kerf adjustz`.
#include "app/commands/adjustz.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "app/commands/drop_in_output.h"
#include "app/options/adjustz_options.h"
#include "app/options/slash_options.h"
#include "app/report/console.h"
#include "base/codes/pathdxf.h"
#include "base/pattern.h"
#include "job/path_programs.h"

#include "kerf/base/files.h"

namespace kerf::app {
namespace {

constexpr Bilingual kInvalid{"Invalid expression for /x: {}", "Ungültiger Ausdruck für /x: {}"};

class AdjustzCommand {
 public:
  AdjustzCommand(AdjustzCommandLine line, Progress* progress) : line_(std::move(line)), progress_(progress) {}

  int run() {
    if (compile_shown_lines())
      for (const std::string& name : line_.files) {
        if (stop_requested(progress_)) break;
        process(name);
      }
    print_messages(diagnostics_, stderr_is_terminal());
    return diagnostics_.has_errors() || stop_requested(progress_) ? kDropInErrors : 0;
  }

 private:
  bool compile_shown_lines() {
    if (!line_.shown_lines) return true;
    std::string problem;
    shown_ = Pattern::compile(*line_.shown_lines, LetterCase::distinct, problem);
    if (!shown_)
      diagnostics_.error(codes::pathdxf_pattern, {},
                         fmt::format(fmt::runtime(kInvalid.in(line_.language)), problem));
    return shown_.has_value();
  }
  void process(const std::string& name);
  void show(std::string_view program);

  AdjustzCommandLine line_;
  Progress* progress_;
  std::optional<Pattern> shown_;
  Diagnostics diagnostics_;
};

void AdjustzCommand::process(const std::string& name) {
  const bool failed_before = diagnostics_.has_errors();
  AdjustOptions options;
  options.max_correction = line_.max_correction;
  options.measured = line_.measured;
  options.reading.language = line_.language;
  options.reading.work_offset = line_.work_offset;
  const auto print = [this](const Bilingual& message, const std::string& file) {
    print_line(fmt::format(fmt::runtime(message.in(line_.language)), file));
  };
  options.report = [&](const std::string& file) { print(kReadingFile, file); };
  const auto program = adjust_path_program(name, options, diagnostics_, progress_);
  if (!program || failed_before) return;
  print(kWritingFile, program->base + "_Milling.gcode");
  OutputSet files;
  if (files.write(program->base + "_Milling.gcode", program->text, diagnostics_)) files.commit(diagnostics_);
  show(program->clean);
}

/// Prints the lines that match /x on standard output.
void AdjustzCommand::show(std::string_view program) {
  for (std::size_t i = 0; shown_ && i < program.size();) {
    const std::size_t end = std::min(program.find('\n', i), program.size());
    const std::string_view line = program.substr(i, end - i);
    if (shown_->search(line)) fmt::print("{}\n", line);
    i = end + 1;
  }
}

}  // namespace

int adjustz_command(const std::vector<std::string>& arguments, Progress* progress) {
  AdjustzCommandLine line = parse_adjustz_options(arguments);
  print_line("Kerf " KERF_VERSION " adjustz\n");
  if (line.help || line.problems.has_errors()) {
    if (!line.help) print_messages(line.problems, true);
    fmt::print(stderr, "{}", adjustz_usage(line.language));
    return kDropInUsage;
  }
  if (line.files.empty()) return kDropInNoFile;
  return AdjustzCommand(std::move(line), progress).run();
}

}  // namespace kerf::app

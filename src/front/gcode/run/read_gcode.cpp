// read_gcode: from text to blocks to steps.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "codec/gcode/block.h"
#include "codec/gcode/plain_text.h"
#include "front/gcode/program/flow.h"
#include "front/gcode/run/interpreter.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

constexpr std::size_t kLinesPerReport = 16'384;  // a stop request takes effect within milliseconds
// For the first reservation; a longer path is reallocated, which takes three times its memory for a moment.
constexpr std::size_t kSampledBytes = 64 * 1024;
constexpr std::size_t kMaxReservedSteps = sizeof(void*) > 4 ? 32'000'000 : 2'000'000;

/// The number of lines, by the length of the first ones: each makes one step in most programs.
std::size_t expected_steps(std::string_view text) {
  const std::string_view sample = text.substr(0, kSampledBytes);
  const auto lines = static_cast<std::size_t>(std::count(sample.begin(), sample.end(), '\n')) + 1;
  return static_cast<std::size_t>(static_cast<double>(lines) * static_cast<double>(text.size()) /
                                  static_cast<double>(sample.size() + 1)) +
         1;
}

GcodeDialect dialect_of(std::string_view text, const GcodeReadOptions& options, bool& torch,
                        Diagnostics& diagnostics) {
  if (options.dialect) return *options.dialect;
  const DialectGuess guess = guess_dialect(text);
  torch = guess.torch;
  if (guess.dialect != GcodeDialect::rs274)
    diagnostics.note(
        codes::dialect_guessed, TextLocation{options.file_name, guess.line, 0},
        fmt::format("reading this as a program for {} ({})", to_string(guess.dialect), guess.from));
  return guess.dialect;
}

/// False with one error for bytes that are not text; otherwise each of their lines would be an error.
bool is_text(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics) {
  const std::optional<gcode::NotPlain> not_plain = gcode::find_not_plain(text);
  if (!not_plain) return true;
  const std::string_view before = text.substr(0, not_plain->at);
  const auto line = static_cast<std::uint32_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  const TextLocation where{options.file_name, line,
                           static_cast<std::uint32_t>(not_plain->at - line_start) + 1};
  if (not_plain->kind == gcode::NotPlain::Kind::utf16)
    diagnostics.error(codes::text_not_plain, where, "the file is UTF-16, which no controller reads").hint =
        "save it as UTF-8 or ASCII, e.g. with: iconv -f UTF-16 -t UTF-8";
  else
    diagnostics.error(codes::text_not_plain, where, "this is binary data, not G-code");
  return false;
}

/// False with one error for a program in another language; otherwise each of its lines would be an error.
bool is_gcode(std::string_view text, const GcodeReadOptions& options, GcodeDialect dialect,
              Diagnostics& diagnostics) {
  if (is_printer(dialect)) return true;
  const auto foreign = find_foreign_language(text);
  if (!foreign) return true;
  diagnostics
      .error(codes::other_language, TextLocation{options.file_name, foreign->line, 0},
             fmt::format("a program for {} ({}), which is not supported", foreign->control, foreign->word))
      .hint = "post it as G-code for a mill, router, laser or printer";
  return false;
}

GcodeProgram read_once(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                       Progress* progress) {
  GcodeProgram program;
  if (progress != nullptr) progress->phase("reading G-code");
  if (!is_text(text, options, diagnostics)) {
    program.cut_short = true;
    return program;
  }
  program.path.reserve(std::min({expected_steps(text), options.max_steps, kMaxReservedSteps}));
  program.dialect = dialect_of(text, options, program.torch, diagnostics);
  if (!is_gcode(text, options, program.dialect, diagnostics)) {
    program.cut_short = true;
    return program;
  }
  gcode::LineReporter reporter(options.file_name, options.strict, diagnostics);
  gcode::Interpreter interpreter(program, text, options, reporter);
  gcode::Flow flow(text, options, reporter, interpreter.parameters(), program.dialect, diagnostics);
  interpreter.set_flow(flow);
  gcode::Block block;
  std::size_t lines = 0, next_report = kLinesPerReport;
  while (!interpreter.done()) {
    if (gcode::BlockReader* reader = flow.sequential_reader())
      lines += interpreter.run_simple_lines(*reader, kLinesPerReport);
    if (!flow.next(block)) break;
    interpreter.run(block);
    if (++lines < next_report) continue;
    next_report = lines + kLinesPerReport;
    report(progress,
           std::min(1.0, static_cast<double>(flow.position()) / static_cast<double>(text.size() + 1)));
    if (stop_requested(progress)) return {};
  }
  interpreter.finish();
  report(progress, 1.0);
  return program;
}

}  // namespace

GcodeProgram read_gcode(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                        Progress* progress) {
  const Diagnostics before = diagnostics;
  GcodeProgram program = read_once(text, options, diagnostics, progress);
  const bool detects = options.arc_centres == ArcCentres::detect;
  if (!detects || !program.arcs.is_for_coordinates() || stop_requested(progress)) return program;
  const TextLocation where{options.file_name, program.arcs.first_line, 0};
  GcodeReadOptions absolute = options;
  absolute.arc_centres = ArcCentres::absolute;
  diagnostics = before;
  program = {};
  diagnostics
      .warning(codes::arc_centres_guessed, where,
               "no arc fits with I J K as offsets from its start, and all fit as coordinates; read as "
               "coordinates")
      .hint = "state it: G90.1 in the program, or --arc-centres absolute";
  return read_once(text, absolute, diagnostics, progress);
}

}  // namespace kerf

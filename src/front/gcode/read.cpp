// read_gcode: text to blocks to steps.
#include <algorithm>

#include "codec/gcode/block.h"
#include "front/gcode/interpreter.h"

#include "kerf/gcode.h"

namespace kerf {
namespace {

constexpr std::size_t kLinesPerReport = 16'384;   // a stop is noticed within some milliseconds
constexpr std::size_t kBytesPerStep = 16;         // of usual programs, for the first reservation
constexpr std::size_t kMostReserved = 2'000'000;  // steps; a longer program grows as it goes

}  // namespace

GcodeProgram read_gcode(std::string_view text, const GcodeReadOptions& options, Diagnostics& diagnostics,
                        Progress* progress) {
  GcodeProgram program;
  if (progress != nullptr) progress->phase("reading G-code");
  program.path.reserve(std::min({text.size() / kBytesPerStep + 1, options.max_steps, kMostReserved}));
  gcode::Talker talker(options.file_name, options.strict, diagnostics);
  gcode::Interpreter interpreter(program, options, talker);
  gcode::BlockReader reader(text, {options.file_name, options.max_line_bytes, options.strict}, diagnostics);
  gcode::Block block;
  std::size_t lines = 0;
  while (!interpreter.done() && reader.next(block)) {
    interpreter.run(block);
    if (++lines % kLinesPerReport != 0) continue;
    report(progress, static_cast<double>(reader.position()) / static_cast<double>(text.size()));
    if (stop_requested(progress)) return {};
  }
  interpreter.finish();
  report(progress, 1.0);
  return program;
}

}  // namespace kerf

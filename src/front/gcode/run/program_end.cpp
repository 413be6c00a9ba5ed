// Where the program ends.
#include "front/gcode/run/program_end.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

/// A dialect of GRBL that is only detected is no reason to read on: other controllers stop.
AfterEnd default_after_end(GcodeDialect dialect, const GcodeReadOptions& options) {
  const bool stops = dialect == GcodeDialect::rs274 || dialect == GcodeDialect::mach3;
  const bool uncertain = dialect == GcodeDialect::grbl && !options.dialect;
  return stops || uncertain ? AfterEnd::stop : AfterEnd::read_on;
}

}  // namespace

ProgramEnd::ProgramEnd(Context& context)
    : Part(context), after_(options_.after_end.value_or(default_after_end(program_.dialect, options_))) {}

/// Whether a line after the program's end is read. Subroutines there run only where they are called.
bool ProgramEnd::reads_on_after(const Block& block) {
  const bool number = !block.words.empty() && block.words.front().letter == 'O';
  if (after_ == AfterEnd::stop && (number || block.o_word)) {
    stopped_ = true;
    return false;
  }
  if (number && flow_->skip_subprogram()) return false;
  if (text_after_reported_ || block.o_word) return true;
  text_after_reported_ = true;
  stopped_ = after_ == AfterEnd::stop;
  const std::uint32_t column = block.words.empty() ? 1 : block.words.front().column;
  if (stopped_)
    reporter_.unusual(codes::text_after_end, column, "text after the end of the program is not read",
                      "use --read-on to read past M2, M30 and %, as G-code senders do");
  else
    reporter_.note(codes::text_after_end, column,
                   "text after the end of the program is read as its continuation");
  return !stopped_;
}

/// A line after the program's end that is not G-code.
void ProgramEnd::report_unreadable() {
  stopped_ = stopped_ || after_ == AfterEnd::stop;
  if (text_after_reported_) return;
  text_after_reported_ = true;
  reporter_.unusual(codes::text_after_end, 1, "text after the end of the program is not G-code; skipped");
}

void ProgramEnd::note() {
  program_.ended = true;
  flow_->note_program_end();
}

/// A program is enclosed in two percent lines, or has none.
void ProgramEnd::read_percent() {
  if (flow_->depth() > 0) return;  // in a subroutine's file
  const bool closes = percent_open_ || words_since_percent_;
  if (closes && !percent_open_)
    reporter_.unusual(codes::lone_percent, 1, "this percent line closes a program without an opening one");
  if (closes) note();
  percent_open_ = !closes;
  words_since_percent_ = false;
}

/// Programs for lasers often end with M5 alone.
bool ProgramEnd::ends_with_beam_off() const {
  for (std::size_t i = path_.size(); i > 0; --i) {
    const Step& s = path_[i - 1];
    if (s.kind() == StepKind::laser_power) return s.laser_power().mode == LaserMode::off;
    if (s.is_cutting()) return false;
  }
  return false;
}

void ProgramEnd::report_missing() {
  if (ends_with_beam_off()) program_.ended = true;
  const bool ends = !is_printer();  // printers need no end
  if (ends && !program_.ended && !program_.cut_short && path_.size() > 0)
    reporter_.unusual(codes::no_program_end, 0, "the program has no end (M2, M30 or a closing %)",
                      "is the file complete?");
}

}  // namespace kerf::gcode

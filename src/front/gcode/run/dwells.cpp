// Times: G4, and P of cycles.
#include "front/gcode/run/dwells.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "front/gcode/comments/laser_comments.h"

namespace kerf::gcode {
namespace {

constexpr double kMillisecondsPerSecond = 1000.0;
constexpr double kLongDwell = 60.0;  // seconds; starting a spindle or coolant takes less

}  // namespace

Dwells::Dwells(Context& context, std::string_view text)
    : Part(context),
      as_printer_(is_printer() ||
                  (program_.dialect == GcodeDialect::laser && is_for_printer_firmware(text))) {}

void Dwells::dwell() {
  const bool fanuc = is_fanuc(program_.dialect);
  char letter = 'P';
  if (as_printer_ && line_.unused('S')) letter = 'S';  // seconds
  for (const char other : {'X', 'U'})
    if (fanuc && line_.unused(other)) letter = other;  // seconds
  const std::optional<double> time = line_.take(letter);
  if (!time) {
    if (as_printer_) return;  // waits for the motions before it
    reporter_.error(codes::word_missing, line_.column(Group::dwell), "G4 needs a time: P in seconds");
    return;
  }
  if (*time < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column(letter), "a time cannot be negative");
    return;
  }
  const double time_s = letter == 'P' ? seconds_of_p(*time) : *time;
  report_long(time_s, letter);
  add(step::Dwell{seconds(time_s)});
}

/// P of a dwell or cycle in seconds. Printers give milliseconds; so do Fanuc's and Haas' controls, unless the
/// number has a decimal point.
double Dwells::seconds_of_p(double p) const {
  const bool fanuc = is_fanuc(program_.dialect) && line_.is_integer_text('P');
  return as_printer_ || fanuc ? p / kMillisecondsPerSecond : p;
}

/// P is in seconds or milliseconds, depending on the controller; a dwell of minutes suggests the wrong unit.
void Dwells::report_long(double time, char letter) {
  if (time <= kLongDwell || long_reported_) return;
  long_reported_ = true;
  const bool milliseconds = letter == 'P' && seconds_of_p(1.0) != 1.0;
  reporter_.unusual(
      codes::dwell_long, line_.column(letter),
      fmt::format("a dwell of {:.3g} minutes: {} is read in {}, as {} does", time / 60.0, letter,
                  milliseconds ? "milliseconds" : "seconds", to_string(program_.dialect)),
      milliseconds ? "" : "if P is in milliseconds, divide it by 1000");
}

}  // namespace kerf::gcode

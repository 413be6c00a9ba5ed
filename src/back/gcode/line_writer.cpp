// The lines of a posted file.
#include "back/gcode/line_writer.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {

void LineWriter::put_number() {
  line_number_ += profile_.line_number_step;
  if (line_number_ > profile_.highest_line_number) line_number_ = profile_.line_number_step;
  word('N', line_number_, 0);
}

void LineWriter::report_long(std::size_t i, std::size_t bytes) {
  diagnostics_.error(
      codes::post_line_long, i < path_.size() ? path_.origin_of(i) : Origin{},
      fmt::format("a line of {} bytes; the maximum of the controller is {}", bytes, profile_.longest_line));
}

}  // namespace kerf::gcode

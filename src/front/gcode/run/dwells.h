// Times: G4, and P of cycles.
#pragma once

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class Dwells : Part {
 public:
  Dwells(Context& context, std::string_view text);

  /// G4.
  void dwell();
  double seconds_of_p(double p) const;
  void report_long(double time, char letter);

 private:
  bool as_printer_;  // S is in seconds, P in milliseconds, and neither is needed
  bool long_reported_ = false;
};

}  // namespace kerf::gcode

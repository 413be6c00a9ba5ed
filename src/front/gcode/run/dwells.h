// Times: G4, and P of cycles.
#pragma once

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class Dwells : Part {
 public:
  explicit Dwells(Context& context) : Part(context) {}

  /// G4.
  void dwell();
  double seconds_of_p(double p) const;
  void report_long(double time, char letter);

 private:
  bool long_reported_ = false;
};

}  // namespace kerf::gcode

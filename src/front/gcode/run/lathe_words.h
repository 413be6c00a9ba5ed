// The words of programs for lathes, which Kerf reads as milling.
#pragma once

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class LatheWords : Part {
 public:
  explicit LatheWords(Context& context) : Part(context) {}

  void note();
  /// At the end of the program.
  void report();

 private:
  unsigned kinds_ = 0;  // that the program has, as bits
  TextLocation where_;  // of the first one
};

}  // namespace kerf::gcode

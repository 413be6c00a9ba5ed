// The machine as a program sees it: position, offsets, plane, stored positions, layers. What moves it goes to sinks.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kerf/geometry.h"

#include "front/gcmc/sink.h"
#include "front/gcmc/value.h"

namespace kerf::gcmc {

class Machine {
 public:
  std::vector<Sink*> sinks;
  Axes position{};          // native units, degrees; without offsets
  Axes fixed_offset{};      // of the command line
  Axes relocation{};        // of relocate()
  Plane plane = Plane::xy;
  struct Stored {
    bool known = false;
    Axes position{};
  };
  std::array<Stored, 2> stored{};
  std::vector<std::string> layers;
  int layer = -1;

  Axes with_offset(const Axes& p) const {
    Axes out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = p[i] + (fixed_offset[i] + relocation[i]);
    return out;
  }
  template <class Tell>
  void tell(Tell tell) {
    for (Sink* sink : sinks) tell(*sink);
  }
};

}  // namespace kerf::gcmc

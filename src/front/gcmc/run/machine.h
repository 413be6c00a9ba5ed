// The machine as a program sees it: position, offsets, plane, stored positions, layers. What moves it goes to
// sinks.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "front/gcmc/run/gouges.h"
#include "front/gcmc/run/sink.h"
#include "front/gcmc/value/value.h"

#include "kerf/base/progress.h"
#include "kerf/geom/geometry.h"

namespace kerf::gcmc {

class Machine {
 public:
  std::vector<Sink*> sinks;
  Progress* progress = nullptr;  // of the run
  Axes position{};               // native units, degrees; without offsets
  Axes sent{};                   // the same with offsets: the position as passed to the sinks
  Axes fixed_offset{};           // of the command line
  Axes relocation{};             // of relocate()
  Plane plane = Plane::xy;
  struct Stored {
    bool known = false;
    Axes position{};
  };
  std::array<Stored, 2> stored{};
  std::vector<std::string> layers;
  int layer = -1;
  std::optional<int> tool;                                        // in the spindle
  std::map<int, std::string> tool_texts;                          // shapes by number, as given to cutter()
  int feed_mode = 1;                                              // as Sink::feed_mode
  std::optional<CompensatedTrace> trace;                          // while tracepath_comp() runs
  bool has_warned_of_arcs = false, has_warned_of_angles = false;  // that the versions of the language differ

  double with_offset(std::size_t axis, double v) const { return v + (fixed_offset[axis] + relocation[axis]); }
  Axes with_offset(const Axes& p) const {
    Axes out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = with_offset(i, p[i]);
    return out;
  }
  void set_position(const Axes& p) {
    position = p;
    sent = with_offset(p);
  }
  void set_axis(std::size_t axis, double v) {
    position[axis] = v;
    sent[axis] = with_offset(axis, v);
  }
  template <class Send>
  void for_each_sink(Send send) {
    for (Sink* sink : sinks) send(*sink);
  }
};

}  // namespace kerf::gcmc

// The effects of a running program on the machine: one interface, for the toolpath and for the text.
//
// Positions are complete and absolute, offsets included: native length units (mm, or inch), A B C in degrees.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kerf/geom/geometry.h"

namespace kerf::gcmc {

/// X Y Z A B C U V W.
using Axes = std::array<double, 9>;
/// The value of an axis of a plane (kerf/geom/geometry.h), whose indices are signed.
inline double& along(Axes& axes, int axis) { return axes[static_cast<std::size_t>(axis)]; }
inline double along(const Axes& axes, int axis) { return axes[static_cast<std::size_t>(axis)]; }

struct Move {
  bool rapid = false;
  const Axes& to;
  unsigned named = 0;  // bits of the axes that the program named
  double feed = 0.0;   // given with this move; 0: none
};

struct ArcMove {
  Turn turn = Turn::cw;
  Plane plane = Plane::xy;
  Axes to{};
  unsigned named = 0;
  Point2 offset;  // of the centre from the start point, in the order of the plane's name
  int turns = 0;  // 0: not given
};

struct DrillMove {
  Axes to{};
  unsigned named = 0;
  double retract = 0.0;
  double delta = 0.0;
  int repeat = 0;  // 0: not given
};

class Sink {
 public:
  virtual ~Sink() = default;
  virtual void move(const Move& m) = 0;
  virtual void arc(const ArcMove& m) = 0;
  virtual void drill(const DrillMove& m) = 0;
  /// A goto() or move() with an error, whose first word the real program has already written.
  virtual void broken_move(bool rapid) = 0;
  virtual void feed_rate(double feed) = 0;
  virtual void feed_mode(int mode) = 0;    // 0 inverse time, 1 per minute, 2 per revolution
  virtual void spindle(double speed) = 0;  // clockwise, counter-clockwise below 0, off at 0
  virtual void spindle_speed(double speed) = 0;
  virtual void coolant(int bits) = 0;  // 1 mist, 2 flood
  virtual void tool_change(int tool, bool length_offset) = 0;
  virtual void dwell(double seconds) = 0;
  virtual void path_mode(bool exact, std::optional<double> p, std::optional<double> q) = 0;
  virtual void pause(bool optional) = 0;
  virtual void plane(Plane plane) = 0;
  virtual void comment(std::string_view text) = 0;
  virtual void literal(std::string_view text) = 0;
  virtual void store_position(bool second) = 0;  // G28.1, G30.1
  /// G28 or G30 through `via` to `end`.
  virtual void restore_position(bool second, const Axes& via, unsigned named, const Axes& end) = 0;
  virtual void layer(const std::string& name) = 0;
  virtual void close_path() = 0;
};

}  // namespace kerf::gcmc

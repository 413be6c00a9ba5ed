// The modal state of a controller, and positions that may be unknown.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "codec/gcode/code_table.h"
#include "path/feed_mode.h"

#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf::gcode {

inline constexpr unsigned kAllAxes = 7;
inline constexpr std::uint32_t kAllLetters = (1u << 26) - 1;
inline constexpr Tenths kMotionNotGiven = -1;     // before the first motion code
inline constexpr Tenths kMotionUnsupported = -2;  // after one that is not supported

/// A position with its unknown axes (Step::unknown_axes).
struct ToolPosition {
  Point3 at;  // mm
  unsigned unknown = kAllAxes;
  Reference reference = Reference::work;  // of reference_axes, which this line sets
  unsigned reference_axes = 0;
};

inline constexpr double kMaxCoordinate = 1e7;  // mm; 10 km
/// Whether the absolute values of all coordinates are <= kMaxCoordinate.
inline bool within_limit(Point3 p) {
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
         std::abs(p.z) <= kMaxCoordinate;
}

/// Modal state.
struct Modes {
  Tenths motion = kMotionNotGiven;
  Plane plane = Plane::xy;
  bool absolute = true;
  bool absolute_centres = false;
  bool centres_stated = false;  // by G90.1 or G91.1
  double scale = 1.0;           // mm of one unit of the program
  FeedMode feed_mode = FeedMode::per_minute;
  double feed = 0.0;        // mm/min, 1/min or mm/turn; 0: none given
  double feed_scale = 1.0;  // `scale` at the F word: #<_feed> is its number, also after a change of units
  double speed = 0.0;       // rpm
  SpindleTurn spindle = SpindleTurn::off;
  bool mist = false, flood = false;
  // M48 to M53: without effect on the toolpath, but programs can read them
  bool feed_override = true, speed_override = true, adaptive_feed = false, feed_hold = true;
  double surface_speed = 0.0;          // mm/min of G96, `speed` is its limit then; 0: the speed is in rpm
  bool speed_given = false;            // an S word was read
  bool retract_to_start = false;       // G98
  bool diameters = false;              // G7: X words are diameters
  std::optional<Point2> polar_centre;  // G16: X words are radii about it, Y words angles; program coordinates
  int system = 1;                      // 1 to 9: G54 to G59.3
  std::optional<int> selected_tool, tool;
  bool zero_stays = false;  // a comment of Kerf's posts: the next touch-off in Z finds the zero that is set
  bool for_snapmaker = false;  // by the header of its files: M76 stops the work, not only its timer
  /// Of the spindle; 0: unknown, or none given.
  double rpm() const { return surface_speed > 0.0 ? 0.0 : speed; }
};

}  // namespace kerf::gcode

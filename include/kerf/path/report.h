// Figures of a toolpath: counts, lengths, bounds, tools, feeds, speeds, and a first estimate of time.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// Minimum and maximum of the values; low above high without values.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool empty() const { return low > high; }
  void add(double v) {
    low = v < low ? v : low;
    high = v > high ? v : high;
  }
};

/// Counts, lengths and times of a part of a toolpath. Motions in machine coordinates count with the values
/// of an interpreter with zero offsets; a helix counts its true length; motions of length 0 are counted.
struct MotionFigures {
  std::size_t lines = 0, arcs = 0, rapids = 0;
  double cut_mm = 0.0, rapid_mm = 0.0;
  Box3 cut_bounds;   // of feed moves and arcs, their starts included, mm
  Box3 cut_ends;     // of the ends of feed moves, and of arcs, mm
  Range feed;        // mm/min, of cutting moves that move X, Y or Z
  Range turn_feed;   // degrees/min, of rotary axes that turn alone
  Range speed;       // rpm, of spindle steps that turn
  Duration cutting;  // and probing to the target, at the programmed feeds, of rotary axes alone in degrees
                     // per minute, without acceleration
  Duration rapid;    // at `rapid_feed`, without acceleration
  Duration dwell;
};

struct ToolFigures {
  std::optional<int> tool;  // nothing: before the first tool change
  MotionFigures figures;
  std::optional<double> deepest;  // lowest Z of its cutting moves, mm
};

struct PathReport {
  MotionFigures all;
  std::vector<ToolFigures> tools;  // in order of first use; a tool used again is one entry
};

struct ReportOptions {
  Feed rapid_feed = mm_per_min(3000);
  /// Maximum rates of X, Y and Z. If all are above 0, a rapid takes the time of its slowest axis, regardless
  /// of `rapid_feed`.
  std::array<Feed, 3> axis_rates{};
  /// Only the steps of [first, end) count.
  std::size_t first = 0, end = std::numeric_limits<std::size_t>::max();
};

PathReport report_on(const Toolpath& path, const ReportOptions& options);

// The time of each step at the programmed feeds. For times as planned by a controller see
// kerf/path/estimate.h.

/// Seconds per step, dwells and motions, as report_on() adds them up; 0 for steps that it does not time.
std::vector<float> reported_seconds(const Toolpath& path, const ReportOptions& options);

}  // namespace kerf

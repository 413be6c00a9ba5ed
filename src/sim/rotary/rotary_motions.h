// The motions of a toolpath for the rotary simulator.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim/rotary/rotary_tool.h"
#include "sim/sweep/survey.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::sim {

inline constexpr double kMaxReach = 1e6;  // mm, of any position

struct RotaryTool {
  Frusta cutting;
  Frusta touching[4];  // as ToolPart numbers them
  Frusta over_flute;
};

/// A straight section of a motion, with a uniform turn of the bar.
struct RotaryMotion {
  Point3 from, to;                                  // mm, work coordinates
  double turn_from = 0.0, turn_to = 0.0;            // radians, A
  double start_fraction = 0.0, end_fraction = 1.0;  // fractions of the step's path
  std::uint32_t step = 0, tool = 0;
  bool cuts = false, spindle_off = false;
  int pieces = 1;          // that are cut one after the other
  bool continues = false;  // from where a motion of the same kind has ended

  Point3 at(double t) const { return from + t * (to - from); }
  double turn(double t) const { return turn_from + t * (turn_to - turn_from); }
  double fraction(double t) const { return start_fraction + t * (end_fraction - start_fraction); }
  double turned() const { return turn_to - turn_from; }
  bool is_along_bar() const { return from.y == to.y && from.z == to.z && turn_from == turn_to; }
  RotaryMotion piece(int number) const;
};

/// Reads motions and tools from the toolpath and reports what cannot be simulated.
class RotaryMotionReader {
 public:
  RotaryMotionReader(const Toolpath& path, const ToolTable& table, const RoundBar& bar, double ray_distance,
                     Diagnostics& diagnostics)
      : path_(path), table_(table), bar_(bar), ray_distance_(ray_distance), diagnostics_(diagnostics) {}

  bool run();
  std::vector<RotaryMotion> motions;
  std::vector<RotaryTool> tools;

 private:
  void add(const Step& step, const MotionContext& context);
  std::optional<std::uint32_t> tool_of(const Step& step, const MotionContext& context);
  void push(RotaryMotion motion);
  double turn_at(const MotionExtra* extra, const MotionContext& context);

  const Toolpath& path_;
  const ToolTable& table_;
  const RoundBar& bar_;
  double ray_distance_;
  Diagnostics& diagnostics_;
  std::map<int, std::uint32_t> index_;
  std::map<int, bool> reported_missing_;
  double turn_ = 0.0, positions_ = 0.0;
  bool judges_spindle_ = false, reported_other_axes_ = false, reported_no_tool_ = false;
};

}  // namespace kerf::sim

// Canned cycles G73, G74 and G81 to G89 as rapids, cuts, dwells and spindle steps.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"

#include "kerf/op/holes.h"

namespace kerf {
namespace {

/// Expands the holes of one cycle.
class Expansion {
 public:
  Expansion(const DrillCycle& cycle, DrillSink& sink)
      : cycle_(cycle), sink_(sink), axis_(axes_of(cycle.plane).w), at_(cycle.at) {}

  void run(Point3 from) {
    if (rises_first(cycle_)) {
      from[axis_] = cycle_.retract_plane;
      sink_.rapid(from);
    }
    const double start = std::max(cycle_.start_level, cycle_.retract_plane);
    clear_ = cycle_.retract == DrillRetract::start ? start : cycle_.retract_plane;
    double travel = std::max(from[axis_], clear_);
    for (int i = 0; i < cycle_.holes && !sink_.is_full(); ++i) {
      if (i > 0) at_ = at_ + cycle_.increment;
      rapid(travel);
      if (travel != cycle_.retract_plane) rapid(cycle_.retract_plane);
      hole();
      travel = clear_;
    }
  }

 private:
  /// From the retract plane to the bottom and back to the clear level.
  void hole() {
    switch (cycle_.kind) {
      case DrillKind::chip_break:
      case DrillKind::peck: return pecks();
      case DrillKind::tap: return tap(SpindleTurn::cw, SpindleTurn::ccw);
      case DrillKind::left_tap: return tap(SpindleTurn::ccw, SpindleTurn::cw);
      case DrillKind::back_bore: return back_bore();
      default: break;
    }
    cut(cycle_.bottom);
    switch (cycle_.kind) {
      case DrillKind::dwell: dwell(); return rapid(clear_);
      case DrillKind::bore: cut(cycle_.retract_plane); return rapid(clear_);
      case DrillKind::stopped_bore: dwell(); return retract_stopped(Pause::no);
      case DrillKind::manual_bore: dwell(); return retract_stopped(Pause::yes);
      case DrillKind::dwell_bore: dwell(); return cut(clear_);
      default: return rapid(clear_);
    }
  }

  void pecks() {
    double depth = cycle_.peck.mm();
    const double less = cycle_.peck_less.mm(), least = cycle_.smallest_peck().mm();
    const double clearance = cycle_.peck_clearance.mm();
    const double lowest = cycle_.bottom + cycle_.weld.mm();
    for (double level = cycle_.retract_plane - depth; level > lowest && !sink_.is_full(); level -= depth) {
      cut(level);
      if (cycle_.kind == DrillKind::peck) rapid(cycle_.retract_plane);
      rapid(level + clearance);
      depth = std::max(depth - less, least);
    }
    cut(cycle_.bottom);
    rapid(clear_);
  }

  void tap(SpindleTurn in, SpindleTurn out) {
    cut(cycle_.bottom);
    sink_.spindle(out);
    dwell();
    cut(clear_);
    sink_.spindle(in);
  }

  enum class Pause : bool { no, yes };
  void retract_stopped(Pause pause) {
    sink_.spindle(SpindleTurn::off);
    if (pause == Pause::yes) sink_.pause();
    rapid(clear_);
    sink_.spindle(cycle_.turn);
  }

  void back_bore() {
    const Point3 hole = at_, aside = at_ + cycle_.aside;
    at_ = aside;
    rapid(cycle_.retract_plane);
    sink_.spindle(SpindleTurn::off);
    rapid(cycle_.bottom);
    at_ = hole;
    rapid(cycle_.bottom);
    sink_.spindle(cycle_.turn);
    cut(cycle_.back_level);
    cut(cycle_.bottom);
    sink_.spindle(SpindleTurn::off);
    at_ = aside;
    rapid(cycle_.bottom);
    rapid(clear_);
    at_ = hole;
    rapid(clear_);
    sink_.spindle(cycle_.turn);
  }

  Point3 at_level(double level) const {
    Point3 to = at_;
    to[axis_] = level;
    return to;
  }
  void rapid(double level) { sink_.rapid(at_level(level)); }
  void cut(double level) { sink_.cut(at_level(level)); }
  void dwell() {
    if (cycle_.dwell > Duration{}) sink_.dwell(cycle_.dwell);
  }

  const DrillCycle& cycle_;
  DrillSink& sink_;
  int axis_;
  Point3 at_;           // of the hole
  double clear_ = 0.0;  // level after the hole
};

/// Steps of a toolpath at one feed and speed.
class ToolpathSink final : public DrillSink {
 public:
  ToolpathSink(Toolpath& path, const DrillRates& rates, OriginId origin)
      : path_(path), rates_(rates), origin_(origin) {}
  void rapid(Point3 to) override { path_.add(step::Rapid{to}, origin_); }
  void cut(Point3 to) override { path_.add(step::Cut{to, rates_.feed}, origin_); }
  void dwell(Duration time) override { path_.add(step::Dwell{time}, origin_); }
  void spindle(SpindleTurn turn) override {
    path_.add(step::Spindle{turn == SpindleTurn::off ? rpm(0) : rates_.speed, turn}, origin_);
  }
  void pause() override { path_.add(step::Pause{}, origin_); }

 private:
  Toolpath& path_;
  const DrillRates& rates_;
  OriginId origin_;
};

}  // namespace

std::optional<DrillFault> fault_of(const DrillCycle& cycle, double max_pecks) {
  if (cycle.retract_plane < cycle.bottom - cycle.weld.mm())
    return DrillFault{codes::cycle_upside_down,
                      fmt::format("the retract plane R is {:.4g} mm below the bottom of the hole",
                                  cycle.bottom - cycle.retract_plane)};
  if (!cycle.has_pecks()) return std::nullopt;
  if (!(cycle.smallest_peck() > Length{}))
    return DrillFault{codes::word_missing, "the depth of a peck must be above 0"};
  const double depth = cycle.retract_plane - cycle.bottom, peck = cycle.smallest_peck().mm();
  const double far = std::max(std::abs(cycle.retract_plane), std::abs(cycle.bottom));
  // A peck smaller than the rounding error of the levels makes no progress.
  if (depth > 0.0 && (depth / peck > max_pecks || far - peck == far))
    return DrillFault{codes::word_out_of_range,
                      fmt::format("pecks of {:g} mm are more than {:g} in one hole", peck, max_pecks)};
  return std::nullopt;
}

double min_steps(const DrillCycle& cycle) {
  double steps = 3.0;  // to the hole, down, out
  if (cycle.has_pecks()) {
    const double pecks = (cycle.retract_plane - cycle.bottom) / cycle.peck.mm() - 1.0;
    steps += std::max(pecks, 0.0) * (cycle.kind == DrillKind::peck ? 3.0 : 2.0);
  }
  return steps * cycle.holes;
}

void expand(const DrillCycle& cycle, Point3 from, DrillSink& sink) { Expansion(cycle, sink).run(from); }

void add_cycle(Toolpath& path, const DrillCycle& cycle, Point3 from, const DrillRates& rates,
               OriginId origin) {
  ToolpathSink sink(path, rates, origin);
  expand(cycle, from, sink);
}

}  // namespace kerf

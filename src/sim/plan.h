// From the motions of a toolpath to sweeps, sorted by the tiles that they can touch.
//
// Where a motion begins is not always known (see Step::unknown_axes). A path that was never commanded must
// neither cut nor be reported, so:
//   rapid   whose end, or the height of whose begin, is unknown: not swept;
//           whose begin is unknown in X or Y only: the tool at its end, which is the one place where it
//           surely is;
//   cut     whose end height is unknown: not swept;
//           whose begin height is unknown: begins above the block, or at its end if that is higher;
//           whose begin is unknown in X or Y: begins at its end's;
//           whose end is unknown in X or Y: goes where an interpreter with zero offsets goes (with a
//           warning);
//   arc     whose begin is unknown: the tool at its end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/sweep.h"
#include "sim/tile.h"

#include "kerf/toolpath.h"

namespace kerf::sim {

/// Sweeps in time order, and which sweep can touch which tile.
struct Batch {
  struct Pair {
    std::uint32_t tile;
    std::uint32_t sweep;
  };
  std::vector<Sweep> sweeps;
  std::vector<Pair> pairs;
  std::vector<Contact> contacts;  // found by the planner itself: below_floor

  bool full() const;
  void clear();
};

/// Which pairs of sweep and tile are wanted. The usual ones: of all tiles, where a column's centre is
/// reached.
struct PlanScope {
  double margin = 0.0;                       // mm, how far from the centres there is something to reach
  const std::vector<bool>* tiles = nullptr;  // only these
};

class Planner {
 public:
  Planner(const Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth,
          PlanScope scope = {});

  /// Adds a motion of a tool; `spindle_off`: what it cuts is cut with a spindle that stands. `flush` is
  /// called whenever the batch is full and returns false to stop.
  template <class Flush>
  void add(const Step& step, const MotionContext& context, std::uint32_t tool, bool spindle_off, Batch& batch,
           const Flush& flush);
  /// Forgets where the tool was: nothing follows the sweep before.
  void interrupt() { cutting_tool_.reset(); }

 private:
  struct Motion {
    Point3 from, to;  // block frame
    bool is_swept = true;
  };
  Motion motion_of(const Step& step, const MotionContext& context) const;
  Sweep line(Point3 from, Point3 to) const;
  std::optional<Sweep> level_arc(const ArcWalk& walk) const;
  bool can_meet(const ArcWalk& walk, std::uint32_t tool) const;
  void emit(Sweep sweep, Batch& batch);
  std::uint8_t passes_that_meet(const Sweep& sweep, std::uint8_t wanted, double& reach) const;
  void note_below_floor(const Sweep& sweep, Batch& batch) const;
  /// Number of the tile a place along X or Y is in; any number below 0 or above the last outside.
  int tile_at(double place) const {
    return static_cast<int>(std::clamp(std::floor(place * per_tile_), -1.0, 1e6));
  }
  void pair_box(const Sweep& sweep, double x1, double y1, double reach, std::uint32_t number,
                Batch& batch) const;
  void pair_line(const Sweep& sweep, double reach, std::uint32_t number, Batch& batch) const;
  void pair_arc(const Sweep& sweep, double reach, std::uint32_t number, Batch& batch) const;
  void pair(int column, int row, std::uint32_t number, Batch& batch) const;

  const Workpiece::Body& body_;
  const std::vector<ToolSolids>& tools_;
  double hazard_depth_;
  PlanScope scope_;
  double per_tile_;
  Point3 size_;
  std::optional<std::uint32_t> cutting_tool_;  // of the sweep before, if that cut
  Point3 end_;                                 // where it ended, block frame
};

/// Chords for the arc of `walk` at the simulator's tolerance, and whether that many are more than are made.
struct ChordCount {
  int count = 1;
  bool too_coarse = false;
};
ChordCount chord_count(const ArcWalk& walk);

template <class Flush>
void Planner::add(const Step& step, const MotionContext& context, std::uint32_t tool, bool spindle_off,
                  Batch& batch, const Flush& flush) {
  const Motion motion = motion_of(step, context);
  const bool cuts = step.is_cutting();
  if (!motion.is_swept) return interrupt();
  const bool follows = cuts && cutting_tool_ == tool && end_ == motion.from;
  const int parts = kPassNeck | kPassShank | kPassHolder;
  const int passes =
      cuts ? kPassCut | kPassOverFlute | parts | (spindle_off ? kPassSpindleOff : 0) : kPassRapid | parts;
  const auto send = [&](Sweep sweep, bool follows_on) {
    sweep.step = static_cast<std::uint32_t>(context.index);
    sweep.tool = tool;
    sweep.passes = static_cast<std::uint8_t>(passes);
    sweep.follows = follows_on;
    emit(sweep, batch);
    return !batch.full() || flush();
  };
  cutting_tool_ = cuts ? std::optional(tool) : std::nullopt;
  end_ = motion.to;
  if (step.kind() != StepKind::arc || context.unknown_from != 0) {
    send(line(motion.from, motion.to), follows);
    return;
  }
  ArcWalk walk = walk_of(step, context.from);
  const PlaneAxes axes = axes_of(walk.plane);
  walk.u -= body_.bounds.low[axes.u];
  walk.v -= body_.bounds.low[axes.v];
  walk.start_w -= body_.bounds.low[axes.w];
  walk.end_w -= body_.bounds.low[axes.w];
  if (!can_meet(walk, tool)) return;
  if (const std::optional<Sweep> arc = level_arc(walk)) {
    send(*arc, false);
    return;
  }
  const int count = chord_count(walk).count;
  Point3 from = walk.at(0.0);
  for (int k = 0; k < count; ++k) {
    const Point3 to = walk.at((k + 1.0) / count);
    Sweep chord = line(from, to);
    chord.share_begin = static_cast<float>(k) / static_cast<float>(count);
    chord.share_end = static_cast<float>(k + 1) / static_cast<float>(count);
    if (!send(chord, cuts && (k > 0 || follows))) return;
    from = to;
  }
}

}  // namespace kerf::sim

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
//   arc     whose begin is unknown in X or Y: begins where an interpreter with zero offsets is (with a
//           warning), since its centre is told from there;
//           whose begin height is unknown: the tool at its end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/dexel/tile.h"
#include "sim/sweep/sweep.h"

#include "kerf/toolpath.h"

namespace kerf::sim {

/// Sweeps in time order, and which sweep can touch which tile: first in order of sweeps, and once sorted in
/// order of tiles.
struct Batch {
  struct Pair {
    std::uint32_t tile;
    std::uint32_t sweep;
  };
  /// A sweep that touches no tile but passes near one, see PlanScope.
  struct Beside {
    Sweep sweep;
    std::size_t before;  // how many of `sweeps` precede it
  };
  std::vector<Sweep> sweeps;
  std::vector<Pair> pairs;
  std::vector<Beside> beside;
  std::vector<Contact> contacts;  // found by the planner itself: below_floor
  std::size_t steps_done = 0;     // of the toolpath, with this batch
  bool is_last = false;

  bool full() const;
  void clear();
  /// Sorts the pairs by tile; `tiles` is the number of all tiles.
  void sort(std::size_t tiles);

  // Tile busy[k] has the sweeps list[start[k]] to list[start[k + 1] - 1], in order of time.
  std::vector<std::uint32_t> busy, list;
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> order;  // of busy: the largest first, so that the threads end together

 private:
  std::vector<std::uint32_t> count_;
};

/// Which pairs of sweep and tile are wanted. By default: those of all tiles where a column's centre is
/// reached.
struct PlanScope {
  double margin = 0.0;                       // mm, maximum distance from the centres
  double beside = 0.0;                       // mm, the same of sweeps that are listed as Batch::beside
  const std::vector<bool>* tiles = nullptr;  // only these
};

class Planner {
 public:
  Planner(const Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth,
          PlanScope scope = {});

  /// Adds a motion of a tool; `spindle_off`: what it cuts is cut with a spindle that stands. An arc of more
  /// chords than the batch holds is left unfinished.
  void add(const Step& step, const MotionContext& context, std::uint32_t tool, bool spindle_off,
           Batch& batch);
  bool unfinished() const { return chords_.next < chords_.count; }
  /// Adds more of an unfinished motion, until it ends or the batch is full.
  void go_on(Batch& batch);
  /// Adds a sweep that another planner has made of the same workpiece and tools.
  void add(const Sweep& planned, Batch& batch);
  /// Takes a motion as done: the next may follow it.
  void pass_over(const Step& step, const MotionContext& context, std::uint32_t tool);
  /// Forgets where the tool was: nothing follows the sweep before.
  void interrupt() { cutting_tool_.reset(); }

 private:
  struct Motion {
    Point3 from, to;  // block frame
    bool is_swept = true;
  };
  /// An arc on its way into batches.
  struct Chords {
    ArcWalk walk;
    Sweep like;  // in all but its place
    int next = 0, count = 0;
    bool first_follows = false, others_follow = false;
    Point3 from;
  };
  Motion motion_of(const Step& step, const MotionContext& context) const;
  void remember(const Step& step, std::uint32_t tool, const Point3& end) {
    cutting_tool_ = step.is_cutting() ? std::optional(tool) : std::nullopt;
    end_ = end;
  }
  void add_arc(const Step& step, const MotionContext& context, Batch& batch);
  bool can_meet(const ArcWalk& walk, std::uint32_t tool) const;
  /// What tells quickly that a tool cannot meet something.
  struct ToolExtent {
    double widest;        // largest radius of all parts, mm
    double other_bottom;  // the lowest of what does not cut, mm above the tip
  };
  bool is_far(const Motion& motion, std::uint32_t tool) const;
  void emit(const Point3& to, Batch& batch);
  bool find_pairs(Sweep& sweep, const Point3& to, Batch& batch) const;
  bool find_tiles(const Sweep& sweep, const Point3& to, double reach, Batch& batch) const;
  std::uint8_t passes_that_meet(const Sweep& sweep, double& reach) const;
  void note_below_floor(const Sweep& sweep, Batch& batch) const;
  /// Number of the tile a place along X or Y is in; any number below 0 or above the last outside.
  int tile_at(double place) const {
    // std::floor is a call, and std::clamp branches.
    return static_cast<int>(std::min(std::max(place * per_tile_ + 1.0, 0.0), 1e6)) - 1;
  }
  void pair_box(const Sweep& sweep, const Point3& to, double reach, std::uint32_t number, Batch& batch) const;
  void pair_line(const Sweep& sweep, const Point3& to, double reach, std::uint32_t number,
                 Batch& batch) const;
  void pair_arc(const Sweep& sweep, double reach, std::uint32_t number, Batch& batch) const;
  void pair(int column, int row, std::uint32_t number, Batch& batch) const {
    const auto tile = static_cast<std::uint32_t>(row * body_.tiles_x + column);
    if (scope_.tiles == nullptr || (*scope_.tiles)[tile]) batch.pairs.push_back({tile, number});
  }

  const Workpiece::Body& body_;
  const std::vector<ToolSolids>& tools_;
  std::vector<ToolExtent> extents_;  // one a tool
  double hazard_depth_;
  PlanScope scope_;
  Box3 wanted_;  // around the tiles of the scope; in X and Y only
  double per_tile_;
  Point3 size_;
  std::optional<std::uint32_t> cutting_tool_;  // of the sweep before, if that cut
  Point3 end_;                                 // where it ended, block frame
  Chords chords_;
};

/// Chords for the arc of `walk` at the simulator's tolerance, and whether that many are more than are made.
struct ChordCount {
  int count = 1;
  bool too_coarse = false;
};
ChordCount chord_count(const ArcWalk& walk);

}  // namespace kerf::sim

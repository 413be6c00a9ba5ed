// From the motions of a toolpath to sweeps, sorted by the tiles that they can touch.
//
// The start of a motion may be unknown (see Step::unknown_axes). A path that was never commanded must neither
// cut nor be reported. Therefore:
//   rapid   end unknown: not swept
//           start height unknown: down to its end from above the block
//           start unknown in X or Y only: the tool at its end, the only position that is certain
//   cut     end height unknown: not swept
//           start height unknown: starts above the block, or at the end height if that is higher
//           start unknown in X or Y: starts at the X or Y of its end
//           end unknown in X or Y: as an interpreter with zero offsets (with a warning)
//   arc     start unknown in X or Y: as an interpreter with zero offsets (with a warning), as the centre is
//           relative to it
//           start height unknown: the tool at its end
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/dexel/tile.h"
#include "sim/sweep/sweep.h"

#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"

namespace kerf::sim {

/// Sweeps in time order, and which sweep can touch which tile: first in the order of sweeps, after sort() in
/// the order of tiles.
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
  std::vector<std::uint32_t> order;  // of busy: the tile with the most sweeps first, so that all threads
                                     // finish at about the same time

 private:
  std::vector<std::uint32_t> count_;
};

/// The wanted pairs of sweep and tile; by default those of all tiles with a column centre in reach.
struct PlanScope {
  double margin = 0.0;                       // mm, maximum distance from the centres
  double beside = 0.0;                       // mm, the same for sweeps listed in Batch::beside
  const std::vector<bool>* tiles = nullptr;  // only these
};

class Planner {
 public:
  Planner(const Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth,
          PlanScope scope = {}, const Surroundings& surroundings = {});

  /// Adds a motion of a tool; `spindle_off`: it cuts with the spindle stopped. An arc with more chords than
  /// the batch can hold is left unfinished.
  void add(const Step& step, const MotionContext& context, std::uint32_t tool, bool spindle_off,
           Batch& batch);
  bool unfinished() const { return chords_.next < chords_.count; }
  /// Adds more of an unfinished motion, until it ends or the batch is full.
  void resume(Batch& batch);
  /// Adds a sweep made by another planner for the same workpiece and tools.
  void add(const Sweep& planned, Batch& batch);
  /// Skips a motion that counts as done, so that the next one may follow it.
  void skip(const Step& step, const MotionContext& context, std::uint32_t tool);
  /// Forgets the tool position: the next sweep follows none.
  void interrupt() { cutting_tool_.reset(); }

 private:
  struct Motion {
    Point3 from, to;  // block frame
    bool is_swept = true;
  };
  /// An arc of which some chords are not in a batch yet.
  struct Chords {
    ArcWalk walk;
    Sweep like;  // all but the geometry
    int next = 0, count = 0;
    bool first_follows = false, others_follow = false;
    Point3 from;
  };
  Motion motion_of(const Step& step, const MotionContext& context) const;
  void remember(const Step& step, std::uint32_t tool, const Point3& end) {
    cutting_tool_ = step.is_cutting() ? std::optional(tool) : std::nullopt;
    end_ = end;
  }
  void add_by_axis(const Point3& from, const Point3& to, Batch& batch);
  void add_arc(const Step& step, const MotionContext& context, Batch& batch);
  bool can_meet(const ArcWalk& walk, std::uint32_t tool) const;
  /// For a quick test that a tool is clear of something.
  struct ToolExtent {
    double widest;        // largest radius of all parts, mm
    double other_bottom;  // lowest point of the parts that do not cut, mm above the tip
  };
  bool is_far(const Motion& motion, std::uint32_t tool) const;
  void emit(const Point3& to, Batch& batch);
  bool find_pairs(Sweep& sweep, const Point3& to, Batch& batch) const;
  bool find_tiles(const Sweep& sweep, const Point3& to, double reach, Batch& batch) const;
  std::uint8_t passes_that_meet(const Sweep& sweep, double& reach) const;
  void note_below_floor(const Sweep& sweep, Batch& batch) const;
  /// Number of the tile of a coordinate along X or Y; outside any number below 0 or above the last.
  int tile_at(double v) const {
    // std::floor is a call, and std::clamp branches.
    return static_cast<int>(std::min(std::max(v * per_tile_ + 1.0, 0.0), 1e6)) - 1;
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
  std::vector<ToolExtent> extents_;  // one per tool
  double hazard_depth_;
  PlanScope scope_;
  std::optional<AxisRates> rapid_rates_;
  double floor_;  // cuts below it are hazards, mm above that of the block
  Box3 wanted_;   // around the tiles of the scope; in X and Y only
  double per_tile_;
  Point3 size_;
  std::optional<std::uint32_t> cutting_tool_;  // of the previous sweep, if that cut
  Point3 end_;                                 // its end, block frame
  Chords chords_;
};

/// Chords of an arc at the simulator's tolerance, and whether they are limited to the maximum number.
struct ChordCount {
  int count = 1;
  bool too_coarse = false;
};
ChordCount chord_count(const ArcWalk& walk);

}  // namespace kerf::sim

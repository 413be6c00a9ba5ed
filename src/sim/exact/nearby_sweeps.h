// Finds the sweeps near query points of a mesh, and the signed distance to what they removed.
//
// A point may be near thousands of sweeps, of which a few bound the material within reach. The lists shrink
// in four steps: sweeps by tile (SweepsByTile), by block of 8 x 8 columns, by cube of 8 columns (both in
// SweepFinder; SweepsByTile keeps the lists of cubes), and around the query point itself (NearbySweeps).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "base/parallel.h"
#include "sim/cut/simulation_plan.h"
#include "sim/dexel/tile.h"
#include "sim/exact/sweep_distance.h"

namespace kerf::sim {

/// The order in which NearbySweeps::gather expects sweeps: level ones first, those of one tool at one height
/// next to each other.
bool is_gathered_before(const Sweep* a, const Sweep* b);

/// The sweeps that can bound the material within `reach` of a centre. Material is where the distances to all
/// sweeps are above 0, so the distance to the removed volume is their minimum.
class NearbySweeps {
 public:
  NearbySweeps(const std::vector<ToolDistance>& tools, double reach) : tools_(tools), reach_(reach) {}
  /// Selects from `sweeps`, which are in the order of is_gathered_before, around a new centre.
  void gather(const std::vector<const Sweep*>& sweeps, Point3 centre);
  /// Selects from `wider`, which must cover the reach of the new centre.
  void gather(const NearbySweeps& wider, Point3 centre);
  /// Signed distance to the removed volume; the gradient points into the material.
  Distance at(Point3 point) const;
  /// Calls visit(sweep) for each selected sweep, in the order of is_gathered_before.
  template <class Visit>
  void for_each(const Visit& visit) const;
  /// Whether all sweeps within `reach` of a point are included.
  bool covers(Point3 point, double reach) const;

 private:
  /// Sweeps of one tool at one height: level_[first] to level_[end - 1].
  struct LevelGroup {
    std::size_t first, end;
    double low;  // distance of the centre to the nearest of them
  };
  /// A sweep's path in plan: what nearest_in_plan needs of a line.
  struct PlanLine {
    double x, y, ux, uy, length;
    static PlanLine of(const Sweep& sweep) {
      return {sweep.x, sweep.y, sweep.ux, sweep.uy, sweep.is_arc ? 0.0 : sweep.length};
    }
    /// From the nearest point of the line to `point`.
    Point2 vector_to(Point2 point) const {
      const double dx = point.x - x, dy = point.y - y;
      const double t = std::min(std::max(dx * ux + dy * uy, 0.0), length);
      return {dx - t * ux, dy - t * uy};
    }
  };
  /// A slope or a plunge.
  struct SlopedSweep {
    double low;  // lower bound of its distance to the centre
    const Sweep* sweep;
    PathDistance nearest;  // to the centre
    bool is_computed;      // whether `nearest` is, and `low` exact
  };
  void clear_around(Point3 centre);
  double gather_level(const Sweep* const* sweeps, const PlanLine* lines, std::size_t count);
  void discard_far(double nearest);
  Point2 nearest_of(const LevelGroup& group, Point2 point) const;

  const std::vector<ToolDistance>& tools_;
  double reach_;
  Point3 centre_;
  std::vector<LevelGroup> groups_;
  std::vector<const Sweep*> level_;
  std::vector<PlanLine> lines_;        // of level_; arcs have length 0
  std::vector<SlopedSweep> sloped_;    // nearest first
  std::vector<PlanLine> group_lines_;  // scratch of gather
  std::vector<Point2> vectors_;        // scratch: from each path of a group to the centre, in plan
};

/// A query point, located for sorting: its tile, its block of columns in the tile, and its layer (the cube of
/// the block that contains its Z).
struct QueryPoint {
  std::uint32_t tile = 0, block = 0;
  std::int32_t layer = 0;
  std::uint32_t number = 0;  // of its vertex, corner or edge
  bool operator<(const QueryPoint& other) const {
    return std::tie(tile, block, layer, number) <
           std::tie(other.tile, other.block, other.layer, other.number);
  }
};

/// All sweeps of a job that pass near some tiles.
class SweepsByTile {
 public:
  /// `reach`: maximum distance of a sweep from a query point, mm.
  SweepsByTile(const Workpiece::Body& body, const std::vector<ToolDistance>& tools, double reach)
      : body_(body), tools_(tools), reach_(reach) {}
  /// Gathers them for the tiles of the query points, from the batches that the simulation has kept or by
  /// planning its toolpath again. `stop` is called between batches.
  template <class Stop>
  void gather(const Simulation& simulation, const std::vector<QueryPoint>& queries, const Stop& stop);

  /// Of all gathered sweeps: nothing is removed below this Z.
  double lowest() const { return lowest_; }
  QueryPoint query_at(Point3 point, std::uint32_t number) const;
  /// Calls work(n, finder) for each query point n on all threads. `queries` must be sorted.
  /// Not for two threads at once: the lists of cubes are kept for the next visit.
  template <class Work, class Stop>
  void visit(const std::vector<QueryPoint>& queries, unsigned threads, const Work& work, const Stop& stop);

 private:
  void take(const Batch& batch);
  void take_kept(const Batch& batch, Planner& planner);
  void sort_for_gathering();
  friend class SweepFinder;
  /// The sweeps selected for a cube. Later visits select from these few again instead of all of a block.
  struct CubeList {
    std::uint32_t block;
    std::int32_t layer;
    std::vector<std::uint32_t> sweeps;
    bool is_before(const QueryPoint& query) const {
      return std::tie(block, layer) < std::tie(query.block, query.layer);
    }
    bool is_of(const QueryPoint& query) const { return block == query.block && layer == query.layer; }
  };

  const Workpiece::Body& body_;
  const std::vector<ToolDistance>& tools_;
  double reach_;
  double lowest_ = std::numeric_limits<double>::infinity();
  std::vector<Sweep> sweeps_;
  /// Of each tile, sorted by block and layer. Changed while a thread visits the tile.
  std::vector<std::vector<CubeList>> cubes_of_tile_;
  std::vector<std::vector<std::uint32_t>> of_tile_;        // in order of steps
  std::vector<std::vector<std::uint32_t>> ready_of_tile_;  // the same in the order of is_gathered_before
};

/// The sweeps near the query points of one tile, visited in sorted order, so that the lists of a block and of
/// a cube are computed once.
class SweepFinder {
 public:
  explicit SweepFinder(SweepsByTile& sweeps);
  void move_to(const QueryPoint& query);
  /// All sweeps within reach of a point.
  const NearbySweeps& all(Point3 point);
  /// The list of the point's cube: cheaper than `all` if a single distance is needed.
  const NearbySweeps& all_of_cube(Point3 point);
  /// Only sweeps of the steps that made the 4 x 4 columns around a point. Faster, and sufficient where the
  /// surface is smooth.
  const NearbySweeps& of_columns(Point3 point);

 private:
  Point3 cube_centre() const;
  void gather_block();
  void gather_cube();

  struct Reachable {
    const Sweep* sweep;
    Point2 vector;  // from the path to the block's centre, in plan
  };
  SweepsByTile& sweeps_;
  NearbySweeps of_cube_, nearby_;
  QueryPoint query_;
  bool has_block_ = false, has_cube_ = false;
  std::vector<Reachable> reachable_;
  std::vector<const Sweep*> of_block_, of_columns_, known_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> steps_;
};

template <class Visit>
void NearbySweeps::for_each(const Visit& visit) const {
  for (const LevelGroup& group : groups_)
    for (std::size_t k = group.first; k < group.end; ++k) visit(*level_[k]);
  std::vector<const Sweep*> sloped;
  for (const SlopedSweep& one : sloped_) sloped.push_back(one.sweep);
  std::sort(sloped.begin(), sloped.end(), is_gathered_before);
  for (const Sweep* sweep : sloped) visit(*sweep);
}

template <class Stop>
void SweepsByTile::gather(const Simulation& simulation, const std::vector<QueryPoint>& queries,
                          const Stop& stop) {
  std::vector<bool> wanted(body_.tiles.size(), false);
  for (const QueryPoint& query : queries) wanted[query.tile] = true;
  of_tile_.resize(body_.tiles.size());
  cubes_of_tile_.assign(body_.tiles.size(), {});
  const PlanScope scope{.margin = 2.0 * reach_, .tiles = &wanted};
  const Simulation::Plan& plan = *simulation.plan;
  if (plan.batches.complete()) {
    Planner planner(body_, plan.survey.solids, Length(), scope);
    for (const auto& batch : plan.batches.batches()) {
      if (stop()) break;
      take_kept(*batch, planner);
    }
    sort_for_gathering();
    return;
  }
  const Toolpath& path = *simulation.job.path;
  BatchSource source(body_, path, plan.survey,
                     {.plan = scope, .steps = {StepRange{0, path.size()}}, .hazard_depth = Length()});
  for (bool more = true; more;) {
    const auto batch = source.next();
    take(*batch);
    more = !batch->is_last && !stop();
  }
  sort_for_gathering();
}

template <class Work, class Stop>
void SweepsByTile::visit(const std::vector<QueryPoint>& queries, unsigned threads, const Work& work,
                         const Stop& stop) {
  std::vector<std::size_t> first;  // query point of each tile
  for (std::size_t n = 0; n < queries.size(); ++n)
    if (n == 0 || queries[n].tile != queries[n - 1].tile) first.push_back(n);
  first.push_back(queries.size());
  const auto do_tile = [&](std::size_t k) {
    SweepFinder finder(*this);
    for (std::size_t n = first[k]; n < first[k + 1]; ++n) {
      finder.move_to(queries[n]);
      work(n, finder);
    }
  };
  parallel_for(threads, first.size() - 1, do_tile, stop);
}

}  // namespace kerf::sim

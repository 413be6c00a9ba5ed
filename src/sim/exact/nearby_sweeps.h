// Places on a mesh and the sweeps that can have cut near them, tile by tile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "base/parallel.h"
#include "sim/cut/simulation_plan.h"
#include "sim/dexel/tile.h"
#include "sim/exact/sweep_distance.h"

namespace kerf::sim {

/// Sweeps in the order that Nearby wants them in: level ones of one tool at one height together.
bool comes_before(const Sweep* a, const Sweep* b);

/// What sweeps leave near a place: the material is where all distances are above 0.
class Nearby {
 public:
  Nearby(const std::vector<ToolDistance>& tools, double reach) : tools_(tools), reach_(reach) {}
  /// Those of `sweeps` (in order) that may bound the material within `reach` of a place.
  void gather(const std::vector<const Sweep*>& sweeps, Point3 place);
  /// Those of `wider`, which holds all that can be met there.
  void gather(const Nearby& wider, Point3 place);
  /// To what is taken away, with the direction into the material.
  Distance at(Point3 place) const;
  /// Whether it is all that can be met within `reach` of a place.
  bool holds(Point3 place, double reach) const;

 private:
  struct Level {  // sweeps of one tool at one height: level_[first] to level_[end - 1]
    std::size_t first, end;
    double low;  // the distance of the nearest to the place that all were gathered around
  };
  struct Line {  // what is needed of a sweep to find its nearest place in plan
    double x, y, ux, uy, length;
    static Line of(const Sweep& sweep) {
      return {sweep.x, sweep.y, sweep.ux, sweep.uy, sweep.is_arc ? 0.0 : sweep.length};
    }
    Point2 way_to(Point2 place) const {
      const double dx = place.x - x, dy = place.y - y;
      const double t = std::min(std::max(dx * ux + dy * uy, 0.0), length);
      return {dx - t * ux, dy - t * uy};
    }
  };
  struct Other {
    double low;  // not above that distance
    const Sweep* sweep;
    Nearest nearest;  // to that place
    bool is_known;    // whether it is
  };
  void begin(Point3 place);
  double gather_level(const Sweep* const* sweeps, const Line* lines, std::size_t count);
  void keep_near(double nearest);
  Point2 nearest_of(const Level& level, Point2 place) const;

  const std::vector<ToolDistance>& tools_;
  double reach_;
  Point3 around_;  // the place that all were gathered around
  std::vector<Level> levels_;
  std::vector<const Sweep*> level_;
  std::vector<Line> lines_;     // of level_; arcs have no length
  std::vector<Other> others_;   // the nearest first
  std::vector<Line> of_level_;  // that is being gathered
  std::vector<Point2> ways_;    // in plan
};

/// A place that is looked at, in its tile, its block of columns there, and its layer of that.
struct QueryPoint {
  std::uint32_t tile = 0, block = 0;
  std::int32_t layer = 0;
  std::uint32_t number = 0;  // whose place it is
  bool operator<(const QueryPoint& other) const {
    return std::tie(tile, block, layer, number) <
           std::tie(other.tile, other.block, other.layer, other.number);
  }
};

/// All sweeps of a job that come near some tiles.
class SweepsByTile {
 public:
  /// `reach`: how far from a place there is something to be found, mm.
  SweepsByTile(const Workpiece::Body& body, const std::vector<ToolDistance>& tools, double reach)
      : body_(body), tools_(tools), reach_(reach) {}
  /// Gathers them for the tiles of some query points, from the batches that the simulation has kept or by
  /// planning its path again. `stop` is asked now and then.
  template <class Stop>
  void gather(const Simulation& simulation, const std::vector<QueryPoint>& queries, const Stop& stop);

  QueryPoint query_at(Point3 place, std::uint32_t number) const;
  /// Calls work(n, around) for number n of the query points, which are in order, on all threads.
  template <class Work, class Stop>
  void visit(const std::vector<QueryPoint>& queries, unsigned threads, const Work& work,
             const Stop& stop) const;

 private:
  void take(const Batch& batch);
  void take_kept(const Batch& batch, Planner& planner);
  friend class Around;

  const Workpiece::Body& body_;
  const std::vector<ToolDistance>& tools_;
  double reach_;
  std::vector<Sweep> sweeps_;
  std::vector<std::vector<std::uint32_t>> of_tile_;
};

/// What is around the query points of one tile, one after the other.
class Around {
 public:
  explicit Around(const SweepsByTile& sweeps);
  void go_to(const QueryPoint& query);
  /// From all sweeps.
  const Nearby& all(Point3 place);
  /// The same for one look.
  const Nearby& wider(Point3 place);
  /// From those that made the columns around a place: quicker, and as good where the surface is smooth.
  const Nearby& of_columns(Point3 place);

 private:
  Point3 middle() const;
  void gather_block();

  struct Reachable {
    const Sweep* sweep;
    Point2 way;  // from there to the block's middle, in plan
  };
  const SweepsByTile& sweeps_;
  Nearby wider_, nearby_;  // the wider ones serve several places
  QueryPoint query_;
  bool has_block_ = false, has_wider_ = false;
  std::vector<Reachable> reachable_;
  std::vector<const Sweep*> of_block_, of_columns_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> steps_;
};

template <class Stop>
void SweepsByTile::gather(const Simulation& simulation, const std::vector<QueryPoint>& queries,
                          const Stop& stop) {
  std::vector<bool> wanted(body_.tiles.size(), false);
  for (const QueryPoint& query : queries) wanted[query.tile] = true;
  of_tile_.resize(body_.tiles.size());
  const PlanScope scope{.margin = 2.0 * reach_, .tiles = &wanted};
  const Simulation::Plan& plan = *simulation.plan;
  if (plan.batches.complete()) {
    Planner planner(body_, plan.survey.solids, Length(), scope);
    for (const auto& batch : plan.batches.batches()) {
      if (stop()) return;
      take_kept(*batch, planner);
    }
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
}

template <class Work, class Stop>
void SweepsByTile::visit(const std::vector<QueryPoint>& queries, unsigned threads, const Work& work,
                         const Stop& stop) const {
  std::vector<std::size_t> begin;
  for (std::size_t n = 0; n < queries.size(); ++n)
    if (n == 0 || queries[n].tile != queries[n - 1].tile) begin.push_back(n);
  begin.push_back(queries.size());
  const auto do_tile = [&](std::size_t k) {
    Around around(*this);
    for (std::size_t n = begin[k]; n < begin[k + 1]; ++n) {
      around.go_to(queries[n]);
      work(n, around);
    }
  };
  parallel_for(threads, begin.size() - 1, do_tile, stop);
}

}  // namespace kerf::sim

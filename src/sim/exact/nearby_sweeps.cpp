// Selecting sweeps near a point: by tile, by block of columns, and by bounds of their distance.
//
// Distances change by no more than the query point moves. So if a centre is at distance d from the nearest
// sweep, a sweep whose distance from the centre exceeds d + 2 reach is not the nearest one of any point
// within `reach` of it, and one whose distance exceeds `reach` does not touch that sphere: both are dropped.
#include "sim/exact/nearby_sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

namespace kerf::sim {
namespace {

/// Columns along a side of a block, which has one list of sweeps, and of a cube, which has a shorter one.
constexpr int kBlock = 8;
constexpr int kBlocksAcross = kTileColumns / kBlock;
/// Distance from the centre of a cube to its corners, in pitches.
constexpr double kCubeDiagonal = 0.5 * kBlock * std::numbers::sqrt3;
/// Columns along a side of the square around a point whose steps select sweeps, see of_columns.
constexpr int kColumns = 4;
constexpr std::uint32_t kUnnumbered = 0xffffffffu;

double lowest_of(const Sweep& sweep, const std::vector<ToolDistance>& tools) {
  return std::min(sweep.z, sweep.z_end) + tools[sweep.tool].bottom();
}

}  // namespace

bool is_gathered_before(const Sweep* a, const Sweep* b) {
  const auto key = [](const Sweep* sweep) {
    return std::tuple(!is_level(*sweep), is_level(*sweep) ? sweep->tool : 0,
                      is_level(*sweep) ? sweep->z : 0.0, sweep);
  };
  return key(a) < key(b);
}

namespace {

/// Whether two sweeps belong to one LevelGroup.
bool is_one_level(const Sweep& a, const Sweep& b) {
  return is_level(a) && is_level(b) && a.tool == b.tool && a.z == b.z;
}

/// Whether a point is within reach of the full circle of an arc, and so may be of the arc.
bool may_be_near(const Sweep& arc, Point2 point, double reach) {
  const double dx = point.x - arc.x, dy = point.y - arc.y;
  return std::abs(std::sqrt(dx * dx + dy * dy) - arc.radius) <= reach;
}

/// The shortest of the vectors from several paths to one point, in plan.
class NearestVector {
 public:
  void take(Point2 vector) {
    const double square = dot(vector, vector);
    if (square >= square_) return;
    square_ = square;
    vector_ = vector;
  }
  double far() const { return std::sqrt(square_); }
  /// Whether a path with this vector can be the nearest one to some point within `reach`.
  bool may_change_to(const Sweep& path, Point2 vector, double reach) const {
    const double far = this->far(), limit = far + 2.0 * reach, square = dot(vector, vector);
    if (square > limit * limit) return false;
    if (path.is_arc || far < 2.0 * reach || square <= square_) return true;
    // For a displacement s, |s| <= reach, the distance to the line is at least |v| + s v / |v| (convex, so
    // above its tangent), and the distance to the nearest point of the other path at most
    // |n| + s n / |n| + reach^2 / (2 (|n| - reach)). So the line stays further away if
    // |v| - |n| > reach |v / |v| - n / |n|| + reach^2 / (2 (|n| - reach)).
    const double other = std::sqrt(square);
    const Point2 change = (1.0 / other) * vector - (1.0 / far) * vector_;
    return other - far <= reach * std::sqrt(dot(change, change)) + 0.5 * reach * reach / (far - reach);
  }

 private:
  double square_ = std::numeric_limits<double>::infinity();
  Point2 vector_;
};

}  // namespace

void NearbySweeps::clear_around(Point3 centre) {
  centre_ = centre;
  groups_.clear();
  level_.clear();
  lines_.clear();
  sloped_.clear();
}

/// Adds a group of those of `count` sweeps of one tool at one height that may be nearest within reach.
/// Returns the distance of the centre to the nearest.
double NearbySweeps::gather_level(const Sweep* const* sweeps, const PlanLine* lines, std::size_t count) {
  const Sweep& like = *sweeps[0];
  vectors_.resize(count);
  for (std::size_t k = 0; k < count; ++k) vectors_[k] = lines[k].vector_to(centre_.xy());
  NearestVector nearest;
  for (std::size_t k = 0; k < count; ++k) {
    const Sweep& sweep = *sweeps[k];
    if (sweep.is_arc) {
      const bool is_near = may_be_near(sweep, centre_.xy(), nearest.far() + 2.0 * reach_);
      vectors_[k] =
          is_near ? centre_.xy() - nearest_in_plan(sweep, centre_.xy()) : Point2{kOutOfReach, kOutOfReach};
    }
    nearest.take(vectors_[k]);
  }
  LevelGroup group{level_.size(), level_.size(), 0.0};
  for (std::size_t k = 0; k < count; ++k)
    if (nearest.may_change_to(*sweeps[k], vectors_[k], reach_)) {
      level_.push_back(sweeps[k]);
      lines_.push_back(lines[k]);
    }
  group.end = level_.size();
  const ToolDistance& tool = tools_[like.tool];
  group.low = distance_to_level(tool, nearest_of(group, centre_.xy()), like.z, centre_).value;
  groups_.push_back(group);
  return group.low;
}

/// Removes the sweeps that cannot be nearest within reach, see the head of this file. `nearest`: an upper
/// bound of the distance to the nearest sweep. Computes the distances to slopes and plunges that are left,
/// the one with the lowest bound first, which lowers `nearest`.
void NearbySweeps::discard_far(double nearest) {
  const auto sort = [&] {
    const double limit = std::min(nearest + 2.0 * reach_, reach_);
    const auto is_far = [&](const auto& one) { return one.low > limit; };
    groups_.erase(std::remove_if(groups_.begin(), groups_.end(), is_far), groups_.end());
    sloped_.erase(std::remove_if(sloped_.begin(), sloped_.end(), is_far), sloped_.end());
    std::sort(sloped_.begin(), sloped_.end(), [](const SlopedSweep& a, const SlopedSweep& b) {
      return a.low != b.low ? a.low < b.low : a.sweep < b.sweep;
    });
  };
  sort();
  bool any = false;
  for (SlopedSweep& sloped : sloped_) {
    if (sloped.is_computed || sloped.low > nearest + 2.0 * reach_) continue;
    sloped.nearest = distance_along(*sloped.sweep, tools_[sloped.sweep->tool], centre_, 2.0 * reach_);
    sloped.low = sloped.nearest.distance.value;
    sloped.is_computed = any = true;
    nearest = std::min(nearest, sloped.low);
  }
  if (any) sort();
}

void NearbySweeps::gather(const std::vector<const Sweep*>& sweeps, Point3 centre) {
  clear_around(centre);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sweeps.size();) {
    const Sweep& sweep = *sweeps[k];
    if (is_level(sweep)) {
      std::size_t end = k + 1;
      while (end < sweeps.size() && is_one_level(sweep, *sweeps[end])) ++end;
      group_lines_.clear();
      for (std::size_t n = k; n < end; ++n) group_lines_.push_back(PlanLine::of(*sweeps[n]));
      nearest = std::min(nearest, gather_level(&sweeps[k], group_lines_.data(), end - k));
      k = end;
      continue;
    }
    const DistanceBounds bounds = bounds_of_distance(sweep, tools_[sweep.tool], centre, reach_);
    nearest = std::min(nearest, bounds.high);
    if (bounds.low <= reach_) sloped_.push_back({bounds.low, &sweep, {}, false});
    ++k;
  }
  discard_far(nearest);
}

void NearbySweeps::gather(const NearbySweeps& wider, Point3 centre) {
  clear_around(centre);
  const Point3 moved = centre - wider.centre_;
  const double far = length(moved);
  double nearest = std::numeric_limits<double>::infinity();
  for (const LevelGroup& group : wider.groups_)
    if (group.low - far <= std::min(nearest + 2.0 * reach_, reach_))
      nearest = std::min(nearest, gather_level(&wider.level_[group.first], &wider.lines_[group.first],
                                               group.end - group.first));
  for (const SlopedSweep& sloped : wider.sloped_) {
    if (sloped.low - far > std::min(nearest + 2.0 * reach_, reach_)) break;
    SlopedSweep here = sloped;
    if (sloped.is_computed) {
      here.nearest = distance_beside(*sloped.sweep, tools_[sloped.sweep->tool], centre, 2.0 * reach_,
                                     sloped.nearest, moved);
      here.low = here.nearest.distance.value;
      nearest = std::min(nearest, here.low);
    } else {
      here.low = sloped.low - far;
    }
    sloped_.push_back(here);
  }
  discard_far(nearest);
}

bool NearbySweeps::covers(Point3 point, double reach) const {
  return distance(point, centre_) + reach <= reach_;
}

Point2 NearbySweeps::nearest_of(const LevelGroup& group, Point2 point) const {
  Point2 nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = group.first; k < group.end; ++k) {
    const Sweep& sweep = *level_[k];
    const Point2 vector = sweep.is_arc ? point - nearest_in_plan(sweep, point) : lines_[k].vector_to(point);
    const double square = dot(vector, vector);
    if (square >= least) continue;
    least = square;
    nearest = point - vector;
  }
  return nearest;
}

Distance NearbySweeps::at(Point3 point) const {
  const double moved = distance(point, centre_);
  Distance nearest;
  const auto take = [&](const Distance& distance) {
    if (distance.value < nearest.value) nearest = distance;
  };
  for (const LevelGroup& group : groups_) {
    if (group.low - moved > nearest.value) continue;
    const Sweep& like = *level_[group.first];
    take(distance_to_level(tools_[like.tool], nearest_of(group, point.xy()), like.z, point));
  }
  for (const SlopedSweep& sloped : sloped_) {
    if (sloped.low - moved > nearest.value) break;
    const ToolDistance& tool = tools_[sloped.sweep->tool];
    take(sloped.is_computed
             ? distance_beside(*sloped.sweep, tool, point, 2.0 * reach_, sloped.nearest, point - centre_,
                               nearest.value)
                   .distance
             : distance_along(*sloped.sweep, tool, point, 2.0 * reach_, nearest.value).distance);
  }
  return nearest;
}

QueryPoint SweepsByTile::query_at(Point3 point, std::uint32_t number) const {
  const auto column = [&](double v, int columns) {
    return std::clamp(static_cast<int>(std::floor(v / body_.pitch)), 0, columns - 1);
  };
  const int i = column(point.x, body_.nx), j = column(point.y, body_.ny);
  const int tile = j / kTileColumns * body_.tiles_x + i / kTileColumns;
  const int block = j % kTileColumns / kBlock * kBlocksAcross + i % kTileColumns / kBlock;
  const double layer = std::floor(point.z / (kBlock * body_.pitch));
  return {static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block),
          static_cast<std::int32_t>(layer), number};
}

void SweepsByTile::take(const Batch& batch) {
  std::vector<std::uint32_t> number(batch.sweeps.size(), kUnnumbered);
  for (const std::uint32_t sweep : batch.list) number[sweep] = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] == kUnnumbered) continue;
    number[n] = static_cast<std::uint32_t>(sweeps_.size());
    sweeps_.push_back(batch.sweeps[n]);
  }
  for (std::size_t k = 0; k < batch.busy.size(); ++k)
    for (std::size_t at = batch.start[k]; at < batch.start[k + 1]; ++at)
      of_tile_[batch.busy[k]].push_back(number[batch.list[at]]);
}

void SweepsByTile::sort_for_gathering() {
  ready_of_tile_ = of_tile_;
  for (const Sweep& sweep : sweeps_) lowest_ = std::min(lowest_, lowest_of(sweep, tools_));
  const auto work = [&](std::size_t tile) {
    std::vector<std::uint32_t>& list = ready_of_tile_[tile];
    std::sort(list.begin(), list.end(),
              [&](std::uint32_t a, std::uint32_t b) { return is_gathered_before(&sweeps_[a], &sweeps_[b]); });
  };
  parallel_for(thread_count(0), ready_of_tile_.size(), work, [] { return false; });
}

/// Takes the sweeps of a kept batch that are in the planner's scope.
void SweepsByTile::take_kept(const Batch& batch, Planner& planner) {
  Batch wanted;
  auto beside = batch.beside.begin();
  for (std::size_t n = 0; n <= batch.sweeps.size(); ++n) {
    for (; beside != batch.beside.end() && beside->before == n; ++beside) planner.add(beside->sweep, wanted);
    if (n < batch.sweeps.size()) planner.add(batch.sweeps[n], wanted);
  }
  wanted.sort(of_tile_.size());
  take(wanted);
}

SweepFinder::SweepFinder(SweepsByTile& sweeps)
    : sweeps_(sweeps),
      of_cube_(sweeps.tools_, sweeps.reach_ + kCubeDiagonal * sweeps.body_.pitch),
      nearby_(sweeps.tools_, sweeps.reach_) {}

void SweepFinder::move_to(const QueryPoint& query) {
  const bool is_in_block = query.tile == query_.tile && query.block == query_.block;
  has_block_ = has_block_ && is_in_block;
  has_cube_ = has_cube_ && is_in_block && query.layer == query_.layer;
  query_ = query;
}

Point3 SweepFinder::cube_centre() const {
  const auto tiles_x = static_cast<std::uint32_t>(sweeps_.body_.tiles_x);
  const double i = query_.tile % tiles_x * kTileColumns + (query_.block % kBlocksAcross + 0.5) * kBlock;
  const double j = query_.tile / tiles_x * kTileColumns + (query_.block / kBlocksAcross + 0.5) * kBlock;
  return sweeps_.body_.pitch * Point3{i, j, (query_.layer + 0.5) * kBlock};
}

void SweepFinder::gather_block() {
  const Workpiece::Body& body = sweeps_.body_;
  const Point2 centre = this->cube_centre().xy();
  const double half = std::numbers::sqrt2 * 0.5 * kBlock * body.pitch + sweeps_.reach_;
  reachable_.clear();
  for (const std::uint32_t n : sweeps_.ready_of_tile_[query_.tile]) {
    const Sweep& sweep = sweeps_.sweeps_[n];
    const Point2 vector = centre - nearest_in_plan(sweep, centre);
    const double limit = sweeps_.tools_[sweep.tool].rim() + half;
    if (dot(vector, vector) <= limit * limit) reachable_.push_back({&sweep, vector});
  }
  of_block_.clear();
  for (std::size_t k = 0; k < reachable_.size();) {
    std::size_t end = k;
    NearestVector nearest;
    for (; end < reachable_.size() && is_one_level(*reachable_[k].sweep, *reachable_[end].sweep); ++end)
      nearest.take(reachable_[end].vector);
    if (end == k) of_block_.push_back(reachable_[k++].sweep);
    for (; k < end; ++k)
      if (nearest.may_change_to(*reachable_[k].sweep, reachable_[k].vector, half))
        of_block_.push_back(reachable_[k].sweep);
  }
  has_block_ = true;
}

/// Selects from the sweeps of an earlier visit of the cube, else from those of the block.
void SweepFinder::gather_cube() {
  std::vector<SweepsByTile::CubeList>& cubes = sweeps_.cubes_of_tile_[query_.tile];
  const auto at = std::lower_bound(
      cubes.begin(), cubes.end(), query_,
      [](const SweepsByTile::CubeList& cube, const QueryPoint& query) { return cube.is_before(query); });
  if (at != cubes.end() && at->is_of(query_)) {
    known_.clear();
    for (const std::uint32_t n : at->sweeps) known_.push_back(&sweeps_.sweeps_[n]);
    return of_cube_.gather(known_, cube_centre());
  }
  if (!has_block_) gather_block();
  of_cube_.gather(of_block_, cube_centre());
  SweepsByTile::CubeList cube{query_.block, query_.layer, {}};
  of_cube_.for_each([&](const Sweep& sweep) {
    cube.sweeps.push_back(static_cast<std::uint32_t>(&sweep - sweeps_.sweeps_.data()));
  });
  cube.sweeps.shrink_to_fit();
  cubes.insert(at, std::move(cube));
}

const NearbySweeps& SweepFinder::all_of_cube(Point3 point) {
  if (!has_cube_) gather_cube();
  has_cube_ = of_cube_.covers(point, sweeps_.reach_);
  if (has_cube_) return of_cube_;
  if (!has_block_) gather_block();
  of_cube_.gather(of_block_, point);
  return of_cube_;
}

const NearbySweeps& SweepFinder::all(Point3 point) {
  nearby_.gather(all_of_cube(point), point);
  return nearby_;
}

const NearbySweeps& SweepFinder::of_columns(Point3 point) {
  const Workpiece::Body& body = sweeps_.body_;
  const int first_i = static_cast<int>(std::lround(point.x / body.pitch)) - kColumns / 2;
  const int first_j = static_cast<int>(std::lround(point.y / body.pitch)) - kColumns / 2;
  intervals_.clear();
  for (int j = std::max(first_j, 0); j < std::min(first_j + kColumns, body.ny); ++j)
    for (int i = std::max(first_i, 0); i < std::min(first_i + kColumns, body.nx); ++i) {
      const auto tile = static_cast<std::size_t>(j / kTileColumns * body.tiles_x + i / kTileColumns);
      if (body.tiles[tile])
        body.intervals(*body.tiles[tile], lane_index(i % kTileColumns, j % kTileColumns), intervals_);
    }
  steps_.clear();
  for (const Interval& run : intervals_) steps_.insert(steps_.end(), {run.low_step, run.high_step});
  std::sort(steps_.begin(), steps_.end());
  steps_.erase(std::unique(steps_.begin(), steps_.end()), steps_.end());
  of_columns_.clear();
  const std::vector<std::uint32_t>& list = sweeps_.of_tile_[query_.tile];
  for (const std::uint32_t step : steps_) {
    const auto before = [&](std::uint32_t n, std::uint32_t wanted) {
      return sweeps_.sweeps_[n].step < wanted;
    };
    for (auto at = std::lower_bound(list.begin(), list.end(), step, before);
         at != list.end() && sweeps_.sweeps_[*at].step == step; ++at)
      of_columns_.push_back(&sweeps_.sweeps_[*at]);
  }
  std::sort(of_columns_.begin(), of_columns_.end(), is_gathered_before);
  nearby_.gather(of_columns_, point);
  return nearby_;
}

}  // namespace kerf::sim

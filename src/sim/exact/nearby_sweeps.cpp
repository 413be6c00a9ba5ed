// Which sweeps are near a place: by tile, by block of columns, and by their distance.
#include "sim/exact/nearby_sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace kerf::sim {
namespace {

/// Columns along the side of a block of columns that share a list of sweeps.
constexpr int kBlock = 8;
constexpr int kBlocksAcross = kTileColumns / kBlock;
/// Pitches from the middle of a cube of so many columns to its corners: places there share a shorter list.
constexpr double kWider = 0.5 * kBlock * std::numbers::sqrt3;
/// Columns along the side of the square around a place whose steps are looked at.
constexpr int kColumns = 4;
constexpr std::uint32_t kNotYet = 0xffffffffu;

}  // namespace

bool comes_before(const Sweep* a, const Sweep* b) {
  const auto key = [](const Sweep* sweep) {
    return std::tuple(!is_level(*sweep), is_level(*sweep) ? sweep->tool : 0,
                      is_level(*sweep) ? sweep->z : 0.0, sweep);
  };
  return key(a) < key(b);
}

namespace {

/// Whether the one that is nearest in plan is the nearer of two.
bool is_one_level(const Sweep& a, const Sweep& b) {
  return is_level(a) && is_level(b) && a.tool == b.tool && a.z == b.z;
}

/// Whether a place may be within reach of an arc: it is near the whole circle.
bool may_be_near(const Sweep& arc, Point2 place, double reach) {
  const double dx = place.x - arc.x, dy = place.y - arc.y;
  return std::abs(std::sqrt(dx * dx + dy * dy) - arc.radius) <= reach;
}

/// The way of a place from the nearest of several paths, in plan.
class NearestWay {
 public:
  void take(Point2 way) {
    const double square = dot(way, way);
    if (square >= square_) return;
    square_ = square;
    way_ = way;
  }
  double far() const { return std::sqrt(square_); }
  /// Whether a path `way` from the place can be nearest to another one within `reach`.
  bool may_change_to(const Sweep& path, Point2 way, double reach) const {
    const double far = this->far(), most = far + 2.0 * reach, square = dot(way, way);
    if (square > most * most) return false;
    if (path.is_arc || far < 2.0 * reach || square <= square_) return true;
    // The distance to a line is convex: above its tangent. That to one of its places is not more above its
    // own than the other term tells.
    const double other = std::sqrt(square);
    const Point2 turn = (1.0 / other) * way - (1.0 / far) * way_;
    return other - far <= reach * std::sqrt(dot(turn, turn)) + 0.5 * reach * reach / (far - reach);
  }

 private:
  double square_ = std::numeric_limits<double>::infinity();
  Point2 way_;
};

}  // namespace

void Nearby::begin(Point3 place) {
  around_ = place;
  levels_.clear();
  level_.clear();
  lines_.clear();
  others_.clear();
}

/// Takes those that may be met of sweeps at one height; returns the distance of the nearest.
double Nearby::gather_level(const Sweep* const* sweeps, const Line* lines, std::size_t count) {
  const Sweep& like = *sweeps[0];
  ways_.resize(count);
  for (std::size_t k = 0; k < count; ++k) ways_[k] = lines[k].way_to(around_.xy());
  NearestWay nearest;
  for (std::size_t k = 0; k < count; ++k) {
    const Sweep& sweep = *sweeps[k];
    if (sweep.is_arc) {
      const bool is_near = may_be_near(sweep, around_.xy(), nearest.far() + 2.0 * reach_);
      ways_[k] = is_near ? around_.xy() - nearest_in_plan(sweep, around_.xy()) : Point2{kNowhere, kNowhere};
    }
    nearest.take(ways_[k]);
  }
  Level level{level_.size(), level_.size(), 0.0};
  for (std::size_t k = 0; k < count; ++k)
    if (nearest.may_change_to(*sweeps[k], ways_[k], reach_)) {
      level_.push_back(sweeps[k]);
      lines_.push_back(lines[k]);
    }
  level.end = level_.size();
  const ToolDistance& tool = tools_[like.tool];
  level.low = distance_to_level(tool, nearest_of(level, around_.xy()), like.z, around_).value;
  levels_.push_back(level);
  return level.low;
}

/// Leaves those that a place `reach` away can meet, if one of all is not further than `nearest`: it is nearer
/// to each by no more than that, and further from the nearest by no more.
void Nearby::keep_near(double nearest) {
  const auto sort = [&] {
    const double most = std::min(nearest + 2.0 * reach_, reach_);
    const auto is_far = [&](const auto& one) { return one.low > most; };
    levels_.erase(std::remove_if(levels_.begin(), levels_.end(), is_far), levels_.end());
    others_.erase(std::remove_if(others_.begin(), others_.end(), is_far), others_.end());
    std::sort(others_.begin(), others_.end(), [](const Other& a, const Other& b) {
      return a.low != b.low ? a.low < b.low : a.sweep < b.sweep;
    });
  };
  sort();
  bool any = false;
  for (Other& other : others_) {
    if (other.is_known || other.low > nearest + 2.0 * reach_) continue;
    other.nearest = nearest_along(*other.sweep, tools_[other.sweep->tool], around_, 2.0 * reach_);
    other.low = other.nearest.distance.value;
    other.is_known = any = true;
    nearest = std::min(nearest, other.low);
  }
  if (any) sort();
}

void Nearby::gather(const std::vector<const Sweep*>& sweeps, Point3 place) {
  begin(place);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sweeps.size();) {
    const Sweep& sweep = *sweeps[k];
    if (is_level(sweep)) {
      std::size_t end = k + 1;
      while (end < sweeps.size() && is_one_level(sweep, *sweeps[end])) ++end;
      of_level_.clear();
      for (std::size_t n = k; n < end; ++n) of_level_.push_back(Line::of(*sweeps[n]));
      nearest = std::min(nearest, gather_level(&sweeps[k], of_level_.data(), end - k));
      k = end;
      continue;
    }
    const DistanceBounds bounds = bounds_of_distance(sweep, tools_[sweep.tool], place, reach_);
    nearest = std::min(nearest, bounds.high);
    if (bounds.low <= reach_) others_.push_back({bounds.low, &sweep, {}, false});
    ++k;
  }
  keep_near(nearest);
}

void Nearby::gather(const Nearby& wider, Point3 place) {
  begin(place);
  const Point3 moved = place - wider.around_;
  const double far = length(moved);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Level& level : wider.levels_)
    if (level.low - far <= std::min(nearest + 2.0 * reach_, reach_))
      nearest = std::min(nearest, gather_level(&wider.level_[level.first], &wider.lines_[level.first],
                                               level.end - level.first));
  for (const Other& other : wider.others_) {
    if (other.low - far > std::min(nearest + 2.0 * reach_, reach_)) break;
    Other here = other;
    if (other.is_known) {
      here.nearest =
          nearest_beside(*other.sweep, tools_[other.sweep->tool], place, 2.0 * reach_, other.nearest, moved);
      here.low = here.nearest.distance.value;
      nearest = std::min(nearest, here.low);
    } else {
      here.low = other.low - far;
    }
    others_.push_back(here);
  }
  keep_near(nearest);
}

bool Nearby::holds(Point3 place, double reach) const { return distance(place, around_) + reach <= reach_; }

Point2 Nearby::nearest_of(const Level& level, Point2 place) const {
  Point2 nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = level.first; k < level.end; ++k) {
    const Sweep& sweep = *level_[k];
    const Point2 way = sweep.is_arc ? place - nearest_in_plan(sweep, place) : lines_[k].way_to(place);
    const double square = dot(way, way);
    if (square >= least) continue;
    least = square;
    nearest = place - way;
  }
  return nearest;
}

Distance Nearby::at(Point3 place) const {
  const double moved = distance(place, around_);
  Distance nearest;
  const auto take = [&](const Distance& distance) {
    if (distance.value < nearest.value) nearest = distance;
  };
  for (const Level& level : levels_) {
    if (level.low - moved > nearest.value) continue;
    const Sweep& like = *level_[level.first];
    take(distance_to_level(tools_[like.tool], nearest_of(level, place.xy()), like.z, place));
  }
  for (const Other& other : others_) {
    if (other.low - moved > nearest.value) break;
    const ToolDistance& tool = tools_[other.sweep->tool];
    take(other.is_known ? nearest_beside(*other.sweep, tool, place, 2.0 * reach_, other.nearest,
                                         place - around_, nearest.value)
                              .distance
                        : nearest_along(*other.sweep, tool, place, 2.0 * reach_, nearest.value).distance);
  }
  return nearest;
}

QueryPoint SweepsByTile::query_at(Point3 place, std::uint32_t number) const {
  const auto column = [&](double v, int columns) {
    return std::clamp(static_cast<int>(std::floor(v / body_.pitch)), 0, columns - 1);
  };
  const int i = column(place.x, body_.nx), j = column(place.y, body_.ny);
  const int tile = j / kTileColumns * body_.tiles_x + i / kTileColumns;
  const int block = j % kTileColumns / kBlock * kBlocksAcross + i % kTileColumns / kBlock;
  const double layer = std::floor(place.z / (kBlock * body_.pitch));
  return {static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block),
          static_cast<std::int32_t>(layer), number};
}

void SweepsByTile::take(const Batch& batch) {
  std::vector<std::uint32_t> number(batch.sweeps.size(), kNotYet);
  for (const std::uint32_t sweep : batch.list) number[sweep] = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] == kNotYet) continue;
    number[n] = static_cast<std::uint32_t>(sweeps_.size());
    sweeps_.push_back(batch.sweeps[n]);
  }
  for (std::size_t k = 0; k < batch.busy.size(); ++k)
    for (std::size_t at = batch.start[k]; at < batch.start[k + 1]; ++at)
      of_tile_[batch.busy[k]].push_back(number[batch.list[at]]);
}

/// Takes those of a batch of the simulation that the planner wants.
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

Around::Around(const SweepsByTile& sweeps)
    : sweeps_(sweeps),
      wider_(sweeps.tools_, sweeps.reach_ + kWider * sweeps.body_.pitch),
      nearby_(sweeps.tools_, sweeps.reach_) {}

void Around::go_to(const QueryPoint& query) {
  const bool is_in_block = query.tile == query_.tile && query.block == query_.block;
  has_block_ = has_block_ && is_in_block;
  has_wider_ = has_wider_ && is_in_block && query.layer == query_.layer;
  query_ = query;
}

/// Of the query point's cube of columns.
Point3 Around::middle() const {
  const auto tiles_x = static_cast<std::uint32_t>(sweeps_.body_.tiles_x);
  const double i = query_.tile % tiles_x * kTileColumns + (query_.block % kBlocksAcross + 0.5) * kBlock;
  const double j = query_.tile / tiles_x * kTileColumns + (query_.block / kBlocksAcross + 0.5) * kBlock;
  return sweeps_.body_.pitch * Point3{i, j, (query_.layer + 0.5) * kBlock};
}

void Around::gather_block() {
  const Workpiece::Body& body = sweeps_.body_;
  const Point2 middle = this->middle().xy();
  const double half = std::numbers::sqrt2 * 0.5 * kBlock * body.pitch + sweeps_.reach_;
  reachable_.clear();
  for (const std::uint32_t n : sweeps_.of_tile_[query_.tile]) {
    const Sweep& sweep = sweeps_.sweeps_[n];
    const Point2 way = middle - nearest_in_plan(sweep, middle);
    const double most = sweeps_.tools_[sweep.tool].rim() + half;
    if (dot(way, way) <= most * most) reachable_.push_back({&sweep, way});
  }
  std::sort(reachable_.begin(), reachable_.end(),
            [](const Reachable& a, const Reachable& b) { return comes_before(a.sweep, b.sweep); });
  of_block_.clear();
  for (std::size_t k = 0; k < reachable_.size();) {
    std::size_t end = k;
    NearestWay nearest;
    for (; end < reachable_.size() && is_one_level(*reachable_[k].sweep, *reachable_[end].sweep); ++end)
      nearest.take(reachable_[end].way);
    if (end == k) of_block_.push_back(reachable_[k++].sweep);
    for (; k < end; ++k)
      if (nearest.may_change_to(*reachable_[k].sweep, reachable_[k].way, half))
        of_block_.push_back(reachable_[k].sweep);
  }
  has_block_ = true;
}

const Nearby& Around::wider(Point3 place) {
  if (!has_block_) gather_block();
  if (!has_wider_) wider_.gather(of_block_, middle());
  has_wider_ = wider_.holds(place, sweeps_.reach_);
  if (!has_wider_) wider_.gather(of_block_, place);
  return wider_;
}

const Nearby& Around::all(Point3 place) {
  nearby_.gather(wider(place), place);
  return nearby_;
}

const Nearby& Around::of_columns(Point3 place) {
  const Workpiece::Body& body = sweeps_.body_;
  const int first_i = static_cast<int>(std::lround(place.x / body.pitch)) - kColumns / 2;
  const int first_j = static_cast<int>(std::lround(place.y / body.pitch)) - kColumns / 2;
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
  std::sort(of_columns_.begin(), of_columns_.end(), comes_before);
  nearby_.gather(of_columns_, place);
  return nearby_;
}

}  // namespace kerf::sim

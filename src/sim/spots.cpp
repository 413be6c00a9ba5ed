// Which sweeps are near a place: by tile, by block of columns, and by their distance.
#include "sim/spots.h"

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
/// Places within so many pitches of one share a shorter list.
constexpr double kWider = 4.0;
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

/// Whether a place may be within reach of an arc: it is near the whole circle.
bool may_be_near(const Sweep& arc, Point2 place, double reach) {
  const double dx = place.x - arc.x, dy = place.y - arc.y;
  return std::abs(std::sqrt(dx * dx + dy * dy) - arc.radius) <= reach;
}

}  // namespace

/// Takes those of one height, the first of which is number `first`; returns the number after the last.
std::size_t Nearby::gather_level(const std::vector<const Sweep*>& sweeps, std::size_t first) {
  const Sweep& like = *sweeps[first];
  distances_.clear();
  double nearest2 = std::numeric_limits<double>::infinity();
  std::size_t end = first;
  for (; end < sweeps.size(); ++end) {
    const Sweep& sweep = *sweeps[end];
    if (!is_level(sweep) || sweep.tool != like.tool || sweep.z != like.z) break;
    double square = std::numeric_limits<double>::infinity();
    if (!sweep.is_arc || may_be_near(sweep, around_.xy(), std::sqrt(nearest2) + 2.0 * reach_)) {
      const Point2 way = around_.xy() - nearest_in_plan(sweep, around_.xy());
      square = dot(way, way);
    }
    distances_.push_back(square);
    nearest2 = std::min(nearest2, square);
  }
  const double most = std::sqrt(nearest2) + 2.0 * reach_;
  Level level{level_.size(), level_.size(), 0.0};
  for (std::size_t k = first; k < end; ++k)
    if (distances_[k - first] <= most * most) {
      const Sweep& sweep = *sweeps[k];
      level_.push_back(&sweep);
      lines_.push_back({sweep.x, sweep.y, sweep.ux, sweep.uy, sweep.is_arc ? -1.0 : sweep.length});
    }
  level.end = level_.size();
  const ToolDistance& tool = tools_[like.tool];
  level.low = distance_to_level(tool, nearest_of(level, around_.xy()), like.z, around_).value;
  levels_.push_back(level);
  return end;
}

void Nearby::gather(const std::vector<const Sweep*>& sweeps, Point3 place) {
  around_ = place;
  levels_.clear();
  level_.clear();
  lines_.clear();
  others_.clear();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sweeps.size();) {
    if (is_level(*sweeps[k])) {
      k = gather_level(sweeps, k);
      nearest = std::min(nearest, levels_.back().low);
      continue;
    }
    const DistanceBounds bounds = bounds_of_distance(*sweeps[k], tools_[sweeps[k]->tool], place, reach_);
    nearest = std::min(nearest, bounds.high);
    if (bounds.low <= reach_) others_.push_back({bounds.low, sweeps[k]});
    ++k;
  }
  // A place `reach` away is nearer to each by no more than that, and further from the nearest by no more.
  const double most = std::min(nearest + 2.0 * reach_, reach_);
  const auto is_far = [&](const auto& one) { return one.low > most; };
  levels_.erase(std::remove_if(levels_.begin(), levels_.end(), is_far), levels_.end());
  others_.erase(std::remove_if(others_.begin(), others_.end(), is_far), others_.end());
  std::sort(others_.begin(), others_.end(), [](const Other& a, const Other& b) {
    return a.low != b.low ? a.low < b.low : a.sweep < b.sweep;
  });
}

void Nearby::list(std::vector<const Sweep*>& out) const {
  out.clear();
  for (const Level& level : levels_)
    out.insert(out.end(), level_.begin() + static_cast<std::ptrdiff_t>(level.first),
               level_.begin() + static_cast<std::ptrdiff_t>(level.end));
  for (const Other& other : others_) out.push_back(other.sweep);
}

bool Nearby::holds(Point3 place, double reach) const { return distance(place, around_) + reach <= reach_; }

Point2 Nearby::nearest_of(const Level& level, Point2 place) const {
  Point2 nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = level.first; k < level.end; ++k) {
    const Line& line = lines_[k];
    const double dx = place.x - line.x, dy = place.y - line.y;
    const double t = std::clamp(dx * line.ux + dy * line.uy, 0.0, std::max(line.length, 0.0));
    Point2 at{line.x + t * line.ux, line.y + t * line.uy};
    if (line.length < 0.0) at = nearest_in_plan(*level_[k], place);  // an arc
    const double square = dot(at - place, at - place);
    if (square >= least) continue;
    least = square;
    nearest = at;
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
    if (bounds_of_distance(*other.sweep, tool, place, 2.0 * reach_).low >= nearest.value) continue;
    take(distance_to(*other.sweep, tool, place, 2.0 * reach_, nearest.value));
  }
  return nearest;
}

Spot SweepsByTile::spot_at(Point3 place, std::uint32_t number) const {
  const auto column = [&](double v, int columns) {
    return std::clamp(static_cast<int>(std::floor(v / body_.pitch)), 0, columns - 1);
  };
  const int i = column(place.x, body_.nx), j = column(place.y, body_.ny);
  const int tile = j / kTileColumns * body_.tiles_x + i / kTileColumns;
  const int block = j % kTileColumns / kBlock * kBlocksAcross + i % kTileColumns / kBlock;
  return {static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block), number};
}

void SweepsByTile::take(const Batch& batch) {
  std::vector<std::uint32_t> number(batch.sweeps.size(), kNotYet);
  for (const Batch::Pair& pair : batch.pairs) {
    std::uint32_t& mine = number[pair.sweep];
    if (mine == kNotYet) {
      mine = static_cast<std::uint32_t>(sweeps_.size());
      sweeps_.push_back(batch.sweeps[pair.sweep]);
    }
    of_tile_[pair.tile].push_back(mine);
  }
}

Around::Around(const SweepsByTile& sweeps)
    : sweeps_(sweeps),
      wider_(sweeps.tools_, sweeps.reach_ + kWider * sweeps.body_.pitch),
      nearby_(sweeps.tools_, sweeps.reach_) {}

void Around::go_to(const Spot& spot) {
  if (spot.tile != spot_.tile || spot.block != spot_.block) has_block_ = has_wider_ = false;
  spot_ = spot;
}

void Around::gather_block() {
  const Workpiece::Body& body = sweeps_.body_;
  const auto tiles_x = static_cast<std::uint32_t>(body.tiles_x);
  const double i = spot_.tile % tiles_x * kTileColumns + (spot_.block % kBlocksAcross + 0.5) * kBlock;
  const double j = spot_.tile / tiles_x * kTileColumns + (spot_.block / kBlocksAcross + 0.5) * kBlock;
  const Point2 middle{i * body.pitch, j * body.pitch};
  const double half = std::numbers::sqrt2 * 0.5 * kBlock * body.pitch + sweeps_.reach_;
  of_block_.clear();
  for (const std::uint32_t n : sweeps_.of_tile_[spot_.tile]) {
    const Sweep& sweep = sweeps_.sweeps_[n];
    if (distance(nearest_in_plan(sweep, middle), middle) <= sweeps_.tools_[sweep.tool].rim() + half)
      of_block_.push_back(&sweep);
  }
  std::sort(of_block_.begin(), of_block_.end(), comes_before);
  has_block_ = true;
}

const Nearby& Around::all(Point3 place) {
  if (!has_block_) gather_block();
  if (!has_wider_ || !wider_.holds(place, sweeps_.reach_)) {
    wider_.gather(of_block_, place);
    wider_.list(of_wider_);
    has_wider_ = true;
  }
  nearby_.gather(of_wider_, place);
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
  const std::vector<std::uint32_t>& list = sweeps_.of_tile_[spot_.tile];
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

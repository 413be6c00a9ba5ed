// Joins the interval ends of the four columns around each corner into surfaces and computes their vertices.
#include "sim/mesh/mesh_corners.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace kerf::meshing {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

int facing_end(Runs mine, int end, Runs other) {
  if (mine.size() == 1 && other.size() == 1)  // the usual case
    return other[0].low < mine[0].high && mine[0].low < other[0].high ? end : -1;
  const auto k = static_cast<std::size_t>(end / 2);
  const float low = mine[k].low, high = mine[k].high;
  // The void at this end: above a high end, below a low end.
  const double void_low = end % 2 == 1 ? high : k > 0 ? mine[k - 1].high : -kFar;
  const double void_high = end % 2 == 0 ? low : k + 1 < mine.size() ? mine[k + 1].low : kFar;
  for (std::size_t n = 0; n < other.size() && other[n].low < high; ++n) {
    if (other[n].high <= low) continue;
    const int low_end = 2 * static_cast<int>(n);
    if (end % 2 == 1) {
      const double next = n + 1 < other.size() ? other[n + 1].low : kFar;
      if (std::max<double>(void_low, other[n].high) < std::min(void_high, next)) return low_end + 1;
    } else {
      const double before = n > 0 ? other[n - 1].high : -kFar;
      if (std::max(void_low, before) < std::min<double>(void_high, other[n].low)) return low_end;
    }
  }
  return -1;
}

bool continues(const ColumnLine& line, int end, int other_end, double pitch) {
  const double mine = z_of(line.mine, end), other = z_of(line.other, other_end), rise = other - mine;
  if (std::abs(rise) <= kSlopeFraction * pitch) return true;
  const int before = facing_end(line.mine, end, line.before);
  if (before >= 0 && continues_rise(rise, mine - z_of(line.before, before))) return true;
  const int after = facing_end(line.other, other_end, line.after);
  return after >= 0 && continues_rise(rise, z_of(line.after, after) - other);
}

double Neighbourhood::slope(int i, int j, int end, int dx, int dy) {
  if (end == 0 && is_floor_level_) return 0.0;
  double rise = 0.0, run = 0.0;
  const Runs mine = runs(i, j);
  const double z = z_of(mine, end);
  const ColumnGrid& frame = columns_->frame();
  for (const int side : {-1, 1}) {
    const int other_i = i + side * dx, other_j = j + side * dy;
    const Runs other = runs(other_i, other_j);
    const int facing = facing_end(mine, end, other);
    if (facing < 0) continue;
    const double step = z_of(other, facing) - z;
    if (std::abs(step) > kSlopeFraction * pitch() &&
        !continues(line(i, j, side * dx, side * dy), end, facing, pitch()))
      continue;
    rise += side * step;
    run += side * (dx != 0 ? frame.column_x(other_i) - frame.column_x(i)
                           : frame.column_y(other_j) - frame.column_y(j));
  }
  return rise != 0.0 ? rise / run : 0.0;
}

CornerPlane::CornerPlane(const Columns& columns) : corners_x_(columns.nx() + 1) {
  const std::size_t size = offset(columns.ny() + 2) - kLeft;
  bytes_.reserve(size);
  sim::use_huge_pages(bytes_.data(), size);  // squares are read across many rows
  bytes_.resize(size, 1);
}

void CornerPlane::wanted(int j, std::vector<int>& out) const {
  constexpr int kBytes = 8;
  const std::uint8_t *below = row(j - 1), *here = row(j), *above = row(j + 1);
  out.clear();
  for (int i = 0; i < corners_x_; i += kBytes) {
    const std::uint64_t all =
        eight(below + i) & eight(above + i) & eight(here + i) & eight(here + i - 1) & eight(here + i + 1);
    if (all == kAllSimple) continue;
    for (int k = i; k < std::min(i + kBytes, corners_x_); ++k)
      if ((below[k] & above[k] & here[k] & here[k - 1] & here[k + 1]) == 0) out.push_back(k);
  }
}

namespace {

/// Neighbouring quadrants.
constexpr std::pair<int, int> kNeighbours[] = {{0, 1}, {0, 2}, {1, 3}, {2, 3}};

}  // namespace

Runs CornerRow::runs(int i, int j, int quadrant) {
  return around_.runs(column_x(i, quadrant), column_y(j, quadrant));
}

void CornerRow::build(const CornerPlane& plane, int j) {
  sheets_.clear();
  ranks_.clear();
  corners_.resize(static_cast<std::size_t>(columns_->nx()) + 1);
  plane.wanted(j, numbers_);
  for (const int i : numbers_) {
    around_.move_to(i, j);
    const int layers = plane.simple(i, j) ? 2 : layers_around(i, j);
    if (layers != 0) {
      build_layers(i, j, layers);
    } else {
      build_any(i, j);
    }
    corners_[static_cast<std::size_t>(i)].simple = plane.simple(i, j);
  }
}

/// The number of ends of each of the four columns around a corner, if it is the same, no step between them is
/// a wall, and each surface is entirely above the one below; else 0.
int CornerRow::layers_around(int i, int j) {
  const std::array<Runs, 4> around{runs(i, j, 0), runs(i, j, 1), runs(i, j, 2), runs(i, j, 3)};
  const std::size_t count = around[0].size();
  if (count == 0 || columns_->uneven(i, j)) return 0;
  for (const Runs& other : around)
    if (other.size() != count) return 0;
  float below = -std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < count; ++k) {
    const FourHeights low =
        four_heights(around[0][k].low, around[1][k].low, around[2][k].low, around[3][k].low);
    const FourHeights high =
        four_heights(around[0][k].high, around[1][k].high, around[2][k].high, around[3][k].high);
    const double wall = kSlopeFraction * columns_->pitch();
    if (!(below < low.low && low.high < high.low) || low.high - low.low > wall || high.high - high.low > wall)
      return 0;
    below = high.high;
  }
  return 2 * static_cast<int>(count);
}

/// A corner at which each surface has all four columns.
void CornerRow::build_layers(int i, int j, int layers) {
  Corner corner;
  corner.first_sheet = static_cast<std::uint32_t>(sheets_.size());
  corner.sheets = static_cast<std::uint32_t>(layers);
  corner.first_rank.fill(static_cast<std::uint32_t>(ranks_.size()));
  corner.ends.fill(layers);
  for (int end = 0; end < layers; ++end) {
    const auto z = [&](int q) { return static_cast<float>(z_of(runs(i, j, q), end)); };
    sheets_.push_back({columns_->corner_x(i), columns_->corner_y(j),
                       four_heights(z(0), z(1), z(2), z(3)).mean, kNone, false});
    ranks_.push_back(end);
  }
  corners_[static_cast<std::size_t>(i)] = corner;
}

void CornerRow::build_any(int i, int j) {
  gather(i, j);
  bool is_spiral = false;
  for (const auto& [q, other] : kNeighbours) is_spiral = !join(i, j, q, other) || is_spiral;
  sort_groups(i, j);
  // Several surfaces, or a spiral, can have a common vertex without a common edge, unless each surface has
  // all four columns.
  const bool is_high =
      std::any_of(group_of_.begin(), group_of_.end(), [](auto& ends) { return ends.size() > 2; });
  const bool suspect = is_spiral || (is_high && !std::all_of(groups_.begin(), groups_.end(), is_whole));

  Corner corner;
  corner.first_sheet = static_cast<std::uint32_t>(sheets_.size());
  corner.sheets = static_cast<std::uint32_t>(groups_.size());
  for (std::size_t q = 0; q < 4; ++q) {
    corner.first_rank[q] = static_cast<std::uint32_t>(ranks_.size());
    corner.ends[q] = static_cast<int>(group_of_[q].size());
    ranks_.insert(ranks_.end(), group_of_[q].begin(), group_of_[q].end());
  }
  for (const Group& group : groups_) sheets_.push_back({0.0, 0.0, group.mean, kNone, suspect});
  const Shift shift = shift_of(i, j, corner);
  set_positions(i, j, corner, shift);
  corners_[static_cast<std::size_t>(i)] = corner;
}

/// Makes one group per end of the four columns.
void CornerRow::gather(int i, int j) {
  groups_.clear();
  for (std::size_t q = 0; q < 4; ++q) {
    const int ends = 2 * static_cast<int>(runs(i, j, static_cast<int>(q)).size());
    group_of_[q].clear();
    for (int e = 0; e < ends; ++e) {
      group_of_[q].push_back(static_cast<int>(groups_.size()));
      groups_.emplace_back();
      groups_.back().end[q] = e;
    }
  }
}

/// Joins the groups of two neighbouring quadrants whose surfaces continue each other. A group has at most one
/// end of each column, so a spiral ramp around the corner stays open on one side; returns false in that case.
bool CornerRow::join(int i, int j, int q, int other) {
  const int qi = column_x(i, q), qj = column_y(j, q);
  const ColumnLine line = around_.line(qi, qj, column_x(i, other) - qi, column_y(j, other) - qj);
  std::vector<int>& mine = group_of_[static_cast<std::size_t>(q)];
  bool all = true;
  for (int e = 0; e < static_cast<int>(mine.size()); ++e) {
    const int f = facing_end(line.mine, e, line.other);
    if (f < 0 || !continues(line, e, f, columns_->pitch())) continue;
    const int keep = mine[static_cast<std::size_t>(e)];
    const int merged = group_of_[static_cast<std::size_t>(other)][static_cast<std::size_t>(f)];
    if (keep == merged) continue;
    Group& a = groups_[static_cast<std::size_t>(keep)];
    Group& b = groups_[static_cast<std::size_t>(merged)];
    bool clash = false;
    for (std::size_t k = 0; k < 4; ++k) clash = clash || (a.end[k] >= 0 && b.end[k] >= 0);
    if (clash) {
      all = false;
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (b.end[k] < 0) continue;
      a.end[k] = b.end[k];
      group_of_[k][static_cast<std::size_t>(b.end[k])] = keep;
    }
    b = Group{};
  }
  return all;
}

/// Removes the groups that were joined to others, sorts the rest by height and renumbers them.
void CornerRow::sort_groups(int i, int j) {
  std::size_t kept = 0;
  for (Group& group : groups_) {
    double sum = 0.0, lowest = kFar, highest = -kFar;
    int members = 0;
    for (int q = 0; q < 4; ++q) {
      const int e = group.end[static_cast<std::size_t>(q)];
      if (e < 0) continue;
      const double z = z_of(runs(i, j, q), e);
      sum += z;
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
      ++members;
    }
    if (members == 0) continue;
    group.mean = lowest == highest ? lowest : sum / members;
    groups_[kept++] = group;
  }
  groups_.resize(kept);
  // At equal heights, high ends (material below) come before low ends (material above).
  const auto is_low_end = [](const Group& g) {
    for (const int e : g.end)
      if (e >= 0) return e % 2 == 0;
    return false;
  };
  sort_few(groups_, [&](const Group& a, const Group& b) {
    if (a.mean != b.mean) return a.mean < b.mean;
    return is_low_end(a) < is_low_end(b);
  });
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t q = 0; q < 4; ++q)
      if (groups_[g].end[q] >= 0)
        group_of_[q][static_cast<std::size_t>(groups_[g].end[q])] = static_cast<int>(g);
}

/// The shift of the corner's line in plan that makes walls smooth: to the centroid of the midpoints between
/// columns that a wall separates (surface nets), weighted by the heights of the walls. Marks the sheets
/// between which there are four walls as suspect. Corners on the block's sides do not move, and those before
/// a narrow last column move at most half way to the side.
CornerRow::Shift CornerRow::shift_of(int i, int j, Corner& corner) {
  std::array<int, 4> material{};
  std::array<int, 4> next{};
  Shift sum;
  double weight = 0.0;
  for (std::uint32_t r = 0; r + 1 < corner.sheets; ++r) {
    for (std::size_t q = 0; q < 4; ++q) {
      const int e = groups_[r].end[q];
      if (e >= 0) material[q] += e % 2 == 0 ? 1 : -1;
      next[q] = material[q] > 0 ? 1 : 0;
    }
    const int south = next[0] ^ next[1], north = next[2] ^ next[3], west = next[0] ^ next[2],
              east = next[1] ^ next[3];
    const int walls = south + north + west + east;
    if (walls == 0) continue;
    Sheet& low = sheets_[corner.first_sheet + r];
    Sheet& high = sheets_[corner.first_sheet + r + 1];
    if (walls == 4) low.suspect = high.suspect = true;
    const double height = groups_[r + 1].mean - groups_[r].mean;
    sum.x += height * (east - west) / walls;
    sum.y += height * (north - south) / walls;
    weight += height;
  }
  const bool border = i == 0 || j == 0 || i == columns_->nx() || j == columns_->ny();
  if (border || weight <= 0.0) return {};
  const double room_x = columns_->corner_x(i + 1) - columns_->corner_x(i);
  const double room_y = columns_->corner_y(j + 1) - columns_->corner_y(j);
  return {std::min(sum.x / weight * columns_->pitch(), room_x) / 2,
          std::min(sum.y / weight * columns_->pitch(), room_y) / 2};
}

/// Computes the position of each sheet. A sheet with all four columns around an unmoved corner has their mean
/// height; others are extrapolated to the corner by their slopes, at most half way to the next sheet on the
/// corner's line.
void CornerRow::set_positions(int i, int j, const Corner& corner, Shift shift) {
  const double x = columns_->corner_x(i) + shift.x, y = columns_->corner_y(j) + shift.y;
  for (std::uint32_t r = 0; r < corner.sheets; ++r) {
    const Group& group = groups_[r];
    Sheet& sheet = sheets_[corner.first_sheet + r];
    sheet.x = x;
    sheet.y = y;
    if (is_whole(group) && shift.x == 0.0 && shift.y == 0.0 && !columns_->uneven(i, j)) continue;
    double change = 0.0;
    int members = 0;
    for (int q = 0; q < 4; ++q) {
      const int e = group.end[static_cast<std::size_t>(q)];
      if (e < 0) continue;
      const int ci = column_x(i, q), cj = column_y(j, q);
      change += around_.slope(ci, cj, e, 1, 0) * (x - columns_->frame().column_x(ci));
      change += around_.slope(ci, cj, e, 0, 1) * (y - columns_->frame().column_y(cj));
      ++members;
    }
    if (change == 0.0) continue;
    const double below = r > 0 ? (groups_[r - 1].mean + group.mean) / 2 : std::min(0.0, group.mean);
    const double above = r + 1 < corner.sheets ? (groups_[r + 1].mean + group.mean) / 2
                                               : std::max(columns_->height(), group.mean);
    // Steeper surfaces are walls; extrapolation beyond them is unreliable.
    const double limit = columns_->pitch();
    sheet.z = std::clamp(group.mean + std::clamp(change / members, -limit, limit), below, above);
  }
}

}  // namespace kerf::meshing

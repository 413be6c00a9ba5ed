// Joins the surfaces of the four columns around each corner and places their vertices.
#include "sim/mesh_corners.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>

namespace kerf::meshing {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

int Columns::facing_end(int i, int j, int end, int other_i, int other_j) const {
  if (!inside(other_i, other_j)) return -1;
  const Square &square = square_of(i, j), &other_square = square_of(other_i, other_j);
  if (square.many == nullptr && other_square.many == nullptr) {  // one interval each, as mostly
    const std::size_t c = cell(i, j), o = cell(other_i, other_j);
    return other_square.low->z[o] < square.high->z[c] && square.low->z[c] < other_square.high->z[o] ? end
                                                                                                    : -1;
  }
  const int other_ends = ends(other_i, other_j);
  const int k = end / 2;
  const Interval mine = interval(i, j, k);
  // Void bounded by this end: above a high end, below a low end.
  const double void_low = end % 2 == 1 ? mine.high : k > 0 ? interval(i, j, k - 1).high : -kFar;
  const double void_high = end % 2 == 0 ? mine.low : end + 1 < ends(i, j) ? interval(i, j, k + 1).low : kFar;
  for (int n = 0; 2 * n < other_ends; ++n) {
    const Interval other = interval(other_i, other_j, n);
    if (other.low >= mine.high) break;
    if (other.high <= mine.low) continue;
    if (end % 2 == 1) {
      const double next = 2 * n + 2 < other_ends ? interval(other_i, other_j, n + 1).low : kFar;
      if (std::max<double>(void_low, other.high) < std::min(void_high, next)) return 2 * n + 1;
    } else {
      const double before = n > 0 ? interval(other_i, other_j, n - 1).high : -kFar;
      if (std::max(void_low, before) < std::min<double>(void_high, other.low)) return 2 * n;
    }
  }
  return -1;
}

bool Columns::facing_z(int i, int j, int end, int other_i, int other_j, double& z) const {
  const int facing = facing_end(i, j, end, other_i, other_j);
  if (facing >= 0) z = this->z(other_i, other_j, facing);
  return facing >= 0;
}

bool Columns::continues(int i, int j, int end, int other_i, int other_j, int other_end) const {
  const double mine = z(i, j, end), other = z(other_i, other_j, other_end), rise = other - mine;
  if (std::abs(rise) <= kSlopeShare * pitch()) return true;
  const int dx = other_i - i, dy = other_j - j;
  double next = 0.0;
  return (facing_z(i, j, end, i - dx, j - dy, next) && goes_on(rise, mine - next)) ||
         (facing_z(other_i, other_j, other_end, other_i + dx, other_j + dy, next) &&
          goes_on(rise, next - other));
}

double Columns::slope(int i, int j, int end, int dx, int dy) const {
  double rise = 0.0, run = 0.0;
  const double mine = z(i, j, end);
  for (const int side : {-1, 1}) {
    const int other_i = i + side * dx, other_j = j + side * dy;
    const int other = facing_end(i, j, end, other_i, other_j);
    if (other < 0) continue;
    const double step = z(other_i, other_j, other) - mine;
    if (std::abs(step) > kSlopeShare * pitch() && !continues(i, j, end, other_i, other_j, other)) continue;
    rise += side * step;
    run += side * (dx != 0 ? frame_.column_x(other_i) - frame_.column_x(i)
                           : frame_.column_y(other_j) - frame_.column_y(j));
  }
  return rise != 0.0 ? rise / run : 0.0;
}

CornerPlane::CornerPlane(const Columns& columns)
    : corners_x_(columns.nx() + 1),
      bytes_(
          static_cast<std::size_t>(columns.ny() + 3) * static_cast<std::size_t>(corners_x_ + kLeft + kRight),
          1) {}

void CornerPlane::wanted(int j, std::vector<int>& out) const {
  constexpr int kBytes = 8;
  constexpr std::uint64_t kAllSimple = 0x0101010101010101u;
  const std::uint8_t *below = row(j - 1), *here = row(j), *above = row(j + 1);
  const auto eight = [](const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return word;
  };
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

/// Quadrants that are neighbours.
constexpr std::pair<int, int> kNeighbours[] = {{0, 1}, {0, 2}, {1, 3}, {2, 3}};

}  // namespace

void CornerRow::build(const Columns& columns, const CornerPlane& plane, int j) {
  sheets_.clear();
  ranks_.clear();
  corners_.resize(static_cast<std::size_t>(columns.nx()) + 1);
  plane.wanted(j, numbers_);
  for (const int i : numbers_) {
    const int layers = plane.simple(i, j) ? 2 : layers_around(columns, i, j);
    if (layers != 0) {
      build_layers(columns, i, j, layers);
    } else {
      build_any(columns, i, j);
    }
    corners_[static_cast<std::size_t>(i)].simple = plane.simple(i, j);
  }
}

/// How many ends each of the four columns around a corner has, if no step between them is a wall and each
/// surface lies wholly above the one below; else 0.
int CornerRow::layers_around(const Columns& columns, int i, int j) {
  const int ends = columns.ends(column_x(i, 0), column_y(j, 0));
  if (ends == 0 || columns.uneven(i, j)) return 0;
  for (int q = 1; q < 4; ++q)
    if (columns.ends(column_x(i, q), column_y(j, q)) != ends) return 0;
  float below = -std::numeric_limits<float>::infinity();
  for (int k = 0; 2 * k < ends; ++k) {
    std::array<Interval, 4> runs;
    for (int q = 0; q < 4; ++q)
      runs[static_cast<std::size_t>(q)] = columns.interval(column_x(i, q), column_y(j, q), k);
    const FourHeights low = four_heights(runs[0].low, runs[1].low, runs[2].low, runs[3].low);
    const FourHeights high = four_heights(runs[0].high, runs[1].high, runs[2].high, runs[3].high);
    const double wall = kSlopeShare * columns.pitch();
    if (!(below < low.low && low.high < high.low) || low.high - low.low > wall || high.high - high.low > wall)
      return 0;
    below = high.high;
  }
  return ends;
}

/// A corner that all surfaces go around.
void CornerRow::build_layers(const Columns& columns, int i, int j, int layers) {
  Corner corner;
  corner.first_sheet = static_cast<std::uint32_t>(sheets_.size());
  corner.sheets = static_cast<std::uint32_t>(layers);
  corner.first_rank.fill(static_cast<std::uint32_t>(ranks_.size()));
  corner.ends.fill(layers);
  for (int end = 0; end < layers; ++end) {
    const auto z = [&](int q) { return static_cast<float>(columns.z(column_x(i, q), column_y(j, q), end)); };
    sheets_.push_back(
        {columns.corner_x(i), columns.corner_y(j), four_heights(z(0), z(1), z(2), z(3)).mean, kNone, false});
    ranks_.push_back(end);
  }
  corners_[static_cast<std::size_t>(i)] = corner;
}

void CornerRow::build_any(const Columns& columns, int i, int j) {
  gather(columns, i, j);
  bool is_spiral = false;
  for (const auto& [q, other] : kNeighbours) is_spiral = !join(columns, i, j, q, other) || is_spiral;
  sort_groups(columns, i, j);
  // Surfaces above each other, or a spiral, can meet in a vertex without sharing an edge; not where all of
  // them go all around.
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
  const Shift shift = shift_of(columns, i, j, corner);
  place(columns, i, j, corner, shift);
  corners_[static_cast<std::size_t>(i)] = corner;
}

/// Every end of the four columns becomes a group of its own.
void CornerRow::gather(const Columns& columns, int i, int j) {
  groups_.clear();
  for (std::size_t q = 0; q < 4; ++q) {
    const int quadrant = static_cast<int>(q);
    const int ends = columns.ends(column_x(i, quadrant), column_y(j, quadrant));
    group_of_[q].clear();
    for (int e = 0; e < ends; ++e) {
      group_of_[q].push_back(static_cast<int>(groups_.size()));
      groups_.emplace_back();
      groups_.back().end[q] = e;
    }
  }
}

/// Joins the groups of neighbouring quadrants whose surfaces continue each other. A group never takes two
/// ends of one column, so a spiral ramp around the corner stays open on one side; false where that happened.
bool CornerRow::join(const Columns& columns, int i, int j, int q, int other) {
  const int qi = column_x(i, q), qj = column_y(j, q), oi = column_x(i, other), oj = column_y(j, other);
  std::vector<int>& mine = group_of_[static_cast<std::size_t>(q)];
  bool all = true;
  for (int e = 0; e < static_cast<int>(mine.size()); ++e) {
    const int f = columns.facing_end(qi, qj, e, oi, oj);
    if (f < 0 || !columns.continues(qi, qj, e, oi, oj, f)) continue;
    const int keep = mine[static_cast<std::size_t>(e)];
    const int gone = group_of_[static_cast<std::size_t>(other)][static_cast<std::size_t>(f)];
    if (keep == gone) continue;
    Group& a = groups_[static_cast<std::size_t>(keep)];
    Group& b = groups_[static_cast<std::size_t>(gone)];
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

/// Drops the groups that were joined to others, sorts the rest by height and renumbers.
void CornerRow::sort_groups(const Columns& columns, int i, int j) {
  std::size_t kept = 0;
  for (Group& group : groups_) {
    double sum = 0.0, lowest = kFar, highest = -kFar;
    int members = 0;
    for (int q = 0; q < 4; ++q) {
      const int e = group.end[static_cast<std::size_t>(q)];
      if (e < 0) continue;
      const double z = columns.z(column_x(i, q), column_y(j, q), e);
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
  // Equal heights: the material that ends there comes before the material that begins there.
  const auto begins = [](const Group& g) {
    for (const int e : g.end)
      if (e >= 0) return e % 2 == 0;
    return false;
  };
  std::stable_sort(groups_.begin(), groups_.end(), [&](const Group& a, const Group& b) {
    if (a.mean != b.mean) return a.mean < b.mean;
    return begins(a) < begins(b);
  });
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t q = 0; q < 4; ++q)
      if (groups_[g].end[q] >= 0)
        group_of_[q][static_cast<std::size_t>(groups_[g].end[q])] = static_cast<int>(g);
}

/// Where the corner's line is moved to, so that walls run smoothly past the columns' squares: to the middle
/// of the points half way between the columns that a wall divides (surface nets in plan), weighted by the
/// walls' heights. Marks the sheets between which four walls meet. Corners on the block's sides stay, and
/// those before a narrow last column go no more than half way to the side.
CornerRow::Shift CornerRow::shift_of(const Columns& columns, int i, int j, Corner& corner) {
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
  const bool border = i == 0 || j == 0 || i == columns.nx() || j == columns.ny();
  if (border || weight <= 0.0) return {};
  const double room_x = columns.corner_x(i + 1) - columns.corner_x(i);
  const double room_y = columns.corner_y(j + 1) - columns.corner_y(j);
  return {std::min(sum.x / weight * columns.pitch(), room_x) / 2,
          std::min(sum.y / weight * columns.pitch(), room_y) / 2};
}

/// Gives each sheet its point. A sheet with all four columns around an unmoved corner has their mean height;
/// others are continued to the corner by their slopes, never past half way to the next sheet in the corner's
/// line.
void CornerRow::place(const Columns& columns, int i, int j, const Corner& corner, Shift shift) {
  const double x = columns.corner_x(i) + shift.x, y = columns.corner_y(j) + shift.y;
  for (std::uint32_t r = 0; r < corner.sheets; ++r) {
    const Group& group = groups_[r];
    Sheet& sheet = sheets_[corner.first_sheet + r];
    sheet.x = x;
    sheet.y = y;
    if (is_whole(group) && shift.x == 0.0 && shift.y == 0.0 && !columns.uneven(i, j)) continue;
    double change = 0.0;
    int members = 0;
    for (int q = 0; q < 4; ++q) {
      const int e = group.end[static_cast<std::size_t>(q)];
      if (e < 0) continue;
      const int ci = column_x(i, q), cj = column_y(j, q);
      change += columns.slope(ci, cj, e, 1, 0) * (x - columns.frame().column_x(ci));
      change += columns.slope(ci, cj, e, 0, 1) * (y - columns.frame().column_y(cj));
      ++members;
    }
    if (change == 0.0) continue;
    const double below = r > 0 ? (groups_[r - 1].mean + group.mean) / 2 : std::min(0.0, group.mean);
    const double above = r + 1 < corner.sheets ? (groups_[r + 1].mean + group.mean) / 2
                                               : std::max(columns.height(), group.mean);
    // Steeper than that there are walls, and what goes on beyond them is a guess.
    const double most = columns.pitch();
    sheet.z = std::clamp(group.mean + std::clamp(change / members, -most, most), below, above);
  }
}

}  // namespace kerf::meshing

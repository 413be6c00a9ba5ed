// The corners of the columns: which interval ends of the four columns around a corner form one surface, and
// the position of its vertex. Algorithm: docs/decisions/0006-mesh.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "sim/mesh/mesh_columns.h"

namespace kerf::meshing {

/// No vertex yet, or no such end.
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Steps up to this fraction of the pitch are slopes, not walls: columns cannot distinguish the two.
inline constexpr double kSlopeFraction = 0.5;
/// A higher step is a slope if the step before or after it, in the same direction, has at least 1 /
/// kRiseRatio of its height: the rise of smooth surfaces changes by less from column to column.
inline constexpr double kRiseRatio = 2.5;
inline bool continues_rise(double rise, double step) {
  return step * rise > 0.0 && std::abs(rise) <= kRiseRatio * std::abs(step);
}

/// Stable sort of a few elements without allocation.
template <class Thing, class Before>
void sort_few(std::vector<Thing>& things, const Before& before) {
  constexpr std::size_t kFew = 16;
  if (things.size() > kFew) {
    std::stable_sort(things.begin(), things.end(), before);
    return;
  }
  for (std::size_t k = 1; k < things.size(); ++k)
    for (std::size_t n = k; n > 0 && before(things[n], things[n - 1]); --n)
      std::swap(things[n], things[n - 1]);
}

/// The end of `other` that bounds the same void as `end` of `mine`, with material behind both; -1: none.
int facing_end(Runs mine, int end, Runs other);

/// Whether `end` of the second of four columns in a row and `other_end` of the third (from facing_end) form
/// one surface; if not, there is a wall between them.
struct ColumnLine {
  Runs before, mine, other, after;
};
bool continues(const ColumnLine& line, int end, int other_end, double pitch);

/// The columns around a corner, each read on first use.
class Neighbourhood {
 public:
  explicit Neighbourhood(const Columns& columns) : columns_(&columns) {}
  void move_to(int i, int j) {
    i_ = i - kReach;
    j_ = j - kReach;
    known_ = 0;
    is_floor_level_ = columns_->have_level_floor(i_, j_, i_ + kSide - 1, j_ + kSide - 1);
  }
  /// A column at the corner, or one of the next two along X or Y.
  Runs runs(int i, int j) {
    const auto n = static_cast<std::size_t>(kSide * (j - j_) + (i - i_));
    if ((known_ >> n & 1u) == 0) {
      known_ |= std::uint64_t{1} << n;
      runs_[n] = columns_->runs(i, j, one_[n]);
    }
    return runs_[n];
  }
  double pitch() const { return columns_->pitch(); }
  /// Rise of the surface per mm along x (dx = 1, dy = 0) or y at an end of a column at the corner, from the
  /// neighbours that continue it.
  double slope(int i, int j, int end, int dx, int dy);
  ColumnLine line(int i, int j, int dx, int dy) {
    return {runs(i - dx, j - dy), runs(i, j), runs(i + dx, j + dy), runs(i + 2 * dx, j + 2 * dy)};
  }

 private:
  static constexpr int kReach = 3, kSide = 2 * kReach;  // columns
  const Columns* columns_;
  int i_ = 0, j_ = 0;
  bool is_floor_level_ = false;  // all lowest ends are at one height
  std::uint64_t known_ = 0;      // one bit per column
  std::array<Runs, kSide * kSide> runs_;
  std::array<Interval, kSide * kSide> one_;
};

inline double z_of(Runs runs, int end) {
  const Interval& run = runs[static_cast<std::size_t>(end / 2)];
  return static_cast<double>(end % 2 == 0 ? run.low : run.high);
}

/// One surface at a corner, with one end of each of its columns: one vertex.
struct Sheet {
  double x = 0.0, y = 0.0, z = 0.0;  // mm from the block's low corner
  std::uint32_t vertex = kNone;      // created with the first triangle
  bool suspect = false;              // may have several fans of triangles or four walls
};

/// The sheets at a corner, lowest first, and for each end of the four columns around (quadrant 0: low x and
/// low y, 1: high x, 2: high y, 3: both) its sheet's rank.
struct Corner {
  std::uint32_t first_sheet = 0;
  std::uint32_t sheets = 0;
  std::array<std::uint32_t, 4> first_rank{};
  std::array<int, 4> ends{};
  /// Four columns of one interval each, with one surface above (rank 1) and one below (rank 0).
  bool simple = false;
};

/// Which corners are simple, one byte each. Most are, and the others are found eight at a time.
class CornerPlane {
 public:
  explicit CornerPlane(const Columns& columns);
  bool simple(int i, int j) const { return row(j)[i] != 0; }
  /// The corners with one y, writable by several threads.
  std::uint8_t* row(int j) { return bytes_.data() + offset(j); }
  const std::uint8_t* row(int j) const { return bytes_.data() + offset(j); }
  /// Whether eight consecutive corners of a row are simple.
  static bool eight_simple(const std::uint8_t* corners) { return eight(corners) == kAllSimple; }
  /// Replaces `out` by the corners of a row that are not simple or have such a neighbour along X or Y.
  void wanted(int j, std::vector<int>& out) const;

 private:
  /// Bytes around the rows that count as simple corners; to the right as many as are read at a time.
  static constexpr int kLeft = 8, kRight = 16;
  static constexpr std::uint64_t kAllSimple = 0x0101010101010101u;
  static std::uint64_t eight(const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return word;
  }
  std::size_t offset(int j) const {
    return static_cast<std::size_t>(j + 1) * static_cast<std::size_t>(corners_x_ + kLeft + kRight) + kLeft;
  }

  int corners_x_;
  std::vector<std::uint8_t> bytes_;
};

/// Four heights around a corner.
struct FourHeights {
  double mean = 0.0;
  float low = 0.0f, high = 0.0f;
};
inline FourHeights four_heights(float a, float b, float c, float d) {
  FourHeights four;
  four.low = std::min(std::min(a, b), std::min(c, d));
  four.high = std::max(std::max(a, b), std::max(c, d));
  four.mean = four.low == four.high ? four.low
                                    : (static_cast<double>(a) + static_cast<double>(b) +
                                       static_cast<double>(c) + static_cast<double>(d)) /
                                          4;
  return four;
}

/// The corners of one row that walls or inner caps may need. Vectors are reused from row to row to avoid
/// allocations.
class CornerRow {
 public:
  explicit CornerRow(const Columns& columns) : columns_(&columns), around_(columns) {}
  void build(const CornerPlane& plane, int j);
  /// Numbers (i) of these corners, in order.
  const std::vector<int>& numbers() const { return numbers_; }
  const Corner& corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }
  Sheet& sheet(const Corner& corner, int rank) {
    return sheets_[corner.first_sheet + static_cast<std::uint32_t>(rank)];
  }
  /// Of all corners; the same whenever the row is built again.
  std::vector<Sheet>& sheets() { return sheets_; }
  int rank(const Corner& corner, int quadrant, int end) const {
    return ranks_[corner.first_rank[static_cast<std::size_t>(quadrant)] + static_cast<std::uint32_t>(end)];
  }

 private:
  struct Group {
    std::array<int, 4> end{-1, -1, -1, -1};  // the end of each quadrant's column, or -1
    double mean = 0.0;
  };
  static bool is_whole(const Group& group) {
    return std::find(group.end.begin(), group.end.end(), -1) == group.end.end();
  }
  struct Shift {
    double x = 0.0, y = 0.0;
  };

  Runs runs(int i, int j, int quadrant);
  int layers_around(int i, int j);
  void build_layers(int i, int j, int layers);
  void build_any(int i, int j);
  void gather(int i, int j);
  bool join(int i, int j, int q, int other);
  void sort_groups(int i, int j);
  Shift shift_of(int i, int j, Corner& corner);
  void set_positions(int i, int j, const Corner& corner, Shift shift);

  const Columns* columns_;
  std::vector<int> numbers_;
  std::vector<Corner> corners_;  // by number
  std::vector<Sheet> sheets_;
  std::vector<int> ranks_;
  // Scratch of one corner.
  Neighbourhood around_;
  std::array<std::vector<int>, 4> group_of_;
  std::vector<Group> groups_;
};

/// Column of a quadrant around corner (i, j).
constexpr int column_x(int i, int quadrant) { return i - 1 + (quadrant & 1); }
constexpr int column_y(int j, int quadrant) { return j - 1 + (quadrant >> 1); }

}  // namespace kerf::meshing

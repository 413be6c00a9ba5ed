// Selects the corners that the caps need: those without which the error of the surface would exceed the
// tolerance, and those that needed corners require.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Height of a corner without material on one side or with several vertices: triangles that use it are not
/// merged.
constexpr float kUnknown = std::numeric_limits<float>::infinity();

constexpr int kPatch = kSquare + 1;  // corners along a whole square's side

/// The two neighbours of a corner along one axis of a patch, mirrored at its sides.
struct Neighbours {
  Neighbours(int at, int by)
      : low(at < by ? at + by : at - by), high(at + by > kSquare ? at - by : at + by) {}
  int low, high;
};

}  // namespace

/// The heights of the corners of a square, and the errors of its triangles if they are not halved.
class CapSheet::Patch {
 public:
  Patch(const CapSheet& sheet, int square_x, int square_y)
      : sheet_(sheet), first_x_(square_x * kSquare), first_y_(square_y * kSquare) {
    const Columns& columns = sheet.columns_;
    wide_ = std::min(kSquare, columns.nx() - first_x_);
    deep_ = std::min(kSquare, columns.ny() - first_y_);
    even_x_ = first_x_ + wide_ == columns.nx() && columns.narrow_x() ? wide_ - 1 : wide_;
    even_y_ = first_y_ + deep_ == columns.ny() && columns.narrow_y() ? deep_ - 1 : deep_;
    for (const int y : {0, kSquare})
      for (const int x : {0, kSquare}) error_[at(x, y)] = 0.0f;  // they halve no triangle
  }

  /// Calls need(x, y), counted from the square's low corner, for each corner without which the error of the
  /// triangles that it halves would exceed the tolerance.
  template <class Need>
  void find(float tolerance, const Need& need) {
    read_heights();
    find_smallest();
    for (int s = 2; s < kSquare; s *= 2) {
      halve_sides(s);
      halve_diagonals(s);
    }
    for (int y = 0; y < kPatch; ++y) {
      for (int x = 0; x < kSquare; x += kBatch)
        if (any_above(error_.data() + at(x, y), tolerance)) find_in_batch(x, y, kBatch, tolerance, need);
      find_in_batch(kSquare, y, 1, tolerance, need);
    }
    if (even_x_ < kSquare || even_y_ < kSquare) find_uneven(need);
  }

 private:
  /// Maxima over the triangles one level below: their error, their own height plus the error of the triangles
  /// below them, and the latter alone. See put.
  struct Below {
    float error = 0.0f, one_level = 0.0f, below = 0.0f;
    void take(const Patch& patch, std::size_t corner) {
      error = std::max(error, patch.error_[corner]);
      one_level = std::max(one_level, patch.one_level_[corner]);
      below = std::max(below, patch.below_[corner]);
    }
  };

  static constexpr int kBatch = 8;  // are compared at a time
  static bool any_above(const float* errors, float tolerance) {
    int any = 0;
    for (int k = 0; k < kBatch; ++k) any |= static_cast<int>(errors[k] > tolerance);
    return any != 0;
  }
  template <class Need>
  void find_in_batch(int first_x, int y, int count, float tolerance, const Need& need) const {
    for (int x = first_x; x < first_x + count; ++x)
      if (error_[at(x, y)] > tolerance) need(x, y);
  }
  /// Where the distances of the corners are not even, since a column is narrower or they are moved to the
  /// block's side, no midpoint is halfway: calls need(x, y) for all there but those of level triangles.
  template <class Need>
  void find_uneven(const Need& need) const {
    for (int s = 1; s < kSquare; s *= 2) {
      for (int y = 0; y < kPatch; y += s) {
        const bool along_y = y % (2 * s) != 0;
        for (int x = along_y ? 0 : s; x < kPatch; x += 2 * s) {
          if (!is_even_or_level(x, y, {{{-s, 0}, {s, 0}, {0, -s}, {0, s}}})) need(x, y);
        }
      }
      for (int y = s; y < kPatch; y += 2 * s)
        for (int x = s; x < kPatch; x += 2 * s)
          if (!is_even_or_level(x, y, {{{-s, -s}, {s, -s}, {-s, s}, {s, s}}})) need(x, y);
    }
  }
  /// Of the corners of the two triangles that a corner halves, given relative to it.
  bool is_even_or_level(int x, int y, const std::array<GridCorner, 4>& around) const {
    bool even = x <= even_x_ && y <= even_y_, level = true;
    for (const GridCorner by : around) {
      const int cx = x + by.x, cy = y + by.y;
      if (cx < 0 || cy < 0 || cx >= kPatch || cy >= kPatch) continue;
      even = even && cx <= even_x_ && cy <= even_y_;
      level = level && height_[at(cx, cy)] == height_[at(x, y)];
    }
    return even || level;
  }
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kPatch + x); }
  void read_heights();
  void read_row(int y, std::array<float, kPatch + 1>& row) const;
  void put_stored_heights();
  float own(std::size_t midpoint, std::size_t a, std::size_t b) const {
    const float height = height_[midpoint];
    return height == kUnknown ? 0.0f : std::abs(height - 0.5f * (height_[a] + height_[b]));
  }
  void find_smallest();
  void halve_sides(int s);
  void halve_diagonals(int s);
  void put(std::size_t midpoint, std::size_t a, std::size_t b, const Below& below);

  const CapSheet& sheet_;
  int first_x_, first_y_;
  int wide_, deep_;      // columns of the square that are in the grid
  int even_x_, even_y_;  // corners up to these numbers are a pitch apart
  using Numbers = std::array<float, kPatch * kPatch>;
  Numbers height_, error_, one_level_, below_;
};

/// The ends of the columns of a row, from the one before the square to the one after it.
void CapSheet::Patch::read_row(int y, std::array<float, kPatch + 1>& row) const {
  const Columns& columns = sheet_.columns_;
  const int j = first_y_ + y;
  row.fill(0.0f);
  if (j < 0 || j >= columns.ny()) return;
  const auto z = [&](int i) { return sheet_.ends_of(columns.square_of(i, j)).z[Columns::cell(i, j)]; };
  if (first_x_ > 0) row.front() = z(first_x_ - 1);
  if (first_x_ + kSquare < columns.nx()) row.back() = z(first_x_ + kSquare);
  const Ends& ends = sheet_.ends_of(columns.square_of(first_x_, j));
  std::copy_n(ends.z.data() + Columns::cell(0, j), kSquare, row.data() + 1);
}

void CapSheet::Patch::read_heights() {
  const int rows = std::min(kPatch, sheet_.columns_.ny() + 1 - first_y_);
  for (int y = 0; y < rows; ++y)  // far apart from each other
    __builtin_prefetch(sheet_.plane_.row(first_y_ + y) + first_x_);
  std::array<float, kPatch + 1> south, north;
  read_row(-1, south);
  for (int y = 0; y < kPatch; ++y) {
    read_row(y, north);
    float* const out = height_.data() + at(0, y);
    const int corners = std::min(kPatch, sheet_.columns_.nx() + 1 - first_x_);
    std::fill_n(out, kPatch, kUnknown);
    if (first_y_ + y > sheet_.columns_.ny()) continue;
    const std::uint8_t* const simple = sheet_.plane_.row(first_y_ + y) + first_x_;
    for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k)
      out[k] = 0.25f * ((south[k] + south[k + 1]) + (north[k] + north[k + 1]));
    for (int x = 0; x < corners; x += kBatch) {
      if (CornerPlane::eight_simple(simple + x)) continue;
      for (int k = x; k < std::min(x + kBatch, corners); ++k)
        if (simple[k] == 0) out[k] = kUnknown;
    }
    south = north;
  }
  put_stored_heights();
}

void CapSheet::Patch::put_stored_heights() {
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      for (const CornerHeight& given :
           sheet_.heights_[sheet_.block_number(first_x_ + dx * kSquare, first_y_ + dy * kSquare)]) {
        const int x = given.cell % kSquare + dx * kSquare, y = given.cell / kSquare + dy * kSquare;
        if (x < kPatch && y < kPatch) height_[at(x, y)] = given.z;
      }
    }
  }
  // Corners beyond the block are moved to its side.
  for (int y = 0; y <= deep_; ++y)
    for (int x = wide_ + 1; x < kPatch; ++x) height_[at(x, y)] = height_[at(wide_, y)];
  for (int y = deep_ + 1; y < kPatch; ++y)
    for (int x = 0; x < kPatch; ++x) height_[at(x, y)] = height_[at(x, deep_)];
}

/// The error of a triangle is at most the height of its midpoint over the halved side plus the error of its
/// halves. But the contribution of the midpoint decreases to 0 towards the sides that contain the midpoints
/// of the halves, so that only the larger of two consecutive levels counts.
void CapSheet::Patch::put(std::size_t midpoint, std::size_t a, std::size_t b, const Below& below) {
  const float mine = own(midpoint, a, b);
  one_level_[midpoint] = mine + below.error;
  below_[midpoint] = below.error;
  error_[midpoint] = std::min(mine + below.error, std::max(mine + below.below, below.one_level));
}

/// The two smallest levels, three quarters of all corners; the first has no level below it.
void CapSheet::Patch::find_smallest() {
  for (int y = 0; y < kPatch; ++y) {
    const bool along_y = y % 2 != 0;
    const std::size_t by = along_y ? kPatch : 1;
    const std::size_t row = at(0, y);
    for (std::size_t c = row + (along_y ? 0 : 1); c < row + kPatch; c += 2)
      error_[c] = own(c, c - by, c + by);
  }
  for (int y = 1; y < kPatch; y += 2) {
    for (int x = 1; x < kPatch; x += 2) {
      const std::size_t c = at(x, y), up = c + kPatch, down = c - kPatch;
      const bool rises = ((x + y) / 2) % 2 != 0;  // as in halve_diagonals
      const float mine = rises ? own(c, down - 1, up + 1) : own(c, down + 1, up - 1);
      const float below =
          std::max(std::max(error_[c - 1], error_[c + 1]), std::max(error_[down], error_[up]));
      one_level_[c] = mine + below;
      below_[c] = below;
      error_[c] = std::max(mine, below);
    }
  }
}

/// Midpoints of the sides of length 2 s along X or Y.
void CapSheet::Patch::halve_sides(int s) {
  const int half = s / 2;  // s is at least 2
  for (int y = 0; y < kPatch; y += s) {
    const bool along_y = y % (2 * s) != 0;
    const int ax = along_y ? 0 : s, ay = along_y ? s : 0;
    for (int x = along_y ? 0 : s; x < kPatch; x += 2 * s) {
      Below below;
      const Neighbours bx(x, half), by(y, half);
      for (const int cy : {by.low, by.high})
        for (const int cx : {bx.low, bx.high}) below.take(*this, at(cx, cy));
      put(at(x, y), at(x - ax, y - ay), at(x + ax, y + ay), below);
    }
  }
}

/// Midpoints of the diagonals of squares of side 2 s, which run from a corner of a square of side 4 s to its
/// centre; the diagonal of the whole square is the one that Cover starts with.
void CapSheet::Patch::halve_diagonals(int s) {
  const int d = 2 * s;
  for (int y = s; y < kPatch; y += d) {
    for (int x = s; x < kPatch; x += d) {
      const int way = ((x - s) / d + (y - s) / d) % 2 == 0 ? s : -s;
      Below below;
      for (const std::size_t child : {at(x - s, y), at(x + s, y), at(x, y - s), at(x, y + s)})
        below.take(*this, child);
      put(at(x, y), at(x - way, y - s), at(x + way, y + s), below);
    }
  }
}

/// Whether a square and its eight neighbours are level at one height, so that it needs no corners.
bool CapSheet::is_plain(int square_x, int square_y) const {
  if (square_x == 0 || square_y == 0 || square_x + 1 >= columns_.squares_x() ||
      square_y + 1 >= columns_.squares_y())
    return false;
  const auto is_level = [this](const ColumnSquare& square) {
    return side_ == Side::bottom ? square.is_low_level : square.is_high_level;
  };
  const float z = ends_of(columns_.square(square_x, square_y)).z[0];
  for (int y = square_y - 1; y <= square_y + 1; ++y) {
    for (int x = square_x - 1; x <= square_x + 1; ++x) {
      const ColumnSquare& square = columns_.square(x, y);
      if (!is_level(square) || ends_of(square).z[0] != z) return false;
    }
  }
  return true;
}

void CapSheet::find_errors(int number) {
  if (!simplifies() || number >= columns_.squares_y()) return;
  const auto tolerance = static_cast<float>(options_.tolerance.mm());
  Band& band = bands_[static_cast<std::size_t>(number)];
  const int first_y = number * kSquare;
  for (int square_x = 0; square_x < columns_.squares_x(); ++square_x) {
    if (is_plain(square_x, number)) continue;
    const int first_x = square_x * kSquare;
    CapBlock* mine = nullptr;
    Patch(*this, square_x, number).find(tolerance, [&](int x, int y) {
      if (x < kSquare && y < kSquare) {
        if (mine == nullptr) mine = &block(first_x, first_y);
        mine->needed[Columns::cell(x, y)] = 1;
      } else if (y < kSquare) {
        need(first_x + x, first_y + y);
      } else {
        band.above.push_back(first_x + x);
      }
    });
  }
}

/// The apexes of the two triangles that a corner (not one of a square) halves.
std::array<CapSheet::GridCorner, 2> CapSheet::parents(GridCorner n) {
  const int both = n.x | n.y, s = both & -both;
  const bool odd_x = (n.x & s) != 0, odd_y = (n.y & s) != 0;
  if (odd_x && odd_y) {
    const int way = s == kSquare / 2 || ((n.x - s) / (2 * s) + (n.y - s) / (2 * s)) % 2 == 0 ? s : -s;
    return {GridCorner{n.x + way, n.y - s}, GridCorner{n.x - way, n.y + s}};
  }
  if (odd_y) return {GridCorner{n.x - s, n.y}, GridCorner{n.x + s, n.y}};
  return {GridCorner{n.x, n.y - s}, GridCorner{n.x, n.y + s}};
}

/// Records the corners that a needed corner requires; calls beyond(n) for those in other bands.
template <class Beyond>
void CapSheet::need_parents(GridCorner n, int band, std::vector<GridCorner>& work, const Beyond& beyond) {
  work.assign(1, n);
  while (!work.empty()) {
    const GridCorner child = work.back();
    work.pop_back();
    for (const GridCorner p : parents(child)) {
      if (p.x < 0 || p.y < 0 || is_whole(p.x, p.y) || p.x / kSquare >= blocks_x_ ||
          p.y / kSquare >= blocks_y_)
        continue;
      if (p.y / kSquare != band) {
        beyond(p);
        continue;
      }
      std::uint8_t& needed = block(p.x, p.y).needed[Columns::cell(p.x, p.y)];
      if (needed != 0) continue;
      needed = 1;
      work.push_back(p);
    }
  }
}

void CapSheet::propagate(int number) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  if (number > 0)
    for (const int x : bands_[static_cast<std::size_t>(number) - 1].above) need(x, number * kSquare);
  std::vector<GridCorner> work;
  const auto beyond = [&](GridCorner n) { band.beyond.push_back(n); };
  for_needed(number, [&](int i, int j) { need_parents({i, j}, number, work, beyond); });
}

void CapSheet::propagate_across() {
  std::vector<GridCorner> across, work;
  for (Band& band : bands_) across.insert(across.end(), band.beyond.begin(), band.beyond.end());
  while (!across.empty()) {
    const GridCorner n = across.back();
    across.pop_back();
    std::uint8_t& needed = block(n.x, n.y).needed[Columns::cell(n.x, n.y)];
    if (needed != 0) continue;
    needed = 1;
    need_parents(n, n.y / kSquare, work, [&](GridCorner p) { across.push_back(p); });
  }
  const int last_x = columns_.squares_x() - 1, last_y = columns_.squares_y() - 1;
  if (columns_.nx() % kSquare != 0)
    for (int y = 0; y <= last_y; ++y) need_on_side(last_x, y);
  if (columns_.ny() % kSquare != 0)
    for (int x = 0; x <= last_x; ++x) need_on_side(x, last_y);
}

}  // namespace kerf::meshing

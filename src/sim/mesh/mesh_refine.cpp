// Which corners the caps need: where the surface would be further off than the tolerance without them, and
// those that needed corners need.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Of a corner beside which there is no material, or where the cap is torn: what refers to it is not merged.
constexpr float kUnknown = std::numeric_limits<float>::infinity();

constexpr int kPatch = kSquare + 1;  // corners along a whole square's side

/// Neighbours of a place in a patch, mirrored at its sides.
struct Beside {
  Beside(int at, int by) : low(at < by ? at + by : at - by), high(at + by > kSquare ? at - by : at + by) {}
  int low, high;
};

}  // namespace

/// The heights of the corners of a whole square, and how far its triangles are off where they are not halved.
class CapSheet::Patch {
 public:
  Patch(const CapSheet& sheet, int square_x, int square_y)
      : sheet_(sheet), first_x_(square_x * kSquare), first_y_(square_y * kSquare) {
    for (const int y : {0, kSquare})
      for (const int x : {0, kSquare}) error_[at(x, y)] = 0.0f;  // they halve no triangle
  }

  /// Calls need(x, y), from the square's low corner, for each corner without which the triangles that it
  /// halves would be further off than the tolerance.
  template <class Need>
  void find(float tolerance, const Need& need) {
    read_heights();
    begin();
    for (int s = 2; s < kSquare; s *= 2) {
      halve_sides(s);
      halve_diagonals(s);
    }
    for (int y = 0; y < kPatch; ++y) {
      for (int x = 0; x < kSquare; x += kSome)
        if (any_above(error_.data() + at(x, y), tolerance)) find_some(x, y, kSome, tolerance, need);
      find_some(kSquare, y, 1, tolerance, need);
    }
  }

 private:
  /// What is known of the triangles that a corner halves: the bound of their error, that bound from half as
  /// far back, and the largest bound of the triangles below them.
  struct Below {
    float error = 0.0f, one_level = 0.0f, below = 0.0f;
    void take(const Patch& patch, std::size_t corner) {
      error = std::max(error, patch.error_[corner]);
      one_level = std::max(one_level, patch.one_level_[corner]);
      below = std::max(below, patch.below_[corner]);
    }
  };

  static constexpr int kSome = 8;  // are compared at a time
  static bool any_above(const float* errors, float tolerance) {
    int any = 0;
    for (int k = 0; k < kSome; ++k) any |= static_cast<int>(errors[k] > tolerance);
    return any != 0;
  }
  template <class Need>
  void find_some(int first_x, int y, int count, float tolerance, const Need& need) const {
    for (int x = first_x; x < first_x + count; ++x)
      if (error_[at(x, y)] > tolerance) need(x, y);
  }
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kPatch + x); }
  void read_heights();
  void read_row(int y, std::array<float, kPatch + 1>& row) const;
  void put_given();
  float own(std::size_t middle, std::size_t a, std::size_t b) const {
    const float height = height_[middle];
    return height == kUnknown ? 0.0f : std::abs(height - 0.5f * (height_[a] + height_[b]));
  }
  void begin();
  void halve_sides(int s);
  void halve_diagonals(int s);
  void put(std::size_t middle, std::size_t a, std::size_t b, const Below& below);

  const CapSheet& sheet_;
  int first_x_, first_y_;
  using Numbers = std::array<float, kPatch * kPatch>;
  Numbers height_, error_, one_level_, below_;
};

/// The ends of the columns from the one before the square to the one behind it.
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
    for (int x = 0; x < corners; x += kSome) {
      if (CornerPlane::eight_simple(simple + x)) continue;
      for (int k = x; k < std::min(x + kSome, corners); ++k)
        if (simple[k] == 0) out[k] = kUnknown;
    }
    south = north;
  }
  put_given();
}

void CapSheet::Patch::put_given() {
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      for (const Given& given :
           sheet_.given_[sheet_.block_number(first_x_ + dx * kSquare, first_y_ + dy * kSquare)]) {
        const int x = given.cell % kSquare + dx * kSquare, y = given.cell / kSquare + dy * kSquare;
        if (x < kPatch && y < kPatch) height_[at(x, y)] = given.z;
      }
    }
  }
}

/// A triangle is off by no more than its middle's height over the halved side plus what its halves are off.
/// But what the middle adds fades out towards the sides on which the halves have their middles, so that of
/// two levels only the larger one counts.
void CapSheet::Patch::put(std::size_t middle, std::size_t a, std::size_t b, const Below& below) {
  const float mine = own(middle, a, b);
  one_level_[middle] = mine + below.error;
  below_[middle] = below.error;
  error_[middle] = std::min(mine + below.error, std::max(mine + below.below, below.one_level));
}

/// The two smallest levels, three quarters of all, of which the first has none below it.
void CapSheet::Patch::begin() {
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

/// Middles of the sides of length 2 s along X or Y.
void CapSheet::Patch::halve_sides(int s) {
  const int half = s / 2;  // s is at least 2
  for (int y = 0; y < kPatch; y += s) {
    const bool along_y = y % (2 * s) != 0;
    const int ax = along_y ? 0 : s, ay = along_y ? s : 0;
    for (int x = along_y ? 0 : s; x < kPatch; x += 2 * s) {
      Below below;
      const Beside bx(x, half), by(y, half);
      for (const int cy : {by.low, by.high})
        for (const int cx : {bx.low, bx.high}) below.take(*this, at(cx, cy));
      put(at(x, y), at(x - ax, y - ay), at(x + ax, y + ay), below);
    }
  }
}

/// Middles of the diagonals of squares of side 2 s, which go from a corner of a square of side 4 s to its
/// centre; that of the whole square is the one that Cover begins with.
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

/// Whether a square and all around it are level at one height: nothing to be found there.
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

/// The apexes of the two triangles that a corner halves, which is no corner of a whole square.
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

/// Notes all that a needed corner needs; beyond(n) what is in other bands.
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
}

}  // namespace kerf::meshing

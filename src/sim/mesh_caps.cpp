// Caps: the upper and lower surfaces of the columns. Where the columns around a corner are level and cut by
// the same step the corner is dropped; right triangles are halved only as far as the needed corners ask.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "sim/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Side of the largest merged square, in columns; a power of two.
constexpr int kSquare = 64;
/// Marks in CapSheet::known_ a corner whose quadrants have vertices of their own.
constexpr std::uint32_t kMany = 0x80000000u;

/// Of a corner beside which there is no material, or where the cap is torn: what refers to it is not merged.
constexpr float kUnknown = std::numeric_limits<float>::infinity();

constexpr int whole_squares(int n) { return (n + kSquare - 1) / kSquare * kSquare; }

}  // namespace

CapSheet::CapSheet(Builder& builder, Side side)
    : builder_(builder),
      side_(side),
      stride_(whole_squares(builder.columns.nx()) + 1),
      rows_(whole_squares(builder.columns.ny()) + 1),
      needed_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_), 0),
      known_((static_cast<std::size_t>(builder.columns.nx()) + 1) *
                 (static_cast<std::size_t>(builder.columns.ny()) + 1),
             kNone) {
  if (builder.options.tolerance > Length()) height_.assign(needed_.size(), kUnknown);
}

/// A corner with one surface all around that is not a simple one.
void CapSheet::take_whole(Sheet& sheet, int i, int j) {
  const Columns& columns = builder_.columns;
  const bool is_level = level(i, j);
  const bool has_moved =
      sheet.x != columns.corner_x(i) || sheet.y != columns.corner_y(j) || columns.uneven(i, j);
  const bool may_go = simplifies() ? is_level || (!has_moved && of_one_group(i, j)) : is_level;
  known(i, j) = has_moved && !may_go ? builder_.vertex(sheet) : sheet.vertex;
  if (simplifies()) height_[index(i, j)] = static_cast<float>(sheet.z);
  needed_[index(i, j)] = known(i, j) != kNone || !may_go ? 1 : 0;
}

void CapSheet::take(CornerRow& row, int j) {
  const Columns& columns = builder_.columns;
  for (int i = 0; i <= columns.nx(); ++i) {
    const Corner& corner = row.corner(i);
    if (corner.simple) {
      const int rank = side_ == Side::bottom ? 0 : 1;
      const Sheet& sheet = row.sheet(corner, rank);
      known(i, j) = sheet.vertex;
      const bool level = corner.level[static_cast<std::size_t>(rank)];
      const bool may_go = simplifies() ? level || of_one_group(i, j) : level;
      if (simplifies()) height_[index(i, j)] = static_cast<float>(sheet.z);
      needed_[index(i, j)] = sheet.vertex != kNone || !may_go ? 1 : 0;
      continue;
    }
    std::array<int, 4> ranks{};
    int empty = 0;
    for (int q = 0; q < 4; ++q) {
      const int ends = corner.ends[static_cast<std::size_t>(q)];
      if (ends == 0) ++empty;
      const int end = side_ == Side::bottom ? 0 : ends - 1;
      ranks[static_cast<std::size_t>(q)] = ends == 0 ? -1 : row.rank(corner, q, end);
    }
    if (empty == 4) continue;
    if (std::all_of(ranks.begin(), ranks.end(), [&](int r) { return r == ranks[0]; })) {
      take_whole(row.sheet(corner, ranks[0]), i, j);
      continue;
    }
    const int highest = *std::max_element(ranks.begin(), ranks.end());
    const bool one_surface =
        std::all_of(ranks.begin(), ranks.end(), [&](int r) { return r < 0 || r == highest; });
    if (simplifies() && one_surface) height_[index(i, j)] = static_cast<float>(row.sheet(corner, highest).z);
    std::array<std::uint32_t, 4> part{kNone, kNone, kNone, kNone};
    for (std::size_t q = 0; q < 4; ++q)
      if (ranks[q] >= 0) part[q] = builder_.vertex(row.sheet(corner, ranks[q]));
    known(i, j) = kMany + static_cast<std::uint32_t>(parts_.size());
    parts_.push_back(part);
    needed_[index(i, j)] = 1;
  }
}

/// The four columns around a corner (all of them have material) end at one height, by one step.
bool CapSheet::level(int i, int j) const {
  const Columns& columns = builder_.columns;
  const int end = end_of(i, j);
  const double z = columns.z(i, j, end);
  const std::uint32_t step = columns.step(i, j, end);
  for (int q = 0; q < 3; ++q) {
    const int ci = column_x(i, q), cj = column_y(j, q), e = end_of(ci, cj);
    if (columns.z(ci, cj, e) != z || columns.step(ci, cj, e) != step) return false;
  }
  return true;
}

bool CapSheet::same_group(std::uint32_t a, std::uint32_t b) const {
  const std::span<const std::uint8_t> groups = builder_.options.step_groups;
  return a == b || (a < groups.size() && b < groups.size() && groups[a] == groups[b]);
}

bool CapSheet::of_one_group(int i, int j) const {
  const Columns& columns = builder_.columns;
  const auto step_at = [&](int q) {
    const int ci = column_x(i, q), cj = column_y(j, q);
    return columns.step(ci, cj, end_of(ci, cj));
  };
  const std::uint32_t step = step_at(0);
  return same_group(step, step_at(1)) && same_group(step, step_at(2)) && same_group(step, step_at(3));
}

/// Calls work(middle, a, b, apex, other_apex) for the middles of all longest sides, from a to b, of the
/// triangles that a square of kSquare can be halved into, the smallest triangles first; the apexes are those
/// of the two triangles that the middle halves.
template <class Work>
void CapSheet::for_each_middle(const Work& work) {
  for (int s = 1; s < kSquare; s *= 2) {
    const int d = 2 * s;
    for (int y = 0; y < rows_; y += s) {  // sides of length 2 s along X or Y
      const bool along_y = y % d != 0;
      const int ax = along_y ? 0 : s, ay = along_y ? s : 0;
      for (int x = along_y ? 0 : s; x < stride_; x += d)
        work(Node{x, y}, Node{x - ax, y - ay}, Node{x + ax, y + ay}, Node{x - ay, y - ax},
             Node{x + ay, y + ax});
    }
    for (int y = s; y < rows_; y += d) {  // diagonals of squares of side 2 s
      for (int x = s; x < stride_; x += d) {
        // Between the corner and the centre of the square of side 4 s.
        const int way = ((x - s) / d + (y - s) / d) % 2 == 0 ? s : -s;
        work(Node{x, y}, Node{x - way, y - s}, Node{x + way, y + s}, Node{x + way, y - s},
             Node{x - way, y + s});
      }
    }
  }
}

/// Marks the corners without which the cap would lie further than the tolerance from where it runs with all
/// of them. The error of leaving one out is its own height over the side it halves, and at most the largest
/// error below it.
void CapSheet::find_errors() {
  const auto tolerance = static_cast<float>(builder_.options.tolerance.mm());
  std::vector<float> error(needed_.size(), 0.0f);
  const auto inside = [&](Node n) { return n.x >= 0 && n.y >= 0 && n.x < stride_ && n.y < rows_; };
  for_each_middle([&](Node middle, Node a, Node b, Node apex, Node other_apex) {
    const std::size_t at = index(middle.x, middle.y);
    if (height_[at] != kUnknown) {
      const bool known_sides = inside(a) && inside(b);
      const float side =
          known_sides ? 0.5f * (height_[index(a.x, a.y)] + height_[index(b.x, b.y)]) : kUnknown;
      error[at] += std::abs(height_[at] - side);
      if (error[at] > tolerance) needed_[at] = 1;
    }
    for (const Node parent : {apex, other_apex}) {
      if (!inside(parent)) continue;
      float& above = error[index(parent.x, parent.y)];
      above = std::max(above, error[at]);
    }
  });
}

/// A corner that halves a triangle needs the apexes of the two triangles it halves, up to the whole squares.
void CapSheet::propagate() {
  const auto need = [&](Node n) {
    if (n.x >= 0 && n.y >= 0 && n.x < stride_ && n.y < rows_) needed_[index(n.x, n.y)] = 1;
  };
  for_each_middle([&](Node middle, Node /*a*/, Node /*b*/, Node apex, Node other_apex) {
    if (needed_[index(middle.x, middle.y)] == 0) return;
    need(apex);
    need(other_apex);
  });
}

bool CapSheet::emit(Progress* progress) {
  if (simplifies()) find_errors();
  propagate();
  const int nx = builder_.columns.nx(), ny = builder_.columns.ny();
  for (int y = 0; y < ny; y += kSquare) {
    if (stop_requested(progress)) return false;
    for (int x = 0; x < nx; x += kSquare) {
      const Node sw{x, y}, se{x + kSquare, y}, ne{x + kSquare, y + kSquare}, nw{x, y + kSquare};
      cover(sw, ne, se);
      cover(ne, sw, nw);
    }
  }
  return true;
}

void CapSheet::cover(Node a, Node b, Node apex) {
  const Node middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const bool smallest = std::abs(a.x - b.x) == 1;
  if (!smallest && needed_[index(middle.x, middle.y)] != 0) {
    cover(apex, a, middle);
    cover(b, apex, middle);
    return;
  }
  leaf(a, b, apex);
}

void CapSheet::leaf(Node a, Node b, Node apex) {
  const int sx = a.x + b.x + apex.x, sy = a.y + b.y + apex.y;
  // The column beside a corner of the triangle that lies inside it.
  const auto inner = [&](Node n) {
    return Node{3 * n.x <= sx ? n.x : n.x - 1, 3 * n.y <= sy ? n.y : n.y - 1};
  };
  const Node column = inner(apex);
  const Columns& columns = builder_.columns;
  if (columns.ends(column.x, column.y) == 0) return;
  const std::uint32_t step = columns.step(column.x, column.y, end_of(column.x, column.y));
  const int turn = (b.x - a.x) * (apex.y - a.y) - (b.y - a.y) * (apex.x - a.x);
  const bool upward = side_ == Side::top;
  if ((turn > 0) != upward) std::swap(a, b);
  builder_.add(vertex(a, inner(a)), vertex(b, inner(b)), vertex(apex, column), step);
}

std::uint32_t CapSheet::vertex(Node corner, Node column) {
  const Columns& columns = builder_.columns;
  assert(corner.x <= columns.nx() && corner.y <= columns.ny());
  std::uint32_t& entry = known(corner.x, corner.y);
  if (entry == kNone) {
    double sum = 0.0;
    for (int q = 0; q < 4; ++q) {
      const int i = column_x(corner.x, q), j = column_y(corner.y, q);
      sum += columns.z(i, j, end_of(i, j));
    }
    entry = builder_.add_vertex(columns.corner_x(corner.x), columns.corner_y(corner.y), sum / 4);
    return entry;
  }
  if (entry < kMany) return entry;
  const auto quadrant = static_cast<std::size_t>((column.x - corner.x + 1) + 2 * (column.y - corner.y + 1));
  return parts_[entry - kMany][quadrant];
}

}  // namespace kerf::meshing

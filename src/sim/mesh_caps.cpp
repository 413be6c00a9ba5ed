// Caps: the upper and lower surfaces of the columns. Where the columns around a corner are level and cut by
// the same step the corner is dropped; right triangles are halved only as far as the needed corners ask.
#include <algorithm>
#include <cassert>

#include "sim/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Side of the largest merged square, in columns; a power of two.
constexpr int kSquare = 64;
/// Marks in CapSheet::known_ a corner whose quadrants have vertices of their own.
constexpr std::uint32_t kMany = 0x80000000u;

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
             kNone) {}

void CapSheet::take(CornerRow& row, int j) {
  const Columns& columns = builder_.columns;
  for (int i = 0; i <= columns.nx(); ++i) {
    const Corner& corner = row.corner(i);
    if (corner.simple) {
      const int rank = side_ == Side::bottom ? 0 : 1;
      known(i, j) = row.sheet(corner, rank).vertex;
      needed_[index(i, j)] = known(i, j) != kNone || !corner.level[static_cast<std::size_t>(rank)] ? 1 : 0;
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
      Sheet& sheet = row.sheet(corner, ranks[0]);
      known(i, j) = columns.uneven(i, j) && !level(i, j) ? builder_.vertex(sheet) : sheet.vertex;
      needed_[index(i, j)] = known(i, j) != kNone || !level(i, j) ? 1 : 0;
      continue;
    }
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

/// A corner that halves a triangle needs the apexes of the two triangles it halves, up to the whole squares.
void CapSheet::propagate() {
  const auto need = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < stride_ && y < rows_) needed_[index(x, y)] = 1;
  };
  for (int s = 1; s < kSquare; s *= 2) {
    const int d = 2 * s;
    for (int y = 0; y < rows_; y += s) {  // middles of axis-parallel sides of length 2 s
      const bool odd_row = y % d != 0;
      for (int x = odd_row ? 0 : s; x < stride_; x += d) {
        if (!needed_[index(x, y)]) continue;
        need(odd_row ? x - s : x, odd_row ? y : y - s);
        need(odd_row ? x + s : x, odd_row ? y : y + s);
      }
    }
    for (int y = s; y < rows_; y += d) {  // middles of squares of side 2 s
      for (int x = s; x < stride_; x += d) {
        if (!needed_[index(x, y)]) continue;
        // The diagonal runs between the corner and the centre of the square of side 4 s; the apexes are the
        // others.
        const bool diagonal = ((x - s) / d + (y - s) / d) % 2 == 0;
        need(diagonal ? x + s : x - s, y - s);
        need(diagonal ? x - s : x + s, y + s);
      }
    }
  }
}

bool CapSheet::emit(Progress* progress) {
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

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

/// Mark in CapSheet::known_ corners whose quadrants have vertices of their own, and those whose vertex is yet
/// to be numbered in its band.
constexpr std::uint32_t kMany = 0x80000000u, kNew = 0x40000000u;

/// Of a corner beside which there is no material, or where the cap is torn: what refers to it is not merged.
constexpr float kUnknown = std::numeric_limits<float>::infinity();

}  // namespace

CapSheet::CapSheet(Builder& builder, Side side)
    : builder_(builder),
      side_(side),
      stride_(whole_squares(builder.columns.nx()) + 1),
      rows_(whole_squares(builder.columns.ny()) + 1),
      height_(simplifies() ? stride_ : 1, simplifies() ? rows_ : 1),
      needed_(stride_, rows_),
      known_(builder.columns.nx() + 1, builder.columns.ny() + 1),
      bands_(static_cast<std::size_t>(bands())) {}

void CapSheet::begin_row(int j) {
  needed_.fill_row(j, 0);
  if (simplifies()) height_.fill_row(j, kUnknown);
  if (j <= builder_.columns.ny()) known_.fill_row(j, kNone);
}

/// A corner with one surface all around that is not a simple one.
void CapSheet::take_whole(Sheet& sheet, int i, int j) {
  const Columns& columns = builder_.columns;
  const bool is_level = level(i, j);
  const bool has_moved =
      sheet.x != columns.corner_x(i) || sheet.y != columns.corner_y(j) || columns.uneven(i, j);
  const bool may_go = simplifies() ? is_level || (!has_moved && of_one_group(i, j)) : is_level;
  known_(i, j) = has_moved && !may_go ? builder_.vertex(sheet) : sheet.vertex;
  if (simplifies()) height_(i, j) = static_cast<float>(sheet.z);
  needed_(i, j) = known_(i, j) != kNone || !may_go ? 1 : 0;
}

void CapSheet::take(CornerRow& row, int j) {
  for (const int i : row.numbers()) {
    const Corner& corner = row.corner(i);
    if (corner.simple) {
      const Sheet& sheet = row.sheet(corner, side_ == Side::bottom ? 0 : 1);
      if (sheet.vertex == kNone) continue;
      known_(i, j) = sheet.vertex;
      needed_(i, j) = 1;
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
    if (simplifies() && one_surface) height_(i, j) = static_cast<float>(row.sheet(corner, highest).z);
    std::array<std::uint32_t, 4> part{kNone, kNone, kNone, kNone};
    for (std::size_t q = 0; q < 4; ++q)
      if (ranks[q] >= 0) part[q] = builder_.vertex(row.sheet(corner, ranks[q]));
    known_(i, j) = kMany + static_cast<std::uint32_t>(parts_.size());
    parts_.push_back(part);
    needed_(i, j) = 1;
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

bool CapSheet::of_one_group(int i, int j) const {
  const Columns& columns = builder_.columns;
  const auto group_at = [&](int q) {
    const int ci = column_x(i, q), cj = column_y(j, q);
    return group_key(builder_.options, columns.step(ci, cj, end_of(ci, cj)));
  };
  const std::uint64_t group = group_at(0);
  return group == group_at(1) && group == group_at(2) && group == group_at(3);
}

/// Calls work(middle, a, b, apex, other_apex) for the middles of all longest sides, from a to b, of the
/// triangles that a square of kSquare can be halved into, the smallest triangles first; the apexes are those
/// of the two triangles that the middle halves.
template <class Work>
void CapSheet::for_each_middle(const Work& work) const {
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
  Plane<float> error(stride_, rows_);
  for (int y = 0; y < rows_; ++y) error.fill_row(y, 0.0f);
  const auto inside = [&](Node n) { return n.x >= 0 && n.y >= 0 && n.x < stride_ && n.y < rows_; };
  for_each_middle([&](Node middle, Node a, Node b, Node apex, Node other_apex) {
    float& mine = error(middle.x, middle.y);
    const float height = height_(middle.x, middle.y);
    if (height != kUnknown) {
      const bool known_sides = inside(a) && inside(b);
      const float side = known_sides ? 0.5f * (height_(a.x, a.y) + height_(b.x, b.y)) : kUnknown;
      mine += std::abs(height - side);
      if (mine > tolerance) needed_(middle.x, middle.y) = 1;
    }
    for (const Node parent : {apex, other_apex}) {
      if (!inside(parent)) continue;
      float& above = error(parent.x, parent.y);
      above = std::max(above, mine);
    }
  });
}

/// A corner that halves a triangle needs the apexes of the two triangles it halves, up to the whole squares.
void CapSheet::propagate() {
  const auto need = [&](Node n) {
    if (n.x >= 0 && n.y >= 0 && n.x < stride_ && n.y < rows_) needed_(n.x, n.y) = 1;
  };
  for_each_middle([&](Node middle, Node /*a*/, Node /*b*/, Node apex, Node other_apex) {
    if (needed_(middle.x, middle.y) == 0) return;
    need(apex);
    need(other_apex);
  });
}

void CapSheet::refine() {
  if (simplifies()) find_errors();
  propagate();
}

/// Whether triangles will meet a corner that has no vertex yet. Where it has material on all sides they do:
/// it is needed, or the corner of a whole square.
bool CapSheet::is_new_vertex(int x, int y) const {
  if (needed_(x, y) == 0 && (x % kSquare != 0 || y % kSquare != 0)) return false;
  if (known_(x, y) != kNone) return false;
  const Columns& columns = builder_.columns;
  for (int q = 0; q < 4; ++q)
    if (columns.ends(column_x(x, q), column_y(y, q)) == 0) return false;
  return true;
}

void CapSheet::place_vertices(int number) {
  const Columns& columns = builder_.columns;
  Band& band = bands_[static_cast<std::size_t>(number)];
  for (int y = first_row(number); y < std::min(end_row(number), columns.ny() + 1); ++y) {
    for (int x = 0; x <= columns.nx(); ++x) {
      if (!is_new_vertex(x, y)) continue;
      double sum = 0.0;
      for (int q = 0; q < 4; ++q) {
        const int i = column_x(x, q), j = column_y(y, q);
        sum += columns.z(i, j, end_of(i, j));
      }
      known_(x, y) = kNew + static_cast<std::uint32_t>(band.positions.size() / 3);
      const Point3 at = columns.frame().bounds.low + Point3{columns.corner_x(x), columns.corner_y(y), sum / 4};
      for (int axis = 0; axis < 3; ++axis) band.positions.push_back(static_cast<float>(at[axis]));
    }
  }
}

void CapSheet::number_vertices() {
  std::vector<float>& positions = builder_.mesh.positions;
  for (Band& band : bands_) {
    band.first_vertex = static_cast<std::uint32_t>(positions.size() / 3);
    positions.insert(positions.end(), band.positions.begin(), band.positions.end());
  }
}

void CapSheet::make_triangles(int number) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  const int y = first_row(number);
  if (y >= builder_.columns.ny()) return;
  for (int x = 0; x < builder_.columns.nx(); x += kSquare) {
    const Node sw{x, y}, se{x + kSquare, y}, ne{x + kSquare, y + kSquare}, nw{x, y + kSquare};
    cover(band, sw, ne, se);
    cover(band, ne, sw, nw);
  }
}

void CapSheet::make_room() {
  Mesh& mesh = builder_.mesh;
  std::size_t triangles = mesh.step.size();
  for (Band& band : bands_) {
    band.first_triangle = triangles;
    triangles += band.step.size();
  }
  mesh.step.resize(triangles);
  mesh.triangles.resize(3 * triangles);
}

void CapSheet::move_to_mesh(int number) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  std::copy(band.step.begin(), band.step.end(), builder_.mesh.step.data() + band.first_triangle);
  std::copy(band.triangles.begin(), band.triangles.end(),
            builder_.mesh.triangles.data() + 3 * band.first_triangle);
  band = {};
}

void CapSheet::cover(Band& band, Node a, Node b, Node apex) const {
  const Node middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const bool smallest = std::abs(a.x - b.x) == 1;
  if (!smallest && needed_(middle.x, middle.y) != 0) {
    cover(band, apex, a, middle);
    cover(band, b, apex, middle);
    return;
  }
  leaf(band, a, b, apex);
}

void CapSheet::leaf(Band& band, Node a, Node b, Node apex) const {
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
  const std::uint32_t va = vertex(a, inner(a)), vb = vertex(b, inner(b)), vc = vertex(apex, column);
  if (va == vb || vb == vc || vc == va) return;
  for (const std::uint32_t v : {va, vb, vc}) band.triangles.push_back(v);
  band.step.push_back(step);
}

std::uint32_t CapSheet::vertex(Node corner, Node column) const {
  assert(corner.x <= builder_.columns.nx() && corner.y <= builder_.columns.ny());
  const std::uint32_t entry = known_(corner.x, corner.y);
  assert(entry != kNone);
  if (entry < kNew) return entry;
  if (entry < kMany) return bands_[static_cast<std::size_t>(corner.y / kSquare)].first_vertex + entry - kNew;
  const auto quadrant = static_cast<std::size_t>((column.x - corner.x + 1) + 2 * (column.y - corner.y + 1));
  return parts_[entry - kMany][quadrant];
}

}  // namespace kerf::meshing

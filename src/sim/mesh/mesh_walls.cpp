// Walls between neighbouring columns. Each column's side is a set of edges between its two corner lines; the
// wall is the difference of the two columns' sides, split at each vertex of both lines. So all faces at a
// corner's line use the same segments of it, and the surface is closed for any columns.
#include <algorithm>
#include <cassert>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {

std::uint32_t Builder::add_vertex(double x, double y, double z) {
  const Point3& low = columns.frame().bounds.low;
  const auto number = static_cast<std::uint32_t>(mesh.positions.size() / 3);
  for (const double v : {low.x + x, low.y + y, low.z + z}) mesh.positions.push_back(static_cast<float>(v));
  return number;
}

std::uint32_t Builder::vertex(Sheet& sheet) {
  if (sheet.vertex == kNone) {
    sheet.vertex = add_vertex(sheet.x, sheet.y, sheet.z);
    if (sheet.suspect) suspects.push_back(sheet.vertex);
  }
  return sheet.vertex;
}

void Builder::add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t step) {
  if (a == b || b == c || c == a) return;
  mesh.triangles.push_back(a);
  mesh.triangles.push_back(b);
  mesh.triangles.push_back(c);
  mesh.step.push_back(step);
}

void WallFiller::fill(ColumnAt a, ColumnAt b, FaceLine left, FaceLine right) {
  if (all_joined(left, right)) return;
  const bool suspect = gather(left, right);
  int state = 0;
  for (std::size_t k = 0; k + 1 < edges_.size(); ++k) {
    state += edges_[k].change;
    if (state == 0) continue;
    const std::uint32_t step = state > 0 ? step_of(b, false, k + 1) : step_of(a, true, k + 1);
    ladder(edges_[k], edges_[k + 1], state, step, left, right, suspect);
  }
}

/// Whether each end of A is on the same sheet as the end of B on both lines: no wall.
bool WallFiller::all_joined(const FaceLine& left, const FaceLine& right) const {
  const int ends = left.corner.ends[static_cast<std::size_t>(left.quadrant_a)];
  if (ends != left.corner.ends[static_cast<std::size_t>(left.quadrant_b)]) return false;
  for (int e = 0; e < ends; ++e) {
    if (left.row.rank(left.corner, left.quadrant_a, e) != left.row.rank(left.corner, left.quadrant_b, e))
      return false;
    if (right.row.rank(right.corner, right.quadrant_a, e) !=
        right.row.rank(right.corner, right.quadrant_b, e))
      return false;
  }
  return true;
}

/// Collects the edges of both columns from bottom to top. True if some cross or coincide so that an edge may
/// get more than two triangles.
bool WallFiller::gather(const FaceLine& left, const FaceLine& right) {
  edges_.clear();
  for (const bool of_a : {true, false}) {
    const int lq = of_a ? left.quadrant_a : left.quadrant_b, rq = of_a ? right.quadrant_a : right.quadrant_b;
    const int ends = left.corner.ends[static_cast<std::size_t>(lq)];
    assert(ends == right.corner.ends[static_cast<std::size_t>(rq)]);
    for (int e = 0; e < ends; ++e) {
      const int change = (e % 2 == 0) == of_a ? 1 : -1;
      edges_.push_back(
          {left.row.rank(left.corner, lq, e), right.row.rank(right.corner, rq, e), change, e, of_a});
    }
  }
  sort_few(edges_, [](const Edge& a, const Edge& b) {
    if (a.left + a.right != b.left + b.right) return a.left + a.right < b.left + b.right;
    return a.left < b.left;
  });
  bool suspect = false;
  int state = 0;
  for (std::size_t k = 0; k + 1 < edges_.size(); ++k) {
    const Edge& low = edges_[k];
    const Edge& high = edges_[k + 1];
    const int before = state;
    state += low.change;
    const bool crossing = high.left < low.left || high.right < low.right;
    const bool doubled = high.left == low.left && high.right == low.right && before != 0;
    suspect = suspect || crossing || doubled || state > 1 || state < -1;
  }
  return suspect;
}

/// The step of the wall above edge `above - 1`: in the column without material there, that of the floor
/// below, else that of the ceiling above, else the one that cut through.
std::uint32_t WallFiller::step_of(ColumnAt column, bool is_a, std::size_t above) const {
  const Columns& columns = builder_.columns;
  for (std::size_t k = above; k-- > 0;)
    if (edges_[k].of_a == is_a && edges_[k].end % 2 == 1)
      return columns.step(column.i, column.j, edges_[k].end);
  for (std::size_t k = above; k < edges_.size(); ++k)
    if (edges_[k].of_a == is_a && edges_[k].end % 2 == 0)
      return columns.step(column.i, column.j, edges_[k].end);
  return columns.cut_through(column.i, column.j);
}

/// Adds triangles between the two lines from edge `low` up to edge `high`, |times| times, facing B if `times`
/// is positive.
void WallFiller::ladder(const Edge& low, const Edge& high, int times, std::uint32_t step, FaceLine left,
                        FaceLine right, bool suspect) {
  const int left_way = high.left >= low.left ? 1 : -1, right_way = high.right >= low.right ? 1 : -1;
  int l = low.left, r = low.right;
  const auto at = [&](FaceLine& line, int rank) {
    const std::uint32_t v = builder_.vertex(line.row.sheet(line.corner, rank));
    if (suspect) builder_.suspects.push_back(v);
    return v;
  };
  const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (int n = 0; n < times; ++n) builder_.add(a, b, c, step);
    for (int n = 0; n < -times; ++n) builder_.add(a, c, b, step);
  };
  while (l != high.left || r != high.right) {
    bool go_left = r == high.right;
    if (l != high.left && r != high.right) {
      go_left = left.row.sheet(left.corner, l + left_way).z < right.row.sheet(right.corner, r + right_way).z;
    }
    const std::uint32_t vl = at(left, l), vr = at(right, r);
    if (go_left) {
      l += left_way;
      emit(vl, vr, at(left, l));
    } else {
      r += right_way;
      emit(vl, vr, at(right, r));
    }
  }
}

}  // namespace kerf::meshing

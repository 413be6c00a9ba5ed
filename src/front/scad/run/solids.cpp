// Booleans and transforms of areas and stacks of slabs.
#include "front/scad/run/solids.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "geom/solid/triangulate.h"

#include "kerf/base/limits.h"

namespace kerf::scad {
namespace {

constexpr double kSame = 1e-9;  // mm: heights closer than this are one; relative size of transform entries

Boolean boolean_of(Operation what) {
  switch (what) {
    case Operation::unite: return Boolean::unite;
    case Operation::subtract: return Boolean::subtract;
    case Operation::intersect: break;
  }
  return Boolean::intersect;
}

Region region_combined(Interpreter& run, const Region& a, const Region& b, Operation what, Position at) {
  if (a.empty()) return what == Operation::unite ? b : Region{};
  if (b.empty()) return what == Operation::intersect ? Region{} : a;
  auto result = combine(a, b, boolean_of(what), region_options(run, at), run.diagnostics());
  if (!result) throw Stop{};  // reported
  return std::move(result->region);
}

/// Numbers the groups of regions whose boxes overlap, also by way of others.
std::vector<std::size_t> groups_of(const std::vector<Region>& regions) {
  std::vector<Box2> boxes;
  std::vector<std::size_t> order, group(regions.size());
  const double weld = Tolerance{}.weld.mm();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    boxes.push_back(bounds(regions[i]).grown(weld));
    order.push_back(i);
    group[i] = i;
  }
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return boxes[a].low.x < boxes[b].low.x; });
  std::vector<std::size_t> active;  // those that reach the x of the current one
  for (const std::size_t i : order) {
    std::erase_if(active, [&](std::size_t k) { return boxes[k].high.x < boxes[i].low.x; });
    for (const std::size_t k : active)
      if (boxes[k].overlaps(boxes[i])) group[root(k)] = root(i);
    active.push_back(i);
  }
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = root(i);
  return group;
}

/// The union. Regions apart from all others are not resolved again: a field of 100,000 circles takes little
/// more than they do.
Region united_regions(Interpreter& run, std::vector<Region> regions, Position at) {
  const std::vector<std::size_t> group = groups_of(regions);
  std::vector<std::vector<std::size_t>> members(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) members[group[i]].push_back(i);
  Region sum;
  for (const std::vector<std::size_t>& list : members) {
    if (list.empty()) continue;
    Region part = std::move(regions[list[0]]);
    if (list.size() > 1) {
      std::vector<Region> parts{std::move(part)};
      for (std::size_t k = 1; k < list.size(); ++k) parts.push_back(std::move(regions[list[k]]));
      auto result = unite(parts, region_options(run, at), run.diagnostics());
      if (!result) throw Stop{};
      part = std::move(*result);
    }
    for (Outline& loop : part.loops) sum.loops.push_back(std::move(loop));
  }
  return sum;
}

/// The area of a solid between two heights without a slab's end between them.
Region area_at(const Shape& s, double low, double high) {
  const double between = 0.5 * (low + high);
  for (const Slab& slab : s.slabs)
    if (slab.low < between && between < slab.high) return slab.region;
  return {};
}

/// Slabs of equal area on each other become one.
void add_slab(Shape& s, Slab slab) {
  if (slab.region.empty()) return;
  if (!s.slabs.empty() && std::fabs(s.slabs.back().high - slab.low) < kSame &&
      s.slabs.back().region == slab.region)
    s.slabs.back().high = slab.high;
  else
    s.slabs.push_back(std::move(slab));
}

Shape solids_combined(Interpreter& run, const Shape& a, const Shape& b, Operation what, Position at) {
  std::vector<double> heights;
  for (const Shape* s : {&a, &b})
    for (const Slab& slab : s->slabs) {
      heights.push_back(slab.low);
      heights.push_back(slab.high);
    }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end(), [](double x, double y) { return y - x < kSame; }),
                heights.end());
  Shape out;
  out.kind = Shape::Kind::solid;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    run.tick(at);
    const double low = heights[i - 1], high = heights[i];
    add_slab(out, {low, high, region_combined(run, area_at(a, low, high), area_at(b, low, high), what, at)});
  }
  return out;
}

/// Whether the linear part keeps Z vertical and the plane level.
bool is_upright(const Matrix& m) {
  const double size = std::fabs(m[2][2]);
  const double tiny = kSame * std::max(1.0, size);
  return std::fabs(m[0][2]) <= tiny && std::fabs(m[1][2]) <= tiny && std::fabs(m[2][0]) <= tiny &&
         std::fabs(m[2][1]) <= tiny;
}

/// Whether the plane's part only turns, mirrors and scales by one factor, so that arcs stay arcs.
bool is_similar(const Matrix& m) {
  const double a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
  const double size = std::max(std::fabs(a) + std::fabs(c), 1e-300);
  return (std::fabs(a - d) <= kSame * size && std::fabs(b + c) <= kSame * size) ||
         (std::fabs(a + d) <= kSame * size && std::fabs(b - c) <= kSame * size);
}

Point2 at_plane(const Matrix& m, Point2 p) {
  return {m[0][0] * p.x + m[0][1] * p.y + m[0][3], m[1][0] * p.x + m[1][1] * p.y + m[1][3]};
}

/// Arcs become chords where the transform does not keep them.
Region region_transformed(Interpreter& run, const Region& region, const Matrix& m, Position at) {
  const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  if (determinant == 0.0) return {};
  const bool keeps_arcs = is_similar(m);
  std::vector<Outline> loops;
  for (const Outline& loop : region.loops) {
    Outline out;
    if (keeps_arcs) {
      out.start = at_plane(m, loop.start);
      for (const Segment& s : loop.segments) {
        Segment t{at_plane(m, s.to), {}};
        if (s.via) t.via = at_plane(m, *s.via);
        out.segments.push_back(t);
      }
    } else {
      const std::vector<Point2> points = flattened(loop, Tolerance{}.chord);
      out.start = at_plane(m, points.front());
      for (std::size_t i = 1; i < points.size(); ++i) out.segments.push_back({at_plane(m, points[i]), {}});
    }
    out.segments.back().to = out.start;
    loops.push_back(std::move(out));
  }
  // Mirrored loops have the other direction: outer ones stay counter-clockwise, holes clockwise.
  if (determinant < 0.0)
    for (Outline& loop : loops) loop = reversed(loop);
  auto result = make_region(loops, FillRule::positive, region_options(run, at), run.diagnostics());
  if (!result) throw Stop{};
  return std::move(*result);
}

/// A block along the axes stays one under quarter turns about X and Y.
bool turned_block(Shape& s, const Matrix& m) {
  if (s.slabs.size() != 1 || s.slabs[0].region.loops.size() != 1) return false;
  const Outline& loop = s.slabs[0].region.loops[0];
  if (loop.segments.size() != 4) return false;
  const Box2 box = bounds(s.slabs[0].region);
  for (const Segment& e : loop.segments)
    if (e.via || (e.to.x != box.low.x && e.to.x != box.high.x) ||
        (e.to.y != box.low.y && e.to.y != box.high.y))
      return false;
  for (int row = 0; row < 3; ++row) {
    int used = 0;
    for (int column = 0; column < 3; ++column)
      if (std::fabs(m[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]) > kSame) ++used;
    if (used != 1) return false;
  }
  Point3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (int corner = 0; corner < 8; ++corner) {
    const Point3 p{(corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                   (corner & 4) != 0 ? s.slabs[0].high : s.slabs[0].low};
    for (int i = 0; i < 3; ++i) {
      const auto& row = m[static_cast<std::size_t>(i)];
      double x = row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
      if (std::fabs(x - std::round(x)) < kSame) x = std::round(x);
      low[i] = std::min(low[i], x);
      high[i] = std::max(high[i], x);
    }
  }
  Outline out{{low.x, low.y}, {}};
  for (const Point2 p :
       {Point2{high.x, low.y}, Point2{high.x, high.y}, Point2{low.x, high.y}, Point2{low.x, low.y}})
    out.segments.push_back({p, {}});
  s.slabs = {{low.z, high.z, {{std::move(out)}}}};
  return true;
}

/// Triangles whose corners are not all different have no area.
void drop_flat_triangles(SolidBody& body) {
  const auto corner = [&](std::uint32_t i) {
    return Point3{body.positions[3 * i], body.positions[3 * i + 1], body.positions[3 * i + 2]};
  };
  std::vector<std::uint32_t> kept;
  for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3) {
    const std::uint32_t a = body.triangles[t], b = body.triangles[t + 1], c = body.triangles[t + 2];
    if (distance(corner(a), corner(b)) > kSame && distance(corner(b), corner(c)) > kSame &&
        distance(corner(c), corner(a)) > kSame)
      kept.insert(kept.end(), {a, b, c});
  }
  body.triangles = std::move(kept);
}

void turn_triangles(SolidBody& body) {
  for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3)
    std::swap(body.triangles[t + 1], body.triangles[t + 2]);
}

double volume_of(const SolidBody& body) {
  const auto corner = [&](std::size_t t) {
    const std::size_t i = 3 * std::size_t{body.triangles[t]};
    return Point3{body.positions[i], body.positions[i + 1], body.positions[i + 2]};
  };
  double sum = 0.0;
  for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3)
    sum += dot(corner(t), cross(corner(t + 1), corner(t + 2)));
  return sum / 6.0;
}

void move_body(SolidBody& body, const Matrix& m) {
  for (std::size_t i = 0; i + 2 < body.positions.size(); i += 3) {
    const Point3 p{body.positions[i], body.positions[i + 1], body.positions[i + 2]};
    for (std::size_t row = 0; row < 3; ++row)
      body.positions[i + row] = m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + m[row][3];
  }
  const Point3 x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
  if (dot(cross(x, y), z) < 0.0) turn_triangles(body);
}

/// The rings of a figure as polygons, the outside counter-clockwise and the holes clockwise.
std::vector<outline_detail::Ring> rings_of(const Figure& figure, Length chord) {
  std::vector<outline_detail::Ring> rings;
  for (const auto& part : figure) {
    const auto* circle = std::get_if<Circle>(&part);
    outline_detail::Ring ring =
        circle != nullptr ? flattened(*circle, chord) : flattened(std::get<Outline>(part), chord);
    if (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
    if ((outline_detail::area(ring) > 0.0) != rings.empty()) std::reverse(ring.begin(), ring.end());
    rings.push_back(std::move(ring));
  }
  return rings;
}

/// Coarser where a finer one would take too many points.
Length chord_for(const std::vector<Figure>& list, int copies) {
  constexpr double kManyPoints = 1e6, kCoarser = 10.0;
  double points = 0.0;
  for (const Figure& figure : list)
    for (const auto& ring : rings_of(figure, Tolerance{}.chord)) points += static_cast<double>(ring.size());
  return points * copies > kManyPoints ? kCoarser * Tolerance{}.chord : Tolerance{}.chord;
}

/// Two triangles for each side of the ring between its copies that start at points `from` and `to`.
void append_walls(SolidBody& body, const std::vector<outline_detail::Ring>& rings, std::uint32_t from,
                  std::uint32_t to) {
  std::uint32_t first = 0;
  for (const auto& ring : rings) {
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % n;
      body.triangles.insert(body.triangles.end(), {a + from, b + from, b + to, a + from, b + to, a + to});
    }
    first += n;
  }
}

}  // namespace

void append_bodies(Interpreter& run, Shape& shape, Position at) {
  for (const Slab& slab : shape.slabs) {
    const auto point_at = [&](Point2 p, double t) {
      return Point3{p.x, p.y, slab.low + t * (slab.high - slab.low)};
    };
    for (SolidBody& body : swept(run, slab.region, {1, false, point_at}, at).bodies)
      shape.bodies.push_back(std::move(body));
  }
}

Shape swept(Interpreter& run, const Region& region, const Sweep& sweep, Position at) {
  constexpr std::size_t kMaxPoints = 4'000'000;
  const int copies = sweep.steps + (sweep.closed ? 0 : 1);
  SolidBody body;
  std::uint32_t first = 0;
  const std::vector<Figure> list = figures(region);
  const Length chord = chord_for(list, copies);
  for (const Figure& figure : list) {
    const auto rings = rings_of(figure, chord);
    std::uint32_t points = 0;
    for (const auto& ring : rings) points += static_cast<std::uint32_t>(ring.size());
    const outline_detail::Triangulation caps = outline_detail::triangulate(rings);
    if (first + static_cast<std::size_t>(copies) * points > kMaxPoints || caps.too_much)
      run.fail(codes::scad_limit, at, fmt::format("a solid of more than {} points", kMaxPoints));
    for (int i = 0; i < copies; ++i)
      for (const auto& ring : rings)
        for (const Point2 p : ring) {
          const Point3 q = sweep.point_at(p, static_cast<double>(i) / sweep.steps);
          body.positions.insert(body.positions.end(), {q.x, q.y, q.z});
        }
    for (int i = 0; i < sweep.steps; ++i)
      append_walls(body, rings, first + static_cast<std::uint32_t>(i) * points,
                   first + static_cast<std::uint32_t>((i + 1) % copies) * points);
    const std::uint32_t last = first + static_cast<std::uint32_t>(copies - 1) * points;
    if (!sweep.closed)
      for (const auto& [a, b, c] : caps.triangles)
        body.triangles.insert(body.triangles.end(),
                              {a + first, c + first, b + first, a + last, b + last, c + last});
    first += static_cast<std::uint32_t>(copies) * points;
  }
  return body_shape(std::move(body));
}

Shape body_shape(SolidBody body) {
  Shape solid;
  solid.kind = Shape::Kind::solid;
  drop_flat_triangles(body);
  if (body.triangles.empty()) return solid;
  if (volume_of(body) < 0.0) turn_triangles(body);
  solid.bodies.push_back(std::move(body));
  return solid;
}

Box3 bounds_of(const Shape& shape) {
  Box3 box;
  const auto add = [&](const Region& region, double z) {
    const Box2 plan = bounds(region);
    if (plan.empty()) return;
    box.add(Point3{plan.low.x, plan.low.y, z});
    box.add(Point3{plan.high.x, plan.high.y, z});
  };
  if (shape.kind == Shape::Kind::area) add(shape.region, 0.0);
  for (const Slab& slab : shape.slabs) {
    add(slab.region, slab.low);
    add(slab.region, slab.high);
  }
  for (const SolidBody& body : shape.bodies)
    for (std::size_t i = 0; i + 2 < body.positions.size(); i += 3)
      box.add(Point3{body.positions[i], body.positions[i + 1], body.positions[i + 2]});
  return box;
}

Shape shadow_of(Interpreter& run, const Shape& solid, Position at) {
  std::vector<Region> parts;
  for (const Slab& slab : solid.slabs) parts.push_back(slab.region);
  for (const SolidBody& body : solid.bodies)
    for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        const std::size_t i = 3 * std::size_t{body.triangles[t + k]};
        return Point2{body.positions[i], body.positions[i + 1]};
      };
      // Those that face upwards cover the whole shadow.
      const Point2 a = corner(0), b = corner(1), c = corner(2);
      if (cross(b - a, c - a) > kSame * kSame) parts.push_back({{Outline{a, {{b, {}}, {c, {}}, {a, {}}}}}});
    }
  auto result = unite(parts, region_options(run, at), run.diagnostics());
  if (!result) throw Stop{};
  return area_shape(std::move(*result));
}

Matrix identity() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}; }

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      m[i][j] = j == 3 ? a[i][3] : 0.0;
      for (std::size_t k = 0; k < 3; ++k) m[i][j] += a[i][k] * b[k][j];
    }
  return m;
}

RegionOptions region_options(Interpreter& run, Position at) {
  RegionOptions options;
  options.where = run.locate(at);
  return options;
}

Shape area_shape(Region region) {
  Shape s;
  s.kind = Shape::Kind::area;
  s.region = std::move(region);
  return s;
}

Shape extruded(Region region, double low, double high) {
  Shape s;
  s.kind = Shape::Kind::solid;
  if (!region.empty() && low < high) s.slabs.push_back({low, high, std::move(region)});
  return s;
}

Shape polygons(Interpreter& run, const std::vector<std::vector<Point2>>& paths, Position at) {
  std::vector<Outline> loops;
  for (const std::vector<Point2>& path : paths) {
    if (path.size() < 3) continue;
    Outline loop;
    loop.start = path[0];
    for (std::size_t i = 1; i < path.size(); ++i)
      if (path[i] != path[i - 1]) loop.segments.push_back({path[i], {}});
    if (loop.segments.empty()) continue;
    if (loop.segments.back().to != loop.start) loop.segments.push_back({loop.start, {}});
    loops.push_back(std::move(loop));
  }
  if (loops.empty()) return area_shape({});
  auto region = make_region(loops, FillRule::even_odd, region_options(run, at), run.diagnostics());
  if (!region) throw Stop{};
  return area_shape(std::move(*region));
}

Shape combined(Interpreter& run, const Shape& a, const Shape& b, Operation what, Position at) {
  if (a.kind == Shape::Kind::nothing) return what == Operation::unite ? b : a;
  if (b.kind == Shape::Kind::nothing) return a;
  if (a.kind != b.kind) {
    run.error(codes::scad_refused, at, "an area and a solid cannot be combined");
    return a;
  }
  if (a.kind == Shape::Kind::area) return area_shape(region_combined(run, a.region, b.region, what, at));
  if (what != Operation::unite && !(a.bodies.empty() && b.bodies.empty())) {
    run.error(codes::scad_refused, at,
              "differences and intersections are possible of solids with vertical sides only")
        .hint =
        "spheres, cones, turned and imported solids can be moved and united; cut the rest with a tool";
    return a;
  }
  Shape sum = solids_combined(run, a, b, what, at);
  for (const Shape* s : {&a, &b}) sum.bodies.insert(sum.bodies.end(), s->bodies.begin(), s->bodies.end());
  return sum;
}

Shape united(Interpreter& run, Shapes shapes, Position at) {
  if (shapes.size() == 1) return std::move(shapes[0]);
  const bool only_areas =
      std::all_of(shapes.begin(), shapes.end(), [](const Shape& s) { return s.kind == Shape::Kind::area; });
  if (only_areas && !shapes.empty()) {
    std::vector<Region> regions;
    for (Shape& s : shapes) regions.push_back(std::move(s.region));
    return area_shape(united_regions(run, std::move(regions), at));
  }
  Shape sum;
  for (const Shape& s : shapes) sum = combined(run, sum, s, Operation::unite, at);
  return sum;
}

void intersect_passes(Interpreter& run, Position at, Shapes& passes, Shapes& out) {
  if (passes.empty()) return;
  Shape common = std::move(passes[0]);
  for (std::size_t i = 1; i < passes.size(); ++i)
    common = combined(run, common, passes[i], Operation::intersect, at);
  if (common.kind != Shape::Kind::nothing) out.push_back(std::move(common));
}

Shape transformed(Interpreter& run, Shape shape, const Matrix& m, Position at) {
  for (const auto& row : m)
    for (const double x : row)
      if (!std::isfinite(x) || std::fabs(x) > limits::kMaxCoordinate) {
        run.error(codes::scad_refused, at, "a transform with a number that is not finite or too large");
        return {};
      }
  if (shape.kind == Shape::Kind::nothing) return shape;
  if (shape.kind == Shape::Kind::area) {
    if (!is_upright(m)) {
      run.error(codes::scad_refused, at, "an area is turned out of the XY plane").hint =
          "linear_extrude() it first, or leave out the rotation about X and Y";
      return {};
    }
    shape.region = region_transformed(run, shape.region, m, at);
    return shape;
  }
  if (!is_upright(m)) {
    if (shape.bodies.empty() && turned_block(shape, m)) return shape;
    append_bodies(run, shape, at);
    shape.slabs.clear();
  }
  for (SolidBody& body : shape.bodies) move_body(body, m);
  for (Slab& slab : shape.slabs) {
    const double low = m[2][2] * slab.low + m[2][3], high = m[2][2] * slab.high + m[2][3];
    slab = {std::min(low, high), std::max(low, high), region_transformed(run, slab.region, m, at)};
  }
  if (m[2][2] < 0.0) std::reverse(shape.slabs.begin(), shape.slabs.end());
  if (m[2][2] == 0.0) shape.slabs.clear();
  return shape;
}

}  // namespace kerf::scad

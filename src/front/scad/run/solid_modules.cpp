// The modules of OpenSCAD that make solids.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/module_call.h"

#include "kerf/base/limits.h"

namespace kerf::scad {
namespace {

/// The solid that an area, its Y upwards, makes as it turns about the axis.
Shape revolved(ModuleCall& call, const Region& region, double angle) {
  const Box2 box = bounds(region);
  const double radius = std::max(std::fabs(box.low.x), std::fabs(box.high.x));
  const double turn = std::fabs(angle) >= 360.0 ? 360.0 : angle;
  if (box.empty() || radius == 0.0 || turn == 0.0) return {};
  int edges = edges_of(call);
  if (edges == 0) {  // chords within the tolerance
    const double step = 2.0 * std::acos(std::max(0.0, 1.0 - Tolerance{}.chord.mm() / radius));
    edges = static_cast<int>(std::clamp(std::ceil(2.0 * std::numbers::pi / step), 24.0, 2000.0));
  }
  const auto point_at = [&](Point2 p, double t) {
    return Point3{p.x * cos_degrees(turn * t), p.x * sin_degrees(turn * t), p.y};
  };
  const int steps = std::max(1, static_cast<int>(std::ceil(edges * std::fabs(turn) / 360.0)));
  return swept(call.run, region, {steps, turn == 360.0, point_at}, call.statement.at);
}

}  // namespace

void cube(ModuleCall& call) {
  const Arguments a(call);
  const Point3 size = a.vector("size", {1, 1, 1}, {3, 3});
  if (not_positive(call, size.x, "the size in X") || not_positive(call, size.y, "the size in Y") ||
      not_positive(call, size.z, "the size in Z"))
    return;
  const Point3 low = a.flag("center") ? -0.5 * size : Point3{};
  give(call, extruded(rectangle(low.xy(), (low + size).xy()), low.z, low.z + size.z));
}

void cylinder(ModuleCall& call) {
  const Arguments a(call);
  const double h = a.number("h", 1.0);
  const double both = a.given("r") || a.given("d") ? radius_of(a, 1.0) : 1.0;
  const double r1 = radius_of(a, both, "r1", "d1"), r2 = radius_of(a, both, "r2", "d2");
  if (not_positive(call, h, "the height") || not_positive(call, std::max(r1, r2), "the radius")) return;
  if (r1 < 0.0 || r2 < 0.0) {
    not_positive(call, std::min(r1, r2), "the radius");
    return;
  }
  if (r1 != r2) {
    const double base = a.flag("center") ? -0.5 * h : 0.0;
    Outline half{{0, base}, {}};
    for (const Point2 p : {Point2{r1, base}, Point2{r2, base + h}, Point2{0, base + h}, Point2{0, base}})
      if (half.segments.empty() ? p != half.start : p != half.segments.back().to)
        half.segments.push_back({p, {}});
    give(call, revolved(call, {{std::move(half)}}, 360.0));
    return;
  }
  const double low = a.flag("center") ? -0.5 * h : 0.0;
  give(call, extruded(circle_region(call, r1), low, low + h));
}

void linear_extrude(ModuleCall& call) {
  const Arguments a(call);
  Shape s = children_of(call);
  const double h =
      a["file"].is_number() && !a.given("height") ? a.number("file", 100.0) : a.number("height", 100.0);
  if (s.kind == Shape::Kind::nothing || not_positive(call, h, "the height")) return;
  if (s.kind != Shape::Kind::area) {
    refuse(call, "linear_extrude() of a solid", "its children must be areas: square(), circle(), polygon()");
    return;
  }
  const double low = a.flag("center") ? -0.5 * h : 0.0;
  const double twist = a.number("twist", 0.0);
  const Point3 top = a.vector("scale", {1, 1, 1}, {2, 2});
  if (twist == 0.0 && top.x == 1.0 && top.y == 1.0) {
    give(call, extruded(std::move(s.region), low, low + h));
    return;
  }
  if (top.x < 0.0 || top.y < 0.0) {
    a.wrong("scale", "factors of 0 or more");
    return;
  }
  constexpr double kDegreesPerSlice = 3.0;
  const double slices = a.number("slices", std::ceil(std::fabs(twist) / kDegreesPerSlice));
  const auto point_at = [&](Point2 p, double t) {
    const double c = cos_degrees(-twist * t), sine = sin_degrees(-twist * t);
    const Point2 q{p.x * (1.0 + t * (top.x - 1.0)), p.y * (1.0 + t * (top.y - 1.0))};
    return Point3{c * q.x - sine * q.y, sine * q.x + c * q.y, low + t * h};
  };
  const int steps = static_cast<int>(std::clamp(slices, 1.0, 10'000.0));
  give(call, swept(call.run, s.region, {steps, false, point_at}, call.statement.at));
}

void sphere(ModuleCall& call) {
  const Arguments a(call);
  const double r = radius_of(a, 1.0);
  if (not_positive(call, r, "the radius")) return;
  const int edges = edges_of(call);
  Outline half{{0, -r}, {}};
  if (edges == 0) {
    half.segments.push_back({{0, r}, Point2{r, 0}});
  } else {  // as OpenSCAD: rings at half steps, flat at the poles
    const int rings = (edges + 1) / 2;
    half.start = {0, -r * cos_degrees(90.0 / rings)};
    for (int i = 0; i < rings; ++i) {
      const double angle = 180.0 * (i + 0.5) / rings;
      half.segments.push_back({{r * sin_degrees(angle), -r * cos_degrees(angle)}, {}});
    }
    half.segments.push_back({{0, -half.start.y}, {}});
  }
  half.segments.push_back({half.start, {}});
  give(call, revolved(call, {{std::move(half)}}, 360.0));
}

void polyhedron(ModuleCall& call) {
  const Arguments a(call);
  const Value& faces = a.given("faces") ? a["faces"] : a["triangles"];
  SolidBody body;
  bool valid = a["points"].is(Type::vector) && faces.is(Type::vector);
  if (valid)
    for (const Value& p : a["points"].items()) {
      valid = valid && p.is(Type::vector) && p.items().size() == 3;
      for (std::size_t i = 0; valid && i < 3; ++i) {
        valid = p.items()[i].is_number() && std::fabs(p.items()[i].number()) <= limits::kMaxCoordinate;
        if (valid) body.positions.push_back(p.items()[i].number());
      }
    }
  if (!valid) {
    a.wrong("points", "a vector of points of 3 finite numbers, with faces");
    return;
  }
  const auto count = static_cast<double>(body.positions.size() / 3);
  for (const Value& face : faces.items()) {
    std::vector<std::uint32_t> corners;
    valid = valid && face.is(Type::vector) && face.items().size() >= 3;
    for (std::size_t i = 0; valid && i < face.items().size(); ++i) {
      const Value& v = face.items()[i];
      valid = v.is_number() && v.number() >= 0.0 && v.number() < count;
      if (valid) corners.push_back(static_cast<std::uint32_t>(v.number()));
    }
    for (std::size_t i = 2; valid && i < corners.size(); ++i)
      body.triangles.insert(body.triangles.end(), {corners[0], corners[i - 1], corners[i]});
  }
  if (valid)
    give(call, body_shape(std::move(body)));
  else
    a.wrong(a.given("faces") ? "faces" : "triangles", "vectors of at least 3 indices of points");
}

void rotate_extrude(ModuleCall& call) {
  const Arguments a(call);
  const Shape s = children_of(call);
  if (s.kind == Shape::Kind::nothing) return;
  if (s.kind != Shape::Kind::area) {
    refuse(call, "rotate_extrude() of a solid", "its children must be areas");
    return;
  }
  const Box2 box = bounds(s.region);
  if (box.low.x < 0.0 && box.high.x > 0.0) {
    call.run.error(codes::scad_shape, call.statement.at,
                   "rotate_extrude(): all points must have the same X coordinate sign");
    return;
  }
  give(call, revolved(call, s.region, a.number("angle", 360.0)));
}

void projection(ModuleCall& call) {
  const Arguments a(call);
  Shape s = children_of(call);
  if (s.kind != Shape::Kind::solid) return;
  if (!a.flag("cut")) {
    give(call, shadow_of(call.run, s, call.statement.at));
    return;
  }
  if (!s.bodies.empty()) {
    refuse(call, "projection(cut = true) of a solid whose sides are not vertical",
           "leave out cut for its shadow; move and cut the areas before they become solids");
    return;
  }
  Shapes areas;
  for (Slab& slab : s.slabs)
    if (slab.low <= 0.0 && slab.high > 0.0) areas.push_back(area_shape(std::move(slab.region)));
  give(call, united(call.run, std::move(areas), call.statement.at));
}

}  // namespace kerf::scad

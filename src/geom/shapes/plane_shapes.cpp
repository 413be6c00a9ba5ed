// The table of plane shapes, and what makes each of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"

#include "kerf/base/limits.h"
#include "kerf/geom/shapes.h"

namespace kerf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kCurvePieces = 180;      // arcs of a curve without arcs of its own
constexpr double kOneThird = 1.0 / 3;  // of a deltoid's circle

Point2 on_circle(Point2 centre, double radius, double angle) {
  const double a = degrees(angle).rad();
  return {centre.x + radius * std::cos(a), centre.y + radius * std::sin(a)};
}

/// An outline of points, and of arcs through a point between.
class Drawn {
 public:
  explicit Drawn(Point2 start) { outline_.start = start; }
  Drawn& line(Point2 to) {
    outline_.segments.push_back({to, {}});
    return *this;
  }
  Drawn& arc(Point2 via, Point2 to) {
    outline_.segments.push_back({to, via});
    return *this;
  }
  /// About a centre between two angles, degrees.
  Drawn& arc(Point2 centre, double radius, double start, double end) {
    return arc(on_circle(centre, radius, (start + end) / 2), on_circle(centre, radius, end));
  }
  /// Ends exactly at the start; by a line, if the last segment ends elsewhere.
  Outline closed() {
    Point2& last = outline_.segments.back().to;
    if (distance(last, outline_.start) < kSame)
      last = outline_.start;
    else
      line(outline_.start);
    return std::move(outline_);
  }

 private:
  static constexpr double kSame = 1e-9;  // mm: rounding of cosines
  Outline outline_;
};

/// A closed curve of arcs through points at evenly spaced values of its parameter, over a full turn.
template <class At>
Outline curve(At at) {
  const double step = kTurn / (2 * kCurvePieces);
  Drawn drawn(at(0.0));
  for (int i = 0; i < kCurvePieces; ++i) drawn.arc(at((2 * i + 1) * step), at((2 * i + 2) * step));
  return drawn.closed();
}

Outline polygon(std::initializer_list<Point2> points) {
  Drawn drawn(*points.begin());
  for (const Point2* p = points.begin() + 1; p != points.end(); ++p) drawn.line(*p);
  return drawn.closed();
}

// ---- round shapes. `v` are the arguments in the order of the table.

Outline circle(const double* v) {
  const Point2 c{v[0], v[1]};
  return Drawn(on_circle(c, v[2], 0)).arc(c, v[2], 0, 180).arc(c, v[2], 180, 360).closed();
}

Outline ellipse(const double* v) {
  return curve([v](double t) {
    return Point2{v[0] + v[2] / 2 * std::cos(t), v[1] + v[3] / 2 * std::sin(t)};
  });
}

// cos t (1 - point sin t) has its greatest value, `widest`, where sin t is `sine`.
Outline egg(const double* v) {
  const double point = v[4];
  const double sine = -2 * point / (1 + std::sqrt(1 + 8 * point * point));
  const double widest = std::sqrt(1 - sine * sine) * (1 - point * sine);
  return curve([v, point, widest](double t) {
    const double half = v[2] / 2 * std::cos(t) * (1 - point * std::sin(t)) / widest;
    return Point2{v[0] + half, v[1] + v[3] / 2 * std::sin(t)};
  });
}

Outline superellipse(const double* v) {
  return curve([v](double t) {
    const double c = std::cos(t), s = std::sin(t), power = 2 / v[4];
    return Point2{v[0] + std::copysign(std::pow(std::abs(c), power), c) * v[2] / 2,
                  v[1] + std::copysign(std::pow(std::abs(s), power), s) * v[3] / 2};
  });
}

Outline segment(const double* v) {
  const Point2 c{v[0], v[1]};
  const double half = v[3] / 2;
  return Drawn(on_circle(c, v[2], 90 - half)).arc(c, v[2], 90 - half, 90 + half).closed();
}

Outline sector(const double* v) {
  const Point2 c{v[0], v[1]};
  return Drawn(c).line(on_circle(c, v[2], v[4])).arc(c, v[2], v[4], v[4] + v[3]).closed();
}

Outline annulus_segment(const double* v) {
  const Point2 c{v[0], v[1]};
  const double outer = v[2], inner = v[3], start = v[4], end = v[5];
  return Drawn(on_circle(c, outer, start))
      .arc(c, outer, start, end)
      .line(on_circle(c, inner, end))
      .arc(c, inner, end, start)
      .closed();
}

Outline deltoid(const double* v) {
  return curve([v](double t) {
    const double b = v[2] * kOneThird;
    return Point2{v[0] + b * (2 * std::cos(t) + std::cos(2 * t)),
                  v[1] + b * (2 * std::sin(t) - std::sin(2 * t))};
  });
}

Outline astroid(const double* v) {
  return curve([v](double t) {
    return Point2{v[0] + v[2] * std::pow(std::cos(t), 3), v[1] + v[2] * std::pow(std::sin(t), 3)};
  });
}

// ---- shapes of a few arcs

/// Half of the common chord of two circles.
double half_chord(double radius, double apart) { return std::sqrt(radius * radius - apart * apart / 4); }

Outline lens(const double* v) {
  const double x = v[0], y = v[1], r = v[2], d = v[3], h = half_chord(r, d);
  return Drawn({x, y - h}).arc({x + r - d / 2, y}, {x, y + h}).arc({x - r + d / 2, y}, {x, y - h}).closed();
}

Outline lune(const double* v) {
  const double x = v[0], y = v[1], r = v[2], d = v[3], h = half_chord(r, d);
  const Point2 top{x + d / 2, y + h}, bottom{x + d / 2, y - h};
  return Drawn(top).arc({x - r, y}, bottom).arc({x + d - r, y}, top).closed();
}

Outline cone(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3];
  return Drawn({x, y}).line({x + w / 2, y + h}).arc({x, y + h + w / 2}, {x - w / 2, y + h}).closed();
}

Outline arch(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3];
  return Drawn({x, y})
      .line({x + w, y})
      .line({x + w, y + h})
      .arc({x + w / 2, y + h + w / 2}, {x, y + h})
      .closed();
}

Outline heart(const double* v) {
  const double x = v[0], y = v[1], w = v[2], shoulder = y + w * 0.7, top = y + w * 0.95;
  return Drawn({x, y})
      .line({x + w / 2, shoulder})
      .arc({x + w / 4, top}, {x, shoulder})
      .arc({x - w / 4, top}, {x - w / 2, shoulder})
      .closed();
}

Outline tomoe(const double* v) {
  const double x = v[0], y = v[1], r = v[2];
  return Drawn({x, y - r})
      .arc({x + r, y}, {x, y + r})
      .arc({x - r / 2, y + r / 2}, {x, y})
      .arc({x + r / 2, y - r / 2}, {x, y - r})
      .closed();
}

Outline reuleaux(const double* v) {
  const double w = v[2];
  const Point2 a{v[0], v[1]}, b{v[0] + w, v[1]}, c{v[0] + w / 2, v[1] + w * std::sqrt(3.0) / 2};
  return Drawn(a)
      .arc(on_circle(c, w, 270), b)
      .arc(on_circle(a, w, 30), c)
      .arc(on_circle(b, w, 150), a)
      .closed();
}

Outline arbelos(const double* v) {
  const double x = v[0], y = v[1], r = v[2], at = v[3];
  const double between = x - r + 2 * r * at, left = r * at, right = r * (1 - at);
  return Drawn({x + r, y})
      .arc({x, y + r}, {x - r, y})
      .arc({x - r + left, y + left}, {between, y})
      .arc({between + right, y + right}, {x + r, y})
      .closed();
}

Outline salinon(const double* v) {
  const double x = v[0], y = v[1], r = v[2], q = v[3], s = (r - q) / 2;
  return Drawn({x + r, y})
      .arc({x, y + r}, {x - r, y})
      .arc({x - q - s, y + s}, {x - q, y})
      .arc({x, y - q}, {x + q, y})
      .arc({x + q + s, y + s}, {x + r, y})
      .closed();
}

Outline dart(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3], d = v[4];
  return Drawn({x - w / 2, y}).arc({x, y + d}, {x + w / 2, y}).line({x, y + h}).closed();
}

Outline arrowhead(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3], d = v[4];
  // Each side bulges until it is vertical at its foot or horizontal at the tip.
  const double bulge = std::tan(std::min(std::atan2(w / 2, h), std::atan2(h, w / 2)) / 2) / 2;
  const double across = w / 4 + bulge * h, up = h / 2 + bulge * w / 2;
  return Drawn({x - w / 2, y})
      .arc({x, y + d}, {x + w / 2, y})
      .arc({x + across, y + up}, {x, y + h})
      .arc({x - across, y + up}, {x - w / 2, y})
      .closed();
}

Outline concave_square(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3], d = v[4];
  return Drawn({x, y}).line({x + w, y}).line({x + w, y + h}).arc({x + w / 2, y + h - d}, {x, y + h}).closed();
}

// ---- polygons

Outline triangle(const double* v) {
  const double x = v[0], y = v[1], a = v[2], b = v[3], c = v[4];
  const double foot = (a * a + c * c - b * b) / (2 * a);
  return polygon({{x, y}, {x + a, y}, {x + foot, y + std::sqrt(c * c - foot * foot)}});
}

Outline rectangle(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3];
  return polygon({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
}

Outline parallelogram(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3], shift = v[4];
  return polygon({{x, y}, {x + w, y}, {x + w + shift, y + h}, {x + shift, y + h}});
}

Outline rhombus(const double* v) {
  const double x = v[0], y = v[1], w = v[2], h = v[3];
  return polygon({{x, y - h / 2}, {x + w / 2, y}, {x, y + h / 2}, {x - w / 2, y}});
}

Outline trapezoid(const double* v) {
  const double x = v[0], y = v[1], bottom = v[2], top = v[3], h = v[4];
  return polygon({{x, y}, {x + bottom, y}, {x + (bottom + top) / 2, y + h}, {x + (bottom - top) / 2, y + h}});
}

Outline kite(const double* v) {
  const double x = v[0], y = v[1], w = v[2], upper = v[3], lower = v[4];
  return polygon({{x, y - lower}, {x + w / 2, y}, {x, y + upper}, {x - w / 2, y}});
}

// ---- values that do not go together

std::string no_triangle(const double* v) {
  const double a = v[2], b = v[3], c = v[4], foot = (a * a + c * c - b * b) / (2 * a);
  if (c * c > foot * foot) return {};
  return fmt::format("a, b, c: {:g}, {:g} and {:g} are not the sides of a triangle", a, b, c);
}

std::string circles_apart(const double* v) {
  if (v[3] < 2 * v[2]) return {};
  return fmt::format("distance must be below the diameter, not {:g}", v[3]);
}

std::string inner_too_large(const double* v) {
  if (v[3] < v[2]) return {};
  return fmt::format("inner must be below the outer radius, not {:g}", v[3]);
}

std::string no_sweep(double angle) {
  if (angle > 0.0 && angle < 360.0) return {};
  return fmt::format("the angle must be above 0 and below 360 degrees, not {:g}", angle);
}
std::string no_segment(const double* v) { return no_sweep(v[3]); }
std::string no_ring_part(const double* v) {
  const std::string inner = inner_too_large(v);
  return inner.empty() ? no_sweep(v[5] - v[4]) : inner;
}

std::string no_fraction(const double* v) {
  if (v[3] > 0.0 && v[3] < 1.0) return {};
  return fmt::format("at must be above 0 and below 1, not {:g}", v[3]);
}

constexpr ShapeArgument kX{"x", ShapeArgument::Kind::any, {}}, kY{"y", ShapeArgument::Kind::any, {}};
constexpr ShapeArgument size(std::string_view name) { return {name, ShapeArgument::Kind::size, {}}; }
constexpr ShapeArgument any(std::string_view name) { return {name, ShapeArgument::Kind::any, {}}; }
constexpr ShapeArgument any(std::string_view name, double fallback) {
  return {name, ShapeArgument::Kind::any, fallback};
}

std::vector<PlaneShape> round_shapes() {
  const ShapeArgument width = size("width"), height = size("height"), radius = size("radius");
  return {
      {"circle", "a circle about (x, y)", {kX, kY, radius}, circle},
      {"ellipse", "an ellipse about (x, y)", {kX, kY, width, height}, ellipse},
      {"egg", "an oval that is narrower at its top", {kX, kY, width, height, any("point", 0.2)}, egg},
      {"superellipse",
       "between an ellipse (2) and a rectangle",
       {kX, kY, width, height, {"exponent", ShapeArgument::Kind::size, 2.5}},
       superellipse},
      {"segment",
       "the part of a circle above a chord",
       {kX, kY, radius, any("angle", 180)},
       segment,
       no_segment},
      {"lens", "what two circles have in common", {kX, kY, radius, size("distance")}, lens, circles_apart},
      {"lune",
       "a circle without another one to its right",
       {kX, kY, radius, size("distance")},
       lune,
       circles_apart},
      {"tomoe", "a comma of three half circles", {kX, kY, radius}, tomoe},
      {"sector",
       "a slice of a circle",
       {kX, kY, radius, any("angle", 90), any("start", 0)},
       sector,
       no_segment},
      {"deltoid",
       "three cusps: a circle that rolls in one of three times its radius",
       {kX, kY, radius},
       deltoid},
      {"astroid", "four cusps", {kX, kY, radius}, astroid},
      {"reuleaux",
       "constant width on a triangle with its lower left corner at (x, y)",
       {kX, kY, width},
       reuleaux},
      {"arbelos",
       "a half circle without two smaller ones on its diameter",
       {kX, kY, radius, any("at", 0.5)},
       arbelos,
       no_fraction},
      {"annulus_segment",
       "the part of a ring between two angles",
       {kX, kY, size("outer"), size("inner"), any("start"), any("end")},
       annulus_segment,
       no_ring_part},
      {"salinon", "four half circles on one line", {kX, kY, radius, size("inner")}, salinon, inner_too_large},
  };
}

std::vector<PlaneShape> shapes_with_lines() {
  const ShapeArgument width = size("width"), height = size("height"), depth = size("depth");
  return {
      {"cone",
       "a triangle with a half circle at its wide end; its tip is at (x, y)",
       {kX, kY, width, height},
       cone},
      {"arch",
       "a rectangle with a half circle on top; (x, y) is its lower left corner",
       {kX, kY, width, height},
       arch},
      {"heart", "two half circles over a tip at (x, y)", {kX, kY, width}, heart},
      {"triangle",
       "by its three sides, a on the X axis from (x, y)",
       {kX, kY, size("a"), size("b"), size("c")},
       triangle,
       no_triangle},
      {"dart", "two straight sides and a concave arc", {kX, kY, width, height, depth}, dart},
      {"arrowhead", "two convex sides and a concave arc", {kX, kY, width, height, depth}, arrowhead},
      {"rectangle", "(x, y) is its lower left corner", {kX, kY, width, height}, rectangle},
      {"parallelogram",
       "with its top shifted to the right",
       {kX, kY, width, height, any("shift")},
       parallelogram},
      {"rhombus", "about (x, y)", {kX, kY, width, height}, rhombus},
      {"trapezoid",
       "(x, y) is its lower left corner",
       {kX, kY, size("bottom"), size("top"), height},
       trapezoid},
      {"kite", "the widest line is at y", {kX, kY, width, size("upper"), size("lower")}, kite},
      {"concave_square",
       "three straight sides and a concave arc on top",
       {kX, kY, width, height, depth},
       concave_square},
  };
}

std::vector<PlaneShape> make_table() {
  std::vector<PlaneShape> table = round_shapes();
  for (PlaneShape& shape : shapes_with_lines()) table.push_back(std::move(shape));
  std::sort(table.begin(), table.end(),
            [](const PlaneShape& a, const PlaneShape& b) { return a.name < b.name; });
  return table;
}

/// Cubic Bernstein polynomials.
std::array<double, 4> blend(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

}  // namespace

Outline circle(Point2 centre, Length radius) { return as_outline(Circle{centre, radius}); }

Outline rectangle(Point2 low, Point2 high) { return polygon({low, {high.x, low.y}, high, {low.x, high.y}}); }

Outline polygon(const std::vector<Point2>& corners) {
  Outline out;
  if (corners.empty()) return out;
  out.start = corners.front();
  for (std::size_t i = 1; i < corners.size(); ++i) out.segments.push_back({corners[i], {}});
  out.segments.push_back({out.start, {}});
  return out;
}

const std::vector<PlaneShape>& plane_shapes() {
  static const std::vector<PlaneShape> table = make_table();
  return table;
}

const PlaneShape* plane_shape(std::string_view name) {
  for (const PlaneShape& shape : plane_shapes())
    if (shape.name == name) return &shape;
  return nullptr;
}

std::optional<Outline> make_plane_shape(const PlaneShape& shape, const std::vector<double>& values,
                                        const Origin& where, Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  const auto refuse = [&](const std::string& what) {
    diagnostics.error(codes::op_option, where, fmt::format("{}: {}", shape.name, what));
  };
  std::vector<double> all = values;
  for (std::size_t i = 0; i < shape.arguments.size(); ++i) {
    const ShapeArgument& argument = shape.arguments[i];
    if (i >= all.size() && !argument.fallback) refuse(fmt::format("{} is missing", argument.name));
    if (i >= all.size()) all.push_back(argument.fallback.value_or(1.0));
    if (!(std::abs(all[i]) <= limits::kMaxCoordinate))
      refuse(fmt::format("{} must be a number up to {:g}, not {:g}", argument.name, limits::kMaxCoordinate,
                         all[i]));
    else if (argument.kind == ShapeArgument::Kind::size && !(all[i] > 0.0))
      refuse(fmt::format("{} must be above 0, not {:g}", argument.name, all[i]));
  }
  if (values.size() > shape.arguments.size())
    refuse(fmt::format("{} values are given, it has {}", values.size(), shape.arguments.size()));
  if (diagnostics.errors() == errors && shape.problem != nullptr)
    if (const std::string problem = shape.problem(all.data()); !problem.empty()) refuse(problem);
  if (diagnostics.errors() > errors) return std::nullopt;
  return shape.make(all.data());
}

double BezierSurface::at(Point2 p) const {
  const auto u = blend(std::clamp((p.x - corner.x) / width, 0.0, 1.0));
  const auto v = blend(std::clamp((p.y - corner.y) / height, 0.0, 1.0));
  double sum = 0.0;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) sum += v[row] * u[column] * heights[row][column];
  return sum;
}

}  // namespace kerf

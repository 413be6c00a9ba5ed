// The modules of OpenSCAD.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/solids.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"

namespace kerf::scad {
namespace {

/// The arguments of a module by the names of its parameters.
class Arguments {
 public:
  Arguments(ModuleCall& call, std::vector<std::string_view> names) : call_(call), values_(names.size()) {
    std::size_t position = 0;
    const auto& list = call.statement.arguments;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].special) continue;
      std::size_t at = position;
      if (list[i].name.empty())
        ++position;
      else
        at = static_cast<std::size_t>(std::find(names.begin(), names.end(), list[i].name) - names.begin());
      if (at < names.size())
        values_[at] = call.values[i];
      else
        call.run.warn(
            codes::scad_call, list[i].at,
            fmt::format("{}() has no such parameter; this argument is not used", call.statement.name));
    }
    names_ = std::move(names);
  }

  const Value& operator[](std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return values_[static_cast<std::size_t>(found - names_.begin())];
  }
  bool given(std::string_view name) const { return !(*this)[name].is_undef(); }
  /// A finite number; another value is an error, and gives `otherwise`.
  double number(std::string_view name, double otherwise) const {
    const Value& v = (*this)[name];
    if (v.is_undef()) return otherwise;
    if (v.is_number() && std::isfinite(v.number()) && std::fabs(v.number()) <= limits::kMaxCoordinate)
      return v.number();
    wrong(name, "a finite number");
    return otherwise;
  }
  /// Two or three numbers, or one number for all of them.
  Point3 vector(std::string_view name, Point3 otherwise) const {
    const Value& v = (*this)[name];
    if (v.is_undef()) return otherwise;
    if (v.is_number()) {
      const double x = number(name, otherwise.x);
      return {x, x, x};
    }
    if (v.is(Type::vector) && v.items().size() <= 3) {
      Point3 p = otherwise;
      bool valid = true;
      for (std::size_t i = 0; i < v.items().size(); ++i) {
        const Value& c = v.items()[i];
        valid = valid && c.is_number() && std::fabs(c.number()) <= limits::kMaxCoordinate;
        if (valid) p[static_cast<int>(i)] = c.number();
      }
      if (valid) return p;
    }
    wrong(name, "a number, or a vector of up to 3 finite numbers");
    return otherwise;
  }
  void wrong(std::string_view name, std::string_view expected) const {
    call_.run.error(
        codes::scad_shape, call_.statement.at,
        fmt::format("{}(): {} is {}; expected {}", call_.statement.name, name,
                    (*this)[name].is(Type::vector) ? "a vector" : to_string((*this)[name]).substr(0, 60),
                    expected));
  }

 private:
  ModuleCall& call_;
  std::vector<std::string_view> names_;
  std::vector<Value> values_;
};

Shape children_of(ModuleCall& call) {
  Shapes shapes;
  call.run.run_children(*call.statement.children, call.context, shapes);
  return united(call.run, std::move(shapes), call.statement.at);
}

void give(ModuleCall& call, Shape shape) {
  if (shape.kind != Shape::Kind::nothing) call.out.push_back(std::move(shape));
}

void refuse(ModuleCall& call, std::string message, std::string hint) {
  call.run.error(codes::scad_refused, call.statement.at, std::move(message)).hint = std::move(hint);
}

// ------------------------------------------------------------------------------------ groups, children

void group(ModuleCall& call) { call.run.run_children(*call.statement.children, call.context, call.out); }

void children(ModuleCall& call) {
  const Activation* a = call.context.activation;
  if (a == nullptr) {
    call.run.warn(codes::scad_call, call.statement.at, "children() outside of a module");
    return;
  }
  if (call.values.empty()) {
    call.run.run_children_of(*a, nullptr, call.statement.at, call.out);
    return;
  }
  const std::size_t count = a->children->statements.size();
  std::vector<std::size_t> which;
  const auto add = [&](const Value& v) {
    if (v.is_number() && v.number() >= 0.0 && v.number() < static_cast<double>(count))
      which.push_back(static_cast<std::size_t>(v.number()));
    else
      call.run.warn(codes::scad_call, call.statement.at,
                    fmt::format("there is no child {}: there are {}", to_string(v).substr(0, 60), count));
  };
  const Value& v = call.values[0];
  if (v.is(Type::vector)) {
    for (const Value& i : v.items()) add(i);
  } else if (v.is(Type::range)) {
    const double n = std::min(v.range().count(), static_cast<double>(call.run.limits().max_range));
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) add(v.range().at(i));
  } else {
    add(v);
  }
  call.run.run_children_of(*a, &which, call.statement.at, call.out);
}

/// The former children(): one child, by default the first.
void child(ModuleCall& call) {
  call.run.warn(codes::scad_call, call.statement.at, "deprecated: the child() module; use children()");
  if (call.values.empty()) call.values.emplace_back(0.0);
  children(call);
}

/// One shape for each child that makes any, in order.
Shapes separate_children(ModuleCall& call) {
  return call.run.run_separately(*call.statement.children, call.context);
}

void unite_children(ModuleCall& call) { give(call, children_of(call)); }

void difference(ModuleCall& call) {
  Shapes all = separate_children(call);
  if (all.empty()) return;
  Shape rest = std::move(all[0]);
  for (std::size_t i = 1; i < all.size(); ++i)
    rest = combined(call.run, rest, all[i], Operation::subtract, call.statement.at);
  give(call, std::move(rest));
}

void intersection(ModuleCall& call) {
  Shapes all = separate_children(call);
  intersect_passes(call.run, call.statement.at, all, call.out);
}

// ------------------------------------------------------------------------------------------ transforms

void transform(ModuleCall& call, const Matrix& matrix) {
  give(call, transformed(call.run, children_of(call), matrix, call.statement.at));
}

void translate(ModuleCall& call) {
  const Arguments a(call, {"v"});
  const Point3 v = a["v"].is_number() ? Point3{} : a.vector("v", {});
  if (a["v"].is_number()) a.wrong("v", "a vector of up to 3 finite numbers");
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i) m[i][3] = v[static_cast<int>(i)];
  transform(call, m);
}

void scale(ModuleCall& call) {
  const Arguments a(call, {"v"});
  const Point3 v = a.vector("v", {1, 1, 1});
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i) m[i][i] = v[static_cast<int>(i)];
  if (v.x == 0.0 || v.y == 0.0 || v.z == 0.0) {
    a.wrong("v", "factors other than 0");
    return;
  }
  transform(call, m);
}

/// Turns about the axis of number `axis`.
Matrix turn(int axis, double angle) {
  const double s = sin_degrees(angle), c = cos_degrees(angle);
  const auto i = static_cast<std::size_t>((axis + 1) % 3), j = static_cast<std::size_t>((axis + 2) % 3);
  Matrix m = identity();
  m[i][i] = c;
  m[i][j] = -s;
  m[j][i] = s;
  m[j][j] = c;
  return m;
}

void rotate(ModuleCall& call) {
  const Arguments a(call, {"a", "v"});
  if (a.given("v") && a["a"].is_number()) {
    const Point3 axis = a.vector("v", {0, 0, 1});
    const double size = length(axis);
    if (axis.x == 0.0 && axis.y == 0.0 && size > 0.0) {
      transform(call, turn(2, axis.z < 0.0 ? -a.number("a", 0) : a.number("a", 0)));
      return;
    }
    if (size > 0.0) {
      const double s = sin_degrees(a.number("a", 0)), c = cos_degrees(a.number("a", 0));
      const Point3 u = (1.0 / size) * axis;
      Matrix m = identity();
      const double cross_part[3][3] = {{0, -u.z, u.y}, {u.z, 0, -u.x}, {-u.y, u.x, 0}};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          m[i][j] = (i == j ? c : 0.0) + s * cross_part[i][j] +
                    (1.0 - c) * u[static_cast<int>(i)] * u[static_cast<int>(j)];
      transform(call, m);
      return;
    }
  }
  if (a["a"].is_number()) {
    transform(call, turn(2, a.number("a", 0)));
    return;
  }
  const Point3 angles = a.vector("a", {});
  transform(call, product(turn(2, angles.z), product(turn(1, angles.y), turn(0, angles.x))));
}

void mirror(ModuleCall& call) {
  const Arguments a(call, {"v"});
  const Point3 v = a["v"].is_number() ? Point3{} : a.vector("v", {1, 0, 0});
  const double size = length(v);
  Matrix m = identity();
  if (size > 0.0)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        m[i][j] -= 2.0 * v[static_cast<int>(i)] * v[static_cast<int>(j)] / (size * size);
  transform(call, m);
}

void multiply_matrix(ModuleCall& call) {
  const Arguments a(call, {"m"});
  Matrix m = identity();
  const Value& given = a["m"];
  bool valid = given.is(Type::vector) && given.items().size() >= 3;
  for (std::size_t i = 0; valid && i < 3; ++i) {
    const Value& row = given.items()[i];
    valid = row.is(Type::vector) && row.items().size() >= 3;
    for (std::size_t j = 0; valid && j < std::min<std::size_t>(row.items().size(), 4); ++j) {
      valid = row.items()[j].is_number();
      if (valid) m[i][j] = row.items()[j].number();
    }
  }
  if (valid)
    transform(call, m);
  else
    a.wrong("m", "a matrix of 3 or 4 rows of 4 numbers");
}

// ------------------------------------------------------------------------------------------------ areas

/// The number of edges of a circle; 0: it is a true circle.
int edges_of(ModuleCall& call) {
  constexpr double kMaxEdges = 10'000;
  const double fn = call.run.special_number("$fn");
  return fn >= 1.0 ? static_cast<int>(std::min(std::max(fn, 3.0), kMaxEdges)) : 0;
}

/// A circle around the origin: of as many edges as $fn says, else of arcs.
Region circle_region(ModuleCall& call, double radius) {
  if (radius <= 0.0) return {};
  const int edges = edges_of(call);
  Outline loop;
  if (edges == 0) {
    loop = as_outline(Circle{{0, 0}, mm(radius)});
  } else {
    loop.start = {radius, 0};
    for (int i = 1; i < edges; ++i) {
      const double angle = 360.0 * i / edges;
      loop.segments.push_back({{radius * cos_degrees(angle), radius * sin_degrees(angle)}, {}, {}});
    }
    loop.segments.push_back({loop.start, {}, {}});
  }
  return {{std::move(loop)}};
}

/// A radius from r or d.
double radius_of(const Arguments& a, double otherwise, std::string_view r = "r", std::string_view d = "d") {
  return a.given(d) ? 0.5 * a.number(d, 2.0 * otherwise) : a.number(r, otherwise);
}

bool not_positive(ModuleCall& call, double x, std::string_view what) {
  if (x > 0.0) return false;
  call.run.error(
      codes::scad_shape, call.statement.at,
      fmt::format("{}(): {} is {}; expected more than 0", call.statement.name, what, to_string(x)));
  return true;
}

void circle(ModuleCall& call) {
  const Arguments a(call, {"r", "d"});
  const double r = radius_of(a, 1.0);
  if (!not_positive(call, r, "the radius")) give(call, area_shape(circle_region(call, r)));
}

Region rectangle(Point2 low, Point2 high) {
  Outline loop{low, {}, {}};
  for (const Point2 p : {Point2{high.x, low.y}, high, Point2{low.x, high.y}, low})
    loop.segments.push_back({p, {}, {}});
  return {{std::move(loop)}};
}

void square(ModuleCall& call) {
  const Arguments a(call, {"size", "center"});
  const Point3 size = a.vector("size", {1, 1, 1});
  if (not_positive(call, size.x, "the width") || not_positive(call, size.y, "the height")) return;
  const Point2 low = a["center"].is_true() ? Point2{-0.5 * size.x, -0.5 * size.y} : Point2{};
  give(call, area_shape(rectangle(low, low + Point2{size.x, size.y})));
}

void polygon(ModuleCall& call) {
  const Arguments a(call, {"points", "paths", "convexity"});
  std::vector<Point2> points;
  bool valid = a["points"].is(Type::vector);
  if (valid)
    for (const Value& p : a["points"].items()) {
      valid = valid && p.is(Type::vector) && p.items().size() >= 2 && p.items()[0].is_number() &&
              p.items()[1].is_number() && std::fabs(p.items()[0].number()) <= limits::kMaxCoordinate &&
              std::fabs(p.items()[1].number()) <= limits::kMaxCoordinate;
      if (valid) points.push_back({p.items()[0].number(), p.items()[1].number()});
    }
  if (!valid) {
    a.wrong("points", "a vector of points of 2 finite numbers");
    return;
  }
  std::vector<std::vector<Point2>> paths;
  const auto add_path = [&](const Value& path) {
    paths.emplace_back();
    for (const Value& i : path.items()) {
      if (i.is_number() && i.number() >= 0.0 && i.number() < static_cast<double>(points.size()))
        paths.back().push_back(points[static_cast<std::size_t>(i.number())]);
      else
        valid = false;
    }
  };
  if (!a.given("paths")) {
    paths.push_back(points);
  } else if (a["paths"].is(Type::vector) && !a["paths"].items().empty() &&
             a["paths"].items()[0].is(Type::vector)) {
    for (const Value& path : a["paths"].items())
      if (path.is(Type::vector)) add_path(path);
  } else if (a["paths"].is(Type::vector)) {
    add_path(a["paths"]);
  }
  if (valid)
    give(call, polygons(call.run, paths, call.statement.at));
  else
    a.wrong("paths", "vectors of indices of points");
}

void offset_module(ModuleCall& call) {
  const Arguments a(call, {"r", "delta", "chamfer"});
  Shape s = children_of(call);
  if (s.kind == Shape::Kind::nothing) return;
  if (s.kind != Shape::Kind::area) {
    refuse(call, "offset() of a solid", "offset the area before linear_extrude()");
    return;
  }
  const bool is_round = !a.given("delta");
  const double by = is_round ? a.number("r", 1.0) : a.number("delta", 1.0);
  if (by == 0.0) {
    give(call, std::move(s));
    return;
  }
  JoinOptions joins;
  if (!is_round) {
    joins.join = Join::mitre;
    joins.mitre_limit = a["chamfer"].is_true() ? 1.0 : 1e3;
  }
  if (!is_round && a["chamfer"].is_true())
    call.run.warn(codes::scad_shape, call.statement.at,
                  "offset(): chamfered corners are cut at the distance of the offset");
  auto result =
      offset(s.region, mm(by), joins, region_options(call.run, call.statement.at), call.run.diagnostics());
  if (!result) throw Stop{};
  give(call, area_shape(std::move(result->region)));
}

// ----------------------------------------------------------------------------------------------- solids

void cube(ModuleCall& call) {
  const Arguments a(call, {"size", "center"});
  const Point3 size = a.vector("size", {1, 1, 1});
  if (not_positive(call, size.x, "the size in X") || not_positive(call, size.y, "the size in Y") ||
      not_positive(call, size.z, "the size in Z"))
    return;
  const Point3 low = a["center"].is_true() ? -0.5 * size : Point3{};
  give(call, extruded(rectangle(low.xy(), (low + size).xy()), low.z, low.z + size.z));
}

void cylinder(ModuleCall& call) {
  const Arguments a(call, {"h", "r1", "r2", "center", "r", "d", "d1", "d2"});
  const double h = a.number("h", 1.0);
  const double both = a.given("r") || a.given("d") ? radius_of(a, 1.0) : 1.0;
  const double r1 = radius_of(a, both, "r1", "d1"), r2 = radius_of(a, both, "r2", "d2");
  if (not_positive(call, h, "the height") || not_positive(call, std::max(r1, r2), "the radius")) return;
  if (r1 != r2) {
    refuse(call, "cylinder() with two radii is a cone, whose sides are not vertical",
           "the material or an outline has vertical sides; cut a cone with a V-shaped tool");
    return;
  }
  const double low = a["center"].is_true() ? -0.5 * h : 0.0;
  give(call, extruded(circle_region(call, r1), low, low + h));
}

void linear_extrude(ModuleCall& call) {
  const Arguments a(call, {"height", "center", "convexity", "twist", "slices", "scale"});
  Shape s = children_of(call);
  const double h = a.number("height", 100.0);
  if (a.number("twist", 0.0) != 0.0 || !(a["scale"].is_undef() || equal(a["scale"], Value(1.0)))) {
    refuse(call, "linear_extrude() with twist or scale has sides that are not vertical",
           "leave out twist and scale");
    return;
  }
  if (s.kind == Shape::Kind::nothing || not_positive(call, h, "the height")) return;
  if (s.kind != Shape::Kind::area) {
    refuse(call, "linear_extrude() of a solid", "its children must be areas: square(), circle(), polygon()");
    return;
  }
  const double low = a["center"].is_true() ? -0.5 * h : 0.0;
  give(call, extruded(std::move(s.region), low, low + h));
}

void projection(ModuleCall& call) {
  const Arguments a(call, {"cut", "convexity"});
  Shape s = children_of(call);
  if (s.kind != Shape::Kind::solid) return;
  Shapes areas;
  for (Slab& slab : s.slabs)
    if (!a["cut"].is_true() || (slab.low <= 0.0 && slab.high > 0.0))
      areas.push_back(area_shape(std::move(slab.region)));
  give(call, united(call.run, std::move(areas), call.statement.at));
}

/// Solids and files that Kerf has no form for. Their children do not run.
void refused(ModuleCall& call) {
  const std::string& name = call.statement.name;
  if (name == "import" || name == "surface")
    refuse(call, fmt::format("{}() is not supported", name),
           "--stock takes meshes as the material; kerf cut and kerf outline read drawings");
  else if (name == "text")
    refuse(call, "text() is not supported here", "commands cut and draw text with the fonts of Kerf");
  else
    refuse(call, fmt::format("{}() has no form as material or outline", name),
           "possible are areas, and solids with vertical sides: cube(), cylinder(), linear_extrude()");
}

}  // namespace

const std::vector<BuiltinModule>& builtin_modules() {
  static const std::vector<BuiltinModule> all{
      {"children", children},
      {"child", child},
      {"group", group},
      {"render", group},
      {"color", group},
      {"union", unite_children},
      {"difference", difference},
      {"intersection", intersection},
      {"translate", translate},
      {"rotate", rotate},
      {"scale", scale},
      {"mirror", mirror},
      {"multmatrix", multiply_matrix},
      {"circle", circle},
      {"square", square},
      {"polygon", polygon},
      {"offset", offset_module},
      {"cube", cube},
      {"cylinder", cylinder},
      {"linear_extrude", linear_extrude},
      {"projection", projection},
      {"sphere", refused},
      {"polyhedron", refused},
      {"rotate_extrude", refused},
      {"hull", refused},
      {"minkowski", refused},
      {"resize", refused},
      {"text", refused},
      {"import", refused},
      {"surface", refused},
  };
  return all;
}

}  // namespace kerf::scad

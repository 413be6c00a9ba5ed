// The modules of OpenSCAD: groups, children, transforms; and the table of all.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/module_call.h"

#include "kerf/base/limits.h"

namespace kerf::scad {
namespace {

// ------------------------------------------------------------------------------------ groups, children

void group(ModuleCall& call) { call.run.run_block(*call.statement.children, call.context, call.out); }

void children(ModuleCall& call) {
  const Activation* a = call.context.activation;
  if (a == nullptr) {
    call.run.warn(codes::scad_call, call.statement.at, "children() outside of a module");
    return;
  }
  if (call.statement.arguments.empty()) {
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
  static const std::vector<std::size_t> kFirst{0};
  call.run.warn(codes::scad_call, call.statement.at, "deprecated: the child() module; use children()");
  if (call.statement.arguments.empty() && call.context.activation != nullptr)
    call.run.run_children_of(*call.context.activation, &kFirst, call.statement.at, call.out);
  else
    children(call);
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
  const Arguments a(call);
  const Point3 v = a.vector("v", {}, {2, 3, false});
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i) m[i][3] = v[static_cast<int>(i)];
  transform(call, m);
}

void scale(ModuleCall& call) {
  const Arguments a(call);
  const Point3 v = a.vector("v", {1, 1, 1}, {2, 3});
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
  const Arguments a(call);
  if (a.given("v") && a["a"].is_number()) {
    const Point3 axis = a.vector("v", {0, 0, 1}, {2, 3, false});
    const double size = length(axis);
    if (size == 0.0) {
      transform(call, identity());
      return;
    }
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
  const Arguments a(call);
  Point3 v = a.vector("v", {1, 0, 0}, {2, 3, false});
  if (length(v) == 0.0) v = {1, 0, 0};  // as OpenSCAD
  const double size = length(v);
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      m[i][j] -= 2.0 * v[static_cast<int>(i)] * v[static_cast<int>(j)] / (size * size);
  transform(call, m);
}

/// Scales to a size; 0 keeps that of an axis, or scales it as the axis of the largest new size if `auto`
/// says.
void resize(ModuleCall& call) {
  const Arguments a(call);
  Shape shape = children_of(call);
  const Point3 wanted = a.vector("newsize", {}, {1, 3, false});
  const Box3 box = bounds_of(shape);
  if (shape.kind == Shape::Kind::nothing || shape.is_empty()) return;
  const bool is_area = shape.kind == Shape::Kind::area;
  const Point3 size = box.high - box.low;
  int largest = 0;
  for (int i = 1; i < (is_area ? 2 : 3); ++i)
    if (wanted[i] > wanted[largest]) largest = i;
  const auto factor = [&](int i) { return size[i] > 0.0 && wanted[i] > 0.0 ? wanted[i] / size[i] : 1.0; };
  const Value& automatic = a["auto"];
  Matrix m = identity();
  for (int i = 0; i < (is_area ? 2 : 3); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto is_yes = [](const Value& v) { return v.is(Type::boolean) && v.truth(); };
    const bool follows = automatic.is(Type::vector)
                             ? k < automatic.items().size() && is_yes(automatic.items()[k])
                             : is_yes(automatic);
    m[k][k] = wanted[i] > 0.0 || !follows ? factor(i) : factor(largest);
  }
  give(call, transformed(call.run, std::move(shape), m, call.statement.at));
}

/// Values that a matrix does not have are those of the identity; the last one of four rows divides all.
void multiply_matrix(ModuleCall& call) {
  const Arguments a(call);
  Matrix m = identity();
  const Value& given = a["m"];
  double divisor = 1.0;
  bool valid = given.is(Type::vector);
  for (std::size_t i = 0; valid && i < std::min<std::size_t>(given.items().size(), 4); ++i) {
    const Value& row = given.items()[i];
    valid = row.is(Type::vector);
    for (std::size_t j = 0; valid && j < std::min<std::size_t>(row.items().size(), 4); ++j) {
      valid = row.items()[j].is_number() && std::fabs(row.items()[j].number()) <= limits::kMaxCoordinate;
      if (valid && i < 3) m[i][j] = row.items()[j].number();
      if (valid && i == 3 && j == 3) divisor = row.items()[j].number();
    }
  }
  if (!valid || divisor == 0.0) {
    a.wrong("m", "a matrix of up to 4 rows of 4 numbers");
    m = identity();
    divisor = 1.0;
  }
  for (auto& row : m)
    for (double& x : row) x /= divisor;
  transform(call, m);
}

/// Solids and files that Kerf has no form for. Their children do not run.
void refused(ModuleCall& call) {
  const std::string& name = call.statement.name;
  refuse(call, fmt::format("{}() is not supported", name),
         "--stock takes meshes as the material; reliefs are cut by kerf cut");
}

}  // namespace

const std::vector<BuiltinModule>& builtin_modules() {
  using enum ModuleArguments;
  static const std::vector<BuiltinModule> table{
      {"children", children, {"index"}, {}, first},
      {"child", child, {"index"}, {}, first},
      {"group", group, {}, {}, none},
      {"render", group, {"convexity"}},
      {"color", group, {"c", "alpha"}},
      {"union", unite_children, {}, {}, none},
      {"difference", difference, {}, {}, none},
      {"intersection", intersection, {}, {}, none},
      {"translate", translate, {"v"}},
      {"rotate", rotate, {"a", "v"}},
      {"scale", scale, {"v"}},
      {"mirror", mirror, {"v"}},
      {"multmatrix", multiply_matrix, {"m"}},
      {"circle", circle, {"r"}, {"d"}},
      {"square", square, {"size", "center"}},
      {"polygon", polygon, {"points", "paths", "convexity"}},
      {"offset", offset_module, {"r"}, {"delta", "chamfer"}},
      {"cube", cube, {"size", "center"}},
      {"cylinder", cylinder, {"h", "r1", "r2", "center"}, {"r", "d", "d1", "d2"}},
      {"linear_extrude",
       linear_extrude,
       {"file", "layer", "height", "origin", "scale", "center", "twist", "slices"},
       {"convexity"}},
      {"projection", projection, {"cut"}, {"convexity"}},
      {"sphere", sphere, {"r"}, {"d"}},
      {"polyhedron", polyhedron, {"points", "faces", "convexity"}, {"triangles"}},
      {"rotate_extrude", rotate_extrude, {"file", "layer", "origin", "scale"}, {"convexity", "angle"}},
      {"hull", hull_module},
      {"minkowski", minkowski_module, {"convexity"}},
      {"resize", resize, {"newsize", "auto"}, {"convexity"}},
      {"text",
       text_module,
       {"text", "size", "font"},
       {"halign", "valign", "spacing", "direction", "language", "script"}},
      {"import",
       import_module,
       {"file", "layer", "convexity", "origin", "scale"},
       {"dpi", "id", "center", "width", "height", "filename", "layername"}},
      {"surface", refused, {"file", "center", "convexity"}, {"invert"}},
  };
  return table;
}

}  // namespace kerf::scad

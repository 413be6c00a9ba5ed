// The modules of OpenSCAD: groups, children, transforms; and the table of all.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/module_call.h"

namespace kerf::scad {
namespace {

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

/// Scales to a size; 0 keeps that of an axis, or scales it as the axis of the largest new size if `auto`
/// says.
void resize(ModuleCall& call) {
  const Arguments a(call, {"newsize", "auto", "convexity"});
  Shape shape = children_of(call);
  const Point3 wanted = a.vector("newsize", {});
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
    const bool follows = automatic.is(Type::vector)
                             ? k < automatic.items().size() && automatic.items()[k].is_true()
                             : automatic.is_true();
    m[k][k] = wanted[i] > 0.0 || !follows ? factor(i) : factor(largest);
  }
  give(call, transformed(call.run, std::move(shape), m, call.statement.at));
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

/// Solids and files that Kerf has no form for. Their children do not run.
void refused(ModuleCall& call) {
  const std::string& name = call.statement.name;
  refuse(call, fmt::format("{}() is not supported", name),
         "--stock takes meshes as the material; reliefs are cut by kerf cut");
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
      {"sphere", sphere},
      {"polyhedron", polyhedron},
      {"rotate_extrude", rotate_extrude},
      {"hull", hull_module},
      {"minkowski", minkowski_module},
      {"resize", resize},
      {"text", text_module},
      {"import", import_module},
      {"surface", refused},
  };
  return all;
}

}  // namespace kerf::scad

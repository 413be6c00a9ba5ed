// The arguments of the modules of OpenSCAD, and what the modules have in common.
#include "front/scad/run/module_call.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"

#include "kerf/base/limits.h"

namespace kerf::scad {

Arguments::Arguments(ModuleCall& call) : call_(call) {
  const BuiltinModule& m = call.module;
  const auto has = [](const std::vector<std::string_view>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::size_t position = 0;
  for (const Argument& a : call.statement.arguments)
    if (a.name.empty() ? position++ >= m.positional.size()
                       : !a.special && !has(m.positional, a.name) && !has(m.named, a.name))
      call.run.warn(codes::scad_call, a.at,
                    a.name.empty()
                        ? fmt::format("{}() takes {} argument{} without a name at most; this one is not used",
                                      m.name, m.positional.size(), m.positional.size() == 1 ? "" : "s")
                        : fmt::format("{}() has no such parameter; this argument is not used", m.name));
}

const Value& Arguments::operator[](std::string_view name) const {
  const BuiltinModule& m = call_.module;
  const auto positional = std::find(m.positional.begin(), m.positional.end(), name);
  if (positional != m.positional.end())
    return call_.values[static_cast<std::size_t>(positional - m.positional.begin())];
  const auto named = std::find(m.named.begin(), m.named.end(), name);
  return call_.values[m.positional.size() + static_cast<std::size_t>(named - m.named.begin())];
}

bool Arguments::flag(std::string_view name) const {
  const Value& v = (*this)[name];
  return v.is(Type::boolean) && v.truth();
}

double Arguments::number(std::string_view name, double otherwise) const {
  const Value& v = (*this)[name];
  if (v.is_undef()) return otherwise;
  if (v.is_number() && std::isfinite(v.number()) && std::fabs(v.number()) <= limits::kMaxCoordinate)
    return v.number();
  wrong(name, "a finite number");
  return otherwise;
}

Point3 Arguments::vector(std::string_view name, Point3 otherwise, const VectorForm& form) const {
  const Value& v = (*this)[name];
  if (v.is_undef()) return otherwise;
  if (v.is_number() && form.number) {
    const double x = number(name, otherwise.x);
    return {x, x, x};
  }
  if (v.is(Type::vector) && v.items().size() >= form.least && v.items().size() <= form.max) {
    Point3 p = otherwise;
    bool valid = true;
    for (std::size_t i = 0; i < v.items().size(); ++i) {
      const Value& c = v.items()[i];
      valid = valid && c.is_number() && std::fabs(c.number()) <= limits::kMaxCoordinate;
      if (valid) p[static_cast<int>(i)] = c.number();
    }
    if (valid) return p;
  }
  const std::string count =
      form.least == form.max ? std::to_string(form.max) : fmt::format("{} to {}", form.least, form.max);
  wrong(name, fmt::format("{}a vector of {} finite numbers", form.number ? "a number, or " : "", count));
  return otherwise;
}

std::string Arguments::text(std::string_view name) const {
  const Value& v = (*this)[name];
  if (v.is_undef()) return {};
  if (v.is(Type::string)) return v.text();
  wrong(name, "a string");
  return {};
}

void Arguments::wrong(std::string_view name, std::string_view expected) const {
  call_.run.error(
      codes::scad_shape, call_.statement.at,
      fmt::format("{}(): {} is {}; expected {}", call_.statement.name, name,
                  (*this)[name].is(Type::vector) ? "a vector" : to_string((*this)[name]).substr(0, 60),
                  expected));
}

Shape children_of(ModuleCall& call) {
  Shapes shapes;
  call.run.run_block(*call.statement.children, call.context, shapes);
  return united(call.run, std::move(shapes), call.statement.at);
}

void give(ModuleCall& call, Shape shape) {
  if (shape.kind != Shape::Kind::nothing) call.out.push_back(std::move(shape));
}

void refuse(ModuleCall& call, std::string message, std::string hint) {
  call.run.error(codes::scad_refused, call.statement.at, std::move(message)).hint = std::move(hint);
}

Shapes separate_children(ModuleCall& call) {
  return call.run.run_separately(*call.statement.children, call.context);
}

double radius_of(const Arguments& a, double otherwise, std::string_view r, std::string_view d) {
  return a.given(d) ? 0.5 * a.number(d, 2.0 * otherwise) : a.number(r, otherwise);
}

bool not_positive(ModuleCall& call, double x, std::string_view what) {
  if (x > 0.0) return false;
  call.run.error(
      codes::scad_shape, call.statement.at,
      fmt::format("{}(): {} is {}; expected more than 0", call.statement.name, what, to_string(x)));
  return true;
}

int edges_of(ModuleCall& call) {
  constexpr double kMaxEdges = 10'000;
  const double fn = call.run.special_number("$fn");
  return fn > 0.0 ? static_cast<int>(std::min(std::max(fn, 3.0), kMaxEdges)) : 0;
}

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
      loop.segments.push_back({{radius * cos_degrees(angle), radius * sin_degrees(angle)}, {}});
    }
    loop.segments.push_back({loop.start, {}});
  }
  return {{std::move(loop)}};
}

Region rectangle(Point2 low, Point2 high) {
  Outline loop{low, {}};
  for (const Point2 p : {Point2{high.x, low.y}, high, Point2{low.x, high.y}, low})
    loop.segments.push_back({p, {}});
  return {{std::move(loop)}};
}

}  // namespace kerf::scad

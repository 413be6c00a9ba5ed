// The arguments of the modules of OpenSCAD, and what the modules have in common.
#include "front/scad/run/module_call.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"

#include "kerf/base/limits.h"

namespace kerf::scad {

Arguments::Arguments(ModuleCall& call, std::vector<std::string_view> names)
    : call_(call), values_(names.size()) {
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

const Value& Arguments::operator[](std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return values_[static_cast<std::size_t>(found - names_.begin())];
}

double Arguments::number(std::string_view name, double otherwise) const {
  const Value& v = (*this)[name];
  if (v.is_undef()) return otherwise;
  if (v.is_number() && std::isfinite(v.number()) && std::fabs(v.number()) <= limits::kMaxCoordinate)
    return v.number();
  wrong(name, "a finite number");
  return otherwise;
}

Point3 Arguments::vector(std::string_view name, Point3 otherwise) const {
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
  call.run.run_children(*call.statement.children, call.context, shapes);
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
  return fn >= 1.0 ? static_cast<int>(std::min(std::max(fn, 3.0), kMaxEdges)) : 0;
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

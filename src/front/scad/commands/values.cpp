// Values of a program as values of the machine's commands, and back.
#include "front/scad/commands/values.h"

#include <cmath>

namespace kerf::scad {
namespace {

/// The value of bezier_surface().
class SurfaceObject final : public Object {
 public:
  explicit SurfaceObject(std::shared_ptr<const design::Surface> s) : surface(std::move(s)) {}
  std::string text() const override { return "bezier_surface()"; }
  const std::shared_ptr<const design::Surface> surface;
};

/// A function literal of x and y.
class FunctionSurface final : public design::Surface {
 public:
  FunctionSurface(const Value& function, CallSite& site) : function_(function), site_(site) {}
  double height(Point2 at) const override {
    const Value z = site_.call(function_, {at.x, at.y});
    return z.is_number() ? z.number() : std::nan("");
  }

 private:
  const Value function_;
  CallSite& site_;
};

design::Value object_value(const Value& value) {
  if (const auto* made = dynamic_cast<const SurfaceObject*>(value.block())) return made->surface;
  return design::Other{to_string(value)};
}

design::Value list_value(const Value& value, CallSite& site) {
  design::Value::List list;
  list.reserve(value.items().size());
  for (const Value& item : value.items()) list.push_back(to_design(item, site));
  return list;
}

Value point_value(Point2 p) { return Value::vector({p.x, p.y}); }

/// Closed unless the last point is another than the first.
Value outline_value(const Outline& outline) {
  std::vector<Value> rows{point_value(outline.start)};
  for (const Segment& s : outline.segments)
    rows.push_back(s.via ? Value::vector({s.via->x, s.via->y, s.to.x, s.to.y}) : point_value(s.to));
  return Value::vector(std::move(rows));
}

Value outlines_value(const design::Outlines& outlines) {
  if (outlines.single) return outline_value(outlines.list.front());
  std::vector<Value> values;
  for (const Outline& outline : outlines.list) values.push_back(outline_value(outline));
  return Value::vector(std::move(values));
}

}  // namespace

design::Value to_design(const Value& value, CallSite& site) {
  switch (value.type()) {
    case Type::undef: return {};
    case Type::boolean: return design::Value::truth(value.truth());
    case Type::number: return value.number();
    case Type::unset: return design::Value::unset();
    case Type::string: return value.text();
    case Type::vector: return list_value(value, site);
    case Type::function:
      return std::shared_ptr<const design::Surface>(std::make_shared<FunctionSurface>(value, site));
    case Type::object: return object_value(value);
    case Type::range: break;
  }
  return design::Other{to_string(value)};
}

Value from_design(const design::Value& value) {
  switch (value.type()) {
    case design::Type::truth: return Value::truth(value.truth());
    case design::Type::number: return value.number();
    case design::Type::text: return Value::string(value.text());
    case design::Type::list: {
      std::vector<Value> items;
      for (const design::Value& item : value.list()) items.push_back(from_design(item));
      return Value::vector(std::move(items));
    }
    case design::Type::outlines: return outlines_value(value.outlines());
    case design::Type::surface: return Value::of(Type::object, new SurfaceObject(value.surface()));
    default: return {};
  }
}

}  // namespace kerf::scad

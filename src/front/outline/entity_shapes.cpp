// Shapes of DXF entities as lines and arcs: circles that blocks stretch become ellipses, ellipses and splines
// become pairs of arcs.
#include "front/outline/entity_shapes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/outline.h"

namespace kerf::outline_front {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRound = 1e-9;  // relative difference of two axes of a circle

double size_of(dxf::Point p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }
dxf::Point scaled(double k, dxf::Point p) { return {k * p.x, k * p.y, k * p.z}; }
dxf::Point sum(dxf::Point a, dxf::Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Point2 end_of(const Outline& outline) { return outline.point(outline.segments.size()); }

/// Two directions of equal length at right angles, seen from above.
bool are_round(Point2 u, Point2 v) {
  const double a = length(u), b = length(v);
  return std::abs(a - b) <= kRound * std::max(a, b) && std::abs(dot(u, v)) <= kRound * a * b;
}

/// From `start` to `end`, counter-clockwise, in the unit of `full`, a full turn. Angles that are equal, or
/// equal but for rounding, are a full turn.
double sweep_of(double start, double end, double full) {
  constexpr double kRounding = 1e-8;
  const double way = end - start;
  if (std::abs(way) > 0.5 * full && std::abs(std::remainder(way, full)) <= kRounding * full) return 1.0;
  const double turn = std::fmod(way, full) / full;
  return turn <= 0.0 ? turn + 1.0 : turn;
}

}  // namespace

Origin element_origin(const dxf::Drawing& drawing, std::uint32_t paint) {
  const dxf::Paint& element = drawing.paints[paint];
  return TextLocation{drawing.file, element.line, element.column};
}

std::string entity_name(const dxf::Drawing& drawing, const dxf::Entity& entity) {
  if (entity.paint != 0)
    return fmt::format("{} of line {}", drawing.paints[entity.paint].element, entity.position);
  const std::string_view type = dxf::type_name(drawing, entity);
  if (entity.handle != 0) return fmt::format("{} {}", type, dxf::handle_text(entity.handle));
  return fmt::format("{} of {} {}", type, drawing.binary ? "byte" : "line", entity.position);
}

std::optional<Circle> whole_circle(const Outline& outline, double weld) {
  constexpr std::size_t kMaxArcs = 16;
  if (!outline.closed() || outline.segments.size() > kMaxArcs) return std::nullopt;
  std::optional<ArcCircle> first;
  double sweep = 0.0;
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const auto circle = arc_circle(outline.point(i), outline.segments[i]);
    if (!circle) return std::nullopt;
    if (!first) first = circle;
    const bool same = distance(first->centre, circle->centre) <= weld &&
                      std::abs(first->radius - circle->radius) <= weld && first->turn == circle->turn;
    if (!same) return std::nullopt;
    sweep += circle->sweep.rad();
  }
  if (!first || std::abs(sweep - 2.0 * kPi) > 1e-6) return std::nullopt;
  return Circle{first->centre, mm(first->radius)};
}

Origin ShapeConverter::location(const dxf::Placed& placed, Point2 at) const {
  if (placed.entity.paint != 0) return element_origin(drawing_, placed.entity.paint);
  return dxf::origin_at(drawing_, placed.style.layer, placed.entity.handle, at.x, at.y);
}

std::string ShapeConverter::entity_name() const {
  return outline_front::entity_name(drawing_, placed_->entity);
}

bool ShapeConverter::refuse(Code code, const std::string& what, Point2 at) {
  diagnostics_.error(code, location(*placed_, at), fmt::format("{}: {}", entity_name(), what));
  return false;
}

dxf::Matrix ShapeConverter::object() const {
  return placed_->matrix * dxf::object_axes(drawing_.extrusions[placed_->entity.extrusion]);
}

void ShapeConverter::add_z(FlatShape& made, dxf::Point p) const {
  const double z = scale_ * p.z;
  const bool first = made.outline.segments.empty();
  made.low_z = first ? z : std::min(made.low_z, z);
  made.high_z = first ? z : std::max(made.high_z, z);
}

bool ShapeConverter::is_near(const Outline& outline) {
  const double farthest = options_.max_coordinate.mm();
  const auto near = [&](Point2 p) { return std::abs(p.x) <= farthest && std::abs(p.y) <= farthest; };
  bool all = near(outline.start);
  for (const Segment& s : outline.segments) all = all && near(s.to) && (!s.via || near(*s.via));
  return all ||
         refuse(codes::drawing_far, fmt::format("a coordinate is beyond {:g} mm", farthest), outline.start);
}

std::optional<FlatShape> ShapeConverter::make(const dxf::Placed& placed) {
  placed_ = &placed;
  auto made = std::visit([&](const auto& s) { return shape(s); }, placed.entity.shape);
  if (!made || !is_near(made->outline)) return std::nullopt;
  if (made->high_z - made->low_z > options_.join.mm()) made->tilted = true;
  return made;
}

std::vector<FlatShape> ShapeConverter::make_hatch(const dxf::Placed& placed, const dxf::Hatch& hatch) {
  placed_ = &placed;
  const dxf::Matrix matrix = object();
  std::vector<FlatShape> made;
  for (const dxf::Hatch::Loop& loop : hatch.loops) {
    std::vector<FlatShape> edges;
    for (const dxf::Hatch::Edge& edge : loop.edges) {
      dxf::Entity entity;  // in world coordinates: `matrix` has the extrusion direction of the hatch
      entity.handle = placed.entity.handle;
      entity.position = placed.entity.position;
      std::visit([&](const auto& shape) { entity.shape = shape; }, edge);
      if (auto shape = make({entity, matrix, placed.style, placed.inserts}))
        edges.push_back(std::move(*shape));
    }
    placed_ = &placed;
    if (auto shape = loop_of(edges)) made.push_back(std::move(*shape));
  }
  return made;
}

/// The edges of a hatch as one closed outline; those that are drawn backwards are reversed. Nothing if they
/// have no length.
std::optional<FlatShape> ShapeConverter::loop_of(const std::vector<FlatShape>& edges) const {
  const double weld = options_.tolerance.weld.mm();
  FlatShape loop;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Outline next = edges[i].outline;
    if (next.segments.empty()) continue;
    const bool is_first = loop.outline.segments.empty();
    if (is_first && i + 1 < edges.size()) {
      const Outline& after = edges[i + 1].outline;
      const Point2 a = after.start, b = end_of(after);
      const auto gap = [&](Point2 p) { return std::min(distance(p, a), distance(p, b)); };
      if (gap(next.start) < gap(end_of(next))) next = reversed(next);
    }
    if (is_first) {
      loop = edges[i];
      loop.outline = std::move(next);
      continue;
    }
    const Point2 at = end_of(loop.outline);
    if (distance(at, end_of(next)) < distance(at, next.start)) next = reversed(next);
    if (distance(at, next.start) > weld) loop.outline.segments.push_back({next.start, {}});
    loop.outline.segments.insert(loop.outline.segments.end(), next.segments.begin(), next.segments.end());
    loop.circle.reset();
    loop.tilted = loop.tilted || edges[i].tilted;
  }
  Outline& outline = loop.outline;
  if (outline.segments.empty()) return std::nullopt;
  if (distance(end_of(outline), outline.start) <= weld)
    outline.segments.back().to = outline.start;
  else
    outline = closed(outline);
  return loop;
}

FitOptions ShapeConverter::fit_options() const {
  const Point2 at = flat(placed_->matrix * dxf::Point{});
  return {entity_name(), location(*placed_, at)};
}

std::optional<FlatShape> ShapeConverter::fitted(const Spline& spline, FlatShape made) {
  const double farthest = options_.max_coordinate.mm();
  for (const Point2 p : spline.control)
    if (!(std::abs(p.x) <= farthest && std::abs(p.y) <= farthest)) {
      refuse(codes::drawing_far, fmt::format("a coordinate is beyond {:g} mm", farthest), p);
      return std::nullopt;
    }
  auto outline = fit_spline(spline, options_.within, fit_options(), diagnostics_);
  if (!outline) return std::nullopt;
  made.outline = std::move(*outline);
  return made;
}

// --------------------------------------------------------------------------------------------------- shapes

std::optional<FlatShape> ShapeConverter::shape(const dxf::Line& line) {
  FlatShape made;
  const dxf::Point from = placed_->matrix * line.from, to = placed_->matrix * line.to;
  made.outline.start = flat(from);
  add_z(made, from);
  made.outline.segments.push_back({flat(to), {}});
  add_z(made, to);
  return made;
}

std::optional<FlatShape> ShapeConverter::elliptic_arc(dxf::Point centre, dxf::Point u, dxf::Point v,
                                                      double start, double sweep) {
  FlatShape made;
  made.low_z = made.high_z = scale_ * centre.z;
  made.tilted = scale_ * std::hypot(u.z, v.z) > options_.join.mm();
  const Point2 c = flat(centre), a = flat(u), b = flat(v);
  const bool full = std::abs(sweep) >= 2.0 * kPi - 1e-9;
  if (!are_round(a, b))
    return fitted(ellipse_spline(c, a, b, radians(start), radians(full ? 2.0 * kPi : sweep)), made);
  if (full) {
    made.circle = Circle{c, mm(length(a))};
    made.outline = as_outline(*made.circle);
    return made;
  }
  const auto at = [&](double t) { return c + std::cos(t) * a + std::sin(t) * b; };
  made.outline.start = at(start);
  made.outline.segments.push_back({at(start + sweep), at(start + 0.5 * sweep)});
  return made;
}

std::optional<FlatShape> ShapeConverter::shape(const dxf::Circle& circle) {
  const dxf::Matrix matrix = object();
  return elliptic_arc(matrix * circle.centre, matrix.direction({circle.radius, 0.0, 0.0}),
                      matrix.direction({0.0, circle.radius, 0.0}), 0.0, 2.0 * kPi);
}

std::optional<FlatShape> ShapeConverter::shape(const dxf::Arc& arc) {
  const dxf::Matrix matrix = object();
  return elliptic_arc(
      matrix * arc.centre, matrix.direction({arc.radius, 0.0, 0.0}), matrix.direction({0.0, arc.radius, 0.0}),
      std::remainder(arc.start, 360.0) * kPi / 180.0, 2.0 * kPi * sweep_of(arc.start, arc.end, 360.0));
}

std::optional<FlatShape> ShapeConverter::shape(const dxf::Boxed<dxf::Ellipse>& ellipse) {
  const dxf::Ellipse& e = *ellipse;
  const dxf::Point& n = drawing_.extrusions[placed_->entity.extrusion];
  const double k = e.ratio / size_of(n);
  const dxf::Point minor = scaled(k, {n.y * e.major.z - n.z * e.major.y, n.z * e.major.x - n.x * e.major.z,
                                      n.x * e.major.y - n.y * e.major.x});
  const double sweep = 2.0 * kPi * sweep_of(e.start, e.end, 2.0 * kPi);
  return elliptic_arc(placed_->matrix * e.centre, placed_->matrix.direction(e.major),
                      placed_->matrix.direction(minor), std::remainder(e.start, 2.0 * kPi), sweep);
}

/// Appends the arc between two vertices; false with an error appended.
bool ShapeConverter::append_bulge(Outline& outline, const dxf::Matrix& matrix, const dxf::Vertex& from,
                                  const dxf::Vertex& to, FlatShape& made) {
  const double dx = to.at.x - from.at.x, dy = to.at.y - from.at.y, b = from.bulge;
  const dxf::Point mid = scaled(0.5, sum(from.at, to.at));
  const Point2 x = flat(matrix.direction({1.0, 0.0, 0.0})), y = flat(matrix.direction({0.0, 1.0, 0.0}));
  if (are_round(x, y)) {
    // The arc's midpoint: for a positive bulge to the right of the chord.
    const dxf::Point via{mid.x + 0.5 * b * dy, mid.y - 0.5 * b * dx, mid.z};
    outline.segments.push_back({flat(matrix * to.at), flat(matrix * via)});
    return true;
  }
  const double aside = (1.0 - b * b) / (4.0 * b);
  const dxf::Point centre{mid.x - aside * dy, mid.y + aside * dx, mid.z};
  const dxf::Point arm{from.at.x - centre.x, from.at.y - centre.y, 0.0};
  const double turn = b > 0.0 ? 1.0 : -1.0;
  const auto arc =
      elliptic_arc(matrix * centre, matrix.direction(arm),
                   matrix.direction({-turn * arm.y, turn * arm.x, 0.0}), 0.0, 4.0 * std::atan(std::abs(b)));
  if (!arc) return false;
  made.tilted = made.tilted || arc->tilted;
  const auto& segments = arc->outline.segments;
  outline.segments.insert(outline.segments.end(), segments.begin(), segments.end());
  outline.segments.back().to = flat(matrix * to.at);
  return true;
}

std::optional<FlatShape> ShapeConverter::shape(const dxf::Boxed<dxf::Polyline>& polyline) {
  const std::vector<dxf::Vertex>& v = polyline->vertices;
  if (v.empty()) return std::nullopt;
  const dxf::Matrix matrix = polyline->spatial ? placed_->matrix : object();
  FlatShape made;
  Outline outline;
  outline.start = flat(matrix * v.front().at);
  made.low_z = made.high_z = scale_ * (matrix * v.front().at).z;
  const std::size_t count = polyline->closed ? v.size() : v.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const dxf::Vertex &from = v[i], &to = v[(i + 1) % v.size()];
    const dxf::Point end = matrix * to.at;
    made.low_z = std::min(made.low_z, scale_ * end.z);
    made.high_z = std::max(made.high_z, scale_ * end.z);
    if (flat(end) == outline.point(outline.segments.size())) continue;  // no length
    if (from.bulge == 0.0 || polyline->spatial)
      outline.segments.push_back({flat(end), {}});
    else if (!append_bulge(outline, matrix, from, to, made))
      return std::nullopt;
  }
  made.outline = std::move(outline);
  made.circle = whole_circle(made.outline, options_.tolerance.weld.mm());
  return made;
}

std::optional<FlatShape> ShapeConverter::shape(const dxf::Boxed<dxf::Spline>& given) {
  const dxf::Spline& s = *given;
  FlatShape made;
  const auto world = [&](const std::vector<dxf::Point>& points) {
    std::vector<Point2> out;
    for (const dxf::Point& p : points) {
      const dxf::Point at = placed_->matrix * p;
      const bool first = out.empty();
      made.low_z = first ? scale_ * at.z : std::min(made.low_z, scale_ * at.z);
      made.high_z = first ? scale_ * at.z : std::max(made.high_z, scale_ * at.z);
      out.push_back(flat(at));
    }
    return out;
  };
  Spline spline;
  if (!s.control.empty()) {
    spline.degree = s.degree;
    spline.control = world(s.control);
    spline.knots = s.knots;
    spline.weights = s.weights;
    return fitted(spline, made);
  }
  SplineEnds ends;
  ends.closed = s.closed;
  if (s.start_tangent) ends.start = flat(placed_->matrix.direction(*s.start_tangent));
  if (s.end_tangent) ends.end = flat(placed_->matrix.direction(*s.end_tangent));
  const auto through = spline_through(world(s.fit), ends, fit_options(), diagnostics_);
  if (!through) return std::nullopt;
  return fitted(*through, made);
}

}  // namespace kerf::outline_front

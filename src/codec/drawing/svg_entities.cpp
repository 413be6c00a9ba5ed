// Writes shapes of SVG as polylines with bulges, circles and splines. Arcs of ellipses become rational
// splines of degree 2, which keep their form in every affine transform.
#if KERF_WITH_SVG
#include "codec/drawing/svg_entities.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kerf/drawing/drawing_files.h"

namespace kerf::svg {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRound = 1e-9;  // relative difference of axes that still are those of a circle
constexpr double kQuarter = 0.5 * kPi;

double length(Vec v) { return std::hypot(v.x, v.y); }
double cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }
bool same(Vec a, Vec b) { return a.x == b.x && a.y == b.y; }

}  // namespace

/// centre + cos(t) * u + sin(t) * v from `start` over `sweep`, radians.
struct EntityWriter::Arc {
  Vec centre, u, v;
  double start = 0.0, sweep = 0.0;
  Vec at(double t) const {
    return {centre.x + std::cos(t) * u.x + std::sin(t) * v.x,
            centre.y + std::cos(t) * u.y + std::sin(t) * v.y};
  }
  bool is_round() const {
    const double a = svg::length(u), b = svg::length(v);
    return std::abs(a - b) <= kRound * std::max(a, b) && std::abs(u.x * v.x + u.y * v.y) <= kRound * a * b;
  }
};

dxf::Point EntityWriter::at(Vec p) const {
  const Vec q = setting_.matrix * p;
  return {q.x, q.y, 0.0};
}

void EntityWriter::append(decltype(dxf::Entity::shape) shape, std::uint32_t chain) {
  dxf::Entity& entity = drawing_.entities.emplace_back();
  entity.layer = setting_.layer;
  entity.position = setting_.line;
  entity.hidden = setting_.is_hidden;
  entity.chain = chain;
  entity.paint = setting_.paint;
  entity.shape = std::move(shape);
}

void EntityWriter::start_at(Vec p) {
  start_ = at_ = p;
  line_ = {};
  has_curve_ = is_drawn_ = false;
  chain_ = ++chains_;
}

/// Adds a vertex at the end of a segment with this bulge.
void EntityWriter::add_vertex(Vec p, double bulge) {
  if (line_.vertices.empty()) line_.vertices.push_back({at(at_), 0.0});
  line_.vertices.back().bulge = bulge;
  line_.vertices.push_back({at(p), 0.0});
  at_ = p;
}

void EntityWriter::line_to(Vec p) {
  if (!same(p, at_)) add_vertex(p, 0.0);
}

/// Appends the lines and arcs since the last curve.
void EntityWriter::flush(bool is_closed) {
  dxf::Polyline line = std::exchange(line_, {});
  if (line.vertices.size() < 2) return;
  line.lightweight = true;
  line.closed = is_closed;
  if (is_closed && line.vertices.size() > 2 && line.vertices.front().at == line.vertices.back().at)
    line.vertices.pop_back();
  append(std::move(line), chain_);
}

void EntityWriter::finish(bool is_closed) {
  const bool is_dot = line_.vertices.empty() && !has_curve_ && is_drawn_;
  if (is_dot && setting_.has_dots) append(dxf::Dot{at(start_)}, 0);
  is_closed = is_closed || setting_.closes;
  if (is_closed) line_to(start_);
  flush(is_closed && !has_curve_);
  at_ = start_;
}

void EntityWriter::curve(std::vector<Vec> control, std::vector<double> weights) {
  const Vec first = control.front();
  if (std::all_of(control.begin(), control.end(), [&](Vec p) { return same(p, first); })) return;
  flush(false);
  has_curve_ = true;
  dxf::Spline spline;
  spline.degree = static_cast<int>(control.size()) - 1;
  for (const Vec p : control) spline.control.push_back(at(p));
  spline.knots.assign(control.size(), 0.0);
  spline.knots.resize(2 * control.size(), 1.0);
  spline.weights = std::move(weights);
  append(std::move(spline), chain_);
  at_ = control.back();
}

/// A circular arc in the drawing as a polyline with a bulge, else quarters as rational splines.
void EntityWriter::elliptic(const Arc& arc, bool is_closed) {
  Arc drawn = arc;
  drawn.u = setting_.matrix.direction(arc.u);
  drawn.v = setting_.matrix.direction(arc.v);
  const double turn = cross(drawn.u, drawn.v) < 0.0 ? -1.0 : 1.0;
  const Vec end = is_closed ? arc.at(arc.start) : arc.at(arc.start + arc.sweep);
  const double widest = drawn.is_round() ? kPi : kQuarter;  // of one piece
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep) / widest - kRound)));
  const double step = arc.sweep / pieces;
  for (int k = 0; k < pieces; ++k) {
    const double from = arc.start + k * step, halfway = from + 0.5 * step;
    const Vec to = k + 1 == pieces ? end : arc.at(from + step);
    if (drawn.is_round()) {
      add_vertex(to, turn * std::tan(0.25 * step));
      continue;
    }
    const double weight = std::cos(0.5 * step);
    const Vec on = arc.at(halfway);
    const Vec control{arc.centre.x + (on.x - arc.centre.x) / weight,
                      arc.centre.y + (on.y - arc.centre.y) / weight};
    curve({at_, control, to}, {1.0, weight, 1.0});
  }
}

/// SVG 2, appendix B.2.4: from the ends of an arc to its centre.
void EntityWriter::arc_to(Vec radii, double turn, bool is_large, bool is_sweep, Vec end) {
  if (same(end, at_)) return;
  if (radii.x == 0.0 || radii.y == 0.0) return line_to(end);
  const double angle = turn * kPi / 180.0, c = std::cos(angle), s = std::sin(angle);
  const Vec half{0.5 * (at_.x - end.x), 0.5 * (at_.y - end.y)};
  const Vec p{c * half.x + s * half.y, -s * half.x + c * half.y};
  const double excess = std::hypot(p.x / radii.x, p.y / radii.y);
  if (excess > 1.0) radii = {excess * radii.x, excess * radii.y};
  const Vec q{p.x / radii.x, p.y / radii.y};
  const double square = q.x * q.x + q.y * q.y;
  double factor = std::sqrt(std::max(0.0, 1.0 / square - 1.0));
  if (is_large == is_sweep) factor = -factor;
  const Vec unit{factor * q.y, -factor * q.x};  // the centre where the ellipse is a circle of radius 1
  Arc arc;
  arc.u = {radii.x * c, radii.x * s};
  arc.v = {-radii.y * s, radii.y * c};
  arc.centre = {0.5 * (at_.x + end.x) + unit.x * arc.u.x + unit.y * arc.v.x,
                0.5 * (at_.y + end.y) + unit.x * arc.u.y + unit.y * arc.v.y};
  arc.start = std::atan2(q.y - unit.y, q.x - unit.x);
  arc.sweep = std::atan2(-q.y - unit.y, -q.x - unit.x) - arc.start;
  if (is_sweep && arc.sweep < 0.0) arc.sweep += 2.0 * kPi;
  if (!is_sweep && arc.sweep > 0.0) arc.sweep -= 2.0 * kPi;
  elliptic(arc, false);
  if (!line_.vertices.empty()) line_.vertices.back().at = at(end);
  at_ = end;
}

void EntityWriter::path(const std::vector<PathCommand>& commands) {
  bool is_open = false;  // a subpath has started
  for (const PathCommand& c : commands) {
    if (c.kind == 'M') {
      if (is_open) finish(false);
      start_at(c.at[0]);
      is_open = true;
      continue;
    }
    if (!is_open) start_at(start_);
    is_open = c.kind != 'Z';
    is_drawn_ = true;
    if (c.kind == 'L') line_to(c.at[0]);
    if (c.kind == 'Q') curve({at_, c.at[0], c.at[1]}, {});
    if (c.kind == 'C') curve({at_, c.at[0], c.at[1], c.at[2]}, {});
    if (c.kind == 'A') arc_to(c.at[0], c.turn, c.is_large, c.is_sweep, c.at[1]);
    if (c.kind == 'Z') finish(true);
  }
  if (is_open) finish(false);
}

void EntityWriter::ellipse(Vec centre, double rx, double ry) {
  const Arc arc{centre, {rx, 0.0}, {0.0, ry}, 0.0, 2.0 * kPi};
  Arc drawn = arc;
  drawn.u = setting_.matrix.direction(arc.u);
  drawn.v = setting_.matrix.direction(arc.v);
  if (drawn.is_round() && !setting_.has_start) {
    append(dxf::Circle{at(centre), svg::length(drawn.u)}, 0);
    return;
  }
  start_at(arc.at(0.0));
  elliptic(arc, true);
  finish(true);
}

/// The points of a Bezier curve as a polyline that is fine enough for its box.
static drawing::Polyline sampled(const dxf::Spline& spline) {
  constexpr int kPieces = 1024;
  drawing::Polyline line;
  for (int k = 0; k <= kPieces; ++k) {
    const double t = static_cast<double>(k) / kPieces;
    std::vector<std::array<double, 3>> row;
    for (std::size_t i = 0; i < spline.control.size(); ++i) {
      const double w = spline.weights.empty() ? 1.0 : spline.weights[i];
      row.push_back({w * spline.control[i].x, w * spline.control[i].y, w});
    }
    for (; row.size() > 1; row.pop_back())
      for (std::size_t i = 0; i + 1 < row.size(); ++i)
        for (std::size_t j = 0; j < 3; ++j) row[i][j] += t * (row[i + 1][j] - row[i][j]);
    line.vertices.push_back({row[0][0] / row[0][2], row[0][1] / row[0][2]});
  }
  return line;
}

Box bounding_box(const std::vector<dxf::Entity>& entities, bool& has_text) {
  Drawing plain;
  for (const dxf::Entity& entity : entities) {
    has_text = has_text || std::holds_alternative<dxf::TextPart>(entity.shape);
    if (const auto* circle = std::get_if<dxf::Circle>(&entity.shape))
      plain.entities.push_back({0, drawing::Circle{circle->centre.x, circle->centre.y, circle->radius}});
    if (const auto* spline = std::get_if<dxf::Boxed<dxf::Spline>>(&entity.shape))
      plain.entities.push_back({0, sampled(**spline)});
    if (const auto* line = std::get_if<dxf::Boxed<dxf::Polyline>>(&entity.shape)) {
      drawing::Polyline made;
      made.closed = (*line)->closed;
      for (const dxf::Vertex& v : (*line)->vertices) made.vertices.push_back({v.at.x, v.at.y, v.bulge});
      plain.entities.push_back({0, std::move(made)});
    }
  }
  const auto [low_x, low_y, high_x, high_y] = drawing_bounds(plain);
  return {low_x, low_y, high_x - low_x, high_y - low_y};
}

}  // namespace kerf::svg
#endif

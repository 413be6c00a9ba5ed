// The bounds of a drawing.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kerf/drawing/drawing_files.h"

namespace kerf {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

class Bounds {
 public:
  void point(double x, double y) {
    low_x_ = std::min(low_x_, x);
    low_y_ = std::min(low_y_, y);
    high_x_ = std::max(high_x_, x);
    high_y_ = std::max(high_y_, y);
  }
  void operator()(const drawing::Line& line) {
    point(line.x1, line.y1);
    point(line.x2, line.y2);
  }
  void operator()(const drawing::Circle& circle) {
    point(circle.x - circle.radius, circle.y - circle.radius);
    point(circle.x + circle.radius, circle.y + circle.radius);
  }
  void operator()(const drawing::Text& text) { point(text.x, text.y); }
  void operator()(const drawing::Arc& arc) {
    const auto at = [&](double degrees) {
      point(arc.x + arc.radius * std::cos(degrees * kDegree),
            arc.y + arc.radius * std::sin(degrees * kDegree));
    };
    at(arc.start);
    at(arc.end);
    double sweep = std::fmod(arc.end - arc.start, 360.0);
    if (sweep <= 0.0) sweep += 360.0;
    double quarter = 90.0 * std::ceil(arc.start / 90.0);
    for (int i = 0; i < 5 && quarter < arc.start + sweep; ++i, quarter += 90.0) at(quarter);
  }
  void operator()(const drawing::Polyline& line) {
    const std::size_t n = line.vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
      const drawing::Vertex& a = line.vertices[i];
      point(a.x, a.y);
      const drawing::Vertex& b = line.vertices[(i + 1) % n];
      if (a.bulge != 0.0 && (i + 1 < n || line.closed)) bulge(a, b);
    }
  }
  std::array<double, 4> result() const {
    if (low_x_ > high_x_) return {0.0, 0.0, 0.0, 0.0};
    return {low_x_, low_y_, high_x_, high_y_};
  }

 private:
  void bulge(const drawing::Vertex& a, const drawing::Vertex& b) {
    const double dx = 0.5 * (b.x - a.x), dy = 0.5 * (b.y - a.y);
    const double rise = 0.5 * (1.0 / a.bulge - a.bulge);  // of the centre over the chord, in half chords
    const double x = a.x + dx - rise * dy, y = a.y + dy + rise * dx;
    const double from = std::atan2(a.y - y, a.x - x) / kDegree, to = std::atan2(b.y - y, b.x - x) / kDegree;
    const double radius = std::hypot(a.x - x, a.y - y);
    (*this)(a.bulge > 0.0 ? drawing::Arc{x, y, radius, from, to} : drawing::Arc{x, y, radius, to, from});
  }
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  double low_x_ = kFar, low_y_ = kFar, high_x_ = -kFar, high_y_ = -kFar;
};

}  // namespace

std::array<double, 4> drawing_bounds(const Drawing& drawing) {
  Bounds bounds;
  for (const DrawingEntity& entity : drawing.entities) std::visit(bounds, entity.shape);
  return bounds.result();
}

}  // namespace kerf

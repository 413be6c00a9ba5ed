// Parallel lines inside a region. The region is turned so that the lines are level; each piece of its
// boundary that rises or falls counts where it passes from below a line to it or above, so that ends count
// once.
#include "op/base/hatch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "op/base/track.h"

namespace kerf::op_detail {
namespace {

/// A part of the boundary without a turning point in y.
struct Monotone {
  LineArc shape;
  Point2 from, to;
  double side = 0.0;  // of an arc: whether it is right (+1) or left (-1) of its centre
};

class Boundary {
 public:
  explicit Boundary(const Region& region, double cosine, double sine) : c_(cosine), s_(sine) {
    for (const Outline& loop : region.loops) {
      const Track track(loop, 0.0);
      for (const LineArc& piece : track.pieces(0.0, track.length())) add(piece);
    }
  }
  const Box2& box() const { return box_; }
  /// Sorted x where the line at height y enters and leaves.
  std::vector<double> crossings(double y) const {
    std::vector<double> xs;
    for (const Monotone& m : pieces_) {
      if ((m.from.y <= y) == (m.to.y <= y)) continue;
      if (m.side == 0.0) {
        xs.push_back(m.from.x + (y - m.from.y) / (m.to.y - m.from.y) * (m.to.x - m.from.x));
      } else {
        const double h = y - m.shape.centre.y;
        xs.push_back(m.shape.centre.x +
                     m.side * std::sqrt(std::max(m.shape.radius * m.shape.radius - h * h, 0.0)));
      }
    }
    std::sort(xs.begin(), xs.end());
    return xs;
  }

 private:
  Point2 turned(Point2 p) const { return {c_ * p.x + s_ * p.y, c_ * p.y - s_ * p.x}; }
  void push(Monotone m) {
    box_.add(m.from), box_.add(m.to);
    pieces_.push_back(m);
  }
  void add(const LineArc& piece) {
    const Point2 from = turned(piece.from), to = turned(piece.to);
    if (!piece.is_arc()) return push({piece, from, to, 0.0});
    LineArc arc = piece;
    arc.centre = turned(piece.circle_centre());  // absolute here
    // Divided at the top and the bottom of its circle.
    const double start = std::atan2(from.y - arc.centre.y, from.x - arc.centre.x), sweep = sweep_of(piece);
    std::vector<double> ends{0.0};
    for (int k = -4; k <= 4; ++k) {
      const double t = arc.turn * ((k + 0.5) * std::numbers::pi - start);
      if (t > 0.0 && t < sweep) ends.push_back(t);
    }
    ends.push_back(sweep);
    std::sort(ends.begin(), ends.end());
    Point2 last = from;
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double angle = start + arc.turn * ends[i],
                   halfway = start + arc.turn * 0.5 * (ends[i - 1] + ends[i]);
      const Point2 end =
          i + 1 == ends.size() ? to : arc.centre + arc.radius * Point2{std::cos(angle), std::sin(angle)};
      push({arc, last, end, std::cos(halfway) >= 0.0 ? 1.0 : -1.0});
      last = end;
    }
  }

  double c_, s_;
  std::vector<Monotone> pieces_;
  Box2 box_;
};

}  // namespace

std::vector<HatchLine> hatch(const Region& region, Angle angle, Length spacing, std::size_t max_lines) {
  std::vector<HatchLine> lines;
  if (region.empty()) return lines;
  const double c = std::cos(angle.rad()), s = std::sin(angle.rad());
  const Boundary boundary(region, c, s);
  const double low = boundary.box().low.y, height = boundary.box().high.y - low;
  // Rows at equal distances, which are at most the spacing.
  const double rows = std::max(std::ceil(height / spacing.mm() - 1e-9), 1.0);
  const auto back = [&](double x, double y) { return Point2{c * x - s * y, s * x + c * y}; };
  for (double row = 0.0; row < rows && lines.size() < max_lines; row += 1.0) {
    const double y = low + height * (row + 0.5) / rows;
    const std::vector<double> xs = boundary.crossings(y);
    for (std::size_t i = 0; i + 1 < xs.size(); i += 2)
      if (xs[i + 1] > xs[i])
        lines.push_back({back(xs[i], y), back(xs[i + 1], y), static_cast<std::size_t>(row)});
  }
  return lines;
}

}  // namespace kerf::op_detail

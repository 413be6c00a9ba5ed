// The rotation and shift of a workpiece from probed points.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/number.h"

#include "kerf/op/rework.h"

namespace kerf {
namespace {

constexpr double kSamePoint = 1e-3;  // mm: nearer points define no direction
constexpr double kFlat = 1e-3;       // mm, the least height of a triangle that defines a circle

std::nullopt_t refuse(std::string message, Diagnostics& diagnostics) {
  diagnostics.error(codes::pass_option, {}, std::move(message));
  return std::nullopt;
}
std::string text_of(Point2 p) { return fmt::format("{},{}", number_text(p.x, 4), number_text(p.y, 4)); }

/// The centre of the circle through three points; nothing if they are on a line.
std::optional<Point2> centre_of(Point2 a, Point2 b, Point2 c) {
  const Point2 u = b - a, v = c - a;
  const double area = 2.0 * cross(u, v), longest = std::max({length(u), length(v), distance(b, c)});
  if (std::abs(area) <= 2.0 * kFlat * longest) return std::nullopt;  // also of one point three times
  const double uu = dot(u, u), vv = dot(v, v);
  return a + Point2{(uu * v.y - vv * u.y) / area, (vv * u.x - uu * v.x) / area};
}

/// The corner of a part: the probe touched its edges from outside.
std::optional<Alignment> from_corner(const AlignPoint& corner, Length probe, Diagnostics& diagnostics) {
  const Point2 a = corner.measured[0], way = corner.measured[1] - a, c = corner.measured[2];
  if (length(way) < kSamePoint)
    return refuse(fmt::format("the two points on the edge along X are one, {}", text_of(a)), diagnostics);
  const Point2 along = (1.0 / length(way)) * way, inwards{-along.y, along.x};
  const double radius = 0.5 * probe.mm();
  const Point2 found = a + (dot(c - a, along) + radius) * along + radius * inwards;
  Alignment made;
  made.transform = {.rotate = radians(std::atan2(along.y, along.x)),
                    .move = {found.x - corner.at.x, found.y - corner.at.y, 0.0},
                    .centre = corner.at};
  return made;
}

struct Pair {
  Point2 at, measured;
};

std::optional<std::vector<Pair>> pairs_of(const AlignOptions& options, Diagnostics& diagnostics) {
  std::vector<Pair> pairs;
  for (const AlignPoint& point : options.points) {
    const std::vector<Point2>& m = point.measured;
    if (point.is_corner) return refuse("a corner is not combined with other points", diagnostics);
    const auto where = m.size() == 3 ? centre_of(m[0], m[1], m[2]) : std::optional(m.front());
    if (!where)
      return refuse(fmt::format("the three points of the hole at {} are on a line", text_of(point.at)),
                    diagnostics);
    for (const Pair& other : pairs)
      if (distance(other.at, point.at) < kSamePoint || distance(other.measured, *where) < kSamePoint)
        return refuse(fmt::format("two points are at {}", text_of(point.at)), diagnostics);
    pairs.push_back({point.at, *where});
  }
  return pairs;
}

}  // namespace

std::optional<Alignment> alignment_of(const AlignOptions& options, Diagnostics& diagnostics) {
  if (options.points.size() == 1 && options.points.front().is_corner)
    return from_corner(options.points.front(), options.probe, diagnostics);
  const auto pairs = pairs_of(options, diagnostics);
  if (!pairs) return std::nullopt;
  Alignment made;
  if (pairs->empty()) return made;
  Point2 from{}, to{};
  for (const Pair& p : *pairs) from = from + p.at, to = to + p.measured;
  const double part = 1.0 / static_cast<double>(pairs->size());
  from = part * from, to = part * to;
  double turned = 0.0, kept = 0.0;
  for (const Pair& p : *pairs) {
    turned += cross(p.at - from, p.measured - to);
    kept += dot(p.at - from, p.measured - to);
  }
  const double angle = pairs->size() > 1 ? std::atan2(turned, kept) : 0.0;
  made.transform = {.rotate = radians(angle), .move = {to.x - from.x, to.y - from.y, 0.0}, .centre = from};
  const Pair* worst = nullptr;
  for (const Pair& p : *pairs) {
    const Point2 d = p.at - from;
    const Point2 there = to + Point2{std::cos(angle) * d.x - std::sin(angle) * d.y,
                                     std::sin(angle) * d.x + std::cos(angle) * d.y};
    if (worst == nullptr || distance(there, p.measured) > made.farthest.mm())
      worst = &p, made.farthest = mm(distance(there, p.measured));
  }
  if (made.farthest > options.fits)
    diagnostics.warning(codes::align_misfit, {},
                        fmt::format("the points do not fit: the one at {} was measured {} mm from where it "
                                    "belongs",
                                    text_of(worst->at), number_text(made.farthest.mm(), 3)));
  return made;
}

}  // namespace kerf

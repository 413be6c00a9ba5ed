// What a path of a flat mill removes, point by point, by distances from its motions alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kerf/geom/offset.h"
#include "kerf/op/operation.h"

namespace kerf::test {

inline Tool made(const ToolShape& shape) {
  Diagnostics diagnostics;
  return *make_tool(1, shape, {}, {}, diagnostics);
}
inline Tool mill(double diameter, double flute = 50.0) {
  return made(shape::Square{mm(diameter), mm(flute)});
}

/// A cut of 4 mm in two levels.
inline CutOptions levels(double depth = 4.0, double stepdown = 2.0) {
  CutOptions cut;
  cut.depth = mm(depth), cut.stepdown = mm(stepdown);
  cut.feed = mm_per_min(600), cut.plunge = mm_per_min(200);
  return cut;
}

inline Outline polygon(const std::vector<Point2>& points) {
  Outline outline;
  outline.start = points.front();
  for (std::size_t i = 1; i < points.size(); ++i) outline.segments.push_back({points[i], {}});
  outline.segments.push_back({points.front(), {}});
  return outline;
}
inline Outline rectangle(double x0, double y0, double x1, double y1) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}
inline Region region_of(const std::vector<Outline>& outlines) {
  Diagnostics diagnostics;
  return *make_region(outlines, FillRule::even_odd, {}, diagnostics);
}

/// A motion seen from above.
struct Motion {
  bool rapid = false;
  Point3 from, to;
  bool arc = false;
  Point2 centre;
  double radius = 0.0, start = 0.0, sweep = 0.0;  // sweep: signed, at most a full turn

  double distance_to(Point2 p) const {
    if (!arc) {
      const Point2 a = from.xy(), way = to.xy() - a;
      const double square = dot(way, way);
      const double t = square > 0.0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
      return distance(p, a + t * way);
    }
    const Point2 v = p - centre;
    double angle = std::atan2(v.y, v.x) - start;
    if (sweep < 0.0) angle = -angle;
    angle = std::fmod(angle, 2.0 * std::numbers::pi);
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    if (angle <= std::abs(sweep)) return std::abs(length(v) - radius);
    return std::min(distance(p, from.xy()), distance(p, to.xy()));
  }
  double low() const { return std::min(from.z, to.z); }
  double high() const { return std::max(from.z, to.z); }
};

/// The motions of a path with known start and end.
inline std::vector<Motion> motions(const Toolpath& path) {
  std::vector<Motion> made;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if (context.unknown_from != 0 || s.unknown_axes() != 0) return;
    Motion m;
    m.rapid = s.kind() == StepKind::rapid;
    m.from = context.from, m.to = s.to();
    if (s.kind() == StepKind::arc) {
      const ArcWalk walk = walk_of(s, context.from);
      m.arc = true;
      m.centre = {walk.u, walk.v};
      m.radius = walk.start_radius, m.start = walk.start_angle;
      m.sweep = std::clamp(walk.sweep, -2.0 * std::numbers::pi, 2.0 * std::numbers::pi);
    }
    made.push_back(m);
  });
  return made;
}

/// Whether a cut at level `z` or below covers the point.
inline bool removed_to(const std::vector<Motion>& path, Point2 p, double radius, double z) {
  return std::any_of(path.begin(), path.end(), [&](const Motion& m) {
    return !m.rapid && m.high() <= z + 1e-9 && m.distance_to(p) <= radius;
  });
}
/// Whether anything below `top` comes to the point.
inline bool touched(const std::vector<Motion>& path, Point2 p, double radius, double top) {
  return std::any_of(path.begin(), path.end(),
                     [&](const Motion& m) { return m.low() < top - 1e-9 && m.distance_to(p) <= radius; });
}

/// Compares a path with what the region demands at points of a grid: nothing outside of it is cut, all but
/// `unreached` is removed down to `bottom`. Points within `margin` of a boundary do not count.
inline std::string wrong_points(const Toolpath& path, const Region& region, const Region& unreached,
                                double radius, double top, double bottom, double pitch,
                                double margin = 0.01) {
  const std::vector<Motion> cuts = motions(path);
  const RegionSearch inside(region), left(unreached);
  const Box2 box = bounds(region).grown(2.0 * radius);
  std::string wrong;
  int shown = 0;
  for (double y = box.low.y; y < box.high.y; y += pitch)
    for (double x = box.low.x; x < box.high.x && shown < 5; x += pitch) {
      const Point2 p{x, y};
      const auto near = inside.nearest(p), near_left = left.nearest(p);
      if (near && near->distance.mm() < margin) continue;
      if (near_left && near_left->distance.mm() < margin) continue;
      const bool in = inside.locate(p, mm(1e-6)) == Location::inside;
      const bool stays = !unreached.empty() && left.locate(p, mm(1e-6)) == Location::inside;
      const auto note = [&](const char* what) {
        wrong += std::string(what) + " at " + std::to_string(x) + ", " + std::to_string(y) + "; ";
        ++shown;
      };
      if (!in && touched(cuts, p, radius - 1e-4, top)) note("gouged");
      if (in && !stays && !removed_to(cuts, p, radius + 1e-4, bottom)) note("left");
      if (in && stays && removed_to(cuts, p, radius - 1e-4, bottom)) note("unreached but cut");
    }
  return wrong;
}

/// Rapids below the retract plane that go through material not yet removed, by samples along them: at each,
/// the disc of the tool was cleared to its level by the cuts before. Returns the first problem.
inline std::string rapid_problem(const Toolpath& path, double radius, double top) {
  std::vector<Motion> cuts;
  for (const Motion& m : motions(path)) {
    if (!m.rapid) {
      cuts.push_back(m);
      continue;
    }
    if (m.low() >= top - 1e-9) continue;
    for (int i = 0; i <= 10; ++i) {
      const Point3 at = m.from + (i / 10.0) * (m.to - m.from);
      if (at.z >= top - 1e-9) continue;
      for (int k = 0; k < 12; ++k)
        for (const double part : {0.3, 0.7, 0.99}) {
          const Point2 p = at.xy() + (part * radius) * Point2{std::cos(k * std::numbers::pi / 6),
                                                              std::sin(k * std::numbers::pi / 6)};
          if (!removed_to(cuts, p, radius + 1e-4, at.z))
            return "rapid in material at " + std::to_string(at.x) + ", " + std::to_string(at.y) + ", " +
                   std::to_string(at.z);
        }
    }
  }
  return "";
}

}  // namespace kerf::test

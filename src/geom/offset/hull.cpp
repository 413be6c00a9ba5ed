// A hull of samples: the boundary's ends and points of its convex arcs. Between two arcs its straight lines
// are moved to the exact tangents, so that the density of samples decides on nothing but which arcs are met.
#include "geom/offset/hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSlack = 1e-9;  // radians, beside the ends of arcs

double turn_fraction(double angle) {
  const double r = std::fmod(angle, kTurn);
  return r < 0.0 ? r + kTurn : r;
}

/// The convex arcs of one circle.
struct ArcsOfCircle {
  struct Sweep {
    double start, sweep;  // radians, counter-clockwise
  };
  Point2 centre;
  double radius = 0.0, step = 0.0;  // radians between samples
  std::vector<Sweep> arcs;

  Point2 at(double angle) const {
    return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
  }
  bool has(double angle) const {
    return std::any_of(arcs.begin(), arcs.end(), [&](const Sweep& s) {
      return turn_fraction(angle - s.start + kSlack) <= s.sweep + 2.0 * kSlack;
    });
  }
};

struct Sample {
  Point2 at;
  std::int64_t circle = -1;
  double angle = 0.0;
};

/// Consecutive vertices of the hull that lie on one arc, or a single vertex.
struct Stretch {
  Sample first, last;
};

class Hull {
 public:
  void add(const Region& region) {
    for (const Outline& loop : region.loops) {
      Point2 from = loop.start;
      for (const Segment& s : loop.segments) {
        const auto arc = s.via ? arc_circle(from, s) : std::nullopt;
        if (arc && arc->turn == Turn::ccw)
          add_arc(*arc, from, s.to);
        else
          samples_.push_back({from});
        from = s.to;
      }
    }
  }

  std::optional<Outline> outline() {
    const std::vector<Sample> vertices = chain();
    if (vertices.size() < 3) return std::nullopt;
    std::vector<Stretch> list = stretches(vertices);
    if (list.empty()) {
      const ArcsOfCircle& c = circles_[static_cast<std::size_t>(vertices[0].circle)];
      return as_outline(Circle{c.centre, mm(c.radius)});
    }
    for (std::size_t i = 0; i < list.size(); ++i) join(list[i].last, list[(i + 1) % list.size()].first);
    return drawn(list);
  }

 private:
  void add_arc(const ArcCircle& arc, Point2 from, Point2 to) {
    constexpr double kSagitta = 1e-3;  // mm, of the samples
    constexpr double kMinStep = 0.002, kMaxStep = 0.1;
    const std::size_t index = circle(arc);
    ArcsOfCircle& c = circles_[index];
    c.step = std::clamp(2.0 * std::acos(std::max(0.0, 1.0 - kSagitta / c.radius)), kMinStep, kMaxStep);
    const double start = std::atan2(from.y - c.centre.y, from.x - c.centre.x), sweep = arc.sweep.rad();
    c.arcs.push_back({start, sweep});
    const auto count = static_cast<int>(std::ceil(sweep / c.step));
    for (int i = 0; i <= count; ++i) {
      const double angle = start + sweep * i / count;
      samples_.push_back({i == 0       ? from
                          : i == count ? to
                                       : c.at(angle),
                          static_cast<std::int64_t>(index), angle});
    }
  }

  /// That of an arc before, if it has the same circle.
  std::size_t circle(const ArcCircle& arc) {
    constexpr double kSame = 1e-9;  // mm
    if (!circles_.empty() && distance(circles_.back().centre, arc.centre) < kSame &&
        std::fabs(circles_.back().radius - arc.radius) < kSame)
      return circles_.size() - 1;
    circles_.push_back({arc.centre, arc.radius, 0.0, {}});
    return circles_.size() - 1;
  }

  /// The vertices of the hull of all samples, counter-clockwise.
  std::vector<Sample> chain() {
    std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
      return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y != b.at.y ? a.at.y < b.at.y : a.circle > b.circle;
    });
    const auto same = [](const Sample& a, const Sample& b) { return a.at == b.at; };
    samples_.erase(std::unique(samples_.begin(), samples_.end(), same), samples_.end());
    std::vector<Sample> hull;
    const auto half = [&](auto first, auto last) {
      const std::size_t base = hull.size();
      for (auto s = first; s != last; ++s) {
        while (hull.size() > base + 1 &&
               cross(hull.back().at - hull[hull.size() - 2].at, s->at - hull.back().at) <= 0.0)
          hull.pop_back();
        hull.push_back(*s);
      }
      hull.pop_back();  // the first of the other half
    };
    if (samples_.empty()) return hull;
    half(samples_.begin(), samples_.end());
    half(samples_.rbegin(), samples_.rend());
    return hull;
  }

  bool on_one_arc(const Sample& a, const Sample& b) const {
    if (a.circle < 0 || a.circle != b.circle) return false;
    const ArcsOfCircle& c = circles_[static_cast<std::size_t>(a.circle)];
    const double gap = turn_fraction(b.angle - a.angle);
    return gap < 1.5 * c.step && c.has(a.angle + 0.5 * gap);
  }

  /// None for a hull that is one circle.
  std::vector<Stretch> stretches(const std::vector<Sample>& vertices) const {
    const std::size_t n = vertices.size();
    std::size_t start = 0;
    while (start < n && on_one_arc(vertices[(start + n - 1) % n], vertices[start])) ++start;
    std::vector<Stretch> list;
    for (std::size_t k = 0; start < n && k < n; ++k) {
      const Sample& v = vertices[(start + k) % n];
      if (!list.empty() && on_one_arc(list.back().last, v))
        list.back().last = v;
      else
        list.push_back({v, v});
    }
    return list;
  }

  /// Moves the ends of a straight line to the tangent of the arcs that they are on, as far as these go.
  void join(Sample& from, Sample& to) const {
    bool on_first = from.circle >= 0, on_second = to.circle >= 0;
    for (int i = 0; i < 3 && (on_first || on_second); ++i) {
      const ArcsOfCircle point{};
      const ArcsOfCircle& a = on_first ? circles_[static_cast<std::size_t>(from.circle)] : point;
      const ArcsOfCircle& b = on_second ? circles_[static_cast<std::size_t>(to.circle)] : point;
      const Point2 along = (on_second ? b.centre : to.at) - (on_first ? a.centre : from.at);
      const double size = length(along), part = (a.radius - b.radius) / size;
      if (!(std::fabs(part) <= 1.0)) return;
      const Point2 unit = (1.0 / size) * along;
      const Point2 normal = part * unit - std::sqrt(1.0 - part * part) * left_of(unit);
      const double angle = std::atan2(normal.y, normal.x);
      const bool is_first = on_first && !a.has(angle), is_second = on_second && !b.has(angle);
      if (is_first || is_second) {
        on_first = on_first && !is_first;
        on_second = on_second && !is_second;
        continue;
      }
      if (on_first) from = {a.at(angle), from.circle, angle};
      if (on_second) to = {b.at(angle), to.circle, angle};
      return;
    }
  }

  Outline drawn(const std::vector<Stretch>& list) const {
    Outline out;
    out.start = list[0].first.at;
    const auto line_to = [&](Point2 p) {
      const Point2 last = out.segments.empty() ? out.start : out.segments.back().to;
      if (last != p) out.segments.push_back({p, {}});
    };
    for (const Stretch& s : list) {
      line_to(s.first.at);
      if (s.first.at == s.last.at) continue;
      const ArcsOfCircle& c = circles_[static_cast<std::size_t>(s.first.circle)];
      const double sweep = turn_fraction(s.last.angle - s.first.angle);
      if (sweep > kSlack && sweep < kTurn - kSlack)
        out.segments.push_back({s.last.at, c.at(s.first.angle + 0.5 * sweep)});
    }
    line_to(out.start);
    return out;
  }

  std::vector<ArcsOfCircle> circles_;
  std::vector<Sample> samples_;
};

}  // namespace

std::optional<Region> convex_hull(const std::vector<Region>& regions, const RegionOptions& options,
                                  Diagnostics& diagnostics) {
  Hull hull;
  for (const Region& region : regions) hull.add(region);
  const auto outline = hull.outline();
  if (!outline) return Region{};
  return make_region({*outline}, FillRule::nonzero, options, diagnostics);
}

}  // namespace kerf

// Spirals. A turn between two rings connects points of the outer one, and their nearest points of the inner
// one, in changing proportion. Every such connection runs straight to the wall, so that turns are no farther
// apart than the rings. At corners the connections of one point are many, and none where both rings turn
// away: what the turns leave there is computed, and such rings are cut one by one.
#include "op/mill/spiral.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kerf/geom/offset.h"

namespace kerf::op_detail {
namespace {

constexpr int kMaxHalvings = 16;  // of a part of a turn
constexpr double kJump = 4.0;     // of the tolerance: a longer chord after all halvings is a jump
constexpr std::size_t kMaxPoints = 200'000;
constexpr double kLeft = 1e-4;  // of the tool's radius squared: a smaller area is no material that remains

/// One turn, by the length v along the outer ring from its start.
class Turning {
 public:
  Turning(const Track& inner, const Track& outer, Point2 from, double chord)
      : inner_(inner), outer_(outer), start_(outer.nearest(from)), chord_(chord) {}

  /// Appends the points after the start. False where it leaves the region.
  bool run(const Walls& walls, std::vector<Point2>& points) {
    std::vector<double> breaks{0.0, outer_.length()};
    double along = 0.0;
    for (const LineArc& piece : outer_.pieces(start_, start_ + outer_.length()))
      breaks.push_back(along), along += length_of(piece);
    for (const LineArc& piece : inner_.pieces(0.0, inner_.length())) {
      const double v = outer_.nearest(piece.from) - start_;
      breaks.push_back(v < 0.0 ? v + outer_.length() : v);
    }
    std::sort(breaks.begin(), breaks.end());
    points.push_back(at(0.0));
    for (std::size_t i = 1; i < breaks.size(); ++i)
      if (!part(walls, breaks[i - 1], breaks[i], kMaxHalvings, points)) return false;
    return true;
  }

 private:
  /// A point of the outer ring and its nearest one of the inner ring.
  std::pair<Point2, Point2> connection(double v) const {
    const Point2 out = outer_.at(start_ + v);
    return {out, inner_.at(inner_.nearest(out))};
  }
  Point2 at(double v) const {
    const auto [out, in] = connection(v);
    return in + (v / outer_.length()) * (out - in);
  }

  bool part(const Walls& walls, double from, double to, int halvings, std::vector<Point2>& points) const {
    if (points.size() > kMaxPoints) return false;
    const Point2 a = points.back(), b = at(to);
    if (halvings > 0 && to > from && deviates(a, b, from, to)) {
      const double halfway = 0.5 * (from + to);
      return part(walls, from, halfway, halvings - 1, points) &&
             part(walls, halfway, to, halvings - 1, points);
    }
    if (halvings == 0 && distance(a, b) > kJump * chord_ && !walls.permits_line(a, b)) return false;
    // In a part that is too narrow for the inner ring, that may be around a corner.
    if (const auto [out, in] = connection(to); !walls.permits_line(in, out)) return false;
    points.push_back(b);
    return true;
  }
  /// Whether a quarter of the way, half of it or three quarters are off the chord.
  bool deviates(Point2 a, Point2 b, double from, double to) const {
    const Point2 way = b - a;
    const double square = dot(way, way);
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point2 p = at(from + t * (to - from)) - a;
      const double on = square > 0.0 ? std::clamp(dot(p, way) / square, 0.0, 1.0) : 0.0;
      if (length(p - on * way) > chord_) return true;
    }
    return false;
  }

  const Track& inner_;
  const Track& outer_;
  double start_, chord_;
};

/// Whether a tool on the turns removes all between the first and the last ring that it removes on them.
bool covers(const std::vector<Outline>& rings, const std::vector<Point2>& points, double radius,
            const RegionOptions& options) {
  Diagnostics unused;
  Outline turns{points.front(), {}};
  for (std::size_t i = 1; i < points.size(); ++i) turns.segments.push_back({points[i], {}});
  const auto all = make_region({rings.back()}, FillRule::even_odd, options, unused);
  auto rest = all;
  const auto take_away = [&](const std::optional<Region>& region) {
    if (!rest || !region) return rest.reset();
    auto made = combine(*rest, *region, Boolean::subtract, options, unused);
    if (!made) return rest.reset();
    rest = std::move(made->region);
  };
  take_away(make_region({rings.front()}, FillRule::even_odd, options, unused));
  for (const Outline* ring : {&rings.front(), &rings.back()})
    take_away(buffer(*ring, mm(radius), PathEnds::round, options, unused));
  take_away(buffer(turns, mm(radius), PathEnds::round, options, unused));
  return rest && area(*rest) <= kLeft * radius * radius;
}

}  // namespace

std::optional<Spiral> spiral_through(const std::vector<Outline>& rings, double tool_radius,
                                     const Walls& walls, const CutOptions& options) {
  const double weld = options.tolerance.weld.mm();
  std::vector<Track> tracks;
  for (const Outline& ring : rings) {
    tracks.emplace_back(ring, weld);
    if (tracks.back().empty() || !tracks.back().closed()) return std::nullopt;
  }
  Spiral spiral{tracks.front(), tracks.back(), {tracks.front().at(0.0)}};
  for (std::size_t i = 1; i < tracks.size(); ++i)
    if (!Turning(tracks[i - 1], tracks[i], spiral.points.back(), options.tolerance.chord.mm())
             .run(walls, spiral.points))
      return std::nullopt;
  if (!covers(rings, spiral.points, tool_radius, region_options(options))) return std::nullopt;
  return spiral;
}

}  // namespace kerf::op_detail

// Random regions: boolean operations and offsets checked by properties that hold for all shapes.
//   property_region [COUNT] [SEED]
// Outlines cross themselves and each other; a third of them has its points on a coarse grid, for coincident
// corners, overlaps and tangent arcs. Prints the seed, and for each case that fails a seed that repeats
// it alone. Exit status 1 if any does.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <random>

#include "kerf/geom/offset.h"

namespace {

using namespace kerf;

class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double probability) { return in(0.0, 1.0) < probability; }
  Outline outline(double size, bool on_grid);
  std::vector<Outline> outlines(double size, bool on_grid) {
    std::vector<Outline> made;
    for (int n = 1 + static_cast<int>(in(0.0, 2.5)); n > 0; --n) made.push_back(outline(size, on_grid));
    return made;
  }
  Point2 point(double size, bool on_grid) {
    const Point2 p{in(-size, size), in(-size, size)};
    return on_grid ? Point2{std::round(p.x), std::round(p.y)} : p;
  }

 private:
  std::mt19937_64 random_;
};

Outline Drawer::outline(double size, bool on_grid) {
  const int corners = 2 + static_cast<int>(in(0.0, 9.0));
  Outline made;
  made.start = point(size, on_grid);
  for (int i = 1; i <= corners; ++i) {
    const Point2 from = made.point(made.segments.size());
    Segment segment{i == corners ? made.start : point(size, on_grid), {}};
    if (segment.to == from) continue;
    if (chance(0.5)) {
      // Half circles on the grid touch each other and the lines.
      const double bulge = (chance(0.5) ? 1.0 : -1.0) * (on_grid ? 1.0 : std::exp(in(-5.0, 1.5)));
      const Point2 half = 0.5 * (segment.to - from);
      segment.via = from + half + bulge * Point2{half.y, -half.x};
    }
    made.segments.push_back(segment);
  }
  if (made.segments.size() < 2) return outline(size, on_grid);
  return made;
}

/// One case: two regions, an offset, and query points.
class Case {
 public:
  explicit Case(std::uint64_t seed) : drawer_(seed) {
    size_ = std::exp(drawer_.in(1.0, 4.0));
    on_grid_ = drawer_.chance(0.33);
    if (on_grid_) size_ = 6.0;
  }
  /// The fault; empty if there is none.
  std::string run();

 private:
  std::string booleans(const Region& a, const Region& b);
  std::string offsets(const Region& a);
  std::string membership(const std::vector<Outline>& outlines, const Region& made, FillRule rule);
  double slack(double perimeter) const { return 1e-5 * perimeter + 1e-9 * size_ * size_; }

  Drawer drawer_;
  Diagnostics diagnostics_;
  double size_ = 1.0;
  bool on_grid_ = false;
};

/// Of an outline, whose arcs are 256 chords, and a point.
struct Around {
  double turns = 0.0;  // the winding number, from angles alone; not an integer near the outline
  double distance = 1e300;
};

Around around(const Outline& outline, Point2 p) {
  Around found;
  Point2 from = outline.start;
  const auto step = [&](Point2 a, Point2 b) {
    found.turns += std::atan2(cross(a - p, b - p), dot(a - p, b - p)) / (2.0 * std::numbers::pi);
    const Point2 way = b - a;
    const double t = dot(way, way) > 0.0 ? std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0) : 0.0;
    found.distance = std::min(found.distance, distance(p, a + t * way));
  };
  for (const Segment& s : outline.segments) {
    if (const auto arc = arc_circle(from, s)) {
      constexpr int kSteps = 256;
      Point2 at = from;
      const Point2 d = from - arc->centre;
      for (int k = 1; k <= kSteps; ++k) {
        const double angle = (arc->turn == Turn::ccw ? 1.0 : -1.0) * arc->sweep.rad() * k / kSteps;
        const Point2 turned{d.x * std::cos(angle) - d.y * std::sin(angle),
                            d.x * std::sin(angle) + d.y * std::cos(angle)};
        const Point2 next = k == kSteps ? s.to : arc->centre + turned;
        step(at, next);
        at = next;
      }
    } else {
      step(from, s.to);
    }
    from = s.to;
  }
  return found;
}

/// Of all cases: points that were so far from the outlines that their chords determine the side, and all.
long compared_points = 0, drawn_points = 0;

std::string Case::membership(const std::vector<Outline>& outlines, const Region& made, FillRule rule) {
  const RegionSearch search(made);
  for (int i = 0; i < 10; ++i) {
    const Point2 p = drawer_.point(1.5 * size_, false);
    long winding = 0;
    double nearest = 1e300;
    for (const Outline& o : outlines) {
      const Around found = around(o, p);
      winding += std::lround(found.turns);
      nearest = std::min(nearest, found.distance);
    }
    ++drawn_points;
    if (nearest <= 1e-3 * size_) continue;
    ++compared_points;
    const bool inside = rule == FillRule::positive  ? winding > 0
                        : rule == FillRule::nonzero ? winding != 0
                                                    : (winding & 1) != 0;
    if (inside != (search.locate(p, {}) == Location::inside))
      return fmt::format("({}, {}) is on the wrong side of made regions", p.x, p.y);
  }
  for (const Outline& loop : made.loops) {
    const auto found = self_intersections(loop, {}, diagnostics_);
    if (!found) return "self-intersections failed";
  }
  return "";
}

std::string Case::booleans(const Region& a, const Region& b) {
  double made[4];
  const Boolean kinds[] = {Boolean::unite, Boolean::intersect, Boolean::subtract, Boolean::exclude};
  const double perimeter = length(a).mm() + length(b).mm();
  for (int k = 0; k < 4; ++k) {
    const auto combined = combine(a, b, kinds[k], {}, diagnostics_);
    if (!combined) return fmt::format("boolean {} failed", k);
    made[k] = area(combined->region);
    // A region made of the result is equal to it.
    const auto again = make_region(combined->region.loops, FillRule::positive, {}, diagnostics_);
    if (!again) return fmt::format("boolean {} cannot be made again", k);
    if (std::abs(area(*again) - made[k]) > slack(perimeter)) return fmt::format("boolean {} changes", k);
  }
  const double sum = area(a) + area(b);
  if (std::abs(made[0] + made[1] - sum) > slack(perimeter))
    return fmt::format("union {} and intersection {} do not add up to {}", made[0], made[1], sum);
  if (std::abs(made[2] + made[1] - area(a)) > slack(perimeter)) return "difference does not add up";
  if (std::abs(made[3] + made[1] - made[0]) > slack(perimeter)) return "exclusion does not add up";
  return "";
}

std::string Case::offsets(const Region& a) {
  const double by = (on_grid_ && drawer_.chance(0.5) ? std::round(drawer_.in(0.5, 3.0)) * 0.5
                                                     : drawer_.in(0.01, 0.4) * size_) *
                    (drawer_.chance(0.5) ? 1.0 : -1.0);
  const auto made = offset(a, mm(by), {}, diagnostics_);
  if (!made) return fmt::format("offset by {} failed", by);
  const RegionSearch before(a), after(made->region);
  const auto signed_distance = [&](Point2 p) {  // below 0 inside
    const auto nearest = before.nearest(p);
    if (!nearest) return 1e300;
    return before.locate(p, {}) == Location::inside ? -nearest->distance.mm() : nearest->distance.mm();
  };
  for (int i = 0; i < 20; ++i) {
    const Point2 p = drawer_.point(1.8 * size_, false);
    const double off = signed_distance(p) - by;
    if (std::abs(off) < 1e-5) continue;
    if ((off < 0.0) != (after.locate(p, {}) == Location::inside))
      return fmt::format("offset by {}: ({}, {}) is {} off and on the wrong side", by, p.x, p.y, off);
  }
  for (const Outline& loop : made->region.loops)  // every point of it has the distance
    for (const Segment& s : loop.segments)
      for (const Point2 p : {s.to, s.via.value_or(s.to)})
        if (std::abs(signed_distance(p) - by) > 2e-5)
          return fmt::format("offset by {}: ({}, {}) is {} off", by, p.x, p.y, signed_distance(p) - by);
  return "";
}

std::string Case::run() {
  const FillRule rules[] = {FillRule::even_odd, FillRule::nonzero, FillRule::positive};
  const FillRule rule = rules[static_cast<int>(drawer_.in(0.0, 3.0))];
  Region made[2];
  for (Region& region : made) {
    const std::vector<Outline> outlines = drawer_.outlines(size_, on_grid_);
    const auto region_made = make_region(outlines, rule, {}, diagnostics_);
    if (!region_made) return "not made: " + to_string(diagnostics_.list().back());
    region = *region_made;
    if (const std::string wrong = membership(outlines, region, rule); !wrong.empty()) return wrong;
  }
  if (const std::string wrong = booleans(made[0], made[1]); !wrong.empty()) return wrong;
  return offsets(made[0]);
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 10000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : std::random_device()();
  fmt::print("{} random regions, seed {}\n", count, seed);
  long failed = 0;
  for (long i = 0; i < count && failed < 20; ++i) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(i);
    const std::string wrong = Case(own).run();
    if (wrong.empty()) continue;
    ++failed;
    fmt::print("property_region 1 {}: {}\n", own, wrong);
  }
  fmt::print("{} failed; {} of {} points compared\n", failed, compared_points, drawn_points);
  if (compared_points < drawn_points / 2) return 1;
  return failed == 0 ? 0 : 1;
}

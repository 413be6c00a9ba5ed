// Offset. Each loop's parallel curve is made as it comes, with all its crossings, so that its winding numbers
// tell what is near the loop (docs/decisions/0016-region-kernel.md has the reason):
//   - around the points that a growing loop reaches the curve winds at least once, and around no others;
//   - a shrinking loop's curve winds around what is left of it at most once, and around nothing else, unless
//     the whole loop fits into a circle of the distance, which its bounds tell beforehand;
//   - a curve of inner corners, and of arcs that turn inside out, may be any path that leaves these numbers
//   above
//     or below 0 as they are: a straight line does.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "outline_check.h"
#include "resolve.h"

namespace kerf {
namespace {

using namespace region_detail;

/// A segment with its directions at both ends.
struct Run : LineArc {
  Point2 start_way, end_way;  // unit directions
  double reach = 0.0;         // so far from both ends it runs on without turning round
  Point2 right_of_start() const { return {start_way.y, -start_way.x}; }
  Point2 right_of_end() const { return {end_way.y, -end_way.x}; }
  double curvature() const { return is_arc() ? turn / radius : 0.0; }
};

Run run_of(Point2 from, const Segment& segment) {
  Run run{outline_detail::make_carrier(from, segment, 0.0), {}, {}, 0.0};
  run.start_way = start_direction(run);
  run.end_way = end_direction(run);
  run.reach = norm(run.chord());
  if (!run.is_arc()) return run;
  const bool beyond_half = run.turn * cross(run.chord(), run.centre) < 0.0;
  run.reach = beyond_half ? run.radius : std::min(run.radius, run.reach);
  return run;
}

std::vector<Run> runs_of(const Outline& outline) {
  std::vector<Run> runs;
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    if (!(s.to == from)) runs.push_back(run_of(from, s));
    from = s.to;
  }
  return runs;
}

/// Whether a chain turns to the left (+1) or to the right (-1) from one run to the next. Where it turns back,
/// a spike with the inside (on the left) within it is a turn to the left.
double turn_between(const Run& run, const Run& next) {
  constexpr double kTurnsBack = 1e-6;  // sine: then curvature tells on which side the way back is
  const double sine = cross(run.end_way, next.start_way);
  if (dot(run.end_way, next.start_way) > 0.0 || std::abs(sine) > kTurnsBack) return sine >= 0.0 ? 1.0 : -1.0;
  const double ahead = std::min(run.reach, next.reach);
  // Directions from the corner to points that far off on both.
  const auto turned = [&](Point2 tangent, double curvature) {
    return direction_at(tangent, 0.0, curvature, ahead);
  };
  const Point2 out = turned(next.start_way, next.curvature());
  const Point2 back = turned(Point2{} - run.end_way, -run.curvature());
  return cross(out, back) >= 0.0 ? 1.0 : -1.0;
}

/// Adds the curve at the distance `by` to the right of a closed chain (left where below 0).
void add_parallel(EdgeSet& set, const std::vector<Run>& runs, double by, std::uint32_t& source) {
  const double weld = set.weld();
  set.begin(runs[0].from + by * runs[0].right_of_start());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run &run = runs[i], &next = runs[i + 1 < runs.size() ? i + 1 : 0];
    const Point2 begin = run.from + by * run.right_of_start(), end = run.to + by * run.right_of_end();
    const double radius = run.radius + run.turn * by;
    set.belongs_to(source++);
    if (run.is_arc() && radius > weld)
      set.arc_to(begin, end, run.circle_centre(), radius, run.turn);
    else
      set.line_to(end);
    const Point2 next_begin = next.from + by * next.right_of_start();
    set.belongs_to(source++);
    if (distance(end, next_begin) <= weld) continue;
    if (turn_between(run, next) * by > 0.0)
      set.arc_to(end, next_begin, run.to, std::abs(by), by > 0.0 ? 1.0 : -1.0);
    else
      set.line_to(next_begin);
  }
  set.close();
}

/// Whether a loop is certain to leave nothing: it shrinks, and is narrower than twice the distance.
bool shrinks_away(const Outline& loop, double by) {
  const auto narrow = [&](const Box2& box) {
    return std::min(box.high.x - box.low.x, box.high.y - box.low.y) < 2.0 * std::abs(by);
  };
  Box2 corners{loop.start, loop.start};
  for (const Segment& s : loop.segments) {
    corners.low = {std::min(corners.low.x, s.to.x), std::min(corners.low.y, s.to.y)};
    corners.high = {std::max(corners.high.x, s.to.x), std::max(corners.high.y, s.to.y)};
  }
  // Its corners alone may tell already that it is not narrow.
  return narrow(corners) && narrow(bounds(loop)) && (area(loop) > 0.0) == (by < 0.0);
}

bool usable_distance(double value, const char* what, const RegionOptions& options, Diagnostics& diagnostics) {
  if (std::abs(value) <= outline_detail::kLargestCoordinate) return true;
  diagnostics.error(Code::region_bad_argument, options.where,
                    fmt::format("{}{}the {} must be a number within 1e60 of 0, not {:g}", options.name,
                                options.name.empty() ? "" : ": ", what, value));
  return false;
}

// --------------------------------------------------------------------------------------------------------
// paths

/// What a path's half width sweeps: for each run its own strip, a sector at each outer corner, half circles
/// at round ends. All of them run counter-clockwise, so that winding numbers add up.
class Strips {
 public:
  enum class Side : std::uint8_t { none, left, right };
  Strips(EdgeSet& set, double width) : set_(set), width_(width) {}

  void run(const Run& run);
  void corner(const Run& run, const Run& next);
  void half_circle(Point2 centre, Point2 from);
  Side side_of(std::uint32_t source) const { return sides_[source]; }

 private:
  void side(Side side) {
    set_.belongs_to(static_cast<std::uint32_t>(sides_.size()));
    sides_.push_back(side);
  }
  void sector(Point2 centre, Point2 from, Point2 to, Side side);
  void ring(const Run& run, double outer, double inner);
  EdgeSet& set_;
  double width_;
  std::vector<Side> sides_;  // by source
};

/// The strip of an arc, between two circles; where it is narrower than the width, the middle of the circle
/// and what lies beyond it, too.
void Strips::ring(const Run& run, double outer, double inner) {
  const bool ccw = run.turn > 0.0;
  const Point2 a =
      ccw ? run.right_of_start() : Point2{} - run.right_of_end();  // outwards, at both ends of the
  const Point2 b = ccw ? run.right_of_end() : Point2{} - run.right_of_start();  // arc run counter-clockwise
  const Point2 c = run.circle_centre();
  set_.begin(c + outer * a);
  side(ccw ? Side::right : Side::left);
  set_.arc_to(c + outer * a, c + outer * b, c, outer, 1.0);
  const std::uint32_t seams = static_cast<std::uint32_t>(sides_.size());
  side(Side::none);
  if (inner > set_.weld()) {
    set_.line_to(c + inner * b);
    side(ccw ? Side::left : Side::right);
    set_.arc_to(c + inner * b, c + inner * a, c, inner, -1.0);
    set_.belongs_to(seams);
  } else {
    set_.line_to(c);
  }
  set_.close();
  if (inner >= -set_.weld()) return;
  side(Side::none);
  set_.begin(c);
  set_.line_to(c + inner * a);
  set_.arc_to(c + inner * a, c + inner * b, c, -inner, 1.0);
  set_.close();
}

void Strips::run(const Run& run) {
  if (run.is_arc()) return ring(run, run.radius + width_, run.radius - width_);
  const Point2 aside = width_ * run.right_of_start();
  set_.begin(run.from + aside);
  side(Side::right);
  set_.line_to(run.to + aside);
  const auto seams = static_cast<std::uint32_t>(sides_.size());
  side(Side::none);
  set_.line_to(run.to - aside);
  side(Side::left);
  set_.line_to(run.from - aside);
  set_.belongs_to(seams);
  set_.close();
}

void Strips::sector(Point2 centre, Point2 from, Point2 to, Side outer) {
  side(Side::none);
  set_.begin(centre);
  set_.line_to(from);
  const auto seams = static_cast<std::uint32_t>(sides_.size() - 1);
  side(outer);
  set_.arc_to(from, to, centre, width_, 1.0);
  set_.belongs_to(seams);
  set_.close();
}

void Strips::corner(const Run& run, const Run& next) {
  const Point2 before = width_ * run.right_of_end(), after = width_ * next.right_of_start();
  if (distance(before, after) <= set_.weld()) return;
  if (turn_between(run, next) > 0.0)
    sector(run.to, run.to + before, run.to + after, Side::right);
  else
    sector(run.to, run.to - after, run.to - before, Side::left);
}

void Strips::half_circle(Point2 centre, Point2 aside) {
  sector(centre, centre + width_ * aside, centre - width_ * aside, Side::none);
}

bool usable_path(const Outline& path, double width, std::string_view wanted, const RegionOptions& options,
                 Diagnostics& diagnostics) {
  if (!usable_distance(width, "distance from a path", options, diagnostics) ||
      !usable_options(options, diagnostics) ||
      !outline_detail::check_outline(path, options.name, options.where, diagnostics))
    return false;
  if (width > 0.0) return true;
  diagnostics.error(Code::region_bad_argument, options.where,
                    fmt::format("the distance from a path must {}", wanted));
  return false;
}

void lay(const Outline& path, PathEnds ends, Strips& strips) {
  const std::vector<Run> runs = runs_of(path);
  for (const Run& run : runs) strips.run(run);
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) strips.corner(runs[i], runs[i + 1]);
  if (runs.empty()) return;
  if (path.closed()) {
    strips.corner(runs.back(), runs.front());
  } else if (ends == PathEnds::round) {
    strips.half_circle(runs.back().to, runs.back().right_of_end());
    strips.half_circle(runs.front().from, Point2{} - runs.front().right_of_start());
  }
}

bool covered(const Winding& w) { return w.of[0] > 0; }

/// The stretches of a loop that `wanted` picks.
template <class Wanted>
void append_stretches(std::vector<Outline>& out, const Arrangement& arrangement, Arrangement::Loop loop,
                      Wanted wanted) {
  const std::size_t n = loop.size();
  std::size_t first = 0;  // where one begins
  while (first < n && !(wanted(loop[first]) && !wanted(loop[(first + n - 1) % n]))) ++first;
  if (first == n && !wanted(loop[0])) return;
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first % n), loop.end());
  for (std::size_t i = 0; i < n;) {
    std::size_t end = i;
    while (end < n && wanted(loop[end])) ++end;
    if (end > i) out.push_back(chain_of(arrangement, loop.data() + i, loop.data() + end));
    i = end + 1;
  }
}

}  // namespace

std::optional<Offset> offset(const Region& region, Length by, const RegionOptions& options,
                             Diagnostics& diagnostics) {
  const double distance = by.mm();
  if (!usable_distance(distance, "distance of an offset", options, diagnostics) ||
      !usable_loops(region.loops, options, diagnostics))
    return std::nullopt;
  double largest = std::abs(distance);
  for (const Outline& loop : region.loops) largest = std::max(largest, largest_coordinate(loop));
  EdgeSet set(weld_for(options, largest));
  std::vector<std::uint32_t> first_source;  // of each loop
  std::uint32_t source = 0;
  for (const Outline& loop : region.loops) {
    first_source.push_back(source);
    if (!shrinks_away(loop, distance)) add_parallel(set, runs_of(loop), distance, source);
  }
  const auto arrangement = arrange(set, options, diagnostics);
  if (!arrangement) return std::nullopt;
  const auto loops = arrangement->loops(covered);
  std::vector<bool> left(region.loops.size(), false);
  for (const Arrangement::Loop& loop : loops)
    for (const Arrangement::Way way : loop) {
      const std::uint32_t s = arrangement->edges()[arrangement->parts()[way.part].edge].source;
      left[static_cast<std::size_t>(std::upper_bound(first_source.begin(), first_source.end(), s) -
                                    first_source.begin()) -
           1] = true;
    }
  Offset made{region_of(*arrangement, loops, set.weld()), 0};
  made.vanished = static_cast<std::size_t>(std::count(left.begin(), left.end(), false));
  return made;
}

std::optional<Region> widen(const Outline& path, Length half_width, PathEnds ends,
                            const RegionOptions& options, Diagnostics& diagnostics) {
  const double width = half_width.mm();
  if (!usable_path(path, width, "be above 0", options, diagnostics)) return std::nullopt;
  EdgeSet set(weld_for(options, std::max(width, largest_coordinate(path))));
  Strips strips(set, width);
  lay(path, ends, strips);
  const auto arrangement = arrange(set, options, diagnostics);
  if (!arrangement) return std::nullopt;
  return region_of(*arrangement, arrangement->loops(covered), set.weld());
}

std::optional<std::vector<Outline>> parallel(const Outline& path, Length to_left,
                                             const RegionOptions& options, Diagnostics& diagnostics) {
  const double width = std::abs(to_left.mm());
  if (!usable_path(path, width, "not be 0", options, diagnostics)) return std::nullopt;
  EdgeSet set(weld_for(options, std::max(width, largest_coordinate(path))));
  Strips strips(set, width);
  lay(path, PathEnds::round, strips);
  const auto arrangement = arrange(set, options, diagnostics);
  if (!arrangement) return std::nullopt;
  const Strips::Side side = to_left.mm() > 0.0 ? Strips::Side::left : Strips::Side::right;
  std::vector<Outline> made;
  for (const Arrangement::Loop& loop : arrangement->loops(covered))
    append_stretches(made, *arrangement, loop, [&](Arrangement::Way way) {
      const Part& part = arrangement->parts()[way.part];
      return strips.side_of(arrangement->edges()[part.edge].source) == side;
    });
  // The boundary has the path on its left: on the path's left side it runs the other way.
  if (side == Strips::Side::left)
    for (Outline& outline : made) outline = reversed(outline);
  return made;
}

}  // namespace kerf

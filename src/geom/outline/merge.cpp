// Neighbouring segments along one line or circle as one segment.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "segment.h"

namespace kerf {
namespace {

using namespace outline_detail;

constexpr double kLargestSweep = 1.9 * std::numbers::pi;  // of one arc, whose ends must stay apart
/// Points checked again for each further segment: bounds the time where many segments become one.
constexpr std::size_t kMaxPassed = 2000;

/// A segment that replaces several.
struct Merged {
  Point2 from;
  Segment segment;
  std::vector<Point2> passed;  // ends and points of the arcs that it replaces
};

bool passes(Point2 from, const Segment& segment, const std::vector<Point2>& points, double within) {
  const Carrier carrier = make_carrier(from, segment, 0.0);
  return std::all_of(points.begin(), points.end(),
                     [&](Point2 p) { return distance_to(carrier, p) <= within; });
}

/// Whether two segments may be one: in one direction, of one circle, and together not nearly a whole one.
bool continues(const Carrier& first, const Carrier& second, double within) {
  if (first.turn != second.turn || dot(end_direction(first), start_direction(second)) <= 0.0) return false;
  if (!first.is_arc()) return dot(second.to - first.from, first.chord()) > 0.0;
  return std::abs(first.radius - second.radius) <= within &&
         norm(first.circle_centre() - second.circle_centre()) <= 2.0 * within &&
         sweep_to(first, first.to) + sweep_to(second, second.to) <= kLargestSweep;
}

/// Adds what follows; false where both are not one segment.
bool add(Merged& made, const Merged& next, double within) {
  if (made.passed.size() + next.passed.size() > kMaxPassed) return false;
  const Carrier first = make_carrier(made.from, made.segment, 0.0);
  if (!continues(first, make_carrier(next.from, next.segment, 0.0), within)) return false;
  Segment segment{next.segment.to};
  std::vector<Point2> passed = made.passed;
  passed.push_back(next.from);
  passed.insert(passed.end(), next.passed.begin(), next.passed.end());
  if (first.is_arc()) {
    for (const Merged* part : {&std::as_const(made), &next})
      if (part->segment.via) passed.push_back(*part->segment.via);
    segment.via = next.from;
    const Carrier arc = make_carrier(made.from, segment, 0.0);
    if (!arc.is_arc()) return false;
    segment.via = arc_midpoint(made.from, segment.to, arc.circle_centre(), arc.radius, arc.turn);
  }
  if (!passes(made.from, segment, passed, within)) return false;
  made.segment = segment;
  made.passed = std::move(passed);
  return true;
}

}  // namespace

Outline merged(const Outline& outline, Length within) {
  const double distance = within.mm();
  std::vector<Merged> runs;
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    Merged next{outline.point(i), outline.segments[i], {}};
    if (next.segment.to == next.from) continue;
    if (runs.empty() || !add(runs.back(), next, distance)) runs.push_back(std::move(next));
  }
  Outline made{outline.start};
  if (outline.closed() && runs.size() > 2 && add(runs.back(), runs.front(), distance)) {
    runs.erase(runs.begin());
    made.start = runs.front().from;
  }
  for (const Merged& run : runs) made.segments.push_back(run.segment);
  return made;
}

}  // namespace kerf

// Arrangements from chains, and outlines from arrangements.
#include "resolve.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"

#include "kerf/base/limits.h"

namespace kerf::region_detail {
namespace {

/// Points computed from coordinates of size 1 have errors of some 2^-50, intersections at small angles larger
/// ones.
constexpr double kRounding = 0x1p-40;
/// The smallest tolerance of an attempt, by the largest coordinate.
constexpr double kFinest = 0x1p-45;

/// After a contradiction: more rounds, then smaller tolerances, then larger ones.
struct Attempt {
  double factor;  // of the tolerance
  Arrangement::Care care;
};
constexpr Attempt kAttempts[] = {
    {1.0, Arrangement::Care::ordinary},    {1.0, Arrangement::Care::thorough},
    {0x1p-6, Arrangement::Care::thorough}, {0x1p-12, Arrangement::Care::thorough},
    {4.0, Arrangement::Care::thorough},    {16.0, Arrangement::Care::thorough}};

double largest_coordinate(const std::vector<Point2>& points) {
  double largest = 0.0;
  for (const Point2 p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  return largest;
}

const char* named(const RegionOptions& options) {
  return options.name.empty() ? "region" : options.name.c_str();
}

/// Whether the loop changes from one source to another, or turns back on one.
bool starts_run(const Arrangement& a, Arrangement::Link before, Arrangement::Link link) {
  const Edge &e = a.edges()[a.parts()[before.part].edge], &f = a.edges()[a.parts()[link.part].edge];
  return e.source != f.source || e.turn != f.turn || before.forward != link.forward;
}

/// A point of the arc that a run of parts follows; its midpoint if no point was displaced.
Point2 via_of(const Arrangement& arrangement, Point2 from, Point2 to, const Arrangement::Link* first,
              const Arrangement::Link* last) {
  constexpr double kShortArc =
      1.5;  // chord by radius: below, the chord and the radius determine the arc best
  const auto part = [&](const Arrangement::Link* link) { return arrangement.parts()[link->part]; };
  const Edge& e = arrangement.edges()[part(first).edge];
  const double turn = first->forward ? e.turn : -e.turn;
  if (!arrangement.displaced())
    return outline_detail::arc_midpoint(from, to, e.circle_centre(), e.radius, turn);
  const Point2 chord = to - from;
  const double length = norm(chord);
  double sum = 0.0;  // of the chords
  for (const Arrangement::Link* link = first; link != last; ++link)
    sum += distance(arrangement.point(part(link).from), arrangement.point(part(link).to));
  if (sum < kShortArc * e.radius) {
    const double half = std::min(0.5 * length, e.radius);
    const double height = half * half / (e.radius + std::sqrt(e.radius * e.radius - half * half));
    return from + 0.5 * chord - (turn * height / length) * left_of(chord);
  }
  const Arrangement::Link* half = first;
  for (double before = 0.0; half + 1 != last; ++half) {
    before += distance(arrangement.point(part(half).from), arrangement.point(part(half).to));
    if (before >= 0.5 * sum) break;
  }
  return arrangement.point_on(part(half), 0.5);
}

/// Appends parts along one source as a segment, or as several where points were displaced too far.
void append_run(Outline& outline, std::vector<std::uint32_t>& sources, const Arrangement& arrangement,
                const Arrangement::Link* first, const Arrangement::Link* last) {
  constexpr double kFlat = 4.0 * outline_detail::kFlatArc;  // chord by radius of what readers take for a line
  const auto end_of = [&](const Arrangement::Link* link) {
    const Part& part = arrangement.parts()[link->part];
    return arrangement.point(link->forward ? part.to : part.from);
  };
  const auto in_two = [&](const Arrangement::Link* between) {
    append_run(outline, sources, arrangement, first, between);
    append_run(outline, sources, arrangement, between, last);
  };
  const Point2 from = outline.point(outline.segments.size());
  Segment segment;
  segment.to = end_of(last - 1);
  if (segment.to == from && last - first > 1) return in_two(first + (last - first) / 2);  // a whole circle
  const Edge& e = arrangement.edges()[arrangement.parts()[first->part].edge];
  if (e.is_arc() && (last - first > 1 || distance(from, segment.to) > kFlat * e.radius))
    segment.via = via_of(arrangement, from, segment.to, first, last);
  if (arrangement.displaced() && last - first > 1) {
    const auto carrier = outline_detail::make_carrier(from, segment, 0.0);
    const Arrangement::Link* worst = nullptr;
    double off = arrangement.slack();
    for (const Arrangement::Link* link = first; link + 1 != last; ++link)
      if (const double own = distance_to(carrier, end_of(link)); own > off) {
        off = own;
        worst = link;
      }
    if (worst != nullptr) return in_two(worst + 1);
  }
  outline.segments.push_back(segment);
  sources.push_back(e.source);
}

struct LoopExtent {
  double twice_area = 0.0, length = 0.0;
  double error = 0.0;  // of twice_area, at most; 0 if it is exact
};

/// The length of a loop to a hundredth, and its area: exact, or from the chords and heights of its arcs.
LoopExtent extent_of(const Arrangement& arrangement, const Arrangement::Loop& loop, bool exact) {
  constexpr double kError = 2e-3;  // relative, of the area between an arc of a quarter turn and its chord
  const Point2 origin = arrangement.point(arrangement.parts()[loop[0].part].from);
  LoopExtent extent;
  for (const Arrangement::Link link : loop) {
    const Part& part = arrangement.parts()[link.part];
    const Edge& e = arrangement.edges()[part.edge];
    const Point2 a = arrangement.point(part.from) - origin, b = arrangement.point(part.to) - origin;
    const double chord = norm(b - a);
    double beside = cross(a, b);
    extent.length += chord;
    if (e.is_arc()) {
      const double half = std::min(0.5 * chord, e.radius);
      const double height = half * half / (e.radius + std::sqrt(e.radius * e.radius - half * half));
      const double bulge = exact ? 2.0 * segment_area(e.radius, 2.0 * std::asin(half / e.radius))
                                 : height * (4.0 / 3.0 * chord + height * height / chord);
      beside += e.turn * bulge;
      if (!exact) extent.error += kError * bulge;
      extent.length += 8.0 / 3.0 * height * height / chord;
    }
    extent.twice_area += link.forward ? beside : -beside;
  }
  return extent;
}

/// Whether the mean width of a loop is at most the tolerance.
bool is_sliver(const Arrangement& arrangement, const Arrangement::Loop& loop, double weld) {
  LoopExtent extent = extent_of(arrangement, loop, false);
  if (std::abs(extent.twice_area) > extent.error + weld * extent.length) return false;
  if (extent.error > 0.0) extent = extent_of(arrangement, loop, true);
  return std::abs(extent.twice_area) <= weld * extent.length;
}

void append_loop(Traced& made, const Arrangement& arrangement, Arrangement::Loop loop) {
  const std::size_t n = loop.size();
  std::size_t first = 0;
  while (first < n && !starts_run(arrangement, loop[(first + n - 1) % n], loop[first])) ++first;
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first % n), loop.end());
  Outline outline;
  const Part& start = arrangement.parts()[loop[0].part];
  outline.start = arrangement.point(loop[0].forward ? start.from : start.to);
  std::vector<std::uint32_t> sources;
  const Arrangement::Link *at = loop.data(), *const end = at + n;
  while (at != end) {
    const Arrangement::Link* next = at + 1;
    while (next != end && !starts_run(arrangement, *(next - 1), *next)) ++next;
    append_run(outline, sources, arrangement, at, next);
    at = next;
  }
  made.region.loops.push_back(std::move(outline));
  made.sources.push_back(std::move(sources));
}

}  // namespace

double weld_for(const RegionOptions& options, double largest) {
  return std::max(options.tolerance.weld.mm(), kRounding * largest);
}

double largest_coordinate(const Outline& outline) {
  double largest = 0.0;
  const auto add = [&](Point2 p) { largest = std::max({largest, std::abs(p.x), std::abs(p.y)}); };
  add(outline.start);
  for (const Segment& s : outline.segments) {
    add(s.to);
    if (s.via) add(*s.via);
  }
  return largest;
}

bool usable_options(const RegionOptions& options, Diagnostics& diagnostics) {
  const double weld = options.tolerance.weld.mm();
  if (weld >= 0.0 && weld <= outline_detail::kLargestCoordinate) return true;
  diagnostics.error(codes::region_bad_argument, options.where,
                    fmt::format("{}: the tolerance must be from 0 to 1e60, not {:g}", named(options), weld));
  return false;
}

bool nearly_closed(const Outline& outline, double weld) {
  return !outline.segments.empty() && distance(outline.segments.back().to, outline.start) <= weld;
}

bool usable_loops(const std::vector<Outline>& outlines, const RegionOptions& options,
                  Diagnostics& diagnostics) {
  if (!usable_options(options, diagnostics)) return false;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const std::string name = fmt::format("{}.{}", named(options), i);
    if (!outline_detail::check_outline(outlines[i], name, options.where, diagnostics)) return false;
    if (nearly_closed(outlines[i], weld_for(options, largest_coordinate(outlines[i])))) continue;
    diagnostics
        .error(codes::region_open_outline, options.where,
               fmt::format("outline \"{}\" is not closed, so that it has no inside", name))
        .hint = "its last point has to be its first, up to the tolerance";
    return false;
  }
  return true;
}

Arrangement* Attempts::next() {
  double finest = attempt_ == 0 ? 0.0 : kFinest * largest_coordinate(set_.points);
  while (attempt_ < std::size(kAttempts)) {
    const Attempt attempt = kAttempts[attempt_++];
    const double weld = attempt.factor * set_.weld();
    if (weld < finest) continue;
    if (set_.edges.size() > limits::kMaxRegionEdges) {
      outcome_ = Arrangement::Outcome::too_many;
      return nullptr;
    }
    outcome_ =
        arrangement_.build(set_, weld, attempt.care, effort_.for_edges(set_.edges.size()), options_.progress);
    if (outcome_ == Arrangement::Outcome::done) return &arrangement_;
    if (outcome_ != Arrangement::Outcome::contradiction) return nullptr;
    finest = kFinest * largest_coordinate(set_.points);
  }
  outcome_ = Arrangement::Outcome::contradiction;
  return nullptr;
}

void Attempts::fail(Diagnostics& diagnostics) const {
  if (outcome_ == Arrangement::Outcome::stopped) return;
  if (outcome_ == Arrangement::Outcome::too_many)
    diagnostics
        .error(codes::region_too_complex, options_.where,
               fmt::format("{}: the outlines meet in too many positions", named(options_)))
        .hint = "outlines of short chords take less when arcs are fitted to them first";
  else
    diagnostics
        .error(codes::region_unresolved, options_.where,
               fmt::format("{}: the inside could not be computed without contradiction", named(options_)))
        .hint = "another tolerance may help";
}

Traced traced(const Outlined& outlined, double weld) {
  Traced made;
  for (const Arrangement::Loop& loop : outlined.loops)
    if (loop.size() > 1 && !is_sliver(outlined.arrangement, loop, weld))
      append_loop(made, outlined.arrangement, loop);
  return made;
}

Region region_of(const Outlined& outlined, double weld) { return traced(outlined, weld).region; }

void add_traced(EdgeSet& set, const Traced& traced, std::uint32_t group) {
  for (std::size_t i = 0; i < traced.region.loops.size(); ++i) {
    add_outline(set, traced.region.loops[i], traced.sources[i], group);
    set.close();
  }
}

}  // namespace kerf::region_detail

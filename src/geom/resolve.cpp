// Arrangements from chains, and outlines from arrangements.
#include "resolve.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "outline_check.h"

namespace kerf::region_detail {
namespace {

/// Points computed from coordinates of size 1 are off by some 2^-50; crossings at small angles by more.
constexpr double kRounding = 0x1p-40;
constexpr std::size_t kMostEdges = 12'000'000;  // about five gigabytes of work
/// Finer than this (of the largest coordinate) no attempt is made.
constexpr double kFinest = 0x1p-45;

/// A contradiction is met with more care, then with finer tolerances, then with coarser ones.
struct Attempt {
  double share;  // of the tolerance
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

/// Where the loop goes over from one source to another, or back on the same.
bool starts_run(const Arrangement& a, Arrangement::Way before, Arrangement::Way way) {
  const Edge &e = a.edges()[a.parts()[before.part].edge], &f = a.edges()[a.parts()[way.part].edge];
  return e.source != f.source || e.turn != f.turn || before.forward != way.forward;
}

/// A run of ways along one source, as a segment.
void append_run(Outline& outline, const Arrangement& arrangement, const Arrangement::Way* begin,
                const Arrangement::Way* end) {
  constexpr double kFlat = 4.0 * outline_detail::kFlatArc;  // chord by radius of what readers take for a line
  const auto& parts = arrangement.parts();
  const Arrangement::Way last = *(end - 1);
  const Point2 from = outline.point(outline.segments.size());
  Segment segment;
  segment.to = arrangement.point(last.forward ? parts[last.part].to : parts[last.part].from);
  if (segment.to == from && end - begin > 1) {  // a whole circle
    const std::ptrdiff_t half = (end - begin) / 2;
    append_run(outline, arrangement, begin, begin + half);
    return append_run(outline, arrangement, begin + half, end);
  }
  const Edge& e = arrangement.edges()[parts[begin->part].edge];
  if (e.is_arc() && (end - begin > 1 || distance(from, segment.to) > kFlat * e.radius))
    segment.via = outline_detail::arc_middle(from, segment.to, e.circle_centre(), e.radius,
                                             begin->forward ? e.turn : -e.turn);
  outline.segments.push_back(segment);
}

/// Whether a loop is narrower than the tolerance everywhere. Its area and length are taken from the chords
/// and heights of its arcs (at most quarter turns), to a hundredth.
bool is_sliver(const Arrangement& arrangement, const Arrangement::Loop& loop, double weld) {
  const Part& first = arrangement.parts()[loop[0].part];
  const Point2 origin = arrangement.point(first.from);
  double twice_area = 0.0, length = 0.0;
  for (const Arrangement::Way way : loop) {
    const Part& part = arrangement.parts()[way.part];
    const Edge& e = arrangement.edges()[part.edge];
    const Point2 a = arrangement.point(part.from) - origin, b = arrangement.point(part.to) - origin;
    const double chord = norm(b - a);
    double beside = cross(a, b);
    length += chord;
    if (e.is_arc()) {
      const double half = std::min(0.5 * chord, e.radius);
      const double height = half * half / (e.radius + std::sqrt(e.radius * e.radius - half * half));
      beside += e.turn * height * (4.0 / 3.0 * chord + height * height / chord);
      length += 8.0 / 3.0 * height * height / chord;
    }
    twice_area += way.forward ? beside : -beside;
  }
  return std::abs(twice_area) <= weld * length;
}

Outline outline_of(const Arrangement& arrangement, Arrangement::Loop loop) {
  const std::size_t n = loop.size();
  std::size_t first = 0;
  while (first < n && !starts_run(arrangement, loop[(first + n - 1) % n], loop[first])) ++first;
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first % n), loop.end());
  return chain_of(arrangement, loop.data(), loop.data() + n);
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
  diagnostics.error(Code::region_bad_argument, options.where,
                    fmt::format("{}: the tolerance must be from 0 to 1e60, not {:g}", named(options), weld));
  return false;
}

bool usable_loops(const std::vector<Outline>& outlines, const RegionOptions& options,
                  Diagnostics& diagnostics) {
  if (!usable_options(options, diagnostics)) return false;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const std::string name = fmt::format("{}.{}", named(options), i);
    if (!outline_detail::check_outline(outlines[i], name, options.where, diagnostics)) return false;
    if (outlines[i].closed()) continue;
    diagnostics
        .error(Code::region_open_outline, options.where,
               fmt::format("outline \"{}\" is not closed, so that it has no inside", name))
        .hint = "its last point has to be exactly its first";
    return false;
  }
  return true;
}

std::optional<Arrangement> arrange(const EdgeSet& set, const RegionOptions& options,
                                   Diagnostics& diagnostics) {
  std::optional<Arrangement> made(std::in_place);
  auto outcome = Arrangement::Outcome::too_many;
  double finest = 0.0;  // worked out where it is needed
  for (const Attempt attempt : kAttempts) {
    const double weld = attempt.share * set.weld();
    if (set.edges.size() > kMostEdges || weld < finest) continue;
    outcome = made->build(set, weld, attempt.care);
    if (outcome != Arrangement::Outcome::contradiction) break;
    finest = kFinest * largest_coordinate(set.points);
  }
  if (outcome == Arrangement::Outcome::done) return made;
  if (outcome == Arrangement::Outcome::too_many)
    diagnostics
        .error(Code::region_too_complex, options.where,
               fmt::format("{}: the outlines meet in too many places", named(options)))
        .hint = "outlines of short chords take less when arcs are fitted to them first";
  else
    diagnostics
        .error(
            Code::region_unresolved, options.where,
            fmt::format("{}: what is inside could not be worked out without contradiction", named(options)))
        .hint = "another tolerance may help";
  return std::nullopt;
}

Outline chain_of(const Arrangement& arrangement, const Arrangement::Way* begin, const Arrangement::Way* end) {
  Outline outline;
  const Part& first = arrangement.parts()[begin->part];
  outline.start = arrangement.point(begin->forward ? first.from : first.to);
  while (begin != end) {
    const Arrangement::Way* next = begin + 1;
    while (next != end && !starts_run(arrangement, *(next - 1), *next)) ++next;
    append_run(outline, arrangement, begin, next);
    begin = next;
  }
  return outline;
}

Region region_of(const Arrangement& arrangement, const std::vector<Arrangement::Loop>& loops, double weld) {
  Region region;
  for (const Arrangement::Loop& loop : loops)
    if (loop.size() > 1 && !is_sliver(arrangement, loop, weld))
      region.loops.push_back(outline_of(arrangement, loop));
  return region;
}

}  // namespace kerf::region_detail

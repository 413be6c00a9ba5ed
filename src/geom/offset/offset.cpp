// Offset. The offset curve of each loop is made with all its self-intersections, so that its winding numbers
// are known (docs/decisions/0024-offsets.md has the proof):
//   - the curve of a growing loop winds at least once around the points within the distance, and around no
//     others;
//   - the curve of a shrinking loop winds at most once around what is left of it, and around nothing else,
//     unless the whole loop fits into a circle of the distance, which its bounds show beforehand;
//   - the curve around inner corners, and of arcs whose radius becomes negative, may be any path that keeps
//     the signs of these numbers: a straight line does.
// If that curve has too many intersections, the band around the boundary is united from pieces, and added to
// the region or subtracted from it.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"
#include "strips.h"

namespace kerf {
namespace {

using namespace region_detail;

bool covered(const Winding& w) { return w.of[0] > 0; }

/// One offset: the loops as runs, numbered by the segments of all loops.
class Offsetter {
 public:
  Offsetter(const Region& region, double by, const JoinOptions& joins, const RegionOptions& options,
            double weld, Diagnostics& diagnostics);
  std::optional<Offset> run();

 private:
  struct Loop {
    std::vector<Run> runs;
    bool shrinks_away = false;
  };
  std::optional<Traced> divided();
  std::optional<Traced> band_of_loops(std::size_t first, std::size_t last);
  void add_parallel(EdgeSet& set, const std::vector<Run>& runs) const;
  Offset finished(Traced traced) const;

  const Region& region_;
  double by_;
  Corner corner_;
  const RegionOptions& options_;
  double weld_;
  Diagnostics& diagnostics_;
  std::vector<Loop> loops_;
  std::vector<std::uint32_t> first_segment_;  // of each loop, and the count of all
};

/// Whether a loop certainly vanishes: it shrinks, and is narrower than twice the distance.
bool shrinks_away(const Outline& loop, double by) {
  const auto narrow = [&](const Box2& box) {
    return std::min(box.high.x - box.low.x, box.high.y - box.low.y) < 2.0 * std::abs(by);
  };
  Box2 corners{loop.start, loop.start};
  for (const Segment& s : loop.segments) {
    corners.low = {std::min(corners.low.x, s.to.x), std::min(corners.low.y, s.to.y)};
    corners.high = {std::max(corners.high.x, s.to.x), std::max(corners.high.y, s.to.y)};
  }
  // Its corners alone may show already that it is not narrow.
  return narrow(corners) && narrow(bounds(loop)) && (area(loop) > 0.0) == (by < 0.0);
}

Offsetter::Offsetter(const Region& region, double by, const JoinOptions& joins, const RegionOptions& options,
                     double weld, Diagnostics& diagnostics)
    : region_(region),
      by_(by),
      corner_{joins.join, joins.mitre_limit},
      options_(options),
      weld_(weld),
      diagnostics_(diagnostics) {
  std::uint32_t count = 0;
  for (const Outline& loop : region.loops) {
    first_segment_.push_back(count);
    Loop made{runs_of(loop), shrinks_away(loop, by)};
    for (Run& run : made.runs) run.number += count;
    loops_.push_back(std::move(made));
    count += static_cast<std::uint32_t>(loop.segments.size());
  }
  first_segment_.push_back(count);
}

/// Adds the curve at the distance to the right of a closed chain (left where below 0).
void Offsetter::add_parallel(EdgeSet& set, const std::vector<Run>& runs) const {
  const double sign = by_ > 0.0 ? 1.0 : -1.0;
  const Beside side = by_ > 0.0 ? Beside::right : Beside::left;
  const Beside corner = by_ > 0.0 ? Beside::right_corner : Beside::left_corner;
  set.start_chain(runs[0].from + by_ * runs[0].right_of_start());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run &run = runs[i], &next = runs[i + 1 < runs.size() ? i + 1 : 0];
    const Point2 start = run.from + by_ * run.right_of_start(), end = run.to + by_ * run.right_of_end();
    const double radius = run.radius + run.turn * by_;
    set.belongs_to(source_of(run, side));
    if (run.is_arc() && radius > weld_)
      set.arc_to(start, end, run.circle_centre(), radius, run.turn);
    else
      set.line_to(end);
    const Point2 next_start = next.from + by_ * next.right_of_start();
    set.belongs_to(source_of(run, corner));
    if (norm(next_start - end) <= weld_) continue;
    if (turn_between(run, next) * by_ > 0.0)
      add_corner(set, run.to, std::abs(by_), sign * run.right_of_end(), sign * next.right_of_start(), sign,
                 corner_, corner_sources(run, next, side, corner));
    else
      set.line_to(next_start);
  }
  set.close();
}

/// The union of the bands around some loops.
std::optional<Traced> Offsetter::band_of_loops(std::size_t first, std::size_t last) {
  if (last - first > 1) {
    const std::size_t between = first + (last - first) / 2;
    const auto one = band_of_loops(first, between);
    if (!one) return std::nullopt;
    const auto other = band_of_loops(between, last);
    if (!other) return std::nullopt;
    return unite(*one, *other, options_, weld_, diagnostics_);
  }
  Chain chain;
  chain.runs = loops_[first].runs;
  chain.closed = true;
  (by_ > 0.0 ? chain.right : chain.left) = corner_;
  return band_of(chain, std::abs(by_), options_, weld_, diagnostics_);
}

std::optional<Traced> Offsetter::divided() {
  const auto band = band_of_loops(0, loops_.size());
  if (!band) return std::nullopt;
  EdgeSet set(weld_);
  for (const Outline& loop : region_.loops) {
    add_outline(set, loop, 0, 0);
    set.close();
  }
  add_traced(set, *band, 1);
  const auto outlined = arrange(set, options_, diagnostics_, [&](const Winding& w) {
    return by_ > 0.0 ? w.of[0] > 0 || w.of[1] > 0 : w.of[0] > 0 && w.of[1] <= 0;
  });
  if (!outlined) return std::nullopt;
  return traced(*outlined, weld_);
}

Offset Offsetter::finished(Traced traced) const {
  Offset made;
  std::vector<bool> left(loops_.size(), false);
  for (const std::vector<std::uint32_t>& loop : traced.sources) {
    std::vector<BoundaryElement>& sources = made.sources.emplace_back();
    sources.reserve(loop.size());
    for (const std::uint32_t source : loop) {
      const std::uint32_t number = run_of_source(source);
      const auto after = std::upper_bound(first_segment_.begin(), first_segment_.end() - 1, number);
      const auto owner = static_cast<std::uint32_t>(after - first_segment_.begin()) - 1;
      left[owner] = true;
      sources.push_back({owner, number - first_segment_[owner], is_corner(source)});
    }
  }
  made.region = std::move(traced.region);
  made.vanished = static_cast<std::size_t>(std::count(left.begin(), left.end(), false));
  return made;
}

std::optional<Offset> Offsetter::run() {
  EdgeSet set(weld_);
  for (const Loop& loop : loops_)
    if (!loop.shrinks_away && !loop.runs.empty()) add_parallel(set, loop.runs);
  Attempts attempts(set, options_, kModerate);
  if (const auto outlined = attempt(attempts, covered)) return finished(traced(*outlined, weld_));
  if (!attempts.exceeded()) return attempts.fail(diagnostics_), std::nullopt;
  set = EdgeSet(weld_);
  auto made = divided();
  if (!made) return std::nullopt;
  return finished(std::move(*made));
}

bool usable_joins(const JoinOptions& joins, const RegionOptions& options, Diagnostics& diagnostics) {
  if (joins.join == Join::round ||
      (joins.mitre_limit >= 1.0 && joins.mitre_limit <= outline_detail::kLargestCoordinate))
    return true;
  diagnostics.error(
      codes::region_bad_argument, options.where,
      fmt::format("the limit of mitred corners must be at least 1, not {:g}", joins.mitre_limit));
  return false;
}

}  // namespace

namespace region_detail {

bool usable_distance(double value, const char* what, const RegionOptions& options, Diagnostics& diagnostics) {
  if (std::abs(value) <= outline_detail::kLargestCoordinate) return true;
  diagnostics.error(codes::region_bad_argument, options.where,
                    fmt::format("{}{}the {} must be a number within 1e60 of 0, not {:g}", options.name,
                                options.name.empty() ? "" : ": ", what, value));
  return false;
}

}  // namespace region_detail

std::optional<Offset> offset(const Region& region, Length by, const JoinOptions& joins,
                             const RegionOptions& options, Diagnostics& diagnostics) {
  const double distance = by.mm();
  if (!usable_distance(distance, "distance of an offset", options, diagnostics) ||
      !usable_joins(joins, options, diagnostics) || !usable_loops(region.loops, options, diagnostics))
    return std::nullopt;
  double largest = std::abs(distance);
  for (const Outline& loop : region.loops) largest = std::max(largest, largest_coordinate(loop));
  return Offsetter(region, distance, joins, options, weld_for(options, largest), diagnostics).run();
}

std::optional<Offset> offset(const Region& region, Length by, const RegionOptions& options,
                             Diagnostics& diagnostics) {
  return offset(region, by, JoinOptions{}, options, diagnostics);
}

}  // namespace kerf

// From a region's boundary to chords: arcs are flattened, the chords resolved to a region again, so that they
// keep apart by more than the grid's steps, and then rounded to the grid.
#include "boundary_chords.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"
#include "geom/region/resolve.h"

#include "kerf/base/limits.h"

namespace kerf::medial_detail {
namespace {

using namespace region_detail;

constexpr double kSteps = 0x1p28;      // of the grid, from its origin to the furthest coordinate
constexpr double kFewestSteps = 16.0;  // between points that are not one
constexpr double kCoarser = 64.0;      // the distance of the next attempt
constexpr int kAttempts = 3;

class ChordMaker {
 public:
  ChordMaker(const Region& region, const MedialOptions& options, Diagnostics& diagnostics);
  std::optional<BoundaryChords> run();

 private:
  bool flatten(EdgeSet& set);
  void add_source(std::uint32_t loop, std::uint32_t segment, std::uint32_t first);
  bool resolve(const EdgeSet& set);
  void add_loop(const Outline& loop, const std::vector<std::uint32_t>& sources);

  const Region& region_;
  const MedialOptions& options_;
  Diagnostics& diagnostics_;
  double half_size_ = 0.0;  // of the region's bounds
  double weld_ = 0.0;
  std::vector<std::uint32_t> segment_of_;  // by number of a chord before it is resolved
  BoundaryChords made_;
};

ChordMaker::ChordMaker(const Region& region, const MedialOptions& options, Diagnostics& diagnostics)
    : region_(region), options_(options), diagnostics_(diagnostics) {
  const Box2 box = bounds(region);
  double largest = 0.0;
  for (const Outline& loop : region.loops) largest = std::max(largest, largest_coordinate(loop));
  made_.origin = 0.5 * (box.low + box.high);
  half_size_ = 0.5 * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  made_.unit = half_size_ / kSteps;
  weld_ = std::max(weld_for(options.region, largest), kFewestSteps * made_.unit);
}

void ChordMaker::add_source(std::uint32_t loop, std::uint32_t segment, std::uint32_t first) {
  const Outline& outline = region_.loops[loop];
  const auto carrier = [&](std::uint32_t i) {
    return outline_detail::make_carrier(outline.point(i), outline.segments[i], 0.0);
  };
  const auto count = static_cast<std::uint32_t>(outline.segments.size());
  const std::uint32_t after = segment + 1 < count ? segment + 1 : 0;
  const Point2 end = end_direction(carrier(segment)), start = start_direction(carrier(after));
  const double turned = std::abs(std::atan2(cross(end, start), dot(end, start)));
  made_.sources.push_back(
      {loop, segment, 0.0, turned < options_.smooth.rad(), first + after, outline.segments[segment].to});
}

bool ChordMaker::flatten(EdgeSet& set) {
  const Length chord = options_.region.tolerance.chord;
  for (std::uint32_t i = 0; i < region_.loops.size(); ++i) {
    const Outline& loop = region_.loops[i];
    const auto first = static_cast<std::uint32_t>(made_.sources.size());
    set.start_chain(loop.start);
    for (std::uint32_t k = 0; k < loop.segments.size(); ++k) {
      add_source(i, k, first);
      const Outline alone{loop.point(k), {loop.segments[k]}};
      const std::vector<Point2> points = flattened(alone, chord);
      if (const auto arc = arc_circle(alone.start, loop.segments[k]))
        made_.sources.back().step = arc->sweep.rad() / static_cast<double>(points.size() - 1);
      for (std::size_t p = 1; p < points.size(); ++p) {
        set.belongs_to(static_cast<std::uint32_t>(segment_of_.size()));
        set.line_to(points[p]);
        segment_of_.push_back(static_cast<std::uint32_t>(made_.sources.size() - 1));
      }
      if (segment_of_.size() > limits::kMaxMedialChords) {
        diagnostics_
            .error(codes::region_too_complex, options_.region.where,
                   fmt::format("the medial axis of more than {} chords", limits::kMaxMedialChords))
            .hint = "a larger chord tolerance makes fewer chords of arcs";
        return false;
      }
    }
    set.close();
  }
  return true;
}

void ChordMaker::add_loop(const Outline& loop, const std::vector<std::uint32_t>& sources) {
  const auto on_grid = [&](Point2 p) {
    const Point2 q = (1.0 / made_.unit) * (p - made_.origin);
    return GridPoint{static_cast<std::int32_t>(std::lround(q.x)),
                     static_cast<std::int32_t>(std::lround(q.y))};
  };
  const auto first = static_cast<std::uint32_t>(made_.chords.size());
  for (std::size_t i = 0; i < loop.segments.size(); ++i) {
    const GridChord chord{on_grid(loop.point(i)), on_grid(loop.segments[i].to)};
    if (chord.from == chord.to) continue;
    const auto number = static_cast<std::uint32_t>(made_.chords.size());
    made_.chords.push_back(chord);
    made_.segments.push_back(segment_of_[sources[i]]);
    made_.next.push_back(number + 1);
    made_.previous.push_back(number - 1);
  }
  if (made_.chords.size() == first) return;
  made_.next.back() = first;
  made_.previous[first] = static_cast<std::uint32_t>(made_.chords.size()) - 1;
}

bool ChordMaker::resolve(const EdgeSet& set) {
  const auto outlined =
      arrange(set, options_.region, diagnostics_, [](const Winding& w) { return w.of[0] > 0; });
  if (!outlined) return false;
  const Traced loops = traced(*outlined, set.weld());
  for (std::size_t i = 0; i < loops.region.loops.size(); ++i)
    add_loop(loops.region.loops[i], loops.sources[i]);
  return true;
}

std::optional<BoundaryChords> ChordMaker::run() {
  if (!(half_size_ > 0.0)) return made_;
  for (int attempt = 0; attempt < kAttempts; ++attempt, weld_ *= kCoarser) {
    EdgeSet set(weld_);
    segment_of_.clear();
    made_.sources.clear();
    if (!flatten(set) || !resolve(set)) return std::nullopt;
    if (are_separate(made_.chords)) return std::move(made_);
    made_.chords.clear();
    made_.segments.clear();
    made_.next.clear();
    made_.previous.clear();
  }
  diagnostics_.error(codes::region_unresolved, options_.region.where,
                     "the boundary of the medial axis could not be separated into chords");
  return std::nullopt;
}

}  // namespace

std::optional<BoundaryChords> boundary_chords(const Region& region, const MedialOptions& options,
                                              Diagnostics& diagnostics) {
  if (!usable_loops(region.loops, options.region, diagnostics)) return std::nullopt;
  const double chord = options.region.tolerance.chord.mm();
  if (!(chord > 0.0) || !(options.smooth.rad() >= 0.0)) {
    diagnostics.error(codes::region_bad_argument, options.region.where,
                      fmt::format("the chord tolerance of a medial axis must be above 0, not {:g}", chord));
    return std::nullopt;
  }
  if (region.empty()) return BoundaryChords{};
  return ChordMaker(region, options, diagnostics).run();
}

}  // namespace kerf::medial_detail

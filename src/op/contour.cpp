// Contours: along the boundary of the region that the axis may be in or may not be in, and along given paths.
#include "kerf/op/contour.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "op/cutter.h"
#include "op/reach.h"

namespace kerf {
namespace {

using namespace op_detail;

/// A closed path and where it is reached from.
struct Loop {
  Track track;
  Box2 box;
};

/// Indices in the order of short rapids, in which every loop comes after those inside of its box.
class InnerFirst {
 public:
  explicit InnerFirst(const std::vector<Loop>& loops) : loops_(loops), around_(loops.size()) {
    waits_.resize(loops.size());
    for (std::uint32_t i = 0; i < loops.size(); ++i)
      for (std::uint32_t j = 0; j < loops.size(); ++j)
        if (i != j && holds(i, j)) around_[j].push_back(i), ++waits_[i];
    for (std::uint32_t i = 0; i < loops.size(); ++i)
      if (waits_[i] == 0) ready_.push_back(i);
  }
  bool done() const { return ready_.empty(); }
  /// The next loop; `here` is where the tool is.
  std::uint32_t take(std::optional<Point2> here) {
    std::size_t best = 0;
    double shortest = INFINITY;
    for (std::size_t i = 0; i < ready_.size() && here; ++i) {
      const double d = to_box(*here, loops_[ready_[i]].box);
      if (d < shortest) shortest = d, best = i;
    }
    const std::uint32_t loop = ready_[best];
    ready_.erase(ready_.begin() + static_cast<std::ptrdiff_t>(best));
    for (const std::uint32_t outer : around_[loop])
      if (--waits_[outer] == 0) ready_.push_back(outer);
    return loop;
  }

 private:
  bool holds(std::uint32_t outer, std::uint32_t inner) const {
    const Box2 &a = loops_[outer].box, &b = loops_[inner].box;
    return a.contains(b) && (!b.contains(a) || outer > inner);
  }
  static double to_box(Point2 p, const Box2& b) {
    return std::hypot(std::max({b.low.x - p.x, 0.0, p.x - b.high.x}),
                      std::max({b.low.y - p.y, 0.0, p.y - b.high.y}));
  }
  const std::vector<Loop>& loops_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<std::uint32_t> waits_, ready_;
};

class ContourRun {
 public:
  ContourRun(const CutOptions& options, const Tool& tool, Walls walls, double lead)
      : options_(options), lead_(lead), cutter_(options, tool, std::move(walls)) {}

  /// `free` is the side of the tracks without material: +1 left, -1 right.
  void loops(const std::vector<Loop>& loops, double free) {
    InnerFirst order(loops);
    while (!order.done() && !cutter_.full()) {
      const auto here = cutter_.position();
      loop(loops[order.take(here ? std::optional(here->xy()) : std::nullopt)].track, free);
    }
  }

  void open_path(const Track& track) {
    cutter_.lift();
    double cleared = options_.top;
    double s = 0.0;
    for (const double z : pass_levels(options_.top, options_.depth, options_.stepdown)) {
      if (cutter_.full()) return;
      cutter_.travel(track.at(s), cleared);
      cutter_.enter(track, s, cleared, z);
      const double other = s > 0.0 ? 0.0 : track.length();
      cutter_.follow(track, s, other, z);
      s = other, cleared = z;
    }
  }
  /// A closed path with all passes, each a continuation of the last.
  void loop(const Track& track, double free) {
    const auto here = cutter_.position();
    double s = here ? track.nearest(here->xy()) : 0.0;
    cutter_.lift();
    const bool lead = permits_lead(track, s, free);
    double cleared = options_.top;
    for (const double z : pass_levels(options_.top, options_.depth, options_.stepdown)) {
      if (cutter_.full()) return;
      if (lead) {
        with_lead(track, s, free, cleared, z);
        cleared = z;
        continue;
      }
      cutter_.travel(track.at(s), cleared);
      s = cutter_.enter(track, s, cleared, z);
      cutter_.follow(track, s, s + track.length(), z);
      cleared = z;
    }
  }

  bool full() const { return cutter_.full(); }
  Toolpath take() {
    cutter_.lift();
    return cutter_.take();
  }

 private:
  bool permits_lead(const Track& track, double s, double free) const {
    if (!(lead_ > 0.0) || free == 0.0) return false;
    const Point2 centre = track.at(s) + (free * lead_) * left_of(track.direction(s));
    return cutter_.walls().permits_circle(centre, lead_);
  }
  /// A pass with a quarter circle at both ends.
  void with_lead(const Track& track, double s, double free, double cleared, double z) {
    const Point2 wall = track.at(s), along = track.direction(s);
    const Point2 centre = wall + (free * lead_) * left_of(along);
    const Turn turn = free > 0.0 ? Turn::ccw : Turn::cw;
    const Point2 start = centre - lead_ * along, end = centre + lead_ * along;
    const auto here = cutter_.position();
    // From the end of the pass above back to its start around the same circle.
    if (here && here->z == cleared && here->xy() == end)
      cutter_.arc(start, centre, turn, here->z);
    else
      cutter_.travel(start, cleared);
    cutter_.rapid_down(cleared + options_.clearance.mm());
    if (options_.entry.kind == EntryKind::plunge)
      cutter_.plunge(z);
    else
      cutter_.helix(centre, turn, z);
    cutter_.arc(wall, centre, turn, z);
    cutter_.follow(track, s, s + track.length(), z);
    cutter_.arc(end, centre, turn, z);
  }

  const CutOptions& options_;
  double lead_;
  Cutter cutter_;
};

std::optional<Operation> finished(ContourRun& run, const CutOptions& options, Diagnostics& diagnostics) {
  if (stop_requested(options.progress)) return std::nullopt;
  if (run.full()) {
    diagnostics.error(Code::op_limit, options.where,
                      fmt::format("{}more than {} steps", prefix(options), options.max_steps));
    return std::nullopt;
  }
  Operation made;
  made.path = run.take();
  return made;
}

bool finite(const Outline& outline) {
  const auto usable = [](Point2 p) {
    return std::abs(p.x) <= limits::kMaxCoordinate && std::abs(p.y) <= limits::kMaxCoordinate;
  };
  return usable(outline.start) &&
         std::all_of(outline.segments.begin(), outline.segments.end(),
                     [&](const Segment& s) { return usable(s.to) && (!s.via || usable(*s.via)); });
}

}  // namespace

std::optional<Operation> contour(const Region& region, const Tool& tool, const ContourOptions& options,
                                 Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid(cut, tool, diagnostics) || !usable(region, cut, diagnostics)) return std::nullopt;
  if (!(options.lead.radius >= Length{} && options.lead.radius.mm() <= limits::kMaxToolSize)) {
    diagnostics.error(Code::op_option, cut.where,
                      fmt::format("{}radius of the lead-in is {:g}; it must be 0 mm or more", prefix(cut),
                                  options.lead.radius.mm()));
    return std::nullopt;
  }
  const bool inside = options.side == ContourSide::inside;
  auto reachable = reach(region, tool, inside ? ReachSide::inside : ReachSide::outside, cut, diagnostics);
  if (!reachable) return std::nullopt;
  // Loops have the region on their left: inside of it they run with the wall on the right, as climb does, and
  // around it the other way.
  const bool climb = cut.direction == CutDirection::climb;
  const double weld = cut.tolerance.weld.mm();
  std::vector<Loop> loops;
  for (const Outline& loop : reachable->axis.loops)
    if (Track track(inside == climb ? loop : reversed(loop), weld); !track.empty())
      loops.push_back({std::move(track), bounds(loop)});
  ContourRun run(cut, tool, Walls(region, reachable->radius, 0.1 * cut.tolerance.chord.mm()),
                 options.lead.radius.mm());
  run.loops(loops, climb ? 1.0 : -1.0);
  auto made = finished(run, cut, diagnostics);
  if (made) made->unreached = std::move(reachable->unreached), made->narrow = std::move(reachable->narrow);
  return made;
}

std::optional<Operation> contour_on(const std::vector<Outline>& outlines, const Tool& tool,
                                    const CutOptions& options, Diagnostics& diagnostics) {
  if (!valid(options, tool, diagnostics)) return std::nullopt;
  const double weld = options.tolerance.weld.mm();
  std::vector<Loop> open;
  for (const Outline& outline : outlines) {
    if (!finite(outline)) {
      diagnostics.error(
          Code::op_option, options.where,
          fmt::format("{}an outline extends beyond {:g} mm", prefix(options), limits::kMaxCoordinate));
      return std::nullopt;
    }
    if (Track track(outline, weld); !track.empty()) open.push_back({std::move(track), bounds(outline)});
  }
  if (open.empty()) {
    diagnostics.error(Code::op_empty, options.where,
                      prefix(options) + "no outline has a length; nothing to cut");
    return std::nullopt;
  }
  ContourRun run(options, tool, Walls(Walls::Kind::unknown), 0.0);
  InnerFirst order(open);
  std::optional<Point2> here;
  while (!order.done() && !run.full()) {
    const Track& track = open[order.take(here)].track;
    if (track.closed())
      run.loop(track, 0.0);
    else
      run.open_path(track);
    here = track.at(track.closed() ? 0.0 : track.length());
  }
  return finished(run, options, diagnostics);
}

}  // namespace kerf

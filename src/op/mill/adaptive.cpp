// The axis has cleared a region C that is a union of discs of a radius R: C = B + disc(R), B its hub. A pass
// lets the hub grow by a step s within H, the points of the axis' region at least R from its boundary, and
// cuts along the new boundary of C where that is new. All that was between is covered, since s is at most
// the tool's radius, and the engagement is within the bound of engagement.h, whatever the region looks like:
// each point of the new boundary is on a disc of radius R that is at most s away from one within C. In a
// slot that is little wider than the tool, the hub is a line, and the new boundary is a trochoidal loop; in
// a wide region it is a long front.
//
// Large discs permit large steps, but do not reach into corners and slots. So the radius is halved from
// stage to stage: each starts with what the one before has cleared.
#include "op/mill/adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "geom/medial/medial_axis.h"
#include "op/base/reach.h"
#include "op/mill/adaptive_order.h"
#include "op/mill/engagement.h"

#include "kerf/geom/offset.h"

namespace kerf::op_detail {
namespace {

/// Radii of the stages over that of the tool.
constexpr std::array kStages{4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625};
constexpr double kSmallestEntry = kNarrowestSlot - 1.0;  // later stages cut only corners
constexpr double kMinStage = 0.01;                       // mm: smaller radii leave less than matters
constexpr double kHelix = 0.9;     // of the tool's radius: a larger helix leaves a core in its centre
constexpr double kMinHub = 0.02;   // of the radius of the stage: a thinner part waits for the next stage
constexpr double kFilm = 0.05;     // of a step, at most: thinner films are not cut again
constexpr int kCornerPasses = 48;  // of a stage for corners, which else would creep along narrow slots
constexpr std::size_t kMaxPasses = 20'000;
constexpr std::size_t kMaxSegments = 4'000'000;                // of all that is kept: 80 bytes each
constexpr double kLeadSlope = 5.0 * std::numbers::pi / 180.0;  // of the way from one ring to the next
constexpr int kLeadChords = 24;

/// The part of the limit that is kept for the lead of a ring.
double lead_slope(double limit) { return std::min(kLeadSlope, limit / 6.0); }

class Growth {
 public:
  Growth(const Region& axis, const AdaptiveOptions& adaptive, const CutOptions& options,
         Diagnostics& diagnostics)
      : axis_(axis),
        adaptive_(adaptive),
        options_(options),
        diagnostics_(diagnostics),
        slope_(lead_slope(adaptive.limit)) {}

  bool run() {
    if (!shift(axis_, adaptive_.radius, target_)) return false;
    for (const double part : kStages) {
      const double radius = part * adaptive_.radius;
      if (part < kSmallestEntry && radius < kMinStage) break;
      if (!stage(radius, part >= kSmallestEntry)) return false;
    }
    return true;
  }

  /// What the axis has covered, and what the tool has.
  bool covered(double further, Region& out) {
    return hub_.empty() ? (out = Region{}, true) : shift(hub_, stage_ + further, out);
  }
  const Region& target() const { return target_; }
  std::vector<AdaptivePass> passes;

 private:
  bool shift(const Region& region, double by, Region& out) {
    auto made = offset(region, mm(by), region_options(options_), diagnostics_);
    if (made) out = merged(made->region, options_.tolerance.weld);
    return made.has_value();
  }
  bool join(const Region& a, const Region& b, Boolean what, Region& out) {
    auto made = combine(a, b, what, region_options(options_), diagnostics_);
    if (made) out = std::move(made->region);
    return made.has_value();
  }
  double step_of(double cleared) const {
    return std::min(step_within(adaptive_.radius, cleared, adaptive_.limit - slope_), adaptive_.max_step) /
           (1.0 + kFilm);
  }

  bool stage(double radius, bool enters) {
    if (!hub_.empty() && !shift(hub_, stage_ - radius, hub_)) return false;
    stage_ = radius;
    Region within;
    if (!shift(axis_, -radius, within)) return false;
    if (within.empty()) return true;
    if (enters)
      for (const Region& part : connected_pieces(within))
        if (!has_hub(part) && !enter(part)) return false;
    if (hub_.empty()) return true;
    return grow(within, enters ? kMaxPasses : std::size_t{kCornerPasses});
  }

  bool has_hub(const Region& part) const {
    const RegionSearch search(part);
    return std::any_of(hub_.loops.begin(), hub_.loops.end(), [&](const Outline& loop) {
      return search.locate(loop.start, mm(kMinHub * stage_)) != Location::outside;
    });
  }

  /// Down a helix at the widest point of a part of the hub's region, and by rings to the radius of the stage.
  bool enter(const Region& part) {
    const auto widest = largest_inscribed_circle(part, region_options(options_), diagnostics_);
    if (!widest) return !stop_requested(options_.progress) && !diagnostics_.has_errors();
    const double hub = std::min(0.25 * stage_, 0.9 * widest->radius.mm());
    if (hub < kMinHub * stage_) return true;
    // The front has to go at least half of the longer side.
    const Box2 box = bounds(part);
    const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    if (0.5 * side / step_of(stage_) > static_cast<double>(kMaxPasses)) return too_many();
    const double helix = std::min(stage_, kHelix * adaptive_.radius);
    passes.push_back({{}, {{.entry = Circle{widest->centre, mm(helix)}}}});
    double cleared = helix;
    while (cleared < stage_ + hub) {
      const double next = std::min(cleared + step_of(cleared), stage_ + hub);
      AdaptivePass pass{{{as_outline({widest->centre, mm(cleared)})}}, {}};
      ring(as_outline({widest->centre, mm(next)}), next - cleared, pass);
      keep(std::move(pass));
      cleared = next;
      if (!continues()) return false;
    }
    return join(hub_, {{as_outline({widest->centre, mm(hub)})}}, Boolean::unite, hub_);
  }

  bool grow(const Region& within, std::size_t max_passes) {
    const double step = step_of(stage_);
    const double film = std::min(kFilm * step, 0.25 * options_.tolerance.chord.mm());
    double size = area(hub_);
    for (std::size_t i = 0; i < max_passes; ++i) {
      if (!continues()) return false;
      Region grown, next;
      if (!shift(hub_, step, grown) || !join(grown, within, Boolean::intersect, next)) return false;
      const double larger = area(next);
      if (!(larger > size + 1e-3 * step * step)) return true;
      AdaptivePass pass;
      if (!front(next, step, film, pass)) return false;
      hub_ = merged(next, options_.tolerance.weld), size = larger;
      keep(std::move(pass));
    }
    return true;
  }

  bool continues() {
    if (stop_requested(options_.progress)) return false;
    return (passes.size() < kMaxPasses && segments_ < kMaxSegments) || too_many();
  }
  bool too_many() {
    return fail(options_, codes::op_limit,
                fmt::format("the region is too large for the tool: more than {} passes or {} segments at an "
                            "engagement of {:g} degrees",
                            kMaxPasses, kMaxSegments, adaptive_.limit * 180.0 / std::numbers::pi),
                diagnostics_);
  }
  /// Keeps a pass, unless it cuts nothing.
  void keep(AdaptivePass pass) {
    if (pass.runs.empty()) return;
    for (const Outline& loop : pass.cleared.loops) segments_ += loop.segments.size();
    for (const AdaptiveRun& run : pass.runs) segments_ += run.path.segments.size();
    passes.push_back(std::move(pass));
  }

  /// The boundary of what the axis covers next, where it is new and touches material.
  bool front(const Region& next, double step, double film, AdaptivePass& pass) {
    Region covered, cleared, material, near, fresh, wanted, boundary;
    if (!shift(hub_, stage_, covered) || !shift(hub_, stage_ + adaptive_.radius + film, cleared) ||
        !join(target_, cleared, Boolean::subtract, material))
      return false;
    if (material.empty()) return true;
    if (!shift(material, adaptive_.radius, near) || !shift(hub_, stage_ + film, fresh) ||
        !join(near, fresh, Boolean::subtract, wanted) || !shift(next, stage_, boundary))
      return false;
    for (const Outline& loop : boundary.loops) {
      auto pieces = clip(loop, wanted, Location::inside, region_options(options_), diagnostics_);
      if (!pieces) return false;
      for (Outline& piece : *pieces) {
        if (piece.closed())
          ring(piece, step, pass);
        else
          add(std::move(piece), pass);
      }
    }
    pass.cleared = std::move(covered);
    return true;
  }

  void add(Outline piece, AdaptivePass& pass) {
    if (options_.direction == CutDirection::conventional) piece = reversed(piece);
    end_ = piece.segments.back().to;
    pass.runs.push_back({.entry = {}, .path = std::move(piece)});
  }

  /// A closed path: approached from `inset` inside at a slope, then once around.
  void ring(const Outline& loop, double inset, AdaptivePass& pass) {
    const bool climb = options_.direction == CutDirection::climb;
    const double weld = options_.tolerance.weld.mm();
    const Track track(climb ? loop : reversed(loop), weld);
    if (track.empty()) return;
    const double first = end_ ? track.nearest(*end_) : 0.0, lead = inset / std::tan(slope_);
    const double side = climb ? inset : -inset;
    const auto on_lead = [&](int i) {
      const double s = first + lead * i / kLeadChords;
      return track.at(s) + (side * (kLeadChords - i) / kLeadChords) * left_of(track.direction(s));
    };
    Outline path{on_lead(0), {}};
    for (int i = 1; i <= kLeadChords; ++i) path.segments.push_back({on_lead(i), {}});
    for (const LineArc& piece : track.pieces(first + lead, first + lead + track.length())) {
      std::optional<Point2> via;
      if (piece.is_arc()) via = point_at(piece, 0.5);
      path.segments.push_back({piece.to, via});
    }
    end_ = path.segments.back().to;
    pass.runs.push_back({.entry = {}, .path = std::move(path)});
  }

  const Region& axis_;
  const AdaptiveOptions& adaptive_;
  const CutOptions& options_;
  Diagnostics& diagnostics_;
  double slope_, stage_ = 0.0;
  std::size_t segments_ = 0;
  Region target_, hub_;
  std::optional<Point2> end_;  // of the path before
};

}  // namespace

std::optional<AdaptivePlan> plan_adaptive(const Region& axis, const AdaptiveOptions& adaptive,
                                          const CutOptions& options, Diagnostics& diagnostics) {
  Growth growth(axis, adaptive, options, diagnostics);
  Region tool_was, axis_was;
  if (!growth.run() || !growth.covered(adaptive.radius, tool_was) ||
      !growth.covered(0.5 * adaptive.radius, axis_was))
    return std::nullopt;
  const RegionOptions regions = region_options(options);
  auto left = combine(growth.target(), tool_was, Boolean::subtract, regions, diagnostics);
  auto narrow = combine(axis, axis_was, Boolean::subtract, regions, diagnostics);
  if (!left || !narrow) return std::nullopt;
  AdaptivePlan plan;
  plan.left = without_slivers(left->region, options.tolerance.chord), plan.narrow = std::move(narrow->region);
  plan.runs = in_order(std::move(growth.passes), adaptive.radius, options);
  if (stop_requested(options.progress)) return std::nullopt;
  return plan;
}

}  // namespace kerf::op_detail

// What a tool can reach: the region smaller by its radius, and grown again. What lies further than a whole
// radius from there is no mere corner: it is too narrow for the tool.
#include "op/base/reach.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <queue>

#include "base/codes/op.h"
#include "op/base/cutter.h"

#include "kerf/base/limits.h"

namespace kerf::op_detail {
namespace {

constexpr int kMaxSquares = 2000;          // of the search for the largest circle
constexpr double kCirclePrecision = 0.01;  // of its radius
constexpr std::size_t kMaxNarrow = 100;    // parts for which the largest tool is computed

/// The largest circle that does not cross the boundary of `walls` and has its centre in `part`: squares with
/// the largest possible radius are divided first.
NarrowPart largest_circle(const Region& part, const RegionSearch& walls, double weld) {
  struct Square {
    Point2 centre;
    double half, bound;
    bool operator<(const Square& other) const { return bound < other.bound; }
  };
  const RegionSearch inside(part);
  NarrowPart best{part.loops.front().start, {}};
  const auto radius_at = [&](Point2 p) {
    const auto nearest = walls.nearest(p);
    return nearest ? nearest->distance.mm() : 0.0;
  };
  double largest = radius_at(best.at);
  const auto offer = [&](Point2 p, double radius) {
    if (radius > largest) largest = radius, best.at = p;
  };
  for (const Outline& loop : part.loops)
    for (const Segment& s : loop.segments) {
      offer(s.to, radius_at(s.to));
      if (s.via) offer(*s.via, radius_at(*s.via));
    }
  const Box2 box = bounds(part);
  std::priority_queue<Square> squares;
  const auto push = [&](Point2 centre, double half) {
    const double reach = half * std::sqrt(2.0), radius = radius_at(centre);
    // Beside a thin part the region may be wide: squares there would be all that is divided.
    const auto within = inside.clearance(centre);
    if (!within || within->mm() < -reach) return;
    if (radius > largest && within->mm() >= -weld) offer(centre, radius);
    squares.push({centre, half, radius + reach});
  };
  push(0.5 * (box.low + box.high), 0.5 * std::max(box.high.x - box.low.x, box.high.y - box.low.y));
  for (int i = 0; i < kMaxSquares && !squares.empty(); ++i) {
    const Square s = squares.top();
    if (s.bound <= (1.0 + kCirclePrecision) * largest) break;
    squares.pop();
    const double h = 0.5 * s.half;
    for (const Point2 d : {Point2{-h, -h}, Point2{h, -h}, Point2{-h, h}, Point2{h, h}}) push(s.centre + d, h);
  }
  best.diameter = mm(2.0 * largest);
  return best;
}

/// The computation for one radius.
class ReachRun {
 public:
  ReachRun(const Region& region, ReachSide side, const CutOptions& options, Diagnostics& diagnostics)
      : region_(region), side_(side), options_(options), diagnostics_(diagnostics) {}

  /// False where a region could not be computed.
  bool run(double radius) {
    const double inwards = side_ == ReachSide::inside ? -1.0 : 1.0;
    const RegionOptions region = region_options(options_);
    auto axis = offset(region_, mm(inwards * radius), region, diagnostics_);
    if (!axis) return false;
    std::optional<Offset> near = Offset{}, far = Offset{};
    if (!axis->region.empty()) {
      near = offset(axis->region, mm(-inwards * radius), region, diagnostics_);
      far = offset(axis->region, mm(-inwards * 2.0 * radius), region, diagnostics_);
    }
    if (!near || !far) return false;
    result.radius = radius;
    result.axis = std::move(axis->region);
    return left(near->region, result.unreached) && left(far->region, narrow);
  }

  Reach result;
  Region narrow;

 private:
  /// What a tool leaves that reaches up to `reached`, less slivers of rounding.
  bool left(const Region& reached, Region& out) {
    const bool inside = side_ == ReachSide::inside;
    auto rest = combine(inside ? region_ : reached, inside ? reached : region_, Boolean::subtract,
                        region_options(options_), diagnostics_);
    if (!rest) return false;
    out = without_slivers(rest->region, options_.tolerance.chord);
    return true;
  }

  const Region& region_;
  ReachSide side_;
  const CutOptions& options_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::vector<Region> connected_pieces(const Region& region) {
  std::vector<Region> pieces;
  for (const Figure& figure : figures(region)) {
    Region piece;
    for (const auto& loop : figure)
      piece.loops.push_back(std::holds_alternative<Outline>(loop) ? std::get<Outline>(loop)
                                                                  : as_outline(std::get<Circle>(loop)));
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

Region without_slivers(const Region& region, Length chord) {
  Region kept;
  for (Region& part : connected_pieces(region))
    if (area(part) > 0.25 * chord.mm() * length(part).mm())
      for (Outline& loop : part.loops) kept.loops.push_back(std::move(loop));
  return kept;
}

std::vector<NarrowPart> narrow_parts(const Region& narrow, const Region& region, double weld) {
  std::vector<NarrowPart> parts;
  if (narrow.empty()) return parts;
  const RegionSearch walls(region);
  for (const Region& part : connected_pieces(narrow)) {
    if (parts.size() >= kMaxNarrow) break;
    parts.push_back(largest_circle(part, walls, weld));
  }
  return parts;
}

const NarrowPart& narrowest(const std::vector<NarrowPart>& parts) {
  return *std::min_element(parts.begin(), parts.end(),
                           [](const NarrowPart& a, const NarrowPart& b) { return a.diameter < b.diameter; });
}

std::string counted(std::size_t parts, std::string_view noun) {
  if (parts == 1) return fmt::format("a {}", noun);
  return fmt::format("{}{} {}s, the narrowest", parts == kMaxNarrow ? "at least " : "", parts, noun);
}

bool usable(const Region& region, const CutOptions& options, Diagnostics& diagnostics) {
  for (const Outline& loop : region.loops)
    if (!loop.closed()) {
      diagnostics.error(codes::op_open, options.where,
                        fmt::format("{}an outline of the region is open at {:.6g}, {:.6g}", prefix(options),
                                    loop.start.x, loop.start.y));
      return false;
    }
  const Box2 box = bounds(region);
  const double limit = limits::kMaxCoordinate;
  if (region.empty() || !(box.high.x - box.low.x > 0.0) || !(box.high.y - box.low.y > 0.0)) {
    diagnostics.error(codes::op_empty, options.where,
                      prefix(options) + "the region is empty; nothing to cut");
    return false;
  }
  if (box.low.x >= -limit && box.low.y >= -limit && box.high.x <= limit && box.high.y <= limit) return true;
  diagnostics.error(codes::op_option, options.where,
                    fmt::format("{}the region extends beyond {:g} mm", prefix(options), limit));
  return false;
}

std::optional<Reach> reach(const Region& region, const Tool& tool, ReachSide side, const CutOptions& options,
                           Diagnostics& diagnostics) {
  const double radius = cutting_radius(tool, options.depth).mm() + options.allowance.mm();
  ReachRun exact(region, side, options, diagnostics);
  if (!exact.run(radius)) return std::nullopt;
  ReachRun* best = &exact;
  // A slot as wide as the tool, or narrower by rounding, is cut all the same.
  ReachRun slack(region, side, options, diagnostics);
  if (!exact.narrow.empty()) {
    if (!slack.run(radius - 0.5 * options.tolerance.chord.mm())) return std::nullopt;
    if (area(slack.narrow) < 0.99 * area(exact.narrow)) best = &slack;
  }
  Reach made = std::move(best->result);
  made.narrow = narrow_parts(best->narrow, region, options.tolerance.weld.mm());
  const bool nothing = side == ReachSide::inside && made.axis.empty();
  if (!made.narrow.empty()) {
    const NarrowPart& part = narrowest(made.narrow);
    const double fits = part.diameter.mm() - 2.0 * options.allowance.mm();
    std::string message = fmt::format(
        "{}tool {} of {:.4g} mm is too wide for {} at {:.6g}, {:.6g}; the largest that fits there "
        "has {:.4g} mm",
        prefix(options), tool.number, 2.0 * (radius - options.allowance.mm()),
        nothing ? "the region" : counted(made.narrow.size(), "part"), part.at.x, part.at.y,
        std::max(fits, 0.0));
    if (nothing)
      diagnostics.error(codes::op_tool_wide, options.where, std::move(message));
    else
      diagnostics.warning(codes::op_tool_wide, options.where, std::move(message));
  }
  if (!nothing) return made;
  if (made.narrow.empty())
    diagnostics.error(codes::op_tool_wide, options.where,
                      fmt::format("{}tool {} does not fit into the region", prefix(options), tool.number));
  return std::nullopt;
}

}  // namespace kerf::op_detail

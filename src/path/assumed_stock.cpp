// The top of the stock, derived from the cuts: from plunges (descending feed motions) and lateral cuts (other
// feed motions, at a height that a plunge or a downward rapid has reached). Feed motions at a height to which
// the tool was lifted are travel above the stock, in programs without rapids.
#include "path/assumed_stock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "path/motion_box.h"

namespace kerf {
namespace {

constexpr double kSameHeight = 1e-4;  // mm; programs have three or four decimals
/// Fraction of lateral cuts above Z0 from which on Z0 is not the top. Programs with Z0 on top have few above
/// it (a first pass that levels the stock), programs with Z0 on the bed most of them.
constexpr double kFractionAboveTop = 0.2;
constexpr double kIntoTheBed = 1.0;  // mm; depth of through cuts below a bed at Z0
constexpr unsigned kAxisZ = 4;       // in masks of unknown axes
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// The relevant data of a feed motion.
struct Feed {
  Point3 from, to;
  double sideways = 0.0;  // mm
  bool down() const { return to.z < from.z - kSameHeight; }
  bool up() const { return to.z > from.z + kSameHeight; }
  double top() const { return std::max(from.z, to.z); }
  /// The part of `sideways` above Z0, which does not depend on how a helix is divided.
  double sideways_above() const {
    const double low = std::min(from.z, to.z), high = top();
    if (high <= kSameHeight) return 0.0;
    return low >= 0.0 ? sideways : sideways * high / (high - low);
  }
};

Feed feed_of(const Step& s, Point3 from) {
  Feed feed{from, s.to(), std::hypot(s.to().x - from.x, s.to().y - from.y)};
  if (s.kind() == StepKind::arc && s.arc().plane == Plane::xy) feed.sideways = walk_of(s, from).length();
  return feed;
}

/// Calls plunge(feed, first) for every descending feed motion, `first` unless another one precedes it, and
/// cut(feed, after_plunge) for every lateral cut.
template <class Plunge, class Cut>
void for_each_feed(const Toolpath& path, Plunge&& plunge, Cut&& cut) {
  bool lifted = true, plunging = false;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    Feed feed = feed_of(s, context.from);
    if ((s.unknown_axes() & kAxisZ) != 0) return;
    if ((context.unknown_from & kAxisZ) != 0) {  // the first height of the program
      feed.from.z = feed.to.z;
      lifted = !s.is_cutting();
    }
    if (!s.is_cutting()) {
      lifted = feed.up() || (lifted && !feed.down());
      plunging = false;
    } else if (feed.down()) {
      plunge(feed, !plunging);
      plunging = true;
      lifted = false;
    } else {
      if (feed.sideways <= kSameHeight)
        lifted = lifted || feed.up();
      else if (!lifted)
        cut(feed, plunging);
      plunging = false;
    }
  });
}

/// Heights of all cuts.
struct Heights {
  double lowest = kNowhere;
  double highest_cut = -kNowhere;               // of lateral ones
  double highest_start = -kNowhere;             // of plunges
  double sideways = 0.0, sideways_above = 0.0;  // mm; above: above Z0

  /// Whether Z0 is the bed instead of the top.
  bool on_bed() const {
    if (lowest >= -kSameHeight) return sideways_above > 0.0 || (sideways == 0.0 && highest_start > 0.0);
    return sideways_above > kFractionAboveTop * sideways;
  }
};

Heights heights_of(const Toolpath& path) {
  Heights h;
  for_each_feed(
      path,
      [&](const Feed& feed, bool) {
        h.lowest = std::min(h.lowest, feed.to.z);
        h.highest_start = std::max(h.highest_start, feed.from.z);
      },
      [&](const Feed& feed, bool) {
        h.lowest = std::min({h.lowest, feed.from.z, feed.to.z});
        h.highest_cut = std::max(h.highest_cut, feed.top());
        h.sideways += feed.sideways;
        h.sideways_above += feed.sideways_above();
      });
  return h;
}

/// The top of a stock on the bed: above the highest cut, and at most at the start of plunges to it.
std::pair<double, AssumedTop> top_above_bed(const Toolpath& path, const Heights& heights) {
  if (heights.sideways == 0.0) return {heights.highest_start, AssumedTop::plunge};
  double start = kNowhere;                   // lowest start of a plunge at or above the highest cut
  double first = -kNowhere, second = first;  // the highest two heights that plunges end at
  for_each_feed(
      path,
      [&](const Feed& feed, bool is_first) {
        if (is_first && feed.from.z >= heights.highest_cut - kSameHeight)
          start = std::min(start, feed.from.z);
      },
      [&](const Feed& feed, bool after_plunge) {
        const double end = feed.from.z;
        if (!after_plunge || std::abs(end - first) <= kSameHeight) return;
        if (end > first) {
          second = first;
          first = end;
        } else {
          second = std::max(second, end);
        }
      });
  const double pass_above = std::isfinite(second) ? first + (first - second) : kNowhere;
  const double top = std::min(pass_above, start);
  if (top == kNowhere || top <= heights.highest_cut) return {heights.highest_cut, AssumedTop::cuts};
  return {top, pass_above < start ? AssumedTop::passes : AssumedTop::plunge};
}

/// The part of a straight motion at or below `limit`; its start point is complete.
Box3 part_below(Point3 from, Point3 to, double limit) {
  Box3 box;
  if (from.z <= limit) box.add(from);
  if (to.z <= limit) box.add(to);
  if ((from.z <= limit) != (to.z <= limit))
    box.add(from + ((limit - from.z) / (to.z - from.z)) * (to - from));
  return box;
}

/// What a feed motion cuts below `limit`, and where a rapid goes down into it.
Box3 part_below(const Step& s, const MotionContext& context, double limit) {
  if (s.kind() == StepKind::arc) {
    const Box3 box = detail::bounds_of(s, context.from, context.unknown_from);
    return box.low.z <= limit ? box : Box3{};
  }
  const Feed feed = feed_of(s, context.from);
  const bool lifts = feed.sideways <= kSameHeight && feed.up();
  if (s.is_cutting() && lifts) return {};
  Point3 from = context.from;
  for (int axis = 0; axis < 3; ++axis)
    if ((context.unknown_from >> axis & 1u) != 0) from[axis] = s.to()[axis];
  if (s.is_cutting()) return part_below(from, s.to(), limit);
  const bool descends = feed.down() || (context.unknown_from & kAxisZ) != 0;
  const bool is_low = s.kind() == StepKind::rapid && s.unknown_axes() == 0 && std::isfinite(limit) &&
                      s.to().z < limit - 2.0 * kSameHeight;
  return is_low && descends ? part_below(s.to(), s.to(), limit) : Box3{};
}

/// Bounds of what is cut below the top, and of rapids that go down below it, which may be mistakes.
Box3 bounds_below(const Toolpath& path, double top) {
  Box3 cuts, plunges;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if ((s.unknown_axes() & kAxisZ) != 0) return;
    (s.is_cutting() ? cuts : plunges).add(part_below(s, context, top + kSameHeight));
  });
  plunges.low.z = plunges.high.z = cuts.low.z;
  if (!cuts.empty()) cuts.add(plunges);
  return cuts;
}

}  // namespace

std::optional<AssumedStock> assume_stock(const Toolpath& path, Length margin, Length floor) {
  const Heights heights = heights_of(path);
  const bool on_bed = heights.on_bed();
  AssumedStock assumed;
  double top = 0.0;
  if (on_bed) std::tie(top, assumed.top) = top_above_bed(path, heights);
  Box3 cuts = bounds_below(path, top);
  if (cuts.empty()) {  // feed motions at one height, to which the tool was lifted
    cuts = bounds_below(path, kNowhere);
    if (cuts.empty()) return std::nullopt;
    top = cuts.high.z;
    assumed.top = AssumedTop::cuts;
  }
  Box3& block = assumed.stock.block;
  block.low = cuts.low - Point3{margin.mm(), margin.mm(), 0.0};
  block.high = cuts.high + Point3{margin.mm(), margin.mm(), 0.0};
  block.high.z = top;
  const bool through_to_bed = on_bed && cuts.low.z >= -kIntoTheBed;
  block.low.z = through_to_bed ? std::min(cuts.low.z, 0.0) : std::min(cuts.low.z, top) - floor.mm();
  return assumed;
}

}  // namespace kerf

// Chains: cuts without gaps, milled in passes.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "base/codes/pathdxf.h"
#include "front/pathdxf/compile/miller.h"
#include "front/pathdxf/text/nearly.h"

namespace kerf::pathdxf {
namespace {

constexpr double kTie = 1e-12;  // mm and relative, of distances that count as equal in the search

constexpr Bilingual kMissing{"{} value missing", "{}-Wert fehlt"};

}  // namespace

bool Miller::passes_of(const Chain& c, const Origin& where, const std::vector<OriginId>& origins,
                       std::vector<Pass>& passes) {
  bool good = c.infeed.has_value();
  if (!good) report_.error(codes::pathdxf_value_missing, where, kMissing, "I");
  passes.reserve(c.segments.size());
  for (std::size_t i = 0; i < c.segments.size(); ++i) {
    const MillSegment& s = c.segments[i];
    if (!has_depths(s.values, s.where)) good = false;
    if (!good) continue;
    check_bars(s.values, length_of(s), s.where);
    const double first = c.first_depth ? *c.first_depth + frame_.raise : top() - *c.infeed;
    passes.push_back({&s, origins[i], levels(first, *c.infeed, bottom_of(s.values), s.where), 0,
                      frame_(s.start), frame_(s.end)});
    if (passes.back().levels.empty()) good = false;
  }
  return good;
}

void Miller::mill(const Pass& pass, double level, bool reversed) {
  out_.set_origin(pass.origin);
  comment_of(pass.segment->values);
  mill_segment(*pass.segment, level, reversed);
}

void Miller::chain(const Chain& c, const Origin& where, const std::vector<OriginId>& origins) {
  std::vector<Pass> passes;
  if (!passes_of(c, where, origins, passes)) return;
  if (c.first_depth)
    slow(passes);
  else
    greedy(passes);
}

/// The tips of the segments of a chain: 2 i and 2 i + 1 are the start and the end of segment i. Those at the
/// tool are found by a table of positions, as most segments continue where another ends, the others by a
/// tree.
class Miller::Tips {
 public:
  explicit Tips(const std::vector<Pass>& passes)
      : passes_(passes), first_(std::bit_ceil(4 * passes.size()), kNone), next_(2 * passes.size()) {
    for (std::uint32_t tip = 0; tip < next_.size(); ++tip)
      next_[tip] = std::exchange(first_[bucket(point_of(tip))], tip);
  }

  /// The segment with the nearest tip at its next level, and whether that is its end; of equally near
  /// segments the first one. The number of segments if all are done.
  NextPass nearest(Point3 head) {
    best_ = {passes_.size(), false};
    nearest_ = std::numeric_limits<double>::infinity();
    for (std::uint32_t tip = first_[bucket(head.xy())]; tip != kNone; tip = next_[tip])
      if (point_of(tip) == head.xy()) visit(tip, head);
    if (nearest_ > 0.0)
      tree().nearest(head.xy(), nearest_, [&](std::uint32_t tip) { return visit(tip, head); });
    return best_;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  Point2 point_of(std::uint32_t tip) const {
    return tip % 2 == 0 ? passes_[tip / 2].start : passes_[tip / 2].end;
  }
  std::size_t bucket(Point2 p) const {
    constexpr std::uint64_t kSpread = 0x9e3779b97f4a7c15u;  // 2^64 divided by the golden ratio
    const auto bits = [](double v) {
      v += 0.0;  // -0 as 0
      std::uint64_t kept = 0;
      std::memcpy(&kept, &v, sizeof kept);  // libc++ 13 has no std::bit_cast
      return kept;
    };
    // Short numbers differ in their upper bits only, which a product does not move down.
    const std::uint64_t both = bits(p.x) ^ std::rotl(bits(p.y), 23);
    const std::uint64_t mixed = (both ^ both >> 32) * kSpread;
    return static_cast<std::size_t>(mixed >> 32) & (first_.size() - 1);
  }
  const BoxTree& tree() {
    if (tree_) return *tree_;
    std::vector<Box2> boxes;
    boxes.reserve(next_.size());
    for (std::uint32_t tip = 0; tip < next_.size(); ++tip) boxes.push_back({point_of(tip), point_of(tip)});
    return tree_.emplace(boxes);
  }
  double visit(std::uint32_t tip, Point3 head) {
    const std::size_t i = tip / 2;
    const Pass& p = passes_[i];
    if (p.next == p.levels.size()) return std::numeric_limits<double>::infinity();
    const double z = p.levels[p.next];
    const double to_start = distance(head, {p.start.x, p.start.y, z});
    const double to_end = distance(head, {p.end.x, p.end.y, z});
    const double d = std::min(to_start, to_end);
    if (d < nearest_ || (d == nearest_ && i < best_.segment)) {
      nearest_ = d;
      best_ = {i, !(to_start < to_end)};
    }
    return d * (1.0 + kTie) + kTie;  // so that equally near ones are visited too
  }

  const std::vector<Pass>& passes_;
  std::vector<std::uint32_t> first_, next_;  // tips of a bucket
  std::optional<BoxTree> tree_;
  NextPass best_;
  double nearest_ = 0.0;
};

/// The nearest segment whose upper passes are done is milled next.
void Miller::greedy(std::vector<Pass>& passes) {
  Tips tips(passes);
  std::size_t left = 0;
  for (const Pass& p : passes) left += p.levels.size();
  Point3 head{passes[0].start.x, passes[0].start.y, passes[0].levels[0]};
  for (; left > 0 && !out_.full(); --left) {
    const auto [best, reversed] = tips.nearest(head);
    Pass& p = passes[best];
    const double z = p.levels[p.next++];
    const Point2 from = reversed ? p.end : p.start, to = reversed ? p.start : p.end;
    const double height = p.segment->sweep_height && !near(out_.position().xy(), from)
                              ? *p.segment->sweep_height + frame_.raise
                              : sweep_height();
    out_.set_origin(p.origin);
    travel({from.x, from.y, z}, height, p.segment->values.feed);
    mill(p, z, reversed);
    head = {to.x, to.y, z};
  }
  const Pass& last = passes.back();
  out_.set_origin(last.origin);
  travel({last.end.x, last.end.y, sweep_height()}, sweep_height(), last.segment->values.feed);
}

/// Without sweeps: all segments at one level, then back along them, then at the next.
void Miller::slow(std::vector<Pass>& passes) {
  std::size_t runs = 0;
  for (const Pass& p : passes) runs = std::max(runs, p.levels.size());
  const bool goes_back = !near(passes.front().start, passes.back().end);
  for (std::size_t k = 0; k < runs && !out_.full(); ++k) {
    const auto level = [k](const Pass& p) { return p.levels[std::min(k, p.levels.size() - 1)]; };
    for (const Pass& p : passes) mill(p, level(p), false);
    if (k + 1 == runs || !goes_back) continue;
    for (auto p = passes.rbegin(); p != passes.rend(); ++p) mill(*p, level(*p), true);
  }
}

}  // namespace kerf::pathdxf

// Chains: cuts without gaps, milled in passes.
#include <cmath>
#include <limits>

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
  if (!good) report_.error(Code::pathdxf_value_missing, where, kMissing, "I");
  for (std::size_t i = 0; i < c.segments.size(); ++i) {
    const MillSegment& s = c.segments[i];
    if (!has_depths(s.values, s.where)) good = false;
    if (!good) continue;
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

/// The nearest tip of a segment at its next level; of equally near segments the first one.
Miller::NextPass Miller::next_pass(const std::vector<Pass>& passes, const BoxTree& tips, Point3 head) {
  NextPass best{passes.size(), false};
  double nearest = std::numeric_limits<double>::infinity();
  tips.nearest(head.xy(), nearest, [&](std::uint32_t tip) {
    const std::size_t i = tip / 2;
    const Pass& p = passes[i];
    if (p.next == p.levels.size()) return std::numeric_limits<double>::infinity();
    const double z = p.levels[p.next];
    const double to_start = distance(head, {p.start.x, p.start.y, z});
    const double to_end = distance(head, {p.end.x, p.end.y, z});
    const double d = std::min(to_start, to_end);
    if (d < nearest || (d == nearest && i < best.segment)) {
      nearest = d;
      best = {i, !(to_start < to_end)};
    }
    return d * (1.0 + kTie) + kTie;  // so that equally near ones are visited too
  });
  return best;
}

/// The nearest segment whose upper passes are done is milled next.
void Miller::greedy(std::vector<Pass>& passes) {
  std::vector<Box2> boxes;
  for (const Pass& p : passes)
    for (const Point2 tip : {p.start, p.end}) boxes.push_back({tip, tip});
  const BoxTree tips(boxes);
  Point3 head{passes[0].start.x, passes[0].start.y, passes[0].levels[0]};
  while (!out_.full()) {
    const auto [best, reversed] = next_pass(passes, tips, head);
    if (best == passes.size()) break;
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

// Lines and cuts of a laser, and frames.
#include "kerf/op/laser.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/inner_first.h"
#include "op/base/lead.h"
#include "op/base/option_check.h"
#include "op/base/reach.h"
#include "op/laser/beam.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr int kLeadTries = 32;  // starts along a loop that are tried for a lead-in

/// How a closed cut starts and ends.
struct Leads {
  Lead in{}, out{};
  double overlap = 0.0;  // mm
  double free = 0.0;     // the side of what falls off: +1 left, -1 right
};

/// The length of a closed track where it is started: near `from`, and where the lead-in fits, if it does
/// anywhere.
double start_of(const Track& track, const Walls& walls, const Leads& leads, std::optional<Point2> from) {
  const double nearest = from ? track.nearest(*from) : 0.0;
  for (int i = 0; i < kLeadTries; ++i) {
    // To both sides of the nearest point in turn.
    const double away = (i + 1) / 2 * (i % 2 == 0 ? 1.0 : -1.0) / kLeadTries;
    const double s = nearest + away * track.length();
    if (permits(walls, leads.in, track, s, leads.free)) return s;
  }
  return nearest;
}

void lead_in(Beam& beam, const Track& track, double s, const Leads& leads, double fraction) {
  const Point2 beyond = beyond_wall(leads.in, track, s, leads.free);
  const bool arc = leads.in.kind == LeadKind::arc;
  beam.travel(arc ? beyond - leads.in.size.mm() * track.direction(s) : beyond);
  beam.power(fraction);
  if (arc)
    beam.arc(track.at(s), beyond, leads.free > 0.0 ? Turn::ccw : Turn::cw);
  else
    beam.line(track.at(s));
}

void lead_out(Beam& beam, const Track& track, double s, const Leads& leads) {
  const Point2 beyond = beyond_wall(leads.out, track, s, leads.free);
  if (leads.out.kind == LeadKind::line) return beam.line(beyond);
  beam.arc(beyond + leads.out.size.mm() * track.direction(s), beyond,
           leads.free > 0.0 ? Turn::ccw : Turn::cw);
}

/// A closed track with all its passes; those without leads follow each other without a rapid.
void cut_loop(Beam& beam, const Track& track, const Walls& walls, const Leads& leads,
              const LaserOptions& options) {
  double s = start_of(track, walls, leads, beam.position());
  const bool leads_in = permits(walls, leads.in, track, s, leads.free);
  for (int pass = 0; pass < options.passes && !beam.full(); ++pass) {
    if (leads_in) {
      lead_in(beam, track, s, leads, options.power);
    } else {
      beam.travel(track.at(s));
      beam.power(options.power);
    }
    const double end = s + track.length() + leads.overlap;
    beam.follow(track, s, end);
    const bool leads_out = permits(walls, leads.out, track, end, leads.free);
    if (leads_out) lead_out(beam, track, end, leads);
    if (!leads_in && !leads_out) s = end;
  }
}

/// An open track back and forth.
void cut_open(Beam& beam, const Track& track, const LaserOptions& options) {
  double s = 0.0;
  const auto at = beam.position();
  if (at && distance(*at, track.at(track.length())) < distance(*at, track.at(0.0))) s = track.length();
  beam.travel(track.at(s));
  beam.power(options.power);
  for (int pass = 0; pass < options.passes && !beam.full(); ++pass) {
    const double other = s > 0.0 ? 0.0 : track.length();
    beam.follow(track, s, other);
    s = other;
  }
}

bool valid_sizes(const LaserCutOptions& options, const CutOptions& cut, Diagnostics& diagnostics) {
  OptionCheck check(cut, diagnostics);
  for (const auto& [length, what] : {std::pair(options.kerf, "kerf"),
                                     {options.lead_in.size, "size of the lead-in"},
                                     {options.lead_out.size, "size of the lead-out"},
                                     {options.overlap, "overlap"}})
    check.expect(length >= Length{} && length.mm() <= limits::kMaxToolSize, what, length.mm(),
                 "0 mm or more");
  return check.valid();
}

/// The loops that the axis of the beam follows; what is narrower than the kerf is reported.
std::optional<Region> beam_loops(const Region& region, const LaserCutOptions& options, const CutOptions& cut,
                                 Diagnostics& diagnostics) {
  if (!(options.kerf > Length{})) return region;
  const bool outside = options.side == ContourSide::outside;
  auto made = offset(region, (outside ? 0.5 : -0.5) * options.kerf, region_options(cut), diagnostics);
  if (!made) return std::nullopt;
  const std::string narrow = fmt::format("{}a kerf of {:g} mm is wider than {}", prefix(cut),
                                         options.kerf.mm(), outside ? "a hole of the part" : "an opening");
  if (made->region.empty()) {
    diagnostics.error(codes::op_tool_wide, cut.where, narrow);
    return std::nullopt;
  }
  // Outer loops that unite when they grow vanish too; then the slot between them is narrower than the kerf.
  if (made->vanished > 0)
    diagnostics.warning(codes::op_tool_wide, cut.where,
                        outside ? narrow + ", or than the distance of two parts" : narrow);
  return std::move(made->region);
}

}  // namespace

std::optional<Operation> laser_lines(const std::vector<Outline>& outlines, const LaserOptions& options,
                                     Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options);
  if (!valid(options, diagnostics) || !within_limits(outlines, cut, diagnostics)) return std::nullopt;
  const std::vector<Loop> loops = loops_of(outlines, options.tolerance.weld);
  if (loops.empty()) {
    fail(cut, codes::op_empty, "no outline has a length; nothing to burn", diagnostics);
    return std::nullopt;
  }
  Beam beam(options);
  InnerFirst order(loops);
  while (!order.done() && !beam.full()) {
    const Track& track = loops[order.take(beam.position())].track;
    if (track.closed())
      cut_loop(beam, track, Walls(Walls::Kind::unknown), {}, options);
    else
      cut_open(beam, track, options);
  }
  return beam.finished(diagnostics);
}

std::optional<Operation> laser_cut(const Region& region, const LaserCutOptions& options,
                                   Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options.laser);
  if (!valid(options.laser, diagnostics) || !valid_sizes(options, cut, diagnostics) ||
      !usable(region, cut, diagnostics))
    return std::nullopt;
  const auto axis = beam_loops(region, options, cut, diagnostics);
  if (!axis) return std::nullopt;
  const bool outside = options.side == ContourSide::outside;
  const std::vector<Loop> loops = loops_of(axis->loops, options.laser.tolerance.weld);
  // Loops have the region on their left; outside of it, what falls off is on the right.
  const Leads leads{options.lead_in, options.lead_out, options.overlap.mm(), outside ? -1.0 : 1.0};
  const Walls walls(region, 0.5 * options.kerf.mm(), options.laser.tolerance.chord.mm());
  Beam beam(options.laser);
  InnerFirst order(loops);
  while (!order.done() && !beam.full())
    cut_loop(beam, loops[order.take(beam.position())].track, walls, leads, options.laser);
  return beam.finished(diagnostics);
}

std::optional<Operation> laser_frame(const Box2& box, const LaserOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options);
  if (!valid(options, diagnostics)) return std::nullopt;
  if (box.empty() || !in_range(box.low) || !in_range(box.high)) {
    fail(cut, codes::op_empty, "there is no box to frame", diagnostics);
    return std::nullopt;
  }
  Beam beam(options);
  beam.travel(box.low);
  beam.power(options.power);
  for (int pass = 0; pass < options.passes && !beam.full(); ++pass)
    for (const Point2 corner :
         {Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}, box.low})
      beam.line(corner);
  return beam.finished(diagnostics);
}

}  // namespace kerf

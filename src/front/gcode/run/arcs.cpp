// Arcs: the centre from I J K or from a radius, turns, and what to do when they do not fit.
//
// Source: LinuxCNC's page "G2, G3 Arc Move"; radii that GRBL refuses are said.
#include <cmath>
#include <fmt/format.h>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

// The radii at an arc's ends may differ by what rounding to a program's decimals leaves: GRBL's limits.
constexpr double kRadiusSlack = 0.005;      // mm
constexpr double kRadiusShare = 0.001;      // of the radius; also what an R may be short of half the chord
constexpr double kHopelessMismatch = 2.83;  // mm; LinuxCNC's limit, past it the centre is not meant so
constexpr double kChordSlack = 0.0283;      // mm that a radius may be short of half the chord without a word
constexpr double kSmallestRadius = 1e-9;    // mm; less is a point
constexpr int kMostTurns = 10'000;

}  // namespace

void Interpreter::arc(Turn turn) {
  if (!placement_.plain && modes_.plane != Plane::xy) {
    talker_.error(Code::code_unsupported, line_.column(),
                  "turned or scaled coordinates go with arcs in the XY plane only; the line is left out");
    return line_.use(kAllLetters);
  }
  const std::optional<Place> to = target();
  if (!to) return;
  const bool mirrored = placement_.scale.x * placement_.scale.y < 0.0;
  if (mirrored) turn = turn == Turn::cw ? Turn::ccw : Turn::cw;
  const int extra = extra_turns();
  const std::optional<Point2> centre = centre_of(*to, turn);
  if (!centre || !radii_agree(*to, *centre) || leaves_compensation()) {  // said
    line_.use(Line::bit('I') | Line::bit('J') | Line::bit('K') | Line::bit('R'));
    return cut(*to, feed_for(straight_length(*to)));
  }
  double length = 0.0;
  if (modes_.feed_mode == FeedMode::inverse_time)
    length = walk_arc(here_.at, to->at, *centre, modes_.plane, turn, extra).length();
  const Feed feed = mm_per_min(feed_for(length));
  if (line_.unused('E'))
    return extrude_arc(walk_arc(here_.at, to->at, *centre, modes_.plane, turn, extra), *to, feed);
  if (compensation_.cutter) return compensated_arc(*to, *centre, turn, extra, feed);
  if (add(step::Arc{to->at, *centre, modes_.plane, turn, extra, feed})) arrive(*to);
}

std::optional<Point2> Interpreter::centre_of(const Place& to, Turn turn) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const bool offsets =
      line_.unused(static_cast<char>('I' + axes.u)) || line_.unused(static_cast<char>('I' + axes.v));
  const std::optional<Point2> centre = offsets ? centre_from_offsets() : centre_from_radius(to, turn);
  if (centre && !reachable({centre->x, centre->y, 0.0})) return std::nullopt;
  return centre;
}

std::optional<Point2> Interpreter::centre_from_offsets() {
  const PlaneAxes axes = axes_of(modes_.plane);
  const std::optional<double> u = line_.take(static_cast<char>('I' + axes.u));
  const std::optional<double> v = line_.take(static_cast<char>('I' + axes.v));
  const double first = u.value_or(0.0) * modes_.scale, second = v.value_or(0.0) * modes_.scale;
  if (!modes_.absolute_centres) {
    const Point2 offset = placement_.plain ? Point2{first, second} : turned_offset({first, second});
    return in_name_order(modes_.plane, {here_.at[axes.u] + offset.x, here_.at[axes.v] + offset.y});
  }
  if (!u || !v) {
    talker_.error(
        Code::arc_no_centre, line_.column(),
        "with absolute centres (G90.1) an arc needs both of its centre's words; read as a straight cut");
    return std::nullopt;
  }
  if (!placement_.plain) return placement_.to_path({first, second, 0.0}).xy();
  return in_name_order(modes_.plane, {first + placement_.shift[axes.u], second + placement_.shift[axes.v]});
}

Point2 Interpreter::turned_offset(Point2 offset) const {
  return (placement_.to_path({offset.x, offset.y, 0.0}) - placement_.to_path({})).xy();
}

/// R above 0 is the arc of less than a half turn, below 0 the other one.
std::optional<Point2> Interpreter::centre_from_radius(const Place& to, Turn turn) {
  const std::optional<double> word = line_.take('R');
  if (!word) {
    talker_.error(Code::arc_no_centre, line_.column(),
                  "an arc needs its centre (I J K) or its radius (R); read as a straight cut");
    return std::nullopt;
  }
  const PlaneAxes axes = axes_of(modes_.plane);
  const double radius = *word * modes_.scale * std::abs(placement_.scale.x);
  const Point2 from{here_.at[axes.u], here_.at[axes.v]}, end{to.at[axes.u], to.at[axes.v]};
  const double chord = distance(from, end);
  const double half = 0.5 * chord;
  if (!(half > kSmallestRadius)) {
    talker_.error(
        Code::arc_in_place, line_.column('R'),
        "an arc with a radius ends where it begins, which leaves its centre open; read as a straight cut",
        "a full circle needs I and J");
    return std::nullopt;
  }
  const double shortfall = half - std::abs(radius);
  if (shortfall > kChordSlack && shortfall > kRadiusShare * half) {
    talker_.error(
        Code::arc_radius_too_small, line_.column('R'),
        fmt::format("the radius {:.4g} mm does not reach the arc's end, which is {:.4g} mm away: it "
                    "would have to be {:.4g} mm at least; read as a straight cut",
                    std::abs(radius), chord, half),
        "controllers refuse such an arc");
    return std::nullopt;
  }
  if (shortfall > kChordSlack)
    talker_.unusual(Code::arc_radius_too_small, line_.column('R'),
                    fmt::format("the radius {:.4g} mm does not reach the arc's end, which is {:.4g} mm away; "
                                "read as a half turn",
                                std::abs(radius), chord));
  const double left = (turn == Turn::ccw) == (radius > 0.0) ? 1.0 : -1.0;  // of the chord
  return in_name_order(modes_.plane, from + centre_over_chord(end - from, radius, left));
}

bool Interpreter::radii_agree(const Place& to, Point2 centre) {
  const ArcWalk walk = walk_arc(here_.at, to.at, centre, modes_.plane, Turn::ccw, 0);
  if (!(std::max(walk.start_radius, walk.end_radius) > kSmallestRadius)) {
    talker_.error(Code::arc_no_centre, line_.column(), "an arc of radius 0; read as a straight cut");
    return false;
  }
  const double off = std::abs(walk.start_radius - walk.end_radius);
  const double share = off / std::max(walk.start_radius, walk.end_radius);
  if (off <= kRadiusSlack || share <= kRadiusShare) return true;
  const std::string text = fmt::format("the arc begins {:.4f} mm and ends {:.4f} mm from its centre",
                                       walk.start_radius, walk.end_radius);
  if (off <= kHopelessMismatch) {
    talker_.unusual(Code::arc_radius_mismatch, line_.column(), text);
    return true;
  }
  talker_.error(Code::arc_radius_mismatch, line_.column(), text + "; read as a straight cut",
                modes_.absolute_centres ? "are I J K offsets from the begin (G91.1)?"
                                        : "are I J K absolute coordinates (G90.1)?");
  return false;
}

/// After G40 the tool stands beside the arc's begin.
bool Interpreter::leaves_compensation() {
  if (!compensation_.leaving) return false;
  compensation_.leaving = false;
  talker_.error(Code::compensation_refused, line_.column(),
                "the move after G40 must be straight; read as a straight cut");
  return true;
}

int Interpreter::extra_turns() {
  const std::optional<double> turns = line_.take('P');
  if (!turns) return 0;
  if (*turns >= 1.0 && *turns <= kMostTurns && *turns == std::floor(*turns))
    return static_cast<int>(*turns) - 1;
  talker_.error(Code::word_out_of_range, line_.column('P'),
                fmt::format("the turns of an arc are a whole number from 1 to {}; read as 1", kMostTurns));
  return 0;
}

}  // namespace kerf::gcode

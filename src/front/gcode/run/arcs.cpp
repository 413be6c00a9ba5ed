// Arcs: the centre from I J K or from a radius, turns, and arcs whose words are inconsistent.
//
// Source: LinuxCNC's page "G2, G3 Arc Move"; radii that GRBL refuses are reported.
#include "front/gcode/run/arcs.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"

namespace kerf::gcode {
namespace {

// Programs are rounded. Controllers accept more in large arcs, but the part is off by it.
constexpr ArcMismatch kMismatch{.limit = mm(0.05)};
constexpr double kMaxRadiusMismatch = 2.83;  // mm, LinuxCNC's limit; above it the centre is certainly wrong
constexpr double kChordTolerance =
    0.0283;  // mm by which R may be smaller than half the chord, without a warning
constexpr Length kArcChord = mm(0.002);  // for arcs written as chords
constexpr double kMinRadius = 1e-9;      // mm

/// An offset in program coordinates as one in those of the toolpath.
Point2 rotated_offset(const ProgramFrame& frame, Point2 offset) {
  return (frame.to_path({offset.x, offset.y, 0.0}) - frame.to_path({})).xy();
}

}  // namespace

/// An offset of 0 along the third axis, which some programs write with every arc, has no effect.
void Arcs::use_idle_offset() {
  const char letter = static_cast<char>('I' + axes_of(modes_.plane).w);
  if (line_.value(letter) == 0.0) line_.use(LineWords::bit(letter));
}

void Arcs::arc(Turn turn) {
  use_idle_offset();
  if (!coordinates_.frame().only_shifted && modes_.plane != Plane::xy) return as_chords(turn);
  const bool names_end = line_.has_any(kAxisLetters);
  const std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  if (!names_end && program_.dialect == GcodeDialect::grbl)
    reporter_.unusual(codes::arc_in_place, line_.column(),
                      "GRBL refuses a full circle without an axis word (error 26)", "add its X or Y");
  const bool mirrored = coordinates_.frame().scale.x * coordinates_.frame().scale.y < 0.0;
  if (mirrored) turn = turn == Turn::cw ? Turn::ccw : Turn::cw;
  const int extra = extra_turns();
  const std::optional<Point2> centre = centre_of(coordinates_.frame(), *to, turn);
  if (!centre || !radii_agree(*to, *centre) || refuse_after_compensation()) {  // reported
    line_.use(LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K') | LineWords::bit('R'));
    return mover_.cut(*to, feeds_.feed_for(feeds_.straight_length(*to)));
  }
  double length = 0.0;
  if (modes_.feed_mode == FeedMode::inverse_time)
    length = walk_arc(position_.at, to->at, *centre, modes_.plane, turn, extra).length();
  const Feed feed = mm_per_min(feeds_.feed_for(length));
  if (line_.unused('E'))
    return printer_.extrude_arc(walk_arc(position_.at, to->at, *centre, modes_.plane, turn, extra), *to,
                                feed);
  if (compensation_.is_on()) return compensation_.arc(*to, *centre, turn, extra, feed);
  if (add(step::Arc{to->at, *centre, modes_.plane, turn, extra, feed})) mover_.arrive(*to);
}

/// An arc in XZ or YZ is none of these planes in rotated or scaled coordinates.
void Arcs::as_chords(Turn turn) {
  if (compensation_.is_on() || line_.unused('E')) {
    reporter_.error(
        codes::code_unsupported, line_.column(),
        "with rotated or scaled coordinates, compensated and printed arcs are supported in the XY "
        "plane only; the line is skipped");
    return line_.use(kAllLetters);
  }
  const std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  const int extra = extra_turns();
  const ToolPosition from = position_;
  const ProgramFrame& frame = coordinates_.frame();  // the arc is one in program coordinates
  ToolPosition end = *to;
  end.at = frame.to_program(to->at);
  position_.at = frame.to_program(from.at);
  const std::optional<Point2> centre = centre_of({}, end, turn);
  std::optional<ArcWalk> walk;
  if (centre && radii_agree(end, *centre) && !refuse_after_compensation())
    walk = walk_arc(position_.at, end.at, *centre, modes_.plane, turn, extra);
  position_ = from;
  line_.use(LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K') | LineWords::bit('R'));
  const double feed = feeds_.feed_for(walk ? walk->length() : feeds_.straight_length(*to));
  const int count = walk ? walk->chords(kArcChord) : 1;
  if (!room_for(count)) return;
  for (int i = 1; i < count; ++i) {
    ToolPosition next = *to;
    next.at = coordinates_.frame().to_path(walk->at(static_cast<double>(i) / count));
    mover_.cut(next, feed);
  }
  mover_.cut(*to, feed);
}

/// Whether the arc fits with its I J K as offsets, or as coordinates.
void Arcs::note_evidence(const ToolPosition& to, Point2 words) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const bool is_known = (position_.unknown & (1u << axes.u | 1u << axes.v)) == 0;
  if (modes_.centres_stated || !coordinates_.frame().only_shifted || !is_known) return;
  const Point3 shift = coordinates_.frame().shift;
  const Point2 from = in_plane(position_.at), end = in_plane(to.at);
  const auto fits = [&](Point2 centre) {
    return kMismatch.permits(distance(from, centre), distance(end, centre));
  };
  const bool offset = fits(from + words), absolute = fits(in_plane(shift) + words);
  ArcEvidence& found = program_.arcs;
  if (offset == absolute) {
    found.neither += offset ? 0 : 1;
    return;
  }
  ++(offset ? found.as_offsets : found.as_coordinates);
  if (absolute && found.first_line == 0) found.first_line = reporter_.line();
}

std::optional<Point2> Arcs::centre_of(const ProgramFrame& frame, const ToolPosition& to, Turn turn) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const bool offsets =
      line_.unused(static_cast<char>('I' + axes.u)) || line_.unused(static_cast<char>('I' + axes.v));
  const std::optional<Point2> centre =
      offsets ? centre_from_offsets(frame, to) : centre_from_radius(frame, to, turn);
  if (centre && !reachable({centre->x, centre->y, 0.0})) return std::nullopt;
  return centre;
}

std::optional<Point2> Arcs::centre_from_offsets(const ProgramFrame& frame, const ToolPosition& to) {
  const PlaneAxes axes = axes_of(modes_.plane);
  const std::optional<double> u = line_.take(static_cast<char>('I' + axes.u));
  const std::optional<double> v = line_.take(static_cast<char>('I' + axes.v));
  const double first = u.value_or(0.0) * modes_.scale, second = v.value_or(0.0) * modes_.scale;
  note_evidence(to, {first, second});
  if (!modes_.absolute_centres) {
    const Point2 offset = frame.only_shifted ? Point2{first, second} : rotated_offset(frame, {first, second});
    return in_name_order(modes_.plane, {position_.at[axes.u] + offset.x, position_.at[axes.v] + offset.y});
  }
  if (!u || !v) {
    reporter_.error(
        codes::arc_no_centre, line_.column(),
        "with absolute centres (G90.1) an arc needs both words of its centre; read as a straight cut");
    return std::nullopt;
  }
  if (!frame.only_shifted) return frame.to_path({first, second, 0.0}).xy();
  return in_name_order(modes_.plane, {first + frame.shift[axes.u], second + frame.shift[axes.v]});
}

/// R > 0: the arc of less than a half turn; R < 0: the other one.
std::optional<Point2> Arcs::centre_from_radius(const ProgramFrame& frame, const ToolPosition& to, Turn turn) {
  const std::optional<double> word = line_.take('R');
  if (!word) {
    reporter_.error(codes::arc_no_centre, line_.column(),
                    "an arc needs its centre (I J K) or its radius (R); read as a straight cut");
    return std::nullopt;
  }
  const PlaneAxes axes = axes_of(modes_.plane);
  const double radius = *word * modes_.scale * std::abs(frame.scale.x);
  const Point2 from{position_.at[axes.u], position_.at[axes.v]}, end{to.at[axes.u], to.at[axes.v]};
  const double chord = distance(from, end);
  const double half = 0.5 * chord;
  if (!(half > kMinRadius)) {
    reporter_.error(codes::arc_in_place, line_.column('R'),
                    "the end point of an arc with R is its start point, so its centre is undefined; read as "
                    "a straight cut",
                    "a full circle needs I and J");
    return std::nullopt;
  }
  const double shortfall = half - std::abs(radius);
  if (shortfall > kChordTolerance && shortfall > kMismatch.relative * half) {
    reporter_.error(
        codes::arc_radius_too_small, line_.column('R'),
        fmt::format("the radius {:.4g} mm is too small for an arc whose end point is {:.4g} mm away: the "
                    "minimum is {:.4g} mm; read as a straight cut",
                    std::abs(radius), chord, half),
        "controllers refuse such an arc");
    return std::nullopt;
  }
  if (shortfall > kChordTolerance)
    reporter_.unusual(
        codes::arc_radius_too_small, line_.column('R'),
        fmt::format("the radius {:.4g} mm is too small for an arc whose end point is {:.4g} mm away; "
                    "read as a half turn",
                    std::abs(radius), chord));
  const double left = (turn == Turn::ccw) == (radius > 0.0) ? 1.0 : -1.0;  // of the chord
  return in_name_order(modes_.plane, from + centre_over_chord(end - from, radius, left));
}

bool Arcs::radii_agree(const ToolPosition& to, Point2 centre) {
  const ArcWalk walk = walk_arc(position_.at, to.at, centre, modes_.plane, Turn::ccw, 0);
  if (!(std::max(walk.start_radius, walk.end_radius) > kMinRadius)) {
    reporter_.error(codes::arc_no_centre, line_.column(), "an arc of radius 0; read as a straight cut");
    return false;
  }
  const double off = std::abs(walk.start_radius - walk.end_radius);
  if (kMismatch.permits(walk.start_radius, walk.end_radius)) return true;
  const std::string text = fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre",
                                       walk.start_radius, walk.end_radius);
  if (off <= kMaxRadiusMismatch) {
    reporter_.unusual(codes::arc_radius_mismatch, line_.column(), text);
    return true;
  }
  reporter_.error(codes::arc_radius_mismatch, line_.column(), text + "; read as a straight cut",
                  modes_.absolute_centres ? "are I J K offsets from the start (G91.1)? see --arc-centres"
                                          : "are I J K absolute coordinates (G90.1)? see --arc-centres");
  return false;
}

/// After G40 the tool is not at the start point of the arc yet.
bool Arcs::refuse_after_compensation() {
  if (!compensation_.stop_leaving()) return false;
  reporter_.error(codes::compensation_refused, line_.column(),
                  "the motion after G40 must be straight; read as a straight cut");
  return true;
}

int Arcs::extra_turns() {
  const std::optional<double> turns = line_.take('P');
  if (!turns) return 0;
  if (*turns >= 1.0 && *turns <= limits::kMaxTurns && *turns == std::floor(*turns))
    return static_cast<int>(*turns) - 1;
  reporter_.error(
      codes::word_out_of_range, line_.column('P'),
      fmt::format("the turns of an arc (P) are an integer from 1 to {}; assuming 1", limits::kMaxTurns));
  return 0;
}

}  // namespace kerf::gcode

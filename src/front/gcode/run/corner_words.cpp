// Corners between straight cuts: the points where they start and end, and their motions.
//
// Source: Fanuc, Series 30i operator's manual, "Optional chamfering and corner R"; Haas, mill operator's
// manual, G01 with ",C" and ",R".
#include "front/gcode/run/corner_words.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr double kMinCut = 1e-9;        // mm; a shorter motion has no direction
constexpr double kStraightSine = 1e-9;  // of the angle between two lines that have no corner

}  // namespace

bool CornerWords::hold(const ToolPosition& to, double feed) {
  if (!is_fanuc(program_.dialect)) return false;
  const std::optional<CornerWord> word = line_.take_corner();
  if (!word) return false;
  const double size = word->size * modes_.scale * std::abs(coordinates_.frame().scale.x);
  if (!(size > 0.0)) {
    if (size < 0.0)
      reporter_.error(codes::word_out_of_range, word->column,
                      "the size of a corner must not be negative; skipped");
    return false;
  }
  held_ = Held{position_, to, size, word->is_round, feed, mover_.named(), reporter_.line(), word->column};
  position_ = to;
  return true;
}

/// Empty if the two cuts can have a corner.
std::string_view CornerWords::why_not(const Held& held, const ToolPosition& next) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  const double w = held.to.at[axes.w];
  if (held.from.at[axes.w] != w || next.at[axes.w] != w) return "both cuts must be in the plane";
  const unsigned unknown = held.from.unknown | held.to.unknown | next.unknown;
  if ((unknown & (1u << axes.u | 1u << axes.v)) != 0) return "a position of its cuts is unknown";
  if (coordinates_.frame().scale.x != coordinates_.frame().scale.y) return "the axes are scaled differently";
  return {};
}

std::optional<CornerWords::Shape> CornerWords::shape(const Held& held, const ToolPosition& next) {
  if (const std::string_view why = why_not(held, next); !why.empty()) {
    report(held, why);
    return std::nullopt;
  }
  const Point2 corner = in_plane(held.to.at);
  const Point2 back = in_plane(held.from.at) - corner, on = in_plane(next.at) - corner;
  const double before = length(back), after = length(on);
  if (!(before > kMinCut) || !(after > kMinCut)) {
    report(held, "a cut has no length in the plane");
    return std::nullopt;
  }
  const Point2 u = (1.0 / before) * back, v = (1.0 / after) * on;
  const double sine = cross(v, u), cosine = dot(u, v);
  if (std::abs(sine) < kStraightSine) {
    report(held, cosine < 0.0 ? "the cuts have the same direction" : "the second cut goes back");
    return std::nullopt;
  }
  // The tangent of half the angle between the two lines is sin / (1 + cos).
  const double taken = held.is_round ? held.size * (1.0 + cosine) / std::abs(sine) : held.size;
  if (taken > std::min(before, after) + kMinCut) {
    report(held, fmt::format("it takes {:.4g} mm of cuts of {:.4g} and {:.4g} mm", taken, before, after));
    return std::nullopt;
  }
  Shape made;
  made.to_left = sine > 0.0;
  made.start = corner + taken * u;
  made.end = corner + taken * v;
  const Point2 to_centre = made.to_left ? left_of(-u) : -left_of(-u);
  made.centre = made.start + held.size * to_centre;
  return made;
}

void CornerWords::report(const Held& held, std::string_view why) {
  reporter_.error(codes::corner_refused, held.column, fmt::format("the corner is left sharp: {}", why));
}

void CornerWords::add_cut(const ToolPosition& to, double feed) {
  if (compensation_.is_on())
    compensation_.line(to, MotionKind::cut, feed);
  else
    mover_.cut(to, feed);
}

void CornerWords::add_corner(const Held& held, const Shape& corner) {
  ToolPosition at = held.to;
  at.at = with_plane_position(held.to.at, corner.start);
  add_cut(at, held.feed);
  mover_.set_named(0);
  at.at = with_plane_position(held.to.at, corner.end);
  if (!held.is_round) return add_cut(at, held.feed);
  const Turn turn = corner.to_left ? Turn::ccw : Turn::cw;
  const Point2 centre = in_name_order(modes_.plane, corner.centre);
  const Feed feed = mm_per_min(held.feed);
  if (compensation_.is_on()) return compensation_.arc(at, centre, turn, 0, feed);
  if (add(step::Arc{at.at, centre, modes_.plane, turn, 0, feed})) mover_.arrive(at);
}

void CornerWords::turn_to(const ToolPosition& to) {
  if (held_) release(&to);
}

/// Adds what is held back, with its own line as origin.
void CornerWords::release(const ToolPosition* next) {
  const Held held = *std::exchange(held_, std::nullopt);
  const std::uint32_t line = reporter_.line();
  const unsigned named = mover_.named();
  reporter_.at_line(held.line);
  std::optional<Shape> corner;
  if (next != nullptr)
    corner = shape(held, *next);
  else
    report(held, "the next line is no straight cut");
  position_ = held.from;
  mover_.set_named(compensation_.is_on() ? 0 : held.named);
  if (corner)
    add_corner(held, *corner);
  else
    add_cut(held.to, held.feed);
  reporter_.at_line(line);
  mover_.set_named(named);
}

void CornerWords::finish_before_line() {
  if (!held_) return;
  constexpr std::uint32_t kContinuing = LineWords::bit(Group::motion) | LineWords::bit(Group::distance);
  const Tenths motion = line_.has(Group::motion) ? line_.code(Group::motion) : modes_.motion;
  if (motion != 10 || !line_.has_only(kContinuing) || !line_.has_any(kAxisLetters)) finish();
}

void CornerWords::finish() {
  if (held_) release(nullptr);
}

}  // namespace kerf::gcode

// The motions of circular pockets.
//
// Sources: Haas, Mill Operator's Manual, "G12 Circular Pocket Milling CW / G13 Circular Pocket Milling CCW";
// Mach3, "Using Mach3Mill", "Clockwise/counterclockwise circular pocket". Haas states the circles, not how
// the tool gets from one to the next: half a circle leads to the first and back from the last, which stays
// within the pocket.
#include "front/gcode/run/circular_pockets.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

constexpr double kRadiusSlack = 1e-9;  // mm

}  // namespace

void CircularPockets::mill() {
  const Turn turn = line_.code(Group::reference) == 120 ? Turn::cw : Turn::ccw;
  if (!accepts()) return line_.use(kAllLetters);
  if (program_.dialect == GcodeDialect::mach3) return mill_as_mach3(turn);
  mill_as_haas(turn);
}

void CircularPockets::refuse(std::uint32_t column, std::string what) {
  reporter_.error(
      codes::word_out_of_range, column,
      fmt::format("{}: {}; the line is skipped", code_text('G', line_.code(Group::reference)), what));
  line_.use(kAllLetters);
}

bool CircularPockets::accepts() {
  if (modes_.plane == Plane::xy && !compensation_.is_on()) return true;
  reporter_.error(codes::code_unsupported, line_.column(),
                  "circular pockets are read in the XY plane and without cutter compensation only; skipped");
  return false;
}

std::optional<double> CircularPockets::length_word(char letter) {
  const std::optional<double> word = line_.take(letter);
  return word ? std::optional(*word * modes_.scale) : std::nullopt;
}

/// Out along X by I, a circle, and back to the centre.
void CircularPockets::mill_as_mach3(Turn turn) {
  const double radius = length_word('I').value_or(0.0);
  if (!(radius > 0.0)) return refuse(line_.column(), "I, the radius, must be positive");
  const double x = position_.at.x;
  const double feed = feeds_.feed_for(2.0 * radius * (1.0 + std::numbers::pi));
  cut_to(x + radius, feed);
  arc_to(x + radius, x, turn, feed);
  cut_to(x, feed);
}

/// X and Y are the centre, Z is the depth; L repeats an incremental Z.
void CircularPockets::mill_as_haas(Turn turn) {
  const std::optional<std::vector<double>> circles = radii();
  if (!circles) return;
  const double repeats = line_.take('L').value_or(1.0);
  if (!(repeats >= 1.0 && repeats <= limits::kMaxHoles && repeats == std::floor(repeats)))
    return refuse(line_.column('L'), "L, the repeats, is a whole number from 1");
  const std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  const double step = to->at.z - position_.at.z;
  ToolPosition centre = *to;
  centre.at.z = position_.at.z;
  centre.unknown |= position_.unknown & 4u;
  if (centre.at.x != position_.at.x || centre.at.y != position_.at.y) mover_.rapid(centre);
  const double feed = feeds_.feed_for(2.0 * std::numbers::pi * circles->back());
  for (double level = 1.0; level <= repeats && steps_.has_room(); level += 1.0) {
    ToolPosition bottom = *to;
    if (!modes_.absolute) bottom.at.z += (level - 1.0) * step;
    if (!reachable(bottom.at)) return;
    if (bottom.at != position_.at || bottom.unknown != position_.unknown) mover_.cut(bottom, feed);
    mill_level(*circles, turn, feed);
  }
}

/// The radii of the tool's circles: from I to K in steps of Q, less the tool's radius.
std::optional<std::vector<double>> CircularPockets::radii() {
  const std::optional<double> first = length_word('I'), last = length_word('K'), step = length_word('Q');
  const std::optional<double> diameter = compensation_.diameter_of_tool(line_.take('D'));
  const auto refused = [this](char letter, std::string what) {
    refuse(line_.has(letter) ? line_.column(letter) : line_.column(), std::move(what));
    return std::nullopt;
  };
  if (!diameter) {
    line_.use(kAllLetters);
    return std::nullopt;
  }
  const double tool = 0.5 * *diameter;
  if (!first || *first - tool < kRadiusSlack)
    return refused('I', fmt::format("I, the radius, must be above that of the tool, {:.4g} mm", tool));
  if (last && *last < *first) return refused('K', "K, the last radius, must be at least I");
  if (last && *last > *first && !(step.value_or(0.0) > 0.0))
    return refused('Q', "K needs Q, the distance of the circles");
  const double count = last && *last > *first ? std::ceil((*last - *first) / *step - kRadiusSlack) : 0.0;
  if (!room_for(3.0 + 2.0 * count)) return std::nullopt;
  std::vector<double> all;
  for (double i = 0.0; i < count; i += 1.0) all.push_back(*first + i * *step - tool);
  all.push_back(last.value_or(*first) - tool);
  return all;
}

void CircularPockets::mill_level(const std::vector<double>& radii, Turn turn, double feed) {
  const double x = position_.at.x;
  arc_to(x + radii.front(), x + 0.5 * radii.front(), turn, feed);
  for (const double radius : radii) {
    if (position_.at.x != x + radius) cut_to(x + radius, feed);
    arc_to(x + radius, x, turn, feed);
  }
  arc_to(x, x + 0.5 * radii.back(), turn, feed);
}

void CircularPockets::cut_to(double x, double feed) {
  ToolPosition to = position_;
  to.at.x = x;
  if (reachable(to.at)) mover_.cut(to, feed);
}

/// An arc to `x` at the same Y, about a centre at the same Y; a full circle where the tool is there already.
void CircularPockets::arc_to(double x, double centre_x, Turn turn, double feed) {
  ToolPosition to = position_;
  to.at.x = x;
  if (!reachable(to.at)) return;
  if (add(step::Arc{to.at, {centre_x, to.at.y}, Plane::xy, turn, 0, mm_per_min(feed)})) mover_.arrive(to);
}

}  // namespace kerf::gcode

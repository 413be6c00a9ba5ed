// What a stored step may be.
#include <algorithm>
#include <cmath>

#include "job/stored/access.h"

#include "kerf/base/limits.h"

namespace kerf::stored {
namespace {

bool is_number(double v) { return std::abs(v) <= limits::kMaxResult; }

/// The fault of what a row's kind makes of its members; empty: none. No default: a new kind is added here.
std::string_view fault_of_kind(const Row& row, const Tables& tables) {
  const std::uint32_t plane = row.plane, turn = row.turn;
  const auto unless = [](bool is_good, std::string_view fault) {
    return is_good ? std::string_view() : fault;
  };
  const bool has_text = row.count >= 0 && static_cast<std::size_t>(row.count) < tables.texts;
  const bool is_numbered = row.count >= -1 && row.count <= limits::kMaxToolNumber;
  switch (row.kind) {
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::dwell:
    case StepKind::close_path: return {};
    case StepKind::arc:
      return unless(plane < 3 && turn < 2 && row.count >= 0 && row.count <= limits::kMaxTurns, "an arc");
    case StepKind::tool_change: return unless(plane < 2 && is_numbered, "a tool change");
    case StepKind::spindle: return unless(turn < 3, "a spindle step");
    case StepKind::coolant: return {};
    case StepKind::path_mode: return unless(plane < 3, "a path mode");
    case StepKind::probe: return unless(plane < 4, "a probe");
    case StepKind::extrude:
      return unless(row.count >= 0 && static_cast<std::size_t>(row.count) < tables.beads, "a bead");
    case StepKind::temperature: return unless(plane < 3 && turn < 2 && is_numbered, "a temperature");
    case StepKind::fan:
    case StepKind::extruder: return unless(is_numbered, "a fan or extruder");
    case StepKind::laser_power: return unless(plane < 3, "a laser's power");
    case StepKind::layer: return unless(has_text && std::abs(row.values[0]) <= 1e9, "a layer");
    case StepKind::note:
    case StepKind::unresolved: return unless(plane < 2 && has_text, "a text");
    case StepKind::verbatim: return unless(has_text, "a text");
    case StepKind::pause: return unless(plane < 3, "a pause");
    case StepKind::end: return unless(turn < 2, "an end");
    case StepKind::store_home: return unless(plane == 2 || plane == 3, "a stored home");
    case StepKind::work_zero:
      return unless(plane < 7 && row.count >= 1 && row.count <= 9 && row.named_axes < 8 &&
                        (row.frame >> 6) == 0 && (row.frame >> 3 & ~row.named_axes) == 0,
                    "a work offset");
    case StepKind::tool_length:
      return unless(plane < 3 && is_numbered && row.named_axes < 8, "a tool length");
    case StepKind::motion_limits: {
      const auto is_limit = [](double v) { return v >= 0.0; };
      return unless(
          plane < 6 && row.frame < 16 && std::all_of(row.values.begin(), row.values.end(), is_limit),
          "limits of motions");
    }
  }
  return "a step of an unknown kind";
}

bool has_position(StepKind kind) {
  return kind <= StepKind::arc || kind == StepKind::probe || kind == StepKind::extrude;
}

}  // namespace

std::string_view fault_of(const Row& row, const Tables& tables) {
  if (row.kind > StepKind::extruder) return "a step of an unknown kind";
  if (!std::all_of(row.values.begin(), row.values.end(), is_number)) return "a number that is too large";
  if (row.origin >= tables.origins || row.extra >= tables.extras) return "a reference";
  const bool is_motion = has_position(row.kind);
  if (!is_motion && (row.extra != 0 || row.rests_before != 0)) return "an axis of no motion";
  if (is_motion && (row.reference > 5 || (row.frame >> 6) != 0 || (row.frame >> 3 & ~row.frame & 7u) != 0))
    return "the axes of a motion";
  return fault_of_kind(row, tables);
}

}  // namespace kerf::stored

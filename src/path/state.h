// The state in force at a step of a toolpath, and the steps that restore it.
//
//   StateReader before(path);
//   before.to(first);                      // the state that step `first` finds
//   const PathState wanted = before.state();
//   ...
//   const StateParts lost = restore(now, wanted, kAllState, origin, out);
//
// Feeds and the planes of arcs are no part of it: each motion has its own. Frame and units as in toolpath.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kerf/path/toolpath.h"

namespace kerf {

/// The parts of a state, as bits of a set.
enum class StatePart : std::uint8_t {
  work_zero,    // the selected work offset, and the offsets that the program sets
  tool,         // and its number
  tool_length,  // compensation (G43, G49)
  path_mode,
  spindle,
  coolant,
  laser,
  rotary,  // the angles of A, B, C
  limits,  // of a printer's motions
  extruder,
  temperature,
  fan,
  filament,  // how much is drawn back
  layer,     // of a drawing
};
inline constexpr int kStateParts = 14;
using StateParts = unsigned;
constexpr StateParts bit_of(StatePart part) { return 1u << static_cast<unsigned>(part); }
inline constexpr StateParts kAllState = (1u << kStateParts) - 1;
/// "work offset", "path mode": for messages.
std::string_view to_string(StatePart part);
/// "the spindle, the coolant"; empty for no part.
std::string to_text(StateParts parts);

/// Offsets of G54 to G59.3 as the program has set them. Index 1 to 9.
struct WorkOffset {
  unsigned axes = 0;     // bits: set by the program
  Point3 zero = {};      // as step::WorkZero::zero
  bool by_tool = false;  // set at the position of the tool: cannot be restored elsewhere
  bool operator==(const WorkOffset&) const = default;
};

/// Of an extruder.
struct DrawnBack {
  double volume = 0.0;       // mm3
  bool by_firmware = false;  // and as far as G10 does
};

/// Nothing where no step has stated it yet: the machine is as its operator has left it. Spindle, coolant and
/// laser are off then.
struct PathState {
  PathPosition position;
  std::optional<step::ToolChange> tool;
  std::optional<step::ToolLength> length;
  std::optional<step::PathMode> path_mode;
  std::optional<step::Spindle> spindle;
  std::optional<step::Coolant> coolant;
  std::optional<step::LaserPower> laser;
  std::optional<step::WorkZero> selected;
  std::array<WorkOffset, 10> offsets{};
  std::size_t shifts = 0;       // steps so far that shift all coordinates (G92)
  unsigned unrelated = 0;       // axes on which the distance of two selected offsets is unknown
  std::array<double, 3> abc{};  // degrees
  unsigned unknown_abc = 7;     // bits 1, 2, 4: A, B, C
  std::map<LimitKind, step::MotionLimits> limits;
  std::optional<int> extruder;
  int extruder_in_use() const { return extruder.value_or(0); }  // firmwares start with the first one
  std::map<std::pair<Heater, int>, step::Temperature> temperatures;
  std::map<int, double> fans;
  std::map<int, DrawnBack> drawn_back;  // filament, by extruder
  Feed retraction;                      // of the last filament that moved while the nozzle was at rest
  std::optional<step::Layer> layer;

  /// Changes it as step `i` does.
  void pass(const Toolpath& path, std::size_t i);
  /// Of the extruder in use.
  DrawnBack filament() const;
};

/// The parts in which two states differ. What has not been stated equals "off" of spindle, coolant and laser.
StateParts difference(const PathState& a, const PathState& b);
/// The part that a step sets; 0 for motions (which set the position, angles and filament) and for steps
/// without a state.
StateParts part_set_by(const Step& step);
/// The parts that steps `first` to `end` set, before a motion other than a rapid finds them.
StateParts set_before_cut(const Toolpath& path, std::size_t first, std::size_t end);

/// Walks along a path; time is that of the steps passed.
class StateReader {
 public:
  explicit StateReader(const Toolpath& path) : path_(&path) {}
  /// Passes the steps before number `end`; must not go back.
  void to(std::size_t end);
  /// After the steps passed so far.
  const PathState& state() const { return state_; }

 private:
  const Toolpath* path_;
  std::size_t next_ = 0;
  PathState state_;
};

/// Appends steps that make `parts` of the state `now` those of `wanted`; `now` becomes the state after them.
/// Returns the parts that cannot be restored: what is to become unstated again, a zero at the position of the
/// tool, filament of other extruders or where the position is unknown. Rotary axes turn by a rapid in place,
/// where the position is known or only Z is (see step::Rapid); the caller moves the tool away from the work
/// before and to the position of `wanted` after it.
StateParts restore(PathState& now, const PathState& wanted, StateParts parts, OriginId origin, Toolpath& out);

}  // namespace kerf

// The toolpath: the common representation between all inputs and all outputs.
//
// A toolpath is a list of steps. Positions are complete, absolute, in mm and work coordinates (rotary axes in
// degrees); nothing is modal or specific to a controller. Arcs stay arcs. Every step has an origin: the line,
// drawing entity or call that caused it. A step has 64 bytes, an origin 16 more.
//
//   Toolpath path;
//   auto here = path.origins().add(CallLocation{.call = "example"});
//   path.add(step::ToolChange{102}, here);
//   path.add(step::Spindle{rpm(16000), SpindleTurn::cw}, here);
//   path.add(step::Rapid{{0, 0, 5}}, here);
//   path.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, here);
//   path.add(step::Arc{.to = {10, 0, -1}, .centre = {5, 0}, .turn = Turn::cw, .feed = mm_per_min(400)},
//   here);
//
// Directions of rotation as in RS274/NGC section 3.5.3.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "kerf/base/origin.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"

namespace kerf {

namespace stored {
struct Access;  // of files, which store every member (src/job/stored)
}

enum class SpindleTurn : std::uint8_t { off, cw, ccw };
enum class PathModeKind : std::uint8_t { exact_path, exact_stop, blend };
enum class Heater : std::uint8_t { nozzle, bed, chamber };
enum class LaserMode : std::uint8_t { off, constant, dynamic };
/// What a bead is part of, as slicers name it. `wall` is an inner wall, `solid_infill` includes bottoms.
enum class BeadKind : std::uint8_t {
  none,
  skirt,
  outer_wall,
  wall,
  overhang,
  infill,
  solid_infill,
  top,
  bridge,
  gap_fill,
  ironing,
  support,
  support_interface,
  purge,
  custom,
};
inline constexpr std::size_t kBeadKinds = 15;
/// "outer_wall", as in JSON and Python; "" for none.
std::string_view to_string(BeadKind kind);
/// A limit of a printer's motions; see step::MotionLimits.
enum class LimitKind : std::uint8_t {
  axis_acceleration,  // X, Y, Z, E, mm/s2 (M201)
  axis_speed,         // X, Y, Z, E, mm/s (M203)
  acceleration,       // of beads, of retractions, of travel, mm/s2 (M204 P, R, T)
  jerk,  // X, Y, Z, E, mm/s: the change of speed without acceleration (M205; M566 of RepRapFirmware)
  junction_deviation,  // mm, the first value only (M205 J)
  corner_speed,        // mm/s at a corner of 90 degrees, the first value only (Klipper)
};
/// "axis_acceleration" and so on, as in JSON and Python.
std::string_view to_string(LimitKind kind);
/// Probing: the event that ends the motion (contact made or lost) and whether its absence is an error
/// (G38.2-G38.5).
enum class ProbeKind : std::uint8_t { contact_or_error, contact, release_or_error, release };
/// Where a pause (M0, M1, M60) waits: always, only if the operator's switch is set, or with a change of
/// pallets.
enum class PauseKind : std::uint8_t { always, optional, pallet_change };
/// What a motion's position is given in: work coordinates, machine coordinates (G53), as the position that
/// the controller stores as its home (G28, G30), as the end switches of the axes (a printer's G28), or as a
/// value that the controller computes from what it has measured.
enum class Reference : std::uint8_t { work, machine, home, second_home, end_switches, measured };
/// A tool change, or only the number of the tool that is in the spindle already (M61).
enum class ToolChangeKind : std::uint8_t { change, number_only };
/// A comment, or a message that the controller shows.
enum class NoteKind : std::uint8_t { comment, message };
/// Tool length compensation: none (G49), from the controller's tool table (G43), or the length itself
/// (G43.1).
enum class ToolLengthKind : std::uint8_t { none, table, given };
enum class UnresolvedKind : std::uint8_t { values, code };
/// What sets the zero of the controller's coordinates: the selection of a work offset (G54 to G59.3), an
/// offset in machine coordinates (G10 L2), the coordinates of the present position in a work offset (G10 L20)
/// or by a shift of all of them (G92), and the end, pause and return of that shift (G92.1, G92.2, G92.3).
enum class ZeroKind : std::uint8_t { select, offset, here, shift, shift_off, shift_paused, shift_on };

namespace step {

/// A move at rapid speed; the tool must not touch material.
struct Rapid {
  Point3 to;
};
/// A straight move at feed.
struct Cut {
  Point3 to;
  Feed feed;
};
/// An arc, or a helix where the third axis moves. `centre` is absolute, in the order of the plane's name (XZ:
/// x, z).
struct Arc {
  Point3 to;
  Point2 centre;
  Plane plane = Plane::xy;
  Turn turn = Turn::ccw;
  int extra_turns = 0;  // whole circles beyond the first arrival at `to`
  Feed feed;
};
struct Dwell {
  Duration time;
};
struct ToolChange {
  int tool = 0;
  ToolChangeKind kind = ToolChangeKind::change;
};
/// With a surface speed (G96) the controller sets the rpm by the distance of the tool from X0: they are
/// unknown, and `speed` is their limit, 0 = none given.
struct Spindle {
  SpindleSpeed speed;
  SpindleTurn turn = SpindleTurn::off;
  Feed surface_speed = {};  // of the cutting edge; 0: `speed` is the speed
  bool operator==(const Spindle&) const = default;
};
struct Coolant {
  bool mist = false;
  bool flood = false;
};
/// How corners are run; `tolerance` is the permitted distance from the path when blending, 0 = none given.
struct PathMode {
  PathModeKind kind = PathModeKind::exact_path;
  Length tolerance;
};
/// Moves towards `to` until contact. Where that is, is unknown: after the step all axes are, unless
/// Toolpath::set_probed_axes() names those that move.
struct Probe {
  Point3 to;
  Feed feed;
  ProbeKind kind = ProbeKind::contact_or_error;
};
/// A straight move that lays a bead of `volume` mm3; below 0: retracts filament. 0 by 0: size unknown.
struct Extrude {
  Point3 to;
  Volume volume;
  Length width;
  Length height;
  Feed feed;
  BeadKind kind = BeadKind::none;
};
struct Temperature {
  Heater heater = Heater::nozzle;
  double celsius = 0.0;
  bool wait = false;
  int extruder = -1;  // whose nozzle; -1: that of the extruder in use
};
/// The extruder that lays the beads from here on. A print that names none has only one, or uses the first.
struct Extruder {
  int number = 0;
};
struct Fan {
  int fan = 0;
  double fraction = 0.0;  // 0 to 1
};
/// The firmware of a printer plans the motions that follow with these limits; values that are not given stay.
struct MotionLimits {
  LimitKind kind = LimitKind::acceleration;
  std::array<double, 4> values{};  // see LimitKind
  unsigned given = 0;              // bits 1, 2, 4, 8 of `values`
};
struct LaserPower {
  LaserMode mode = LaserMode::off;
  double power = 0.0;  // in the units of the program's S word
};
struct Layer {
  std::string name;
  int colour = 256;  // AutoCAD colour index, 256 = by layer
};
struct Note {
  std::string text;
  NoteKind kind = NoteKind::comment;
};
/// The machine waits for the operator (M0, M1, M60).
struct Pause {
  PauseKind kind = PauseKind::always;
};
/// The program ends (M2); `rewind`: and is ready to run again (M30).
struct End {
  bool rewind = false;
};
/// The drawn contour returns to its start point. It matters to drawings only: the tool does not
/// move.
struct ClosePath {};
/// The controller stores the present position as its home or second home (G28.1, G30.1), where later motions
/// with that reference lead.
struct StoreHome {
  Reference home = Reference::home;
};
/// The controller's coordinates change, the tool does not move. Only posts need the zero: positions of the
/// toolpath do not depend on it. Where the relation of the new coordinates to the old ones is unknown, so is
/// the position afterwards.
struct WorkZero {
  ZeroKind kind = ZeroKind::select;
  int system = 1;        // 1 to 9: G54 to G59.3
  unsigned axes = 0;     // bits 1, 2, 4: X, Y, Z are given
  Point3 zero = {};      // of the controller's coordinates in `system` after it, in those of the toolpath
  Point3 at = {};        // the present position on `axes` (here, shift)
  unsigned known = 0;    // axes of unknown position that are at `at` from here on
  unsigned unknown = 0;  // axes whose position is unknown from here on
};
/// How the controller accounts for the length of the tool. The toolpath is that of the tip.
struct ToolLength {
  ToolLengthKind kind = ToolLengthKind::none;
  int number = -1;     // of the entry in the tool table (H); -1: the tool's own
  Point3 offset = {};  // mm, of a given length
  unsigned axes = 0;   // of `offset` that are given
};
/// Something whose effect is unknown. `values`: from here on the program depends on values known only at
/// run time, such as the result of a probe in a condition; the toolpath continues with assumed ones,
/// and posts refuse it. `code`: a code that was left out and may have moved the tool, whose position is
/// unknown.
struct Unresolved {
  std::string text;  // for messages
  UnresolvedKind kind = UnresolvedKind::values;
};
/// A line that is passed to the controller unchanged, such as a macro call or a message on a display. It must
/// neither move the machine nor change how other lines are read; this is the responsibility of the caller.
struct Verbatim {
  std::string text;
};

}  // namespace step

enum class StepKind : std::uint8_t {
  rapid,
  cut,
  arc,
  dwell,
  tool_change,
  spindle,
  coolant,
  path_mode,
  probe,
  extrude,
  temperature,
  fan,
  laser_power,
  layer,
  note,
  verbatim,
  pause,
  end,
  close_path,
  store_home,
  work_zero,
  tool_length,
  unresolved,
  motion_limits,
  extruder,
};
/// The name used in `kerf steps`: "rapid", "cut", "tool", "pathmode" and so on.
std::string_view name_of(StepKind kind);

/// One step, packed. Read it through `kind()` and the typed getters, which assert the kind; texts and beads
/// are stored in the Toolpath (`Toolpath::layer()`, `text()`, `extrude()`).
class Step {
 public:
  StepKind kind() const { return kind_; }
  OriginId origin() const { return origin_; }

  /// True for rapid, cut, arc, probe and extrude: the kinds that have an end position.
  bool is_motion() const {
    return kind_ <= StepKind::arc || kind_ == StepKind::probe || kind_ == StepKind::extrude;
  }
  /// True for cutting motions: cut and arc (a probe touches, it does not cut).
  bool is_cutting() const { return kind_ == StepKind::cut || kind_ == StepKind::arc; }
  Point3 to() const { return {values_[0], values_[1], values_[2]}; }
  /// Feed of a cut, arc, probe or extrude; zero if the program gave none.
  Feed feed() const { return Feed::raw(values_[3]); }
  /// Bits 1, 2, 4: X, Y, Z at the end of this motion is unknown in work coordinates (not yet commanded,
  /// commanded in machine coordinates, moved by a probe). `to()` then has the value of an interpreter with
  /// zero offsets. Where the start is unknown too, and the axis is none of `reference_axes()`, it moves by
  /// the difference to the start.
  unsigned unknown_axes() const { return frame_ & 7u; }
  /// The reference of `reference_axes()` (bits as above). Those axes are unknown ones. With Reference::work,
  /// only of probes, `to()` is known although the end is not.
  Reference reference() const { return static_cast<Reference>(reference_); }
  unsigned reference_axes() const { return (frame_ >> 3) & 7u; }
  /// Bits 1, 2, 4, 8, 16, 32: the program named X, Y, Z, A, B, C for this motion; 0: not specified.
  /// `to()` is complete either way. Only posts that reproduce the user's words may use it.
  unsigned named_axes() const { return named_axes_; }
  /// The controller stops before this motion for a reason without a step (the work offset changes).
  bool rests_before() const { return rests_before_; }

  step::Rapid rapid() const;
  step::Cut cut() const;
  step::Arc arc() const;
  step::Dwell dwell() const;
  step::ToolChange tool_change() const;
  step::Spindle spindle() const;
  step::Coolant coolant() const;
  step::PathMode path_mode() const;
  step::Probe probe() const;
  step::Temperature temperature() const;
  step::Extruder extruder() const;
  step::Fan fan() const;
  step::MotionLimits motion_limits() const;
  step::LaserPower laser_power() const;
  step::Pause pause() const;
  step::End end() const;
  step::StoreHome store_home() const;
  step::WorkZero work_zero() const;
  step::ToolLength tool_length() const;
  UnresolvedKind unresolved() const;
  NoteKind note_kind() const;

 private:
  friend class Toolpath;
  friend struct stored::Access;
  std::array<double, 6> values_{};
  std::int32_t count_ = 0;  // extra turns, number of a tool, fan or work offset, index of a text or bead
  OriginId origin_ = OriginId::none;
  std::uint32_t extra_ = 0;  // index into the toolpath's extras, 0 = none
  StepKind kind_ = StepKind::rapid;
  std::uint8_t plane_ : 3 = 0;  // Plane, or the kind's own small enumeration
  std::uint8_t reference_ : 3 = 0;
  bool rests_before_ : 1 = false;
  std::uint8_t turn_ : 2 = 0;  // Turn or SpindleTurn, or two flags
  std::uint8_t named_axes_ : 6 = 0;
  std::uint8_t frame_ = 0;  // from the low end: 3 bits unknown axes, 3 bits reference (or known) axes; of
                            // limits: the values given
};
static_assert(sizeof(Step) == 64, "a million steps fit in 64 MB");

/// How a cut depends on the spindle's angle: not at all; it follows it (G33); it does so down and, with the
/// spindle reversed, up again (G33.1); it taps with a floating holder (G84, G74), down and up again.
enum class SpindleLock : std::uint8_t { none, thread, rigid_tap, tap };
std::string_view to_string(SpindleLock lock);

/// Rare data of a motion: rotary axes, a Z that is corrected by probed points, threads.
struct MotionExtra {
  std::optional<std::array<double, 3>> abc;  // degrees
  std::string z_correction = {};             // expression over probed values; empty = none
  unsigned unknown_abc = 0;                  // bits 1, 2, 4: A, B, C is unknown at the end
  unsigned reference_abc = 0;                // bits: goes to the motion's reference (G28 A0)
  SpindleLock lock = SpindleLock::none;
  double per_turn = 0.0;  // mm per revolution of the spindle, of a motion with a lock
  /// Bits 1, 2, 4: A, B, C is at a stated angle at the end, or goes to a reference.
  unsigned stated_axes() const { return abc ? (~unknown_abc & 7u) | reference_abc : 0; }
};

/// The position of the tool between steps. At the start all axes are unknown.
struct PathPosition {
  Point3 at;             // mm
  unsigned unknown = 7;  // axes, see Step::unknown_axes
  bool is_known() const { return unknown == 0; }
  /// Moves it to where the tool is after the step.
  void pass(const Step& step);
};

/// The list of steps with their origins and texts. A value; moving it is cheap.
class Toolpath {
 public:
  const std::vector<Step>& steps() const { return steps_; }
  std::size_t size() const { return steps_.size(); }
  const Step& operator[](std::size_t i) const { return steps_[i]; }

  OriginTable& origins() { return origins_; }
  const OriginTable& origins() const { return origins_; }
  Origin origin_of(std::size_t i) const { return origins_.resolve(steps_[i].origin()); }
  /// Whether any step is of this kind; constant time.
  bool has(StepKind kind) const { return (kinds_ >> static_cast<unsigned>(kind) & 1u) != 0; }
  /// The last motion before step `i`, if there is one.
  std::optional<std::size_t> motion_before(std::size_t i) const;

  // Each returns the new step's index. Positions must be finite (asserted).
  std::size_t add(const step::Rapid& s, OriginId origin);
  std::size_t add(const step::Cut& s, OriginId origin);
  std::size_t add(const step::Arc& s, OriginId origin);
  std::size_t add(const step::Dwell& s, OriginId origin);
  std::size_t add(const step::ToolChange& s, OriginId origin);
  std::size_t add(const step::Spindle& s, OriginId origin);
  std::size_t add(const step::Coolant& s, OriginId origin);
  std::size_t add(const step::PathMode& s, OriginId origin);
  std::size_t add(const step::Probe& s, OriginId origin);
  std::size_t add(const step::Extrude& s, OriginId origin);
  std::size_t add(const step::Temperature& s, OriginId origin);
  std::size_t add(const step::Extruder& s, OriginId origin);
  std::size_t add(const step::Fan& s, OriginId origin);
  std::size_t add(const step::MotionLimits& s, OriginId origin);
  std::size_t add(const step::LaserPower& s, OriginId origin);
  std::size_t add(const step::Layer& s, OriginId origin);
  std::size_t add(const step::Note& s, OriginId origin);
  std::size_t add(const step::Verbatim& s, OriginId origin);
  std::size_t add(const step::Pause& s, OriginId origin);
  std::size_t add(const step::End& s, OriginId origin);
  std::size_t add(const step::ClosePath& s, OriginId origin);
  std::size_t add(const step::StoreHome& s, OriginId origin);
  std::size_t add(const step::WorkZero& s, OriginId origin);
  std::size_t add(const step::ToolLength& s, OriginId origin);
  std::size_t add(const step::Unresolved& s, OriginId origin);
  /// Copies step `i` of another toolpath (made from the same sources), texts, extras and origin included.
  std::size_t add_copy(const Toolpath& other, std::size_t i);
  /// Copies the origin of step `i` of another toolpath, callers included, for a step that replaces it.
  OriginId copy_origin(const Toolpath& other, std::size_t i);

  /// Moves the end of motion `i`; an arc's new end must lie on its circle. For front ends that learn the end
  /// of a motion only from the next one.
  void set_end(std::size_t i, Point3 to);
  /// Marks axes (bits 1, 2, 4 for X, Y, Z) as unknown at the end of motion `i`; see Step::unknown_axes.
  void set_unknown_axes(std::size_t i, unsigned bits);
  /// The axes that probe `i` moves, `known`: those of them whose target is known. All others keep their
  /// position, `unknown` of them an unknown one.
  void set_probed_axes(std::size_t i, unsigned moved, unsigned known, unsigned unknown);
  /// Sets the axes that the program named for motion `i`; see Step::named_axes.
  void set_named_axes(std::size_t i, unsigned bits);
  /// Marks `axes` (bits; they must be unknown ones) of motion `i` as given in a reference of the machine.
  void set_reference(std::size_t i, Reference reference, unsigned axes);
  /// Marks motion `i`; see Step::rests_before.
  void set_rests_before(std::size_t i);
  void set_extra(std::size_t i, MotionExtra extra);
  /// The motion's extra, or nullptr.
  const MotionExtra* extra(std::size_t i) const;
  /// Bits 1, 2, 4: the program uses A, B, C: an angle or a reference of some motion is stated.
  unsigned rotary_axes() const { return rotary_axes_; }

  step::Layer layer(std::size_t i) const;
  step::Extrude extrude(std::size_t i) const;
  /// The text of a note, verbatim or unresolved step.
  std::string_view text(std::size_t i) const;

  void reserve(std::size_t steps);

 private:
  friend class MotionReader;
  friend struct stored::Access;
  Step& append(StepKind kind, OriginId origin);
  void note_kind(StepKind kind);
  Step& append_motion(StepKind kind, Point3 to, OriginId origin);
  std::int32_t intern(std::string_view text);
  struct Bead {
    Length width, height;
    BeadKind kind = BeadKind::none;
    bool operator==(const Bead&) const = default;
  };

  std::vector<Step> steps_;
  std::vector<std::size_t> changes_;  // the tool changes and spindle steps among them, in order
  std::uint32_t kinds_ = 0;           // one bit per kind
  OriginTable origins_;
  std::vector<std::string> texts_;
  std::unordered_map<std::string, std::int32_t> text_index_;
  std::vector<Bead> beads_;
  std::vector<MotionExtra> extras_{1};
  unsigned rotary_axes_ = 0;
};

/// A motion of a toolpath with its start position and the current tool and spindle. The first motion starts
/// at X0 Y0 Z0 with all axes unknown.
struct MotionContext {
  std::size_t index = 0;      // of the step
  Point3 from;                // mm
  unsigned unknown_from = 7;  // axes of `from` that are unknown, see Step::unknown_axes
  std::optional<int> tool;    // nothing: no tool change yet
  step::Spindle spindle;
  bool spindle_stated = false;  // a spindle step was seen
};

/// Iterates over the motions of a path, in parts if needed.
class MotionReader {
 public:
  explicit MotionReader(const Toolpath& path) : path_(&path) {}
  /// The state after all steps before number `first`; the time does not depend on their number.
  MotionReader(const Toolpath& path, std::size_t first);
  /// Advances to the next motion, initially to the first; false at the end.
  bool next();
  /// The current motion.
  const Step& step() const { return *motion_; }
  const MotionContext& context() const { return context_; }

 private:
  void note_change(const Step& step);

  const Toolpath* path_;
  const Step* motion_ = nullptr;
  std::size_t next_ = 0;
  MotionContext context_;
};

/// Calls visit(step, context) for every motion, in order. `visit` returns void.
template <class Visit>
void for_each_motion(const Toolpath& path, Visit&& visit) {
  for (MotionReader motion(path); motion.next();) visit(motion.step(), motion.context());
}

/// The walk of arc step `s` that starts at `from`.
ArcWalk walk_of(const Step& s, Point3 from);

}  // namespace kerf

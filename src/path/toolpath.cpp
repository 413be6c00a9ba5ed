// The toolpath: packing and unpacking of steps.
#include "kerf/path/toolpath.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace kerf {

std::string_view name_of(StepKind kind) {
  static constexpr std::string_view kNames[] = {
      "rapid",      "cut",        "arc",     "dwell",       "tool",      "spindle",   "coolant",
      "pathmode",   "probe",      "extrude", "temperature", "fan",       "laser",     "layer",
      "note",       "verbatim",   "pause",   "end",         "closepath", "storehome", "workzero",
      "toollength", "unresolved", "limits",  "extruder",
  };
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view to_string(BeadKind kind) {
  static constexpr std::string_view kNames[] = {
      "",       "skirt",    "outer_wall", "wall",    "overhang",          "infill", "solid_infill", "top",
      "bridge", "gap_fill", "ironing",    "support", "support_interface", "purge",  "custom",
  };
  static_assert(std::size(kNames) == kBeadKinds);
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view to_string(LimitKind kind) {
  static constexpr std::string_view kNames[] = {"axis_acceleration",  "axis_speed",  "acceleration", "jerk",
                                                "junction_deviation", "corner_speed"};
  return kNames[static_cast<std::size_t>(kind)];
}

// ---- reading a step

step::Rapid Step::rapid() const {
  assert(kind_ == StepKind::rapid);
  return {to()};
}
step::Cut Step::cut() const {
  assert(kind_ == StepKind::cut);
  return {to(), feed()};
}
step::Arc Step::arc() const {
  assert(kind_ == StepKind::arc);
  return {to(),  {values_[4], values_[5]}, static_cast<Plane>(plane_), static_cast<Turn>(turn_), count_,
          feed()};
}
step::Dwell Step::dwell() const {
  assert(kind_ == StepKind::dwell);
  return {Duration::raw(values_[0])};
}
step::ToolChange Step::tool_change() const {
  assert(kind_ == StepKind::tool_change);
  return {count_, static_cast<ToolChangeKind>(plane_)};
}
step::Spindle Step::spindle() const {
  assert(kind_ == StepKind::spindle);
  return {SpindleSpeed::raw(values_[0]), static_cast<SpindleTurn>(turn_), Feed::raw(values_[1])};
}
step::Coolant Step::coolant() const {
  assert(kind_ == StepKind::coolant);
  return {(turn_ & 1) != 0, (turn_ & 2) != 0};
}
step::PathMode Step::path_mode() const {
  assert(kind_ == StepKind::path_mode);
  return {static_cast<PathModeKind>(plane_), Length::raw(values_[0])};
}
step::Probe Step::probe() const {
  assert(kind_ == StepKind::probe);
  return {to(), feed(), static_cast<ProbeKind>(plane_)};
}
step::MotionLimits Step::motion_limits() const {
  assert(kind_ == StepKind::motion_limits);
  return {static_cast<LimitKind>(plane_), {values_[0], values_[1], values_[2], values_[3]}, frame_};
}
step::Temperature Step::temperature() const {
  assert(kind_ == StepKind::temperature);
  return {static_cast<Heater>(plane_), values_[0], turn_ != 0, count_};
}
step::Extruder Step::extruder() const {
  assert(kind_ == StepKind::extruder);
  return {count_};
}
step::Fan Step::fan() const {
  assert(kind_ == StepKind::fan);
  return {count_, values_[0]};
}
step::LaserPower Step::laser_power() const {
  assert(kind_ == StepKind::laser_power);
  return {static_cast<LaserMode>(plane_), values_[0]};
}

step::Pause Step::pause() const {
  assert(kind_ == StepKind::pause);
  return {static_cast<PauseKind>(plane_)};
}
step::End Step::end() const {
  assert(kind_ == StepKind::end);
  return {turn_ != 0};
}
step::StoreHome Step::store_home() const {
  assert(kind_ == StepKind::store_home);
  return {static_cast<Reference>(plane_)};
}
step::WorkZero Step::work_zero() const {
  assert(kind_ == StepKind::work_zero);
  return {.kind = static_cast<ZeroKind>(plane_),
          .system = count_,
          .axes = named_axes_,
          .zero = to(),
          .at = {values_[3], values_[4], values_[5]},
          .known = (frame_ >> 3) & 7u,
          .unknown = frame_ & 7u};
}
step::ToolLength Step::tool_length() const {
  assert(kind_ == StepKind::tool_length);
  return {static_cast<ToolLengthKind>(plane_), count_, to(), named_axes_};
}
NoteKind Step::note_kind() const {
  assert(kind_ == StepKind::note);
  return static_cast<NoteKind>(plane_);
}
UnresolvedKind Step::unresolved() const {
  assert(kind_ == StepKind::unresolved);
  return static_cast<UnresolvedKind>(plane_);
}

void PathPosition::pass(const Step& step) {
  if (step.is_motion()) {
    at = step.to();
    unknown = step.unknown_axes();
  } else if (step.kind() == StepKind::work_zero) {
    const step::WorkZero zero = step.work_zero();
    for (int axis = 0; axis < 3; ++axis)
      if ((zero.known >> axis & 1u) != 0) at[axis] = zero.at[axis];
    unknown = (unknown & ~zero.known) | zero.unknown;
  } else if (step.kind() == StepKind::tool_length) {
    unknown |= 4u;
  } else if (step.kind() == StepKind::unresolved && step.unresolved() == UnresolvedKind::code) {
    unknown = 7u;
  }
}

// ---- adding steps

Step& Toolpath::append(StepKind kind, OriginId origin) {
  assert(static_cast<std::size_t>(origin) < origins_.size());
  Step& s = steps_.emplace_back();
  s.kind_ = kind;
  s.origin_ = origin;
  note_kind(kind);
  return s;
}

/// Of the last step.
void Toolpath::note_kind(StepKind kind) {
  kinds_ |= 1u << static_cast<unsigned>(kind);
  if (kind == StepKind::tool_change || kind == StepKind::spindle) changes_.push_back(steps_.size() - 1);
}

Step& Toolpath::append_motion(StepKind kind, Point3 to, OriginId origin) {
  assert(finite(to));
  Step& s = append(kind, origin);
  s.values_[0] = to.x;
  s.values_[1] = to.y;
  s.values_[2] = to.z;
  return s;
}

std::size_t Toolpath::add(const step::Rapid& s, OriginId origin) {
  append_motion(StepKind::rapid, s.to, origin);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Cut& s, OriginId origin) {
  append_motion(StepKind::cut, s.to, origin).values_[3] = s.feed.raw();
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Arc& s, OriginId origin) {
  Step& out = append_motion(StepKind::arc, s.to, origin);
  out.values_[3] = s.feed.raw();
  out.values_[4] = s.centre.x;
  out.values_[5] = s.centre.y;
  out.plane_ = static_cast<std::uint8_t>(s.plane) & 7;
  out.turn_ = static_cast<std::uint8_t>(s.turn) & 3;
  out.count_ = s.extra_turns;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Dwell& s, OriginId origin) {
  append(StepKind::dwell, origin).values_[0] = s.time.raw();
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::ToolChange& s, OriginId origin) {
  Step& out = append(StepKind::tool_change, origin);
  out.count_ = s.tool;
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Spindle& s, OriginId origin) {
  Step& out = append(StepKind::spindle, origin);
  out.values_[0] = s.speed.raw();
  out.values_[1] = s.surface_speed.raw();
  out.turn_ = static_cast<std::uint8_t>(s.turn) & 3;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Coolant& s, OriginId origin) {
  append(StepKind::coolant, origin).turn_ =
      static_cast<std::uint8_t>((s.mist ? 1 : 0) | (s.flood ? 2 : 0)) & 3;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::PathMode& s, OriginId origin) {
  Step& out = append(StepKind::path_mode, origin);
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  out.values_[0] = s.tolerance.raw();
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Probe& s, OriginId origin) {
  Step& out = append_motion(StepKind::probe, s.to, origin);
  out.values_[3] = s.feed.raw();
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  set_probed_axes(steps_.size() - 1, 7, 7, 0);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Extrude& s, OriginId origin) {
  const Bead bead{s.width, s.height, s.kind};
  if (beads_.empty() || beads_.back() != bead) beads_.push_back(bead);  // a print has long runs of one bead
  Step& out = append_motion(StepKind::extrude, s.to, origin);
  out.values_[3] = s.feed.raw();
  out.values_[4] = s.volume.raw();
  out.count_ = static_cast<std::int32_t>(beads_.size() - 1);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Temperature& s, OriginId origin) {
  Step& out = append(StepKind::temperature, origin);
  out.plane_ = static_cast<std::uint8_t>(s.heater) & 7;
  out.values_[0] = s.celsius;
  out.turn_ = s.wait ? 1 : 0;
  out.count_ = s.extruder;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Extruder& s, OriginId origin) {
  append(StepKind::extruder, origin).count_ = s.number;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Fan& s, OriginId origin) {
  Step& out = append(StepKind::fan, origin);
  out.count_ = s.fan;
  out.values_[0] = s.fraction;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::MotionLimits& s, OriginId origin) {
  assert(s.given < 16);
  Step& out = append(StepKind::motion_limits, origin);
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    assert((s.given >> i & 1u) == 0 || (std::isfinite(s.values[i]) && s.values[i] >= 0.0));
    out.values_[i] = s.values[i];
  }
  out.frame_ = static_cast<std::uint8_t>(s.given);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::LaserPower& s, OriginId origin) {
  Step& out = append(StepKind::laser_power, origin);
  out.plane_ = static_cast<std::uint8_t>(s.mode) & 7;
  out.values_[0] = s.power;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Layer& s, OriginId origin) {
  Step& out = append(StepKind::layer, origin);
  out.count_ = intern(s.name);
  out.values_[0] = s.colour;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Note& s, OriginId origin) {
  Step& out = append(StepKind::note, origin);
  out.count_ = intern(s.text);
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Verbatim& s, OriginId origin) {
  append(StepKind::verbatim, origin).count_ = intern(s.text);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Pause& s, OriginId origin) {
  append(StepKind::pause, origin).plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::End& s, OriginId origin) {
  append(StepKind::end, origin).turn_ = s.rewind ? 1 : 0;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::ClosePath&, OriginId origin) {
  append(StepKind::close_path, origin);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::StoreHome& s, OriginId origin) {
  assert(s.home == Reference::home || s.home == Reference::second_home);
  append(StepKind::store_home, origin).plane_ = static_cast<std::uint8_t>(s.home) & 7;
  return steps_.size() - 1;
}

std::size_t Toolpath::add(const step::WorkZero& s, OriginId origin) {
  assert(finite(s.zero) && finite(s.at) && ((s.known | s.unknown) & ~7u) == 0 && (s.known & ~s.axes) == 0);
  Step& out = append(StepKind::work_zero, origin);
  out.values_ = {s.zero.x, s.zero.y, s.zero.z, s.at.x, s.at.y, s.at.z};
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  out.count_ = s.system;
  out.named_axes_ = s.axes & 7;
  out.frame_ = static_cast<std::uint8_t>((s.known << 3) | s.unknown);
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::ToolLength& s, OriginId origin) {
  assert(finite(s.offset));
  Step& out = append(StepKind::tool_length, origin);
  out.values_ = {s.offset.x, s.offset.y, s.offset.z};
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  out.count_ = s.number;
  out.named_axes_ = s.axes & 7;
  return steps_.size() - 1;
}
std::size_t Toolpath::add(const step::Unresolved& s, OriginId origin) {
  Step& out = append(StepKind::unresolved, origin);
  out.count_ = intern(s.text);
  out.plane_ = static_cast<std::uint8_t>(s.kind) & 7;
  return steps_.size() - 1;
}

OriginId Toolpath::copy_origin(const Toolpath& other, std::size_t i) {
  const OriginId old = other.steps_[i].origin_;
  const OriginId origin = origins_.add(other.origins_.resolve(old));
  OriginId inner = origin;
  for (const Origin& caller : other.origins_.callers(old)) {
    const OriginId outer = origins_.add(caller);
    origins_.set_caller(inner, outer);
    inner = outer;
  }
  return origin;
}

std::size_t Toolpath::add_copy(const Toolpath& other, std::size_t i) {
  const OriginId origin = copy_origin(other, i);
  switch (other.steps_[i].kind_) {
    case StepKind::layer: return add(other.layer(i), origin);
    case StepKind::note: {
      const auto kind = static_cast<NoteKind>(other.steps_[i].plane_);
      return add(step::Note{std::string(other.text(i)), kind}, origin);
    }
    case StepKind::unresolved:
      return add(step::Unresolved{std::string(other.text(i)), other.steps_[i].unresolved()}, origin);
    case StepKind::verbatim: return add(step::Verbatim{std::string(other.text(i))}, origin);
    case StepKind::extrude: add(other.extrude(i), origin); break;
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::dwell:
    case StepKind::tool_change:
    case StepKind::spindle:
    case StepKind::coolant:
    case StepKind::path_mode:
    case StepKind::probe:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::pause:
    case StepKind::end:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::motion_limits:
    case StepKind::extruder: {
      Step& s = steps_.emplace_back(other.steps_[i]);
      s.origin_ = origin;
      s.extra_ = 0;
      note_kind(s.kind_);
    }
  }
  if (const MotionExtra* extra = other.extra(i)) set_extra(steps_.size() - 1, *extra);
  steps_.back().frame_ = other.steps_[i].frame_;
  steps_.back().reference_ = other.steps_[i].reference_;
  steps_.back().rests_before_ = other.steps_[i].rests_before_;
  steps_.back().named_axes_ = other.steps_[i].named_axes_;
  return steps_.size() - 1;
}

void Toolpath::set_end(std::size_t i, Point3 to) {
  assert(steps_[i].is_motion() && finite(to));
  for (int axis = 0; axis < 3; ++axis) steps_[i].values_[static_cast<std::size_t>(axis)] = to[axis];
}

void Toolpath::set_unknown_axes(std::size_t i, unsigned bits) {
  assert(steps_[i].is_motion() && bits < 8);
  steps_[i].frame_ = static_cast<std::uint8_t>((steps_[i].frame_ & ~7u) | bits);
}

void Toolpath::set_reference(std::size_t i, Reference reference, unsigned axes) {
  assert((axes & ~steps_[i].unknown_axes()) == 0);
  steps_[i].frame_ = static_cast<std::uint8_t>((axes << 3) | steps_[i].unknown_axes());
  steps_[i].reference_ = static_cast<std::uint8_t>(reference) & 7;
}

void Toolpath::set_probed_axes(std::size_t i, unsigned moved, unsigned known, unsigned unknown) {
  assert(steps_[i].kind() == StepKind::probe && (moved | known | unknown) < 8);
  steps_[i].frame_ = static_cast<std::uint8_t>((moved & known) << 3 | (moved | unknown));
  steps_[i].reference_ = static_cast<std::uint8_t>(Reference::work) & 7;
}

void Toolpath::set_rests_before(std::size_t i) {
  assert(steps_[i].is_motion());
  steps_[i].rests_before_ = true;
}

void Toolpath::set_named_axes(std::size_t i, unsigned bits) {
  assert(steps_[i].is_motion() && bits < 64);
  steps_[i].named_axes_ = bits & 63;
}

std::string_view to_string(SpindleLock lock) {
  switch (lock) {
    case SpindleLock::none: break;
    case SpindleLock::thread: return "thread";
    case SpindleLock::rigid_tap: return "rigid_tap";
    case SpindleLock::tap: return "tap";
  }
  return "none";
}

void Toolpath::set_extra(std::size_t i, MotionExtra extra) {
  assert(steps_[i].is_motion());
  steps_[i].extra_ = static_cast<std::uint32_t>(extras_.size());
  rotary_axes_ |= extra.stated_axes();
  extras_.push_back(std::move(extra));
}

const MotionExtra* Toolpath::extra(std::size_t i) const {
  return steps_[i].extra_ == 0 ? nullptr : &extras_[steps_[i].extra_];
}

std::optional<std::size_t> Toolpath::motion_before(std::size_t i) const {
  while (i > 0)
    if (steps_[--i].is_motion()) return i;
  return std::nullopt;
}

step::Extrude Toolpath::extrude(std::size_t i) const {
  const Step& s = steps_[i];
  assert(s.kind_ == StepKind::extrude);
  const Bead& bead = beads_[static_cast<std::size_t>(s.count_)];
  return {s.to(), Volume::raw(s.values_[4]), bead.width, bead.height, s.feed(), bead.kind};
}

step::Layer Toolpath::layer(std::size_t i) const {
  const Step& s = steps_[i];
  assert(s.kind_ == StepKind::layer);
  return {texts_[static_cast<std::size_t>(s.count_)], static_cast<int>(s.values_[0])};
}

std::string_view Toolpath::text(std::size_t i) const {
  const Step& s = steps_[i];
  assert(s.kind_ == StepKind::note || s.kind_ == StepKind::verbatim || s.kind_ == StepKind::unresolved);
  return texts_[static_cast<std::size_t>(s.count_)];
}

void Toolpath::reserve(std::size_t steps) {
  steps_.reserve(steps);
  origins_.reserve(steps + 1);
}

std::int32_t Toolpath::intern(std::string_view text) {
  auto [it, is_new] = text_index_.try_emplace(std::string(text), static_cast<std::int32_t>(texts_.size()));
  if (is_new) texts_.emplace_back(text);
  return it->second;
}

ArcWalk walk_of(const Step& s, Point3 from) {
  const step::Arc arc = s.arc();
  return walk_arc(from, arc.to, arc.centre, arc.plane, arc.turn, arc.extra_turns);
}

MotionReader::MotionReader(const Toolpath& path, std::size_t first) : path_(&path) {
  if (const auto before = path.motion_before(first)) {
    motion_ = &path[*before];
    next_ = *before + 1;  // steps after it may set the position
  }
  const auto none = path.changes_.begin();
  bool knows_tool = false, knows_spindle = false;
  for (auto change = std::lower_bound(none, path.changes_.end(), first);
       change != none && !(knows_tool && knows_spindle);) {
    const Step& step = path[*--change];
    bool& known = step.kind() == StepKind::spindle ? knows_spindle : knows_tool;
    if (!std::exchange(known, true)) note_change(step);
  }
}

void MotionReader::note_change(const Step& step) {
  if (step.kind() == StepKind::tool_change) context_.tool = step.tool_change().tool;
  if (step.kind() != StepKind::spindle) return;
  context_.spindle = step.spindle();
  context_.spindle_stated = true;
}

bool MotionReader::next() {
  if (motion_ != nullptr) {
    context_.from = motion_->to();
    context_.unknown_from = motion_->unknown_axes();
  }
  for (motion_ = nullptr; next_ < path_->size();) {
    const Step& s = (*path_)[next_++];
    if (!s.is_motion()) {
      note_change(s);
      if (s.kind() >= StepKind::work_zero) {  // those that may set the position
        PathPosition position{context_.from, context_.unknown_from};
        position.pass(s);
        context_.from = position.at;
        context_.unknown_from = position.unknown;
      }
      continue;
    }
    context_.index = next_ - 1;
    motion_ = &s;
    return true;
  }
  return false;
}

}  // namespace kerf

// The state in force at a step, and how it is restored.
#include "path/state.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "path/firmware_retraction.h"

namespace kerf {
namespace {

constexpr std::string_view kNames[kStateParts] = {
    "work offset", "tool",  "tool length",         "path mode",     "spindle",
    "coolant",     "laser", "rotary axes",         "motion limits", "extruder",
    "temperature", "fan",   "filament drawn back", "layer",
};

bool is_off(const std::optional<step::Spindle>& s) { return !s || s->turn == SpindleTurn::off; }
bool is_off(const std::optional<step::Coolant>& c) { return !c || (!c->mist && !c->flood); }
bool is_off(const std::optional<step::LaserPower>& l) { return !l || l->mode == LaserMode::off; }

bool same(const step::Spindle& a, const step::Spindle& b) { return a == b; }
bool same(const step::Coolant& a, const step::Coolant& b) { return a.mist == b.mist && a.flood == b.flood; }
bool same(const step::LaserPower& a, const step::LaserPower& b) {
  return a.mode == b.mode && a.power == b.power;
}
bool same(const step::PathMode& a, const step::PathMode& b) {
  return a.kind == b.kind && a.tolerance == b.tolerance;
}
bool same(const step::ToolLength& a, const step::ToolLength& b) {
  return a.kind == b.kind && a.number == b.number && a.offset == b.offset && a.axes == b.axes;
}
bool same(const step::ToolChange& a, const step::ToolChange& b) { return a.tool == b.tool; }
bool same(const step::MotionLimits& a, const step::MotionLimits& b) {
  return a.given == b.given && a.values == b.values;
}
bool same(const step::Temperature& a, const step::Temperature& b) { return a.celsius == b.celsius; }
bool same(const step::Layer& a, const step::Layer& b) { return a.name == b.name && a.colour == b.colour; }

template <class Value>
bool equal(const std::optional<Value>& a, const std::optional<Value>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
/// Of what is off unless it is stated.
template <class Value>
bool equal_or_off(const std::optional<Value>& a, const std::optional<Value>& b) {
  return is_off(a) ? is_off(b) : b && same(*a, *b);
}
template <class Key, class Value>
bool equal(const std::map<Key, Value>& a, const std::map<Key, Value>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && same(x.second, y.second);
  });
}

int system_of(const PathState& s) { return s.selected ? s.selected->system : 1; }
bool equal_zeros(const PathState& a, const PathState& b) {
  return system_of(a) == system_of(b) && a.offsets == b.offsets && a.shifts == b.shifts;
}
bool equal_angles(const PathState& a, const PathState& b) {
  if (a.unknown_abc != b.unknown_abc) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if ((a.unknown_abc >> k & 1u) == 0 && a.abc[k] != b.abc[k]) return false;
  return true;
}

constexpr double kSameFilament = 1e-6;  // mm3

bool equal_filament(const DrawnBack& a, const DrawnBack& b) {
  return a.by_firmware == b.by_firmware && std::abs(a.volume - b.volume) <= kSameFilament;
}
/// Whether all of the first is in the second.
bool within(const std::map<int, DrawnBack>& a, const std::map<int, DrawnBack>& b) {
  return std::all_of(a.begin(), a.end(), [&](const auto& one) {
    const auto other = b.find(one.first);
    return equal_filament(one.second, other == b.end() ? DrawnBack{} : other->second);
  });
}

void pass_zero(PathState& state, const step::WorkZero& zero) {
  WorkOffset* offset =
      zero.system >= 1 && zero.system <= 9 ? &state.offsets[static_cast<std::size_t>(zero.system)] : nullptr;
  switch (zero.kind) {
    case ZeroKind::select:
      state.selected = zero;
      state.unrelated |= zero.unknown;
      return;
    case ZeroKind::offset:
    case ZeroKind::here:
      if (offset == nullptr) return;
      offset->axes |= zero.axes, offset->zero = zero.zero;
      offset->by_tool = zero.kind == ZeroKind::here;
      return;
    case ZeroKind::shift:
    case ZeroKind::shift_off:
    case ZeroKind::shift_paused:
    case ZeroKind::shift_on: ++state.shifts; return;
  }
}

void pass_motion(PathState& state, const Toolpath& path, std::size_t i, Point3 from) {
  if (path[i].kind() == StepKind::extrude) {
    const step::Extrude bead = path.extrude(i);
    double& back = state.drawn_back[state.extruder_in_use()].volume;
    back = std::max(back - bead.volume.mm3(), 0.0);
    if (state.position.is_known() && bead.to == from) state.retraction = bead.feed;
  }
  const MotionExtra* extra = path.extra(i);
  if (extra == nullptr || !extra->abc) return;
  state.abc = *extra->abc;
  state.unknown_abc = extra->unknown_abc;
}

}  // namespace

std::string_view to_string(StatePart part) { return kNames[static_cast<std::size_t>(part)]; }

std::string to_text(StateParts parts) {
  std::string text;
  for (int k = 0; k < kStateParts; ++k) {
    if ((parts >> k & 1u) == 0) continue;
    if (!text.empty()) text += ", ";
    text += "the ";
    text += kNames[k];
  }
  return text;
}

void PathState::pass(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  const Point3 from = position.at;
  position.pass(s);
  switch (s.kind()) {
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::probe:
    case StepKind::extrude: return pass_motion(*this, path, i, from);
    case StepKind::tool_change: tool = s.tool_change(); return;
    case StepKind::tool_length: length = s.tool_length(); return;
    case StepKind::path_mode: path_mode = s.path_mode(); return;
    case StepKind::spindle: spindle = s.spindle(); return;
    case StepKind::coolant: coolant = s.coolant(); return;
    case StepKind::laser_power: laser = s.laser_power(); return;
    case StepKind::work_zero: return pass_zero(*this, s.work_zero());
    case StepKind::motion_limits: {
      step::MotionLimits& kept = limits[s.motion_limits().kind];
      const step::MotionLimits set = s.motion_limits();
      kept.kind = set.kind, kept.given |= set.given;
      for (std::size_t k = 0; k < set.values.size(); ++k)
        if ((set.given >> k & 1u) != 0) kept.values[k] = set.values[k];
      return;
    }
    case StepKind::extruder: extruder = s.extruder().number; return;
    case StepKind::temperature: {
      const step::Temperature set = s.temperature();
      temperatures[{set.heater, set.extruder}] = set;
      return;
    }
    case StepKind::fan: fans[s.fan().fan] = s.fan().fraction; return;
    case StepKind::layer: layer = path.layer(i); return;
    case StepKind::verbatim: {
      const RetractionLine line = read_firmware_retraction(path.text(i)).line;
      if (line != RetractionLine::none && line != RetractionLine::lengths)
        drawn_back[extruder_in_use()].by_firmware = line == RetractionLine::back;
      return;
    }
    case StepKind::dwell:
    case StepKind::note:
    case StepKind::pause:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::unresolved: return;
    case StepKind::end:
      spindle = step::Spindle{}, coolant = step::Coolant{};
      if (laser) laser = step::LaserPower{};
      return;
  }
}

DrawnBack PathState::filament() const {
  const auto found = drawn_back.find(extruder_in_use());
  return found == drawn_back.end() ? DrawnBack{} : found->second;
}

StateParts part_set_by(const Step& step) {
  switch (step.kind()) {
    case StepKind::tool_change: return bit_of(StatePart::tool);
    case StepKind::tool_length: return bit_of(StatePart::tool_length);
    case StepKind::path_mode: return bit_of(StatePart::path_mode);
    case StepKind::spindle: return bit_of(StatePart::spindle);
    case StepKind::coolant: return bit_of(StatePart::coolant);
    case StepKind::laser_power: return bit_of(StatePart::laser);
    case StepKind::work_zero: return bit_of(StatePart::work_zero);
    case StepKind::motion_limits: return bit_of(StatePart::limits);
    case StepKind::extruder: return bit_of(StatePart::extruder);
    case StepKind::temperature: return bit_of(StatePart::temperature);
    case StepKind::fan: return bit_of(StatePart::fan);
    case StepKind::layer: return bit_of(StatePart::layer);
    case StepKind::end:
      return bit_of(StatePart::spindle) | bit_of(StatePart::coolant) | bit_of(StatePart::laser);
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::probe:
    case StepKind::extrude:
    case StepKind::dwell:
    case StepKind::note:
    case StepKind::verbatim:
    case StepKind::pause:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::unresolved: return 0;
  }
  return 0;
}

StateParts set_before_cut(const Toolpath& path, std::size_t first, std::size_t end) {
  // Of these, a part of what is set may stay as it was; a work offset decides where rapids lead.
  constexpr StateParts kWhole = bit_of(StatePart::tool) | bit_of(StatePart::path_mode) |
                                bit_of(StatePart::spindle) | bit_of(StatePart::coolant) |
                                bit_of(StatePart::laser) | bit_of(StatePart::extruder) |
                                bit_of(StatePart::layer);
  StateParts set = 0;
  for (std::size_t i = first; i < end; ++i) {
    if (path[i].is_motion() && path[i].kind() != StepKind::rapid) break;
    set |= part_set_by(path[i]);
  }
  return set & kWhole;
}

StateParts difference(const PathState& a, const PathState& b) {
  StateParts parts = 0;
  const auto note = [&](StatePart part, bool equals) {
    if (!equals) parts |= bit_of(part);
  };
  note(StatePart::work_zero, equal_zeros(a, b));
  note(StatePart::tool, equal(a.tool, b.tool));
  note(StatePart::tool_length, equal(a.length, b.length));
  note(StatePart::path_mode, equal(a.path_mode, b.path_mode));
  note(StatePart::spindle, equal_or_off(a.spindle, b.spindle));
  note(StatePart::coolant, equal_or_off(a.coolant, b.coolant));
  note(StatePart::laser, equal_or_off(a.laser, b.laser));
  note(StatePart::rotary, equal_angles(a, b));
  note(StatePart::limits, equal(a.limits, b.limits));
  note(StatePart::extruder, a.extruder_in_use() == b.extruder_in_use());
  note(StatePart::temperature, equal(a.temperatures, b.temperatures));
  note(StatePart::fan, a.fans == b.fans);
  note(StatePart::filament, within(a.drawn_back, b.drawn_back) && within(b.drawn_back, a.drawn_back));
  note(StatePart::layer, equal(a.layer, b.layer));
  return parts;
}

void StateReader::to(std::size_t end) {
  assert(end >= next_ && end <= path_->size());
  for (; next_ < end; ++next_) state_.pass(*path_, next_);
}

namespace {

/// Appends the steps of one call of restore().
class Restorer {
 public:
  Restorer(PathState& now, const PathState& wanted, OriginId origin, Toolpath& out)
      : now_(now), wanted_(wanted), origin_(origin), out_(out) {}

  StateParts run(StateParts parts) {
    parts &= difference(now_, wanted_);
    const auto has = [&](StatePart part) { return (parts & bit_of(part)) != 0; };
    if (has(StatePart::laser) && is_off(wanted_.laser)) add(step::LaserPower{});
    if (has(StatePart::work_zero)) zeros();
    if (has(StatePart::tool)) set(StatePart::tool, wanted_.tool);
    // A length from the table is that of the tool.
    const bool new_tool = has(StatePart::tool) && wanted_.length;
    if (has(StatePart::tool_length) || new_tool) set(StatePart::tool_length, wanted_.length);
    if (has(StatePart::path_mode)) set(StatePart::path_mode, wanted_.path_mode);
    if (has(StatePart::layer)) set(StatePart::layer, wanted_.layer);
    if (has(StatePart::limits)) limits();
    if (has(StatePart::extruder)) extruder();
    if (has(StatePart::temperature)) temperatures();
    if (has(StatePart::fan)) fans();
    if (has(StatePart::rotary)) rotary();
    if (has(StatePart::spindle)) add(wanted_.spindle.value_or(step::Spindle{}));
    if (has(StatePart::coolant)) add(wanted_.coolant.value_or(step::Coolant{}));
    if (has(StatePart::laser) && !is_off(wanted_.laser)) add(*wanted_.laser);
    if (has(StatePart::filament)) filament();
    return lost_;
  }

 private:
  template <class Made>
  std::size_t add(const Made& step) {
    const std::size_t added = out_.add(step, origin_);
    now_.pass(out_, added);
    return added;
  }
  void lose(StatePart part) { lost_ |= bit_of(part); }
  template <class Value>
  void set(StatePart part, const std::optional<Value>& value) {
    if (value)
      add(*value);
    else
      lose(part);
  }

  void zeros() {
    if (now_.shifts != wanted_.shifts) return lose(StatePart::work_zero);
    for (int system = 1; system <= 9; ++system) {
      const WorkOffset& to = wanted_.offsets[static_cast<std::size_t>(system)];
      const WorkOffset& from = now_.offsets[static_cast<std::size_t>(system)];
      if (from == to) continue;
      if (to.by_tool || (from.axes & ~to.axes) != 0) {
        lose(StatePart::work_zero);
        continue;
      }
      add(step::WorkZero{.kind = ZeroKind::offset, .system = system, .axes = to.axes, .zero = to.zero});
    }
    const int system = system_of(wanted_);
    if (system == system_of(now_)) return;
    const WorkOffset& offset = wanted_.offsets[static_cast<std::size_t>(system)];
    Point3 zero = wanted_.selected ? wanted_.selected->zero : Point3{};
    for (int axis = 0; axis < 3; ++axis)
      if ((offset.axes >> axis & 1u) != 0) zero[axis] = offset.zero[axis];
    add(step::WorkZero{.system = system, .zero = zero, .unknown = now_.unrelated});
  }

  void limits() {
    for (const auto& [kind, to] : wanted_.limits) {
      const auto from = now_.limits.find(kind);
      if (from == now_.limits.end() || !same(from->second, to)) add(to);
    }
    if (!equal(now_.limits, wanted_.limits)) lose(StatePart::limits);
  }
  void extruder() { add(step::Extruder{wanted_.extruder_in_use()}); }
  void temperatures() {
    for (const auto& [heater, to] : wanted_.temperatures) {
      const auto from = now_.temperatures.find(heater);
      if (from == now_.temperatures.end() || !same(from->second, to)) add(to);
    }
    if (!equal(now_.temperatures, wanted_.temperatures)) lose(StatePart::temperature);
  }
  void fans() {
    for (const auto& [fan, to] : wanted_.fans) {
      const auto from = now_.fans.find(fan);
      if (from == now_.fans.end() || from->second != to) add(step::Fan{fan, to});
    }
    if (now_.fans != wanted_.fans) lose(StatePart::fan);
  }

  /// In place, at the feed of the last retraction.
  void filament() {
    const DrawnBack from = now_.filament(), to = wanted_.filament();
    const double volume = from.volume - to.volume;
    const bool moves = std::abs(volume) > kSameFilament;
    if (moves && now_.position.is_known() && now_.retraction > Feed{})
      add(step::Extrude{now_.position.at, mm3(volume), {}, {}, now_.retraction});
    if (from.by_firmware != to.by_firmware) add(step::Verbatim{to.by_firmware ? "G10" : "G11"});
    if (!within(now_.drawn_back, wanted_.drawn_back) || !within(wanted_.drawn_back, now_.drawn_back))
      lose(StatePart::filament);
  }

  /// A rapid to where the tool is that turns the axes whose angle is known.
  void rotary() {
    const unsigned unknown = now_.position.unknown;
    if ((wanted_.unknown_abc & ~now_.unknown_abc) != 0) lose(StatePart::rotary);
    if (wanted_.unknown_abc == 7u) return;
    const std::size_t added = out_.add(step::Rapid{now_.position.at}, origin_);
    if (unknown != 0) out_.set_unknown_axes(added, unknown);
    MotionExtra extra;
    extra.abc = wanted_.abc;
    for (std::size_t k = 0; k < 3; ++k)
      if ((wanted_.unknown_abc >> k & 1u) != 0) (*extra.abc)[k] = now_.abc[k];
    extra.unknown_abc = wanted_.unknown_abc & now_.unknown_abc;
    out_.set_extra(added, std::move(extra));
    now_.pass(out_, added);
  }

  PathState& now_;
  const PathState& wanted_;
  OriginId origin_;
  Toolpath& out_;
  StateParts lost_ = 0;
};

}  // namespace

StateParts restore(PathState& now, const PathState& wanted, StateParts parts, OriginId origin,
                   Toolpath& out) {
  return Restorer(now, wanted, origin, out).run(parts);
}

}  // namespace kerf

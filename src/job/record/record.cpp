// Kerf's values as records.
#include "job/record/record.h"

#include <cmath>
#include <cstdint>

#include "path/motion_limits.h"

namespace kerf {
namespace {

Record origin_record(std::monostate) { return nullptr; }
Record origin_record(const TextLocation& at) {
  return {{"file", at.file}, {"line", at.line}, {"column", at.column}};
}
Record origin_record(const DrawingLocation& at) {
  return {
      {"file", at.file}, {"layer", at.layer}, {"handle", at.handle}, {"at", record_of(Point2{at.x, at.y})}};
}
Record origin_record(const CallLocation& at) {
  return {{"file", at.file}, {"line", at.line}, {"call", at.call}};
}

std::string_view word(Plane plane) { return plane == Plane::xy ? "XY" : plane == Plane::xz ? "XZ" : "YZ"; }
std::string_view word(Turn turn) { return turn == Turn::cw ? "cw" : "ccw"; }
std::string_view word(SpindleTurn turn) {
  return turn == SpindleTurn::off ? "off" : turn == SpindleTurn::cw ? "cw" : "ccw";
}
std::string_view word(PathModeKind kind) {
  return kind == PathModeKind::exact_path   ? "exact_path"
         : kind == PathModeKind::exact_stop ? "exact_stop"
                                            : "blend";
}
std::string_view word(Heater heater) {
  return heater == Heater::nozzle ? "nozzle" : heater == Heater::bed ? "bed" : "chamber";
}
std::string_view word(LaserMode mode) {
  return mode == LaserMode::off ? "off" : mode == LaserMode::constant ? "constant" : "dynamic";
}
std::string_view word(PauseKind kind) {
  return kind == PauseKind::always ? "always" : kind == PauseKind::optional ? "optional" : "pallet_change";
}
std::string_view word(Reference reference) {
  switch (reference) {
    case Reference::work: return "work";
    case Reference::machine: return "machine";
    case Reference::home: return "home";
    case Reference::second_home: return "second_home";
    case Reference::end_switches: return "end_switches";
    case Reference::measured: break;
  }
  return "measured";
}
std::string_view word(ZeroKind kind) {
  switch (kind) {
    case ZeroKind::select: return "select";
    case ZeroKind::offset: return "offset";
    case ZeroKind::here: return "here";
    case ZeroKind::shift: return "shift";
    case ZeroKind::shift_off: return "shift_off";
    case ZeroKind::shift_paused: return "shift_paused";
    case ZeroKind::shift_on: break;
  }
  return "shift_on";
}
std::string_view word(ToolLengthKind kind) {
  return kind == ToolLengthKind::none ? "none" : kind == ToolLengthKind::table ? "table" : "given";
}
std::string_view word(ProbeKind kind) {
  switch (kind) {
    case ProbeKind::contact_or_error: return "contact_or_error";
    case ProbeKind::contact: return "contact";
    case ProbeKind::release_or_error: return "release_or_error";
    case ProbeKind::release: break;
  }
  return "release";
}

Record axes_record(unsigned bits) {
  Record axes = Record::array();
  for (unsigned axis = 0; axis < 6; ++axis)
    if ((bits >> axis & 1u) != 0) axes.push_back(std::string(1, "XYZABC"[axis]));
  return axes;
}

void add_motion(Record& out, const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  unsigned unknown = s.unknown_axes(), reference = s.reference_axes();
  out["to"] = record_of(s.to());
  if (const MotionExtra* extra = path.extra(i)) {
    if (extra->abc) out["abc"] = record_of(Point3{(*extra->abc)[0], (*extra->abc)[1], (*extra->abc)[2]});
    if (extra->lock != SpindleLock::none) {
      out["spindle_lock"] = to_string(extra->lock);
      out["per_turn"] = record_of(extra->per_turn);
    }
    if (!extra->z_correction.empty()) out["z_correction"] = extra->z_correction;
    if (extra->abc) {
      unknown |= (extra->unknown_abc & path.rotary_axes()) << 3;
      reference |= extra->reference_abc << 3;
    }
  }
  if (unknown == 0) return;
  out["unknown_axes"] = axes_record(unknown);
  if (reference != 0 && s.reference() != Reference::work) out["reference"] = word(s.reference());
}

void add_work_zero(Record& out, const step::WorkZero& zero) {
  out["sets"] = word(zero.kind);
  out["system"] = zero.system;
  out["zero"] = record_of(zero.zero);
  if (zero.axes != 0) out["axes"] = axes_record(zero.axes);
  if (zero.known != 0) out["at"] = record_of(zero.at);
  if (zero.unknown != 0) out["unknown_axes"] = axes_record(zero.unknown);
}

void add_tool_length(Record& out, const step::ToolLength& length) {
  out["length"] = word(length.kind);
  if (length.kind == ToolLengthKind::table && length.number >= 0) out["number"] = length.number;
  if (length.kind == ToolLengthKind::given) out["offset"] = record_of(length.offset);
}

void add_arc(Record& out, const step::Arc& arc) {
  out["centre"] = record_of(arc.centre);
  out["plane"] = word(arc.plane);
  out["turn"] = word(arc.turn);
  out["extra_turns"] = arc.extra_turns;
}

void add_bead(Record& out, const step::Extrude& bead) {
  out["volume"] = record_of(bead.volume.mm3());
  out["width"] = record_of(bead.width.mm());
  out["height"] = record_of(bead.height.mm());
  if (bead.kind != BeadKind::none) out["kind"] = to_string(bead.kind);
}

/// The limits that are given, by their axis or motion.
void add_limits(Record& out, const step::MotionLimits& limits) {
  out["limit"] = to_string(limits.kind);
  for (std::size_t i = 0; i < limits.values.size(); ++i)
    if ((limits.given >> i & 1u) != 0) out[value_names(limits.kind)[i]] = record_of(limits.values[i]);
}

/// The values of a step that is not a motion.
void add_setting(Record& out, const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  switch (s.kind()) {
    case StepKind::dwell: out["seconds"] = record_of(s.dwell().time.seconds()); break;
    case StepKind::spindle:
      out["rpm"] = record_of(s.spindle().speed.rpm());
      out["turn"] = word(s.spindle().turn);
      if (s.spindle().surface_speed > Feed{})
        out["surface_speed"] = record_of(s.spindle().surface_speed.mm_per_min());
      break;
    case StepKind::coolant:
      out["mist"] = s.coolant().mist;
      out["flood"] = s.coolant().flood;
      break;
    case StepKind::path_mode:
      out["mode"] = word(s.path_mode().kind);
      out["tolerance"] = record_of(s.path_mode().tolerance.mm());
      break;
    case StepKind::temperature:
      out["heater"] = word(s.temperature().heater);
      out["celsius"] = record_of(s.temperature().celsius);
      out["wait"] = s.temperature().wait;
      if (s.temperature().extruder >= 0) out["extruder"] = s.temperature().extruder;
      break;
    case StepKind::extruder: out["extruder"] = s.extruder().number; break;
    case StepKind::fan:
      out["fan"] = s.fan().fan;
      out["share"] = record_of(s.fan().fraction);
      break;
    case StepKind::motion_limits: add_limits(out, s.motion_limits()); break;
    case StepKind::laser_power:
      out["mode"] = word(s.laser_power().mode);
      out["power"] = record_of(s.laser_power().power);
      break;
    case StepKind::layer:
      out["name"] = path.layer(i).name;
      out["colour"] = path.layer(i).colour;
      break;
    case StepKind::tool_change:
      if (s.tool_change().kind == ToolChangeKind::number_only) out["number_only"] = true;
      break;
    case StepKind::note:
    case StepKind::verbatim: out["text"] = path.text(i); break;
    case StepKind::pause: out["pause"] = word(s.pause().kind); break;
    case StepKind::end: out["rewind"] = s.end().rewind; break;
    case StepKind::store_home: out["home"] = word(s.store_home().home); break;
    case StepKind::work_zero: add_work_zero(out, s.work_zero()); break;
    case StepKind::tool_length: add_tool_length(out, s.tool_length()); break;
    case StepKind::unresolved: out["text"] = path.text(i); break;
    case StepKind::close_path:
    case StepKind::rapid:  // motions: see record_of_step
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::probe:
    case StepKind::extrude: break;
  }
}

}  // namespace

Record record_of(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value == 0.0 ? 0.0 : value;
}

Record record_of(Point3 p) { return Record::tuple({record_of(p.x), record_of(p.y), record_of(p.z)}); }

Record record_of(Point2 p) { return Record::tuple({record_of(p.x), record_of(p.y)}); }

Record record_of(const Box3& box) {
  if (box.empty()) return nullptr;
  return Record::tuple({record_of(box.low), record_of(box.high)});
}

Record record_of(const Range& range) {
  if (range.empty()) return nullptr;
  return {{"min", record_of(range.low)}, {"max", record_of(range.high)}};
}

Record record_of(const Origin& origin) {
  return std::visit([](const auto& at) { return origin_record(at); }, origin);
}

Record record_of(const Diagnostic& diagnostic) {
  Record out{{"severity", to_string(diagnostic.severity)},
             {"code", static_cast<unsigned>(diagnostic.code)},
             {"name", name_of(diagnostic.code)},
             {"message", diagnostic.message},
             {"origin", record_of(diagnostic.where)}};
  if (!diagnostic.notes.empty()) {
    Record& notes = out["notes"] = Record::array();
    for (const DiagnosticNote& note : diagnostic.notes)
      notes.push_back(Record{{"message", note.text}, {"origin", record_of(note.where)}});
  }
  if (!diagnostic.hint.empty()) out["hint"] = diagnostic.hint;
  return out;
}

Record record_of(const Diagnostics& diagnostics) {
  Record list = Record::array();
  for (const Diagnostic& d : diagnostics.list()) list.push_back(record_of(d));
  for (const Code code : diagnostics.dropped_codes())
    list.push_back(Record{{"severity", "note"},
                          {"code", static_cast<unsigned>(code)},
                          {"name", name_of(code)},
                          {"message", std::to_string(diagnostics.dropped(code)) + " more of this code"},
                          {"origin", nullptr}});
  return list;
}

Record record_of(const Profile& profile) {
  Record knots = Record::array();
  for (const Knot& k : profile.knots)
    knots.push_back(Record{{"r", record_of(k.r)}, {"z", record_of(k.z)}, {"bulge", record_of(k.bulge)}});
  return knots;
}

Record record_of_step(const Toolpath& path, std::size_t i, std::optional<int> tool) {
  const Step& s = path[i];
  Record out{{"step", name_of(s.kind())}};
  if (s.is_motion()) {
    add_motion(out, path, i);
    if (s.kind() == StepKind::arc) add_arc(out, s.arc());
    if (s.kind() == StepKind::extrude) add_bead(out, path.extrude(i));
    if (s.kind() == StepKind::probe) out["kind"] = word(s.probe().kind);
    if (s.kind() != StepKind::rapid) out["feed"] = record_of(s.feed().mm_per_min());
  } else {
    add_setting(out, path, i);
  }
  if (tool) out["tool"] = *tool;
  out["origin"] = record_of(path.origin_of(i));
  return out;
}

std::string text_of(const Record& json, Layout layout) { return json.text(layout) + "\n"; }

}  // namespace kerf

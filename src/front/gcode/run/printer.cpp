// Printers: Marlin, Klipper and RepRapFirmware. E is the filament; heaters and fans are separate steps.
//
// Source: Marlin's list of G-codes; Klipper's page "G-Codes"; Duet's "GCode dictionary".
#include "front/gcode/run/printer.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/gcode.h"
#include "base/names.h"
#include "front/gcode/comments/slicer_comments.h"
#include "front/gcode/run/printer_limits.h"
#include "front/gcode/run/printer_words.h"
#include "path/bead.h"
#include "path/firmware_commands.h"
#include "path/firmware_retraction.h"
#include "path/planner_texts.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

constexpr double kFullFan = 255.0;
constexpr double kMaxCelsius = 2000.0;
constexpr double kChordTolerance = 0.01;   // mm
constexpr double kDefaultFilament = 1.75;  // mm

}  // namespace

/// True for a line with an M code of printers.
bool Printer::has_code() {
  if (!is_printer()) return false;
  // T alone changes the extruder of a print, or the tool.
  if (line_.has('T') && !line_.has_codes() && line_.large_m_code() < 0) {
    if (line_.value('T') == -1.0) {
      line_.use(LineWords::bit('T'));
      reporter_.note(codes::code_ignored, line_.column('T'), "T-1 deselects all tools; skipped");
      return false;
    }
    if (extrudes_) {
      if (const auto number = extruders_.number_of(*line_.take('T'), line_.column('T')))
        extruders_.use(*number);
      return false;
    }
    tools_.select();
    if (modes_.selected_tool) {
      modes_.tool = *modes_.selected_tool;
      add(step::ToolChange{*modes_.tool});
    }
  }
  if (line_.large_m_code() >= 0) return true;
  if (!line_.has(Group::other)) return false;
  const Tenths code = line_.code(Group::other);
  return code == 820 || code == 830;
}

/// A command that has no meaning here. A G code runs a procedure of the firmware, such as levelling the bed
/// (G29), after which the nozzle may be anywhere; retraction by the firmware leaves it where it is.
void Printer::command(std::string_view text) {
  const auto limits = read_limits(text, program_.dialect, modes_.scale);
  for (const step::MotionLimits& given : limits.list) add(given);
  if (!limits.rest.empty()) add(step::Verbatim{limits.rest});
  if (!limits.list.empty() || !limits.rest.empty() || sets_no_minimum_feed(text)) return;
  if (tool_offset_command(text) || zero_command(text) || extruders_.command(text)) return;
  const std::string command = fold_name(text);
  if (comments_.change_at_pause() && (command == "pause" || command == "m226" || command == "m76"))
    return tools_.change_at_pause();
  if ((program_.dialect == GcodeDialect::klipper && command == "pause") ||
      (program_.dialect == GcodeDialect::reprap && command == "m226") ||
      (modes_.for_snapmaker && command == "m76"))
    return void(add(step::Pause{}));
  const char first = text.front();
  if (const RetractionLine line = read_firmware_retraction(text).line; line != RetractionLine::none) {
    const bool in_units = line == RetractionLine::lengths && modes_.scale != 1.0;
    return void(add(step::Verbatim{in_units ? retraction_in_mm(text, modes_.scale) : std::string(text)}));
  }
  const FirmwareCommand known = firmware_command(text);
  if ((first != 'G' && first != 'g') || known.effect == CommandEffect::harmless || is_macro(known)) {
    add(step::Verbatim{std::string(text)});
    if (is_macro(known)) lose_by_macro(known.name);
    lose_by_free_motors(text);
    return;
  }
  const std::string code = "G" + std::string(text.substr(1, text.find_first_not_of("0123456789.", 1) - 1));
  reporter_.note(
      codes::code_ignored, 1,
      code +
          " runs a procedure of the printer, which is neither simulated nor posted; the position is "
          "unknown after it");
  add(step::Unresolved{code, UnresolvedKind::code});
  coordinates_.lose(kAllAxes);
}

/// A macro of the printer may home and park before the first bead; later ones are taken to return to their
/// start point, unless they are named for what moves.
void Printer::lose_by_macro(const std::string& name) {
  constexpr std::string_view kMoving[] = {"HOME", "PRINT_START", "START_PRINT", "CALIBRATE", "LEVEL", "TILT"};
  const bool moves = std::any_of(std::begin(kMoving), std::end(kMoving),
                                 [&](std::string_view word) { return name.find(word) != std::string::npos; });
  if (!moves && laid_bead_) return;
  reporter_.note(
      codes::code_ignored, 1,
      name + " may be a macro of the printer, which can home and heat; the position is unknown after it");
  coordinates_.lose(kAllAxes);
}

/// RepRapFirmware's G10 P1 X10: the offset of a tool, after which its position in work coordinates is
/// unknown.
bool Printer::tool_offset_command(std::string_view text) {
  const CommandParts parts = command_parts(text);
  if (program_.dialect != GcodeDialect::reprap || parts.name != "g10") return false;
  const auto has = [&](std::string_view letters) {
    return parts.rest.find_first_of(letters) != std::string_view::npos;
  };
  const bool offset = has("Pp") && has("XYZxyz");
  if (offset) lose_by_offset("G10");
  return offset && !has("Ss");
}

/// A command that moves the zero of the coordinates, or the nozzle against it; without values M206, M218 and
/// Klipper's report only. Sources: Marlin's pages M206, M218, M428; Klipper's page "G-Codes".
bool Printer::zero_command(std::string_view text) {
  const CommandParts parts = command_parts(text);
  const bool here = parts.name == "m428";
  const bool values = parts.name == "m206" || parts.name == "m218" || parts.name == "setgcodeoffset" ||
                      parts.name == "setkinematicposition";
  if (!here && !(values && parts.rest.find_first_of("XYZxyz") != std::string_view::npos)) return false;
  lose_by_offset(text.substr(0, text.find_first_of(" \t")));
  return true;
}

void Printer::lose_by_offset(std::string_view code) {
  reporter_.unusual(codes::value_unknown, 1,
                    fmt::format("{} moves the zero of the coordinates, which is not supported", code));
  add(step::Unresolved{fmt::format("the position after {}, which moves the zero,", code)});
  coordinates_.lose(kAllAxes);
}

/// M18 and M84 switch the motors of the named axes off, or all: who moves the nozzle by hand then moves it
/// from its position. With S they set a time only, with E the motors of extruders. Source: Marlin's page M18.
void Printer::lose_by_free_motors(std::string_view text) {
  const CommandParts parts = command_parts(text);
  if (parts.name != "m18" && parts.name != "m84") return;
  unsigned axes = 0;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (const char letter : {"XYZ"[axis], "xyz"[axis]})
      if (parts.rest.find(letter) != std::string_view::npos) axes |= 1u << axis;
  const bool others = parts.rest.find_first_of("ESes") != std::string_view::npos;
  coordinates_.lose(axes == 0 && !others ? kAllAxes : axes);
}

void Printer::run_code() {
  const int code = line_.large_m_code();
  if (code < 0) {
    filament_relative_ = line_.code(Group::other) == 830;
    return;
  }
  const auto heat = [&](Heater heater, bool wait) {
    const double celsius =
        std::clamp(line_.take('S').value_or(line_.take('R').value_or(0.0)), 0.0, kMaxCelsius);
    const auto given = heater == Heater::nozzle ? line_.take('T') : std::nullopt;
    const auto number = given ? extruders_.number_of(*given, line_.column('T')) : std::optional(-1);
    if (number) add(step::Temperature{heater, celsius, wait, *number});
  };
  switch (code) {
    case 104: return heat(Heater::nozzle, false);
    case 109: return heat(Heater::nozzle, true);
    case 140: return heat(Heater::bed, false);
    case 190: return heat(Heater::bed, true);
    case 141: return heat(Heater::chamber, false);
    case 191: return heat(Heater::chamber, true);
    case 106:
    case 107: {
      const auto fan =
          static_cast<int>(std::clamp(line_.take('P').value_or(0.0), 0.0, double{limits::kMaxFans}));
      double power = code == 107 ? 0.0 : line_.take('S').value_or(kFullFan);
      if (program_.dialect == GcodeDialect::reprap && power <= 1.0) power *= kFullFan;
      add(step::Fan{fan, std::clamp(power / kFullFan, 0.0, 1.0)});
      return;
    }
    case 200: return set_volumetric();
    default: add(step::Verbatim{fmt::format("M{}", code)}); return;  // for the controller
  }
}

/// G28 runs to the end switches, G92 sets coordinates and the E position.
void Printer::use_reference() {
  const Tenths code = line_.code(Group::reference);
  if (code == 920) {
    const std::optional<double> e = line_.take('E');
    if (e) extruders_.set_filament(*e);
    if (line_.has_unused(kAxisLetters)) coordinates_.shift_zero();
    return;
  }
  if (code == 100 && program_.dialect == GcodeDialect::reprap) {
    const double what = line_.value('L');
    if (what == 2.0 || what == 20.0) return coordinates_.set_data();
    lose_by_offset("G10");
  }
  if (code == 280) run_to_end_switches();
  line_.use(kAllLetters);
}

/// Homing of the named axes, or of all.
void Printer::run_to_end_switches() {
  const bool all = !line_.has_any(kAxisLetters);
  auto to = position_;
  for (int axis = 0; axis < 3; ++axis) {
    if (!all && !line_.has(static_cast<char>('X' + axis))) continue;
    to.at[axis] = 0.0;
    to.unknown |= 1u << axis;
    to.reference_axes |= 1u << axis;
  }
  to.reference = Reference::end_switches;
  mover_.rapid(to);
}

/// Filament diameter: from the options, else from the slicer's comments, else the default.
void Printer::set_filament(std::string_view text) {
  filament_diameter_ = options_.filament_diameter ? *options_.filament_diameter
                                                  : find_filament_diameter(text).value_or(kDefaultFilament);
  if (mm(filament_diameter_) != kUsualFilament) add(step::Note{filament_note(mm(filament_diameter_))});
  volumetric_ = find_volumetric(text);
  extrudes_ = extrudes(text);
  const auto notes = limit_notes(text);
  for (const std::string_view note : notes) add(step::Note{std::string(note)});
  if (notes.empty() && program_.dialect == GcodeDialect::klipper) add(step::Note{std::string(kKlipperNote)});
  program_.filament_diameter = filament_diameter_;
  program_.filament_density = find_filament_density(text);
}

/// M200: with a diameter (D) above 0 the E words are volumes from here on; S1 and S0 switch only that.
void Printer::set_volumetric() {
  const auto diameter = line_.take('D'), on = line_.take('S');
  if (diameter) volumetric_ = *diameter > 0.0;
  if (on) volumetric_ = *on != 0.0;
}

/// Marlin's G91 applies to E too, Klipper's does not.
bool Printer::filament_is_relative() const {
  return filament_relative_ || (program_.dialect == GcodeDialect::marlin && !modes_.absolute);
}

/// A straight motion with an E word: a bead; without motion, filament that is extruded or retracted.
void Printer::extrude(const ToolPosition& to, double feed) {
  const double e = line_.take('E').value_or(0.0);
  const bool relative = filament_is_relative();
  const double pushed = relative ? e : e - extruders_.filament();
  extruders_.set_filament(relative ? extruders_.filament() + e : e);
  const double area = std::numbers::pi / 4.0 * filament_diameter_ * filament_diameter_;
  if (!(to.at == position_.at) && pushed == 0.0) return mover_.cut(to, feed);
  laid_bead_ = laid_bead_ || (pushed > 0.0 && distance(to.at.xy(), position_.at.xy()) > 0.0);
  step::Extrude bead;
  bead.to = to.at;
  bead.volume = Volume::raw(extruders_.flow_factor() * (volumetric_ ? pushed : pushed * modes_.scale * area));
  bead.width = mm(beads_.width);
  bead.height = mm(beads_.height);
  bead.kind = beads_.kind;
  bead.feed = mm_per_min(feed);
  if (std::isfinite(bead.volume.raw()) && add(bead)) mover_.arrive(to);
}

/// Beads are straight: an arc with an E word becomes chords, each with an equal fraction of the filament.
void Printer::extrude_arc(const ArcWalk& walk, const ToolPosition& to, Feed feed) {
  const double e = line_.take('E').value_or(0.0);
  const bool relative = filament_is_relative();
  const double pushed = relative ? e : e - extruders_.filament();
  const int count = walk.chords(mm(kChordTolerance), limits::kMaxChords);
  const double start = extruders_.filament();
  for (int i = 1; i <= count; ++i) {
    ToolPosition next = to;
    if (i < count) next.at = walk.at(i / double(count));
    line_.set('E', relative ? pushed / count : start + pushed * i / count);
    extrude(next, feed.mm_per_min());
  }
}

}  // namespace kerf::gcode

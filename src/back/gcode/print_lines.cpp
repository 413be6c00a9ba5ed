// Printers: beads with their comments, extruders, heaters, fans.
//
// The comments are those of PrusaSlicer, which OrcaSlicer, SuperSlicer and the interfaces of printers read
// too.
#include "back/gcode/print_lines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/number.h"
#include "path/bead.h"

namespace kerf::gcode {
namespace {

constexpr int kDecimalsExtruded = 5;
constexpr double kSameLayer = 0.01;  // mm in Z
constexpr int kCommentDecimals = 5;  // of widths and heights in comments, mm
constexpr double kFineFan = 10.0;    // fans with a smaller full speed need decimals
constexpr int kFanDecimals = 3;

std::int64_t counts_of(double value, int decimals) { return std::llround(value * std::pow(10.0, decimals)); }

/// The names of PrusaSlicer.
std::string_view comment_of(BeadKind kind) {
  switch (kind) {
    case BeadKind::none:
    case BeadKind::custom: break;
    case BeadKind::skirt: return "Skirt/Brim";
    case BeadKind::outer_wall: return "External perimeter";
    case BeadKind::wall: return "Perimeter";
    case BeadKind::overhang: return "Overhang perimeter";
    case BeadKind::infill: return "Internal infill";
    case BeadKind::solid_infill: return "Solid infill";
    case BeadKind::top: return "Top solid infill";
    case BeadKind::bridge: return "Bridge infill";
    case BeadKind::gap_fill: return "Gap fill";
    case BeadKind::ironing: return "Ironing";
    case BeadKind::support: return "Support material";
    case BeadKind::support_interface: return "Support material interface";
    case BeadKind::purge: return "Wipe tower";
  }
  return "Custom";
}

}  // namespace

double PrintLines::in_e_words(double volume) const {
  if (profile_.extruder.unit == ExtruderUnit::volume) return volume;
  return volume / filament_.area() / units_.unit_mm;
}

void PrintLines::extrude(std::size_t i) {
  if (!profile_.has_letter('E')) return report_unsupported(i, "the controller cannot extrude (no E word)");
  const step::Extrude bead = path_.extrude(i);
  extruded_ += in_e_words(bead.volume.mm3());
  const std::int64_t whole = counts_of(extruded_, kDecimalsExtruded);
  const std::int64_t e = profile_.extruder.mode == ExtruderMode::absolute ? whole : whole - written_extruded_;
  const Counts to = axes_.counts(bead.to);
  const unsigned axes = axes_.to_write(i, to);
  if (axes_.by_distance(i, to) != 0) report_unsupported(i, "a bead starts at an unknown position");
  if (axes == 0 && whole == written_extruded_) return;
  if (profile_.bead_comments == BeadComments::slicer && axes != 0 && bead.volume > Volume())
    comment_on_bead(i, bead);
  lines_.start_line();
  words_.put_motion(1);
  axes_.put(to, axes);
  if (whole != written_extruded_) lines_.word('E', e, kDecimalsExtruded);
  written_extruded_ = whole;
  words_.put_feed(i);
  axes_.arrive(i, to, axes);
  lines_.end_line(i);
}

/// Klipper starts E at 0 after the change of the extruder, other firmwares keep it: G92 makes them equal.
void PrintLines::select_extruder(std::size_t i) {
  const int number = path_[i].extruder().number;
  if (profile_.extruder_lines.empty())
    return report_unsupported(i, fmt::format("the controller cannot select extruder {}", number));
  texts_.set_extruder(number);
  texts_.templates(profile_.extruder_lines);
  if (profile_.extruder.mode == ExtruderMode::relative) return;
  extruded_ -= static_cast<double>(written_extruded_) * std::pow(10.0, -kDecimalsExtruded);
  written_extruded_ = 0;
  words_.raw_line("G92 E0");
}

void PrintLines::push(std::size_t i, double volume, Feed feed) {
  extruded_ += in_e_words(volume);
  const std::int64_t whole = counts_of(extruded_, kDecimalsExtruded);
  lines_.start_line();
  words_.put_motion(1);
  lines_.word('E', profile_.extruder.mode == ExtruderMode::absolute ? whole : whole - written_extruded_,
              kDecimalsExtruded);
  written_extruded_ = whole;
  words_.put_feed(feed);
  lines_.end_line(i);
}

/// A second G10 or G11 in a row has no effect, as in the firmwares.
void PrintLines::firmware_retraction(std::size_t i, const FirmwareRetraction& retraction) {
  if (!profile_.has_letter('E')) return report_unsupported(i, "the controller cannot extrude (no E word)");
  const bool back = retraction.line == RetractionLine::back;
  if (retraction.line == RetractionLine::lengths) {
    lengths_.update(retraction.lengths);
    if (profile_.extruder.retraction == RetractionPolicy::firmware) put_lengths(i, retraction.lengths);
    return;
  }
  const bool has_both = profile_.has_g(100) && profile_.has_g(110);
  if (profile_.extruder.retraction == RetractionPolicy::firmware && has_both)
    return lines_.code_line(i, 'G', back ? 100 : 110);
  if (back == (drawn_back_ > 0.0)) return;
  const Feed speed = lengths_.speed ? mm_per_min(*lengths_.speed) : profile_.extruder.retract_speed;
  if (back) {
    drawn_back_ = lengths_.length.value_or(profile_.extruder.retract.mm()) * filament_.area();
    return push(i, -drawn_back_, speed);
  }
  push(i, drawn_back_ + lengths_.extra.value_or(0.0) * filament_.area(),
       lengths_.return_speed ? mm_per_min(*lengths_.return_speed) : speed);
  drawn_back_ = 0.0;
}

/// M207 and M208 of Marlin, M207 of RepRapFirmware, SET_RETRACTION of Klipper.
void PrintLines::put_lengths(std::size_t i, const RetractionLengths& lengths) {
  constexpr int kDecimals = 6;
  std::string first, second;
  const auto put = [](std::string& line, std::string_view name, std::optional<double> value, double scale) {
    if (value) line += fmt::format(" {}{}", name, number_text(*value * scale, kDecimals));
  };
  if (profile_.limits == LimitCommands::klipper) {
    constexpr double kPerSecond = 1.0 / 60.0;
    put(first, "RETRACT_LENGTH=", lengths.length, 1.0);
    put(first, "RETRACT_SPEED=", lengths.speed, kPerSecond);
    put(first, "UNRETRACT_EXTRA_LENGTH=", lengths.extra, 1.0);
    put(first, "UNRETRACT_SPEED=", lengths.return_speed, kPerSecond);
    if (!first.empty()) lines_.text_line("SET_RETRACTION" + first);
    return;
  }
  if (!profile_.has_m(2070))
    return report_skipped(i, "the controller has no M207; the length of retractions");
  const bool reprap = profile_.limits == LimitCommands::reprap;
  const double to_units = 1.0 / units_.unit_mm;
  put(first, "S", lengths.length, to_units);
  put(first, "F", lengths.speed, to_units);
  put(reprap ? first : second, reprap ? "R" : "S", lengths.extra, to_units);
  put(reprap ? first : second, reprap ? "T" : "F", lengths.return_speed, to_units);
  put(first, "Z", lengths.hop, to_units);
  if (!first.empty()) lines_.text_line("M207" + first);
  if (!second.empty()) lines_.text_line("M208" + second);
}

/// Layer, kind, width and height of a bead, where they change. A chain of beads that climbs (a vase) starts a
/// layer where it has climbed by the height of a bead.
void PrintLines::comment_on_bead(std::size_t i, const step::Extrude& bead) {
  const double width = bead.width.mm(), height = bead.height.mm();
  const bool known = position_.is_known() && path_[i].unknown_axes() == 0;
  const double z = position_.at.z;
  const double step = on_bead_ ? std::max(height, kSameLayer) : 0.0;
  if (known && (!layer_z_ || z > *layer_z_ + step + (on_bead_ ? -kSameLayer : kSameLayer) ||
                z < *layer_z_ - kSameLayer)) {
    layer_z_ = z;
    lines_.text_line(";LAYER_CHANGE");
    lines_.text_line(";Z:" + number_text(z, kCommentDecimals));
  }
  const bool first_kind = !commented_kind_ && bead.kind != BeadKind::none;
  if (first_kind || (commented_kind_ && *commented_kind_ != bead.kind)) {
    commented_kind_ = bead.kind;
    lines_.text_line(fmt::format(";TYPE:{}", comment_of(bead.kind)));
  }
  if (width != commented_width_) {
    commented_width_ = width;
    lines_.text_line(";WIDTH:" + number_text(width, kCommentDecimals));
  }
  if (height != commented_height_) {
    commented_height_ = height;
    lines_.text_line(";HEIGHT:" + number_text(height, kCommentDecimals));
  }
}

void PrintLines::temperature(std::size_t i) {
  const step::Temperature t = path_[i].temperature();
  constexpr int kSet[] = {1040, 1400, 1410}, kWait[] = {1090, 1900, 1910};
  const int tenths = (t.wait ? kWait : kSet)[static_cast<std::size_t>(t.heater)];
  if (t.heater == Heater::chamber && !profile_.has_m(tenths))
    return report_skipped(
        i, fmt::format("the controller has no M{} for a chamber; setting its temperature", tenths / 10));
  if (!can_m(i, tenths, "a heater")) return;
  lines_.start_line();
  lines_.code('M', tenths);
  if (t.heater == Heater::nozzle && t.extruder >= 0) lines_.word('T', t.extruder, 0);
  lines_.word('S', counts_of(t.celsius, 1), 1);
  lines_.end_line(i);
}

void PrintLines::fan(std::size_t i) {
  const step::Fan f = path_[i].fan();
  const bool on = f.fraction > 0.0;
  if (!can_m(i, on || !profile_.has_m(1070) ? 1060 : 1070, "a fan")) return;
  const int decimals = profile_.fan_full < kFineFan ? kFanDecimals : 0;
  lines_.start_line();
  lines_.code('M', on || !profile_.has_m(1070) ? 1060 : 1070);
  if (f.fan != 0) lines_.word('P', f.fan, 0);
  if (on || !profile_.has_m(1070))
    lines_.word('S', counts_of(std::min(f.fraction, 1.0) * profile_.fan_full, decimals), decimals);
  lines_.end_line(i);
}

void PrintLines::start_file() {
  drawn_back_ = 0.0;
  extruded_ = 0.0;
  written_extruded_ = 0;
  layer_z_.reset();
  commented_kind_.reset();
  commented_width_ = commented_height_ = 0.0;
}

}  // namespace kerf::gcode

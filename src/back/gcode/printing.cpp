// Printers: beads with their comments, heaters, fans, limits of motions, thumbnails.
//
// The comments are those of PrusaSlicer, which OrcaSlicer, SuperSlicer and the interfaces of printers read
// too.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "back/gcode/poster.h"
#include "base/number.h"
#include "path/bead.h"

namespace kerf::gcode {
namespace {

constexpr int kDecimalsExtruded = 5;
constexpr double kSameLayer = 0.01;  // mm in Z
constexpr int kCommentDecimals = 5;  // of widths and heights in comments, mm
constexpr int kLimitDecimals = 3;    // of speeds and accelerations
constexpr double kFineFan = 10.0;    // fans with a smaller full speed need decimals
constexpr int kFanDecimals = 3;
constexpr std::size_t kThumbnailLine = 78;  // characters of a picture on each line

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

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

}  // namespace

/// That of the printer, else of the program, else the usual one.
Length Poster::filament_diameter() const {
  for (const Length diameter : {profile_.filament, options_.filament, filament_of_path(path_)})
    if (diameter > Length()) return diameter;
  return kUsualFilament;
}

/// Whether a print needs a comment with the diameter: it is an unusual one, and the header has none.
bool Poster::states_filament() const {
  if (filament_ == kUsualFilament) return false;
  if (profile_.comments != CommentStyle::semicolon || !path_.has(StepKind::extrude)) return false;
  return std::none_of(profile_.header.begin(), profile_.header.end(), [](const std::string& line) {
    return is_comment(line) && line.find("filament_diameter") != std::string::npos;
  });
}

double Poster::filament_area() const {
  const double radius = 0.5 * filament_.mm();
  return std::numbers::pi * radius * radius;
}

void Poster::extrude(std::size_t i) {
  if (!profile_.has_letter('E')) return report_unsupported(i, "the controller cannot extrude (no E word)");
  const step::Extrude bead = path_.extrude(i);
  extruded_ += bead.volume.mm3() / filament_area();
  const double unit_mm = unit_ == LengthUnit::mm ? 1.0 : kMmPerInch;
  const std::int64_t whole = counts_of(extruded_ / unit_mm, kDecimalsExtruded);
  const std::int64_t e = profile_.extruder == ExtruderMode::absolute ? whole : whole - written_extruded_;
  const Counts to = grid_counts(bead.to);
  const unsigned axes = axes_to_write(i, to);
  if (axes_by_distance(i, to) != 0) report_unsupported(i, "a bead starts at an unknown position");
  if (axes == 0 && whole == written_extruded_) return;
  if (profile_.bead_comments == BeadComments::slicer && axes != 0 && bead.volume > Volume())
    comment_on_bead(i, bead);
  start_line();
  put_motion(1);
  put_axes(to, axes);
  if (whole != written_extruded_) word('E', e, kDecimalsExtruded);
  written_extruded_ = whole;
  put_feed(i);
  arrive(i, to, axes);
  end_line(i);
}

/// Klipper starts E at 0 after the change of the extruder, other firmwares keep it: G92 makes them equal.
void Poster::select_extruder(std::size_t i) {
  const int number = path_[i].extruder().number;
  if (profile_.extruder_lines.empty())
    return report_unsupported(i, fmt::format("the controller cannot select extruder {}", number));
  extruder_ = number;
  templates(profile_.extruder_lines);
  if (profile_.extruder == ExtruderMode::relative) return;
  extruded_ -= static_cast<double>(written_extruded_) * std::pow(10.0, -kDecimalsExtruded) *
               (unit_ == LengthUnit::mm ? 1.0 : kMmPerInch);
  written_extruded_ = 0;
  raw_line("G92 E0");
}

void Poster::put_comment(std::string_view text) {
  line_.clear();
  line_.put(text);
  end_line(path_.size());
}

/// Layer, kind, width and height of a bead, where they change. A chain of beads that climbs (a vase) starts a
/// layer where it has climbed by the height of a bead.
void Poster::comment_on_bead(std::size_t i, const step::Extrude& bead) {
  const double width = bead.width.mm(), height = bead.height.mm();
  const bool known = position_.is_known() && path_[i].unknown_axes() == 0;
  const double z = position_.at.z;
  const double step = on_bead_ ? std::max(height, kSameLayer) : 0.0;
  if (known && (!layer_z_ || z > *layer_z_ + step + (on_bead_ ? -kSameLayer : kSameLayer) ||
                z < *layer_z_ - kSameLayer)) {
    layer_z_ = z;
    put_comment(";LAYER_CHANGE");
    put_comment(";Z:" + number_text(z, kCommentDecimals));
  }
  const bool first_kind = !commented_kind_ && bead.kind != BeadKind::none;
  if (first_kind || (commented_kind_ && *commented_kind_ != bead.kind)) {
    commented_kind_ = bead.kind;
    put_comment(fmt::format(";TYPE:{}", comment_of(bead.kind)));
  }
  if (width != commented_width_) {
    commented_width_ = width;
    put_comment(";WIDTH:" + number_text(width, kCommentDecimals));
  }
  if (height != commented_height_) {
    commented_height_ = height;
    put_comment(";HEIGHT:" + number_text(height, kCommentDecimals));
  }
}

void Poster::temperature(std::size_t i) {
  const step::Temperature t = path_[i].temperature();
  constexpr int kSet[] = {1040, 1400, 1410}, kWait[] = {1090, 1900, 1910};
  const int tenths = (t.wait ? kWait : kSet)[static_cast<std::size_t>(t.heater)];
  if (t.heater == Heater::chamber && !profile_.has_m(tenths))
    return report_skipped(
        i, fmt::format("the controller has no M{} for a chamber; setting its temperature", tenths / 10));
  if (!can_m(i, tenths, "a heater")) return;
  start_line();
  code('M', tenths);
  if (t.heater == Heater::nozzle && t.extruder >= 0) word('T', t.extruder, 0);
  word('S', counts_of(t.celsius, 1), 1);
  end_line(i);
}

void Poster::fan(std::size_t i) {
  const step::Fan f = path_[i].fan();
  const bool on = f.fraction > 0.0;
  if (!can_m(i, on || !profile_.has_m(1070) ? 1060 : 1070, "a fan")) return;
  const int decimals = profile_.fan_full < kFineFan ? kFanDecimals : 0;
  start_line();
  code('M', on || !profile_.has_m(1070) ? 1060 : 1070);
  if (f.fan != 0) word('P', f.fan, 0);
  if (on || !profile_.has_m(1070))
    word('S', counts_of(std::min(f.fraction, 1.0) * profile_.fan_full, decimals), decimals);
  end_line(i);
}

// ---- limits of motions

/// A limit that the firmware has no command for changes the time of a print, not its shape: one warning.
void Poster::skip_limits(std::size_t i, LimitKind kind) {
  const unsigned bit = 1u << static_cast<unsigned>(kind);
  if ((skipped_limits_ & bit) != 0) return;
  skipped_limits_ |= bit;
  std::string name(to_string(kind));
  std::replace(name.begin(), name.end(), '_', ' ');
  report_skipped(i, fmt::format("{} has no command for this limit ({}); it", profile_.title, name));
}

/// The given values as words, multiplied by `factor`.
void Poster::put_limits(std::size_t i, const step::MotionLimits& limits, std::string_view letters,
                        double factor) {
  const double unit_mm = unit_ == LengthUnit::mm ? 1.0 : kMmPerInch;
  for (std::size_t k = 0; k < letters.size(); ++k)
    if ((limits.given >> k & 1u) != 0)
      word(letters[k], counts_of(limits.values[k] * factor / unit_mm, kLimitDecimals), kLimitDecimals);
  end_line(i);
}

void Poster::motion_limits(std::size_t i) {
  const step::MotionLimits limits = path_[i].motion_limits();
  if (profile_.limits == LimitCommands::klipper) return put_klipper_limit(i, limits);
  constexpr double kPerMinute = 60.0;
  const bool reprap = profile_.limits == LimitCommands::reprap;
  const double speed = reprap ? kPerMinute : 1.0;
  const bool jerk_in_566 = reprap && limits.kind == LimitKind::jerk;
  const bool own_kind =
      limits.kind == LimitKind::corner_speed || (reprap && limits.kind == LimitKind::junction_deviation);
  if (profile_.limits == LimitCommands::none || own_kind) return skip_limits(i, limits.kind);
  constexpr int kCodes[] = {2010, 2030, 2040, 2050, 2050};
  const int tenths = jerk_in_566 ? 5660 : kCodes[static_cast<std::size_t>(limits.kind)];
  if (!profile_.has_m(tenths)) return skip_limits(i, limits.kind);
  start_line();
  code('M', tenths);
  switch (limits.kind) {
    case LimitKind::axis_acceleration: return put_limits(i, limits, "XYZE", 1.0);
    case LimitKind::axis_speed: return put_limits(i, limits, "XYZE", speed);
    case LimitKind::acceleration: return put_limits(i, limits, "PRT", 1.0);
    case LimitKind::jerk: return put_limits(i, limits, "XYZE", speed);
    case LimitKind::junction_deviation: return put_limits(i, limits, "J", 1.0);
    case LimitKind::corner_speed: return;
  }
}

/// Klipper has one acceleration for all motions, and one speed for X and Y together.
void Poster::put_klipper_limit(std::size_t i, const step::MotionLimits& limits) {
  double value = -1.0;
  for (std::size_t k = 0; k < limits.values.size(); ++k) {
    const bool counts = limits.kind == LimitKind::acceleration ? k == 0 || k == 2
                        : limits.kind == LimitKind::axis_speed ? k < 2
                                                               : k == 0;
    if (counts && (limits.given >> k & 1u) != 0)
      value = value < 0.0 ? limits.values[k] : std::min(value, limits.values[k]);
  }
  const std::string_view name = limits.kind == LimitKind::acceleration   ? "ACCEL"
                                : limits.kind == LimitKind::axis_speed   ? "VELOCITY"
                                : limits.kind == LimitKind::corner_speed ? "SQUARE_CORNER_VELOCITY"
                                                                         : "";
  if (name.empty() || value < 0.0) return skip_limits(i, limits.kind);
  put_comment(fmt::format("SET_VELOCITY_LIMIT {}={}", name, number_text(value, kLimitDecimals)));
}

// ---- templates

void Poster::thumbnails() {
  if (profile_.comments != CommentStyle::semicolon || !profile_.has_letter('E')) return;
  for (const Thumbnail& picture : options_.thumbnails) {
    const std::string text = base64(picture.png);
    put_comment(";");
    put_comment(fmt::format("; thumbnail begin {}x{} {}", picture.width, picture.height, text.size()));
    for (std::size_t k = 0; k < text.size(); k += kThumbnailLine)
      put_comment("; " + text.substr(k, kThumbnailLine));
    put_comment("; thumbnail end");
    put_comment(";");
  }
}

/// The names of templates for prints; those of the steps of the current file.
std::optional<std::string> Poster::print_value_of(std::string_view key) {
  if (key == "extruder") return profile_.extruder == ExtruderMode::relative ? "M83" : "M82";
  if (key == "extruder_number") return fmt::format("{}", extruder_);
  if (key == "extruder_name") return extruder_ == 0 ? "extruder" : fmt::format("extruder{}", extruder_);
  if (key == "filament_diameter") return number_text(filament_.mm(), 4);
  constexpr std::string_view kHeaters[] = {"nozzle", "bed", "chamber"};
  for (std::size_t h = 0; h < std::size(kHeaters); ++h) {
    if (key != kHeaters[h]) continue;
    for (std::size_t i = file_start_; i < file_end_; ++i) {
      if (path_[i].kind() != StepKind::temperature) continue;
      const step::Temperature t = path_[i].temperature();
      if (static_cast<std::size_t>(t.heater) == h && t.celsius > 0.0) return number_text(t.celsius, 1);
    }
    return "0";
  }
  if (key != "filament_mm" && key != "filament_cm3" && key != "layers" && key != "layer_height")
    return std::nullopt;
  double volume = 0.0;
  std::vector<double> levels;
  for (std::size_t i = file_start_; i < file_end_; ++i) {
    if (path_[i].kind() != StepKind::extrude) continue;
    const step::Extrude bead = path_.extrude(i);
    volume += bead.volume.mm3();
    if (bead.volume > Volume() && (levels.empty() || bead.to.z != levels.back())) levels.push_back(bead.to.z);
  }
  if (key == "filament_mm") return number_text(volume / filament_area(), 2);
  if (key == "filament_cm3") return number_text(1e-3 * volume, 3);
  std::sort(levels.begin(), levels.end());
  const auto same = [](double a, double b) { return b - a <= kSameLayer; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  if (key == "layers") return fmt::format("{}", levels.size());
  return number_text(levels.empty() ? 0.0 : levels.front(), 3);
}

}  // namespace kerf::gcode

// Motions as lines: axes, feeds, arcs, chords; and the function for each kind of step.
#include "back/gcode/poster.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "kerf/units.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxCounts = 1e13;  // of a position; exact in a double with room for differences
constexpr std::size_t kStepsBetweenReports = 1 << 16;
constexpr std::size_t kBytesPerStep = 24;  // typical
constexpr int kDecimalsExtruded = 5;

double power_of_ten(int exponent) { return std::pow(10.0, exponent); }

}  // namespace

Poster::Poster(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
               Diagnostics& diagnostics)
    : path_(path),
      profile_(profile),
      options_(options),
      diagnostics_(diagnostics),
      unit_(options.unit.value_or(profile.unit)),
      tool_policy_(options.tool_change.value_or(profile.tool_change)),
      decimals_(unit_ == LengthUnit::mm ? profile.decimals_mm : profile.decimals_inch),
      fraction_(profile.zeros == Zeros::kept ? Fraction::full : Fraction::shortest) {
  const double unit_mm = unit_ == LengthUnit::mm ? 1.0 : kMmPerInch;
  grid_.counts_per_mm = power_of_ten(decimals_) / unit_mm;
  counts_per_feed_ = power_of_ten(profile.decimals_feed) / unit_mm;
}

std::vector<PostedFile> Poster::run(Progress* progress) {
  if (unit_ == LengthUnit::inch && !profile_.has_g(200))
    diagnostics_.error(Code::post_cannot, {}, "the controller has no inches (G20)");
  open_file(0);
  out_.reserve(out_.size() + kBytesPerStep * path_.size());
  for (std::size_t i = 0; i < path_.size(); ++i) {
    if (i % kStepsBetweenReports == 0) {
      if (stop_requested(progress)) return {};
      report(progress, static_cast<double>(i) / static_cast<double>(path_.size()));
    }
    write_step(i);
  }
  close_file();
  report(progress, 1.0);
  return std::move(files_);
}

void Poster::write_step(std::size_t i) {
  const Step& s = path_[i];
  if (s.is_motion()) return write_motion(i);
  switch (s.kind()) {
    case StepKind::dwell: return dwell(i, s.dwell().time);
    case StepKind::tool_change: return tool_change(i);
    case StepKind::spindle: return spindle(i);
    case StepKind::coolant: return coolant(i, wanted_coolant_ = s.coolant());
    case StepKind::path_mode: return path_mode(i);
    case StepKind::temperature: return temperature(i);
    case StepKind::fan: return fan(i);
    case StepKind::laser_power: return laser(i);
    case StepKind::layer: return comment(path_.layer(i).name);
    case StepKind::note: return comment(path_.text(i));
    case StepKind::verbatim: return verbatim(i);
    case StepKind::pause: return pause(i);
    case StepKind::store_home: return store_home(i);
    default: return;  // the end of the program is written with the end of the file
  }
}

void Poster::write_motion(std::size_t i) {
  const Step& s = path_[i];
  if (!fits(i)) return;
  if (restore_) restore(i);
  if (!moved_ && files_.size() > 0) approach(i);
  if (s.reference_axes() != 0)
    to_reference(s.kind() == StepKind::rapid ? 0 : 1, i);
  else if (s.kind() == StepKind::rapid)
    straight(0, i);
  else if (s.kind() == StepKind::cut)
    straight(1, i);
  else if (s.kind() == StepKind::arc)
    arc(i);
  else if (s.kind() == StepKind::probe)
    probe(i);
  else
    extrude(i);
  moved_ = true;
  from_ = s.to();
  unknown_from_ = s.unknown_axes();
}

/// Whether the motion can be written: numbers within the limits, no height correction.
bool Poster::fits(std::size_t i) {
  const Step& s = path_[i];
  double farthest = std::max({std::abs(s.to().x), std::abs(s.to().y), std::abs(s.to().z), s.feed().raw()});
  if (s.kind() == StepKind::arc) {
    const Point2 centre = s.arc().centre;
    farthest = std::max({farthest, std::abs(centre.x), std::abs(centre.y)});
  }
  if (!(farthest * grid_.counts_per_mm < kMaxCounts)) {
    diagnostics_.error(Code::post_number_large, path_.origin_of(i),
                       "a position or feed is too large to be written");
    return false;
  }
  if (correction_of(i).empty()) return true;
  if (profile_.comments == CommentStyle::brackets && unit_ == LengthUnit::mm &&
      correction_of(i).size() <= kMaxFormula) {
    if (!uncorrected_reported_)
      diagnostics_
          .warning(Code::heights_uncorrected, path_.origin_of(i),
                   "heights have to be corrected by measured values; each is written with its formula")
          .hint =
          "specify the values with --measured, or apply them to the written program with kerf adjustz";
    uncorrected_reported_ = true;
    return true;
  }
  report_unsupported(i, "the heights depend on measured values, and their formulas cannot be written here");
  return true;
}

/// The formula of the height at the end of a motion; empty: it has none.
std::string_view Poster::correction_of(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  return extra != nullptr ? std::string_view(extra->z_correction) : std::string_view();
}

/// The formula behind a Z word, as kerf adjustz reads it.
void Poster::put_correction(std::size_t i) {
  if (const std::string_view formula = correction_of(i); !formula.empty())
    line_.put("(="), line_.put(formula), line_.put(')');
}

/// The axes whose words the line needs.
unsigned Poster::axes_to_write(std::size_t i, const Counts& to) {
  const unsigned unknown = path_[i].unknown_axes();
  unsigned axes = profile_.axes == Repeat::always ? kAllAxes & ~unknown : kAllAxes & ~unknown & ~known_axes_;
  if (!correction_of(i).empty()) axes |= 4u & ~unknown;  // Z
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (to[axis] == at_[axis]) continue;
    const unsigned bit = 1u << axis;
    axes |= bit;
    if ((unknown & bit) != 0)
      diagnostics_.warning(
          Code::post_place_unknown, path_.origin_of(i),
          fmt::format("the position of {} in work coordinates is unknown here; written as {}", "XYZ"[axis],
                      path_[i].to()[static_cast<int>(axis)]));
  }
  return axes;
}

/// Adds the rotary words that change; false if there are none.
bool Poster::add_rotary(std::size_t i) {
  const MotionExtra* extra = path_.extra(i);
  if (extra == nullptr || !extra->abc) return false;
  bool any = false;
  const double scale = power_of_ten(profile_.decimals_degrees);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double degrees = (*extra->abc)[axis];
    const auto counts = static_cast<std::int64_t>(std::llround(degrees * scale));
    if (counts == rotary_[axis] && ((known_rotary_ >> axis & 1u) != 0 || counts == 0)) continue;
    const char letter = static_cast<char>('A' + axis);
    rotary_[axis] = counts;
    known_rotary_ |= 1u << axis;
    if (!profile_.has_letter(letter)) {
      report_unsupported(i, fmt::format("the controller has no rotary axis {}", letter));
      continue;
    }
    word(letter, counts, profile_.decimals_degrees);
    any = true;
  }
  return any;
}

void Poster::put_motion(int g) {
  const bool in_force = g == motion_ && profile_.syntax == LineSyntax::words;
  if (in_force && profile_.motion == Repeat::when_changed) return;
  code('G', g * 10);
  motion_ = g;
}

/// Adds the plane of an arc, on a separate line for LineSyntax::commands.
void Poster::put_plane(std::size_t i, Plane plane) {
  if (plane_ == plane) return;
  plane_ = plane;
  code('G', plane == Plane::xy ? 170 : plane == Plane::xz ? 180 : 190);
  if (profile_.syntax == LineSyntax::words) return;
  end_line(i);
  start_line();
}

void Poster::put_axes(const Counts& to, unsigned axes) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1u) != 0) word(static_cast<char>('X' + axis), to[axis], decimals_);
}

void Poster::put_feed(std::size_t i) {
  Feed feed = path_[i].feed();
  if (!(feed.raw() > 0.0)) feed = options_.missing_feed;
  if (!(feed.raw() > 0.0)) {
    if (!no_feed_reported_)
      diagnostics_.error(Code::post_no_feed, path_.origin_of(i), "a cut without a feed").hint =
          "specify a feed for such cuts with --feed";
    no_feed_reported_ = true;
    return;
  }
  const auto counts = std::max<std::int64_t>(1, std::llround(feed.mm_per_min() * counts_per_feed_));
  if (counts == feed_ && profile_.feed == Repeat::when_changed) return;
  feed_ = counts;
  word('F', counts, profile_.decimals_feed);
}

void Poster::put_power() {
  if (!pending_power_) return;
  word('S', std::llround(*pending_power_ * power_of_ten(profile_.decimals_speed)), profile_.decimals_speed);
  pending_power_.reset();
}

void Poster::arrive(std::size_t i, const Counts& to) {
  at_ = to;
  known_axes_ = kAllAxes & ~path_[i].unknown_axes();
  touched_ = false;
}

void Poster::straight(int g, std::size_t i) { straight_to(g, i, grid_.counts(path_[i].to())); }

void Poster::straight_to(int g, std::size_t i, const Counts& to) {
  const unsigned axes = axes_to_write(i, to);
  start_line();
  put_motion(g);
  put_axes(to, axes);
  put_correction(i);
  const bool rotary = add_rotary(i);
  arrive(i, to);
  if (axes == 0 && !rotary) {  // length 0: written all the same; passes remove such motions
    const unsigned known = kAllAxes & ~path_[i].unknown_axes();
    if (known == 0) {
      line_.clear();
      motion_ = -1;
      return;
    }
    put_axes(to, known & (0u - known));
  }
  if (g == 1) {
    put_feed(i);
    put_power();
  }
  end_line(i);
}

void Poster::arc(std::size_t i) {
  const Step& s = path_[i];
  const step::Arc arc = s.arc();
  const Counts to = grid_.counts(arc.to);
  const PlaneAxes axes = axes_of(arc.plane);
  const unsigned in_plane = (1u << axes.u) | (1u << axes.v);
  if ((unknown_from_ & in_plane) != 0)
    diagnostics_.error(Code::post_place_unknown, path_.origin_of(i),
                       "the start point of an arc is unknown in work coordinates");
  const ArcWalk walk = walk_arc(from_, arc.to, arc.centre, arc.plane, arc.turn, arc.extra_turns);
  unsigned first_axes = axes_to_write(i, to);
  plan_arc(walk, at_, to, grid_, profile_, plan_);
  if (plan_.uneven)
    diagnostics_.warning(Code::post_arc_uneven, path_.origin_of(i),
                         fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre; "
                                     "written as {} straight cuts",
                                     walk.start_radius, walk.end_radius, plan_.segments.size()));
  if (!correction_of(i).empty() && (plan_.form != ArcForm::arcs || plan_.segments.size() > 1) &&
      (arc.plane != Plane::xy || walk.start_w != walk.end_w))
    return report_unsupported(i, "a helix whose height has a formula has to be divided for this controller");
  if (plan_.form != ArcForm::arcs) return chords(i);
  for (const ArcSegment& segment : plan_.segments) {
    start_line();
    put_plane(i, arc.plane);
    code('G', arc.turn == Turn::cw ? 20 : 30);
    motion_ = arc.turn == Turn::cw ? 2 : 3;
    const auto w = static_cast<std::size_t>(axes.w);
    const bool is_corrected = !correction_of(i).empty();
    const unsigned third = segment.to[w] != at_[w] || is_corrected ? 1u << w : 0u;
    put_axes(segment.to, in_plane | third | first_axes);
    put_correction(i);
    first_axes = 0;
    const std::int64_t centre[3] = {segment.u, segment.v, 0};
    for (const int axis : {0, 1, 2})
      if (axis != axes.w) word(static_cast<char>('I' + axis), centre[axis == axes.u ? 0 : 1], decimals_);
    add_rotary(i);
    put_feed(i);
    put_power();
    arrive(i, segment.to);
    end_line(i);
  }
}

/// The segments of the plan as straight cuts.
void Poster::chords(std::size_t i) {
  const bool several = plan_.segments.size() > 1;
  for (const ArcSegment& segment : plan_.segments) {
    const bool no_motion = segment.to == at_ && known_axes_ == kAllAxes;
    if (!(several && no_motion)) straight_to(1, i, segment.to);
  }
}

void Poster::probe(std::size_t i) {
  const step::Probe probe = path_[i].probe();
  const int tenths = 382 + static_cast<int>(probe.kind);
  if (!profile_.has_g(tenths))
    return report_unsupported(
        i, fmt::format("the controller has no probing motion G{}.{}", tenths / 10, tenths % 10));
  const Counts to = grid_.counts(probe.to);
  if (to == at_ && !touched_) return report_unsupported(i, "controllers refuse a probing motion of length 0");
  const unsigned axes = axes_to_write(i, to);
  start_line();
  code('G', tenths);
  put_axes(to, axes == 0 ? 1u << 2 : axes);
  put_feed(i);
  end_line(i);
  at_ = to;
  known_axes_ = 0;  // the motion ends at contact
  touched_ = true;
  motion_ = -1;
}

void Poster::extrude(std::size_t i) {
  if (!profile_.has_letter('E')) return report_unsupported(i, "the controller cannot extrude (no E word)");
  const double radius = 0.5 * profile_.filament.mm();
  const double area = std::acos(-1.0) * radius * radius;
  extruded_ += path_.extrude(i).volume.mm3() / area;
  const double unit_mm = unit_ == LengthUnit::mm ? 1.0 : kMmPerInch;
  const std::int64_t whole = std::llround(extruded_ / unit_mm * power_of_ten(kDecimalsExtruded));
  const std::int64_t e = profile_.extruder == ExtruderMode::absolute ? whole : whole - written_extruded_;
  const Counts to = grid_.counts(path_[i].to());
  const unsigned axes = axes_to_write(i, to);
  start_line();
  if (axes == 0 && whole == written_extruded_) return;
  put_motion(1);
  put_axes(to, axes);
  if (whole != written_extruded_) word('E', e, kDecimalsExtruded);
  written_extruded_ = whole;
  put_feed(i);
  arrive(i, to);
  end_line(i);
}

/// A motion to machine coordinates, or to a home stored in the controller.
void Poster::to_reference(int g, std::size_t i) {
  const Step& s = path_[i];
  const Counts to = grid_.counts(s.to());
  if (s.reference() == Reference::end_switches) return to_end_switches(i);
  const bool machine = s.reference() == Reference::machine;
  const int tenths = machine ? 530 : s.reference() == Reference::home ? 280 : 300;
  if (!profile_.has_g(tenths) || profile_.syntax == LineSyntax::commands) {
    return report_skipped(
        i, fmt::format("the controller has no G{}; a motion to a machine position", tenths / 10));
  }
  if (machine) {
    start_line();
    code('G', tenths);
    code('G', g * 10);
    put_axes(to, s.reference_axes());
    if (g == 1) put_feed(i);
    end_line(i);
  } else {  // with an intermediate point at distance 0
    start_line();
    code('G', 910);
    code('G', tenths);
    put_axes(Counts{}, s.reference_axes());
    end_line(i);
    start_line();
    code('G', 900);
    end_line(i);
  }
  motion_ = -1;
  arrive(i, to);
}

/// G28 of printers; the axis words are flags.
void Poster::to_end_switches(std::size_t i) {
  const Step& s = path_[i];
  if (!profile_.has_g(280) || profile_.syntax != LineSyntax::commands)
    return report_skipped(i, "the controller has no G28 that runs the axes to their end switches; homing");
  start_line();
  code('G', 280);
  if (s.reference_axes() != kAllAxes) put_axes(Counts{}, s.reference_axes());
  end_line(i);
  motion_ = -1;
  arrive(i, grid_.counts(s.to()));
}

// ---- lines

void Poster::start_line() {
  line_.clear();
  if (profile_.line_number_step == 0) return;
  line_number_ += profile_.line_number_step;
  if (line_number_ > profile_.highest_line_number) line_number_ = profile_.line_number_step;
  word('N', line_number_, 0);
}

void Poster::word(char letter, std::int64_t counts, int decimals) {
  if (profile_.spacing == WordSpacing::blank && !line_.empty()) line_.put(' ');
  line_.put(letter);
  line_.units(counts, decimals, decimals == 0 ? Fraction::shortest : fraction_);
}

/// A G or M code, with a decimal only if it needs one.
void Poster::code(char letter, int tenths) {
  if (profile_.spacing == WordSpacing::blank && !line_.empty()) line_.put(' ');
  line_.put(letter);
  line_.units(tenths, 1, Fraction::shortest);
}

void Poster::end_line(std::size_t i) {
  const std::string_view text = line_.text();
  if (text.size() > profile_.longest_line)
    diagnostics_.error(Code::post_line_long, i < path_.size() ? path_.origin_of(i) : Origin{},
                       fmt::format("a line of {} bytes; the maximum of the controller is {}", text.size(),
                                   profile_.longest_line));
  out_ += text;
  out_ += profile_.line_end == LineEnd::crlf ? "\r\n" : "\n";
  ++lines_;
}

void Poster::report_unsupported(std::size_t i, std::string message) {
  diagnostics_.error(Code::post_cannot, path_.origin_of(i), std::move(message));
}

void Poster::report_skipped(std::size_t i, std::string message) {
  diagnostics_.warning(Code::post_left_out, path_.origin_of(i), std::move(message) + " is skipped");
}

}  // namespace kerf::gcode

namespace kerf {

std::vector<PostedFile> post(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
                             Diagnostics& diagnostics, Progress* progress) {
  return gcode::Poster(path, profile, options, diagnostics).run(progress);
}

}  // namespace kerf

// Motions as lines: axes, feeds, arcs, chords; and the function for each kind of step.
#include "back/gcode/poster.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"
#include "path/bead.h"

#include "kerf/base/units.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxCounts = 1e13;         // of a position; exact in a double with room for differences
constexpr double kMaxRadiusMismatch = 0.5;  // mm; GRBL refuses every arc above it
constexpr std::size_t kStepsBetweenReports = 1 << 16;
constexpr std::size_t kBytesPerStep = 24;  // typical

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
      fraction_(profile.zeros == Zeros::kept ? Fraction::full : Fraction::shortest),
      states_(path),
      filament_(filament_diameter()) {
  const double unit_mm = unit_ == LengthUnit::mm ? 1.0 : kMmPerInch;
  grid_.counts_per_mm = power_of_ten(decimals_) / unit_mm;
  counts_per_feed_ = power_of_ten(profile.decimals_feed) / unit_mm;
}

std::vector<PostedFile> Poster::run(Progress* progress) {
  if (unit_ == LengthUnit::inch && !profile_.has_g(200))
    diagnostics_.error(codes::post_cannot, {}, "the controller has no inches (G20)");
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
  if (i < skip_to_) return position_.pass(s);
  if (s.is_motion()) return write_motion(i);
  switch (s.kind()) {
    case StepKind::dwell: return dwell(i, s.dwell().time);
    case StepKind::tool_change: return tool_change(i);
    case StepKind::spindle: return spindle(i);
    case StepKind::coolant: return coolant(i, wanted_coolant_ = s.coolant());
    case StepKind::path_mode: return path_mode(i, s.path_mode());
    case StepKind::temperature: return temperature(i);
    case StepKind::extruder: return select_extruder(i);
    case StepKind::fan: return fan(i);
    case StepKind::motion_limits: return motion_limits(i);
    case StepKind::laser_power: return laser(i);
    case StepKind::layer: return comment(path_.layer(i).name);
    case StepKind::note:
      if (read_filament_note(path_.text(i))) return;  // the header states it
      return comment(path_.text(i), s.note_kind());
    case StepKind::verbatim: return verbatim(i);
    case StepKind::pause: return pause(i);
    case StepKind::store_home: return store_home(i);
    case StepKind::work_zero: return work_zero(i);
    case StepKind::tool_length: position_.pass(s); return tool_length(i, s.tool_length());
    case StepKind::unresolved: return unresolved(i);
    case StepKind::end:         // written with the end of the file
    case StepKind::close_path:  // for drawings
    case StepKind::rapid:       // motions
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::probe:
    case StepKind::extrude: return;
  }
}

void Poster::write_motion(std::size_t i) {
  const Step& s = path_[i];
  if (!fits(i)) return;
  if (restore_) restore(i);
  if (!moved_ && files_.size() > 0) approach(i);
  if (s.reference() == Reference::measured)
    report_unsupported(
        i,
        "the end of this motion is computed from a value known only at run time, such as a probed position");
  else if (s.reference() != Reference::work)
    to_reference(s.kind() == StepKind::rapid ? 0 : 1, i);
  else if (s.kind() == StepKind::rapid)
    straight(0, i);
  else if (s.kind() == StepKind::cut)
    cut(i);
  else if (s.kind() == StepKind::arc)
    arc(i);
  else if (s.kind() == StepKind::probe)
    probe(i);
  else
    extrude(i);
  moved_ = true;
  on_bead_ = s.kind() == StepKind::extrude && path_.extrude(i).volume > Volume();
  const double from_z = (position_.unknown & 4u) == 0 ? position_.at.z : s.to().z;
  position_.pass(s);
  if ((s.unknown_axes() & 4u) != 0) return;
  path_top_ = std::max(path_top_, s.to().z);
  if (s.is_cutting() && s.to().z <= from_z) cut_top_ = std::max(cut_top_, s.to().z);
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
    diagnostics_.error(codes::post_number_large, path_.origin_of(i),
                       "a position or feed is too large to be written");
    return false;
  }
  if (correction_of(i).empty()) return true;
  if (profile_.comments == CommentStyle::brackets && unit_ == LengthUnit::mm &&
      correction_of(i).size() <= kMaxFormula) {
    if (!uncorrected_reported_)
      diagnostics_
          .warning(codes::heights_uncorrected, path_.origin_of(i),
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

/// The axes whose words the line needs: those that move, and those of the program's line (all, where it is
/// not known) that have not been written since the controller's position was last unknown, or since a pause.
unsigned Poster::axes_to_write(std::size_t i, const Counts& to) const {
  const Step& s = path_[i];
  unsigned axes = profile_.axes == Repeat::always ? kAllAxes : kAllAxes & ~known_axes_;
  if (s.named_axes() != 0) axes = (axes & (known_axes_ | s.named_axes())) | (paused_axes_ & s.named_axes());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (to[axis] != at_[axis]) axes |= 1u << axis;
  if (!correction_of(i).empty()) axes |= 4u;  // Z
  const unsigned target_known = s.kind() == StepKind::probe ? s.reference_axes() : 0u;
  return axes & (~s.unknown_axes() | target_known);
}

/// The axes that move by a distance: their positions before and after are unknown.
unsigned Poster::axes_by_distance(std::size_t i, const Counts& to) const {
  const Step& s = path_[i];
  unsigned axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (to[axis] != at_[axis]) axes |= 1u << axis;
  return axes & s.unknown_axes() & ~s.reference_axes();
}

/// Adds the rotary words that change, at a fraction of the motion; false if there are none.
bool Poster::add_rotary(std::size_t i, double fraction) {
  const MotionExtra* extra = path_.extra(i);
  if (extra == nullptr || !extra->abc) return false;
  bool any = false;
  const double scale = power_of_ten(profile_.decimals_degrees);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double degrees = rotary_from_[axis] + fraction * ((*extra->abc)[axis] - rotary_from_[axis]);
    const auto counts = static_cast<std::int64_t>(std::llround(degrees * scale));
    const char letter = static_cast<char>('A' + axis);
    const unsigned bit = 1u << axis;
    if ((extra->unknown_abc & bit) != 0) {
      if (counts != rotary_[axis])
        report_unsupported(i, fmt::format("{} turns by an angle from an unknown position", letter));
      rotary_[axis] = counts;
      known_rotary_ &= ~bit;
      continue;
    }
    const bool known = (known_rotary_ & bit) != 0 || (counts == 0 && !profile_.has_letter(letter));
    if (counts == rotary_[axis] && known) continue;
    rotary_[axis] = counts;
    known_rotary_ |= bit;
    if (!profile_.has_letter(letter)) {
      report_unsupported(i, fmt::format("the controller has no rotary axis {}", letter));
      continue;
    }
    word(letter, counts, profile_.decimals_degrees);
    any = true;
  }
  if (fraction == 1.0) rotary_from_ = *extra->abc;
  return any;
}

/// Whether only rotary axes move. The feed is in degrees per minute then.
bool Poster::only_turns(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  const Step& s = path_[i];
  return extra != nullptr && extra->abc && s.kind() != StepKind::arc && s.to() == position_.at &&
         s.unknown_axes() == position_.unknown;
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
      diagnostics_.error(codes::post_no_feed, path_.origin_of(i), "a cut without a feed").hint =
          "specify a feed for such cuts with --feed";
    no_feed_reported_ = true;
    return;
  }
  const double scale = only_turns(i) ? power_of_ten(profile_.decimals_feed) : counts_per_feed_;
  const auto counts = std::max<std::int64_t>(1, std::llround(feed.mm_per_min() * scale));
  if (counts == feed_ && profile_.feed == Repeat::when_changed) return;
  feed_ = counts;
  word('F', counts, profile_.decimals_feed);
}

void Poster::put_power() {
  if (!pending_power_) return;
  word('S', std::llround(*pending_power_ * power_of_ten(profile_.decimals_speed)), profile_.decimals_speed);
  pending_power_.reset();
}

void Poster::arrive(std::size_t i, const Counts& to, unsigned written) {
  at_ = to;
  known_axes_ = (known_axes_ | written) & ~path_[i].unknown_axes();
  paused_axes_ &= ~written;
}

void Poster::cut(std::size_t i) {
  if (!locked_motion(i)) straight(1, i);
}

void Poster::straight(int g, std::size_t i) { straight_to(g, i, grid_counts(path_[i].to()), 1.0); }

void Poster::straight_to(int g, std::size_t i, const Counts& to, double fraction) {
  if (axes_by_distance(i, to) != 0) return move_by({10 * g}, i, to);
  unsigned axes = axes_to_write(i, to);
  start_line();
  put_motion(g);
  put_axes(to, axes);
  put_correction(i);
  const bool rotary = add_rotary(i, fraction);
  if (axes == 0 && !rotary) {  // length 0: written all the same; passes remove such motions
    unsigned known = kAllAxes & ~path_[i].unknown_axes();
    if (path_[i].named_axes() != 0) known &= path_[i].named_axes() | known_axes_;
    if (known == 0) {
      line_.clear();
      motion_ = -1;
      return arrive(i, to, 0);
    }
    axes = known & (0u - known);
    put_axes(to, axes);
  }
  arrive(i, to, axes);
  if (g == 1) put_feed(i);
  put_power();  // also of a rapid, before which the beam is set to 0
  end_line(i);
}

/// A motion of which an axis moves by a distance, and so all do: between lines with G91 and G90.
void Poster::move_by(const std::vector<int>& codes, std::size_t i, const Counts& to) {
  const Step& s = path_[i];
  const unsigned found = position_.unknown & ~s.unknown_axes();  // axes that start at an unknown position
  const MotionExtra* extra = path_.extra(i);
  const bool turns = extra != nullptr && extra->abc && *extra->abc != rotary_from_;
  if (found != 0 || turns || !profile_.has_g(910)) {
    report_unsupported(i,
                       "an axis moves by a distance from an unknown position, which cannot be combined "
                       "with the other axes of this motion");
    return arrive(i, to, 0);
  }
  Counts by{};
  unsigned axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    by[axis] = to[axis] - at_[axis];
    if (by[axis] != 0) axes |= 1u << axis;
  }
  start_line();
  code('G', 910);
  if (profile_.syntax == LineSyntax::commands) {
    end_line(i);
    start_line();
  }
  for (const int tenths : codes) code('G', tenths);
  put_axes(by, axes);
  if (s.kind() != StepKind::rapid) put_feed(i);
  put_power();
  end_line(i);
  start_line();
  code('G', 900);
  end_line(i);
  motion_ = -1;
  arrive(i, to, axes);
}

void Poster::arc(std::size_t i) {
  const Step& s = path_[i];
  const step::Arc arc = s.arc();
  const Counts to = grid_counts(arc.to);
  const PlaneAxes axes = axes_of(arc.plane);
  const unsigned in_plane = (1u << axes.u) | (1u << axes.v);
  if (((position_.unknown | s.unknown_axes()) & in_plane) != 0 || axes_by_distance(i, to) != 0) {
    diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                       "the start point of an arc is unknown in work coordinates");
    return arrive(i, to, 0);
  }
  const Point2 zero = in_name_order(arc.plane, {zero_[axes.u], zero_[axes.v]});
  const ArcWalk walk =
      walk_arc(position_.at - zero_, arc.to - zero_, arc.centre - zero, arc.plane, arc.turn, arc.extra_turns);
  unsigned first_axes = axes_to_write(i, to);
  plan_arc(walk, at_, to, grid_, profile_, plan_);
  // From an unknown height, as after a probe, the heights between are unknown, too.
  const unsigned rises = 1u << axes.w & position_.unknown & ~s.unknown_axes();
  if (rises != 0 && plan_.segments.size() > 1 && !plan_as_one(walk, arc, at_, to, grid_, plan_)) {
    diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                       "a helix from an unknown height has to be divided for this controller");
    return arrive(i, to, 0);
  }
  first_axes |= rises;
  const double mismatch = std::abs(walk.start_radius - walk.end_radius);
  if (mismatch > kMaxRadiusMismatch)
    return report_unsupported(i, fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre; "
                                             "controllers refuse it, and its curve is unknown",
                                             walk.start_radius, walk.end_radius));
  if (plan_.uneven)
    diagnostics_.warning(codes::post_arc_uneven, path_.origin_of(i),
                         fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre; "
                                     "written as {} straight cuts",
                                     walk.start_radius, walk.end_radius, plan_.segments.size()));
  if (!correction_of(i).empty() && (plan_.form != ArcForm::arcs || plan_.segments.size() > 1) &&
      (arc.plane != Plane::xy || walk.start_w != walk.end_w))
    return report_unsupported(i, "a helix whose height has a formula has to be divided for this controller");
  if (plan_.form != ArcForm::arcs) return chords(i);
  double done = 0.0;
  for (const ArcSegment& segment : plan_.segments) {
    done += 1.0;
    start_line();
    put_plane(i, arc.plane);
    code('G', arc.turn == Turn::cw ? 20 : 30);
    motion_ = arc.turn == Turn::cw ? 2 : 3;
    const auto w = static_cast<std::size_t>(axes.w);
    const bool is_corrected = !correction_of(i).empty();
    const unsigned third = segment.to[w] != at_[w] || is_corrected ? 1u << w : 0u;
    const unsigned written = in_plane | third | first_axes;
    put_axes(segment.to, written);
    put_correction(i);
    first_axes = 0;
    const std::int64_t centre[3] = {segment.u, segment.v, 0};
    for (const int axis : {0, 1, 2})
      if (axis != axes.w) word(static_cast<char>('I' + axis), centre[axis == axes.u ? 0 : 1], decimals_);
    add_rotary(i, done / static_cast<double>(plan_.segments.size()));
    put_feed(i);
    put_power();
    arrive(i, segment.to, written);
    end_line(i);
  }
}

/// The segments of the plan as straight cuts.
void Poster::chords(std::size_t i) {
  const bool several = plan_.segments.size() > 1;
  double done = 0.0;
  for (const ArcSegment& segment : plan_.segments) {
    done += 1.0;
    const bool no_motion = segment.to == at_ && known_axes_ == kAllAxes;
    if (!(several && no_motion))
      straight_to(1, i, segment.to, done / static_cast<double>(plan_.segments.size()));
  }
}

void Poster::probe(std::size_t i) {
  const step::Probe probe = path_[i].probe();
  int tenths = 382 + static_cast<int>(probe.kind);
  constexpr int kSkip = 310;  // G31 of Mach3
  if (!profile_.has_g(tenths) && probe.kind <= ProbeKind::contact && profile_.has_g(kSkip)) tenths = kSkip;
  if (!profile_.has_g(tenths))
    return report_unsupported(
        i, fmt::format("the controller has no probing motion G{}.{}", tenths / 10, tenths % 10));
  const Counts to = grid_counts(probe.to);
  const unsigned axes = axes_to_write(i, to);
  if (axes_by_distance(i, to) != 0) {
    move_by({tenths}, i, to);
  } else if (axes == 0) {
    return report_unsupported(i, "controllers refuse a probing motion of length 0");
  } else {
    start_line();
    code('G', tenths);
    put_axes(to, axes);
    put_feed(i);
    end_line(i);
    arrive(i, to, axes);
  }
  motion_ = -1;
}

/// A motion to machine coordinates, or to a home stored in the controller.
void Poster::to_reference(int g, std::size_t i) {
  const Step& s = path_[i];
  const Counts to = grid_counts(s.to());
  if (s.reference() == Reference::end_switches) return to_end_switches(i);
  const bool machine = s.reference() == Reference::machine;
  const int tenths = machine ? 530 : s.reference() == Reference::home ? 280 : 300;
  if (!profile_.has_g(tenths) || profile_.syntax == LineSyntax::commands) {
    report_skipped(i, fmt::format("the controller has no G{}; a motion to a machine position", tenths / 10));
    return arrive(i, to, 0);
  }
  unsigned axes = s.reference_axes();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1u) == 0 && to[axis] != at_[axis]) axes |= 1u << axis;
  // Known axes move to a home only where the program has stored it, and so does the controller.
  if (axes != s.reference_axes() && (machine || !profile_.has_g(tenths + 1)))
    return report_unsupported(i,
                              "axes move in machine coordinates and in work coordinates at once; move "
                              "them one after the other");
  const MotionExtra* extra = path_.extra(i);
  unsigned rotary = extra != nullptr ? extra->reference_abc : 0u;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!profile_.has_letter(static_cast<char>('A' + axis))) rotary &= ~(1u << axis);
  if ((axes | rotary) == 0)  // without words it would be all axes
    return report_unsupported(i, "the controller has none of the axes that move to their home here");
  if (machine) {
    start_line();
    code('G', tenths);
    code('G', g * 10);
    put_axes(grid_.counts(s.to()), axes);
    add_rotary(i, 1.0);
    if (g == 1) put_feed(i);
    end_line(i);
  } else {  // with an intermediate point at distance 0
    start_line();
    code('G', 910);
    code('G', tenths);
    put_axes(Counts{}, axes);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((rotary >> axis & 1u) != 0) word(static_cast<char>('A' + axis), 0, profile_.decimals_degrees);
    end_line(i);
    start_line();
    code('G', 900);
    end_line(i);
    known_rotary_ &= ~rotary;
  }
  motion_ = -1;
  arrive(i, to, 0);
}

/// G28 of printers, G28.1 of Mach3; the axis words are flags.
void Poster::to_end_switches(std::size_t i) {
  constexpr int kPrinters = 280;
  const Step& s = path_[i];
  const bool printer = profile_.syntax == LineSyntax::commands && profile_.has_g(kPrinters);
  const int tenths = printer ? kPrinters : profile_.homing;
  if (tenths == 0) {
    report_skipped(i, "the controller has no G code that runs the axes to their end switches; homing");
    return arrive(i, grid_counts(s.to()), 0);
  }
  start_line();
  code('G', tenths);
  if (!printer || s.reference_axes() != kAllAxes) put_axes(Counts{}, s.reference_axes());
  end_line(i);
  motion_ = -1;
  arrive(i, grid_counts(s.to()), 0);
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
    diagnostics_.error(codes::post_line_long, i < path_.size() ? path_.origin_of(i) : Origin{},
                       fmt::format("a line of {} bytes; the maximum of the controller is {}", text.size(),
                                   profile_.longest_line));
  out_ += text;
  out_ += profile_.line_end == LineEnd::crlf ? "\r\n" : "\n";
  ++lines_;
}

void Poster::report_unsupported(std::size_t i, std::string message) {
  diagnostics_.error(codes::post_cannot, path_.origin_of(i), std::move(message));
}

void Poster::report_skipped(std::size_t i, std::string message) {
  diagnostics_.warning(codes::post_left_out, path_.origin_of(i), std::move(message) + " is skipped");
}

}  // namespace kerf::gcode

namespace kerf {

std::vector<PostedFile> post(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
                             Diagnostics& diagnostics, Progress* progress) {
  return gcode::Poster(path, profile, options, diagnostics).run(progress);
}

}  // namespace kerf

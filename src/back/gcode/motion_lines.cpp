// Motions as lines: axes, feeds, arcs, chords.
#include "back/gcode/motion_lines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"

#include "kerf/base/tolerance.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxCounts = 1e13;  // of a position; exact in a double with room for differences
constexpr double kMaxRadiusMismatch = ArcMismatch().limit.mm();  // GRBL refuses every arc above it

}  // namespace

/// Whether the motion can be written: numbers within the limits, no height correction.
bool MotionLines::fits(std::size_t i) {
  const Step& s = path_[i];
  double farthest = std::max({std::abs(s.to().x), std::abs(s.to().y), std::abs(s.to().z), s.feed().raw()});
  if (s.kind() == StepKind::arc) {
    const Point2 centre = s.arc().centre;
    farthest = std::max({farthest, std::abs(centre.x), std::abs(centre.y)});
  }
  if (!(farthest * units_.grid.counts_per_mm < kMaxCounts)) {
    diagnostics_.error(codes::post_number_large, path_.origin_of(i),
                       "a position or feed is too large to be written");
    return false;
  }
  if (axes_.correction_of(i).empty()) return true;
  if (profile_.comments == CommentStyle::brackets && units_.unit == LengthUnit::mm &&
      axes_.correction_of(i).size() <= kMaxFormula) {
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

/// Writes a motion other than a bead.
void MotionLines::write(std::size_t i) {
  const Step& s = path_[i];
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
}

void MotionLines::cut(std::size_t i) {
  if (!threads_.locked_motion(i)) straight(1, i);
}

void MotionLines::straight(int g, std::size_t i) { straight_to(g, i, axes_.counts(path_[i].to()), 1.0); }

void MotionLines::straight_to(int g, std::size_t i, const Counts& to, double fraction) {
  if (axes_.by_distance(i, to) != 0) return move_by({10 * g}, i, to);
  unsigned axes = axes_.to_write(i, to);
  const bool inverse = g == 1 && rotary_.in_inverse_time(i);
  lines_.start_line();
  if (inverse) words_.put_inverse_mode();
  words_.put_motion(g);
  axes_.put(to, axes);
  axes_.put_correction(i);
  const bool rotary = rotary_.add(i, fraction);
  if (axes == 0 && !rotary) {  // length 0: written all the same; passes remove such motions
    unsigned known = kAllAxes & ~path_[i].unknown_axes();
    if (path_[i].named_axes() != 0) known &= path_[i].named_axes() | axes_.known();
    if (known == 0) {
      lines_.drop_line();
      words_.forget_motion();
      return axes_.arrive(i, to, 0);
    }
    axes = known & (0u - known);
    axes_.put(to, axes);
  }
  axes_.arrive(i, to, axes);
  if (inverse)
    words_.put_inverse_time(mm(fraction * distance(position_.at, path_[i].to())) / path_[i].feed());
  else if (g == 1)
    words_.put_feed(i);
  words_.put_power();  // also of a rapid, before which the beam is set to 0
  lines_.end_line(i);
}

/// A motion of which an axis moves by a distance, and so all do: between lines with G91 and G90.
void MotionLines::move_by(const std::vector<int>& codes, std::size_t i, const Counts& to) {
  const Step& s = path_[i];
  const unsigned found = position_.unknown & ~s.unknown_axes();  // axes that start at an unknown position
  if (found != 0 || rotary_.turns(i) || !profile_.has_g(910)) {
    report_unsupported(i,
                       "an axis moves by a distance from an unknown position, which cannot be combined "
                       "with the other axes of this motion");
    return axes_.arrive(i, to, 0);
  }
  Counts by{};
  unsigned axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    by[axis] = to[axis] - axes_.at()[axis];
    if (by[axis] != 0) axes |= 1u << axis;
  }
  lines_.start_line();
  lines_.code('G', 910);
  if (profile_.syntax == LineSyntax::commands) {
    lines_.end_line(i);
    lines_.start_line();
  }
  for (const int tenths : codes) lines_.code('G', tenths);
  axes_.put(by, axes);
  if (s.kind() != StepKind::rapid) words_.put_feed(i);
  words_.put_power();
  lines_.end_line(i);
  lines_.start_line();
  lines_.code('G', 900);
  lines_.end_line(i);
  words_.forget_motion();
  axes_.arrive(i, to, axes);
}

void MotionLines::arc(std::size_t i) {
  const Step& s = path_[i];
  const step::Arc arc = s.arc();
  const Counts to = axes_.counts(arc.to);
  const PlaneAxes axes = axes_of(arc.plane);
  const unsigned in_plane = (1u << axes.u) | (1u << axes.v);
  if (((position_.unknown | s.unknown_axes()) & in_plane) != 0 || axes_.by_distance(i, to) != 0) {
    diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                       "the start point of an arc is unknown in work coordinates");
    return axes_.arrive(i, to, 0);
  }
  const Point2 zero = in_name_order(arc.plane, {axes_.zero()[axes.u], axes_.zero()[axes.v]});
  const ArcWalk walk = walk_arc(position_.at - axes_.zero(), arc.to - axes_.zero(), arc.centre - zero,
                                arc.plane, arc.turn, arc.extra_turns);
  unsigned first_axes = axes_.to_write(i, to);
  plan_arc(walk, axes_.at(), to, units_.grid, profile_, plan_);
  // From an unknown height, as after a probe, the heights between are unknown, too.
  const unsigned rises = 1u << axes.w & position_.unknown & ~s.unknown_axes();
  if (rises != 0 && plan_.segments.size() > 1 &&
      !plan_as_one(walk, arc, axes_.at(), to, units_.grid, plan_)) {
    diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                       "a helix from an unknown height has to be divided for this controller");
    return axes_.arrive(i, to, 0);
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
  if (!axes_.correction_of(i).empty() && (plan_.form != ArcForm::arcs || plan_.segments.size() > 1) &&
      (arc.plane != Plane::xy || walk.start_w != walk.end_w))
    return report_unsupported(i, "a helix whose height has a formula has to be divided for this controller");
  if (plan_.form != ArcForm::arcs) return chords(i);
  double done = 0.0;
  for (const ArcSegment& segment : plan_.segments) {
    done += 1.0;
    lines_.start_line();
    words_.put_plane(i, arc.plane);
    lines_.code('G', arc.turn == Turn::cw ? 20 : 30);
    words_.set_motion(arc.turn == Turn::cw ? 2 : 3);
    const auto w = static_cast<std::size_t>(axes.w);
    const bool is_corrected = !axes_.correction_of(i).empty();
    const unsigned third = segment.to[w] != axes_.at()[w] || is_corrected ? 1u << w : 0u;
    const unsigned written = in_plane | third | first_axes;
    axes_.put(segment.to, written);
    axes_.put_correction(i);
    first_axes = 0;
    const std::int64_t centre[3] = {segment.u, segment.v, 0};
    for (const int axis : {0, 1, 2})
      if (axis != axes.w)
        lines_.word(static_cast<char>('I' + axis), centre[axis == axes.u ? 0 : 1], units_.decimals);
    rotary_.add(i, done / static_cast<double>(plan_.segments.size()));
    words_.put_feed(i);
    words_.put_power();
    axes_.arrive(i, segment.to, written);
    lines_.end_line(i);
  }
}

/// The segments of the plan as straight cuts.
void MotionLines::chords(std::size_t i) {
  const bool several = plan_.segments.size() > 1;
  double done = 0.0;
  for (const ArcSegment& segment : plan_.segments) {
    done += 1.0;
    const bool no_motion = segment.to == axes_.at() && axes_.known() == kAllAxes;
    if (!(several && no_motion))
      straight_to(1, i, segment.to, done / static_cast<double>(plan_.segments.size()));
  }
}

void MotionLines::probe(std::size_t i) {
  const step::Probe probe = path_[i].probe();
  int tenths = 382 + static_cast<int>(probe.kind);
  constexpr int kSkip = 310;  // G31 of Mach3
  if (!profile_.has_g(tenths) && probe.kind <= ProbeKind::contact && profile_.has_g(kSkip)) {
    if (probe.kind == ProbeKind::contact_or_error)
      report_skipped(i, "the controller has G31 only; the error of G38.2 where there is no contact");
    tenths = kSkip;
  }
  if (!profile_.has_g(tenths))
    return report_unsupported(
        i, fmt::format("the controller has no probing motion G{}.{}", tenths / 10, tenths % 10));
  const Counts to = axes_.counts(probe.to);
  const unsigned axes = axes_.to_write(i, to);
  if (axes_.by_distance(i, to) != 0) {
    move_by({tenths}, i, to);
  } else if (axes == 0) {
    return report_unsupported(i, "controllers refuse a probing motion of length 0");
  } else {
    lines_.start_line();
    lines_.code('G', tenths);
    axes_.put(to, axes);
    words_.put_feed(i);
    lines_.end_line(i);
    axes_.arrive(i, to, axes);
  }
  words_.forget_motion();
}

/// A motion to machine coordinates, or to a home stored in the controller.
void MotionLines::to_reference(int g, std::size_t i) {
  const Step& s = path_[i];
  const Counts to = axes_.counts(s.to());
  if (s.reference() == Reference::end_switches) return to_end_switches(i);
  const bool machine = s.reference() == Reference::machine;
  const int tenths = machine ? 530 : s.reference() == Reference::home ? 280 : 300;
  if (!profile_.has_g(tenths) || profile_.syntax == LineSyntax::commands) {
    report_skipped(i, fmt::format("the controller has no G{}; a motion to a machine position", tenths / 10));
    return axes_.arrive(i, to, 0);
  }
  unsigned axes = s.reference_axes();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1u) == 0 && to[axis] != axes_.at()[axis]) axes |= 1u << axis;
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
    lines_.start_line();
    lines_.code('G', tenths);
    lines_.code('G', g * 10);
    axes_.put(units_.grid.counts(s.to()), axes);
    rotary_.add(i, 1.0);
    if (g == 1) words_.put_feed(i);
    lines_.end_line(i);
  } else {
    go_home(tenths, axes, rotary, i);
    rotary_.lose(rotary);
  }
  words_.forget_motion();
  axes_.arrive(i, to, 0);
}

/// With an intermediate point at distance 0.
void MotionLines::go_home(int tenths, unsigned axes, unsigned rotary, std::size_t i) {
  lines_.start_line();
  lines_.code('G', 910);
  lines_.code('G', tenths);
  axes_.put(Counts{}, axes);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((rotary >> axis & 1u) != 0) lines_.word(static_cast<char>('A' + axis), 0, profile_.decimals.degrees);
  lines_.end_line(i);
  lines_.start_line();
  lines_.code('G', 900);
  lines_.end_line(i);
}

/// Z again to the position of the machine to which motion `k` has led; false if the controller cannot.
bool MotionLines::raise_again(std::size_t k, std::size_t i) {
  constexpr unsigned kZ = 4;
  const Step& s = path_[k];
  const bool machine = s.reference() == Reference::machine;
  const int tenths = machine ? 530 : s.reference() == Reference::home ? 280 : 300;
  if (!profile_.has_g(tenths) || profile_.syntax == LineSyntax::commands) return false;
  if (machine) {
    lines_.start_line();
    lines_.code('G', tenths);
    lines_.code('G', 0);
    axes_.put(units_.grid.counts(s.to()), kZ);
    lines_.end_line(i);
  } else {
    go_home(tenths, kZ, 0, i);
  }
  words_.forget_motion();
  return true;
}

/// G28 of printers, G28.1 of Mach3; the axis words are flags.
void MotionLines::to_end_switches(std::size_t i) {
  constexpr int kPrinters = 280;
  const Step& s = path_[i];
  const bool printer = profile_.syntax == LineSyntax::commands && profile_.has_g(kPrinters);
  const int tenths = printer ? kPrinters : profile_.homing;
  if (tenths == 0) {
    report_skipped(i, "the controller has no G code that runs the axes to their end switches; homing");
    return axes_.arrive(i, axes_.counts(s.to()), 0);
  }
  lines_.start_line();
  lines_.code('G', tenths);
  if (!printer || s.reference_axes() != kAllAxes) axes_.put(Counts{}, s.reference_axes());
  lines_.end_line(i);
  words_.forget_motion();
  axes_.arrive(i, axes_.counts(s.to()), 0);
}

}  // namespace kerf::gcode

// The walk along the steps of a toolpath.
#include "back/native/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"

#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"

namespace kerf::native {
namespace {

constexpr unsigned kAllAxes = 7, kPlaneXy = 3, kZ = 4;
constexpr std::size_t kStepsBetweenReports = 1 << 16;
constexpr double kShortestArc = 0.002;  // mm: rounded, its ends may be one point, and it a circle

bool turns_axes(const MotionExtra* extra) {
  if (extra == nullptr || !extra->abc) return false;
  return std::any_of(extra->abc->begin(), extra->abc->end(), [](double angle) { return angle != 0.0; });
}

}  // namespace

Writer::Writer(const Toolpath& path, const NativeOptions& options, NativeToolChange tool_change,
               Diagnostics& diagnostics)
    : path_(path),
      options_(options),
      diagnostics_(diagnostics),
      tool_change_(options.tool_change.value_or(tool_change)) {
  for (const Step& s : path.steps())
    if (s.is_motion() && s.reference() == Reference::work && (s.unknown_axes() & kZ) == 0)
      top_ = std::max(top_.value_or(s.to().z), s.to().z);
}

void Writer::cannot(std::size_t i, const std::string& what) {
  if (once(what)) diagnostics_.error(codes::post_cannot, path_.origin_of(i), what);
}

void Writer::left_out(std::size_t i, const std::string& what) {
  if (once(what)) diagnostics_.warning(codes::post_left_out, path_.origin_of(i), what + " is left out");
}

std::vector<NativeFile> Writer::run(Progress* progress) {
  open_file();
  for (std::size_t i = 0; i < path_.size(); ++i) {
    if (i % kStepsBetweenReports == 0) {
      if (stop_requested(progress)) return {};
      report(progress, static_cast<double>(i) / static_cast<double>(path_.size()));
    }
    step(i);
  }
  finish_file();
  report(progress, 1.0);
  return std::move(files_);
}

void Writer::finish_file() {
  close_file();
  files_.push_back({tool_change_ == NativeToolChange::files ? tool_ : std::nullopt, std::move(text_)});
  text_.clear();
  moved_ = used_ = false;
}

void Writer::step(std::size_t i) {
  const Step& s = path_[i];
  if (s.is_motion()) return motion(i);
  switch (s.kind()) {
    case StepKind::dwell: return dwell(i, s.dwell().time);
    case StepKind::tool_change: return tool_step(i);
    case StepKind::spindle:
      if (s.spindle().surface_speed > Feed{})
        return cannot(i, "the machine cannot hold the speed of the cutting edge (G96)");
      spindle_ = s.spindle();
      return spindle(i, spindle_);
    case StepKind::pause:
      if (s.pause().kind == PauseKind::optional) return left_out(i, "an optional pause");
      return pause(i);
    case StepKind::layer: return comment(path_.layer(i).name);
    case StepKind::note: return comment(path_.text(i));
    case StepKind::work_zero: return zero_step(i);
    default: return other_step(i);
  }
}

/// Steps that the machine has no command for.
void Writer::other_step(std::size_t i) {
  const Step& s = path_[i];
  position_.pass(s);
  switch (s.kind()) {
    case StepKind::coolant:
      if (s.coolant().mist || s.coolant().flood)
        left_out(i, "coolant, whose output differs between machines,");
      return;
    case StepKind::path_mode:
      if (s.path_mode().kind != PathModeKind::exact_path) left_out(i, "the mode of corners (G61.1, G64)");
      return;
    case StepKind::laser_power: return cannot(i, "the post is for spindles; the program is for a laser");
    case StepKind::temperature:
    case StepKind::extruder:
    case StepKind::fan:
    case StepKind::motion_limits: return left_out(i, "a setting of a printer");
    case StepKind::store_home: return left_out(i, "storing a home position");
    case StepKind::tool_length:
      if (s.tool_length().kind == ToolLengthKind::given)
        return cannot(i, "the machine has no command for the length of a tool (G43.1)");
      if (s.tool_length().kind == ToolLengthKind::table)
        left_out(i, "tool length compensation, which the machine's own tool change sets,");
      return;
    case StepKind::verbatim:
      return cannot(i, fmt::format("the line \"{}\" is for another controller", path_.text(i)));
    case StepKind::unresolved:
      if (s.unresolved() == UnresolvedKind::code && options_.skip_left_out) return;
      return cannot(i, fmt::format("{} cannot be written: its effect is unknown, or known at run time only",
                                   path_.text(i)));
    default: return;  // the end, which the end of the file states; a mark of drawings
  }
}

/// The program's first selection of a work offset selects the zero that the operator sets. Later changes are
/// left out where positions stay known: those of the toolpath do not depend on them.
void Writer::zero_step(std::size_t i) {
  const step::WorkZero zero = path_[i].work_zero();
  position_.pass(path_[i]);
  const bool first = zero.kind == ZeroKind::select && !moved_ && files_.empty();
  if (first && zero.system == 1) return;
  if (first) return left_out(i, "the selection of a work offset, and so another zero of the work,");
  if (zero.unknown != 0 || zero.known != 0 || zero.kind == ZeroKind::offset)
    cannot(i,
           "positions depend on another zero (G10, G54 to G59, G92), which the machine has no command for");
}

/// Rapids before the first tool that the program names, as those of a retract, are of that tool.
void Writer::tool_step(std::size_t i) {
  const int tool = path_[i].tool_change().tool;
  const bool same = tool_ == tool;
  const bool new_file = tool_change_ == NativeToolChange::files && !same && used_;
  if (new_file) {
    finish_file();
    open_file();
  }
  tool_ = tool;
  if (!same) change_tool(i, tool, used_);
}

/// Motions to positions of the machine are there to be out of the way: Z goes to the highest one instead.
void Writer::machine_motion(std::size_t i) {
  const bool up = (path_[i].reference_axes() & kZ) != 0 && top_ && moved_;
  if (once("machine"))
    diagnostics_.warning(
        codes::post_left_out, path_.origin_of(i),
        up ? "a motion to a position of the machine (G28, G53) is written as one of Z to the "
             "highest position of the program"
           : "a motion to a position of the machine (G28, G53) is left out");
  if (up) straight(i, Speed::rapid, {0.0, 0.0, *top_}, kZ, Feed{});
}

bool Writer::can_run(std::size_t i) {
  const Step& s = path_[i];
  const MotionExtra* extra = path_.extra(i);
  if (s.kind() == StepKind::probe)
    cannot(i, "the machine's language has no probing motion");
  else if (s.kind() == StepKind::extrude)
    cannot(i, "the program lays beads: it is for a printer");
  else if (s.reference() == Reference::measured)
    cannot(i, "the end of a motion is known at run time only");
  else if (s.reference() != Reference::work)
    machine_motion(i);
  else if (turns_axes(extra))
    cannot(i, "the program turns a rotary axis (A, B, C)");
  else if (extra != nullptr && extra->lock != SpindleLock::none)
    cannot(i, "a motion is locked to the angle of the spindle (threads, tapping)");
  else if (extra != nullptr && !extra->z_correction.empty())
    cannot(i, "heights have to be corrected by measured values; apply them with --measured");
  else
    return true;
  return false;
}

std::optional<Feed> Writer::feed_of(std::size_t i) {
  const Step& s = path_[i];
  if (s.kind() == StepKind::rapid) return Feed{};
  const Feed feed = s.feed() > Feed{} ? s.feed() : options_.missing_feed;
  if (feed > Feed{}) return feed;
  if (once("no feed"))
    diagnostics_.error(codes::post_no_feed, path_.origin_of(i), "a cutting motion has no feed").hint =
        "give one with --feed";
  return std::nullopt;
}

/// At the start of the file of a further tool: from above to where the last one ended.
void Writer::approach(std::size_t i) {
  if (files_.empty() || moved_ || position_.unknown != 0) return;
  if (position_.at.z < *top_)
    return cannot(
        i, "the tool before this one ends below the highest Z of the program; retract it before the change");
  straight(i, Speed::rapid, position_.at, kZ, Feed{});
  straight(i, Speed::rapid, position_.at, kPlaneXy, Feed{});
}

void Writer::motion(std::size_t i) {
  const Step& s = path_[i];
  const std::optional<Feed> feed = can_run(i) ? feed_of(i) : std::nullopt;
  if (feed) {
    if (spindle_.turn != SpindleTurn::off) spindle(i, spindle_);  // after a change of the tool
    approach(i);
    if (s.kind() == StepKind::arc)
      arc_step(i, *feed);
    else
      straight_step(i, *feed);
    moved_ = true;
    used_ = used_ || tool_ || s.kind() != StepKind::rapid;
  }
  position_.pass(s);
}

/// The axes that the motion brings to a known position: an axis that has none stays where it is.
void Writer::straight_step(std::size_t i, Feed feed) {
  const Step& s = path_[i];
  const unsigned axes = kAllAxes & ~s.unknown_axes();
  const Point3 by = s.to() - position_.at;
  const std::array<double, 3> distances{by.x, by.y, by.z};
  for (unsigned axis = 0; axis < 3; ++axis)
    if ((s.unknown_axes() >> axis & 1u) != 0 && distances[axis] != 0.0)
      return void(diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                                     "an axis moves by a distance from an unknown position"));
  const bool stays = position_.unknown == 0 && axes == kAllAxes && by.x == 0.0 && by.y == 0.0 && by.z == 0.0;
  if (axes == 0 || stays) return;
  straight(i, s.kind() == StepKind::rapid ? Speed::rapid : Speed::feed, s.to(), axes, feed);
}

void Writer::arc_step(std::size_t i, Feed feed) {
  const Step& s = path_[i];
  if (position_.unknown != 0 || s.unknown_axes() != 0)
    return void(diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                                   "the start point of an arc is unknown in work coordinates"));
  const ArcWalk walk = walk_of(s, position_.at);
  const double mismatch = std::abs(walk.start_radius - walk.end_radius);
  if (mismatch > ArcMismatch().limit.mm())
    return cannot(i, fmt::format("the arc starts {:.4f} mm and ends {:.4f} mm from its centre",
                                 walk.start_radius, walk.end_radius));
  const bool level = walk.plane == Plane::xy && walk.start_w == walk.end_w;
  const bool even = mismatch < 1e-3 && walk.length() > kShortestArc;
  const bool one_turn = std::abs(walk.sweep) < 2.0 * std::numbers::pi + 1e-9;
  if (level && even && one_turn && arc(i, walk, s.to(), feed)) return;
  chords(i, walk, s.to(), feed);
}

void Writer::chords(std::size_t i, const ArcWalk& walk, Point3 to, Feed feed) {
  const int count = walk.chords(default_tolerance::kPostChord, limits::kMaxChords);
  for (int k = 1; k <= count; ++k)
    straight(i, Speed::feed, k == count ? to : walk.at(static_cast<double>(k) / count), kAllAxes, feed);
}

}  // namespace kerf::native

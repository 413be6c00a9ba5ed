// Motion figures of a toolpath.
#include "kerf/path/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "path/motion_box.h"
#include "path/rotary_way.h"

namespace kerf {
namespace {

ToolFigures& figures_of(PathReport& report, std::optional<int> tool) {
  const auto found = std::find_if(report.tools.begin(), report.tools.end(),
                                  [&](const ToolFigures& entry) { return entry.tool == tool; });
  if (found != report.tools.end()) return *found;
  report.tools.push_back({tool, {}, std::nullopt});
  return report.tools.back();
}

/// The contribution of one motion.
struct Motion {
  StepKind kind;
  double length;  // mm
  Point3 way;     // mm, from start to end
  Box3 box;
  Box3 end;
  Feed feed;
  double degrees = 0.0;  // of rotary axes that turn alone, at a feed in degrees per minute
};

Motion measure(const Step& s, const PathPosition& start) {
  Motion motion{s.kind(),
                distance(start.at, s.to()),
                s.to() - start.at,
                detail::bounds_of(s, start.at, start.unknown),
                {},
                s.feed(),
                0.0};
  motion.end.add(s.to());
  if (s.kind() == StepKind::arc) {
    const ArcWalk walk = walk_of(s, start.at);
    motion.length = walk.length();
    motion.end = walk.bounds();
  }
  return motion;
}

Duration rapid_time(const Motion& motion, const ReportOptions& options) {
  Duration slowest;
  for (int axis = 0; axis < 3; ++axis) {
    const Feed rate = options.axis_rates[static_cast<std::size_t>(axis)];
    if (!(rate.raw() > 0.0))
      return options.rapid_feed.raw() > 0.0 ? mm(motion.length) / options.rapid_feed : Duration{};
    slowest = std::max(slowest, mm(std::abs(motion.way[axis])) / rate);
  }
  return slowest;
}

/// Adds a motion and returns its time.
Duration add(MotionFigures& figures, const Motion& motion, const ReportOptions& options) {
  if (motion.kind == StepKind::probe) {  // to its target, as it may find nothing before
    const Duration time = motion.feed.raw() > 0.0 ? mm(motion.length) / motion.feed : Duration{};
    figures.cutting = figures.cutting + time;
    return time;
  }
  if (motion.kind == StepKind::rapid) {
    ++figures.rapids;
    figures.rapid_mm += motion.length;
    const Duration time = rapid_time(motion, options);
    figures.rapid = figures.rapid + time;
    return time;
  }
  ++(motion.kind == StepKind::arc ? figures.arcs : figures.lines);
  figures.cut_mm += motion.length;
  figures.cut_bounds.add(motion.box);
  figures.cut_ends.add(motion.end);
  if (!(motion.feed.raw() > 0.0)) return {};
  const bool turns = motion.degrees > 0.0;
  (turns ? figures.turn_feed : figures.feed).add(motion.feed.mm_per_min());
  const Duration time =
      turns ? minutes(motion.degrees / motion.feed.mm_per_min()) : mm(motion.length) / motion.feed;
  figures.cutting = figures.cutting + time;
  return time;
}

void add(Range& range, const Range& more) {
  range.low = std::min(range.low, more.low);
  range.high = std::max(range.high, more.high);
}

void add(MotionFigures& all, const MotionFigures& more) {
  all.lines += more.lines;
  all.arcs += more.arcs;
  all.rapids += more.rapids;
  all.cut_mm += more.cut_mm;
  all.rapid_mm += more.rapid_mm;
  if (!more.cut_bounds.empty()) all.cut_bounds.add(more.cut_bounds);
  if (!more.cut_ends.empty()) all.cut_ends.add(more.cut_ends);
  add(all.feed, more.feed);
  add(all.turn_feed, more.turn_feed);
  add(all.speed, more.speed);
  all.cutting = all.cutting + more.cutting;
  all.rapid = all.rapid + more.rapid;
  all.dwell = all.dwell + more.dwell;
}

/// The position of the tool before a step.
PathPosition position_before(const Toolpath& path, std::size_t step) {
  PathPosition start;
  for (std::size_t i = path.motion_before(step).value_or(0); i < step; ++i) start.pass(path[i]);
  return start;
}

/// The report; calls `timed` with each step that takes time.
template <class Timed>
PathReport report(const Toolpath& path, const ReportOptions& options, Timed timed) {
  PathReport report;
  const std::size_t end = std::min(options.end, path.size());
  PathPosition start = position_before(path, std::min(options.first, end));
  detail::RotaryWay rotary;
  if (const auto before = path.motion_before(std::min(options.first, end))) rotary.pass(path, *before, {});
  std::optional<int> tool;
  ToolFigures* current = nullptr;  // the tool's entry, looked up when it is first needed
  for (std::size_t i = options.first; i < end; ++i) {
    const Step& s = path[i];
    if (s.kind() == StepKind::tool_change) {
      tool = s.tool_change().tool;
      current = nullptr;
      continue;
    }
    const bool turns = s.kind() == StepKind::spindle && s.spindle().turn != SpindleTurn::off;
    if (!s.is_motion()) start.pass(s);
    if (!s.is_motion() && !turns && s.kind() != StepKind::dwell) continue;
    if (current == nullptr) current = &figures_of(report, tool);
    MotionFigures& figures = current->figures;
    if (s.kind() == StepKind::dwell) {
      figures.dwell = figures.dwell + s.dwell().time;
      timed(i, s.dwell().time);
    }
    if (turns && !(s.spindle().surface_speed > Feed{})) figures.speed.add(s.spindle().speed.rpm());
    if (!s.is_motion()) continue;
    if (s.reference() == Reference::end_switches) {  // the distance depends on the machine
      start.pass(s);
      continue;
    }
    Motion motion = measure(s, start);
    motion.degrees = rotary.pass(path, i, start.at).value_or(0.0);
    timed(i, add(figures, motion, options));
    if (s.is_cutting())
      current->deepest = std::min(current->deepest.value_or(motion.box.low.z), motion.box.low.z);
    start.pass(s);
  }
  for (const ToolFigures& entry : report.tools) add(report.all, entry.figures);
  return report;
}

}  // namespace

PathReport report_on(const Toolpath& path, const ReportOptions& options) {
  return report(path, options, [](std::size_t, Duration) {});
}

std::vector<float> reported_seconds(const Toolpath& path, const ReportOptions& options) {
  std::vector<float> seconds(path.size(), 0.0f);
  report(path, options,
         [&](std::size_t step, Duration time) { seconds[step] = static_cast<float>(time.seconds()); });
  return seconds;
}

}  // namespace kerf

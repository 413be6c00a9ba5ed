// Resuming a program from a line.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"

#include "kerf/op/rework.h"

namespace kerf {
namespace {

/// The first step whose line is the given one or a later one.
std::optional<std::size_t> step_of_line(const Toolpath& path, std::uint32_t line) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path.origins().line(path[i].origin()) >= line) return i;
  return std::nullopt;
}

/// What the steps before number `first` have set and motions do not carry.
void restore(const Toolpath& path, std::size_t first, const MotionContext& context, OriginId origin,
             Toolpath& out) {
  std::optional<std::size_t> coolant, mode;
  for (std::size_t i = 0; i < first; ++i) {
    if (path[i].kind() == StepKind::work_zero || path[i].kind() == StepKind::tool_length)
      out.add_copy(path, i);
    if (path[i].kind() == StepKind::coolant) coolant = i;
    if (path[i].kind() == StepKind::path_mode) mode = i;
  }
  if (mode) out.add(path[*mode].path_mode(), origin);
  if (context.tool) out.add(step::ToolChange{*context.tool}, origin);
  if (context.spindle_stated && context.spindle.turn != SpindleTurn::off) out.add(context.spindle, origin);
  if (coolant) out.add(path[*coolant].coolant(), origin);
}

bool is_known_rapid(const Step& motion) {
  return motion.kind() == StepKind::rapid && motion.unknown_axes() == 0;
}

/// To where the motion starts: down at feed for a cut, above its end for a rapid.
void approach(const MotionContext& context, const Step& motion, const ResumeOptions& options, OriginId origin,
              Toolpath& out) {
  const bool rapid = is_known_rapid(motion);
  const Point3 start = rapid ? motion.to() : context.from;
  const double high = std::max(options.safe_z, start.z);
  out.set_unknown_axes(out.add(step::Rapid{{0.0, 0.0, high}}, origin), 3);
  out.add(step::Rapid{{start.x, start.y, high}}, origin);
  const Feed feed = options.approach > Feed{} ? options.approach : motion.feed();
  if (!rapid && start.z < high) out.add(step::Cut{start, feed}, origin);
}

}  // namespace

std::optional<Resumed> resume_from(const Toolpath& path, const ResumeOptions& options,
                                   Diagnostics& diagnostics) {
  const auto fail = [&](Code code, const Origin& where, std::string message) {
    diagnostics.error(code, where, std::move(message));
    return std::nullopt;
  };
  if (!std::isfinite(options.safe_z) || options.line == 0)
    return fail(codes::pass_option, {}, "resuming requires a line from 1 on, and a safe Z");
  if (path.has(StepKind::extrude) || path.has(StepKind::laser_power))
    return fail(codes::pass_refused, {}, "only milling programs can be resumed from a line");
  const auto first = step_of_line(path, options.line);
  MotionReader reader(path, first.value_or(path.size()));
  if (!first || !reader.next())
    return fail(codes::resume_line, {}, fmt::format("no motion at or after line {}", options.line));
  const MotionContext& context = reader.context();
  const Step& motion = reader.step();
  const bool at_start = !path.motion_before(context.index).has_value();
  if (!at_start && context.unknown_from != 0 && !is_known_rapid(motion))
    return fail(codes::resume_line, path.origin_of(context.index),
                "the position before this line is unknown; resume from another line");

  for (std::size_t i = 0; i < *first; ++i)
    if (path[i].kind() == StepKind::work_zero && path[i].work_zero().kind != ZeroKind::select &&
        path[i].work_zero().kind != ZeroKind::offset)
      return fail(
          codes::resume_line, path.origin_of(i),
          "a zero is set at the position of the tool here, before the line; resume from a line before it");

  Resumed made;
  made.first = *first;
  const OriginId origin = made.path.copy_origin(path, *first);
  // The tool and the spindle before the line; those set between it and the motion are copied with the rest.
  restore(path, *first, MotionReader(path, *first).context(), origin, made.path);
  for (std::size_t i = *first; i < path.size(); ++i) {
    if (i == context.index && !at_start) approach(context, motion, options, origin, made.path);
    made.path.add_copy(path, i);
  }
  return made;
}

}  // namespace kerf

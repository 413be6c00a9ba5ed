// Programs one after another.
#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "base/codes/op.h"
#include "op/base/upwards.h"
#include "path/state.h"

#include "kerf/base/limits.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

/// What the end of a program switches off.
constexpr StateParts kOffAtEnd =
    bit_of(StatePart::spindle) | bit_of(StatePart::coolant) | bit_of(StatePart::laser);
/// What a program leaves to the next one, which was made for a machine as its operator leaves it.
constexpr StateParts kLeft = bit_of(StatePart::path_mode) | bit_of(StatePart::tool_length) |
                             bit_of(StatePart::rotary) | bit_of(StatePart::limits) | bit_of(StatePart::fan);

PathState state_at_end(const Toolpath& path) {
  StateReader reader(path);
  reader.to(path.size());
  return reader.state();
}

/// The first motion whose end is known.
std::optional<std::size_t> first_known(const Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].is_motion() && path[i].unknown_axes() == 0) return i;
  return std::nullopt;
}

bool refuse(const Toolpath& path, std::size_t i, const char* message, Diagnostics& diagnostics) {
  diagnostics.error(codes::pass_refused, path.origin_of(i), message);
  return false;
}

/// Whether the program may follow another one.
bool can_follow(const Toolpath& path, const Toolpath& program, Diagnostics& diagnostics) {
  for (const Toolpath* part : {&path, &program})
    for (std::size_t i = 0; i < part->size(); ++i)
      if ((*part)[i].kind() == StepKind::work_zero)
        return refuse(*part, i, "a program that sets a work zero cannot be joined with others", diagnostics);
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (!program[i].is_motion()) continue;
    if (program[i].kind() == StepKind::rapid) break;
    return refuse(program, i, "a program that starts with a cut cannot follow another one", diagnostics);
  }
  for (const Toolpath* part : {&path, &program})
    if (!op_detail::counts_upwards(*part, "rapids between programs", diagnostics)) return false;
  if (path.size() + program.size() <= limits::kMaxPathSteps) return true;
  return refuse(program, 0, "the joined program has too many steps", diagnostics);
}

/// Rises at `here` to `high` or the height of the higher end, and moves across at that height.
void move_across(Point3 here, const Toolpath& program, std::size_t first, double high, Toolpath& out) {
  const Point3 to = program[first].to();
  high = std::max({high, here.z, to.z});
  const OriginId origin = out.copy_origin(program, first);
  if (high > here.z) out.add(step::Rapid{{here.x, here.y, high}}, origin);
  if (high > to.z && here.xy() != to.xy()) out.add(step::Rapid{{to.x, to.y, high}}, origin);
}

void copy_steps(const Toolpath& from, const std::optional<Point3>& here, Toolpath& out) {
  const auto first = here ? first_known(from) : std::nullopt;
  double high = here ? here->z : 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i].kind() == StepKind::end) continue;
    // From a known position, rises at an unknown one are part of the way across.
    const bool rise = first && i < *first && from[i].kind() == StepKind::rapid;
    if (rise && from[i].unknown_axes() == 3) {
      high = std::max(high, from[i].to().z);
      continue;
    }
    if (first && i == *first) move_across(*here, from, i, high, out);
    out.add_copy(from, i);
  }
}

}  // namespace

bool append_program(Toolpath& path, const Toolpath& program, Diagnostics& diagnostics) {
  const bool follows = path.motion_before(path.size()).has_value();
  if (follows && !can_follow(path, program, diagnostics)) return false;
  Toolpath out;
  copy_steps(path, std::nullopt, out);
  PathState now = state_at_end(out);  // without the end, which would switch all off
  if (program.size() > 0) {
    restore(now, {}, kOffAtEnd, out.copy_origin(program, 0), out);
    const StateParts left = difference(now, {}) & kLeft & ~set_before_cut(program, 0, program.size());
    if (follows && left != 0)
      diagnostics.warning(
          codes::pass_refused, program.origin_of(0),
          fmt::format("the program before has set {}, which stays in force here", to_text(left)));
  }
  const bool known = now.position.is_known();
  copy_steps(program, known ? std::optional(now.position.at) : std::nullopt, out);
  path = std::move(out);
  return true;
}

std::optional<Toolpath> joined(const std::vector<const Toolpath*>& programs, Diagnostics& diagnostics) {
  Toolpath path;
  for (const Toolpath* program : programs)
    if (!append_program(path, *program, diagnostics)) return std::nullopt;
  path.add(step::End{}, OriginId::none);
  return path;
}

}  // namespace kerf

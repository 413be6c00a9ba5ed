// Resuming a program from a line.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <variant>

#include "base/codes/op.h"
#include "op/base/upwards.h"
#include "path/state.h"

#include "kerf/op/rework.h"

namespace kerf {
namespace {

/// The file and line of a location in a text, as a part of `origin`; nothing for others.
std::optional<std::pair<std::string_view, std::uint32_t>> text_line(const Origin& origin) {
  if (const auto* text = std::get_if<TextLocation>(&origin))
    return std::pair(std::string_view(text->file), text->line);
  if (const auto* call = std::get_if<CallLocation>(&origin))
    return std::pair(std::string_view(call->file), call->line);
  return std::nullopt;
}

/// Where a program continues.
struct Entry {
  std::size_t step = 0;
  std::uint32_t line = 0;
  Origin caller;       // of the subroutine with the line
  bool again = false;  // the line runs later, too
};

/// Finds the step at which the program first gets to a line. A step is on its own line, and on those of the
/// calls that led to it: subroutines are before or behind the lines that call them.
class LineFinder {
 public:
  explicit LineFinder(const Toolpath& path) : path_(path) {
    for (std::size_t i = 0; i < path.size() && main_.empty(); ++i) {
      const std::vector<Origin> callers = path.origins().callers(path[i].origin());
      const Origin outermost = callers.empty() ? path.origin_of(i) : callers.back();
      if (const auto line = text_line(outermost)) main_ = line->first;
    }
  }

  /// Of the lines from `wanted` on that the program gets to, the first one in the text.
  std::optional<Entry> find(std::uint32_t wanted) {
    std::optional<Entry> entry;
    bool before = false;  // the last step is on the line of the entry
    for (std::size_t i = 0; i < path_.size(); ++i) {
      read_lines(i);
      const auto on = [&](std::uint32_t line) {
        return std::find(lines_.begin(), lines_.end(), line) != lines_.end();
      };
      for (const std::uint32_t line : lines_) {
        if (line < wanted || (entry && line >= entry->line)) continue;
        entry =
            Entry{i, line, line == lines_.front() && !callers_.empty() ? callers_.front() : Origin{}, false};
        before = true;
      }
      const bool now = entry && on(entry->line);
      if (now && !before) entry->again = true;
      before = now;
    }
    return entry;
  }

 private:
  /// The lines of a step in the main file, its own first; 0 for one in another file.
  void read_lines(std::size_t i) {
    lines_.clear();
    const OriginId origin = path_[i].origin();
    callers_ = path_.origins().callers(origin);
    const auto add = [&](const Origin& where) {
      const auto line = text_line(where);
      lines_.push_back(line && line->first == main_ ? line->second : 0);
    };
    add(path_.origins().resolve(origin));
    for (const Origin& caller : callers_) add(caller);
  }

  const Toolpath& path_;
  std::string main_;  // the name of the program's file
  std::vector<std::uint32_t> lines_;
  std::vector<Origin> callers_;
};

bool is_known_rapid(const Step& motion) {
  return motion.kind() == StepKind::rapid && motion.unknown_axes() == 0;
}

/// To where the motion starts, which finds the state `wanted`: rotary axes turn above, then down at feed for
/// a cut, above its end for a rapid.
void approach(const PathState& wanted, const Step& motion, const ResumeOptions& options, OriginId origin,
              PathState& now, Toolpath& out) {
  const bool rapid = is_known_rapid(motion);
  const Point3 start = rapid ? motion.to() : wanted.position.at;
  const double high = std::max(options.safe_z, start.z);
  out.set_unknown_axes(out.add(step::Rapid{{0.0, 0.0, high}}, origin), 3);
  now.pass(out, out.size() - 1);
  restore(now, wanted, bit_of(StatePart::rotary), origin, out);
  out.add(step::Rapid{{start.x, start.y, high}}, origin);
  const Feed feed = options.approach > Feed{} ? options.approach : motion.feed();
  if (!rapid && start.z < high) out.add(step::Cut{start, feed}, origin);
}

/// The first step before number `end` that sets a zero at the position of the tool.
std::optional<std::size_t> zero_at_tool(const Toolpath& path, std::size_t end) {
  for (std::size_t i = 0; i < end; ++i)
    if (path[i].kind() == StepKind::work_zero && path[i].work_zero().kind != ZeroKind::select &&
        path[i].work_zero().kind != ZeroKind::offset)
      return i;
  return std::nullopt;
}

/// What the user did not ask for by the number of the line alone.
void note_entry(const Toolpath& path, const Entry& entry, Diagnostics& diagnostics) {
  if (entry.caller.index() != 0)
    diagnostics.note(codes::resume_line, path.origin_of(entry.step),
                     fmt::format("line {} is in a subroutine; resumed in its call at {}", entry.line,
                                 to_string(entry.caller)));
  if (entry.again)
    diagnostics.note(codes::resume_line, path.origin_of(entry.step),
                     fmt::format("line {} runs several times; resumed at its first pass", entry.line));
}

class Resumption {
 public:
  Resumption(const Toolpath& path, const ResumeOptions& options, Diagnostics& diagnostics)
      : path_(path), options_(options), diagnostics_(diagnostics), source_(path) {}

  std::optional<Resumed> run() {
    const auto entry = LineFinder(path_).find(options_.line);
    const std::size_t first = entry ? entry->step : path_.size();
    std::size_t motion = first;
    while (motion < path_.size() && !path_[motion].is_motion()) ++motion;
    if (motion == path_.size())
      return fail(codes::resume_line, {}, fmt::format("no motion at or after line {}", options_.line));
    if (const auto zero = zero_at_tool(path_, first))
      return fail(
          codes::resume_line, path_.origin_of(*zero),
          "a zero is set at the position of the tool here, before the line; resume from a line before it");
    source_.to(first);
    PathState now;
    const OriginId origin = made_.path.copy_origin(path_, first);
    // Rotary axes turn after the tool has risen; what is set before the first cut needs no other value
    // before.
    const StateParts parts =
        kAllState & ~bit_of(StatePart::rotary) & ~set_before_cut(path_, first, path_.size());
    restore(now, source_.state(), parts, origin, made_.path);
    source_.to(motion);
    const bool at_start = !path_.motion_before(motion).has_value();
    if (!at_start && !source_.state().position.is_known() && !is_known_rapid(path_[motion]))
      return fail(codes::resume_line, path_.origin_of(motion),
                  "the position before this line is unknown; resume from another line");
    note_entry(path_, *entry, diagnostics_);
    made_.first = first;
    for (std::size_t i = first; i < path_.size(); ++i) {
      if (i == motion && !at_start)
        approach(source_.state(), path_[motion], options_, origin, now, made_.path);
      made_.path.add_copy(path_, i);
      if (i < motion) now.pass(made_.path, made_.path.size() - 1);
    }
    return std::move(made_);
  }

 private:
  std::nullopt_t fail(Code code, const Origin& where, std::string message) {
    diagnostics_.error(code, where, std::move(message));
    return std::nullopt;
  }

  const Toolpath& path_;
  const ResumeOptions& options_;
  Diagnostics& diagnostics_;
  StateReader source_;
  Resumed made_;
};

}  // namespace

std::optional<Resumed> resume_from(const Toolpath& path, const ResumeOptions& options,
                                   Diagnostics& diagnostics) {
  if (!std::isfinite(options.safe_z) || options.line == 0) {
    diagnostics.error(codes::pass_option, {}, "resuming requires a line from 1 on, and a safe Z");
    return std::nullopt;
  }
  if (path.has(StepKind::extrude) || path.has(StepKind::laser_power)) {
    diagnostics.error(codes::pass_refused, {}, "only milling programs can be resumed from a line");
    return std::nullopt;
  }
  if (!op_detail::counts_upwards(path, "a safe height", diagnostics)) return std::nullopt;
  return Resumption(path, options, diagnostics).run();
}

}  // namespace kerf

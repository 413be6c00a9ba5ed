// The files of a post, and the tool changes at which they end.
#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "back/gcode/poster.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {

void Poster::open_file(std::size_t first_step) {
  lines_.start_file();
  spindle_.start_file();
  prints_.start_file();
  texts_.start_file(first_step, tool_policy_);
  words_.forget();
  moved_ = false;
  texts_.header();
  if (!profile_.header.empty()) words_.set_plane(Plane::xy);
  zeros_.start_file(first_step);
  if (tool_policy_ != ToolChangePolicy::files || !texts_.file_tool()) return;
  texts_.set_tool(texts_.file_tool());
  texts_.templates(profile_.section);
}

void Poster::close_file() {
  if (path_.size() > 0) words_.end_inverse_time(path_.size() - 1);
  spindle_.end_file();
  texts_.templates(profile_.footer);
  PostedFile file;
  if (tool_policy_ == ToolChangePolicy::files) file.tool = texts_.file_tool();
  file.text = lines_.take_text();
  file.lines = lines_.lines();
  files_.push_back(std::move(file));
}

/// The height to which the file's own rapids lift before its first cut, in the coordinates in force at step
/// `i`.
std::optional<double> Poster::height_of_rapids(std::size_t i) const {
  std::optional<double> height;
  PathPosition at = position_;
  for (std::size_t k = i; k < texts_.end_of_file(); ++k) {
    const Step& s = path_[k];
    if (s.kind() == StepKind::work_zero || (s.kind() == StepKind::tool_length && k != own_length_)) break;
    if (s.is_motion() && (s.kind() != StepKind::rapid || s.reference() != Reference::work)) break;
    at.pass(s);
    if (s.is_motion() && (at.unknown & 4u) == 0) height = std::max(height.value_or(at.at.z), at.at.z);
  }
  return height;
}

/// The motion that has led Z to a position of the machine, where it still is.
std::optional<std::size_t> Poster::raised_by(std::size_t i) const {
  for (auto k = path_.motion_before(i); k; k = path_.motion_before(*k)) {
    const Step& s = path_[*k];
    if ((s.unknown_axes() & 4u) == 0 || s.to().z != position_.at.z) return std::nullopt;
    if ((s.reference_axes() & 4u) == 0 || s.reference() == Reference::work) continue;
    return s.reference() == Reference::end_switches ? std::nullopt : k;
  }
  return std::nullopt;
}

/// Whether a motion leads Z to a position of the machine.
bool Poster::rises_by_itself(std::size_t i) const {
  return (path_[i].reference_axes() & 4u) != 0 && path_[i].reference() != Reference::work;
}

/// A further file starts where the tool of the file before it stopped, but above the work: there, or at the
/// height to which the file's own rapids lift before its first cut.
void Poster::approach(std::size_t i) {
  moved_ = true;
  if (rises_by_itself(i)) return;
  const std::optional<double> own = height_of_rapids(i);
  if ((position_.unknown & 4u) != 0) return approach_from_unknown(i, own);
  const double height = std::max(position_.at.z, own.value_or(position_.at.z));
  if (!(height > cut_top_) && height < path_top_)
    return report_unsupported(i,
                              "the file of this tool starts in the work, where the tool before it stopped; "
                              "retract (G0 Z...) before or after the tool change");
  axes_.approach(put_rapid({position_.at.x, position_.at.y, height}, 4u, i), 4u);
  across(i);
}

Counts Poster::put_rapid(Point3 at, unsigned axes, std::size_t i) {
  const Counts to = axes_.counts(at);
  lines_.start_line();
  words_.put_motion(0);
  axes_.put(to, axes);
  lines_.end_line(i);
  return to;
}

/// To where the file before it stopped, if that is known; else all axes that the program names are written.
void Poster::across(std::size_t i) {
  if (((position_.unknown | path_[i].reference_axes()) & 3u) == 0)
    axes_.approach(put_rapid(position_.at, 3u, i), 3u);
}

/// The height is unknown in the coordinates of the file: the work offset has changed, or Z is at a position
/// of the machine.
void Poster::approach_from_unknown(std::size_t i, std::optional<double> own) {
  if (const auto k = raised_by(i); k && motions_.raise_again(*k, i)) return across(i);
  if (own) {
    put_rapid({0.0, 0.0, *own}, 4u, i);
    return across(i);
  }
  PathPosition at = position_;
  at.pass(path_[i]);
  if (at.at.xy() != position_.at.xy() || ((at.unknown ^ position_.unknown) & 3u) != 0)
    report_unsupported(i,
                       "the file of this tool starts at an unknown height; retract (G0 Z...) after the tool "
                       "change");
}

void Poster::tool_change(std::size_t i) {
  const bool only_number = path_[i].tool_change().kind == ToolChangeKind::number_only;
  if (tool_policy_ == ToolChangePolicy::files && !only_number) return change_file(i);
  const int number = path_[i].tool_change().tool;
  if (only_number) return set_tool_number(i);
  const bool first = !texts_.tool().has_value();
  const bool same = texts_.tool() == number;
  texts_.set_tool(number);
  if (tool_policy_ == ToolChangePolicy::ignore) return;
  if (same && tool_policy_ != ToolChangePolicy::command) return;
  if (spindle_.turn() != SpindleTurn::off) spindle_.stop();
  spindle_.note_change();
  if (tool_policy_ == ToolChangePolicy::command) {
    if (number > profile_.highest_tool)
      report_unsupported(i, fmt::format("the maximum tool number of the controller is {}; this one is {}",
                                        profile_.highest_tool, number));
    texts_.templates(profile_.change_lines);
    if (options_.tool_lengths == ToolLengths::by_post) texts_.templates(profile_.length_lines);
  } else if (!first || worked_) {
    texts_.templates(profile_.pause_lines);
  }
  texts_.templates(profile_.section);
}

/// The tool is in the spindle already: only a controller with a tool changer needs it (M61).
void Poster::set_tool_number(std::size_t i) {
  constexpr int kSetTool = 610;
  texts_.set_tool(path_[i].tool_change().tool);
  if (tool_policy_ != ToolChangePolicy::command) return;
  if (!profile_.has_m(kSetTool))
    return report_skipped(
        i, fmt::format("the controller has no M61; setting the tool number {}", *texts_.tool()));
  lines_.start_line();
  lines_.code('M', kSetTool);
  lines_.word('Q', *texts_.tool(), 0);
  lines_.end_line(i);
}

/// A file ends at the change to another tool. Changes before its first motion only select its tool, which
/// open_file() has found already.
void Poster::change_file(std::size_t i) {
  if (!moved_ || i < texts_.end_of_file() || texts_.file_tool() == path_[i].tool_change().tool) return;
  const auto last_motion = path_.motion_before(path_.size());
  if (!last_motion || *last_motion < i) return;  // T0 M6 at the end puts the last tool away
  if (files_.size() + 1 == limits::kMaxPostedFiles)
    report_unsupported(i, fmt::format("there are more than {} tool changes, each of which starts a file",
                                      limits::kMaxPostedFiles));
  if (files_.size() + 1 >= limits::kMaxPostedFiles) return;
  close_file();
  open_file(i);
  restore_modes(i);
  spindle_.note_change();
}

/// What the files before have set and this one does not set itself: each file is a program of its own.
void Poster::restore_modes(std::size_t i) {
  states_.to(i);
  const PathState& state = states_.state();
  const StateParts own = set_before_cut(path_, i, texts_.end_of_file());
  const auto has = [&](StatePart part) { return (own & bit_of(part)) == 0; };
  if (state.path_mode && has(StatePart::path_mode)) path_mode(i, *state.path_mode);
  own_length_ = length_before_cut(i);
  if (own_length_)
    zeros_.tool_length(i, path_[*own_length_].tool_length());
  else if (state.length)
    zeros_.tool_length(i, *state.length);
}

/// The step with which the file states the length of its tool, before which it only moves above the work: the
/// length of the tool before it would make these rapids too low.
std::optional<std::size_t> Poster::length_before_cut(std::size_t i) const {
  for (; i < texts_.end_of_file(); ++i) {
    if (path_[i].kind() == StepKind::tool_length) return i;
    if (path_[i].is_motion() && path_[i].kind() != StepKind::rapid) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace kerf::gcode

// Which part writes each step.
#include "back/gcode/poster.h"

#include <algorithm>
#include <utility>

#include "base/codes/gcode.h"
#include "path/bead.h"
#include "path/planner_texts.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kStepsBetweenReports = 1 << 16;
constexpr std::size_t kBytesPerStep = 24;  // typical

/// Whether inverse time stays in force: such cuts follow one another, with comments between them.
bool keeps_feed_mode(const Step& s) {
  const bool is_straight = s.kind() == StepKind::rapid || s.kind() == StepKind::cut;
  return is_straight ? s.reference() == Reference::work
                     : s.kind() == StepKind::note || s.kind() == StepKind::layer;
}

}  // namespace

Poster::Poster(PostContext& context)
    : PostPart(context),
      tool_policy_(options_.tool_change.value_or(profile_.tool_change)),
      axes_(context),
      rotary_(context),
      words_(context, axes_, rotary_),
      spindle_(context, words_),
      zeros_(context, axes_, words_),
      threads_(context, axes_, words_, spindle_),
      motions_(context, axes_, rotary_, words_, threads_),
      filament_(context),
      texts_(context, words_, filament_),
      prints_(context, axes_, words_, filament_, texts_),
      header_(profile_),
      limits_(context),
      states_(path_) {}

std::vector<PostedFile> Poster::run(Progress* progress) {
  if (units_.unit == LengthUnit::inch && !profile_.has_g(200))
    diagnostics_.error(codes::post_cannot, {}, "the controller has no inches (G20)");
  open_file(0);
  lines_.reserve(kBytesPerStep * path_.size());
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
  extruded_ = extruded_ || lays_bead(path_, i);
  if (threads_.skips(i) || is_in_header(i)) return position_.pass(s);
  if (!keeps_feed_mode(s)) words_.end_inverse_time(i);
  if (s.is_motion()) return write_motion(i);
  switch (s.kind()) {
    case StepKind::dwell: return spindle_.dwell(i, s.dwell().time);
    case StepKind::tool_change: return tool_change(i);
    case StepKind::spindle: return spindle_.spindle(i);
    case StepKind::coolant: return spindle_.coolant(i);
    case StepKind::path_mode: return path_mode(i, s.path_mode());
    case StepKind::temperature: return prints_.temperature(i);
    case StepKind::extruder: return prints_.select_extruder(i);
    case StepKind::fan: return prints_.fan(i);
    case StepKind::motion_limits: return limits_.motion_limits(i);
    case StepKind::laser_power: return spindle_.laser(i);
    case StepKind::layer: return texts_.comment(path_.layer(i).name);
    case StepKind::note:
      if (read_filament_note(path_.text(i)) || path_.text(i) == kKlipperNote) return;  // the header states it
      return texts_.comment(path_.text(i), s.note_kind());
    case StepKind::verbatim: return verbatim(i);
    case StepKind::pause: return pause(i);
    case StepKind::store_home: return zeros_.store_home(i);
    case StepKind::work_zero: return zeros_.work_zero(i);
    case StepKind::tool_length:
      position_.pass(s);
      return own_length_ == i ? void() : zeros_.tool_length(i, s.tool_length());  // written at the start
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
  if (!motions_.fits(i)) return;
  spindle_.restore(i);
  const bool starts_file = !moved_ && files_.size() > 0;
  if (starts_file) approach(i);
  if (threads_.tap_from_above(i)) return position_.pass(s);
  const bool is_bead = s.reference() == Reference::work && s.kind() == StepKind::extrude;
  if (is_bead)
    prints_.extrude(i);
  else
    motions_.write(i);
  if (starts_file && rises_by_itself(i)) across(i);
  moved_ = true;
  worked_ = worked_ || s.kind() != StepKind::rapid;
  prints_.note_motion(s.kind() == StepKind::extrude && path_.extrude(i).volume > Volume());
  const double from_z = (position_.unknown & 4u) == 0 ? position_.at.z : s.to().z;
  position_.pass(s);
  if ((s.unknown_axes() & 4u) != 0) return;
  path_top_ = std::max(path_top_, s.to().z);
  if (s.is_cutting() && s.to().z <= from_z) cut_top_ = std::max(cut_top_, s.to().z);
}

}  // namespace kerf::gcode

namespace kerf {

std::vector<PostedFile> post(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
                             Diagnostics& diagnostics, Progress* progress) {
  gcode::PostContext context(path, profile, options, diagnostics);
  return gcode::Poster(context).run(progress);
}

}  // namespace kerf

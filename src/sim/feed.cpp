// Which motions of a toolpath become sweeps, and of what.
#include "sim/feed.h"

namespace kerf::sim {

bool Feeder::is_wanted(std::size_t step) {
  const std::vector<StepRange>& steps = scope_.steps;
  while (next_range_ < steps.size() && steps[next_range_].last < step) ++next_range_;
  return next_range_ < steps.size() && steps[next_range_].first <= step;
}

/// Adds the motion that was read.
void Feeder::add(Batch& batch) {
  const Step& step = motion_.step();
  const MotionContext& context = motion_.context();
  if (!is_wanted(context.index)) return planner_.interrupt();
  if (step.kind() == StepKind::probe || step.kind() == StepKind::extrude) return planner_.interrupt();
  const std::optional<int> number = context.tool ? context.tool : survey_.only_tool;
  const auto tool = number ? survey_.index.find(*number) : survey_.index.end();
  if (tool == survey_.index.end()) return planner_.interrupt();  // a rapid before the first tool
  const bool spindle_off =
      scope_.is_no_go ||
      (survey_.judges_spindle && (!context.spindle_stated || context.spindle.turn == SpindleTurn::off));
  planner_.add(step, context, tool->second, spindle_off, batch);
}

void Feeder::fill(Batch& batch) {
  batch.clear();
  planner_.go_on(batch);
  while (!batch.full() && motion_.next()) add(batch);
  batch.steps_done = motion_.context().index;
  batch.sort(tiles_);
}

}  // namespace kerf::sim

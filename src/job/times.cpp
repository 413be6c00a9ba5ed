// The machining time of a job.
#include "kerf/job/job.h"

namespace kerf {
namespace {

TimeFigures plain_times(const MotionFigures& f) {
  TimeFigures out;
  out.motion = f.cutting + f.rapid;
  out.rapid = f.rapid;
  out.dwell = f.dwell;
  return out;
}

}  // namespace

const TimeFigures& JobTimes::of_tool(std::optional<int> tool) const {
  for (const ToolTime& t : estimate.tools)
    if (t.tool == tool) return t.time;
  static const TimeFigures none;
  return none;
}

JobTimes times_of(const Job& job, const Machine* machine) {
  if (machine != nullptr) return {estimate_time(job.program.path, *machine), machine->name};
  JobTimes out;
  out.estimate.all = plain_times(job.report.all);
  for (const ToolFigures& t : job.report.tools)
    out.estimate.tools.push_back({t.tool, plain_times(t.figures)});
  return out;
}

bool deeper_than_flute(const Job& job, const ToolFigures& figures) {
  const Tool* tool = figures.tool ? job.tools.find(*figures.tool) : nullptr;
  if (tool == nullptr || !figures.deepest || !job.stock) return false;
  return job.stock->block.high.z - *figures.deepest > tool->flute.mm();
}

}  // namespace kerf

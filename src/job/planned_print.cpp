// The time and the flow of a print.
#include "job/planned_print.h"

#include "kerf/path/check.h"
#include "kerf/path/estimate.h"

namespace kerf {
namespace {

std::string_view name_of(CornerRule rule) {
  switch (rule) {
    case CornerRule::square_corner: return "as Klipper plans";
    case CornerRule::junction_deviation: return "as Marlin plans, by junction deviation";
    case CornerRule::jerk: break;
  }
  return "as Marlin plans, by jerk";
}

}  // namespace

PlannedPrint planned_print(const Toolpath& path, const PrinterChoice* printer, Length filament) {
  PlannedPrint plan;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if ((context.unknown_from | s.unknown_axes()) != 0) return;
    const VolumeFlow flow = flow_of(path, context.index, context.from);
    if (flow > plan.highest) plan.highest = flow, plan.step = context.index;
  });
  PrintPlanner planner = default_planner(path, filament);
  if (printer != nullptr) {
    plan.limit = limits_of(*printer).max_flow;
    if (printer->printer.has_planner) {
      planner = printer->printer.planner, planner.filament = filament;
      plan.printer = printer->printer.name;
    }
  }
  const PrintTime time = estimate_print_time(path, planner);
  plan.motion = time.motion, plan.dwell = time.dwell, plan.method = name_of(planner.corners);
  return plan;
}

}  // namespace kerf

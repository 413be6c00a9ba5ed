// Which steps of a program can go elsewhere with the part.
#include "op/rework/moved_steps.h"

namespace kerf::op_detail {

std::string_view fault_of_move(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  switch (s.kind()) {
    case StepKind::probe: return "probes stay where they are";
    case StepKind::extrude: return "only milling programs can be transformed";
    case StepKind::store_home: return "it stores a position of the machine";
    case StepKind::work_zero:
      if (s.work_zero().kind == ZeroKind::select || s.work_zero().kind == ZeroKind::offset) return {};
      return "it sets a zero at the position of the tool";
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::dwell:
    case StepKind::tool_change:
    case StepKind::spindle:
    case StepKind::coolant:
    case StepKind::path_mode:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::layer:
    case StepKind::note:
    case StepKind::verbatim:
    case StepKind::pause:
    case StepKind::end:
    case StepKind::close_path:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::motion_limits:
    case StepKind::extruder: break;
  }
  if (!s.is_motion()) return {};
  if (path.extra(i) != nullptr) return "it has a rotary axis or a probed height";
  return {};
}

}  // namespace kerf::op_detail

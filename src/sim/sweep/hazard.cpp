// The names of hazards.
#include "kerf/sim/simulation_options.h"

namespace kerf {

std::string_view to_string(HazardKind kind) {
  switch (kind) {
    case HazardKind::rapid_in_stock: return "rapid_in_stock";
    case HazardKind::neck_contact: return "neck_contact";
    case HazardKind::shank_contact: return "shank_contact";
    case HazardKind::holder_contact: return "holder_contact";
    case HazardKind::over_flute: return "over_flute";
    case HazardKind::below_floor: return "below_floor";
    case HazardKind::spindle_off: break;
  }
  return "spindle_off";
}

}  // namespace kerf

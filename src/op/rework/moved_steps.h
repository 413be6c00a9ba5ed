// Which steps of a program can go elsewhere with the part.
#pragma once

#include <cstddef>
#include <string_view>

#include "kerf/path/toolpath.h"

namespace kerf::op_detail {

/// The axes that are at a position of the machine (G28, G53), which does not go with the part. A retraction
/// of Z, a tool change at the home and the way home at the end are right wherever the part is; what starts
/// from there by a distance is not.
class MachineAxes {
 public:
  /// `follows`: bits of the axes along which the part goes elsewhere.
  explicit MachineAxes(unsigned follows) : follows_(follows) {}

  /// Passes a step that starts at `from`. Why it cannot go with the part; empty if it can.
  std::string_view pass(const Step& s, Point3 from) {
    if (!s.is_motion()) return {};
    unsigned moves = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (s.to()[axis] != from[axis]) moves |= 1u << axis;
    if (s.reference() != Reference::work) {
      axes_ = (axes_ | s.reference_axes()) & s.unknown_axes();
      may_cut_ = s.reference() == Reference::end_switches;
      if ((moves & ~s.reference_axes()) != 0) return "it leads to a position of the machine";
      return s.is_cutting() && (s.reference_axes() & follows_) != 0 ? kCuts : std::string_view();
    }
    axes_ &= s.unknown_axes();
    if (s.is_cutting() && !may_cut_ && (axes_ & follows_) != 0) return kCuts;
    if ((axes_ & follows_ & moves) == 0) return {};
    return "it moves by a distance from a position of the machine";
  }

 private:
  static constexpr std::string_view kCuts = "it cuts at a position of the machine";

  unsigned follows_;
  unsigned axes_ = 0;
  bool may_cut_ = false;  // printers extrude and move at feeds where they are homed
};

/// Why a step cannot be moved; empty if it can.
std::string_view fault_of_move(const Toolpath& path, std::size_t i);

}  // namespace kerf::op_detail

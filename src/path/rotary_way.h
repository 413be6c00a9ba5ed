// How far the rotary axes turn in motions in which nothing else moves. Their feed is in degrees per minute.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "kerf/path/toolpath.h"

namespace kerf::detail {

/// Follows A, B and C along a toolpath; starts with unknown angles.
class RotaryWay {
 public:
  /// Must be called for each motion, with the position before it. Degrees of a motion of rotary axes alone;
  /// 0 where an angle is unknown before or after it. Nothing for any other motion.
  std::optional<double> pass(const Toolpath& path, std::size_t step, Point3 from) {
    const MotionExtra* extra = path.extra(step);
    if (extra == nullptr || !extra->abc) return std::nullopt;
    const std::array<double, 3> to = *extra->abc;
    double square = 0.0;
    unsigned turned = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - at_[axis];
      if (way != 0.0) turned |= 1u << axis;
      square += way * way;
    }
    const unsigned unknown = unknown_ | extra->unknown_abc;
    at_ = to;
    unknown_ = extra->unknown_abc;
    const Step& s = path[step];
    if (!(s.to() == from) || s.kind() == StepKind::arc) return std::nullopt;
    return (unknown & turned) == 0 ? std::sqrt(square) : 0.0;
  }

 private:
  std::array<double, 3> at_{};
  unsigned unknown_ = 7;
};

}  // namespace kerf::detail

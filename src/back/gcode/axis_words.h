// The controller's axes: where they are, and which words a line needs.
#pragma once

#include <cstddef>
#include <string_view>

#include "back/gcode/post_part.h"

namespace kerf::gcode {

inline constexpr unsigned kAllAxes = 7;

/// X, Y and Z.
class AxisWords : PostPart {
 public:
  explicit AxisWords(PostContext& context) : PostPart(context) {}

  /// A point of the toolpath in the controller's coordinates.
  Counts counts(Point3 p) const { return units_.grid.counts(p - zero_); }
  const Counts& at() const { return at_; }
  Point3 zero() const { return zero_; }
  unsigned known() const { return known_; }

  unsigned to_write(std::size_t i, const Counts& to) const;
  unsigned by_distance(std::size_t i, const Counts& to) const;
  void put(const Counts& to, unsigned axes) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((axes >> axis & 1u) != 0) lines_.word(static_cast<char>('X' + axis), to[axis], units_.decimals);
  }
  std::string_view correction_of(std::size_t i) const;
  void put_correction(std::size_t i);
  /// Motion `i`, of which the axes `written` are on the line, leads to `to`.
  void arrive(std::size_t i, const Counts& to, unsigned written);
  /// `axes` that lines outside of the toolpath have moved.
  void approach(const Counts& to, unsigned axes);

  void lose(unsigned axes) { known_ &= ~axes; }
  /// The operator may move all axes.
  void pause() { paused_ = kAllAxes; }
  void set_zero(Point3 zero) { zero_ = zero; }
  /// The zero has changed: the axes are at the toolpath's position.
  void follow_position() {
    at_ = counts(position_.at);
    known_ = 0;
  }

 private:
  Point3 zero_;  // of its coordinates, in those of the toolpath
  Counts at_{};
  unsigned known_ = 0;   // axes whose at_ has been written in work coordinates
  unsigned paused_ = 0;  // axes not written since a pause, in which the operator may have moved them
};

/// A, B and C.
class RotaryWords : PostPart {
 public:
  explicit RotaryWords(PostContext& context) : PostPart(context) {}

  bool add(std::size_t i, double fraction);
  bool only_turns(std::size_t i) const;
  /// Whether motion `i` changes an angle.
  bool turns(std::size_t i) const;
  /// Whether straight cut `i` moves along and turns, in inverse time on this controller.
  bool in_inverse_time(std::size_t i) const;
  void lose(unsigned axes) { known_ &= ~axes; }

 private:
  std::array<std::int64_t, 3> counts_{};
  std::array<double, 3> from_{};          // degrees, of the toolpath
  unsigned unknown_ = kAllAxes;           // of it
  std::optional<std::size_t> turned_by_;  // the last motion that turns an axis, or may do so
  unsigned known_ = 0;
};

}  // namespace kerf::gcode

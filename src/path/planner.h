// A motion planner as small controllers have it: a short ring of straight moves, of which the last ends at
// rest. Works in mm and seconds.
//
// Each move knows the highest speed (squared) at which it may be entered: that of its corner, or 0 after a
// stop. When a move is added, the speeds of those before it are worked out again from the end, until one does
// not change. The move at the front is done when the ring is full; its exit is the entry of the next one.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kerf/machine.h"

namespace kerf::detail {

class Planner {
 public:
  /// Seconds are added to `seconds[move's step]`.
  Planner(const Machine& machine, std::vector<float>& seconds);

  /// A straight move to `to`; `feed` in mm/s, infinity for rapids. Moves shorter than a step are none.
  void move(Point3 to, double feed, std::size_t step);
  /// All that is planned is done, and the machine stands.
  void stop();
  /// Takes the machine to a place without a move (one that is not timed).
  void place(Point3 to);
  std::size_t moves() const { return moves_; }

 private:
  struct Move {
    double length = 0.0;        // mm
    double acceleration = 0.0;  // mm/s^2
    double speed = 0.0;         // mm/s, the highest
    double most_entry2 = 0.0;   // highest entry speed, squared
    double entry2 = 0.0;        // planned entry speed, squared
    std::size_t step = 0;
  };

  Point3 rounded(Point3 to) const;
  double corner_speed2(Point3 before, Point3 after) const;
  void plan_backwards();
  void finish_front();
  Move& at(std::size_t i) {
    const std::size_t place = front_ + i;
    return ring_[place < ring_.size() ? place : place - ring_.size()];
  }

  std::vector<float>& seconds_;
  std::array<double, 3> rates_{}, accelerations_{}, steps_per_mm_{};
  double deviation_, slowest_;
  std::vector<Move> ring_;
  std::size_t front_ = 0, count_ = 0, moves_ = 0;
  Point3 here_;            // rounded to steps
  Point3 direction_;       // of the last move
  double last_speed_ = 0;  // of the last move
  bool standing_ = true;   // nothing is planned, so that the next move begins at rest
};

}  // namespace kerf::detail

// A motion planner like that of small controllers: a short queue of straight motions, the last of which ends
// at rest. Works in mm and seconds.
//
// Each motion has a maximum entry speed (squared): that of its corner, or 0 after a stop. When a motion is
// added, the speeds of those before it are recomputed from the end until one does not change. The first
// motion runs when the queue is full; its exit speed is the entry speed of the next one.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kerf/path/machine.h"

namespace kerf::detail {

class Planner {
 public:
  /// Seconds are added to `seconds[move's step]`.
  Planner(const Machine& machine, std::vector<float>& seconds);

  /// A straight motion to `to`; `feed` in mm/s, infinity for rapids. Motions shorter than a step are ignored.
  void move(Point3 to, double feed, std::size_t step);
  /// Runs all planned motions and stops the machine.
  void stop();
  /// Sets the position without a timed motion.
  void set_position(Point3 to);
  std::size_t moves() const { return moves_; }

 private:
  struct Move {
    double length = 0.0;        // mm
    double acceleration = 0.0;  // mm/s^2
    double speed = 0.0;         // mm/s, maximum
    double max_entry2 = 0.0;    // maximum entry speed, squared
    double entry2 = 0.0;        // planned entry speed, squared
    std::size_t step = 0;
  };

  Point3 rounded(Point3 to) const;
  double corner_speed2(Point3 before, Point3 after) const;
  void plan_backwards();
  void finish_front();
  Move& at(std::size_t i) {
    const std::size_t index = front_ + i;
    return ring_[index < ring_.size() ? index : index - ring_.size()];
  }

  std::vector<float>& seconds_;
  std::array<double, 3> rates_{}, accelerations_{}, steps_per_mm_{};
  double deviation_, slowest_;
  std::vector<Move> ring_;
  std::size_t front_ = 0, count_ = 0, moves_ = 0;
  Point3 here_;            // rounded to steps
  Point3 direction_;       // of the last move
  double last_speed_ = 0;  // of the last move
  bool stopped_ = true;    // nothing is planned: the next motion starts at rest
};

}  // namespace kerf::detail

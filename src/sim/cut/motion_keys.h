// The motions of two toolpaths that are the same to the simulator.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sweep/survey.h"

#include "kerf/path/toolpath.h"
#include "kerf/sim/live.h"

namespace kerf::sim {

/// The identity of a motion for the simulator.
struct MotionKey {
  std::uint64_t hash = 0;  // of everything that determines what the motion cuts and touches
  std::uint32_t step = 0;  // index in its toolpath
};

/// One per motion, in order. Two motions with the same hash remove the same from the same material.
std::vector<MotionKey> motion_keys(const Toolpath& path, const Survey& survey);

/// The difference of two lists: motions before `first` are the same, and so are those from `old_end` and from
/// `new_end` on.
struct MotionChange {
  std::size_t first = 0, old_end = 0, new_end = 0;
  bool none() const { return first == old_end && first == new_end; }
  /// The new index of a motion; of a deleted motion that of the motion after it.
  std::size_t moved(std::size_t old) const {
    return old < first ? old : old < old_end ? first : old - old_end + new_end;
  }
};
MotionChange change_of(const std::vector<MotionKey>& old_keys, const std::vector<MotionKey>& new_keys);
/// The new numbers of the steps of the motions that are the same.
std::vector<StepShift> step_shifts(const std::vector<MotionKey>& old_keys,
                                   const std::vector<MotionKey>& new_keys, const MotionChange& change);

}  // namespace kerf::sim

// Which motions of two toolpaths are the same to the simulator.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sweep/survey.h"

#include "kerf/toolpath.h"

namespace kerf::sim {

/// A motion as the simulator sees it.
struct MotionKey {
  std::uint64_t hash = 0;  // of all that decides what the motion cuts and meets
  std::uint32_t step = 0;  // index in its toolpath
};

/// One a motion, in order. Two motions with the same hash cut the same from the same material.
std::vector<MotionKey> motion_keys(const Toolpath& path, const Survey& survey);

/// The motions that two lists do not have in common: those before `first` are the same, and so are those from
/// `old_end` and from `new_end` on.
struct MotionChange {
  std::size_t first = 0, old_end = 0, new_end = 0;
  bool none() const { return first == old_end && first == new_end; }
  /// Where a motion is now that was number `old`: those that are gone are where their followers are.
  std::size_t moved(std::size_t old) const {
    return old < first ? old : old < old_end ? first : old - old_end + new_end;
  }
};
MotionChange change_of(const std::vector<MotionKey>& old_keys, const std::vector<MotionKey>& new_keys);

}  // namespace kerf::sim

// From a toolpath to batches of sweeps: in parts, so that one batch is made while the one before is cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/plan.h"
#include "sim/survey.h"

#include "kerf/toolpath.h"

namespace kerf::sim {

/// From a first step to a last one; none while the first is after the last.
struct StepRange {
  std::size_t first = SIZE_MAX, last = 0;
  void add(const StepRange& more) {
    first = std::min(first, more.first);
    last = std::max(last, more.last);
  }
};

/// What of a toolpath is to be cut, and how it is judged.
struct FeedScope {
  PlanScope plan;
  std::vector<StepRange> steps;  // in order and apart
  Length hazard_depth;
  bool is_no_go = false;  // every cut is one of a spindle that stands
};

class Feeder {
 public:
  Feeder(const Workpiece::Body& body, const Toolpath& path, const Survey& survey, FeedScope scope)
      : survey_(survey),
        scope_(std::move(scope)),
        tiles_(body.tiles.size()),
        planner_(body, survey.solids, scope_.hazard_depth, scope_.plan),
        motion_(path) {}

  /// Fills a batch, whatever it held, with what comes next; it is empty at the end of the path.
  void fill(Batch& batch);

 private:
  bool is_wanted(std::size_t step);
  void add(Batch& batch);

  const Survey& survey_;
  FeedScope scope_;
  std::size_t tiles_;
  Planner planner_;
  MotionReader motion_;
  std::size_t next_range_ = 0;
};

}  // namespace kerf::sim

// From a toolpath to batches of sweeps: in parts, so that one batch is made while the one before is cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/sweep/plan.h"
#include "sim/sweep/survey.h"

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

/// The same steps in order, no range touching another.
std::vector<StepRange> apart(std::vector<StepRange> ranges);

/// How far from the centres of columns sweeps are kept for exact meshes, in pitches.
inline constexpr double kKeptMargin = 1.9;

/// What of a toolpath is to be cut, and how it is judged.
struct BatchScope {
  PlanScope plan;
  std::vector<StepRange> steps;  // in order and apart
  Length hazard_depth;
  bool is_no_go = false;                 // every cut is one of a spindle that stands
  std::vector<std::size_t> pauses = {};  // in order: a batch ends before each of these steps
  /// Null, or one a step: what sweeps and contacts have in place of it.
  const std::vector<std::uint32_t>* numbers = nullptr;
};

/// Plans a path batch by batch.
class BatchSource {
 public:
  BatchSource(const Workpiece::Body& body, const Toolpath& path, const Survey& survey, BatchScope scope)
      : path_(path),
        survey_(survey),
        scope_(std::move(scope)),
        tiles_(body.tiles.size()),
        planner_(body, survey.solids, scope_.hazard_depth, scope_.plan),
        motion_(path) {}

  /// What comes next, in a batch that nothing else holds any more or in a new one.
  std::shared_ptr<const Batch> next();

 private:
  void fill(Batch& batch);
  bool is_wanted(std::size_t step);
  bool next_motion();
  bool skip();
  bool is_done() const { return next_range_ >= scope_.steps.size(); }
  bool reached_pause();
  /// Sets tool_ to the place of a tool's solids; false if it has none.
  bool find_tool(int number);
  void add(Batch& batch);

  const Toolpath& path_;
  const Survey& survey_;
  BatchScope scope_;
  std::size_t tiles_;
  Planner planner_;
  MotionReader motion_;
  std::size_t next_range_ = 0, next_pause_ = 0;
  std::size_t skipped_to_ = 0;      // the ranges before this one were skipped to
  std::optional<int> tool_number_;  // of tool_
  std::uint32_t tool_ = 0;
  bool waiting_ = false;  // the motion that was read has not been added
  std::vector<std::shared_ptr<Batch>> batches_;
  std::vector<Batch::Pair> pairs_;  // the memory of all batches' pairs, which are of no use when sorted
};

/// The batches of a path, kept for what needs its sweeps again as long as they are few: planning a longer
/// path again takes little of the time that cutting it takes, and much less memory.
class KeptBatches {
 public:
  void add(const std::shared_ptr<const Batch>& batch);
  /// Whether these are all batches of the path.
  bool complete() const { return !batches_.empty() && batches_.back()->is_last; }
  /// In order of time.
  const std::vector<std::shared_ptr<const Batch>>& batches() const { return batches_; }

 private:
  std::vector<std::shared_ptr<const Batch>> batches_;
  std::size_t sweeps_ = 0, pairs_ = 0;
  bool too_many_ = false;
};

}  // namespace kerf::sim

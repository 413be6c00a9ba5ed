// Batches of sweeps from a toolpath: one batch is planned while the previous one is cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/sweep/plan.h"
#include "sim/sweep/survey.h"

#include "kerf/path/toolpath.h"

namespace kerf::sim {

/// The steps first to last; empty if first > last.
struct StepRange {
  std::size_t first = SIZE_MAX, last = 0;
  void add(const StepRange& more) {
    first = std::min(first, more.first);
    last = std::max(last, more.last);
  }
};

/// The same steps as sorted ranges that neither overlap nor touch.
std::vector<StepRange> merge_ranges(std::vector<StepRange> ranges);

/// Sweeps within this distance of column centres are kept for exact meshes, in pitches.
inline constexpr double kKeptMargin = 1.9;

/// Which steps of a toolpath are cut, and how contacts are judged.
struct BatchScope {
  PlanScope plan;
  std::vector<StepRange> steps;  // sorted, without overlap
  Length hazard_depth;
  bool is_no_go = false;                 // every cut counts as one with the spindle stopped
  std::vector<std::size_t> pauses = {};  // sorted: a batch ends before each of these steps
  /// Null, or one number per step, stored in sweeps and contacts instead of the step.
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
        planner_(body, survey.solids, scope_.hazard_depth, scope_.plan, survey.surroundings),
        motion_(path) {}

  /// The next batch: a reused one that is no longer referenced elsewhere, or a new one.
  std::shared_ptr<const Batch> next();

 private:
  void fill(Batch& batch);
  bool is_wanted(std::size_t step);
  bool next_motion();
  bool skip();
  bool is_done() const { return next_range_ >= scope_.steps.size(); }
  bool reached_pause();
  /// Sets tool_ to the index of the solids of a tool; false if it has none.
  bool find_tool(int number);
  void add(Batch& batch);
  void mark_repeats(Batch& batch);

  const Toolpath& path_;
  const Survey& survey_;
  BatchScope scope_;
  std::size_t tiles_;
  Planner planner_;
  MotionReader motion_;
  std::size_t next_range_ = 0, next_pause_ = 0, next_covered_ = 0;
  std::size_t skipped_to_ = 0;      // the ranges before this one have been skipped to
  std::optional<int> tool_number_;  // of tool_
  std::uint32_t tool_ = 0;
  bool waiting_ = false;                 // the current motion has not been added yet
  std::vector<std::uint32_t> first_of_;  // hash table of mark_repeats, kept for its memory
  std::vector<std::shared_ptr<Batch>> batches_;
  std::vector<Batch::Pair>
      pairs_;  // memory for the pairs, shared by all batches, as pairs are not needed after sorting
};

/// The batches of a path, kept for a second pass over its sweeps while they are few. Planning a long path
/// again takes a small fraction of the time of cutting it and saves much memory.
class KeptBatches {
 public:
  void add(const std::shared_ptr<const Batch>& batch);
  /// Whether these are all batches of the path.
  bool complete() const { return !batches_.empty() && batches_.back()->is_last; }
  /// Sorted by time.
  const std::vector<std::shared_ptr<const Batch>>& batches() const { return batches_; }

 private:
  std::vector<std::shared_ptr<const Batch>> batches_;
  std::size_t sweeps_ = 0, pairs_ = 0;
  bool too_many_ = false;
};

}  // namespace kerf::sim

// A simulation that follows the edits of its program: after an edit only the tiles touched by changed motions
// are cut again; progress can be shown while cutting, and the workpiece is available at any step.
//
// Columns and hazards are those of `simulate` for the same toolpath, within 0.1 um on steep flanks (sums are
// rounded per group of sweeps, and groups may differ). Volumes are those of the column centres: walls between
// columns are not measured as in simulate, so they may be off by half a column at a wall.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/sim/workpiece.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

struct LiveOptions {
  SimulationOptions simulation;
  /// Number of states kept, evenly spread along the job, from which any step is reached; each needs the
  /// memory of the tiles that change until the next.
  std::size_t states = 16;
};

/// A rectangle of columns.
struct ColumnBlock {
  int i = 0, j = 0;    // the first column
  int nx = 0, ny = 0;  // numbers of columns
};

/// The columns cut since the previous call.
struct LiveChunk {
  std::size_t steps_done = 0;  // of the toolpath
  std::vector<ColumnBlock> changed;
};
/// Called between two batches, while the workpiece does not change.
using LiveProgress = std::function<void(const LiveChunk&)>;

/// New numbers of steps: those of the previous toolpath from `first` to the next entry's `first` are `by`
/// higher.
struct StepShift {
  std::uint32_t first = 0;
  std::int32_t by = 0;
  bool operator==(const StepShift&) const = default;
};

/// The result of an update.
struct LiveUpdate {
  std::size_t motions_kept = 0;     // unchanged motions of the toolpath
  std::vector<ColumnBlock> redone;  // all columns that may have changed
  /// Of the steps that made the surfaces of all other columns, in ascending order; none: unchanged.
  std::vector<StepShift> shifts;
  double seconds = 0.0;
  bool stopped = false;  // the state then contains only part of the job; the next update starts over
};

class LiveSimulation {
 public:
  struct State;

  /// Nothing is cut: the workpiece is the stock. The first update reports an invalid stock.
  LiveSimulation(ToolTable tools, Stock stock, LiveOptions options);
  LiveSimulation(LiveSimulation&&) noexcept;
  LiveSimulation& operator=(LiveSimulation&&) noexcept;
  ~LiveSimulation();

  /// Makes this the simulation of `path`. Appends errors as `simulate` does, and returns nothing and changes
  /// nothing, if it cannot run.
  std::optional<LiveUpdate> update(Toolpath path, Diagnostics& diagnostics, Progress* progress = nullptr,
                                   const LiveProgress& chunk = {});
  /// Without a copy of the path.
  std::optional<LiveUpdate> update(std::shared_ptr<const Toolpath> path, Diagnostics& diagnostics,
                                   Progress* progress = nullptr, const LiveProgress& chunk = {});

  /// The toolpath of the last update; empty before the first.
  const Toolpath& path() const;
  /// The workpiece after the whole job; null before the first update.
  const Workpiece* workpiece() const;
  Volume stock() const, removed() const;
  std::vector<Hazard> hazards() const;         // in order of steps
  std::vector<float> removed_by_step() const;  // mm3

  /// A copy of the workpiece after the first `steps` steps. Nothing before the first update, and if stopped.
  std::optional<Workpiece> at(std::size_t steps, Progress* progress = nullptr) const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace kerf

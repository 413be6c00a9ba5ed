// A simulation that lives while its program is edited: after an edit only the tiles that changed motions
// touch are cut anew, what is cut is shown bit by bit, and any instant of the job can be looked at.
//
// The columns and the hazards are those that `simulate` gives for the same toolpath, but for a tenth of a
// micron on steep flanks (sums are rounded by groups of sweeps, which may end elsewhere). The volumes are
// those of the columns' middles: walls between two columns are not measured anew (simulate does so), so they
// may be off by half a column at a wall.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/hazard.h"
#include "kerf/progress.h"
#include "kerf/simulation_options.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"
#include "kerf/workpiece.h"

namespace kerf {

struct LiveOptions {
  SimulationOptions simulation;
  /// States kept along the job, evenly spread, from which any instant is reached; each costs the memory of
  /// the tiles that change until the next.
  std::size_t states = 16;
};

/// A rectangle of columns.
struct ColumnBlock {
  int i = 0, j = 0;    // its first column
  int nx = 0, ny = 0;  // how many
};

/// What has been cut since the chunk before.
struct LiveChunk {
  std::size_t steps_done = 0;  // of the toolpath
  std::vector<ColumnBlock> changed;
};
/// Called between two batches, with the simulation's workpiece at rest.
using LiveProgress = std::function<void(const LiveChunk&)>;

/// What an update has done.
struct LiveUpdate {
  std::size_t motions_kept = 0;     // of the toolpath's motions, as they were before
  std::vector<ColumnBlock> redone;  // all columns that may differ from before
  double seconds = 0.0;
  bool stopped = false;  // the state is then that of a part of the job; the next update begins anew
};

class LiveSimulation {
 public:
  struct State;

  /// Nothing is cut yet: the workpiece is the stock. An unsound stock is told by the first update.
  LiveSimulation(ToolTable tools, Stock stock, LiveOptions options);
  LiveSimulation(LiveSimulation&&) noexcept;
  LiveSimulation& operator=(LiveSimulation&&) noexcept;
  ~LiveSimulation();

  /// Makes this the simulation of `path`. Appends errors as `simulate` does and returns nothing where it
  /// cannot run; all is then as before.
  std::optional<LiveUpdate> update(Toolpath path, Diagnostics& diagnostics, Progress* progress = nullptr,
                                   const LiveProgress& chunk = {});

  /// That of the last update; empty before the first.
  const Toolpath& path() const;
  /// The part as it is after the whole job; null before the first update.
  const Workpiece* workpiece() const;
  Volume stock() const, removed() const;
  std::vector<Hazard> hazards() const;         // in order of steps
  std::vector<float> removed_by_step() const;  // mm3

  /// The part as it stood after the first `steps` steps; a copy. Nothing before the first update, and where
  /// stopped.
  std::optional<Workpiece> at(std::size_t steps, Progress* progress = nullptr) const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace kerf

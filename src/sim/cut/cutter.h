// Passes the tiles of a batch of sweeps to the kernels.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "sim/kernel/kernels.h"
#include "sim/sweep/batch_source.h"

namespace kerf::sim {

/// A batch and the results of cutting it.
struct CutBatch {
  std::shared_ptr<const Batch> plan;
  std::vector<double> removed;  // length of column, mm, one per pair in the order of the list
  std::vector<std::vector<Contact>> contacts_of;  // one per tile
};

/// Positions of the columns of a tile from its first one, as the kernels see them, and their fractions inside
/// the block.
struct TileColumns {
  Real x[kTileColumns], y[kTileColumns];
  Real fraction_x[kTileColumns], fraction_y[kTileColumns];
};

/// Data of tiles and kernels during a run.
class Cutter {
 public:
  Cutter(Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth);

  /// The job for tile number `k` of the batch, without the tile itself; its results are stored in the batch.
  /// Jobs for several tiles may run at the same time.
  TileJob job(CutBatch& batch, std::size_t k) const;
  TileColumns columns_of(std::size_t tile) const;

 private:
  /// Along one axis: the fraction of each column inside the block, and its position from the first column of
  /// its tile.
  struct AxisColumns {
    std::vector<Real> fraction, position;
    void add(double column_fraction, double column_position, int number, double pitch);
  };
  void set_columns(std::size_t tile, TileJob& job) const;

  Workpiece::Body& body_;
  std::vector<LaneTool> tools_;
  Field field_{};
  AxisColumns along_x_, along_y_;
  bool narrow_x_ = false, narrow_y_ = false;  // the last column of a row or the last row is narrower
};

/// Cuts all batches that next(), a function returning std::shared_ptr<const Batch>, returns: calls cut(batch,
/// k) for each tile of a batch on any thread, and at_rest(batch) after the last of them. While a batch is
/// cut, the results of the previous one are passed to add_up(batch), then next() is called. After stop() has
/// returned true no further tile is started and at_rest is not called.
template <class Next, class Cut, class AddUp, class AtRest, class Stop>
void cut_batches(const Next& next, unsigned threads, const Cut& cut, const AddUp& add_up,
                 const AtRest& at_rest, const Stop& stop) {
  CutBatch now, other;
  now.plan = next();
  const auto tasks = static_cast<unsigned>(now.plan->busy.size() + 1);
  Team team(now.plan->is_last ? std::min(threads, tasks) : threads);
  const auto finish = [&](CutBatch& batch) {
    if (batch.plan) add_up(batch);
    batch.plan.reset();
  };
  for (bool more = true; more && !stop(); std::swap(now, other)) {
    more = !now.plan->is_last;
    now.removed.assign(now.plan->list.size(), 0.0);
    now.contacts_of.assign(now.plan->busy.size(), {});
    const auto work = [&](std::size_t n) {
      if (n > 0) return cut(now, now.plan->order[n - 1]);
      finish(other);
      if (more) other.plan = next();
    };
    team.run(now.plan->busy.size() + 1, work, stop);
    if (!stop()) at_rest(now);  // after a stop, tiles of the batch may be uncut
  }
  finish(other);
}

/// Contacts merged by step and kind.
class ContactList {
 public:
  void add(const Contact& contact);
  /// Sorted by step; `low` is the lowest corner of the block.
  std::vector<Hazard> hazards(Point3 low) const;

 private:
  std::map<std::pair<std::uint32_t, HazardKind>, Contact> contacts_;
};

}  // namespace kerf::sim

// Sends the tiles of a batch of sweeps to the kernels.
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

/// A batch and what cutting it has found.
struct CutBatch {
  std::shared_ptr<const Batch> plan;
  std::vector<double> removed;                    // length of column, mm, one a pair in order of the list
  std::vector<std::vector<Contact>> contacts_of;  // one a tile
};

/// Places of a tile's columns from its first one, as the kernels see them, and their shares in the block.
struct TileColumns {
  Real x[kTileColumns], y[kTileColumns];
  Real share_x[kTileColumns], share_y[kTileColumns];
};

/// What tiles and kernels share during a run.
class Cutter {
 public:
  Cutter(Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth);

  /// The work on tile number `k` of the batch, all but the tile itself; what it finds goes into the batch.
  /// Tiles may be worked on at the same time.
  TileJob job(CutBatch& batch, std::size_t k) const;
  TileColumns columns_of(std::size_t tile) const;

 private:
  /// Along one axis: each column's share in the block, and its place from the first column of its tile.
  struct ColumnPlaces {
    std::vector<Real> share, place;
    void add(double column_share, double column_place, int number, double pitch);
  };
  void place_columns(std::size_t tile, TileJob& job) const;

  Workpiece::Body& body_;
  std::vector<LaneTool> tools_;
  Field field_{};
  ColumnPlaces along_x_, along_y_;
  bool narrow_x_ = false, narrow_y_ = false;  // the last column of a row, the last row
};

/// Cuts all batches that next() returns, a std::shared_ptr<const Batch>: calls cut(batch, k) for each of a
/// batch's tiles on any thread and at_rest(batch) after the last of them. While a batch is cut, what the
/// previous one has found is added up by add_up(batch), and then next() is called. After stop() returned true
/// no further tile is started.
template <class Next, class Cut, class AddUp, class AtRest, class Stop>
void cut_batches(const Next& next, unsigned threads, const Cut& cut, const AddUp& add_up,
                 const AtRest& at_rest, const Stop& stop) {
  CutBatch now, other;
  now.plan = next();
  const auto pieces = static_cast<unsigned>(now.plan->busy.size() + 1);
  Team team(now.plan->is_last ? std::min(threads, pieces) : threads);
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
    at_rest(now);
  }
  finish(other);
}

/// Contacts by step and kind, each the sum of what its step met.
class ContactList {
 public:
  void add(const Contact& contact);
  /// In order of steps; `low` is the block's lowest corner.
  std::vector<Hazard> hazards(Point3 low) const;

 private:
  std::map<std::pair<std::uint32_t, HazardKind>, Contact> contacts_;
};

}  // namespace kerf::sim

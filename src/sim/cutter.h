// Sends the tiles of a batch of sweeps to the kernels.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "sim/feed.h"
#include "sim/kernels.h"
#include "sim/parallel.h"

namespace kerf::sim {

/// What tiles and kernels share during a run, and what the batch that is cut has given so far.
class Cutter {
 public:
  Cutter(Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth);

  /// Makes room for what the batch will give.
  void begin(const Batch& batch);
  /// The work on tile number `k` of the batch, all but the tile itself. Tiles may be worked on at the same
  /// time.
  TileJob job(const Batch& batch, std::size_t k);

  /// Length of column that each of the batch's pairs took, mm, in the order of the batch's list.
  const std::vector<double>& removed() const { return removed_; }
  /// What each of the batch's tiles met.
  const std::vector<std::vector<Contact>>& contacts() const { return contacts_; }

 private:
  /// Along one axis: each column's share in the block, and its place from the first column of its tile.
  struct ColumnPlaces {
    std::vector<Real> share, place;
    void add(double column_share, double column_place, int number, double pitch);
  };

  Workpiece::Body& body_;
  std::vector<LaneTool> tools_;
  Field field_{};
  ColumnPlaces along_x_, along_y_;
  bool narrow_x_ = false, narrow_y_ = false;  // the last column of a row, the last row
  std::vector<double> removed_;
  std::vector<std::vector<Contact>> contacts_;
};

/// Cuts all batches of a feeder, each planned while the one before is cut: calls cut(batch, k) for each of a
/// batch's tiles on any thread, then done(batch). After stop() returned true no further piece is begun.
template <class Cut, class Done, class Stop>
void cut_batches(Feeder& feeder, Cutter& cutter, unsigned threads, const Cut& cut, const Done& done,
                 const Stop& stop) {
  Batch now, next;
  feeder.fill(now);
  for (bool more = true; more && !stop(); std::swap(now, next)) {
    more = !now.is_last;
    cutter.begin(now);
    const auto work = [&](std::size_t n) {
      if (n > 0) return cut(now, now.order[n - 1]);
      if (more) feeder.fill(next);
    };
    parallel_for(threads, now.busy.size() + 1, work, stop);
    done(now);
  }
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

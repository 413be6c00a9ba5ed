// The volumes removed by the steps of a path, added up batch by batch.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/cut/cutter.h"

namespace kerf::sim {

/// The order of additions depends only on the batches, not on threads, as sums of floating-point numbers
/// depend on it.
class StepSums {
 public:
  /// `area`: of a column, mm2; `steps`: of the path.
  StepSums(double area, std::size_t steps);
  /// Adds the lengths removed by a batch. Batches come in time order.
  void add(const CutBatch& batch);
  double total() const { return total_; }  // mm3
  /// mm3, one per step. Nothing may be added afterwards.
  std::vector<float> take_volumes();

 private:
  void add_to_step(std::size_t step, double length);

  double area_;
  std::size_t steps_;
  double total_ = 0.0;
  std::vector<float> volumes_;    // one per step, up to the last that removes something
  std::vector<double> of_sweep_;  // of one batch, mm of column
};

}  // namespace kerf::sim

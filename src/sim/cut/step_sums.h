// What the steps of a path have removed, added up batch by batch.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/cut/cutter.h"

namespace kerf::sim {

/// The order of adding is told by the batches alone, whichever thread was first: sums of floating numbers
/// depend on it.
class StepSums {
 public:
  /// `area`: of a column, mm2; `steps`: of the path.
  StepSums(double area, std::size_t steps);
  /// Adds what a batch has removed. Batches come in order of time.
  void add(const CutBatch& batch);
  double total() const { return total_; }  // mm3
  /// mm3, one a step. There is nothing to be added any more.
  std::vector<float> take_volumes();

 private:
  void add_to_step(std::size_t step, double length);

  double area_;
  std::size_t steps_;
  double total_ = 0.0;
  std::vector<float> volumes_;    // one a step, up to the last that removes something
  std::vector<double> of_sweep_;  // of one batch, mm of column
};

}  // namespace kerf::sim

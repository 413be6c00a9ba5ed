// Sums by step in double precision within a batch, so that a step of a thousand chords is as exact as one of
// one.
#include "sim/cut/step_sums.h"

#include <utility>

#include "base/huge_pages.h"

namespace kerf::sim {

StepSums::StepSums(double area, std::size_t steps) : area_(area), steps_(steps) {
  volumes_.reserve(steps);
  use_huge_pages(volumes_.data(), steps * sizeof(float));
}

void StepSums::add(const CutBatch& batch) {
  const Batch& plan = *batch.plan;
  of_sweep_.assign(plan.sweeps.size(), 0.0);
  for (std::size_t at = 0; at < plan.list.size(); ++at) of_sweep_[plan.list[at]] += batch.removed[at];
  for (std::size_t first = 0, next = 0; first < of_sweep_.size(); first = next) {
    const std::size_t step = plan.sweeps[first].step;
    double length = 0.0;
    for (; next < of_sweep_.size() && plan.sweeps[next].step == step; ++next) length += of_sweep_[next];
    if (length != 0.0) add_to_step(step, length);
  }
}

void StepSums::add_to_step(std::size_t step, double length) {
  if (step >= volumes_.size()) volumes_.resize(step + 1);
  volumes_[step] += static_cast<float>(length * area_);
  total_ += length * area_;
}

std::vector<float> StepSums::take_volumes() {
  volumes_.resize(steps_);
  return std::move(volumes_);
}

}  // namespace kerf::sim

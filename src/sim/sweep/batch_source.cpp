// Selects the motions of a toolpath that become sweeps, with their tools.
#include "sim/sweep/batch_source.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace kerf::sim {
namespace {

/// Whether two sweeps touch the same, from the same state of the workpiece.
bool is_same(const Sweep& a, const Sweep& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.ux == b.ux && a.uy == b.uy && a.length == b.length &&
         a.z_end == b.z_end && a.slope == b.slope && a.radius == b.radius && a.turn == b.turn &&
         a.tool == b.tool && a.passes == b.passes && a.is_arc == b.is_arc;
}

std::size_t hash_of(const Sweep& s) {
  std::uint64_t hash = s.tool;
  for (const double v : {s.x, s.y, s.z, s.ux, s.length, s.z_end, s.turn}) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
  }
  return static_cast<std::size_t>(hash >> 32);
}

}  // namespace

std::vector<StepRange> merge_ranges(std::vector<StepRange> ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const StepRange& a, const StepRange& b) { return a.first < b.first; });
  std::vector<StepRange> out;
  for (const StepRange& next : ranges) {
    if (out.empty() || out.back().last < next.first) {
      out.push_back(next);
    } else {
      out.back().add(next);
    }
  }
  return out;
}

bool BatchSource::is_wanted(std::size_t step) {
  const std::vector<StepRange>& steps = scope_.steps;
  while (next_range_ < steps.size() && steps[next_range_].last < step) ++next_range_;
  const std::vector<std::size_t>& covered = survey_.covered;
  while (next_covered_ < covered.size() && covered[next_covered_] < step) ++next_covered_;
  if (next_covered_ < covered.size() && covered[next_covered_] == step) return false;
  return next_range_ < steps.size() && steps[next_range_].first <= step;
}

bool BatchSource::find_tool(int number) {
  if (number == tool_number_) return true;
  const auto tool = survey_.index.find(number);
  if (tool == survey_.index.end()) return false;
  tool_number_ = number;
  tool_ = tool->second;
  return true;
}

/// Adds the current motion to a batch.
void BatchSource::add(Batch& batch) {
  const Step& step = motion_.step();
  const MotionContext& context = motion_.context();
  if (step.kind() == StepKind::probe || step.kind() == StepKind::extrude) return planner_.interrupt();
  const std::optional<int> number = survey_.tool_of(context);
  if (!number || !find_tool(*number)) return planner_.interrupt();  // a rapid before the first tool
  if (!is_wanted(context.index)) return planner_.skip(step, context, tool_);
  const bool spindle_off = scope_.is_no_go || survey_.spindle_off(context);
  planner_.add(step, context, tool_, spindle_off, batch);
}

/// Whether the batch ends before the current motion.
bool BatchSource::reached_pause() {
  const std::size_t before = next_pause_;
  while (next_pause_ < scope_.pauses.size() && scope_.pauses[next_pause_] <= motion_.context().index)
    ++next_pause_;
  return next_pause_ != before;
}

/// Skips ahead to the motion before the next wanted range. That motion is not wanted itself, but the next one
/// may follow it.
bool BatchSource::skip() {
  if (next_range_ < skipped_to_) return false;
  skipped_to_ = next_range_ + 1;
  const std::optional<std::size_t> before = path_.motion_before(scope_.steps[next_range_].first);
  if (!before || *before <= motion_.context().index) return false;
  motion_ = MotionReader(path_, *before);
  return motion_.next();
}

bool BatchSource::next_motion() { return skip() || motion_.next(); }

std::shared_ptr<const Batch> BatchSource::next() {
  const auto is_free = [](const std::shared_ptr<Batch>& batch) { return batch.use_count() == 1; };
  const auto free = std::find_if(batches_.begin(), batches_.end(), is_free);
  const std::shared_ptr<Batch> batch =
      free != batches_.end() ? *free : batches_.emplace_back(std::make_shared<Batch>());
  std::swap(batch->pairs, pairs_);
  fill(*batch);
  std::swap(batch->pairs, pairs_);
  return batch;
}

void KeptBatches::add(const std::shared_ptr<const Batch>& batch) {
  constexpr std::size_t kMaxSweeps = 1 << 18, kMaxPairs = 1 << 22;  // some 50 MB
  sweeps_ += batch->sweeps.size() + batch->beside.size();
  pairs_ += batch->list.size();
  too_many_ = too_many_ || sweeps_ > kMaxSweeps || pairs_ > kMaxPairs;
  if (too_many_) {
    batches_.clear();
  } else {
    batches_.push_back(batch);
  }
}

/// Marks the sweeps that repeat an earlier one of the batch, as in spring passes and loops over one depth.
void BatchSource::mark_repeats(Batch& batch) {
  constexpr std::uint32_t kFree = 0xffffffffu;
  const std::size_t size = std::bit_ceil(2 * batch.sweeps.size() + 1);
  first_of_.assign(size, kFree);
  for (std::uint32_t n = 0; n < batch.sweeps.size(); ++n) {
    Sweep& sweep = batch.sweeps[n];
    std::size_t at = hash_of(sweep) & (size - 1);
    while (first_of_[at] != kFree && !is_same(batch.sweeps[first_of_[at]], sweep)) at = (at + 1) & (size - 1);
    sweep.is_repeat = first_of_[at] != kFree;
    if (!sweep.is_repeat) first_of_[at] = n;
  }
}

void BatchSource::fill(Batch& batch) {
  batch.clear();
  planner_.resume(batch);
  while (!batch.full() && !is_done() && (waiting_ || next_motion())) {
    if (!waiting_ && (waiting_ = reached_pause())) break;
    waiting_ = false;
    add(batch);
  }
  batch.is_last = !batch.full() && !waiting_;
  batch.steps_done = batch.is_last ? path_.size() : motion_.context().index;
  if (!scope_.is_no_go) mark_repeats(batch);
  if (scope_.numbers != nullptr) {
    for (Sweep& sweep : batch.sweeps) sweep.step = (*scope_.numbers)[sweep.step];
    for (Contact& contact : batch.contacts) contact.step = (*scope_.numbers)[contact.step];
  }
  batch.sort(tiles_);
}

}  // namespace kerf::sim

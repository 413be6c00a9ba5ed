// Progress of a loop with many short passes: a report or a question for each of them would take longer than
// the passes themselves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"

namespace kerf {

class Pace {
 public:
  /// `progress` may be null. A phase starts, unless `phase` is empty. `between`: passes between two reports.
  explicit Pace(Progress* progress, std::string_view phase = {}, std::size_t between = kBetween)
      : progress_(progress), between_(between) {
    if (progress_ != nullptr && !phase.empty()) progress_->phase(phase);
  }
  /// The reports that follow are within this part of the phase.
  void part(double from, double to) { from_ = from, to_ = to; }
  /// To be called in each pass, with what is done of all. True once the work is to stop.
  bool stops(std::size_t done, std::size_t all) {
    if (progress_ == nullptr || stopped_ || ++passes_ < between_) return stopped_;
    passes_ = 0;
    const double fraction = all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all);
    progress_->report(from_ + (to_ - from_) * std::min(fraction, 1.0));
    return asks();
  }
  /// The same for long passes: each is reported.
  bool stops_at(std::size_t done, std::size_t all) {
    passes_ = between_;
    return stops(done, all);
  }
  /// Asks at once, for what follows a loop.
  bool asks() { return stopped_ = stopped_ || stop_requested(progress_); }
  bool stopped() const { return stopped_; }

 private:
  static constexpr std::size_t kBetween = 1024;

  Progress* progress_;
  std::size_t between_;
  double from_ = 0.0, to_ = 1.0;
  std::size_t passes_ = 0;
  bool stopped_ = false;
};

/// Appends the error of a file whose reading was stopped, unless there are more errors than before.
void add_if_stopped(const std::string& path, std::size_t errors, Progress* progress,
                    Diagnostics& diagnostics);

}  // namespace kerf

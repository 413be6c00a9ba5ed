// A progress that records its reports, and asks to stop after the nth report.
#pragma once

#include <ctime>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "kerf/base/progress.h"

namespace kerf::test {

class Watched : public Progress {
 public:
  explicit Watched(std::size_t stop_after = std::numeric_limits<std::size_t>::max())
      : stop_after_(stop_after) {}

  void phase(std::string_view what) override {
    phase_ = what;
    last_ = 0.0;
  }
  void report(double fraction) override {
    EXPECT_GE(fraction, last_) << phase_;
    EXPECT_LE(fraction, 1.0) << phase_;
    last_ = fraction;
    if (fraction > 0.0 && fraction < 1.0) ++reports_[phase_];
    if (++all_ >= stop_after_ && !asked_) asked_ = std::clock();
    after_ += asked_ ? 1 : 0;
  }
  bool stop_requested() override { return asked_.has_value(); }

  /// Between the first and the last one of a phase.
  std::size_t reports(const std::string& phase) const {
    const auto at = reports_.find(phase);
    return at == reports_.end() ? 0 : at->second;
  }
  std::size_t all() const { return all_; }
  bool asked() const { return asked_.has_value(); }
  /// Reports since the stop was asked for, that one included.
  std::size_t after() const { return after_; }
  /// Of the processor, since then.
  double seconds_since() const {
    return asked_ ? static_cast<double>(std::clock() - *asked_) / CLOCKS_PER_SEC : 0.0;
  }
  std::string phases() const {
    std::string text;
    for (const auto& [name, count] : reports_) text += name + " " + std::to_string(count) + ", ";
    return text;
  }

 private:
  std::size_t stop_after_, all_ = 0, after_ = 0;
  std::string phase_;
  double last_ = 0.0;
  std::map<std::string, std::size_t> reports_;
  std::optional<std::clock_t> asked_;
};

}  // namespace kerf::test

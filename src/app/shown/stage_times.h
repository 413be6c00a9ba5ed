// How long the stages of a load have taken.
#pragma once

#include <chrono>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace kerf::app::view {

/// From its construction, or from the last stage.
class StageTimes {
 public:
  /// Ends a stage.
  void note(std::string_view stage) {
    const auto now = Clock::now();
    add(stage, std::chrono::duration<double, std::milli>(now - last_).count());
    last_ = now;
  }
  /// A stage that was measured elsewhere.
  void add(std::string_view stage, double ms) {
    text_ += fmt::format("{}{};dur={:.1f}", text_.empty() ? "" : ", ", stage, ms);
  }
  /// As the value of the header Server-Timing: "read;dur=31.5, cut;dur=70.2".
  const std::string& text() const { return text_; }
  double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - last_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
  std::string text_;
};

}  // namespace kerf::app::view

// Progress with the remaining time on a terminal, and interruption by SIGINT and SIGTERM.
#pragma once

#include <chrono>
#include <string>

#include "app/report/console.h"

#include "kerf/base/progress.h"

namespace kerf::app {

/// Installs handlers: SIGINT and SIGTERM set a flag (the second one ends the program at once), and a file
/// that exceeds ulimit -f is a failed write instead of SIGXFSZ.
void catch_interrupts();
bool interrupted();

/// Draws "cutting  [#####.....]  52%  0:03 left" on stderr, at most ten times per second, and clears it at
/// the end. If stderr is not a terminal, or with --quiet, it only reports interrupts.
class TerminalProgress : public Progress {
 public:
  explicit TerminalProgress(const Console& console);
  ~TerminalProgress() override;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  void phase(std::string_view what) override;
  void report(double fraction) override;
  bool stop_requested() override { return interrupted(); }
  /// Clears the bar, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double fraction, Clock::time_point now);

  bool visible_;
  bool drawn_ = false;
  std::string what_ = "working";
  Clock::time_point phase_start_ = Clock::now();
  Clock::time_point last_ = Clock::now();
};

/// Only reports interrupts: for the drop-in commands.
class InterruptOnly : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return interrupted(); }
};

/// "0:03 left", "1:02:03 left": the remaining time if `fraction` of the work took `elapsed` seconds; empty
/// while `fraction` is too small for an estimate.
std::string time_left(double fraction, double elapsed);

}  // namespace kerf::app

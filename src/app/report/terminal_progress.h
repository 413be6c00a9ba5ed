// Progress on a terminal with the time left, and stopping by Ctrl-C or a kill.
#pragma once

#include <chrono>
#include <string>

#include "app/report/console.h"

#include "kerf/progress.h"

namespace kerf::app {

/// From now on SIGINT and SIGTERM only set a flag (a second one ends the program at once), and a
/// file that grows beyond the limit (ulimit -f) is a write that fails, not the end of the program.
void catch_interrupts();
bool interrupted();

/// Draws "cutting  [#####.....]  52%  0:03 left" on stderr, at most ten times a second, and takes it away at
/// the end. On anything but a terminal, and with --quiet, it draws nothing and only tells of interrupts.
class TerminalProgress : public Progress {
 public:
  explicit TerminalProgress(const Console& console);
  ~TerminalProgress() override;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  void phase(std::string_view what) override;
  void report(double share) override;
  bool stop_requested() override { return interrupted(); }
  /// Takes the bar away, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double share, Clock::time_point now);

  bool visible_;
  bool drawn_ = false;
  std::string what_ = "working";
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_ = Clock::now();
};

/// Draws nothing and only tells of interrupts: for commands whose output is another program's.
class InterruptOnly : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return interrupted(); }
};

/// "0:03", "1:02:03"; the time left when `share` of the work took `elapsed` seconds, empty while that is a
/// guess.
std::string time_left(double share, double elapsed);
std::string clock_text(double seconds);

}  // namespace kerf::app

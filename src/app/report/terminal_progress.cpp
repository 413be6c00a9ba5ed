// The progress bar and the interrupt flag.
#include "app/report/terminal_progress.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fmt/format.h>

#include "base/clock_text.h"

namespace kerf::app {
namespace {

constexpr int kBarCells = 24;
constexpr auto kBetweenDraws = std::chrono::milliseconds(100);
constexpr auto kBeforeFirstDraw = std::chrono::milliseconds(300);  // no bar for short runs
constexpr double kMinFraction = 0.02;                              // for an estimate of the remaining time

volatile std::sig_atomic_t stop_flag = 0;

extern "C" void on_signal(int) { stop_flag = 1; }

}  // namespace

void catch_interrupts() {
#if defined(_WIN32)
  for (const int which : {SIGINT, SIGTERM}) std::signal(which, on_signal);
#else
  for (const int which : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // without SA_RESTART: a blocked read returns
    sigaction(which, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

bool interrupted() { return stop_flag != 0; }

std::string time_left(double fraction, double elapsed) {
  if (!(fraction >= kMinFraction)) return {};
  return clock_text(elapsed * (1.0 - fraction) / fraction) + " left";
}

TerminalProgress::TerminalProgress(const Console& console)
    : visible_(stderr_is_terminal() && !console.quiet()) {}

TerminalProgress::~TerminalProgress() { clear(); }

void TerminalProgress::phase(std::string_view what) {
  what_ = what;
  phase_start_ = last_ = Clock::now();
}

void TerminalProgress::report(double fraction) {
  if (!visible_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < kBetweenDraws || now - phase_start_ < kBeforeFirstDraw) return;
  last_ = now;
  draw(std::clamp(fraction, 0.0, 1.0), now);
}

void TerminalProgress::draw(double fraction, Clock::time_point now) {
  const auto cells = static_cast<std::size_t>(std::lround(fraction * kBarCells));
  const double elapsed = std::chrono::duration<double>(now - phase_start_).count();
  fmt::print(stderr, "\r\x1b[K{}  [{:.<{}}] {:3.0f}%  {}", what_, std::string(cells, '#'), kBarCells,
             fraction * 100.0, time_left(fraction, elapsed));
  std::fflush(stderr);
  drawn_ = true;
}

void TerminalProgress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace kerf::app

// The threads of a team.
#include "base/parallel.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace kerf {
namespace {

/// Number of polls before the thread sleeps: about as long as waking takes.
constexpr int kPolls = 2000;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

unsigned thread_count(unsigned wanted) {
  constexpr unsigned kMaxWorkers = 256;
  if (!kHasThreads) return 1;
  return std::clamp(wanted != 0 ? wanted : std::thread::hardware_concurrency(), 1u, kMaxWorkers);
}

Team::Team(unsigned threads) {
  for (unsigned n = 1; n < threads; ++n) {
    try {
      helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
      break;  // the system refuses more threads; the existing ones do the work
    }
  }
}

Team::~Team() {
  begin({});
  for (std::thread& helper : helpers_) helper.join();
}

/// Returns when `value` is no longer `old`.
void Team::wait_while(const Count& value, std::uint32_t old) {
  for (int poll = 0; poll < kPolls; ++poll) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause();
  }
  std::unique_lock lock(sleep_mutex_);
  changed_.wait(lock, [&] { return value.load(std::memory_order_acquire) != old; });
}

/// After a change of a value: the mutex lies between a sleeper's test of it and its sleep.
void Team::wake() {
  { const std::lock_guard lock(sleep_mutex_); }
  changed_.notify_all();
}

void Team::begin(std::function<void()> round) {
  if (helpers_.empty()) return;
  round_ = std::move(round);
  working_.store(static_cast<std::uint32_t>(helpers_.size()), std::memory_order_relaxed);
  rounds_.fetch_add(1, std::memory_order_release);
  wake();
}

void Team::keep(std::exception_ptr error) {
  const std::lock_guard lock(error_mutex_);
  if (!error_) error_ = std::move(error);
}

void Team::finish() {
  for (std::uint32_t left = working_; left != 0; left = working_.load(std::memory_order_acquire))
    wait_while(working_, left);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Team::help() {
  for (std::uint32_t seen = 0;; ++seen) {
    wait_while(rounds_, seen);
    if (!round_) return;
    round_();
    if (working_.fetch_sub(1, std::memory_order_release) == 1) wake();
  }
}

}  // namespace kerf

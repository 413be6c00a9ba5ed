// Runs numbered work items on several threads, or on the calling one if there are no others.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kerf {

/// False if the platform has no threads: the caller then does all work.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool kHasThreads = false;
#else
inline constexpr bool kHasThreads = true;
#endif

/// Number of threads to use; 0: as many as the machine has.
unsigned thread_count(unsigned wanted);

/// A pool of threads for many short rounds: starting a thread takes as long as a short round.
class Team {
 public:
  /// `threads` including the calling one; fewer if the system refuses more.
  explicit Team(unsigned threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls work(i) once for each i below `count`, in no fixed order, also on the calling thread, which calls
  /// stop() between items; after that has returned true no further item is started. Returns when all are
  /// done. Rethrows the first exception of an item (such as std::bad_alloc); no item is started after it.
  template <class Work, class Stop>
  void run(std::size_t count, const Work& work, const Stop& stop) {
    std::atomic<std::size_t> next{0};
    const auto take_part = [&](const auto& is_enough) {
      try {
        for (std::size_t i = next++; i < count; i = next++) {
          work(i);
          if (is_enough()) next = count;
        }
      } catch (...) {
        next = count;
        keep(std::current_exception());
      }
    };
    begin([&] { take_part([] { return false; }); });
    take_part(stop);
    finish();
  }

 private:
  using Count = std::atomic<std::uint32_t>;
  void wait_while(const Count& value, std::uint32_t old);
  void wake();
  void begin(std::function<void()> round);
  void keep(std::exception_ptr error);
  void finish();
  void help();

  std::vector<std::thread> helpers_;
  std::function<void()> round_;  // the work of the round; empty: exit
  Count rounds_{0};              // started
  Count working_{0};             // helpers still busy with the last round
  // Not std::atomic's wait(): where the system has no futex (Windows), that of GCC 12 tests the value before
  // it takes its mutex, and sleeps forever where the value changes in between.
  std::mutex sleep_mutex_;
  std::condition_variable changed_;
  std::mutex error_mutex_;
  std::exception_ptr error_;  // the first of the round
};

/// One round of a temporary team.
template <class Work, class Stop>
void parallel_for(unsigned threads, std::size_t count, const Work& work, const Stop& stop) {
  Team(count < threads ? static_cast<unsigned>(count) : threads).run(count, work, stop);
}

}  // namespace kerf

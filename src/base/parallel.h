// Running numbered pieces of work on several threads; also where there are none.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kerf {

/// False where the platform has no threads: all work is then done by the caller.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool kHasThreads = false;
#else
inline constexpr bool kHasThreads = true;
#endif

/// How many threads to use; 0 asks for as many as the machine has.
unsigned thread_count(unsigned wanted);

/// Threads that wait for work: for those who have many short rounds of it, as a thread takes as long to begin
/// as many a round takes to be done.
class Team {
 public:
  /// `threads` with the calling one; fewer where the machine gives no more.
  explicit Team(unsigned threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls work(i) once for each i below `count`, in no fixed order. The calling thread takes part and asks
  /// stop() between pieces; after that returned true no further piece is begun. Returns when all are done.
  /// Throws what any piece threw first (memory may run out), after which none is begun either.
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
  void begin(std::function<void()> round);
  void keep(std::exception_ptr error);
  void finish();
  void help();

  std::vector<std::thread> helpers_;
  std::function<void()> round_;            // what the helpers do; empty: go home
  std::atomic<std::uint32_t> rounds_{0};   // begun
  std::atomic<std::uint32_t> working_{0};  // helpers that have not done with the last round
  std::mutex error_mutex_;
  std::exception_ptr error_;  // the first of the round
};

/// One round of a team that has come for it.
template <class Work, class Stop>
void parallel_for(unsigned threads, std::size_t count, const Work& work, const Stop& stop) {
  Team(count < threads ? static_cast<unsigned>(count) : threads).run(count, work, stop);
}

}  // namespace kerf

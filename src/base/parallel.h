// Running numbered pieces of work on several threads; also where there are none.
#pragma once

#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace kerf {

/// False where the platform has no threads: all work is then done by the caller.
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool kHasThreads = false;
#else
inline constexpr bool kHasThreads = true;
#endif

inline unsigned thread_count(unsigned wanted) {
  constexpr unsigned kMost = 256;
  if (!kHasThreads) return 1;
  const unsigned count = wanted != 0 ? wanted : std::thread::hardware_concurrency();
  return count == 0 ? 1 : count < kMost ? count : kMost;
}

/// Calls work(i) once for each i below `count`, in no fixed order. The calling thread takes part and asks
/// stop() between pieces; after that returned true no further piece is begun.
template <class Work, class Stop>
void parallel_for(unsigned threads, std::size_t count, const Work& work, const Stop& stop) {
  std::atomic<std::size_t> next{0};
  const auto helper = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> helpers;
  for (unsigned n = 1; n < threads && n < count; ++n) {
    try {
      helpers.emplace_back(helper);
    } catch (const std::system_error&) {
      break;  // the machine gives no more threads; those there are do the work
    }
  }
  for (std::size_t i = next++; i < count; i = next++) {
    work(i);
    if (stop()) next = count;
  }
  for (std::thread& thread : helpers) thread.join();
}

}  // namespace kerf

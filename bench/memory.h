// Peak memory of a benchmark.
#pragma once

#include <fstream>
#include <malloc.h>
#include <string>

/// A number of kilobytes from /proc/self/status, as MB; 0 without such a file.
inline double status_mb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == name + ":" && status >> kilobytes) return kilobytes / 1024;
  }
  return 0.0;
}

/// Peak memory of the process since construction, above that at construction.
class PeakMemory {
 public:
  PeakMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);  // what other benchmarks left
#endif
    std::ofstream("/proc/self/clear_refs") << 5;  // resets the maximum
    start_mb_ = status_mb("VmRSS");
  }
  double mb() const { return status_mb("VmHWM") - start_mb_; }

 private:
  double start_mb_ = 0.0;
};

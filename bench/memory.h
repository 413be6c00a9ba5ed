// The memory that a benchmark needs.
#pragma once

#include <fstream>
#include <malloc.h>
#include <string>

/// A number of kilobytes from /proc/self/status, as MB; 0 where there is no such file.
inline double status_mb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == name + ":" && status >> kilobytes) return kilobytes / 1024;
  }
  return 0.0;
}

/// The maximum of the process's memory since the start of this object, less what it held then.
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

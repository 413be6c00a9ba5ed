// Reading G-code: a million moves of a relief in 30 MB, a program that computes its moves, canned cycles.
//
// times_real is how many times faster than LinuxCNC's interpreter, which takes 6.3 s of one core for a
// million lines.
#include "kerf/program/gcode.h"

#include <benchmark/benchmark.h>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace {

using namespace kerf;

constexpr double kInterpreterSecondsPerLine = 6.3e-6;

/// Pseudo-random numbers, the same in every run.
class Random {
 public:
  unsigned below(unsigned limit) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<unsigned>(state_ >> 33) % limit;
  }

 private:
  std::uint64_t state_ = 1;
};

std::string relief(std::int64_t lines) {
  std::string text = "G21 G90 F900\n";
  Random random;
  char line[64];
  for (std::int64_t i = 0; i < lines; ++i) {
    const int size = std::snprintf(line, sizeof line, "G1 X%u.%03u Y%u.%03u Z-%u.%04u\n",
                                   100 + random.below(400), random.below(1000), 100 + random.below(300),
                                   random.below(1000), 1 + random.below(9), random.below(10000));
    text.append(line, static_cast<std::size_t>(size));
  }
  return text + "M2\n";
}

void read(benchmark::State& state, const std::string& text) {
  std::size_t moves = 0;
  double seconds = 0.0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    Diagnostics diagnostics;
    moves = read_gcode(text, {}, diagnostics).path.size();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  const double runs = static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(moves));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["times_real"] = kInterpreterSecondsPerLine * static_cast<double>(moves) * runs / seconds;
}

void read_relief(benchmark::State& state) { read(state, relief(state.range(0))); }
BENCHMARK(read_relief)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void read_loop(benchmark::State& state) {
  read(state,
       "G21 G90 F900\n#1 = 0\nO1 while [#1 LT 100000]\n#1 = [#1 + 1]\nG1 X[10 * COS[#1]] Y[10 * SIN[#1]]\n"
       "O1 endwhile\nM2\n");
}
BENCHMARK(read_loop)->Unit(benchmark::kMillisecond);

void read_pecks(benchmark::State& state) {
  read(state, "G21 G90 F900\nG0 X0 Y0 Z5\nG83 X1 Y1 Z-10 R1 Q0.1\nG91\nX1 L1000\nG80\nM2\n");
}
BENCHMARK(read_pecks)->Unit(benchmark::kMillisecond);

}  // namespace

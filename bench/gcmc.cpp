// gcmc programs: time from text to text (or toolpath). The ratio compares with what the real program needs
// for the same programs (spec section 15: gcc -O2, user seconds).
#include "kerf/gcmc.h"

#include <benchmark/benchmark.h>
#include <string>

#include "kerf/files.h"

namespace {

class Counter final : public kerf::GcmcOutput {
 public:
  void message(const kerf::GcmcMessage&) override {}
  void text(std::string_view piece) override { bytes += piece.size(); }
  std::size_t bytes = 0;
};

enum class Wanted { text, path };

void run(benchmark::State& state, const std::string& program, double units, double real_seconds,
         Wanted wanted) {
  kerf::GcmcOptions options;
  options.want_path = wanted == Wanted::path;
  options.want_text = wanted == Wanted::text;
  for (auto _ : state) {
    Counter counter;
    kerf::Diagnostics diagnostics;
    const kerf::GcmcRun result = kerf::run_gcmc(program, options, counter, diagnostics);
    if (!result.completed) state.SkipWithError("the program failed");
    benchmark::DoNotOptimize(counter.bytes);
  }
  const auto count = static_cast<double>(state.iterations());
  state.counters["units/s"] = benchmark::Counter(units * count, benchmark::Counter::kIsRate);
  state.counters["ratio"] = benchmark::Counter(real_seconds * count, benchmark::Counter::kIsRate);
}

struct Program {
  const char* file;     // in cases/gcmc/perf
  double units;         // moves, loop steps, calls or vectors
  double real_seconds;  // user time of the real program
};
constexpr Program kPrograms[] = {
    {"p1_moves_loop", 500'000, 0.53},  {"p2_vectorlist", 500'000, 0.60},   {"p3_arith", 3'000'000, 1.21},
    {"p4_funcs", 832'000, 0.13},       {"p5_engrave", 423'000, 0.55},      {"p6_varcs", 125'664, 0.28},
    {"p7_bezier", 94'566, 0.59},       {"p8_arcs", 300'000, 0.23},         {"p9_nested_lists", 8'000, 1.85},
    {"p10_2M_moves", 2'000'000, 1.17}, {"p11_1M_list_int", 200'000, 0.30}, {"p12_tpc", 1'000, 0.01},
};

void add(const Program& p) {
  const std::string path = std::string(KERF_CASES_DIR) + "/gcmc/perf/" + p.file + ".gcmc";
  kerf::Diagnostics diagnostics;
  const auto file = kerf::InputFile::open(path, diagnostics);
  if (!file) return;  // the given cases are not there
  const std::string text(file->bytes());
  for (const Wanted wanted : {Wanted::text, Wanted::path}) {
    const std::string name = std::string("gcmc/") + p.file + (wanted == Wanted::text ? "" : "/toolpath");
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      run(state, text, p.units, p.real_seconds, wanted);
    })->Unit(benchmark::kMillisecond);
  }
}

const bool registered = [] {
  for (const Program& p : kPrograms) add(p);
  return true;
}();

}  // namespace

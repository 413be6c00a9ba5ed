// gcmc programs: time from text to text (or toolpath). Counter times_real: how many times faster than the
// real program, whose processor seconds for the same programs are listed below (compiled with gcc -O2, output
// written).
#include "front/gcmc/gcmc.h"

#include <benchmark/benchmark.h>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "kerf/base/files.h"

namespace {

/// Writes to an unnamed file.
class Writer final : public kerf::GcmcOutput {
 public:
  void message(const kerf::Diagnostic&) override {}
  void text(std::string_view piece) override {
    good_ = std::fwrite(piece.data(), 1, piece.size(), file_.get()) == piece.size() && good_;
  }
  bool good() const { return good_ && file_ != nullptr; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_{std::tmpfile()};
  bool good_ = true;
};

enum class Wanted { text, path };

void run(benchmark::State& state, const std::string& program, std::int64_t items, double real_seconds,
         Wanted wanted) {
  kerf::GcmcOptions options;
  options.want_path = wanted == Wanted::path;
  options.want_text = wanted == Wanted::text;
  for (auto _ : state) {
    Writer writer;
    kerf::Diagnostics diagnostics;
    const kerf::GcmcRun result = kerf::run_gcmc(program, options, writer, diagnostics);
    if (!result.completed || !writer.good()) state.SkipWithError("the program failed");
  }
  state.SetItemsProcessed(state.iterations() * items);
  state.counters["times_real"] =
      benchmark::Counter(real_seconds * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

struct Program {
  const char* file;     // in cases/gcmc/perf
  std::int64_t items;   // moves, loop steps, calls or vectors
  double real_seconds;  // of the real program
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
  if (!file) return;  // the given cases are not available
  const std::string text(file->bytes());
  for (const Wanted wanted : {Wanted::text, Wanted::path}) {
    const std::string name = std::string("gcmc/") + p.file + (wanted == Wanted::text ? "" : "/toolpath");
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      run(state, text, p.items, p.real_seconds, wanted);
    })->Unit(benchmark::kMillisecond);
  }
}

const bool registered = [] {
  for (const Program& p : kPrograms) add(p);
  return true;
}();

}  // namespace

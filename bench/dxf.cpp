// Reading DXF: a drawing of a million entities in 50 MB, and the same tenth of it beside ezdxf.
//
// times_real is how many times faster than ezdxf, which reads the same bytes in the same run; it is found as
// the interpreter of KERF_PYTHON, else build/venv/bin/python, else python3, and left out where that has no
// ezdxf.
#include "kerf/drawing/dxf.h"

#include <benchmark/benchmark.h>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include "memory.h"

namespace {

using namespace kerf;

/// Numbers that look random and are the same every time.
class Random {
 public:
  unsigned below(unsigned limit) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<unsigned>(state_ >> 33) % limit;
  }

 private:
  std::uint64_t state_ = 1;
};

class Generator {
 public:
  std::string drawing(std::int64_t entities) {
    text_ =
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$DWGCODEPAGE\n3\nANSI_1252\n9\n$INSUNITS\n70\n4\n"
        "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    for (std::int64_t i = 0; i < entities; ++i) entity();
    return text_ + "0\nENDSEC\n0\nEOF\n";
  }

 private:
  void number(int group, unsigned limit) {
    char line[48];
    const int size = std::snprintf(line, sizeof line, "%d\n%u.%02u\n", group, 1 + random_.below(limit),
                                   random_.below(100));
    text_.append(line, static_cast<std::size_t>(size));
  }
  void start(const char* type, const char* marker) {
    text_ += "0\n";
    text_ += type;
    text_ += random_.below(4) == 0 ? "\n8\nENGRAVE\n" : "\n8\nCUT\n";
    if (marker != nullptr) text_ += std::string("100\n") + marker + "\n";
    number(10, 1000);
    number(20, 1000);
  }
  void entity() {
    const unsigned kind = random_.below(10);
    if (kind < 6) {
      start("LINE", nullptr);
      number(11, 1000);
      number(21, 1000);
    } else if (kind < 8) {
      start("CIRCLE", nullptr);
      number(40, 50);
    } else if (kind < 9) {
      start("ARC", nullptr);
      number(40, 50);
      number(50, 360);
      number(51, 360);
    } else {
      start("POINT", nullptr);
    }
  }
  std::string text_;
  Random random_;
};

/// Processor time that ezdxf takes for a file; 0 where it is not installed.
double ezdxf_seconds(const std::string& bytes) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "kerf-bench.dxf";
  std::ofstream(file, std::ios::binary) << bytes;
  const char* const named = std::getenv("KERF_PYTHON");
  const bool own = std::filesystem::exists("build/venv/bin/python");
  const std::string python = named != nullptr ? named : own ? "build/venv/bin/python" : "python3";
  const std::string command = python +
                              " -c \"import ezdxf, sys, time; start = time.process_time(); "
                              "ezdxf.readfile(sys.argv[1]); print(time.process_time() - start)\" " +
                              file.string() + " 2>/dev/null";
  double seconds = 0.0;
  if (FILE* const pipe = popen(command.c_str(), "r")) {
    if (std::fscanf(pipe, "%lf", &seconds) != 1) seconds = 0.0;
    pclose(pipe);
  }
  std::filesystem::remove(file);
  return seconds;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void read_dxf(benchmark::State& state, bool compare) {
  const std::string text = Generator().drawing(state.range(0));
  const PeakMemory memory;
  const double start = cpu_seconds();
  std::size_t entities = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto drawing = dxf::read_dxf(text, "bench.dxf", diagnostics);
    entities = drawing ? drawing->entities.size() : 0;
  }
  const double seconds = (cpu_seconds() - start) / static_cast<double>(state.iterations());
  if (entities != static_cast<std::size_t>(state.range(0))) state.SkipWithError("entities are missing");
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["peak_MB"] = memory.mb();
  if (!compare) return;
  const double other = ezdxf_seconds(text);
  if (other <= 0.0) return;
  state.counters["times_real"] = other / seconds;
  state.counters["ezdxf_cpu_s"] = other;
}

void read_million(benchmark::State& state) { read_dxf(state, false); }
BENCHMARK(read_million)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void read_beside_ezdxf(benchmark::State& state) { read_dxf(state, true); }
BENCHMARK(read_beside_ezdxf)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace

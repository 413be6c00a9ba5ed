// Compiling path drawings: a project with a thousand embeddings of drawings with a hundred thousand elements.
//
// The generator makes one drawing of 100 paths, each with a hundredth of the elements, and a project that
// embeds them in turn. /10: a tenth of both, to show that time and memory grow with the size.
#include "front/pathdxf/pathdxf.h"

#include <benchmark/benchmark.h>
#include <ctime>
#include <fmt/format.h>
#include <string>

#include "memory.h"

namespace {

using namespace kerf;

constexpr int kPaths = 100;
constexpr double kStep = 1.0;  // mm, of one element

std::string entity(const char* type, const std::string& layer, const char* linetype,
                   const std::string& rest) {
  return fmt::format("0\n{}\n8\n{}\n6\n{}\n{}", type, layer, linetype, rest);
}
std::string line(const std::string& layer, const char* linetype, double x1, double y1, double x2, double y2) {
  return entity("LINE", layer, linetype, fmt::format("10\n{}\n20\n{}\n11\n{}\n21\n{}\n", x1, y1, x2, y2));
}
std::string circle(const std::string& layer, double x, double y, double radius) {
  return entity("CIRCLE", layer, "PHANTOM", fmt::format("10\n{}\n20\n{}\n40\n{}\n", x, y, radius));
}
std::string text(const std::string& layer, double x, double y, const std::string& value) {
  return fmt::format("0\nMTEXT\n8\n{}\n10\n{}\n20\n{}\n40\n0.3\n71\n5\n1\n{}\n", layer, x, y, value);
}
std::string drawing(const std::string& entities) {
  return "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
         "0\nENDSEC\n0\nEOF\n";
}

/// A path of `elements` steps of a saw tooth from (0, y) to the right, milled at one depth.
std::string path(int number, double y, int elements) {
  const std::string layer = fmt::format("9000_{}P", number);
  std::string out = circle(layer, 0, y, 0.5) + text(layer, 0, y, "M1 O2 T2 I2 B0");
  for (int i = 0; i < elements; ++i)
    out += line(layer, "CONTINUOUS", i * kStep, y + i % 2, (i + 1) * kStep, y + (i + 1) % 2);
  return out + circle(layer, elements * kStep, y + elements % 2, 1.0);
}

struct Project {
  std::string parts, main;
};

/// `elements` in all, divided by the paths, and `embeddings` of them.
Project project(int elements, int embeddings) {
  Project p;
  const int each = 2 * (elements / kPaths / 2);
  for (int k = 0; k < kPaths; ++k) p.parts += path(k + 1, 10.0 * k, each);
  p.parts = drawing(p.parts);
  const std::string layer = "8999_1P";
  std::string main = circle(layer, 0, 0, 0.5) + text(layer, 0, 0, "M1 O2 T2 I2 B0 S10");
  const double length = each * kStep;
  for (int k = 0; k < embeddings; ++k) {
    const double x = k % 2 * length, y = 5.0 * k;
    main += line(layer, "DASHDOT", x, y, length - x, y);
    main += text(layer, length / 2, y, fmt::format(">9000.{}P", k % kPaths + 1));
    main += line(layer, "HIDDEN", length - x, y, length - x, y + 5.0);
  }
  main += circle(layer, embeddings % 2 * length, 5.0 * embeddings, 1.0);
  p.main = drawing(main);
  return p;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void compile_project(benchmark::State& state) {
  const int embeddings = static_cast<int>(state.range(0)), elements = static_cast<int>(state.range(1));
  const Project p = project(elements, embeddings);
  PathdxfOptions options;
  options.rapid_height = mm(10);
  options.feed = mm_per_min(100);
  options.max_steps = 50'000'000;
  options.read_file = [&](const std::string& file) {
    return std::optional(file == "9000.dxf" ? p.parts : p.main);
  };
  options.list_files = [](const std::string&) { return std::vector<std::string>{"9000.dxf"}; };
  const PeakMemory memory;
  const double start = cpu_seconds();
  std::size_t steps = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const PathdxfRun run = compile_pathdxf("8999.1P.dxf", options, diagnostics);
    if (run.programs.empty() || diagnostics.has_errors()) {
      state.SkipWithError(diagnostics.list().empty() ? "no program"
                                                     : to_string(diagnostics.list().front()).c_str());
      return;
    }
    steps = run.programs.front().milling.size();
  }
  state.counters["cpu_s"] = (cpu_seconds() - start) / static_cast<double>(state.iterations());
  state.counters["steps"] = static_cast<double>(steps);
  state.counters["peak_MB"] = memory.mb();
}
// 1,000 embeddings of 10 elements of the 1,000 in the drawing would be small: each path has a hundredth of
// the elements, so that 1,000 embeddings of 100,000 elements make a million cuts.
BENCHMARK(compile_project)
    ->Args({100, 10'000})
    ->Args({1'000, 10'000})
    ->Args({1'000, 100'000})
    ->Unit(benchmark::kMillisecond);

}  // namespace

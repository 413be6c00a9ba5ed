// A small job from end to end: the text of gcodepreview's template (448 moves of 13 tools, the given case) is
// read, simulated at the resolution the block chooses, meshed, sharpened, verified and made a GLB.
//
// The peers' figures: the same job's solid by Manifold, quick to slow as its hulls are told, in seconds; by
// OpenSCAD it takes over half an hour.
#include <array>
#include <benchmark/benchmark.h>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <string>

#include "kerf/exact_mesh.h"
#include "kerf/gcode.h"
#include "kerf/mesh_files.h"
#include "kerf/simulate.h"
#include "kerf/tool_files.h"

namespace kerf {
namespace {

/// The recorded moves, one a line, as G-code. Where one does not begin at the end of the one before, the tool
/// is lifted, as the template set a position without moving there.
class Recording {
 public:
  void take(const std::string& line) {
    if (line.find("\"toolchange\"") != std::string::npos)
      text += "M6 T" + number_after(line, "\"number\": ") + "\nM3 S16000\n";
    if (line.find("\"move\"") == std::string::npos) return;
    const std::string begin = place_after(line, "\"b\": ["), end = place_after(line, "\"e\": [");
    if (begin != here_) text += "G0 Z50\nG0 " + begin.substr(0, begin.find('Z')) + "\nG0 " + begin + "\n";
    text += (line.find("\"cut\"") != std::string::npos ? "G1 F1000 " : "G0 ") + end + "\n";
    here_ = end;
  }
  std::string text = "G21 G90 G17\n";

 private:
  static std::string number_after(const std::string& line, const std::string& key) {
    const std::size_t at = line.find(key) + key.size();
    return line.substr(at, line.find_first_of(",}", at) - at);
  }
  static std::string place_after(const std::string& line, const std::string& key) {
    std::array<double, 3> p{};
    std::sscanf(line.c_str() + line.find(key) + key.size(), "%lf, %lf, %lf", &p[0], &p[1], &p[2]);
    std::array<char, 128> words{};
    std::snprintf(words.data(), words.size(), "X%.6f Y%.6f Z%.6f", p[0], p[1], p[2]);
    return words.data();
  }
  std::string here_;
};

/// What the parts of the way have taken, by name, in seconds of processor time on all threads.
class Stopwatch {
 public:
  void lap(const std::string& name) {
    const std::clock_t now = std::clock();
    sums[name] += static_cast<double>(now - begin_) / CLOCKS_PER_SEC;
    begin_ = now;
  }
  std::map<std::string, double> sums;

 private:
  std::clock_t begin_ = std::clock();
};

/// The GLB's bytes; empty where something fails.
std::string made_glb(const std::string& text, Stopwatch& watch, std::size_t& triangles) {
  Stock stock;
  stock.block.add(Point3{-110, -75, -8.35});
  stock.block.add(Point3{110, 75, 0});
  Diagnostics diagnostics;
  const GcodeProgram program = read_gcode(text, {}, diagnostics);
  watch.lap("read_cpu_s");
  const auto result = simulate(program.path, built_in_tools(), stock, {}, diagnostics);
  if (!result) return {};
  watch.lap("simulate_cpu_s");
  const std::vector<std::uint8_t> one_group(program.path.size(), 0);
  const MeshOptions options{.tolerance = mm(0.002), .step_groups = one_group};
  const ColumnGrid columns = result->workpiece.grid();
  Mesh mesh = extract_mesh(columns, options);
  watch.lap("mesh_cpu_s");
  const SharpenOptions sharp;
  if (!sharpen_mesh(mesh, result->workpiece, program.path, built_in_tools(), stock, sharp)) return {};
  watch.lap("sharpen_cpu_s");
  const VolumeRange volume = mesh_volume(columns, {.tolerance = options.tolerance + sharp.tolerance});
  if (!verify_mesh(mesh, volume, diagnostics)) return {};
  watch.lap("verify_cpu_s");
  triangles = mesh.step.size();
  MeshView view;
  view.positions = mesh.positions;
  view.triangles = mesh.triangles;
  view.step = mesh.step;
  std::string bytes = write_mesh(view, MeshFormat::glb);
  watch.lap("write_cpu_s");
  return bytes;
}

void template_to_glb(benchmark::State& state, const std::string& text) {
  std::size_t triangles = 0;
  std::map<std::string, double> sums;
  for (auto _ : state) {
    Stopwatch watch;
    if (made_glb(text, watch, triangles).empty()) return state.SkipWithError("nothing made");
    for (const auto& [name, seconds] : watch.sums) sums[name] += seconds;
  }
  for (const auto& [name, seconds] : sums)
    state.counters[name] = seconds / static_cast<double>(state.iterations());
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["Manifold_quick_s"] = 6;
  state.counters["Manifold_slow_s"] = 50;
}

const bool registered = [] {
  std::ifstream file(std::string(KERF_CASES_DIR) +
                     "/gcodepreview/reference/gcodepreviewtemplate.motion.json");
  Recording recording;
  bool any = false;
  for (std::string line; std::getline(file, line); any = true) recording.take(line);
  if (!any) return false;  // the given cases are not there
  benchmark::RegisterBenchmark(
      "template_to_glb", [text = recording.text](benchmark::State& state) { template_to_glb(state, text); })
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace kerf

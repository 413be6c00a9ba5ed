// A small job from end to end: the text of gcodepreview's template (448 moves of 13 tools, the given case) is
// read, simulated, meshed, verified and written as GLB, for a viewer and as an exact mesh.
//
// Other programs: the solid of the same job by Manifold, in seconds, depending on the form of its hulls;
// OpenSCAD takes over half an hour.
#include <array>
#include <benchmark/benchmark.h>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/program/gcode.h"
#include "kerf/sim/exact_mesh.h"
#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

/// The recorded motions, one per line, as G-code. Where one does not start at the end of the previous one,
/// the tool is lifted, as the template set a position without moving there.
class Recording {
 public:
  void take(const std::string& line) {
    if (line.find("\"toolchange\"") != std::string::npos)
      text += "M6 T" + number_after(line, "\"number\": ") + "\nM3 S16000\n";
    if (line.find("\"move\"") == std::string::npos) return;
    const std::string begin = text_after(line, "\"b\": ["), end = text_after(line, "\"e\": [");
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
  static std::string text_after(const std::string& line, const std::string& key) {
    std::array<double, 3> p{};
    std::sscanf(line.c_str() + line.find(key) + key.size(), "%lf, %lf, %lf", &p[0], &p[1], &p[2]);
    std::array<char, 128> words{};
    std::snprintf(words.data(), words.size(), "X%.6f Y%.6f Z%.6f", p[0], p[1], p[2]);
    return words.data();
  }
  std::string here_;
};

/// Processor time of the stages by name, seconds over all threads.
class Stopwatch {
 public:
  void lap(const std::string& name) {
    const std::clock_t now = std::clock();
    sums[name] += static_cast<double>(now - start_) / CLOCKS_PER_SEC;
    start_ = now;
  }
  std::map<std::string, double> sums;

 private:
  std::clock_t start_ = std::clock();
};

/// The result: the mesh for a viewer, within 5 microns, or the exact one, within 2.
enum class Finish { viewed, sharpened };

struct Making {
  Finish finish;
  Length resolution;  // 0: the default of the block
};

/// The mesh of what was cut, verified; nothing where something fails.
std::optional<Mesh> made_mesh(const Simulation& result, Finish finish, Stopwatch& watch) {
  const bool is_exact = finish == Finish::sharpened;
  const std::vector<std::uint8_t> one_group(result.job.path->size(), 0);
  MeshOptions options{.tolerance = mm(is_exact ? 0.002 : 0.005), .step_groups = one_group};
  const MeshColumns columns(result.workpiece);
  watch.lap("columns_cpu_s");
  Mesh mesh = extract_mesh(columns, options);
  watch.lap("mesh_cpu_s");
  if (is_exact) {
    const ExactMeshOptions exact;
    if (!make_mesh_exact(mesh, result, exact)) return std::nullopt;
    options.tolerance = options.tolerance + exact.tolerance;
    watch.lap("sharpen_cpu_s");
  }
  Diagnostics diagnostics;
  if (!verify_mesh(mesh, mesh_volume(columns, options), diagnostics)) return std::nullopt;
  watch.lap("verify_cpu_s");
  return mesh;
}

/// The GLB's bytes; empty on failure.
std::string made_glb(const std::string& text, Making making, Stopwatch& watch, std::size_t& triangles) {
  Stock stock;
  stock.block.add(Point3{-110, -75, -8.35});
  stock.block.add(Point3{110, 75, 0});
  Diagnostics diagnostics;
  const GcodeProgram program = read_gcode(text, {}, diagnostics);
  watch.lap("read_cpu_s");
  const auto result = simulate(
      {borrowed(program.path), built_in_tools(), stock, {.resolution = making.resolution}}, diagnostics);
  if (!result) return {};
  watch.lap("simulate_cpu_s");
  const auto mesh = made_mesh(*result, making.finish, watch);
  if (!mesh) return {};
  triangles = mesh->step.size();
  MeshView view;
  view.positions = mesh->positions;
  view.triangles = mesh->triangles;
  view.step = mesh->step;
  std::string bytes = write_mesh(view, MeshFormat::glb);
  watch.lap("write_cpu_s");
  return bytes;
}

void make(benchmark::State& state, const std::string& text, Finish finish) {
  const Making making{finish, mm(1e-3 * static_cast<double>(state.range(0)))};
  std::size_t triangles = 0;
  std::map<std::string, double> sums;
  for (auto _ : state) {
    Stopwatch watch;
    if (made_glb(text, making, watch, triangles).empty()) return state.SkipWithError("nothing made");
    for (const auto& [name, seconds] : watch.sums) sums[name] += seconds;
  }
  for (const auto& [name, seconds] : sums)
    state.counters[name] = seconds / static_cast<double>(state.iterations());
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["Manifold_quick_s"] = 6;
  state.counters["Manifold_slow_s"] = 50;
}

/// Rows by resolution in microns; 0: the default of the block.
void add_rows(const std::string& name, const std::string& text, Finish finish) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [text, finish](benchmark::State& state) { make(state, text, finish); })
      ->Arg(0)
      ->Arg(100)
      ->Arg(200)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

const bool registered = [] {
  std::ifstream file(std::string(KERF_CASES_DIR) +
                     "/gcodepreview/reference/gcodepreviewtemplate.motion.json");
  Recording recording;
  bool any = false;
  for (std::string line; std::getline(file, line); any = true) recording.take(line);
  if (!any) return false;  // the given cases are not available
  add_rows("template_to_glb", recording.text, Finish::viewed);
  add_rows("template_to_sharp_glb", recording.text, Finish::sharpened);
  return true;
}();

}  // namespace
}  // namespace kerf

// Uses every module of the library once in WebAssembly and prints the results; exit status 1 if one is wrong.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "base/codes/files.h"
#include "base/number.h"

#include "kerf/base/diagnostics.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"
#ifdef KERF_HAS_FRONT_GCODE_RUN
#include "kerf/program/gcode.h"
#endif
#ifdef KERF_HAS_SIM_CUT
#include "kerf/sim/simulate.h"
#endif
#ifdef KERF_HAS_CODEC_MESH
#include "kerf/formats/mesh_files.h"
#include "kerf/sim/mesh.h"
#endif

namespace kerf {
namespace {

int failures = 0;

void expect(bool right, const char* what) {
  std::printf("%s %s\n", right ? "ok    " : "WRONG ", what);
  if (!right) ++failures;
}

void check_base_and_geom() {
  expect(number_text(-0.0001, 3) == "0" && parse_number("-2.5e-1") == -0.25, "numbers as text and back");
  Diagnostics diagnostics;
  diagnostics.error(codes::file_unreadable, TextLocation{"part.nc", 3, 7}, "made up");
  expect(to_string(diagnostics.list().front()).rfind("part.nc:3:7", 0) == 0, "a diagnostic with its line");
  const ArcWalk arc = walk_arc({1, 0, 0}, {-1, 0, 0}, {0, 0}, Plane::xy, Turn::ccw, 0);
  expect(std::abs(arc.length() - std::numbers::pi) < 1e-12, "length of half a circle");
}

void check_path() {
  Toolpath path;
  const OriginId here = path.origins().add(CallLocation{"", 0, "smoke"});
  path.add(step::Cut{{10, 0, -1}, mm_per_min(100)}, here);
  expect(path.size() == 1 && path[0].cut().to.x == 10.0, "a toolpath keeps its step");
}

#ifdef KERF_HAS_FRONT_GCODE_RUN
constexpr const char* kProgram =
    "G21 G90\nM6 T1\nM3 S10000\nG0 Z5\nG0 X5 Y10\nG1 Z-1 F100\nG1 X15 F400\nG0 Z5\nM30\n";

void check_gcode() {
  Diagnostics diagnostics;
  const GcodeProgram program = read_gcode(kProgram, {}, diagnostics);
  expect(!diagnostics.has_errors() && program.ended, "G-code is read");
  try {
    read_gcode("G1 X1e999 (", {}, diagnostics);
    expect(diagnostics.has_errors(), "bad G-code is refused with an error");
  } catch (...) {
    expect(false, "nothing is thrown across a public header");
  }
}
#endif

#if defined(KERF_HAS_FRONT_GCODE_RUN) && defined(KERF_HAS_SIM_CUT)
ToolTable one_square_mill(Diagnostics& diagnostics) {
  ToolTable tools;
  if (auto tool = make_tool(1, shape::Square{mm(4), mm(12)}, {}, {}, diagnostics)) tools.set(1, *tool);
  return tools;
}

void check_simulator() {
  Diagnostics diagnostics;
  const GcodeProgram program = read_gcode(kProgram, {}, diagnostics);
  const ToolTable tools = one_square_mill(diagnostics);
  const Stock stock = make_block({20, 20, 5}, ZeroCorner::lower_left, ZeroHeight::top);
  SimulationOptions options;
  options.resolution = mm(0.05);
  options.threads = 1;
  const auto result = simulate(program.path, tools, stock, options, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) std::printf("%s\n", to_string(d).c_str());
  expect(result.has_value(), "a slot is cut");
  if (!result) return;
  const double slot = 10.0 * 4.0 + std::numbers::pi * 4.0;  // mm3 of a slot 10 long, 4 wide, 1 deep
  std::printf("       removed %.3f mm3, the slot's volume is %.3f mm3\n", result->removed.mm3(), slot);
  expect(std::abs(result->removed.mm3() - slot) < 0.2 * 0.05 * (20.0 + 4.0 * std::numbers::pi), "its volume");
#ifdef KERF_HAS_CODEC_MESH
  const Mesh mesh = extract_mesh(result->workpiece.grid());
  expect(check_mesh(mesh).bad_edges == 0, "its mesh is closed");
  MeshView view;
  view.positions = mesh.positions;
  view.triangles = mesh.triangles;
  expect(write_mesh(view, MeshFormat::glb).rfind("glTF", 0) == 0, "a GLB of it");
#endif
}
#endif

}  // namespace
}  // namespace kerf

int main() {
  kerf::check_base_and_geom();
  kerf::check_path();
#ifdef KERF_HAS_FRONT_GCODE_RUN
  kerf::check_gcode();
#endif
#if defined(KERF_HAS_FRONT_GCODE_RUN) && defined(KERF_HAS_SIM_CUT)
  kerf::check_simulator();
#endif
  std::printf(kerf::failures == 0 ? "WebAssembly smoke: passed\n" : "WebAssembly smoke: failed\n");
  return kerf::failures == 0 ? 0 : 1;
}

// Programs that PrusaSlicer has sliced from meshes: filament and time against the figures in its comments.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <numbers>
#include <string>

#include "test_paths.h"

#include "kerf/path/estimate.h"
#include "kerf/program/gcode.h"
#include "kerf/sim/print.h"

namespace kerf {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The text after "; NAME = ".
std::string setting(const std::string& text, const std::string& name) {
  const std::string key = "; " + name + " = ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return {};
  return text.substr(at + key.size(), text.find('\n', at) - at - key.size());
}

/// "1h 4m 21s" in seconds.
double seconds_of(const std::string& text) {
  double sum = 0.0, number = 0.0;
  for (const char c : text) {
    if (c >= '0' && c <= '9') number = 10.0 * number + (c - '0');
    if (c == 'h' || c == 'm' || c == 's')
      sum += number * (c == 'h' ? 3600.0 : c == 'm' ? 60.0 : 1.0), number = 0.0;
  }
  return sum;
}

TEST(SlicedPrograms, have_the_filament_and_time_of_the_slicer) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KERF_TEST_DATA "/gcode/slicer")) {
    SCOPED_TRACE(entry.path().filename().string());
    ++files;
    const std::string text = text_of(entry.path());
    Diagnostics diagnostics;
    const GcodeProgram program = read_gcode(text, {}, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors());
    const double diameter = program.filament_diameter;
    const double used =
        figures_of_print(program.path, {}).extruded.mm3() / (std::numbers::pi / 4.0 * diameter * diameter);
    const double stated = std::stod(setting(text, "filament used [mm]"));
    EXPECT_NEAR(used, stated, 0.02 * stated);
    const double slicer = seconds_of(setting(text, "estimated printing time (normal mode)"));
    ASSERT_GT(slicer, 60.0);
    const PrintTime time = estimate_print_time(program.path, default_planner(program.path, mm(diameter)));
    EXPECT_NEAR(time.total().seconds(), slicer, 0.05 * slicer);
    RecordProperty("seconds", std::to_string(time.total().seconds()));
    std::printf("%s: %.1f s, slicer %.0f s\n", entry.path().filename().c_str(), time.total().seconds(),
                slicer);
  }
  EXPECT_GE(files, 3);
}

}  // namespace
}  // namespace kerf

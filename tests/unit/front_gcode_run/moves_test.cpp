// The moves of small programs against those that LinuxCNC's interpreter makes of them
// (tests/data/gcode/moves.txt).
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "notation.h"
#include "test_paths.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

std::string text_of(const Step& s) {
  std::ostringstream out;
  out.precision(9);
  if (s.kind() == StepKind::dwell) {
    out << "D " << s.dwell().time.seconds();
    return out.str();
  }
  out << (s.kind() == StepKind::rapid ? 'R' : s.kind() == StepKind::cut ? 'C' : 'A');
  for (int axis = 0; axis < 3; ++axis) out << ' ' << s.to()[axis];
  if (s.kind() == StepKind::arc) {
    const step::Arc arc = s.arc();
    const int turns = arc.extra_turns + 1;
    out << " c " << arc.centre.x << ' ' << arc.centre.y << " t " << (arc.turn == Turn::cw ? -turns : turns);
  }
  return out.str();
}

std::vector<std::string> moves_of(const Toolpath& path) {
  std::vector<std::string> moves;
  for (const Step& s : path.steps())
    if (s.is_motion() || s.kind() == StepKind::dwell) moves.push_back(text_of(s));
  return moves;
}

TEST(Moves, AreThoseOfLinuxCnc) {
  std::ifstream file(KERF_TEST_DATA "/gcode/moves.txt");
  ASSERT_TRUE(file);
  std::string program, wanted;
  int programs = 0;
  while (std::getline(file, program)) {
    if (program.rfind("#", 0) == 0) continue;
    ASSERT_TRUE(std::getline(file, wanted) && wanted.rfind("= ", 0) == 0) << program;
    const std::string text = program_text(program);
    Diagnostics diagnostics;
    GcodeReadOptions options;  // the tools of the recording
    options.tool_diameter = [](int tool, const Tool*) -> std::optional<double> {
      return tool == 1 ? 6.0 : 10.0;
    };
    const GcodeProgram read = read_gcode(text, options, diagnostics);
    const auto got = moves_of(read.path);
    const auto want = split(wanted.substr(2), "; ");
    const double slack =
        program.find("G20") == std::string::npos ? 1.01e-4 : 2.6e-3;  // four decimals of the unit
    ASSERT_EQ(got.size(), want.size()) << program;
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_TRUE(same(got[i], want[i], slack))
          << program << "\nmove " << i << ": " << got[i] << ", wanted " << want[i];
    EXPECT_FALSE(diagnostics.has_errors()) << program << "\n" << to_string(diagnostics.list().front());
    EXPECT_TRUE(read.ended);
    ++programs;
  }
  EXPECT_GE(programs, 100);
}

}  // namespace
}  // namespace kerf

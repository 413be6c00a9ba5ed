// The linter against lines that GRBL accepts and refuses, and each of its codes.
#include "back/gcode/lint.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <string_view>

#include "base/codes/gcode.h"

#include "kerf/program/post.h"

namespace kerf {
namespace {

enum class Before { feed, no_feed };
struct Line {
  Before before;
  std::string_view text;
  int error;  // GRBL's number, 0: accepted
};
constexpr Line kLines[] = {
#include "grbl_lines.inc"
};

bool accepted(const Line& line) {
  Diagnostics diagnostics;
  std::string text = line.before == Before::feed ? "G21G90G94F100\n" : "";
  text += line.text;
  return lint_gcode(text, *find_post("grbl"), "line", diagnostics);
}

TEST(Lint, refuses_every_line_that_grbl_refuses) {
  for (const Line& line : kLines)
    EXPECT_TRUE(line.error == 0 || !accepted(line)) << line.text << ", GRBL says error " << line.error;
}

TEST(Lint, accepts_the_lines_that_grbl_accepts) {
  // Refused by the linter although GRBL accepts them: no machine does what they mean.
  const std::string_view stricter[] = {"M1", "T1.5", "M30\x1a"};
  for (const Line& line : kLines) {
    const bool known = std::find(std::begin(stricter), std::end(stricter), line.text) != std::end(stricter);
    EXPECT_TRUE(line.error != 0 || known || accepted(line)) << line.text;
  }
}

struct Case {
  std::string_view post, text;
  Code code;
};

TEST(Lint, reports_each_code) {
  const Case cases[] = {
      {"grbl", "G0 A1", codes::lint_letter},
      {"grbl", "M6", codes::lint_code},
      {"grbl", "G0 G1", codes::lint_conflict},
      {"grbl", "G0 X1 P1", codes::lint_unused},
      {"grbl", "G1 X1", codes::lint_missing},
      {"grbl", "T256", codes::lint_value},
      {"grbl", "G10 L2 P7 X1", codes::lint_value},  // GRBL has G54 to G59
      {"grbl", "G43.1 X1", codes::lint_missing},
      {"linuxcnc", "G10 L2 P10 X1", codes::lint_value},  // LinuxCNC G54 to G59.3
      {"linuxcnc", "G10 L2 P1.5 X1", codes::lint_value},
      {"linuxcnc", "G7 G8", codes::lint_conflict},
      {"linuxcnc", "G96 G97 S100", codes::lint_conflict},
      {"linuxcnc", "G52 X1 G92 X1", codes::lint_conflict},
      {"linuxcnc", "G5 X1 Y1 I0 J1 P0 Q-1", codes::lint_missing},  // a cut before any feed
      {"grbl", "F100\nG2 X5 I1 J0", codes::lint_arc},
      {"grbl", "G0 X1.00000000000000000000000000000000000000000000000000000000000000000000000000000000000",
       codes::lint_line},
      {"grbl", "(what?)", codes::lint_comment},
      {"marlin", "(comment)", codes::lint_comment},
      {"grbl", "%", codes::lint_syntax},
      {"grbl", "O100 call", codes::lint_syntax},
      {"marlin", "PAUSE", codes::lint_syntax},
      {"reprapfirmware", "PRINT_START", codes::lint_syntax},
      {"klipper", "G17 G1 X1", codes::lint_conflict},
      {"klipper", "G1 F100\nX1", codes::lint_missing},
      {"klipper", "G20", codes::lint_code},
  };
  for (const Case& c : cases) {
    Diagnostics diagnostics;
    EXPECT_FALSE(lint_gcode(c.text, *find_post(c.post), "text", diagnostics)) << c.text;
    ASSERT_FALSE(diagnostics.list().empty()) << c.text;
    EXPECT_EQ(diagnostics.list().front().code, c.code)
        << c.text << ": " << diagnostics.list().front().message;
  }
}

TEST(Lint, accepts_the_offsets_of_the_controller) {
  for (const auto& [post, text] :
       {std::pair("grbl", "G10 L2 P6 X1\nG10 L20 P0 Z2"),
        std::pair("linuxcnc", "G10 L20 P9 X1\nG59.3\nG10 L2 P7 Y0"), std::pair("linuxcnc", "G43.1 X1 Z2")}) {
    Diagnostics diagnostics;
    EXPECT_TRUE(lint_gcode(text, *find_post(post), "text", diagnostics)) << text;
  }
}

/// GRBL 1.1's MAX_LINE_NUMBER is 10000000; a larger number is its error 27. Its settings have 256 tools.
TEST(Lint, the_highest_numbers_of_lines_and_tools_are_accepted) {
  for (const auto& [text, accepts] : {std::pair("N10000000 G0 X1", true), std::pair("N10000001 G0 X1", false),
                                      std::pair("T255", true), std::pair("T256", false)}) {
    Diagnostics diagnostics;
    EXPECT_EQ(lint_gcode(text, *find_post("grbl"), "text", diagnostics), accepts) << text;
  }
}

/// The end of a probing motion is where it touches, and machine coordinates are not those of the work: an arc
/// from there may be right. Where all axes are in work coordinates it can be checked again.
TEST(Lint, an_arc_from_an_unknown_position_is_accepted) {
  const std::string arc = "\nG2 X5 I1 J0", all = "\nG0 X10 Y0 Z0";
  for (const auto& [before, accepts] : {std::pair<std::string, bool>("G0 X10 Y0 Z0", false),
                                        {"G38.2 X10", true},
                                        {"G38.2 X10\nG38.2 X10", true},
                                        {"G53 G0 X10", true},
                                        {"G38.2 X10" + all, false},
                                        {"G53 G0 X10" + all, false}}) {
    Diagnostics diagnostics;
    EXPECT_EQ(lint_gcode("G21 G90 G94 G17 F100\n" + before + arc, *find_post("grbl"), "text", diagnostics),
              accepts)
        << before;
    for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::lint_arc) << d.message;
  }
}

/// LinuxCNC's own interpreter accepts these programs.
TEST(Lint, accepts_splines_threads_and_local_shifts) {
  for (const char* text :
       {"F100\nG5 X1 Y1 I0 J1 P0 Q-1", "F100 G5.1 X1 Y1 I0 J1", "F100\nG5.2 X1 Y1 P1 L3\nX2 Y2 P1\nG5.3",
        "S100 M3 F100\nG0 Z1 X10\nG76 P0.5 Z-5 I-0.5 J0.1 K0.3 R1 Q29 H1 E0.2 L2", "F100\nG1 X1\nG52 X2"}) {
    Diagnostics diagnostics;
    EXPECT_TRUE(lint_gcode(text, *find_post("linuxcnc"), "text", diagnostics))
        << text << ": " << diagnostics.list().front().message;
  }
}

TEST(Lint, a_foreign_line_neither_moves_nor_changes_a_mode) {
  const auto code_of = [](std::string_view post, std::string_view line) {
    Diagnostics diagnostics;
    gcode::lint(line, *find_post(post), "", gcode::LintStart::foreign_line, diagnostics);
    return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
  };
  EXPECT_EQ(code_of("linuxcnc", "G91"), codes::lint_mode);
  EXPECT_EQ(code_of("linuxcnc", "M64 P1 S100"), codes::lint_mode);
  EXPECT_EQ(code_of("linuxcnc", "M64 P1 (pump)"), Code{});
  EXPECT_EQ(code_of("marlin", "M204 S500"), Code{});
  EXPECT_EQ(code_of("marlin", "G91"), codes::lint_mode);
}

TEST(Lint, accepts_named_commands_of_klipper_and_marlin) {
  for (const auto& [post, text] :
       {std::pair("klipper", "PAUSE\nSET_FAN_SPEED FAN=box SPEED=0.5"),
        std::pair("klipper", "T1\nM117 half done"), std::pair("marlin", "M117 x=1"),
        std::pair("reprapfirmware", "echo \"a\"\nglobal layer = 1")}) {
    Diagnostics diagnostics;
    EXPECT_TRUE(lint_gcode(text, *find_post(post), "text", diagnostics)) << text;
  }
}

}  // namespace
}  // namespace kerf

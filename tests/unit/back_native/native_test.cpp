// OpenSBP and RML-1 from steps: what depends on the order of steps that G-code cannot make.
#include "back/native/native.h"

#include <gtest/gtest.h>

#include "base/codes/gcode.h"

namespace kerf {
namespace {

Toolpath two_tools() {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Cut{{0, 0, -1}, mm_per_min(60)}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Cut{{10, 0, 5}, mm_per_min(600)}, OriginId::none);
  return path;
}

NativeOptions bare(NativeToolChange how) {
  NativeOptions options;
  options.writer = "Kerf";
  options.tool_change = how;
  return options;
}

TEST(OpenSbp, TheSpindleTurnsAgainAfterAChangeByHand) {
  Diagnostics diagnostics;
  const auto files = write_opensbp(two_tools(), bare(NativeToolChange::pause), diagnostics);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(files[0].text.find("C7\n&Tool = 2\n'change to tool 2\nPAUSE\nC6\nMS,10,10\nM3,10,0,5\n"),
            std::string::npos)
      << files[0].text;
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(OpenSbp, AFilePerToolStartsFromAbove) {
  Diagnostics diagnostics;
  const auto files = write_opensbp(two_tools(), bare(NativeToolChange::files), diagnostics);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[1].tool, 2);
  EXPECT_NE(files[1].text.find("&Tool = 2\nTR,9000\nC6\nJZ,5\nJ2,0,0\nMS,10,10\nM3,10,0,5\nC7\nEND\n"),
            std::string::npos)
      << files[1].text;
}

TEST(Rml, AToolThatEndsBelowTheTopCannotBeFollowedByAnotherFile) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Cut{{0, 0, -1}, mm_per_min(60)}, OriginId::none);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Cut{{10, 0, -1}, mm_per_min(600)}, OriginId::none);
  Diagnostics diagnostics;
  (void)write_rml(path, {}, bare(NativeToolChange::files), diagnostics);
  ASSERT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.list().back().code, codes::post_cannot);
}

TEST(Rml, FeedsAreBelowTheHighestSpeed) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 1}}, OriginId::none);
  path.add(step::Cut{{1, 0, 1}, mm_per_min(3000)}, OriginId::none);
  path.add(step::Cut{{2, 0, 1}, mm_per_min(1)}, OriginId::none);
  Diagnostics diagnostics;
  const auto files =
      write_rml(path, {.step = 0.01, .fastest = 50.0}, bare(NativeToolChange::ignore), diagnostics);
  EXPECT_EQ(files.at(0).text, ";;^DF;\n^PA;\nV50;\nZ0,0,100;\nV49.9;\nZ100,0,100;\nV0.1;\nZ200,0,100;\nH;\n");
  ASSERT_EQ(diagnostics.list().size(), 2u);  // one of each kind: too fast, too slow
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::post_left_out);
}

}  // namespace
}  // namespace kerf

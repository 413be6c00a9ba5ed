// OpenSBP and RML-1 to steps: modes that Kerf itself does not write.
#include "front/native/native_program.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

std::vector<Point3> ends(const NativeProgram& program) {
  std::vector<Point3> all;
  for (const Step& s : program.path.steps())
    if (s.is_motion()) all.push_back(s.to());
  return all;
}

TEST(OpenSbp, AnEmptyParameterIsAnAxisThatStays) {
  Diagnostics diagnostics;
  const auto read =
      read_opensbp("IF %(25)=0 THEN GOTO E\nJ3,1,2,3\nM3,,5\nm3, 4 ,,-1 'down\nMH\n", "a", diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  const std::vector<Point3> wanted{{1, 2, 3}, {1, 5, 3}, {4, 5, -1}, {0, 0, -1}};
  EXPECT_EQ(ends(read), wanted);
}

TEST(OpenSbp, NothingIsReadAfterTheEnd) {
  Diagnostics diagnostics;
  const auto read = read_opensbp("IF %(25)=1 THEN GOTO E\nJZ,1\nEND\nE:\nwhatever\n", "a", diagnostics);
  EXPECT_TRUE(diagnostics.list().empty() && read.ended && read.inch);
  EXPECT_EQ(read.path[0].unknown_axes(), 3u);
}

TEST(Rml, RelativePositionsAndPens) {
  Diagnostics diagnostics;
  const auto read =
      read_rml("^DF;!PZ-100,200;V50;Z0,0,200;^PR;PD100,0;PD0,100;PU;^PA;M300,0;D300,300", "a", diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  const std::vector<Point3> wanted{{0, 0, 2}, {0, 0, -1}, {1, 0, -1}, {1, 1, -1},
                                   {1, 1, 2}, {3, 0, 2},  {3, 0, -1}, {3, 3, -1}};
  ASSERT_EQ(ends(read).size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_LT(distance(ends(read)[i], wanted[i]), 1e-9) << i;
  EXPECT_EQ(read.path[0].kind(), StepKind::rapid);  // at the highest speed
}

}  // namespace
}  // namespace kerf

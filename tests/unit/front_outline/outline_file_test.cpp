// Outline files: their meaning, and the diagnostics of bad ones.
#include <gtest/gtest.h>

#include "base/codes/outline.h"

#include "kerf/drawing/outline_files.h"

namespace kerf {
namespace {

TEST(OutlineFile, IsReadWithUnitArcsAndClosing) {
  Diagnostics diagnostics;
  const auto outlines = read_outline_file(R"({"unit": "inch", "outlines": [{"name": "plate", "closed": true,
    "first": {"at": [0, 0], "corner": 0.1}, "segments": [{"to": [2, 0], "corner": -0.2},
    {"to": [2, 1], "via": [2.5, 0.5]}]}]})",
                                          "a.json", diagnostics);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_EQ(diagnostics.list().size(), 0u);
  const Outline& o = outlines[0].outline;
  EXPECT_EQ(outlines[0].name, "plate");
  EXPECT_TRUE(o.closed());
  ASSERT_EQ(o.segments.size(), 3u);
  EXPECT_DOUBLE_EQ(outlines[0].corners.at(0).mm(), 2.54);
  EXPECT_DOUBLE_EQ(outlines[0].corners.at(1).mm(), -5.08);
  ASSERT_TRUE(o.segments[1].via);
  EXPECT_DOUBLE_EQ(o.segments[1].via->x, 63.5);
}

Diagnostic complaint(const char* text) {
  Diagnostics diagnostics;
  EXPECT_TRUE(read_outline_file(text, "a.json", diagnostics).empty());
  EXPECT_EQ(diagnostics.list().size(), 1u);
  return diagnostics.list().empty() ? Diagnostic{} : diagnostics.list()[0];
}

TEST(OutlineFile, BadJsonIsRefusedWithItsLine) {
  const Diagnostic d = complaint("{\"outlines\":\n [1,}");
  EXPECT_EQ(d.code, codes::outline_file_syntax);
  EXPECT_EQ(std::get<TextLocation>(d.where).line, 2u);
  EXPECT_EQ(complaint("").code, codes::outline_file_syntax);
}

TEST(OutlineFile, EachWrongValueIsNamed) {
  for (const char* text :
       {"[]", "{}", R"({"outlines": []})", R"({"outlines": [3]})", R"({"unit": "m", "outlines": [3]})",
        R"({"outlines": [{"segments": []}]})",
        R"({"outlines": [{"first": {"at": [0, "x"]}, "segments": []}]})",
        R"({"outlines": [{"first": {"at": [0, 0]}, "segments": [{"to": [1]}]}]})",
        R"({"outlines": [{"first": {"at": [0, 0]}, "segments": [{"to": [1, 1], "radius": 3}]}]})",
        R"({"outlines": [{"first": {"at": [0, 0]}, "segments": [{"to": [1, 1], "corner": "3"}]}]})",
        R"({"outlines": [{"first": {"at": [0, 1e999]}, "segments": []}]})"})
    EXPECT_EQ(complaint(text).code, codes::outline_file_content) << text;
  const Diagnostic d = complaint(
      R"({"outlines": [{"name": "lid", "first": {"at": [0, 0]}, "segments": [{"to": [1, 1]}, {"to": 5}]}]})");
  EXPECT_NE(d.message.find("outline \"lid\": segment 2"), std::string::npos) << d.message;
}

}  // namespace
}  // namespace kerf

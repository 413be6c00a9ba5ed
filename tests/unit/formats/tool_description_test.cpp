// Kerf's own descriptions of tools: what is written is read as the same tool, for every shape and every
// built-in tool; other texts are no descriptions.
#include "tool/tool_description.h"

#include <gtest/gtest.h>
#include <string>

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

void expect_same(const Profile& read, const Profile& written, const std::string& text) {
  ASSERT_EQ(read.knots.size(), written.knots.size()) << text;
  for (std::size_t i = 0; i < read.knots.size(); ++i) {
    EXPECT_NEAR(read.knots[i].r, written.knots[i].r, 2e-6) << text;
    EXPECT_NEAR(read.knots[i].z, written.knots[i].z, 2e-6) << text;
    EXPECT_NEAR(read.knots[i].bulge, written.knots[i].bulge, 2e-6) << text;
  }
}

void expect_read_back(const Tool& tool) {
  const std::string text = write_tool_description(tool);
  Diagnostics diagnostics;
  const auto read = read_tool_description(text, tool.number, {}, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << text << ": " << to_string(d);
  ASSERT_TRUE(read) << text;
  EXPECT_TRUE(is_from_description(*read)) << text;
  EXPECT_EQ(read->shape.index(), tool.shape.index()) << text;
  EXPECT_EQ(read->teeth, tool.teeth) << text;
  EXPECT_EQ(read->teeth_assumed, tool.teeth_assumed) << text;
  EXPECT_EQ(read->plunges, tool.plunges) << text;
  EXPECT_EQ(read->flute_assumed, tool.flute_assumed) << text;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
    expect_same(read->silhouette.part(part), tool.silhouette.part(part), text);
}

TEST(ToolDescription, BuiltInToolsAreReadBack) {
  EXPECT_GE(built_in_tools().tools().size(), 97u);
  for (const auto& [number, tool] : built_in_tools().tools()) expect_read_back(tool);
}

TEST(ToolDescription, EveryShapeIsReadBack) {
  std::vector<bool> seen(std::variant_size_v<ToolShape>, false);
  for (const std::string option :
       {"square d=3.175",
        "square d=3.175 teeth=2",
        "square d=6 flute=20 shank=6 shank_length=20 holder=30 holder_length=25",
        "square d=6 flute=20 neck=5 neck_length=10 shank=8 transition=cone teeth=3 plunges=false",
        "ball d=6.35 flute=19.05",
        "bull nose d=6 flute=20 r=1",
        "bowl d=19.05 flute=15.875 r=6.35",
        "V d=12.7 angle=60",
        "V d=12 angle=90 tip=2",
        "V d=12 angle=90 tip_radius=0.5 flute=9",
        "tapered ball d=6.35 flute=38.1 tip=1.5875",
        "keyhole d=9.525 head=3.175 neck=6.35 flute=9",
        "dovetail d=12.7 flute=12.7 angle=14",
        "roundover tip=0.508 r=1.3335",
        "thread mill minor_diameter=4 major_diameter=6 cut_height=1 length=20",
        "lollipop d=6 neck=3 flute=10",
        "lollipop d=6 neck=3 neck_length=12 shank=6",
        "T-slot d=12 thickness=3 neck=5",
        "T-slot d=12 thickness=3 neck=5 neck_length=9",
        "drill d=5 flute=30 angle=135",
        "centre drill pilot_diameter=2 pilot_length=3 pilot_angle=118 d=6 flute=20 angle=60",
        "flat groove d=31.75 flute=12.7 tip=6.35",
        "chamfer d=10 flute=9 angle=90 tip=2",
        "corner rounding tip=2 d=8 r=3 height=10 flute=6"}) {
    Diagnostics diagnostics;
    const auto tool = read_tool_option(option, {}, diagnostics);
    ASSERT_TRUE(tool) << option << (diagnostics.list().empty() ? "" : to_string(diagnostics.list()[0]));
    seen[tool->shape.index()] = true;
    expect_read_back(*tool);
  }
  Diagnostics diagnostics;
  const auto drawn =
      make_tool(1, shape::Drawn{Profile{{{0, 0, 0}, {2, 0, 0.4142135623730951}, {3, 1, 0}, {3, 10, 0}}}}, {},
                {}, diagnostics);
  ASSERT_TRUE(drawn);
  seen[drawn->shape.index()] = true;
  expect_read_back(*drawn);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_TRUE(seen[i]) << i;
}

TEST(ToolDescription, OtherTextsAreNone) {
  for (const std::string text :
       {"", "square", "square,", "square, 6 mm", "square, diameter 6", "square, diameter 6 inch",
        "ball, size 6 mm", "Square, diameter 6 mm", "end mill, diameter 6 mm",
        "square, diameter 6 mm, roughing", "flat, diameter 6 mm", "square, angle 6 deg", "V, angle 60 mm",
        "square, 3 teeth", "square diameter 6 mm"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_tool_description(text, 1, {}, diagnostics)) << text;
    EXPECT_TRUE(diagnostics.list().empty()) << text;
  }
}

TEST(ToolDescription, SizesOfNoToolAreAnError) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_tool_description("square, diameter -6 mm", 1, {}, diagnostics));
  EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace kerf

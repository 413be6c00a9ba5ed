// Tool comments as real programs write them, their writing, and the choice between comment and table.
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "base/codes/gcode.h"
#include "base/codes/tools.h"
#include "tool/tool_comments.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

std::optional<ToolShape> read(std::string_view comment, double scale = 1.0) {
  Diagnostics diagnostics;
  auto shape = read_tool_comment(comment, scale, {}, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty()) << comment;
  return shape;
}

Diagnostics faults(std::string_view comment) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_tool_comment(comment, 1.0, {}, diagnostics)) << comment;
  return diagnostics;
}

Tool made(int number, const ToolShape& shape) {
  Diagnostics diagnostics;
  auto tool = make_tool(number, shape, {}, {}, diagnostics);
  EXPECT_TRUE(tool);
  return tool.value_or(Tool{});
}

template <class S>
S as(const std::optional<ToolShape>& shape) {
  EXPECT_TRUE(shape && std::holds_alternative<S>(*shape)) << (shape ? name_of(*shape) : "nothing");
  return shape && std::holds_alternative<S>(*shape) ? std::get<S>(*shape) : S{};
}

TEST(ReadToolComment, Mills) {
  const auto square = as<shape::Square>(read("TOOL/MILL, 3.175, 0.00, 12.7, 0.00"));
  EXPECT_EQ(square.diameter, mm(3.175));
  EXPECT_EQ(square.flute, mm(12.7));
  EXPECT_EQ(as<shape::Ball>(read("TOOL/MILL,6.35, 3.17, 19.05, 0.00")).diameter, mm(6.35));
  EXPECT_EQ(as<shape::Ball>(read("TOOL/MILL,0.80, 0.40, 1.59, 0.00")).diameter, mm(0.8));
  EXPECT_EQ(as<shape::Ball>(read("TOOL/MILL,3.17, 1.59, 12.70, 0.00")).diameter, mm(3.17));
  EXPECT_EQ(as<shape::BullNose>(read("TOOL/MILL, 19.05, 6.35, 15.875, 0.00")).corner_radius, mm(6.35));
}

TEST(ReadToolComment, OddSpacingAndLeadingCharacters) {
  for (const char* comment :
       {"(TOOL/MILL, 3.17, 0.00, 0.00, 0.00)", ";TOOL/MILL,3.17,0,0", " tool / mill ,3.17 , 0 ,0 , 0 ",
        "TOOL/MILL,3.17,0.00,0.00,0.00, COLOR,255,0,0"}) {
    EXPECT_EQ(as<shape::Square>(read(comment)).diameter, mm(3.17)) << comment;
  }
}

TEST(ReadToolComment, HeightZeroIsFilledInByMakeTool) {
  EXPECT_EQ(made(1, *read("TOOL/MILL,3.17, 0.00, 0.00, 0.00")).flute, mm(12.7));
  EXPECT_NEAR(made(1, *read("TOOL/MILL,0.0, 0.00, 0.00, 45.00")).diameter.mm(), 12.7, 1e-9);
}

TEST(ReadToolComment, VeesOfThreeTips) {
  const auto pointed = as<shape::Vee>(read("TOOL/MILL, 0.00, 0.00, 6.35, 45.00"));
  EXPECT_NEAR(pointed.diameter.mm(), 12.7, 1e-12);
  EXPECT_NEAR(pointed.included_angle.deg(), 90.0, 1e-12);
  const auto flat = as<shape::Vee>(read("TOOL/MILL, 6.35, 0.00, 12.7, 45.00"));
  EXPECT_NEAR(flat.diameter.mm(), 31.75, 1e-12);
  EXPECT_EQ(flat.tip_diameter, mm(6.35));
  const auto rounded = as<shape::Vee>(read("TOOL/MILL, 0.10, 0.05, 6.35, 45.00"));
  EXPECT_EQ(rounded.tip_radius, mm(0.05));
  EXPECT_NEAR(made(1, rounded).silhouette.cutting.radius_at(6.35), rounded.diameter.mm() / 2, 1e-9);
}

TEST(ReadToolComment, TaperedBallsAndTaperedBulls) {
  const auto ball = as<shape::TaperedBall>(read("TOOL/MILL, 0.254, 0.127, 5.561, 15.00"));
  EXPECT_NEAR(ball.diameter.mm(), 3.175, 1e-4);
  const Tool bull = made(1, *read("TOOL/MILL, 6, 1, 20, 10"));
  const auto& knots = bull.silhouette.cutting.knots;
  ASSERT_EQ(knots.size(), 4u);
  EXPECT_EQ(knots[1].r, 2.0);
  EXPECT_NEAR(std::atan2(knots[3].r - knots[2].r, knots[3].z - knots[2].z), degrees(10.0).rad(), 1e-12);
}

TEST(ReadToolComment, OtherWords) {
  const auto corner = as<shape::CornerRounding>(read("TOOL/CRMILL, 0.508, 6.35, 3.175, 7.9375, 3.175"));
  EXPECT_EQ(corner.tip_diameter, mm(0.508));
  EXPECT_EQ(corner.radius, mm(3.175));
  const auto chamfer = as<shape::Chamfer>(read("TOOL/CHAMFER, 10, 90, 8, 4"));
  EXPECT_NEAR(chamfer.tip_diameter.mm(), 2.0, 1e-12);
  EXPECT_NEAR(as<shape::Drill>(read("TOOL/DRILL, 5, 118, 30")).point_angle.deg(), 118.0, 1e-12);
  const auto centre = as<shape::CentreDrill>(read("TOOL/CDRILL, 2, 118, 3, 6, 60, 20"));
  EXPECT_EQ(centre.pilot_length, mm(3.0));
  EXPECT_EQ(centre.flute, mm(20.0));
}

TEST(ReadToolComment, InchProgramsScaleLengthsOnly) {
  const auto vee = as<shape::Vee>(read("TOOL/MILL, 0, 0, 0.25, 45", 25.4));
  EXPECT_NEAR(vee.diameter.mm(), 12.7, 1e-12);
}

TEST(ReadToolComment, CommentsWithoutAShapeAreIgnored) {
  for (const char* comment :
       {"", "hello", "tool 374 keyhole", "TOOL/ID=5", "TOOL/Description=1/4, flat", "COLOR,255,0,0",
        "FROM/0,0,10", "TOOL/", "TOOL/LASER, 1, 2", "T1  D=6.35 CR=0 - flat end mill"}) {
    EXPECT_FALSE(read(comment)) << comment;
  }
}

TEST(ReadToolComment, MalformedOnesAreErrors) {
  for (const char* comment :
       {"TOOL/MILL, 3.175", "TOOL/MILL, a, b, c", "TOOL/MILL, 6, -3, 20, 0", "TOOL/MILL, -6, 0, 20",
        "TOOL/MILL, 6, 0, 20, 95", "TOOL/MILL, 6, 0, 20, -5", "TOOL/MILL, 1e300, 0, 1, 0",
        "TOOL/MILL, nan, 0, 1, 0", "TOOL/DRILL, 5, 0, 30", "TOOL/CDRILL, 1, 2, 3", "TOOL/CHAMFER, 0, 90, 5",
        "TOOL/CRMILL, 1, 2, -3, 4, 5", "TOOL/MILL,,,"}) {
    const Diagnostics found = faults(comment);
    ASSERT_EQ(found.errors(), 1u) << comment;
    EXPECT_EQ(found.list()[0].code, codes::tool_comment_malformed) << comment;
  }
}

TEST(ReadToolComment, FieldsInAnotherOrderAreSkippedWithAWarning) {
  for (const char* comment :
       {"TOOL/MILL, 12.7, 6.367, 12.7, 0.00", "TOOL/MILL, 11.1125, 8, 3.175, 0.00",
        "TOOL/CRMILL, 6, 2, 1, 4, 5", "TOOL/MILL, 0, 0, 5, 0", "TOOL/CHAMFER, 2, 90, 9, 8"}) {
    const Diagnostics found = faults(comment);
    EXPECT_EQ(found.errors(), 0u) << comment;
    ASSERT_EQ(found.warnings(), 1u) << comment;
    EXPECT_EQ(found.list()[0].code, codes::tool_comment_unusable) << comment;
  }
}

TEST(WriteToolComment, WhatIsWrittenReadsBackAsTheSameSolid) {
  const std::vector<ToolShape> shapes{
      shape::Square{mm(3.175), mm(12.7)},
      shape::Ball{mm(0.79375), mm(1.5875)},
      shape::BullNose{mm(6), mm(20), mm(1)},
      shape::Vee{mm(12.7), Length(), degrees(60), Length(), Length()},
      shape::Vee{mm(12), Length(), degrees(90), mm(2), Length()},
      shape::Vee{mm(12), Length(), degrees(90), Length(), mm(0.5)},
      shape::TaperedBall{mm(6.35), mm(38.1), Angle(), mm(1.5875)},
      shape::FlatGroove{mm(31.75), mm(12.7), mm(6.35)},
      shape::Chamfer{mm(10), mm(9), degrees(90), mm(2)},
      shape::Drill{mm(5), mm(30), degrees(118)},
      shape::CentreDrill{mm(2), mm(3), degrees(118), mm(6), mm(20), degrees(60)},
      shape::Roundover{mm(0.508), mm(1.3335), mm(4.2545)},
      shape::CornerRounding{mm(2), mm(8), mm(3), mm(10), mm(6)}};
  for (const ToolShape& shape : shapes) {
    const Tool tool = made(1, shape);
    const auto comment = write_tool_comment(tool.shape);
    ASSERT_TRUE(comment) << name_of(shape);
    const Tool again = made(1, *read(*comment));
    for (double z = 0.01; z < tool.flute.mm(); z += 0.37) {
      EXPECT_NEAR(again.silhouette.cutting.radius_at(z), tool.silhouette.cutting.radius_at(z), 2e-5)
          << *comment << z;
    }
  }
}

TEST(WriteToolComment, FormIsThatOfRealPrograms) {
  EXPECT_EQ(write_tool_comment(shape::Square{mm(3.175), mm(12.7)}), "TOOL/MILL, 3.175, 0.00, 12.7, 0.00");
  EXPECT_EQ(write_tool_comment(shape::Ball{mm(6.35), mm(19.05)}), "TOOL/MILL, 6.35, 3.175, 19.05, 0.00");
  EXPECT_EQ(write_tool_comment(shape::Vee{mm(12.7), mm(6.35), degrees(90), Length(), Length()}),
            "TOOL/MILL, 0.00, 0.00, 6.35, 45.00");
  EXPECT_FALSE(write_tool_comment(shape::Keyhole{mm(9.525), mm(3.175), mm(6.35), mm(6.35)}));
  EXPECT_FALSE(write_tool_comment(shape::Dovetail{mm(12.7), mm(12.7), degrees(14)}));
}

/// The one that is chosen: 't'able or 'c'omment, followed by 'w' if there is a warning.
std::string choice(const ToolShape& table, std::string_view comment) {
  const Tool known = made(9, table);
  const Tool described = made(9, *read(comment));
  Diagnostics diagnostics;
  const Tool* chosen = choose_tool(&known, &described, {}, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::tool_comment_differs);
  return std::string(chosen == &known ? "t" : "c") + (diagnostics.warnings() > 0 ? "w" : "");
}

TEST(ChooseTool, TheTableWhereBothAgree) {
  EXPECT_EQ(choice(shape::Square{mm(3.175), mm(12.7)}, "TOOL/MILL,3.17, 0.00, 0.00, 0.00"), "t");
  EXPECT_EQ(choice(shape::Ball{mm(0.79375), mm(1.5875)}, "TOOL/MILL,0.80, 0.40, 1.59, 0.00"), "t");
  const shape::Vee vee{mm(12.7), mm(11.067), degrees(60), Length(), Length()};
  EXPECT_EQ(choice(vee, "TOOL/MILL, 0.10, 0.05, 6.35, 30.00"), "t");
  EXPECT_EQ(choice(vee, "TOOL/MILL, 0.03, 0.00, 13.4874, 30.00"), "t");
  const shape::Keyhole keyhole{mm(9.525), mm(3.175), mm(6.35), mm(6.35)};
  EXPECT_EQ(choice(keyhole, "TOOL/MILL, 9.53, 0.00, 3.17, 0.00"), "t");
  const shape::Bowl bowl{mm(19.05), mm(15.875), mm(6.35)};
  EXPECT_EQ(choice(bowl, "TOOL/MILL, 15.875, 6.35, 19.05, 0.00"),
            "t");  // diameter and height are interchanged
  EXPECT_EQ(choice(shape::TaperedBall{mm(3.175), mm(5.561), degrees(30), mm(0.254)},
                   "TOOL/MILL,0.03, 0.00, 10.00, 30.00"),
            "t");  // the full angle
}

TEST(ChooseTool, TheCommentWhereTheyDiffer) {
  EXPECT_EQ(choice(shape::Square{mm(3.175), mm(12.7)}, "TOOL/MILL, 6.35, 0.00, 12.7, 0.00"), "cw");
  EXPECT_EQ(choice(shape::Square{mm(6.35), mm(12.7)}, "TOOL/MILL, 6.35, 3.175, 12.7, 0.00"), "cw");
  const shape::Vee vee{mm(12.7), Length(), degrees(90), Length(), Length()};
  EXPECT_EQ(choice(vee, "TOOL/MILL, 0.10, 0.05, 6.35, 30.00"), "cw");
  EXPECT_EQ(choice(vee, "TOOL/MILL, 6.35, 0.00, 6.35, 45.00"), "cw");
}

TEST(ChooseTool, RoundoversWithTheirNominalRadius) {
  const shape::Roundover small{mm(0.508), mm(1.3335), mm(4.2545)};
  EXPECT_EQ(choice(small, "TOOL/CRMILL, 0.508, 3.175, 1.3335, 4.2545, 4.2545"), "t");
  EXPECT_EQ(choice(small, "TOOL/CRMILL, 0.508, 3.571875, 1.5875, 5.55625, 1.5875"), "t");
  EXPECT_EQ(choice(small, "TOOL/CRMILL, 0.508, 6.35, 3.175, 7.9375, 3.175"), "cw");
}

TEST(ChooseTool, OneOrNone) {
  const Tool tool = made(1, shape::Square{mm(6.0), mm(10.0)});
  Diagnostics diagnostics;
  EXPECT_EQ(choose_tool(&tool, nullptr, {}, diagnostics), &tool);
  EXPECT_EQ(choose_tool(nullptr, &tool, {}, diagnostics), &tool);
  EXPECT_EQ(choose_tool(nullptr, nullptr, {}, diagnostics), nullptr);
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(ToolComments, BelongToTheChangeBeforeThemOrToTheNext) {
  std::map<int, Tool> tools;
  Diagnostics diagnostics;
  ToolComments comments(tools);
  const auto mill = [&](const char* diameter) {
    comments.read(std::string(" tool/mill, ") + diameter + ", 0, 10, 0 ", 1.0, {}, diagnostics);
  };
  mill("1");  // of the next change
  comments.tool_change(5, diagnostics);
  mill("2");  // 5 is described: of the next change
  comments.motion();
  comments.tool_change(6, diagnostics);
  comments.tool_change(7, diagnostics);
  mill("3");  // of the change before, as nothing moved since
  comments.tool_change(8, diagnostics);
  comments.motion();
  comments.read("milling tool", 1.0, {}, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  mill("4");  // without a later change
  comments.finish(diagnostics);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::tool_comment_unused);
  ASSERT_EQ(tools.size(), 3u);
  EXPECT_NEAR(tools.at(5).diameter.mm(), 1.0, 1e-9);
  EXPECT_NEAR(tools.at(6).diameter.mm(), 2.0, 1e-9);
  EXPECT_NEAR(tools.at(7).diameter.mm(), 3.0, 1e-9);
}

}  // namespace
}  // namespace kerf

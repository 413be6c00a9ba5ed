// Tool comments of CAM programs, in the words that they write, and comments about other things.
#include "front/gcode/comments/cam_comments.h"

#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <variant>
#include <vector>

#include "front/gcode/comments/cam_stock_comments.h"
#include "front/gcode/comments/own_comments.h"
#include "test_paths.h"

namespace kerf::gcode {
namespace {

constexpr int kNone = -1;
constexpr double kInch = 25.4;

struct Case {
  std::string comment;
  int number;  // kNone: not given
  std::string shape;
  double diameter;  // mm
  double angle = 0.0, tip = 0.0, scale = 1.0;
  bool at_tool_change = false;
};

double diameter_of(const ToolShape& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.diameter; })
          return s.diameter.mm();
        else
          return 0.0;
      },
      shape);
}

const Case kTools[] = {
    // Fusion and HSM, Makera
    {"T1  D=6.35 CR=0 - ZMIN=-19.8 - flat end mill", 1, "square", 6.35},
    {"T2 D=3. CR=1.5 - ZMIN=-2 - ball end mill", 2, "ball", 3.0},
    {"T3 D=0.25 CR=0. TAPER=45DEG - ZMIN=-0.1 - chamfer mill", 3, "V", 6.35, 90, 0, kInch},
    {"T4 D=8. CR=0. - ZMIN=-2 - counter sink", 4, "V", 8.0, 90},
    {"T5 D=5. CR=0. TAPER=118DEG - ZMIN=-9 - drill", 5, "drill", 5.0, 118},
    // CamBam, CopperCAM
    {"T3 : 0.125", 3, "square", 3.175, 0, 0, kInch},
    {"Tool #3 \"0.8mm corn\" / Diameter 0.8 mm", 3, "square", 0.8},
    {"Tool #5 \"0.3mm30degree\" / Diameter 3.175 mm", 5, "V", 3.175, 30, 0.3},
    // Estlcam, VCarve and Aspire, Easel, Carbide Motion
    {"HSS, 2-Flute Endmill, 2mm", kNone, "square", 2.0},
    {"1 = End Mill {6 mm}", 1, "square", 6.0},
    {"End Mill (1/4 inch)", kNone, "square", 6.35},
    {"V-Bit (90 deg 1.25\")", kNone, "V", 31.75, 90},
    {"Ball Nose (1/8 inch)", kNone, "ball", 3.175},
    {"Tool: 1/8 in Carbide End Mill", kNone, "square", 3.175},
    {"1-1/4\" spoilboard bit", kNone, "square", 31.75},
    // FreeCAD, pcb2gcode, FlatCAM, gEDA
    {"3mm Endmill001", kNone, "square", 3.0},
    {"Compensated Tool Path. Diameter: 3.0", kNone, "square", 3.0},
    {"Change tool bit to cutter diameter 0.05906in", kNone, "square", 1.500124},
    {"Change tool bit to drill size 0.8000mm", kNone, "drill", 0.8, 118},
    {"Change tool bit to mill diameter 0.15000mm", kNone, "square", 0.15},
    {" Bit sizes: [0.035inch] ", kNone, "square", 0.889},
    {"Tool: 1 -> Dia: 0.8 mm", 1, "square", 0.8},
    {"TOOL DIAMETER: 3.0", kNone, "square", 3.0},
    {"Tool diameter: 0.200000 mm", kNone, "square", 0.2},
    // OpenBuilds, SketchUcam, UGS, Kiri:Moto, Mach3's wizards, others
    {" Tool 4: Flat End Mill 3 Flutes, Diam = 3mm, Len = 15.00mm", 4, "square", 3.0},
    {"Bit diameter: 1/8\"", kNone, "square", 3.175},
    {"Tool: 3.0mm", kNone, "square", 3.0},
    {"Change Tool: Diameter: 1.0000 mm", kNone, "square", 1.0},
    {"change tool to 'end 1/4'", kNone, "square", 6.35},
    {"TOOL 1 - DIA 6.", 1, "square", 6.0},
    {"TOOL: T1 = 10.0 dia. ENDMILLM1000:REG", 1, "square", 10.0},
    {"3MM CRB 2FL 12 LOC", kNone, "square", 3.0},
    {"FREZA D10", kNone, "square", 10.0, 0, 0, 1.0, true},
    {"D26", kNone, "square", 26.0, 0, 0, 1.0, true},
    {" 10. END_MILL_SPHER DIA. 10. ", kNone, "ball", 10.0},
    {"Tools: T04 1/2\" Endmill, Square, 3 Flute, 1.75\" LOC", 4, "square", 12.7},
    {"TOOL #1 0.5 DIA FLAT END MILL 3 FLUTE", 1, "square", 12.7, 0, 0, kInch},
    {"DIA 20.0 END MILL", kNone, "square", 20.0},
    {"TOOL - 1  DIA. OFF. - 41  LEN. - 1  DIA. - .5", 1, "square", 12.7, 0, 0, kInch},
    {" 1/16 FLAT ENDMILL TOOL - 1 DIA. OFF. - 1 LEN. - 1 DIA. - .0625", 1, "square", 1.5875, 0, 0, kInch},
    {" 1/4 DRILL TOOL - 2 DIA. OFF. - 2 LEN. - 2 DIA. - .25", 2, "drill", 6.35, 118, 0, kInch},
    {"6. FLAT ENDMILL TOOL - 3 DIA. OFF. - 3 LEN. - 3 DIA. - 6.", 3, "square", 6.0},
    {"3/8 BALL ENDMILL TOOL - 4 DIA. OFF. - 4 LEN. - 4 DIA. - .375", 4, "ball", 9.525, 0, 0, kInch},
};

TEST(CamComments, OfEachProgramAreUnderstood) {
  for (const Case& c : kTools) {
    CamComments comments;
    const auto tool = comments.read(c.comment, c.scale, c.at_tool_change);
    ASSERT_TRUE(tool) << c.comment;
    EXPECT_EQ(tool->number.value_or(kNone), c.number) << c.comment;
    EXPECT_EQ(name_of(tool->shape), c.shape) << c.comment;
    EXPECT_NEAR(diameter_of(tool->shape), c.diameter, 1e-9) << c.comment;
    if (const auto* v = std::get_if<shape::Vee>(&tool->shape)) {
      EXPECT_NEAR(v->included_angle.deg(), c.angle, 1e-9) << c.comment;
      EXPECT_NEAR(v->tip_diameter.mm(), c.tip, 1e-9) << c.comment;
    }
    if (const auto* drill = std::get_if<shape::Drill>(&tool->shape)) {
      EXPECT_NEAR(drill->point_angle.deg(), c.angle, 1e-9) << c.comment;
    }
  }
}

TEST(CamComments, CommentsAboutOtherThingsAreNoTools) {
  for (const std::string comment :
       {"Workpiece is assumed to be the 120mm x 120mm enclosure, 3mm thick polycarbonate",
        "No. 10: Mill Left Hand Side Button Hole F",
        "next hole is the BOTTOM SIDE, 90 degrees",
        "Drill1",
        "Tool Size",
        "1/4 inch plywood, 4 sheets",
        "Millimeters 10",
        "TOOL CHANGE AT 0.0 0.0 1.5",
        "Toolpath 2: profile 3 mm",
        "Change tool to Cylindrical cutter",
        "drill 4 holes 3 mm",
        "pocket 6mm deep",
        "Pass 3 of 12",
        "2012-09-06 00:25:01",
        "disable tool radius compensation",
        "finish 0.2 mm",
        "",
        "slot 3mm wide",
        "X12 Y30",
        "tool path 3",
        "Drilling depth 9 mm",
        "Line 20"}) {
    CamComments comments;
    EXPECT_FALSE(comments.read(comment, 1.0, false)) << comment;
  }
}

/// Ordinary comments, one per line, none of which describes a tool or a stock.
TEST(CamComments, ProseIsNeitherAToolNorAStock) {
  std::ifstream file(KERF_TEST_DATA "/gcode/comments/prose.txt");
  ASSERT_TRUE(file);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line); ++count)
    for (const bool at_tool_change : {false, true}) {
      CamComments tools;
      const auto tool = tools.read(line, 1.0, at_tool_change);
      EXPECT_FALSE(tool) << line << ": " << (tool ? name_of(tool->shape) : "");
      CamStockComments stock;
      stock.read(line, 1.0);
      EXPECT_FALSE(stock.stock()) << line;
      OwnComments own;
      Diagnostics diagnostics;
      const auto described = own.read(line, {}, diagnostics);
      EXPECT_FALSE(described) << line;
    }
  EXPECT_GE(count, 200u);
}

TEST(CamComments, AProfileThatIsNotGivenIsUnknown) {
  for (const std::string comment :
       {"T4 D=6. CR=0. - ZMIN=-2 - lollipop mill", "T4 D=6. CR=0. - ZMIN=-2 - slot mill",
        "T4 D=6. CR=1. - ZMIN=-2 - radius mill", "T4 D=6. CR=0. - ZMIN=-2 - thread mill",
        "T4 D=2. CR=0. - ZMIN=-2 - probe", "T4 D=6. CR=0. TAPER=30DEG - ZMIN=-2 - dovetail mill",
        "6 mm V-bit", "6 mm thread mill", "1/2\" dovetail bit"}) {
    CamComments comments;
    EXPECT_FALSE(comments.read(comment, 1.0, false)) << comment;
  }
}

TEST(CamComments, SomeAreSpreadOverSeveralComments) {
  CamComments pycam;  // the settings at the head of PyCAM's programs
  for (const std::string line : {"[Tool]", "torus_radius = 0.25", "shape = CylindricalCutter"})
    EXPECT_FALSE(pycam.read(line, 1.0, false));
  const auto mill = pycam.read("tool_radius = 1.5", 1.0, false);
  ASSERT_TRUE(mill);
  EXPECT_EQ(diameter_of(mill->shape), 3.0);
  CamComments ball;
  ball.read("shape = SphericalCutter", 1.0, false);
  EXPECT_EQ(name_of(ball.read("tool_radius = 2", 1.0, false).value().shape), "ball");

  CamComments vectric;
  EXPECT_FALSE(vectric.read("TOOL NUMBER:1", 1.0, false));
  const auto cone = vectric.read("DESCRIPTION:30.0 deg. conical with 0.000 mm tip rad.", 1.0, false);
  ASSERT_TRUE(cone);
  EXPECT_EQ(cone->number, 1);
  EXPECT_EQ(name_of(cone->shape), "V");

  CamComments etching;  // pcb-gcode
  EXPECT_FALSE(etching.read("  Tool Size", kInch, false));
  EXPECT_NEAR(diameter_of(etching.read("0.0030  ", kInch, false).value().shape), 0.0762, 1e-9);
  EXPECT_FALSE(etching.read("0.0030  ", kInch, false));
}

}  // namespace
}  // namespace kerf::gcode

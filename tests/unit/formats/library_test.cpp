// Tool libraries of other programs: each kind's measures, what is skipped, damaged files, and writing and
// reading.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/tools.h"
#include "codec/zip/zip.h"
#include "formats/tool_libraries.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

struct Read {
  ToolTable table;
  Diagnostics diagnostics;
  explicit Read(std::string_view bytes, ToolLibraryOptions options = {}) {
    read_tool_library(bytes, "lib", options, table, diagnostics);
  }
  bool says(Code code) const {
    for (const Diagnostic& d : diagnostics.list())
      if (d.code == code) return true;
    return false;
  }
  std::string shape(int number) const {
    const Tool* tool = table.find(number);
    return tool == nullptr ? "none" : std::string(name_of(tool->shape));
  }
};

TEST(ToolLibrary, LinuxCncTable) {
  const Read read(";a comment\nT1 P17 Z0 D0.25 I45 J45 Q0 ;quarter inch\nt20 p2 d.125\nT3 P3 Z1\n",
                  {25.4, 1});
  EXPECT_EQ(library_kind_of("T1 P1 D1\n"), ToolLibraryKind::linuxcnc);
  ASSERT_EQ(read.table.tools().size(), 2u);
  EXPECT_DOUBLE_EQ(read.table.find(1)->diameter.mm(), 6.35);
  EXPECT_EQ(read.table.find(1)->description, "quarter inch");
  EXPECT_DOUBLE_EQ(read.table.find(20)->diameter.mm(), 3.175);
  EXPECT_TRUE(read.says(codes::tool_library_shape));    // T3 has no diameter
  EXPECT_TRUE(read.says(codes::tool_library_assumed));  // its shapes and unit
  EXPECT_TRUE(Read("T1 P1 D3 Qx\n").says(codes::tool_library_value));
}

TEST(ToolLibrary, CarbideCreate) {
  const Read read(
      "number,vendor,model,URL,name,type,diameter,cornerradius,flutelength,shaftdiameter,angle,numflutes,"
      "stickout,coating,metric\n"
      "201,Shop,S-1,,\"1/4\"\" end, up\",end,0.25,0,0.75,0.25,0,3,1,,0\n"
      "5,Shop,V-1,,a V,vee,12.7,0,12,6,90,2,20,,1\n"
      "6,Shop,B-1,,a ball,ball,6,3,20,6,0,2,20,,1\n"
      "6,Shop,B-2,,again,end,6,0.5,20,6,0,2,20,,1\n"
      ",,,,none,saw,6,0.5,20,6,0,2,20,,1\n");
  EXPECT_EQ(read.shape(201), "square");
  EXPECT_DOUBLE_EQ(read.table.find(201)->diameter.mm(), 6.35);
  EXPECT_DOUBLE_EQ(read.table.find(201)->flute.mm(), 19.05);
  EXPECT_EQ(read.table.find(201)->teeth, 3);
  EXPECT_EQ(read.table.find(201)->description, "1/4\" end, up");
  EXPECT_EQ(read.shape(5), "V");
  EXPECT_NEAR(read.table.find(5)->silhouette.cutting.radius_at(3), 3.0, 1e-9);  // 90 degrees in all
  EXPECT_EQ(read.shape(6), "ball");
  EXPECT_EQ(read.shape(1), "bull nose");  // number 6 is taken
  EXPECT_TRUE(read.says(codes::tool_library_number));
  EXPECT_TRUE(read.says(codes::tool_library_shape));  // the saw
}

TEST(ToolLibrary, Fusion) {
  const Read read(R"({"data": [
    {"type": "flat end mill", "unit": "inches", "geometry": {"DC": 0.5, "LCF": 1, "NOF": 4},
     "post-process": {"number": 3}},
    {"type": "ball end mill", "unit": "millimeters", "geometry": {"DC": 6, "LCF": 12},
     "post-process": {"number": 4}},
    {"type": "chamfer mill", "unit": "millimeters",
     "geometry": {"DC": 10, "TA": 45, "tip-diameter": 0, "LCF": 5}, "post-process": {"number": 5}},
    {"type": "drill", "unit": "millimeters", "geometry": {"DC": 3, "SIG": 118, "LCF": 20},
     "post-process": {"number": 6}},
    {"type": "bull nose end mill", "unit": "millimeters", "geometry": {"DC": 6, "RE": 1, "LCF": 12},
     "post-process": {"number": 7}},
    {"type": "holder", "description": "a holder"}, 5, {"type": "flat end mill", "geometry": {"DC": -1}}]})");
  EXPECT_DOUBLE_EQ(read.table.find(3)->diameter.mm(), 12.7);
  EXPECT_EQ(read.table.find(3)->teeth, 4);
  EXPECT_EQ(read.shape(4), "ball");
  EXPECT_EQ(read.shape(5), "V");
  EXPECT_NEAR(read.table.find(5)->silhouette.cutting.radius_at(2), 2.0, 1e-9);
  EXPECT_EQ(read.shape(6), "drill");
  EXPECT_EQ(read.shape(7), "bull nose");
  EXPECT_EQ(read.table.tools().size(), 5u);
  EXPECT_FALSE(read.diagnostics.has_errors());
}

TEST(ToolLibrary, FreeCad) {
  const Read vee(R"({"version": 2, "name": "V60", "shape": "vbit.fcstd", "shape-type": "VBit",
    "parameter": {"Diameter": "10.0000 mm", "CuttingEdgeAngle": "60.00 °", "CuttingEdgeHeight": "8 mm"}})",
                 {1.0, 40});
  EXPECT_EQ(vee.shape(40), "V");
  EXPECT_NEAR(vee.table.find(40)->silhouette.cutting.radius_at(2), 2 * std::tan(std::acos(-1.0) / 6), 1e-9);
  const Read mill(R"({"version": 2, "name": "m", "shape": "endmill.fcstd",
    "parameter": {"Diameter": "1/4 in", "CuttingEdgeHeight": "30.0000 mm", "ShankDiameter": "3.0000 mm"}})");
  EXPECT_EQ(mill.shape(1), "square");
  EXPECT_DOUBLE_EQ(mill.table.find(1)->diameter.mm(), 6.35);
  EXPECT_DOUBLE_EQ(mill.table.find(1)->flute.mm(), 30.0);
}

TEST(ToolLibrary, Camotics) {
  const Read read(R"({"units": "metric", "tools": {
    "1": {"units": "imperial", "shape": "cylindrical", "length": 1, "diameter": 0.25, "description": "q"},
    "2": {"shape": "conical", "length": 10, "diameter": 20},
    "3": {"shape": "ballnose", "length": 10, "diameter": 4},
    "x": {"shape": "spheroid", "length": 10, "diameter": 4}}})");
  EXPECT_DOUBLE_EQ(read.table.find(1)->diameter.mm(), 6.35);
  EXPECT_EQ(read.shape(2), "V");
  EXPECT_NEAR(read.table.find(2)->silhouette.cutting.radius_at(5), 5.0, 1e-9);
  EXPECT_EQ(read.shape(3), "ball");
  EXPECT_TRUE(read.says(codes::tool_library_shape));  // the spheroid
}

TEST(ToolLibrary, OtherFilesAreRefused) {
  for (const char* text : {"", "hello", "{", "{}", "[]", "{\"data\": 5}", "\x00\x01"})
    EXPECT_TRUE(Read(text).says(codes::tool_library_unknown)) << text;
  EXPECT_TRUE(Read("PK\x03\x04 no zip").says(codes::tool_library_unreadable));
}

std::string zipped(std::string_view content) {
  zip::Writer archive;
  archive.begin("tools.json");
  archive.write(content);
  archive.end();
  return archive.finish();
}

TEST(ToolLibrary, AZippedFusionLibrary) {
  const Read read(zipped(R"({"data": [{"type": "flat end mill", "unit": "millimeters",
    "geometry": {"DC": 6, "LCF": 12}, "post-process": {"number": 3}}]})"));
  EXPECT_EQ(read.shape(3), "square");
  std::string cut = zipped("{}");
  cut.resize(cut.size() - 30);
  EXPECT_TRUE(Read(cut).says(codes::tool_library_unreadable));
}

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

void expect_same(const Profile& a, const Profile& b, int number, double within = 1e-9) {
  ASSERT_EQ(a.knots.size(), b.knots.size()) << number;
  for (std::size_t i = 0; i < a.knots.size(); ++i) {
    EXPECT_NEAR(a.knots[i].r, b.knots[i].r, within) << number;
    EXPECT_NEAR(a.knots[i].z, b.knots[i].z, within) << number;
    EXPECT_NEAR(a.knots[i].bulge, b.knots[i].bulge, within) << number;
  }
}

TEST(ToolLibrary, TheToolFileReadsBackAsTheSameTools) {
  const std::string text = write_tool_file(built_in_tools());
  ToolTable again;
  Diagnostics diagnostics;
  read_tool_file(text, "again", again, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
  ASSERT_EQ(again.tools().size(), built_in_tools().tools().size());
  for (const auto& [number, tool] : built_in_tools().tools()) {
    const Tool* read = again.find(number);
    ASSERT_NE(read, nullptr) << number;
    EXPECT_EQ(sorted(read->names), sorted(tool.names));
    EXPECT_EQ(read->plunges, tool.plunges);
    EXPECT_EQ(read->teeth, tool.teeth);
    for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
      expect_same(read->silhouette.part(part), tool.silhouette.part(part), number);
  }
}

TEST(ToolLibrary, LinuxCncTableOut) {
  const Read read("T7 P1 D6.35 ;mine\n");
  Diagnostics diagnostics;
  EXPECT_EQ(write_linuxcnc_table(read.table, 25.4, diagnostics),
            "T7 P1 Z0 D0.25 ;square, diameter 6.35 mm / mine\n");
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(ToolLibrary, LinuxCncTableOutAndInAreTheSameTools) {
  for (const double unit_mm : {1.0, 25.4}) {
    Diagnostics diagnostics;
    ToolTable again;
    const std::string text = write_linuxcnc_table(built_in_tools(), unit_mm, diagnostics);
    read_tool_library(text, "tool.tbl", {.unit_mm = unit_mm}, again, diagnostics);
    for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
    for (const auto& [number, tool] : built_in_tools().tools()) {
      const Tool* read = again.find(number);
      ASSERT_NE(read, nullptr) << number;
      EXPECT_EQ(name_of(read->shape), name_of(tool.shape)) << number;
      EXPECT_EQ(read->description, tool.description) << number;
      EXPECT_EQ(read->plunges, tool.plunges) << number;
      EXPECT_EQ(read->teeth, tool.teeth) << number;
      for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
        expect_same(read->silhouette.part(part), tool.silhouette.part(part), number, 2e-6);
    }
  }
}

TEST(ToolLibrary, ALineThatIsTooLongIsNamed) {
  Diagnostics diagnostics;
  ToolTable table;
  table.set(3, read_tool_option("square d=6 description=" + std::string(400, 'x'), {}, diagnostics).value());
  const std::string text = write_linuxcnc_table(table, 1.0, diagnostics);
  EXPECT_LE(text.size(), 251u);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::tool_not_written);
}

TEST(ToolLibrary, ADiameterThatContradictsItsCommentIsAWarning) {
  const Read read("T7 P1 D5 ;ball, diameter 6 mm\n");
  EXPECT_NEAR(read.table.find(7)->diameter.mm(), 5.0, 1e-12);
  ASSERT_FALSE(read.diagnostics.list().empty());
  EXPECT_EQ(read.diagnostics.list()[0].code, codes::tool_library_value);
}

}  // namespace
}  // namespace kerf

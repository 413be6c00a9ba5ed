// Drawings as DXF and SVG: the content of the files.
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <sstream>

#include "kerf/drawing/drawing_files.h"
#include "kerf/drawing/dxf.h"

namespace kerf {
namespace {

Drawing sample() {
  Drawing drawing;
  drawing.layers = {{"cut <1>", 1, {255, 0, 16}, 0.5, LineKind::dashed}};
  drawing.title = "a & b";
  drawing.entities = {{0, drawing::Line{0, 0, 10, 5}},
                      {0, drawing::Arc{0, 0, 10, 350, 100}},
                      {0, drawing::Circle{1, 2, 3}},
                      {0, drawing::Polyline{{{0, 0, 1}, {10, 0, 0}, {10, 5, 0}}, true}},
                      {0, drawing::Text{1, 1, 2, "<hi>"}}};
  return drawing;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Drawing, BoundsFollowArcsAndBulges) {
  const auto b = drawing_bounds(sample());
  EXPECT_DOUBLE_EQ(b[0], -2.0);
  EXPECT_NEAR(b[1], -5.0, 1e-12);  // a bulge of 1 is half a circle, to the right of its chord
  EXPECT_NEAR(b[2], 10.0, 1e-12);
  EXPECT_NEAR(b[3], 10.0, 1e-12);
  Drawing arc = sample();
  arc.entities = {{0, drawing::Arc{0, 0, 10, 350, 100}}};
  const auto of_arc = drawing_bounds(arc);
  EXPECT_NEAR(of_arc[0], 10 * std::cos(100 * 3.14159265358979 / 180), 1e-9);
  EXPECT_NEAR(of_arc[1], 10 * std::sin(350 * 3.14159265358979 / 180), 1e-9);
  EXPECT_NEAR(of_arc[2], 10.0, 1e-9);
  EXPECT_NEAR(of_arc[3], 10.0, 1e-9);
  EXPECT_EQ(drawing_bounds(Drawing{}), (std::array<double, 4>{0, 0, 0, 0}));
}

TEST(Drawing, DxfIsCompleteAndKeepsArcs) {
  const std::string dxf = write_dxf(sample());
  for (const char* part :
       {"AC1015", "$INSUNITS", "AcDbPolyline", "AcDbArc", "*Model_Space", "cut _1_", "DASHED"})
    EXPECT_NE(dxf.find(part), std::string::npos) << part;
  EXPECT_EQ(count(dxf, "\nSECTION\n"), 6u);
  EXPECT_EQ(count(dxf, "\nENDSEC\n"), 6u);
  EXPECT_EQ(dxf.substr(dxf.size() - 4), "EOF\n");
  EXPECT_NE(dxf.find(" 42\n1\n"), std::string::npos);  // the bulge
}

TEST(Drawing, R12HasNeitherSubclassesNorLightPolylines) {
  const std::string dxf = write_dxf(sample(), DxfVersion::r12);
  for (const char* part : {"AC1009", "\nPOLYLINE\n", "\nSEQEND\n", "CUT__1_", "$INSUNITS"})
    EXPECT_NE(dxf.find(part), std::string::npos) << part;
  for (const char* part : {"AcDb", "LWPOLYLINE", "OBJECTS", "CLASSES", "BLOCK_RECORD"})
    EXPECT_EQ(dxf.find(part), std::string::npos) << part;
  EXPECT_EQ(count(dxf, "\nVERTEX\n"), 3u);
}

TEST(Drawing, DxfEscapesNonAsciiLetters) {
  Drawing drawing;
  drawing.layers = {{"N\xC3\xA4he \xE2\x82\xAC", 1, {}, 0.5, LineKind::solid}};
  drawing.entities = {{0, drawing::Text{0, 0, 2, "\xC3\xA9 \xFF \xC3"}}};
  const std::string dxf = write_dxf(drawing);
  EXPECT_NE(dxf.find("N\\U+00E4he \\U+20AC\n"), std::string::npos);
  EXPECT_NE(dxf.find("\\U+00E9 ? ?\n"), std::string::npos);
  for (const char c : dxf) ASSERT_LT(static_cast<unsigned char>(c), 0x80);
}

TEST(Drawing, LayersWhoseNamesBecomeAlikeAreOne) {
  Drawing drawing;
  drawing.layers = {{"a<b", 1, {}, 0.5, LineKind::solid}, {"a>b", 2, {}, 0.5, LineKind::solid}};
  drawing.entities = {{1, drawing::Line{0, 0, 1, 1}}};
  EXPECT_EQ(count(write_dxf(drawing), "AcDbLayerTableRecord"), 2u);  // that and "0"
}

TEST(Drawing, ColoursOfIndices) {
  using Rgb = std::array<std::uint8_t, 3>;
  EXPECT_EQ(colour_of_index(1), (Rgb{255, 0, 0}));
  EXPECT_EQ(colour_of_index(7), (Rgb{0, 0, 0}));
  EXPECT_EQ(colour_of_index(10), (Rgb{255, 0, 0}));
  EXPECT_EQ(colour_of_index(11), (Rgb{255, 128, 128}));
  EXPECT_EQ(colour_of_index(30), (Rgb{255, 128, 0}));
  EXPECT_EQ(colour_of_index(170), (Rgb{0, 0, 255}));
  EXPECT_EQ(colour_of_index(94), (Rgb{0, 128, 0}));
  EXPECT_EQ(colour_of_index(255), (Rgb{255, 255, 255}));
  EXPECT_EQ(colour_of_index(-1), colour_of_index(256));
}

TEST(Drawing, SvgHasItsSizeInMillimetresAndYUp) {
  const std::string svg = write_svg(sample());
  EXPECT_NE(svg.find("mm\""), std::string::npos);
  EXPECT_NE(svg.find("M0,0 L10,-5"), std::string::npos) << svg;
  EXPECT_NE(svg.find("&lt;hi&gt;"), std::string::npos);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("#ff0010"), std::string::npos);
  EXPECT_NE(svg.find("A5,5 0 0 0 10,0"), std::string::npos) << svg;
}

TEST(Drawing, AnglesOfArcsAreWrittenFrom0To360) {
  Drawing drawing;
  drawing.layers = {{"0", 7, {}, 0.5, LineKind::solid}};
  for (const auto& [given, written] : {std::pair(-90.0, "270"), std::pair(-725.0, "355"),
                                       std::pair(450.0, "90"), std::pair(359.5, "359.5")}) {
    drawing.entities = {{0, drawing::Arc{0, 0, 10, given, given + 45.0}}};
    const std::string dxf = write_dxf(drawing);
    EXPECT_EQ(count(dxf, std::string("\n 50\n") + written + "\n"), 1u) << given;
  }
  drawing.entities = {{0, drawing::Arc{0, 0, 10, 10.0, -45.0}}};
  EXPECT_EQ(count(write_dxf(drawing), "\n 51\n315\n"), 1u);
}

TEST(Drawing, SvgArcsOfMoreThanHalfACircleAreTheLargeOnes) {
  Drawing drawing;
  drawing.layers = {{"0", 7, {}, 0.5, LineKind::solid}};
  for (const auto& [end, large] : {std::pair(90.0, "0"), std::pair(200.0, "1"), std::pair(359.0, "1")}) {
    drawing.entities = {{0, drawing::Arc{0, 0, 10, 0, end}}};
    const std::string svg = write_svg(drawing);
    const std::size_t arc = svg.find('A', svg.find(" d=\""));
    ASSERT_NE(arc, std::string::npos) << svg;
    std::string text = svg.substr(arc + 1, 40);
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream words(text);
    std::string rx, ry, rotation, flag;
    words >> rx >> ry >> rotation >> flag;
    EXPECT_EQ(flag, large) << end << ": " << text;
  }
}

/// The arbitrary axis algorithm of the DXF reference: the X axis of an extrusion direction within 1/64 of Z
/// is at right angles to Y, of any other to Z.
TEST(Dxf, AxesOfAnExtrusionDirectionChangeNearZ) {
  const auto x_axis = [](double nx, double ny) {
    const dxf::Matrix m = dxf::object_axes({nx, ny, std::sqrt(1.0 - nx * nx - ny * ny)});
    return std::array<double, 3>{m.m[0][0], m.m[1][0], m.m[2][0]};
  };
  const double inside = 0.0156, outside = 0.0157;  // 1/64 is 0.015625
  struct Case {
    double nx, ny;
    std::array<double, 3> x;  // Y x N or Z x N, as a unit vector
  };
  const double along = std::sqrt(1.0 - inside * inside);
  for (const Case& c : {Case{inside, 0, {along, 0, -inside}}, Case{-inside, 0, {along, 0, inside}},
                        Case{0, inside, {1, 0, 0}}, Case{0, -inside, {1, 0, 0}}, Case{outside, 0, {0, 1, 0}},
                        Case{-outside, 0, {0, -1, 0}}, Case{0, outside, {-1, 0, 0}},
                        Case{0, -outside, {1, 0, 0}}, Case{0, 0, {1, 0, 0}}}) {
    const auto x = x_axis(c.nx, c.ny);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], c.x[i], 1e-12) << c.nx << ' ' << c.ny << ' ' << i;
  }
}

}  // namespace
}  // namespace kerf

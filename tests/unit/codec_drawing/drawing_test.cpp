// Drawings as DXF and SVG: what stands in the files.
#include <cmath>
#include <gtest/gtest.h>

#include "kerf/drawing_files.h"

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
  EXPECT_NEAR(b[0], 10 * std::cos(100 * 3.14159265358979 / 180), 1.8);  // -2 of the circle is further left
  EXPECT_DOUBLE_EQ(b[0], -2.0);
  EXPECT_NEAR(b[1], -5.0, 1e-12);  // a bulge of 1 is half a circle, to the right of its chord
  EXPECT_NEAR(b[2], 10.0, 1e-12);
  EXPECT_NEAR(b[3], 10.0, 1e-12);
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

TEST(Drawing, SvgHasItsSizeInMillimetresAndYUp) {
  const std::string svg = write_svg(sample());
  EXPECT_NE(svg.find("mm\""), std::string::npos);
  EXPECT_NE(svg.find("M0,0 L10,-5"), std::string::npos) << svg;
  EXPECT_NE(svg.find("&lt;hi&gt;"), std::string::npos);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("#ff0010"), std::string::npos);
  EXPECT_NE(svg.find("A5,5 0 0 0 10,0"), std::string::npos) << svg;
}

}  // namespace
}  // namespace kerf

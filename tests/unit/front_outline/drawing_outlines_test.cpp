// Outlines from drawings: units, layers, shapes, blocks, and what is reported.
#include "kerf/drawing/drawing_outlines.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/outline.h"

#include "kerf/geom/fit.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

/// A drawing of the given sections in the unit of $INSUNITS `unit`; 4 is mm.
std::string file_of(const std::string& entities, const std::string& blocks = "", int unit = 4) {
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n";
  if (unit >= 0) text += "9\n$INSUNITS\n70\n" + std::to_string(unit) + "\n";
  text +=
      "0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nCUT\n70\n0\n62\n1\n6\nCONTINUOUS\n"
      "0\nLAYER\n2\nOFF\n70\n0\n62\n-3\n6\nCONTINUOUS\n0\nENDTAB\n0\nENDSEC\n";
  if (!blocks.empty()) text += "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n";
  return text + "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
}

std::string entity(const std::string& type, const std::vector<std::pair<int, double>>& tags,
                   const std::string& layer = "CUT") {
  std::string text = "0\n" + type + "\n8\n" + layer + "\n";
  for (const auto& [group, value] : tags) text += std::to_string(group) + "\n" + std::to_string(value) + "\n";
  return text;
}
std::string line(double x1, double y1, double x2, double y2, const std::string& layer = "CUT") {
  return entity("LINE", {{10, x1}, {20, y1}, {11, x2}, {21, y2}}, layer);
}
const std::string kSquare = entity(
    "LWPOLYLINE", {{70, 1}, {10, 0}, {20, 0}, {10, 20}, {20, 0}, {10, 20}, {20, 10}, {10, 0}, {20, 10}});

struct Drawn {
  std::optional<DrawingOutlines> made;
  Diagnostics diagnostics;
  bool has(Code code) const {
    return std::any_of(diagnostics.list().begin(), diagnostics.list().end(),
                       [&](const Diagnostic& d) { return d.code == code; });
  }
  const Outline& outline(std::size_t i = 0) const { return made->outlines.at(i).outline; }
};

Drawn draw(const std::string& text, DrawingOutlineOptions options = {}) {
  Drawn drawn;
  const auto drawing = dxf::read_dxf(text, "test.dxf", drawn.diagnostics);
  if (drawing) drawn.made = drawn_outlines(*drawing, options, drawn.diagnostics);
  return drawn;
}

TEST(DrawingOutlines, TheUnitIsThatOfTheDrawingOrRequired) {
  EXPECT_NEAR(draw(file_of(kSquare, "", 1)).made->unit.mm(), 25.4, 0);
  EXPECT_NEAR(area(draw(file_of(kSquare, "", 5)).outline()), 200.0 * 100.0, 1e-9);  // cm
  for (const int unit : {-1, 0, 99}) {
    const Drawn missing = draw(file_of(kSquare, "", unit));
    EXPECT_FALSE(missing.made);
    EXPECT_TRUE(missing.has(codes::drawing_unit));
    EXPECT_NE(missing.diagnostics.list().back().hint.find("--unit inch"), std::string::npos);
    DrawingOutlineOptions inches;
    inches.unit = mm(25.4);
    const Drawn asked = draw(file_of(kSquare, "", unit), inches);
    EXPECT_NEAR(bounds(asked.outline()).high.x, 508.0, 1e-9);
    EXPECT_TRUE(asked.diagnostics.list().empty());
  }
  DrawingOutlineOptions inches;
  inches.unit = mm(25.4);
  const Drawn other = draw(file_of(kSquare), inches);
  EXPECT_TRUE(other.made && other.has(codes::drawing_unit) && !other.diagnostics.has_errors());
}

TEST(DrawingOutlines, LayersAreChosenByNameOrByBeingVisible) {
  const std::string text = file_of(kSquare + line(0, 0, 1, 0, "OFF") + line(50, 0, 51, 0, "other"));
  const Drawn visible = draw(text);
  ASSERT_EQ(visible.made->outlines.size(), 2u);
  EXPECT_EQ(visible.made->outlines[0].name, "CUT.1");
  EXPECT_EQ(visible.made->outlines[1].layer, "other");
  EXPECT_TRUE(visible.has(codes::drawing_hidden));
  DrawingOutlineOptions options;
  options.layers = {"off"};
  EXPECT_EQ(draw(text, options).made->outlines.at(0).name, "OFF.1");
  options.layers = {"CUTS"};
  const Drawn unknown = draw(text, options);
  EXPECT_FALSE(unknown.made);
  EXPECT_TRUE(unknown.has(codes::drawing_layer));
  EXPECT_NE(unknown.diagnostics.list().back().hint.find("CUT"), std::string::npos);
  options.layers = {"0"};
  EXPECT_TRUE(draw(text, options).has(codes::drawing_empty));
}

TEST(DrawingOutlines, EntitiesAreJoinedWithinTheirLayer) {
  const Drawn drawn = draw(file_of(line(0, 0, 10, 0) + line(10, 10, 10, 0) + line(10, 10, 0, 0) +
                                   line(10, 10, 20, 10, "0") + entity("POINT", {{10, 5}, {20, 6}})));
  ASSERT_EQ(drawn.made->outlines.size(), 2u);
  EXPECT_EQ(drawn.made->outlines[0].layer, "0");  // in the order of the table
  EXPECT_TRUE(drawn.outline(1).closed());
  EXPECT_NEAR(area(drawn.outline(1)), 50.0, 1e-12);
  ASSERT_EQ(drawn.made->points.size(), 1u);
  EXPECT_EQ(drawn.made->points[0].at, (Point2{5, 6}));
  EXPECT_EQ(drawn.made->open_ends.size(), 2u);
  EXPECT_FALSE(drawn.has(codes::drawing_junction));
}

TEST(DrawingOutlines, OpenEndsJunctionsAndRepeatedEntitiesAreReported) {
  const Drawn drawn =
      draw(file_of(line(0, 0, 10, 0) + line(10.05, 0, 20, 0) + line(5, 0, 5, 7) + line(5, 7, 5, 0)));
  ASSERT_EQ(drawn.made->open_ends.size(), 5u);
  EXPECT_NEAR(drawn.made->open_ends[1].distance.mm(), 0.05, 1e-9);
  bool found = false;
  for (const Diagnostic& d : drawn.diagnostics.list())
    found = found ||
            (d.code == codes::drawing_open_end && d.message.find("10, 0; the nearest") != std::string::npos &&
             d.message.find("0.05 mm away") != std::string::npos && !d.hint.empty());
  EXPECT_TRUE(found);
  ASSERT_EQ(drawn.made->junctions.size(), 1u);
  EXPECT_EQ(drawn.made->junctions[0].at, (Point2{5, 0}));
  EXPECT_TRUE(drawn.has(codes::drawing_junction) && drawn.has(codes::drawing_repeated));
  DrawingOutlineOptions wide;
  wide.join = mm(0.1);
  EXPECT_EQ(draw(file_of(line(0, 0, 10, 0) + line(10.05, 0, 20, 0)), wide).made->outlines.size(), 1u);
}

TEST(DrawingOutlines, CirclesAndArcsStayWhatTheyAre) {
  const Drawn circle = draw(file_of(entity("CIRCLE", {{10, 3}, {20, 4}, {40, 2}})));
  EXPECT_EQ(circle.made->outlines[0].circle, (Circle{{3, 4}, mm(2)}));
  EXPECT_NEAR(area(circle.outline()), 4 * kPi, 1e-12);
  const Drawn arc = draw(file_of(entity("ARC", {{10, 3}, {20, 4}, {40, 2}, {50, 300}, {51, 30}})));
  const auto got = arc_circle(arc.outline().start, arc.outline().segments[0]);
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->sweep.deg(), 90.0, 1e-9);
  EXPECT_NEAR(got->radius, 2.0, 1e-12);
  EXPECT_EQ(got->turn, Turn::ccw);
  // 0 to 360 degrees, exactly or rounded, and two halves of a polyline, are circles.
  for (const double end : {360.0, 0.0, 360.0000001, 359.9999999})
    EXPECT_TRUE(draw(file_of(entity("ARC", {{10, 3}, {20, 4}, {40, 2}, {50, 0}, {51, end}})))
                    .made->outlines[0]
                    .circle)
        << end;
  const Drawn halves =
      draw(file_of(entity("LWPOLYLINE", {{70, 1}, {10, 0}, {20, 0}, {42, -1}, {10, 10}, {20, 0}, {42, -1}})));
  ASSERT_TRUE(halves.made->outlines[0].circle);
  EXPECT_NEAR(halves.made->outlines[0].circle->radius.mm(), 5.0, 1e-12);
  EXPECT_NEAR(area(halves.outline()), -25 * kPi, 1e-9);
  // Seen from below.
  const Drawn flipped =
      draw(file_of(entity("ARC", {{10, 3}, {20, 4}, {40, 2}, {50, 0}, {51, 90}, {230, -1}})));
  EXPECT_NEAR(flipped.outline().start.x, -5.0, 1e-12);
  EXPECT_EQ(arc_circle(flipped.outline().start, flipped.outline().segments[0])->turn, Turn::cw);
}

TEST(DrawingOutlines, EllipsesAndSplinesBecomeArcsWithinTheTolerance) {
  for (const double within : {0.1, 0.001}) {
    DrawingOutlineOptions options;
    options.within = mm(within);
    const Drawn ellipse = draw(
        file_of(entity("ELLIPSE", {{10, 1}, {20, 2}, {11, 30}, {21, 0}, {40, 0.5}, {41, 0}, {42, 6.283185}})),
        options);
    const Outline& outline = ellipse.outline();
    EXPECT_TRUE(outline.closed());
    EXPECT_NEAR(area(outline), 450 * kPi, 150 * within);
    for (const Point2 p : flattened(outline, mm(within / 10))) {
      const double x = (p.x - 1) / 30, y = (p.y - 2) / 15;
      EXPECT_NEAR(std::sqrt(x * x + y * y), 1.0, within / 14);
    }
  }
  // Half of one, flipped: the minor axis points down.
  const Drawn half = draw(file_of(
      entity("ELLIPSE", {{10, 0}, {20, 0}, {11, 4}, {21, 0}, {40, 0.5}, {41, 0}, {42, kPi}, {230, -1}})));
  EXPECT_NEAR(bounds(half.outline()).low.y, -2.0, 0.01);
  EXPECT_NEAR(bounds(half.outline()).high.y, 0.0, 1e-5);

  std::vector<std::pair<int, double>> tags{{70, 8}, {71, 3}};
  for (const double knot : {0, 0, 0, 0, 1, 1, 1, 1}) tags.emplace_back(40, knot);
  for (const Point2 p : {Point2{0, 0}, Point2{0, 10}, Point2{20, 10}, Point2{20, 0}})
    tags.insert(tags.end(), {{10, p.x}, {20, p.y}});
  const Drawn spline = draw(file_of(entity("SPLINE", tags)));
  EXPECT_NEAR(bounds(spline.outline()).high.y, 7.5, 0.01);
  const Drawn fit = draw(
      file_of(entity("SPLINE", {{70, 0}, {71, 3}, {11, 0}, {21, 0}, {11, 5}, {21, 5}, {11, 10}, {21, 0}})));
  EXPECT_NEAR(bounds(fit.outline()).high.y, 5.0, 0.01);
  const Drawn bad =
      draw(file_of(entity("SPLINE", {{70, 0}, {71, 3}, {11, 1}, {21, 1}, {11, 1}, {21, 1}}) + kSquare));
  EXPECT_TRUE(bad.made && bad.has(codes::curve_malformed));
}

TEST(DrawingOutlines, BlocksAreInsertedAndStretched) {
  const std::string blocks =
      "0\nBLOCK\n8\n0\n2\nB\n10\n0\n20\n0\n" + entity("CIRCLE", {{10, 0}, {20, 0}, {40, 1}}, "0") +
      entity("LWPOLYLINE", {{70, 1}, {10, 5}, {20, 0}, {42, 1}, {10, 7}, {20, 0}, {42, 1}}, "0") +
      "0\nENDBLK\n";
  const auto insert = [&](double sx, double sy) {
    return "0\nINSERT\n8\nCUT\n2\nB\n10\n100\n20\n0\n41\n" + std::to_string(sx) + "\n42\n" +
           std::to_string(sy) + "\n";
  };
  const Drawn mirrored = draw(file_of(insert(-3, 3), blocks));
  ASSERT_EQ(mirrored.made->outlines.size(), 2u);
  EXPECT_EQ(mirrored.made->outlines[0].layer, "CUT");
  ASSERT_TRUE(mirrored.made->outlines[0].circle && mirrored.made->outlines[1].circle);
  EXPECT_NEAR(mirrored.made->outlines[1].circle->centre.x, 82.0, 1e-9);
  EXPECT_NEAR(mirrored.made->outlines[1].circle->radius.mm(), 3.0, 1e-9);
  const Drawn stretched = draw(file_of(insert(2, 1), blocks));
  ASSERT_EQ(stretched.made->outlines.size(), 2u);
  for (const DrawnOutline& o : stretched.made->outlines) {
    EXPECT_FALSE(o.circle);
    EXPECT_TRUE(o.outline.closed());
    EXPECT_NEAR(area(o.outline), 2 * kPi, 0.03);
  }
  EXPECT_NEAR(bounds(stretched.outline(1)).low.x, 110.0, 0.01);
}

/// Layer 0 of a block is that of its insert (AutoCAD's rule); entities on other layers keep theirs.
TEST(DrawingOutlines, EntitiesOfBlocksKeepTheirLayers) {
  const std::string blocks = "0\nBLOCK\n8\n0\n2\nB\n10\n0\n20\n0\n" +
                             entity("CIRCLE", {{10, 0}, {20, 0}, {40, 1}}, "0") +
                             entity("CIRCLE", {{10, 9}, {20, 0}, {40, 2}}, "CUT") + "0\nENDBLK\n";
  const Drawn drawn = draw(file_of("0\nINSERT\n8\nDRILL\n2\nB\n10\n0\n20\n0\n", blocks));
  ASSERT_TRUE(drawn.made);
  ASSERT_EQ(drawn.made->outlines.size(), 2u);
  for (const DrawnOutline& o : drawn.made->outlines) {
    ASSERT_TRUE(o.circle);
    EXPECT_EQ(o.layer, o.circle->radius.mm() < 1.5 ? "DRILL" : "CUT");
  }
}

TEST(DrawingOutlines, TiltedFarAndOtherEntities) {
  const Drawn tilted = draw(file_of(entity("LINE", {{10, 0}, {20, 0}, {30, 5}, {11, 10}, {21, 0}, {31, 0}})));
  EXPECT_TRUE(tilted.made && tilted.has(codes::drawing_tilted));
  EXPECT_FALSE(draw(file_of(entity("LINE", {{10, 0}, {20, 0}, {30, 5}, {11, 10}, {21, 0}, {31, 5}})))
                   .has(codes::drawing_tilted));
  EXPECT_TRUE(draw(file_of(entity("CIRCLE", {{10, 0}, {20, 0}, {40, 5}, {210, 1}, {220, 0}, {230, 1}})))
                  .has(codes::drawing_tilted));
  EXPECT_TRUE(draw(file_of(line(0, 0, 1e8, 0))).has(codes::drawing_far));
  EXPECT_TRUE(draw(file_of(entity("ELLIPSE", {{10, 0}, {20, 0}, {11, 1e9}, {21, 0}, {40, 0.5}})))
                  .has(codes::drawing_far));
  const Drawn others =
      draw(file_of(kSquare + entity("HATCH", {}) + entity("3DSOLID", {}) + entity("HATCH", {})));
  EXPECT_TRUE(others.has(codes::drawing_ignored));
  const auto reported = [&](std::string_view words) {
    return std::any_of(others.diagnostics.list().begin(), others.diagnostics.list().end(),
                       [&](const Diagnostic& d) { return d.message.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(reported("1 3DSOLID is not read as an outline"));
  EXPECT_TRUE(reported("2 HATCH are not read as outlines; the first is HATCH"));
  DrawingOutlineOptions few;
  few.max_segments = 3;
  EXPECT_TRUE(draw(file_of(kSquare + kSquare), few).has(codes::drawing_limit));
}

TEST(DrawingOutlines, TheRegionOfClosedOutlines) {
  const Drawn part = draw(file_of(kSquare + entity("CIRCLE", {{10, 10}, {20, 5}, {40, 2}})));
  Diagnostics diagnostics;
  const auto region = drawn_region(*part.made, Combining::drawn, {}, diagnostics);
  ASSERT_TRUE(region);
  EXPECT_NEAR(area(*region), 200 - 4 * kPi, 1e-9);
  const Drawn open = draw(file_of(kSquare + line(50, 0, 60, 0)));
  const auto rest = drawn_region(*open.made, Combining::drawn, {}, diagnostics);
  ASSERT_TRUE(rest && diagnostics.list().size() == 1 && !diagnostics.has_errors());
  EXPECT_NEAR(area(*rest), 200.0, 1e-9);
  EXPECT_EQ(diagnostics.list().back().code, codes::region_open_outline);
  EXPECT_FALSE(drawn_region(*draw(file_of(line(50, 0, 60, 0))).made, Combining::drawn, {}, diagnostics));
  EXPECT_TRUE(diagnostics.has_errors());
}

/// A hatch of a rectangle 40 x 20, an island of two half circles of radius 4, and an island of a line, an arc
/// of an ellipse with axes 6 and 3, and a spline that is a parabola over 12 with a height of 2.
std::string hatch() {
  std::string text = "0\nHATCH\n8\nCUT\n10\n0\n20\n0\n30\n0\n2\nSOLID\n70\n1\n71\n0\n91\n3\n";
  const auto add = [&](std::initializer_list<std::pair<int, double>> tags) {
    for (const auto& [group, value] : tags)
      text += std::to_string(group) + "\n" + std::to_string(value) + "\n";
  };
  add({{92, 3},
       {72, 0},
       {73, 1},
       {93, 4},
       {10, 0},
       {20, 0},
       {10, 40},
       {20, 0},
       {10, 40},
       {20, 20},
       {10, 0},
       {20, 20}});
  add({{97, 0}, {92, 16}, {93, 2}, {72, 2}, {10, 10}, {20, 10}, {40, 4}, {50, 0}, {51, 180}, {73, 1}});
  add({{72, 2}, {10, 10}, {20, 10}, {40, 4}, {50, 0}, {51, 180}, {73, 0}, {97, 0}});  // clockwise: the lower
                                                                                      // half
  add({{92, 16},
       {93, 2},
       {72, 3},
       {10, 30},
       {20, 10},
       {11, 6},
       {21, 0},
       {40, 0.5},
       {50, 0},
       {51, 180},
       {73, 1}});
  add({{72, 4}, {94, 2}, {73, 0}, {74, 0}, {95, 6}, {96, 3}});
  add({{40, 0},
       {40, 0},
       {40, 0},
       {40, 1},
       {40, 1},
       {40, 1},
       {10, 24},
       {20, 10},
       {10, 30},
       {20, 6},
       {10, 36},
       {20, 10}});
  add({{97, 0}, {75, 0}, {76, 1}, {98, 1}, {10, 1}, {20, 1}});
  return text;
}

TEST(DrawingOutlines, HatchesAreFilledAreasWithIslands) {
  const double islands = 16 * kPi + 0.5 * 18 * kPi + 2.0 / 3.0 * 12 * 2;
  DrawingOutlineOptions fine;
  fine.within = mm(1e-4);
  for (const bool with_boundary : {false, true}) {
    const std::string boundary = entity(
        "LWPOLYLINE", {{70, 1}, {10, 0}, {20, 0}, {10, 40}, {20, 0}, {10, 40}, {20, 20}, {10, 0}, {20, 20}});
    const Drawn drawn = draw(file_of((with_boundary ? boundary : "") + hatch()), fine);
    ASSERT_TRUE(drawn.made);
    EXPECT_TRUE(drawn.diagnostics.list().empty());
    ASSERT_EQ(drawn.made->outlines.size(), 3u);
    Diagnostics diagnostics;
    const auto region = drawn_region(*drawn.made, Combining::drawn, {}, diagnostics);
    ASSERT_TRUE(region);
    EXPECT_NEAR(area(*region), 800 - islands, 0.01);
  }
  // In a block that is inserted twice, each is a figure of its own.
  const std::string blocks = "0\nBLOCK\n8\n0\n2\nB\n10\n0\n20\n0\n" + hatch() + "0\nENDBLK\n";
  const auto insert = [](double x) { return entity("INSERT", {{10, x}, {20, 0}}) + "2\nB\n"; };
  const Drawn two = draw(file_of(insert(0) + insert(100), blocks), fine);
  ASSERT_TRUE(two.made);
  Diagnostics diagnostics;
  const auto region = drawn_region(*two.made, Combining::drawn, {}, diagnostics);
  ASSERT_TRUE(region);
  EXPECT_NEAR(area(*region), 2 * (800 - islands), 0.02);
}

TEST(DrawingOutlines, LayersAndTheirContent) {
  Diagnostics diagnostics;
  const auto drawing =
      dxf::read_dxf(file_of(kSquare + line(0, 0, 1, 0, "OFF") + line(0, 0, 2, 0, "OFF")), "a", diagnostics);
  const auto contents = layer_contents(*drawing, {}, diagnostics);
  ASSERT_EQ(contents.size(), 3u);
  EXPECT_EQ(contents[1].name, "CUT");
  EXPECT_EQ(contents[1].types, (std::vector<std::pair<std::string, std::size_t>>{{"LWPOLYLINE", 1}}));
  EXPECT_TRUE(contents[2].off);
  EXPECT_EQ(contents[2].entities, 2u);
}

}  // namespace
}  // namespace kerf

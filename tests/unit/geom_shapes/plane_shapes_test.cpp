// Plane shapes: areas by their formulas, closed outlines, refused values.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "kerf/geom/region.h"
#include "kerf/geom/shapes.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

struct ShapeCase {
  const char* name;
  std::vector<double> values;
  double area;  // by the formula of the shape
};

void PrintTo(const ShapeCase& c, std::ostream* out) { *out << c.name; }

class PlaneShapeArea : public testing::TestWithParam<ShapeCase> {};

TEST_P(PlaneShapeArea, IsThatOfTheFormula) {
  const ShapeCase& c = GetParam();
  const PlaneShape* shape = plane_shape(c.name);
  ASSERT_NE(shape, nullptr);
  Diagnostics diagnostics;
  const auto outline = make_plane_shape(*shape, c.values, {}, diagnostics);
  ASSERT_TRUE(outline) << to_string(diagnostics.list().at(0));
  EXPECT_TRUE(outline->closed());
  const auto region = make_region({*outline}, FillRule::nonzero, {}, diagnostics);
  ASSERT_TRUE(region);
  EXPECT_NEAR(area(*region), c.area, 1e-4 * c.area);
}

INSTANTIATE_TEST_SUITE_P(
    All, PlaneShapeArea,
    testing::Values(
        ShapeCase{"circle", {3, 4, 5}, 25 * kPi}, ShapeCase{"ellipse", {0, 0, 20, 10}, 50 * kPi},
        ShapeCase{"egg", {0, 0, 20, 10, 0}, 50 * kPi}, ShapeCase{"superellipse", {0, 0, 20, 10, 2}, 50 * kPi},
        ShapeCase{"superellipse", {0, 0, 20, 10, 1}, 100},  // a rhombus
        ShapeCase{"cone", {0, 0, 10, 20}, 100 + 12.5 * kPi}, ShapeCase{"segment", {0, 0, 10}, 50 * kPi},
        ShapeCase{"arch", {0, 0, 10, 20}, 200 + 12.5 * kPi},
        ShapeCase{"lens", {0, 0, 10, 10}, 100 * (2 * kPi / 3 - std::sqrt(3.0) / 2)},
        ShapeCase{"lune", {0, 0, 10, 10}, 100 * (kPi - 2 * kPi / 3 + std::sqrt(3.0) / 2)},
        ShapeCase{"triangle", {0, 0, 3, 4, 5}, 6}, ShapeCase{"sector", {0, 0, 10}, 25 * kPi},
        ShapeCase{"sector", {0, 0, 10, 60, 30}, 100 * kPi / 6}, ShapeCase{"deltoid", {0, 0, 9}, 2 * kPi * 9},
        ShapeCase{"astroid", {0, 0, 8}, 3.0 / 8 * kPi * 64},
        ShapeCase{"reuleaux", {0, 0, 10}, 50 * (kPi - std::sqrt(3.0))},
        ShapeCase{"arbelos", {0, 0, 10, 0.3}, kPi / 2 * (100 - 9 - 49)},
        ShapeCase{"tomoe", {0, 0, 10}, 50 * kPi}, ShapeCase{"rectangle", {1, 2, 3, 4}, 12},
        ShapeCase{"parallelogram", {0, 0, 10, 5, 3}, 50}, ShapeCase{"rhombus", {0, 0, 10, 4}, 20},
        ShapeCase{"trapezoid", {0, 0, 10, 6, 5}, 40}, ShapeCase{"kite", {0, 0, 10, 4, 8}, 60},
        ShapeCase{"annulus_segment", {0, 0, 10, 5, 0, 90}, 75 * kPi / 4},
        ShapeCase{"salinon", {0, 0, 10, 4}, kPi * 49}));  // of Archimedes: a circle over both radii

TEST(PlaneShapes, AreAllClosedAndTurnToTheLeftOrRight) {
  for (const PlaneShape& shape : plane_shapes()) {
    std::vector<double> values;
    for (const ShapeArgument& argument : shape.arguments) {
      const bool second = argument.name == "inner" || argument.name == "start";
      values.push_back(argument.fallback.value_or(argument.name == "end" ? 100 : second ? 3 : 10));
    }
    values[0] = values[1] = 0;
    Diagnostics diagnostics;
    const auto outline = make_plane_shape(shape, values, {}, diagnostics);
    ASSERT_TRUE(outline) << shape.name;
    EXPECT_TRUE(outline->closed()) << shape.name;
    EXPECT_GT(std::abs(area(*outline)), 1.0) << shape.name;
  }
}

TEST(PlaneShapes, RefuseWrongValuesWithTheirNames) {
  const auto message = [](const char* name, const std::vector<double>& values) {
    Diagnostics diagnostics;
    EXPECT_FALSE(make_plane_shape(*plane_shape(name), values, {}, diagnostics)) << name;
    return diagnostics.list().empty() ? std::string() : diagnostics.list()[0].message;
  };
  EXPECT_EQ(message("circle", {0, 0, 0}), "circle: radius must be above 0, not 0");
  EXPECT_EQ(message("circle", {0, 0}), "circle: radius is missing");
  EXPECT_NE(message("circle", {0, 0, NAN}).find("radius must be a number"), std::string::npos);
  EXPECT_NE(message("circle", {0, 0, 1, 2}).find("4 values are given"), std::string::npos);
  EXPECT_EQ(message("triangle", {0, 0, 1, 2, 9}),
            "triangle: a, b, c: 1, 2 and 9 are not the sides of a triangle");
  EXPECT_NE(message("lens", {0, 0, 5, 10}).find("distance must be below"), std::string::npos);
  EXPECT_NE(message("salinon", {0, 0, 5, 5}).find("inner must be below"), std::string::npos);
  EXPECT_NE(message("sector", {0, 0, 5, 0}).find("angle must be above 0"), std::string::npos);
  EXPECT_NE(message("annulus_segment", {0, 0, 5, 2, 90, 30}).find("angle must be"), std::string::npos);
  EXPECT_NE(message("arbelos", {0, 0, 5, 1}).find("at must be"), std::string::npos);
}

TEST(PlaneShapes, ASurfaceInterpolatesItsCornersAndPlanes) {
  BezierSurface surface{{10, 20}, 30, 60, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) surface.heights[row][column] = 3 * column - row;
  // Evenly spaced control points of a plane give that plane: 9 mm over 30 mm of X, -3 over 60 of Y.
  EXPECT_NEAR(surface.at({25, 50}), 4.5 - 1.5, 1e-12);
  EXPECT_NEAR(surface.at({40, 80}), 6, 1e-12);
  EXPECT_NEAR(surface.at({99, 999}), 6, 1e-12) << "the edge continues";
}

TEST(PlaneShapes, SimpleOnesAreCalledDirectly) {
  Diagnostics diagnostics;
  const auto area_of = [&](const Outline& outline) {
    const auto region = make_region({outline}, FillRule::positive, {}, diagnostics);
    return region ? area(*region) : -1.0;
  };
  EXPECT_NEAR(area_of(circle({3, 4}, mm(2))), 4 * 3.14159265358979, 1e-9);
  EXPECT_DOUBLE_EQ(area_of(rectangle({1, 2}, {5, 12})), 40.0);
  EXPECT_DOUBLE_EQ(area_of(polygon({{0, 0}, {4, 0}, {0, 3}})), 6.0);
  EXPECT_TRUE(polygon({}).segments.empty());
  EXPECT_FALSE(diagnostics.has_errors());
}

}  // namespace
}  // namespace kerf

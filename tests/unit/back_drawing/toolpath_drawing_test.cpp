// The entities of a toolpath's drawing.
#include "kerf/drawing/toolpath_drawing.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace kerf {
namespace {

const Feed kFeed = mm_per_min(500);

class ToolpathDrawing : public testing::Test {
 protected:
  void rapid(Point3 to) { path_.add(step::Rapid{to}, OriginId::none); }
  void cut(Point3 to) { path_.add(step::Cut{to, kFeed}, OriginId::none); }
  void arc(Point3 to, Point2 centre, Turn turn, int extra_turns = 0, Plane plane = Plane::xy) {
    path_.add(step::Arc{to, centre, plane, turn, extra_turns, kFeed}, OriginId::none);
  }
  template <class Shape>
  const Shape& only(const Drawing& drawing) {
    EXPECT_EQ(drawing.entities.size(), 1u);
    return std::get<Shape>(drawing.entities.at(0).shape);
  }

  Toolpath path_;
};

TEST_F(ToolpathDrawing, one_cut_is_a_line) {
  rapid({1, 2, 5});
  cut({1, 2, -1});
  cut({4, 2, -1});
  EXPECT_EQ(only<drawing::Line>(toolpath_drawing(path_, {})), (drawing::Line{1, 2, 4, 2}));
  const Drawing inches = toolpath_drawing(path_, {.unit = DrawingUnit::inch});
  EXPECT_DOUBLE_EQ(only<drawing::Line>(inches).x2, 4 / 25.4);
}

TEST_F(ToolpathDrawing, one_arc_is_an_arc) {
  rapid({10, 0, 0});
  arc({0, 10, 0}, {0, 0}, Turn::ccw);
  const auto ccw = only<drawing::Arc>(toolpath_drawing(path_, {}));
  EXPECT_NEAR(ccw.radius, 10, 1e-12);
  EXPECT_NEAR(std::fmod(ccw.end - ccw.start + 360, 360), 90, 1e-9);
  EXPECT_NEAR(std::cos(ccw.start * std::numbers::pi / 180), 1, 1e-12);
  Toolpath back;
  std::swap(path_, back);
  rapid({0, 10, 0});
  arc({10, 0, 0}, {0, 0}, Turn::cw);
  const auto cw = only<drawing::Arc>(toolpath_drawing(path_, {}));
  EXPECT_NEAR(std::fmod(cw.start - ccw.start + 720, 360), 0, 1e-9);
  EXPECT_NEAR(std::fmod(cw.end - ccw.end + 720, 360), 0, 1e-9);
}

TEST_F(ToolpathDrawing, whole_turns_are_one_circle) {
  rapid({10, 0, 0});
  arc({10, 0, -3}, {0, 0}, Turn::cw, 3);
  EXPECT_EQ(only<drawing::Circle>(toolpath_drawing(path_, {})), (drawing::Circle{0, 0, 10}));
}

TEST_F(ToolpathDrawing, a_helix_that_ends_elsewhere_keeps_its_rest) {
  rapid({10, 0, 0});
  arc({-10, 0, -3}, {0, 0}, Turn::ccw, 1);
  const Drawing drawing = toolpath_drawing(path_, {});
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(std::get<drawing::Circle>(drawing.entities[0].shape), (drawing::Circle{0, 0, 10}));
  const auto& rest = std::get<drawing::Polyline>(drawing.entities[1].shape);
  ASSERT_EQ(rest.vertices.size(), 2u);
  EXPECT_NEAR(rest.vertices[0].bulge, 1, 1e-9);  // half a circle, counter-clockwise
  EXPECT_NEAR(rest.vertices[1].x, -10, 1e-9);
}

TEST_F(ToolpathDrawing, a_chain_is_one_polyline_and_passes_are_drawn_once) {
  rapid({0, 0, 5});
  for (const double z : {-1.0, -2.0, -3.0}) {
    cut({0, 0, z});
    cut({10, 0, z});
    arc({10, 10, z}, {10, 5}, Turn::ccw);
    cut({0, 10, z});
    cut({0, 0, z});
  }
  const auto line = only<drawing::Polyline>(toolpath_drawing(path_, {}));
  EXPECT_TRUE(line.closed);
  ASSERT_EQ(line.vertices.size(), 4u);
  EXPECT_NEAR(line.vertices[1].bulge, 1, 1e-12);
}

TEST_F(ToolpathDrawing, more_than_half_a_circle_is_two_bulges) {
  rapid({0, 0, 0});
  cut({10, 0, 0});
  arc({0, 10, 0}, {0, 0}, Turn::cw);
  const auto line = only<drawing::Polyline>(toolpath_drawing(path_, {}));
  ASSERT_EQ(line.vertices.size(), 4u);
  for (int i : {1, 2})
    EXPECT_NEAR(line.vertices[static_cast<std::size_t>(i)].bulge, -std::tan(std::numbers::pi * 1.5 / 8),
                1e-12);
}

TEST_F(ToolpathDrawing, upright_arcs_are_seen_from_above) {
  rapid({0, 0, 0});
  arc({10, 0, 0}, {5, 0}, Turn::cw, 0, Plane::xz);
  const auto bounds = drawing_bounds(toolpath_drawing(path_, {}));
  EXPECT_NEAR(bounds[2] - bounds[0], 10, 1e-9);
  EXPECT_NEAR(bounds[3] - bounds[1], 0, 1e-9);
}

TEST_F(ToolpathDrawing, a_hole_is_a_circle_of_the_tool) {
  path_.add(step::ToolChange{7}, OriginId::none);
  rapid({3, 4, 5});
  cut({3, 4, -10});
  rapid({3, 4, 5});
  rapid({8, 4, 5});
  const Drawing drawing =
      toolpath_drawing(path_, {.tool_names = {{7, "drill"}}, .tool_diameters = {{7, mm(6)}}});
  EXPECT_EQ(only<drawing::Circle>(drawing), (drawing::Circle{3, 4, 3}));
  EXPECT_EQ(drawing.layers.at(drawing.entities[0].layer).name, "T7 drill");
}

TEST_F(ToolpathDrawing, layers_have_names_or_tools) {
  path_.add(step::ToolChange{1}, OriginId::none);
  rapid({0, 0, 0});
  cut({1, 0, 0});
  path_.add(step::ToolChange{2}, OriginId::none);
  cut({2, 0, 0});
  path_.add(step::Layer{"pocket", 30}, OriginId::none);
  cut({3, 0, 0});
  const Drawing drawing = toolpath_drawing(path_, {});
  ASSERT_EQ(drawing.layers.size(), 3u);
  EXPECT_EQ(drawing.layers[0].name, "T1");
  EXPECT_EQ(drawing.layers[1].name, "T2");
  EXPECT_NE(drawing.layers[0].colour, drawing.layers[1].colour);
  EXPECT_EQ(drawing.layers[2].name, "pocket");
  EXPECT_EQ(drawing.layers[2].colour, 30);
}

TEST_F(ToolpathDrawing, rapids_and_a_beam_without_power_cut_nothing) {
  rapid({0, 0, 0});
  path_.add(step::LaserPower{LaserMode::dynamic, 0}, OriginId::none);
  cut({10, 0, 0});
  path_.add(step::LaserPower{LaserMode::dynamic, 200}, OriginId::none);
  cut({20, 0, 0});
  EXPECT_EQ(only<drawing::Line>(toolpath_drawing(path_, {})), (drawing::Line{10, 0, 20, 0}));
  const Drawing both = toolpath_drawing(path_, {.rapids = RapidLines::drawn});
  ASSERT_EQ(both.entities.size(), 2u);
  EXPECT_EQ(both.layers.at(both.entities[0].layer).name, "rapids");
}

TEST_F(ToolpathDrawing, unknown_positions_are_skipped) {
  path_.set_unknown_axes(path_.add(step::Rapid{{0, 0, 0}}, OriginId::none), 7);
  cut({5, 5, 0});
  EXPECT_TRUE(toolpath_drawing(path_, {}).entities.empty());
  cut({6, 5, 0});
  EXPECT_EQ(only<drawing::Line>(toolpath_drawing(path_, {})), (drawing::Line{5, 5, 6, 5}));
}

}  // namespace
}  // namespace kerf

// Outlines as entities of a drawing, and the picture of the corners.
#include "back/drawing/outline_drawing.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

Outline half_disc() {
  Outline outline;
  outline.start = {-10, 0};
  outline.segments = {{{10, 0}}, {{-10, 0}, Point2{0, 10}}};
  return outline;
}

TEST(OutlineDrawing, PiecesAreLinesAndArcs) {
  Drawing drawing;
  draw(drawing, 0, half_disc(), OutlineEntities::pieces);
  ASSERT_EQ(drawing.entities.size(), 2u);
  ASSERT_TRUE(std::holds_alternative<drawing::Line>(drawing.entities[0].shape));
  const auto* arc = std::get_if<drawing::Arc>(&drawing.entities[1].shape);
  ASSERT_NE(arc, nullptr);
  EXPECT_NEAR(arc->radius, 10.0, 1e-12);
  EXPECT_NEAR(arc->start, 0.0, 1e-9);
  EXPECT_NEAR(arc->end, 180.0, 1e-9);
}

TEST(OutlineDrawing, APolylineHasBulges) {
  Drawing drawing;
  draw(drawing, 0, Figure{half_disc(), Circle{{0, 3}, mm(1)}}, OutlineEntities::polyline);
  ASSERT_EQ(drawing.entities.size(), 2u);
  const auto* line = std::get_if<drawing::Polyline>(&drawing.entities[0].shape);
  ASSERT_NE(line, nullptr);
  EXPECT_TRUE(line->closed);
  ASSERT_EQ(line->vertices.size(), 2u);
  EXPECT_NEAR(line->vertices[1].bulge, 1.0, 1e-12);
}

TEST(OutlineDrawing, ThePictureShowsTheBitAtEachChangedCorner) {
  Diagnostics diagnostics;
  auto cut = cut_corners(half_disc(), {Length(), mm(2)}, {}, diagnostics);
  ASSERT_TRUE(cut);
  const Drawing picture = corner_picture({{half_disc(), *cut}}, "half disc");
  int bits = 0;
  for (const DrawingEntity& entity : picture.entities)
    if (const auto* circle = std::get_if<drawing::Circle>(&entity.shape)) {
      ++bits;
      EXPECT_EQ(picture.layers[entity.layer].name, "bit");
      EXPECT_NEAR(circle->radius, 2.0, 1e-9);
    }
  EXPECT_EQ(bits, 1);
  EXPECT_EQ(picture.entities.size(), 3u);
}

}  // namespace
}  // namespace kerf

// Figures as solids: closed meshes of the right volume, and what is refused.
#include "geom/solid/extrude.h"

#include <gtest/gtest.h>
#include <map>
#include <numbers>

#include "base/codes/outline.h"

namespace kerf {
namespace {

Outline box(double low, double high) {
  Outline outline;
  outline.start = {low, low};
  outline.segments = {{{high, low}, {}}, {{high, high}, {}}, {{low, high}, {}}, {{low, low}, {}}};
  return outline;
}

double volume(const SolidMesh& mesh) {
  const auto at = [&](std::size_t i) {
    const std::size_t k = 3 * mesh.triangles[i];
    return Point3{mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]};
  };
  double six = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) six += dot(at(i), cross(at(i + 1), at(i + 2)));
  return six / 6.0;
}

void expect_closed(const SolidMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    ++edges[{mesh.triangles[i], mesh.triangles[i - i % 3 + (i + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(Extrude, APlateWithHolesHasItsVolume) {
  Figure figure{box(0, 40), box(5, 10), Circle{{25, 25}, mm(10)}, box(11, 12), reversed(box(1, 3))};
  Diagnostics diagnostics;
  const auto mesh = extrude(figure, mm(5), {.chord = mm(1e-4)}, diagnostics);
  ASSERT_TRUE(mesh);
  expect_closed(*mesh);
  EXPECT_NEAR(volume(*mesh), 5.0 * (1600 - 25 - 100 * std::numbers::pi - 1 - 4), 0.05);
}

TEST(Extrude, FiguresWithoutAnInsideAreRefused) {
  Outline open = box(0, 10);
  open.segments.pop_back();
  for (const Figure& figure : {Figure{}, Figure{open}, Figure{Circle{{0, 0}, mm(-1)}}}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(extrude(figure, mm(5), {}, diagnostics));
    ASSERT_FALSE(diagnostics.list().empty());
    EXPECT_EQ(diagnostics.list()[0].code, codes::figure_not_solid);
  }
}

TEST(Extrude, CrossingOutlinesAreRefused) {
  for (const Figure& figure : {Figure{box(0, 10), box(5, 15)}, Figure{box(0, 10), box(20, 30)}}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(extrude(figure, mm(5), {}, diagnostics));
    ASSERT_FALSE(diagnostics.list().empty());
    EXPECT_EQ(diagnostics.list()[0].code, codes::figure_crosses);
  }
}

}  // namespace
}  // namespace kerf

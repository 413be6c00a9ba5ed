// The drawings of toolpaths in gcmc's forms.
#include "back/drawing/gcmc_drawing.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

Toolpath small_path() {
  Toolpath path;
  path.add(step::Rapid{{10, 0, 5}}, OriginId::none);
  path.add(step::Cut{{10, 0, -1}, mm_per_min(100)}, OriginId::none);
  path.add(step::Cut{{20, 0, -1}, mm_per_min(100)}, OriginId::none);
  path.add(step::Arc{.to = {20, 10, -1}, .centre = {20, 5}, .turn = Turn::ccw, .feed = mm_per_min(100)},
           OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  return path;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(GcmcSvg, PathsRunFromRapidToRapid) {
  const std::string svg = gcmc_svg(small_path(), {});
  EXPECT_TRUE(has(svg,
                  "d=\"M 10.000000,0.000000 L 10.000000,0.000000 L 20.000000,0.000000 "
                  "A 5.000000,5.000000 0 0,1 20.000000,10.000000\"/>"));
  EXPECT_TRUE(has(svg, "#ff0000"));
  EXPECT_TRUE(has(svg, "width=\"28.000000mm\""));  // X to 25 on the arc, and the tool width
  EXPECT_TRUE(has(svg, "height=\"13.000000mm\""));
  EXPECT_TRUE(has(svg, "translate(1.500000 11.500000) scale(1 -1)"));
}

TEST(GcmcSvg, OptionsChangeWhatIsDrawn) {
  GcmcDrawingOptions options;
  options.imperial = true;
  options.flip = options.show_moves = options.show_grid = false;
  options.tool_width = 1;
  options.opacity = 1;
  options.layers = {"one"};
  const std::string svg = gcmc_svg(small_path(), options);
  EXPECT_FALSE(has(svg, "Move Path"));
  EXPECT_FALSE(has(svg, "xygrid"));
  EXPECT_FALSE(has(svg, "scale(1 -1)"));
  EXPECT_TRUE(has(svg, "inkscape:label=\"cutpath\""));
  EXPECT_TRUE(has(svg, "inkscape:label=\"one\""));
  EXPECT_TRUE(has(svg, "stroke-width:1.000000"));
  EXPECT_TRUE(has(svg, "in\""));
}

TEST(GcmcSvg, CirclesAreTwoHalves) {
  Toolpath path;
  path.add(step::Arc{.to = {0, 0, 0}, .centre = {5, 0}, .turn = Turn::cw, .feed = mm_per_min(1)},
           OriginId::none);
  EXPECT_TRUE(has(gcmc_svg(path, {}),
                  "M 0.000000,0.000000 A 5.000000,5.000000 0 0,0 10.000000,0.000000 "
                  "A 5.000000,5.000000 0 0,0 0.000000,0.000000"));
}

TEST(GcmcDxf, EntitiesOfEachKind) {
  Toolpath path = small_path();
  path.add(step::Layer{"holes", 256}, OriginId::none);
  path.add(step::Arc{.to = {0, 0, 5}, .centre = {5, 0}, .turn = Turn::cw, .feed = mm_per_min(1)},
           OriginId::none);
  const std::string dxf = gcmc_dxf(path, {});
  EXPECT_TRUE(has(dxf, "  0\nLINE\n  5\npath1\n"));
  EXPECT_TRUE(has(dxf, "  0\nARC\n"));
  EXPECT_TRUE(has(dxf, " 50\n270.0000000000000000\n 51\n90.0000000000000000\n"));
  EXPECT_TRUE(has(dxf, "  0\nCIRCLE\n"));
  EXPECT_TRUE(has(dxf, "  2\nholes\n"));  // the whole name in the table of layers
  EXPECT_TRUE(has(dxf, "  9\n$INSUNITS\n 70\n4\n"));
  GcmcDrawingOptions options;
  options.hex_handles = options.imperial = true;
  const std::string valid = gcmc_dxf(path, options);
  EXPECT_FALSE(has(valid, "path1"));
  EXPECT_TRUE(has(valid, "  9\n$INSUNITS\n 70\n1\n"));
}

}  // namespace
}  // namespace kerf

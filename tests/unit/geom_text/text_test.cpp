// Text in lines: where strokes of the built-in fonts are, and what is refused.
#include "kerf/geom/text.h"

#include <gtest/gtest.h>

#include "geom/text/stroke_fonts.h"

namespace kerf {
namespace {

TextOptions sized(double height) {
  TextOptions options;
  options.height = mm(height);
  return options;
}

Box2 box_of(const std::vector<Outline>& paths) {
  Box2 box;
  for (const Outline& path : paths) box.add(bounds(path));
  return box;
}

TEST(StrokeFonts, AllNamesAreFontsWithCapitals) {
  EXPECT_EQ(stroke_font_names().size(), 8u);
  for (const std::string_view name : stroke_font_names()) {
    const StrokeFont* font = stroke_font(name);
    ASSERT_NE(font, nullptr) << name;
    for (const char32_t c : {U' ', U'A', U'z', U'0'}) EXPECT_TRUE(font->contains(c)) << name;
  }
  EXPECT_EQ(stroke_font("Comic"), nullptr);
  EXPECT_EQ(stroke_font(1), stroke_font("sans"));
  EXPECT_EQ(stroke_font(99), nullptr);
}

TEST(Text, CapitalsAreAsHighAsRequested) {
  const auto font = stroke_text_font("sans");
  ASSERT_TRUE(font);
  Diagnostics diagnostics;
  const auto paths = set_text("HI", *font, sized(10), diagnostics);
  ASSERT_TRUE(paths);
  EXPECT_TRUE(diagnostics.list().empty());
  // The strokes of H and of I.
  ASSERT_EQ(paths->size(), 4u);
  const Box2 box = box_of(*paths);
  EXPECT_NEAR(box.low.y, 0.0, 1e-9);
  EXPECT_NEAR(box.high.y, 10.0, 1e-9);
  EXPECT_GT(box.low.x, 0.0);
}

TEST(Text, PositionAngleAlignmentAndLines) {
  const auto font = stroke_text_font("sans");
  Diagnostics diagnostics;
  const Box2 plain = box_of(*set_text("OXO", *font, sized(10), diagnostics));
  TextOptions options = sized(10);
  options.at = {100, 50}, options.angle = degrees(90);
  const Box2 turned = box_of(*set_text("OXO", *font, options, diagnostics));
  EXPECT_NEAR(turned.low.x, 100 - plain.high.y, 1e-9);
  EXPECT_NEAR(turned.low.y, 50 + plain.low.x, 1e-9);
  EXPECT_NEAR(turned.high.y, 50 + plain.high.x, 1e-9);
  options = sized(10);
  options.align = TextAlign::centre;
  const Box2 centred = box_of(*set_text("OXO", *font, options, diagnostics));
  EXPECT_NEAR(centred.low.x, -centred.high.x, 1e-9);  // these characters are symmetric
  options.align = TextAlign::right;
  EXPECT_LT(box_of(*set_text("OXO", *font, options, diagnostics)).high.x, 0.0);
  options = sized(10);
  options.spacing = mm(3);
  const Box2 wider = box_of(*set_text("OXO", *font, options, diagnostics));
  EXPECT_NEAR(wider.high.x - plain.high.x, 6.0, 1e-9);
  const Box2 lines = box_of(*set_text("OXO\nOXO", *font, sized(10), diagnostics));
  EXPECT_NEAR(lines.low.y, plain.low.y - 16.0, 1e-9);
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(Text, WhatCannotBeSetIsAnError) {
  const auto font = stroke_text_font("sans");
  const auto message = [&](std::string_view text, const TextOptions& options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(set_text(text, *font, options, diagnostics));
    EXPECT_EQ(diagnostics.errors(), 1u);
    return diagnostics.list().empty() ? "" : diagnostics.list().front().message;
  };
  EXPECT_NE(message("A\xE2\x98\x83", sized(10)).find("U+2603"), std::string::npos);
  EXPECT_NE(message("", sized(10)).find("no visible character"), std::string::npos);
  EXPECT_NE(message(" \n ", sized(10)).find("no visible character"), std::string::npos);
  for (const double height : {0.0, -1.0, std::nan(""), double{INFINITY}})
    EXPECT_NE(message("A", sized(height)).find("height"), std::string::npos) << height;
  TextOptions bad = sized(10);
  bad.spacing = mm(std::nan(""));
  EXPECT_NE(message("A", bad).find("spacing"), std::string::npos);
}

}  // namespace
}  // namespace kerf

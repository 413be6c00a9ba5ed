// Fonts: a small font made here, and broken files.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "base/codes/files.h"
#include "codec/font/font_files.h"
#include "codec/font/kerning.h"

namespace kerf {
namespace {

/// A TrueType font with the characters H (a rectangle of 200 by 700 units) and O (a square of 500 with a
/// round hole of 8 curves' control points), advance 600, from the tables that the format requires.
class FontMaker {
 public:
  std::string make() {
    glyf_.clear(), loca_.clear();
    glyph({});
    glyph({{{0, 0, true}, {0, 700, true}, {200, 700, true}, {200, 0, true}}});
    glyph({{{0, 0, true}, {0, 500, true}, {500, 500, true}, {500, 0, true}},
           {{100, 250, true},
            {100, 100, false},
            {250, 100, true},
            {400, 100, false},
            {400, 250, true},
            {400, 400, false},
            {250, 400, true},
            {100, 400, false}}});
    put32(loca_, static_cast<std::uint32_t>(glyf_.size()));
    std::string head, hhea, maxp, hmtx, cmap;
    put32(head, 0x00010000), put32(head, 0x00010000), put32(head, 0), put32(head, 0x5F0F3CF5);
    put16(head, 0), put16(head, 1000), head.append(16, '\0');
    for (const int v : {0, 0, 1000, 1000}) put16(head, v);
    put16(head, 0), put16(head, 8), put16(head, 2), put16(head, 1), put16(head, 0);
    put32(hhea, 0x00010000), put16(hhea, 800), put16(hhea, -200), put16(hhea, 0), put16(hhea, 600);
    hhea.append(22, '\0'), put16(hhea, 3);
    put32(maxp, 0x00010000), put16(maxp, 3), maxp.append(26, '\0');
    for (int i = 0; i < 3; ++i) put16(hmtx, 600), put16(hmtx, 0);
    put16(cmap, 0), put16(cmap, 1), put16(cmap, 3), put16(cmap, 1), put32(cmap, 12);
    // Format 4: the segments H (72), O (79), and the end.
    put16(cmap, 4), put16(cmap, 16 + 8 * 3), put16(cmap, 0), put16(cmap, 6), put16(cmap, 4), put16(cmap, 1),
        put16(cmap, 2);
    for (const int v : {72, 79, 0xFFFF, 0, 72, 79, 0xFFFF, 1 - 72, 2 - 79, 1, 0, 0, 0}) put16(cmap, v);
    const std::vector<std::pair<std::string, std::string>> tables{
        {"cmap", cmap}, {"glyf", glyf_}, {"head", head}, {"hhea", hhea},
        {"hmtx", hmtx}, {"loca", loca_}, {"maxp", maxp}};
    std::string file, body;
    put32(file, 0x00010000), put16(file, static_cast<int>(tables.size())), put16(file, 64), put16(file, 2),
        put16(file, 48);
    const std::size_t start = 12 + 16 * tables.size();
    for (const auto& [name, bytes] : tables) {
      file += name;
      put32(file, 0), put32(file, static_cast<std::uint32_t>(start + body.size()));
      put32(file, static_cast<std::uint32_t>(bytes.size()));
      body += bytes;
      body.append((4 - bytes.size() % 4) % 4, '\0');
    }
    return file + body;
  }

 private:
  struct Point {
    int x, y;
    bool on;
  };
  static void put16(std::string& out, int v) {
    out += static_cast<char>(v >> 8 & 0xFF), out += static_cast<char>(v & 0xFF);
  }
  static void put32(std::string& out, std::uint32_t v) {
    put16(out, static_cast<int>(v >> 16)), put16(out, static_cast<int>(v & 0xFFFF));
  }
  void glyph(const std::vector<std::vector<Point>>& contours) {
    put32(loca_, static_cast<std::uint32_t>(glyf_.size()));
    if (contours.empty()) return;
    std::string flags, xs, ys;
    put16(glyf_, static_cast<int>(contours.size()));
    for (const int v : {0, 0, 500, 700}) put16(glyf_, v);
    int end = -1, x = 0, y = 0;
    for (const auto& contour : contours) put16(glyf_, end += static_cast<int>(contour.size()));
    put16(glyf_, 0);
    for (const auto& contour : contours)
      for (const Point& p : contour) {
        flags += static_cast<char>(p.on ? 1 : 0);
        put16(xs, p.x - x), put16(ys, p.y - y);
        x = p.x, y = p.y;
      }
    glyf_ += flags + xs + ys;
    glyf_.append((4 - glyf_.size() % 4) % 4, '\0');
  }
  std::string glyf_, loca_;
};

TEST(Font, CharactersAreCurvesInHeightsOfACapital) {
  Diagnostics diagnostics;
  const auto font = read_font(FontMaker().make(), "small.ttf", U"HOX", diagnostics);
  ASSERT_TRUE(font) << to_string(diagnostics.list().front());
  EXPECT_EQ(font->glyphs.size(), 2u);  // X is not in the font
  const FontGlyph& h = font->glyphs.at(U'H');
  EXPECT_NEAR(h.advance, 600.0 / 700, 1e-12);
  ASSERT_EQ(h.contours.size(), 1u);
  double high = 0.0, right = 0.0;
  for (const FontCurve& c : h.contours[0].curves)
    high = std::max(high, c.to.y), right = std::max(right, c.to.x);
  EXPECT_NEAR(high, 1.0, 1e-12);
  EXPECT_NEAR(right, 200.0 / 700, 1e-12);
  const FontGlyph& o = font->glyphs.at(U'O');
  ASSERT_EQ(o.contours.size(), 2u);
  ASSERT_EQ(o.contours[1].curves.size(), 4u);
  for (const FontCurve& c : o.contours[1].curves) EXPECT_EQ(c.control.size(), 1u);
}

TEST(Font, OtherFilesAreErrors) {
  for (const std::string& bytes : {std::string(), std::string("PNG"), std::string(1000, '\0')}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_font(bytes, "x.ttf", U"A", diagnostics));
    ASSERT_EQ(diagnostics.errors(), 1u);
    EXPECT_EQ(diagnostics.list().front().code, codes::file_unreadable);
  }
}

TEST(Font, BrokenFontsNeitherCrashNorMakeNumbersThatAreNotFinite) {
  const std::string whole = FontMaker().make();
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = whole.substr(0, i % 3 == 0 ? random() % whole.size() : whole.size());
    for (std::size_t k = 0; k < 1 + random() % 6 && !bytes.empty(); ++k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    Diagnostics diagnostics;
    const auto font = read_font(bytes, "x.ttf", U"HO", diagnostics);
    EXPECT_EQ(font.has_value(), !diagnostics.has_errors());
    if (!font) continue;
    for (const auto& [code, glyph] : font->glyphs)
      for (const FontContour& c : glyph.contours)
        for (const FontCurve& curve : c.curves)
          ASSERT_TRUE(std::isfinite(curve.to.x) && std::isfinite(curve.to.y));
  }
}

/// A table GPOS with the feature "kern" of Latin text: a pair of the glyphs 5 and 7 is 50 units closer.
std::string pairs_of_one() {
  std::string table;
  const auto put = [&](std::initializer_list<int> numbers) {
    for (const int n : numbers) {
      table += static_cast<char>((n >> 8) & 0xFF);
      table += static_cast<char>(n & 0xFF);
    }
  };
  put({1, 0, 10, 30, 44});                        // version; scripts, features, lookups
  put({1}), table += "latn", put({8, 4, 0});      // the script and its default language
  put({0, 0xFFFF, 1, 0});                         // the language: feature 0
  put({1}), table += "kern", put({8, 0, 1, 0});   // the feature: lookup 0
  put({1, 4, 2, 0, 1, 8});                        // the lookup: pairs, one subtable
  put({1, 18, 4, 0, 1, 12, 1, 7, -50, 1, 1, 5});  // single pairs; a set for glyph 5: 7; the glyphs covered
  return table;
}

TEST(Kerning, PairsOfTheTableGpos) {
  const PairKerning pairs(pairs_of_one());
  ASSERT_TRUE(pairs.exists());
  EXPECT_EQ(pairs.between(5, 7), -50.0);
  EXPECT_EQ(pairs.between(5, 6), 0.0);
  EXPECT_EQ(pairs.between(7, 5), 0.0);
  EXPECT_FALSE(PairKerning("").exists());
}

TEST(Kerning, DamagedTables) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    std::string table = pairs_of_one();
    for (int k = 0; k < 4; ++k) table[random() % table.size()] = static_cast<char>(random());
    table.resize(random() % (table.size() + 1));
    EXPECT_TRUE(std::isfinite(PairKerning(table).between(5, 7)));
  }
  // All counts are the largest, and all offsets lead into the table.
  EXPECT_TRUE(std::isfinite(PairKerning(std::string(200'000, '\xFF')).between(5, 7)));
}

}  // namespace
}  // namespace kerf

// Text of code pages: the tables, and the system's converters, which are iconv on POSIX and those of Windows
// there. The expectations are those of Python's codecs.
#include "codec/drawing/code_page.h"

#include <gtest/gtest.h>

namespace kerf::dxf {
namespace {

constexpr struct {
  int page;
  const char *bytes, *text;
} kTexts[] = {
    {932, "\223\372\226{\214\352\261\225\134x", "日本語ｱ表x"},
    {936, "\274\362\314\345\326\320\316\304x", "简体中文x"},
    {949, "\307\321\261\271\276\356\224\356x", "한국어뷁x"},
    {950, "\301c\305\351\244\244\244\345\245\134x", "繁體中文功x"},
    {1361, "\320e\212\202\264\341x", "한국어x"},
    {437, "\202\361\344x", "é±Σx"},
    {850, "\202\361\341x", "é±ßx"},
    {28592, "\261\243\276x", "ąŁžx"},
    {10000, "\216\271x", "éπx"},
    {1251, "\306\377x", "Жяx"},
    {1252, "\200\351x", "€éx"},
};

TEST(CodePages, AreDecoded) {
  for (const auto& row : kTexts) {
    TextDecoder decoder;
    ASSERT_TRUE(decoder.use(row.page)) << row.page;
    EXPECT_EQ(decoder.decode(row.bytes), row.text) << row.page;
    EXPECT_EQ(decoder.faulty_texts(), 0u) << row.page;
  }
}

TEST(CodePages, CountTextsWithBytesThatAreNoCharacter) {
  for (const int page : {932, 936, 949, 950}) {
    TextDecoder decoder;
    ASSERT_TRUE(decoder.use(page)) << page;
    EXPECT_EQ(decoder.decode("a\201 b"), "a\uFFFD b") << page;  // a space is never a second byte
    EXPECT_EQ(decoder.decode("a\201"), "a\uFFFD") << page;
    EXPECT_EQ(decoder.decode("ab"), "ab") << page;
    EXPECT_EQ(decoder.faulty_texts(), 2u) << page;
  }
}

TEST(CodePages, AnUnknownOneIsRefused) {
  TextDecoder decoder;
  EXPECT_FALSE(decoder.use(12345));
  EXPECT_EQ(decoder.decode("\351"), "é");  // ANSI_1252, as before
}

TEST(CodePages, EscapesNameThePage) {
  TextDecoder decoder;
  EXPECT_EQ(decoder.decode("\\M+193FA \\U+65E5"), "日 日");  // 0x93FA in page 932
}

}  // namespace
}  // namespace kerf::dxf

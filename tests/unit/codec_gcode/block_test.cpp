// Blocks of words: every valid spelling, every fault with its location, and bounded work on junk.
#include "codec/gcode/block.h"

#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

struct Reading {
  std::vector<Block> blocks;
  Diagnostics diagnostics;
};

Reading read(std::string_view text, BlockReaderOptions options = {}) {
  Reading reading;
  BlockReader reader(text, std::move(options), reading.diagnostics);
  for (Block block; reader.next(block);) reading.blocks.push_back(block);
  return reading;
}

/// "G0 X10 Y-0.5": the words of a block as plain text.
std::string words_of(const Block& block) {
  std::string text;
  for (const Word& word : block.words) {
    if (!text.empty()) text += ' ';
    text += word.letter;
    text += word.kind == ValueKind::number ? std::to_string(word.value) : std::string(block.value_text(word));
  }
  return text;
}

TEST(Block, ReadsTheUsualSpellings) {
  const std::string want = "G0.000000 X10.000000 Y-0.500000";
  for (const std::string_view text :
       {"G0 X10 Y-.5", "g0x10y-0.5", "G00X10.Y-00.50", "G 0 X 1 0 Y - . 5", "\tG0\tX+10 Y-0.5 ",
        "\xEF\xBB\xBFG0 X10 Y-.5", "G0 (a) X10 (b) Y-.5 ; c"}) {
    const Reading r = read(text);
    ASSERT_EQ(r.blocks.size(), 1u) << text;
    EXPECT_EQ(words_of(r.blocks[0]), want) << text;
    EXPECT_TRUE(r.diagnostics.list().empty()) << text;
  }
}

TEST(Block, LineEndsOfAllKindsCountOnce) {
  const Reading r = read("G0\r\nG1\rG2\nG3\n\nG4");
  ASSERT_EQ(r.blocks.size(), 6u);
  EXPECT_EQ(r.blocks[1].line, 2u);
  EXPECT_EQ(words_of(r.blocks[2]), "G2.000000");
  EXPECT_EQ(r.blocks[5].line, 6u);
  EXPECT_TRUE(read("").blocks.empty());
}

TEST(Block, KeepsWhatSurroundsTheWords) {
  const Reading r = read("/N10 G1 (one) X2 ; two (2)\n%prog\nN 20.5 /G0\nO1000 (name)\nN3 G1 X5*71");
  ASSERT_EQ(r.blocks.size(), 5u);
  const Block& b = r.blocks[0];
  EXPECT_TRUE(b.optional);
  EXPECT_EQ(b.number, 10.0);
  ASSERT_EQ(b.comments.size(), 2u);
  EXPECT_EQ(b.comments[0].text, "one");
  EXPECT_EQ(b.comments[0].column, 9u);
  EXPECT_EQ(b.comments[1].text, " two (2)");
  ASSERT_EQ(b.words.size(), 2u);
  EXPECT_EQ(b.words[1].column, 15u);
  EXPECT_TRUE(r.blocks[1].percent);
  EXPECT_TRUE(r.blocks[2].optional);
  EXPECT_EQ(r.blocks[2].number, 20.5);
  EXPECT_EQ(words_of(r.blocks[3]), "O1000.000000");
  EXPECT_EQ(r.blocks[4].words.back().letter, '*');
}

TEST(Block, CommentsMayHoldAnyBytes) {
  const Reading r = read("(M\xC3\xBCller \xFF\x01) G0\n; \xE5\xB9\xB3");
  EXPECT_TRUE(r.diagnostics.list().empty());
  EXPECT_EQ(words_of(r.blocks[0]), "G0.000000");
}

TEST(Block, RecognisesExpressions) {
  const Reading r = read(
      "#1=2 #<depth> = [#1 * [2 + 1]] G1 X#1 Y[1+2] Z-#<z_safe> I-[2] F##2 Jatan[1]/[2] K abs[-1]\nO100 "
      "sub\no<x> call [1] (c)");
  EXPECT_TRUE(r.diagnostics.list().empty());
  const Block& b = r.blocks[0];
  ASSERT_EQ(b.assignments.size(), 2u);
  EXPECT_EQ(b.assignments[0].text, "#1=2");
  EXPECT_EQ(b.assignments[1].text, "#<depth> = [#1 * [2 + 1]]");
  EXPECT_EQ(b.assignments[1].column, 6u);
  EXPECT_EQ(words_of(b), "G1.000000 X#1 Y[1+2] Z-#<z_safe> I-[2] F##2 Jatan[1]/[2] K abs[-1]");
  ASSERT_TRUE(r.blocks[1].o_word);
  EXPECT_EQ(r.blocks[1].o_word->text, "O100 sub");
  EXPECT_EQ(r.blocks[2].o_word->text, "o<x> call [1]");
  EXPECT_EQ(r.blocks[2].comments[0].text, "c");
}

TEST(Block, NumbersAreTheNearestDouble) {
  for (const char* text :
       {"0.1", "123.456789", "-0.000001", "1234567890.12345", "0.1234567890123456789",
        "00000000000000000000001.5", "3.14159265358979323846264338327950288", "999999999999"}) {
    const Reading r = read(std::string("X") + text);
    ASSERT_EQ(r.blocks[0].words.size(), 1u) << text;
    EXPECT_EQ(r.blocks[0].words[0].value, std::strtod(text, nullptr)) << text;
  }
  const Reading zero = read("X-0 Y-.000");
  EXPECT_FALSE(std::signbit(zero.blocks[0].words[0].value));
  EXPECT_FALSE(std::signbit(zero.blocks[0].words[1].value));
}

TEST(Block, ALineThatStartsWithADollarSignIsACommand) {
  const Reading r = read("$H\n$110 = 5000.000    (X-axis maximum rate)\nG1 X5");
  EXPECT_TRUE(r.diagnostics.list().empty());
  ASSERT_EQ(r.blocks.size(), 3u);
  EXPECT_EQ(r.blocks[0].command, "$H");
  EXPECT_TRUE(r.blocks[1].words.empty());
  EXPECT_TRUE(r.blocks[2].command.empty());
}

struct Fault {
  std::string_view text;
  Code code;
  std::uint32_t column;
};

TEST(Block, FaultsHaveTheirLocationAndReadingContinues) {
  const Fault faults[] = {
      {"G1 X", codes::number_missing, 4},
      {"G1 X Y2", codes::number_missing, 4},
      {"X--1", codes::number_missing, 1},
      {"Xnan", codes::number_missing, 1},
      {"X.", codes::number_missing, 1},
      {"#1=", codes::number_missing, 3},
      {"X1.2.3", codes::number_malformed, 5},
      {"G1 X1e308", codes::number_malformed, 6},
      {"X1-2", codes::number_malformed, 3},
      {"X1E+5", codes::number_malformed, 3},
      {"X1000000000001", codes::number_too_large, 1},
      {"X99999999999999999999999", codes::number_too_large, 1},
      {"G1 $", codes::number_missing, 4},
      {"G1 X1 )", codes::bad_character, 7},
      {"5", codes::bad_character, 1},
      {"G1 %", codes::bad_character, 4},
      {"G1 X1/2", codes::bad_character, 6},
      {"#1 2", codes::bad_character, 1},
      {"G1 \xC3\xBC", codes::bad_character, 4},
      {"[1]", codes::bad_character, 1},
  };
  for (const Fault& f : faults) {
    const Reading r = read(std::string(f.text) + "\nG1 X5");
    ASSERT_EQ(r.diagnostics.list().size(), 1u) << f.text;
    const Diagnostic& d = r.diagnostics.list()[0];
    EXPECT_EQ(d.code, f.code) << f.text << ": " << to_string(d);
    EXPECT_EQ(d.severity, Severity::error);
    EXPECT_EQ(d.where, Origin(TextLocation{"<text>", 1, f.column})) << f.text << ": " << to_string(d);
    EXPECT_TRUE(r.blocks[0].faulty);
    EXPECT_TRUE(r.blocks[0].words.empty());
    EXPECT_EQ(words_of(r.blocks[1]), "G1.000000 X5.000000") << f.text;
  }
  const std::string nul("G1 X1\0 Y2", 9);
  EXPECT_EQ(read(nul).diagnostics.list()[0].code, codes::bad_character);
  const std::string digits = "X" + std::string(2000, '0') + "1";
  EXPECT_EQ(read(digits).diagnostics.list()[0].code, codes::number_too_large);
}

TEST(Block, UnusualCommentsAreWarningsOrStrictErrors) {
  for (const bool strict : {false, true}) {
    const Severity severity = strict ? Severity::error : Severity::warning;
    const Reading open = read("G0 (open X1", {"<text>", 1000, strict});
    ASSERT_EQ(open.diagnostics.list().size(), 1u);
    EXPECT_EQ(open.diagnostics.list()[0].code, codes::comment_unclosed);
    EXPECT_EQ(open.diagnostics.list()[0].severity, severity);
    EXPECT_EQ(open.blocks[0].comments[0].text, "open X1");
    const Reading nested = read("(a (b) c) G0", {"<text>", 1000, strict});
    ASSERT_EQ(nested.diagnostics.list().size(), 1u);
    EXPECT_EQ(nested.diagnostics.list()[0].code, codes::comment_nested);
    EXPECT_EQ(nested.diagnostics.list()[0].severity, severity);
    EXPECT_EQ(nested.blocks[0].comments[0].text, "a (b) c");
    EXPECT_EQ(words_of(nested.blocks[0]), "G0.000000");
  }
  EXPECT_EQ(read("(a (b) G0").blocks[0].comments[0].text, "a (b");
}

TEST(Block, LongLinesAreRefused) {
  const std::string text = "G1" + std::string(200, ' ') + "X1\nG0";
  const Reading r = read(text, {"<text>", 100, false});
  ASSERT_EQ(r.diagnostics.list().size(), 1u);
  EXPECT_EQ(r.diagnostics.list()[0].code, codes::line_too_long);
  EXPECT_EQ(words_of(r.blocks[1]), "G0.000000");
}

/// Texts that take quadratic time if the reader looks ahead from every position.
TEST(Block, HostileTextsTakeLinearTime) {
  const auto repeated = [](std::string_view part, std::size_t bytes) {
    std::string text;
    while (text.size() < bytes) text += part;
    return text;
  };
  for (const std::string_view part :
       {"((a)", "O<a>(x)", "X1 (b) ", "\r", "[", "X[", "#", "X1 \t", "X[1]", "atan[1]/", "("}) {
    Diagnostics diagnostics;
    const std::string text = repeated(part, 4'000'000);
    BlockReader reader(text, {"<text>", text.size(), false}, diagnostics);
    std::size_t lines = 0;
    for (Block block; reader.next(block);) ++lines;
    EXPECT_GE(lines, 1u) << part;
  }
}

TEST(Block, ABlockDeleteMayHaveASwitchNumber) {
  for (const std::string_view text :
       {"/G0 X10 Y-.5", "/2G0 X10 Y-.5", "/2 G0 X10 Y-.5", "/12N5 G0 X10 Y-.5"}) {
    const Reading r = read(text);
    ASSERT_EQ(r.blocks.size(), 1u) << text;
    EXPECT_TRUE(r.blocks[0].optional) << text;
    EXPECT_EQ(words_of(r.blocks[0]), "G0.000000 X10.000000 Y-0.500000") << text;
    EXPECT_TRUE(r.diagnostics.list().empty()) << text;
  }
  EXPECT_EQ(read("/12N5 G0").blocks[0].number, 5.0);
}

}  // namespace
}  // namespace kerf::gcode

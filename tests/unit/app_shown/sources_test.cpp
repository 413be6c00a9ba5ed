// Texts in blocks: together they are the text, an edit changes the blocks around it alone, and each line is
// one line of a page.
#include "app/shown/sources.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <vector>

#include "base/system.h"

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

std::string joined(const std::vector<SourceBlock>& blocks) {
  std::string text;
  for (const SourceBlock& block : blocks) text += *block.text;
  return text;
}

std::size_t lines_of(const std::vector<SourceBlock>& blocks) {
  std::size_t sum = 0;
  for (const SourceBlock& block : blocks) sum += block.lines;
  return sum;
}

std::vector<std::string> program(int lines) {
  std::vector<std::string> out;
  for (int k = 0; k < lines; ++k)
    out.push_back(fmt::format("G1 X{} Y{}.{}", k * 7919 % 1000, k % 50, k % 13));
  return out;
}

std::string text_of(const std::vector<std::string>& lines, std::string_view end = "\n") {
  std::string text;
  for (const std::string& line : lines) text.append(line).append(end);
  return text;
}

std::set<std::string> texts_of(const std::vector<SourceBlock>& blocks) {
  std::set<std::string> out;
  for (const SourceBlock& block : blocks) out.insert(*block.text);
  return out;
}

TEST(BlocksOfLines, AreTheText) {
  EXPECT_TRUE(blocks_of_lines("").empty());
  for (const std::string_view end : {"\n", "\r\n", "\r"}) {
    const std::string text = text_of(program(20'000), end);
    const auto blocks = blocks_of_lines(text);
    EXPECT_GT(blocks.size(), 4u);
    EXPECT_EQ(joined(blocks), text);
    EXPECT_EQ(lines_of(blocks), 20'001u) << "with the empty one at the end";
    const auto open = blocks_of_lines(text.substr(0, text.size() - end.size()));
    EXPECT_EQ(lines_of(open), 20'000u);
  }
}

TEST(BlocksOfLines, AnInsertedLineChangesItsBlock) {
  std::vector<std::string> lines = program(50'000);
  const auto before = texts_of(blocks_of_lines(text_of(lines)));
  lines.insert(lines.begin() + 25'000, "G1 X5 F300");
  std::size_t changed = 0;
  for (const std::string& text : texts_of(blocks_of_lines(text_of(lines)))) changed += 1 - before.count(text);
  EXPECT_GE(changed, 1u);
  EXPECT_LE(changed, 2u);
}

TEST(BlocksOfLines, OfVeryLongLinesTheStartIsKept) {
  std::string text = "first\n";
  for (int k = 0; k < 1'000'000; ++k) text += "\xc3\xa4";  // in two bytes
  text += "\nlast";
  const auto blocks = blocks_of_lines(text);
  EXPECT_EQ(lines_of(blocks), 3u);
  const std::string kept = joined(blocks);
  EXPECT_LT(kept.size(), 20'000u);
  EXPECT_EQ(kept.substr(0, 8), "first\n\xc3\xa4");
  EXPECT_EQ(kept.substr(kept.size() - 7), "\xc3\xa4\nlast");
}

TEST(Sources, KeepTheIdsOfUnchangedBlocks) {
  const TemporaryFolder folder("kerf-sources-");
  const std::string file = folder.path() + "/part.nc";
  const auto write = [&](const std::string& text) {
    Diagnostics diagnostics;
    OutputSet files;
    ASSERT_TRUE(files.write(file, text, diagnostics) && files.commit(diagnostics));
  };
  std::vector<std::string> lines = program(30'000);
  write(text_of(lines));
  Sources first;
  first.read({file}, 1000);
  first.take_ids({});
  lines.front() = "G20";
  write(text_of(lines));
  Sources second;
  second.read({file}, 1000);
  second.take_ids({&first});
  const std::vector<SourceBlock>&before = first.files()[0].blocks, &after = second.files()[0].blocks;
  ASSERT_EQ(before.size(), after.size());
  EXPECT_NE(before[0].id, after[0].id);
  for (std::size_t k = 1; k < before.size(); ++k) EXPECT_EQ(before[k].id, after[k].id);
  EXPECT_EQ(first.find(after[0].id), nullptr) << "a changed block has an id of its own";
  EXPECT_EQ(second.find(after[0].id)->substr(0, 4), "G20\n");
  EXPECT_NE(second.record_with_texts().text(Layout::line).find("\"text\":\"G20\\nG1 "), std::string::npos);
}

}  // namespace
}  // namespace kerf::app::view

// Zip archives: written ones are read back, damaged ones are refused.
#include "codec/zip/zip.h"

#include <gtest/gtest.h>

namespace kerf::zip {
namespace {

const std::string kLong(200'000, 'x');  // more than one buffer

std::string archive() {
  Writer writer;
  writer.begin("First.txt");
  writer.write("one, ");
  writer.write("two");
  writer.end();
  writer.begin("folder/second.txt", Writer::Size::large);
  writer.write(kLong);
  writer.end();
  return writer.finish();
}

std::string unpacked(Reader& reader, const std::string& name, bool& whole) {
  std::string out;
  whole = reader.unpack(name, [&](std::string_view piece, bool) {
    out += piece;
    return true;
  });
  return out;
}

TEST(Zip, ReadsBack) {
  const std::string bytes = archive();
  Reader reader(bytes);
  ASSERT_TRUE(reader.is_zip());
  bool whole = false;
  EXPECT_EQ(unpacked(reader, "FIRST.TXT", whole), "one, two");
  EXPECT_TRUE(whole);
  EXPECT_EQ(unpacked(reader, "folder/second.txt", whole), kLong);
  EXPECT_TRUE(whole);
  unpacked(reader, "third.txt", whole);
  EXPECT_FALSE(whole);
  EXPECT_EQ(archive(), bytes);  // without a date
}

TEST(Zip, TheFirstFileUpToALimit) {
  const std::string bytes = archive();
  EXPECT_EQ(Reader(bytes).first(8), "one, two");
  EXPECT_EQ(Reader(bytes).first(7), std::nullopt);
}

TEST(Zip, ReadingCanStopEarly) {
  const std::string bytes = archive();
  Reader reader(bytes);
  std::size_t got = 0;
  EXPECT_TRUE(reader.unpack("folder/second.txt", [&](std::string_view piece, bool) {
    got += piece.size();
    return false;
  }));
  EXPECT_LT(got, kLong.size());
}

TEST(Zip, DamagedArchives) {
  EXPECT_FALSE(Reader("").is_zip());
  EXPECT_FALSE(Reader("PK\x03\x04 no zip").is_zip());
  EXPECT_EQ(Reader("no zip").first(100), std::nullopt);
  std::string bytes = archive();
  EXPECT_FALSE(Reader(std::string_view(bytes).substr(0, bytes.size() - 30)).is_zip());
  bytes[45] = static_cast<char>(bytes[45] ^ 0x10);  // within the first file's content
  EXPECT_EQ(Reader(bytes).first(100), std::nullopt);
}

}  // namespace
}  // namespace kerf::zip

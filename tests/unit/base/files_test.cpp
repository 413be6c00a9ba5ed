// Files: unreadable ones are errors with their path; outputs appear complete and together or not at all.
#include "base/codes/files.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "kerf/base/files.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  Files() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("kerf_files_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Files() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// False where there are no symbolic links.
  bool make_link(const std::string& target, const std::string& name) const {
    std::error_code failed;
    fs::create_symlink(target, path(name), failed);
    return !failed;
  }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
  Diagnostics diagnostics_;
};

TEST_F(Files, ReadsBytesAsTheyAre) {
  const std::string bytes("G1 X1\r\n\0\xff", 9);
  std::ofstream(path("a.nc"), std::ios::binary) << bytes;
  std::ofstream(path("empty.nc"), std::ios::binary);
  const auto file = InputFile::open(path("a.nc"), diagnostics_);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->bytes(), bytes);
  const auto empty = InputFile::open(path("empty.nc"), diagnostics_);
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->bytes(), "");
  EXPECT_TRUE(diagnostics_.list().empty());
}

/// Not mapped: an editor that saves over the file shortens it first.
TEST_F(Files, BytesOfLargeFilesStayWhenTheFileIsShortened) {
  const std::string bytes(std::size_t{40} << 20, 'G');
  std::ofstream(path("large.nc"), std::ios::binary) << bytes;
  const auto file = InputFile::open(path("large.nc"), diagnostics_);
  ASSERT_TRUE(file);
  std::filesystem::resize_file(path("large.nc"), 10);
  EXPECT_TRUE(file->bytes() == bytes);
}

TEST_F(Files, MissingFilesAndFoldersAreUnreadable) {
  EXPECT_FALSE(InputFile::open(path("missing.nc"), diagnostics_));
  EXPECT_FALSE(InputFile::open(folder_.string(), diagnostics_));
  ASSERT_EQ(diagnostics_.errors(), 2u);
  for (const Diagnostic& d : diagnostics_.list()) EXPECT_EQ(d.code, codes::file_unreadable);
  EXPECT_EQ(std::get<TextLocation>(diagnostics_.list()[0].where).file, path("missing.nc"));
}

TEST_F(Files, LargerThanTheLimitIsRefused) {
  std::ofstream(path("a.nc")) << "0123456789";
  EXPECT_TRUE(InputFile::open(path("a.nc"), diagnostics_, 10));
  EXPECT_FALSE(InputFile::open(path("a.nc"), diagnostics_, 9));
  ASSERT_EQ(diagnostics_.errors(), 1u);
  EXPECT_EQ(diagnostics_.list()[0].code, codes::file_too_large);
}

TEST_F(Files, AnEndlessDeviceIsRefusedAtTheLimit) {
  if (!fs::exists("/dev/zero")) GTEST_SKIP() << "no /dev/zero here";
  EXPECT_FALSE(InputFile::open("/dev/zero", diagnostics_, 1 << 20));
  ASSERT_EQ(diagnostics_.errors(), 1u);
  EXPECT_EQ(diagnostics_.list()[0].code, codes::file_too_large);
}

class StoppedAtOnce : public Progress {
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return true; }
};

TEST_F(Files, ReadingAStreamCanBeStopped) {
  if (!fs::exists("/dev/zero")) GTEST_SKIP() << "no /dev/zero here";
  StoppedAtOnce progress;
  EXPECT_FALSE(InputFile::open("/dev/zero", diagnostics_, std::size_t{4} << 30, &progress));
  ASSERT_EQ(diagnostics_.errors(), 1u);
  EXPECT_EQ(diagnostics_.list()[0].code, codes::stopped);
}

TEST_F(Files, ALinkStaysAndItsTargetIsReplaced) {
  std::ofstream(path("a.txt")) << "old";
  if (!make_link("a.txt", "link.txt")) GTEST_SKIP() << "no symbolic links here";
  OutputSet outputs;
  ASSERT_TRUE(outputs.write(path("link.txt"), "new", diagnostics_));
  ASSERT_TRUE(outputs.commit(diagnostics_));
  EXPECT_TRUE(fs::is_symlink(path("link.txt")));
  EXPECT_EQ(content("a.txt"), "new");
  EXPECT_EQ(count(), 2u);
}

TEST_F(Files, ADeviceIsWrittenToAndStaysOne) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  ASSERT_TRUE(make_link("/dev/full", "full.txt"));
  OutputSet outputs;
  ASSERT_TRUE(outputs.write(path("full.txt"), "x", diagnostics_));
  EXPECT_FALSE(outputs.commit(diagnostics_));
  ASSERT_EQ(diagnostics_.errors(), 1u);
  EXPECT_EQ(diagnostics_.list()[0].code, codes::file_unwritable);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, OutputsAppearTogetherOnCommit) {
  std::ofstream(path("a.txt")) << "old";
  OutputSet outputs;
  ASSERT_TRUE(outputs.write(path("a.txt"), "new", diagnostics_));
  ASSERT_TRUE(outputs.write(path("b.txt"), "second", diagnostics_));
  EXPECT_EQ(content("a.txt"), "old");
  EXPECT_FALSE(fs::exists(path("b.txt")));
  ASSERT_TRUE(outputs.commit(diagnostics_));
  EXPECT_EQ(content("a.txt"), "new");
  EXPECT_EQ(content("b.txt"), "second");
  EXPECT_EQ(count(), 2u);
}

TEST_F(Files, WithoutACommitNothingIsLeft) {
  {
    OutputSet outputs;
    ASSERT_TRUE(outputs.write(path("a.txt"), "x", diagnostics_));
    EXPECT_EQ(count(), 1u);
  }
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, AnUnwritableFolderIsAnError) {
  {
    OutputSet outputs;
    EXPECT_FALSE(outputs.write(path("no/such/folder/a.txt"), "x", diagnostics_));
    fs::create_directories(path("taken/inside"));
    ASSERT_TRUE(outputs.write(path("first"), "x", diagnostics_));
    ASSERT_TRUE(outputs.write(path("taken"), "x", diagnostics_));
    EXPECT_FALSE(outputs.commit(diagnostics_));
  }
  ASSERT_EQ(diagnostics_.errors(), 2u);
  for (const Diagnostic& d : diagnostics_.list()) EXPECT_EQ(d.code, codes::file_unwritable);
  EXPECT_EQ(count(), 1u) << "only the folder that was in the way";
}

TEST_F(Files, ALinkIsFollowed) {
  fs::create_directories(path("folder"));
  if (!make_link("folder/real.txt", "link.txt")) GTEST_SKIP() << "no symbolic links here";
  for (const char* text : {"first", "second"}) {  // the second time the file is there already
    auto file = OutputFile::create(path("link.txt"), diagnostics_);
    ASSERT_TRUE(file.has_value());
    ASSERT_TRUE(file->write(text, diagnostics_));
    ASSERT_TRUE(file->commit(diagnostics_));
    EXPECT_TRUE(fs::is_symlink(path("link.txt")));
    EXPECT_EQ(content("folder/real.txt"), text);
  }
}

#if !defined(_WIN32)
TEST_F(Files, DevicesAndPipesAreWrittenAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  OutputSet outputs;
  EXPECT_TRUE(outputs.write(path("pipe"), "text", diagnostics_));
  EXPECT_TRUE(outputs.commit(diagnostics_));
  char got[8] = {};
  EXPECT_EQ(::read(reader, got, sizeof got), 4);
  ::close(reader);
  EXPECT_STREQ(got, "text");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(count(), 1u);
}
#endif

}  // namespace
}  // namespace kerf

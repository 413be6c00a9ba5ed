// What differs between operating systems: folders, stamps, random numbers, processes.
#include "base/system.h"

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "base/process.h"

#include "kerf/base/files.h"

namespace kerf {
namespace {

#if defined(_WIN32)
constexpr const char *kSayVariable = "echo %KERF_WORD%", *kLong = "ping -n 60 127.0.0.1";
std::vector<std::string> shell(const std::string& text) { return {"cmd", "/c", text}; }
#else
constexpr const char *kSayVariable = "echo \"$KERF_WORD\"", *kLong = "sleep 60";
std::vector<std::string> shell(const std::string& text) { return {"sh", "-c", text}; }
#endif

std::string content(const std::string& path) {
  Diagnostics diagnostics;
  const auto file = InputFile::open(path, diagnostics);
  std::string text = file ? std::string(file->bytes()) : "unreadable";
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

TEST(System, RandomBytesDiffer) {
  std::array<unsigned char, 32> a{}, b{};
  EXPECT_TRUE(fill_with_random_bytes(a));
  EXPECT_TRUE(fill_with_random_bytes(b));
  EXPECT_NE(a, b);
  EXPECT_NE(a, (std::array<unsigned char, 32>{}));
}

TEST(System, NamesTheRunningProgram) {
  const auto file = command_file();
  ASSERT_TRUE(file);
  EXPECT_EQ(std::filesystem::path(*file).stem().string(), "test_base");
}

TEST(System, TemporaryFoldersAreRemoved) {
  std::string path;
  {
    const TemporaryFolder folder("kerf-test");
    path = folder.path();
    ASSERT_FALSE(path.empty());
    EXPECT_TRUE(is_writable(path));
    EXPECT_FALSE(make_private_folder(path));
    std::ofstream(path + "/file") << "text";
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(System, AStampChangesWithTheFile) {
  const TemporaryFolder folder("kerf-test");
  const std::string path = folder.path() + "/\xc3\xa9.nc";
  const std::filesystem::path file = std::u8string(path.begin(), path.end());
  EXPECT_FALSE(file_stamp(path).exists);
  std::ofstream(file) << "M2";
  const FileStamp first = file_stamp(path);
  EXPECT_TRUE(first.exists);
  EXPECT_EQ(first, file_stamp(path));
  std::ofstream(file) << "M30";
  EXPECT_NE(first, file_stamp(path));
}

TEST(Process, HasAnExitStatus) {
  const ProcessEnd end = run_process(shell("exit 3"), {});
  EXPECT_EQ(end.kind, ProcessEnd::Kind::exited);
  EXPECT_EQ(end.number, 3);
}

TEST(Process, AMissingProgramIsReported) {
  EXPECT_EQ(run_process({"kerf-no-such-program"}, {}).kind, ProcessEnd::Kind::not_found);
}

TEST(Process, OutputAndVariablesAreThoseOfTheOptions) {
  const TemporaryFolder folder("kerf-test");
  ProcessOptions options;
  options.environment = {{"KERF_WORD", "two words"}};
  options.output_file = folder.path() + "/\xc3\xa4 \xe6\x97\xa5.txt";
  EXPECT_EQ(run_process(shell(kSayVariable), options).kind, ProcessEnd::Kind::exited);
  EXPECT_EQ(content(options.output_file), "two words");
}

TEST(Process, EndsWhenItIsStopped) {
  class Stopped final : public Progress {
    void phase(std::string_view) override {}
    void report(double) override {}
    bool stop_requested() override { return true; }
  } progress;
  ProcessOptions options;
  options.progress = &progress;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run_process(shell(kLong), options).kind, ProcessEnd::Kind::stopped);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

}  // namespace
}  // namespace kerf

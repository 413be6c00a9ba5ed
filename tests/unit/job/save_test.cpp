// A job from a file and its files, one call each.
#include "kerf/job/save.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "base/codes/files.h"
#include "base/codes/gcode.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

class SaveTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("kerf-save-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "part.nc")
        << "G21 G90\nT1 M6\nM3 S10000\nG0 X0 Y0 Z5\nG1 Z-1 F200\nG1 X20\nG0 Z5\nM2\n";
    add_tool("square d=3", {}, options_.job.tools, diagnostics_);
  }
  std::string in(const char* name) const { return (folder_ / name).string(); }
  std::optional<Job> job() { return load_job(in("part.nc"), options_, diagnostics_); }

  fs::path folder_;
  LoadOptions options_;
  Diagnostics diagnostics_;
};

TEST_F(SaveTest, WritesAPartAndItsProgram) {
  const auto made = job();
  ASSERT_TRUE(made);
  EXPECT_TRUE(save_part(*made, {in("a.stl"), in("a.png")}, {.run = {.resolution = mm(0.2)}}, diagnostics_));
  EXPECT_TRUE(save_program(made->program, "grbl", in("out.nc"), {}, diagnostics_));
  EXPECT_FALSE(diagnostics_.has_errors());
  for (const char* name : {"a.stl", "a.png", "out.nc"}) EXPECT_TRUE(fs::exists(in(name))) << name;
  const auto again = load_job(in("out.nc"), options_, diagnostics_);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->report.all.cut_mm, made->report.all.cut_mm);
}

/// The tool of the job, whose program has no tool change, is a comment of the file and not a change.
TEST_F(SaveTest, ASavedProgramHasTheToolsAndTheStockOfItsJob) {
  std::ofstream(folder_ / "part.nc") << "G21 G90\nM3 S10000\nG0 X0 Y0 Z5\nG1 Z-1 F200\nG1 X20\nG0 Z5\nM2\n";
  options_.job.stock = Stock{{{-5, -5, -3}, {30, 5, 0}}};
  const auto made = job();
  ASSERT_TRUE(made);
  ASSERT_EQ(made->program.path[0].kind(), StepKind::tool_change);
  for (const char* target : {"linuxcnc", "grbl", "marlin"}) {
    ASSERT_TRUE(save_program(*made, target, in("out.nc"), {}, diagnostics_)) << target;
    const auto read = load_program(in("out.nc"), {}, diagnostics_);
    ASSERT_TRUE(read);
    EXPECT_FALSE(read->path.has(StepKind::tool_change)) << target;
    const auto again = load_job(in("out.nc"), {}, diagnostics_);
    ASSERT_TRUE(again) << target;
    ASSERT_TRUE(again->start_tool) << target;
    const Tool* tool = again->tools.find(*again->start_tool);
    ASSERT_NE(tool, nullptr);
    EXPECT_EQ(tool->diameter, mm(3));
    ASSERT_TRUE(again->stock);
    EXPECT_EQ(again->stock_source, StockSource::program) << target;
    EXPECT_EQ(again->stock->block.low.x, -5.0) << target;
  }
}

TEST_F(SaveTest, AProgramWithErrorsIsNoJob) {
  std::ofstream(folder_ / "part.nc") << "G1 X\n";
  EXPECT_FALSE(job());
  EXPECT_TRUE(diagnostics_.has_errors());
  EXPECT_FALSE(load_job(in("missing.nc"), options_, diagnostics_));
}

/// Stops from the call with this number on.
struct StopsAtCall : Progress {
  explicit StopsAtCall(int number) : left(number) {}
  void phase(std::string_view) override { --left; }
  void report(double) override { --left; }
  bool stop_requested() override { return --left <= 0; }
  bool has_stopped() const { return left <= 0; }
  int left;
};

/// Wherever saving is stopped, there is no file, not even the one that is complete.
TEST_F(SaveTest, AStoppedPartHasNoFile) {
  const auto made = job();
  ASSERT_TRUE(made);
  const SaveOptions options{.run = {.resolution = mm(0.5), .threads = 1}};
  bool saved = false;
  int number = 1;
  for (; !saved && number < 100'000; ++number) {
    StopsAtCall progress(number);
    saved = save_part(*made, {in("a.stl"), in("b.png")}, options, diagnostics_, &progress);
    ASSERT_EQ(saved, !progress.has_stopped()) << number;
    for (const char* name : {"a.stl", "b.png"}) ASSERT_EQ(fs::exists(in(name)), saved) << number;
  }
  EXPECT_TRUE(saved);
  EXPECT_GT(number, 3);
}

/// Files that a job names are beside it, wherever the command runs.
TEST_F(SaveTest, FilesOfAJobAreInItsFolder) {
  const std::string start =
      "[tools]\n1 = \"square d=1\"\n[[operation]]\nop = \"engrave\"\ntool = 1\ndepth = 1\nfeed = 600\n";
  for (const auto& [name, text] :
       {std::pair("none.ttf", "[[shape]]\ntext = \"H\"\nfont = \"none.ttf\"\nheight = 20\n"),
        std::pair("none.png", "[[shape]]\npicture = \"none.png\"\npicture-width = 20\n"),
        std::pair("none.stl", "[surface]\nfile = \"none.stl\"\n")}) {
    std::ofstream(folder_ / "job.toml") << start << text;
    Diagnostics diagnostics;
    EXPECT_FALSE(load_job(in("job.toml"), options_, diagnostics)) << name;
    std::string all;
    for (const Diagnostic& d : diagnostics.list()) all += to_string(d) + '\n';
    EXPECT_NE(all.find(in(name)), std::string::npos) << name << "\n" << all;
  }
}

TEST_F(SaveTest, AnUnknownEndingOrTargetWritesNothing) {
  const auto made = job();
  ASSERT_TRUE(made);
  EXPECT_FALSE(save_part(*made, {in("a.stl"), in("a.doc")}, {}, diagnostics_));
  EXPECT_EQ(diagnostics_.list().back().code, codes::output_kind_unknown);
  EXPECT_FALSE(save_program(made->program, "gbrl", in("out.nc"), {}, diagnostics_));
  EXPECT_EQ(diagnostics_.list().back().code, codes::post_unknown);
  EXPECT_FALSE(fs::exists(in("a.stl")) || fs::exists(in("out.nc")));
}

}  // namespace
}  // namespace kerf

// A program that is edited on the workbench: its part against one that is read and cut at once, its errors,
// and what is refused.
#include "app/browser/workbench.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <optional>
#include <string>

#include "base/system.h"

namespace kerf::app::view {
namespace {

/// A slot of 30 x 3.175 mm, `depth` mm deep, in a plate of 40 x 30 x 6 mm.
std::string slot(const std::string& depth) {
  return "(stockMin:0.00mm, 0.00mm, -6.00mm)\n(stockMax:40.00mm, 30.00mm, 0.00mm)\nG21 G90 G17\nT102 M6\n"
         "M3 S10000\nG0 X5 Y10 Z5\nG1 Z-" +
         depth + " F100\nG1 X35 F400\nG0 Z5\nM2\n";
}

class WorkbenchTest : public ::testing::Test {
 protected:
  WorkbenchTest() {
    EXPECT_FALSE(temporary_.path().empty());
    bench_.emplace(folder_);
  }

  bool show(const std::string& name, const std::string& text) {
    return bench_->put(name, text) && bench_->load(name, nullptr);
  }

  TemporaryFolder temporary_{"kerf-bench"};
  std::string folder_ = temporary_.path() + "/";
  std::optional<Workbench> bench_;
};

TEST_F(WorkbenchTest, AnEditedPartIsThatOfAFreshRun) {
  ASSERT_TRUE(show("slot.nc", slot("1")));
  EXPECT_EQ(bench_->shown().revision, 1u);
  ASSERT_TRUE(show("slot.nc", slot("2.5")));
  EXPECT_EQ(bench_->shown().revision, 2u);
  Workbench fresh(folder_);
  ASSERT_TRUE(fresh.load("slot.nc", nullptr));
  // As sets of triangles: tiles after an edit keep their order.
  EXPECT_EQ(bench_->shown().tiles.triangles(), fresh.shown().tiles.triangles());
  const auto removed = [](const Workbench& bench) {
    const std::string& model = bench.shown().model;
    const std::size_t at = model.find("\"removed_mm3\":", model.find("\"volumes\""));
    return std::strtod(model.c_str() + at + 14, nullptr);
  };
  EXPECT_EQ(removed(*bench_), removed(fresh));
  // 2.5 mm deep: a rectangle and two half circles.
  EXPECT_NEAR(removed(fresh), 2.5 * (30 * 3.175 + 3.14159265 * 3.175 * 3.175 / 4), 0.5);
}

TEST_F(WorkbenchTest, WhatAProgramPrintsIsShownUntilTheNext) {
  const std::string motion = "feedrate(100mm);\ngoto([0mm, 0mm, 5mm]);\nmove([5mm, 0mm, -1mm]);\n";
  ASSERT_TRUE(show("a.gcmc", motion + "message(\"depth \", 2mm);\n"));
  EXPECT_NE(bench_->shown().console.find("a.gcmc:4:"), std::string::npos);
  EXPECT_NE(bench_->shown().console.find("Runtime message(): depth 2mm\n"), std::string::npos);
  EXPECT_FALSE(show("a.gcmc", "message(\"before\");\nmove(nothing);\n"));
  EXPECT_NE(bench_->shown().console.find("Runtime message(): before\n"), std::string::npos);
  ASSERT_TRUE(show("a.gcmc", motion));
  EXPECT_EQ(bench_->shown().console, "");
}

TEST_F(WorkbenchTest, AnErrorLeavesThePartUntilItIsRepaired) {
  ASSERT_TRUE(show("slot.nc", slot("1")));
  EXPECT_FALSE(show("slot.nc", slot("1 [")));
  EXPECT_EQ(bench_->shown().state, State::failed);
  EXPECT_EQ(bench_->shown().revision, 1u);
  EXPECT_NE(bench_->event().find("slot.nc\",\"line\":7"), std::string::npos) << bench_->event();
  ASSERT_TRUE(show("slot.nc", slot("1")));
  EXPECT_EQ(bench_->shown().state, State::ready);
  EXPECT_EQ(bench_->shown().errors, "[]");
}

TEST_F(WorkbenchTest, AnIncludedFileIsFoundBesideTheProgram) {
  ASSERT_TRUE(bench_->put("depth.gcmc", "DEPTH = -1mm;\n"));
  EXPECT_TRUE(show("slot.gcmc",
                   "include(\"depth.gcmc\");\ngoto([-, -, 5mm]);\ngoto([5mm, 5mm]);\nfeedrate(300mm);\n"
                   "move([-, -, DEPTH]);\nmove([25mm, 5mm]);\ngoto([-, -, 5mm]);\n"))
      << bench_->event();
  EXPECT_EQ(bench_->shown().job->program.files.size(), 2u);
}

TEST_F(WorkbenchTest, StatesAndDownloads) {
  EXPECT_FALSE(bench_->at(1, 0).has_value());
  EXPECT_FALSE(bench_->download({"stl", "", ""}).problem.empty());
  ASSERT_TRUE(show("slot.nc", slot("1")));
  const auto state = bench_->at(1, kWholeJob);
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->substr(0, 4), "KMSH");
  const Download gcode = bench_->download({"gcode", "grbl", ""});
  EXPECT_EQ(gcode.problem, "");
  EXPECT_EQ(gcode.name, "slot.nc");
  EXPECT_NE(gcode.bytes.find("G1"), std::string::npos);
  EXPECT_TRUE(bench_->make_exact(nullptr));
  EXPECT_NE(bench_->shown().exact, nullptr);
}

TEST_F(WorkbenchTest, WhatCannotBeShownIsRefused) {
  EXPECT_FALSE(show("script.py", "print(1)\n"));
  EXPECT_NE(bench_->event().find("Python"), std::string::npos);
  EXPECT_FALSE(show("missing.gcmc", "include(\"none.gcmc\");\n"));
  EXPECT_FALSE(bench_->load("never.nc", nullptr));
  // No name leads out of the folder.
  ASSERT_TRUE(bench_->put("../../outside.nc", slot("1")));
  EXPECT_TRUE(std::filesystem::exists(folder_ + "_.._.._outside.nc"));
}

}  // namespace
}  // namespace kerf::app::view

// Live jobs against fresh ones, over many edits of a program's text.
#include "kerf/job/live_job.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

#include "base/codes/files.h"
#include "base/system.h"

#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

const char* const kHead =
    "(stockMin:0mm, 0mm, -8mm)\n(stockMax:60mm, 40mm, 0mm)\nG21 G90 G17\nM6 T102\nM3 S10000\nG0 Z5\n";

/// A program with a line for each motion, edited at random.
class EditedProgram {
 public:
  explicit EditedProgram(unsigned seed) : random_(seed) {
    for (int k = 0; k < 40; ++k) lines_.push_back(line());
  }
  void edit() {
    const std::size_t at = random_() % lines_.size();
    const auto here = lines_.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random_() % 5) {
      case 0: lines_.insert(here, line()); break;
      case 1:
        if (lines_.size() > 5) lines_.erase(here);
        break;
      case 2: std::swap(lines_[at], lines_[random_() % lines_.size()]); break;
      case 3: lines_.insert(here, random_() % 2 == 0 ? "M6 T101" : "M6 T102"); break;
      default: lines_[at] = line();
    }
  }
  std::string text() const {
    std::string out = kHead;
    for (const std::string& line : lines_) out += line + "\n";
    return out + "M2\n";
  }

 private:
  std::string line() {
    const auto number = [&](double low, double high) {
      return std::to_string(std::uniform_real_distribution<double>(low, high)(random_));
    };
    const std::string xy = "X" + number(-4, 64) + " Y" + number(-4, 44);
    switch (random_() % 6) {
      case 0: return "G0 Z" + number(-2, 5);
      case 1: return "G1 Z" + number(-7, 0) + " F200";
      case 2: return "G0 " + xy;
      case 3: return "G2 " + xy + " R" + number(40, 90) + " F400";
      default: return "G1 " + xy + " Z" + number(-6, 1) + " F400";
    }
  }
  std::mt19937 random_;
  std::vector<std::string> lines_;
};

std::shared_ptr<const Job> job_of(const std::string& text, Diagnostics& diagnostics) {
  const auto file =
      std::filesystem::temp_directory_path() / ("kerf_live_job_" + std::to_string(process_number()) + ".nc");
  std::ofstream(file) << text;
  auto program = load_program(file.string(), {}, diagnostics);
  std::filesystem::remove(file);
  return std::make_shared<const Job>(make_job(std::move(*program), {}, UnknownTool::assume, diagnostics));
}

/// The largest difference of heights, mm; infinite where the numbers of intervals differ.
double difference(const ColumnGrid& a, const ColumnGrid& b) {
  if (a.first != b.first) return INFINITY;
  double largest = 0.0;
  for (std::size_t k = 0; k < a.intervals.size(); ++k)
    largest = std::max({largest, std::abs(static_cast<double>(a.intervals[k].low - b.intervals[k].low)),
                        std::abs(static_cast<double>(a.intervals[k].high - b.intervals[k].high))});
  return largest;
}

/// Kind and step of the findings in the material, without the stopped spindle, which check_job() takes from
/// the path.
std::vector<std::pair<std::string, std::size_t>> in_material(const std::vector<Finding>& findings) {
  std::vector<std::pair<std::string, std::size_t>> list;
  for (const Finding& f : findings)
    if (f.depth_mm > 0.0 && f.kind != "spindle_off") list.emplace_back(f.kind, f.step);
  std::sort(list.begin(), list.end());
  return list;
}

TEST(LiveJob, IsTheFreshRunAfterEveryOf200Edits) {
  EditedProgram program(20261);
  LiveJob live;
  const RunOptions how{.resolution = mm(0.25), .threads = 1};
  std::size_t redone = 0, all = 0, findings = 0;
  for (int k = 0; k < 200; ++k) {
    Diagnostics diagnostics, of_fresh;
    const auto job = job_of(program.text(), diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list().front());
    const auto change = live.update(job, how, {}, diagnostics);
    ASSERT_TRUE(change);
    EXPECT_EQ(live.kind(), LiveKind::milling);
    const auto fresh = run_job(*job, how, of_fresh);
    ASSERT_TRUE(fresh);
    EXPECT_LT(difference(live.cut()->workpiece()->grid(), fresh->milling().workpiece.grid()), 2e-4) << k;
    EXPECT_EQ(in_material(live.findings()), in_material(fresh->findings)) << k;
    findings += in_material(live.findings()).size();
    for (const ColumnBlock& block : change->columns) redone += static_cast<std::size_t>(block.nx * block.ny);
    all += 240 * 160;
    program.edit();
  }
  EXPECT_LT(redone, all);
  EXPECT_GT(findings, 200u);
}

TEST(LiveJob, StartsOverWithAnotherStockAndResolution) {
  Diagnostics diagnostics;
  EditedProgram program(7);
  LiveJob live;
  const auto job = job_of(program.text(), diagnostics);
  EXPECT_TRUE(live.update(job, {.resolution = mm(0.5)}, {}, diagnostics)->is_new);
  EXPECT_FALSE(live.update(job, {.resolution = mm(0.5)}, {}, diagnostics)->is_new);
  EXPECT_TRUE(live.update(job, {.resolution = mm(0.4)}, {}, diagnostics)->is_new);
  auto other = std::make_shared<Job>(*job);
  other->stock->block.high.z = 1.0;
  EXPECT_TRUE(live.update(other, {.resolution = mm(0.4)}, {}, diagnostics)->is_new);
  EXPECT_EQ(live.cut()->workpiece()->bounds().high.z, 1.0);
}

TEST(LiveJob, KeepsTheLastRunAfterAnErrorAndWhenStopped) {
  Diagnostics diagnostics, bad;
  EditedProgram program(8);
  LiveJob live;
  const auto job = job_of(program.text(), diagnostics);
  ASSERT_TRUE(live.update(job, {.resolution = mm(0.5)}, {}, diagnostics));
  const std::size_t findings = live.findings().size();
  bad.error(codes::usage, {}, "an error");
  EXPECT_FALSE(live.update(job, {.resolution = mm(0.5)}, {}, bad));
  struct Stopped : Progress {
    void phase(std::string_view) override {}
    void report(double) override {}
    bool stop_requested() override { return true; }
  } stopped;
  program.edit();
  Diagnostics fine;
  const auto next = job_of(program.text(), fine);
  EXPECT_FALSE(live.update(next, {.resolution = mm(0.5)}, {}, fine, &stopped));
  EXPECT_EQ(live.job(), job);
  EXPECT_EQ(live.findings().size(), findings);
  ASSERT_TRUE(live.update(next, {.resolution = mm(0.5)}, {}, fine));
  const auto fresh = run_job(*next, {.resolution = mm(0.5)}, fine);
  EXPECT_LT(difference(live.cut()->workpiece()->grid(), fresh->milling().workpiece.grid()), 2e-4);
}

TEST(LiveJob, OfAProgramWithoutStockIsItsPathAlone) {
  Diagnostics diagnostics;
  LiveJob live;
  const auto file = std::filesystem::temp_directory_path() / "kerf_live_rapids.nc";
  std::ofstream(file) << "G21 G90\nG0 X1 Y1 Z1\nG0 X5\nM2\n";
  auto program = load_program(file.string(), {}, diagnostics);
  std::filesystem::remove(file);
  const auto job =
      std::make_shared<const Job>(make_job(std::move(*program), {}, UnknownTool::assume, diagnostics));
  ASSERT_TRUE(live.update(job, {}, {}, diagnostics));
  EXPECT_EQ(live.kind(), LiveKind::path_only);
  EXPECT_EQ(live.cut(), nullptr);
}

}  // namespace
}  // namespace kerf

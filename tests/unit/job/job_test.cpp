// Jobs through the public headers alone: load, choose, run, check, write, post.
#include "kerf/job/job.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "base/codes/files.h"

#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram =
    "(STOCK/BLOCK, 20, 10, 5, 0, 0, 5)\nG21 G90\nT102 M6\nM3 S9000\nG0 X5 Y5 Z2\nG1 Z-2 F100\nG0 "
    "Z2\nM5\nM2\n";
const ProgramOptions kDefaults;
constexpr double kHole = 3.14159265 / 4.0 * 3.175 * 3.175 * 2.0;  // mm3

/// A folder of its own, removed at the end.
class JobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("kerf-job-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "library");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    std::ofstream(path) << text;
    return path.string();
  }
  std::string path_of(const std::string& name) const { return (folder_ / name).string(); }

  Job job_of(const std::string& text, const JobSettings& settings = {},
             UnknownTool unknown = UnknownTool::error) {
    auto program = load_program(write("part.nc", text), kDefaults, diagnostics_);
    return make_job(std::move(*program), settings, unknown, diagnostics_);
  }

  Diagnostics diagnostics_;

 private:
  fs::path folder_;
};

TEST_F(JobTest, ListsEveryFileThatAProgramWasReadFrom) {
  write("library/depth.inc.gcmc", "depth = 2mm;\n");
  write("beside.gcmc", "include(\"depth.inc.gcmc\");\n");
  const std::string main = write("part.gcmc",
                                 "include(\"beside.gcmc\");\ninclude(\"varcs.inc.gcmc\");\nfeedrate(100mm);\n"
                                 "goto([0mm,0mm,5mm]);\nmove([-,-,-depth]);\n");
  ProgramOptions options;
  options.include_paths = {path_of("library")};
  const auto program = load_program(main, options, diagnostics_);
  ASSERT_TRUE(program && !diagnostics_.has_errors()) << to_string(diagnostics_.list().front());
  std::vector<std::string> names;
  for (const std::string& file : program->files) names.push_back(fs::path(file).filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"part.gcmc", "beside.gcmc", "depth.inc.gcmc"}));
  EXPECT_EQ(program->files.front(), main);
}

TEST_F(JobTest, ListsSubroutinesBesideAGcodeProgram) {
  const std::string sub = write("hole.ngc", "o<hole> sub\nG1 Z-1 F100\nG0 Z2\no<hole> endsub\nM2\n");
  const std::string main = write("part.ngc", "G21 G90\nG0 X0 Y0 Z2\no<hole> call\no<hole> call\nM2\n");
  const auto program = load_program(main, kDefaults, diagnostics_);
  ASSERT_TRUE(program);
  EXPECT_EQ(program->files, (std::vector<std::string>{main, sub}));
}

TEST_F(JobTest, HasTheSourcesOfToolsAndStock) {
  const Job job = job_of(kProgram);
  EXPECT_EQ(job.tool_sources.at(102), ToolSource::built_in);
  EXPECT_EQ(job.stock_source, StockSource::program);
  JobSettings settings;
  add_tool("102=square d=6 flute=20", {}, settings.tools, diagnostics_);
  settings.stock = make_block({30, 30, 10}, *parse_zero_corner("lower-left"), *parse_zero_height("top"));
  const Job given = job_of(kProgram, settings);
  EXPECT_EQ(given.tool_sources.at(102), ToolSource::option);
  EXPECT_EQ(given.stock_source, StockSource::option);
  EXPECT_FALSE(diagnostics_.has_errors());
}

TEST_F(JobTest, BytesInMemoryAreThoseOfTheFiles) {
  const Job job = job_of(kProgram);
  const auto run = run_job(job, {.resolution = mm(0.1)}, diagnostics_);
  ASSERT_TRUE(run);
  EXPECT_NEAR(run->milling().removed.mm3(), kHole, 0.03 * kHole);
  const auto surface = make_surface(job, *run, {}, diagnostics_);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->colours.size(), surface->mesh.step.size());
  EXPECT_EQ(surface->colour_names, (std::vector<std::string>{"stock", "hazard", "tool 102"}));
  View view = *named_view("top");
  view.width = view.height = 200;
  const auto stl = mesh_file(*surface, MeshFormat::stl, "part", diagnostics_);
  const auto png = picture_file(*surface, view, diagnostics_);
  ASSERT_TRUE(stl && png);

  OutputSet set;
  const std::vector<PartFile> files{*part_file(path_of("part.stl")), *part_file(path_of("part.png"))};
  ASSERT_TRUE(write_part(files, job, *run, {.view = view}, set, diagnostics_));
  ASSERT_TRUE(set.commit(diagnostics_));
  EXPECT_TRUE(InputFile::open(path_of("part.stl"), diagnostics_)->bytes() == *stl);
  EXPECT_TRUE(InputFile::open(path_of("part.png"), diagnostics_)->bytes() == *png);
  EXPECT_FALSE(part_file("part.jpg"));
}

TEST_F(JobTest, ChecksTheJob) {
  const Job valid = job_of(kProgram);
  EXPECT_TRUE(check_job(valid, {}, diagnostics_).empty());
  std::string text = kProgram;
  text.replace(text.find("G1 Z-2 F100"), 11, "G0 Z-2 X9\n");
  const Job job = job_of(text);
  const std::vector<Finding> findings = check_job(job, {}, diagnostics_);
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings.front().kind, "rapid_in_stock");
  EXPECT_EQ(to_string(findings.front().origin).substr(path_of("part.nc").size(), 3), ":6:");
}

/// Four layers of beads side by side, each bead of the second and third laid twice.
TEST_F(JobTest, LayersWithTooMuchFilamentAreOneFinding) {
  std::string text = "M109 S210\nG90\nM83\nG1 X10 Y10 Z0.2 F6000\n";
  for (int layer = 1; layer <= 4; ++layer) {
    text += "G0 Z0." + std::to_string(2 * layer) + '\n';
    for (int bead = 0; bead < 20; ++bead)
      for (int again = 0; again < (layer == 2 || layer == 3 ? 2 : 1); ++again)
        // 0.45 x 0.2 x 30 mm of a filament of 1.75 mm
        text += "G0 X10 Y" + std::to_string(10 + 0.45 * bead) + "\nG1 X40 E1.1226 F1800\n";
  }
  auto program = load_program(write("print.gcode", text), kDefaults, diagnostics_);
  ASSERT_TRUE(program);
  const Job job = make_job_or_print(std::move(*program), {}, UnknownTool::error, diagnostics_);
  const std::vector<Finding> findings = check_job(job, {}, diagnostics_);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, "overfill");
  EXPECT_NE(findings[0].message.find(" of 2 layers from Z0.4 to Z0.6 "), std::string::npos)
      << findings[0].message;
  EXPECT_NEAR(findings[0].at.z, 0.4, 1e-9);
}

TEST_F(JobTest, AnAssumedToolIsAWarningOrAFinding) {
  std::string text = kProgram;
  text.replace(text.find("T102"), 4, "T9");
  const Job job = job_of(text, {}, UnknownTool::assume);
  ASSERT_EQ(diagnostics_.list().size(), 1u);
  EXPECT_EQ(diagnostics_.list().front().code, codes::no_tool_shape);
  EXPECT_EQ(diagnostics_.list().front().severity, Severity::warning);
  EXPECT_EQ(job.tool_sources.at(9), ToolSource::assumed);
  ASSERT_NE(job.tools.find(9), nullptr);
  const std::vector<Finding> findings = check_job(job, {}, diagnostics_);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings.front().kind, "unknown_tool");
  EXPECT_TRUE(diagnostics_.list().empty());
}

TEST_F(JobTest, ACommentBeforeTheFirstToolChangeIsForTheCutsBeforeIt) {
  const Job job = job_of(
      "G21 G90\n(6mm end mill)\nM3 S9000\nG0 X5 Y5 Z2\nG1 Z-2 F100\nG0 Z2\nT102 M6\nM3\n"
      "G1 Z-1\nG0 Z2\nM2\n");
  ASSERT_TRUE(job.start_tool);
  EXPECT_EQ(job.tool_sources.at(*job.start_tool), ToolSource::comment);
  EXPECT_EQ(job.tools.find(*job.start_tool)->diameter, mm(6));
  EXPECT_EQ(job.tools.find(102)->diameter, mm(3.175));
}

TEST_F(JobTest, AJobWithoutStockCannotRun) {
  const Job job = job_of("G21 G90\nT102 M6\nG0 X5 Y5 Z2\nM2\n");
  EXPECT_FALSE(run_job(job, {}, diagnostics_));
  EXPECT_EQ(diagnostics_.list().back().code, codes::nothing_to_cut);
}

TEST_F(JobTest, TimesComeFromTheMachineOrFromTheFeeds) {
  const Job job = job_of(kProgram);
  const JobTimes plain = times_of(job, nullptr);
  EXPECT_FALSE(plain.planned());
  EXPECT_DOUBLE_EQ(plain.estimate.all.total().seconds(), plain.of_tool(102).total().seconds());
  const Machine machine;
  EXPECT_GT(times_of(job, &machine).estimate.all.total().seconds(), plain.estimate.all.total().seconds());
}

TEST_F(JobTest, PostsForControllersAndAsDrawings) {
  auto program = load_program(write("part.nc", kProgram), kDefaults, diagnostics_);
  const auto grbl = find_post_target("GRBL"), svg = find_post_target("svg");
  ASSERT_TRUE(grbl && svg);
  EXPECT_FALSE(find_post_target("none such"));
  PostingOptions options;
  options.tools = used_tools(*program, ToolChoices{});
  EXPECT_EQ(options.tools.count(102), 1u);
  const auto files = post_program(*program, *grbl, options, diagnostics_);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(files.front().text.find("G1 Z-2 F100"), std::string::npos) << files.front().text;
  EXPECT_EQ(post_program(*program, *svg, options, diagnostics_).front().text.rfind("<?xml", 0), 0u);
  const std::vector<PostedFile> several{{1, "", 0}, {2, "", 0}, {1, "", 0}};
  EXPECT_EQ(posted_file_names("part.nc", several),
            (std::vector<std::string>{"part-T1.nc", "part-T2.nc", "part-T1-2.nc"}));
}

TEST_F(JobTest, PassesReportTheirSavings) {
  const std::string text = "G21 G90\nG0 X0 Y0 Z2\nG1 Z-1 F100\nG1 X1\nG1 X2\nG1 X3\nG0 Z2\nM2\n";
  auto program = load_program(write("part.nc", text), kDefaults, diagnostics_);
  const auto savings = improve(program->path, {.join = mm(0.01)});
  ASSERT_EQ(savings.size(), 1u);
  EXPECT_EQ(savings.front().name, "join");
  EXPECT_EQ(savings.front().before.steps - savings.front().after.steps, 2u);
  EXPECT_EQ(program->path.size(), savings.front().after.steps);
}

TEST(Sections, AreReadAndWritten) {
  const auto section = parse_section("z=1in");
  ASSERT_TRUE(section);
  EXPECT_EQ(section->plane, Plane::xy);
  EXPECT_DOUBLE_EQ(section->at, 25.4);
  EXPECT_EQ(to_string(*parse_section("X=2.5")), "x=2.5");
  EXPECT_FALSE(parse_section("w=1"));
  EXPECT_FALSE(parse_section("x=1mm2"));
}

}  // namespace
}  // namespace kerf

// Long work has fractions of what is done, and ends soon after it is asked to stop, with nothing made.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "base/codes/files.h"
#include "watched_progress.h"

#include "kerf/formats/mesh_files.h"
#include "kerf/job/cut_program.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"

namespace kerf {
namespace {

using test::Watched;

constexpr double kSoon = 0.3;  // s

class Folder {
 public:
  Folder() {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string file = (path_ / name).string();
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  bool holds(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      ("kerf_progress_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

/// A closed relief of n x n squares, 40 mm wide, with waves between Z-4 and Z0 above a bottom at Z-6.
struct Relief {
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles;

  explicit Relief(std::uint32_t n) {
    const std::uint32_t side = n + 1;
    for (const bool is_top : {true, false})
      for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
          const double x = 40.0 * i / n, y = 40.0 * j / n;
          const double z = is_top ? 2.0 * std::sin(0.5 * x) * std::cos(0.4 * y) - 2.0 : -6.0;
          for (const double v : {x, y, z}) positions.push_back(static_cast<float>(v));
        }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      triangles.insert(triangles.end(), {a, b, c, a, c, d});
    };
    const std::uint32_t low = side * side;
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = j * side + i;
        quad(a, a + 1, a + side + 1, a + side);
        quad(low + a, low + a + side, low + a + side + 1, low + a + 1);
      }
    const auto wall = [&](std::uint32_t a, std::uint32_t b) { quad(a, low + a, low + b, b); };
    for (std::uint32_t k = 0; k < n; ++k) {
      wall(k, k + 1);
      wall(k * side + n, (k + 1) * side + n);
      wall(n * side + k + 1, n * side + k);
      wall((k + 1) * side, k * side);
    }
  }
  std::string bytes(MeshFormat format) const {
    return write_mesh({positions, triangles, {}, {}, {}, "relief"}, format);
  }
  std::string text_stl() const {
    std::string text = "solid relief\n";
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (std::size_t k = 0; k < 3; ++k) {
        text += "vertex";
        for (std::size_t axis = 0; axis < 3; ++axis)
          text += " " + std::to_string(positions[3 * triangles[t + k] + axis]);
        text += "\n";
      }
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid relief\n";
  }
};

std::string svg_of(int count) {
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"500mm\" height=\"500mm\" viewBox=\"0 0 500 500\">\n";
  for (int i = 0; i < count; ++i)
    text += "<path d=\"M" + std::to_string(i % 200 * 2) + "," + std::to_string(i / 200 * 2) +
            " l1.5,0 l0,1.5 l-1.5,0 z\" stroke=\"#000\" fill=\"none\"/>\n";
  return text + "</svg>\n";
}

std::string dxf_of(int count) {
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  for (int i = 0; i < count; ++i)
    text += "0\nCIRCLE\n8\nCUT\n10\n" + std::to_string(i % 200 * 2) + "\n20\n" + std::to_string(i / 200 * 2) +
            "\n40\n0.5\n";
  return text + "0\nENDSEC\n0\nEOF\n";
}

/// Runs work to its end, then again until it is asked to stop after some reports in all phases. `work`
/// returns whether it has made something.
template <class Work>
void expect_stops(const std::vector<std::string>& phases, const Work& work) {
  Watched whole;
  Diagnostics fine;
  ASSERT_TRUE(work(fine, &whole)) << (fine.list().empty() ? "" : fine.list().front().message);
  for (const std::string& phase : phases)
    EXPECT_GE(whole.reports(phase), 5u) << phase << " of " << whole.phases();
  for (std::size_t n = 1; n < whole.all(); n += 1 + whole.all() / 12) {
    Watched stopped(n);
    Diagnostics diagnostics;
    const bool is_made = work(diagnostics, &stopped);
    if (!stopped.asked()) continue;  // with several threads the number of reports varies
    EXPECT_FALSE(is_made) << n;
    EXPECT_LT(stopped.seconds_since(), kSoon) << n;
    EXPECT_LE(stopped.after(), 3u) << n;
    for (const Diagnostic& d : diagnostics.list())
      EXPECT_TRUE(d.severity != Severity::error || d.code == codes::stopped) << d.message;
  }
}

TEST(LongWork, OfMeshFilesHasFractionsAndStops) {
  const Folder folder;
  const Relief relief(120);
  const std::pair<const char*, std::string> files[] = {{"a.stl", relief.bytes(MeshFormat::stl)},
                                                       {"b.stl", relief.text_stl()},
                                                       {"c.obj", relief.bytes(MeshFormat::obj)},
                                                       {"d.glb", relief.bytes(MeshFormat::glb)},
                                                       {"e.3mf", relief.bytes(MeshFormat::three_mf)}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    const std::string file = folder.write(name, bytes);
    expect_stops({"reading the mesh", "checking the mesh"},
                 [&](Diagnostics& diagnostics, Progress* progress) {
                   const auto stock = load_stock(file, diagnostics, progress);
                   EXPECT_EQ(stock.has_value(), !diagnostics.has_errors());
                   return stock.has_value();
                 });
  }
}

TEST(LongWork, OfDrawingsHasFractionsAndStops) {
  const Folder folder;
  for (const auto& [name, bytes] : {std::pair("a.svg", svg_of(20'000)), std::pair("b.dxf", dxf_of(20'000))}) {
    SCOPED_TRACE(name);
    const std::string file = folder.write(name, bytes);
    expect_stops({"reading the drawing", "making outlines"},
                 [&](Diagnostics& diagnostics, Progress* progress) {
                   const auto shapes = load_art(file, {}, diagnostics, progress);
                   EXPECT_EQ(!shapes.empty(), !diagnostics.has_errors());
                   return !shapes.empty();
                 });
  }
}

TEST(LongWork, OfReliefsHasFractionsAndStops) {
  const Folder folder;
  folder.write("relief.stl", Relief(100).bytes(MeshFormat::stl));
  for (const auto& [operation, phases] :
       {std::pair(std::string("raster"), std::vector<std::string>{"raster"}),
        std::pair(std::string("waterline"), std::vector<std::string>{"heights of the tool", "waterlines"})}) {
    SCOPED_TRACE(operation);
    const std::string job = folder.write("job.toml",
                                         "[surface]\nfile = \"relief.stl\"\n[tools]\n1 = \"ball d=3\"\n"
                                         "[[operation]]\nop = \"" +
                                             operation + "\"\ntool = 1\nfeed = 900\nstepdown = 0.2\n");
    std::vector<std::string> all{"reading the mesh"};
    all.insert(all.end(), phases.begin(), phases.end());
    expect_stops(all, [&](Diagnostics& diagnostics, Progress* progress) {
      const auto program = load_program(job, {}, diagnostics, progress);
      return program && !diagnostics.has_errors() && !stop_requested(progress);
    });
  }
}

TEST(LongWork, OfAPartFromAMeshWritesNothingWhenStopped) {
  const Folder folder;
  const std::string stock = folder.write("relief.stl", Relief(60).bytes(MeshFormat::stl));
  const std::string part =
      folder.write("part.nc", "T1 M6\nG0 X5 Y5 Z5\nG1 Z-3 F500\nG1 X35\nG2 X35 Y35 I0 J15\nM2\n");
  std::size_t turn = 0, made = 0;
  expect_stops({"reading the mesh", "checking the mesh", "reading the body"}, [&](Diagnostics& diagnostics,
                                                                                  Progress* progress) {
    const std::string name = "part" + std::to_string(++turn) + ".stl";
    OutputSet set;
    JobSettings settings;
    settings.stock_file = load_stock(stock, diagnostics, progress);
    auto program = settings.stock_file ? load_program(part, {}, diagnostics, progress) : std::nullopt;
    if (!program || diagnostics.has_errors()) return false;
    const Job job = make_job(std::move(*program), settings, UnknownTool::assume, diagnostics);
    RunOptions how;
    how.resolution = mm(0.1);
    const auto run = run_job(job, how, diagnostics, progress);
    const std::vector<PartFile> files{*part_file(folder.file(name))};
    const bool is_made =
        run && write_part(files, job, *run, {}, set, diagnostics, progress) && set.commit(diagnostics);
    EXPECT_EQ(folder.holds(name), is_made);
    made += is_made ? 1 : 0;
    return is_made;
  });
  EXPECT_EQ(folder.files(), 2 + made);  // the inputs and the parts
}

}  // namespace
}  // namespace kerf

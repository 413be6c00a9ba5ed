// Detection of dialects: files with evidence for one, and similar files without. The name of a file in
// tests/data/gcode/dialects starts with the dialect expected for it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "test_paths.h"

#include "kerf/program/gcode_options.h"

namespace kerf {
namespace {

using Path = std::filesystem::path;

std::vector<Path> fixtures() {
  std::vector<Path> files;
  for (const auto& entry : std::filesystem::directory_iterator(KERF_TEST_DATA "/gcode/dialects"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of(const Path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Dialect, IsTheOneInTheFileName) {
  std::size_t similar = 0, detected = 0;
  for (const Path& path : fixtures()) {
    const std::string name = path.filename().string();
    const auto dialect = dialect_named(name.substr(0, name.find('-')));
    ASSERT_TRUE(dialect) << name;
    const DialectGuess guess = guess_dialect(text_of(path));
    EXPECT_EQ(to_string(guess.dialect), to_string(*dialect)) << name << ": " << guess.from;
    EXPECT_EQ(guess.from.empty(), guess.dialect == GcodeDialect::rs274) << name;
    ++(*dialect == GcodeDialect::rs274 ? similar : detected);
  }
  EXPECT_GE(detected, 11u);
  EXPECT_GE(similar, 9u);
}

TEST(Dialect, EachHasAFile) {
  const std::vector<Path> files = fixtures();
  for (const std::string_view name :
       {"rs274", "grbl", "mach3", "fanuc", "laser", "marlin", "klipper", "reprapfirmware"})
    EXPECT_TRUE(std::any_of(files.begin(), files.end(), [&](const Path& p) {
      return p.filename().string().rfind(std::string(name) + "-", 0) == 0;
    })) << name;
}

struct Evidence {
  std::string_view file, dialect, from;
  std::uint32_t line;
};

TEST(Dialect, TheGuessNamesItsEvidence) {
  const Evidence cases[] = {
      {"grbl-maker.nc", "GRBL", "\"(Written by Carbide Create)\" in line 3", 3},
      {"fanuc-numbered.nc", "Fanuc", "O1001 in line 2 and M98 in line 4", 2},
      {"laser-powers.gc", "laser", "M4 in line 2 and the S words of its motions", 2},
      {"laser-focus.nc", "laser", "M3 in line 1, switched on and off without motions in Z", 1},
      {"marlin-words.gcode", "Marlin", "M140 in line 1 and E in line 5", 1},
      {"klipper-words.gcode", "Klipper", "M140 in line 2 and SET_PRESSURE_ADVANCE in line 4", 2},
  };
  for (const Evidence& c : cases) {
    const DialectGuess guess = guess_dialect(text_of(Path(KERF_TEST_DATA "/gcode/dialects") / c.file));
    EXPECT_EQ(to_string(guess.dialect), c.dialect) << c.file;
    EXPECT_EQ(guess.from, c.from) << c.file;
    EXPECT_EQ(guess.line, c.line) << c.file;
  }
}

TEST(Dialect, EWordsOfMotionsMakeAPrint) {
  const std::string cold = "G28\nG1 X10 Y0 E0.3\nG1 X0 Y1 E0.3\nG1 X10 Y1 E0.3\n";
  EXPECT_EQ(guess_dialect(cold).dialect, GcodeDialect::marlin);
  EXPECT_EQ(guess_dialect("M3 S9000\n" + cold).dialect, GcodeDialect::rs274);
  EXPECT_EQ(guess_dialect("M104 S200\nG1 X10 E0.3\n").dialect, GcodeDialect::marlin);
  const std::string thread = "G76 P0.05 Z-1 I-.075 J0.008 K0.045 Q29.5 L2 E0.045\n";
  EXPECT_EQ(guess_dialect(thread + thread + thread).dialect, GcodeDialect::rs274);
}

TEST(Dialect, PicturesInCommentsDoNotHideTheWords) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "; iVBORw0KGgoAAAANSUhEUgAAASwAAAEsCAIAAAD2HxkiAAAA\r\n";
  text += text_of(Path(KERF_TEST_DATA "/gcode/dialects/marlin-words.gcode"));
  const DialectGuess guess = guess_dialect(text);
  EXPECT_EQ(guess.dialect, GcodeDialect::marlin);
  EXPECT_EQ(guess.line, 3001u);
}

}  // namespace
}  // namespace kerf

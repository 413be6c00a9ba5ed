// Which controller a program is for: files that tell it, and others that come near and must not. A file of
// tests/data/gcode/dialects is named after the dialect, then after what it shows.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "test_paths.h"

#include "kerf/gcode.h"

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

TEST(Dialect, IsThatOfTheFilesName) {
  std::size_t near = 0, told = 0;
  for (const Path& path : fixtures()) {
    const std::string name = path.filename().string();
    const auto dialect = dialect_named(name.substr(0, name.find('-')));
    ASSERT_TRUE(dialect) << name;
    const DialectGuess guess = guess_dialect(text_of(path));
    EXPECT_EQ(to_string(guess.dialect), to_string(*dialect)) << name << ": " << guess.from;
    EXPECT_EQ(guess.from.empty(), guess.dialect == GcodeDialect::rs274) << name;
    ++(*dialect == GcodeDialect::rs274 ? near : told);
  }
  EXPECT_GE(told, 11u);
  EXPECT_GE(near, 9u);
}

TEST(Dialect, EachHasAFile) {
  const std::vector<Path> files = fixtures();
  for (const std::string_view name : {"rs274", "grbl", "mach3", "fanuc", "laser", "marlin", "klipper"})
    EXPECT_TRUE(std::any_of(files.begin(), files.end(), [&](const Path& p) {
      return p.filename().string().rfind(std::string(name) + "-", 0) == 0;
    })) << name;
}

struct Told {
  std::string_view file, from;
  std::uint32_t line;
};

TEST(Dialect, TheMessageSaysFromWhat) {
  const Told cases[] = {
      {"grbl-maker.nc", "GRBL (\"(Written by Carbide Create)\" in line 3)", 3},
      {"fanuc-numbered.nc", "Fanuc (O1001 in line 2 and M98 in line 4)", 2},
      {"laser-powers.gc", "laser (M4 in line 2 and the S words of its moves)", 2},
      {"marlin-words.gcode", "Marlin (M140 in line 1 and E in line 5)", 1},
      {"klipper-words.gcode", "Klipper (M140 in line 2 and SET_PRESSURE_ADVANCE in line 4)", 2},
  };
  for (const Told& c : cases) {
    Diagnostics diagnostics;
    read_gcode(text_of(Path(KERF_TEST_DATA "/gcode/dialects") / c.file), {}, diagnostics);
    const auto& list = diagnostics.list();
    const auto said = std::find_if(list.begin(), list.end(),
                                   [](const Diagnostic& d) { return d.code == Code::dialect_guessed; });
    ASSERT_NE(said, list.end()) << c.file;
    EXPECT_NE(said->message.find(c.from), std::string::npos) << said->message;
    EXPECT_EQ(said->where, Origin(TextSpot{"<text>", c.line, 0}));
  }
}

TEST(Dialect, PicturesInRemarksDoNotHideTheWords) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "; iVBORw0KGgoAAAANSUhEUgAAASwAAAEsCAIAAAD2HxkiAAAA\r\n";
  text += text_of(Path(KERF_TEST_DATA "/gcode/dialects/marlin-words.gcode"));
  const DialectGuess guess = guess_dialect(text);
  EXPECT_EQ(guess.dialect, GcodeDialect::marlin);
  EXPECT_EQ(guess.line, 3001u);
}

}  // namespace
}  // namespace kerf

// Tool files: units, keys, and every kind of fault with its location.
#include <gtest/gtest.h>

#include "base/codes/tools.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

struct File {
  ToolTable table;
  Diagnostics diagnostics;
};
File read(std::string_view text) {
  File file;
  read_tool_file(text, "my.toml", file.table, file.diagnostics);
  return file;
}
/// The first diagnostic as text; empty if there is none.
std::string first(const File& file) {
  return file.diagnostics.list().empty() ? "" : to_string(file.diagnostics.list().front());
}
Code first_code(const File& file) {
  return file.diagnostics.list().empty() ? Code{} : file.diagnostics.list().front().code;
}

TEST(ToolFile, ReadsToolsUnderAllTheirNumbers) {
  const File file = read(R"(
[[tool]]
numbers = [1, 11]
names = ["Mine"]
shape = "Bull-Nose"
diameter = 6
corner_radius = 1.0
flute = "1/2 in"
shank_diameter = 8
transition = "cone"
teeth = 3
plunges = false
description = "a test"
)");
  EXPECT_EQ(first(file), "");
  const Tool* tool = file.table.find(11);
  ASSERT_NE(tool, nullptr);
  EXPECT_EQ(tool->number, 11);
  EXPECT_EQ(tool->flute, mm(12.7));
  EXPECT_EQ(tool->teeth, 3);
  EXPECT_FALSE(tool->plunges);
  EXPECT_EQ(tool->description, "a test");
  EXPECT_EQ(tool->silhouette.shank.knots[1], (Knot{4, 13.7, 0}));
  EXPECT_EQ(tool->silhouette.shank.top(), 32.7);  // 20 mm by default
  EXPECT_EQ(file.table.find_name("mine")->diameter, mm(6));
}

TEST(ToolFile, InchesPerFileAndPerTool) {
  const File file = read(R"(
unit = "inch"
[[tool]]
number = 1
shape = "square"
diameter = 0.25
flute = 1
[[tool]]
number = 2
unit = "mm"
shape = "drawn"
profile = [[0, 0], [2, 0, 0.41421356237309503], [4, 2], [4, 9]]
)");
  EXPECT_EQ(first(file), "");
  EXPECT_EQ(file.table.find(1)->diameter, mm(6.35));
  EXPECT_EQ(file.table.find(2)->diameter, mm(8.0));
}

TEST(ToolFile, SyntaxErrorsHaveLineAndColumn) {
  const File file = read("[[tool]]\nnumber = = 2\n");
  EXPECT_EQ(first_code(file), codes::tool_file_syntax);
  EXPECT_EQ(first(file).substr(0, 10), "my.toml:2:") << first(file);
}

TEST(ToolFile, UnknownKeysAreErrorsWithAGuess) {
  const File file = read("[[tool]]\nnumber = 2\nshape = \"square\"\ndiametre = 3\n");
  EXPECT_EQ(first_code(file), codes::tool_key_unknown);
  EXPECT_EQ(first(file).substr(0, 12), "my.toml:4:1:") << first(file);
  EXPECT_EQ(file.diagnostics.list()[0].hint, "did you mean diameter?");
  EXPECT_EQ(file.table.tools().size(), 0u);
  const File root = read("[[tools]]\nnumber = 2\n");
  EXPECT_EQ(first_code(root), codes::tool_key_unknown);
  EXPECT_EQ(root.diagnostics.list()[0].hint, "did you mean [[tool]]?");
  EXPECT_EQ(first_code(read("[[tool]]\nnumber=2\nshape=\"square\"\ndiameter=2\nangle=3\n")),
            codes::tool_key_unknown);
}

TEST(ToolFile, UnknownShapesAreErrorsWithAGuess) {
  const File file = read("[[tool]]\nnumber = 2\nshape = \"squre\"\n");
  EXPECT_EQ(first_code(file), codes::tool_shape_unknown);
  EXPECT_EQ(file.diagnostics.list()[0].hint, "did you mean square?");
}

TEST(ToolFile, WrongKindsOfValues) {
  for (const char* text : {"tool = 3",
                           "tool = [1, 2]",
                           "unit = \"parsec\"",
                           "unit = 3",
                           "[[tool]]\nnumber = -1\nshape=\"square\"\ndiameter=1",
                           "[[tool]]\nnumber = 1.5\nshape=\"square\"\ndiameter=1",
                           "[[tool]]\nnumbers = [\"a\"]\nshape=\"square\"\ndiameter=1",
                           "[[tool]]\nnumber = 1\nshape = 3",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = \"wide\"",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = true",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = {a=1}",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = 1\nteeth = 2.5",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = 1\nplunges = 1",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = 1\ndescription = 1",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = 1\ntransition = \"x\"",
                           "[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = 1\nd = 2",
                           "[[tool]]\nnumber = 1\nnames=3\nshape=\"square\"\ndiameter = 1",
                           "[[tool]]\nnumber = 1\nnames=[3]\nshape=\"square\"\ndiameter = 1",
                           "[[tool]]\nnumber = 1\nshape=\"drawn\"\nprofile = [[0, 0], [1]]",
                           "[[tool]]\nnumber = 1\nshape=\"drawn\"\nprofile = [[0, 0], [1, true]]",
                           "[[tool]]\nnumber = 1\nshape=\"drawn\"\nprofile = 3"}) {
    const File file = read(text);
    EXPECT_EQ(first_code(file), codes::tool_value_type) << text << first(file);
    EXPECT_TRUE(file.table.tools().empty()) << text;
  }
}

TEST(ToolFile, MissingNumbersAndShapes) {
  EXPECT_EQ(first_code(read("[[tool]]\nshape=\"square\"\ndiameter = 1")), codes::tool_key_missing);
  EXPECT_EQ(first_code(read("[[tool]]\nnumber = 1\ndiameter = 1")), codes::tool_key_missing);
  EXPECT_EQ(first_code(read("[[tool]]\nnumber = 1\nshape = \"square\"")), codes::tool_measure_bad);
  EXPECT_EQ(first_code(read("[[tool]]\nnumber = 1\nshape = \"drawn\"")), codes::tool_shape_impossible);
}

TEST(ToolFile, NotFiniteNumbersAreRefused) {
  for (const char* value : {"nan", "inf", "-inf", "1e308", "-3", "0"}) {
    const File file =
        read(std::string("unit=\"inch\"\n[[tool]]\nnumber = 1\nshape=\"square\"\ndiameter = ") + value);
    EXPECT_EQ(first_code(file), codes::tool_measure_bad) << value;
  }
}

TEST(ToolFile, DuplicatesNameTheFirst) {
  const File file = read(
      "[[tool]]\nnumber=1\nshape=\"square\"\ndiameter=1\n[[tool]]\nnumber=1\nshape=\"square\"\ndiameter=2\n");
  EXPECT_EQ(first_code(file), codes::tool_number_twice);
  ASSERT_EQ(file.diagnostics.list()[0].notes.size(), 1u);
  EXPECT_EQ(file.table.find(1)->diameter, mm(1));
}

TEST(ToolFile, AUsersFileReplacesToolsOfTheTable) {
  ToolTable table = built_in_tools();
  Diagnostics diagnostics;
  read_tool_file("[[tool]]\nnumber=102\nshape=\"ball\"\ndiameter=4\n", "my.toml", table, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(table.find(102)->diameter, mm(4));
}

TEST(ToolFile, ReportsEveryFaultAndKeepsTheGoodTools) {
  const File file = read(R"(
[[tool]]
number = 1
shape = "square"
diameter = 1
[[tool]]
number = 2
shape = "square"
diamter = 1
flut = 2
[[tool]]
number = 3
shape = "bull nose"
diameter = 6
corner_radius = 4
)");
  EXPECT_EQ(file.diagnostics.errors(), 3u);
  EXPECT_EQ(file.table.tools().size(), 1u);
}

TEST(ToolFile, JunkAndDeepNestingEndInAnError) {
  EXPECT_TRUE(read(std::string_view("\xff\xfe\x00\x01", 4)).diagnostics.has_errors());
  EXPECT_TRUE(read("a = " + std::string(100000, '[')).diagnostics.has_errors());
  EXPECT_EQ(first_code(read("[=]")), codes::tool_file_syntax);  // the parser's own assertion fails here
  EXPECT_EQ(first_code(read(std::string_view("[[\0tool]]", 9))), codes::tool_file_syntax);
  EXPECT_EQ(first_code(read("\xc3\xa9 = 1")), codes::tool_file_syntax);  // a letter outside ASCII
  EXPECT_TRUE(read("").diagnostics.list().empty());
}

}  // namespace
}  // namespace kerf

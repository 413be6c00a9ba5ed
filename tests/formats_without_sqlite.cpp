// Tool databases in a Kerf that is built without SQLite: one clear error, for reading and for writing.
#include <gtest/gtest.h>

#include "base/codes/tools.h"
#include "formats/tool_libraries.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

void expect_missing(const Diagnostics& diagnostics) {
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::tool_database_missing);
  EXPECT_EQ(diagnostics.list()[0].severity, Severity::error);
}

TEST(WithoutSqlite, ReadingSaysSo) {
  const std::string bytes = std::string("SQLite format 3\0", 16) + std::string(500, '\0');
  ToolTable table;
  Diagnostics diagnostics;
  read_tool_library(bytes, "tools.vtdb", {}, table, diagnostics);
  expect_missing(diagnostics);
}

TEST(WithoutSqlite, WritingSaysSo) {
  Diagnostics diagnostics;
  const auto written =
      write_tool_library(built_in_tools(), *library_form_named("vectric"), "tools.vtdb", 1.0, diagnostics);
  EXPECT_TRUE(written.files.empty());
  expect_missing(diagnostics);
}

}  // namespace
}  // namespace kerf

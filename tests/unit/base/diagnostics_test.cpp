// Diagnostics and origins: text form, the limit per code, the compact table of origins.
#include "kerf/base/diagnostics.h"

#include <gtest/gtest.h>
#include <set>
#include <string>

#include "base/codes/files.h"

namespace kerf {
namespace {

TEST(Diagnostic, TextHasOriginMessageNotesAndHint) {
  Diagnostics diagnostics;
  Diagnostic& d =
      diagnostics.warning(codes::file_unreadable, TextLocation{"part.nc", 3, 7}, "no number after X");
  d.notes.push_back({TextLocation{"part.nc", 1, 0}, "the program starts here"});
  d.hint = "write X0";
  EXPECT_EQ(to_string(d),
            "part.nc:3:7: warning: no number after X [1001]\n"
            "  note: part.nc:1: the program starts here\n"
            "  hint: write X0");
  EXPECT_EQ(to_string(Diagnostic{Severity::error, codes::file_unreadable, {}, "bad", {}, {}}),
            "error: bad [1001]");
}

TEST(Diagnostics, KeepsABoundedNumberOfEachCodeAndCountsTheRest) {
  Diagnostics diagnostics(3);
  for (int i = 0; i < 1000; ++i) diagnostics.error(codes::file_unreadable, {}, "again").hint = "still valid";
  diagnostics.warning(codes::file_unwritable, {}, "another");
  EXPECT_EQ(diagnostics.list().size(), 4u);
  EXPECT_EQ(diagnostics.errors(), 1000u);
  EXPECT_EQ(diagnostics.warnings(), 1u);
  EXPECT_EQ(diagnostics.dropped(codes::file_unreadable), 997u);
  EXPECT_EQ(diagnostics.dropped(codes::file_unwritable), 0u);
  EXPECT_EQ(diagnostics.dropped_codes(), std::vector<Code>{codes::file_unreadable});
}

TEST(Codes, HaveNamesAndMeaningsOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Code code : all_codes()) {
    EXPECT_TRUE(names.insert(name_of(code)).second);
    EXPECT_FALSE(meaning_of(code).empty());
  }
  EXPECT_EQ(name_of(codes::file_unreadable), "file_unreadable");
}

TEST(Origin, IsWrittenAsEditorsReadIt) {
  EXPECT_EQ(to_string(Origin{}), "");
  EXPECT_EQ(to_string(Origin{TextLocation{"part.nc", 12, 5}}), "part.nc:12:5");
  EXPECT_EQ(to_string(Origin{TextLocation{"part.nc", 12, 0}}), "part.nc:12");
  EXPECT_EQ(to_string(Origin{TextLocation{"part.nc", 0, 0}}), "part.nc");
  EXPECT_EQ(to_string(Origin{DrawingLocation{"plate.dxf", "8999", "2F", 10, 20.5}}),
            "plate.dxf: layer 8999, handle 2F, at 10, 20.5");
  EXPECT_EQ(to_string(Origin{CallLocation{"job.py", 7, "cutline"}}), "job.py:7 (cutline)");
}

TEST(OriginTable, ResolvesWhatWasAdded) {
  OriginTable table;
  const Origin text = TextLocation{"part.nc", 12, 5};
  const Origin drawing = DrawingLocation{"plate.dxf", "8999", "2F", 10, 20};
  const Origin call = CallLocation{"job.py", 7, "cutline"};
  const OriginId a = table.add(text), b = table.add(drawing), c = table.add(call);
  EXPECT_EQ(table.resolve(a), text);
  EXPECT_EQ(table.resolve(b), drawing);
  EXPECT_EQ(table.resolve(c), call);
  EXPECT_EQ(table.resolve(OriginId::none), Origin{});
  EXPECT_EQ(table.line(a), 12u);
  EXPECT_EQ(table.line(c), 7u);
  EXPECT_EQ(table.file("part.nc"), table.file("part.nc"));
}

TEST(OriginTable, GivesALocationFurtherIds) {
  OriginTable table;
  const OriginId first = table.add(DrawingLocation{"plate.dxf", "8999", "2F", 10, 20, "LINE"});
  const OriginId caller = table.add(TextLocation{"part.nc", 1, 1});
  const OriginId second = table.add_again(first);
  table.set_caller(second, caller);
  EXPECT_EQ(table.resolve(second), table.resolve(first));
  EXPECT_TRUE(table.callers(first).empty());
  EXPECT_EQ(table.callers(second).size(), 1u);
  EXPECT_EQ(to_string(table.resolve(second)), "plate.dxf: layer 8999, LINE 2F, at 10, 20");
}

TEST(OriginTable, NamesCallersInnermostFirst) {
  OriginTable table;
  const OriginId outer = table.add(TextLocation{"main.ngc", 2, 0});
  const OriginId caller = table.add(TextLocation{"sub.ngc", 5, 0});
  const OriginId inner = table.add(TextLocation{"deep.ngc", 9, 0});
  table.set_caller(caller, outer);
  table.set_caller(inner, caller);
  const std::vector<Origin> expected{TextLocation{"sub.ngc", 5, 0}, TextLocation{"main.ngc", 2, 0}};
  EXPECT_EQ(table.callers(inner), expected);
  EXPECT_TRUE(table.callers(outer).empty());
}

}  // namespace
}  // namespace kerf

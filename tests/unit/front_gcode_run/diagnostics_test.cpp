// One program for each diagnostic of the reader, with its location, severity, and the number of motions read.
#include <algorithm>
#include <gtest/gtest.h>

#include "base/codes/gcode.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

struct Case {
  std::string_view text;  // M2 is added
  Code code;
  Severity severity;
  std::uint32_t line, column;
  std::size_t motions;  // that are read nevertheless
};

constexpr Severity kWarning = Severity::warning, kError = Severity::error, kNote = Severity::note;

const Case kCases[] = {
    {"G0 X[1", codes::expression_malformed, kError, 1, 7, 0},
    {"#1 = [2", codes::expression_malformed, kError, 1, 8, 0},
    {"G0 X1 Y[ATAN[1]]", codes::expression_malformed, kError, 1, 16, 0},
    {"G0 X[1/0]", codes::expression_impossible, kError, 1, 9, 0},
    {"G0 X[SQRT[-1]]", codes::expression_impossible, kError, 1, 14, 0},
    {"G0 X#<none>", codes::parameter_unknown, kError, 1, 5, 0},
    {"#6000 = 1", codes::parameter_unknown, kError, 1, 2, 0},
    {"O100 nonsense", codes::o_word_malformed, kError, 1, 1, 0},
    {"O100 if", codes::o_word_unmatched, kError, 1, 1, 0},
    {"O100 endwhile", codes::o_word_unmatched, kError, 1, 1, 0},
    {"O100 call", codes::sub_missing, kError, 1, 1, 0},
    {"M98 P100", codes::sub_missing, kError, 1, 1, 0},
    {"O1 sub\nO1 call\nO1 endsub\nO1 call", codes::calls_too_deep, kError, 2, 1, 0},
    {"O1 while [1]\nO1 endwhile", codes::runs_too_long, kError, 1, 1, 0},
    {"G0 @5", codes::polar_from_zero, kError, 1, 1, 0},
    {"; LightBurn", codes::dialect_guessed, kNote, 1, 0, 0},
    {"G21\n(T4  D=3.175 CR=0 - flat end mill)", codes::tool_from_remark, kNote, 2, 1, 0},
    {"G21\n(T4 D=6 CR=0 - right hand tap)", codes::tool_shape_assumed, kWarning, 2, 1, 0},
    {"G1 X1 F9 ,R2", codes::corner_refused, kError, 1, 11, 1},
    {"G0 X1 E5", codes::unknown_letter, kWarning, 1, 7, 1},
    {"G0 X1 G77.7", codes::unknown_g_code, kWarning, 1, 7, 0},
    {"G0 X1 G1000", codes::unknown_g_code, kWarning, 1, 7, 0},
    {"G0 X1 M199", codes::unknown_m_code, kWarning, 1, 7, 1},
    {"G0 X1 G1.05", codes::unknown_g_code, kWarning, 1, 7, 0},
    {"G17.1", codes::code_unsupported, kError, 1, 1, 0},
    {"G41 D1", codes::compensation_no_tool, kError, 1, 1, 0},
    {"G42", codes::compensation_no_tool, kError, 1, 1, 0},
    {"G41.1", codes::word_missing, kError, 1, 1, 0},
    {"G41 D1.5", codes::word_out_of_range, kError, 1, 5, 0},
    {"G19 G41.1 D2", codes::compensation_refused, kError, 1, 5, 0},
    {"G41.1 D2\nG42.1 D2", codes::compensation_refused, kWarning, 2, 1, 0},
    {"F9 G41.1 D2\nG1 X9\nG53 G0 X1", codes::compensation_refused, kError, 3, 1, 2},
    {"F9 G41.1 D2\nG1 X9\nG18", codes::compensation_refused, kError, 3, 1, 1},
    {"F9 G41.1 D2\nG1 X9\nG81 X10 R1 Z0", codes::compensation_refused, kError, 3, 1, 5},
    {"F9 G41.1 D2\nG1 X9\nG40\nG2 X12 I1", codes::compensation_refused, kError, 4, 1, 2},
    {"F9 G41.1 D2\nG1 X1", codes::compensation_entry, kError, 2, 1, 1},
    {"F9 G41.1 D2\nG3 X1 Y1 J1", codes::compensation_entry, kError, 2, 1, 1},
    {"F9 G41.1 D2\nG1 Z1\nX9", codes::compensation_entry, kWarning, 2, 1, 2},
    {"F9 G41.1 D4\nG1 X9\nX15\nY1\nX9", codes::compensation_gouge, kError, 5, 1, 4},
    {"F9 G41.1 D4\nG1 X9\nG3 X10 Y1 J1", codes::compensation_gouge, kError, 3, 1, 2},
    {"M48", codes::code_ignored, kNote, 1, 1, 0},
    {"M62 P0", codes::code_ignored, kNote, 1, 1, 0},
    {"F9 G2 X2 I1 K2", codes::word_unused, kWarning, 1, 13, 1},
    {"G0 X1 P2", codes::word_unused, kWarning, 1, 7, 1},
    {"G1 G0 X5", codes::modal_conflict, kWarning, 1, 4, 1},
    {"G0 X5 X6", codes::word_repeated, kWarning, 1, 7, 1},
    {"G1 X5\nX6", codes::no_feed, kWarning, 1, 1, 2},
    {"F9 G93 G81 X1 R1 Z0", codes::no_feed, kWarning, 1, 1, 4},
    {"X5", codes::no_motion_mode, kWarning, 1, 1, 1},
    {"G80\nX5", codes::no_motion_mode, kError, 2, 1, 0},
    {"F9 G2 G53 X5 I1", codes::no_motion_mode, kError, 1, 1, 0},
    {"G4", codes::word_missing, kError, 1, 1, 0},
    {"M6", codes::word_missing, kWarning, 1, 1, 0},
    {"G92", codes::word_missing, kError, 1, 1, 0},
    {"F9 G81 X1 Z-1", codes::word_missing, kError, 1, 1, 0},
    {"F9 G81 X1 R1", codes::word_missing, kError, 1, 1, 0},
    {"F9 G83 X1 R1 Z-1", codes::word_missing, kError, 1, 1, 0},
    {"F9 G87 X1 R1 Z-1", codes::word_missing, kError, 1, 1, 0},
    {"F9 G82 X1 R1 Z0", codes::word_missing, kWarning, 1, 1, 4},
    {"G93 G1 X1 F2\nX2", codes::no_feed, kWarning, 2, 1, 2},
    {"M3\nG0 X1", codes::word_missing, kWarning, 1, 1, 1},
    {"G81", codes::word_missing, kWarning, 1, 1, 0},
    {"F-1", codes::word_out_of_range, kError, 1, 1, 0},
    {"S-1", codes::word_out_of_range, kError, 1, 1, 0},
    {"T1.5", codes::word_out_of_range, kError, 1, 1, 0},
    {"T-1", codes::word_out_of_range, kError, 1, 1, 0},
    {"T99999999999", codes::word_out_of_range, kError, 1, 1, 0},
    {"G4 P-1", codes::word_out_of_range, kError, 1, 4, 0},
    {"G64 P-1", codes::word_out_of_range, kError, 1, 5, 0},
    {"F9 G2 I1 P1.5", codes::word_out_of_range, kError, 1, 10, 1},
    {"F9 G2 I1 P1000000", codes::word_out_of_range, kError, 1, 10, 1},
    {"F9 G81 X1 R1 Z0 L0", codes::word_out_of_range, kError, 1, 17, 4},
    {"F9 G81 X1 R1 Z0 L1000000", codes::word_out_of_range, kError, 1, 17, 4},
    {"F9 G82 X1 R1 Z0 P-1", codes::word_out_of_range, kError, 1, 1, 4},
    {"F9 G83 X1 R1000 Z0 Q.0001", codes::word_out_of_range, kError, 1, 1, 4},
    {"F9 G2 X5", codes::arc_no_centre, kError, 1, 1, 1},
    {"F9 G2 I0", codes::arc_no_centre, kError, 1, 1, 1},
    {"F9 G90.1 G2 X2 I1", codes::arc_no_centre, kError, 1, 1, 1},
    {"F9 G2 X5 I2.6", codes::arc_radius_mismatch, kWarning, 1, 1, 1},
    {"F9 G2 X50 I2.6", codes::arc_radius_mismatch, kError, 1, 1, 1},
    {"F9 G2 X100 R49.96", codes::arc_radius_too_small, kWarning, 1, 12, 1},
    {"F9 G2 X50 R20", codes::arc_radius_too_small, kError, 1, 11, 1},
    {"G4 P61", codes::dwell_long, kWarning, 1, 4, 0},
    {"F9 G82 X1 R1 Z0 P2000", codes::dwell_long, kWarning, 1, 17, 4},
    {"G54 G0 X1\nG55 X2", codes::offset_unknown, kWarning, 2, 1, 2},
    {"G59.3 G0 X1\nG54 X2", codes::offset_unknown, kWarning, 2, 1, 2},
    {"T1 M6\nG43 H2", codes::tool_length_other, kWarning, 2, 5, 0},
    {"G97 S900 M3\nG18 F9 G1 X4", codes::turning_program, kWarning, 1, 1, 1},
    {"G0 Z[#5063+1]\nG38.2 Z0 F9\nG0 Z[#5063+1]", codes::value_unknown, kWarning, 3, 4, 3},
    {"F9 G38.2 Z-9\nG82 P1 X1 R5 Z[#5063+1]", codes::value_unknown, kWarning, 2, 14, 5},
    {"F9 G2 X0 R20", codes::arc_in_place, kError, 1, 10, 1},
    {"F9 G81 X5 R1 Z2", codes::cycle_upside_down, kError, 1, 1, 0},
    {"G91 G53 G0 Z-5", codes::g53_incremental, kWarning, 1, 5, 1},
    {"G0 X99999999", codes::position_too_far, kError, 1, 1, 0},
    {"F9 G2 X1 I99999999", codes::position_too_far, kError, 1, 1, 1},
    {"(TOOL/MILL, 3, 0, 10, 0)\nG0 X1", codes::tool_comment_unused, kWarning, 1, 1, 1},
    {"G20 F9", codes::feed_with_units, kNote, 1, 5, 0},
    {"M2\nG0 X1", codes::text_after_end, kWarning, 2, 1, 0},
};

std::size_t motions_of(const Toolpath& path) {
  std::size_t count = 0;
  for (const Step& s : path.steps()) count += s.is_motion() ? 1 : 0;
  return count;
}

TEST(GcodeDiagnostics, EachHasItsLocation) {
  for (const Case& c : kCases) {
    Diagnostics diagnostics;
    const GcodeProgram program =
        read_gcode(std::string(c.text) + "\nM2\n", {.max_rerun_bytes = 100'000}, diagnostics);
    const Diagnostic* found = nullptr;
    for (const Diagnostic& d : diagnostics.list())
      if (found == nullptr && d.code == c.code) found = &d;
    ASSERT_NE(found, nullptr) << c.text;
    EXPECT_EQ(found->severity, c.severity) << c.text;
    EXPECT_EQ(found->where, Origin(TextLocation{"<text>", c.line, c.column}))
        << c.text << ": " << to_string(*found);
    EXPECT_EQ(motions_of(program.path), c.motions) << c.text << ": " << to_string(*found);
  }
}

std::size_t count_of(Code code, std::string_view text) {
  Diagnostics diagnostics;
  read_gcode(std::string(text) + "\nM2\n", {}, diagnostics);
  return static_cast<std::size_t>(std::count_if(diagnostics.list().begin(), diagnostics.list().end(),
                                                [&](const Diagnostic& d) { return d.code == code; }));
}

TEST(GcodeDiagnostics, OffsetsAreNeededForMovesInTwoSystems) {
  EXPECT_EQ(count_of(codes::offset_unknown, "G54\nG55 G0 X1\nX2"), 0u);
  EXPECT_EQ(count_of(codes::offset_unknown, "G0 G53 Z0\nG55 G0 X1\nG54"), 0u);    // no move in G54
  EXPECT_EQ(count_of(codes::offset_unknown, "G10 L2 P2 X0\nG0 X1\nG55 X1"), 1u);  // from which G54?
  EXPECT_EQ(count_of(codes::offset_unknown, "G10 L2 P1 X9 Y0 Z0\nG10 L2 P2 X0 Y0 Z0\nG0 X1\nG55 X1"), 0u);
  EXPECT_EQ(count_of(codes::offset_unknown, "#5241 = 50\nG0 X1\nG55 X1"), 1u);
  EXPECT_EQ(count_of(codes::offset_unknown, "#5221 = 9\n#5241 = 50\nG55 G0 X1\nG54 X1"), 0u);
  EXPECT_EQ(count_of(codes::offset_unknown, "G0 X1\nG55 X1\nG56 X1\nG55 X2"), 1u);
}

TEST(GcodeDiagnostics, ARadiusTooSmallNamesTheSmallestPossible) {
  Diagnostics diagnostics;
  read_gcode("G0 X5 Y5\nG1 Z-3 F200\nG2 X30 Y5 R5\nM2\n", {}, diagnostics);
  ASSERT_EQ(diagnostics.errors(), 1u);
  EXPECT_NE(diagnostics.list().back().message.find("12.5 mm"), std::string::npos);
  EXPECT_EQ(count_of(codes::arc_radius_too_small, "F9 G0 X5 Y5\nG2 X30 Y5 R12.49"), 0u);  // rounded
}

TEST(GcodeDiagnostics, ALongDwellNamesTheUnitOfP) {
  EXPECT_EQ(count_of(codes::dwell_long, "G4 P60"), 0u);
  EXPECT_EQ(count_of(codes::dwell_long, "G4 P2000\nG4 P2000"), 1u);
  Diagnostics diagnostics;
  read_gcode("G4 P2000\nM2\n", {.dialect = GcodeDialect::grbl}, diagnostics);
  EXPECT_NE(diagnostics.list().front().message.find("seconds, as GRBL"), std::string::npos);
  Diagnostics printer;
  read_gcode("G4 P2000\nM2\n", {.dialect = GcodeDialect::marlin}, printer);
  EXPECT_EQ(printer.list().size(), 0u);
}

TEST(GcodeDiagnostics, AnOInsteadOfAZeroHasAHint) {
  for (const char* text : {"G0 X4O", "G0 XO", "G0 X4.O Y1", "G0 X4O5"}) {
    Diagnostics diagnostics;
    read_gcode(std::string(text) + "\nM2\n", {}, diagnostics);
    ASSERT_TRUE(diagnostics.has_errors()) << text;
    EXPECT_NE(diagnostics.list().front().hint.find("digit 0"), std::string::npos) << text;
  }
}

TEST(GcodeDiagnostics, StrictReadingTurnsWarningsIntoErrors) {
  for (const Case& c : kCases) {
    if (c.severity != kWarning || c.code == codes::tool_comment_unused) continue;
    Diagnostics diagnostics;
    read_gcode(std::string(c.text) + "\nM2\n", {.strict = true}, diagnostics);
    EXPECT_TRUE(diagnostics.has_errors()) << c.text;
  }
}

TEST(GcodeDiagnostics, APlainProgramHasNone) {
  Diagnostics diagnostics;
  const std::string_view text =
      "%\nO1000 (part)\nN1 G17 G21 G40 G49 G54 G80 G90 G94 (start)\nN2 T1 M6\nM3 S1000 M8\nG0 X0 Y0 Z5\n"
      "G1 Z-1 F100\nG2 X10 I5\nG3 X0 I-5\n/G0 Z5\nM5 M9\nM30\n%\n";
  const GcodeProgram program = read_gcode(text, {.strict = true}, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty()) << to_string(diagnostics.list().front());
  EXPECT_TRUE(program.ended);
}

/// GRBL 1.1, "gc_execute_line": error 26 where an arc has no axis word in its plane. LinuxCNC accepts it.
TEST(GcodeDiagnostics, FullCirclesWithoutAxisWords) {
  const auto found = [](GcodeDialect dialect, const std::string& arc) {
    Diagnostics diagnostics;
    const auto program = read_gcode("G0 X0 Y0 Z0\n" + arc + " F100\nM2\n", {.dialect = dialect}, diagnostics);
    EXPECT_EQ(program.path[program.path.size() - 2].kind(), StepKind::arc);
    return diagnostics.list().size();
  };
  EXPECT_EQ(found(GcodeDialect::grbl, "G2 I10 J0"), 1u);
  EXPECT_EQ(found(GcodeDialect::grbl, "G2 X0 I10 J0"), 0u);
  EXPECT_EQ(found(GcodeDialect::rs274, "G2 I10 J0"), 0u);
}

TEST(GcodeDiagnostics, MissingEnds) {
  Diagnostics none;
  EXPECT_FALSE(read_gcode("G0 X1\n", {}, none).ended);
  ASSERT_EQ(none.list().size(), 1u);
  EXPECT_EQ(none.list()[0].code, codes::no_program_end);
  Diagnostics lone;
  EXPECT_TRUE(read_gcode("G0 X1\n%\n", {}, lone).ended);
  ASSERT_EQ(lone.list().size(), 1u);
  EXPECT_EQ(lone.list()[0].code, codes::lone_percent);
}

TEST(GcodeDiagnostics, ASpeedAfterM3IsEnough) {
  Diagnostics diagnostics;
  read_gcode("M3\nS1000\nG0 X1\nM2\n", {}, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty()) << to_string(diagnostics.list().front());
}

TEST(GcodeDiagnostics, InInverseTimeAFeedHoldsForItsLineOnly) {
  Diagnostics diagnostics;
  const GcodeProgram program = read_gcode("F100 G1 X1\nG93 X2\nX3 F2\nX4\nG94 F50 X5\nM2\n", {}, diagnostics);
  std::vector<double> feeds;
  for (const Step& s : program.path.steps())
    if (s.is_cutting()) feeds.push_back(s.feed().mm_per_min());
  EXPECT_EQ(feeds, (std::vector<double>{100, 0, 2, 0, 50}));
}

struct NoText {
  std::string_view bytes;
  std::uint32_t line, column;
  std::string_view word;  // of the message
};

TEST(GcodeDiagnostics, BinaryFilesAreOneError) {
  using namespace std::string_view_literals;
  const NoText cases[] = {
      {"\xFF\xFEG\0"
       "0\0\n\0M\0"
       "2\0"sv,
       1, 1, "UTF-16"},
      {"\xFE\xFF\0G\0"
       "0"sv,
       1, 1, "UTF-16"},
      {"G\0"
       "0\0X\0"
       "1\0\n\0M\0"
       "2\0"sv,
       1, 2, "UTF-16"},
      {"G0 X1\n\x7F"
       "ELF\x02\x01\x01\0\0\0\0"sv,
       2, 1, "binary"},
  };
  for (const NoText& c : cases) {
    Diagnostics diagnostics;
    const GcodeProgram program = read_gcode(c.bytes, {}, diagnostics);
    EXPECT_TRUE(program.cut_short && program.path.size() == 0) << c.word;
    ASSERT_EQ(diagnostics.list().size(), 1u) << c.word;
    const Diagnostic& d = diagnostics.list().front();
    EXPECT_EQ(d.code, codes::text_not_plain);
    EXPECT_EQ(d.severity, Severity::error);
    EXPECT_EQ(d.where, Origin(TextLocation{"<text>", c.line, c.column})) << to_string(d);
    EXPECT_NE(d.message.find(c.word), std::string::npos) << d.message;
  }
}

TEST(GcodeDiagnostics, OtherAlphabetsAndStrayBytesAreText) {
  for (const std::string_view comment : {"(Fr\xE4ser)", "(\xE5\x88\x80\xE5\x85\xB7)", "\xEF\xBB\xBF(mark)"}) {
    Diagnostics diagnostics;
    const GcodeProgram program = read_gcode(std::string(comment) + "\nG21\nG0 X1\nM2\n\x1A", {}, diagnostics);
    EXPECT_EQ(program.path.size(), 2u) << comment;
    for (const Diagnostic& d : diagnostics.list()) EXPECT_NE(d.code, codes::text_not_plain) << comment;
  }
}

TEST(GcodeDiagnostics, ManyFaultsCostBoundedMemory) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "G1 X?\n";
  Diagnostics diagnostics;
  read_gcode(text, {}, diagnostics);
  EXPECT_EQ(diagnostics.errors(), 100'000u);
  EXPECT_LT(diagnostics.list().size(), 100u);
}

// GRBL accepts 0.005 mm, or 0.1 percent of the radius (gcode.c, error 33).
TEST(GcodeDiagnostics, RadiiOfAnArcMayDifferByAThousandth) {
  EXPECT_EQ(count_of(codes::arc_radius_mismatch, "F9 G0 X0 Y0\nG2 X4.004 Y0 I2"), 0u);
  EXPECT_EQ(count_of(codes::arc_radius_mismatch, "F9 G0 X0 Y0\nG2 X4.006 Y0 I2"), 1u);
  EXPECT_EQ(count_of(codes::arc_radius_mismatch, "F9 G0 X0 Y0\nG2 X80.039 Y0 I40"), 0u);
  EXPECT_EQ(count_of(codes::arc_radius_mismatch, "F9 G0 X0 Y0\nG2 X80.045 Y0 I40"), 1u);
  EXPECT_EQ(count_of(codes::arc_radius_mismatch, "F9 G0 X0 Y0\nG2 X400.06 Y0 I200"), 1u) << "a visible step";
}

TEST(GcodeDiagnostics, ARepeatedFeedModeNeedsAFeed) {
  EXPECT_EQ(count_of(codes::word_missing, "G94 F100 G1 X1\nG94 F200\nX2"), 0u);
  EXPECT_EQ(count_of(codes::word_missing, "G94 F100 G1 X1\nG94\nX2"), 1u);
  EXPECT_EQ(count_of(codes::word_missing, "G94\nF100 G1 X1"), 0u);
}

}  // namespace
}  // namespace kerf

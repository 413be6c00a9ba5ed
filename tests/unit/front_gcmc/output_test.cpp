// The two forms of output: the text, and the toolpath with its origins; and the library.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "base/codes/files.h"
#include "base/codes/gcmc.h"
#include "gcmc_run.h"

namespace kerf::test {
namespace {

GcmcOptions with(void (*change)(GcmcOptions&)) {
  GcmcOptions options = bare();
  change(options);
  return options;
}

// ---- text

TEST(GcmcText, PrologueAndEpilogue) {
  GcmcOptions options = bare();
  options.frame = GcmcFrame::usual;
  options.date = "2026-01-31 12:00:00";
  options.imperial = options.relative = true;
  options.plane = Plane::xz;
  EXPECT_EQ(
      run("", options).text,
      "(gcmc compiled code, do not change)\n(2026-01-31 12:00:00)\n(-- prologue begin --)\nG18 ( Use XZ "
      "plane )\n"
      "G20 ( Use inch )\nG40 ( Cancel cutter radius compensation )\nG49 ( Cancel tool length compensation )\n"
      "G54 ( Default coordinate system )\nG80 ( Cancel canned cycle )\nG91 ( Use relative distance mode )\n"
      "G94 ( Units Per Minute feed rate mode )\nG64 ( Enable path blending for best speed )\n"
      "(-- prologue end --)\n(-- epilogue begin --)\nM30 (-- epilogue end --)\n");
}

TEST(GcmcText, SubroutineAndOwnFrames) {
  GcmcOptions options = bare();
  options.frame = GcmcFrame::subroutine;
  options.subroutine = "part";
  EXPECT_EQ(run("goto([1]);", options).text,
            "(gcmc compiled function: part, do not change)\no<part> sub\nG0 X1.000\no<part> endsub\nM2\n");
  options.subroutine_ends_program = false;
  EXPECT_EQ(run("", options).text,
            "%\n(gcmc compiled function: part, do not change)\no<part> sub\no<part> endsub\n%\n");
  options.prologue = "(head)\n";
  options.epilogue = "(end)\n";
  EXPECT_EQ(run("goto([1]);", options).text, "(head)\nG0 X1.000\n(end)\n");
}

TEST(GcmcText, RelativeModeWritesDifferences) {
  const GcmcOptions options = with([](GcmcOptions& o) { o.relative = true; });
  EXPECT_EQ(run("goto([1, 2, 3]); move([1, 3]); move_r([0, 1]); move_r([0, 0]);", options).text,
            "G0 X1.000 Y2.000 Z3.000\nG1 X0.000 Y1.000\nG1 Y1.000\nG1 X0.000 Y0.000\n");
  EXPECT_EQ(run("arc_cw([10, 0], 5); arc_ccw([0, 0, -1], 5);", options).text,
            "G2 X10.000 Y0.000 I5.000 J0.000\nG3 X-10.000 Y0.000 Z-1.000 I-5.000 J0.000\n");
}

TEST(GcmcText, OffsetsAndUvw) {
  GcmcOptions options = bare();
  options.offsets = {10, 0, 0, 5, 0, 0, 1, 0, 0};
  options.uvw = true;
  EXPECT_EQ(run("goto([1, 2, 3, 4, 5, 6, 7, 8, 9]);", options).text,
            "G0 X11.000 Y2.000 Z3.000 A9.000 B5.000 C6.000 U8.000 V8.000 W9.000\n");
}

TEST(GcmcText, BriefOmitsWhatIsInForce) {
  const GcmcOptions options = with([](GcmcOptions& o) { o.brief = true; });
  EXPECT_EQ(
      run("feedrate(10); feedrate(10); goto([1, 2, 3]); goto([1, 2, 4]); move([1, 2, 4]); move([2, 2], 10);"
          "arc_cw([4, 2], 1); move([4, 3]);",
          options)
          .text,
      "F10.000\nG0 X1.000 Y2.000 Z3.000\nZ4.000\nG1\nX2.000\nG2 X4.000 Y2.000 I1.000 J0.000\nG1 Y3.000\n");
}

TEST(GcmcText, BriefFollowsRelocation) {
  const GcmcOptions options = with([](GcmcOptions& o) { o.brief = true; });
  // After relocate() the machine is still at X1; the first line names Y only, so X has to be written later.
  EXPECT_EQ(run("goto([1, 1]); relocate([2, 2]); goto([-, 3]); goto([1, 3]);", options).text,
            "G0 X1.000 Y1.000\nY5.000\nX3.000\n");
}

TEST(GcmcText, NumbersKeepTheirSignAndRounding) {
  const GcmcOptions options = with([](GcmcOptions& o) { o.precision = 8; });
  EXPECT_EQ(run("move([-0.000000001, -0.0, 123456.789012345]);", options).text,
            "G1 X-0.00000000 Y0.00000000 Z123456.78901235\n");
}

TEST(GcmcText, TextBeforeAnErrorIsKept) {
  const auto ran = run("goto([1]); goto([-]);");
  EXPECT_EQ(ran.text, "G0 X1.000\nG0\n");
  EXPECT_EQ(ran.run.status, 1);
}

// ---- toolpath

TEST(GcmcPath, PositionsAreCompleteInMillimetres) {
  const GcmcOptions options = with([](GcmcOptions& o) { o.imperial = true; });
  const auto ran = run("feedrate(10); goto([1, 2]); move([-, -, -1]); toolchange(3); dwell(2);", options);
  const Toolpath& path = ran.run.path;
  ASSERT_EQ(path.size(), 4u);
  EXPECT_EQ(path[0].to(), (Point3{25.4, 50.8, 0}));
  EXPECT_EQ(path[0].unknown_axes(), 4u);
  EXPECT_EQ(path[0].named_axes(), 3u);
  EXPECT_EQ(path[1].to(), (Point3{25.4, 50.8, -25.4}));
  EXPECT_EQ(path[1].named_axes(), 4u);
  EXPECT_EQ(path[1].unknown_axes(), 0u);
  EXPECT_DOUBLE_EQ(path[1].feed().mm_per_min(), 254.0);
  EXPECT_EQ(path[2].tool_change().tool, 3);
  EXPECT_DOUBLE_EQ(path[3].dwell().time.seconds(), 2.0);
}

TEST(GcmcPath, ArcsHaveAbsoluteCentres) {
  const auto ran = run("goto([10, 0, 0]); arc_ccw([0, 10], 10, 2); plane(PLANE_XZ); arc_cw([10, -, 0], 5);");
  const Toolpath& path = ran.run.path;
  const step::Arc first = path[1].arc();
  EXPECT_NEAR(first.centre.x, 0, 1e-12);
  EXPECT_NEAR(first.centre.y, 0, 1e-12);
  EXPECT_EQ(first.extra_turns, 1);
  EXPECT_EQ(first.turn, Turn::ccw);
  // In XZ clockwise is seen from +Y: the arc from X0 to X10 goes through negative Z.
  const ArcWalk walk = walk_of(path[2], path[1].to());
  EXPECT_NEAR(walk.at(0.5).z, -5, 1e-9);
  EXPECT_NEAR(walk.at(0.5).x, 5, 1e-9);
}

TEST(GcmcPath, OtherCallsHaveTheirSteps) {
  const auto ran =
      run("spindle(-100); spindlespeed(50); coolant(3); pathmode(1); pathmode(0.5, 1); pause(1);"
          "comment(\"c\"); literal(\"G4\", \" P1\\n\"); layerstack(\"a\"); layer(\"a\"); feedmode(2); "
          "move([1], 2);"
          "svg_closepath(); fixpos_store(1); goto([1,2,3,0,0,90]); literal(\"M9\");");
  const Toolpath& p = ran.run.path;
  ASSERT_EQ(p.size(), 14u) << ran.lines.front();
  EXPECT_EQ(p[0].spindle().turn, SpindleTurn::ccw);
  EXPECT_DOUBLE_EQ(p[1].spindle().speed.rpm(), 50);
  EXPECT_EQ(p[1].spindle().turn, SpindleTurn::ccw);
  EXPECT_TRUE(p[2].coolant().mist && p[2].coolant().flood);
  EXPECT_EQ(p[3].path_mode().kind, PathModeKind::exact_path);
  EXPECT_DOUBLE_EQ(p[4].path_mode().tolerance.mm(), 0.5);
  EXPECT_EQ(p[5].pause().kind, PauseKind::optional);
  EXPECT_EQ(p.text(6), "c");
  EXPECT_DOUBLE_EQ(p[7].dwell().time.seconds(), 1.0);
  EXPECT_EQ(p.layer(8).name, "a");
  EXPECT_DOUBLE_EQ(p[9].feed().mm_per_min(), 100);  // 2 mm per turn at 50 rpm
  EXPECT_EQ(p[10].kind(), StepKind::close_path);
  EXPECT_EQ(p[11].store_home().home, Reference::second_home);
  EXPECT_EQ((*p.extra(12)->abc)[2], 90);
  EXPECT_EQ(p[13].kind(), StepKind::coolant);
  EXPECT_FALSE(p[13].coolant().mist || p[13].coolant().flood);
}

double feed_at(const Ran& ran, std::size_t i) { return ran.run.path[i].feed().mm_per_min(); }

TEST(GcmcPath, FeedModesBecomeFeedsPerMinute) {
  // Inverse time: a feed counts for its own move only, times its length. A new mode clears the feed.
  const auto inverse =
      run("feedrate(100); goto([0, 0, 0]); feedmode(0); move([30, 40], 2); move([60, 80]);"
          "feedrate(3); move([0, 0]); feedmode(1); move([1]); feedmode(1); feedrate(50); move([2]);");
  EXPECT_DOUBLE_EQ(feed_at(inverse, 1), 100);  // 50 mm in half a minute
  EXPECT_EQ(feed_at(inverse, 2), 0);
  EXPECT_EQ(feed_at(inverse, 3), 0);
  EXPECT_EQ(feed_at(inverse, 4), 0);
  EXPECT_DOUBLE_EQ(feed_at(inverse, 5), 50);
  // Per turn: without a speed there is none.
  const auto turns = run("feedmode(2); feedrate(0.1); move([1]); spindle(-1000); move([2]); arc_cw([4], 1);");
  EXPECT_EQ(feed_at(turns, 0), 0);
  EXPECT_DOUBLE_EQ(feed_at(turns, 2), 100);
  EXPECT_DOUBLE_EQ(feed_at(turns, 3), 100);
  EXPECT_EQ(messages_of("feedrate(-1);"), "error: A feed cannot be negative (-1)");
}

TEST(GcmcPath, AxesThatAreNotNamedStayAfterRelocation) {
  // As in the text: the words X2 Y0 do not move Z, whatever relocate() has set.
  const auto ran =
      run("goto([0, 0, 5]); relocate([0, 0, 10]); goto([2, 0]); goto([3, 0, 1]); circle_cw([1, 0]);");
  EXPECT_EQ(ran.run.path[1].to(), (Point3{2, 0, 5}));
  EXPECT_EQ(ran.run.path[2].to(), (Point3{3, 0, 11}));
}

TEST(GcmcPath, StoredPositions) {
  // Only the named axes go home. A home that the program has not stored is unknown.
  const auto ran =
      run("goto([1, 2, 3]); fixpos_store(0); goto([9, 9, 9]); fixpos_restore(0, [5]);"
          "fixpos_restore(0); fixpos_set(1, [7, 7, 7]); fixpos_restore(1); goto([4]);");
  const Toolpath& p = ran.run.path;
  ASSERT_EQ(p.size(), 10u);
  EXPECT_EQ(p[3].to(), (Point3{5, 9, 9}));
  EXPECT_EQ(p[4].to(), (Point3{1, 9, 9}));
  EXPECT_EQ(p[6].to(), (Point3{1, 2, 3}));
  EXPECT_EQ(p[6].unknown_axes(), 0u);
  EXPECT_EQ(p[8].reference(), Reference::second_home);
  EXPECT_EQ(p[8].unknown_axes(), 7u);
  EXPECT_EQ(p[9].unknown_axes(), 6u);
}

TEST(GcmcPath, ToolChangesStopTheSpindleAndCoolantAddsUp) {
  const auto ran = run("spindle(100); toolchange(2); coolant(1); coolant(2); coolant(0);");
  const Toolpath& p = ran.run.path;
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(p[1].spindle().turn, SpindleTurn::off);
  EXPECT_EQ(p[2].tool_change().tool, 2);
  EXPECT_TRUE(p[4].coolant().mist && p[4].coolant().flood);
  EXPECT_FALSE(p[5].coolant().mist || p[5].coolant().flood);
}

std::string kinds_of(const std::string& program, const GcmcOptions& options = bare()) {
  const auto ran = run(program, options);
  if (!ran.lines.empty()) return ran.lines.front();
  std::string text;
  for (const Step& s : ran.run.path.steps())
    text += (text.empty() ? "" : " ") + std::string(name_of(s.kind()));
  return text;
}

TEST(GcmcPath, TheUsualFrameEndsTheProgram) {
  GcmcOptions options = bare();
  options.frame = GcmcFrame::usual;
  EXPECT_EQ(kinds_of("move([1]);", options), "cut end");
  EXPECT_EQ(kinds_of("spindle(100); coolant(1);", options), "spindle coolant spindle coolant end");
  EXPECT_EQ(kinds_of("literal(\"M2\\n\"); move([1]); layer(\"a\");", options),
            "warning: layer() layer 'a' not found, added to the stack");
  EXPECT_EQ(kinds_of("literal(\"M2\\n\"); move([1]); svg_closepath(); comment(\"x\");", options), "end");
}

TEST(GcmcPath, LiteralLinesBecomeSteps) {
  EXPECT_EQ(kinds_of("literal(\"(hello)\\n\\n   \\nM3 S1000 (fast)\\n\"); literal(\"T4\", \" M6\\nM8\\n\");"),
            "note note spindle spindle tool coolant");
  EXPECT_EQ(kinds_of("literal(\"G61.1\\nG64 P0.1 Q0.2\\nM0\\nM1\\nM60\\nM64 P1\\nM101\\nG4 P2\\nM5\\n\");"),
            "pathmode pathmode pause pause pause verbatim verbatim dwell spindle");
  EXPECT_EQ(kinds_of("literal(\"  \"); goto([1]);"), "rapid");
  EXPECT_EQ(
      kinds_of("literal(\"M7 \"); comment(\"x\"); comment(\"a\\nM8\");"),
      "error: The line \"M8)\" cannot be part of a toolpath: ')' is not allowed here, expected a letter");
  EXPECT_EQ(kinds_of("comment(\"a) M8 (b\");"), "note note coolant");
  const auto ran = run("literal(\"T7\\n\"); literal(\"M6\\n\"); literal(\"S50\\nM4\\n\");");
  EXPECT_EQ(ran.run.path[0].tool_change().tool, 7);
  EXPECT_DOUBLE_EQ(ran.run.path[1].spindle().speed.rpm(), 50);
}

TEST(GcmcPath, LiteralLinesThatMoveOrChangeModesAreRefused) {
  for (const char* line :
       {"G91",    "G20",     "G92 X0", "G1 Z-20 F100", "G0",     "G18",       "G41 D1", "G55",          "G93",
        "G99",    "G81 Z-1", "G28",    "G28.1",        "G43 H1", "G38.2 Z-1", "F100",   "X5",           "A90",
        "M61 Q1", "M98 P1",  "M70",    "#1=5",         "G4 P#1", "o100 call", "%",      "/M8",          "G4",
        "M3 M64", "M3 P1",   "hello",  "M6",           "T1.5",   "S-1",       "M3 M4",  "G5.1 X1 Y1 I1"}) {
    const auto ran = run(std::string("goto([1]);\n literal(\"") + line + "\\n\"); goto([2]);");
    ASSERT_EQ(ran.messages.size(), 1u) << line;
    EXPECT_EQ(ran.messages[0].code, codes::gcmc_literal) << line;
    EXPECT_EQ(location_of(ran.messages[0]).line, 2u) << line;
    EXPECT_EQ(ran.run.path.size(), 1u) << line;
    EXPECT_NE(ran.messages[0].message.find(line), std::string::npos) << ran.messages[0].message;
  }
  EXPECT_EQ(messages_of("literal(\"G91\\n\");"),
            "error: The line \"G91\" cannot be part of a toolpath: G91 changes the distance mode");
  EXPECT_EQ(
      messages_of("literal(\"M8\"); goto([1]);"),
      "error: The line \"M8\" of literal() has no line end: the words of this call would be appended to it");
  GcmcOptions text = bare();
  text.want_path = false;
  EXPECT_EQ(run("literal(\"G91\\n\"); literal(\"X1 \"); goto([1]);", text).text, "G91\nX1 G0 X1.000\n");
  GcmcOptions drawing = bare();
  drawing.target = GcmcTarget::svg;
  EXPECT_EQ(kinds_of("literal(\"G91\\n\"); literal(\"X1 \"); goto([1]);", drawing), "rapid");
}

TEST(GcmcPath, DrillIsMadeOfItsMoves) {
  const auto ran = run("goto([0, 0, 10]); drill([1, 2, -2.5], 5, 5);");
  const Toolpath& p = ran.run.path;
  ASSERT_EQ(p.size(), 7u);
  EXPECT_EQ(p[1].to(), (Point3{1, 2, 10}));
  EXPECT_EQ(p[3].to(), (Point3{1, 2, 0}));
  EXPECT_EQ(p[5].to(), (Point3{1, 2, -2.5}));
  EXPECT_TRUE(p[5].is_cutting());
  EXPECT_EQ(p[6].to(), (Point3{1, 2, 5}));
}

TEST(GcmcPath, AnAxisThatIsNotNamedStays) {
  const auto ran = run("goto([1, 1, 1, 10]); relocate([2, 2, 2, 2]); goto([-, 3]); move([-, -, 1]);");
  const Toolpath& p = ran.run.path;
  EXPECT_EQ(ran.text, "G0 X1.000 Y1.000 Z1.000 A10.000\nG0 Y5.000\nG1 Z3.000\n");
  ASSERT_EQ(p.size(), 3u);
  EXPECT_EQ(p[1].to(), (Point3{1, 5, 1}));
  EXPECT_EQ(p[2].to(), (Point3{1, 5, 3}));
  EXPECT_EQ(p.extra(2)->abc->at(0), 10);
}

TEST(GcmcPath, DrillRisesToTheRetractPlaneFirst) {
  const auto ran = run("goto([0, 0, 1]); drill([3, 0, -1], 5, 4, 2);");
  const Toolpath& p = ran.run.path;
  EXPECT_EQ(ran.text, "G0 X0.000 Y0.000 Z1.000\nG73 X3.000 Y0.000 Z-1.000 R5.000 Q4.000 L2\n");
  const Point3 wanted[] = {{0, 0, 1}, {0, 0, 5}, {3, 0, 5}, {3, 0, 1},     {3, 0, 1.254}, {3, 0, -1},
                           {3, 0, 5}, {3, 0, 5}, {3, 0, 1}, {3, 0, 1.254}, {3, 0, -1},    {3, 0, 5}};
  ASSERT_EQ(p.size(), std::size(wanted));
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(p[i].to(), wanted[i]) << i;
}

TEST(GcmcPath, OriginsNameLineAndCalls) {
  const auto ran = run("function f() {\n  goto([1]);\n}\nf();\nrepeat(3) { move([2]); }\nf();");
  const Toolpath& p = ran.run.path;
  EXPECT_EQ(to_string(p.origin_of(0)), "t.gcmc:2:11");
  const auto calls = p.origins().callers(p[0].origin());
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(to_string(calls[0]), "t.gcmc:4:3");
  EXPECT_EQ(p[1].origin(), p[3].origin());  // one location is one origin
  EXPECT_EQ(to_string(p.origins().callers(p[4].origin()).at(0)), "t.gcmc:6:3");
}

TEST(GcmcPath, OriginsReachThroughTheLibrary) {
  const auto ran = run("include(\"tracepath.inc.gcmc\");\ntracepath({[1, 1], [2, 2]}, -1mm);");
  const Toolpath& p = ran.run.path;
  const auto* location = std::get_if<TextLocation>(&p.origins().callers(p[1].origin()).at(0));
  ASSERT_NE(location, nullptr);
  EXPECT_EQ(location->line, 2u);
}

TEST(GcmcPath, TheNumberOfStepsIsLimited) {
  GcmcOptions options = bare();
  options.max_path_steps = 100;
  EXPECT_EQ(messages_of("repeat(1000; i) { move([i]); }", options),
            "error: The toolpath has more than 100 steps");
}

// ---- include

TEST(GcmcInclude, PathsAreSearchedInOrder) {
  const std::string folder = testing::TempDir();
  const std::string file = folder + "kerf_gcmc_included.gcmc";
  std::ofstream(file) << "inside = 7;\nmessage(oops);\n";
  GcmcOptions options = bare();
  options.include_paths = {folder};
  const auto ran = run("include(\"kerf_gcmc_included.gcmc\");", options);
  EXPECT_EQ(to_string(ran.messages.at(0).where), file + ":2:13");
  std::ofstream(file) << "include(\"kerf_gcmc_included.gcmc\");\n";
  EXPECT_NE(messages_of("include(\"kerf_gcmc_included.gcmc\");", options).find("nested too deeply"),
            std::string::npos);
  std::remove(file.c_str());
}

TEST(GcmcInclude, UnreadableIncludesAreNamed) {
  EXPECT_EQ(messages_of("include(\"/\");"), "error: Include file '/': cannot read the file: it is a folder");
  EXPECT_EQ(run("include(\"/\");").messages.at(0).code, codes::file_unreadable);
  EXPECT_EQ(messages_of("include(\"/dev/zero\");"),
            "error: Include file '/dev/zero': it is a device, not a regular file");
  const std::filesystem::path large = std::filesystem::path(testing::TempDir()) / "kerf_large.gcmc";
  std::ofstream(large) << ";";
  std::filesystem::resize_file(large, std::uintmax_t{1} << 30);  // sparse
  const std::string message = messages_of("include(\"" + large.string() + "\");");
  EXPECT_NE(message.find("kerf_large.gcmc': the file is larger than the limit of 268435456 bytes"),
            std::string::npos)
      << message;
  std::filesystem::remove(large);
  // A folder of that name does not hide a file later in the search order.
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "kerf_hides";
  std::filesystem::create_directories(folder / "varcs.inc.gcmc");
  GcmcOptions options = bare();
  options.include_paths = {folder.string()};
  EXPECT_EQ(messages_of("include(\"varcs.inc.gcmc\");", options), "");
  std::filesystem::remove_all(folder);
}

// ---- library

const std::string kDrill = "include(\"canned_drill.inc.gcmc\"); ";

TEST(GcmcLibrary, DrillCycle) {
  EXPECT_EQ(
      run(kDrill + "goto([0,0,10]); canned_drill({[1,1,-2],[2],[-,3,-3]}, 5, 0.5, 1);").text,
      "G0 X0.000 Y0.000 Z10.000\n(-- canned_drill R-plane=5.000mm dewlling=0.500 return-to-old-Z=1 --)\nG61\n"
      "G0 X1.000 Y1.000\nG0 Z5.000\nG1 Z-2.000\nG4 P0.500\nG0 Z10.000\n"
      "G0 X2.000\nG0 Z5.000\nG1 Z-2.000\nG4 P0.500\nG0 Z10.000\n"
      "G0 Y3.000\nG0 Z5.000\nG1 Z-3.000\nG4 P0.500\nG0 Z10.000\nG0 Z10.000\n(-- end canned_drill --)\n");
}

TEST(GcmcLibrary, PeckCycle) {
  EXPECT_EQ(
      run(kDrill + "goto([0,0,10]); canned_drill_peck({[1,1,-4]}, 5mm, 3mm, 0);").text,
      "G0 X0.000 Y0.000 Z10.000\n(-- canned_drill_peck R-plane=5.000mm peck-increment=3.000mm "
      "return-to-old-Z=0 --)\nG61\nG0 X1.000 Y1.000\nG0 Z5.000\nG1 Z2.000\nG0 Z5.000\nG0 Z2.200\nG1 Z-1.000\n"
      "G0 Z5.000\nG0 Z-0.800\nG1 Z-4.000\nG0 Z5.000\n(-- end canned_drill_peck --)\n");
}

TEST(GcmcLibrary, DrillRefusals) {
  EXPECT_EQ(messages_of(kDrill + "canned_drill({[1,1]}, 5mm, -1, 0);"),
            "Runtime error(): canned_drill(): Argument 1 'holelist[0]' has no Z-coordinate");
  EXPECT_EQ(
      messages_of(kDrill + "canned_drill({}, 5mm, -1, 0);"),
      "Runtime warning(): canned_drill(): Argument 1 'holelist' has no entries, canned cycle not performed");
  EXPECT_EQ(messages_of(kDrill + "canned_drill_peck({[1,1,-6]}, 5mm, 0mm, 0);"),
            "Runtime error(): canned_drill_peck(): Argument 3 'delta' must > 0.0");
  EXPECT_EQ(messages_of(kDrill + "canned_drill({[1,1,6]}, 5mm, -1, 0);"),
            "Runtime warning(): canned_drill(): drilling at [1,1] to depth 6mm is higher than retract-plane "
            "(5.000mm), "
            "skipping");
}

TEST(GcmcLibrary, Tracepath) {
  EXPECT_EQ(
      run("include(\"tracepath.inc.gcmc\"); goto([0,0,5]); tracepath({[1,1,7],[2,2]}, -1mm, 0.25);").text,
      "G0 X0.000 Y0.000 Z5.000\n(-- tracepath at Z=-1mm --)\nG0 X1.000 Y1.000 Z7.000\nG1 Z-1.000\nG4 P0.250\n"
      "G1 X2.000 Y2.000\nG4 P0.250\nG1 X1.000 Y1.000 Z7.000\nG4 P0.250\nG1 Z5.000\n(-- tracepath end --)\n");
  EXPECT_EQ(run("include(\"tracepath.inc.gcmc\"); tracepath({[1,1]});").text,
            "(-- tracepath at Z=<undef> --)\nG0 X1.000 Y1.000\nG1 X1.000 Y1.000\n(-- tracepath end --)\n");
}

TEST(GcmcLibrary, Engrave) {
  EXPECT_EQ(run("include(\"engrave.inc.gcmc\"); engrave({[-,-,1],[2,2,-],[-,-,0],[3,3,-]}, 1, -1);").text,
            "G0 Z1.000\nG0 X2.000 Y2.000\nG1 Z-1.000\nG1 X3.000 Y3.000\n");
  EXPECT_EQ(messages_of("include(\"engrave.inc.gcmc\"); engrave({}, 1deg, -1);"),
            "Runtime warning(): engrave(): Argument 2, 'zup', must be distance");
}

TEST(GcmcLibrary, ArcsAsPoints) {
  const std::string varcs = "include(\"varcs.inc.gcmc\"); ";
  const auto points = [&](const std::string& expression) {
    return messages_of(varcs + "message(" + expression + ");");
  };
  EXPECT_EQ(points("varc_cw([10mm,0mm],5mm,0,5mm,45deg)"),
            "Runtime message(): {[1.464mm,3.536mm],[5.000mm,5.000mm],[8.536mm,3.536mm],[10mm,0mm]}");
  EXPECT_EQ(points("varc_ccw([10mm,0mm],5mm,0,5mm,90deg)"),
            "Runtime message(): {[2.500mm,-4.330mm],[7.500mm,-4.330mm],[10mm,0mm]}");
  for (const char* way : {"varc_ccw([10mm,10mm],10mm,0,1mm,5deg)", "varc_cw([10mm,10mm],10mm,0,1mm,5deg)",
                          "varc_ccw([-10mm,10mm],10mm,0,1mm,5deg)"})  // rounding adds no step
    EXPECT_EQ(points(std::string("count(") + way + ")"), "Runtime message(): 18") << way;
  EXPECT_EQ(points("count(varc_ccw([10mm,10mm],10mm,0,1mm,4.999deg))"), "Runtime message(): 19");
  EXPECT_EQ(points("count(varc_cw([10mm,0mm],5mm)), \" \", count(vcircle_cw([0mm,50mm])), \" \", "
                   "count(vcircle_cw([0mm,1mm]))"),
            "Runtime message(): 180 3142 360");
  EXPECT_EQ(
      points("vcircle_ccw([5mm,0mm,8mm],0,5mm,90deg)"),
      "Runtime message(): {[2.500mm,-4.330mm,1.333mm],[7.500mm,-4.330mm,2.667mm],[10.000mm,-0.000mm,4.000mm],"
      "[7.500mm,4.330mm,5.333mm],[2.500mm,4.330mm,6.667mm],[0.000mm,0.000mm,8mm]}");
  EXPECT_EQ(points("vcircle_cw([-,5mm,0mm],0,10mm,90deg,PLANE_YZ)[0]"),
            "Runtime message(): [-,5.000mm,5.000mm]");
  EXPECT_EQ(points("varc_cw([10mm,3mm,0mm],8mm,0,10mm,45deg,PLANE_XZ)"),
            "Runtime message(): {[5.000mm,1.500mm,1.755mm],[10mm,3mm,0mm]}");
  EXPECT_EQ(points("varc_cw([10mm,0mm],4mm)"),
            "Runtime error(): varc_cw() radius (4mm) is less than two times distance "
            "from start to end (D=-36.000mm)|Runtime message(): {}");
}

TEST(GcmcLibrary, ListsCanBeTurned) {
  const auto ran = run("include(\"vlistrotate.inc.gcmc\"); message(vlistrotate({[1],[2],[3]}, 1));");
  ASSERT_EQ(ran.lines.size(), 2u);
  EXPECT_NE(ran.lines[0].find("deprecated"), std::string::npos);
  EXPECT_EQ(ran.lines[1], "Runtime message(): {[3],[1],[2]}");
}

TEST(GcmcLibrary, BezierCurves) {
  const std::string bezier = "include(\"vbezier.inc.gcmc\"); ";
  EXPECT_EQ(messages_of(bezier + "message(vbezier3([0mm,0mm],[0mm,10mm],[10mm,10mm],[10mm,0mm],1.0,5mm));"),
            "Runtime message(): {[5.000mm,7.500mm],[10mm,0mm]}");
  EXPECT_EQ(
      messages_of(bezier + "message(count(vbezier3([0mm,0mm],[0mm,10mm],[10mm,10mm],[10mm,0mm])), \" \", "
                           "count(vbezier2([0mm,0mm],[5mm,10mm],[10mm,0mm])));"),
      "Runtime message(): 326 168");
  EXPECT_EQ(
      messages_of(bezier + "message(vbezier3([0,0],[1,0],[2,0],[3,0],-1));"),
      "Runtime error(): vbezier3(): Argument 'flatness' must be larger than zero|Runtime message(): {}");
}

TEST(GcmcLibrary, CompensatedTrace) {
  const std::string square =
      "include(\"tracepath_comp.inc.gcmc\"); goto([0,0,5]); "
      "sq = {[0,0,-1],[0,10],[10,10],[10,0]} * 1mm; ";
  EXPECT_EQ(
      run(square + "tracepath_comp(sq, 1mm, TPC_LEFT|TPC_ARCIN|TPC_ARCOUT|TPC_KEEPZ|TPC_OLDZ);").text,
      "G0 X0.000 Y0.000 Z5.000\n(-- tracepath_comp at left side at width=1.000mm --)\nG0 X-2.000 Y-1.000\n"
      "G1 X-2.000 Y-1.000\nG3 X-1.000 Y0.000 I0.000 J1.000\nG1 X-1.000 Y10.000\nG2 X0.000 Y11.000 I1.000 "
      "J0.000\n"
      "G1 X10.000 Y11.000\nG2 X11.000 Y10.000 I0.000 J-1.000\nG1 X11.000 Y0.000\n"
      "G3 X12.000 Y-1.000 I1.000 J0.000\nG0 Z5.000\n(-- tracepath_comp end --)\n");
  EXPECT_EQ(messages_of("include(\"tracepath_comp.inc.gcmc\"); "
                        "tracepath_comp({[0,0,-1],[0,10],[0.5,10],[0.5,0],[10,0]}*1mm, 1mm, TPC_RIGHT);",
                        with([](GcmcOptions& o) { o.own_warnings = false; })),
            "Runtime warning(): Removed 1 unreachable internal corner(s)");
  EXPECT_EQ(messages_of("include(\"tracepath_comp.inc.gcmc\"); tracepath_comp({[0,0]}, 1mm, TPC_RIGHT);"),
            "Runtime error(): tracepath_comp(): Argument 1 'path' has fewer than 2 points");
}

}  // namespace
}  // namespace kerf::test

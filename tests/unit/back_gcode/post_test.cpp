// The output of the posts, line by line, and what they refuse.
#include "kerf/program/post.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "back/gcode/line_buffer.h"
#include "base/codes/gcode.h"

namespace kerf {
namespace {

/// A profile without templates: only the lines of the steps.
PostProfile bare(std::string_view name) {
  PostProfile profile = *find_post(name);
  profile.header.clear();
  profile.section.clear();
  profile.footer.clear();
  profile.spindle_dwell = Duration{};
  return profile;
}

struct Posted {
  std::vector<PostedFile> files;
  Diagnostics diagnostics;
  std::string text() const { return files.empty() ? "" : files.front().text; }
  bool reports(Code code) const {
    const auto& list = diagnostics.list();
    return std::any_of(list.begin(), list.end(), [code](const Diagnostic& d) { return d.code == code; });
  }
};

Posted posted(const Toolpath& path, const PostProfile& profile, const PostOptions& options = {}) {
  Posted out;
  out.files = post(path, profile, options, out.diagnostics);
  return out;
}

Toolpath at_origin() {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  return path;
}

const Feed kFeed = mm_per_min(600);

TEST(Numbers, are_exact_counts) {
  const auto text = [](std::int64_t v, int decimals, gcode::Fraction f) {
    char buffer[32];
    return std::string(buffer, gcode::write_units(buffer, v, decimals, f));
  };
  using gcode::Fraction;
  EXPECT_EQ(text(12500, 3, Fraction::shortest), "12.5");
  EXPECT_EQ(text(12500, 3, Fraction::full), "12.500");
  EXPECT_EQ(text(-250, 3, Fraction::shortest), "-0.25");
  EXPECT_EQ(text(-1, 3, Fraction::shortest), "-0.001");
  EXPECT_EQ(text(0, 3, Fraction::shortest), "0");
  EXPECT_EQ(text(0, 3, Fraction::full), "0.000");
  EXPECT_EQ(text(1000, 3, Fraction::shortest), "1");
  EXPECT_EQ(text(7, 0, Fraction::shortest), "7");
}

TEST(Post, writes_only_what_changes) {
  Toolpath path = at_origin();
  path.add(step::Cut{{0, 0, -1}, kFeed}, OriginId::none);
  path.add(step::Cut{{10, 0, -1}, kFeed}, OriginId::none);
  path.add(step::Cut{{10, 2.5, -1}, mm_per_min(300)}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG1 Z-1 F600\nX10\nY2.5 F300\n");
}

TEST(Post, moves_of_length_zero_are_written) {
  Toolpath path = at_origin();
  path.add(step::Cut{{0, 0, 5}, kFeed}, OriginId::none);
  path.add(step::Rapid{{0, 0.0001, 5}}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG1 X0 F600\nG0 X0\n");
}

TEST(Post, writes_inches) {
  Toolpath path = at_origin();
  path.add(step::Cut{{25.4, 0, -2.54}, mm_per_min(254)}, OriginId::none);
  PostOptions options;
  options.unit = LengthUnit::inch;
  EXPECT_EQ(posted(path, bare("grbl"), options).text(), "G0 X0 Y0 Z0.1969\nG1 X1 Z-0.1 F10\n");
}

TEST(Post, arcs_have_both_axes_and_both_centre_words) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {10, 0, 5}, .centre = {5, 0}, .turn = Turn::cw, .feed = kFeed}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG17 G2 X10 Y0 I5 J0 F600\n");
}

TEST(Post, full_circles_are_split) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {0, 0, 3}, .centre = {5, 0}, .turn = Turn::ccw, .feed = kFeed}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(),
            "G0 X0 Y0 Z5\nG17 G3 X10 Y0 Z4 I5 J0 F600\nG3 X0 Y0 Z3 I-5 J0\n");
}

TEST(Post, a_tiny_arc_never_becomes_a_full_circle) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {0.0002, 0.0002, 5}, .centre = {0, 5}, .turn = Turn::ccw, .feed = kFeed},
           OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text().find("G3"), std::string::npos);
}

TEST(Post, arcs_in_other_planes) {
  Toolpath path = at_origin();
  path.add(
      step::Arc{.to = {10, 0, 5}, .centre = {5, 5}, .plane = Plane::xz, .turn = Turn::ccw, .feed = kFeed},
      OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG18 G3 X10 Z5 I5 K0 F600\n");
}

TEST(Post, arcs_become_chords_for_controllers_without_arcs) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {10, 0, 5}, .centre = {5, 0}, .turn = Turn::cw, .feed = kFeed}, OriginId::none);
  const Posted out = posted(path, bare("klipper"));
  EXPECT_EQ(out.text().find("G2"), std::string::npos);
  EXPECT_GT(out.files.front().lines, 20u);
}

TEST(Post, an_uneven_arc_becomes_chords_with_a_warning) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {10.3, 0, 5}, .centre = {5, 0}, .turn = Turn::cw, .feed = kFeed}, OriginId::none);
  const Posted out = posted(path, bare("grbl"));
  EXPECT_TRUE(out.reports(codes::post_arc_uneven));
  EXPECT_EQ(out.text().find("G2"), std::string::npos);
  Toolpath refused = at_origin();
  refused.add(step::Arc{.to = {11.5, 0, 5}, .centre = {5, 0}, .turn = Turn::cw, .feed = kFeed},
              OriginId::none);
  EXPECT_TRUE(posted(refused, bare("grbl")).reports(codes::post_cannot));
}

TEST(Post, spindle_stops_before_a_tool_change_and_starts_again) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Spindle{rpm(12000), SpindleTurn::cw}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Rapid{{1, 0, 5}}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grblhal")).text(),
            "T1 M6\nM3 S12000\nG0 X0 Y0 Z5\nM5\nT2 M6\nM3 S12000\nG0 X1 Y0 Z5\nM5\n");
  EXPECT_EQ(posted(path, bare("grbl")).text(),
            "M3 S12000\nG0 X0 Y0 Z5\nM5\n(change to tool 2)\nM0\nM3 S12000\nG0 X1 Y0 Z5\nM5\n");
}

TEST(Post, a_speed_set_by_hand_after_an_s_word_is_reported) {
  Toolpath path = at_origin();
  path.add(step::Spindle{rpm(0), SpindleTurn::cw}, OriginId::none);
  path.add(step::Cut{{0, 0, -1}, kFeed}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).diagnostics.list().empty());
  path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, OriginId::none);
  path.add(step::Spindle{}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).diagnostics.list().empty());
  path.add(step::Spindle{rpm(0), SpindleTurn::cw}, OriginId::none);  // the controller keeps S9000
  path.add(step::Cut{{9, 0, -1}, kFeed}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_left_out));
}

/// M3 of a mill switches the beam on.
TEST(Post, a_post_for_another_drive_is_reported) {
  Toolpath mill = at_origin(), laser = at_origin();
  mill.add(step::Spindle{rpm(9000), SpindleTurn::cw}, OriginId::none);
  laser.add(step::LaserPower{LaserMode::constant, 300}, OriginId::none);
  for (Toolpath* path : {&mill, &laser}) path->add(step::Cut{{9, 0, 5}, kFeed}, OriginId::none);
  EXPECT_TRUE(posted(mill, bare("laser")).reports(codes::post_left_out));
  EXPECT_TRUE(posted(laser, bare("laser")).diagnostics.list().empty());
  EXPECT_TRUE(posted(laser, bare("grbl")).reports(codes::post_left_out));
  EXPECT_TRUE(posted(mill, bare("grbl")).diagnostics.list().empty());
}

TEST(Post, a_probe_by_g31_loses_its_error) {
  for (const ProbeKind kind : {ProbeKind::contact_or_error, ProbeKind::contact}) {
    Toolpath path = at_origin();
    path.add(step::Probe{{0, 0, -5}, kFeed, kind}, OriginId::none);
    path.set_unknown_axes(path.size() - 1, 4);
    path.set_probed_axes(path.size() - 1, 4, 4, 0);
    EXPECT_EQ(posted(path, bare("mach3")).reports(codes::post_left_out), kind == ProbeKind::contact_or_error);
  }
}

TEST(Post, each_file_of_a_tool_starts_above_the_last_position) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{3, 4, 5}}, OriginId::none);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Cut{{3, 4, -1}, kFeed}, OriginId::none);
  PostOptions options;
  options.tool_change = ToolChangePolicy::files;
  const Posted out = posted(path, bare("grbl"), options);
  ASSERT_EQ(out.files.size(), 2u);
  EXPECT_EQ(out.files[0].tool, 1);
  EXPECT_EQ(out.files[0].text, "G0 X3 Y4 Z5\n");
  EXPECT_EQ(out.files[1].tool, 2);
  EXPECT_EQ(out.files[1].text, "G0 Z5\nX3 Y4\nG1 Z-1 F600\n");
}

/// M61 states the number of the tool that is in the spindle already. No tool is changed, so that no file
/// ends.
TEST(Post, a_number_of_a_tool_ends_no_file) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Cut{{0, 0, -1}, kFeed}, OriginId::none);
  path.add(step::ToolChange{2, ToolChangeKind::number_only}, OriginId::none);
  path.add(step::Cut{{30, 0, -1}, kFeed}, OriginId::none);
  PostProfile profile = bare("linuxcnc");
  profile.header = {"({bounds})", "({tools})"};
  PostOptions options;
  options.tool_change = ToolChangePolicy::files;
  const Posted out = posted(path, profile, options);
  ASSERT_EQ(out.files.size(), 1u);
  EXPECT_EQ(out.text().substr(0, out.text().find("G0")),
            "(cuts within X 0 to 30 Y 0 to 0 Z -1 to 5 mm)\n(tools 1, 2)\n");
}

TEST(Post, spindle_waits_unless_the_program_does) {
  PostProfile profile = bare("grbl");
  profile.spindle_dwell = seconds(2);
  Toolpath path;
  path.add(step::Spindle{rpm(100), SpindleTurn::cw}, OriginId::none);
  EXPECT_EQ(posted(path, profile).text().substr(0, 15), "M3 S100\nG4 P2\nM");
  path.add(step::Dwell{seconds(0.5)}, OriginId::none);
  EXPECT_EQ(posted(path, profile).text(), "M3 S100\nG4 P0.5\nM5\n");
  EXPECT_EQ(posted(path, bare("marlin")).text(), "M3 S100\nG4 P500\nM5\n");
}

TEST(Post, laser_power_is_written_with_the_moves) {
  Toolpath path = at_origin();
  path.add(step::LaserPower{LaserMode::dynamic, 100}, OriginId::none);
  path.add(step::Cut{{1, 0, 5}, kFeed}, OriginId::none);
  path.add(step::LaserPower{LaserMode::dynamic, 200}, OriginId::none);
  path.add(step::Cut{{2, 0, 5}, kFeed}, OriginId::none);
  path.add(step::LaserPower{}, OriginId::none);
  EXPECT_EQ(posted(path, bare("laser")).text(), "G0 X0 Y0 Z5\nM4 S100\nG1 X1 F600\nX2 S200\nM5\n");
}

TEST(Post, a_power_with_its_mode_replaces_an_older_one) {
  Toolpath path = at_origin();
  path.add(step::LaserPower{LaserMode::dynamic, 100}, OriginId::none);
  path.add(step::LaserPower{LaserMode::dynamic, 200}, OriginId::none);
  path.add(step::LaserPower{LaserMode::constant, 300}, OriginId::none);
  path.add(step::Cut{{1, 0, 5}, kFeed}, OriginId::none);
  EXPECT_EQ(posted(path, bare("laser")).text(), "G0 X0 Y0 Z5\nM4 S100\nM3 S300\nG1 X1 F600\nM5\n");
}

TEST(Post, printers_get_one_command_per_line) {
  Toolpath path = at_origin();
  path.add(step::Cut{{1, 0, 5}, kFeed}, OriginId::none);
  path.add(step::Cut{{2, 0, 5}, kFeed}, OriginId::none);
  path.add(step::Arc{.to = {4, 0, 5}, .centre = {3, 0}, .feed = kFeed}, OriginId::none);
  EXPECT_EQ(posted(path, bare("marlin")).text(), "G0 X0 Y0 Z5\nG1 X1 F600\nG1 X2\nG17\nG3 X4 Y0 I1 J0\n");
  const std::size_t home = path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.set_unknown_axes(home, 7);
  path.set_reference(home, Reference::home, 7);
  EXPECT_TRUE(posted(path, bare("marlin")).reports(codes::post_left_out));  // G28 would run to the switches
}

TEST(Post, beads_for_printers_only) {
  Toolpath path = at_origin();
  const double area = std::acos(-1.0) * 0.875 * 0.875;
  path.add(step::Extrude{{10, 0, 5}, mm3(area), mm(0.4), mm(0.2), kFeed}, OriginId::none);
  path.add(step::Temperature{Heater::nozzle, 210, true}, OriginId::none);
  path.add(step::Fan{0, 0.5}, OriginId::none);
  EXPECT_EQ(
      posted(path, bare("marlin")).text(),
      "G0 X0 Y0 Z5\n;LAYER_CHANGE\n;Z:5\n;WIDTH:0.4\n;HEIGHT:0.2\nG1 X10 E1 F600\nM109 S210\nM106 S128\n");
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_cannot));
}

TEST(Post, machine_coordinates_are_kept) {
  Toolpath path = at_origin();
  const std::size_t up = path.add(step::Rapid{{0, 0, -3}}, OriginId::none);
  path.set_unknown_axes(up, 4);
  path.set_reference(up, Reference::machine, 4);
  const std::size_t home = path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.set_unknown_axes(home, 7);
  path.set_reference(home, Reference::home, 7);
  path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(),
            "G0 X0 Y0 Z5\nG53 G0 Z-3\nG91 G28 X0 Y0 Z0\nG90\nG0 X0 Y0 Z0\n");
}

TEST(Post, foreign_lines_with_lasting_effects_are_refused) {
  for (const char* line : {"G91",   "G20",    "G18",           "G41 D1", "G55",     "G93",       "G99",
                           "G0 X1", "X1",     "G81 X1 Z-1 R1", "F100",   "S100",    "T2",        "M5",
                           "M30",   "G92 X0", "G53 G0 Z0",     "#1=2",   "/M64 P1", "o<a> call", "%"}) {
    Toolpath path = at_origin();
    path.add(step::Verbatim{line}, OriginId::none);
    const auto result = posted(path, bare("linuxcnc"));
    EXPECT_TRUE(result.reports(codes::post_cannot)) << line;
    ASSERT_EQ(result.diagnostics.list().size(), 1u) << line;
    EXPECT_NE(result.diagnostics.list()[0].notes.at(0).text.find("changes"), std::string::npos) << line;
  }
  Toolpath path = at_origin();
  path.add(step::Verbatim{"M64 P1"}, OriginId::none);
  EXPECT_EQ(posted(path, bare("linuxcnc")).text(), "G0 X0 Y0 Z5\nM64 P1\n");
  Toolpath print = at_origin();
  print.add(step::Verbatim{"M204 S500"}, OriginId::none);  // a printer's S is a parameter
  EXPECT_EQ(posted(print, bare("marlin")).text(), "G0 X0 Y0 Z5\nM204 S500\n");
}

TEST(Post, a_code_that_was_left_out_is_refused) {
  Toolpath path = at_origin();
  path.add(step::Unresolved{"G65", UnresolvedKind::code}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_code_left_out));
  PostOptions allowed;
  allowed.left_out = LeftOutCodes::skipped;
  Diagnostics diagnostics;
  post(path, bare("grbl"), allowed, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST(Post, a_home_is_stored_where_the_controller_can) {
  Toolpath path = at_origin();
  path.add(step::StoreHome{Reference::home}, OriginId::none);
  path.add(step::StoreHome{Reference::second_home}, OriginId::none);
  path.add(step::End{}, OriginId::none);  // the end of the file ends the program
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG28.1\nG30.1\n");
  EXPECT_TRUE(posted(path, bare("marlin")).reports(codes::post_left_out));
}

TEST(Post, printers_run_to_their_end_switches) {
  Toolpath path = at_origin();
  path.set_unknown_axes(path.add(step::Rapid{{0, 0, 5}}, OriginId::none), 3);
  path.set_reference(path.size() - 1, Reference::end_switches, 3);
  path.set_unknown_axes(path.add(step::Rapid{{0, 0, 0}}, OriginId::none), 7);
  path.set_reference(path.size() - 1, Reference::end_switches, 7);
  path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  EXPECT_EQ(posted(path, bare("marlin")).text(), "G0 X0 Y0 Z5\nG28 X0 Y0\nG28\nG0 X0 Y0 Z0\n");
  EXPECT_TRUE(posted(path, bare("linuxcnc")).reports(codes::post_left_out));  // G28 leads elsewhere there
}

TEST(Post, an_arc_needs_a_known_start_point) {
  Toolpath path = at_origin();
  const step::Arc arc{.to = {10, 0, 5}, .centre = {5, 0}, .feed = kFeed};
  path.add(arc, OriginId::none);
  EXPECT_FALSE(posted(path, bare("grbl")).diagnostics.has_errors());
  const std::size_t home = path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.set_unknown_axes(home, 7);
  path.set_reference(home, Reference::home, 7);
  path.add(arc, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_place_unknown));
}

/// An end point that is computed at the machine: the arc has no words for it.
TEST(Post, an_arc_needs_a_known_end_point) {
  for (const unsigned axis : {1u, 2u, 4u}) {
    Toolpath path = at_origin();
    const step::Arc arc{.to = {0, 0, 5}, .centre = {5, 0}, .feed = kFeed};
    path.set_unknown_axes(path.add(arc, OriginId::none), axis);
    const Posted out = posted(path, bare("grbl"));
    EXPECT_EQ(out.reports(codes::post_place_unknown), axis != 4u) << axis;
    EXPECT_EQ(out.text().find("G3") == std::string::npos, axis != 4u) << out.text();
  }
}

TEST(Post, after_a_probe_every_axis_is_written) {
  Toolpath path = at_origin();
  path.add(step::Probe{{0, 0, -5}, kFeed, ProbeKind::contact}, OriginId::none);
  path.add(step::Rapid{{0, 0, -5}}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "G0 X0 Y0 Z5\nG38.3 Z-5 F600\nG0 X0 Y0 Z-5\n");
  path.add(step::Note{"after which all axes are written again"}, OriginId::none);
  path.add(step::Probe{{0, 0, -5}, kFeed, ProbeKind::contact}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_cannot));  // length 0
}

TEST(Post, comments_have_no_active_characters) {
  Toolpath path;
  path.add(step::Note{"slot (2x)! ready? caf\xC3\xA9"}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "(slot [2x]. ready. caf_)\n");
  EXPECT_EQ(posted(path, bare("marlin")).text(), "; slot (2x)! ready? caf_\n");
}

TEST(Post, pauses_in_the_controllers_own_way) {
  Toolpath path;
  path.add(step::Pause{}, OriginId::none);
  EXPECT_EQ(posted(path, bare("grbl")).text(), "M0\n");
  EXPECT_EQ(posted(path, bare("klipper")).text(), "PAUSE\n");
  Toolpath optional;
  optional.add(step::Pause{PauseKind::optional}, OriginId::none);
  EXPECT_EQ(posted(optional, bare("linuxcnc")).text(), "M1\n");
  EXPECT_TRUE(posted(optional, bare("klipper")).reports(codes::post_left_out));
  PostProfile endless = bare("klipper");
  endless.pause_lines = {"; wait"};
  EXPECT_TRUE(posted(path, endless).reports(codes::post_cannot));
}

TEST(Post, reports_what_a_controller_lacks) {
  Toolpath path;
  path.add(step::Coolant{true, false}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_left_out));
  path.add(step::Cut{{1, 0, 0}, {}}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_no_feed));
  PostOptions options;
  options.missing_feed = kFeed;
  EXPECT_FALSE(posted(path, bare("grbl"), options).reports(codes::post_no_feed));
  path.add(step::Rapid{{1e300, 0, 0}}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_number_large));
  path.add(step::Verbatim{"M101 P1"}, OriginId::none);
  EXPECT_TRUE(posted(path, bare("grbl")).reports(codes::post_cannot));
  Toolpath lost;
  lost.set_unknown_axes(lost.add(step::Rapid{{1, 0, 0}}, OriginId::none), 7);
  EXPECT_EQ(posted(lost, bare("grbl")).text(), "G91 G0 X1\nG90\n") << "from an unknown start, by 1 mm";
  lost.add(step::Arc{.to = {1, 0, 0}, .centre = {2, 0}, .feed = kFeed}, OriginId::none);
  EXPECT_TRUE(posted(lost, bare("grbl")).reports(codes::post_place_unknown));
  PostProfile narrow = bare("grbl");
  narrow.longest_line = 20;
  Toolpath far;
  far.add(step::Rapid{{12345.678, 12345.678, 12345.678}}, OriginId::none);
  EXPECT_TRUE(posted(far, narrow).reports(codes::post_line_long));
  narrow = bare("grbl");
  narrow.header = {"({nmae})"};
  EXPECT_TRUE(posted(far, narrow).reports(codes::post_placeholder));
}

TEST(Post, one_arc_does_not_fill_the_memory) {
  Toolpath path = at_origin();
  path.add(step::Arc{.to = {0, 0, 5}, .centre = {1e6, 0}, .extra_turns = 9999, .feed = kFeed},
           OriginId::none);
  EXPECT_LT(posted(path, bare("grbl")).text().size(), std::size_t{200} << 20);
}

TEST(Post, a_feed_is_never_rounded_to_zero) {
  PostProfile profile = bare("grbl");
  profile.decimals.feed = 1;
  Toolpath path = at_origin();
  path.add(step::Cut{{1, 0, 5}, mm_per_min(0.04)}, OriginId::none);
  path.add(step::Cut{{2, 0, 5}, mm_per_min(0.16)}, OriginId::none);
  EXPECT_EQ(posted(path, profile).text(), "G0 X0 Y0 Z5\nG1 X1 F0.1\nX2 F0.2\n");
}

TEST(Post, arcs_above_the_largest_radius_become_chords) {
  PostProfile profile = bare("grbl");
  profile.largest_radius = mm(100);
  for (const double radius : {99.9, 100.1}) {
    Toolpath path = at_origin();
    path.add(step::Arc{.to = {radius, radius, 5}, .centre = {radius, 0}, .turn = Turn::cw, .feed = kFeed},
             OriginId::none);
    const Posted out = posted(path, profile);
    EXPECT_EQ(out.text().find("G2 ") != std::string::npos, radius < 100) << out.text();
    EXPECT_EQ(out.files.front().lines > 10, radius > 100);
  }
}

TEST(Post, coolant_changes) {
  const auto text = [](std::vector<step::Coolant> states) {
    Toolpath path = at_origin();
    for (const step::Coolant& state : states) path.add(state, OriginId::none);
    const std::string all = posted(path, bare("linuxcnc")).text();
    return all.substr(all.find('\n') + 1);
  };
  const step::Coolant off{}, mist{true, false}, flood{false, true}, both{true, true};
  const std::string end = "M9\n";  // of the program
  EXPECT_EQ(text({both, flood}), "M7\nM8\nM9\nM8\n" + end) << "M9 switches both off";
  EXPECT_EQ(text({both, mist}), "M7\nM8\nM9\nM7\n" + end);
  EXPECT_EQ(text({mist, both}), "M7\nM8\n" + end);
  EXPECT_EQ(text({flood, flood}), "M8\n" + end);
  EXPECT_EQ(text({mist, off}), "M7\nM9\n");
}

/// LinuxCNC: M8 switches flood on, M9 all coolant off. Before the first motion the state of the controller is
/// unknown: the M9 of the program is written, and no other one.
TEST(Post, coolant_before_the_first_motion) {
  for (const auto& [state, line] :
       {std::pair(step::Coolant{false, true}, "M8\n"), std::pair(step::Coolant{true, false}, "M7\n"),
        std::pair(step::Coolant{}, "M9\n")}) {
    Toolpath path;
    path.add(state, OriginId::none);
    path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
    const bool on = state.mist || state.flood;
    EXPECT_EQ(posted(path, bare("linuxcnc")).text(),
              std::string(line) + "G0 X0 Y0 Z5\n" + (on ? "M9\n" : ""));
  }
}

TEST(Post, each_file_of_a_tool_starts_spindle_and_coolant) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, OriginId::none);
  path.add(step::Coolant{false, true}, OriginId::none);
  path.add(step::Rapid{{3, 4, 5}}, OriginId::none);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Cut{{3, 4, -1}, kFeed}, OriginId::none);
  PostOptions options;
  options.tool_change = ToolChangePolicy::files;
  const Posted out = posted(path, bare("linuxcnc"), options);
  ASSERT_EQ(out.files.size(), 2u);
  for (const PostedFile& file : out.files) {
    const std::size_t spindle = file.text.find("M3 S9000\n"), coolant = file.text.find("M8\n");
    ASSERT_NE(spindle, std::string::npos) << file.text;
    ASSERT_NE(coolant, std::string::npos) << file.text;
    EXPECT_LT(spindle, file.text.find("X3")) << file.text;
    EXPECT_LT(coolant, file.text.find("X3")) << file.text;
  }
}

TEST(Post, a_fan_turns_at_full_speed_at_most) {
  for (const auto& [fraction, line] : {std::pair(1.5, "M106 S255\n"), std::pair(1.0, "M106 S255\n"),
                                       std::pair(0.2, "M106 S51\n"), std::pair(0.0, "M107\n")}) {
    Toolpath path;
    path.add(step::Fan{0, fraction}, OriginId::none);
    EXPECT_EQ(posted(path, bare("marlin")).text(), line) << fraction;
  }
}

TEST(Post, long_comments_of_templates_are_cut_and_closed) {
  PostProfile profile = bare("grbl");
  profile.longest_line = 30;
  profile.header = {"(a comment of the header that is longer than a line)"};
  const std::string text = posted(at_origin(), profile).text();
  const std::string first = text.substr(0, text.find('\n'));
  EXPECT_EQ(first, "(a comment of the header that)");
  EXPECT_EQ(first.size(), 30u);
}

}  // namespace
}  // namespace kerf

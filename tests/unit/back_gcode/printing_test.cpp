// Programs for printers: comments on beads, limits of motions, variables, thumbnails, absolute E.
#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>
#include <string>

#include "base/codes/gcode.h"

#include "kerf/program/post.h"

namespace kerf {
namespace {

const double kFilament = std::numbers::pi * 0.875 * 0.875;  // mm2, of 1.75 mm
const Feed kFeed = mm_per_min(1200);

PostProfile bare(std::string_view name) {
  PostProfile profile = *find_post(name);
  profile.header.clear();
  profile.section.clear();
  profile.footer.clear();
  return profile;
}

struct Posted {
  std::string text;
  Diagnostics diagnostics;
};

Posted posted(const Toolpath& path, const PostProfile& profile, const PostOptions& options = {}) {
  Posted out;
  const auto files = post(path, profile, options, out.diagnostics);
  if (files.size() == 1) out.text = files[0].text;
  return out;
}

void lay(Toolpath& path, Point3 to, double filament, BeadKind kind, double width = 0.45) {
  path.add(step::Extrude{to, mm3(filament * kFilament), mm(width), mm(0.2), kFeed, kind}, OriginId::none);
}

TEST(PrintPost, beads_get_the_comments_of_slicers_where_they_change) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
  lay(path, {10, 0, 0.2}, 1, BeadKind::outer_wall);
  lay(path, {10, 10, 0.2}, 1, BeadKind::outer_wall);
  lay(path, {0, 10, 0.2}, 0.5, BeadKind::bridge, 0.4);
  path.add(step::Rapid{{0, 0, 0.4}}, OriginId::none);
  lay(path, {10, 0, 0.4}, 1, BeadKind::bridge, 0.4);
  EXPECT_EQ(posted(path, bare("marlin")).text,
            "G0 X0 Y0 Z0.2\n"
            ";LAYER_CHANGE\n;Z:0.2\n;TYPE:External perimeter\n;WIDTH:0.45\n;HEIGHT:0.2\n"
            "G1 X10 E1 F1200\nG1 Y10 E1\n"
            ";TYPE:Bridge infill\n;WIDTH:0.4\nG1 X0 E0.5\nG0 Y0 Z0.4\n"
            ";LAYER_CHANGE\n;Z:0.4\nG1 X10 E1\n");
}

TEST(PrintPost, a_vase_starts_a_layer_where_it_has_climbed_by_a_bead) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
  for (int i = 1; i <= 16; ++i)
    lay(path, {i % 2 == 0 ? 0.0 : 10.0, i % 4 < 2 ? 0.0 : 10.0, 0.2 + 0.05 * i}, 1, BeadKind::outer_wall);
  const std::string text = posted(path, bare("klipper")).text;
  std::size_t layers = 0;
  for (std::size_t at = text.find(";LAYER_CHANGE"); at != std::string::npos;
       at = text.find(";LAYER_CHANGE", at + 1))
    ++layers;
  EXPECT_EQ(layers, 4u);  // at Z0.2, 0.4, 0.6 and 0.8; the last bead starts at Z0.95
}

TEST(PrintPost, plain_printers_get_absolute_filament_lengths) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
  for (int i = 1; i <= 3; ++i) lay(path, {10.0 * i, 0, 0.2}, 1, BeadKind::none);
  PostProfile plain = bare("plain");
  plain.bead_comments = BeadComments::none;
  EXPECT_EQ(posted(path, plain).text, "G0 X0 Y0 Z0.2\nG1 X10 E1 F1200\nG1 X20 E2\nG1 X30 E3\n");
  const std::string whole = posted(path, *find_post("plain")).text;
  EXPECT_NE(whole.find("\nM82\nG92 E0\n"), std::string::npos) << whole;
  EXPECT_NE(posted(path, *find_post("marlin")).text.find("\nM83\nG92 E0\n"), std::string::npos);
}

Toolpath with_limits() {
  Toolpath path;
  path.add(step::MotionLimits{LimitKind::axis_acceleration, {500, 600, 70, 800}, 15}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::axis_speed, {200, 180, 12, 0}, 7}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::acceleration, {1000, 0, 1500, 0}, 5}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::jerk, {8, 9, 0, 2.5}, 11}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::junction_deviation, {0.013, 0, 0, 0}, 1}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::corner_speed, {5, 0, 0, 0}, 1}, OriginId::none);
  return path;
}

TEST(PrintPost, limits_are_those_of_the_firmware) {
  const Toolpath path = with_limits();
  const Posted marlin = posted(path, bare("marlin")), reprap = posted(path, bare("reprapfirmware")),
               klipper = posted(path, bare("klipper")), plain = posted(path, bare("plain"));
  EXPECT_EQ(marlin.text,
            "M201 X500 Y600 Z70 E800\nM203 X200 Y180 Z12\nM204 P1000 T1500\nM205 X8 Y9 E2.5\nM205 J0.013\n");
  EXPECT_EQ(reprap.text,
            "M201 X500 Y600 Z70 E800\nM203 X12000 Y10800 Z720\nM204 P1000 T1500\nM566 X480 Y540 E150\n");
  EXPECT_EQ(klipper.text,
            "SET_VELOCITY_LIMIT VELOCITY=180\nSET_VELOCITY_LIMIT ACCEL=1000\n"
            "SET_VELOCITY_LIMIT SQUARE_CORNER_VELOCITY=5\n");
  EXPECT_EQ(plain.text, "");
  EXPECT_EQ(marlin.diagnostics.list().size(), 1u);   // corner speed
  EXPECT_EQ(reprap.diagnostics.list().size(), 2u);   // and junction deviation
  EXPECT_EQ(klipper.diagnostics.list().size(), 3u);  // accelerations of axes, jerk, junction deviation
  EXPECT_EQ(plain.diagnostics.list().size(), 6u);
  for (const Posted* one : {&marlin, &reprap, &klipper, &plain})
    for (const Diagnostic& d : one->diagnostics.list()) EXPECT_EQ(d.code, codes::post_left_out);
}

TEST(PrintPost, extruders_are_selected_in_the_words_of_the_firmware) {
  Toolpath path;
  path.add(step::Temperature{Heater::nozzle, 205, false, 1}, OriginId::none);
  path.add(step::Extruder{0}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
  lay(path, {10, 0, 0.2}, 1, BeadKind::none, 0);
  path.add(step::Extruder{1}, OriginId::none);
  lay(path, {20, 0, 0.2}, 1, BeadKind::none, 0);
  const auto text = [&](std::string_view name) {
    PostProfile profile = bare(name);
    profile.bead_comments = BeadComments::none;
    const Posted out = posted(path, profile);
    EXPECT_TRUE(out.diagnostics.list().empty()) << name;
    return out.text;
  };
  EXPECT_EQ(text("marlin"),
            "M104 T1 S205\nT0\nG0 X0 Y0 Z0.2\nG1 X10 E1 F1200\nT1\nG1 X20 Y0 Z0.2 E1 F1200\n");
  EXPECT_EQ(text("reprapfirmware"), text("marlin"));
  EXPECT_EQ(text("klipper"),
            "M104 T1 S205\nACTIVATE_EXTRUDER EXTRUDER=extruder\nG0 X0 Y0 Z0.2\nG1 X10 E1 F1200\n"
            "ACTIVATE_EXTRUDER EXTRUDER=extruder1\nG1 X20 Y0 Z0.2 E1 F1200\n");
  EXPECT_EQ(
      text("plain"),
      "M104 T1 S205\nT0\nG92 E0\nG0 X0 Y0 Z0.2\nG1 X10 E1 F1200\nT1\nG92 E0\nG1 X20 Y0 Z0.2 E1 F1200\n");
}

TEST(PrintPost, a_mill_has_no_extruders) {
  Toolpath path;
  path.add(step::Extruder{1}, OriginId::none);
  const Posted out = posted(path, bare("grbl"));
  ASSERT_EQ(out.diagnostics.list().size(), 1u);
  EXPECT_EQ(out.diagnostics.list()[0].severity, Severity::error);
}

TEST(PrintPost, fans_of_reprapfirmware_are_fractions) {
  Toolpath path;
  path.add(step::Fan{1, 0.25}, OriginId::none);
  path.add(step::Fan{0, 0.0}, OriginId::none);
  EXPECT_EQ(posted(path, bare("reprapfirmware")).text, "M106 P1 S0.25\nM107\n");
  EXPECT_EQ(posted(path, bare("marlin")).text, "M106 P1 S64\nM107\n");
}

TEST(PrintPost, templates_have_the_figures_of_the_print_and_variables) {
  Diagnostics diagnostics;
  const auto profile = read_post_profile(
      "base = \"marlin\"\nname = \"mine\"\n[variables]\nbed_sheet = \"smooth\"\nlift = 5\nfast = true\n"
      "[templates]\nheader = [\"; {bed_sheet} {lift} {fast} {nozzle} {bed} {chamber}\", \"; {layers} of "
      "{layer_height}, {filament_mm} mm, {filament_cm3} cm3\"]\nfooter = []\n",
      "mine.toml", diagnostics);
  ASSERT_TRUE(profile);
  Toolpath path;
  path.add(step::Temperature{Heater::nozzle, 0, false}, OriginId::none);
  path.add(step::Temperature{Heater::nozzle, 215, true}, OriginId::none);
  path.add(step::Temperature{Heater::bed, 60.5, true}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0.3}}, OriginId::none);
  lay(path, {10, 0, 0.3}, 2, BeadKind::wall);
  path.add(step::Rapid{{0, 0, 0.5}}, OriginId::none);
  lay(path, {10, 0, 0.5}, 2, BeadKind::wall);
  PostOptions options;
  options.variables["lift"] = "7\nM112";  // stays within its comment
  const std::string text = posted(path, *profile, options).text;
  EXPECT_EQ(text.substr(0, text.find("G0")),
            "; smooth 7_M112 true 215 60.5 0\n; 2 of 0.3, 4 mm, 0.01 cm3\nM104 S0\nM109 S215\nM190 S60.5\n");
}

/// Commands of slicers, by the lists of the firmwares themselves: Marlin's "G-code index", Klipper's page
/// "G-Codes", Duet's "GCode dictionary".
TEST(PrintPost, commands_that_the_firmware_knows_are_kept_and_harmless_ones_left_out) {
  const auto written = [](std::string_view post, std::string text) {
    Toolpath path;
    path.add(step::Verbatim{text}, OriginId::none);
    path.add(step::Verbatim{text}, OriginId::none);
    Posted out = posted(path, bare(post));
    const auto& list = out.diagnostics.list();
    if (list.empty()) return out.text == text + '\n' + text + '\n' ? std::string("kept") : out.text;
    if (out.diagnostics.has_errors()) return std::string("refused");
    EXPECT_EQ(list.size(), 1u) << text;  // reported once
    EXPECT_EQ(list[0].code, codes::post_left_out);
    return out.text.empty() ? std::string("left out") : out.text;
  };
  struct Case {
    const char *text, *marlin, *klipper, *reprap, *plain;
  };
  const char *kept = "kept", *none = "left out", *refused = "refused", *m0 = "M0\nM0\n";
  const char *pause = "PAUSE\nPAUSE\n", *m226 = "M226\nM226\n";
  for (const Case& c : {Case{"M115 U3.9", kept, kept, kept, none},
                        {"M900 K0.05", kept, none, none, none},
                        {"M862.3 P \"MK3S\"", kept, none, none, none},
                        {"M155 S1", kept, none, none, none},
                        {"M420 S1", kept, none, none, none},
                        {"M300 S440 P100", kept, none, kept, none},
                        {"M73 P10 R5", kept, kept, kept, none},
                        {"M75", kept, none, none, none},
                        {"M572 D0 S0.05", none, none, kept, none},
                        {"M486 S0", kept, kept, kept, none},
                        {"M205 X8 B20000", kept, none, kept, none},
                        {"M600", kept, pause, kept, m0},
                        {"M601", m0, pause, kept, m0},
                        {"PAUSE", m0, kept, m226, m0},
                        {"SET_PRESSURE_ADVANCE ADVANCE=0.05", none, kept, none, none},
                        {"EXCLUDE_OBJECT_START NAME=a", none, kept, none, none},
                        {"PRINT_START BED=60", refused, kept, refused, refused},
                        {"echo \"half done\"", none, kept, kept, none},
                        {"M206 Z-0.1", refused, refused, refused, refused},
                        {"M280 P0 S10", refused, refused, refused, refused},
                        {"M84", kept, kept, kept, kept},
                        {"M701", refused, refused, refused, refused}}) {
    EXPECT_EQ(written("marlin", c.text), c.marlin) << c.text;
    EXPECT_EQ(written("klipper", c.text), c.klipper) << c.text;
    EXPECT_EQ(written("reprapfirmware", c.text), c.reprap) << c.text;
    EXPECT_EQ(written("plain", c.text), c.plain) << c.text;
  }
  EXPECT_EQ(written("marlin", "M117 " + std::string(100, 'x')), "left out");  // too long for a line
  EXPECT_EQ(written("grbl", "M900 K0.05"), "refused");                        // may be a macro of a mill
}

/// Marlin has the lengths of G11 in M208, RepRapFirmware (Duet's "GCode dictionary") as R and T of M207,
/// Klipper in SET_RETRACTION with speeds in mm/s.
TEST(PrintPost, lengths_of_retraction_are_in_the_words_of_the_firmware) {
  Toolpath path;
  path.add(step::Verbatim{"M207 S1.5 F2400 Z0.2"}, OriginId::none);
  path.add(step::Verbatim{"M208 S0.1 F1200"}, OriginId::none);
  EXPECT_EQ(posted(path, bare("marlin")).text, "M207 S1.5 F2400 Z0.2\nM208 S0.1 F1200\n");
  EXPECT_EQ(posted(path, bare("reprapfirmware")).text, "M207 S1.5 F2400 Z0.2\nM207 R0.1 T1200\n");
  EXPECT_EQ(posted(path, bare("klipper")).text,
            "SET_RETRACTION RETRACT_LENGTH=1.5 RETRACT_SPEED=40\n"
            "SET_RETRACTION UNRETRACT_EXTRA_LENGTH=0.1 UNRETRACT_SPEED=20\n");
}

/// A firmware with only one of G10 and G11 cannot retract by itself: what one draws back the other must
/// return.
TEST(PrintPost, retraction_by_the_firmware_needs_both_codes) {
  Toolpath path;
  path.add(step::Verbatim{"G10"}, OriginId::none);
  path.add(step::Verbatim{"G11"}, OriginId::none);
  PostProfile profile = bare("marlin");
  profile.extruder.retract = mm(2);
  profile.extruder.retract_speed = mm_per_min(1800);
  EXPECT_EQ(posted(path, profile).text, "G10\nG11\n");
  for (const int lacks : {100, 110}) {
    PostProfile less = profile;
    less.g_codes.erase(std::remove(less.g_codes.begin(), less.g_codes.end(), lacks), less.g_codes.end());
    EXPECT_EQ(posted(path, less).text, "G1 E-2 F1800\nG1 E2\n") << lacks;
  }
}

/// The printer has filament of 2.85 mm, whatever the program was made for: E is the volume by its area.
TEST(PrintPost, the_filament_is_that_of_the_post) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
  const double area = std::numbers::pi * 1.425 * 1.425;
  path.add(step::Extrude{{10, 0, 0.2}, mm3(2 * area), mm(0.45), mm(0.2), kFeed, BeadKind::none},
           OriginId::none);
  PostProfile profile = bare("marlin");
  profile.bead_comments = BeadComments::none;
  PostOptions options;
  options.filament = mm(2.85);
  EXPECT_NE(posted(path, profile, options).text.find("X10 E2 "), std::string::npos) << "that of the program";
  profile.filament = mm(2.85);
  options.filament = mm(1.75);
  EXPECT_NE(posted(path, profile, options).text.find("X10 E2 "), std::string::npos) << "that of the post";
}

TEST(PrintPost, variables_must_be_values) {
  Diagnostics diagnostics;
  EXPECT_FALSE(
      read_post_profile("base = \"marlin\"\n[variables]\nlift = [1, 2]\n", "mine.toml", diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::post_value_bad);
}

TEST(PrintPost, thumbnails_are_base64_in_lines_of_comments) {
  PostOptions options;
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += static_cast<char>(i);
  options.thumbnails = {{16, 12, bytes}, {2, 2, "kerf!"}};
  PostProfile marlin = bare("marlin");
  marlin.header = {"; first", "G90", "; later"};
  const std::string text = posted({}, marlin, options).text;
  // python3 -c "import base64; print(base64.b64encode(bytes(range(100))).decode())"
  EXPECT_EQ(text,
            "; first\n;\n; thumbnail begin 16x12 136\n"
            "; AAECAwQFBgcICQoLDA0ODxAREhMUFRYXGBkaGxwdHh8gISIjJCUmJygpKissLS4vMDEyMzQ1Njc4OT\n"
            "; o7PD0+P0BBQkNERUZHSElKS0xNTk9QUVJTVFVWV1hZWltcXV5fYGFiYw==\n; thumbnail end\n;\n"
            ";\n; thumbnail begin 2x2 8\n; a2VyZiE=\n; thumbnail end\n;\nG90\n; later\n");
  EXPECT_EQ(posted({}, bare("grbl"), options).text, "");
}

}  // namespace
}  // namespace kerf

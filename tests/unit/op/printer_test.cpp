// The printer: volumes and speeds computed by hand, travel, seams, settings out of range.
#include "kerf/op/printer.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "base/codes/op.h"

namespace kerf {
namespace {

// 0.45 x 0.2 mm: (0.45 - 0.2) * 0.2 + pi * 0.1^2
constexpr double kArea = 0.0814159265;  // mm2
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Outline line(std::vector<Point2> points) {
  Outline path{points.front(), {}};
  for (std::size_t i = 1; i < points.size(); ++i) path.segments.push_back({points[i], {}});
  return path;
}
Outline rectangle_path(double x0, double y0, double x1, double y1) {
  return line({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}});
}
Region rectangle(double x0, double y0, double x1, double y1) {
  return Region{{rectangle_path(x0, y0, x1, y1)}};
}

struct Print {
  explicit Print(const PrinterSettings& settings = {}) : printer(settings, diagnostics) {}
  /// The volume of the beads that are laid.
  double volume() {
    double sum = 0.0;
    const Toolpath& path = printer.path();
    for (std::size_t i = 0; i < path.size(); ++i)
      if (path[i].kind() == StepKind::extrude && path.extrude(i).width > Length())
        sum += path.extrude(i).volume.mm3();
    return sum;
  }
  /// "cut 1,2,0.2 9000; extrude ..." with volumes.
  std::string text() {
    std::string out;
    const Toolpath& path = printer.path();
    char buffer[200];
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Step& s = path[i];
      if (!s.is_motion()) continue;
      std::snprintf(buffer, sizeof buffer, "%s %g,%g,%g F%g", std::string(name_of(s.kind())).c_str(),
                    s.to().x, s.to().y, s.to().z, std::round(s.feed().mm_per_min()));
      out += buffer;
      if (s.kind() == StepKind::extrude) {
        std::snprintf(buffer, sizeof buffer, " V%.4f", path.extrude(i).volume.mm3());
        out += buffer;
      }
      out += "\n";
    }
    return out;
  }
  Diagnostics diagnostics;
  Printer printer;
};

TEST(Printer, a_bead_has_the_volume_of_its_section) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}, {10, 5}})));
  EXPECT_NEAR(print.volume(), 15 * kArea, 1e-6);
  EXPECT_NEAR(print.printer.printed().mm3(), 15 * kArea, 1e-6);
  EXPECT_EQ(print.text(),
            "cut 0,0,0.2 F9000\nextrude 10,0,0.2 F3000 V0.8142\nextrude 10,5,0.2 F3000 V0.4071\n");
}

TEST(Printer, speeds_are_limited_by_the_flow) {
  Print print({.first_layer_speed = mm_per_min(1000), .max_flow = mm3_per_s(4)});
  const auto feed = [&] {
    EXPECT_TRUE(print.printer.next_layer());
    EXPECT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}})));
    return print.printer.path()[print.printer.path().size() - 1].feed().mm_per_min();
  };
  EXPECT_NEAR(feed(), 1000, 1e-9);
  EXPECT_NEAR(feed(), 60 * 4 / kArea, 1e-3);  // 2948 instead of 3000
  EXPECT_TRUE(print.printer.bead(line({{0, 5}, {10, 5}}), {.width = mm(0.9)}));
  // 0.9 x 0.2 mm: 0.14 + 0.0314159
  EXPECT_NEAR(print.printer.path()[print.printer.path().size() - 1].feed().mm_per_min(), 240 / 0.1714159265,
              1e-3);
}

TEST(Printer, travels_draw_back_wipe_and_hop) {
  Print print({.hop = mm(0.4), .wipe = mm(1)});
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}})));
  ASSERT_TRUE(print.printer.bead(line({{10, 1}, {0, 1}})));  // near: no rules
  ASSERT_TRUE(print.printer.bead(line({{20, 1}, {30, 1}})));
  // 0.8 mm of filament of 1.75 mm: 1.9242 mm3
  EXPECT_EQ(print.text(),
            "cut 0,0,0.2 F9000\nextrude 10,0,0.2 F3000 V0.8142\n"
            "cut 10,1,0.2 F9000\nextrude 0,1,0.2 F3000 V0.8142\n"
            "extrude 1,1,0.2 F3000 V-1.9242\ncut 1,1,0.6 F9000\ncut 20,1,0.6 F9000\ncut 20,1,0.2 F9000\n"
            "extrude 20,1,0.2 F2400 V1.9242\nextrude 30,1,0.2 F3000 V0.8142\n");
}

TEST(Printer, layers_rise_before_the_nozzle_moves_sideways) {
  Print print({.retract = mm(0)});
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}})));
  ASSERT_TRUE(print.printer.next_layer(mm(0.3)));
  ASSERT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}})));
  EXPECT_EQ(print.text(),
            "cut 0,0,0.2 F9000\nextrude 10,0,0.2 F3000 V0.8142\ncut 10,0,0.5 F9000\ncut 0,0,0.5 F9000\n"
            "extrude 10,0,0.5 F3000 V1.1569\n");  // (0.15 * 0.3 + pi * 0.15^2) * 10
}

TEST(Printer, walls_are_inside_the_boundary) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  const auto inside = print.printer.walls(rectangle(0, 0, 20, 10), 2);
  ASSERT_TRUE(inside);
  // Centres 0.225 and 0.225 + 0.434 inside: 2 * (19.55 + 9.55) and 2 * (18.682 + 8.682) mm long.
  EXPECT_NEAR(print.volume(), (58.2 + 54.728) * kArea, 1e-5);
  // The fill starts 2 * 0.434 + 0.008 mm inside.
  EXPECT_NEAR(area(*inside), (20 - 1.752) * (10 - 1.752), 1e-6);
  const Toolpath& path = print.printer.path();
  std::vector<BeadKind> kinds;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::extrude && path.extrude(i).width > Length() &&
        (kinds.empty() || kinds.back() != path.extrude(i).kind))
      kinds.push_back(path.extrude(i).kind);
  EXPECT_EQ(kinds, (std::vector{BeadKind::outer_wall, BeadKind::wall}));
}

TEST(Printer, a_wall_too_wide_for_a_part_is_a_warning) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  const Region both{{rectangle_path(0, 0, 10, 10), rectangle_path(20, 0, 20.4, 10)}};
  ASSERT_TRUE(print.printer.walls(both, 1));
  ASSERT_EQ(print.diagnostics.list().size(), 1u);
  EXPECT_EQ(print.diagnostics.list()[0].code, codes::op_tool_wide);
  EXPECT_FALSE(print.diagnostics.has_errors());
}

TEST(Printer, rows_divide_a_solid_region_evenly) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.fill(rectangle(0, 0, 10, 5.4)));
  // 5.4 / 0.434 = 12.4: 13 rows 0.415385 mm apart, 0.431385 mm wide: 0.046277 + 0.0314159 mm2
  EXPECT_NEAR(print.volume(), 13 * 10 * 0.0776929, 1e-4);
  Print sparse;
  ASSERT_TRUE(sparse.printer.next_layer());
  ASSERT_TRUE(sparse.printer.fill(rectangle(0, 0, 10, 5.4), {.density = 0.2}));
  EXPECT_NEAR(sparse.volume(), 3 * 10 * kArea, 1e-4);  // 5.4 / 2.17 = 2.5
}

TEST(Printer, rings_divide_a_solid_region_evenly) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  const auto left = print.printer.fill(rectangle(0, 0, 10, 4), {.pattern = FillPattern::concentric});
  ASSERT_TRUE(left);
  EXPECT_TRUE(left->empty());
  // The inner circle has a radius of 2 mm: 5 rings 0.4 mm apart (0.416 wide), 0.2, 0.6 ... 1.8 mm inside.
  double way = 0.0;
  for (const double in : {0.2, 0.6, 1.0, 1.4, 1.8}) way += 2 * (10 - 2 * in + 4 - 2 * in);
  EXPECT_NEAR(print.volume(), way * (0.216 * 0.2 + 0.0314159265), 2e-3);
}

TEST(Printer, rings_report_what_they_leave) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  // A square of 10 mm (12 rings 0.4167 mm apart) with a bar of 1.23 mm, in which the first ring leaves 0.4 mm
  // and the second one has no room.
  const Region part{
      {line({{0, 0}, {10, 0}, {10, 4.5}, {30, 4.5}, {30, 5.73}, {10, 5.73}, {10, 10}, {0, 10}, {0, 0}})}};
  const auto left = print.printer.fill(part, {.pattern = FillPattern::concentric});
  ASSERT_TRUE(left);
  EXPECT_NEAR(area(*left), 20 * 0.4, 0.5);
}

TEST(Printer, seams_are_where_they_are_wanted) {
  for (const auto& [seam, start] : {std::pair{Seam::nearest, "20,0"}, {Seam::rear, "0,10"}}) {
    Print print({.seam = seam});
    ASSERT_TRUE(print.printer.next_layer());
    ASSERT_TRUE(print.printer.travel({25, -3}));
    ASSERT_TRUE(print.printer.bead(rectangle_path(0, 0, 20, 10)));
    EXPECT_NE(print.text().find(std::string("\ncut ") + start + ",0.2 F9000\nextrude "), std::string::npos)
        << print.text();
  }
}

TEST(Printer, a_brim_is_outside_and_comes_from_the_outside) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.brim(rectangle(0, 0, 20, 10), 2));
  // Centres 0.434 - 0.225 and 0.643 mm outside; the corners are arcs.
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(print.volume(), (120 + 2 * pi * (0.209 + 0.643)) * kArea, 5e-3);
  double low_x = 0.0;
  for (std::size_t i = 0; i < print.printer.path().size(); ++i)
    low_x = std::min(low_x, print.printer.path()[i].to().x);
  EXPECT_NEAR(low_x, -0.643, 1e-6);
}

TEST(Printer, a_vase_has_the_volume_of_its_wall) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.bead(rectangle_path(0, 0, 20, 20)));
  const double base = print.volume();
  ASSERT_TRUE(print.printer.vase(rectangle_path(0, 0, 20, 20), 2.2));
  // Nine whole turns, and two in which the height t grows from 0 to 0.2: the mean of 0.45 t - t^2 + pi/4 t^2.
  const double wedge = 0.045 - 0.04 / 3 + std::acos(-1.0) / 4 * 0.04 / 3;
  EXPECT_NEAR(print.volume() - base, 80 * (9 * kArea + 2 * wedge), 0.01);
  EXPECT_EQ(print.printer.z(), 2.2);
  double z = 0.2;
  const Toolpath& path = print.printer.path();
  for (std::size_t i = 6; i < path.size(); ++i) {
    EXPECT_GE(path[i].to().z, z - 1e-12);
    z = path[i].to().z;
  }
  EXPECT_EQ(z, 2.2);
}

TEST(Printer, ironing_without_flow_moves_only) {
  Print print;
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.iron(rectangle(0, 0, 10, 1), {.spacing = mm(0.25)}));
  EXPECT_EQ(print.text().find("extrude"), std::string::npos);
  const std::size_t steps = print.printer.path().size();
  EXPECT_EQ(steps, 8u);  // four rows, each with the way to its start
  ASSERT_TRUE(print.printer.iron(rectangle(0, 0, 10, 1), {.spacing = mm(0.25), .flow = 0.1}));
  EXPECT_NEAR(print.printer.printed().mm3(), 0.1 * 10 * 1 * 0.2, 1e-9);
}

TEST(Printer, start_heats_homes_and_lifts) {
  Print print;
  print.printer.start({.nozzle = 210, .bed = 60});
  ASSERT_TRUE(print.printer.next_layer());
  ASSERT_TRUE(print.printer.bead(line({{10, 10}, {20, 10}})));
  print.printer.finish();
  const Toolpath& path = print.printer.path();
  std::string kinds;
  for (const Step& s : path.steps()) kinds += std::string(name_of(s.kind())) + " ";
  EXPECT_EQ(
      kinds,
      "temperature temperature rapid cut temperature temperature cut cut extrude extrude cut temperature "
      "temperature fan ");
  EXPECT_EQ(path[3].unknown_axes(), 3u);
  EXPECT_EQ(path[6].to(), (Point3{10, 10, 5}));
}

TEST(Printer, settings_out_of_range_are_errors) {
  const auto errors = [](const PrinterSettings& settings) {
    Print print(settings);
    print.printer.start({.nozzle = 200});
    print.printer.next_layer();
    print.printer.bead(line({{0, 0}, {10, 0}}));
    EXPECT_EQ(print.printer.path().size(), 0u);
    for (const Diagnostic& d : print.diagnostics.list()) EXPECT_EQ(d.code, codes::op_option);
    return print.diagnostics.errors();
  };
  EXPECT_EQ(errors({.width = mm(0.1)}), 1u);
  EXPECT_EQ(errors({.height = mm(0)}), 1u);
  EXPECT_EQ(errors({.height = mm(kNan)}), 2u);
  EXPECT_EQ(errors({.filament = mm(-1.75)}), 1u);
  EXPECT_EQ(errors({.speed = mm_per_min(0)}), 1u);
  EXPECT_EQ(errors({.travel_speed = mm_per_min(kNan)}), 1u);
  EXPECT_EQ(errors({.max_flow = mm3_per_s(-1)}), 1u);
  EXPECT_EQ(errors({.flow = 0}), 1u);
  EXPECT_EQ(errors({.side_overlap = 2}), 1u);
  EXPECT_EQ(errors({.retract = mm(-1)}), 1u);
  EXPECT_EQ(errors({.chord = mm(0)}), 1u);
}

TEST(Printer, calls_out_of_range_are_errors_and_add_no_step) {
  Print print;
  EXPECT_FALSE(print.printer.bead(line({{0, 0}, {10, 0}})));  // before the first layer
  EXPECT_FALSE(print.printer.next_layer(mm(0.6)));            // higher than wide
  EXPECT_FALSE(print.printer.next_layer(mm(kNan)));
  ASSERT_TRUE(print.printer.next_layer());
  EXPECT_FALSE(print.printer.travel({kNan, 0}));
  EXPECT_FALSE(print.printer.bead(line({{0, 0}, {kNan, 0}})));
  EXPECT_FALSE(print.printer.bead(Outline{}));
  EXPECT_FALSE(print.printer.bead(line({{0, 0}, {1, 0}}), {.width = mm(0.1)}));
  EXPECT_FALSE(print.printer.walls({}, 1));
  EXPECT_FALSE(print.printer.walls(rectangle(0, 0, 10, 10), -1));
  EXPECT_FALSE(print.printer.fill(rectangle(0, 0, 10, 10), {.density = 0}));
  EXPECT_FALSE(print.printer.fill(rectangle(0, 0, 10, 10), {.density = 1e-9, .speed = mm_per_min(-1)}));
  EXPECT_FALSE(print.printer.brim(rectangle(0, 0, 10, 10), 2, mm(-1)));
  EXPECT_FALSE(print.printer.vase(line({{0, 0}, {10, 0}}), 5));
  EXPECT_FALSE(print.printer.vase(rectangle_path(0, 0, 10, 10), 0.1));
  EXPECT_FALSE(print.printer.iron(rectangle(0, 0, 10, 10), {.spacing = mm(0)}));
  EXPECT_EQ(print.printer.path().size(), 0u);
  EXPECT_EQ(print.diagnostics.errors(), 15u);
  EXPECT_TRUE(print.printer.bead(line({{0, 0}, {10, 0}})));  // and it can be used on
}

TEST(Printer, steps_are_limited) {
  Print print({.max_steps = 100});
  ASSERT_TRUE(print.printer.next_layer());
  EXPECT_FALSE(print.printer.fill(rectangle(0, 0, 100, 100)));
  ASSERT_EQ(print.diagnostics.list().size(), 1u);
  EXPECT_EQ(print.diagnostics.list()[0].code, codes::op_limit);
  EXPECT_EQ(print.printer.path().size(), 0u);
  EXPECT_FALSE(print.printer.vase(rectangle_path(0, 0, 10, 10), 1000));
}

}  // namespace
}  // namespace kerf

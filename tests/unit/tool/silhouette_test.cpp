// Silhouettes: exact knots, tangencies, and every parameter that gives no solid.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "base/codes/tools.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

constexpr double kExact = 1e-12;

Tool made(const ToolShape& shape, const ToolBody& body = {}) {
  Diagnostics diagnostics;
  auto tool = make_tool(7, shape, body, {}, diagnostics);
  EXPECT_TRUE(tool) << (diagnostics.list().empty() ? "" : to_string(diagnostics.list().front()));
  return tool.value_or(Tool{});
}

Diagnostics faults(const ToolShape& shape, const ToolBody& body = {}) {
  Diagnostics diagnostics;
  EXPECT_FALSE(make_tool(7, shape, body, {}, diagnostics));
  return diagnostics;
}

Code first_code(const Diagnostics& diagnostics) {
  return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
}

/// Heading in the (r, z) plane at a segment's start and end, radians.
struct Headings {
  double start, end;
};
Headings headings(const Knot& a, const Knot& b) {
  const double chord = std::atan2(b.z - a.z, b.r - a.r);
  const double half = 2.0 * std::atan(a.bulge);
  return {chord - half, chord + half};
}

TEST(Silhouette, SquareIsACylinder) {
  const Tool tool = made(shape::Square{mm(6.0), mm(20.0)});
  EXPECT_EQ(tool.silhouette.cutting.knots, (std::vector<Knot>{{0, 0, 0}, {3, 0, 0}, {3, 20, 0}}));
  EXPECT_EQ(tool.diameter, mm(6.0));
  EXPECT_EQ(tool.flute, mm(20.0));
  EXPECT_TRUE(tool.plunges);
  EXPECT_EQ(tool.number, 7);
}

TEST(Silhouette, AnAssumedFluteIsMarked) {
  EXPECT_TRUE(made(shape::Square{mm(3.0), {}}).flute_assumed);
  EXPECT_TRUE(made(shape::Ball{mm(3.0), {}}).flute_assumed);
  EXPECT_TRUE(made(shape::BullNose{mm(3.0), {}, mm(0.5)}).flute_assumed);
  EXPECT_TRUE(made(shape::Drill{mm(3.0), {}, degrees(118)}).flute_assumed);
  EXPECT_FALSE(made(shape::Square{mm(3.0), mm(9.0)}).flute_assumed);
  EXPECT_FALSE(made(shape::Vee{mm(3.0), {}, degrees(90), {}, {}}).flute_assumed);  // ends with the cone
}

TEST(Silhouette, BallRadiusAtHeight) {
  const Profile profile = made(shape::Ball{mm(6.0), mm(20.0)}).silhouette.cutting;
  for (const double z : {0.1, 1.0, 2.0, 2.9}) {
    EXPECT_NEAR(profile.radius_at(z), std::sqrt(9.0 - (3.0 - z) * (3.0 - z)), kExact) << z;
  }
  EXPECT_EQ(profile.radius_at(0.0), 0.0);
  EXPECT_EQ(profile.radius_at(10.0), 3.0);
  EXPECT_EQ(profile.radius_at(20.1), 0.0);
  EXPECT_EQ(profile.radius_at(-0.1), 0.0);
}

TEST(Silhouette, BowlFollowsItsFormula) {
  const Profile profile = made(shape::Bowl{mm(19.05), mm(15.875), mm(6.35)}).silhouette.cutting;
  const double corner = 6.35;
  for (const double h : {0.0, 1.0, 5.0, 6.35}) {
    const double diameter = 19.05 - 2 * corner + 2 * std::sqrt(corner * corner - (corner - h) * (corner - h));
    EXPECT_NEAR(2 * profile.radius_at(h), diameter, 1e-9) << h;
  }
}

TEST(Silhouette, BullNoseOfHalfTheDiameterIsABall) {
  const Profile ball = made(shape::Ball{mm(6.0), mm(9.0)}).silhouette.cutting;
  EXPECT_EQ(made(shape::BullNose{mm(6.0), mm(9.0), mm(3.0)}).silhouette.cutting, ball);
}

TEST(Silhouette, TaperedBallIsTangentToItsCone) {
  const Tool tool = made(shape::TaperedBall{mm(3.175), mm(5.561), degrees(30.0), mm(0.254)});
  const auto& knots = tool.silhouette.cutting.knots;
  ASSERT_EQ(knots.size(), 4u);
  EXPECT_NEAR(headings(knots[0], knots[1]).start, 0.0, kExact);
  EXPECT_NEAR(headings(knots[0], knots[1]).end, headings(knots[1], knots[2]).start, kExact);
  EXPECT_NEAR(knots[2].z, 5.560940337260746, 1e-12);
  EXPECT_EQ(knots[3], (Knot{1.5875, 5.561, 0}));
}

TEST(Silhouette, TaperedBallWithoutAngleReachesItsDiameterAtTheFlute) {
  const Tool tool = made(shape::TaperedBall{mm(6.35), mm(38.1), Angle(), mm(1.5875)});
  const auto& knots = tool.silhouette.cutting.knots;
  ASSERT_EQ(knots.size(), 3u);
  EXPECT_NEAR(knots[2].r, 3.175, kExact);
  EXPECT_NEAR(knots[2].z, 38.1, kExact);
  EXPECT_NEAR(headings(knots[0], knots[1]).end, headings(knots[1], knots[2]).start, kExact);
  EXPECT_NEAR(0.5 * std::get<shape::TaperedBall>(tool.shape).included_angle.deg(), 3.649755336636023, 1e-9);
}

TEST(Silhouette, VeeIsPointedFlatOrRounded) {
  const auto pointed = made(shape::Vee{mm(12.7), Length(), degrees(60.0), Length(), Length()});
  EXPECT_NEAR(pointed.flute.mm(), 6.35 / std::tan(degrees(30.0).rad()), kExact);
  const auto flat = made(shape::Vee{mm(10.0), mm(8.0), degrees(90.0), mm(2.0), Length()});
  EXPECT_NEAR(flat.silhouette.cutting.radius_at(0.0), 1.0, kExact);
  EXPECT_NEAR(flat.silhouette.cutting.radius_at(2.0), 3.0, kExact);
  EXPECT_NEAR(flat.silhouette.cutting.radius_at(8.0), 5.0, kExact);
  const auto rounded = made(shape::Vee{mm(10.0), Length(), degrees(90.0), Length(), mm(0.5)});
  const auto& knots = rounded.silhouette.cutting.knots;
  EXPECT_NEAR(headings(knots[0], knots[1]).end, headings(knots[1], knots[2]).start, kExact);
  EXPECT_NEAR(headings(knots[1], knots[2]).start, degrees(45.0).rad(), kExact);
}

TEST(Silhouette, ConeShorterThanItsDiameterIsCutOffWithAWarning) {
  Diagnostics diagnostics;
  const auto tool =
      make_tool(1, shape::Vee{mm(12.0), mm(4.0), degrees(90.0), Length(), Length()}, {}, {}, diagnostics);
  ASSERT_TRUE(tool);
  EXPECT_NEAR(tool->diameter.mm(), 8.0, kExact);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::tool_flute_short);
}

TEST(Silhouette, CatalogueRoundingOfAConeIsCorrected) {
  Diagnostics diagnostics;
  const auto tool =
      make_tool(1, shape::Vee{mm(6.35), mm(11.849), degrees(30.0), Length(), Length()}, {}, {}, diagnostics);
  ASSERT_TRUE(tool);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(tool->diameter, mm(6.35));
  EXPECT_NEAR(tool->flute.mm(), 3.175 / std::tan(degrees(15.0).rad()), kExact);
}

TEST(Silhouette, RoundoverIsConcave) {
  const Profile profile = made(shape::Roundover{mm(0.508), mm(1.3335), mm(4.2545)}).silhouette.cutting;
  for (const double z : {0.0, 0.3, 0.9, 1.3}) {
    EXPECT_NEAR(profile.radius_at(z), 0.254 + 1.3335 - std::sqrt(1.3335 * 1.3335 - z * z), 1e-9) << z;
  }
  EXPECT_EQ(profile.radius_at(4.0), 0.254 + 1.3335);
}

TEST(Silhouette, UndercutShapes) {
  const Profile keyhole = made(shape::Keyhole{mm(9.525), mm(3.175), mm(6.35), mm(6.35)}).silhouette.cutting;
  EXPECT_EQ(keyhole.radius_at(3.175), 4.7625);  // the larger one at the step
  EXPECT_EQ(keyhole.radius_at(3.2), 3.175);
  const Tool dovetail = made(shape::Dovetail{mm(12.7), mm(12.7), degrees(14.0)});
  EXPECT_NEAR(2.0 * dovetail.silhouette.cutting.radius_at(12.7),
              12.7 - 2 * 12.7 * std::tan(degrees(14.0).rad()), kExact);
  EXPECT_FALSE(dovetail.plunges);
  const Tool thread = made(shape::ThreadMill{mm(2.4), mm(4.8), mm(0.75), mm(18.0)});
  EXPECT_EQ(thread.silhouette.cutting.radius_at(0.375), 2.4);
  EXPECT_EQ(thread.flute, mm(0.75));
  EXPECT_EQ(thread.silhouette.neck.top(), 18.0);
  EXPECT_FALSE(thread.plunges);
  const Tool slot = made(shape::TSlot{mm(20.0), mm(4.0), mm(8.0), mm(15.0)});
  EXPECT_EQ(slot.silhouette.cutting.knots,
            (std::vector<Knot>{{0, 0, 0}, {10, 0, 0}, {10, 4, 0}, {4, 4, 0}, {4, 15, 0}}));
}

TEST(Silhouette, LollipopsBallMeetsItsNeck) {
  const Tool tool = made(shape::Lollipop{mm(10.0), mm(6.0), mm(30.0)});
  EXPECT_NEAR(tool.silhouette.cutting.radius_at(5.0), 5.0, kExact);
  EXPECT_NEAR(tool.silhouette.cutting.radius_at(9.0), 3.0, 1e-9);
  EXPECT_NEAR(tool.silhouette.cutting.radius_at(8.0), 4.0, 1e-9);
  EXPECT_EQ(tool.silhouette.cutting.max_radius(), 5.0);
  ToolBody body;
  body.neck_length = mm(12.0);
  const Tool bare = made(shape::Lollipop{mm(10.0), mm(6.0), Length()}, body);
  EXPECT_NEAR(bare.flute.mm(), 9.0, kExact);
  EXPECT_NEAR(bare.silhouette.neck.top(), 21.0, kExact);
  EXPECT_EQ(bare.silhouette.neck.max_radius(), 3.0);
}

TEST(Silhouette, DrillsAndChamfers) {
  const Profile drill = made(shape::Drill{mm(6.0), Length(), degrees(90.0)}).silhouette.cutting;
  EXPECT_NEAR(drill.radius_at(1.0), 1.0, kExact);
  EXPECT_EQ(drill.top(), 18.0);
  const Profile centre =
      made(shape::CentreDrill{mm(2.0), mm(3.0), degrees(90.0), mm(6.0), mm(10.0), degrees(90.0)})
          .silhouette.cutting;
  EXPECT_NEAR(centre.radius_at(0.5), 0.5, kExact);
  EXPECT_NEAR(centre.radius_at(2.0), 1.0, kExact);
  EXPECT_NEAR(centre.radius_at(4.0), 2.0, kExact);
  EXPECT_NEAR(centre.radius_at(9.0), 3.0, kExact);
  const Tool chamfer = made(shape::Chamfer{mm(10.0), Length(), degrees(90.0), mm(2.0)});
  EXPECT_NEAR(chamfer.flute.mm(), 4.0, kExact);
  EXPECT_FALSE(chamfer.plunges);
  const Profile groove = made(shape::FlatGroove{mm(31.75), mm(12.7), mm(6.35)}).silhouette.cutting;
  EXPECT_NEAR(groove.radius_at(1.0), 4.175, kExact);
}

TEST(Silhouette, AnAssumedFluteOfADrillContainsItsPoint) {
  // A point of 10 degrees is radius / tan(5 degrees) high: 34.29 mm at 6 mm.
  const Tool slender = made(shape::Drill{mm(6.0), Length(), degrees(10.0)});
  EXPECT_NEAR(slender.flute.mm(), 3.0 / std::tan(5.0 * std::acos(-1.0) / 180.0), 1e-9);
  EXPECT_NEAR(slender.silhouette.cutting.radius_at(slender.flute.mm()), 3.0, 1e-9);
  EXPECT_TRUE(slender.flute_assumed);
}

TEST(Silhouette, CornerRoundingEndsAtTheSecondDiameter) {
  const auto radius_at = [](const shape::CornerRounding& s, double z) {
    return made(s).silhouette.cutting.radius_at(z);
  };
  const shape::CornerRounding exact{mm(2.0), mm(8.0), mm(3.0), mm(10.0), mm(6.0)};
  EXPECT_NEAR(radius_at(exact, 3.0), 4.0, kExact);
  EXPECT_EQ(made(exact).flute, mm(10.0));
  const shape::CornerRounding wider{mm(2.0), mm(12.0), mm(3.0), mm(10.0), mm(6.0)};
  EXPECT_NEAR(radius_at(wider, 2.9999), 4.0, 0.05);
  EXPECT_NEAR(radius_at(wider, 3.0), 6.0, kExact);  // a step outwards
  const shape::CornerRounding narrower{mm(2.0), mm(6.0), mm(3.0), mm(10.0), mm(6.0)};
  EXPECT_NEAR(radius_at(narrower, 1.0), 1.0 + 3.0 - std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(radius_at(narrower, 5.0), 3.0, kExact);
}

TEST(Silhouette, PartsStackUpwards) {
  ToolBody body{mm(5.0), mm(4.0), mm(8.0), mm(20.0), mm(40.0), mm(30.0), Transition::step};
  const Silhouette all = made(shape::Square{mm(6.0), mm(10.0)}, body).silhouette;
  EXPECT_EQ(all.neck.knots, (std::vector<Knot>{{2.5, 10, 0}, {2.5, 14, 0}}));
  EXPECT_EQ(all.shank.knots, (std::vector<Knot>{{2.5, 14, 0}, {4, 14, 0}, {4, 34, 0}}));
  EXPECT_EQ(all.holder.knots, (std::vector<Knot>{{4, 34, 0}, {20, 34, 0}, {20, 64, 0}}));
  EXPECT_EQ(all.top(), 64.0);
  EXPECT_EQ(all.max_radius(), 20.0);
  EXPECT_EQ(&all.part(ToolPart::shank), &all.shank);
  EXPECT_EQ(to_string(ToolPart::holder), "holder");
  body.transition = Transition::cone;
  const Silhouette cone = made(shape::Square{mm(6.0), mm(10.0)}, body).silhouette;
  EXPECT_EQ(cone.shank.knots, (std::vector<Knot>{{2.5, 14, 0}, {4, 15.5, 0}, {4, 34, 0}}));
}

TEST(Silhouette, DrawnProfilesAreChecked) {
  const double semi = 1.0;
  const Profile bulb{{{1, 0, 0}, {1, 2, semi}, {1, 6, 0}, {1, 9, 0}}};
  EXPECT_NEAR(made(shape::Drawn{bulb}).silhouette.cutting.max_radius(), 3.0, kExact);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Profile& bad :
       {Profile{}, Profile{{{1, 0, 0}}}, Profile{{{1, 0, 0}, {1, -1, 0}}}, Profile{{{-1, 0, 0}, {1, 1, 0}}},
        Profile{{{nan, 0, 0}, {1, 1, 0}}}, Profile{{{1, 0, 1.5}, {1, 1, 0}}}, Profile{{{0, 0, 0}, {0, 1, 0}}},
        Profile{{{1, 1, 0}, {1, 2, 0}}}, Profile{{{1, 0, 0.9}, {5, 0.1, 0}}},
        Profile{{{1, 0, -1.0}, {1, 6, 0}}}, Profile{{{1, 0, 0.5}, {1, 0, 0}}}}) {
    EXPECT_EQ(first_code(faults(shape::Drawn{bad})), codes::tool_shape_impossible);
  }
}

TEST(MakeTool, ReportsEveryBadMeasure) {
  ToolBody body;
  body.shank_diameter = mm(-1.0);
  body.holder_diameter = mm(10.0);
  const double infinity = std::numeric_limits<double>::infinity();
  const Diagnostics found = faults(shape::Vee{mm(-3.0), mm(infinity), Angle(), mm(1e9), Length()}, body);
  EXPECT_GE(found.errors(), 6u);
  for (const Diagnostic& diagnostic : found.list()) EXPECT_EQ(diagnostic.code, codes::tool_measure_bad);
}

TEST(MakeTool, RefusesMeasuresThatDoNotFit) {
  const std::vector<ToolShape> bad{
      shape::BullNose{mm(6.0), mm(10.0), mm(3.5)},
      shape::BullNose{mm(6.0), mm(1.0), mm(2.0)},
      shape::Ball{mm(6.0), mm(2.0)},
      shape::Vee{mm(6.0), Length(), degrees(60.0), mm(7.0), Length()},
      shape::Vee{mm(6.0), Length(), degrees(60.0), mm(1.0), mm(1.0)},
      shape::Vee{mm(6.0), Length(), degrees(60.0), Length(), mm(9.0)},
      shape::Vee{mm(6.0), mm(0.1), degrees(60.0), Length(), mm(1.0)},
      shape::TaperedBall{mm(6.0), Length(), Angle(), mm(2.0)},
      shape::TaperedBall{mm(2.0), mm(20.0), Angle(), mm(3.0)},
      shape::Keyhole{mm(6.0), mm(2.0), mm(6.0), Length()},
      shape::Keyhole{mm(6.0), mm(2.0), mm(3.0), mm(1.0)},
      shape::Dovetail{mm(6.0), mm(20.0), degrees(30.0)},
      shape::Dovetail{mm(6.0), mm(2.0), degrees(100.0)},
      shape::Roundover{mm(1.0), mm(3.0), mm(2.0)},
      shape::ThreadMill{mm(5.0), mm(4.0), mm(1.0), Length()},
      shape::ThreadMill{mm(3.0), mm(4.0), mm(2.0), mm(1.0)},
      shape::Lollipop{mm(5.0), mm(6.0), Length()},
      shape::Lollipop{mm(5.0), mm(2.0), mm(1.0)},
      shape::TSlot{mm(5.0), mm(2.0), mm(6.0), Length()},
      shape::Drill{mm(6.0), mm(0.0), degrees(-1.0)},
      shape::CentreDrill{mm(6.0), mm(9.0), degrees(90.0), mm(4.0), Length(), degrees(60.0)},
      shape::CentreDrill{mm(3.0), mm(1.0), degrees(90.0), mm(4.0), Length(), degrees(60.0)},
      shape::FlatGroove{mm(6.0), mm(5.0), mm(7.0)},
      shape::Chamfer{mm(6.0), mm(5.0), degrees(90.0), mm(7.0)},
      shape::CornerRounding{mm(6.0), mm(5.0), mm(1.0), mm(3.0), mm(3.0)},
      shape::CornerRounding{mm(2.0), mm(8.0), mm(3.0), mm(1.0), mm(1.0)},
  };
  for (const ToolShape& shape : bad) EXPECT_TRUE(faults(shape).has_errors()) << name_of(shape);
}

TEST(MakeTool, FillsInTheUsualFlute) {
  EXPECT_EQ(made(shape::Square{mm(3.17), Length()}).flute, mm(12.7));
  EXPECT_EQ(made(shape::Square{mm(10.0), Length()}).flute, mm(30.0));
  EXPECT_EQ(made(shape::Keyhole{mm(9.525), mm(3.175), mm(6.35), Length()}).flute, mm(6.35));
}

TEST(ShapeNames, GoBothWays) {
  for (const std::string& name : shape_names()) {
    const auto shape = shape_named(name);
    ASSERT_TRUE(shape) << name;
    EXPECT_EQ(name_of(*shape), name);
  }
  EXPECT_EQ(shape_names().size(), std::variant_size_v<ToolShape>);
  EXPECT_EQ(name_of(*shape_named("Bull-Nose")), "bull nose");
  EXPECT_EQ(name_of(*shape_named("vee")), "V");
  EXPECT_EQ(name_of(*shape_named("Center Drill")), "centre drill");
  EXPECT_EQ(name_of(*shape_named("O-flute")), "square");
  EXPECT_FALSE(shape_named("banana"));
}

TEST(ShapeParameters, SetAndGetTheSameMember) {
  for (const std::string& name : shape_names()) {
    ToolShape shape = *shape_named(name);
    double value = 1.0;
    for (const ShapeParameter& parameter : parameters_of(shape)) parameter.set(shape, value++);
    value = 1.0;
    for (const ShapeParameter& parameter : parameters_of(shape))
      EXPECT_NEAR(parameter.get(shape), value++, kExact);
  }
}

TEST(ToolTable, FindsByNumberAndName) {
  ToolTable table;
  Tool tool = made(shape::Square{mm(6.0), mm(10.0)});
  tool.names = {"Amana 46200-K"};
  table.set(326, tool);
  ASSERT_NE(table.find(326), nullptr);
  EXPECT_EQ(table.find(326)->number, 326);
  EXPECT_EQ(table.find(1), nullptr);
  EXPECT_EQ(table.find_name("amana 46200k"), table.find(326));
  EXPECT_EQ(table.find_name("amana"), nullptr);
}

}  // namespace
}  // namespace kerf

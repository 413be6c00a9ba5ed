// Six-digit tool numbers: the printed ones, and encoding against decoding.
#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/tools.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

std::optional<int> encoded(const ToolShape& shape, int number = 0) {
  Diagnostics diagnostics;
  const auto tool = make_tool(number, shape, {}, {}, diagnostics);
  EXPECT_TRUE(tool);
  return tool ? encode_tool_number(*tool) : std::nullopt;
}

std::optional<ToolShape> decoded(int number) {
  Diagnostics diagnostics;
  auto shape = decode_tool_number(number, {}, diagnostics);
  EXPECT_EQ(shape.has_value(), !diagnostics.has_errors());
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::tool_number_unclear);
  return shape;
}

TEST(EncodeToolNumber, PrintedNumbers) {
  EXPECT_EQ(encoded(shape::Square{mm(0.79375), mm(1.5875)}), 100012);
  EXPECT_EQ(encoded(shape::Square{mm(3.175), mm(12.7)}), 100036);
  EXPECT_EQ(encoded(shape::Square{mm(6.35), mm(25.4)}), 100048);
  EXPECT_EQ(encoded(shape::Square{mm(2.0), mm(6.35)}), 100204);
  EXPECT_EQ(encoded(shape::Square{mm(8.0), mm(26.0)}), 100058);
  EXPECT_EQ(encoded(shape::Ball{mm(0.79375), mm(1.5875)}), 201012);
  EXPECT_EQ(encoded(shape::Ball{mm(6.35), mm(19.05)}), 204047);
  EXPECT_EQ(encoded(shape::Vee{mm(12.7), mm(6.35), degrees(90), Length(), Length()}), 390074);
  EXPECT_EQ(encoded(shape::Vee{mm(12.7), mm(11.067), degrees(60), Length(), Length()}), 360071);
  EXPECT_EQ(encoded(shape::Vee{mm(25.4), mm(22.134), degrees(60), Length(), Length()}), 360098);
  EXPECT_EQ(encoded(shape::TaperedBall{mm(3.175), mm(5.561), degrees(30), mm(0.254)}), 530131);
  EXPECT_EQ(encoded(shape::Roundover{mm(0.508), mm(1.3335), mm(4.2545)}), 602032);
  EXPECT_EQ(encoded(shape::Roundover{mm(0.508), mm(2.921), mm(7.492)}), 603042);
  EXPECT_EQ(encoded(shape::Dovetail{mm(12.7), mm(12.7), degrees(14)}), 814071);
  EXPECT_EQ(encoded(shape::Dovetail{mm(12.7), mm(20.955), degrees(8)}), 808071);
  EXPECT_EQ(encoded(shape::Keyhole{mm(9.525), mm(3.175), mm(6.35), Length()}), 906043);
  EXPECT_EQ(encoded(shape::Keyhole{mm(12.7), mm(4.7625), mm(8.0), Length()}), 907050);
  EXPECT_EQ(encoded(shape::Bowl{mm(12.7), mm(12.7), mm(3.175)}, 45981), 445981);
  EXPECT_EQ(encoded(shape::Bowl{mm(12.7), mm(12.7), mm(3.175)}, 445981), 445981);
}

TEST(EncodeToolNumber, ShapesWithoutACode) {
  EXPECT_FALSE(encoded(shape::ThreadMill{mm(2.4), mm(4.8), mm(0.75), Length()}));
  EXPECT_FALSE(encoded(shape::FlatGroove{mm(31.75), mm(12.7), mm(6.35)}));
  EXPECT_FALSE(encoded(shape::TaperedBall{mm(6.35), mm(38.1), Angle(), mm(1.5875)}));
  EXPECT_FALSE(encoded(shape::Vee{mm(12.7), Length(), degrees(60.5), Length(), Length()}));
  EXPECT_FALSE(encoded(shape::Bowl{mm(12.7), mm(12.7), mm(3.175)}, 5));
}

TEST(DecodeToolNumber, GivesTheSizesOfItsDigits) {
  const auto square = std::get<shape::Square>(*decoded(100036));
  EXPECT_EQ(square.diameter, mm(3.175));
  EXPECT_EQ(square.flute, mm(12.7));
  EXPECT_NEAR(std::get<shape::Square>(*decoded(100204)).diameter.mm(), 2.0, 1e-12);
  const auto vee = std::get<shape::Vee>(*decoded(360071));
  EXPECT_EQ(vee.diameter, mm(12.7));
  EXPECT_NEAR(vee.included_angle.deg(), 60.0, 1e-12);
  const auto roundover = std::get<shape::Roundover>(*decoded(602032));
  EXPECT_NEAR((roundover.tip_diameter + 2.0 * roundover.radius).mm(), 3.175, 1e-12);
  EXPECT_EQ(std::get<shape::Dovetail>(*decoded(814071)).flute, mm(12.7));
  EXPECT_NEAR(std::get<shape::Keyhole>(*decoded(907040)).head.mm(), 4.7625, 1e-12);
}

TEST(DecodeToolNumber, RefusesWhatIsNotOfTheScheme) {
  for (const int number : {-1, 0, 102, 99999, 1000000, 2147483647, 100096, 100006, 201022, 300000, 445981,
                           700000, 600000, 500000, 800000, 900000, 904060, 590000, 899071}) {
    EXPECT_FALSE(decoded(number)) << number;
  }
}

/// Tip codes 4, 7, 8 and 9 are the sizes of diameter codes 1, 2, 3 and 4: no taper.
TEST(DecodeToolNumber, ATaperedBallIsThinnerAtItsTip) {
  for (const int number : {510410, 510720, 510830, 510940, 510910, 510820})
    EXPECT_FALSE(decoded(number)) << number;
  for (const int number : {510130, 510420, 510730, 510840, 510950}) {
    const auto shape = decoded(number);
    ASSERT_TRUE(shape) << number;
    const auto ball = std::get<shape::TaperedBall>(*shape);
    EXPECT_LT(ball.tip_diameter.mm(), ball.diameter.mm()) << number;
  }
}

TEST(DecodeToolNumber, EveryNumberThatDecodesMakesATool) {
  for (int number = 100000; number < 1000000; ++number) {
    Diagnostics diagnostics(1);
    const auto shape = decode_tool_number(number, {}, diagnostics);
    if (!shape) continue;
    const auto tool = make_tool(number, *shape, {}, {}, diagnostics);
    ASSERT_TRUE(tool) << number << to_string(diagnostics.list().front());
    const auto again = encode_tool_number(*tool);
    if (!again) continue;
    ASSERT_EQ(*again / 100000, number / 100000) << number;
    const bool eight = number / 10 % 100 == 80 || number / 1000 % 100 == 80;  // same code as 5/16"
    if (number / 100000 < 3 && !eight) {
      ASSERT_EQ(*again / 10, number / 10) << number;
    }
  }
}

}  // namespace
}  // namespace kerf

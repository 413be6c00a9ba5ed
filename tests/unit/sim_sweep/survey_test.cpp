// Errors and warnings before anything is cut.
#include "sim/sweep/survey.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "../path/jobs.h"
#include "base/codes/sim.h"

namespace kerf::test {
namespace {

struct Refusal {
  Diagnostics diagnostics;
  std::optional<sim::Setup> setup;
  bool says(Code code) const {
    for (const Diagnostic& d : diagnostics.list())
      if (d.code == code) return true;
    return false;
  }
};
Refusal attempt(const Toolpath& path, const ToolTable& tools, Stock stock = block({0, 0, -10}, {50, 40, 0}),
                double pitch = 0.5) {
  Refusal refusal;
  refusal.setup = sim::set_up(path, tools, stock, {.resolution = mm(pitch)}, refusal.diagnostics);
  return refusal;
}
Toolpath plain_cut(int tool) {
  Path path;
  return path.tool(tool).rapid({5, 5, 2}).cut({5, 5, -1}).path();
}

TEST(Refusals, UnknownTool) {
  const Refusal refusal = attempt(plain_cut(77), square_and_keyhole());
  EXPECT_FALSE(refusal.setup);
  ASSERT_TRUE(refusal.says(codes::no_such_tool));
  EXPECT_NE(refusal.diagnostics.list()[0].hint.find("\"square d="), std::string::npos);
  EXPECT_NE(to_string(refusal.diagnostics.list()[0].where), "");
}

TEST(Refusals, NoToolChosen) {
  Path path;
  path.rapid({5, 5, 2}).cut({5, 5, -1});
  EXPECT_TRUE(attempt(path.path(), square_and_keyhole()).says(codes::no_tool_chosen));
  ToolTable one;
  one.set(9, make_drawn(9, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})));
  EXPECT_TRUE(attempt(path.path(), one).setup);
}

TEST(Refusals, ResolutionAndStock) {
  const double nan = std::nan("");
  EXPECT_TRUE(attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), nan)
                  .says(codes::bad_resolution));
  EXPECT_TRUE(attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), -1)
                  .says(codes::bad_resolution));
  const Refusal fine =
      attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {5000, 4000, 0}), 0.001);
  ASSERT_TRUE(fine.says(codes::too_many_columns));
  EXPECT_NE(fine.diagnostics.list()[0].hint.find("try a resolution of"), std::string::npos);
  EXPECT_TRUE(attempt(plain_cut(1), square_and_keyhole(), Stock{}).says(codes::stock_empty));
  EXPECT_TRUE(
      attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {50, nan, 0})).says(codes::stock_empty));
  EXPECT_TRUE(attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {1e300, 40, 0}))
                  .says(codes::stock_empty));
}

TEST(Refusals, TheSuggestedResolutionIsAccepted) {
  const Stock stock = block({0, 0, -10}, {500, 400, 0});
  Diagnostics diagnostics;
  SimulationOptions options;
  options.max_columns = 10'000;
  options.resolution = mm(0.1);
  ASSERT_FALSE(sim::set_up(plain_cut(1), square_and_keyhole(), stock, options, diagnostics));
  const std::string hint = diagnostics.list().at(0).hint;
  options.resolution = mm(std::stod(hint.substr(hint.find_first_of("0123456789"))));
  EXPECT_TRUE(sim::set_up(plain_cut(1), square_and_keyhole(), stock, options, diagnostics));
}

TEST(Refusals, AutomaticResolution) {
  const Refusal automatic = attempt(plain_cut(1), square_and_keyhole(), block({0, 0, -10}, {100, 100, 0}), 0);
  ASSERT_TRUE(automatic.setup);
  EXPECT_NEAR(automatic.setup->pitch.mm(), 100 / std::sqrt(2.5e6), 1e-9);
}

TEST(Refusals, AbsurdMotions) {
  Path path;
  path.tool(1).rapid({5, 5, 2}).cut({1e300, 5, -1});
  EXPECT_TRUE(attempt(path.path(), square_and_keyhole()).says(codes::motion_out_of_range));
}

TEST(Warnings, WhatIsNotSimulatedIsReported) {
  Path path;
  path.tool(1).rapid({5, 5, 2}).cut({5, 5, -1});
  Toolpath& steps = path.path();
  steps.set_extra(2, {.abc = std::array<double, 3>{10, 0, 0}, .z_correction = "#100"});
  steps.add(step::Extrude{{6, 6, -1}, mm3(1), mm(0.4), mm(0.2), mm_per_min(900)}, path.origin());
  const Refusal refusal = attempt(steps, square_and_keyhole());
  EXPECT_TRUE(refusal.setup);
  EXPECT_TRUE(refusal.says(codes::rotary_not_simulated));
  EXPECT_TRUE(refusal.says(codes::z_correction_not_simulated));
  EXPECT_TRUE(refusal.says(codes::extrusion_not_simulated));
}

TEST(Warnings, CoarseArcAndUnknownPosition) {
  Path path;
  path.tool(1).rapid({5, 5, 2}).cut({5, 5, -1});
  path.arc({.to = {5, 5, -2}, .centre = {1e6, 5}, .extra_turns = 50, .feed = mm_per_min(9)});
  EXPECT_TRUE(attempt(path.path(), square_and_keyhole()).says(codes::coarse_arc));
  Path unknown;
  unknown.tool(1).cut({0, 0, -1});
  unknown.path().set_unknown_axes(1, 3);
  EXPECT_TRUE(attempt(unknown.path(), square_and_keyhole()).says(codes::cut_at_unknown_place));
}

TEST(Warnings, OnlyTheUnknownAxesAreNamed) {
  const std::pair<unsigned, std::string_view> cases[] = {
      {7, "X, Y and Z are not known; assuming X0 and Y0; nothing is cut without Z"},
      {2, "Y is not known; assuming Y0"},
      {4, "Z is not known; nothing is cut without Z"}};
  for (const auto& [axes, words] : cases) {
    Path unknown;
    unknown.tool(1).cut({0, 0, -1});
    unknown.path().set_unknown_axes(1, axes);
    const Refusal refusal = attempt(unknown.path(), square_and_keyhole());
    ASSERT_TRUE(refusal.says(codes::cut_at_unknown_place));
    const std::string& message = refusal.diagnostics.list().front().message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace kerf::test

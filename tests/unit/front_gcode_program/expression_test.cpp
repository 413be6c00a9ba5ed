// Expressions and O-words by themselves. The values are those that LinuxCNC's interpreter computes.
#include "front/gcode/program/expression.h"

#include <gtest/gtest.h>
#include <string_view>

#include "base/codes/gcode.h"
#include "front/gcode/program/o_word.h"
#include "front/gcode/program/parameters.h"

namespace kerf::gcode {
namespace {

class NoController : public SystemValues {
 public:
  std::optional<double> system_number(int) const override { return std::nullopt; }
  std::optional<double> system_name(std::string_view) const override { return std::nullopt; }
  double unit_of(int) const override { return 1.0; }
  bool is_unknown_number(int number) const override { return number == 5420; }
  bool is_unknown_name(std::string_view) const override { return false; }
};

TEST(Expression, HasTheValueThatLinuxCncComputes) {
  const struct {
    std::string_view text;
    double value;
  } kCases[] = {{"[1+2*3]", 7},
                {"[2**3**2]", 64},
                {"[1 OR 0 AND 0]", 0},
                {"[-3 MOD 2]", 1},
                {"[1 EQ 1.00005]", 1},
                {"[2 GT 1 EQ 1]", 1},
                {"ROUND[-2.5]", -3},
                {"FIX[-2.5]", -3},
                {"FUP[-2.5]", -2},
                {"ATAN[-1]/[-1]", -135},
                {"-SIN[30]", -0.5},
                {"#5", 8},
                {"##4", 8},
                {"#<Foo Bar>", 3},
                {"EXISTS[#<nope>]", 0},
                {"EXISTS[#99999]", 0}};
  const NoController system;
  Parameters parameters(system);
  parameters.set_number(4, 5);
  parameters.set_number(5, 8);
  parameters.set_name("foobar", 3);
  for (const auto& c : kCases) {
    ExpressionReader reader(c.text, parameters);
    const std::optional<double> value = reader.value();
    ASSERT_TRUE(value) << c.text << ": " << reader.fault().message;
    EXPECT_NEAR(*value, c.value, 1e-9) << c.text;
    EXPECT_TRUE(reader.at_end()) << c.text;
  }
}

TEST(Expression, AFaultHasACodeAndAnOffset) {
  const struct {
    std::string_view text;
    Code code;
    std::size_t offset;
  } kCases[] = {{"[1+]", codes::expression_malformed, 3},
                {"[1/0]", codes::expression_impossible, 4},
                {"#6000", codes::parameter_unknown, 1},
                {"#<nope>", codes::parameter_unknown, 0}};
  const NoController system;
  const Parameters parameters(system);
  for (const auto& c : kCases) {
    ExpressionReader reader(c.text, parameters);
    EXPECT_FALSE(reader.value()) << c.text;
    EXPECT_EQ(reader.fault().code, c.code) << c.text;
    EXPECT_EQ(reader.fault().offset, c.offset) << c.text << ": " << reader.fault().message;
  }
}

TEST(Expression, IsUnknownWhereAParameterIs) {
  const NoController system;  // has no #5420
  Parameters parameters(system);
  parameters.set_number(1, {2.0, true});
  parameters.set_number(2, 3.0);
  parameters.set_name("depth", {4.0, true});
  const auto is_unknown = [&](std::string_view text) {
    ExpressionReader reader(text, parameters);
    EXPECT_TRUE(reader.value()) << text;
    return reader.is_unknown();
  };
  for (const auto* text : {"#1", "[#2+2*#1]", "ABS[#<depth>]", "##1", "#5420"})
    EXPECT_TRUE(is_unknown(text)) << text;
  for (const auto* text : {"#2", "[#2*2]", "EXISTS[#<depth>]"}) EXPECT_FALSE(is_unknown(text)) << text;
  parameters.set_number(1, 2.0);
  EXPECT_FALSE(is_unknown("#1")) << "a known value has replaced it";
}

TEST(Parameters, ASubroutineKnowsWhichArgumentsAreUnknown) {
  const NoController system;
  Parameters parameters(system);
  parameters.set_number(1, {7.0, true});
  const ParameterValue arguments[] = {3.0, {4.0, true}};
  parameters.enter(arguments);
  EXPECT_FALSE(parameters.number(1)->unknown);
  EXPECT_TRUE(parameters.number(2)->unknown);
  parameters.leave();
  EXPECT_TRUE(parameters.number(1)->unknown);
  EXPECT_FALSE(parameters.number(2)->unknown);
}

TEST(Parameters, ASubroutineHasItsOwnArgumentsAndNames) {
  const NoController system;
  Parameters parameters(system);
  parameters.set_number(1, 7);
  parameters.set_number(31, 9);
  parameters.set_name("depth", 2);
  parameters.set_name("_global", 4);
  const ParameterValue arguments[] = {3.0};
  parameters.enter(arguments);
  EXPECT_EQ(parameters.number(1), 3.0);
  EXPECT_EQ(parameters.number(31), 9.0);
  EXPECT_EQ(parameters.name("depth"), std::nullopt);
  EXPECT_EQ(parameters.name("_global"), 4.0);
  parameters.leave();
  EXPECT_EQ(parameters.number(1), 7.0);
  EXPECT_EQ(parameters.name("depth"), 2.0);
}

TEST(OWord, IsALabelAKeywordAndValues) {
  const OWord call = read_o_word("O<Drill Hole> CALL [1] [2]");
  EXPECT_EQ(call.label, "<drillhole>");
  EXPECT_EQ(call.kind, OKind::call);
  EXPECT_EQ(call.values, " [1] [2]");
  EXPECT_EQ(read_o_word("o0100").label, "100");
  EXPECT_EQ(read_o_word("o0100").kind, OKind::number);
  EXPECT_EQ(read_o_word("o100 endwhile").kind, OKind::end_while);
  EXPECT_EQ(read_o_word("o100 twice").kind, OKind::invalid);
}

}  // namespace
}  // namespace kerf::gcode

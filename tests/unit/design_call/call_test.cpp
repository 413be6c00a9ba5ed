// Calls of commands: arguments of a type, defaults, and how a wrong one ends the command.
#include "design/call/call.h"

#include <cmath>
#include <gtest/gtest.h>

namespace kerf::design {
namespace {

class Site final : public CallSite {
 public:
  Origin where() const override { return TextLocation{"part.txt", 3, 5}; }
  OriginId origin(OriginTable& origins) override { return origins.add(where()); }
  void error(Problem, std::string) override {}
  void warning(std::string) override {}
  Diagnostics& diagnostics() override { return found; }
  void print(std::string_view) override {}
  std::string shown(const Value& value) const override {
    return value.is(Type::text) ? "\"" + value.text() + "\"" : text_of(value);
  }
  std::string as_text(const Value& value) const override { return text_of(value); }
  std::optional<std::vector<Outline>> children() override { return std::nullopt; }
  std::optional<double> variable(std::string_view) const override { return std::nullopt; }
  Diagnostics found;
};

Value nothing(Machine&, Call&) { return {}; }

struct Calls : testing::Test {
  Command command{"rapid", parameters_of("x, y=2, name=\"a\", on=false"), nothing};
  Site site;
  std::vector<Value> arguments;
  Call call(std::vector<Value> given) {
    arguments = std::move(given);
    return Call(command, site, arguments);
  }
};

template <class Read>
Refusal refusal_of(Read read) {
  try {
    read();
  } catch (const Refusal& refusal) {
    return refusal;
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

TEST_F(Calls, TakeDefaultsOfMissingArguments) {
  const Call c = call({1.0, Value::unset()});
  EXPECT_EQ(c.size(), 4u);
  EXPECT_EQ(c.number(0), 1.0);
  EXPECT_EQ(c.number(1), 2.0);
  EXPECT_EQ(c.text(2), "a");
  EXPECT_FALSE(c.truth(3));
}

TEST_F(Calls, NameTheArgumentAndWhatIsWrong) {
  const Call c = call({std::string("q"), HUGE_VAL, 7.0, Value()});
  EXPECT_EQ(refusal_of([&] { c.number(0); }).message, "x must be a number, not \"q\"");
  EXPECT_EQ(refusal_of([&] { c.number(0); }).problem, Problem::type);
  EXPECT_EQ(refusal_of([&] { c.number(1); }).message, "y must be a finite number, not inf");
  EXPECT_EQ(refusal_of([&] { c.number(1); }).problem, Problem::value);
  EXPECT_EQ(refusal_of([&] { c.text(2); }).message, "name must be a text, not 7");
  EXPECT_EQ(refusal_of([&] { c.truth(3); }).message, "on must be true or false, not undef");
  EXPECT_EQ(refusal_of([&] { c.point2(0); }).problem, Problem::type);
}

TEST_F(Calls, AnUndefinedValueMayBeNone) {
  const Call c = call({Value(), 3.0, Value()});
  EXPECT_FALSE(c.optional_number(0));
  EXPECT_EQ(c.optional_number(1), 3.0);
  EXPECT_FALSE(c.optional_text(2));
}

TEST(Values, AreConditionsAndTexts) {
  EXPECT_FALSE(Value().is_true() || Value(0.0).is_true() || Value(std::string()).is_true() ||
               Value(Value::List()).is_true());
  EXPECT_TRUE(Value(1.0).is_true() && Value::truth(true).is_true() && Value(std::string("a")).is_true());
  EXPECT_EQ(text_of(Value::List{1.5, std::string("a"), Value::truth(true), Value()}),
            "[1.5, \"a\", true, undef]");
  EXPECT_EQ(text_of(std::string("a")), "a");
  EXPECT_EQ(text_of(Other{"[0 : 1 : 5]"}), "[0 : 1 : 5]");
}

}  // namespace
}  // namespace kerf::design

// Calls of built-in commands: arguments of a type, and messages with their callers.
#include "front/scad/value/command.h"

#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/scad.h"

namespace kerf::scad {
namespace {

class Site final : public CallSite {
 public:
  TextLocation where() const override { return {"part.scad", 3, 5}; }
  std::vector<DiagnosticNote> callers() const override {
    return {{TextLocation{"part.scad", 9, 1}, "called by module side"}};
  }
  OriginId origin(OriginTable& origins) override { return origins.add(where()); }
  Shape children() override { return {}; }
  std::size_t child_count() const override { return 0; }
  Value special(std::string_view) const override { return {}; }
  Value call(const Value&, const std::vector<Value>&) override { return {}; }
  void print(std::string_view) override {}
};

Value nothing(Call&) { return {}; }

struct ScadCall : testing::Test {
  Command command{"rapid", {{"x"}, {"y", 2.0}, {"name", Value::string("a")}}, nothing};
  Site site;
  Diagnostics diagnostics;
  Call call(std::vector<Value> arguments) {
    return Call(command, nullptr, site, diagnostics, std::move(arguments));
  }
};

TEST_F(ScadCall, TakesDefaultsOfMissingArguments) {
  Call c = call({1.0});
  EXPECT_EQ(c.number("x"), 1.0);
  EXPECT_EQ(c.number("y"), 2.0);
  EXPECT_EQ(c.text(2), "a");
  EXPECT_TRUE(c.given("x"));
  EXPECT_FALSE(c.given("y"));
  EXPECT_FALSE(c.failed());
}

TEST_F(ScadCall, ReportsWrongTypesWithTheirCallers) {
  Call c = call({Value::string("q"), HUGE_VAL, 7.0});
  EXPECT_FALSE(c.number(0));
  EXPECT_FALSE(c.number(1));
  EXPECT_FALSE(c.text(2));
  EXPECT_FALSE(c.point(0));
  EXPECT_TRUE(c.failed());
  ASSERT_GE(diagnostics.errors(), 3u);
  const Diagnostic& first = diagnostics.list()[0];
  EXPECT_EQ(first.code, codes::scad_argument);
  EXPECT_EQ(first.message, "rapid(): x is \"q\"; expected a finite number");
  EXPECT_EQ(first.where, Origin(TextLocation{"part.scad", 3, 5}));
  ASSERT_EQ(first.notes.size(), 1u);
}

TEST_F(ScadCall, LimitsNumbers) {
  Call c = call({2.5});
  EXPECT_EQ(c.number_in(0, 0, 3), 2.5);
  EXPECT_FALSE(c.number_in(0, 0, 2));
  EXPECT_FALSE(c.integer(0, 0, 9));
  EXPECT_EQ(c.integer(1, 0, 9), 2);
  EXPECT_EQ(c.truth(1), true);
  EXPECT_FALSE(c.truth(2));
}

TEST_F(ScadCall, ReadsVectorsOfPoints) {
  const Value point = Value::vector({1.0, 2.0});
  Call c = call({Value::vector({point, point}), Value::vector({1.0, std::nan("")})});
  ASSERT_TRUE(c.points(0, 2));
  EXPECT_EQ(c.points(0, 2)->size(), 2u);
  EXPECT_FALSE(c.points(0, 3));
  EXPECT_FALSE(c.numbers(1));
}

}  // namespace
}  // namespace kerf::scad

// Calls of built-in commands: messages with their callers.
#include "front/scad/value/command.h"

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
  Value variable(std::string_view) const override { return {}; }
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

TEST_F(ScadCall, MessagesHaveTheirCallers) {
  Call c = call({1.0, Value::unset()});
  ASSERT_EQ(c.arguments().size(), 2u);
  c.error(codes::scad_argument, "rapid: x is wrong");
  const Diagnostic& first = diagnostics.list()[0];
  EXPECT_EQ(first.code, codes::scad_argument);
  EXPECT_EQ(first.where, Origin(TextLocation{"part.scad", 3, 5}));
  ASSERT_EQ(first.notes.size(), 1u);
  EXPECT_EQ(first.notes[0].text, "called by module side");
}

}  // namespace
}  // namespace kerf::scad

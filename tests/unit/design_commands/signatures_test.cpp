// Every method of the Python module gcodepreview is a command of the same name, with the same parameters in
// the same order and the same defaults. docs/manual/routines.md, which is made from the module, lists them.
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

#include "base/names.h"
#include "design/commands/commands.h"
#include "design/commands/rows.h"
#include "test_paths.h"

namespace kerf::design {
namespace {

/// Methods with a value that only Python can use: texts and simulations.
const std::set<std::string> kOfPython{"dxf", "gcode", "pathsvg", "simulaterotary", "svg"};

struct Method {
  std::string name;
  std::vector<std::string> parameters;  // "ex", "laser=0"
};

/// The parts of a list between commas that are not in quotation marks or parentheses.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::string part;
  char quote = 0;
  for (const char c : text) {
    if (quote == 0 && (c == '\'' || c == '"'))
      quote = c;
    else if (c == quote)
      quote = 0;
    if (c == ',' && quote == 0) {
      parts.emplace_back(trim(part));
      part.clear();
    } else {
      part += c;
    }
  }
  if (!trim(part).empty()) parts.emplace_back(trim(part));
  return parts;
}

std::vector<Method> methods() {
  std::ifstream file(std::string(KERF_TEST_DATA) + "/../../docs/manual/routines.md");
  std::vector<Method> all;
  for (std::string line; std::getline(file, line) && line.rfind("## Shapes", 0) != 0;) {
    if (line.rfind("| `", 0) != 0) continue;
    const std::size_t open = line.find('('), close = line.find(")`");
    all.push_back({line.substr(3, open - 3), split(line.substr(open + 1, close - open - 1))});
  }
  return all;
}

/// A default of Python as text of the table: None is undef, 'Even' is "Even", 0.0 is 0.
std::string as_constant(const std::string& text) {
  if (text == "None") return "undef";
  if (text == "True") return "true";
  if (text == "False") return "false";
  if (text.front() == '\'') return "\"" + text.substr(1, text.size() - 2) + "\"";
  return text;
}

TEST(Signatures, AreThoseOfTheModule) {
  const std::vector<Method> all = methods();
  ASSERT_GT(all.size(), 150u);
  for (const Method& method : all) {
    if (kOfPython.count(method.name) != 0) continue;
    const auto found = std::find_if(commands().begin(), commands().end(),
                                    [&](const Command& command) { return command.name == method.name; });
    ASSERT_NE(found, commands().end()) << "there is no command " << method.name;
    for (std::size_t i = 0; i < method.parameters.size(); ++i) {
      const std::string& text = method.parameters[i];
      if (text.front() == '*' || method.name == "debug") break;
      const std::size_t equals = text.find('=');
      ASSERT_LT(i, found->parameters.size()) << signature_of(*found);
      const Parameter& parameter = found->parameters[i];
      EXPECT_EQ(parameter.name, text.substr(0, equals)) << signature_of(*found);
      if (equals == std::string::npos) continue;
      const std::string row = "x=" + as_constant(text.substr(equals + 1));
      const Parameter expected = parameters_of(row)[0];
      EXPECT_FALSE(parameter.required) << signature_of(*found);
      EXPECT_EQ(text_of(parameter.standard), text_of(expected.standard))
          << signature_of(*found) << " has " << row;
    }
  }
}

TEST(Signatures, AreReadFromText) {
  const auto parameters = parameters_of("ex, laser=0, name=\"Both\", on=true, feed=undef, low=-1.5");
  ASSERT_EQ(parameters.size(), 6u);
  EXPECT_TRUE(parameters[0].required);
  EXPECT_EQ(parameters[1].standard.number(), 0.0);
  EXPECT_EQ(parameters[2].standard.text(), "Both");
  EXPECT_TRUE(parameters[3].standard.truth());
  EXPECT_TRUE(parameters[4].standard.is(Type::undefined));
  EXPECT_FALSE(parameters[4].required);
  EXPECT_EQ(parameters[5].standard.number(), -1.5);
  EXPECT_TRUE(parameters_of("").empty());
}

}  // namespace
}  // namespace kerf::design

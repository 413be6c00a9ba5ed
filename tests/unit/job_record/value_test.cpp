// JSON as the command prints it.
#include "job/record/value.h"

#include <gtest/gtest.h>
#include <limits>

namespace kerf {
namespace {

std::string line(const Record& json) { return json.text(Record::Layout::line); }

TEST(JsonValue, WritesEveryKind) {
  EXPECT_EQ(line(Record()), "null");
  EXPECT_EQ(line(Record(true)), "true");
  EXPECT_EQ(line(Record(-3)), "-3");
  EXPECT_EQ(line(Record(std::size_t{5'000'000'000})), "5000000000");
  EXPECT_EQ(line(Record("text")), "\"text\"");
  EXPECT_EQ(line(Record(std::vector<std::string>{"a", "b"})), R"(["a","b"])");
  EXPECT_EQ(line(Record::array()), "[]");
  EXPECT_EQ(line(Record::object()), "{}");
}

TEST(JsonValue, FloatingNumbersHaveAPointOrAnExponent) {
  EXPECT_EQ(line(Record(2.0)), "2.0");
  EXPECT_EQ(line(Record(-1200.0)), "-1200.0");
  EXPECT_EQ(line(Record(0.1)), "0.1");
  EXPECT_EQ(line(Record(-0.0)), "-0.0");
  EXPECT_EQ(line(Record(1e-7)), "1e-07");
  EXPECT_EQ(line(Record(1e14)), "100000000000000.0");
  EXPECT_EQ(line(Record(1e15)), "1e+15");
  EXPECT_EQ(line(Record(1e20)), "1e+20");
  EXPECT_EQ(line(Record(std::numeric_limits<double>::infinity())), "null");
}

TEST(JsonValue, ListsOfPairsAreObjects) {
  EXPECT_EQ(line(Record{{"at", {1.5, 2.0}}, {"name", "x"}}), R"({"at":[1.5,2.0],"name":"x"})");
  EXPECT_EQ(line(Record{{"only", nullptr}}), R"({"only":null})");
  EXPECT_EQ(line(Record::array({"name", "x"})), R"(["name","x"])");
}

TEST(JsonValue, KeysKeepTheirOrder) {
  Record json;
  json["z"] = 1;
  json["a"].push_back(2);
  json["z"] = 3;
  json.update(Record{{"a", "new"}, {"k", false}});
  EXPECT_EQ(line(json), R"({"z":3,"a":"new","k":false})");
  Record list = Record::array({Record{{"a", 1}}});
  list[0]["b"] = 2;
  EXPECT_EQ(line(list), R"([{"a":1,"b":2}])");
}

TEST(JsonValue, StringsAreEscapedAndAlwaysUtf8) {
  EXPECT_EQ(line(Record("a\"b\\c\nd\x01")), R"("a\"b\\c\nd\u0001")");
  EXPECT_EQ(line(Record("\xc3\xa9")), "\"\xc3\xa9\"");
  EXPECT_EQ(line(Record("\xe9!")), "\"\xef\xbf\xbd!\"");  // Latin-1
  EXPECT_EQ(line(Record{{"k\n", 1}}), R"({"k\n":1})");
}

TEST(JsonValue, IndentsOnRequest) {
  const Record json{{"a", Record::array()}, {"b", {1, 2}}};
  EXPECT_EQ(json.text(Record::Layout::indented), "{\n  \"a\": [],\n  \"b\": [\n    1,\n    2\n  ]\n}");
}

}  // namespace
}  // namespace kerf

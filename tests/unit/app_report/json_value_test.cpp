// JSON as the command prints it.
#include "app/report/json_value.h"

#include <gtest/gtest.h>
#include <limits>

namespace kerf::app {
namespace {

std::string line(const Json& json) { return json.text(Json::Layout::line); }

TEST(JsonValue, WritesEveryKind) {
  EXPECT_EQ(line(Json()), "null");
  EXPECT_EQ(line(Json(true)), "true");
  EXPECT_EQ(line(Json(-3)), "-3");
  EXPECT_EQ(line(Json(std::size_t{5'000'000'000})), "5000000000");
  EXPECT_EQ(line(Json("text")), "\"text\"");
  EXPECT_EQ(line(Json(std::vector<std::string>{"a", "b"})), R"(["a","b"])");
  EXPECT_EQ(line(Json::array()), "[]");
  EXPECT_EQ(line(Json::object()), "{}");
}

TEST(JsonValue, FloatingNumbersHaveAPointOrAnExponent) {
  EXPECT_EQ(line(Json(2.0)), "2.0");
  EXPECT_EQ(line(Json(-1200.0)), "-1200.0");
  EXPECT_EQ(line(Json(0.1)), "0.1");
  EXPECT_EQ(line(Json(-0.0)), "-0.0");
  EXPECT_EQ(line(Json(1e-7)), "1e-07");
  EXPECT_EQ(line(Json(1e14)), "100000000000000.0");
  EXPECT_EQ(line(Json(1e15)), "1e+15");
  EXPECT_EQ(line(Json(1e20)), "1e+20");
  EXPECT_EQ(line(Json(std::numeric_limits<double>::infinity())), "null");
}

TEST(JsonValue, ListsOfPairsAreObjects) {
  EXPECT_EQ(line(Json{{"at", {1.5, 2.0}}, {"name", "x"}}), R"({"at":[1.5,2.0],"name":"x"})");
  EXPECT_EQ(line(Json{{"only", nullptr}}), R"({"only":null})");
  EXPECT_EQ(line(Json::array({"name", "x"})), R"(["name","x"])");
}

TEST(JsonValue, KeysKeepTheirOrder) {
  Json json;
  json["z"] = 1;
  json["a"].push_back(2);
  json["z"] = 3;
  json.update(Json{{"a", "new"}, {"k", false}});
  EXPECT_EQ(line(json), R"({"z":3,"a":"new","k":false})");
  Json list = Json::array({Json{{"a", 1}}});
  list[0]["b"] = 2;
  EXPECT_EQ(line(list), R"([{"a":1,"b":2}])");
}

TEST(JsonValue, StringsAreEscapedAndAlwaysUtf8) {
  EXPECT_EQ(line(Json("a\"b\\c\nd\x01")), R"("a\"b\\c\nd\u0001")");
  EXPECT_EQ(line(Json("\xc3\xa9")), "\"\xc3\xa9\"");
  EXPECT_EQ(line(Json("\xe9!")), "\"\xef\xbf\xbd!\"");  // Latin-1
  EXPECT_EQ(line(Json{{"k\n", 1}}), R"({"k\n":1})");
}

TEST(JsonValue, IndentsOnRequest) {
  const Json json{{"a", Json::array()}, {"b", {1, 2}}};
  EXPECT_EQ(json.text(Json::Layout::indented), "{\n  \"a\": [],\n  \"b\": [\n    1,\n    2\n  ]\n}");
}

}  // namespace
}  // namespace kerf::app

// The order in which OpenSCAD evaluates arguments: that of std::unordered_map of GCC 12, recorded.
#include "front/scad/text/argument_order.h"

#include <gtest/gtest.h>
#include <string>

namespace kerf::scad {
namespace {

using Order = std::vector<std::size_t>;

TEST(ArgumentOrder, IsThatOfTheHashTable) {
  EXPECT_EQ(table_order({"r", "$fn"}), (Order{1, 0}));
  EXPECT_EQ(table_order({"h", "r1", "r2", "center", "$fn"}), (Order{4, 3, 2, 1, 0}));
  EXPECT_EQ(table_order({"a", "b", "c", "d", "e", "f"}), (Order{5, 4, 2, 1, 3, 0}));
  EXPECT_EQ(table_order({"x", "y", "z", "$s", "size", "a_name_of_more_than_eight"}),
            (Order{5, 4, 3, 2, 1, 0}));
}

TEST(ArgumentOrder, IsThatOfATableThatHasGrown) {
  std::vector<std::string> names;
  for (int i = 0; i < 16; ++i) names.push_back("p" + std::to_string(i));
  EXPECT_EQ(table_order({names.begin(), names.end()}),
            (Order{14, 13, 0, 9, 12, 1, 5, 6, 2, 15, 4, 11, 7, 3, 8, 10}));
}

TEST(ArgumentOrder, LeavesOutArgumentsWithoutParameter) {
  std::vector<Argument> arguments(3);
  arguments[1].name = "b";
  const std::vector<Taken> taken = taken_of({"a", "b"}, 1, arguments);
  ASSERT_EQ(taken.size(), 2u);  // the last one has no name and no parameter is left
  EXPECT_EQ(taken[0].argument + taken[1].argument, 1u);
}

}  // namespace
}  // namespace kerf::scad

// Names compare without regard to case, spaces and hyphens.
#include "base/names.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(FoldName, DropsCaseSpacesAndHyphens) {
  EXPECT_EQ(fold_name("Lower-Left"), "lowerleft");
  EXPECT_EQ(fold_name(" LOWER left_"), "lowerleft");
  EXPECT_EQ(fold_name("Center-Left"), "centreleft");
  EXPECT_EQ(fold_name("centercenter"), "centrecentre");
  EXPECT_EQ(fold_name(""), "");
}

TEST(ListText, JoinsWithOr) {
  EXPECT_EQ(list_text({}), "");
  EXPECT_EQ(list_text({"a"}), "a");
  EXPECT_EQ(list_text({"a", "b", "c"}), "a, b or c");
}

TEST(Trim, TakesBlanksOffBothEnds) {
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim("   "), "");
}

}  // namespace
}  // namespace kerf

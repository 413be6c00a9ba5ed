// Lengths of messages in inches: one inch is 25.4 mm.
#include "job/length_text.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(LengthText, ConvertsMessages) {
  const LengthText inch(ProgramUnits::inch), mm;
  const auto text = [&](const char* message) { return inch.message(message); };
  EXPECT_EQ(text("a rapid passes 25.4 mm deep through the stock"),
            "a rapid passes 1 in deep through the stock");
  EXPECT_EQ(text("the tool is changed at Z -2.54, 5.08 mm below the top"),
            "the tool is changed at Z -0.1, 0.2 in below the top");
  EXPECT_EQ(text("its rapids run at Z -25.4 to 50.8, its cuts at Z 12.7"),
            "its rapids run at Z -1 to 2, its cuts at Z 0.5");
  EXPECT_EQ(text("a feed of -254 mm/min; 0.0508 mm per tooth"), "a feed of -10 in/min; 0.002 in per tooth");
  EXPECT_EQ(text("tool 2 does not cut at its centre"), "tool 2 does not cut at its centre");
  EXPECT_EQ(text("G54 and X50.8 with 10 rpm, 2 teeth, 254 mm3"), "G54 and X2 with 10 rpm, 2 teeth, 254 mm3");
  EXPECT_EQ(mm.message("Z 25.4, 1 mm"), "Z 25.4, 1 mm");
}

}  // namespace
}  // namespace kerf

// Tools given on the command line.
#include <gtest/gtest.h>

#include "base/codes/tools.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

const Origin kOption = CallLocation{"", 0, "--tool"};

Tool read(std::string_view text) {
  Diagnostics diagnostics;
  auto tool = read_tool_option(text, kOption, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.list())
    ADD_FAILURE() << text << ": " << to_string(diagnostic);
  EXPECT_TRUE(tool) << text;
  return tool.value_or(Tool{});
}

Diagnostics faults(std::string_view text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_tool_option(text, kOption, diagnostics)) << text;
  EXPECT_TRUE(diagnostics.has_errors()) << text;
  return diagnostics;
}

TEST(ToolOption, ShapesWithMeasures) {
  EXPECT_EQ(read("square d=3.175 flute=12.7").flute, mm(12.7));
  EXPECT_EQ(read("ball d=6").flute, mm(18.0));
  EXPECT_NEAR(read("V d=12.7 angle=90").flute.mm(), 6.35, 1e-12);
  EXPECT_EQ(read("tapered ball, d=6.35, tip=1.5875, flute=38.1").diameter, mm(6.35));
  EXPECT_EQ(read("bull nose d = 6 r= 1").diameter, mm(6));
  EXPECT_EQ(read("keyhole d=9.525 head=3.175 neck=6.35").flute, mm(6.35));
  EXPECT_EQ(read("dovetail diameter=12.7 flute=12.7 angle=14deg").diameter, mm(12.7));
  EXPECT_EQ(read("square d=6 number=4").number, 4);
  EXPECT_EQ(read("square d=6 teeth=3 plunges=false shank=6").teeth, 3);
}

TEST(ToolOption, Inches) {
  EXPECT_EQ(read("square d=0.25in flute=3/4in").diameter, mm(6.35));
  EXPECT_EQ(read("square d=1/8\" flute=12.7mm").diameter, mm(3.175));
}

TEST(ToolOption, NumbersAndNamesOfTheTable) {
  EXPECT_EQ(read("102").number, 102);
  EXPECT_EQ(read(" 45982 ").diameter, mm(19.05));
  EXPECT_EQ(read("Amana 46200-K").number, 326);
  EXPECT_EQ(read("100046").flute, mm(12.7));  // not in the table, but its digits say 1/4" and 1/2"
}

TEST(ToolOption, FaultsNameWhatWasMeant) {
  EXPECT_EQ(faults("squar d=3").list()[0].hint, "did you mean square?");
  EXPECT_EQ(faults("square diamter=3").list()[0].hint, "did you mean diameter?");
  const Diagnostics unknown = faults("1022");
  EXPECT_EQ(unknown.list()[0].code, codes::tool_unknown);
  EXPECT_EQ(unknown.list()[0].hint, "did you mean 102?");
  EXPECT_EQ(faults("700000").list()[0].code, codes::tool_number_unclear);
  EXPECT_EQ(faults("square d=abc").list()[0].code, codes::tool_value_type);
  EXPECT_EQ(faults("square d=3 wide").list()[0].code, codes::tool_value_type);
  EXPECT_EQ(faults("square d=3 number=x").list()[0].code, codes::tool_value_type);
  EXPECT_EQ(faults("square d=3 d=4").list()[0].code, codes::tool_value_type);
  EXPECT_EQ(faults("square").list()[0].code, codes::tool_measure_bad);
}

TEST(ToolOption, AllFaultsAreReportedWithTheOption) {
  const Diagnostics found = faults("V d=x angel=90 flute=1e");
  ASSERT_EQ(found.list().size(), 3u);
  for (const Diagnostic& fault : found.list()) EXPECT_EQ(to_string(fault.where), "--tool");
}

TEST(ToolOption, OddTextsEndInAnError) {
  for (const char* text : {"", "=", "==", "square d=", "d=3", ",,,", "square d=1/0", "square d=nan",
                           "square d=1e999", "-5", "999999999999", "square d=-1", "square d==3"}) {
    faults(text);
  }
  faults("square d=" + std::string(10000, '1'));
}

}  // namespace
}  // namespace kerf

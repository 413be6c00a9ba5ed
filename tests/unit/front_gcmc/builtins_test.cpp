// Every built-in function: its value, and its messages for arguments that do not fit.
#include <gtest/gtest.h>

#include "base/codes/gcmc.h"
#include "gcmc_run.h"

namespace kerf::test {
namespace {

class Value : public ValueTest {};
TEST_P(Value, IsThatOfTheRealProgram) { expect_value(); }

const std::vector<Case> kNumbers{
    {"pi()", "3.142"},
    {"abs(-3mm)", "3mm"},
    {"abs(-2.5)", "2.500"},
    {"sign(-3)", "-1.000"},
    {"sign(0)", "1.000"},
    {"round(2.5mm)", "3.000mm"},
    {"round(-2.5)", "-3.000"},
    {"ceil(1.2)", "2.000"},
    {"floor(-1.2)", "-2.000"},
    {"sqrt(16mm)", "4.000"},
    {"pow(2, 10)", "1024.000"},
    {"exp(0)", "1.000"},
    {"loge(1)", "0.000"},
    {"log10(1000)", "3.000"},
    {"log2(8)", "3.000"},
    {"sin(30deg)", "0.500"},
    {"cos(60deg)", "0.500"},
    {"tan(45deg)", "1.000"},
    {"sin(1)", "0.841"},
    {"asin(1)", "1.571rad"},
    {"acos(-1.0)", "3.142rad"},
    {"atan(1, 1)", "0.785rad"},
    {"atan_xy([1, 1])", "0.785rad"},
    {"atan_xz([1, 0, 1])", "0.785rad"},
    {"atan_yz([0, 1, 1])", "0.785rad"},
    {"atan(1in, 25.4mm)", "0.785rad"},
};
INSTANTIATE_TEST_SUITE_P(Numbers, Value, testing::ValuesIn(kNumbers));

const std::vector<Case> kNumbersOutOfRange{
    {"asin(2)", "warning: asin() argument 1 out of range [-1.000000,1.000000]|nanrad"},
    {"sin(1mm)", "warning: sin() argument 1 has incompatible distance units attached|0.841"},
    {"pow(2, 1mm)", "warning: pow() argument 2 has units attached|2.000"},
    {"loge(0)", "warning: loge() argument 1 out of range [0.000000,inf]|-inf"},
    {"sin()", "error: sin() requires one argument"},
    {"head([1])", "error: head() requires two arguments"},
    {"insert([1], 2)", "error: insert() requires three arguments"},
    {"pi(1)", "warning: pi() takes no arguments, ignored|3.142"},
    {"abs(\"a\")", "error: abs() argument 1 must be scalar"},
    {"abs(undef())", "error: abs() argument 1 must be scalar"},
    {"atan_xy(1)", "error: atan_xy() argument 1 must be vector"},
    {"atan_xy([1])", "error: atan_xy(): Both X and Y coordinates must be present"},
    {"atan_xy([1deg, 1deg])", "error: atan_xy(): Both X and Y coordinates must be distance"},
    {"atan(1mm, 1)", "warning: atan() arguments have different units (UNIT_MM and UNIT_NONE)|0.785rad"},
};
INSTANTIATE_TEST_SUITE_P(NumbersOutOfRange, Value, testing::ValuesIn(kNumbersOutOfRange));

const std::vector<Case> kVectors{
    {"count([1, 2])", "2"},
    {"count({[1]})", "1"},
    {"count(\"abc\")", "3"},
    {"count(\"\xC3\xA9\")", "1"},
    {"length([3, 4])", "5.000"},
    {"length([3in, 4in])", "127.000mm"},
    {"length([3, -, 4])", "5.000"},
    {"length([90deg])", "90.000deg"},
    {"normalize([3mm, 4mm])", "[0.600,0.800]"},
    {"normalize([1in, -, 1in])", "[0.707,-,0.707]"},
    {"head([1, 2, 3], 2)", "[1,2]"},
    {"head([1], 3)", "[1]"},
    {"head([1, 2, 3], -1)", "[1,2]"},
    {"head(\"hello\", -2)", "hel"},
    {"head([1, 2], -5)", "[]"},
    {"tail([1, 2, 3], 2)", "[2,3]"},
    {"tail([1], 3)", "[-,-,1]"},
    {"tail({[1], [2], [3]}, -1)", "{[2],[3]}"},
    {"delete([1, 2, 3], 1)", "[1,3]"},
    {"delete([1, 2, 3, 4], 1, 2)", "[1,4]"},
    {"delete({[1], [2]}, 0)", "{[2]}"},
    {"delete(\"hello\", 1, 2)", "hlo"},
    {"insert([1, 2], 9, 0)", "[9,1,2]"},
    {"insert([1, 2], 9, -1)", "[1,2,9]"},
    {"insert([1, 2], [8, 9], 1)", "[1,8,9,2]"},
    {"insert({[1], [2]}, [5], 1)", "{[1],[5],[2]}"},
    {"insert(\"hello\", \"XX\", 2)", "heXXllo"},
    {"insert([1], 2mm, 0)", "[2mm,1]"},
    {"reverse([1, 2, 3])", "[3,2,1]"},
    {"reverse({[1], [2]})", "{[2],[1]}"},
    {"reverse(\"abc\")", "cba"},
    {"scale([1, 2, 3], [2, -, 4])", "[2,2,12]"},
    {"scale([1], [2, 3])", "[2,-]"},
    {"scale({[1, 2]}, [2, 3mm])", "{[2,6mm]}"},
    {"scale([-, 2], [2, 2])", "[-,4]"},
    {"rotate_xy([1, 0], 90deg)", "[0.000,1.000]"},
    {"rotate_xz([1, 5, 0], 90deg)", "[0.000,5,1.000]"},
    {"rotate_yz([5, 1, 0], 90deg)", "[5,0.000,1.000]"},
};
INSTANTIATE_TEST_SUITE_P(Vectors, Value, testing::ValuesIn(kVectors));

const std::vector<Case> kVectorsThatDoNotFit{
    {"count(1)", "error: count() can only count vectors, vectorlists and strings"},
    {"length(1)", "error: length() argument 1 must be vector"},
    {"length([1mm, 1deg])",
     "warning: Mix of distance and angular units in vector in length() operation|1.414mm"},
    {"head(1, 2)", "error: head() argument 0 must be vector, vectorlist or string"},
    {"tail([1], 2000000)", "error: tail() argument 2 is too large"},
    {"delete([1], 5)", "error: delete(): argument 1 index 5 out of range [-1..0]"},
    {"delete([], 0)", "warning: delete(): argument 0 vector has no entries, cannot delete|[]"},
    {"delete([1, 2], 1, 5)", "warning: delete(): argument 2 count 5 is beyond the end, clipped to 1|[1]"},
    {"delete([1, 2], 1, -5)", "error: delete(): argument 2 must not be negative"},
    {"insert([1], \"a\", 0)", "error: insert() argument 1 must be scalar or vector for argument 0 as vector"},
    {"insert({}, 1, 0)",
     "error: insert() argument 1 must be vector or vectorlist for argument 0 as vectorlist"},
    {"insert([1], 2, 5)", "error: insert(): argument 2 index 5 out of range [-2..1]"},
    {"reverse(1)", "error: reverse() argument 1 must be vector, vectorlist or string"},
    {"scale(1, [1])", "error: scale() argument 1 must be vector or vectorlist"},
    {"scale([1], 1)", "error: scale() argument 2 must be vector"},
    {"rotate_xy([1mm, 1in], 90deg)",
     "warning: rotate_xy() Vector coordinates for X and Y have different units "
     "(X=UNIT_MM, Y=UNIT_IN)|[-1.000in,0.039in]"},
};
INSTANTIATE_TEST_SUITE_P(VectorsThatDoNotFit, Value, testing::ValuesIn(kVectorsThatDoNotFit));

const std::vector<Case> kConversions{
    {"to_mm(1in)", "25.400mm"},
    {"to_in(25.4mm)", "1.000in"},
    {"to_inch(5)", "5in"},
    {"to_deg(1rad)", "57.296deg"},
    {"to_rad(180deg)", "3.142rad"},
    {"to_none(5mm)", "5"},
    {"to_none([1mm, -])", "[1,-]"},
    {"to_native([1in, 1rad, 2])", "[25.400mm,57.296deg,2]"},
    {"to_distance(3)", "3mm"},
    {"to_mm({[1, -]})", "{[1mm,-]}"},
    {"to_int(2.9mm)", "2mm"},
    {"to_int(-2.9)", "-2"},
    {"to_int(2.99999999999999)", "2"},
    {"to_int([2.99999999999999])", "[3]"},
    {"to_int(\"0x1f\")", "31"},
    {"to_int(\"12mm\")", "12mm"},
    {"to_int(\"zz\", 36)", "1295"},
    {"to_int(\"<undef>\")", "<undef>"},
    {"to_int(undef())", "<undef>"},
    {"to_float(3in)", "3.000in"},
    {"to_float(\"1e3deg\")", "1000.000deg"},
    {"to_float(\"500mil\")", "0.500in"},
    {"to_string(1mm, [1], \"x\")", "1mm[1]x"},
    {"to_chr(233)", "\xC3\xA9"},
    {"to_chr(0)", ""},
    {"to_val(\"Abc\")", "65"},
    {"to_val(\"\")", "0"},
};
INSTANTIATE_TEST_SUITE_P(Conversions, Value, testing::ValuesIn(kConversions));

const std::vector<Case> kConversionsThatDoNotFit{
    {"to_distance(5deg)", "warning: Angular units UNIT_DEG converted to distance units UNIT_MM|5mm"},
    {"to_rad(5mm)", "warning: Distance units UNIT_MM converted to angular units UNIT_RAD|5rad"},
    {"to_mm(\"a\")", "error: to_mm() argument 1 must be scalar, vector or vectorlist"},
    {"to_int(\"1500mil\")",
     "warning: to_int(): Unit mil in string to integer loses digits because of inch "
     "conversion (1500mil != 1in)|1in"},
    {"to_int(\"5xyz\")",
     "warning: to_int(): String has a trailing context 'xyz' which does not translate into a "
     "recognized unit|5"},
    {"to_int(\"12\", 1)",
     "warning: to_int(): Base argument must be zero or between [2..36], setting to zero|12"},
    {"to_float(\"inf\")", "warning: to_float(): Value evaluates to +Inf|inf"},
    {"to_float(\"nan\")", "warning: to_float(): Value evaluates to NaN|nan"},
    {"to_chr(-1)", "error: to_chr() argument 1 is no character (-1)"},
    {"to_val(1)", "error: to_val() argument 1 must be string"},
};
INSTANTIATE_TEST_SUITE_P(ConversionsThatDoNotFit, Value, testing::ValuesIn(kConversionsThatDoNotFit));

const std::vector<Case> kQuestions{
    {"isint(1), isint(1.0)", "10"},
    {"isfloat(1.0), isfloat(1)", "10"},
    {"isscalar(1), isscalar(\"a\")", "10"},
    {"isstring(\"\"), isstring(1)", "10"},
    {"isundef(undef()), isundef(1)", "10"},
    {"isvector([]), isvector({})", "10"},
    {"isvectorlist({}), isvectorlist([])", "10"},
    {"isnone(1), isnone(1mm)", "10"},
    {"isdeg(1deg), isdeg(1rad)", "10"},
    {"israd(1rad), israd(1)", "10"},
    {"ismm(1mm), ismm(1in)", "10"},
    {"isinch(1in), isinch(1mm)", "10"},
    {"isangle(1), isangle(1deg), isangle(1mm)", "110"},
    {"isdistance(1), isdistance(1mm), isdistance(1deg)", "110"},
    {"isdefined(\"nope\"), isdefined(\"PLANE_XY\")", "01"},
    {"isconst(\"PLANE_XY\"), isconst(\"nope\")", "1<undef>"},
    {"ismodemm(), isrelative()", "10"},
    {"isgcode(), issvg(), isdxf()", "100"},
    {"isnone([1])", "error: isnone() argument 1 must be scalar"},
    {"isdefined(1)", "error: isdefined() argument 1 must be string"},
};
INSTANTIATE_TEST_SUITE_P(Questions, Value, testing::ValuesIn(kQuestions));

TEST(GcmcBuiltins, ModesFollowTheOptions) {
  GcmcOptions options = bare();
  options.imperial = options.relative = true;
  options.target = GcmcTarget::svg;
  EXPECT_EQ(value_of("ismodemm(), isrelative(), isgcode(), issvg()", options), "0101");
  EXPECT_EQ(value_of("to_native([1in, 25.4mm])", options), "[1in,1.000in]");
  EXPECT_EQ(value_of("to_distance(1)", options), "1in");
}

TEST(GcmcBuiltins, NormalizingNothingWarns) {
  EXPECT_EQ(value_of("count(normalize([0, 0]))"),
            "warning: normalize() argument 1 has no length, the result is not a number|2");
}

TEST(GcmcBuiltins, MessagesAreLinesForOtherPrograms) {
  const auto ran = run("message(\"a\\n\", \"b\\n\");\nwarning(1);\nerror(\"bad \", 2mm); message();");
  ASSERT_EQ(ran.messages.size(), 4u);
  EXPECT_EQ(gcmc_line(ran.messages[0]), "t.gcmc:1:21: Runtime message(): a\nb");
  EXPECT_EQ(gcmc_line(ran.messages[1]), "t.gcmc:2:10: Runtime warning(): 1");
  EXPECT_EQ(gcmc_line(ran.messages[2]), "t.gcmc:3:18: Runtime error(): bad 2mm");
  EXPECT_EQ(gcmc_line(ran.messages[3]), "t.gcmc:3:29: Runtime message(): ");
  EXPECT_EQ(ran.run.status, 1);  // error() does not stop, but it counts
  EXPECT_EQ(ran.messages[0].code, codes::gcmc_script);
}

struct Written {
  const char* program;
  const char* text;
};
class Text : public testing::TestWithParam<Written> {};
TEST_P(Text, IsThatOfTheRealProgram) {
  GcmcOptions options = bare();
  options.want_path = false;  // literal() prints values here, which are invalid in a toolpath
  const auto ran = run(GetParam().program, options);
  EXPECT_EQ(ran.text, GetParam().text);
  EXPECT_EQ(ran.run.status, 0) << (ran.lines.empty() ? "" : ran.lines.front());
}

const std::vector<Written> kMoves{
    {"goto([1, 2, 3]); goto([1, 2, 3]);", "G0 X1.000 Y2.000 Z3.000\nG0 X1.000 Y2.000 Z3.000\n"},
    {"move([1in, -, 2]);", "G1 X25.400 Z2.000\n"},
    {"move([1], 100); move([2], 1in);", "G1 X1.000 F100.000\nG1 X2.000 F25.400\n"},
    {"move({[1], [2]});", "G1 X1.000\nG1 X2.000\n"},
    {"goto([1, 2]); goto_r([1]); move_r([-, 1]);", "G0 X1.000 Y2.000\nG0 X2.000\nG1 Y3.000\n"},
    {"goto([1, 2, 3, 4, 5, 6, 7]);", "G0 X1.000 Y2.000 Z3.000 A4.000 B5.000 C6.000\n"},
    {"goto([-, -, -, 1rad]);", "G0 A57.296\n"},
    {"relocate([10, -, 1in]); move([1, 1, 1]); relocate(); move([1]);",
     "G1 X11.000 Y1.000 Z26.400\nG1 X1.000\n"},
    {"move([1, 2]); literal(to_string(position()));", "G1 X1.000 Y2.000\n[1.000mm,2.000mm,0.000mm]"},
    {"literal(to_string(position(2)), to_string(move([5])), to_string(position()));",
     "G1 X5.000\n[0.000mm,0.000mm][0.000mm,0.000mm,0.000mm][5.000mm,0.000mm,0.000mm]"},
};
INSTANTIATE_TEST_SUITE_P(Moves, Text, testing::ValuesIn(kMoves));

const std::vector<Written> kArcs{
    {"arc_cw([10, 0], 5);", "G2 X10.000 Y0.000 I5.000 J0.000\n"},
    {"goto([10, 0]); arc_cw([0, 0], 10); ", "G0 X10.000 Y0.000\nG2 X0.000 Y0.000 I-5.000 J8.660\n"},
    {"arc_ccw([10], -10, 2);", "G3 X10.000 I5.000 J-8.660 P2\n"},
    {"move([5, 5, 5]); arc_ccw_r([0, 2, 1], 2);",
     "G1 X5.000 Y5.000 Z5.000\nG3 X5.000 Y7.000 Z6.000 I-1.732 J1.000\n"},
    {"move([5, 5]); arc_cw_r([2, -], 1);", "G1 X5.000 Y5.000\nG2 X7.000 I1.000 J0.000\n"},
    {"plane(PLANE_YZ); arc_cw([-, 10, 0], 6);", "G19\nG2 Y10.000 Z0.000 J5.000 K-3.317\n"},
    {"plane(\"xz\"); arc_cw([10, -, 0], 6);", "G18\nG2 X10.000 Z0.000 I5.000 K3.317\n"},
    {"circle_cw([5, 0]); circle_ccw([5, 0, 3]); circle_cw_r([0, 5, 1], 3);",
     "G2 X0.000 Y0.000 I5.000 J0.000\nG3 X0.000 Y0.000 Z3.000 I5.000 J0.000\n"
     "G2 X0.000 Y0.000 Z4.000 I0.000 J5.000 P3\n"},
    {"circle_ccw(5, 90deg); circle_ccw_r(5mm, 90deg, 4);",
     "G3 X0.000 Y0.000 I0.000 J5.000\nG3 X0.000 Y0.000 I0.000 J5.000 P4\n"},
};
INSTANTIATE_TEST_SUITE_P(Arcs, Text, testing::ValuesIn(kArcs));

const std::vector<Written> kState{
    {"feedrate(60); feedrate(1in);", "F60.000\nF25.400\n"},
    {"feedmode(0); feedmode(\"UPM\"); feedmode(2);", "G93\nG94\nG95\n"},
    {"spindle(100); spindle(-50); spindle(0); spindlespeed(7);", "S100.000\nM3\nS50.000\nM4\nM5\nS7.000\n"},
    {"coolant(0); coolant(1); coolant(\"flood\"); coolant(3);", "M9\nM7\nM8\nM7\nM8\n"},
    {"toolchange(3); toolchange(4, 1);", "T3\nM6\nT4\nM6\nG43 H4\n"},
    {"dwell(0.5);", "G4 P0.500\n"},
    {"pathmode(1); pathmode(0); pathmode(0.1, 0.2); pathmode(1in, undef());",
     "G61\nG64\nG64 P0.100 Q0.200\nG64 P25.400\n"},
    {"pause(); pause(1); pause(0);", "M0\nM1\nM0\n"},
    {"literal(plane(undef()), plane(1), plane(PLANE_QUERY));", "G18\n001"},
    {"comment(\"x=\", 1mm);", "(x=1mm)\n"},
    {"svg_closepath(); layerstack(\"a\"); layer(1);", ""},
    {"fixpos_store(0); goto([1, 2, 3]); fixpos_restore(0, [-, -, 9]); literal(to_string(position()));",
     "G28.1\nG0 X1.000 Y2.000 Z3.000\nG28 Z9.000\n[0.000mm,0.000mm,0.000mm]"},
    {"fixpos_set(1, [1, 2, 3]); fixpos_restore(1); literal(to_string(position()));",
     "G30\n[1.000mm,2.000mm,3.000mm]"},
    {"drill([1, 2, -3], 5, 1); drill([2, 2, -3], 5, 1, 4); literal(to_string(position()));",
     "G73 X1.000 Y2.000 Z-3.000 R5.000 Q1.000\nG73 X2.000 Y2.000 Z-3.000 R5.000 Q1.000 L4\n"
     "[2.000mm,2.000mm,5.000mm]"},
};
INSTANTIATE_TEST_SUITE_P(State, Text, testing::ValuesIn(kState));

class Refusal : public MessageTest {};
TEST_P(Refusal, HasItsMessage) { expect_messages(); }

const std::vector<Case> kMachine{
    {"goto([-, -]);", "error: All coordinates in goto() undefined"},
    {"move({});", "warning: move(): Vectorlist contains no vectors"},
    {"goto(1);", "error: goto(): Argument must be a vector or a vectorlist"},
    {"goto([-, -, -, 1mm]);", "warning: goto() argument 1 has incompatible distance units attached"},
    {"goto([1deg]);", "warning: goto() argument 1 has incompatible angular units attached"},
    {"goto([to_float(\"1e308\") * 100]);", "error: goto() coordinate X is not a finite number"},
    {"position(10);", "error: position() argument 1 must be 1 to 9"},
    {"relocate(1);", "error: relocate() argument 1 must be vector"},
    {"arc_cw(1, 1);", "error: arc_cw(): First argument must be a vector"},
    {"arc_cw([1, 0], 0.4);",
     "error: arc_cw() radius (4.000000e-01) is less than two times distance from start to end "
     "(D=-9.000000e-02)"},
    {"arc_cw([0, 0], 1);", "error: arc_cw() distance between start and endpoint zero (0.000000e+00)"},
    {"arc_cw([-, -, 5], 5);", "error: arc_cw() in plane PLANE_XY is missing both plane coordinates"},
    {"arc_cw([10, 0], 5, 0);", "error: arc_cw() Number of turns must be >= 1"},
    {"circle_cw([1]);", "error: circle_cw() in plane PLANE_XY is missing plane coordinates"},
    {"circle_cw(\"a\");", "error: circle_cw(): First argument neither vector nor scalar"},
    {"circle_cw(1);", "error: circle_cw() requires two arguments"},
    {"circle_cw([0, 0]);", "error: circle_cw() radius is zero"},
    {"drill([1, 2], 5, 1);", "error: Drill-cycle must have a scalar Z-coordinate in first argument"},
    {"drill([1, 2, 3], 5, 0);", "error: drill() argument 3 must be > 0"},
    {"drill([1, 2, 3], 5, 1, 0);", "error: drill() argument 4 must be > 0"},
    {"drill([1, 2, -1000000], 5, 0.001);",
     "error: drill(): pecks of 0.001 mm are more than 100000 in one hole"},
    {"drill([1, 2, 6], 5, 1);", "error: drill(): the retract plane R is 1 mm below the bottom of the hole"},
    {"drill([1, 2, -3], 5, 1, 10001);", "error: drill() repeats a hole more than 10000 times"},
    {"plane(PLANE_XZ); drill([1, -, -3], 5, 1);", "error: drill() needs Y, the bottom of the hole"},
    {"feedrate(60deg);", "warning: feedrate() argument 1 has incompatible angular units attached"},
    {"feedrate(to_float(\"inf\"));",
     "warning: to_float(): Value evaluates to +Inf|error: feedrate() argument 1 is not finite"},
    {"feedmode(5);", "error: Feed mode must be one of 0 (\"inverse\"), 1 (\"upm\") or 2 (\"upr\")"},
    {"coolant(7);",
     "error: Coolant must be on of: 0 (\"off\"), 1 (\"mist\"), 2 (\"flood\") or 3 (\"mist+flood\")"},
    {"spindlespeed(-1);", "error: Spindle speed cannot be negative (-1.000000)"},
    {"toolchange(-1);", "error: Tool index must be >= 0"},
    {"dwell(-1);", "error: Dwell cannot have negative seconds (-1.000000)"},
    {"pathmode();", "error: pathmode(): expects one or two arguments"},
    {"plane(5);",
     "error: plane() only accepts PLANE_XY (0), PLANE_XZ (1), PLANE_YZ (2) or strings "
     "\"XY\"|\"XZ\"|\"YZ\""},
    {"fixpos_restore(0);", "warning: Position for G28 not previously set, tracking may be off"},
    {"fixpos_set(0, 1);", "error: fixpos_set() argument 2 must be vector"},
    {"fixpos_restore(0, 1);", "error: fixpos_restore() argument 2 must be vector"},
    {"layerstack(\"a b\");", "error: layerstack() invalid characters in layer name 1"},
    {"layerstack(\"a\", \"a\");", "error: layerstack() layer 'a' already exists"},
    {"layerstack(1);", "error: layerstack() argument 1 must be string"},
    {"layer(1);", "error: layer() index 1 out of range [1..0]"},
    {"layer(\"n\");", "warning: layer() layer 'n' not found, added to the stack"},
};
INSTANTIATE_TEST_SUITE_P(Machine, Refusal, testing::ValuesIn(kMachine));

TEST(GcmcBuiltins, ADrawingHasOnePlane) {
  GcmcOptions options = bare();
  options.target = GcmcTarget::dxf;
  EXPECT_EQ(messages_of("plane(PLANE_XZ);", options),
            "warning: plane() other than PLANE_XY has no meaning in a drawing");
  EXPECT_EQ(messages_of("spindlespeed(100);", options), "");
}

// ---- typeset

TEST(GcmcTypeset, BlankHasTheWidthOfTheLanguage) {
  EXPECT_EQ(value_of("typeset(\" \", FONT_HSANS_1)"),
            "{[-,-,1.000],[0.000,0.000,-],[0.571,0.000,-],[0.571,0.000,-]}");
  EXPECT_EQ(value_of("typeset(\"\", FONT_HTIMES)"), "{[-,-,1.000],[0.000,0.000,-],[0.000,0.000,-]}");
}

TEST(GcmcTypeset, MissingGlyphsAndFontsAreWarnings) {
  EXPECT_EQ(value_of("typeset(\"\\x07\", FONT_HSANS_1)"),
            "warning: Glyph for codepoint 0x00000007 not available, replacing with ' '|"
            "{[-,-,1.000],[0.000,0.000,-],[0.571,0.000,-],[0.571,0.000,-]}");
  EXPECT_EQ(value_of("typeset(\"A\", 99)"), "warning: Font id 0x00000063 not found|<undef>");
  EXPECT_EQ(value_of("typeset(1, 1)"), "error: typeset() argument 1 must be string");
  EXPECT_EQ(value_of("typeset(\"A\", 1.0)"), "error: typeset() argument 2 must be integer");
  EXPECT_EQ(run("typeset(\"\\x07\", 1);").messages.front().code, codes::gcmc_glyph);
}

TEST(GcmcTypeset, CapitalsAreOneHighInEveryFont) {
  for (const char* font :
       {"FONT_HSANS_1", "FONT_HSANS_2", "FONT_HSCRIPT_1", "FONT_HSCRIPT_2", "FONT_HTIMES", "FONT_HSANS_1_RS",
        "FONT_HTIMES_BOLD", "FONT_HTIMES_ITALIC", "FONT_HTIMES_ITALIC_BOLD"}) {
    const std::string program = std::string("top = 0.0; foreach(typeset(\"X\", ") + font +
                                "); v) { if(!isundef(v.y) && v.y > top) { top = v.y; } } message(top);";
    const auto ran = run(program);
    ASSERT_EQ(ran.lines.size(), 1u) << font;
    EXPECT_EQ(ran.lines[0], "Runtime message(): 1.000") << font;
  }
}

TEST(GcmcTypeset, AccentsAreComposed) {
  EXPECT_EQ(value_of("count(typeset(\"\xC3\xA9\", 1)) > count(typeset(\"e\", 1))"), "1");
  EXPECT_EQ(value_of("typeset(\"\xC3\xA9\", 1)[-1].x == typeset(\"e\", 1)[-1].x"), "1");
}

}  // namespace
}  // namespace kerf::test

// Every built-in function: its value, and what it says where its arguments do not fit.
#include <gtest/gtest.h>

#include "gcmc_run.h"

namespace kerf {
namespace {

using test::bare;
using test::run;
using test::said_by;
using test::value_of;

struct Case {
  const char* expression;
  const char* value;
};

class Value : public testing::TestWithParam<Case> {};
TEST_P(Value, IsAsTheLanguageSays) { EXPECT_EQ(value_of(GetParam().expression), GetParam().value); }

INSTANTIATE_TEST_SUITE_P(Numbers, Value, testing::Values(
    Case{"pi()", "3.142"}, Case{"abs(-3mm)", "3mm"}, Case{"abs(-2.5)", "2.500"}, Case{"sign(-3)", "-1.000"},
    Case{"sign(0)", "1.000"}, Case{"round(2.5mm)", "3.000mm"}, Case{"round(-2.5)", "-3.000"},
    Case{"ceil(1.2)", "2.000"}, Case{"floor(-1.2)", "-2.000"}, Case{"sqrt(16mm)", "4.000"},
    Case{"pow(2, 10)", "1024.000"}, Case{"exp(0)", "1.000"}, Case{"loge(1)", "0.000"}, Case{"log10(1000)", "3.000"},
    Case{"log2(8)", "3.000"}, Case{"sin(30deg)", "0.500"}, Case{"cos(60deg)", "0.500"}, Case{"tan(45deg)", "1.000"},
    Case{"sin(1)", "0.841"}, Case{"asin(1)", "1.571rad"}, Case{"acos(-1.0)", "3.142rad"}, Case{"atan(1, 1)", "0.785rad"},
    Case{"atan_xy([1, 1])", "0.785rad"}, Case{"atan_xz([1, 0, 1])", "0.785rad"},
    Case{"atan_yz([0, 1, 1])", "0.785rad"}, Case{"atan(1in, 25.4mm)", "0.785rad"}));

INSTANTIATE_TEST_SUITE_P(NumbersOutOfRange, Value, testing::Values(
    Case{"asin(2)", "warning: asin() argument 1 out of range [-1.000000,1.000000]|nanrad"},
    Case{"sin(1mm)", "warning: sin() argument 1 has incompatible distance units attached|0.841"},
    Case{"pow(2, 1mm)", "warning: pow() argument 2 has units attached|2.000"},
    Case{"loge(0)", "warning: loge() argument 1 out of range [0.000000,inf]|-inf"},
    Case{"sin()", "error: sin() requires one argument"},
    Case{"head([1])", "error: head() requires two arguments"},
    Case{"insert([1], 2)", "error: insert() requires three arguments"},
    Case{"pi(1)", "warning: pi() takes no arguments, ignored|3.142"},
    Case{"abs(\"a\")", "error: abs() argument 1 must be scalar"},
    Case{"abs(undef())", "error: abs() argument 1 must be scalar"},
    Case{"atan_xy(1)", "error: atan_xy() argument 1 must be vector"},
    Case{"atan_xy([1])", "error: atan_xy(): Both X and Y coordinates must be present"},
    Case{"atan_xy([1deg, 1deg])", "error: atan_xy(): Both X and Y coordinates must be distance"},
    Case{"atan(1mm, 1)", "warning: atan() arguments have different units (UNIT_MM and UNIT_NONE)|0.785rad"}));

INSTANTIATE_TEST_SUITE_P(Vectors, Value, testing::Values(
    Case{"count([1, 2])", "2"}, Case{"count({[1]})", "1"}, Case{"count(\"abc\")", "3"}, Case{"count(\"\xC3\xA9\")", "1"},
    Case{"length([3, 4])", "5.000"}, Case{"length([3in, 4in])", "127.000mm"}, Case{"length([3, -, 4])", "5.000"},
    Case{"length([90deg])", "90.000deg"}, Case{"normalize([3mm, 4mm])", "[0.600,0.800]"},
    Case{"normalize([1in, -, 1in])", "[0.707,-,0.707]"}, Case{"head([1, 2, 3], 2)", "[1,2]"},
    Case{"head([1], 3)", "[1]"}, Case{"head([1, 2, 3], -1)", "[1,2]"}, Case{"head(\"hello\", -2)", "hel"},
    Case{"head([1, 2], -5)", "[]"}, Case{"tail([1, 2, 3], 2)", "[2,3]"}, Case{"tail([1], 3)", "[-,-,1]"},
    Case{"tail({[1], [2], [3]}, -1)", "{[2],[3]}"}, Case{"delete([1, 2, 3], 1)", "[1,3]"},
    Case{"delete([1, 2, 3, 4], 1, 2)", "[1,4]"}, Case{"delete({[1], [2]}, 0)", "{[2]}"},
    Case{"delete(\"hello\", 1, 2)", "hlo"}, Case{"insert([1, 2], 9, 0)", "[9,1,2]"},
    Case{"insert([1, 2], 9, -1)", "[1,2,9]"}, Case{"insert([1, 2], [8, 9], 1)", "[1,8,9,2]"},
    Case{"insert({[1], [2]}, [5], 1)", "{[1],[5],[2]}"}, Case{"insert(\"hello\", \"XX\", 2)", "heXXllo"},
    Case{"insert([1], 2mm, 0)", "[2mm,1]"}, Case{"reverse([1, 2, 3])", "[3,2,1]"},
    Case{"reverse({[1], [2]})", "{[2],[1]}"}, Case{"reverse(\"abc\")", "cba"},
    Case{"scale([1, 2, 3], [2, -, 4])", "[2,2,12]"}, Case{"scale([1], [2, 3])", "[2,-]"},
    Case{"scale({[1, 2]}, [2, 3mm])", "{[2,6mm]}"}, Case{"scale([-, 2], [2, 2])", "[-,4]"},
    Case{"rotate_xy([1, 0], 90deg)", "[0.000,1.000]"}, Case{"rotate_xz([1, 5, 0], 90deg)", "[0.000,5,1.000]"},
    Case{"rotate_yz([5, 1, 0], 90deg)", "[5,0.000,1.000]"}));

INSTANTIATE_TEST_SUITE_P(VectorsThatDoNotFit, Value, testing::Values(
    Case{"count(1)", "error: count() can only count vectors, vectorlists and strings"},
    Case{"length(1)", "error: length() argument 1 must be vector"},
    Case{"length([1mm, 1deg])",
         "warning: Mix of distance and angular units in vector in length() operation|1.414mm"},
    Case{"head(1, 2)", "error: head() argument 0 must be vector, vectorlist or string"},
    Case{"tail([1], 2000000)", "error: tail() argument 2 is too large"},
    Case{"delete([1], 5)", "error: delete(): argument 1 index 5 out of range [-1..0]"},
    Case{"delete([], 0)", "warning: delete(): argument 0 vector has no entries, cannot delete|[]"},
    Case{"delete([1, 2], 1, 5)", "warning: delete(): argument 2 count 5 is beyond the end, clipped to 1|[1]"},
    Case{"delete([1, 2], 1, -5)", "error: delete(): argument 2 must not be negative"},
    Case{"insert([1], \"a\", 0)", "error: insert() argument 1 must be scalar or vector for argument 0 as vector"},
    Case{"insert({}, 1, 0)", "error: insert() argument 1 must be vector or vectorlist for argument 0 as vectorlist"},
    Case{"insert([1], 2, 5)", "error: insert(): argument 2 index 5 out of range [-2..1]"},
    Case{"reverse(1)", "error: reverse() argument 1 must be vector, vectorlist or string"},
    Case{"scale(1, [1])", "error: scale() argument 1 must be vector or vectorlist"},
    Case{"scale([1], 1)", "error: scale() argument 2 must be vector"},
    Case{"rotate_xy([1mm, 1in], 90deg)", "warning: rotate_xy() Vector coordinates for X and Y have different units "
                                         "(X=UNIT_MM, Y=UNIT_IN)|[-1.000in,0.039in]"}));

INSTANTIATE_TEST_SUITE_P(Conversions, Value, testing::Values(
    Case{"to_mm(1in)", "25.400mm"}, Case{"to_in(25.4mm)", "1.000in"}, Case{"to_inch(5)", "5in"},
    Case{"to_deg(1rad)", "57.296deg"}, Case{"to_rad(180deg)", "3.142rad"}, Case{"to_none(5mm)", "5"},
    Case{"to_none([1mm, -])", "[1,-]"}, Case{"to_native([1in, 1rad, 2])", "[25.400mm,57.296deg,2]"},
    Case{"to_distance(3)", "3mm"}, Case{"to_mm({[1, -]})", "{[1mm,-]}"}, Case{"to_int(2.9mm)", "2mm"},
    Case{"to_int(-2.9)", "-2"}, Case{"to_int(2.99999999999999)", "2"}, Case{"to_int([2.99999999999999])", "[3]"},
    Case{"to_int(\"0x1f\")", "31"}, Case{"to_int(\"12mm\")", "12mm"}, Case{"to_int(\"zz\", 36)", "1295"},
    Case{"to_int(\"<undef>\")", "<undef>"}, Case{"to_int(undef())", "<undef>"}, Case{"to_float(3in)", "3.000in"},
    Case{"to_float(\"1e3deg\")", "1000.000deg"}, Case{"to_float(\"500mil\")", "0.500in"},
    Case{"to_string(1mm, [1], \"x\")", "1mm[1]x"}, Case{"to_chr(233)", "\xC3\xA9"}, Case{"to_chr(0)", ""},
    Case{"to_val(\"Abc\")", "65"}, Case{"to_val(\"\")", "0"}));

INSTANTIATE_TEST_SUITE_P(ConversionsThatDoNotFit, Value, testing::Values(
    Case{"to_distance(5deg)", "warning: Angular units UNIT_DEG converted to distance units UNIT_MM|5mm"},
    Case{"to_rad(5mm)", "warning: Distance units UNIT_MM converted to angular units UNIT_RAD|5rad"},
    Case{"to_mm(\"a\")", "error: to_mm() argument 1 must be scalar, vector or vectorlist"},
    Case{"to_int(\"1500mil\")", "warning: to_int(): Unit mil in string to integer loses digits because of inch "
                                "conversion (1500mil != 1in)|1in"},
    Case{"to_int(\"5xyz\")", "warning: to_int(): String has a trailing context 'xyz' which does not translate into a "
                             "recognized unit|5"},
    Case{"to_int(\"12\", 1)",
         "warning: to_int(): Base argument must be zero or between [2..36], setting to zero|12"},
    Case{"to_float(\"inf\")", "warning: to_float(): Value evaluates to +Inf|inf"},
    Case{"to_float(\"nan\")", "warning: to_float(): Value evaluates to NaN|nan"},
    Case{"to_chr(-1)", "error: to_chr() argument 1 is no character (-1)"},
    Case{"to_val(1)", "error: to_val() argument 1 must be string"}));

INSTANTIATE_TEST_SUITE_P(Questions, Value, testing::Values(
    Case{"isint(1), isint(1.0)", "10"}, Case{"isfloat(1.0), isfloat(1)", "10"}, Case{"isscalar(1), isscalar(\"a\")", "10"},
    Case{"isstring(\"\"), isstring(1)", "10"}, Case{"isundef(undef()), isundef(1)", "10"},
    Case{"isvector([]), isvector({})", "10"}, Case{"isvectorlist({}), isvectorlist([])", "10"},
    Case{"isnone(1), isnone(1mm)", "10"}, Case{"isdeg(1deg), isdeg(1rad)", "10"}, Case{"israd(1rad), israd(1)", "10"},
    Case{"ismm(1mm), ismm(1in)", "10"}, Case{"isinch(1in), isinch(1mm)", "10"},
    Case{"isangle(1), isangle(1deg), isangle(1mm)", "110"},
    Case{"isdistance(1), isdistance(1mm), isdistance(1deg)", "110"},
    Case{"isdefined(\"nope\"), isdefined(\"PLANE_XY\")", "01"},
    Case{"isconst(\"PLANE_XY\"), isconst(\"nope\")", "1<undef>"}, Case{"ismodemm(), isrelative()", "10"},
    Case{"isgcode(), issvg(), isdxf()", "100"}, Case{"isnone([1])", "error: isnone() argument 1 must be scalar"},
    Case{"isdefined(1)", "error: isdefined() argument 1 must be string"}));

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
  EXPECT_EQ(to_line(ran.messages[0]), "t.gcmc:1:21: Runtime message(): a\nb");
  EXPECT_EQ(to_line(ran.messages[1]), "t.gcmc:2:10: Runtime warning(): 1");
  EXPECT_EQ(to_line(ran.messages[2]), "t.gcmc:3:18: Runtime error(): bad 2mm");
  EXPECT_EQ(to_line(ran.messages[3]), "t.gcmc:3:29: Runtime message(): ");
  EXPECT_EQ(ran.run.status, 1);  // error() does not stop, but it counts
  EXPECT_EQ(ran.messages[0].code, Code::gcmc_script);
}

struct Written {
  const char* program;
  const char* text;
};
class Text : public testing::TestWithParam<Written> {};
TEST_P(Text, IsWordForWord) {
  const auto ran = run(GetParam().program);
  EXPECT_EQ(ran.text, GetParam().text);
  EXPECT_EQ(ran.run.status, 0) << (ran.said.empty() ? "" : ran.said.front());
}

INSTANTIATE_TEST_SUITE_P(Moves, Text, testing::Values(
    Written{"goto([1, 2, 3]); goto([1, 2, 3]);", "G0 X1.000 Y2.000 Z3.000\nG0 X1.000 Y2.000 Z3.000\n"},
    Written{"move([1in, -, 2]);", "G1 X25.400 Z2.000\n"}, Written{"move([1], 100); move([2], 1in);",
                                                                  "G1 X1.000 F100.000\nG1 X2.000 F25.400\n"},
    Written{"move({[1], [2]});", "G1 X1.000\nG1 X2.000\n"},
    Written{"goto([1, 2]); goto_r([1]); move_r([-, 1]);", "G0 X1.000 Y2.000\nG0 X2.000\nG1 Y3.000\n"},
    Written{"goto([1, 2, 3, 4, 5, 6, 7]);", "G0 X1.000 Y2.000 Z3.000 A4.000 B5.000 C6.000\n"},
    Written{"goto([-, -, -, 1rad]);", "G0 A57.296\n"},
    Written{"relocate([10, -, 1in]); move([1, 1, 1]); relocate(); move([1]);",
            "G1 X11.000 Y1.000 Z26.400\nG1 X1.000\n"},
    Written{"move([1, 2]); literal(to_string(position()));", "G1 X1.000 Y2.000\n[1.000mm,2.000mm,0.000mm]"},
    Written{"literal(to_string(position(2)), to_string(move([5])), to_string(position()));",
            "G1 X5.000\n[0.000mm,0.000mm][0.000mm,0.000mm,0.000mm][5.000mm,0.000mm,0.000mm]"}));

INSTANTIATE_TEST_SUITE_P(Arcs, Text, testing::Values(
    Written{"arc_cw([10, 0], 5);", "G2 X10.000 Y0.000 I5.000 J0.000\n"},
    Written{"goto([10, 0]); arc_cw([0, 0], 10); ", "G0 X10.000 Y0.000\nG2 X0.000 Y0.000 I-5.000 J8.660\n"},
    Written{"arc_ccw([10], -10, 2);", "G3 X10.000 I5.000 J-8.660 P2\n"},
    Written{"move([5, 5, 5]); arc_ccw_r([0, 2, 1], 2);",
            "G1 X5.000 Y5.000 Z5.000\nG3 X5.000 Y7.000 Z6.000 I-1.732 J1.000\n"},
    Written{"move([5, 5]); arc_cw_r([2, -], 1);", "G1 X5.000 Y5.000\nG2 X7.000 I1.000 J0.000\n"},
    Written{"plane(PLANE_YZ); arc_cw([-, 10, 0], 6);", "G19\nG2 Y10.000 Z0.000 J5.000 K-3.317\n"},
    Written{"plane(\"xz\"); arc_cw([10, -, 0], 6);", "G18\nG2 X10.000 Z0.000 I5.000 K3.317\n"},
    Written{"circle_cw([5, 0]); circle_ccw([5, 0, 3]); circle_cw_r([0, 5, 1], 3);",
            "G2 X0.000 Y0.000 I5.000 J0.000\nG3 X0.000 Y0.000 Z3.000 I5.000 J0.000\n"
            "G2 X0.000 Y0.000 Z4.000 I0.000 J5.000 P3\n"},
    Written{"circle_ccw(5, 90deg); circle_ccw_r(5mm, 90deg, 4);",
            "G3 X0.000 Y0.000 I0.000 J5.000\nG3 X0.000 Y0.000 I0.000 J5.000 P4\n"}));

INSTANTIATE_TEST_SUITE_P(State, Text, testing::Values(
    Written{"feedrate(60); feedrate(1in);", "F60.000\nF25.400\n"},
    Written{"feedmode(0); feedmode(\"UPM\"); feedmode(2);", "G93\nG94\nG95\n"},
    Written{"spindle(100); spindle(-50); spindle(0); spindlespeed(7);", "S100.000\nM3\nS50.000\nM4\nM5\nS7.000\n"},
    Written{"coolant(0); coolant(1); coolant(\"flood\"); coolant(3);", "M9\nM7\nM8\nM7\nM8\n"},
    Written{"toolchange(3); toolchange(4, 1);", "T3\nM6\nT4\nM6\nG43 H4\n"}, Written{"dwell(0.5);", "G4 P0.500\n"},
    Written{"pathmode(1); pathmode(0); pathmode(0.1, 0.2); pathmode(1in, undef());",
            "G61\nG64\nG64 P0.100 Q0.200\nG64 P25.400\n"},
    Written{"pause(); pause(1); pause(0);", "M0\nM1\nM0\n"},
    Written{"literal(plane(undef()), plane(1), plane(PLANE_QUERY));", "G18\n001"},
    Written{"comment(\"x=\", 1mm);", "(x=1mm)\n"}, Written{"svg_closepath(); layerstack(\"a\"); layer(1);", ""},
    Written{"fixpos_store(0); goto([1, 2, 3]); fixpos_restore(0, [-, -, 9]); literal(to_string(position()));",
            "G28.1\nG0 X1.000 Y2.000 Z3.000\nG28 Z9.000\n[0.000mm,0.000mm,0.000mm]"},
    Written{"fixpos_set(1, [1, 2, 3]); fixpos_restore(1); literal(to_string(position()));",
            "G30\n[1.000mm,2.000mm,3.000mm]"},
    Written{"drill([1, 2, -3], 5, 1); drill([2, 2, -3], 5, 1, 4); literal(to_string(position()));",
            "G73 X1.000 Y2.000 Z-3.000 R5.000 Q1.000\nG73 X2.000 Y2.000 Z-3.000 R5.000 Q1.000 L4\n"
            "[2.000mm,2.000mm,5.000mm]"}));

struct Refused {
  const char* program;
  const char* said;
};
class Refusal : public testing::TestWithParam<Refused> {};
TEST_P(Refusal, SaysWhy) {
  EXPECT_EQ(said_by(GetParam().program), GetParam().said);
}

INSTANTIATE_TEST_SUITE_P(Machine, Refusal, testing::Values(
    Refused{"goto([-, -]);", "error: All coordinates in goto() undefined"},
    Refused{"move({});", "warning: move(): Vectorlist contains no vectors"},
    Refused{"goto(1);", "error: goto(): Argument must be a vector or a vectorlist"},
    Refused{"goto([-, -, -, 1mm]);", "warning: goto() argument 1 has incompatible distance units attached"},
    Refused{"goto([1deg]);", "warning: goto() argument 1 has incompatible angular units attached"},
    Refused{"goto([to_float(\"1e308\") * 100]);", "error: goto() coordinate X is not a finite number"},
    Refused{"position(10);", "error: position() argument 1 must be 1 to 9"},
    Refused{"relocate(1);", "error: relocate() argument 1 must be vector"},
    Refused{"arc_cw(1, 1);", "error: arc_cw(): First argument must be a vector"},
    Refused{"arc_cw([1, 0], 0.4);",
            "error: arc_cw() radius (4.000000e-01) is less than two times distance from start to end (D=-9.000000e-02)"},
    Refused{"arc_cw([0, 0], 1);", "error: arc_cw() distance between start and endpoint zero (0.000000e+00)"},
    Refused{"arc_cw([-, -, 5], 5);", "error: arc_cw() in plane PLANE_XY is missing both plane coordinates"},
    Refused{"arc_cw([10, 0], 5, 0);", "error: arc_cw() Number of turns must be >= 1"},
    Refused{"circle_cw([1]);", "error: circle_cw() in plane PLANE_XY is missing plane coordinates"},
    Refused{"circle_cw(\"a\");", "error: circle_cw(): First argument neither vector nor scalar"},
    Refused{"circle_cw(1);", "error: circle_cw() requires two arguments"},
    Refused{"circle_cw([0, 0]);", "error: circle_cw() radius is zero"},
    Refused{"drill([1, 2], 5, 1);", "error: Drill-cycle must have a scalar Z-coordinate in first argument"},
    Refused{"drill([1, 2, 3], 5, 0);", "error: drill() argument 3 must be > 0"},
    Refused{"drill([1, 2, 3], 5, 1, 0);", "error: drill() argument 4 must be > 0"},
    Refused{"drill([1, 2, -1000000], 5, 0.001);", "error: drill() makes too many pecks"},
    Refused{"feedrate(60deg);", "warning: feedrate() argument 1 has incompatible angular units attached"},
    Refused{"feedrate(to_float(\"inf\"));",
            "warning: to_float(): Value evaluates to +Inf|error: feedrate() argument 1 is not finite"},
    Refused{"feedmode(5);", "error: Feed mode must be one of 0 (\"inverse\"), 1 (\"upm\") or 2 (\"upr\")"},
    Refused{"coolant(7);",
            "error: Coolant must be on of: 0 (\"off\"), 1 (\"mist\"), 2 (\"flood\") or 3 (\"mist+flood\")"},
    Refused{"spindlespeed(-1);", "error: Spindle speed cannot be negative (-1.000000)"},
    Refused{"toolchange(-1);", "error: Tool index must be >= 0"},
    Refused{"dwell(-1);", "error: Dwell cannot have negative seconds (-1.000000)"},
    Refused{"pathmode();", "error: pathmode(): expects one or two arguments"},
    Refused{"plane(5);",
            "error: plane() only accepts PLANE_XY (0), PLANE_XZ (1), PLANE_YZ (2) or strings \"XY\"|\"XZ\"|\"YZ\""},
    Refused{"fixpos_restore(0);", "warning: Position for G28 not previously set, tracking may be off"},
    Refused{"fixpos_set(0, 1);", "error: fixpos_set() argument 2 must be vector"},
    Refused{"fixpos_restore(0, 1);", "error: fixpos_restore() argument 2 must be vector"},
    Refused{"layerstack(\"a b\");", "error: layerstack() invalid characters in layer name 1"},
    Refused{"layerstack(\"a\", \"a\");", "error: layerstack() layer 'a' already exists"},
    Refused{"layerstack(1);", "error: layerstack() argument 1 must be string"},
    Refused{"layer(1);", "error: layer() index 1 out of range [1..0]"},
    Refused{"layer(\"n\");", "warning: layer() layer 'n' not found, added to the stack"}));

TEST(GcmcBuiltins, ADrawingHasOnePlane) {
  GcmcOptions options = bare();
  options.target = GcmcTarget::dxf;
  EXPECT_EQ(said_by("plane(PLANE_XZ);", options), "warning: plane() other than PLANE_XY has no meaning in a drawing");
  EXPECT_EQ(said_by("spindlespeed(100);", options), "");
}

// ---- typeset

TEST(GcmcTypeset, BlankHasTheWidthOfTheLanguage) {
  EXPECT_EQ(value_of("typeset(\" \", FONT_HSANS_1)"), "{[-,-,1.000],[0.000,0.000,-],[0.571,0.000,-],[0.571,0.000,-]}");
  EXPECT_EQ(value_of("typeset(\"\", FONT_HTIMES)"), "{[-,-,1.000],[0.000,0.000,-],[0.000,0.000,-]}");
}

TEST(GcmcTypeset, MissingGlyphsAndFontsAreSaid) {
  EXPECT_EQ(value_of("typeset(\"\\x07\", FONT_HSANS_1)"),
            "warning: Glyph for codepoint 0x00000007 not available, replacing with ' '|"
            "{[-,-,1.000],[0.000,0.000,-],[0.571,0.000,-],[0.571,0.000,-]}");
  EXPECT_EQ(value_of("typeset(\"A\", 99)"), "warning: Font id 0x00000063 not found|<undef>");
  EXPECT_EQ(value_of("typeset(1, 1)"), "error: typeset() argument 1 must be string");
  EXPECT_EQ(value_of("typeset(\"A\", 1.0)"), "error: typeset() argument 2 must be integer");
  EXPECT_EQ(run("typeset(\"\\x07\", 1);").messages.front().code, Code::gcmc_glyph);
}

TEST(GcmcTypeset, CapitalsAreOneHighInEveryFont) {
  for (const char* font : {"FONT_HSANS_1", "FONT_HSANS_2", "FONT_HSCRIPT_1", "FONT_HSCRIPT_2", "FONT_HTIMES",
                           "FONT_HSANS_1_RS", "FONT_HTIMES_BOLD", "FONT_HTIMES_ITALIC", "FONT_HTIMES_ITALIC_BOLD"}) {
    const std::string program = std::string("top = 0.0; foreach(typeset(\"X\", ") + font +
                                "); v) { if(!isundef(v.y) && v.y > top) { top = v.y; } } message(top);";
    const auto ran = run(program);
    ASSERT_EQ(ran.said.size(), 1u) << font;
    EXPECT_EQ(ran.said[0], "Runtime message(): 1.000") << font;
  }
}

TEST(GcmcTypeset, AccentsAreComposed) {
  EXPECT_EQ(value_of("count(typeset(\"\xC3\xA9\", 1)) > count(typeset(\"e\", 1))"), "1");
  EXPECT_EQ(value_of("typeset(\"\xC3\xA9\", 1)[-1].x == typeset(\"e\", 1)[-1].x"), "1");
}

}  // namespace
}  // namespace kerf

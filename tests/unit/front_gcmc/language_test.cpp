// The language: words, statements, scopes, operators, and each of its errors.
#include <gtest/gtest.h>

#include "base/codes/gcmc.h"
#include "gcmc_run.h"

namespace kerf::test {
namespace {

class Expression : public ValueTest {};
TEST_P(Expression, HasTheValue) { expect_value(); }

const std::vector<Case> kLiterals{
    {"010", "10"},
    {"0x1F", "31"},
    {"1., .5, 1e3, 1.5e-3", "1.0000.5001000.0000.002"},
    {"5mm, 5 in, 5\n/* far */ deg, 1rad", "5mm5in5deg1rad"},
    {"200mil", "0.200in"},
    {"\"a\\x417\\101\\n\\\"\\q\\\\\"", "aA7A\n\"q\\"},
    {"\"con\" \"cat\"", "concat"},
    {"\"two\\\n   lines\"", "twolines"},
    {"count(\"\\xc3\\xa9\")", "1"},
    {"[1, -, 2.5in]", "[1,-,2.500in]"},
    {"{[1], [2],}", "{[1],[2]}"},
    {"{}, []", "{}[]"},
    {"-0.0", "-0.000"},
};
INSTANTIATE_TEST_SUITE_P(Literals, Expression, testing::ValuesIn(kLiterals));

const std::vector<Case> kPrecedence{
    {"5&3|8", "9"},      {"1|2^3", "1"},       {"1<<2+1", "8"}, {"!0==1", "1"},
    {"- - 3", "3"},      {"2+3*4-1", "13"},    {"7-2-1", "4"},  {"1 ? 2 : 0 ? 3 : 4", "2"},
    {"1 < 2 == 1", "1"}, {"1 || 0 && 0", "1"}, {"-2*-3", "6"},  {"[1, 2][1] + 1", "3"},
    {"!!5", "1"},
};
INSTANTIATE_TEST_SUITE_P(Precedence, Expression, testing::ValuesIn(kPrecedence));

const std::vector<Case> kUnits{
    {"1mm+1in", "26.400mm"},
    {"1in+1mm", "1.039in"},
    {"1+1mm", "2mm"},
    {"2mm*3mm", "6mm"},
    {"10mm/2mm", "5"},
    {"10/2mm", "5mm"},
    {"10mm/4", "2mm"},
    {"25.4mm/1in", "1.000"},
    {"-7/2", "-3"},
    {"-7%3", "-1"},
    {"10.5%3mm", "1.500mm"},
    {"1deg+1rad", "58.296deg"},
    {"180deg/1rad", "3.142"},
    {"1mm + 1deg",
     "warning: Operation '+': LHS has distance units and RHS has "
     "angular units, RHS units ignored|2mm"},
    {"4deg / 2mm",
     "warning: Operation '/': LHS has angular units and RHS has "
     "distance units, RHS units ignored|2"},
};
INSTANTIATE_TEST_SUITE_P(Units, Expression, testing::ValuesIn(kUnits));

const std::vector<Case> kVectors{
    {"[1]+[10,20,30]", "[11,-,-]"},
    {"[1]+|[2,3]", "[3,3]"},
    {"[-,1]+[5,5]", "[-,6]"},
    {"[5]-|[1,2]", "[4,-2]"},
    {"[5]-[1,2]", "[4,-]"},
    {"{[1],[2]}+[10,20]", "{[11,-],[12,-]}"},
    {"{[1,2]}-[1]", "{[0,2]}"},
    {"{[1]}+{[2]}", "{[1],[2]}"},
    {"2*[1,-]", "[2,-]"},
    {"{[3,6]}/3", "{[1,2]}"},
    {"[7,8]%3", "[1,2]"},
    {"[1,2]*[3,4]", "11.000"},
    {"[1,2]*[3mm]", "3.000mm"},
    {"[1mm,2in]*[3mm,4in]", "5164.280mm"},
    {"-{[1,-2]}", "{[-1,2]}"},
    {"[1,-,3]|[9,8]", "[1,8,3]"},
    {"[1]|[9,8,-,7]", "[1,8,-,7]"},
    {"[1,-,3]&[9,8,-,4]", "[9,-,3,-]"},
    {"[1,2,3]<<1", "[2,3]"},
    {"[1,2]>>2", "[-,-,1,2]"},
    {"{[1]}>>2", "{[],[],[1]}"},
    {"{[1],[2]}<<1", "{[2]}"},
    {"[1]<<5", "[]"},
    {"[1,2,3,4,5]*2", "[2,4,6,8,10]"},
    {"[1,2,3,4]+[1]", "[2,2,3,4]"},
};
INSTANTIATE_TEST_SUITE_P(Vectors, Expression, testing::ValuesIn(kVectors));

const std::vector<Case> kUndefined{
    {"undef()+1", "<undef>"},      {"1+undef()", "1"},
    {"undef()-1", "<undef>"},      {"1-undef()", "1"},
    {"undef()*2", "<undef>"},      {"undef()+|1", "1"},
    {"undef()-|1", "-1"},          {"1+|undef()", "1"},
    {"undef()<<1", "<undef>"},     {"[1]+undef()", "[1]"},
    {"undef()+|[1]", "[1]"},       {"undef()-|[1]", "[-1]"},
    {"undef()-|{[1]}", "{[-1]}"},  {"undef() ? 1 : 2", "2"},
    {"\"x\" + undef() + 1", "x1"}, {"\"x\" +| undef()", "x<undef>"},
};
INSTANTIATE_TEST_SUITE_P(Undefined, Expression, testing::ValuesIn(kUndefined));

const std::vector<Case> kBits{
    {"~5", "-6"},
    {"6^3", "5"},
    {"1.5<<1", "3.000"},
    {"6.0>>1", "3.000"},
    {"-8>>1", "-4"},
    {"~5mm", "warning: Binary not target has units associated, ignored|-6"},
    {"~5.0", "warning: Binary not target should be integer, converted|-6"},
    {"5.0 & 3", "warning: Binary '&' operator, left-hand-side, should be integer, converted|1"},
    {"1 | 2mm", "warning: Binary '|' operator, right-hand-side, has units associated, ignored|3"},
    {"[1] << 2in", "warning: Operation '<<': Shift count has units associated, ignored|[]"},
};
INSTANTIATE_TEST_SUITE_P(Bits, Expression, testing::ValuesIn(kBits));

const std::vector<Case> kComparisons{
    {"1mm < 1in", "1"},
    {"1in == 25.4mm", "1"},
    {"1 == 1.0", "1"},
    {"0.1+0.2 == 0.3", "1"},
    {"\"abc\" < \"abd\"", "1"},
    {"[1,-] == [1,-]", "1"},
    {"[1] != [2]", "1"},
    {"2 >= 2", "1"},
    {"1 != 1", "0"},
    {"2147483647 + 1 < 0", "1"},
    {"1in == 25.4", "warning: Possible unit mismatch; comparing units UNIT_IN with none|1"},
    {"1mm == 1deg",
     "warning: Unit mismatch in comparison, converted to <none> (LHS=UNIT_MM, RHS=UNIT_DEG)|1"},
    {"[1] != [1,2]", "warning: Comparison of vectors with unequal nr. of entries is always false|0"},
    {"[1] < [2]", "warning: Vectors can only be compared for equality, result is always false|0"},
    {"undef() == undef()", "warning: Comparison of VAL_UNDEF with VAL_UNDEF, result is always false|0"},
};
INSTANTIATE_TEST_SUITE_P(Comparisons, Expression, testing::ValuesIn(kComparisons));

const std::vector<Case> kTruth{
    {"1e-13 || 0", "0"}, {"\"\" || 0", "0"}, {"\"a\" && 1", "1"}, {"[] || 0", "0"},
    {"[0] && 1", "1"},   {"{} || 0", "0"},   {"!undef()", "1"},   {"0.0 || 0.5", "1"},
};
INSTANTIATE_TEST_SUITE_P(Truth, Expression, testing::ValuesIn(kTruth));

const std::vector<Case> kElements{
    {"[1,2,3][-1]", "3"},
    {"{[1],[2]}[-1]", "[2]"},
    {"\"hello\"[1]", "e"},
    {"[1,2,3].z", "3"},
    {"[1,2,3][5]", "warning: Vector index out of range (5 outside [-3..2])|<undef>"},
    {"[][0]", "warning: Vector index out of range (vector has no entries)|<undef>"},
    {"{[1]}[1]", "warning: Vector index out of range (1 outside [-1..0])|[]"},
    {"[1][0mm]", "warning: Index of [] operator has units associated, ignored|1"},
};
INSTANTIATE_TEST_SUITE_P(Elements, Expression, testing::ValuesIn(kElements));

TEST(GcmcLanguage, ConstantsOfTheLanguage) {
  EXPECT_EQ(
      value_of(
          "PLANE_XY, PLANE_XZ, PLANE_YZ, COOLANT_ALL, FEEDMODE_UPR, FONT_HTIMES_ITALIC_BOLD, PLANE_QUERY"),
      "01232773<undef>");
  EXPECT_EQ(
      value_of("GCMC_VERSION == (GCMC_VERSION_MAJOR*1000 + GCMC_VERSION_MINOR)*1000 + GCMC_VERSION_POINT"),
      "1");
  EXPECT_EQ(value_of("__global_position"),
            "warning: Using internal variable '__global_position' strongly discouraged|"
            "[0.000mm,0.000mm,0.000mm,0.000rad,0.000rad,0.000rad]");
}

class Runs : public testing::TestWithParam<Case> {};
TEST_P(Runs, WithTheMessages) { EXPECT_EQ(output_of(GetParam().given), GetParam().wanted); }

const std::vector<Case> kStatements{
    {"if(0) {} elif(0) {} else { message(\"E\"); }", "E"},
    {"for(i = 0; i < 3; i++) { if(i == 1) { continue; } message(i); }", "0|2"},
    {"for(;1;) { break; } i = 0; while(i < 2) { i++; } message(i);", "2"},
    {"i = 0; do { i++; if(i < 5) { continue; } } while(i < 3); message(i);", "3"},
    {"repeat(3; i) { message(i); } message(i);", "1|2|3|3"},
    {"repeat(-2; i) { message(i); }", "-1|-2"},
    {"repeat(0) { message(1); }", ""},
    {"foreach([5, -]; v) { message(v); }", "5|<undef>"},
    {"l = {[1], [2]}; foreach(l; v) { v.x = 9; l += {[3]}; } message(l, v);", "{[1],[2],[3],[3]}[9]"},
    {";;; x = y = 3; message(x, y);", "33"},
    {"a =+ 2; message(a); a =- 2; message(a);", "2|-2"},
    {"a = 2; message(-a++, a); message(++a, --a);", "-23|43"},
    {"return 3; message(1);", ""},
    {"foreach({[1]}; v) { return 5; }", ""},
};
INSTANTIATE_TEST_SUITE_P(Statements, Runs, testing::ValuesIn(kStatements));

const std::vector<Case> kFunctions{
    {"function f(n) { if(n <= 1) { return 1; } return n*f(n-1); } message(f(10));", "3628800"},
    {"f = 3; function f() { return 4; } message(f, f());", "34"},
    {"function f(&a) { a[0] = [7]; a += {[8]}; } l = {[1,2]}; f(l); message(l);", "{[7],[8]}"},
    {"function f(&a) { g(a); } function g(&b) { b++; } x = 1; f(x); message(x);", "2"},
    {"function f(a, b = 2, c = a0) { return a + b + c; } a0 = 10; message(f(1), \" \", f(1, 1, 1));", "13 3"},
    {"function f() { return; } message(f());", "<undef>"},
    {"function f() {} f();", ""},
    {"function f(v) { v = 3; w = 4; return w; } v = 1; message(f(v), v, isdefined(\"w\"));", "410"},
};
INSTANTIATE_TEST_SUITE_P(Functions, Runs, testing::ValuesIn(kFunctions));

const std::vector<Case> kScopes{
    {"x = 5; function f() { x = 6; local x = 7; message(x); } f(); message(x);", "7|6"},
    {"function o() { local q = 5; i(); } function i() { message(isdefined(\"q\")); } o();", "0"},
    {"g = 1; function f() { g += 2; g.x; } message(g);", "error: Statement has no effect"},
    {"g = [1]; function f() { g.y = 2; g[0]++; g *= 10; } f(); message(g);", "[20,20]"},
    {"function f() { i = 5; return i; } message(f(), isdefined(\"i\")); i = 1; message(f(), i);", "50|55"},
    {"function f() { repeat(2) { local a = 1; a += 1; message(a); } } f();",
     "2|warning: Local scope variable 'a' already available in local scope|3"},
    {"local a = 2; message(a);",
     "warning: Locally scoped variable 'a' setting without local scope, adding to "
     "global scope|2"},
    {"repeat(2) { local a = 1; a += 1; message(a); }",
     "warning: Locally scoped variable 'a' setting without local scope, adding to global scope|2|"
     "warning: Locally scoped variable 'a' setting without local scope, adding to global scope|"
     "warning: Local scope variable 'a' already available in local scope|3"},
    {"function f() { const C = 3; return C; } message(f(), f());", "33"},
    {"function f() { const C = 3; } function g() { v = [1]; v.y = 2; return v; } f(); message(g());",
     "[1,2]"},
    {"function f() { foreach({[1]}; v) {} return isdefined(\"v\"); } message(f(), isdefined(\"v\"));", "10"},
};
INSTANTIATE_TEST_SUITE_P(Scopes, Runs, testing::ValuesIn(kScopes));

const std::vector<Case> kAssignments{
    {"v = []; v[3] = 7; message(v); v.w = 9; message(v);", "[-,-,-,7]|[-,-,-,7,-,-,-,-,9]"},
    {"l = {[1], [2], [3]}; l[-5] = [9]; message(l);", "{[9],[2],[3],[],[]}"},
    {"l = {[1, 2]}; l[0].y = 9; l[0][0] += 1; l[1].x = 3; message(l);", "{[2,9],[3]}"},
    {"a = [1, 2]; b = a; b[0] = 9; message(a, b);", "[1,2][9,2]"},
    {"a = {[1], [2]}; a += a; message(a); s = \"ab\"; s += s; message(s);", "{[1],[2],[1],[2]}|abab"},
    {"a = {}; a += [1, 2]; message(a); a += {[1, 2]}; message(a); a += [1]; message(a);",
     "{}|{[1,2]}|{[2,2]}"},
    {"x = undef(); x += 1; message(x); x +|= 3mm; message(x);", "<undef>|3mm"},
    {"s = \"a\"; s += 5mm; message(s);", "a5mm"},
    {"x = 1.5; x <<= 1; message(x);", "3.000"},
    {"x = 7; x %= 4; x |= 8; x &= 10; x ^= 1; x -= 1; x *= 3; x /= 2; message(x);", "15"},
    {"v = [1, 2]; v.x++; --v.y; message(v, v.x++, v);", "[2,1]2[3,1]"},
    {"l = {[1, 2], [3, 4]}; l[1][0]++; --l[0][1]; message(l);", "{[1,1],[4,4]}"},
    {"l = {[1, 2], [3, 4]}; i = 0; message(l[i][1]--, ++l[1][i], l);", "24{[1,1],[4,4]}"},
    {"i = 1; message(i + (i = 5), i);", "65"},
    {"v = [1, 2, 3]; v = [v.z, v.y, v.x]; message(v);", "[3,2,1]"},
    {"x = 1; x = x ? x + 1 : x; message(x); x = x && x; message(x);", "2|1"},
    {"\"a\"; x = 1;", "error: Statement has no effect"},
};
INSTANTIATE_TEST_SUITE_P(Assignments, Runs, testing::ValuesIn(kAssignments));

const std::vector<Case> kAppending{
    {"l = {}; function f(v) { l += {v}; l = l + {[v.x, 2]}; } f([1]); f([3]); message(l);",
     "{[1],[1,2],[3],[3,2]}"},
    {"function f(&k) { k = k + {[9, count(k)]}; } l = {[1]}; f(l); m = l; f(l); message(l, m);",
     "{[1],[9,1],[9,2]}{[1],[9,1]}"},
    {"v = [1]; l = {[2]}; m = l + {v}; l += {v}; v.x = 5; message(m, l, v);", "{[2],[1]}{[2],[1]}[5]"},
    {"x = 2; l = {[1]}; l = l + (l + {[x]}); message(l);", "{[1],[1],[2]}"},
    {"l = {[1]}; function f() { l += {[3]}; return [2]; } l = l + {f()}; message(l);", "{[1],[2]}"},
    {"x = 1; s = \"a\"; s += {[x]}; message(s);", "a{[1]}"},
    {"x = 1; u = undef(); u += {[x]}; message(u); u +|= {[x]}; message(u);", "<undef>|{[1]}"},
    {"x = 1; l = {}; l += {x};", "error: Vectorlist entries must be vectors"},
    {"x = [1]; x += {x};",
     "error: Scalars and vectors can only be added to scalars vectors and vector lists "
     "(lv=VAL_VECTOR, rv=VAL_VECTORLIST)"},
    {"function f(k) { foreach(k; v) { return v; } } l = {[1]}; repeat(2) { l += {f(l)}; } message(l);",
     "{[1],[1],[1]}"},
};
INSTANTIATE_TEST_SUITE_P(Appending, Runs, testing::ValuesIn(kAppending));

// A small integer on the right is part of the instruction; the rules are the same.
const std::vector<Case> kSmallIntegers{
    {"x = 5mm; x = x + 1; message(x, x - 2, x * 3, x / 4, x % 4);", "6mm4mm18mm1mm2mm"},
    {"x = 2147483647; x = x + 1; message(x); x = x - 1; message(x * 2);", "-2147483648|-2"},
    {"x = -2147483647 - 1; message(x / -1, x % -1);", "-21474836480"},
    {"x = [2, 4]; message(x * 2, x / 2, x % 3);", "[4,8][1,2][2,1]"},
    {"x = 1.5; message(x + 1, x - 1, x * 2, x / 2);", "2.5000.5003.0000.750"},
    {"x = \"a\"; message(x + 1);", "a1"},
    {"x = undef(); message(x + 1, x * 2);", "<undef><undef>"},
    {"x = {[1]}; message(x - 1);",
     "error: Only scalars/vectors can be subtracted from scalars/vectors (lv=VAL_VECTORLIST, rv=VAL_INT)"},
    {"x = 7; message(x / 0);", "error: Divide by zero"},
    {"x = 7; message(x % 0);", "error: Modulo by zero"},
    {"message(y + 1);", "error: Variable 'y' undefined"},
    {"x = 2; message(x < 3, x > 3, x <= 2, x >= 3, x == 2, x != 2);", "101010"},
    {"x = 2.5; message(x < 3, x > 3, x <= 2, x >= 3, x == 2, x != 2);", "100001"},
    {"x = 2; if(x < 3) { message(1); } if(!(x < 3)) { message(2); } while(x != 4) { x++; } message(x);",
     "1|4"},
    {"x = 2mm; if(x < 3) { message(1); }",
     "warning: Possible unit mismatch; comparing units UNIT_MM with none|1"},
    {"x = \"a\"; if(x == 1) {}", "warning: Comparison of VAL_STRING with VAL_INT, result is always false"},
};
INSTANTIATE_TEST_SUITE_P(SmallIntegers, Runs, testing::ValuesIn(kSmallIntegers));

const std::vector<Case> kRuntimeErrors{
    {"message(y);", "error: Variable 'y' undefined"},
    {"y += 1;", "error: Variable 'y' undefined"},
    {"v[0] = 1;", "error: Variable 'v' undefined"},
    {"f();", "error: Function 'f' not found"},
    {"f(); function f() {}", "error: Function 'f' not found"},
    {"f(1); function f() {}", "error: Function 'f' not found"},
    {"function f() {} x = f();",
     "error: Function call 'f()' did not return a value, but is used in assignment or calculation"},
    {"function f(a, b) {} f(1);", "error: Incorrect number of arguments in call to 'f'"},
    {"function f(&a) {} f(1);", "error: f argument 1: Cannot pass expression by reference"},
    {"function f(&a) {} f(zz);", "error: Variable 'zz' undefined"},
    {"repeat(2) { function g() {} }", "error: Function 'g' already defined"},
    {"const A = 1; const A = 2;", "error: Constant 'A' already defined"},
    {"A = 1; const A = 2;", "error: Constant 'A' already defined as variable"},
    {"const C = 1; C = 2;", "error: Attempt to assign to const variable 'C'"},
    {"const C = 1; C++;", "error: Attempt to assign to const variable 'C'"},
    {"const C = 1; C += 1;", "error: Attempt to assign to const variable 'C'"},
    {"const C = [1]; C.x = 5;", "error: Attempt to assign to const variable 'C'"},
    {"const C = 1; foreach({[1]}; C) {}", "error: Attempt to assign to const variable 'C'"},
    {"const C = 1; function f(&a) { a = 2; } f(C);",
     "error: Attempt to assign to const variable 'a' (from 'C')"},
    {"PLANE_XY = 3;", "error: Attempt to assign to const variable 'PLANE_XY'"},
    {"if(1) { continue; }", "error: Unexpected break or continue"},
    {"x = 1%0;", "error: Modulo by zero"},
    {"x = 1/0;", "error: Divide by zero"},
    {"x = 1.0%0;", "error: Modulo by zero"},
    {"x = 1/0.0;", "error: Divide by zero (|val| < 1.000000e-12)"},
    {"x = [1, [2]];", "error: Vector entries must be scalar"},
    {"x = [undef(), 1];", "error: Vector entries must be scalar"},
    {"x = [1, 2, 3, undef()];", "error: Vector entries must be scalar"},
    {"x = {1};", "error: Vectorlist entries must be vectors"},
    {"repeat([1]) {}", "error: Repeat's source must be scalar"},
    {"repeat(1.5) {}",
     "warning: Repeat's source is floating point and has a non-integer fraction, truncated to "
     "integer"},
    {"repeat(1mm) {}", "warning: Repeat's source has units associated, ignored"},
    {"foreach(1; v) {}", "error: Foreach's source must be vector or vectorlist"},
};
INSTANTIATE_TEST_SUITE_P(RuntimeErrors, Runs, testing::ValuesIn(kRuntimeErrors));

const std::vector<Case> kTypeErrors{
    {"x = -\"a\";",
     "error: Scalars and vectors can only be multiplied by scalars and vectors (lv=VAL_STRING, "
     "rv=VAL_INT)"},
    {"x = \"a\" - \"b\";",
     "error: Only scalars/vectors can be subtracted from scalars/vectors (lv=VAL_STRING, "
     "rv=VAL_STRING)"},
    {"x = 1 + [1];",
     "error: Scalars and vectors can only be added to scalars vectors and vector lists "
     "(lv=VAL_INT, rv=VAL_VECTOR)"},
    {"x = {[1]} - {[1]};",
     "error: Only scalars/vectors can be subtracted from scalars/vectors "
     "(lv=VAL_VECTORLIST, rv=VAL_VECTORLIST)"},
    {"x = [1]/[2];",
     "error: Scalars, vectors and vectorlists can only be divided by scalars (lv=VAL_VECTOR, "
     "rv=VAL_VECTOR)"},
    {"x = [1]%[2];",
     "error: Scalars, vectors and vectorlists can only be taken modulo by scalars (lv=VAL_VECTOR, "
     "rv=VAL_VECTOR)"},
    {"x = [1]^[2];", "error: Operator '^' cannot be applied to these types (lv=VAL_VECTOR, rv=VAL_VECTOR)"},
    {"x = ~[1];", "error: Binary not target must be scalar (VAL_VECTOR)"},
    {"x = 1 << -1;", "error: Operation '<<': Shift count is negative"},
    {"x = 1 << 32;", "error: Operation '<<': Shift count too large"},
    {"x = [1] >> 2000000000;", "error: Operation '>>': Shift count too large"},
    {"x = [1,2][[0]];", "error: Index of [] operator is not scalar"},
    {"x = 5; y = x[0];", "error: Only vectors, vectorlists and strings can be indexed (VAL_INT)"},
    {"s = \"abc\"; s[0] = \"d\";", "error: Strings cannot be indexed as lvalues"},
    {"x = 1; x[0] = 1;", "error: Only vectors and vectorlists can be indexed as lvalues (VAL_INT)"},
    {"v = [1]; v[0] = [1];", "error: Vector entries must be scalar (VAL_VECTOR)"},
    {"l = {[1]}; l[0] = 1;", "error: Vectorlist entries must be vectors (VAL_INT)"},
    {"v = [1]; v[2000000000] = 1;", "error: Index 2000000000 is too large"},
    {"l = {[1]}; l[0].x.y = 1;", "error: Lvalue expected"},
    {"v = [1]; v[3] += 1;", "warning: Vector index out of range (3 outside [-1..0])|error: Lvalue expected"},
    {"v = [1]; v[3]++; message(v);",
     "warning: Vector index out of range (3 outside [-1..0])|"
     "warning: Increment on non-scalar (VAL_UNDEF) has no effect|[1]"},
    {"s = \"a\"; s--;", "warning: Decrement on non-scalar (VAL_STRING) has no effect"},
};
INSTANTIATE_TEST_SUITE_P(TypeErrors, Runs, testing::ValuesIn(kTypeErrors));

const std::vector<Case> kSyntaxErrors{
    {"1+2;", "error: Statement has no effect"},
    {"x;", "error: Statement has no effect"},
    {"x = 1\n", "error: ';' expected"},
    {"while(1) x=1;", "error: '{' expected"},
    {"if (1) message(\"x\");", "error: '{' expected"},
    {"do { i=0; } while(0)\n", "error: ';' expected"},
    {"x = 1; x.q = 2;", "error: Index can only be an axis name"},
    {"\"abc\"[0]=\"d\";", "error: Lvalue not a variable, cannot be dereferenced"},
    {"5 = 3;", "error: Lvalue not a variable, cannot be dereferenced"},
    {"(x) = 3;", "error: Lvalue not a variable, cannot be dereferenced"},
    {"x = 3 3;", "error: ';' expected|error: Statement has no effect"},
    {"[1]++;", "error: Statement post-increment on a constant has no effect|error: Statement has no effect"},
    {"--3;", "error: Statement pre-decrement on a constant has no effect|error: Statement has no effect"},
    {"function ff(){} function ff(){}", "error: Function name 'ff' is already defined"},
    {"function sin(){}", "error: Function name 'sin' is reserved as built-in function"},
    {"function f() { function g() {} }", "error: Function in functions not supported"},
    {"function f(a = 1, b) {}",
     "error: Argument 'b' must have a default value because a previous argument has one"},
    {"function f(&a = 1) {}", "error: Reference argument 'a' cannot have a default"},
    {"function f(a, a) {}", "error: Argument name 'a' is used twice"},
    {"const A;", "error: '=' expected"},
    {"include(1);", "error: Name of the file expected"},
    {"include(\"nofile.gcmc\");", "error: Include file 'nofile.gcmc' cannot be found"},
    {"for(local i = 0; i < 2; i++) {}",
     "error: ';' expected|error: Statement has no effect|error: ';' expected|error: Syntax "
     "error|error: Syntax error"},
    {"{ x = 1; }", "error: Syntax error"},
    {"mm = 3;", "error: Syntax error"},
    {"foreach({}; in) {}", "error: Variable name expected"},
    {"if(x=1) {}", "warning: Assignment in boolean expression may be an inadvertent error, use () to force"},
    {"if((x=1)) {}", ""},
    {"x = ; y = ;",
     "error: Expression expected after '='|error: Expression expected "
     "after '='"},
    {"__global_offset = [1];",
     "warning: Using internal variable '__global_offset' strongly discouraged|"
     "error: Assigning to read-only variable '__global_offset' not allowed"},
};
INSTANTIATE_TEST_SUITE_P(SyntaxErrors, Runs, testing::ValuesIn(kSyntaxErrors));

const std::vector<Case> kWords{
    {"x = 0xZZ;\nx = 2;", "error: Bad hexadecimal number '0xZZ;'"},
    {"x = 0X10;", "error: ';' expected|error: Statement has no effect"},
    {"y = 1e;",
     "error: Bad floating point number '1e', missing exponent magnitude|"
     "error: Expression expected after '='"},
    {"y = 1e999;", "error: Number '1e999' is too large|error: Expression expected after '='"},
    {"z = \"a\\400\";",
     "error: Character constant out of range|"
     "warning: Skipping embedded UTF-8 NUL embedding 2/1"},
    {"w = \"\\x4\";", "error: Invalid hex escape sequence '\\x4'"},
    {"q = \"\\0\";",
     "error: Embedded '\\0' character not allowed|"
     "warning: Skipping embedded UTF-8 NUL embedding 1/0"},
    {"q = \"\\1017\";", "error: Bad escape sequence"},
    {"q = \"\\xff\";", "error: String is not valid UTF-8"},
    {"q = \"\\xc1\\x81\";", "warning: String has over-long UTF-8 sequences"},
    {"$", "error: Illegal character in text '$' (0x24)"},
    {"x = \"unterminated\n", "error: Unterminated string|fatal: Unexpected EOF"},
    {"x = \"unterminated", "fatal: Unexpected EOF"},
    {"x = \"a\" \"b;\ny = ;\n", "error: Unterminated string|error: Expression expected after '='"},
    {"message(\"abc);\ny = \"d;\nz = ;\n",
     "error: Unterminated string|error: Unterminated string|error: Expression expected after '='"},
    {"y = [\"abc];\n}\n", "error: Unterminated string|error: Syntax error"},
    {"/* no end", "fatal: Unexpected EOF"},
    {"x = \"a\" \n \"b\";", "error: ';' expected|error: Statement has no effect"},
    {"x = 3000000000; message(x);",
     "warning: Integer '3000000000' does not fit 32 bits and becomes -1294967296|"
     "-1294967296"},
    {"x = 0x1ffffffff; message(x);", "warning: Hexadecimal number does not fit 32 bits, upper bits lost|-1"},
    {"\xEF\xBB\xBFmessage(1);", "1"},
};
INSTANTIATE_TEST_SUITE_P(Words, Runs, testing::ValuesIn(kWords));

TEST(GcmcLanguage, ReturnAtTheTopIsTheExitStatus) {
  EXPECT_EQ(run("return 3;").run.status, 3);
  EXPECT_EQ(run("return 2.9;").run.status, 2);
  EXPECT_EQ(run("return;").run.status, 0);
  EXPECT_EQ(run("error(1); return 3;").run.status, 1);
}

TEST(GcmcLanguage, ASyntaxErrorRunsNothing) {
  const auto ran = run("goto([1]); x = ;");
  EXPECT_EQ(ran.text, "");
  EXPECT_EQ(ran.run.status, 1);
  EXPECT_FALSE(ran.run.completed);
  EXPECT_TRUE(ran.diagnostics.has_errors());
}

TEST(GcmcLanguage, AllErrorsAreReportedInOneRun) {
  const auto ran = run("x = ;\ny = 3\nfunction f( {}\nfoo bar;\n");
  EXPECT_GE(ran.lines.size(), 4u);
  EXPECT_EQ(location_of(ran.messages[1]).line, 3u);
}

TEST(GcmcLanguage, LocationsAreThoseOfTheRealProgram) {
  const auto at = [](const char* program) {
    const auto where = location_of(run(program).messages.at(0));
    return std::to_string(where.line) + ":" + std::to_string(where.column);
  };
  EXPECT_EQ(at("x = 1%0;"), "1:8");
  EXPECT_EQ(at("\nf();"), "2:3");
  EXPECT_EQ(at("message(__undefined ? 1 : 2);"), "1:21");
  EXPECT_EQ(at("x = [1] << 2in;"), "1:15");
  EXPECT_EQ(at("repeat([1]) {}"), "1:1");
  EXPECT_EQ(at("message(~5mm);"), "1:11");
  EXPECT_EQ(at("1+2;"), "1:5");
}

struct Coded {
  const char* program;
  Code code;
};
class Codes : public testing::TestWithParam<Coded> {};
TEST_P(Codes, AreStable) {
  const auto ran = run(GetParam().program);
  ASSERT_FALSE(ran.messages.empty());
  EXPECT_EQ(ran.messages.front().code, GetParam().code);
  EXPECT_EQ(ran.diagnostics.list().front().code, GetParam().code);
}
const std::vector<Coded> kEach{
    {"$", codes::gcmc_word},
    {"/* no end", codes::gcmc_text_end},
    {"x;", codes::gcmc_syntax},
    {"include(\"no\");", codes::gcmc_include_missing},
    {"const A = 1; const A = 1;", codes::gcmc_defined_twice},
    {"if(x = 1) {}", codes::gcmc_suspicious},
    {"x = 3000000000;", codes::gcmc_number_wraps},
    {"x = \"\\xff\";", codes::gcmc_text_encoding},
    {"x = y;", codes::gcmc_unknown_name},
    {"x = 1 + [1];", codes::gcmc_type},
    {"x = 1mm + 1deg;", codes::gcmc_unit},
    {"x = 1/0;", codes::gcmc_range},
    {"x = sin();", codes::gcmc_arguments},
    {"PLANE_XY = 1;", codes::gcmc_constant},
    {"break;", codes::gcmc_control},
    {"goto([]);", codes::gcmc_geometry},
    {"typeset(\"a\", 99);", codes::gcmc_glyph},
    {"function f() { f(); } f();", codes::gcmc_limit},
    {"error(1);", codes::gcmc_script},
    {"plane(PLANE_XZ); arc_cw([10, -, 0], 6);", codes::gcmc_xz_arc},
    {"move([-, -, -, 1]);", codes::gcmc_bare_angle},
    {"include(\"tracepath_comp.inc.gcmc\");\n"
     "tracepath_comp({[0, 0], [0, 9], [9, 9], [9, 0]}, 2, TPC_RIGHT | TPC_CLOSED);",
     codes::gcmc_gouge},
    {"include(\"tracepath_comp.inc.gcmc\");\n"
     "tracepath_comp({[0, 0], [9, 0], [5, 2], [20, 0]}, 9, TPC_LEFT);",
     codes::gcmc_corner_left_out},
};
INSTANTIATE_TEST_SUITE_P(Each, Codes, testing::ValuesIn(kEach));

TEST(GcmcLanguage, HintsNameWhatWasMeant) {
  EXPECT_EQ(run("radius = 1; x = raduis;").messages.at(0).hint, "did you mean 'radius'?");
  EXPECT_EQ(run("feedrat(1);").messages.at(0).hint, "did you mean 'feedrate'?");
  EXPECT_EQ(run("forach(x; v) {}").messages.at(0).severity, Severity::error);
  EXPECT_EQ(run("whiel(1) {}").messages.at(0).hint, "did you mean 'while'?");
  EXPECT_EQ(run("x = 5 mmm;").messages.at(0).hint, "did you mean 'mm'?");
}

TEST(GcmcLanguage, UnitsThatDoNotFitAreExplained) {
  const auto hint = [](const char* program) { return run(program).messages.at(0).hint; };
  EXPECT_EQ(hint("x = 1mm + 90deg;"), "90deg is used as 90mm; use to_none() if that is intended");
  EXPECT_EQ(hint("x = 1mm < 5;"), "5 is compared as 5mm; write the unit");
  EXPECT_EQ(hint("x = 2.5 == 90deg;"), "2.5 is compared as 2.5deg; write the unit");
  EXPECT_EQ(hint("x = 1mm == 1rad;"), "a length and an angle are compared by their numbers only");
  EXPECT_EQ(hint("x = sin(2mm);"), "an angle is expected; 2mm is used as 2rad");
  EXPECT_EQ(hint("feedrate(5deg);"), "a length is expected; 5deg is used as 5mm");
}

TEST(GcmcLanguage, CallsAreNamedWithAnError) {
  const auto ran = run("function g() { x = 1/0; }\nfunction f() {\n  g();\n}\nf();");
  const Diagnostic& m = ran.messages.at(0);
  ASSERT_EQ(m.notes.size(), 2u);
  EXPECT_EQ(to_string(m.notes[0].where), "t.gcmc:3:5");
  EXPECT_EQ(m.notes[0].text, "in the call of g()");
  EXPECT_EQ(to_string(m.notes[1].where), "t.gcmc:5:3");
}

TEST(GcmcLanguage, DefinesRunFirst) {
  GcmcOptions options = bare();
  options.defines = {"depth=5mm", "n = 2"};
  EXPECT_EQ(value_of("depth * n", options), "10mm");
  options.defines = {"oops"};
  const auto ran = run("", options);
  EXPECT_EQ(to_string(ran.messages.at(0).where), "<cmd-line defines>:1:6");
}

TEST(GcmcErrors, AStringWithoutEndHidesNothing) {
  const Ran ran = run("x=1mm;\ny=\"abc;\n5=3;\nz.q=1;\n");
  std::vector<std::string> locations;
  for (const Diagnostic& m : ran.messages) locations.push_back(to_string(m.where));
  EXPECT_EQ(locations, (std::vector<std::string>{"t.gcmc:2:9", "t.gcmc:3:5", "t.gcmc:4:4"}));
  const Ran end = run("x=1;\ny=\"abc");
  EXPECT_EQ(to_string(end.messages.at(0).where), "t.gcmc:2:7");  // after the last character
}

// ---- limits

TEST(GcmcLimits, EndlessRecursionEnds) {
  EXPECT_EQ(messages_of("function f() { f(); } f();").substr(0, 34), "error: Calls are nested too deeply");
  EXPECT_EQ(run("function f() { f(); } f();").messages.at(0).code, codes::gcmc_limit);
}

TEST(GcmcLimits, EndlessLoopsEnd) {
  GcmcOptions options = bare();
  options.max_quiet_steps = 100'000;
  EXPECT_NE(messages_of("while(1) {}", options).find("an endless loop?"), std::string::npos);
  EXPECT_NE(
      messages_of("function f() { return f; } f = 0; for(;1;) { f(); }", options).find("an endless loop?"),
      std::string::npos);
  EXPECT_EQ(messages_of("repeat(1000000; i) { move([i]); }", options), "");  // output resets the count
}

TEST(GcmcLimits, OutputIsBounded) {
  GcmcOptions options = bare();
  options.max_output = 1 << 20;
  for (const char* program :
       {"\nwhile(1) { move([1, 2]); }", "\nwhile(1) { literal(\"\"); }", "\nwhile(1) { comment(\"x\"); }"}) {
    options.want_path = false;
    const Ran ran = run(program, options);
    EXPECT_EQ(ran.lines,
              std::vector<std::string>{"error: More than 1 MB of output and messages: an endless loop?"});
    EXPECT_EQ(location_of(ran.messages.at(0)).line, 2u);
    EXPECT_EQ(ran.messages.at(0).code, codes::gcmc_limit);
    EXPECT_EQ(ran.run.status, 1);
    EXPECT_LT(ran.text.size(), std::size_t{1} << 21);
  }
  options.max_output = 20'000;
  for (const char* program : {"while(1) { message(\"0123456789\"); }", "while(1) { warning(1); }",
                              "while(1) { error(1); }", "while(1) { x = 1mm + 1deg; }"}) {
    const Ran ran = run(program, options);
    EXPECT_NE(ran.lines.back().find("an endless loop?"), std::string::npos) << program;
    EXPECT_LT(ran.lines.size(), 10'002u) << program;
  }
}

TEST(GcmcLimits, StepsAreBoundedAlsoWithOutput) {
  GcmcOptions options = bare();
  options.max_steps = 100'000;
  EXPECT_EQ(messages_of("while(1) { move([1]); repeat(10000) {} }", options),
            "error: The program runs more than 100000 loop steps");
}

TEST(GcmcLimits, MemoryIsBounded) {
  GcmcOptions options = bare();
  options.max_memory = 1 << 20;
  for (const char* program : {"l = {}; while(1) { l += {[1]}; }", "s = \"a\"; while(1) { s += s; }",
                              "l = {[1]}; while(1) { l += l; }", "v = []; i = 0; while(1) { v[i++] = 1; }",
                              "v = []; v[40000000] = 1;", "x = {[1]} >> 40000000;",
                              "s = \"abcdefgh\"; repeat(12) { s += s; } x = typeset(s, 1);"})
    EXPECT_EQ(messages_of(program, options),
              "error: The program uses more than 1 MB for vectors, lists and strings")
        << program;
}

/// Accepts a limited number of writes.
class FullDisk final : public GcmcOutput {
 public:
  explicit FullDisk(int capacity) : capacity_(capacity) {}
  void message(const Diagnostic& m) override { messages += gcmc_line(m); }
  void text(std::string_view) override { ++writes; }
  bool is_broken() const override { return writes > capacity_; }
  int writes = 0;
  std::string messages;

 private:
  int capacity_;
};

TEST(GcmcLimits, AProgramEndsWhereItsTextCannotBeWritten) {
  for (const char* program : {"while(1) { move([1, 2]); }",
                              "s = \"0123456789\"; repeat(11) { s += s; } while(1) { literal(s); }"}) {
    FullDisk disk(3);
    Diagnostics diagnostics;
    const GcmcRun ran = run_gcmc(program, bare(), disk, diagnostics);
    EXPECT_EQ(disk.writes, 4) << program;  // the one that fails is the last
    EXPECT_EQ(disk.messages, "");
    EXPECT_EQ(ran.status, 1);
    EXPECT_FALSE(ran.completed);
  }
  GcmcOptions options = bare();
  options.prologue = std::string(100'000, '%');
  FullDisk disk(0);
  Diagnostics diagnostics;
  EXPECT_EQ(run_gcmc("message(1);", options, disk, diagnostics).status, 1);
  EXPECT_EQ(disk.messages, "");
}

// The values of a function are released when it ends; otherwise each call would keep a copy of the list.
TEST(GcmcLimits, FunctionsReleaseTheirValues) {
  GcmcOptions options = bare();
  options.max_memory = 3 << 20;
  const std::string list = "l = {}; repeat(20000; i) { l += {[i, 2, 3]}; } ";
  for (const char* use : {"function f() { local k = l; } f(); l += {[1]}; repeat(3) { f(); l += {[1]}; }",
                          "function f(k) { foreach(k; v) { return v; } } repeat(3) { l += {f(l)}; }",
                          "function f() { l += {[1]}; } repeat(3) { f(); k = l; }"})
    EXPECT_EQ(messages_of(list + use + " message(count(l) > 20000);", options), "Runtime message(): 1")
        << use;
}

TEST(GcmcLimits, TextsOfTheToolpathAreBounded) {
  GcmcOptions options = bare();
  options.max_memory = 1 << 20;
  for (const char* program :
       {"i = 0; while(1) { comment(\"number \", i++); }", "while(1) { literal(\"a\"); }"})
    EXPECT_NE(messages_of(program, options).find("more than 1 MB"), std::string::npos) << program;
  options.max_path_steps = 100;
  EXPECT_NE(messages_of("while(1) { coolant(1); }", options).find("more than 100 steps"), std::string::npos);
}

TEST(GcmcLimits, NestingIsBounded) {
  EXPECT_NE(messages_of("x = " + std::string(5000, '(') + "1" + std::string(5000, ')') + ";")
                .find("nested too deeply"),
            std::string::npos);
  std::string sum = "x = 1";
  for (int i = 0; i < 100'000; ++i) sum += "+y";
  EXPECT_NE(messages_of(sum + ";").find("nested too deeply"), std::string::npos);
  std::string blocks;
  for (int i = 0; i < 2000; ++i) blocks += "if(1) {";
  EXPECT_NE(messages_of(blocks).find("nested too deeply"), std::string::npos);
  std::string elifs = "if(0) {}";
  for (int i = 0; i < 20'000; ++i)
    elifs += " elif(x == " + std::to_string(i) + ") { y = " + std::to_string(i) + "; }";
  EXPECT_EQ(messages_of("x = 19999; " + elifs + " else { y = -1; } message(y);"), "Runtime message(): 19999");
  EXPECT_EQ(messages_of("x = -7; " + elifs + " else { y = -1; } message(y);"), "Runtime message(): -1");
  EXPECT_NE(messages_of("function f(a = f()) {} f();").find("too large"), std::string::npos);
}

class StopAtOnce final : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return true; }
};

TEST(GcmcLimits, AnEndlessLoopCanBeInterrupted) {
  StopAtOnce progress;
  const auto ran = run("while(1) {}", bare(), &progress);
  EXPECT_TRUE(ran.run.stopped);
  EXPECT_FALSE(ran.run.completed);
  EXPECT_EQ(ran.lines.at(0), "error: Interrupted");
}

}  // namespace
}  // namespace kerf::test

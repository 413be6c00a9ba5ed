"""Fanuc's macros. The motions are computed by hand from what is commonly known of the language; they have
not been compared with Fanuc's manual."""
import json

import pytest

HEAD = "O0100\nG21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nF300\n"


def motion_ends(kerf, path, *options):
    run = kerf("steps", "--json", "--dialect", "fanuc", *options, path)
    assert run.status == 0, run.err
    steps = [s for s in map(json.loads, run.out.splitlines()[1:]) if s["step"] in ("rapid", "cut")]
    return [tuple(s["to"]) for s in steps][1:]


def xs(kerf, program, text, subprograms=""):
    return [p[0] for p in motion_ends(kerf, program(HEAD + text + "\nM30\n" + subprograms))]


@pytest.mark.parametrize("text, wanted", [
    # repetition and branch
    ("#1=1\nWHILE [#1 LE 3] DO1\nG1 X[#1*10]\n#1=#1+1\nEND1", [10, 20, 30]),
    ("#1=0\nWHILE[#1LT2]DO1\n#2=0\nWHILE[#2LT2]DO2\nG1X[#1*10+#2]\n#2=#2+1\nEND2\n#1=#1+1\nEND1",
     [0, 1, 10, 11]),
    ("#1=0\nDO1\n#1=#1+1\nG1 X#1\nIF [#1 GE 2] GOTO 9\nEND1\nN9 G1 X50", [1, 2, 50]),
    ("GOTO 20\nG1 X1\nN20 G1 X2", [2]),
    ("#1=0\nN10 #1=#1+1\nG1 X#1\nIF [#1 LT 3] GOTO 10", [1, 2, 3]),
    ("#1=30\nGOTO #1\nG1 X1\nN0030 G1 X3", [3]),
    ("#1=5\nIF [#1 GT 3] THEN #2=7.\nIF [#1 LT 3] THEN #2=8.\nG1 X#2", [7]),
    ("WHILE [#9 EQ 1] DO1 (never)\nG1 X1\nEND1\nG1 X2", [2]),
    # functions
    ("G1 X[SIN[30]+COS[60]]\nX[TAN[45]]\nX[ATAN[1]/[-1]]\nX[ATAN[1]]\nX[ASIN[0.5]]\nX[ACOS[0.5]]",
     [1, 1, 135, 45, 30, 60]),
    ("G1 X[SQRT[16]]\nX[ABS[-3]]\nX[ROUND[2.5]]\nX[LN[EXP[2]]]\nX[7 MOD 4]", [4, 3, 3, 2, 3]),
    ("G1 X[FIX[1.2]]\nX[FUP[1.2]]\nX[FIX[-1.2]]\nX[FUP[-1.2]]", [1, 2, -1, -2]),
    ("G1 X[6 AND 3]\nX[6 OR 3]\nX[6 XOR 3]\nX[8 + 6 AND 3]", [2, 7, 5, 10]),
    ("#1=2+3*4\nG1 X#1\n#2=#1/2 #3=#2-1\nG1 X#3", [14, -1]),
    # vacant variables
    ("G1 X5 Y#5\nG1 X#0 Y3\nG1 X9", [5, 5, 9]),
    ("#1=#0\nIF [#1 EQ #0] THEN #2=1\n#1=0\nIF [#1 NE #0] THEN #3=2\nIF [#1 GE #0] THEN #4=3\n"
     "G1 X#2\nX#3\nX#4",
     [1, 2, 3]),
    ("#2=#1*5\nG1 X4\nG1 X#2", [4, 0]),
    ("#100=#101\nG1 X4\nG1 X#100 Y1", [4, 4]),
])
def test_macro_statements_run(kerf, program, text, wanted):
    assert xs(kerf, program, text) == pytest.approx(wanted)


@pytest.mark.parametrize("text, subprograms, wanted", [
    # A is #1, I #4, F #9, S #19, T #20, U #21, X #24; the caller's locals come back
    ("#1=1\nG65 P200 A10 I4 F9 S2 T3 U5 X7\nG1 X#1",
     "O0200\nG1 X#1\nX#4\nX#9\nX#19\nX#20\nX#21\nX#24\nG1 X#2 Y5\nM99\n", [10, 4, 9, 2, 3, 5, 7, 7, 1]),
    ("#100=0\nG65 P200 L2 A3", "O0200\n#1=#1+1\n#100=#100+#1\nG1 X#100\nM99\n", [4, 8]),
    ("#33=6\nG65 P200\nG1 X#33", "O0200\n#33=1\nG1 X#33\nM99\n", [1, 6]),
    ("#1=3\nM98 P200\nG1 X#1", "O0200\n#1=4\nM99\n", [4]),  # M98 has no locals of its own
    ("G91\nM98 P0020200", "O0200\nG1 X2\nM99\n", [2, 4]),
    ("G91\nM98 P200 L3", "O0200\nG1 X2\nM99\n", [2, 4, 6]),
    # M99 P returns to a line number of the caller; numbers belong to their program
    ("M98 P200\nG1 X1\nN70 G1 X7", "O0200\nG1 X5\nM99 P70\nN70 G1 X99\nM99\n", [5, 7]),
    ("M98 P200\nN5 G1 X5", "O0200\nGOTO 5\nG1 X1\nN5 G1 X2\nM99\n", [2, 5]),
])
def test_calls_have_their_variables(kerf, program, text, subprograms, wanted):
    assert xs(kerf, program, text, subprograms) == pytest.approx(wanted)


@pytest.mark.parametrize("text, line, message", [
    ("GOTO 20", 7, "no line N20"),
    ("WHILE [#1 LT 3] DO1\nG1 X1", 7, "no matching start or end"),
    ("IF [#1 LT 3] G1 X1", 7, "expected WHILE"),
    ("#0=3", 7, "always vacant"),
    ("#1=[3 4", 7, "expected an operator"),
    ("#1=1\nDO1\n#1=#1+1\nEND1", None, "does every loop end?"),
    ("N10 GOTO 10", None, "does every loop end?"),
])
def test_what_a_control_refuses_is_an_error(kerf, program, text, line, message):
    run = kerf("steps", "--dialect", "fanuc", program(HEAD + text + "\nM30\n"))
    assert run.status == 1 and message in run.err
    assert line is None or f":{line}:" in run.err


def test_a_variable_of_the_control_is_unknown(kerf, program):
    found = kerf("check", "--json", "--dialect", "fanuc", program(HEAD + "G1 X#2001\nM30\n")).json["hazards"]
    assert [h["origin"]["line"] for h in found if h["kind"] == "value_unknown"] == [7]


def test_other_controls_do_not_have_the_statements(kerf, program):
    for dialect in ("linuxcnc", "grbl", "mach3"):
        assert kerf("steps", "--dialect", dialect, program(HEAD + "GOTO 20\nN20 G1 X2\nM30\n")).status == 1

"""Fanuc's macros. The motions are computed by hand from what is commonly known of the language; they have
not been compared with Fanuc's manual."""
import json

import pytest

HEAD = "O0100\nG21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nF300\n"


def motion_ends(kerf, path, *options):
    run = kerf("steps", "--json", *(options or ("--dialect", "fanuc")), path)
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
    ("G1 X[POW[2.,3.]]\nX[ATAN[1.,1.]]\nX[ATAN[1.,-1.]]", [8, 45, 135]),
    # the first two letters of a function; binary-coded decimals, 16 is hexadecimal 10 (Fanuc, B-63684EN)
    ("G1 X[SQ[16]]\nX[AB[-3]]\nX[RO[2.5]]\nX[EX[0]]\nX[FI[1.9]]\nX[FU[1.2]]\nX[SI[30]+CO[60]]\nX[TA[45]]",
     [4, 3, 3, 1, 1, 2, 1, 1]),
    ("G1 X[AT[1]/[-1]]\nX[AT[1]]\nX[AS[0.5]]\nX[AC[0.5]]\nX[PO[2,3]]", [135, 45, 30, 60, 8]),
    ("G1 X[BIN[16]]\nX[BCD[10]]\nX[BI[153]]\nX[BC[99]]\nX[BIN[#1]]", [10, 16, 99, 153, 0]),
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
    # argument specification II and a mixture, of which the later word counts (Fanuc, B-63684EN, page 278)
    ("G65 A1. B2. I-3. I4. D5. P200", "O0200\nG1 X#1\nX#2\nX#4\nX#7\nIF[#3EQ#0]THEN#3=8\nX#3\nM99\n",
     [1, 2, -3, 5, 8]),
    ("G65 P200 A1 B2 C3 I4 J5 K6 I7 J8 K9 I10 J11 K12 I13 J14 K15 I16 J17 K18 I19 J20 K21 I22 J23 K24 "
     "I25 J26 K27 I28 J29 K30 I31 J32 K33",
     "O0200\n#100=1\nWHILE[#100LE33]DO1\nG1X##100\n#100=#100+1\nEND1\nM99\n", list(range(1, 34))),
    ("G65 P200 K1 J2 I3", "O0200\nG1 X#6\nX#8\nX#10\nM99\n", [1, 2, 3]),
    ("G65 P200 I#0 I3", "O0200\nIF[#4EQ#0]THEN#4=1\nG1 X#4\nX#7\nM99\n", [1, 3]),
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


def motions(kerf, path, *options):
    """The ends of cuts and arcs, with the centres of arcs."""
    run = kerf("steps", "--json", *options, path)
    assert run.status == 0, run.err
    steps = [s for s in map(json.loads, run.out.splitlines()[1:]) if s["step"] in ("cut", "arc")]
    return [(s["step"], *s["to"][:2], *s.get("centre", ())) for s in steps]


@pytest.mark.parametrize("text, wanted", [
    ("G1 X50 ,R5\nY30 ,C4\nX0\nY0",
     [("cut", 45, 0), ("arc", 50, 5, 45, 5), ("cut", 50, 26), ("cut", 46, 30), ("cut", 0, 30),
      ("cut", 0, 0)]),
    # to the right, with a comment between, the next line incremental
    ("G1 X20,R2.(round)\n(between)\nG91 Y-10", [("cut", 18, 0), ("arc", 20, -2, 18, -2), ("cut", 20, -10)]),
    # 60 degrees: the tangent length is 3 / tan(30)
    ("G1 X20 ,R3\nX10 Y17.320508",
     [("cut", 20 - 3 * 3 ** 0.5, 0), ("arc", 20 - 3 * 3 ** 0.5 / 2, 4.5, 20 - 3 * 3 ** 0.5, 3),
      ("cut", 10, 17.320508)]),
    # two corners that use the whole cut between them
    ("G1 X10 ,R5\nY10 ,R5\nX0", [("cut", 5, 0), ("arc", 10, 5, 5, 5), ("cut", 10, 5),
                                 ("arc", 5, 10, 5, 5), ("cut", 0, 10)]),
    # values of variables, and inches
    ("#1=5\nG1 X50 ,R#1\nY30", [("cut", 45, 0), ("arc", 50, 5, 45, 5), ("cut", 50, 30)]),
    ("G20\nG1 X2 ,C.5\nY2", [("cut", 38.1, 0), ("cut", 50.8, 12.7), ("cut", 50.8, 50.8)]),
    ("G1 X50 ,R0\nY30", [("cut", 50, 0), ("cut", 50, 30)]),
])
@pytest.mark.parametrize("dialect", [(), ("--dialect", "haas")])
def test_corner_words_shorten_both_cuts(kerf, program, text, wanted, dialect):
    found = motions(kerf, program(HEAD + text + "\nM30\n"), *dialect)
    assert [m[0] for m in found] == [m[0] for m in wanted]
    for got, right in zip(found, wanted):
        assert got[1:] == pytest.approx(right[1:], abs=1e-6)


def test_a_corner_is_compensated_like_the_lines(kerf, program):
    """A tool of 4 mm left of a contour with a corner of 5 mm to the left: its axis turns by 3 mm."""
    text = "G41.1 D4 G1 X10 Y10\nX50 ,R5\nY30\nG40 X60 Y40"
    found = motions(kerf, program(HEAD + text + "\nM30\n"), "--dialect", "fanuc")
    arcs = [m for m in found if m[0] == "arc"]
    assert arcs[-1][1:] == pytest.approx((48, 15, 45, 15))  # the first one is at the start


@pytest.mark.parametrize("text, message", [
    ("G1 X5 ,R6\nY30", "it takes 6 mm of cuts of 5 and 30 mm"),
    ("G1 X5 ,R1\nX9", "same direction"),
    ("G1 X5 ,R1\nX1", "goes back"),
    ("G1 X5 ,R1\nZ-1", "both cuts must be in the plane"),
    ("G1 X5 ,R1\nM8\nG1 Y9", "no straight cut"),
    ("G1 X5 ,R1\nG0 Y9", "no straight cut"),
    ("G1 X5 ,R1", "no straight cut"),
    ("G1 X5 ,R-1\nG1 Y9", "negative"),
    ("G0 X5 ,R1\nG1 Y9", "belongs to a straight cut"),
    ("G1 X5 ,A30\nG1 Y9", "angle of a line"),
])
def test_a_corner_that_cannot_be_is_left_sharp_with_an_error(kerf, program, text, message):
    path = program(HEAD + text + "\nM30\n")
    run = kerf("steps", "--dialect", "fanuc", path)
    assert run.status == 1 and message in run.err and ":7:8:" in run.err
    # the motion itself is read
    assert kerf("info", "--json", "--dialect", "fanuc", path).json["motion"]["cut_extent_mm"][1][0] >= 5


def test_other_controls_have_no_corners(kerf, program):
    run = kerf("steps", "--dialect", "linuxcnc", program(HEAD + "G1 X5 ,R1\nY9\nM30\n"))
    assert run.status == 1 and "--dialect fanuc" in run.err


SUB = "O0200\nG91\nG1 Y#1\nG90\nM99\n"


@pytest.mark.parametrize("text, wanted", [
    # after each motion up to G67; the line of G66 itself does not move
    ("G66 P200 A2\nG0 X5\nX10\nM8\nG67\nX20", [(5, 0), (5, 2), (10, 2), (10, 4), (20, 4)]),
    ("G66 P200 L2 A1\nG0 X5\nG67", [(5, 0), (5, 1), (5, 2)]),
    ("G65 P200 A3 M5\nG1 X1", [(0, 3), (1, 3)]),
])
def test_modal_macros_run_after_each_motion(kerf, program, text, wanted):
    ends = motion_ends(kerf, program(HEAD + text + "\nM30\n" + SUB))
    assert [p[:2] for p in ends] == wanted


@pytest.mark.parametrize("line", ["G92 X1", "G10 L2 P2 X3", "G4 X1", "G52 X0"])
def test_modal_macros_do_not_run_after_lines_that_do_not_move(kerf, program, line):
    text = f"G66 P200 A2\n{line}\nG67\nG1 X50"
    ends = motion_ends(kerf, program(HEAD + text + "\nM30\n" + SUB))
    assert [p[1] for p in ends] == [0]


def test_m_is_an_argument_of_a_macro(kerf, program):
    assert xs(kerf, program, "G65 P200 M7", "O0200\nG1 X#13\nM99\n") == [7]


def test_an_alarm_ends_the_program(kerf, program):
    text = "#1=3\nIF [#1 LT 2] THEN #3000=1\nG1 X5\nIF [#1 GT 2] THEN #3000=1 (TOO LONG)\nG1 X9\nM30\n"
    path = program(HEAD + text)
    run = kerf("check", "--json", "--dialect", "fanuc", path)
    errors = [d for d in run.json["diagnostics"] if d["severity"] == "error"]
    assert [(d["name"], d["origin"]["line"]) for d in errors] == [("program_alarm", 10)]
    assert "TOO LONG" in errors[0]["message"]
    assert kerf("info", "--json", "--dialect", "fanuc", path).json["motion"]["cut_mm"] == 5


def test_a_message_stops_the_program(kerf, program):
    path = program(HEAD + "#3006=1(TURN THE PART)\nG1 X5\nM30\n")
    run = kerf("steps", "--json", "--dialect", "fanuc", path)
    assert run.status == 0 and '"pause":"always"' in run.out


@pytest.mark.parametrize("dialect, text, wanted", [
    # Haas: the tool's circle is smaller by its radius; from I to K in steps of Q, and back to the centre
    ("haas", "G12 I5 Z-1 D0",
     [("cut", 0, 0), ("arc", 5, 0, 2.5, 0), ("arc", 5, 0, 0, 0), ("arc", 0, 0, 2.5, 0)]),
    ("haas", "G0 X50 Y50\nG13 I5 K8 Q2 D1",
     [("arc", 53, 50, 51.5, 50), ("arc", 53, 50, 50, 50), ("cut", 55, 50), ("arc", 55, 50, 50, 50),
      ("cut", 56, 50), ("arc", 56, 50, 50, 50), ("arc", 50, 50, 53, 50)]),
    # Mach3: along X by I, a circle, and back
    ("mach3", "G12 I10", [("cut", 10, 0), ("arc", 10, 0, 0, 0), ("cut", 0, 0)]),
])
def test_circular_pockets(kerf, program, dialect, text, wanted):
    found = motions(kerf, program(HEAD + text + "\nM30\n"), "--dialect", dialect, "--tool", "1=square d=4")
    assert [m[0] for m in found] == [m[0] for m in wanted]
    for got, right in zip(found, wanted):
        assert got[1:] == pytest.approx(right[1:], abs=1e-6)


def test_a_circular_pocket_removes_its_cylinder(kerf, program):
    """Radius 15, 4 deep in two levels, milled by 6 mm in steps of 4: the volume of the cylinder."""
    text = "G0 Z0\nG91 G13 I4 K15 Q4 Z-2 L2 D1\nG90 G0 Z5"
    run = kerf("simulate", "--json", "--dialect", "haas", "--tool", "1=square d=6", "--stock",
               "-20,-20,-10 to 20,20,0", program(HEAD + text + "\nM30\n"))
    assert run.json["removed_mm3"] == pytest.approx(3.14159265 * 15 * 15 * 4, rel=2e-3)


@pytest.mark.parametrize("dialect, text, message", [
    ("haas", "G12 I1 D1", "above that of the tool, 2 mm"),
    ("haas", "G12 I5 K9 D1", "K needs Q"),
    ("haas", "G12 I5 K4 Q1 D1", "at least I"),
    ("haas", "G18 G12 I5 D1", "XY plane"),
    ("mach3", "G12", "must be positive"),
    ("haas", "G70 I5 L4", "needs a drilling cycle"),
    ("haas", "G81 Z-1 R1 L0\nG70 I5", "number of holes"),
    ("fanuc", "G16\nG91 G1 X5 Y5", "with G90 only"),
])
def test_words_that_make_no_pattern_are_errors(kerf, program, dialect, text, message):
    run = kerf("check", "--dialect", dialect, "--tool", "1=square d=4", program(HEAD + text + "\nM30\n"))
    assert run.status in (1, 3) and message in run.err and "error" in run.err


def test_bolt_holes_are_on_the_circle(kerf, program):
    def holes(text):
        path = program(HEAD + "G0 X10 Y10\n" + text + "\nM30\n")
        run = kerf("steps", "--json", "--dialect", "haas", path)
        return [pytest.approx(s["to"][:2], abs=1e-6) for s in map(json.loads, run.out.splitlines()[1:])
                if s["step"] == "cut"]
    assert holes("G81 G99 Z-5 R2 L0\nG70 I20 J90 L4") == [[10, 30], [-10, 10], [10, -10], [30, 10]]
    assert holes("G81 G99 Z-5 R2 G71 I20 J0 K-45 L3") == [
        [30, 10], [10 + 20 * 0.5 ** 0.5, 10 - 20 * 0.5 ** 0.5], [10, -10]]


@pytest.mark.parametrize("dialect, wanted", [("fanuc", (0, 10)), ("haas", (0, 10)), ("mach3", (3, 14))])
def test_polar_coordinates(kerf, program, dialect, wanted):
    """About the work zero, on Mach3 about the position at G16."""
    path = program(HEAD + "G0 X3 Y4\nG16\nG1 X10 Y90\nG15\nG1 X1\nM30\n")
    ends = motion_ends(kerf, path, "--dialect", dialect)
    assert [p[:2] for p in ends[1:]] == [pytest.approx(wanted, abs=1e-9), pytest.approx((1, wanted[1]))]


@pytest.mark.parametrize("code", ["G12 I5", "G16", "G66 P200", "G67", "G150 I1", "G31 X5"])
def test_codes_of_other_dialects_are_left_out(kerf, program, code):
    path = program(HEAD + code + "\nG1 X5\nM2\n")
    found = kerf("check", "--json", "--dialect", "linuxcnc", path).json["hazards"]
    assert "left_out" in [h["kind"] for h in found]


@pytest.mark.parametrize("text, levels", [
    ("G83 X10 Z-10 R0 I4 J1 K2", [-4, -7, -9, -10]),
    ("G83 X10 Z-10 R0 I4 J1.5 K1\nX20", [-4, -6.5, -7.5, -8.5, -9.5, -10] * 2),
    ("G73 X10 Z-6 R0 I3 J1 K1", [-3, -5, -6]),
    ("G83 X10 Z-6 R0 Q2.5", [-2.5, -5, -6])])
def test_pecks_of_haas_become_smaller(kerf, program, text, levels):
    """Haas, Mill Operator's Manual, G73 and G83: the first peck is I deep, each further one is less by J, and
    none is less than K."""
    run = kerf("steps", "--json", "--dialect", "haas", program(HEAD + text + "\nG80\nM30\n"))
    assert run.status == 0, run.err
    steps = map(json.loads, run.out.splitlines()[1:])
    assert [s["to"][2] for s in steps if s["step"] == "cut"] == pytest.approx(levels)


@pytest.mark.parametrize("dialect, line, message", [
    ("fanuc", "G83 X1 Z-5 R1 I2 J0.5 K1", "I J K, pecks that become smaller"),
    ("haas", "G73 X1 Z-5 R1 K3 Q1", "G73 with K and Q"),
    ("haas", "G83 X1 Z-5 R1 I2 J0.5", "above 0")])
def test_pecks_that_are_not_read_are_refused(kerf, program, dialect, line, message):
    run = kerf("steps", "--json", "--dialect", dialect, program(HEAD + line + "\nG80\nM30\n"))
    assert run.status == 1 and message in run.err + run.out


@pytest.mark.parametrize("text, message", [
    ("G65 P200 " + "I1 " * 11 + "\nM30\nO0200\nM99\n", "at most ten I, J and K"),
    ("G1 X[BIN[26]]\nM30\n", "a digit of the argument is above 9"),
    ("G1 X[BCD[-1]]\nM30\n", "up to eight digits"),
])
def test_arguments_that_have_no_variable_are_errors(kerf, program, text, message):
    run = kerf("info", "--dialect", "fanuc", program(HEAD + text))
    assert run.status == 1
    assert message in run.err


def test_an_unknown_level_is_no_level_to_return_to(kerf, program):
    text = "G21 G90\nT1 M6\nS900 M3\nG43 H1\nG98 G81 X10 Y0 Z-13 R-8 F100\nX20\nG80\nM30\n"
    ends = motion_ends(kerf, program(text), "--dialect", "fanuc")
    assert {to[2] for to in ends} == {-8, -13}


@pytest.mark.parametrize("dialect, back", [
    # after power-on: G98 on Fanuc (B-63684EN, "G code list"), Haas (mill operator's manual, list of codes),
    # grblHAL and Smoothieware (their sources); LinuxCNC G99 (recorded in tests/data/gcode/moves.txt)
    ("fanuc", 5), ("haas", 5), ("grbl", 5), ("linuxcnc", 2), ("mach3", 2)])
def test_the_level_after_a_hole_without_g98_and_g99(kerf, program, dialect, back):
    text = "G21 G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z5\nG81 X10 Z-3 R2 F100\nX20\nG99 X30\nG80\nM30\n"
    ends = motion_ends(kerf, program(text), "--dialect", dialect)
    last = {x: [to[2] for to in ends if to[0] == x][-1] for x in (10, 20, 30)}
    assert last == {10: back, 20: back, 30: 2}

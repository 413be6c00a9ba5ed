"""Languages of machines that do not read G-code: OpenSBP of ShopBot, RML-1 of Roland. What is written reads
back as the same path, what the machine cannot do has the line of the program, and foreign files are read or
refused."""
import json
import math
import random

import pytest

LANGUAGES = {"shopbot": ("part.sbp", 1e-5), "rml": ("part.rml", 0.025 / 2 + 1e-6),
             "rml100": ("part.rml", 0.005 + 1e-6)}

HEAD = "G21 G90 G17\nT102 M6\nM3 S12000\nG0 Z5\nG0 X0 Y0\n"
TAIL = "G0 Z5\nM5\nM2\n"


def steps(kerf, file):
    run = kerf("steps", file, "--json")
    assert run.status == 0, run.out + run.err
    return [json.loads(line) for line in run.out.splitlines()[1:]]


def motions(kerf, file):
    """Motions that move in work coordinates, as (kind, end, step)."""
    made, at = [], None
    for s in steps(kerf, file):
        if s["step"] not in ("rapid", "cut", "arc") or "reference" in s or s.get("unknown_axes"):
            continue
        if s["to"] != at or s["step"] == "arc":
            made.append((s["step"], s["to"], s))
        at = s["to"]
    return made


def post(kerf, language, source, *more, name=None):
    return kerf("post", "--to", language, source, "-o", name or LANGUAGES[language][0], "--json", *more)


def near(a, b, within):
    return all(abs(x - y) <= within for x, y in zip(a, b, strict=True))


def random_program(rng):
    """Lines, arcs and rapids; an arc in XY is of any length, up to a whole turn."""
    lines, x, y, z = [HEAD], 0.0, 0.0, 5.0
    for _ in range(40):
        kind = rng.random()
        feed = rng.choice((100, 250, 400, 800))
        if kind < 0.25:
            lines.append("G0 Z5\n")
            x, y, z = round(rng.uniform(0, 80), 3), round(rng.uniform(0, 80), 3), -round(rng.uniform(0, 5), 3)
            lines.append(f"G0 X{x} Y{y}\nG1 Z{z} F{feed}\n")
        elif kind < 0.6:
            x, y = round(rng.uniform(0, 80), 3), round(rng.uniform(0, 80), 3)
            z = round(z - rng.uniform(-1, 1), 3) if rng.random() < 0.4 else z
            lines.append(f"G1 X{x} Y{y} Z{z} F{feed}\n")
        else:
            radius, start = rng.uniform(0.5, 20), rng.uniform(0, 2 * math.pi)
            i, j = round(radius * math.cos(start), 4), round(radius * math.sin(start), 4)
            radius, sweep = math.hypot(i, j), rng.uniform(0.1, 2 * math.pi - 0.1)
            clockwise = rng.random() < 0.5
            end = math.atan2(-j, -i) + (-sweep if clockwise else sweep)
            whole = rng.random() < 0.15
            cx, cy = x + i, y + j
            if not whole:
                x, y = round(cx + radius * math.cos(end), 4), round(cy + radius * math.sin(end), 4)
            lines.append(f"G{2 if clockwise else 3} X{x} Y{y} I{i} J{j} F{feed}\n")
    return "".join(lines) + TAIL


@pytest.mark.parametrize("unit", ["--mm", "--inch"])
@pytest.mark.parametrize("seed", range(4))
def test_opensbp_reads_back_as_the_same_path(kerf, program, seed, unit):
    source = program(random_program(random.Random(seed)))
    run = post(kerf, "shopbot", source, unit)
    assert run.status == 0, run.out
    old, new = motions(kerf, source), motions(kerf, "part.sbp")
    within = 3e-5 if unit == "--inch" else 1e-5
    assert [kind for kind, _, _ in old] == [kind for kind, _, _ in new]
    for (kind, a, s), (_, b, t) in zip(old, new, strict=True):
        assert near(a, b, within), (s, t)
        if kind != "rapid":
            assert t["feed"] == pytest.approx(s["feed"], rel=1e-4)
        if kind == "arc":
            assert s["turn"] == t["turn"] and near(s["centre"], t["centre"], 2 * within)
    old, new = steps(kerf, source), steps(kerf, "part.sbp")
    for kind in ("tool", "spindle"):
        a, b = ([s.get("tool") for s in made if s["step"] == kind] for made in (old, new))
        assert a == b


@pytest.mark.parametrize("language", ["rml", "rml100"])
@pytest.mark.parametrize("seed", range(3))
def test_rml_reads_back_as_the_same_path(kerf, program, language, seed):
    """Every motion of the source ends at one of the file, in its order; between are chords of its arc."""
    source = program(random_program(random.Random(seed)))
    assert post(kerf, language, source).status == 0
    within = LANGUAGES[language][1]
    new = motions(kerf, "part.rml")
    k = 0
    for kind, to, s in motions(kerf, source):
        chords = []
        while not near(to, new[k][1], within) or (kind == "arc" and k + 1 < len(new) and not chords):
            chords.append(new[k])
            k += 1
            if chords and near(to, chords[-1][1], within):
                break
        if not (chords and near(to, chords[-1][1], within)):
            chords.append(new[k])
            k += 1
        assert all(c[0] == ("rapid" if kind == "rapid" else "cut") for c in chords), (s, chords)
        if kind != "arc":
            assert len(chords) == 1, (s, chords)
        else:
            radius = math.dist(s["centre"], to[:2])
            for _, at, _ in chords:  # its own rounding, and the chord's distance from the arc
                assert abs(math.dist(s["centre"], at[:2]) - radius) <= 1.5 * within + 0.002
        if kind != "rapid":
            assert all(c[2]["feed"] == pytest.approx(s["feed"], abs=3.1) for c in chords)
    assert k == len(new)


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_part_is_the_same(kerf, program, language):
    """A helix and an arc in XZ, which become chords."""
    text = (HEAD + "G1 Z-1 F100\nG1 X20 F400\nG3 X20 Y20 I0 J10 Z-2\nG18 G2 X30 Z-2 I5 K0\nG17\n" + TAIL)
    source = program(text)
    assert post(kerf, language, source).status == 0
    file = LANGUAGES[language][0]
    stock = ("--stock", "-10,-10,-20 to 50,40,0", "--tool", "square d=3.175 flute=12.7")
    a, b = (kerf("simulate", f, *stock, "--json").json for f in (source, file))
    assert b["removed_mm3"] == pytest.approx(a["removed_mm3"], rel=0.01)
    assert not b["hazards"]


def test_commands_of_opensbp(kerf, program, tmp_path):
    """The words of ShopBot's command reference."""
    source = program(HEAD + "G1 Z-1 F60\nG2 X10 Y0 I5 J0 F600\nG4 P1.5\nG1 X11\nG0 Z5\nM5\nM2\n")
    assert post(kerf, "shopbot", source).status == 0
    lines = [line for line in (tmp_path / "part.sbp").read_text().splitlines() if not line.startswith("'")]
    assert lines == ["IF %(25)=0 THEN GOTO UNIT_ERROR", "SA", "&Tool = 102", "TR,12000", "C6", "JZ,5",
                     "J3,0,0,5", "MS,1,1", "M3,0,0,-1", "MS,10,10", "CG,,10,0,5,0,T,1", "PAUSE 1.5",
                     "M3,11,0,-1", "J3,11,0,5", "C7", "END", "UNIT_ERROR:", "CN,91", "END"]


def test_commands_of_rml(kerf, program, tmp_path):
    source = program("G21 G90\nM3 S6000\nG0 X10 Y0\nG0 Z5\nG1 Z-1 F60\nG1 X11 F600\nG0 Z5\nM5\nM2\n")
    run = post(kerf, "rml", source)
    assert run.status == 0
    assert (tmp_path / "part.rml").read_text().split() == [
        ";;^IN;", "^PA;", "!MC1;", "V15;", "!PZ0,200;", "PU400,0;", "V1;", "Z400,0,-40;", "V10;",
        "Z440,0,-40;",
        "V15;", "Z440,0,200;", "!MC0;", "H;"]
    assert post(kerf, "rml100", source).status == 0
    text = (tmp_path / "part.rml").read_text()
    assert text.startswith(";;^DF;") and "Z1100,0,-100;" in text


def test_tools_of_shopbot(kerf, program, tmp_path):
    source = program(HEAD + "G1 Z-1 F60\nG0 Z5\nT201 M6\nM3 S9000\nG0 X5 Y5\nG1 Z-1\n" + TAIL)
    for how, words in (("pause", ["C7", "&Tool = 201", "PAUSE", "TR,9000", "C6", "J3,5,5,5"]),
                       ("command", ["C7", "&Tool = 201", "C9", "TR,9000", "C6", "J3,5,5,5"]),
                       ("ignore", ["C7", "TR,9000", "C6", "J3,5,5,5"])):
        assert post(kerf, "shopbot", source, "--tool-change", how).status == 0
        text = (tmp_path / "part.sbp").read_text()
        lines = [line for line in text.splitlines() if not line.startswith("'")]
        start = [i for i, line in enumerate(lines) if line == "J3,0,0,5"][1] + 1
        assert lines[start:start + len(words)] == words, (how, lines)
    assert post(kerf, "shopbot", source).status == 0
    tools = {t["number"]: t["known"] for t in kerf("info", "part.sbp", "--json").json["tools"]}
    assert tools == {102: True, 201: True}


def test_a_file_per_tool(kerf, program, files, tmp_path):
    source = program(HEAD + "G1 Z-1 F60\nG0 Z5\nT201 M6\nM3 S9000\nG1 X5 Y5\nG1 Z-1\n" + TAIL)
    run = post(kerf, "rml", source)
    assert run.status == 1
    fault, = [d for d in run.json["diagnostics"] if d["severity"] == "error"]
    assert fault["name"] == "post_cannot" and fault["origin"]["line"] == 8
    assert "--tool-change files" in fault["message"]
    run = post(kerf, "rml", source, "--tool-change", "files")
    assert run.status == 0 and run.json["outputs"] == ["part-T102.rml", "part-T201.rml"]
    # The second one comes from above, with the spindle on.
    assert (tmp_path / "part-T201.rml").read_text().split()[2:6] == ["!MC1;", "V15;", "!ZM200;", "Z0,0,200;"]


RETRACTS = {"machine": "G53 G0 Z0\n", "rapid": "G0 Z5\n", "both": "G53 G0 Z0\nG0 Z5\n"}


@pytest.mark.parametrize("post_name", ["grbl", "shopbot", "rml"])
@pytest.mark.parametrize("before", RETRACTS)
def test_a_retract_before_the_first_tool_is_in_its_file(kerf, program, tmp_path, post_name, before):
    source = program("G21 G90\n" + RETRACTS[before] + "T1 M6\nS9000 M3\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG0 Z5\n"
                     "T2 M6\nG0 X2 Y2\nG1 Z-1 F100\nG0 Z5\nM30\n")
    run = kerf("post", "--to", post_name, source, "-o", "part.out", "--tool-change", "files", "--json")
    assert run.status == 0, run.out
    assert run.json["outputs"] == ["part-T1.out", "part-T2.out"]


@pytest.mark.parametrize("post_name", ["grbl", "shopbot", "rml"])
def test_tools_before_the_first_cut(kerf, program, post_name):
    """The file of the tool that cuts; a tool that has cut without a name has its own file."""
    source = "G21 G90\nG0 Z5\n{}T1 M6\nT2 M6\nS9000 M3\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG0 Z5\nM30\n"
    for cut, outputs in (("", ["part.out"]),
                         ("G0 X0 Y0\nG1 Z-1 F100\nG0 Z5\n", ["part-T0.out", "part-T2.out"])):
        run = kerf("post", "--to", post_name, program(source.format(cut)), "-o", "part.out", "--tool-change",
                   "files", "--json")
        assert run.status == 0, run.out
        assert run.json["outputs"] == outputs


@pytest.mark.parametrize("post_name, stop", [("grbl", "M0"), ("shopbot", "PAUSE"), ("tinyg", "M0")])
def test_a_retract_before_the_first_tool_is_no_reason_to_stop(kerf, program, tmp_path, post_name, stop):
    source = ("G21 G90\n{}T1 M6 (TOOL/MILL, 6,0,20,0)\nS9000 M3\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG0 Z5\n{}M30\n")
    second = "T2 M6\nG0 X2 Y2\nG1 Z-1\nG0 Z5\n"
    cut = "G0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\n"
    cases = [(before, "", 0) for before in RETRACTS.values()]
    for before, after, stops in [*cases, (RETRACTS["both"], second, 1), (cut, "", 1), (cut, second, 2)]:
        run = kerf("post", "--to", post_name, program(source.format(before, after)), "-o", "part.out")
        assert run.status == 0, run.out + run.err
        assert (tmp_path / "part.out").read_text().splitlines().count(stop) == stops, (before, after)
        tools = kerf("info", "part.out", "--json").json["tools"]
        named = [t["number"] for t in tools if t["number"] is not None]
        assert named == ([1, 2] if after else [1]) and all(t["known"] for t in tools if t["number"] == 1)


def test_rml_refuses_a_tool_after_one_without_a_name(kerf, program):
    source = "G21 G90\nM3 S1000\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\nG0 Z5\nT2 M6\nG1 Z-1\nG0 Z5\nM30\n"
    run = post(kerf, "rml", program(source))
    assert run.status == 1
    assert [d["origin"]["line"] for d in run.json["diagnostics"] if d["severity"] == "error"] == [7]


@pytest.mark.parametrize("language", ["rml", "rml100"])
def test_rml_says_that_a_feed_is_too_slow(kerf, program, language):
    """Speeds have one decimal in mm/s: 6 mm/min is the lowest."""
    run = post(kerf, language, program(HEAD + "G1 Z-1 F0.5\nG1 X1\nG1 X2 F2\nG1 X3 F6\n" + TAIL))
    assert run.status == 0
    only, = [d for d in run.json["diagnostics"] if "mm/min" in d["message"]]
    assert only["severity"] == "warning" and only["origin"]["line"] == 6
    assert "below 6 mm/min" in only["message"]
    run = post(kerf, language, program(HEAD + "G1 Z-1 F6\nG1 X1 F60\n" + TAIL))
    assert not [d for d in run.json["diagnostics"] if "mm/min" in d["message"]]


CANNOT = [
    ("G38.2 Z-5 F50", "post_cannot"), ("G55", "post_cannot"), ("G1 X5 A10 F100", "post_cannot"),
    ("M4 S1000", "post_cannot"), ("G33 Z-5 K1", "post_cannot"), ("G1 Z-1", "post_no_feed")]
LEFT_OUT = ["M8", "G64 P0.1", "G43 H1", "M1"]


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("line, name", CANNOT)
def test_what_the_machine_cannot_do(kerf, program, language, line, name):
    source = program(HEAD + line + "\n" + TAIL)
    run = post(kerf, language, source, "--dialect", "rs274")
    assert run.status == 1, run.out
    errors = [d for d in run.json["diagnostics"] if d["severity"] == "error"]
    assert (errors[0]["name"], errors[0]["origin"]["line"]) == (name, 6), errors


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("line", LEFT_OUT)
def test_what_is_left_out(kerf, program, language, line):
    source = program(HEAD + line + "\nG1 Z-1 F100\nG1 X5\n" + TAIL)
    run = post(kerf, language, source, "--dialect", "rs274")
    assert run.status == 0, run.out
    assert ("post_left_out", 6) in [(d["name"], d["origin"]["line"]) for d in run.json["diagnostics"]]


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_retract_to_the_machine_goes_to_the_highest_z(kerf, program, language):
    """Left out, the next rapid would cross the work."""
    source = program(HEAD + "G1 Z-1 F100\nG53 G0 Z0\nG0 X30 Y30\nG1 Z-1\n" + TAIL)
    run = post(kerf, language, source)
    assert run.status == 0
    assert [d["origin"]["line"] for d in run.json["diagnostics"] if "highest" in d["message"]] == [7]
    ends = [to for _, to, _ in motions(kerf, LANGUAGES[language][0])]
    k = next(i for i, to in enumerate(ends) if near(to, (0, 0, -1), 0.01))
    assert near(ends[k + 1], (0, 0, 5), 0.01) and near(ends[k + 2], (30, 30, 5), 0.01)


def test_rml_has_no_inches(kerf, program):
    assert post(kerf, "rml", program(HEAD + TAIL), "--inch").status == 1


# ---- Files of other programs.

VECTRIC_SBP = """'SHOPBOT FILE IN MM
IF %(25)=0 THEN GOTO UNIT_ERROR	'check to see software is set to standard
C#,90				 	'Lookup offset values
'Turning router ON
TR,18000,1
SO,1,1
PAUSE 2
MS,40.0,20.0
JZ,20.000000
J2,0.000000,0.000000
J3,10.000000,20.000000,5.000000
M3,10.000000,20.000000,-3.000000
CG, ,20.000000,20.000000,5.000000,0.000000,T,1
M2,30,20
MX,35
JZ,20
SO,1,0
END
UNIT_ERROR:
C#,91
END
"""


def test_a_part_file_of_vectrics_post(kerf, program):
    """In the form that VCarve's post ShopBot (arcs)(mm) writes."""
    got = steps(kerf, program(VECTRIC_SBP, "v.sbp"))
    spindle = [s for s in got if s["step"] == "spindle"]
    assert [(s["rpm"], s["turn"]) for s in spindle] == [(18000, "cw"), (0, "off")]
    assert [s["seconds"] for s in got if s["step"] == "dwell"] == [2]
    ends = [(kind, to) for kind, to, _ in motions(kerf, "v.sbp")]
    assert ends == [("rapid", [0, 0, 20]), ("rapid", [10, 20, 5]), ("cut", [10, 20, -3]),
                    ("arc", [20, 20, -3]), ("cut", [30, 20, -3]), ("cut", [35, 20, -3]),
                    ("rapid", [35, 20, 20])]
    plunge, arc = [s for s in got if s["step"] in ("cut", "arc")][:2]
    assert (plunge["feed"], arc["feed"], arc["centre"], arc["turn"]) == (1200, 2400, [15, 20], "cw")


def test_inches_by_the_test_of_the_unit(kerf, program):
    text = VECTRIC_SBP.replace("%(25)=0", "%(25)=1")
    assert motions(kerf, program(text, "v.sbp"))[0][1] == [0, 0, pytest.approx(20 * 25.4)]
    run = kerf("info", program("J3,0,0,1\nMS,1,1\nM3,1,0,1\nEND\n", "w.sbp"), "--json")
    assert "native_assumed" in run.codes() and motions(kerf, "w.sbp")[-1][1][0] == pytest.approx(25.4)


FAB_RML = """PA;PA;VS4.0;!VZ4.0;!PZ0,80;!MC1;
PU400,400;
Z400,400,-20;
Z480,400,-20;
PU480,400;
PU0,0;!MC0;
H;
"""


def test_a_file_of_the_fab_modules(kerf, program):
    got = [(kind, to) for kind, to, _ in motions(kerf, program(FAB_RML, "f.rml"))]
    assert got[:5] == [("rapid", [10, 10, 2]), ("cut", [10, 10, -0.5]), ("cut", [12, 10, -0.5]),
                       ("rapid", [12, 10, 2]), ("rapid", [0, 0, 2])]
    run = kerf("info", "f.rml", "--json")
    assert "native_assumed" in run.codes()  # the length of a step


@pytest.mark.parametrize("name, text, code, line", [
    ("a.sbp", "SA\nM3,1,2,x\n", "native_value", 2), ("a.sbp", "SA\nM9,1,2\n", "native_command", 2),
    ("a.sbp", "SA\n&x\n", "native_command", 2), ("a.sbp", "SA\n%(25) = 1\n", "native_command", 2),
    ("a.sbp", "SA\n&x = 5\nM3,1,2,&y\n", "native_value", 3),
    ("a.sbp", "&x = Material Surface\nMZ,&x\n", "native_value", 2),
    ("a.sbp", "&x = 1\n&y = &x + 1\nMZ,&y\n", "native_value", 3),
    ("a.sbp", "&n = none\n&Tool = &n\n", "native_value", 2), ("a.sbp", "SR\n", "native_command", 1),
    ("a.sbp", "CG,,1,2,3,4,T,1\n", "native_value", 1),
    ("a.sbp", "IF &a > 1 THEN GOTO B\n", "native_command", 1),
    ("a.sbp", "J3,0,0,0\nCG,,9,9,1,0,T,1\n", "native_value", 2), ("a.sbp", "MS,0\n", "native_value", 1),
    ("a.sbp", "J3,0,0,0\nCG,,2,0,1,0,I,1\n", "native_command", 2),
    ("a.sbp", "M3,1e300,0,0\n", "native_value", 1),
    ("a.sbp", "&Tool = x\n", "native_value", 1), ("a.sbp", "TR,-5\n", "native_value", 1),
    ("a.rml", "^IN;\nZ1,2;\n", "native_value", 2), ("a.rml", "^IN;QQ5;\n", "native_command", 1),
    ("a.rml", "^IN;V;\n", "native_value", 1), ("a.rml", "^IN;\n\n  PU5;\n", "native_value", 3),
    ("a.rml", "^IN;Z1-2,3,4;\n", "native_value", 1), ("a.rml", "^IN;#\n", "native_command", 1)])
def test_what_is_not_read_has_its_line(kerf, program, name, text, code, line):
    run = kerf("info", program(text, name), "--json")
    assert run.status == 1
    errors = [d for d in run.json["diagnostics"] if d["severity"] == "error"]
    assert (errors[0]["name"], errors[0]["origin"]["line"]) == (code, line), errors


PARTWORKS_SBP = """'SHOPBOT ROUTER FILE IN INCHES
IF %(25)=1 THEN GOTO UNIT_ERROR	'check to see software is set to standard
SA                             	'Set program to absolute coordinate mode
CN,90
&PWSafeZ = 0.200
&PWZorigin = Material Surface
&PWMaterial = 1.000
&ToolName = "End Mill (1/4 inch)"
&depth=-0.25
&Deep = &depth
&n = 3
&Tool = &n
C9
TR,12000
C6
PAUSE 2
MS,1.0,0.5
JZ,&PWSafeZ
J2,1,1
M3,1,1,&DEPTH
M3,2,1,&deep
JZ,&pwsafez
C7
END
UNIT_ERROR:
CN,91
END
"""


@pytest.mark.parametrize("name", ["p.sbp", "p.part"])
def test_variables_of_partworks_are_read(kerf, program, name):
    """In the form of PartWorks' files: variables that no motion uses, and a depth that some do."""
    source = program(PARTWORKS_SBP, name)
    run = kerf("info", source, "--json")
    assert run.status == 0 and not {"native_command", "native_value"} & set(run.codes()), run.out
    assert [s["tool"] for s in steps(kerf, source) if s["step"] == "tool"] == [3]
    assert [(kind, pytest.approx([v / 25.4 for v in to])) for kind, to, _ in motions(kerf, source)] == [
        ("rapid", [1, 1, 0.2]), ("cut", [1, 1, -0.25]), ("cut", [2, 1, -0.25]), ("rapid", [2, 1, 0.2])]


def test_variables_alone_are_not_opensbp(kerf, program):
    assert motions(kerf, program("&x = 1\n&y = 2\nM3,1,1,&x\nEND\n", "v.part"))[0][0] == "cut"
    run = kerf("info", program("&x = 1\nG0 X5\n", "w.part"), "--json")
    assert "native_command" not in run.codes()


def test_texts_of_other_endings(kerf, program):
    assert motions(kerf, program(VECTRIC_SBP, "v.part"))[0][1] == [0, 0, 20]
    assert motions(kerf, program(FAB_RML, "f.part"))[0][1] == [10, 10, 2]
    assert motions(kerf, program("M3 S1000\nG0 X1 Y1 Z1\nG1 X2 F100\nM2\n", "g.part"))[-1][1] == [2, 1, 1]

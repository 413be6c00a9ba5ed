"""kerf post: what the sources of a controller say about its files. Each TOML of posts/ names its sources in
the first comment; the expectations here are taken from them."""
import json
import re

import pytest

PROGRAM = """(T1 D=6 CR=0 - flat end mill)
(T2 D=3 CR=0 - flat end mill)
G21 G90
T1 M6
M3 S12000.4
G0 X10 Y0 Z5
G4 P1.5
G1 Z-0.5 F300
G2 X20 Y0 I5 J0
G2 X30 Y0 I5 J0
G1 X40
X50
G0 Z5
M5
T2 M6
M3 S9000
G0 X0
G1 Z-1
X10
G0 Z5
M30
"""


def lines_of(kerf, program, post, *options, text=PROGRAM):
    run = kerf("post", "--to", post, *options, program(text))
    assert run.status == 0, run.err
    return run.out.splitlines()


def steps_of(kerf, tmp_path, lines):
    (tmp_path / "out.nc").write_text("\n".join(lines) + "\n")
    return [json.loads(row) for row in kerf("steps", "out.nc").out.splitlines()[1:]]


def words_of(line):
    return re.sub(r"\([^)]*\)|;.*", "", line).strip()


@pytest.mark.parametrize("post, dwell, change, end", [
    ("tinyg", "G4 P1.5", "M0", "M2"),  # "Pause for P seconds"; M6 does not stop
    ("g2core", "G4 P1.5", "M0", "M2"),
    ("smoothieware", "G4 P1.5", "M600", "M2"),  # seconds in grbl_mode; no M0; M30 may delete a file
    ("carvera", "G4 P1.5", "T2 M6", "M30"),  # "Dwell P<seconds>"
    ("maslow", "G4 P1.5", "M0", "M30"),
    ("centroid", "G4 P1.5", "T2 M6", "M30"),  # "the time in seconds"; M2 starts the program again
    ("uccnc", "G4 P1500", "T2 M6", "M30"),
    ("masso", "G4 P1500", "T2 M6", "M30"),
    ("estlcam", "G4 P1.5", "M6 T2", "%")])
def test_dwells_tool_changes_and_the_end(kerf, program, tmp_path, post, dwell, change, end):
    lines = lines_of(kerf, program, post)
    assert dwell in lines and change in lines and lines[-1] == end
    steps = steps_of(kerf, tmp_path, lines)
    assert 1.5 in [s["seconds"] for s in steps if s["step"] == "dwell"]
    assert {s["tool"] for s in steps if s["step"] == "cut"} == {1, 2}
    assert not [s for s in steps if s["step"] == "unresolved"]


@pytest.mark.parametrize("post", ["smoothieware", "carvera", "estlcam"])
def test_each_line_names_its_motion(kerf, program, post):
    """Older versions of Smoothieware read an arc without G2 as a straight line (issue 500 there)."""
    lines = [words_of(line) for line in lines_of(kerf, program, post)]
    moves = [line for line in lines if re.search("[XYZ]", line)]
    assert len(moves) == 11 and all(re.search(r"\bG[0-3]\b", line) for line in moves), moves


def test_speeds_are_whole_numbers_where_posts_write_them_so(kerf, program):
    for post in ("carvera", "uccnc", "masso", "estlcam"):
        assert "M3 S12000" in lines_of(kerf, program, post), post


@pytest.mark.parametrize("post, line", [
    ("smoothieware", "M30"), ("smoothieware", "M0"), ("smoothieware", "M4 S100"), ("smoothieware", "G28 Z0"),
    ("carvera", "G20"), ("carvera", "M4 S100"),
    ("tinyg", "G10 L20 P1 X0"), ("tinyg", "G28 Z0"), ("tinyg", "G43 H1"), ("tinyg", "G91.1"),
    ("tinyg", "T300"),
    ("g2core", "G30 Z0"), ("g2core", "G81 X0 Y0 Z-1 R1"),
    ("maslow", "M4 S100"), ("maslow", "M8"), ("maslow", "G59.1"),
    ("centroid", "G10 L2 P1 X0"), ("centroid", "G91.1"), ("centroid", "M60"),
    ("snapmaker", "M3 S1000"), ("snapmaker", "M4 P50"), ("snapmaker", "G2 X1 Y0 I1 J0"),
    ("uccnc", "G18"), ("uccnc", "M10"), ("masso", "G43 H1"), ("estlcam", "G18"), ("estlcam", "G91")])
def test_words_that_the_controller_does_not_have_are_refused(kerf, tmp_path, post, line):
    (tmp_path / "mine.toml").write_text(f'base = "{post}"\nname = "mine"\n[templates]\nheader = ["{line}"]\n')
    (tmp_path / "part.nc").write_text(PROGRAM)
    run = kerf("post", "--post", "mine.toml", "part.nc", "-o", "out.nc")
    refused = re.search("the controller (has no|does not have)|the maximum tool number", run.err)
    assert run.status == 1 and refused, run.err
    assert not (tmp_path / "out.nc").exists()


@pytest.mark.parametrize("post, longest", [("smoothieware", 128), ("carvera", 128), ("masso", 80)])
def test_lines_are_as_long_as_the_controller_reads(kerf, tmp_path, post, longest):
    """Smoothieware discards a longer line (Player.cpp)."""
    name = "a-part-with-a-long-name-" * 6
    (tmp_path / f"{name}.nc").write_text(PROGRAM)
    tool = "1=keyhole d=9.525 head=3.175 neck_diameter=6.35 flute=9"
    run = kerf("post", "--to", post, "--tool", tool, f"{name}.nc", "-o", "out.nc")
    assert run.status == 0, run.err
    assert max(map(len, (tmp_path / "out.nc").read_text().splitlines())) <= longest
    assert "keyhole" in kerf("info", "--json", "out.nc").json["tools"][0]["name"]


def test_centroid_has_comments_after_semicolons_alone(kerf, program):
    """Parentheses belong to expressions there (its grammar)."""
    text = "\n".join(lines_of(kerf, program, "centroid"))
    assert "(" not in text and "; Kerf" in text


def test_estlcam_has_no_modes(kerf, program):
    """Neither its posts nor Estlcam write planes, units or G90, and arcs lie in XY."""
    text = PROGRAM.replace("G1 X40", "G18\nG2 X40 Z-0.5 I5 K0\nG17\nG1")
    lines = [words_of(line) for line in lines_of(kerf, program, "estlcam", text=text)]
    assert lines[0] == "%" and not any(re.search(r"G(1[7-9]|2[01]|9\d)", line) for line in lines)
    assert sum("G2" in line for line in lines) == 2  # those in XY


@pytest.mark.parametrize("post", ["carvera", "estlcam"])
def test_inches_are_refused_where_the_controller_has_none(kerf, program, post):
    run = kerf("post", "--to", post, "--inch", program(PROGRAM))
    assert run.status == 1 and "inches" in run.err, run.err


@pytest.mark.parametrize("post", ["tinyg", "g2core"])
def test_characters_that_act_at_once_are_not_in_comments(kerf, program, post):
    """! holds the feed, ~ resumes, % empties the queue."""
    lines = lines_of(kerf, program, post, text="(stop! ~50 % of it)\n" + PROGRAM)
    assert not set("".join(lines)) & set("!~%")


def test_a_pause_of_smoothieware_is_read_as_one(kerf, program, tmp_path):
    lines = lines_of(kerf, program, "smoothieware", text=PROGRAM.replace("G1 X40", "M0\nG1 X40"))
    steps = steps_of(kerf, tmp_path, lines)
    assert [s["step"] for s in steps].count("pause") == 1
    unknown = program("G21 G90\nG0 X0 Y0 Z5\nM600\nG1 X10 F100\nM2\n")
    for dialect, found in (("smoothieware", "pause"), ("linuxcnc", "unresolved")):
        rows = kerf("steps", "--dialect", dialect, unknown).out.splitlines()[1:]
        assert found in [json.loads(row)["step"] for row in rows], dialect


def test_snapmaker_takes_the_speed_as_a_percentage(kerf, program, tmp_path):
    """P100 is 12000 rpm (gcode_reference.md); arcs become chords."""
    run = kerf("post", "--to", "snapmaker", "--tool-change", "pause", program(PROGRAM))
    assert run.status == 0 and "12000 rpm at most" in run.err, run.err
    lines = run.out.splitlines()
    assert "M3 P100" in lines and "M3 P75" in lines and "G4 P1500" in lines and lines[-2:] == ["M5", "M400"]
    assert not any(re.match("G[23] ", line) for line in lines)
    speeds = [s["rpm"] for s in steps_of(kerf, tmp_path, lines) if s["step"] == "spindle"]
    assert [rpm for rpm in speeds if rpm > 0] == [12000.0, 9000.0]
    assert {s["tool"] for s in steps_of(kerf, tmp_path, lines) if s["step"] == "cut"} == {1, 2}


def test_m76_stops_the_work_of_snapmaker_only(kerf, tmp_path):
    """gcode_reference.md of its controller; the M76 of other Marlins stops the timer of the print alone."""
    body = ["G21", "G90", "G0 Z9", "M76", "G1 X5 F300", "M400"]
    headers = (([";Header Start", ";header_type: cnc"], "pause"), (["M104 S0", "G1 E1 F60"], "verbatim"))
    for header, kind in headers:
        steps = [step for step in steps_of(kerf, tmp_path, header + body)
                 if step["step"] == "pause" or step.get("text") == "M76"]
        assert [step["step"] for step in steps] == [kind], header

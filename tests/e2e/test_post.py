"""kerf post: every profile over real programs, what is refused, tool changes, files, units, templates."""
import json
import os
import re
from pathlib import Path

import pytest
from conftest import VALID

POSTS = ["carbide", "carvera", "centroid", "estlcam", "fanuc", "fluidnc", "g2core", "grbl", "grblhal",
         "haas", "klipper", "laser", "linuxcnc", "mach3", "mach4", "marlin", "maslow", "masso",
         "smoothieware", "snapmaker", "tinyg", "uccnc"]
PRINTER_POSTS = ["plain", "prusa", "reprapfirmware"]  # of prints alone
CASES = Path(os.environ.get("KERF_CASES_DIR") or "none", "gcode")
OWN = Path(__file__).parent.parent / "data/gcode/programs"
FILES = [p for folder in (OWN, CASES) for p in sorted(folder.glob("*.*"))
         if p.suffix in (".nc", ".ngc", ".gcode")]
# Programs with features that the controller lacks.
REFUSED = {
    ("mach3", "carbide_create_sample_102_390.nc"): "post_cannot",  # tool 390; Mach3 has 255
    ("mach4", "carbide_create_sample_102_390.nc"): "post_cannot",
    ("haas", "carbide_create_sample_102_390.nc"): "post_cannot",  # T1 to T200
    ("carbide", "gsender_laser_best_cnc.nc"): "post_cannot",  # M4, which Carbide Motion lacks
    ("carvera", "gsender_laser_best_cnc.nc"): "post_cannot",
    ("maslow", "gsender_laser_best_cnc.nc"): "post_cannot",
    ("smoothieware", "gsender_laser_best_cnc.nc"): "post_cannot",
    ("snapmaker", "gsender_laser_best_cnc.nc"): "post_cannot",
}
PLANES = {"G17": "XY", "G18": "XZ", "G19": "YZ"}
TWO_TOOLS = """G21 G90
T1 M6
M3 S1000
G0 X0 Y0 Z5
G1 Z-1 F100
X10
G0 Z5
M5
T2 M6
M3 S2000
G0 X5 Y5
G1 Z-2
X20
G0 Z5
T1 M6
M3 S500
G0 X3
G1 Z-3
G0 Z5
M2
"""


def test_lists_the_posts(kerf):
    run = kerf("post", "--list")
    assert run.status == 0
    names = [line.split()[0] for line in run.out.splitlines()]
    wanted = [*sorted([*POSTS, *PRINTER_POSTS]), "shopbot", "rml", "rml100", "dxf", "svg", "sheet",
              "sheet-svg", "kerf"]
    assert names == wanted
    listed = kerf("post", "--list", "--json").json
    assert [p["name"] for p in listed] == wanted
    assert all(p["title"] and p["file_ending"].startswith(".") for p in listed)


def motion_of(kerf, path):
    return kerf("info", "--json", path, timeout=300).json["motion"]


def words_of(line):
    """Letters and numbers of a line; comments left out."""
    return re.findall(r"([A-Z])(-?[\d.]+)", re.sub(r"\([^)]*\)|;.*", "", line))


def check_grbl_lines(text):
    """GRBL's rules for any line: at most 79 characters that count, arcs with all words."""
    plane = "XY"
    for line in text.splitlines():
        counted = re.sub(r"\([^)]*\)|;.*|\s", "", line)
        assert len(counted) <= 79, line
        assert line.isascii() and not set(line) & set("!?~%#[]"), line
        words = words_of(line)
        letters = [letter for letter, _ in words]
        assert all(letters.count(one) == 1 for one in letters if one not in "GM"), line
        codes = {letter + number for letter, number in words if letter in "GM"}
        for code in codes & PLANES.keys():
            plane = PLANES[code]
        if codes & {"G2", "G3"}:
            centre = {"XY": "IJ", "XZ": "IK", "YZ": "JK"}[plane]
            assert set(plane + centre) <= set(letters) and "R" not in letters, line


# The tool change with which a post writes one file.
ONE_FILE = {"klipper": "pause", "laser": "ignore", "snapmaker": "pause"}
CHORDS = ("klipper", "snapmaker")


def expect_same_motion(before, after, post):
    # Half a count (0.001 mm) at both ends of each move, and arcs that became chords.
    slack = 0.05 + 0.0005 * (before["lines"] + before["arcs"])
    for length in ("cut_mm", "rapid_mm"):
        assert after[length] == pytest.approx(before[length], rel=1e-3, abs=slack), post
    # The bounds of an arc contain its start point, those of a straight cut only its end point.
    for mine, theirs in zip(after["cut_bounds_mm"] or [], before["cut_bounds_mm"] or []):
        assert mine == pytest.approx(theirs, abs=0.02 if post in CHORDS else 0.006), post
    assert after["rapids"] == before["rapids"], post
    assert after["lines"] + after["arcs"] >= before["lines"] + before["arcs"], post


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_programs_by_all_posts(kerf, tmp_path, path):
    before = motion_of(kerf, path)
    homes = re.search(r"G(28|30)", path.read_text()) is not None  # by way of a point, which counts as a move
    for post in POSTS:
        out = tmp_path / f"{post}.nc"
        policy = ["--tool-change", ONE_FILE[post]] if post in ONE_FILE else []
        run = kerf("post", "--to", post, "--feed", 500, *policy, path, "-o", out, "--json")
        if (post, path.name) in REFUSED:
            assert run.status == 1 and REFUSED[post, path.name] in run.codes()
            assert not out.exists()
            continue
        assert run.status == 0, run.out
        if post == "grbl":
            check_grbl_lines(out.read_text())
        skipped = [d for d in run.json["diagnostics"] if "a motion to a machine position" in d["message"]]
        if not skipped and not homes:
            expect_same_motion(before, motion_of(kerf, out), post)


def test_written_to_standard_output(kerf, program):
    run = kerf("post", "--to", "grbl", program())
    assert run.status == 0 and run.err == ""
    assert run.out.startswith("(part)\n") and run.out.endswith("M30\n")
    assert "G1 Z-1 F100\nX20 F400\nG3 X20 Y20 I0 J5\n" in run.out


def test_inches(kerf, program):
    run = kerf("post", "--to", "grbl", "--inch", program())
    assert "G20 G90 G94 G17" in run.out and "G1 Z-0.0394 F3.937" in run.out
    same = kerf("post", "--to", "grbl", "--mm", program(run.out, "inch.nc"))
    assert "G1 Z-1.001 F100" in same.out  # 0.0394 inches
    both = kerf("post", "--to", "grbl", "--mm", "--inch", program())
    assert both.status == 2


def test_inches_are_refused_where_the_controller_has_none(kerf, program, tmp_path):
    run = kerf("post", "--to", "klipper", "--inch", program(), "-o", "out.gcode", "--json")
    assert run.status == 1 and "lint_code" in run.codes()
    assert not (tmp_path / "out.gcode").exists()


def test_unknown_post(kerf, program):
    run = kerf("post", "--to", "grll", program())
    assert run.status == 2 and run.out == ""
    assert 'did you mean grbl?' in run.err
    assert kerf("post", program()).status == 2
    assert kerf("post", "--to", "grbl").status == 2
    assert kerf("post", "--to", "grbl", "--tool-change", "later", program()).status == 2


def test_what_the_controller_lacks_is_refused(kerf, program, files):
    path = program("G21\nM6 T1\nM3 S1000\nG1 X1 A10 F100\nM2\n")
    before = files()
    run = kerf("post", "--to", "grbl", path, "-o", "out.nc", "--json")
    assert run.status == 1 and "post_cannot" in run.codes()
    assert files() == before
    assert kerf("post", "--to", "linuxcnc", path).status == 0


def test_the_linter_refuses_a_template(kerf, program, files):
    path = program('base = "grbl"\nname = "mine"\n[templates]\nheader = ["G64 P0.01"]\n', "mine.toml")
    part = program()
    before = files()
    run = kerf("post", "--post", path, part, "-o", "out.nc", "--json")
    assert run.status == 1 and "lint_code" in run.codes()
    assert files() == before


def test_a_move_without_feed(kerf, program):
    path = program("G21\nM6 T1\nM3 S1000\nG1 X1\nM2\n")
    run = kerf("post", "--to", "grbl", path)
    assert run.status == 1 and "--feed" in run.err
    assert "G1 X1 F250\n" in kerf("post", "--to", "grbl", "--feed", "250", path).out


class TestToolChanges:
    def lines(self, kerf, program, how):
        run = kerf("post", "--to", "grbl" if how != "command" else "grblhal", "--tool-change", how,
                   program(TWO_TOOLS))
        assert run.status == 0, run.err
        return [line for line in run.out.splitlines() if not line.startswith("(")]

    def test_command(self, kerf, program):
        lines = self.lines(kerf, program, "command")
        changes = [line for line in lines if "M6" in line]
        assert changes == ["T1 M6", "T2 M6", "T1 M6"]
        for change in changes[1:]:  # the spindle is stopped during the change
            at = lines.index(change, lines.index(changes[0]) + 1)
            assert lines[at - 1] == "M5"

    def test_pause(self, kerf, program):
        lines = self.lines(kerf, program, "pause")
        assert lines.count("M0") == 2  # the first tool is in the spindle
        for at in (i for i, line in enumerate(lines) if line == "M0"):
            assert lines[at - 1] == "M5" and lines[at + 1].startswith("M3 ")

    def test_ignore(self, kerf, program):
        lines = self.lines(kerf, program, "ignore")
        assert not [line for line in lines if "M0" in line or "M6" in line or "T" in line]

    def test_files(self, kerf, program, tmp_path):
        run = kerf("post", "--to", "grbl", "--tool-change", "files", program(TWO_TOOLS), "-o", "out.nc",
                   "--json")
        assert run.status == 0, run.out
        assert run.json["outputs"] == ["out-T1.nc", "out-T2.nc", "out-T1-2.nc"]
        texts = [Path(tmp_path, name).read_text() for name in run.json["outputs"]]
        for text, tool, speed in zip(texts, (1, 2, 1), (1000, 2000, 500)):
            assert f"(tools {tool})\n" in text and f"(tool {tool})\n" in text
            assert text.count("M3 ") == 1 and f"M3 S{speed}\n" in text
            assert text.endswith("M5\nM30\n")
        # A further file first retracts, then moves across, from the last position of the tool before it.
        assert "G0 Z5\nX10 Y0\nX5 Y5\nG1 Z-2" in texts[1]
        # The header is the file's own.
        assert "(cuts within X 5 to 20 Y 5 to 5 Z -2 to 5 mm)" in texts[1]
        all_of_it = motion_of(kerf, program(TWO_TOOLS))
        parts = [motion_of(kerf, Path(tmp_path, name)) for name in run.json["outputs"]]
        assert sum(p["cut_mm"] for p in parts) == pytest.approx(all_of_it["cut_mm"])

    def test_files_need_a_name(self, kerf, program):
        run = kerf("post", "--to", "grbl", "--tool-change", "files", program(TWO_TOOLS))
        assert run.status == 2 and "-o" in run.err

    def test_one_tool_is_one_file(self, kerf, program, tmp_path):
        run = kerf("post", "--to", "grbl", "--tool-change", "files", program(), "-o", "out.nc")
        assert run.status == 0 and (tmp_path / "out.nc").exists()


class TestFiles:
    def test_the_input_stays(self, kerf, program):
        path = program()
        run = kerf("post", "--to", "grbl", path, "-o", path)
        assert run.status == 2 and path.read_text() == VALID

    def test_all_or_none(self, kerf, program, tmp_path, files):
        (tmp_path / "out-T2.nc").mkdir()  # the second file cannot be written
        part = program(TWO_TOOLS)
        run = kerf("post", "--to", "grbl", "--tool-change", "files", part, "-o", "out.nc", "--json")
        assert run.status == 1
        assert files() == ["out-T2.nc", "part.nc"]

    def test_a_missing_folder(self, kerf, program, files):
        part = program()
        before = files()
        run = kerf("post", "--to", "grbl", part, "-o", "no/such/out.nc")
        assert run.status == 1 and files() == before

    def test_an_old_file_stays_when_writing_fails(self, kerf, program, tmp_path):
        (tmp_path / "out.nc").write_text("old")
        run = kerf("post", "--to", "grbl", program("G21\nM6 T1\nM3 S1\nG1 A1 F100\nM2\n"), "-o", "out.nc")
        assert run.status == 1 and (tmp_path / "out.nc").read_text() == "old"


class TestOwnPost:
    def test_from_another(self, kerf, program):
        path = program("""base = "grbl"
name = "mine"
[line]
end = "crlf"
number_step = 10
[numbers]
zeros = "kept"
[repeat]
motion = "always"
[templates]
header = ["({name} for {profile}, tool {tool})", "{units} G90"]
section = []
footer = ["G53 G0 Z-1", "M30"]
""", "mine.toml")
        run = kerf("post", "--post", path, program(), "-o", "out.nc")
        assert run.status == 0, run.err
        text = (path.parent / "out.nc").read_bytes().decode()
        assert text.startswith("(part for mine for grbl, tool 102)\r\n(stockMin:0.00mm, 0.00mm, -6.00mm)\r\n")
        assert "(STOCK/BLOCK, 40.00, 30.00, 6.00, 0.00, 0.00, 6.00)\r\nG21 G90\r\n" in text
        assert "G1 Z-1.000 F100.000\r\n" in text and text.endswith("G53 G0 Z-1\r\nM30\r\n")
        numbers = [int(n) for n in re.findall(r"^N(\d+) ", text, re.M)]
        assert numbers == list(range(10, 10 * len(numbers) + 1, 10))

    def test_short_lines(self, kerf, program):
        path = program('base = "grbl"\nname = "mine"\n[line]\nlongest = 20\n', "mine.toml")
        part = program(VALID.replace("G1 X20", "G1 X20.001 Y20.001 Z-1.001"))
        run = kerf("post", "--post", path, part, "--json")
        assert run.status == 1 and "post_line_long" in run.codes()

    @pytest.mark.parametrize("text, code", [
        ("name = ", "post_file_syntax"),
        ('name = "x"\n[words]\ng = "all"\n', "post_value_bad"),
        ('base = "grbl"\nname = "x"\nlettters = "G"\n', "post_key_unknown"),
        ('base = "grll"\nname = "x"\n', "post_unknown"),
    ])
    def test_faults(self, kerf, program, text, code):
        run = kerf("post", "--post", program(text, "mine.toml"), program(), "--json")
        assert run.status == 1 and code in run.codes()
        assert run.json["diagnostics"][0]["origin"]["file"].endswith("mine.toml")


def test_passes_report_their_savings(kerf, program):
    chords = "".join(f"X{10 * i / 50:.4f}\n" for i in range(1, 51))
    path = program("G21\nT1 M6\nM3 S1000\nG0 X0 Y0 Z5\nG0 Z9\nG0 Z5\nG1 Z-1 F100\n" + chords + "G0 Z5\nM2\n")
    run = kerf("post", "--to", "grbl", "--join", "0.001", "--shorten-rapids", path, "-o", "out.nc", "--json")
    assert run.status == 0
    join, rapids = run.json["passes"]
    assert (join["pass"], rapids["pass"]) == ("join", "rapids")
    assert join["steps_before"] - join["steps_after"] == 49
    assert rapids["rapid_mm_before"] - rapids["rapid_mm_after"] == pytest.approx(8)
    written = motion_of(kerf, path.parent / "out.nc")
    assert written["lines"] == 2 and written["cut_mm"] == pytest.approx(16)

COMPENSATED = """G21 G90 G17
T77 M6
M3 S10000
G0 X-10 Y-10 Z5
G1 Z-3 F200
G41 D77 G1 X0 Y0
Y40
G40 G1 X-10 Y-10
G0 Z5
M5
M30
"""


def test_compensation_takes_the_tool_of_the_options(kerf, program):
    part = program(COMPENSATED)
    without_tool = kerf("post", "--to", "grbl", part)
    assert without_tool.status == 1 and "[2045]" in without_tool.err and "--tool 77=" in without_tool.err
    with_option = kerf("post", "--to", "grbl", "--tool", "77=square d=6", part)
    assert with_option.status == 0, with_option.err
    assert "X-3" in with_option.out  # the tool's radius beside X0
    table = program('[[tool]]\nnumber = 77\nshape = "square"\ndiameter = 4\n', "tools.toml")
    with_file = kerf("post", "--to", "grbl", "--tools", table, part)
    assert with_file.status == 0, with_file.err
    assert "X-2" in with_file.out
    assert kerf("post", "--to", "grbl", "--tool", "77=round d=six", part).status == 2
    assert kerf("post", "--to", "grbl", "--tools", "none.toml", part).status == 1


def test_drilled_circles_have_the_size_of_the_option(kerf, program):
    part = program("G21 G90\nT77 M6\nM3 S1000\nG0 X5 Y5 Z5\nG1 Z-3 F100\nG0 Z5\nM30\n")
    svg = kerf("post", "--to", "svg", "--tool", "77=square d=7", part)
    assert svg.status == 0 and 'r="3.5"' in svg.out, svg.out


DWELL = """G21 G90
T1 M6
M3 S12000.4
G0 X10 Y0 Z5
G4 P1.5
G1 Z-0.5 F300
G2 X20 Y0 I5 J0
G0 Z5
M2
"""


def test_fanuc_has_points_capitals_and_milliseconds(kerf, program):
    """X10 is 0.01 mm on Fanuc's controls, P and S take no point (0i operator's manual, decimal points)."""
    run = kerf("post", "--to", "fanuc", program(DWELL))
    assert run.status == 0, run.err
    lines = run.out.splitlines()
    assert lines[:4] == ["%", "O0001", "(PART)", "(KERF 0.2.0, FANUC)"] and lines[-2:] == ["M30", "%"]
    assert "G0 X10. Y0. Z5." in lines and "G4 P1500" in lines and "G1 Z-0.5 F300." in lines
    assert "M3 S12000" in lines and "G17 G2 X20. Y0. I5. J0." in lines
    assert not re.search("[a-z]", run.out)
    own = kerf("post", "--to", "haas", "--set", "program=01234", program(DWELL)).out
    assert own.splitlines()[1] == "O01234"


@pytest.mark.parametrize("line, message", [
    ("G0 X10", "X without a decimal point"), ("G4 P1.5", "P must have no decimal point"),
    ("O100 CALL", "no O-words")])
def test_fanuc_refuses(kerf, tmp_path, line, message):
    """A header of the user's own goes through the same check."""
    (tmp_path / "mine.toml").write_text(f'base = "fanuc"\nname = "mine"\n'
                                        f'[templates]\nheader = ["%", "G21 G90", "{line}"]\n')
    (tmp_path / "part.nc").write_text(DWELL)
    run = kerf("post", "--post", "mine.toml", "part.nc", "-o", "out.nc")
    assert run.status == 1 and message in run.err, run.err


@pytest.mark.parametrize("base, dialect", [("fanuc", "Fanuc"), ("grbl", "GRBL"), ("haas", "Haas")])
def test_an_own_post_is_read_as_its_base(kerf, tmp_path, base, dialect):
    """A dwell of a post in milliseconds is not read in seconds."""
    (tmp_path / "mine.toml").write_text(f'base = "{base}"\nname = "mymill"\n')
    (tmp_path / "part.nc").write_text(DWELL)
    assert kerf("post", "--post", "mine.toml", "part.nc", "-o", "out.nc").status == 0
    assert f"mymill for {base}" in (tmp_path / "out.nc").read_text().lower()
    steps = [json.loads(row) for row in kerf("steps", "out.nc").out.splitlines()[1:]]
    assert [s["seconds"] for s in steps if s["step"] == "dwell"][-1] == 1.5
    assert dialect in kerf("info", "out.nc").err


@pytest.mark.parametrize("feed, word", [
    ("60ipm", "F1524"), ("60 ipm", "F1524"), ("900", "F900"), ("15mm/s", "F900")])
def test_feeds_have_units(kerf, program, feed, word):
    part = program("G21 G90\nT1 M6\nM3 S900\nG0 X0 Y0 Z5\nG1 Z-1\nG1 X9\nG0 Z5\nM2\n")
    run = kerf("post", "--to", "grbl", "--feed", feed, part)
    assert run.status == 0 and f"Z-1 {word}\n" in run.out, run.err
    for wrong in ("60in", "fast", "-1", "0"):
        assert kerf("post", "--to", "grbl", "--feed", wrong, part).status == 2


def test_lengths_have_units(kerf, program):
    part = program()
    both = [kerf("post", "--to", "grbl", "--fit-arcs", text, part).out for text in ("0.002in", "0.0508")]
    assert both[0] == both[1] != ""

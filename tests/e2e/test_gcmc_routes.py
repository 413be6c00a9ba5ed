"""A gcmc program read directly and the G-code that `kerf gcmc` writes for it have the same motions with the
same tool and spindle, and in the simulator the same volumes and hazards."""
import json
import math
import os
from pathlib import Path

import pytest

CASES = Path(os.environ.get("KERF_CASES_DIR", "")) / "gcmc"
OWN = sorted((Path(__file__).parent.parent / "data/gcmc").glob("*.gcmc"))
MOTIONS = ("rapid", "cut", "arc")
NEAR = 1e-6  # mm; the G-code has 8 decimals
LARGEST = 200_000  # bytes of G-code; larger programs repeat the same few calls


def near(a, b, tolerance=NEAR):
    return abs(a - b) <= tolerance * max(1.0, abs(a), abs(b))


def motions(steps):
    """The motions with their tool and spindle."""
    spindle, found = ("off", 0.0), []
    for line in steps.splitlines()[1:]:
        step = json.loads(line)
        if step["step"] == "spindle":
            spindle = (step["turn"], step["rpm"])
        if step["step"] in MOTIONS:
            found.append({**step, "spindle": spindle if spindle[0] != "off" else "off"})
    return found


def assert_same_motion(direct, read):
    where = f"{direct}\n{read}"
    for key in ("step", "tool", "spindle", "unknown_axes", "reference", "plane", "turn", "extra_turns"):
        assert direct.get(key) == read.get(key), where
    for a, b in zip(direct["to"], read["to"]):
        assert near(a, b), where
    for a, b in zip(direct.get("centre", []), read.get("centre", [])):
        assert near(a, b), where
    for a, b in zip(direct.get("abc", [0, 0, 0]), read.get("abc", [0, 0, 0])):
        assert near(a, b), where
    assert near(direct.get("feed", 0), read.get("feed", 0)), where


def same_motions(kerf, source, folder):
    """Compares the steps of both routes; the path of the G-code, or None where nothing is cut."""
    text = folder / "written.ngc"
    written = kerf("gcmc", "-I", source.parent, "-o", text, source)
    if written.status != 0 or text.stat().st_size > LARGEST:
        return None
    direct, read = kerf("steps", source), kerf("steps", text)
    if "[8021]" in direct.err:  # text that only the G-code can hold
        assert "literal(" in source.read_text() or "comment(" in source.read_text()
        return None
    assert direct.status == 0, direct.err
    assert read.status == 0, read.err
    a, b = motions(direct.out), motions(read.out)
    for one, other in zip(a, b):
        assert_same_motion(one, other)
    assert len(a) == len(b)
    return text if any(m["step"] != "rapid" for m in a) else None


def same_results(kerf, source, text):
    options = ["--json", "--tool", "square d=3 flute=20", "--resolution", "0.5",
               "--stock", "-5,-25,-12 to 45,25,0"]
    a, b = kerf("simulate", *options, source), kerf("simulate", *options, text)
    assert a.status == b.status, a.err + b.err
    for key in ("stock_mm3", "removed_mm3", "left_mm3", "resolution_mm"):
        assert near(a.json[key], b.json[key]), key
    assert len(a.json["hazards"]) == len(b.json["hazards"])
    for one, other in zip(a.json["hazards"], b.json["hazards"]):
        assert one["kind"] == other["kind"]
        for key in ("depth_mm", "removed_mm3"):
            assert near(one[key], other[key]), key


@pytest.mark.parametrize("source", OWN, ids=lambda p: p.stem)
def test_both_routes_agree(kerf, tmp_path, source):
    text = same_motions(kerf, source, tmp_path)
    assert text is not None
    same_results(kerf, source, text)


def given_programs():
    if not CASES.is_dir():
        return []
    probes = json.loads((CASES / "probes.json").read_text())
    given = [pytest.param(path, id=path.stem) for folder in ("seed", "files")
             for path in sorted((CASES / folder).glob("*.gcmc"))]
    return given + [pytest.param(case["program"], id=f"probe{number}") for number, case in enumerate(probes)
                    if case["rc"] == 0 and not case["options"]]


@pytest.mark.parametrize("given", given_programs())
def test_both_routes_agree_on_given_programs(kerf, tmp_path, given):
    source = given
    if isinstance(given, str):
        source = tmp_path / "one.gcmc"
        source.write_text(given + "\n")
    text = same_motions(kerf, source, tmp_path)
    if text is not None:
        same_results(kerf, source, text)


def test_comments_describe_tools_and_stock_on_both_routes(kerf, program, tmp_path):
    source = program("""
        comment("stockMin:0mm, 0mm, -6mm"); comment("stockMax:40mm, 30mm, 0mm");
        comment("TOOL/MILL, 6, 0, 20, 0");
        toolchange(7);
        spindle(1000); feedrate(100);
        goto([10, 10, 5]); move([-, -, -2]); move([20]); goto([-, -, 5]);
        toolchange(8);
        comment("TOOL/MILL, 4, 2, 20, 0");
        spindle(1000);
        goto([30, 10]); move([-, -, -2]); goto([-, -, 5]);
        """, "p.gcmc")
    assert kerf("gcmc", "-o", tmp_path / "p.ngc", source).status == 0
    a, b = (kerf("simulate", "--json", path).json for path in (source, tmp_path / "p.ngc"))
    tools = [(t["number"], t["name"]) for t in a["tools"]]
    assert [number for number, _ in tools] == [7, 8]
    assert tools == [(t["number"], t["name"]) for t in b["tools"]]
    assert a["stock"] == b["stock"] and near(a["removed_mm3"], b["removed_mm3"])
    slot, half_ball = 2 * (60 + 9 * math.pi), 8 * math.pi * 2 / 3
    assert a["removed_mm3"] == pytest.approx(slot + half_ball, rel=0.02)
    unused = program('move([1]); comment("TOOL/MILL, 6, 0, 20, 0");', "q.gcmc")
    assert "tool_comment_unused" in kerf("info", "--json", unused).codes()


def test_a_carriage_return_does_not_hide_a_line(kerf, program):
    """A carriage return ends a line of G-code: what follows it acts there, and is refused here."""
    text = 'feedrate(100);\ngoto([0, 0, 5]);\nliteral("M3\\rG91\\n");\nmove([1, 1, 1]);\n'
    source = program(text, "p.gcmc")
    for command in (["steps"], ["simulate"], ["check"], ["post", "--to", "linuxcnc"]):
        run = kerf(*command, source)
        assert run.status == 1 and "p.gcmc:3:" in run.err and "carriage return" in run.err


def test_the_end_of_a_program_is_its_last_line(kerf, program):
    source = program("feedrate(100);\ngoto([0, 0, 5]);\nmove([1]);\n", "p.gcmc")
    steps = kerf("steps", source).out.splitlines()
    assert '"step":"end"' in steps[-1] and 'p.gcmc","line":3' in steps[-1]


@pytest.mark.parametrize("line, why", [
    ("G91", "G91 changes the distance mode"),
    ("G20", "G20 changes the unit"),
    ("G92 X0", "G92 changes the work zero"),
    ("G1 Z-20 F100", "G1 changes the modal motion"),
    ("M47", "M47 changes the run of the program"),
    ("M18", "M18 changes the motors"),
])
def test_a_line_that_a_toolpath_cannot_hold(kerf, program, tmp_path, line, why):
    """Refused with its line wherever a toolpath is made; written to the G-code, which can be simulated."""
    source = program(f'feedrate(100);\ngoto([0, 0, 5]);\nliteral("{line}\\n");\nmove([1, 1, 1]);\n', "p.gcmc")
    for command in (["steps"], ["simulate"], ["check"], ["post", "--to", "linuxcnc"]):
        run = kerf(*command, source)
        assert run.status == 1 and "p.gcmc:3:" in run.err and why in run.err and "[8021]" in run.err
        assert "kerf gcmc" in run.err  # the hint
    written = kerf("gcmc", "-o", tmp_path / "p.ngc", source)
    assert written.status == 0 and line + "\n" in (tmp_path / "p.ngc").read_text()
    assert kerf("steps", tmp_path / "p.ngc").status == 0


def test_feed_modes_are_posted_as_feeds_per_minute(kerf, program):
    source = program("spindle(1000);\nfeedmode(\"upr\");\nfeedrate(0.1);\ngoto([0, 0, 5]);\n"
                     "move([10, 0, -1]);\nfeedmode(\"inverse\");\nmove([40, 40, -1], 3);\n", "p.gcmc")
    run = kerf("post", "--to", "grbl", source)
    assert run.status == 0, run.err
    assert "G1 X10 Z-1 F100\n" in run.out and "X40 Y40 F150\n" in run.out
    assert "G93" not in run.out and "G95" not in run.out
    without = program("feedmode(\"upr\");\nfeedrate(0.1);\nmove([10, 0, -1]);\n", "q.gcmc")
    found = [h["kind"] for h in kerf("check", "--json", without).json["hazards"]]
    assert "no_feed" in found

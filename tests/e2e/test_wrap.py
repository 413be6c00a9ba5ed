"""A flat program around a bar: positions and feeds by their closed forms, the volume by the simulator of the
fourth axis, and what is refused."""
import json
import math
import re
import struct

import pytest

FLAT = """G21 G90 G17
T1 M6
M3 S10000
G0 X10 Y0 Z5
G1 Z-0.4 F200
G1 X40 Y25 F600
G1 Y60
G1 X12
G2 X12 Y20 I0 J-20
G0 Z5
G0 X0 Y0
M2
"""
TOOL = ("--tool", "1=square d=2 flute=8")


def motions(run):
    steps, here = [], None
    assert run.status == 0, run.err
    for step in map(json.loads, run.out.splitlines()):
        if "to" in step:
            steps.append((here, step))
            here = step
    return steps


def wrap(kerf, part, *more, to="linuxcnc"):
    done = kerf("post", part, "--to", to, *more, *TOOL, "-o", "wrapped.ngc")
    assert done.status == 0, done.err
    return "wrapped.ngc"


@pytest.mark.parametrize("value", ["40", "d=40", "d=4cm"])
def test_positions_are_those_of_the_closed_form(kerf, program, value):
    made = motions(kerf("steps", "--json", wrap(kerf, program(FLAT), "--wrap", value)))
    turn = -360 / (math.pi * 40)
    lines = [step for _, step in made if step["step"] == "cut"]
    ends = [(s["to"][0], s["abc"][0], s["to"][2]) for s in lines]
    assert all(step["to"][1] == 0 for _, step in made if not step.get("unknown_axes"))
    for x, y, z in ((40, 25, -0.4), (40, 60, -0.4), (12, 60, -0.4), (12, 20, -0.4)):
        assert any(math.dist(end, (x, y * turn, z)) < 0.002 for end in ends), (x, y, z)
    # The half circle: every end is on it, and no chord is farther away from it than the tolerance.
    points = [(x, a / turn) for x, a, _ in ends[ends.index(min(ends, key=lambda e: math.dist(
        e, (12, 60 * turn, -0.4)))):]]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        assert math.hypot(x1 - 12, y1 - 40) == pytest.approx(20, abs=0.002)
        assert math.hypot((x0 + x1) / 2 - 12, (y0 + y1) / 2 - 40) > 20 - 0.005


def test_the_tool_moves_over_the_surface_at_the_feed(kerf, program):
    made = motions(kerf("steps", "--json", wrap(kerf, program(FLAT), "--wrap", "40")))
    turn, seen = 360 / (math.pi * 40), 0
    for before, step in made:
        if step["step"] != "cut" or "abc" not in before or step["to"][2] != before["to"][2]:
            continue
        flat = math.dist(step["to"], before["to"])
        degrees = abs(step["abc"][0] - before["abc"][0])
        if max(flat, degrees / turn) < 0.5:
            continue  # rounded to the decimals of the program
        minutes = flat / step["feed"] if flat > 0 else degrees / step["feed"]
        assert math.hypot(flat, degrees / turn) / minutes == pytest.approx(600, rel=0.01)
        seen += 1
    assert seen > 10


def words_of(line):
    return {letter: float(number) for letter, number in re.findall(r"([A-Z])(-?[0-9.]+)", line)}


@pytest.mark.parametrize("to", ["grblhal", "mach3", "mach4", "fanuc", "haas", "uccnc", "masso", "centroid"])
def test_feeds_are_times_where_a_feed_per_minute_would_be_another(kerf, program, tmp_path, to):
    """These controllers add degrees to mm, or need the diameter in a setting; read by the words alone."""
    lines = (tmp_path / wrap(kerf, program(FLAT), "--wrap", "40", to=to)).read_text().splitlines()
    here, feed, inverse, seen = {"X": 0.0, "Z": 5.0, "A": 0.0}, None, False, 0
    for line in lines:
        line = re.sub(r"\(.*?\)", "", line)
        codes = re.findall(r"G[0-9.]+", line)
        inverse = "G93" in codes or (inverse and "G94" not in codes)
        words = words_of(line)
        motion = next((code for code in codes if code in ("G0", "G1")), None) or here.get("motion")
        there = here | {axis: words[axis] for axis in "XZA" if axis in words} | {"motion": motion}
        feed = words.get("F", None if inverse else feed)
        flat = math.hypot(there["X"] - here["X"], there["Z"] - here["Z"])
        around = abs(there["A"] - here["A"]) * math.pi * 40 / 360
        if motion == "G1" and there["Z"] == here["Z"] and max(flat, around) > 0.5:
            assert inverse == (flat > 0 and around > 0), line
            minutes = 1 / feed if inverse else flat / feed if flat > 0 else abs(there["A"] - here["A"]) / feed
            assert math.hypot(flat, around) / minutes == pytest.approx(600, rel=0.01), line
            seen += inverse
        here = there
    assert seen > 10 and not inverse


def test_the_volume_is_that_of_the_flat_program(kerf, program):
    """A shallow cut on a bar of 200 mm: below the edges of a mill of 2 mm the bar is 0.0025 mm lower."""
    flat = kerf("simulate", "--json", program(FLAT), *TOOL, "--stock", "-30,-10,-5 to 60,80,0",
                "--resolution", "0.05").json
    name = wrap(kerf, program(FLAT), "--wrap", "d=200")
    around = kerf("simulate", "--json", name, *TOOL, "--rotary", "d=200 length=90 x=-30 z=-100",
                  "--resolution", "0.1")
    assert around.status == 0, around.err
    assert around.json["removed_mm3"] == pytest.approx(flat["removed_mm3"], rel=0.03)
    assert around.json["hazards"] == []


def test_lettering_reads_around_the_bar_as_it_does_flat(kerf, program, tmp_path):
    """A plunge at Y+ of the centre line of the drawing is a hole at the side of Y+ of the bar."""
    flat = program("G21 G90\nT1 M6\nM3 S10000\nG0 X10 Y10 Z5\nG1 Z-2 F100\nG0 Z5\nM2\n")
    name = wrap(kerf, flat, "--wrap", "d=40")
    run = kerf("simulate", name, *TOOL, "--rotary", "d=40 length=40 z=-20", "-o", "part.stl")
    assert run.status == 0, run.err
    points = [struct.unpack("<9f", record[12:48]) for (record,) in
              struct.iter_unpack("50s", (tmp_path / "part.stl").read_bytes()[84:])]
    floor = [p for nine in points for p in zip(nine[::3], nine[1::3], nine[2::3])
             if 15 < math.hypot(p[1], p[2] + 20) < 18.5 and 8 < p[0] < 12]
    assert floor
    angle = 10 / 20  # of the bar, radians
    for _, y, z in floor:
        assert math.atan2(y, z + 20) == pytest.approx(angle, abs=0.08)


def test_a_cutting_job_is_wrapped(kerf, tmp_path):
    (tmp_path / "job.toml").write_text(
        'tools = { 1 = "square d=2 flute=8" }\nstock = "60x60x3"\nwrap = "d=40"\n\n[[shape]]\nname = "a"\n'
        'rectangle = [10, 10, 50, 50]\n\n[[operation]]\nop = "engrave"\ntool = 1\ndepth = 0.3\nfeed = 600\n'
        'rpm = 10000\n')
    made = motions(kerf("steps", "--json", "job.toml"))
    cuts = [step for _, step in made if step["step"] == "cut" and step["to"][2] < 0]
    turn = -360 / (math.pi * 40)
    points = {(round(step["to"][0], 3), round(step["abc"][0] / turn, 3)) for step in cuts}
    assert {(x, y) for x in (10, 50) for y in (10, 50)} <= points  # and the ends of ramps
    assert all(x in (10, 50) or y in (10, 50) for x, y in points)
    assert all(step["to"][1] == 0 for step in cuts)


@pytest.mark.parametrize("value", ["0", "-4", "d=", "bar", "nan"])
def test_a_diameter_must_be_one(kerf, program, files, value):
    part = program(FLAT)
    before = set(files())
    done = kerf("post", part, "--to", "linuxcnc", "--wrap", value, "-o", "wrapped.ngc")
    assert done.status == 2 and "--wrap" in done.err and set(files()) == before


@pytest.mark.parametrize("line,why", [("G1 X5 A10 F100", "rotary"), ("G38.2 Z-5 F50", "probe"),
                                      ("G53 G1 Y5 F100", "position of the machine")])
def test_what_cannot_be_wrapped_is_refused(kerf, program, line, why):
    part = program(FLAT.replace("M2", f"{line}\nM2"))
    done = kerf("post", part, "--to", "linuxcnc", "--wrap", "40", *TOOL, "-o", "wrapped.ngc")
    assert done.status == 1 and why in done.err and "part.nc:12" in done.err


def test_a_controller_without_a_refuses(kerf, program):
    done = kerf("post", program(FLAT), "--to", "grbl", "--wrap", "40", *TOOL, "-o", "wrapped.nc")
    assert done.status == 1 and "rotary axis A" in done.err

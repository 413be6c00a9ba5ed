"""kerf post --level and kerf level: motions that follow a measured surface, and programs that measure one."""

import json
import math
import os
import re
from pathlib import Path

import pytest

MAPS = Path(os.environ.get("KERF_CASES_DIR") or "none", "heights")

PROGRAM = """G21 G90 G17
G0 Z5
G0 X0 Y0
G1 Z-1 F100
G1 X60 F400
G1 Y40
G1 X0 Y0
G0 Z5
G0 X30 Y20
G1 Z-0.5 F100
G2 X30 Y20 I10 J0 F300
G0 Z5
M2
"""
HELIX = "G21 G90 G17\nG0 Z5\nG0 X30 Y20\nG1 Z-0.5 F100\nG3 X40 Y30 Z-1.5 I10 J0\nG0 Z5\nM2\n"


def bowl(x, y):
    return 0.3 * ((x - 30) / 40) ** 2 - 0.2 * (y / 40) + 0.1


def slope(x, y):
    return 0.01 * x - 0.004 * y + 0.05


def points(surface, columns=31, rows=21):
    xs = [60 * i / (columns - 1) for i in range(columns)]
    ys = [40 * j / (rows - 1) for j in range(rows)]
    return [(x, y, surface(x, y)) for y in ys for x in xs]


def write_map(tmp_path, rows, name="map.txt"):
    (tmp_path / name).write_text("".join(f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in rows))
    return name


def cuts(kerf, name):
    """Cuts as lists of points 0.2 mm apart, arcs included."""
    run = kerf("steps", name)
    assert run.status == 0, run.err
    at, out = None, []
    for step in (json.loads(row) for row in run.out.splitlines()[1:]):
        if step["step"] == "cut":
            n = max(1, int(math.dist(at, step["to"]) / 0.2))
            out.append([[a + (b - a) * k / n for a, b in zip(at, step["to"])] for k in range(n + 1)])
        if step["step"] == "arc":
            cx, cy = step["centre"]
            a0 = math.atan2(at[1] - cy, at[0] - cx)
            a1 = math.atan2(step["to"][1] - cy, step["to"][0] - cx)
            turn = 2 * math.pi
            sweep = (a1 - a0) % turn if step["turn"] == "ccw" else -((a0 - a1) % turn)
            if abs(sweep) < 1e-6:
                sweep = turn if step["turn"] == "ccw" else -turn
            r = math.hypot(at[0] - cx, at[1] - cy)
            out.append([[cx + r * math.cos(a0 + sweep * k / 200), cy + r * math.sin(a0 + sweep * k / 200),
                         at[2] + (step["to"][2] - at[2]) * k / 200] for k in range(201)])
        if "to" in step:
            at = step["to"]
    return out


@pytest.mark.parametrize("surface, grid", [(slope, True), (slope, False), (bowl, True)])
@pytest.mark.parametrize("post", ["grbl", "linuxcnc"])
def test_cuts_follow_the_surface(kerf, tmp_path, surface, grid, post):
    (tmp_path / "part.nc").write_text(PROGRAM)
    rows = points(surface)
    if not grid:  # scattered: a plane is exact in every triangle
        rows = [(x, y, z) for k, (x, y, z) in enumerate(rows) if k % 7 != 3 or x in (0, 60)]
    write_map(tmp_path, rows)
    run = kerf("post", "--json", "--to", post, "--level", "map.txt", "part.nc", "-o", "out.nc")
    assert run.status == 0, run.err + run.out
    # Of the curved surface, a grid of 2 mm is bilinear within 0.3 * (1/40)^2 * 2 = 0.0004 mm.
    flat = [p for cut in cuts(kerf, "out.nc") for p in cut]
    assert len(flat) > 1000
    levels = []
    for x, y, z in flat:
        levels.append(z - surface(x, y))
    # Nominal heights: -1 on the lines, -0.5 on the circle.
    on_lines = [v for v in levels if abs(v + 1) < 0.02]
    assert len(on_lines) > 600 and max(abs(v + 1) for v in on_lines) < 0.01
    on_circle = [v for v in levels if abs(v + 0.5) < 0.02]
    assert len(on_circle) > 190 and max(abs(v + 0.5) for v in on_circle) < 0.01
    report = run.json["level"]
    assert report["divided"] >= (2 if surface is bowl else 1)


def zigzag(x, y):
    """Over a grid of 10 mm: straight between its lines, with an edge of 0.3 mm at each."""
    def wave(v):
        k = math.floor(v / 10)
        u = v / 10 - k
        return u if k % 2 == 0 else 1 - u

    return 0.3 * wave(x) + 0.2 * wave(y)


@pytest.mark.parametrize("gcode", ["G1 X60 F400\nG1 Y40\nG1 X0\nG1 Y0", "G1 X60 Y40",
                                   "G0 X5 Y0\nG1 Y40\nG1 X47", "G1 X60 Y0.0000001"])
def test_cuts_along_the_axes_have_the_edges_of_the_surface(kerf, tmp_path, gcode):
    (tmp_path / "part.nc").write_text(f"G21 G90 G17\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\n{gcode}\nG0 Z5\nM2\n")
    write_map(tmp_path, points(zigzag, columns=7, rows=5))
    assert kerf("post", "--to", "linuxcnc", "--level", "map.txt", "part.nc", "-o", "out.nc").status == 0
    flat = [p for cut in cuts(kerf, "out.nc")[1:] for p in cut]
    assert len(flat) > 300
    assert max(abs(z + 1 - zigzag(x, y)) for x, y, z in flat) < 0.01


def test_the_helix_keeps_its_slope(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(HELIX)
    write_map(tmp_path, points(bowl))
    assert kerf("post", "--to", "grbl", "--level", "map.txt", "part.nc", "-o", "out.nc").status == 0
    for x, y, z in [p for cut in cuts(kerf, "out.nc")[1:] for p in cut]:
        # Counter-clockwise over three quarters around X40 Y20, from -0.5 down to -1.5.
        fraction = ((math.atan2(y - 20, x - 40) - math.pi) % (2 * math.pi)) / (1.5 * math.pi)
        fraction = 0 if fraction > 1.2 else fraction
        assert math.hypot(x - 40, y - 20) == pytest.approx(10, abs=0.005)
        assert z == pytest.approx(-0.5 - fraction + bowl(x, y), abs=0.01)


def test_arcs_stay_arcs_and_a_level_surface_changes_nothing(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    write_map(tmp_path, points(lambda x, y: 0.25))
    assert kerf("post", "--to", "grbl", "--level", "map.txt", "part.nc", "-o", "out.nc").status == 0
    assert kerf("post", "--to", "grbl", "part.nc", "-o", "same.nc").status == 0
    words, plain = ([row.split() for row in (tmp_path / name).read_text().splitlines() if row[0] != "("]
                    for name in ("out.nc", "same.nc"))
    assert len(words) == len(plain)
    for a, b in zip(words, plain):
        for u, v in zip(a, b):
            if u[0] == "Z":
                assert float(u[1:]) == pytest.approx(float(v[1:]) + 0.25, abs=1e-6)
            else:
                assert u == v


def test_high_motions_stay(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    write_map(tmp_path, points(slope))
    assert kerf("post", "--to", "grbl", "--level", "map.txt", "--keep-above", "2", "part.nc", "-o",
                "out.nc").status == 0
    steps = [json.loads(row) for row in kerf("steps", "out.nc").out.splitlines()[1:]]
    rapids = [s["to"][2] for s in steps if s["step"] == "rapid"]
    assert rapids and all(z == 5 for z in rapids)
    plunge = next(s for s in steps if s["step"] == "cut")
    assert plunge["to"][2] == pytest.approx(-1 + slope(0, 0), abs=0.002)


def test_files_of_controllers(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    rows = points(slope, 4, 3)
    probe = "0 60 4\n0 40 3\n-1 1 100\n" + "".join(f"{x} {y} {z}\n" for x, y, z in rows)
    log = "WCO:1,2,-3\n" + "".join(f"[PRB:{x + 1},{y + 2},{z - 3}:1]\n" for x, y, z in rows)
    opened = "".join(f"{x} {y} {z} 0 0 0 0 0 0\n" for x, y, z in rows)
    results = []
    for content in (probe, log, opened, "".join(f"{x},{y},{z}\n" for x, y, z in rows)):
        (tmp_path / "map").write_text(content)
        assert kerf("post", "--to", "grbl", "--level", "map", "part.nc", "-o", "out.nc").status == 0, content
        results.append((tmp_path / "out.nc").read_text())
    assert len(set(results)) == 1
    assert f"Z{-1 + slope(0, 0):.2f}" in results[0]


@pytest.mark.parametrize("content, code", [
    ("", "heights_missing"), ("0 0\n", "heights_format"), ("a b c\nd e f\n", "heights_format"),
    ("0 0 3\n1 0 3\n0 1 3\n1 1 3\n", "level_correction"), ("1e9 0 0\n", "level_map"),
    ("[PRB:0,0,0:1]\n", "heights_missing"),
])
def test_maps_that_cannot_be_used(kerf, tmp_path, content, code):
    (tmp_path / "part.nc").write_text(PROGRAM)
    (tmp_path / "map").write_text(content)
    run = kerf("post", "--json", "--to", "grbl", "--level", "map", "part.nc", "-o", "out.nc")
    assert run.status == 1 and code in run.codes()
    assert not (tmp_path / "out.nc").exists()


def test_small_maps(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    for content, first in (("7 7 0.5\n", -0.5), ("0 0 0.1\n60 0 0.4\n", -0.9),
                           ("0 0 0.1\n60 0 0.4\n60 40 0.2\n", -0.9)):
        (tmp_path / "map").write_text(content)
        run = kerf("post", "--json", "--to", "grbl", "--level", "map", "part.nc", "-o", "out.nc")
        assert run.status == 0, content
        assert f"Z{first}" in (tmp_path / "out.nc").read_text()
        assert ("level_outside" in run.codes()) == (not content.endswith("0.2\n"))


def test_rotary_motions_are_refused(kerf, tmp_path):
    (tmp_path / "part.nc").write_text("G21 G90 G0 Z5\nG0 X0 Y0 A0\nG1 X5 A30 F100\nM2\n")
    write_map(tmp_path, points(slope))
    run = kerf("post", "--json", "--to", "linuxcnc", "--level", "map.txt", "part.nc", "-o", "out.nc")
    assert run.status == 1 and "level_motion" in run.codes()


def test_probing_program(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    assert kerf("level", "--grid", "5x4", "--over", "part.nc", "-o", "probe.nc").status == 0
    text = (tmp_path / "probe.nc").read_text()
    assert text.count("G38.2") == 20
    steps = [json.loads(row) for row in kerf("steps", "probe.nc").out.splitlines()[1:]]
    at = [tuple(s["to"][:2]) for s in steps if s["step"] == "probe"]
    # The circle around X40 Y20 of radius 10 lies within X0 to X60, Y0 to Y40.
    assert sorted(set(at)) == sorted((15.0 * i, round(40 / 3 * j, 3)) for i in range(5) for j in range(4))
    assert all(s["to"][2] == -2 for s in steps if s["step"] == "probe")
    for option in ("5", "1x4", "5x", "5x1000"):
        assert kerf("level", "--grid", option, "--over", "part.nc").status == 2
    assert kerf("level", "--over", "part.nc", "--to", "svg").status == 2
    # The material's top is not at Z0: a rapid at --clearance may lead through it.
    (tmp_path / "bottom.nc").write_text("(STOCK/BLOCK, 70, 50, 6, 0, 0, 0)\n" + PROGRAM)
    run = kerf("level", "--json", "--over", "bottom.nc", "-o", "bottom-probe.nc")
    assert run.status == 0 and "heights_unmatched" in run.codes()
    assert "heights_unmatched" not in kerf("level", "--json", "--over", "part.nc", "-o", "probe.nc").codes()
    # 60 x 40 mm: a margin of -20 mm leaves a line.
    assert kerf("level", "--over", "part.nc", "--margin", "-19").status == 0
    run = kerf("level", "--json", "--over", "part.nc", "--margin", "-20")
    assert run.status == 1 and "level_map" in run.codes()
    assert kerf("level", "--grid", "2x2", "--over", "part.nc", "--to", "linuxcnc").out.count("G38.2") == 4


# ------------------------------------------------------------------------- what comes back from machines

def surface_of(kerf, tmp_path, content, *options, name="map"):
    """The points that kerf level --read finds, as {(x, y): z}, and the codes of its messages."""
    (tmp_path / name).write_text(content)
    run = kerf("level", "--json", "--read", name, *options, "-o", "points.txt")
    assert run.status == 0, run.out + run.err
    rows = [row.split() for row in (tmp_path / "points.txt").read_text().splitlines()]
    return {(float(x), float(y)): float(z) for x, y, z in rows}, run.codes()


CORNERS = {(0, 0): 0.1, (10, 0): 0.2, (0, 20): -0.1, (10, 20): 0.3}


def log_lines(offset, corners=None):
    return [f"[PRB:{x + offset[0]:.3f},{y + offset[1]:.3f},{z + offset[2]:.3f}:1]"
            for (x, y), z in (corners or CORNERS).items()]


def test_the_offset_in_force_before_each_probe_counts(kerf, tmp_path):
    log = ["<Idle|MPos:0,0,0|FS:0,0|WCO:100.000,50.000,-30.000>", *log_lines((100, 50, -30)), "ok"]
    points, codes = surface_of(kerf, tmp_path, "\n".join(log))
    assert points == CORNERS and codes == []
    # The zero is set again after the probes: the heights stay above the one in force before.
    points, codes = surface_of(kerf, tmp_path, "\n".join([*log, "<Idle|MPos:0,0,0|WCO:100,50,-29.400>"]))
    assert points == CORNERS and codes == ["heights_offset"]
    # And between them.
    first, second = log_lines((100, 50, -30))[:2], log_lines((100, 50, -29))[2:]
    points, codes = surface_of(kerf, tmp_path, "\n".join(
        ["<Idle|WCO:100,50,-30>", *first, "<Idle|WCO:100,50,-29>", *second]))
    assert points == CORNERS and codes == ["heights_offset"]


def test_the_active_system_counts(kerf, tmp_path):
    answer = ["[G54:1,2,3]", "[G55:100,50,-31]", "[G28:0,0,0]", "[G92:0,0,0.5]", "[TLO:0.5]"]
    log = ["[GC:G0 G55 G17 G21 G90]", *answer, "[PRB:0,0,-77:1]", "ok", *log_lines((100, 50, -30))]
    points, codes = surface_of(kerf, tmp_path, "\n".join(log))
    assert points == CORNERS and codes == ["heights_left_out"]


def test_probes_that_are_no_points_of_the_surface(kerf, tmp_path):
    start = ["<Idle|WCO:100,50,-25.000>"]
    touch = ["[PRB:90.000,40.000,-15.010:1]", "[PRB:90.000,40.000,-15.000:1]", "<Idle|WCO:100,50,-30.000>"]
    points, codes = surface_of(kerf, tmp_path, "\n".join([*start, *touch, *log_lines((100, 50, -30))]))
    assert points == CORNERS and codes == ["heights_left_out"] * 2
    edge = ["<Idle|WCO:100,50,-30>", "> G38.2 X-20 F100", "[PRB:80.000,40.000,-33.000:1]"]
    sent = [line for probe in log_lines((100, 50, -30)) for line in ("> G38.2 Z-2 F50", probe, "ok")]
    points, codes = surface_of(kerf, tmp_path, "\n".join([*edge, *sent]))
    assert points == CORNERS and codes == ["heights_left_out"]


CANDLE = "0;0;10;20\n2;2;-1;1\n0;1;1\n0.1;0.2\n-0.1;0.3\n"
XML = """<?xml version="1.0" encoding="utf-8"?>
<heightmap MinX="0" MinY="0" MaxX="10" MaxY="20" SizeX="2" SizeY="2">
  <point X="0" Y="0">0.1</point><point X="1" Y="0">0.2</point>
  <point X="0" Y="1">-0.1</point>
  <point X="1" Y="1">0.3</point>
</heightmap>"""
GSENDER = json.dumps({"bounds": {"minX": 0, "maxX": 10}, "resolution": {"x": 2, "y": 2}, "units": "mm",
                      "points": [{"x": x, "y": y, "z": z} for (x, y), z in CORNERS.items()]})
DUET = """RepRapFirmware height map file v2 generated at 2024-05-01 10:00, min error -0.100, max error 0.300
axis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1
X,Y,0.00,10.00,0.00,20.00,-1.00,10.00,20.00,2,2
  0.100,  0.200
 -0.100,  0.300
"""
OLD_DUET = """RepRapFirmware height map file v1
xmin,xmax,ymin,ymax,radius,spacing,xnum,ynum
0.00,10.00,0.00,20.00,-1.00,10.00,2,3
  0.100,  0.200
      0,      0
 -0.100,  0.300
"""
KLIPPER = """[printer]
kinematics: cartesian
#*# <---------------------- SAVE_CONFIG ---------------------->
#*# [bed_mesh default]
#*# version = 1
#*# points =
#*# \t  0.100000, 0.200000
#*# \t  -0.100000, 0.300000
#*# x_count = 2
#*# min_x = 0.0
#*# min_y = 0.0
#*# max_x = 10.0
#*# max_y = 20.0
"""
MESH = json.dumps({"result": {"status": {"bed_mesh": {
    "mesh_min": [0, 0], "mesh_max": [10, 20], "probed_matrix": [[0.1, 0.2], [-0.1, 0.3]]}}}})
MARLIN = "".join(f"echo: x\nBed X: {x:.2f} Y: {y:.2f} Z: {z:.3f}\nok\n" for (x, y), z in CORNERS.items())
PROBE = "".join(f"// probe at {x:.3f},{y:.3f} is z={z:.6f}\n" for (x, y), z in CORNERS.items())


@pytest.mark.parametrize("content", [CANDLE, XML, "\ufeff" + XML, GSENDER, DUET, OLD_DUET, KLIPPER, MESH,
                                     MARLIN, PROBE])
def test_maps_of_senders_and_firmware(kerf, tmp_path, content):
    points, codes = surface_of(kerf, tmp_path, content)
    assert points == CORNERS and codes == []


@pytest.mark.parametrize("content", [
    "Bilinear Leveling Grid:\n      0      1\n 0 +0.100 +0.200\n 1 -0.100 +0.300\n\n",
    "// Mesh Leveling Probed Z positions:\n  0.1 0.2\n  -0.1 0.3\nok\n"])
def test_grids_without_positions(kerf, tmp_path, content):
    points, codes = surface_of(kerf, tmp_path, content, "--map-area", "0,0,10,20")
    assert points == CORNERS and codes == []
    run = kerf("level", "--json", "--read", "map")
    assert run.status == 1 and run.codes() == ["heights_missing"]
    assert "--map-area" in run.out


@pytest.mark.parametrize("content", [
    CANDLE + "1;1\n", CANDLE[:-9], CANDLE.replace("0.1;0.2", "0.1"),
    XML.replace('X="1" Y="1"', 'X="2" Y="1"'),
    XML.replace('SizeX="2"', ""), XML.replace("0.3<", "a<"), GSENDER[:-1], '{"points": []}',
    DUET.replace(",2,2", ",2,3"), DUET.replace("num0", "n"), KLIPPER.replace("min_x", "min"),
    "Bilinear Leveling Grid:\n\n", "Bed X: 1 Y: 2\n",
    # Cut off, points missing or given twice, numbers that contradict the size.
    XML[:-14], XML[:-40], XML.replace('<point X="1" Y="0">0.2</point>', ""),
    XML.replace('SizeY="2"', 'SizeY="3"'),
    XML.replace('X="1" Y="0"', 'X="0" Y="0"'), XML.replace('MaxX="10"', 'MaxX="-10"'),
    GSENDER.replace('"maxX": 10', '"maxX": 12'), GSENDER.replace('"x": 10, "y": 0', '"x": 10, "y": 1'),
    GSENDER.replace('"z": 0.2', '"z": null'),
    GSENDER.replace('"resolution": {"x": 2', '"resolution": {"x": 3'),
    MESH.replace("0.2", "null"), MESH.replace("[-0.1, 0.3]", "[-0.1]"), MESH.replace("[10, 20]", "[10, 0]"),
    DUET.replace("20.00,2,2", "9.00,2,2"), DUET.replace("X,Y,0.00", "Y,X,0.00"),
    DUET.replace("  0.200", "  nan"),
    DUET.replace(",-1.00", ""), KLIPPER.replace("x_count = 2", "x_count = 3"),
    KLIPPER.replace("#*# x_count = 2", "#*# y_count = 3"), KLIPPER.replace("-0.100000", "-0.1x"),
    KLIPPER.replace("max_x = 10.0", "max_x = -1"), CANDLE.replace("0;0;10;20", "0;0;0;20"),
    CANDLE.replace("2;2;-1;1", "2;2.5;-1;1"), CANDLE.replace("0.1;0.2", "0.1;;0.2"), CANDLE[10:]])
def test_maps_with_contradictions_are_refused(kerf, tmp_path, content):
    (tmp_path / "map").write_text(content)
    run = kerf("level", "--json", "--read", "map")
    assert run.status == 1 and run.codes() in (["heights_format"], ["heights_missing"])


BCNC = "0 10 2\n0 20 2\n-2 3 100\n\n\n" + "".join(f"{x} {y} {z}\n" for (x, y), z in CORNERS.items())


@pytest.mark.parametrize("name", ["map.probe", "map.txt"])
@pytest.mark.parametrize("change, line", [
    (("10 0 0.2\n", ""), 8), (("0 10 2", "0 10 3"), 9), (("0 20 2", "0 30 2"), 8), (("0 20 2", "20 0 2"), 2),
    (("10 20 0.3", "10 20 0.3x"), 9), (("10 20 0.3", "10 20 nan"), 9), (("10 20 0.3", "10 0 0.3"), 9),
    (("10 20 0.3", "10 20"), 9), (("10 20 0.3", "10 20 0.3\n20 20 0.4"), 10), (("-2 3 100\n", ""), 5),
    (("0 10 2\n", ""), 5), (("-2 3 100", "-2 3"), 3)])
def test_a_map_of_bcnc_is_never_read_as_points(kerf, tmp_path, name, change, line):
    """The lines with limits and counts were points of the surface where the map contradicts them."""
    (tmp_path / name).write_text(BCNC)
    run = kerf("level", "--json", "--read", name)
    assert run.status == 0 and run.json["points"] == 4 and run.json["high"] == [10, 20]
    (tmp_path / name).write_text(BCNC.replace(*change))
    run = kerf("level", "--json", "--read", name)
    assert run.status == 1 and run.codes() == ["heights_format"], run.out
    origin = run.json["diagnostics"][0]["origin"]
    assert origin["file"] == name and origin["line"] == line, run.out
    assert "expected" in run.out or "missing" in run.out or "second time" in run.out


@pytest.mark.parametrize("header, order", [
    ("N;X;Y;Z", "{n};{x};{y};{z}"), ("Y;X;Z", "{y};{x};{z}"), ("x,y,z,comment", "{x},{y},{z},at {n}"),
    ("# z y x", "{z} {y} {x}"), ("X (mm)\tY (mm)\tZ (mm)", "{x}\t{y}\t{z}")])
def test_columns_are_taken_by_their_names(kerf, tmp_path, header, order):
    rows = [order.format(n=n, x=x, y=y, z=z) for n, ((x, y), z) in enumerate(CORNERS.items())]
    points, codes = surface_of(kerf, tmp_path, "\n".join([header, *rows]) + "\n")
    assert points == CORNERS and codes == []


def test_names_of_columns_that_are_unknown_are_an_error(kerf, tmp_path):
    for header in ("A;B;C", "x;y;height2", "x;y", "x;y;z;z", "north;east;up"):
        (tmp_path / "map.csv").write_text(header + "\n1;2;3\n5;2;3\n1;6;3\n")
        run = kerf("level", "--json", "--read", "map.csv")
        assert run.status == 1 and run.codes() == ["heights_format"]
        assert run.json["diagnostics"][0]["origin"]["line"] == 1 and "x, y and z" in run.out


def test_two_heights_at_one_position_are_a_warning(kerf, tmp_path):
    points, codes = surface_of(kerf, tmp_path, "0 0 0.1\n10 0 0.2\n0 20 0\n10 20 0\n10 0 0.5\n")
    assert codes == ["heights_repeated"] and points[10, 0] == 0.5
    run = kerf("level", "--read", "map")
    assert "map:5" in run.err and "line 2" in run.err and "0.300 mm" in run.err


@pytest.mark.parametrize("bad", ["nan", "inf", "", "1e999", "-"])
def test_heights_that_are_no_numbers_are_errors_with_their_line(kerf, tmp_path, bad):
    (tmp_path / "map").write_text(f"0;0;0.1\n10;0;{bad}\n0;20;0.3\n")
    run = kerf("level", "--json", "--read", "map")
    assert run.status == 1 and run.codes() == ["heights_format"]
    assert run.json["diagnostics"][0]["origin"]["line"] == 2


def test_a_zero_outside_of_the_map_is_a_warning_with_the_distance(kerf, tmp_path):
    content = "".join(f"{x} {y} {z}\n" for (x, y), z in CORNERS.items())
    points, codes = surface_of(kerf, tmp_path, content, "--map-zero", "13,24")  # 3 and 4 mm beyond 10, 20
    assert codes == ["level_outside"] and points[10, 20] == 0
    assert "5.00 mm outside" in kerf("level", "--read", "map", "--map-zero", "13,24").err
    assert surface_of(kerf, tmp_path, content, "--map-zero", "10,20")[1] == []


def test_outputs_of_other_forms_are_refused(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    (tmp_path / "map").write_text(CANDLE)
    for name in ("map.pdf", "map.PDF", "map.nc"):
        run = kerf("level", "--read", "map", "-o", name)
        assert run.status == 2 and ".png, .svg, .txt, .xyz" in run.err and not (tmp_path / name).exists()
    for name in ("map.png", "map.svg"):
        run = kerf("level", "--over", "part.nc", "-o", name)
        assert run.status == 2 and "--read" in run.err and not (tmp_path / name).exists()
    for name in ("map.png", "map.svg"):
        assert kerf("level", "--read", "map", "-o", name).status == 0
        run = kerf("level", "--json", "--read", name)  # a picture of a map is none
        assert run.status == 1 and run.codes() == ["heights_format"]
        assert "PNG picture" in run.out or "no height map" in run.out


@pytest.mark.skipif(not MAPS.is_dir(), reason="KERF_CASES_DIR names no folder with heights; skipped")
def test_real_maps_are_read_or_refused_with_one_reason(kerf):
    run = kerf("level", "--json", "--read", MAPS / "heightmap_lens.map")
    assert run.status == 0 and run.json["points"] == 49
    assert run.json["high"] == [30, 30] and run.json["highest"] == 0.021
    # Its second line states 4 rows, and it has 5.
    run = kerf("level", "--json", "--read", MAPS / "candle.map")
    assert run.status == 1 and run.codes() == ["heights_format"]


def test_units_and_zeros_of_maps(kerf, tmp_path):
    rows = "".join(f"{x / 25.4:.8f} {y / 25.4:.8f} {(z + 40) / 25.4:.8f}\n" for (x, y), z in CORNERS.items())
    points, _ = surface_of(kerf, tmp_path, rows, "--map-unit", "inch", "--map-zero", "0,0")
    assert points == pytest.approx({at: z - 0.1 for at, z in CORNERS.items()}, abs=1e-4)
    points, _ = surface_of(kerf, tmp_path, rows, "--map-unit", "inch", "--map-zero", "mean")
    assert points == pytest.approx({at: z - 0.125 for at, z in CORNERS.items()}, abs=1e-4)
    (tmp_path / "part.nc").write_text("G21 G90 G0 Z5\nG0 X0 Y0\nG1 Z-1 F100\nX10\nG0 Z5\nM2\n")
    run = kerf("post", "--to", "grbl", "--level", "map", "--map-unit", "inch", "--map-zero", "10,20",
               "part.nc")
    assert run.status == 0 and "Z-1.2" in run.out and "Z-1.1" in run.out
    for options in (["--map-unit", "ell"], ["--map-zero", "1"], ["--map-area", "0,0,-1,2"]):
        assert kerf("level", "--read", "map", *options).status == 2


def test_outliers_are_marked(kerf, tmp_path):
    rows = points(bowl, 7, 5)
    x, y, z = rows[17]
    rows[17] = (x, y, z + 0.4)
    write_map(tmp_path, rows)
    for picture in ("map.png", "map.svg"):
        run = kerf("level", "--json", "--read", "map.txt", "-o", picture)
        assert run.status == 0 and run.codes() == ["level_outlier"]
        assert [o[:2] for o in run.json["outliers"]] == [[x, pytest.approx(y)]]
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "map.svg").read_text().count('class="outlier"') == 1
    write_map(tmp_path, points(bowl, 7, 5))
    assert kerf("level", "--json", "--read", "map.txt").codes() == []


@pytest.mark.parametrize("post, words", [
    ("grblhal", ["G38.2"]), ("linuxcnc", ["(PROBEOPEN probe.txt)", "G38.2", "(PROBECLOSE)", "M2"]),
    ("mach3", ["M40", "G31", "M41", "M30"]), ("marlin", ["G30 X0 Y0", "G30 X60 Y40"]),
    ("klipper", ["G1 X0 Y0", "PROBE"]), ("reprapfirmware", ["M557 X0:60 Y0:40 P3:2", "G29 S0"])])
def test_each_controller_stores_or_shows_what_it_measures(kerf, tmp_path, post, words):
    (tmp_path / "part.nc").write_text(PROGRAM)
    run = kerf("level", "--json", "--grid", "3x2", "--over", "part.nc", "--to", post, "-o", "probe.nc")
    assert run.status == 0 and run.codes() == [], run.out
    text = (tmp_path / "probe.nc").read_text()
    at = [text.find(word) for word in words]
    assert -1 not in at and at == sorted(at), text
    # The probe is lifted before the first point and after the last one.
    lifts = [m.start() for m in re.finditer(r"\bG[01] Z\d", text)]
    measured = [m.start() for m in re.finditer(r"^(G38\.2|G31|G30|PROBE PROBE)", text, re.M)]
    assert post == "reprapfirmware" or lifts[0] < measured[0] < measured[-1] < lifts[-1], text
    assert run.json["result"]
    # 6 points of 5 mm at 50 mm/min alone are 36 s.
    assert 36 < run.json["seconds"] < 60


def test_controllers_that_keep_nothing(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    run = kerf("level", "--json", "--over", "part.nc", "--to", "carbide", "-o", "probe.nc")
    assert run.status == 1 and run.codes() == ["level_controller"] and not (tmp_path / "probe.nc").exists()
    for post in ("plain", "prusa"):  # they have no code for probes: one message for all 25 points
        run = kerf("level", "--json", "--over", "part.nc", "--to", post)
        assert run.status == 1 and run.codes() == ["post_cannot"]
        assert "G38.2" in run.out and "25 points" in run.out and "G38.3" not in run.out
    assert kerf("level").status == 2


def test_cuts_at_unknown_positions_are_refused_with_their_line(kerf, tmp_path):
    write_map(tmp_path, points(slope))
    for line, gcode in ((3, "G21 G91\nG0 Z5\nG1 Z-6 F100\nG1 X20\nG0 Z5\nM2\n"),
                        (4, "G21 G90\nG0 Z5\nG0 X0 Y0\nG53 G1 Z-50 F100\nM2\n")):
        (tmp_path / "part.nc").write_text(gcode)
        run = kerf("post", "--json", "--to", "linuxcnc", "--level", "map.txt", "part.nc", "-o", "out.nc")
        assert run.status == 1 and run.codes() == ["level_motion"]
        assert run.json["diagnostics"][0]["origin"]["line"] == line
        assert not (tmp_path / "out.nc").exists()


@pytest.mark.parametrize("gcode, heights", [
    # G91 from a known position, G43 before the first position, and a shift whose position is known
    ("G21 G90\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\nG91\nG1 X60\nG1 Y40\nG90\nG0 Z5\nM2\n",
     [(0, 0), (60, 0), (60, 40)]),
    ("G21 G90\nG0 G43 H1 Z5\nG0 X60 Y0\nG1 Z-1 F100\nG1 Y40\nG0 Z5\nM2\n", [(60, 0), (60, 40)]),
    ("G21 G90\nG0 Z5\nG0 X60 Y0\nG92 X0 Y0\nG1 Z-1 F100\nG1 Y40\nG0 Z5\nM2\n", [(60, 0), (60, 40)])])
def test_relative_and_shifted_motions_are_levelled(kerf, tmp_path, gcode, heights):
    (tmp_path / "part.nc").write_text(gcode)
    write_map(tmp_path, points(slope))
    assert kerf("post", "--to", "linuxcnc", "--level", "map.txt", "part.nc", "-o", "out.nc").status == 0
    ends = [json.loads(row)["to"] for row in kerf("steps", "out.nc").out.splitlines()[1:]
            if json.loads(row)["step"] == "cut"]
    assert [z for _, _, z in ends] == pytest.approx([-1 + slope(x, y) for x, y in heights], abs=0.001)




def board_mesh(tmp_path, surface, low=-1.6):
    """A board of 60 x 40 mm whose top is `surface`, as a closed ASCII STL."""
    xs, ys = [2.0 * i for i in range(31)], [2.0 * j for j in range(21)]
    facets = []

    def quad(a, b, c, d):
        facets.extend([(a, b, c), (a, c, d)])

    for x0, x1 in zip(xs, xs[1:]):
        for y0, y1 in zip(ys, ys[1:]):
            corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            quad(*[(x, y, surface(x, y)) for x, y in corners])
            quad(*[(x, y, low) for x, y in reversed(corners)])
    rim = [(x, 0.0) for x in xs] + [(60.0, y) for y in ys[1:]] + [(x, 40.0) for x in reversed(xs[:-1])] + [
        (0.0, y) for y in reversed(ys[1:-1])]
    for (x0, y0), (x1, y1) in zip(rim, rim[1:] + rim[:1]):
        quad((x0, y0, low), (x1, y1, low), (x1, y1, surface(x1, y1)), (x0, y0, surface(x0, y0)))
    text = "".join("facet normal 0 0 0\nouter loop\n"
                   + "".join("vertex {:.6f} {:.6f} {:.6f}\n".format(*p) for p in facet)
                   + "endloop\nendfacet\n" for facet in facets)
    (tmp_path / "board.stl").write_text(f"solid board\n{text}endsolid board\n")
    return "board.stl"


def stored_by_controller(to, probed):
    """The log of GRBL, in machine coordinates, and LinuxCNC's file of PROBEOPEN, in those of the program."""
    if to == "grbl":
        return "<Idle|MPos:0,0,0|WCO:-250.000,-180.000,-41.500>\n" + "".join(
            f"[PRB:{x - 250:.3f},{y - 180:.3f},{z - 41.5:.3f}:1]\nok\n" for x, y, z in probed)
    return "".join(f"{x:.6f} {y:.6f} {z:.6f} 0 0 0 0 0 0\n" for x, y, z in probed)


@pytest.mark.parametrize("to", ["grbl", "linuxcnc"])
def test_a_board_is_probed_levelled_and_cut(kerf, tmp_path, to):
    """Traces are isolated 0.1 mm deep on a board that is curved by 0.3 mm: depths are right to 0.01 mm."""
    depth = 0.1
    (tmp_path / "art.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
        '<rect x="8" y="8" width="44" height="3"/><rect x="8" y="28" width="44" height="3"/>'
        '<circle cx="30" cy="20" r="5"/></svg>')
    tool = "v angle=30 d=3.175 tip=0.1 flute=6"
    cut = kerf("cut", "art.svg", "--op", "isolation", "--depth", depth, "--tool", tool, "--feed", 300,
               "--plunge", 100, "--entry", "plunge", "--rpm", 20000, "--stock", "60x40x1.6",
               "--to", to, "-o", "flat.nc")
    assert cut.status == 0, cut.err
    run = kerf("level", "--grid", "7x5", "--over", "flat.nc", "--to", to, "-o", "probe.nc")
    assert run.status == 0, run.err
    steps = [json.loads(row) for row in kerf("steps", "probe.nc").out.splitlines()[1:]]
    points_probed = [s["to"][:2] for s in steps if s["step"] == "probe"]
    assert len(points_probed) == 35
    probed = [(x, y, bowl(x, y)) for x, y in points_probed]
    (tmp_path / "stored.txt").write_text(stored_by_controller(to, probed))
    run = kerf("post", "--to", to, "--level", "stored.txt", "flat.nc", "-o", "level.nc")
    assert run.status == 0, run.err
    below = [[z - bowl(x, y) for x, y, z in cut] for cut in cuts(kerf, "level.nc")]
    level = [z for heights in below if abs(heights[0] - heights[-1]) < 0.03 for z in heights]  # no plunge
    assert len(level) > 1000 and max(abs(z + depth) for z in level) < 0.01
    # The same in simulation: what is removed of the curved board, and of a flat one by the program before.
    board = board_mesh(tmp_path, bowl)
    curved = kerf("simulate", "--json", "--resolution", 0.05, "level.nc", "--stock-mesh", board).json
    flat = kerf("simulate", "--json", "--resolution", 0.05, "flat.nc", "--stock", "0,0,-1.6 to 60,40,0").json
    assert curved["removed_mm3"] == pytest.approx(flat["removed_mm3"], rel=0.05)


@pytest.mark.parametrize("content", [
    "0 0 0.1\n40 0 0.2\n0 30 0.3\n40 30 0.2\n", "0;0;0,1\n40;0;0,2\n0;30;0,3\n40;30;0,2\n"])
def test_a_mark_of_utf_8_is_no_part_of_a_map(kerf, tmp_path, content):
    for name, text in (("plain.txt", content), ("marked.txt", "\ufeff" + content)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    runs = [kerf("level", "--read", name, "-o", "-") for name in ("plain.txt", "marked.txt")]
    assert runs[0].status == runs[1].status == 0 and runs[0].out == runs[1].out


def test_fluidnc_shows_what_it_measures(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    run = kerf("level", "--grid", "3x3", "--over", "part.nc", "--to", "fluidnc", "-o", "probe.nc")
    assert run.status == 0 and "save the console log" in run.out + run.err and "unknown" not in run.err


def test_a_zero_at_the_height_of_the_tool_is_refused(kerf, tmp_path):
    """G10 L20 P1 Z0 takes the levelled height as zero: what follows would be corrected twice."""
    (tmp_path / "part.nc").write_text("G21 G90 G17 G94\nG0 Z5\nM3 S100\nG0 X30 Y20\nG1 Z1 F100\n"
                                      "G10 L20 P1 Z0\nG1 Z-1\nG1 X10\nM2\n")
    write_map(tmp_path, points(lambda x, y: 0.5, columns=3, rows=3))
    run = kerf("post", "--to", "linuxcnc", "--level", "map.txt", "part.nc", "-o", "out.nc")
    assert run.status == 1 and "part.nc:6" in run.err and "G10 L20" in run.err
    assert not (tmp_path / "out.nc").exists()

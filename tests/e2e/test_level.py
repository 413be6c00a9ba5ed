"""kerf post --level and kerf level: motions that follow a measured surface, and programs that measure one."""

import json
import math

import pytest

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

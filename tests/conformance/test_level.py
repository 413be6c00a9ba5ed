"""Levelled programs in LinuxCNC's interpreter: accepted, and every cut follows the measured surface."""
import math
import os
import subprocess

import pytest
import rs274

if not rs274.is_installed():
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)

TOLERANCE = 0.01  # mm between a cut and the surface raised by the cut's height in the program
PROGRAM = """G21 G90 G17 G94
S10000 M3
G0 Z5
G0 X0 Y0
G1 Z-1 F100
G1 X60 F400
G1 Y40
G1 X0 Y0
G0 Z5
G0 X30 Y20
G1 Z-1 F100
G2 X30 Y20 I10 J0 F300
G0 Z5
M2
"""
SURFACES = {
    "level": lambda x, y: 0.25,
    "slope": lambda x, y: 0.01 * x - 0.004 * y + 0.05,
    "bowl": lambda x, y: 0.3 * ((x - 30) / 40) ** 2 - 0.2 * (y / 40) + 0.1,
}


def points_along(start, move):
    """Points of a straight cut or of an arc in XY, at most 0.5 mm apart."""
    end = move[1:4]
    if move[0] == "C":
        n = max(1, math.ceil(math.dist(start, end) / 0.5))
        return [[a + (b - a) * k / n for a, b in zip(start, end)] for k in range(n + 1)]
    cx, cy, turns = move[4], move[5], move[6]
    radius = math.hypot(start[0] - cx, start[1] - cy)
    first = math.atan2(start[1] - cy, start[0] - cx)
    sweep = (math.atan2(end[1] - cy, end[0] - cx) - first) % (2 * math.pi)
    if turns < 0:
        sweep -= 2 * math.pi
    if abs(sweep) < 1e-6 or abs(abs(sweep) - 2 * math.pi) < 1e-6:
        sweep = math.copysign(2 * math.pi, turns)
    n = max(2, math.ceil(abs(sweep) * radius / 0.5))
    return [[cx + radius * math.cos(first + sweep * k / n), cy + radius * math.sin(first + sweep * k / n),
             start[2] + (end[2] - start[2]) * k / n] for k in range(n + 1)]


@pytest.mark.parametrize("name", SURFACES)
def test_cuts_follow_the_surface(name, tmp_path):
    surface = SURFACES[name]
    (tmp_path / "part.nc").write_text(PROGRAM)
    (tmp_path / "map.txt").write_text("".join(
        f"{x} {y} {surface(x, y):.6f}\n" for y in range(0, 41, 2) for x in range(0, 61, 2)))
    words = "post --to linuxcnc --level map.txt part.nc -o out.ngc".split()
    done = subprocess.run([os.environ["KERF"], *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    moves, refused = rs274.moves_of((tmp_path / "out.ngc").read_text())
    assert refused is None
    at, length = None, 0.0
    for move in moves:
        if move[0] == "D":
            continue
        if move[0] == "A" or (move[0] == "C" and math.dist(at[:2], move[1:3]) > 1e-6):
            points = points_along(at, move)
            for x, y, z in points:
                assert z - surface(x, y) == pytest.approx(-1.0, abs=TOLERANCE), (move, x, y)
            length += sum(math.dist(a[:2], b[:2]) for a, b in zip(points, points[1:]))
        at = move[1:4]
    # 60 + 40 + the diagonal of the triangle, and a circle of radius 10
    assert length == pytest.approx(100 + math.hypot(60, 40) + 20 * math.pi, rel=1e-3)

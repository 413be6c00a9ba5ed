"""Volumes removed by each shape of tool, against integrals over its profile: r(z) is written here again from
the drawing of the shape, and the integrals are sums of 20,000 slices.  A plunge removes the body of
revolution, a level slot also twice the profile's area times its length."""
import math

import pytest

# Shape, profile r(z) from the tip upwards, depth of the cut.
TOOLS = {
    "square d=6 flute=12": (lambda z: 3.0, 4.0),
    "ball d=6 flute=12": (lambda z: math.sqrt(max(9.0 - (3.0 - z) ** 2, 0.0)) if z < 3 else 3.0, 5.0),
    "ball d=8 flute=16": (lambda z: math.sqrt(max(16.0 - (4.0 - z) ** 2, 0.0)) if z < 4 else 4.0, 2.0),
    "bull nose d=8 r=2 flute=12": (
        lambda z: 2.0 + math.sqrt(max(4.0 - (2.0 - z) ** 2, 0.0)) if z < 2 else 4.0, 3.0),
    "V d=12 angle=90 flute=8": (lambda z: min(z, 6.0), 5.0),
    "V d=12 angle=60 flute=12": (lambda z: min(z * math.tan(math.radians(30)), 6.0), 4.0),
    "drill d=5 angle=118 flute=20": (lambda z: min(z * math.tan(math.radians(59)), 2.5), 6.0),
    "chamfer d=10 angle=90 tip_diameter=2 flute=8": (lambda z: min(1.0 + z, 5.0), 3.0),
    "flat groove d=6 flute=6 tip_diameter=3": (lambda z: min(1.5 + 0.25 * z, 3.0), 4.0),
    "roundover tip_diameter=6 r=4 flute=10": (
        lambda z: 3.0 + 4.0 - math.sqrt(max(16.0 - z * z, 0.0)) if z < 4 else 7.0, 3.5),
}
UNDERCUT = {  # enter through the side of the stock
    "dovetail d=12 flute=8 angle=14": (lambda z: 6.0 - z * math.tan(math.radians(14)), 6.0),
    "T-slot d=14 thickness=3 neck_diameter=6 flute=9": (lambda z: 7.0 if z < 3 else 3.0, 7.0),
    "keyhole d=10 head=4 neck_diameter=5 flute=10": (lambda z: 5.0 if z < 4 else 2.5, 8.0),
}
SLICES = 20_000
LENGTH = 20.0


def integral(f, depth):
    return sum(f((k + 0.5) * depth / SLICES) for k in range(SLICES)) * depth / SLICES


def removed(kerf, program, body, tool, stock):
    part = program(f"G21 G90\nT1 M6\nM3 S9000\n{body}M5\nM30\n")
    run = kerf("simulate", "--json", "--resolution", "0.02", "--stock", stock, "--tool", f"1 = {tool}", part)
    assert run.status in (0, 3), run.err  # a plunge with a wide flat tip may be a finding
    return run.json["removed_mm3"]


@pytest.mark.parametrize("tool", TOOLS)
def test_plunge(kerf, program, tool):
    r, depth = TOOLS[tool]
    body = f"G0 X0 Y0 Z5\nG1 Z{-depth} F100\nG1 Z5\n"
    wanted = integral(lambda z: math.pi * r(z) ** 2, depth)
    assert removed(kerf, program, body, tool, "-10,-10,-10 to 10,10,0") == pytest.approx(wanted, rel=2e-3)


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("angle", [0, 33, 90])
def test_slot(kerf, program, tool, angle):
    r, depth = TOOLS[tool]
    x, y = LENGTH * math.cos(math.radians(angle)), LENGTH * math.sin(math.radians(angle))
    body = f"G0 X0 Y0 Z5\nG1 Z{-depth} F100\nX{x:.6f} Y{y:.6f} F400\nG0 Z5\n"
    wanted = integral(lambda z: math.pi * r(z) ** 2 + 2.0 * LENGTH * r(z), depth)
    assert removed(kerf, program, body, tool, "-8,-8,-10 to 30,30,0") == pytest.approx(wanted, rel=1e-3)


@pytest.mark.parametrize("tool", UNDERCUT)
def test_through_the_stock(kerf, program, tool):
    r, depth = UNDERCUT[tool]
    body = f"G0 X-20 Y0 Z5\nG0 Z{-depth}\nG1 X50 F300\nG0 Z5\n"
    wanted = integral(lambda z: 2.0 * 30.0 * r(z), depth)
    assert removed(kerf, program, body, tool, "0,-10,-12 to 30,10,0") == pytest.approx(wanted, rel=1e-3)

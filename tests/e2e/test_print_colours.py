"""Prints in the colours of what their beads are for and how they are printed; the volume against a target."""
import json
import struct

import pytest
from test_first_try import pixels

# Two layers of one bead each: 20 x 3 x 2 mm at 1200 mm/min and 200 C, then at 2400 mm/min and 220 C.
PRINT = """; filament_diameter = 1.75
M83
M109 S200
;LAYER_CHANGE
;HEIGHT:2
;TYPE:External perimeter
G1 X0 Y0 Z2 F9000
G1 X20 E{e} F1200
M109 S220
;LAYER_CHANGE
;TYPE:Top solid infill
G1 X0 Z4 F9000
G1 X20 E{e} F2400
"""
VOLUME = (1 * 2 + 3.141592653589793) * 20  # mm3 of a bead
FILAMENT = VOLUME / (3.141592653589793 / 4 * 1.75 ** 2)


@pytest.fixture
def part(program):
    return program(PRINT.format(e=FILAMENT), "p.gcode")


@pytest.mark.parametrize("what, names", [
    ("kind", ["outer_wall", "top"]), ("layer", ["2 to 2.17 mm", "3.83 to 4 mm"]),
    ("speed", ["1200 to 1300 mm/min", "2300 to 2400 mm/min"]),
    ("flow", ["102.83 to 111.4 mm3/s", "197.09 to 205.66 mm3/s"]),
    ("temperature", ["200 to 201.67 C", "218.33 to 220 C"]),
])
def test_the_legend_and_the_picture(kerf, part, folder_bytes, what, names):
    run = kerf("simulate", "--json", part, "--colour", what, "-o", "p.png", "-o", "p.glb", "--view", "front",
               "--size", "400x300")
    assert run.status == 0, run.err
    legend = {c["name"]: c["colour"] for c in run.json["colours"]}
    assert list(legend) == ["hazard", *names]
    _, _, rows = pixels(folder_bytes()["p.png"])

    def nearest(name):
        r, g, b = (int(legend[name][i:i + 2], 16) for i in (1, 3, 5))
        return [y for y, row in enumerate(rows) if min(abs(p[0] - r) + abs(p[1] - g) + abs(p[2] - b)
                                                       for p in row) < 60]
    low, high = nearest(names[0]), nearest(names[1])
    assert low and high and min(high) < min(low)  # the second layer is above the first
    glb = folder_bytes()["p.glb"]
    length = struct.unpack_from("<I", glb, 12)[0]
    assert {names[0], names[1]} <= {m["name"] for m in json.loads(glb[20:20 + length])["materials"]}


def test_without_the_option_a_print_has_one_colour(kerf, part):
    assert "colours" not in kerf("simulate", "--json", part).json
    assert kerf("simulate", part, "--colour", "mood").status == 2
    run = kerf("simulate", "--json", part, "--color", "kind")
    assert len(run.json["colours"]) == 3


def test_no_effect_on_a_mill(kerf, program):
    run = kerf("simulate", "--json", program(), "--colour", "kind")
    assert run.status == 0 and "option_unused" in run.codes()


def test_the_volume_against_a_target(kerf, part, tmp_path):
    """A box of 20 x 3 x 4 mm as an ASCII STL."""
    x, y, z = 20.0, 3.0, 4.0
    v = [(i & 1 and x, i & 2 and y, i & 4 and z) for i in range(8)]
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7),
             (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    lines = ["solid box"]
    for face in faces:
        corners = [f"vertex {v[k][0]} {v[k][1]} {v[k][2]}" for k in face]
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    (tmp_path / "box.stl").write_text("\n".join([*lines, "endsolid box"]))
    info = kerf("info", "--json", part, "--target", "box.stl").json
    assert info["target"]["target_mm3"] == pytest.approx(240, rel=1e-6)
    assert info["target"]["part_mm3"] == pytest.approx(2 * VOLUME, rel=1e-4)
    assert "85.7%" in kerf("info", part, "--target", "box.stl").out
    assert kerf("info", part, "--target", "none.stl").status == 1

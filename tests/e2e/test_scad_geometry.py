"""Areas and solids of OpenSCAD programs: their volumes and sizes in closed form, and what they import."""
import math
import re
import struct
from pathlib import Path

import pytest

PI = math.pi
ABOVE = "gcp = gcodepreview();\nrapid(1, 1, 150);\ncutline(1, 1, 149);\n"


def slot(r, s, length):
    """The area of the hull of two circles."""
    a = math.acos((r - s) / length)
    return r * r * (PI - a) + s * s * a + (r + s) * length * math.sin(a)


def hexagon(outer):
    return 1.5 * math.sqrt(3) * outer ** 2


AREAS = {
    "hull_of_circles": ("hull() { circle(5); translate([20, 0]) circle(5); }", slot(5, 5, 20),
                        (-5, -5, 25, 5)),
    "hull_of_two_radii": ("hull() { circle(5); translate([20, 0]) circle(2); }", slot(5, 2, 20),
                          (-5, -5, 22, 5)),
    "hull_of_squares": ("hull() { square(2); translate([8, 0]) square(2); }", 20, (0, 0, 10, 2)),
    "hull_of_three": ("hull() { polygon([[0,0],[1,0],[0,1]]); translate([9,0]) square(1);"
                      " translate([0,9]) square(1); }", 59.5, (0, 0, 10, 10)),
    "minkowski_with_a_circle": ("minkowski() { square(10); circle(2); }", 180 + 4 * PI, (-2, -2, 12, 12)),
    "minkowski_of_squares": ("minkowski() { square([10, 6]); square(2, center = true); }", 96,
                             (-1, -1, 11, 7)),
    "minkowski_of_a_hole": ("minkowski() { difference() { square(20, center = true);"
                            " square(10, center = true); } square(2, center = true); }",
                            22 ** 2 - 8 ** 2, (-11, -11, 11, 11)),
    "offset_r": ("offset(r = 2) square(10);", 180 + 4 * PI, (-2, -2, 12, 12)),
    "offset_r_inwards": ("offset(r = -2) square(10);", 36, (2, 2, 8, 8)),
    "offset_delta": ("offset(delta = 2) square(10);", 196, (-2, -2, 12, 12)),
    # each corner is cut at the distance of the offset: a triangle of height 2 (sqrt 2 - 1) is missing
    "offset_chamfer": ("offset(delta = 2, chamfer = true) square(10);",
                       196 - 4 * (2 * (math.sqrt(2) - 1)) ** 2, (-2, -2, 12, 12)),
    "resize": ("resize([40, 10]) circle(5);", PI * 20 * 5, (-20, -5, 20, 5)),
    "resize_auto": ("resize([40, 0], auto = true) square([10, 20]);", 3200, (0, 0, 40, 80)),
    "resize_one_axis": ("resize([40, 0]) square([10, 20]);", 800, (0, 0, 40, 20)),
    "projection": ("projection() translate([0, 0, 9]) rotate([45, 0, 0]) cube(10);", 10 * math.sqrt(200),
                   (0, -math.sqrt(50), 10, math.sqrt(50))),
    "projection_of_a_cut": ("projection(cut = true) difference() { cube(10, center = true);"
                            " cylinder(h = 20, r = 3, center = true); }", 100 - 9 * PI, (-5, -5, 5, 5)),
    "projection_of_a_sphere": ("projection() sphere(10);", 100 * PI, (-10, -10, 10, 10)),
    "booleans": ("difference() { square(10); translate([5, 5]) circle(3); }", 100 - 9 * PI, (0, 0, 10, 10)),
    "intersection": ("intersection() { square(10); translate([5, 0]) square(10); }", 50, (5, 0, 10, 10)),
    "scattered": ("for (i = [0:9]) translate([3 * i, 0]) circle(1);", 10 * PI, (-1, -1, 28, 1)),
    "chained": ("for (i = [0:9]) translate([i, 0]) square(2);", 22, (0, 0, 11, 2)),
    "specials_of_the_same_call": ("$fn = 64; circle(r = 5 / cos(180 / $fn), $fn = 6);",
                                  hexagon(5 / math.cos(PI / 6)), None),
}

SOLIDS = {
    "sphere": ("sphere(10);", 4000 / 3 * PI, 20, 20),
    "cone": ("cylinder(h = 10, r1 = 5, r2 = 2);", PI * 10 / 3 * (25 + 10 + 4), 10, 10),
    "tip": ("cylinder(h = 9, d1 = 10, d2 = 0, center = true);", PI * 25 * 3, 10, 9),
    "torus": ("rotate_extrude() translate([10, 0]) circle(2);", 2 * PI ** 2 * 40, 24, 4),
    "quarter": ("rotate_extrude(angle = 90) translate([10, 0]) square(2);", PI / 4 * 44 * 2, 12, 2),
    "tube": ("rotate_extrude($fn = 4) translate([10, 0]) square(2);", 2 * 2 * 44, 24, 2),
    "tetrahedron": ("polyhedron([[0,0,0],[10,0,0],[0,10,0],[0,0,10]], [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);",
                    1000 / 6, 10, 10),
    "inside_out": ("polyhedron([[0,0,0],[10,0,0],[0,10,0],[0,0,10]], [[2,1,0],[1,3,0],[3,2,0],[2,3,1]]);",
                   1000 / 6, 10, 10),
    "pyramid": ("linear_extrude(9, scale = 0) square(10, center = true);", 300, 10, 9),
    "frustum": ("linear_extrude(9, scale = [1, 0.5]) square(10, center = true);", 675, 10, 9),
    "turned_cube": ("rotate([45, 0, 0]) cube(10);", 1000, 10, math.sqrt(200)),
    "mirrored": ("mirror([0, 0, 1]) cylinder(h = 10, r1 = 5, r2 = 2);", PI * 10 / 3 * 39, 10, 10),
    "union": ("cube(20, center = true); translate([0, 0, 30]) sphere(10);", 8000 + 4000 / 3 * PI, 20, 50),
    "hull_of_prisms": ("hull() { cylinder(r = 5, h = 3); translate([20, 0, 0]) cylinder(r = 5, h = 3); }",
                       3 * slot(5, 5, 20), 30, 3),
    "rounded_box": ("minkowski() { cube([10, 10, 2]); cylinder(r = 2, h = 1); }", 3 * (180 + 4 * PI), 14, 3),
    "resized": ("resize([0, 0, 30], auto = true) cylinder(h = 10, r1 = 5, r2 = 2);", 27 * PI * 130, 30, 30),
}


ARGUMENTS = {  # as OpenSCAD takes them
    "linear_extrude(5, true) square(2);": (0, 5),  # the second one is layer
    "linear_extrude(height = 5, center = true) square(2);": (-2.5, 2.5),
    "linear_extrude(height = 5, center = 1) square(2);": (0, 5),  # only true is true
    "rotate(a = 30, v = [0, 0, 0]) cube([4, 2, 5]);": (0, 5),
    "mirror([0, 0, 0]) rotate([0, 90, 0]) mirror([0, 0, 0]) cube([4, 2, 5]);": (0, 4),
    "multmatrix([[1, 2], [3, 4]]) cube(2);": (0, 2),
    "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 2]]) cube(2);": (2, 3),
}


@pytest.mark.parametrize("text", ARGUMENTS)
def test_arguments_are_those_of_openscad(kerf, program, text):
    low, high = stock(kerf, program, text)["stock"]["block_mm"]
    assert (low[2], high[2]) == pytest.approx(ARGUMENTS[text])


def test_special_arguments_of_groups_have_no_effect(kerf, program):
    made = stock(kerf, program, "linear_extrude(1) union($fn = 4) circle(5);")
    assert made["stock_mm3"] == pytest.approx(25 * PI, rel=1e-3)
    made = stock(kerf, program, "linear_extrude(1) translate([0, 0], $fn = 4) { $fn = 6; circle(5); }")
    assert made["stock_mm3"] == pytest.approx(50, rel=1e-3)


def stock(kerf, program, text):
    run = kerf("simulate", "--json", program(ABOVE + text + "\n", "part.scad"))
    assert run.status == 0, run.out + run.err
    return run.json


@pytest.mark.parametrize("name", AREAS)
def test_areas(kerf, program, name):
    text, area, box = AREAS[name]
    made = stock(kerf, program, f"linear_extrude(2) {{ {text} }}")
    assert made["stock_mm3"] == pytest.approx(2 * area, rel=2e-3)  # the simulator samples columns
    low, high = made["stock"]["block_mm"]
    if box:
        assert [*low[:2], *high[:2]] == pytest.approx(box, abs=0.01)


@pytest.mark.parametrize("name", SOLIDS)
def test_solids(kerf, program, name):
    text, volume, width, height = SOLIDS[name]
    made = stock(kerf, program, text)
    assert made["stock_mm3"] == pytest.approx(volume, rel=2e-3)
    low, high = made["stock"]["block_mm"]
    assert (high[0] - low[0], high[2] - low[2]) == pytest.approx((width, height), abs=0.02)


def test_arcs_of_hulls_are_cut_as_arcs(kerf, program):
    text = 'gcp = gcodepreview("cut");\nsetupstock(60, 30, 6);\ntoolchange(201, 9000);\nrapid(0, 0, 9);\n'
    text += "cutoutline(zdepth = 2) hull() { circle(5); translate([20, 0]) circle(5); }\n"
    run = kerf("steps", program(text, "slot.scad"))
    assert run.status == 0, run.err
    assert run.out.count('"step":"arc"') >= 2


# ---- text


@pytest.mark.parametrize("options, box", [
    ("", (None, 0, None, 10)),
    ('valign = "top"', (None, -10, None, 0)),
    ('valign = "center", halign = "center"', ("centre", -5, "centre", 5)),
    ('halign = "right"', (None, 0, 0, 10)),
])
def test_capitals_of_text_are_as_high_as_its_size(kerf, program, options, box):
    made = stock(kerf, program, f'linear_extrude(1) text("KEH", size = 10, {options});'.replace(", )", ")"))
    low, high = made["stock"]["block_mm"]
    assert (low[1], high[1]) == pytest.approx((box[1], box[3]), abs=0.01)
    if box[0] == "centre":
        assert low[0] == pytest.approx(-high[0], abs=0.01)
    if box[2] == 0:
        assert high[0] == pytest.approx(0, abs=0.01)
    assert 20 < high[0] - low[0] < 35
    # strokes: more than a line, less than the block
    assert 60 < made["stock_mm3"] < 0.6 * 10 * (high[0] - low[0])


def test_text_can_be_pocketed(kerf, program):
    text = 'gcp = gcodepreview("cut");\nsetupstock(60, 30, 6);\ntoolchange(102, 9000);\nrapid(0, 0, 9);\n'
    text += 'cutoutline(zdepth = 1) text("A1", size = 20);\n'
    run = kerf("check", program(text, "letters.scad"))
    assert run.status in (0, 3) and "error" not in run.err


FONT = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
# The texts "KERF AVgy" of OpenSCAD 2021.01 with $fn = 64: arguments, area, Y of the lower and upper end.
OUTLINE_TEXTS = [
    ('font = "DejaVu Sans"', 237.388, -2.886, 10.125),
    ('font = "dejavu sans:style=Bold"', 416.014, -2.995, 10.125),
    ('font = "DejaVu Sans", halign = "right", valign = "top", size = 7, spacing = 1.5',
     116.319, -8.942, 0.166),
]


@pytest.mark.skipif(not FONT.exists(), reason="needs the DejaVu fonts")
@pytest.mark.parametrize("arguments, area, low, high", OUTLINE_TEXTS)
def test_text_of_a_font_file_is_that_of_openscad(kerf, program, arguments, area, low, high):
    text = f"use <{FONT}>\nuse <{FONT.with_stem('DejaVuSans-Bold')}>\n"
    made = stock(kerf, program, f'{text}linear_extrude(1) text("KERF AVgy", {arguments});')
    assert made["stock_mm3"] == pytest.approx(area, rel=2e-3)
    box = made["stock"]["block_mm"]
    assert (box[0][1], box[1][1]) == pytest.approx((low, high), abs=0.2)  # OpenSCAD rounds heights of glyphs
    named = stock(kerf, program, f'linear_extrude(1) text("KERF AVgy", font = "{FONT}");')
    assert named["stock_mm3"] == pytest.approx(237.388, rel=2e-3)


def test_a_font_file_must_be_there(kerf, program):
    run = kerf("run", program('use <none.ttf>\ntext("A", font = "other.ttf");\n', "part.scad"))
    assert run.status == 1 and "part.scad:1:5: error: use <none.ttf>" in run.err
    run = kerf("run", program('circle(1);\ntext("A", font = "other.ttf");\n', "part.scad"))
    assert run.status == 1 and "part.scad:2:1: error: cannot open" in run.err


# ---- files


def dxf(*entities):
    tags = ["0", "SECTION", "2", "ENTITIES"]
    for entity in entities:
        tags += [str(word) for word in entity]
    return "\n".join([*tags, "0", "ENDSEC", "0", "EOF", ""])


def line(layer, x, y, to_x, to_y):
    return ["0", "LINE", "8", layer, "10", x, "20", y, "11", to_x, "21", to_y]


def test_drawings_are_areas(kerf, program):
    circle = ["0", "CIRCLE", "8", "HOLES", "10", 10, "20", 10, "40", 4]
    square = [line("CUT", 0, 0, 20, 0), line("CUT", 20, 0, 20, 20), line("CUT", 20, 20, 0, 20),
              line("CUT", 0, 20, 0, 0)]
    program(dxf(*square, circle), "plate.dxf")
    for text, area in (('import("plate.dxf");', 400 - 16 * PI),
                       ('import("plate.dxf", layer = "CUT");', 400),
                       ('import(file = "plate.dxf", layer = "HOLES", scale = 2);', 64 * PI)):
        assert stock(kerf, program, f"linear_extrude(1) {text}")["stock_mm3"] == pytest.approx(area, rel=1e-3)
    program('<svg xmlns="http://www.w3.org/2000/svg" width="30mm" height="20mm" viewBox="0 0 30 20">'
            '<rect x="5" y="0" width="10" height="8"/></svg>', "plate.svg")
    made = stock(kerf, program, 'linear_extrude(1) import("plate.svg");')
    assert made["stock"]["block_mm"] == [pytest.approx([5, 12, 0]), pytest.approx([15, 20, 1])]


def test_open_outlines_of_drawings_are_reported(kerf, program):
    circle = ["0", "CIRCLE", "8", "0", "10", 0, "20", 0, "40", 4]
    program(dxf(line("0", 0, 0, 5, 5), circle), "mixed.dxf")
    run = kerf("run", program('import("mixed.dxf");\n', "part.scad"))
    assert run.status == 0
    assert re.search(r"mixed\.dxf.*: warning: outline 0\.\d is open", run.err)
    assert re.search(r"note: \S*part\.scad:1:1: imported here", run.err)


def tetrahedron(size):
    corners = [(0, 0, 0), (size, 0, 0), (0, size, 0), (0, 0, size)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    data = b"\0" * 80 + struct.pack("<I", len(faces))
    for face in faces:
        data += struct.pack("<12f", 0, 0, 0, *(x for i in face for x in corners[i])) + b"\0\0"
    return data


def test_meshes_are_solids(kerf, program):
    program(tetrahedron(30), "part.stl")
    made = stock(kerf, program, 'translate([0, 0, -30]) import("part.stl");')
    assert made["stock_mm3"] == pytest.approx(4500)
    assert made["stock"]["block_mm"] == [pytest.approx([0, 0, -30]), pytest.approx([30, 30, 0])]


def test_files_are_found_beside_the_file_that_names_them(kerf, program, tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "part.stl").write_bytes(tetrahedron(30))
    (tmp_path / "lib" / "part.scad").write_text('module part() import("part.stl");\n')
    assert stock(kerf, program, "use <lib/part.scad>\npart();")["stock_mm3"] == pytest.approx(4500)


def dimension(name, kind, *points, angle=0):
    tags = ["0", "DIMENSION", "8", "SIZES", "1", name, "70", kind, "50", angle]
    for group, (x, y) in points:
        tags += [10 + group, x, 20 + group, y]
    return tags


def test_dimensions_and_crosses_of_drawings(kerf, program):
    program(dxf(dimension("across", 0, (3, (1, 2)), (4, (11, 26))),
                dimension("up", 0, (3, (1, 2)), (4, (11, 26)), angle=90),
                dimension("aligned", 1, (3, (1, 2)), (4, (11, 26))),
                dimension("radius", 4, (0, (5, 5)), (5, (8, 9))),
                dimension("x", 70, (3, (7, 8))), dimension("y", 6, (3, (7, 8))),
                line("O", 0, 0, 10, 10), line("O", 0, 10, 10, 0)), "sizes.dxf")
    text = 'function size(n) = dxf_dim(file = "sizes.dxf", name = n);\n'
    text += 'echo([for (n = ["across", "up", "aligned", "radius", "x", "y"]) size(n)]);\n'
    text += 'echo(dxf_cross(file = "sizes.dxf", layer = "O"));\n'
    text += 'echo(dxf_cross(file = "sizes.dxf", layer = "O", origin = [1, 2], scale = 2));\n'
    text += 'echo(dxf_dim(file = "sizes.dxf", name = "none"));\n'
    run = kerf("run", program(text, "part.scad"))
    assert run.status == 0, run.err
    assert run.out == "ECHO: [10, 24, 26, 5, 7, 8]\nECHO: [5, 5]\nECHO: [8, 6]\nECHO: undef\n"
    assert "part.scad:5:6: warning: cannot find dimension" in run.err

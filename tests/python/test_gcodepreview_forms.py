"""Both forms of gcodepreview: 0.93, whose commands have the number of a tool first, and 0.9313 without it."""

import math
import re
import struct
import subprocess
import sys
import zlib

import pytest

import kerf
from kerf_command import command

from gcodepreview import GcodePreviewError, gcodepreview


def machine(tool=102):
    gcp = gcodepreview("cut", True, True)
    gcp.opendxffile("part")
    gcp.setupstock(200, 150, 10, "Top", "Lower-Left", 5)
    gcp.toolchange(tool)
    return gcp


def steps_of(gcp):
    return [{k: v for k, v in step.items() if k != "origin"} for step in gcp.toolpath]


# Name, the arguments after the number of the tool.
BOTH = [
    ("dxfline", (1, 2, 30, 40)),
    ("dxfarc", (10, 10, 5, 0, 90)),
    ("dxfcircle", (10, 10, 5)),
    ("dxfrectangle", (0, 0, 50, 30)),
    ("dxfrectangle", (0, 0, 50, 30, "Fillet", 6)),
    ("dxfrectangle", (0, 0, 50, 30, "Chamfer")),
    ("dxfrectanglelwp", (0, 0, 50, 30)),
    ("dxfrectangleround", (0, 0, 50, 30, 5)),
    ("dxfrectanglechamfer", (0, 0, 50, 30, 5)),
    ("dxfrectangleflippedfillet", (0, 0, 50, 30, 5)),
    ("cutrectangle", (10, 10, 0, 50, 30, 2)),
    ("cutrectangledxf", (10, 10, 0, 50, 30, 2)),
    ("cutrectangleround", (10, 10, 0, 50, 30, 2, 5)),
    ("cutrectanglerounddxf", (10, 10, 0, 50, 30, 2, 5)),
    ("cutpocketrectangleround", (10, 10, 0, 50, 30, 2, 5)),
    ("cutpocketrectanglerounddxf", (10, 10, 0, 50, 30, 2, 5)),
    ("gcodearc", (10, 10, 5, 0, 90)),
    ("dxfoutline", ([(0, 0), (10, 0), (10, 10)],)),
    ("dxfbezier", ([(0, 0), (10, 20), (30, 0)],)),
    ("dxftext", ("Ab", 0, 0, 10)),
]


@pytest.mark.parametrize("name, arguments", BOTH, ids=lambda v: v if isinstance(v, str) else None)
def test_both_forms_do_the_same(name, arguments):
    with_tool, without = machine(), machine()
    getattr(with_tool, name)(102, *arguments)
    getattr(without, name)(*arguments)
    assert steps_of(with_tool) == steps_of(without)
    assert with_tool.dxf() == without.dxf()


def test_the_tool_left_out_is_the_one_in_use():
    gcp = machine(201)
    gcp.dxflayers = "tool"
    gcp.dxfcircle(10, 10, 5)
    assert b"Tool 201" in gcp.dxf()


def test_keyholes_of_the_tool_in_use():
    first, second = machine(374), machine(374)
    first.dxfKH(374, 50, 30, 0, -7, 270, 11.5875)
    second.dxfKH(50, 30, 0, -7, 270, 11.5875)
    assert first.dxf() == second.dxf()


def test_names_of_arguments_select_the_form():
    gcp, other = machine(), machine()
    gcp.dxfcircle(xcenter=1, ycenter=2, radius=3)
    gcp.dxfcircle(10, 2, radius=3)
    other.dxfcircle(102, 1, 2, 3)
    other.dxfcircle(102, 10, 2, radius=3)
    assert gcp.dxf() == other.dxf()


def entities(gcp, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    (tmp_path / "read.dxf").write_bytes(gcp.dxf())
    return list(ezdxf.readfile(tmp_path / "read.dxf").modelspace())


def test_polylines_start_with_their_first_vertex(tmp_path):
    gcp = machine()
    gcp.beginpolyline(1, 2)
    gcp.addvertex(10, 2)
    gcp.addvertex(10, 8, 0)
    gcp.closepolyline()
    (line,) = entities(gcp, tmp_path)
    assert [tuple(p[:2]) for p in line.get_points()] == [(1, 2), (10, 2), (10, 8)]


def test_polylines_with_heights_are_lines_in_space(tmp_path):
    gcp = machine()
    gcp.beginpolyline(0, 0, -1)
    gcp.addvertex(10, 0, -2)
    gcp.addvertex(10, 8, -3)
    gcp.closepolyline()
    gcp.dxfline(0, 20, 10, 20, -1, -4)
    ends = [(tuple(e.dxf.start), tuple(e.dxf.end)) for e in entities(gcp, tmp_path)]
    assert ends == [
        ((0, 0, -1), (10, 0, -2)),
        ((10, 0, -2), (10, 8, -3)),
        ((0, 20, -1), (10, 20, -4)),
    ]


@pytest.mark.parametrize(
    "call",
    [
        lambda g: g.dxfline(12.5, 0, 10, 50, -1),
        lambda g: g.dxfline(17, 0, 10, 50, -1),
        lambda g: g.dxfarc(102, 1, 2, 3),
        lambda g: g.dxfcircle(1, 2),
        lambda g: g.cutrectangle(1.5, 10, 10, 0, 50, 30, 2),
        lambda g: g.dxfrectangle(0, 0, 50),
    ],
)
def test_calls_of_neither_form_name_both(call):
    with pytest.raises((GcodePreviewError, TypeError)) as raised:
        call(machine())
    text = str(raised.value)
    name = text.split("(")[0].split(":")[0]
    shown = re.findall(rf"{name}\(((?:tn|tool_num|x\w+|bx)[^)]*)\)", text)
    assert len(shown) == 2, text
    assert shown[1].split(", ")[1:] == shown[0].split(", ")


def test_pockets_with_round_corners_leave_nothing():
    gcp = machine(201)
    gcp.rapid(10, 10, 5)
    gcp.cutpocketrectangleround(10, 10, 0, 50, 30, 2, 5)
    area = 50 * 30 - (4 - math.pi) * 25
    assert gcp.simulate().simulation.removed_mm3 == pytest.approx(2 * area, rel=2e-3)


def test_open_polylines_are_cut_and_drawn(tmp_path):
    gcp = machine()
    gcp.rapid(0, 0, 5)
    gcp.beginopenpolyline()
    for p in ((0, 0, -1), (20, 0, -1), (20, 10, -1)):
        gcp.cutpolylinedxf(*p)
    gcp.finishopenpolyline()
    (line,) = entities(gcp, tmp_path)
    assert [tuple(p[:2]) for p in line.get_points()] == [(0, 0), (20, 0), (20, 10)]
    assert [m.end for m in gcp.toolpaths] == [(0, 0, -1), (20, 0, -1), (20, 10, -1)]


PRINT = """
from gcodepreview import *
gcp = gcodepreview("print", True, False)
gcp.initializeforprinting(0.4, 1.75, 0.6, 0.2, "absolute", 200, 60, "prusa_i3", "printed")
gcp.extrude(9, 18, 0.2)
gcp.rapid(125, 125, 0.2)
for x, y in ((150, 125), (150, 150), (125, 150), (125, 125)):
    gcp.extrude(x, y, 0.2)
gcp.stockandtoolpaths("toolpaths")
gcp.shutdownafterprinting(1500)
"""


def run(text, tmp_path, name="script.py"):
    (tmp_path / name).write_text(text)
    done = subprocess.run(
        [sys.executable, name], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done


def test_a_print_in_the_form_of_today(tmp_path):
    run(PRINT, tmp_path)
    text = (tmp_path / "printed.gcode").read_text()
    assert "M190 S60" in text and "M109 S200" in text and "M104 S0" in text
    steps = kerf.Toolpath(kerf.load(tmp_path / "printed.gcode"))
    beads = [s for s in steps if s["step"] == "extrude" and "width" in s]
    square = [s for s in beads if s["to"][0] >= 125]
    bead = (0.6 - 0.2) * 0.2 + math.pi * 0.1**2  # mm2
    assert sum(s["volume"] for s in square) == pytest.approx(4 * 25 * bead, rel=1e-3)
    assert {s["feed"] for s in beads} == {1500}
    assert (tmp_path / "script.glb").stat().st_size > 1000  # the beads are shown


def test_a_fourth_argument_that_is_true_is_no_width():
    gcp = gcodepreview("print", True, False)
    gcp.initializeforprinting()
    gcp.rapid(0, 0, 0.2)
    gcp.extrude(10, 0, 0.2, True)
    gcp.extrude(20, 0, 0.2, False)
    widths = {s["width"] for s in gcp.toolpath if s["step"] == "extrude"}
    assert widths == {0.6}


SCAD = """
use <gcodepreview.scad>
gcp = gcodepreview("cut", true, true);
opendxffile("drawn");
setupstock(100, 60, 10, "Top", "Lower-Left", 5);
toolchange(102);
dxfcircle({tool}30, 30, 5);
dxfrectangle({tool}0, 0, 50, 30, "Fillet", 6);
cutrectangledxf({tool}5, 5, 0, 20, 10, 2);
{polyline}
closedxffile();
"""
POLYLINES = (
    "beginpolyline(102); addvertex(102, 1, 2); addvertex(102, 30, 2); closepolyline(102);",
    "beginpolyline(1, 2); addvertex(30, 2); closepolyline();",
)


def run_scad(folder):
    done = [command(), "run", "p.scad"]
    return subprocess.run(done, cwd=folder, capture_output=True, text=True, check=False, timeout=120)


def test_both_forms_in_openscad(tmp_path):
    drawn = []
    for tool, polyline in zip(("102, ", ""), POLYLINES):
        (tmp_path / "p.scad").write_text(SCAD.format(tool=tool, polyline=polyline))
        done = run_scad(tmp_path)
        assert done.returncode == 0, done.stderr
        drawn.append((tmp_path / "drawn.dxf").read_bytes())
    assert drawn[0] == drawn[1]


def test_openscad_names_both_forms(tmp_path):
    text = 'gcp = gcodepreview("cut", false, true);\ndxfcircle(1, 2);\n'
    (tmp_path / "p.scad").write_text(text)
    done = run_scad(tmp_path)
    assert done.returncode == 1
    assert "p.scad:2" in done.stderr
    assert "dxfcircle(xcenter, ycenter, radius)" in done.stderr
    assert "dxfcircle(tool_num, xcenter, ycenter, radius)" in done.stderr


# ---- what is shown


def pixels(path):
    """The pixels of a PNG with 8 bits per channel, as tuples; decoded here."""
    data, at, packed = path.read_bytes(), 8, b""
    width = height = kind = 0
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if name == b"IHDR":
            width, height, depth, kind = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and kind in (2, 6)
        elif name == b"IDAT":
            packed += body
        at += 12 + size
    channels = 3 if kind == 2 else 4
    return rows_of(zlib.decompress(packed), width * channels, height, channels)


def paeth(a, b, c):
    p = a + b - c
    return min((a, b, c), key=lambda v: (abs(p - v), (a, b, c).index(v)))


def rows_of(raw, stride, height, channels):
    before, out = bytes(stride), []
    for y in range(height):
        how = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride if how else 0):
            left = row[i - channels] if i >= channels else 0
            corner = before[i - channels] if i >= channels else 0
            added = (0, left, before[i], (left + before[i]) // 2)
            row[i] = row[i] + (paeth(left, before[i], corner) if how == 4 else added[how]) & 255
        out += [tuple(row[i : i + 3]) for i in range(0, stride, channels)]
        before = row
    return out


def count_hue(path, channel):
    """Pixels in which one channel is far above the other two."""
    return sum(rgb[channel] > max(v for c, v in enumerate(rgb) if c != channel) + 60 for rgb in pixels(path))


COLOURS = """
from gcodepreview import *
gcp = gcodepreview("cut")
gcp.setupstock(60, 40, 10, "Top", "Lower-Left", 5)
gcp.toolchange(201)
gcp.setcolor("#0000ff", "lime", "red")
gcp.rapid(10, 10, 5)
gcp.cutline(10, 10, -3)
gcp.cutline(50, 10, -3)
gcp.rapidZ(5)
gcp.rapid(10, 30, 5)
gcp.rapid(10, 30, -4)
gcp.rapid(50, 30, -4)
gcp.rapidZ(5)
gcp.stockandtoolpaths({option})
"""


def test_colours_are_on_the_part(tmp_path):
    small = "gcp.simulate().save('c.png', size=(400, 250))"
    script = COLOURS.replace("gcp.stockandtoolpaths({option})", small)
    run(script, tmp_path)
    assert count_hue(tmp_path / "c.png", 2) > 100  # cuts are blue
    assert count_hue(tmp_path / "c.png", 1) > 100  # rapids in the material are green
    assert count_hue(tmp_path / "c.png", 0) < 20


@pytest.mark.parametrize("option", ["stock", "toolpaths", "rapids"])
def test_each_option_shows_something(tmp_path, option):
    (tmp_path / "c.py").write_text(COLOURS.format(option=repr(option)))
    done = subprocess.run(
        [command(), "run", "c.py", "-o", "c.png"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert len(set(pixels(tmp_path / "c.png"))) > 2


# ---- entries


def removed(call):
    gcp = gcodepreview("cut", False, False, 2, 0.05)
    gcp.setupstock(100, 80, 10, "Top", "Lower-Left", 5)
    gcp.toolchange(201)
    gcp.rapid(20, 20, 5)
    call(gcp)
    simulation = gcp.simulate().simulation
    return gcp, simulation


def plunges(gcp):
    """Cuts straight down below the surface."""
    return [
        m
        for m in gcp.toolpaths
        if m.centre is None and m.start[:2] == m.end[:2] and m.end[2] < min(m.start[2], 0) - 1e-6
    ]


def first_descent(gcp):
    return next(m for m in gcp.toolpaths if m.end[2] < -1e-6)


@pytest.mark.parametrize("entry", ["ramp", "helix", "trochoidal"])
def test_pockets_without_a_plunge(entry):
    outline = [(20, 20), (70, 20), (70, 60), (20, 60), (20, 20)]
    gcp, simulation = removed(lambda g: g.cutpocket(outline, 0, 3, entry=entry))
    if entry == "trochoidal":  # goes down elsewhere too, where it has cut before
        assert first_descent(gcp).centre is not None
    else:
        assert not plunges(gcp)
    corners = (4 - math.pi) * 3.175**2
    assert simulation.removed_mm3 == pytest.approx(3 * (50 * 40 - corners), rel=5e-3)


def test_rectangles_on_a_ramp():
    gcp, simulation = removed(lambda g: g.cutrectangle(20, 20, 0, 40, 30, 3, "ramp"))
    assert not plunges(gcp)
    r = 3.175
    area = (40 + 2 * r) * (30 + 2 * r) - (4 - math.pi) * r * r - (40 - 2 * r) * (30 - 2 * r)
    assert simulation.removed_mm3 == pytest.approx(3 * area, rel=5e-3)


def test_rectangles_by_loops():
    gcp, simulation = removed(lambda g: g.cutrectangle(20, 20, 0, 40, 30, 3, "trochoidal", 10))
    assert first_descent(gcp).centre is not None
    area = 50 * 40 - (4 - math.pi) * 25 - 30 * 20  # within 5 mm of the outline
    assert simulation.removed_mm3 == pytest.approx(3 * area, rel=1e-2)

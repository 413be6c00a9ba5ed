"""gcodepreview command by command; gcodepreview_rows.txt lists the commands and their tests."""

import inspect
import math
import pathlib
import re

import ezdxf
import numpy as np
import pytest
import shapely

import kerf
from gcodepreview import GcodePreviewError, gcodepreview, pygcpversion, shapes
from gcodepreview_motion import motions

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])
    return tmp_path


@pytest.fixture
def gcp():
    made = gcodepreview("cut", True, True)
    made.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
    made.rapid(0, 0, 0)
    return made


def ends(gcp):
    return [end for _, end, *_ in motions(gcp.toolpath)]


def last(gcp):
    return gcp.toolpath[len(gcp.toolpath) - 1]


def entities(gcp):
    pathlib.Path("sketch.dxf").write_bytes(gcp.dxf())
    document = ezdxf.readfile("sketch.dxf")
    assert not document.audit().errors
    return list(document.modelspace())


# ---- 1 object, modes, state


def test_version():
    assert pygcpversion() == 0.93


@pytest.mark.parametrize(
    "mode, ending", [("cut", ".nc"), ("print", ".gcode"), ("no_preview", ".nc"), (False, ".nc")]
)
def test_modes(mode, ending):
    gcp = gcodepreview(mode, 1, 0)
    assert (gcp.generatecut, gcp.generateprint) == (mode == "cut", mode == "print")
    assert (gcp.generategcode, gcp.generatedxf, gcp.gcodefilext) == (True, False, ending)


def test_flags_are_booleans_or_numbers():
    with pytest.raises(TypeError, match="generategcode"):
        gcodepreview("cut", "yes")


def test_resolution_is_effective():
    assert gcodepreview("cut", gcpfs=0.5).resolution == 0.5


def test_positions(gcp):
    gcp.cutline(1, 2, -3)
    assert (gcp.xpos(), gcp.ypos(), gcp.zpos()) == (1, 2, -3)


def test_a_position_set_without_motion_is_flagged(gcp):
    gcp.cutline(10, 10, -2)
    gcp.setzpos(9)
    with pytest.warns(UserWarning, match="Z9 without a motion"):
        gcp.rapidXY(20, 20)
    assert ends(gcp)[-2:] == [(10, 10, 9), (20, 20, 9)]
    gcp.setxpos(30)
    gcp.setypos(5)
    assert (gcp.xpos(), gcp.ypos()) == (30, 5)


def test_a_start_position_is_not_a_motion():
    gcp = gcodepreview("cut", True)
    gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
    gcp.setxpos(10)
    gcp.movetosafeZ()
    gcp.rapidXY(20, 5)
    gcp.cutline(20, 5, -1)
    text = gcp.gcode()
    assert text.index("G0 Z9") < text.index("X10 Y0") < text.index("X20 Y5"), "up before across"


def test_rapids_and_cuts_are_apart(gcp):
    gcp.cutline(1, 1, -1)
    gcp.rapid(1, 1, 5)
    assert [m.kind for m in gcp.rapids] == ["rapid", "rapid"]
    assert [m.end for m in gcp.toolpaths] == [(1, 1, -1)]


def test_the_default_tool():
    gcp = gcodepreview("cut")
    assert (gcp.endmilltype, gcp.diameter, gcp.flute, gcp.toolnumber) == ("square", 3.175, 12.7, "100036")
    assert (gcp.shaftdiameter, gcp.shaftlength) == (3.175, 19.5)


def test_colours_ignore_case(gcp):
    gcp.setcolor("GREEN", "orange", "Red")
    with pytest.raises(GcodePreviewError, match="cutcolor.*greenish"):
        gcp.setcolor("greenish")


def test_choices_by_commands(gcp, capsys):
    """Those that are attributes in Python are commands for OpenSCAD programs."""
    gcp.setpost("grbl")
    gcp.setdxfoptions("r12", "tool", False, True)
    gcp.setdebug()
    assert (gcp.post, gcp.debugenable) == ("grbl", True)
    assert (gcp.dxfversion, gcp.dxflayers, gcp.dxfjoin, gcp.dxfstagger) == ("r12", "tool", False, True)
    gcp.gcpversion()
    assert "0.93" in capsys.readouterr().out


def test_debug(gcp, capsys):
    gcp.debug("quiet")
    gcp.debugenable = True
    gcp.debug("loud", 1)
    assert capsys.readouterr().err == "DEBUG: loud 1\n"


# ---- 2 stock


@pytest.mark.parametrize(
    "height, zero, low",
    [
        ("Top", "Lower-Left", (0, 0, -12.7)),
        ("Top", "Center-Left", (0, -30, -12.7)),
        ("Top", "Top-Left", (0, -60, -12.7)),
        ("Top", "Center", (-50, -30, -12.7)),
        ("Bottom", "Lower-Left", (0, 0, 0)),
        ("Bottom", "Center", (-50, -30, 0)),
        ("top", "lower left", (0, 0, -12.7)),
        ("Top", "Top-Right", (-100, -60, -12.7)),
    ],
)
def test_stock_zeros(height, zero, low):
    gcp = gcodepreview("cut")
    gcp.setupstock(100, 60, 12.7, height, zero, 9)
    assert gcp.stock.low == pytest.approx(low)
    assert gcp.stock.high == pytest.approx(tuple(a + b for a, b in zip(low, (100, 60, 12.7))))
    assert gcp.retractheight == 9


@pytest.mark.parametrize(
    "zero, texts",
    [
        (
            "Lower-Left",
            (
                "stockMin:0.00mm, 0.00mm, -12.7mm",
                "stockMax:100mm, 60mm, 0.00mm",
                "STOCK/BLOCK, 100, 60, 12.7, 0.00, 0.00, 12.7",
            ),
        ),
        (
            "Center-Left",
            (
                "stockMin:0.00mm, -30.0mm, -12.7mm",
                "stockMax:100mm, 30.0mm, 0.00mm",
                "STOCK/BLOCK, 100, 60, 12.7, 0.00, 30.0, 12.7",
            ),
        ),
        (
            "Top-Left",
            (
                "stockMin:0.00mm, -60mm, -12.7mm",
                "stockMax:100mm, 0.00mm, 0.00mm",
                "STOCK/BLOCK, 100, 60, 12.7, 0.00, 60, 12.7",
            ),
        ),
        (
            "Center",
            (
                "stockMin:-50.0mm, -30.0mm, -12.7mm",
                "stockMax:50.0mm, 30.0mm, 0.00mm",
                "STOCK/BLOCK, 100, 60, 12.7, 50.0, 30.0, 12.7",
            ),
        ),
    ],
)
def test_stock_comments(zero, texts):
    gcp = gcodepreview("cut")
    gcp.setupstock(100, 60, 12.7, "Top", zero, 9)
    notes = [gcp.toolpath[i]["text"] for i in range(len(gcp.toolpath)) if gcp.toolpath[i]["step"] == "note"]
    assert tuple(notes) == texts


def test_unknown_positions_of_stock_are_errors():
    with pytest.raises(GcodePreviewError, match="stockzero.*Lower-Left"):
        gcodepreview("cut").setupstock(100, 60, 12.7, "Top", "Somewhere")


def test_five_arguments_of_setupstock():
    gcp = gcodepreview("cut")
    gcp.setupstock(100, 60, 12.7, "Top", "Center")
    assert gcp.retractheight == 5


def test_cutting_area():
    gcp = gcodepreview("cut")
    gcp.rapid(1, 2, 3)
    stock = gcp.setupcuttingarea(40, 30, 10, -20, -15, -10)
    assert stock.low == pytest.approx((-20, -15, -10)) and stock.high == pytest.approx((20, 15, 0))
    assert gcp.xpos() == 0 and not gcp.rapids


def test_shift_and_addition_of_stock(gcp):
    gcp.shiftstock(1, 2, 3)
    assert gcp.stock.low == pytest.approx((1, 2, -9.7))
    gcp.addtostock(10, 60, 20, 101, 2, -9.7)
    assert gcp.stock.high == pytest.approx((111, 62, 10.3))
    volume = kerf.simulate(
        kerf.read_gcode("G21 G90\nG0 X0 Y0 Z50\nM2\n"), gcp.stock, resolution=0.5
    ).stock_mm3
    assert volume == pytest.approx(100 * 60 * 12.7 + 10 * 60 * 20, rel=1e-3)


def test_stock_is_required():
    with pytest.raises(GcodePreviewError, match="shiftstock: setupstock"):
        gcodepreview("cut").shiftstock(1, 1, 1)


def test_stock_from_a_file(gcp):
    gcp.toolchange(201)
    gcp.rapid(50, 30, 5)
    gcp.cutline(50, 30, -6)
    gcp.rapidZ(5)
    part = gcp.simulate().simulation
    part.save("side.stl")
    kerf.save_left_stock(part, "side.kstock")
    for name in ("side.stl", "side.kstock"):
        second = gcodepreview("cut")
        second.stockfromfile(name)
        assert (second.stock.low, second.stock.high) == ((0, 0, pytest.approx(-12.7)), (100, 60, 0))
        second.toolchange(201)
        second.rapid(50, 30, 5)
        second.cutline(50, 30, -6)  # again in the hole: nothing is left to cut
        assert second.simulate().simulation.removed_mm3 == pytest.approx(0, abs=4), name  # of 190
    with pytest.raises(FileNotFoundError):
        second.stockfromfile("none.stl")


def test_two_sides(gcp):
    gcp.toolchange(201)
    for call in ((50, 30, 5),):
        gcp.rapid(*call)
    gcp.cutline(50, 30, -6)
    gcp.rapidZ(5)
    gcp.flipstock("x")
    gcp.rapid(50, 30, 5)
    gcp.cutline(50, 30, -6.71)
    result = gcp.simulate()
    assert result.simulation.left_mm3 == pytest.approx(100 * 60 * 12.7 - math.pi * 3.175**2 * 12.7, rel=1e-3)


# ---- 3 and 4 tools

NUMBERS = {
    324: "100048",
    274: "100036",
    278: "100047",
    251: "100047",
    322: "100047",
    326: "100036",
    122: "100012",
    112: "100024",
    102: "100036",
    201: "100047",
    205: "100048",
    282: "100204",
    121: "201012",
    111: "202024",
    101: "203036",
    202: "204047",
    325: "204048",
    301: "390074",
    302: "360071",
    327: "360098",
    390: "390032",
    323: "330041",
    501: "530131",
    502: "540131",
    814: "814071",
    374: "906043",
    375: "906053",
    376: "907040",
    378: "907050",
    56142: "602032",
    56125: "603042",
    1568: "603032",
    1572: "604042",
    45981: "445981",
    45982: "445982",
    1370: "401370",
    1372: "401372",
}


@pytest.mark.parametrize("number, generated", NUMBERS.items())
def test_generated_numbers(gcp, number, generated):
    gcp.toolchange(number, 12000)
    assert gcp.toolnumber == generated
    assert gcp.currenttoolnumber() == gcp.currenttool() == number
    gcp.toolchange(int(generated))
    assert gcp.diameter == kerf.built_in_tools()[number].diameter


@pytest.mark.parametrize(
    "number",
    [
        204,
        304,
        311,
        312,
        211,
        212,
        648,
        13921,
        602,
        603,
        690,
        251,
        322,
        326,
        324,
        274,
        278,
        1570,
        1574,
        808079,
        45828,
    ],
)
def test_further_tools(gcp, number):
    gcp.toolchange(number)
    gcp.cutline(10, 0, -1)
    assert gcp.diameter > 0


SIZES = {
    102: (3.175, 12.7),
    201: (6.35, 19.05),
    112: (1.5875, 6.35),
    122: (0.79375, 1.5875),
    324: (6.35, 22.225),
    205: (6.35, 25.4),
    282: (2, 6.35),
    274: (3.175, 12.7),
    278: (6.35, 19.05),
    202: (6.35, 19.05),
    121: (0.79375, 1.5875),
    301: (12.7, 6.35),
    302: (12.7, 11.067),
    374: (9.525, 3.175),
    376: (12.7, 4.7625),
    45981: (12.7, 12.7),
    45982: (19.05, 15.875),
    1372: (19.05, 15.875),
    501: (3.175, 5.561),
    814: (12.7, 12.7),
    808079: (12.7, 20.955),
}


@pytest.mark.parametrize("number, sizes", SIZES.items())
def test_sizes_of_tools(gcp, number, sizes):
    gcp.toolchange(number)
    assert (gcp.diameter, gcp.flute) == pytest.approx(sizes, abs=1e-4)


def test_unknown_tools_are_errors(gcp):
    with pytest.raises(GcodePreviewError, match="there is no tool 999; known: 101, 102"):
        gcp.toolchange(999)
    assert gcp.currenttoolnumber() == 102


def test_toolchange_writes_the_makers_number(gcp):
    gcp.toolchange(100047, 12345)
    gcp.cutline(10, 0, -1)
    text = gcp.gcode()
    assert "M6 T201" in text and "M3 S12345" in text and "(TOOL/MILL, 6.35, 0.00, 19.05, 0.00)" in text


@pytest.mark.parametrize(
    "values, shape, heights",
    [
        (("mill", 6, 0, 20, 0), "square", {0: 6, 5: 6}),
        (("mill", 6, 3, 20, 0), "ball", {3: 6}),
        (("mill", 12.7, 3.175, 12.7, 0), "bull nose", {3.175: 12.7}),
        (("mill", 0.1, 0.05, 6.35, 45), "V", {6.3: 0.1 + 2 * 6.3}),
        (("chamfer", 12, 90, 20, 0), "chamfer", {3: 6}),
        (("drill", 6, 118, 20, 0), "drill", {10: 6}),
        (("crmill", 0.508, 5.842, 2.667, 8), "corner rounding", {2.667: 0.508 + 2 * 2.667}),
    ],
)
def test_tools_by_comments(gcp, values, shape, heights):
    gcp.settoolparameters(*values)
    assert gcp.endmilltype == shape
    for height, diameter in heights.items():
        assert gcp.tool_diameter(gcp.currenttoolnumber(), height) == pytest.approx(diameter, abs=1e-6)


# ---- 5 shapes


def test_the_four_descriptions(gcp):
    gcp.toolchange(202)
    assert (gcp.endmilltype, gcp.diameter, gcp.radius) == ("ball", 6.35, 3.175)
    assert max(r for r, z in gcp.toolprofile) == pytest.approx(3.175)
    assert min(z for r, z in gcp.toolprofile) == 0
    assert {x for x, z in gcp.tooloutline} >= {3.175, -3.175}
    for r, z in gcp.toolprofile:
        if 0 < z < 3.175 and r > 0:
            assert math.hypot(r, z - 3.175) == pytest.approx(3.175, abs=1e-9)
    shape = gcp._section.shape()
    volume = sum(
        (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        / 6
        for a, b, c in shape
    )
    assert volume > 0.99 * math.pi * 3.175**2 * 35


@pytest.mark.parametrize(
    "call, width, height",
    [
        (lambda g: g.definesquaretool(6, 20, 30), 6, 20),
        (lambda g: g.defineballnosetool(6, 20, 30), 6, 20),
        (lambda g: g.defineVtool(12, 6, 30, 6), 12, 6),
        (lambda g: g.defineKeyholetool(9.5, 3, 6, 3, 6, 20), 9.5, 6),
        (lambda g: g.definebowltool(12.7, 12.7, 3, 6, 20), 12.7, 12.7),
        (lambda g: g.defineRoundovertool(6, 0.5, 8, 2.75, 6, 10), 6, 8),
    ],
)
def test_defined_outlines(gcp, call, width, height):
    call(gcp)
    assert max(x for x, z in gcp.tooloutline) == pytest.approx(width / 2)
    assert max(z for x, z in gcp.tooloutline) == pytest.approx(height)


def test_shafts(gcp):
    gcp.defineshaft(3, 6, 12, 1.5, 20)
    assert gcp.shaftprofile == [(1.5, 12), (3, 13.5), (3, 33.5)]
    gcp.defineshaft(3, 0, 12, 0, 20)
    assert gcp.shaftdiameter == 3


@pytest.mark.parametrize(
    "what, name", [("outline", "202_outline.svg"), ("profile", "202_profile.svg"), ("shape", "202_shape.stl")]
)
def test_shown_tools(gcp, here, what, name):
    gcp.toolchange(202)
    getattr(gcp, "showtool" + what)()
    data = (here / name).read_bytes()
    assert data.startswith(b"<?xml") or len(data) > 84


def area_within(points):
    return shapely.Polygon(points).area


@pytest.mark.parametrize("mode", ["cut", "print", "no_preview"])
def test_shown_tools_are_returned(here, mode):
    gcp = gcodepreview(mode)
    gcp.toolchange(201)  # square, 6.35 wide, flute 19.05, shaft 20 long
    square = [(3.175, 0), (3.175, 39.05), (-3.175, 39.05), (-3.175, 0)]
    outline, profile, triangles = gcp.showtooloutline(), gcp.showtoolprofile(), gcp.showtoolshape()
    assert area_within(outline) == pytest.approx(area_within(square))
    assert area_within(profile) == pytest.approx(3.175 * 39.05)
    sides = 48  # of the circle as a polygon
    volume = sum(np.dot(a, np.cross(b, c)) for a, b, c in np.array(triangles)) / 6
    assert volume == pytest.approx(sides / 2 * math.sin(2 * math.pi / sides) * 3.175**2 * 39.05)
    gcp.toolchange(202)  # a ball of 6.35, flute 19.05
    area = 6.35 * 39.05 - (2 - math.pi / 2) * 3.175**2
    assert area_within(gcp.showtooloutline()) == pytest.approx(area, rel=1e-3)
    assert min(gcp.showtooloutline(), key=lambda p: p[1]) == pytest.approx((0, 0), abs=1e-9)


# ---- 6 straight moves

MOVES = {
    "rapid": ((1, 2, 3), (1, 2, 3)),
    "rapidXYZ": ((1, 2, 3), (1, 2, 3)),
    "rapidXY": ((1, 2), (1, 2, 0)),
    "rapidXZ": ((1, 3), (1, 0, 3)),
    "rapidYZ": ((2, 3), (0, 2, 3)),
    "rapidX": ((1,), (1, 0, 0)),
    "rapidY": ((2,), (0, 2, 0)),
    "rapidZ": ((3,), (0, 0, 3)),
    "movetosafeZ": ((), (0, 0, 9)),
    "endtoolpath": ((), (0, 0, 9)),
    "cutline": ((1, 2, -3), (1, 2, -3)),
    "cutlinedxf": ((1, 2, -3), (1, 2, -3)),
    "cutlinedxfgc": ((1, 2, -3), (1, 2, -3)),
    "cutlinegc": ((1, 2, -3), (1, 2, -3)),
    "cutlineXYZ": ((1, 2, -3), (1, 2, -3)),
    "cutlineXY": ((1, 2), (1, 2, 0)),
    "cutlineXZ": ((1, -3), (1, 0, -3)),
    "cutlineYZ": ((2, -3), (0, 2, -3)),
    "cutlineX": ((1,), (1, 0, 0)),
    "cutlineY": ((2,), (0, 2, 0)),
    "cutlineZ": ((-3,), (0, 0, -3)),
}
FEEDS = {
    "cutlineXYZwithfeed": ((1, 2, -3, 321), (1, 2, -3)),
    "cutlineXYwithfeed": ((1, 2, 321), (1, 2, 0)),
    "cutlineXZwithfeed": ((1, -3, 321), (1, 0, -3)),
    "cutlineYZwithfeed": ((2, -3, 321), (0, 2, -3)),
    "cutlineXwithfeed": ((1, 321), (1, 0, 0)),
    "cutlineYwithfeed": ((2, 321), (0, 2, 0)),
    "cutlineZwithfeed": ((-3, 321), (0, 0, -3)),
    "cutlineZgcfeed": ((-3, 321), (0, 0, -3)),
    "moveatfeedrate": ((1, 2, 3, 321), (1, 2, 3)),
    "cutwithfeed": ((1, 2, -3, 321), (1, 2, -3)),
    "cutoneaxis_setfeed": (("Y", 7, 321), (0, 7, 0)),
}


@pytest.mark.parametrize("name", MOVES)
def test_straight_moves(gcp, name):
    arguments, end = MOVES[name]
    moves = getattr(gcp, name)(*arguments)
    assert last(gcp)["to"] == end
    assert last(gcp)["step"] == ("rapid" if "cut" not in name else "cut")
    assert moves[-1].end == end


@pytest.mark.parametrize("name", FEEDS)
def test_moves_with_feeds(gcp, name):
    arguments, end = FEEDS[name]
    getattr(gcp, name)(*arguments)
    assert (last(gcp)["to"], last(gcp)["feed"]) == (end, 321)


def test_the_gcode_changes_only_to_tools_that_cut(gcp):
    gcp.rapid(10, 20, 5)
    gcp.toolchange(201, 10000)
    gcp.cutline(10, 20, -1)
    changes = [line for line in gcp.gcode().splitlines() if line.startswith("M6")]
    assert changes == ["M6 T201"]


def test_rapids_are_in_the_gcode(gcp):
    gcp.rapid(10, 20, 5)
    gcp.cutline(10, 20, -1)
    text = gcp.gcode()
    assert "X10 Y20 Z5\n" in text and "G1 Z-1 F400" in text


def test_origins_are_lines_of_the_script(gcp):
    gcp.cutlinedxfgc(1, 2, -3)
    line = inspect.currentframe().f_lineno - 1
    origin = last(gcp)["origin"]
    assert origin["file"].endswith("test_gcodepreview.py") and origin["line"] == line


def test_the_first_move_to_safe_z_does_not_move_x_and_y():
    gcp = gcodepreview("cut", True)
    gcp.movetosafeZ()
    gcp.rapid(5, 5, 2)
    gcp.cutline(5, 5, -1)
    text = gcp.gcode()
    first = [line for line in text.splitlines() if line.startswith("G0")][0]
    assert first == "G0 Z5"


def test_lasers_move_with_the_tool_off(gcp):
    gcp.post = "laser"
    gcp.setlaserpower(600)
    gcp.cutline(10, 0, 0)
    gcp.rapid(20, 10, 0, "laser")
    gcp.cutline(30, 10, 0)
    lines = gcp.gcode().splitlines()
    (first,) = [i for i, line in enumerate(lines) if "X10" in line]
    (moved,) = [i for i, line in enumerate(lines) if "X20" in line]
    (second,) = [i for i, line in enumerate(lines) if "X30" in line]
    on = lambda a, b: any("S600" in line for line in lines[a : b + 1])
    off = lambda a, b: any("M5" in line or "S0" in line for line in lines[a : b + 1])
    assert on(0, first) and (off(first + 1, moved) or lines[moved].startswith("G0")) and on(0, second)


def test_the_spindle_of_a_mill_goes_on(gcp):
    gcp.toolchange(102, 16000)
    gcp.rapid(10, 10, 5)
    gcp.cutline(10, 10, -2)
    gcp.rapid(40, 10, 0, "laser")
    gcp.cutline(50, 10, -1)
    before = gcp.gcode().split("X50")[0]
    assert "M3 S16000" in before and "M5" not in before.split("M3 S16000")[1]
    result = gcp.simulate()
    assert not result.hazards
    top = result.simulation.column(200, 80)[-1][1]
    assert top == pytest.approx(0, abs=1e-5), "nothing is cut on the way"


def test_begintoolpath(gcp):
    gcp.begintoolpath(5, 6, 0.25)
    assert ends(gcp)[-3:] == [(0, 0, 9), (5, 6, 9), (5, 6, 0.25)]


def test_comments(gcp):
    gcp.writecomment("first pass")
    gcp.writegc("(second)")
    gcp.cutline(1, 1, -1)
    assert "(first pass)" in gcp.gcode() and "(second)" in gcp.gcode()


# ---- 7 arcs


@pytest.mark.parametrize("step", [1, 5])
@pytest.mark.parametrize(
    "name, start, angles, turn",
    [
        ("cutarcCC", (10, 0, 0), (0, 90), "ccw"),
        ("cutarcCW", (0, 10, 0), (90, 0), "cw"),
        ("cutarcCCdxf", (10, 0, 0), (0, 90), "ccw"),
        ("cutarcCWdxf", (0, 10, 0), (90, 0), "cw"),
        ("extrudearcCC", (10, 0, 0), (0, 90), "ccw"),
    ],
)
def test_arcs_reach_their_ends(gcp, name, start, angles, turn, step):
    gcp.rapid(*start)
    getattr(gcp, name)(*angles, 0, 0, 10, -2, step)
    arc = last(gcp)
    assert (arc["step"], arc["turn"], arc["centre"]) == ("arc", turn, (0, 0))
    assert arc["to"] == pytest.approx((0, 10, -2) if turn == "ccw" else (10, 0, -2), abs=1e-12)
    if name.endswith("dxf"):
        (drawn,) = entities(gcp)
        assert (drawn.dxftype(), drawn.dxf.start_angle, drawn.dxf.end_angle) == ("ARC", 0, 90)


def test_arcs_are_cut_to_from_elsewhere(gcp):
    gcp.cutarcCC(0, 90, 20, 20, 5, -1)
    assert ends(gcp)[-2:] == [(25, 20, 0), pytest.approx((20, 25, -1))]


QUARTERS = {
    "NE": ((1, 0), (0, 1)),
    "NW": ((0, 1), (-1, 0)),
    "SW": ((-1, 0), (0, -1)),
    "SE": ((0, -1), (1, 0)),
}


@pytest.mark.parametrize("suffix", ["", "dxf"])
@pytest.mark.parametrize("turn", ["CC", "CW"])
@pytest.mark.parametrize("quadrant", QUARTERS)
def test_quarter_circles(gcp, quadrant, turn, suffix):
    start, end = QUARTERS[quadrant] if turn == "CC" else QUARTERS[quadrant][::-1]
    gcp.rapid(30 + 10 * start[0], 30 + 10 * start[1], 0)
    call = getattr(gcp, f"cutquarter{turn}{quadrant}{suffix}")
    call(30 + 10 * end[0], 30 + 10 * end[1], -1, 10)
    arc = last(gcp)
    assert arc["centre"] == pytest.approx((30, 30))
    assert arc["turn"] == ("ccw" if turn == "CC" else "cw")
    assert arc["to"] == pytest.approx((30 + 10 * end[0], 30 + 10 * end[1], -1))
    assert gcp.toolpath.report()["arcs"] == 1


@pytest.mark.parametrize("suffix", ["dxf", "dxfgc"])
@pytest.mark.parametrize("turn", ["CC", "CW"])
@pytest.mark.parametrize("quadrant", QUARTERS)
def test_arcs_about_a_centre(gcp, quadrant, turn, suffix):
    start, end = QUARTERS[quadrant] if turn == "CC" else QUARTERS[quadrant][::-1]
    gcp.rapid(30 + 10 * start[0], 30 + 10 * start[1], 0)
    call = getattr(gcp, f"cutarc{quadrant}{turn}{suffix}")
    call(30 + 10 * end[0], 30 + 10 * end[1], -1, 30, 30, 10)
    arc = last(gcp)
    assert arc["to"] == pytest.approx((30 + 10 * end[0], 30 + 10 * end[1], -1))
    (drawn,) = entities(gcp)
    sweep = (drawn.dxf.end_angle - drawn.dxf.start_angle) % 360
    assert (drawn.dxf.radius, sweep) == pytest.approx((10, 90))


def test_arcs_in_gcode_have_centres(gcp):
    gcp.rapid(10, 0, 0)
    gcp.arcCCgc(-10, 0, -1, 0, 0, 10)
    gcp.arcCWgc(10, 0, -2, 0, 0, 10)
    text = gcp.gcode()
    assert "G3 X-10 Y0 Z-1 I-10 J0" in text and "G2 X10 Y0 Z-2 I10 J0" in text
    with pytest.raises(GcodePreviewError, match="radius"):
        gcp.arcCCgc(0, 12, -2, 0, 0, 10)


@pytest.mark.parametrize("turn", ["CC", "CW"])
@pytest.mark.parametrize("suffix", ["", "dxf"])
def test_circles_end_at_their_depth(gcp, turn, suffix):
    gcp.rapid(25, 20, 0)
    getattr(gcp, f"cutcircle{turn}{suffix}")(20, 20, -3.175, -3.175, 5)
    assert last(gcp)["to"] == (25, 20, -3.175)
    assert gcp.toolpath.report()["cut_mm"] == pytest.approx(3.175 + 2 * math.pi * 5)


def test_gcodearc(gcp):
    gcp.rapid(10, 0, 0)
    gcp.gcodearc(102, 0, 0, 10, 0, 90)
    assert last(gcp)["step"] == "arc"


# ---- 8 diameters


@pytest.mark.parametrize(
    "tool, height, diameter",
    [
        (122, 1, 0.79375),
        (112, 1, 1.5875),
        (102, 1, 3.175),
        (201, 5, 6.35),
        (101, 2, 3.175),
        (202, 4, 6.35),
        (202, 1, 2 * math.sqrt(3.175**2 - 2.175**2)),
        (121, 1, 0.79375),
        (111, 1, 1.5875),
        (301, 2, 4),
        (302, 2, 2.3094),
        (390, 1, 2),
        (374, 1, 9.525),
        (374, 5, 6.35),
        (375, 7, 8),
        (376, 1, 12.7),
        (378, 7, 8),
        (814, 4, 10.7054),
        (808079, 10, 9.8892),
        (45982, 7, 19.05),
        (45982, 0, 6.35),
        (56142, 0, 0.508),
        (56142, 1.3335, 3.175),
    ],
)
def test_diameters_at_a_height(gcp, tool, height, diameter):
    assert gcp.tool_diameter(tool, height) == pytest.approx(diameter, abs=1e-3)
    assert gcp.tool_radius(tool, height) == pytest.approx(diameter / 2, abs=1e-3)


# ---- 9 feeds


def test_feeds_and_ratios(gcp):
    gcp.opengcodefile("part", plunge=100, feed=400)
    gcp.setfeeds(small_square=0.75, small_V=0.625)
    gcp.cutline(0, 0, -1)
    assert last(gcp)["feed"] == 75
    gcp.cutline(10, 0, -1)
    assert last(gcp)["feed"] == 300
    gcp.toolchange(390)
    gcp.cutline(20, 0, -1)
    assert last(gcp)["feed"] == 250
    with pytest.raises(GcodePreviewError, match="tiny"):
        gcp.setfeeds(tiny=1)


# ---- 10 printing


def printer():
    gcp = gcodepreview("print", True)
    gcp.opengcodefile("part")
    gcp.initializeforprinting(0.4, 1.75, 0.6, 0.2)
    return gcp


def test_beads_have_the_volume_of_a_stadium():
    gcp = printer()
    gcp.moveatfeedrate(0, 0, 0.2, 1200)
    gcp.extrude(10, 20, 0.2)
    filament = math.pi * (1.75 / 2) ** 2
    assert last(gcp)["volume"] / filament == pytest.approx(1.03578, abs=1e-5)
    gcp.moveatfeedrate(3.752, 3.756, 0.2, 1200)
    gcp.extrude(253.37, 253.389, 0.2)
    assert last(gcp)["volume"] / filament == pytest.approx(16.3525, abs=1e-3)
    assert (gcp.xpos(), gcp.ypos()) == (253.37, 253.389)


@pytest.mark.parametrize(
    "name, arguments, text",
    [
        ("setextrudertemperature", (200,), "M104 S200"),
        ("setandwaitforextrudertemperature", (200,), "M109 S200"),
        ("setbedtemperature", (60,), "M140 S60"),
        ("setandwaitforbedtemperature", (60,), "M190 S60"),
        ("setfeedratio", (100,), "M220 S100"),
        ("setspeedratio", (100,), "M221 S100"),
        ("setacceleration", (500,), "M204 P500 T500"),
        ("setbuildpercentage", (10,), "M73 P10"),
        ("setfanspeed", (1, 255), "M106"),
        ("setfansoff", (), "M107"),
        ("pauseforclearbuffer", (), "M400"),
        ("setchambertemperature", (45,), "M141 S45"),
        ("setandwaitforchambertemperature", (45,), "M191 S45"),
        ("setfilamentsensor", (), "M412 S1"),
        ("setfilamentsensor", (False,), "M412 S0"),
        ("displaymessage", ("Layer 2 of 10",), "M117 Layer 2 of 10"),
        ("clearmessage", (), "M117\n"),
    ],
)
def test_settings_of_printers(name, arguments, text):
    gcp = printer()
    getattr(gcp, name)(*arguments)
    gcp.moveatfeedrate(0, 0, 0.2, 1200)
    gcp.extrude(10, 20, 0.2)
    assert text in gcp.gcode()


@pytest.mark.parametrize("name", ["setfeedratio", "setspeedratio", "setbuildpercentage"])
@pytest.mark.parametrize("percent", [-1, 1001, math.nan, math.inf, "-1", "1001"])
def test_percentages_out_of_range(name, percent):
    with pytest.raises(GcodePreviewError, match=r"(feedratio|speedratio|percent) must"):
        getattr(printer(), name)(percent)


@pytest.mark.parametrize(
    "name, percent", [("setfeedratio", 0), ("setspeedratio", 0), ("setbuildpercentage", 100.5)]
)
def test_percentages_at_the_ends_of_their_range(name, percent):
    with pytest.raises(GcodePreviewError, match="percent, not"):
        getattr(printer(), name)(percent)


@pytest.mark.parametrize(
    "post, name, line",
    [
        ("klipper", "tareloadcell", "LOAD_CELL_TARE"),
        ("klipper", "readaccelerometer", "ACCELEROMETER_QUERY"),
        ("reprapfirmware", "readaccelerometer", "M956 P0 S1000 A0 D0"),
        ("klipper", "cleannozzle", "CLEAN_NOZZLE"),
        ("reprapfirmware", "cleannozzle", 'M98 P"clean.g"'),
        ("klipper", "cutfilament", "CUT_TIP"),
    ],
)
def test_devices_of_printers(here, post, name, line):
    """The commands of the firmwares' documents; where they have none, the printer's macro is required."""
    gcp = gcodepreview("print", True)
    gcp.setpost(post)
    gcp.opengcodefile("part")
    gcp.initializeforprinting(0.4, 1.75, 0.6, 0.2)
    if name in ("cleannozzle", "cutfilament"):
        with pytest.raises(GcodePreviewError, match=f"{post} has no command.*macro"):
            getattr(gcp, name)()
        getattr(gcp, name)(line)
    else:
        getattr(gcp, name)()
    with pytest.raises(GcodePreviewError, match="does not accept"):
        getattr(gcp, name)("M9999")
    gcp.extrude(10, 0, 0.2)
    gcp.closegcodefile()
    assert line in (here / "part.gcode").read_text().splitlines()


def test_a_printer_with_a_command_of_its_own_has_a_post_of_its_own(here):
    """M729 cleans the nozzle of Elegoo's printers, as in the sample of the library's text."""
    words = "m = [82, 83, 104, 107, 109, 140, 190, 400, 729]"
    (here / "elegoo.toml").write_text(f'base = "klipper"\nname = "elegoo"\n[words]\n{words}\n')
    gcp = gcodepreview("print", True)
    gcp.setpost("elegoo.toml")
    gcp.opengcodefile("part")
    gcp.initializeforprinting(0.4, 1.75, 0.6, 0.2)
    gcp.cleannozzle("M729")
    gcp.extrude(10, 0, 0.2)
    gcp.closegcodefile()
    assert "M729" in (here / "part.gcode").read_text().splitlines()


def test_accelerations_are_written_for_the_firmware():
    gcp = printer()
    gcp.setacceleration("500")
    gcp.moveatfeedrate(0, 0, 0.2, 1200)
    assert "SET_VELOCITY_LIMIT ACCEL=500\n" in gcp.gcode("klipper")
    assert "M204 P500 T500\n" in gcp.gcode("reprapfirmware")
    for wrong in (0, -1, math.inf, 1e10):
        with pytest.raises(GcodePreviewError, match="acceleration"):
            gcp.setacceleration(wrong)


def test_a_chamber_that_the_firmware_lacks_is_a_warning():
    gcp = printer()
    gcp.setchambertemperature(45)
    gcp.moveatfeedrate(0, 0, 0.2, 1200)
    with pytest.warns(UserWarning, match="M141 for a chamber"):
        text = gcp.gcode("klipper")
    assert "M141" not in text and "G1" in text


def test_nozzles_are_lifted_and_primed():
    gcp = printer()
    gcp.liftandprimenozzle()
    assert gcp.zpos() == 5
    assert last(gcp)["volume"] == pytest.approx(-2 * math.pi * 0.875**2)


def test_the_mode_of_the_extruder():
    """The post writes one mode for the whole program, whatever the call asks for."""
    texts = []
    for absolute in (True, False):
        gcp = printer()
        gcp.setextrusionabsolute(absolute)
        gcp.moveatfeedrate(0, 0, 0.2, 1200)
        gcp.extrude(10, 20, 0.2)
        texts.append(gcp.gcode())
    assert texts[0] == texts[1] and ("M82" in texts[0]) != ("M83" in texts[0])


def test_filament_is_drawn_back_and_pushed_forward():
    gcp = printer()
    with pytest.raises(GcodePreviewError, match="move it first"):
        gcp.retract()
    gcp.moveatfeedrate(0, 0, 0.2, 1200)
    gcp.extrude(10, 20, 0.2)
    area = math.pi * 0.875**2
    gcp.retract(0.8)
    assert last(gcp)["volume"] == pytest.approx(-0.8 * area)
    gcp.unretract(0.8, 1800)
    assert last(gcp)["volume"] == pytest.approx(0.8 * area)
    text = gcp.gcode()
    assert "E-0.8 F2400" in text and "E0.8 F1800" in text
    with pytest.raises(GcodePreviewError, match="length"):
        gcp.retract(-1)


@pytest.mark.parametrize("message", ["two\nlines", "a; G28", "a (b)", "a\rG28"])
def test_messages_are_one_line_of_text(message):
    with pytest.raises(GcodePreviewError, match="one line"):
        printer().displaymessage(message)


def test_widths_below_the_height_are_errors():
    with pytest.raises(GcodePreviewError, match="extrusionwidth"):
        printer().extrude(1, 1, 0.2, 0.1, 0.2)


# ---- 11 results


def test_stockandtoolpaths(gcp):
    gcp.cutline(0, 0, -2)
    gcp.cutline(50, 0, -2)
    gcp.rapid(50, 30, -2)
    with pytest.warns(UserWarning, match="rapid in stock"):
        result = gcp.stockandtoolpaths()
    assert result.hazards[0]["kind"] == "rapid_in_stock"
    line = inspect.currentframe().f_lineno - 4
    assert f"test_gcodepreview.py:{line}: rapid in stock" in result.report()
    assert gcp.stockandtoolpaths("stock").low == gcp.stock.low
    assert gcp.stockandtoolpaths("toolpaths") is gcp.toolpaths
    assert gcp.stockandtoolpaths("rapids") is gcp.rapids
    assert gcp.returnstockandtoolpaths().simulation.removed_mm3 > 0
    with pytest.raises(GcodePreviewError, match="option"):
        gcp.stockandtoolpaths("everything")


def test_parts_are_written_beside_the_script(gcp, here, monkeypatch):
    monkeypatch.setattr("sys.argv", [str(here / "part.py")])
    gcp.stockandtoolpaths()
    assert (here / "part.glb").read_bytes()[:4] == b"glTF"


def test_outputs_of_kerf_run(gcp, here, monkeypatch):
    monkeypatch.setenv("KERF_RUN_OUTPUTS", f"{here}/a.png\n{here}/b.stl")
    gcp.stockandtoolpaths()
    assert (here / "a.png").exists() and (here / "b.stl").exists()


def test_the_mesh_tolerance_of_kerf_run(gcp, here, monkeypatch):
    monkeypatch.setenv("KERF_RUN_OUTPUTS", f"{here}/exact.stl")
    gcp.cutline(50, 30, -3)
    gcp.stockandtoolpaths()
    monkeypatch.setenv("KERF_RUN_OUTPUTS", f"{here}/coarse.stl")
    monkeypatch.setenv("KERF_RUN_MESH_TOLERANCE", "0.2")
    gcp.stockandtoolpaths()
    assert (here / "coarse.stl").stat().st_size < 0.9 * (here / "exact.stl").stat().st_size


# ---- 12 files


def test_files_appear_when_they_are_closed(gcp, here):
    gcp.opengcodefile("part")
    gcp.opendxffile("part")
    gcp.cutlinedxfgc(10, 10, -1)
    assert not list(here.glob("part.*"))
    gcp.closegcodefile()
    gcp.closedxffile()
    assert (here / "part.nc").read_text().splitlines()[-1] in ("M2", "M30")
    assert gcp.zpos() == 9, "the tool ends at the retract height"
    with pytest.raises(GcodePreviewError, match="closegcodefile"):
        gcp.closegcodefile()
    with pytest.raises(GcodePreviewError, match="closedxffile"):
        gcp.closedxffile()


def test_folders_that_do_not_exist(gcp):
    gcp.cutline(1, 1, -1)
    with pytest.raises(OSError):
        gcp.opengcodefile("missing/part")


def test_drawings_by_tool(gcp, here):
    gcp.opendxffiles("part", 201, 102)
    gcp.dxfline(201, 0, 0, 10, 0)
    gcp.dxfline(102, 0, 0, 20, 0)
    gcp.closedxffiles()
    assert {p.name for p in here.glob("*.dxf")} == {"part201.dxf", "part102.dxf"}
    (line,) = ezdxf.readfile("part102.dxf").modelspace()
    assert line.dxf.end.x == 20


def test_lines_that_the_controller_lacks_are_refused_at_once(gcp, here):
    gcp.opengcodefile("part")
    gcp.cutline(1, 1, -1)
    with pytest.raises(GcodePreviewError, match='does not accept "M729"'):
        gcp.writegc("M729")
    gcp.closegcodefile()
    assert "M729" not in (here / "part.nc").read_text()


def test_second_files_have_their_own_motions(gcp, here):
    gcp.toolchange(201, 12000)
    gcp.opengcodefile("a")
    gcp.rapid(10, 10, 5)
    gcp.cutline(10, 10, -1)
    gcp.closegcodefile()
    gcp.opengcodefile("b")
    gcp.rapid(40, 10, 5)
    gcp.cutline(40, 10, -2)
    gcp.closegcodefile()
    first, second = ((here / name).read_text() for name in ("a.nc", "b.nc"))
    assert "Z-1" in first and "Z-2" not in first and "Z-2" in second and "Z-1" not in second
    assert "M6 T201" in second and "M3 S12000" in second and "STOCK/BLOCK, 100, 60, 12.7" in second


def test_hooks(gcp):
    seen = []
    gcp.on_open = lambda g: seen.append("open") or ["(opened)"]
    gcp.on_section = lambda g, n: seen.append(n)
    gcp.on_close = lambda g: seen.append("close")
    gcp.opengcodefile("part")
    gcp.toolchange(201)
    gcp.cutline(1, 1, -1)
    gcp.closegcodefile()
    assert seen == ["open", 201, "close"]


# ---- 14 drawings


def test_colours_and_layers(gcp):
    for name in ("red", "YELLOW", "Dark Gray", "darkgray", "Gray", "aqua"):
        gcp.setdxfcolor(name)
        gcp.dxfcircle(102, 0, 0, 5)
    colours = [e.dxf.layer for e in entities(gcp)]
    assert sorted(set(colours)) == ["Layer_Cyan", "Layer_Dark_Gray", "Layer_Red", "Layer_Yellow"]
    document = ezdxf.readfile("sketch.dxf")
    assert document.layers.get("Layer_Cyan").color == 4
    with pytest.raises(GcodePreviewError, match="color.*Black"):
        gcp.setdxfcolor("sky")


def test_own_layers(gcp):
    gcp.setdxflayer("pocket 3mm")
    gcp.dxfline(102, 0, 0, 1, 1)
    gcp.setdxflayer()
    gcp.dxflayers = "tool"
    gcp.dxfline(201, 0, 0, 1, 2)
    gcp.dxflayers = "depth"
    gcp.cutline(0, 0, -2)
    gcp.dxfline(102, 0, 0, 1, 3)
    assert {e.dxf.layer for e in entities(gcp)} == {"pocket 3mm", "Tool 201", "Tool 102 to -2_000"}


def test_versions_of_drawings(gcp):
    gcp.dxfline(102, 0, 0, 1, 1)
    gcp.dxfversion = "r12"
    entities(gcp)
    assert ezdxf.readfile("sketch.dxf").dxfversion == "AC1009"


def test_offset_by_colour(gcp):
    gcp.dxfstagger = True
    gcp.setdxfcolor("Green")
    gcp.dxfline(102, 0, 0, 10, 0)
    (line,) = entities(gcp)
    assert line.dxf.start.x == 300 and line.dxf.start.y == 180


def test_chains_are_joined(gcp):
    gcp.dxfline(102, 0, 0, 10, 0)
    gcp.dxfarc(102, 10, 5, 5, 270, 360)
    gcp.dxfline(102, 0, 10, 15, 5)
    gcp.dxfline(102, 0, 0, 0, 10)
    (outline,) = entities(gcp)
    assert outline.dxftype() == "LWPOLYLINE" and outline.closed and len(outline) == 4
    assert sorted(abs(b) for *_, b in outline.get_points("xyb"))[-1] == pytest.approx(math.tan(math.pi / 8))
    gcp.dxfjoin = False
    assert len(entities(gcp)) == 4


def test_branches_are_not_joined(gcp):
    for end in ((10, 0), (0, 10), (-10, 0)):
        gcp.dxfline(102, 0, 0, *end)
    assert [e.dxftype() for e in entities(gcp)] == ["LINE"] * 3


def test_plunges_are_not_drawn(gcp):
    gcp.cutlinedxfgc(0, 0, -1)
    assert entities(gcp) == []


def test_polylines(gcp):
    with pytest.raises(GcodePreviewError, match="beginpolyline"):
        gcp.addvertex(102, 0, 0)
    gcp.beginpolyline(102)
    gcp.cutvertexdxf(0, 0, -1)
    gcp.cutvertexdxfgc(10, 0, -1)
    gcp.cutvertexdxf(10, 10, -1)
    gcp.closepolyline(102)
    (outline,) = entities(gcp)
    assert [p[:2] for p in outline.get_points("xy")] == [(0, 0), (10, 0), (10, 10)]
    assert ends(gcp)[-1] == (10, 10, -1)


def test_open_polylines(gcp):
    with pytest.raises(GcodePreviewError, match="beginpolyline"):
        gcp.addopline(102, 0, 0)
    gcp.beginopenpolyline(102)
    for p in ((0, 0), (10, 0), (10, 10)):
        gcp.addopline(102, *p)
    gcp.finishopenpolyline(102)
    (outline,) = entities(gcp)
    assert [p[:2] for p in outline.get_points("xy")] == [(0, 0), (10, 0), (10, 10)]


def test_texts_of_drawings(gcp):
    gcp.dxfpreamble(102)
    gcp.dxfrectanglelwp(102, 1, 2, 30, 20)
    gcp.writedxfcolor(102)
    gcp.dxfpostamble(102)
    (outline,) = entities(gcp)
    assert outline.closed and sorted(p[:2] for p in outline.get_points("xy"))[0] == (1, 2)
    assert "<svg" in gcp.svg() and "<path" in gcp.svg()
    for call in (gcp.writedxf, gcp.writedxfs):
        with pytest.raises(GcodePreviewError, match="writedxf"):
            call(102, "0", "LINE")
    assert len(entities(gcp)) == 1


def test_the_path_as_svg(gcp):
    gcp.cutline(50, 30, -1)
    gcp.rapid(50, 30, 5)
    gcp.rapid(0, 0, 5)
    assert "<svg" in gcp.pathsvg() and gcp.pathsvg(rapids=True) != gcp.pathsvg()


def test_the_postamble_lifts_the_tool(gcp):
    gcp.cutline(50, 30, -1)
    gcp.gcodepostamble()
    assert gcp.zpos() == gcp.retractheight == 9
    steps = len(gcp.toolpath)
    gcp.gcodepostamble()
    assert len(gcp.toolpath) == steps, "it is there"


@pytest.mark.parametrize(
    "style, area",
    [
        ("Square", 600),
        ("Fillet", 600 - 16 * (4 - math.pi)),
        ("Chamfer", 600 - 32),
        ("flipped fillet", 600 - 16 * math.pi),
    ],
)
def test_rectangles(gcp, style, area):
    gcp.dxfrectangle(102, 1, 2, 30, 20, style, 4)
    entities(gcp)
    assert kerf.load_drawing("sketch.dxf").region(unit="mm").area == pytest.approx(area)
    with pytest.raises(GcodePreviewError, match="corners.*Chamfer"):
        gcp.dxfrectangle(102, 1, 2, 30, 20, "Wavy", 4)
    with pytest.raises(GcodePreviewError, match="radius"):
        gcp.dxfrectangle(102, 1, 2, 30, 20, "Fillet", 11)


@pytest.mark.parametrize("name", ["dxfrectangleround", "dxfrectanglechamfer", "dxfrectangleflippedfillet"])
def test_rectangles_by_style(gcp, name):
    getattr(gcp, name)(102, 0, 0, 30, 20, 4)
    assert len(entities(gcp)) == 1


@pytest.mark.parametrize(
    "name, extra, length",
    [
        ("cutrectangle", (), 60),
        ("cutrectangledxf", (), 60),
        ("cutrectangleround", (3,), 60 - 24 + 6 * math.pi),
        ("cutrectanglerounddxf", (3,), 60 - 24 + 6 * math.pi),
    ],
)
@pytest.mark.parametrize("depth", [2, -2])
def test_cut_rectangles(gcp, name, extra, length, depth):
    start = (8, 6, -2) if extra else (5, 6, -2)
    gcp.rapid(*start)
    call = lambda: getattr(gcp, name)(102, 5, 6, 0, 20, 10, depth, *extra)
    if depth < 0:
        with pytest.warns(UserWarning, match="zdepth counts downwards"):
            call()
    else:
        call()
    low, high = gcp.toolpath.report()["cut_bounds_mm"]
    assert low == pytest.approx((5, 6, -2)) and high[:2] == pytest.approx((25, 16))
    travelled = gcp.toolpath.report()["cut_mm"] - (0 if extra else 4)
    assert travelled == pytest.approx(length)
    assert last(gcp)["to"] == pytest.approx(start)


# ---- 16 shapes

POINTS = {
    "circle": (0, 0, 10),
    "ellipse": (0, 0, 20, 10),
    "egg": (0, 0, 20, 30),
    "superellipse": (0, 0, 20, 20),
    "cone": (0, 0, 10, 20),
    "segment": (0, 0, 10, 180),
    "arch": (0, 0, 10, 20),
    "lens": (0, 0, 10, 10),
    "lune": (0, 0, 10, 8),
    "heart": (0, 0, 20),
    "tomoe": (0, 0, 10),
    "triangle": (0, 0, 30, 40, 50),
    "sector": (0, 0, 10, 90),
    "deltoid": (0, 0, 10),
    "astroid": (0, 0, 10),
    "reuleaux": (0, 0, 10),
    "arbelos": (0, 0, 10),
    "dart": (0, 0, 20, 30, 5),
    "arrowhead": (0, 0, 20, 30, 5),
    "rectangle": (0, 0, 20, 10),
    "parallelogram": (0, 0, 20, 10, 5),
    "rhombus": (0, 0, 20, 10),
    "trapezoid": (0, 0, 20, 10, 8),
    "kite": (0, 0, 10, 8, 15),
    "annulus_segment": (0, 0, 10, 6, 0, 120),
    "salinon": (0, 0, 12, 4),
    "concave_square": (0, 0, 20, 10, 3),
}
AREAS = {
    "circle": 100 * math.pi,
    "ellipse": 50 * math.pi,
    "egg": 150 * math.pi / max(math.cos(t / 1e4) * (1 - 0.2 * math.sin(t / 1e4)) for t in range(-15708, 1)),
    "cone": 100 + 12.5 * math.pi,
    "segment": 50 * math.pi,
    "arch": 200 + 12.5 * math.pi,
    "triangle": 600,
    "sector": 25 * math.pi,
    "lens": 100 * (2 * math.pi / 3 - math.sqrt(3) / 2),
    "deltoid": 2 * math.pi * (10 / 3) ** 2,
    "astroid": 3 / 8 * math.pi * 100,
    "reuleaux": 50 * (math.pi - math.sqrt(3)),
    "arbelos": 25 * math.pi,
    "tomoe": 50 * math.pi,
    "rectangle": 200,
    "parallelogram": 200,
    "rhombus": 100,
    "trapezoid": 120,
    "kite": 115,
    "annulus_segment": math.pi * 64 / 3,
    "salinon": math.pi * 64,
}


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("egg", (20, 30)),
        ("egg", (40, 10, 0.45)),
        ("egg", (20, 30, 0)),
        ("arrowhead", (20, 30, 5)),
        ("arrowhead", (17, 9, 3)),
        ("arrowhead", (8, 60, 2)),
        ("arrowhead", (60, 8, 2)),
        ("dart", (20, 30, 5)),
        ("ellipse", (20, 10)),
        ("superellipse", (20, 30)),
    ],
)
def test_a_shape_is_as_wide_and_as_high_as_asked(name, sizes):
    x0, y0, x1, y1 = kerf.Region([getattr(shapes, name)(3, -2, *sizes)]).bounds
    assert (x1 - x0, y1 - y0) == pytest.approx(sizes[:2], abs=0.003)


def test_every_shape_is_listed():
    assert set(POINTS) == set(shapes.SHAPES)
    for shape in kerf.plane_shapes():
        stated = inspect.signature(shapes.SHAPES[shape["name"]]).parameters.values()
        defaults = [(p.name, None if p.default is p.empty else p.default) for p in stated]
        assert defaults == [(a["name"], a["default"]) for a in shape["arguments"]], shape["name"]


def test_shapes_refuse_what_is_none():
    with pytest.raises(TypeError, match="radius must be a number, not str"):
        shapes.circle(0, 0, "10")
    with pytest.raises(TypeError, match="x must be a number, not bool"):
        shapes.circle(True, 0, 10)
    with pytest.raises(GcodePreviewError, match="width.*height"):
        shapes.ellipse(0, 0, -1, math.nan)
    with pytest.raises(GcodePreviewError, match="sides of a triangle"):
        shapes.triangle(0, 0, 1, 2, 9)
    with pytest.raises(ValueError, match="no shape 'spoon'"):
        kerf.plane_shape("spoon", 0, 0)
    with pytest.raises(ValueError, match="radius is missing"):
        kerf.plane_shape("circle", 0, 0)
    with pytest.raises(ValueError, match="it has 3"):
        kerf.plane_shape("circle", 0, 0, 1, 2)


def test_a_surface_is_that_of_its_control_points():
    rows = [[i * k for k in range(4)] for i in range(4)]  # bilinear: exactly reproduced
    surface = kerf.BezierSurface((10, 20), 30, 60, rows)
    assert surface(10, 20) == 0 and surface(40, 80) == 9
    assert surface(25, 50) == pytest.approx(1.5 * 1.5) and surface(99, 99) == 9
    for wrong in (rows[:3], [[1, 2, 3]] * 4, "flat", [[math.inf] * 4] * 4):
        with pytest.raises(ValueError, match="heights"):
            kerf.BezierSurface((0, 0), 1, 1, wrong)
    with pytest.raises(ValueError, match="width"):
        kerf.BezierSurface((0, 0), 0, 1, rows)


@pytest.mark.parametrize("name", POINTS)
def test_shapes_are_outlines(gcp, name):
    outline = shapes.SHAPES[name](*POINTS[name])
    region = kerf.Region([outline], fill="even_odd")
    assert len(region.outlines) == 1, "one outline that does not intersect itself"
    if name in AREAS:
        assert region.area == pytest.approx(AREAS[name], rel=2e-4)
    gcp.dxfoutline(102, outline)
    entities(gcp)
    assert kerf.load_drawing("sketch.dxf").region(unit="mm").area == pytest.approx(region.area, rel=1e-6)


@pytest.mark.parametrize("name", POINTS)
def test_shapes_have_a_rounded_form(name):
    outline = shapes.SHAPES[name](*POINTS[name])
    rounded = shapes.round_corners(outline, 0.5)
    area = kerf.Region([outline], fill="even_odd").area
    assert rounded and kerf.Region(rounded).area == pytest.approx(area, rel=0.1)


def test_annulus():
    outer, inner = shapes.annulus(0, 0, 10, 5)
    assert (kerf.Region([outer]) - kerf.Region([inner])).area == pytest.approx(75 * math.pi)


@pytest.mark.parametrize("offset, width", [("none", 20), ("outside", 23.175), ("inside", 16.825)])
def test_contours(gcp, offset, width):
    gcp.cutoutline(shapes.rectangle(20, 20, 20, 10), 0, 2, offset)
    low, high = gcp.toolpath.report()["cut_bounds_mm"]
    assert high[0] - low[0] == pytest.approx(width)
    assert low[2] == -2


@pytest.mark.parametrize("stepover", [0.4, 0.7, 1.0])
def test_pockets_leave_nothing_between_rings(gcp, stepover):
    """The area that the tool can reach in a rectangle: all but its corners."""
    gcp.resolution = 0.1
    gcp.cutpocket(shapes.rectangle(20, 10, 40, 30), 0, 1, stepover)
    r = 3.175 / 2
    expected = 40 * 30 - (4 - math.pi) * r * r
    assert gcp.simulate().simulation.removed_mm3 == pytest.approx(expected, abs=1.0)


def test_open_outlines_are_closed(gcp):
    corners = [(10, 10), (40, 10), (40, 40)]
    gcp.cutoutline(corners, 0, 2)
    assert gcp.toolpath.report()["cut_mm"] == pytest.approx(11 + 60 + 30 * math.sqrt(2))  # with the plunge
    assert last(gcp)["step"] == "rapid" and gcp.toolpaths[-1].end == (10, 10, -2)
    gcp.dxfoutline(102, corners)
    entities(gcp)
    assert kerf.load_drawing("sketch.dxf").region(unit="mm").area == pytest.approx(450)


@pytest.mark.parametrize(
    "outline", [shapes.annulus(50, 30, 20, 10), kerf.Region([[50, 30, 20]]) - kerf.Region([[50, 30, 10]])]
)
def test_rings_are_pocketed(gcp, outline):
    gcp.resolution = 0.1
    gcp.cutpocket(outline, 0, 1)
    assert gcp.simulate().simulation.removed_mm3 == pytest.approx(300 * math.pi, rel=2e-3)


def test_pockets(gcp):
    gcp.cutpocket(shapes.circle(50, 30, 12), 0, 3)
    result = gcp.simulate()
    assert result.simulation.removed_mm3 == pytest.approx(math.pi * 144 * 3, rel=5e-3)


# ---- 17 keyholes


@pytest.mark.parametrize(
    "tool, out, angle",
    [(374, 3.5498, 41.810), (375, 2.5848, 57.129), (376, 5.4993, 30), (378, 4.9318, 39.044)],
)
@pytest.mark.parametrize("towards", [0, 45, 90, 180, 270])
def test_keyholes_in_drawings(gcp, tool, out, angle, towards):
    gcp.dxfKH(tool, 50, 30, 0, 5, towards, 20)
    circle, hole = sorted(entities(gcp), key=lambda e: e.dxftype())
    neck = gcp.tool_radius(tool, 7)
    assert (circle.dxftype(), circle.dxf.radius) == ("CIRCLE", pytest.approx(neck))
    points = hole.get_points("xyb")
    distances = sorted(math.dist(p[:2], (50, 30)) for p in points)
    head = gcp.tool_radius(tool, 0)
    assert distances[:2] == pytest.approx([head, head])
    assert math.sqrt(head**2 - neck**2) == pytest.approx(out, abs=1e-3)
    assert math.degrees(math.asin(neck / head)) == pytest.approx(angle, abs=2e-3)
    far = max(points, key=lambda p: math.dist(p[:2], (50, 30)))
    a = math.radians(towards)
    along = (far[0] - 50) * math.cos(a) + (far[1] - 30) * math.sin(a)
    assert along == pytest.approx(20)


@pytest.mark.parametrize(
    "direction, end", [("N", (50, 50)), ("S", (50, 10)), ("E ", (70, 30)), ("w", (30, 30))]
)
def test_keyholes_are_cut_and_left_again(gcp, direction, end):
    gcp.toolchange(374)
    gcp.rapid(50, 30, 0)
    gcp.cutkeyholegcdxf(374, 0, 5, direction, 20)
    assert ends(gcp)[-4:] == [(50, 30, -5), pytest.approx((*end, -5)), (50, 30, -5), (50, 30, 0)]
    with pytest.raises(GcodePreviewError, match="kht_direction"):
        gcp.cutkeyholegcdxf(374, 0, 5, "up", 20)
    gcp.cutKHgcdxf(374, 0, 5, 45, 10)


def test_a_keyhole_of_another_tool_is_flagged(gcp):
    gcp.toolchange(376)
    gcp.rapid(50, 30, 0)
    with pytest.warns(UserWarning, match="cutKHgcdxf: tool 376 is in use, not 374"):
        gcp.cutKHgcdxf(374, 0, 5, 45, 10)


def test_keyholes_require_their_tool(gcp):
    with pytest.raises(GcodePreviewError, match="kh_tool_num"):
        gcp.dxfKH(102, 0, 0, 0, 5, 0, 20)


# ---- 19 reading


def test_previewgcodefile_reads_the_modules_own_output(gcp):
    gcp.opengcodefile("part")
    gcp.toolchange(201, 12000)
    gcp.rapid(20, 20, 5)
    gcp.cutline(20, 20, -3)
    gcp.cutarcCC(180, 360, 30, 20, 10, -1)
    gcp.closegcodefile()
    again = gcodepreview("cut")
    result = again.previewgcodefile("part.nc")
    assert again.stock.high == pytest.approx((100, 60, 0))
    assert [m.end for m in again.toolpaths] == [pytest.approx(m.end) for m in gcp.toolpaths]
    mine = gcp.simulate().simulation.removed_mm3
    assert result.simulation.removed_mm3 == pytest.approx(mine, rel=1e-3)
    with pytest.raises(OSError):
        again.previewgcodefile("missing.nc")


def test_previewgcodefile_reads_modal_gcode():
    pathlib.Path("other.nc").write_text(
        "%\nG20 G90 (letters G1 X9 in comments)\nT201 M6\nG0 X0 Y0 Z.2\nG01 Z-.1 F10\n"
        "G2 X1 Y1 R1\nG91 G1 X.5\nM30\n%\n"
    )
    gcp = gcodepreview("cut")
    gcp.setupstock(100, 60, 12.7)
    gcp.previewgcodefile("other.nc")
    assert [m.end for m in gcp.toolpaths][-1] == pytest.approx((38.1, 25.4, -2.54))
    assert len(gcp.rapids) == 1


# ---- bad input


@pytest.mark.parametrize(
    "call, name",
    [
        (lambda g: g.rapid("a", 0, 0), "ex"),
        (lambda g: g.cutline(0, float("nan"), 0), "ey"),
        (lambda g: g.cutline(0, 0, None), "ez"),
        (lambda g: g.cutarcCC(0, 90, 0, 0, -5, 0), "radius"),
        (lambda g: g.setupstock(0, 1, 1), "stockXwidth"),
        (lambda g: g.moveatfeedrate(0, 0, 0, 0), "f"),
        (lambda g: g.cutline(10**400, 0, 0), "ex"),
        (lambda g: g.toolchange(math.nan), "tool_number"),
        (lambda g: g.toolchange(10**400), "tool_number"),
        (lambda g: g.toolchange(1e300), "tool_number"),
        (lambda g: g.cutoutline(5, 0, 1), "outline"),
        (lambda g: shapes.polygon(3), "points"),
        (lambda g: shapes.polygon([(1, 2), (3,)]), "points"),
        (lambda g: shapes.bezier(3), "control"),
        (lambda g: g.dxfcircle(102, 0, 0, math.inf), "radius"),
        (lambda g: g.toolchange("102"), "tool_number"),
        (lambda g: g.cutoneaxis_setfeed("Q", 1, 100), "axis"),
        (lambda g: g.cutarcCC(90, 0, 0, 0, 5, 0), "earc"),
    ],
)
def test_wrong_values_name_the_argument(gcp, call, name):
    steps = len(gcp.toolpath)
    with pytest.raises((GcodePreviewError, TypeError), match=rf"\b{name}\b"):
        call(gcp)
    assert len(gcp.toolpath) == steps


# ---- movements that are not run; comments of CutViewer; colours


def test_movements_of_tool_and_shaft_are_not_run(gcp):
    steps = len(gcp.toolpath)
    moves = gcp.toolmovement(0, 0, 0, 10, 0, -1).union(gcp.shaftmovement(0, 0, 0, 10, 0, -1))
    assert [(m.kind, m.start, m.end) for m in moves] == [
        ("cut", (0, 0, 0), (10, 0, -1)),
        ("shaft", (0, 0, 0), (10, 0, -1)),
    ]
    assert len(gcp.toolpath) == steps and gcp.xpos() == 0
    with pytest.raises(TypeError, match="ey"):
        gcp.toolmovement(0, 0, 0, 1, "2", 3)


def test_a_shaft_that_rubs_is_a_hazard(gcp):
    gcp.toolchange(122, 16000)  # 1.5875 mm of flute, then a shaft of 3.175 mm
    gcp.rapid(20, 20, 1)
    gcp.cutline(20, 20, -4)
    gcp.cutline(40, 20, -4)
    assert "shank_contact" in {h["kind"] for h in gcp.simulate().hazards}


CUTVIEWER = """(STOCK/BLOCK, 100, 70, 30, 50, 35, 30)
;TOOL/MILL, 6, 0, 20, 0
T1 M6
G0 X0 Y0 Z5
G1 Z-1 F100
(TOOL/ID=12)
(TOOL/Description=a bull nose)
(TOOL/MILL, 6, 1, 20, 0)
T2 M6
(TOOL/MILL, 0.1, 0.05, 6.35, 45)
(COLOR,255,0,0)
T3 M6
(TOOL/CRMILL, 0.508, 6.35, 3.175, 7.9375, 3.175)
T4 M6
(TOOL/CHAMFER, 6.35, 90, 10)
T5 M6
(TOOL/DRILL, 6, 118, 30)
T6 M6
(TOOL/CDRILL, 3, 118, 5, 6, 90, 20)
T7 M6
(TOOL/MILL, 6, 3, 20, 0)
T8 M6
(FROM/0,0,50)
M2
"""


def test_comments_of_cutviewer():
    # The guide: origin of the stock from its lowest corner; taper is the half angle; a corner radius of half
    # the diameter is a ball with its control point at the tip.
    pathlib.Path("cv.nc").write_text(CUTVIEWER)
    program = kerf.load("cv.nc")
    assert (program.stock.low, program.stock.high) == ((-50, -35, -30), (50, 35, 0))
    tools = program.tools
    assert [(n, t.shape) for n, t in tools.items() if n not in (3,)] == [
        (1, "square"),
        (2, "bull nose"),
        (4, "corner rounding"),
        (5, "chamfer"),
        (6, "drill"),
        (7, "centre drill"),
        (8, "ball"),
    ]
    assert tools[1].diameter == 6 and tools[1].flute == 20
    assert tools[2].diameter_at(1) == pytest.approx(6) and tools[2].diameter_at(0) == pytest.approx(4)
    assert tools[3].diameter_at(2) - tools[3].diameter_at(1) == pytest.approx(2), "90 degrees"
    assert tools[4].diameter_at(0) == pytest.approx(0.508)
    assert tools[5].diameter_at(1) == pytest.approx(2)
    assert tools[6].diameter_at(1) == pytest.approx(2 * math.tan(math.radians(59)))
    assert tools[7].diameter_at(4) == pytest.approx(3) and tools[7].diameter_at(10) == pytest.approx(6)
    assert tools[8].diameter_at(3) == pytest.approx(6)


def test_a_ball_controlled_at_its_centre_is_refused():
    pathlib.Path("cv.nc").write_text("(TOOL/MILL, 6, -3, 20, 0)\nT1 M6\nM2\n")
    with pytest.raises(kerf.Error, match="controlled at its centre"):
        kerf.load("cv.nc")


@pytest.mark.parametrize(
    "name, index",
    [
        ("Black", 7), ("Red", 1), ("Yellow", 2), ("Green", 3), ("Cyan", 4), ("Blue", 5), ("Magenta", 6),
        ("White", 7), ("Dark Gray", 8), ("Light Gray", 9), ("Aqua", 4), ("Fuchsia", 6), ("Gray", 8),
        ("Silver", 9), ("Maroon", 1), ("Olive", 2), ("Lime", 3), ("Teal", 4), ("Navy", 5), ("Purple", 6),
    ],
)
def test_every_colour_has_its_index(gcp, name, index):
    gcp.setdxfcolor(name)
    gcp.dxfline(102, 0, 0, 10, 0)
    (line,) = entities(gcp)
    layer = line.doc.layers.get(line.dxf.layer)
    assert (line.dxf.color if line.dxf.color != 256 else layer.color) == index
    gcp.setcolor(name, name.upper(), name.lower())


# ---- other names and the table


def test_other_names():
    import gcodepreview_standalone
    import openscad

    names = {}
    exec("from openscad import *\nnimport('https://example.org/gcodepreview.py')\n", names)
    assert names["gcodepreview"] is gcodepreview_standalone.gcodepreview is gcodepreview
    assert openscad.show(None) is None


SECTIONS = range(1, 25)  # of the inventory; those after them are about other versions, users and speed


def test_the_table_names_every_command_and_its_tests():
    folder = pathlib.Path(__file__).parent
    text = (folder / "gcodepreview_rows.txt").read_text()
    rows = [line.split("|") for line in text.splitlines() if line and not line.startswith("#")]
    sources = "\n".join(path.read_text() for path in folder.glob("test_*.py"))
    known = set(re.findall(r"^def (test_\w+)\(", sources, re.M))
    differences = (folder.parents[1] / "docs" / "differences.md").read_text()
    commands, sections = set(), set()
    for section, names, tests in rows:
        sections.add(int(section.split()[0]))
        commands |= set(names.split())
        if tests.startswith("docs/differences.md: "):
            assert f"gcodepreview: {tests.split(': ')[1]} |" in differences, f"{section}: {names}"
            continue
        assert tests.split(), f"{section}: {names} has no test"
        assert set(tests.split()) <= known, f"{section}: {set(tests.split()) - known}"
    assert sections == set(SECTIONS)
    public = {n for n, f in inspect.getmembers(gcodepreview, inspect.isroutine) if not n.startswith("_")}
    assert public <= commands, f"without a row: {sorted(public - commands)}"


def test_the_index_has_every_routine():
    """docs/manual/routines.md is what tests/tools/make_routines.py writes."""
    import importlib.util

    root = pathlib.Path(__file__).parents[2]
    spec = importlib.util.spec_from_file_location("make_routines", root / "tests/tools/make_routines.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert (root / "docs/manual/routines.md").read_text() == module.page(), "run tests/tools/make_routines.py"

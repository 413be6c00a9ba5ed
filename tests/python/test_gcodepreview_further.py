"""Text, curves, surfaces, countersinks, threads and the fourth axis of gcodepreview."""

import math
import pathlib

import ezdxf
import pytest

from gcodepreview import GcodePreviewError, gcodepreview, shapes

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])


@pytest.fixture
def gcp():
    made = gcodepreview("cut", True, True)
    made.setupstock(60, 40, 12, "Top", "Lower-Left", 5)
    made.movetosafeZ()
    return made


def part(gcp, resolution=0.1):
    gcp.resolution = resolution
    result = gcp.simulate()
    assert not [h for h in result.hazards if h["kind"] == "rapid_in_stock"]
    return result.simulation


def column(simulation, x, y, size=(60, 40)):
    """The centre of the column at a position, and the height of the surface there."""
    nx, ny = simulation.columns
    i, j = math.floor(x / size[0] * nx + 1e-6), math.floor(y / size[1] * ny + 1e-6)
    return (i + 0.5) * size[0] / nx, (j + 0.5) * size[1] / ny, simulation.column(i, j)[-1][1]


def top(simulation, x, y):
    return column(simulation, x, y)[2]


def box(strokes):
    xs, ys = zip(*[p for stroke in strokes for p in stroke])
    return min(xs), min(ys), max(xs), max(ys)


# ---- text


def test_capitals_have_their_height():
    low_x, low_y, high_x, high_y = box(shapes.text(5, 7, "HI", 10))
    assert (low_y, high_y) == pytest.approx((7, 17)) and low_x >= 5
    assert len(shapes.text(0, 0, "HI", 10)) == 4, "three strokes and one"


def test_letters_are_spaced_and_widened():
    normal, spaced, wide = (
        shapes.text(0, 0, "HI", 10),
        shapes.text(0, 0, "HI", 10, spacing=3),
        shapes.text(0, 0, "HI", 10, width=2),
    )
    assert box(spaced)[2] == pytest.approx(box(normal)[2] + 3)
    assert box(wide) == pytest.approx((2 * box(normal)[0], 0, 2 * box(normal)[2], 10))
    lines = shapes.text(0, 0, "A\nA", 10)
    assert box(lines)[1] == pytest.approx(-20), "lines are two heights apart"
    assert shapes.text(0, 0, "A B", 1) != shapes.text(0, 0, "AB", 1)


@pytest.mark.parametrize(
    "font", ["sans", "Sans Bold", "script", "script bold", "times", "times-bold", "times italic"]
)
def test_fonts(font):
    assert len(shapes.text(0, 0, 'Aé"\\', 5, font)) >= 6


def test_text_is_engraved(gcp):
    gcp.toolchange(301, 16000)
    gcp.cuttext("I", 20, 10, 20, 0, 1.5)
    ((begin, end),) = shapes.text(20, 10, "I", 20)
    made = part(gcp)
    assert top(made, begin[0], 20) == pytest.approx(-1.5, abs=0.06)
    assert top(made, begin[0] + 1.0, 20) == pytest.approx(-0.5, abs=0.12), "a V of 90 degrees"
    assert (begin[0], end[0]) == (end[0], begin[0])


def test_text_is_drawn(gcp):
    gcp.dxftext(102, "HI", 0, 0, 10)
    pathlib.Path("text.dxf").write_bytes(gcp.dxf())
    document = ezdxf.readfile("text.dxf")
    assert not document.audit().errors and len(list(document.modelspace())) >= 2


@pytest.mark.parametrize(
    "arguments, error, name",
    [
        (("A", 0, 0, -1, 0, 1), GcodePreviewError, "height"),
        ((5, 0, 0, 5, 0, 1), TypeError, "string"),
        (("A", 0, 0, 5, 0, 1, "comic"), GcodePreviewError, "font.*times"),
    ],
)
def test_wrong_texts_name_the_argument(gcp, arguments, error, name):
    with pytest.raises(error, match=name):
        gcp.cuttext(*arguments)


# ---- Bézier curves and surfaces


def bezier_point(control, t):
    points = [tuple(p) for p in control]
    while len(points) > 1:
        points = [tuple((1 - t) * a + t * b for a, b in zip(p, q)) for p, q in zip(points, points[1:])]
    return points[0]


def test_bezier_curves_are_cut_and_drawn_as_arcs(gcp):
    control = [(10, 10), (20, 40), (40, -20), (50, 30)]
    gcp.toolchange(112, 16000)
    gcp.cutbezier(control, 0, 1)
    steps = [gcp.toolpath[i] for i in range(len(gcp.toolpath))]
    arcs = [s for s in steps if s["step"] == "arc"]
    assert len(arcs) > 4 and arcs[-1]["to"] == pytest.approx((50, 30, -1))
    made = part(gcp, 0.05)
    for t in (0.1, 0.3, 0.5, 0.7, 0.9):
        assert top(made, *bezier_point(control, t)) == pytest.approx(-1, abs=1e-3)
    gcp.dxfbezier(112, control)
    pathlib.Path("curve.dxf").write_bytes(gcp.dxf())
    (drawn,) = ezdxf.readfile("curve.dxf").modelspace()
    assert any(abs(bulge) > 1e-3 for *_, bulge in drawn.get_points("xyb"))
    with pytest.raises(GcodePreviewError, match="control"):
        gcp.cutbezier([(0, 0), (1, 1)], 0, 1)


def test_bezier_surfaces():
    heights = [[0, -1, -2, -3], [0, 4, 4, 0], [0, 4, 4, 0], [-3, -2, -1, 0]]
    surface = shapes.bezier_surface(10, 20, 30, 60, heights)
    assert surface(10, 20) == 0 and surface(40, 20) == -3 and surface(10, 80) == -3
    rows = [bezier_point([(z,) for z in row], 0.3)[0] for row in heights]
    assert surface(10 + 9, 20 + 15) == pytest.approx(bezier_point([(z,) for z in rows], 0.25)[0])
    with pytest.raises(GcodePreviewError, match="heights"):
        shapes.bezier_surface(0, 0, 1, 1, [[0, 0, 0, 0]])


@pytest.mark.parametrize("tool, scallop", [(202, 0.03), (201, 0.5)])
def test_surfaces_are_cut_without_gouges(gcp, tool, scallop):
    def wave(x, y):
        return -4 + 2 * math.sin(x / 6) * math.cos(y / 7)

    gcp.toolchange(tool, 16000)
    gcp.cutsurface(wave, 8, 8, 44, 24, stepover=0.08, stepdown=3)
    made = part(gcp)
    at = [column(made, x, y) for x in range(12, 50, 3) for y in range(12, 30, 3)]
    errors = [z - wave(x, y) for x, y, z in at]
    assert min(errors) >= -0.02, "nothing below the surface"
    assert sum(e <= scallop for e in errors) > 0.9 * len(errors)


def test_wrong_surfaces_name_the_argument(gcp):
    with pytest.raises(TypeError, match="surface"):
        gcp.cutsurface(3, 0, 0, 10, 10)
    with pytest.raises(GcodePreviewError, match="not a finite number"):
        gcp.cutsurface(lambda x, y: math.nan, 0, 0, 10, 10)
    with pytest.raises(GcodePreviewError, match="stepover"):
        gcp.cutsurface(lambda x, y: -1, 0, 0, 10, 10, 2)


# ---- countersinks and threads


@pytest.mark.parametrize("angle", [60, 90])
def test_countersinks_are_cones(gcp, angle):
    gcp.toolchange(101, 16000)
    gcp.cutcountersink(30, 20, 14, angle, 0, 0.05)
    made = part(gcp, 0.05)
    for x in (24, 25, 26, 34, 35, 36.5):
        u, v, z = column(made, x, 20)
        cone = -(7 - math.hypot(u - 30, v - 20)) / math.tan(math.radians(angle / 2))
        assert z == pytest.approx(cone, abs=0.04)
    # From the inside out.
    radii = [m.start[0] - 30 for m in gcp.toolpaths if m.turn]
    assert len(radii) > 5 and radii == sorted(radii)
    gcp.toolchange(102)
    with pytest.raises(GcodePreviewError, match="ball"):
        gcp.cutcountersink(30, 20, 14, 90)


@pytest.mark.parametrize("hand, turn", [("right", "ccw"), ("left", "cw")])
def test_threads_are_helices_of_whole_turns(gcp, hand, turn):
    gcp.toolchange(648, 16000)
    gcp.cutthread(30, 20, 8, 1.25, 0, 9, hand)
    (helix,) = [s for s in (gcp.toolpath[i] for i in range(len(gcp.toolpath))) if s["step"] == "arc"]
    assert (helix["turn"], helix["extra_turns"]) == (turn, 7)
    assert helix["to"][2] == pytest.approx(-9 + 8 * 1.25), "up to above the surface, a pitch per turn"
    assert helix["to"][0] - 30 == pytest.approx((8 - gcp.diameter) / 2)
    wrong = (((4, 1, 0, 5), "diameter"), ((8, 1, 0, 0), "zdepth"), ((8, 1, 0, 5, "up"), "hand"))
    for arguments, name in wrong:
        with pytest.raises(GcodePreviewError, match=name):
            gcp.cutthread(30, 20, *arguments)


@pytest.mark.parametrize(
    "command, arguments",
    [
        ("cutthread", (30, 20, 8, 1.25, 0, 6)),
        ("cutkeyholegcdxf", (374, 0, 5, "E", 12)),
        ("cut_pins", (100, 12, 4, 8, 0.75, 12.7, 14)),
        ("cut_tails", (100, 12, 4, 8, 0.75, 12.7, 14)),
    ],
)
def test_commands_for_one_shape_of_tool_warn_of_others(gcp, command, arguments):
    gcp.toolchange(102, 16000)
    with pytest.warns(UserWarning, match="should be in use, not a square"):
        getattr(gcp, command)(*arguments)


# ---- the fourth axis


def test_a_fourth_axis_turns_the_part():
    gcp = gcodepreview("cut", True)
    gcp.toolchange(201, 16000)
    gcp.setrotary(0)
    gcp.rapid(5, 0, 30)
    for i in range(0, 361, 90):
        gcp.setrotary(i)
        gcp.rapid(5, 0, 30)
        gcp.cutline(5, 0, 8)
        gcp.cutline(25, 0, 8)
        gcp.rapid(25, 0, 30)
    made = gcp.simulaterotary(20, 0, 40)
    # Four flats of 6.35 mm in a bar of 20 mm: each takes a part of a circle beyond 8 mm from the axis.
    assert 0 < made.removed_mm3 < made.stock_mm3 / 3
    gcp.post = "linuxcnc"
    assert " A270" in gcp.gcode()
    gcp.setrotary(None)
    gcp.rapid(0, 0, 40)
    assert "A" not in gcp.gcode().splitlines()[-3]


# ---- own tools


def test_lollipops(gcp):
    gcp.addtool(901, "lollipop", diameter=10, neck_diameter=4, flute=14)
    gcp.toolchange(901, 12000)
    gcp.rapid(-10, 20, 5)
    gcp.cutline(-10, 20, -11)
    gcp.cutline(30, 20, -11)
    column = part(gcp).column(100, 200)
    assert len(column) == 1 and column[0][1] == pytest.approx(-11, abs=0.01), "on its axis"
    beside = part(gcp).column(100, 240)  # 4 mm beside it: ball below, material above
    assert len(beside) == 2
    with pytest.raises(GcodePreviewError, match="tool_number"):
        gcp.addtool(0, "ball", diameter=3)

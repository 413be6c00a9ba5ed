"""The commands of gcodepreview in OpenSCAD programs against the Python module: the same calls make the same
steps, warnings and files.
"""

import inspect
import math
import os
import pathlib
import shutil
import subprocess
import warnings

import ezdxf
import ezdxf.bbox
import pytest

import kerf
from gcodepreview import gcodepreview, shapes
from gcodepreview_motion import differences, motions, recorded
from kerf_command import command

CASES = pathlib.Path(os.environ.get("KERF_CASES_DIR") or "/nowhere") / "gcodepreview"

START = [("setupstock", 100, 60, 12.7, "Top", "Lower-Left", 9), ("rapid", 0, 0, 0)]
KEYHOLE = [("toolchange", 374, 9000), ("rapid", 50, 30, 5)]
DOVETAIL = [("movetosafeZ",), ("toolchange", 814, 10000), ("rapidZ", 0)]
TOOLS = (102, 100047, 202, 301, 374, 814, 808071, 56142, 45982, 204, 502, 13921)
CORNERS = ("Square", "fillet", "Chamfer", "flipped-fillet")
HEART = shapes.heart(50, 20, 30)
LENS = shapes.lens(50, 30, 20, 20)
QUARTERS = {
    # The start of a quarter circle of 5 mm about (50, 30), and its end.
    "NE": ((55, 30), (50, 35)),
    "NW": ((50, 35), (45, 30)),
    "SW": ((45, 30), (50, 25)),
    "SE": ((50, 25), (55, 30)),
}


def quarter(quadrant, turn, ending=""):
    start, end = QUARTERS[quadrant] if turn == "CC" else QUARTERS[quadrant][::-1]
    return [("cutline", *start, -1), (f"cutquarter{turn}{quadrant}{ending}", *end, -2, 5)]


def about(quadrant, turn, ending):
    start, end = QUARTERS[quadrant] if turn == "CC" else QUARTERS[quadrant][::-1]
    return [("cutline", *start, -1), (f"cutarc{quadrant}{turn}{ending}", *end, -2, 50, 30, 5)]


CALLS = {
    "rapids": [
        *(("rapid", 1, 2, 3), ("rapidXYZ", 2, 3, 4), ("rapidXY", 5, 6), ("rapidXZ", 7, 8)),
        *(("rapidYZ", 9, 10), ("rapidX", 11), ("rapidY", 12), ("rapidZ", 13)),
        *(("rapid", 1, 1, 1, "laser"), ("movetosafeZ",)),
    ],
    "cuts": [
        *(("cutline", 1, 2, -3), ("cutlinegc", 2, 2, -3), ("cutlinedxf", 3, 3, -3)),
        ("cutlinedxfgc", 4, 4, -1),
        *(("cutlineXYZ", 1, 2, -1), ("cutlineXY", 3, 4), ("cutlineXZ", 5, -2), ("cutlineYZ", 6, -3)),
        *(("cutlineX", 7), ("cutlineY", 8), ("cutlineZ", -4), ("cutline", 9, 9, -4, 321)),
    ],
    "feeds": [
        ("opengcodefile", "part", 102, 3.175, 100, 400, 16000),
        ("cutline", 0, 0, -1),
        ("cutlineXYZwithfeed", 1, 2, -1, 111),
        *(("cutlineXYwithfeed", 3, 4, 112), ("cutlineXZwithfeed", 5, -2, 113)),
        *(("cutlineYZwithfeed", 6, -3, 114), ("cutlineXwithfeed", 7, 115)),
        *(("cutlineYwithfeed", 8, 116), ("cutlineZwithfeed", -4, 117), ("cutlineZgcfeed", -5, 118)),
        *(("cutwithfeed", 1, 1, -1, 119), ("moveatfeedrate", 2, 2, -1, 120)),
        *(("cutoneaxis_setfeed", "Z", -3, 50), ("cutoneaxis_setfeed", "X", 20, 60)),
        ("cutline", 30, 30, -3),
    ],
    "preposition": [
        ("begintoolpath", 10, 10, 0.25),
        ("cutline", 10, 10, -1),
        ("endtoolpath",),
        ("writecomment", "done"),
        ("writegc", "(a comment)"),
        ("writegc", "M400"),
    ],
    "arcs": [
        ("cutarcCC", 0, 90, 20, 20, 10, -2, 5),
        ("cutarcCW", 90, 30, 20, 20, 10, -1),
        ("cutarcCCdxf", 0, 400, 50, 30, 10, -1),
        ("cutarcCWdxf", 90, -270, 50, 30, 10, 0),
        ("extrudearcCC", 10, 60, 50, 30, 5, 0),
        ("gcodearc", 102, 40, 30, 5, 0, 180),
        ("cutline", 10, 0, -1),
        ("arcCCgc", 0, 10, -2, 0, 0, 10),
        ("arcCWgc", 10, 0, -2, 0, 0, 10),
    ],
    "circles": [
        ("cutcircleCC", 20, 20, -1, -3, 6),
        ("cutcircleCW", 20, 20, -3, -3, 9),
        ("cutcircleCCdxf", 60, 20, 0, -3, 6),
        ("cutcircleCWdxf", 60, 20, 0, -3, 7),
    ],
    "positions": [
        ("cutline", 10, 10, -2),
        ("setzpos", 9),
        ("rapidXY", 20, 20),
        ("setxpos", 30),
        ("setypos", 5),
        ("setzpos", -1),
        ("cutline", 30, 30, -1),
    ],
    "tools": [
        *(("toolchange", n, 12000) for n in TOOLS),
        ("toolchange", 282),
        ("cutline", 10, 10, -1),
    ],
    "ratios": [
        ("setfeeds", 100, 500),
        ("cutline", 0, 0, -1),
        ("toolchange", 390, 0),
        ("cutline", 10, 0, -1),
    ],
    "rectangles": [
        ("cutrectangle", 102, 10, 10, 0, 30, 20, 3),
        ("cutrectangledxf", 102, 12, 12, 0, 26, 16, 3),
        ("cutrectangleround", 102, 50, 10, 0, 30, 20, 3, 4),
        ("cutrectanglerounddxf", 102, 50, 35, 0, 30, 20, -3, 4),
    ],
    "drawing": [
        ("setdxfcolor", "red"),
        ("dxfline", 102, 0, 0, 10, 0),
        ("dxfline", 102, 10, 0, 10, 10),
        ("dxfarc", 102, 0, 10, 10, 270, 0),
        ("dxfarc", 102, 50, 50, 3, 0, 360),
        ("setdxfcolor", "Light Gray"),
        ("dxfcircle", 102, 30, 30, 5),
        *(("dxfrectangle", 102, 5, 5, 20, 10, corners, 3) for corners in CORNERS),
        ("dxfrectangleround", 102, 5, 25, 20, 10, 3),
        ("dxfrectanglechamfer", 102, 5, 25, 20, 10, 3),
        ("dxfrectangleflippedfillet", 102, 5, 25, 20, 10, 3),
        ("setdxflayer", "own"),
        ("beginpolyline", 102),
        *(("addvertex", 102, x, y) for x, y in ((0, 0), (5, 0), (5, 5), (0, 0))),
        ("closepolyline", 102),
        ("beginpolyline", 102),
        ("cutvertexdxf", 1, 1, -1),
        ("cutvertexdxfgc", 9, 1, -1),
        ("closepolyline", 102),
    ],
    "keyholes": [
        *KEYHOLE,
        ("cutkeyholegcdxf", 374, 0, 4, "S", 12),
        ("cutKHgcdxf", 374, 0, 4, 30, 12),
        ("dxfKH", 378, 20, 20, 0, 4, 77, 15),
    ],
    "pins": [*DOVETAIL, ("cut_pins", 100, 12.7, 4, 8, 0.75, 12.7, 14)],
    "tails": [*DOVETAIL, ("cut_tails", 100, 12.7, 4, 8, 0.75, 12.7, 14, 0.1)],
    **{
        f"box joint {orientation} {side}": [
            ("Full_Blind_Finger_Joint", 5, 7, orientation, side, 90, 12.7, 25.4, 3.175, kind)
        ]
        for orientation, side, kind in (
            ("Vertical", "Left", "Default"),
            ("Vertical", "Right", "Default"),
            ("Vertical", "Both", "Odd"),
            ("Horizontal", "Lower", "Even"),
            ("Horizontal", "Upper", "Default"),
            ("Horizontal", "Both", "Default"),
        )
    },
    "fingers alone": [
        ("Finger_Joint_square", 0, 20, "Horizontal", "Lower", 90, 12.7, 5, 10, 3.175, "Odd", 0.2)
    ],
    "outlines": [
        ("cutoutline", HEART, 0, 2),
        ("cutoutline", HEART, 0, 2, "outside"),
        ("cutoutline", [50, 30, 12], 0, 2, "inside"),
        ("dxfoutline", 102, LENS),
    ],
    "pockets": [
        ("cutpocket", LENS, 0, 2),
        ("cutpocket", shapes.rectangle(5, 5, 30, 20), 0, 2, 0.5, "dog-bone"),
    ],
    "t-bones": [("cutoutline", shapes.rectangle(5, 5, 30, 20), 0, 2, "inside", "t-bone")],
    "finger slots": [
        ("cutfingers", 90, 12, 5, 0, 3),
        ("cutfingers", 90, 12, 5, 0, 3, False, 0.1, "t-bone", 5, 5, "upper", 0.5),
    ],
    "text": [
        ("cuttext", "Kerf 0.93", 10, 20, 8, 0, 0.5),
        ("cuttext", "two\nlines", 10, 40, 5, 0, 0.5, "times", 0.7, 1.5),
        ("dxftext", 102, "abc", 10, 20, 8),
    ],
    "curves": [
        ("cutbezier", [[0, 0], [10, 20], [30, -5], [40, 0]], 0, 1),
        ("dxfbezier", 102, [[0, 0], [10, 20], [40, 0]]),
    ],
    "holes": [
        ("cutthread", 20, 20, 8, 1.25, 0, 6),
        ("cutthread", 20, 20, 8, 1.25, 0, 6, "left"),
        ("toolchange", 202),
        ("cutcountersink", 50, 30, 12, 90, 0, 0.2),
    ],
    "fourth axis": [
        *(("setrotary", 30), ("cutline", 1, 1, -1), ("rapid", 2, 2, 5)),
        *(("setrotary", None), ("rapidX", 9)),
    ],
    "own tools": [
        ("settoolparameters", "mill", 5, 0, 20, 0),
        ("cutoutline", [50, 30, 12], 0, 2, "inside"),
        ("settoolparameters", "mill", 6, 3, 20, 0),
        ("cutoutline", [50, 30, 12], 0, 2, "outside"),
    ],
    **{f"quarter {q} {t}": quarter(q, t) + quarter(q, t, "dxf") for q in QUARTERS for t in ("CC", "CW")},
    **{f"arc {q} {t}": about(q, t, "dxf") + about(q, t, "dxfgc") for q in QUARTERS for t in ("CC", "CW")},
}

PRINTED = [
    ("initializeforprinting", 0.4, 1.75, 0.6, 0.2),
    ("setandwaitforextrudertemperature", 200),
    ("setextrudertemperature", 205),
    ("setbedtemperature", 60),
    ("setandwaitforbedtemperature", 60),
    ("setfansoff",),
    ("setfanspeed", 1, 128),
    ("setfeedratio", 90),
    ("setspeedratio", "95"),
    ("setacceleration", 1000),
    ("setbuildpercentage", 5),
    ("setextrusionabsolute", True),
    ("pauseforclearbuffer",),
    ("setchambertemperature", 40),
    ("setandwaitforchambertemperature", 45),
    ("setfilamentsensor", False),
    ("displaymessage", "Layer 2 of 10"),
    ("clearmessage",),
    ("liftandprimenozzle",),
    ("moveatfeedrate", 0, 0, 0.2, 20000),
    ("extrude", 10, 20, 0.2),
    ("retract", 0.8),
    ("unretract", 0.8, 1800),
    ("extrude", 3.752, 3.756, 0.2, 0.5, 0.25, 1200),
]


def literal(value):
    """A value of Python as OpenSCAD writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "undef"
    if isinstance(value, str):
        return '"' + value.replace("\n", "\\n") + '"'
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(map(literal, value)) + "]"
    return repr(value)


def scad_text(calls, mode="cut", files=False):
    lines = [f'gcp = gcodepreview("{mode}", {literal(files)}, true);']
    lines += [f"{name}({', '.join(map(literal, values))});" for name, *values in calls]
    return "\n".join(lines) + "\n"


def by_python(calls, mode="cut"):
    """The object after the calls, and their warnings."""
    gcp = gcodepreview(mode, False, True)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        for name, *values in calls:
            getattr(gcp, name)(*values)
    return gcp, [str(w.message) for w in found]


def steps_of(path):
    steps = []
    for i in range(len(path)):
        step = dict(path[i])
        step.pop("origin")
        steps.append(step)
    return steps


def same(a, b):
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float) or isinstance(b, float):
        return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-7)
    return a == b


def compare(calls, tmp_path, mode="cut"):
    program = tmp_path / "part.scad"
    program.write_text(scad_text(calls, mode))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        loaded = kerf.load(program)
    gcp, expected_warnings = by_python(calls, mode)
    made, expected = steps_of(loaded.toolpath), steps_of(gcp.toolpath)
    for i, (a, b) in enumerate(zip(made, expected)):
        assert same(a, b), f"step {i}: {a} instead of {b}"
    assert len(made) == len(expected)
    assert len(found) == len(expected_warnings), [str(w.message) for w in found]
    return gcp


@pytest.mark.parametrize("name", CALLS)
def test_calls_make_the_same_steps(name, tmp_path):
    compare(START + CALLS[name], tmp_path)


def test_printing_makes_the_same_steps(tmp_path):
    compare(PRINTED, tmp_path, "print")


def test_a_surface_is_cut_the_same(tmp_path):
    heights = [[0, -1, -2, 0], [-1, -4, -5, 0], [0, -2, -6, -1], [0, 0, -1, 0]]
    program = tmp_path / "part.scad"
    setup = [*START, ("toolchange", 202)]
    call = "cutsurface(bezier_surface(10, 10, 40, 30, %s), 12, 12, 36, 26, 0.5, 2);\n" % literal(heights)
    program.write_text(scad_text(setup) + call)
    gcp, _ = by_python(setup)
    gcp.cutsurface(shapes.bezier_surface(10, 10, 40, 30, heights), 12, 12, 36, 26, 0.5, 2)
    made, expected = motions(kerf.load(program).toolpath), motions(gcp.toolpath)
    # The rows are the same; points that lie on a line within the tolerance may differ by rounding.
    assert abs(len(made) - len(expected)) <= 0.01 * len(expected)
    height = lambda rows: sum(end[2] for _, end, *_ in rows) / len(rows)
    assert height(made) == pytest.approx(height(expected), abs=0.01)


def test_shapes_are_those_of_the_module(tmp_path):
    """Each shape is drawn by both; its outline has the same area and bounds."""
    values = {
        "triangle": (5, 5, 30, 40, 45),
        "annulus_segment": (50, 30, 20, 10, 10, 100),
        "salinon": (50, 30, 20, 5),
    }
    for name, make in shapes.SHAPES.items():
        required = [p for p in inspect.signature(make).parameters.values() if p.default is p.empty]
        arguments = values.get(name, (50, 30, 20, 12, 5, 4)[: len(required)])
        program = tmp_path / "part.scad"
        text = f'cutoutline(shape("{name}", {", ".join(map(str, arguments))}), 0, 1);\n'
        program.write_text(scad_text(START) + text)
        gcp, _ = by_python(START)
        gcp.cutoutline(make(*arguments), 0, 1)
        made, expected = steps_of(kerf.load(program).toolpath), steps_of(gcp.toolpath)
        assert len(made) == len(expected), name
        assert all(map(same, made, expected)), name


def entities(path):
    document = ezdxf.readfile(path)
    assert not document.audit().errors
    rows = []
    for entity in document.modelspace():
        points = entity.get_points("xyb") if entity.dxftype() == "LWPOLYLINE" else []
        box = ezdxf.bbox.extents([entity])
        rows.append((entity.dxf.layer, entity.dxftype(), len(points), *box.extmin.xy, *box.extmax.xy))
    return sorted(rows, key=lambda row: (row[:3], *(round(v, 4) for v in row[3:])))


# Not the pins: their lines are drawn forth and back, which here become one line, there a polyline of both.
DRAWN = ("drawing", "keyholes", "tails", "rectangles", "arcs", "outlines", "text")


@pytest.mark.parametrize("name", DRAWN)
def test_drawings_are_the_same(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    calls = [("opendxffile", "part"), *START, *CALLS[name], ("closedxffile",)]
    (tmp_path / "part.scad").write_text(scad_text(calls))
    subprocess.run([command(), "run", "part.scad"], check=True, capture_output=True)
    shutil.move("part.dxf", "scad.dxf")
    by_python(calls)
    made, expected = entities("scad.dxf"), entities("part.dxf")
    assert len(made) == len(expected)
    assert all(map(same, made, expected))


def run_scad(script, *options):
    return subprocess.run([command(), "run", script, *options], capture_output=True, text=True)


@pytest.mark.skipif(not CASES.is_dir(), reason="the cases are not given")
def test_the_template_runs_unmodified(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copyfile(CASES / "templates" / "gcodepreviewtemplate.scad", "template.scad")
    done = run_scad("template.scad", "-o", "part.png")
    assert done.returncode == 0, done.stderr
    assert "is a semicolon missing" in done.stderr, "of line 207"
    text = pathlib.Path("export.nc").read_text()
    assert "(STOCK/BLOCK, 220, 150, 8.35, 110.0, 75.0, 8.35)" in text
    assert not ezdxf.readfile("export.dxf").audit().errors
    assert pathlib.Path("part.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.skipif(not CASES.is_dir(), reason="the cases are not given")
def test_the_templates_move_alike_where_they_agree(tmp_path):
    """Cuts of the .scad template, by tool, are those of the .py template, except where the two differ."""
    shutil.copyfile(CASES / "templates" / "gcodepreviewtemplate.scad", tmp_path / "template.scad")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = kerf.load(tmp_path / "template.scad").toolpath
    rows = recorded(CASES / "reference" / "gcodepreviewtemplate.motion.json")
    known = {tuple(round(v, 5) + 0.0 for v in end) for kind, _, end in rows if kind == "cut"}
    ends = [end for kind, end, *_ in motions(path) if kind in ("cut", "arc")]
    other = [end for end in ends if tuple(round(v, 5) + 0.0 for v in end) not in known]
    # The recorded quarter circles stop one degree before their end, which these reach.
    assert [tuple(round(v, 4) for v in end) for end in other] == [
        (-55, 56.25, -2.0875),
        (-73.75, 37.5, -4.175),
        (-55, 18.75, -6.2625),
    ]
    assert len(ends) - len(other) == 36


@pytest.mark.skipif(not CASES.is_dir(), reason="the cases are not given")
@pytest.mark.parametrize("name", ["joint_dovetail_pins", "joint_dovetail_tails"])
def test_joints_move_as_recorded(name, tmp_path):
    tail = "cut_tails" if "tails" in name else "cut_pins"
    calls = [
        ("setupstock", 100, 60, 12.7, "Top", "Lower-Left", 9),
        *DOVETAIL,
        (tail, 100, 12.7, 4, 8, 0.75, 12.7, 14),
    ]
    (tmp_path / "part.scad").write_text(scad_text(calls))
    path = kerf.load(tmp_path / "part.scad").toolpath
    assert differences(path, recorded(CASES / "reference" / name / f"{name}.motion.json")) == []


def test_gcode_is_that_of_python(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    calls = [
        ("opengcodefile", "part", 102, 3.175, 100, 400, 16000),
        *START,
        ("movetosafeZ",),
        ("toolchange", 201, 16000),
        ("rapid", 10, 10, 5),
        ("cutlinedxfgc", 10, 10, -3),
        ("cutarcCC", 0, 90, 0, 10, 10, -1),
        ("closegcodefile",),
    ]
    (tmp_path / "part.scad").write_text(scad_text(calls, files=True))
    assert run_scad("part.scad").returncode == 0
    shutil.move("part.nc", "scad.nc")
    gcp = gcodepreview("cut", True, True)
    for name, *values in calls:
        getattr(gcp, name)(*values)
    made, expected = (pathlib.Path(name).read_text().splitlines() for name in ("scad.nc", "part.nc"))
    assert made[0] == "(part)"  # the name of the file; a toolpath of Python has none
    assert made[1:] == expected[1:]


def test_a_wrong_call_names_its_line_and_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = [("toolchange", 999), ("cutline", 1, "a", 2)]
    calls = [("opengcodefile", "part"), *START, *wrong, ("closegcodefile",)]
    (tmp_path / "part.scad").write_text(scad_text(calls, files=True))
    done = run_scad("part.scad")
    assert done.returncode != 0
    assert "part.scad:5" in done.stderr and "there is no tool 999" in done.stderr
    assert "part.scad:6" in done.stderr, "all errors are reported"
    assert not pathlib.Path("part.nc").exists()


def test_children_are_outlines(tmp_path):
    text = scad_text(START) + "cutpocket(zdepth=2) translate([50, 30]) circle(10);\n"
    (tmp_path / "part.scad").write_text(text)
    ends = [end for kind, end, *_ in motions(kerf.load(tmp_path / "part.scad").toolpath) if kind == "arc"]
    assert max(math.dist(end[:2], (50, 30)) for end in ends) == pytest.approx(10 - 1.5875, abs=1e-3)

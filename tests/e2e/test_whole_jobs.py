"""Whole jobs of the workshop, each from one command: posted, read back without a finding, and compared with
their drawings by shapely; tools that an operation refuses."""
import json
import math
import re
from pathlib import Path

import pytest

shapely = pytest.importorskip("shapely")
import shapely.affinity  # noqa: E402
from shapely.geometry import LineString, Point, Polygon, box  # noqa: E402
from shapely.ops import unary_union  # noqa: E402

JOBS = Path(__file__).parents[2] / "examples" / "jobs"
NAMES = ("sign", "pcb", "relief", "inlay", "box")


@pytest.mark.parametrize("post", ("grbl", "linuxcnc"))
@pytest.mark.parametrize("name", NAMES)
def test_a_whole_job_is_posted_and_checked_without_a_finding(kerf, name, post):
    cut = kerf("cut", JOBS / f"{name}.toml", "--to", post, "-o", f"{name}.nc", "--json")
    assert cut.status == 0, cut.out + cut.err
    assert [d for d in cut.json["diagnostics"] if d["severity"] != "note"] == []
    check = kerf("check", "--json", f"{name}.nc")
    assert check.status == 0, check.out
    assert check.json["hazards"] == []
    assert [d for d in check.json["diagnostics"] if d["severity"] != "note"] == []


def cuts(kerf, name, tool=None):
    """Cutting lines of a tool in the posted program, as pairs of points; arcs in chords."""
    kerf("cut", JOBS / f"{name}.toml", "--to", "grbl", "-o", "job.nc")
    run = kerf("steps", "--json", "job.nc")
    assert run.status == 0, run.err
    lines, here = [], None
    for step in map(json.loads, run.out.splitlines()):
        if "to" not in step:
            continue
        if step["step"] in ("cut", "arc") and tool in (None, step["tool"]):
            points = [here, *(chords(here, step) if step["step"] == "arc" else [step["to"]])]
            lines += zip(points, points[1:])
        here = step["to"]
    assert lines
    return lines


def chords(start, step):
    centre, end = step["centre"], step["to"]
    assert step["plane"] == "XY" and step["extra_turns"] == 0
    radius = math.hypot(start[0] - centre[0], start[1] - centre[1])
    first, last = (math.atan2(p[1] - centre[1], p[0] - centre[0]) for p in (start, end))
    turn = (last - first) % (2 * math.pi) or 2 * math.pi
    if step["turn"] == "cw":
        turn = turn - 2 * math.pi or -2 * math.pi
    count = max(8, math.ceil(abs(turn) / 0.1))
    return [[centre[0] + radius * math.cos(first + turn * i / count),
             centre[1] + radius * math.sin(first + turn * i / count),
             start[2] + (end[2] - start[2]) * i / count] for i in range(1, count)] + [end]


def swept(lines, radius_at):
    """The area that round tools cover, whose radius depends on Z."""
    hulls = []
    for a, b in lines:
        ends = [Point(p[:2]).buffer(radius_at(p[2]), quad_segs=32) for p in (a, b) if radius_at(p[2]) > 0]
        if ends:
            hulls.append(unary_union(ends).convex_hull)
    return unary_union(hulls)


def below(lines, z):
    """The parts of lines that are below Z."""
    def clipped(a, b):
        t = (z - a[2]) / (b[2] - a[2]) if a[2] > z else 0
        return [p + t * (q - p) for p, q in zip(a, b)]
    return [(clipped(a, b), clipped(b, a)) for a, b in lines if min(a[2], b[2]) < z]


PADS = [(6, 6), (6, 14), (6, 24), (13, 24), (24, 6), (34, 6), (34, 14), (34, 24)]
TRACKS = [[(6, 6), (16, 6), (24, 14), (34, 14)], [(6, 14), (14, 14), (24, 24), (34, 24)],
          [(6, 24), (13, 24)], [(24, 6), (34, 6)]]


def test_the_copper_that_is_left_is_that_of_the_art(kerf):
    """Each net is one piece, and no piece has two nets."""
    def at(points):
        return [(x + 3, 33 - y) for x, y in points]  # lower left corner of the edge and its margin
    pads = [Point(p).buffer(1.1, quad_segs=32) for p in at(PADS[1:])] + [box(7.9, 25.9, 10.1, 28.1)]
    pads = unary_union(pads)
    lines = [LineString(at(track)) for track in TRACKS]
    nets = [unary_union([line.buffer(0.4, quad_segs=32), *(p for p in pads.geoms if p.intersects(line))])
            for line in lines]
    cut = swept(cuts(kerf, "pcb", 1), lambda z: 0.05 - z * math.tan(math.radians(15)) if z < 0 else 0)
    left = box(4, 4, 42, 32) - cut
    pieces = [next(p for p in left.geoms if p.intersects(net.buffer(-0.3))) for net in nets]
    assert len({id(p) for p in pieces}) == len(nets) == 4
    for net, piece in zip(nets, pieces):
        assert piece.contains(net.buffer(-0.01))
        assert net.buffer(0.09).buffer(-0.08).contains(piece)  # inner corners are as round as the tool
    assert len(left.geoms) == 5  # and the copper around


def test_the_boards_of_the_box_go_together(kerf):
    manifold3d, numpy = pytest.importorskip("manifold3d"), pytest.importorskip("numpy")
    panel = box(0, 0, 174, 124)
    parts = panel - swept(cuts(kerf, "box"), lambda z: 1.5 if z < 0 else 0)

    def board(x, y, matrix):
        piece = next(p for p in parts.geoms if p.contains(Point(x + 30, y + 25)))
        assert not piece.interiors
        ring = shapely.geometry.polygon.orient(piece).exterior.coords[:-1]
        flat = manifold3d.CrossSection([[(px - x, py - y) for px, py in ring]])
        return flat.extrude(6).transform(numpy.array(matrix, dtype=float))

    front = board(8, 8, [[1, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0]])
    side = board(106, 8, [[0, 0, 1, 84], [1, 0, 0, 0], [0, 1, 0, 0]])
    corner = manifold3d.Manifold.cube((6, 6, 50)).translate((84, 0, 0))
    assert front.volume() > 25000 and side.volume() > 15000
    assert (front ^ side).volume() < 0.01
    gaps = (corner - front - side).volume()
    bones = 4 * 2 * 6 * 1.0  # mm3: a bone takes less than 1 mm2 of the finger beside its corner
    assert 4 * 0.1 * 36 - 0.1 < gaps < 4 * 0.1 * 36 + bones


def test_the_plug_fits_into_its_pocket(kerf):
    slope, depth, glue = math.tan(math.radians(30)), 3.0, 0.4
    walls, floors, corners = (cuts(kerf, "inlay", tool) for tool in (2, 1, 3))

    def section(z, plug):
        def here(lines):
            return [line for line in lines if (line[0][0] > 60) == plug]
        return unary_union([swept(below(here(walls), z), lambda tip: max(z - tip, 1e-9) * slope),
                            swept(here(floors), lambda tip: 1.5 if tip <= z else 0),
                            swept(here(corners), lambda tip: 0.5 if tip <= z else 0)])
    low, high = section(-0.001, False).bounds[0], section(-0.001, False).bounds[2]
    for z in (-0.4, -1.5, -2.55):
        pocket = section(z, False)
        cut = section(-(depth - glue + z), True)
        around = max(getattr(cut, "geoms", [cut]), key=lambda g: g.area)
        rest = Polygon(around.exterior) - cut
        plug = max(getattr(rest, "geoms", [rest]), key=lambda g: g.area)
        plug = shapely.affinity.translate(plug, -60)
        plug = shapely.affinity.scale(plug, -1, origin=((low + high) / 2, 0))
        assert pocket.buffer(0.02).contains(plug), z
        assert (pocket - plug.buffer(0.05)).area < 0.5, z  # corners where two walls meet


TOOLS = {"drill": "drill d=6", "ball": "ball d=6", "square": "square d=6", "V": "V d=6 angle=60",
         "dovetail": "dovetail d=6 angle=14 flute=5", "keyhole": "keyhole d=6 head=2 neck=3 flute=10",
         "thread mill": "thread mill minor_diameter=4.6 major_diameter=6 pitch=1.4 length=15"}
REFUSED = [
    *(("drill", op) for op in ("pocket", "contour", "engrave", "isolation", "face", "bore", "vcarve", "slot",
                               "trochoidal-slot", "thread", "chamfer", "vcarve-floor")),
    *((tool, op) for tool in ("dovetail", "keyhole") for op in ("pocket", "contour", "face", "drill")),
    *(("thread mill", op) for op in ("pocket", "contour", "drill", "slot", "vcarve")),
    ("ball", "drill"), ("ball", "thread"), ("square", "vcarve"), ("square", "thread"), ("square", "chamfer"),
    ("V", "thread")]


@pytest.mark.parametrize("tool, op", REFUSED)
def test_tools_that_cannot_do_an_operation_are_refused(kerf, program, tool, op):
    job = kerf("cut", "--example", op).out
    job = re.sub(r'^(\d+) = ".*"', lambda m: f'{m[1]} = "{TOOLS[tool]}"', job, flags=re.M)
    run = kerf("cut", program(job, "job.toml"), "-o", "out.nc")
    assert run.status == 1
    form = rf"job.toml:\d+:\d+: error: .*: tool \d+ \({tool}\) cannot do the operation "
    assert re.search(form, run.err), run.err
    assert "tools that can: " in run.err


def test_strokes_of_some_layers_are_areas(kerf, program):
    """The edge of a board stays one line, whatever its stroke; a layer that is named by its colour counts."""
    program('''<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm"
 viewBox="0 0 40 40" fill="none">
<path d="M10,20 H30" stroke="blue" stroke-width="4"/>
<rect x="0" y="0" width="40" height="40" stroke="red" stroke-width="2"/></svg>''', "art.svg")
    job = program('''art = "art.svg"
strokes = ["blue"]
[tools]
1 = "square d=2 flute=6"
[defaults]
tool = 1
feed = 300
rpm = 9000
depth = 1
[[operation]]
op = "isolation"
layers = ["blue"]
[[operation]]
op = "contour"
layers = ["red"]
''', "job.toml")
    run = kerf("cut", job, "--to", "grbl")
    assert run.status == 0, run.err
    assert "cuts within X -1 to 41 Y -1 to 41 " in run.out
    steps = [json.loads(line) for line in kerf("steps", "--json", job).out.splitlines()]
    starts = [s for a, s in zip(steps, steps[1:]) if a.get("step") == "rapid" and s.get("step") != "rapid"]
    assert len([s for s in starts if s["step"] in ("cut", "arc")]) == 2  # once around each


def test_a_spoilboard_is_stated_in_the_program_and_limits_its_cuts(kerf, program):
    job = (JOBS / "box.toml").read_text().replace("box.svg", str(JOBS / "box.svg"))
    for board, status in ((3, 0), (0.1, 3)):
        file = program(job.replace("spoilboard = 3", f"spoilboard = {board}"), "job.toml")
        assert kerf("cut", file, "--to", "grbl", "-o", "out.nc").status == 0
        assert kerf("check", "out.nc").status == status
        assert kerf("check", file).status == status


def test_the_way_down_from_a_tool_change_is_straight(kerf, program):
    """Across at the height of the change, then down."""
    job = (JOBS / "pcb.toml").read_text().replace("pcb.svg", str(JOBS / "pcb.svg"))
    file = program("change-height = 40\nchange-at = [0, 0]\n" + job, "job.toml")
    steps = [json.loads(line) for line in kerf("steps", "--json", file).out.splitlines()]
    points = [s["to"] for s in steps if "to" in s]
    high = [i for i, p in enumerate(points) if p[2] == 40]
    assert len(high) >= 6
    for i in high:
        if points[i + 1][2] < 40:
            assert points[i + 1][:2] == points[i][:2]


def test_a_margin_without_a_thickness_says_that_no_stock_is_made(kerf, program):
    job = (JOBS / "box.toml").read_text().replace("box.svg", str(JOBS / "box.svg"))
    job = job.replace("thickness = 6\n", "").replace("through = 0.2", "depth = 6.2")
    run = kerf("cut", program(job, "job.toml"), "-o", "out.nc")
    assert run.status == 0 and "note: art-margin without thickness makes no stock" in run.err


def with_clamps(name, retract):
    """The text of a job with a tool change and a park beyond its clamps."""
    text = (JOBS / f"{name}.toml").read_text(encoding="utf-8")
    text = re.sub('^art = "', f'art = "{JOBS.as_posix()}/', text, flags=re.MULTILINE)
    text = text.replace('"../shell.stl"', f'"{(JOBS.parent / "shell.stl").as_posix()}"')
    text = re.sub(r"(?m)^retract = .*\n", "", text)
    heights = f"retract = {retract}" if retract else ""
    if "[defaults]" in text:
        text = text.replace("[defaults]", f"[defaults]\n{heights}")
    else:
        text = text.replace("[[operation]]", f"[defaults]\n{heights}\n[[operation]]", 1)
    return f"change-height = 40\nchange-at = [-30, -30]\npark = [-30, 90]\n{text}"


@pytest.mark.parametrize("name", NAMES)
def test_retract_change_height_and_park_clear_clamps_of_25_mm(kerf, program, tmp_path, name):
    """Clamps are all around the stock, 0.1 mm away; the tool is changed and parked beyond them."""
    def contacts(retract):
        cut = kerf("cut", program(with_clamps(name, retract), "job.toml"), "-o", "job.nc")
        assert cut.status == 0, cut.err
        text = (tmp_path / "job.nc").read_text(encoding="utf-8")
        (x0, y0, z0), (x1, y1, _) = (
            [float(v) for v in re.search(rf"\(stock{end}:(.*)mm\)", text)[1].replace("mm", "").split(",")]
            for end in ("Min", "Max"))
        near, wide = 0.1, 10
        x0, y0, x1, y1 = x0 - near, y0 - near, x1 + near, y1 + near
        bars = [(x0 - wide, y0 - wide, x0, y1 + wide), (x1, y0 - wide, x1 + wide, y1 + wide),
                (x0, y0 - wide, x1, y0), (x0, y1, x1, y1 + wide)]
        clamps = [f"--fixture={a},{b},{z0} to {c},{d},25" for a, b, c, d in bars]
        check = kerf("check", "--json", "job.nc", *clamps)
        return [hazard for hazard in check.json["hazards"] if hazard["kind"] == "fixture_contact"]
    assert contacts(30) == []
    assert contacts(None) != []


# Links between the lines of one shape were 0.5 mm above the material, beside the shape, too.
BOLT = """stock = "0,-30,-12 to 100,70,0"
[tools]
1 = "V d=12 angle=60"
[[shape]]
name = "C"
polygon = [[20, -10], [80, -10], [80, 50], [20, 50], [20, 40], [70, 40], [70, 0], [20, 0]]
[[operation]]
op = "vcarve"
tool = 1
feed = 600
rpm = 10000
retract = 30
"""


def test_rapids_of_carving_leave_the_letter_above_retract(kerf, program):
    cut = kerf("cut", program(BOLT, "bolt.toml"), "-o", "bolt.nc")
    assert cut.status == 0, cut.err
    check = kerf("check", "--json", "bolt.nc", "--fixture", "25,4,-6 to 64,36,25")
    assert check.status == 0 and check.json["hazards"] == [], check.out

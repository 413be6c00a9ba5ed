"""kerf.op: every operation with its keys as arguments, and changes of finished programs."""

import importlib.util
import inspect
import math
import pathlib
import re

import numpy as np
import pytest

import kerf

SQUARE = [(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]
PLATE = kerf.Region([SQUARE])
MILL, VEE = "square d=6", "V d=20 angle=60"
# Of each operation: what it cuts, its tool, and what it requires.
EXAMPLES = {
    "pocket": (PLATE, MILL, dict(depth=4, feed=900)),
    "contour": (PLATE, MILL, dict(depth=4, feed=900)),
    "chamfer": (PLATE, VEE, dict(width=1, feed=900)),
    "isolation": (PLATE, "square d=1", dict(depth=0.1, feed=400)),
    "engrave": ([SQUARE], MILL, dict(depth=1, feed=900)),
    "face": (PLATE, MILL, dict(depth=1, feed=900)),
    "drill": ([(5, 5), (9, 30)], "drill d=3", dict(depth=4, feed=100)),
    "bore": ([(20, 20, 8)], MILL, dict(depth=4, feed=900)),
    "keyhole": ([(20, 20)], "keyhole d=9.5 head=4.8 neck=4.8 flute=12", dict(depth=6, feed=500, length=12)),
    "slot": ([[(0, 20), (60, 20)]], "dovetail d=12.7 flute=9 angle=14", dict(depth=6, feed=500)),
    "thread": (
        [(20, 20, 5)],
        "thread mill minor_diameter=3 major_diameter=6 cut_height=2 length=12",
        dict(depth=8, feed=200, pitch=1.25),
    ),
    "countersink": ([(20, 20, 5)], "ball d=3", dict(depth=3, feed=500)),
    "vcarve": (PLATE, VEE, dict(feed=900)),
    "vcarve-floor": (PLATE, MILL, dict(depth=3, feed=900, carve_tool=kerf.Tool(VEE, 2))),
}
LASERS = {
    "laser": ([SQUARE], dict(power=30, feed=2000)),
    "laser-cut": (PLATE, dict(power=90, feed=300)),
    "laser-fill": (PLATE, dict(power=30, feed=2000)),
    "laser-test": (None, dict(power=100, feed=1200)),
    "laser-frame": (PLATE, dict(feed=3000)),
}
# A roof of slope 3/4 along X over 20 x 10 mm, its ridge at Z0.
ROOF = (
    [(0, 0, -7.5), (10, 0, 0), (20, 0, -7.5), (0, 10, -7.5), (10, 10, 0), (20, 10, -7.5)],
    [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)],
)
RIDGE = [[(4, 5), (16, 5)]]
MESHES = {
    "raster": ([], dict(feed=900)),
    "waterline": ([], dict(feed=900, stepdown=2)),
    "project": ([RIDGE], dict(feed=900, depth=0.5)),
}
FUNCTIONS = {"vcarve": "v_carve", "vcarve-floor": "v_carve_floor"}


def steps(program):
    path = program.toolpath
    return [{k: v for k, v in path[i].items() if k != "origin"} for i in range(len(path))]


def made(op, **more):
    shapes, tool, required = EXAMPLES[op]
    return getattr(kerf.op, FUNCTIONS.get(op, op))(shapes, tool, **required, **more)


OPERATIONS = kerf.job_schema()["$defs"]
# Keys that are an argument of another form, or none.
NO_ARGUMENT = {"op", "layers", "outlines", "tool", "name", "rpm", "through"}


@pytest.mark.parametrize("op", OPERATIONS)
def test_the_functions_have_the_keys_of_the_rows(op):
    function = getattr(kerf.op, FUNCTIONS.get(op, op.replace("-", "_")))
    assert function.__name__ in kerf.op.__all__
    arguments = inspect.signature(function).parameters
    documented = set(re.findall(r"^ +(\w+) : ", function.__doc__.split("Returns")[0], re.M))
    assert documented == set(arguments)
    assert all(argument.annotation is not inspect.Parameter.empty for argument in arguments.values())
    rows = OPERATIONS[op]["properties"]
    for key in rows.keys() - NO_ARGUMENT:
        argument = arguments[key.replace("-", "_")]
        if rows[key].get("x-required"):
            assert argument.default is inspect.Parameter.empty
        else:
            assert argument.default == rows[key].get("default"), key


@pytest.mark.parametrize("name", ["operations.md", "laser.md"])
def test_the_manual_has_all_operations_and_their_keys(name):
    root = pathlib.Path(__file__).parents[2]
    tools = root / "tests" / "tools" / "make_key_tables.py"
    spec = importlib.util.spec_from_file_location("make_key_tables", tools)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    text = (root / "docs" / "manual" / name).read_text()
    assert text == module.page(name), "run tests/tools/make_key_tables.py"
    for op, row in OPERATIONS.items():
        assert ("x-laser" in row) != module.PAGES[name] or f"| `{op}` |" in text, op


@pytest.mark.parametrize("op", EXAMPLES)
def test_their_defaults_are_those_of_the_operation(op):
    shapes, tool, required = EXAMPLES[op]
    name = "points" if op in ("drill", "keyhole") else "shapes"
    plain = kerf.cut(op, tool=tool, **{name: shapes}, **required)
    assert len(plain) > 4
    assert steps(made(op)) == steps(plain)


@pytest.mark.parametrize("op", LASERS)
def test_the_defaults_of_lasers_are_those_of_the_operation(op):
    shapes, required = LASERS[op]
    function = getattr(kerf.op, op.replace("-", "_"))
    program = function(**required) if shapes is None else function(shapes, **required)
    plain = kerf.cut(op, shapes, **required)
    assert len(plain) > 3
    assert steps(program) == steps(plain)


@pytest.mark.parametrize("op", MESHES)
def test_the_defaults_on_meshes_are_those_of_the_operation(op):
    more, required = MESHES[op]
    plain = kerf.cut(op, *more, mesh=ROOF, tool="ball d=6", **required)
    assert len(plain) > 4
    assert steps(getattr(kerf.op, op)(ROOF, *more, "ball d=6", **required)) == steps(plain)


def cut_length(program):
    motions = [(step["step"], step["to"]) for step in steps(program) if "to" in step]
    return sum(math.dist(a, b) for (_, a), (kind, b) in zip(motions, motions[1:]) if kind == "cut")


def cut_points(program):
    return [step["to"] for step in steps(program) if step["step"] == "cut"]


def test_a_raster_of_a_mesh_of_arrays():
    points, triangles = np.array(ROOF[0], dtype=np.float32), np.array(ROOF[1], dtype=np.int64)
    area = [[(100, 2), (120, 2), (120, 8), (100, 8), (100, 2)]]
    cuts = cut_points(
        kerf.op.raster(
            (points, triangles), "ball d=6", feed=900, move=(100, 0, 2), area=area, line_distance=2
        )
    )
    # Lines are in the centres of three strips.
    assert {round(p[1], 6) for p in cuts} == {3, 5, 7}
    for x, _, z in cuts:
        # A ball touches a slope of 3/4 a quarter of its radius above the point below its tip, and the ridge
        # where its circle does.
        slope = 2 - 0.75 * abs(x - 110) + 3 * 0.25
        ridge = 2 - 3 + math.sqrt(max(0.0, 9 - (x - 110) ** 2))
        height = slope if abs(x - 110) > 3 * 0.6 else ridge
        assert height - 1e-6 <= z <= max(height, -5.5) + 0.011, (x, z)


def test_a_mesh_of_a_file_and_of_a_simulation(tmp_path):
    part = kerf.simulate(made("pocket"), kerf.Stock.block((60, 40, 10)), resolution=0.5)
    part.save(tmp_path / "part.stl")
    of_file = kerf.op.raster(tmp_path / "part.stl", "ball d=3", feed=900, stepover=0.5)
    of_arrays = kerf.op.raster(part.mesh(), "ball d=3", feed=900, stepover=0.5)
    lowest = [min(p[2] for p in cut_points(program)) for program in (of_file, of_arrays)]
    assert lowest == pytest.approx([-4, -4], abs=0.02)


def test_engraving_on_a_mesh():
    cuts = cut_points(kerf.op.project(ROOF, RIDGE, "V d=6 angle=60", feed=900, depth=0.5))
    # Beside the ridge the tip of a cone steeper than the slope touches where it is, and goes deeper.
    assert cuts[0][2] == pytest.approx(-0.75 * 6 - 0.5, abs=1e-6)
    assert max(p[2] for p in cuts) == pytest.approx(-0.5, abs=0.02)


def test_wrong_meshes_are_named(tmp_path):
    with pytest.raises(TypeError, match="mesh must be a path, or points and triangles"):
        kerf.op.raster(5, "ball d=6", feed=900)
    with pytest.raises(ValueError, match="points of a mesh are an array of N x 3"):
        kerf.op.raster(([1, 2, 3], ROOF[1]), "ball d=6", feed=900)
    with pytest.raises(ValueError, match="M x 3 whole numbers"):
        kerf.op.raster((ROOF[0], np.zeros((2, 3))), "ball d=6", feed=900)
    with pytest.raises(ValueError, match="not one of its 6 points"):
        kerf.op.raster((ROOF[0], [(0, 1, 6)]), "ball d=6", feed=900)
    with pytest.raises(kerf.Error, match="point beyond"):
        kerf.op.raster(([(0, 0, 0), (1, 0, math.nan), (0, 1, 0)], [(0, 1, 2)]), "ball d=6", feed=900)
    with pytest.raises(kerf.Error, match="no outline"):
        kerf.op.raster(ROOF, "ball d=6", feed=900, area=[])
    with pytest.raises(kerf.Error, match="no mesh"):
        kerf.cut("raster", tool="ball d=6", feed=900)
    with pytest.raises(kerf.Error):
        kerf.op.raster(tmp_path / "none.stl", "ball d=6", feed=900)


def test_a_picture_is_burnt():
    rows = ["0990", "9009"]
    program = kerf.op.laser_picture(rows, width=4, at=(10, 20), power=40, feed=3000, interval=1)
    assert steps(program) == steps(
        kerf.cut("laser_picture", pixels=rows, picture_width=4, at=(10, 20), power=40, feed=3000, interval=1)
    )
    # Four of eight pixels of 1 mm2 are black: 4 W for 4 mm at 50 mm/s.
    burn = kerf.burn(program, beam=0.1, power=10)
    assert burn.energy_j == pytest.approx(0.4 * 10 * 4 / 50, rel=0.02)


def test_the_line_of_the_script_is_the_origin():
    program = made("pocket")
    origin = program.toolpath[2]["origin"]
    assert origin["file"].endswith("test_op.py") and origin["call"] == "pocket"


def test_a_spindle_speed_and_a_name():
    path = made("pocket", rpm=12000, name="left").toolpath
    kinds = {path[i]["step"]: path[i] for i in range(len(path))}
    assert kinds["spindle"]["rpm"] in (0, 12000)
    assert any(path[i].get("rpm") == 12000 for i in range(len(path)))


def test_wrong_arguments_are_named():
    with pytest.raises(TypeError, match="depth"):
        kerf.op.pocket(PLATE, MILL, feed=900)
    with pytest.raises(TypeError, match="stepdwn"):
        made("pocket", stepdwn=2)
    with pytest.raises(kerf.Error, match="direction: .*climb, conventional"):
        made("pocket", direction="left")
    with pytest.raises(kerf.Error, match="stepdown: .*number in mm"):
        made("pocket", stepdown=math.nan)
    with pytest.raises(TypeError, match="tool must be a Tool"):
        kerf.op.pocket(PLATE, 3.5, depth=1, feed=900)
    with pytest.raises(TypeError, match="shapes must be"):
        kerf.op.pocket("plate.dxf", MILL, depth=1, feed=900)


def test_rest_machining_cuts_the_corners_alone():
    # A round tool of 12 mm leaves (1 - pi/4) r^2 in each corner of a rectangle.
    large = kerf.op.pocket(PLATE, kerf.Tool("square d=12", 1), depth=2, feed=900)
    small = kerf.op.pocket(PLATE, kerf.Tool("square d=2", 2), depth=2, feed=900, rest_tool="square d=12")
    stock = kerf.Stock.block((60, 40, 5))
    first = kerf.simulate(large, stock, resolution=0.1)
    both = kerf.simulate(kerf.op.join(large, small), stock, resolution=0.1)
    left = 4 * (1 - math.pi / 4) * 6**2 * 2
    left_by_small = 4 * (1 - math.pi / 4) * 1**2 * 2
    assert first.left_mm3 - both.left_mm3 == pytest.approx(left - left_by_small, rel=0.03)
    assert len(small) < 0.5 * len(kerf.op.pocket(PLATE, "square d=2", depth=2, feed=900))


def test_rest_machining_of_a_mesh_leaves_no_more_than_the_whole_raster():
    shape = kerf.op.pocket(kerf.Region([SQUARE]), "square d=2", depth=3, feed=900)
    block = kerf.move_stock(kerf.Stock.block((70, 50, 8)), shift=(-5, -5, 0))
    mesh = kerf.simulate(shape, block, resolution=0.25).mesh()
    cut = dict(feed=900, area=[SQUARE], top=0, depth=3)
    large = kerf.op.raster(mesh, kerf.Tool("ball d=8", 1), stepover=0.05, **cut)
    whole = kerf.op.raster(mesh, kerf.Tool("ball d=3", 2), stepover=0.2, **cut)
    rest = kerf.op.raster(mesh, kerf.Tool("ball d=3", 2), stepover=0.2, rest_tool="ball d=8", **cut)

    def left(*programs):
        return kerf.simulate(kerf.op.join(*programs), block, resolution=0.2).left_mm3

    left_by_large, left_by_whole, left_by_rest = left(large), left(large, whole), left(large, rest)
    # Beside walls 3 mm high the ball of 8 mm leaves 3.39 mm2, that of 3 mm 0.48 mm2, and more where no line
    # of it is near enough to a wall: less than 200 * 2.91 mm3.
    assert 300 < left_by_large - left_by_whole < 582
    # Of that, at most 0.1 mm remains where it is thinner, over walls and floors near them.
    assert left_by_rest - left_by_whole < 0.05 * (left_by_large - left_by_whole)
    assert cut_length(rest) < 0.6 * cut_length(whole)


def test_two_tools_of_an_operation_have_two_numbers():
    with pytest.raises(ValueError, match="carve_tool has the number 2"):
        kerf.op.v_carve_floor(PLATE, kerf.Tool(MILL, 2), depth=3, feed=900, carve_tool=kerf.Tool(VEE, 2))


def test_texts_are_outlines():
    word = kerf.op.text_outlines("HI", 10, at=(5, 5))
    xs = [p[-2] for outline in word for p in outline]
    ys = [p[-1] for outline in word for p in outline]
    assert min(xs) >= 5 and min(ys) == pytest.approx(5, abs=0.01) and max(ys) == pytest.approx(15, abs=0.01)
    assert len(kerf.op.engrave(word, "V d=6 angle=60", depth=0.4, feed=600)) > 10
    with pytest.raises(kerf.Error, match="no font"):
        kerf.op.text_outlines("HI", 10, font="gothic")
    with pytest.raises(OSError):
        kerf.op.text_outlines("HI", 10, font="missing.ttf")


# ---- joining


def rapids_between(first, second):
    path = kerf.op.join(first, second).toolpath
    return [path[i]["to"] for i in range(len(path)) if path[i]["step"] == "rapid"]


def program(x, high):
    path = kerf.Toolpath()
    path.tool(102)
    path.spindle(9000)
    path.rapid((0, 0, high), unknown="XY")
    path.rapid((x, 0, high))
    path.cut((x, 0, -1), feed=100)
    path.rapid((x, 0, high))
    path.end()
    return path


def test_a_joined_program_rises_before_it_goes_across():
    assert rapids_between(program(10, 5), program(40, 20))[2:] == [
        (10, 0, 5),
        (10, 0, 20),
        (40, 0, 20),
        (40, 0, 20),
    ]


def test_a_joined_program_goes_down_after_it_went_across():
    assert rapids_between(program(10, 20), program(40, 5))[2:] == [
        (10, 0, 20),
        (40, 0, 20),
        (40, 0, 5),
        (40, 0, 5),
    ]


def test_a_joined_program_ends_once_and_stops_the_spindle_between():
    path = kerf.op.join(program(10, 5), program(40, 5)).toolpath
    kinds = [path[i]["step"] for i in range(len(path))]
    assert kinds.count("end") == 1 and kinds[-1] == "end"
    turns = [path[i]["turn"] for i in range(len(path)) if path[i]["step"] == "spindle"]
    assert turns == ["cw", "off", "cw"]


def test_what_cannot_be_joined_is_refused():
    cut_first = kerf.Toolpath()
    cut_first.cut((10, 0, -1), feed=100)
    with pytest.raises(kerf.Error, match="starts with a cut"):
        kerf.op.join(program(10, 5), cut_first)
    with pytest.raises(ValueError, match="tool 1 has different shapes"):
        kerf.op.join(made("pocket"), made("vcarve"))
    with pytest.raises(TypeError):
        kerf.op.join()
    path = program(10, 5)
    with pytest.raises(kerf.Error, match="starts with a cut"):
        path.append(cut_first)
    assert len(path) == 7


def test_a_path_is_appended_to_itself():
    path = program(10, 5)
    path.append(path)
    ends = [path[i]["to"] for i in range(len(path)) if "to" in path[i]]
    assert ends.count((10, 0, -1)) == 2


# ---- changes


def test_passes_tabs_and_copies():
    part = kerf.op.contour(PLATE, MILL, depth=4, feed=600)
    deep = kerf.op.step_down(part, 1)
    assert {round(s["to"][2], 6) for s in steps(deep) if s["step"] == "cut"} >= {-1, -2, -3, -4}
    held = kerf.op.add_tabs(part, 1.5, count=3)
    assert sum(s["step"] == "cut" and s["to"][2] == pytest.approx(-2.5) for s in steps(held)) >= 3
    panel = kerf.op.repeat(part, 2, 3, pitch=(80, 60))
    low, high = panel.toolpath.report()["cut_bounds_mm"]
    assert (low[0], high[0]) == (pytest.approx(-3), pytest.approx(143))
    assert (low[1], high[1]) == (pytest.approx(-3), pytest.approx(163))
    assert len(kerf.op.order(panel)) > 0


def test_leads_and_helices():
    # Clockwise, the part on the right: the axis 3 mm left of the part, the arc 2 mm further to the left.
    path = kerf.Toolpath()
    path.rapid((-3, 10, 5))
    path.cut((-3, 10, -4), feed=100)
    for x, y in ((-3, 23), (43, 23), (43, -3), (-3, -3), (-3, 10)):
        path.cut((x, y, -4), feed=500)
    path.rapid((-3, 10, 5))
    led = steps(kerf.op.add_leads(path, 2, lead_out=0, finish=None))
    assert led[0]["to"] == (-5, 8, 5) and led[1]["to"] == (-5, 8, -4)
    assert led[2]["step"] == "arc" and led[2]["to"] == (-3, 10, -4)
    assert led[-1]["to"] == (-3, 10, 5)
    deep = steps(kerf.op.step_down(path, 2, entry="helix", helix_radius=2.5, entry_angle=10))
    assert [s["to"] for s in deep if s["step"] == "arc"] == [(-3, 10, -2), (-3, 10, -4)]
    with pytest.raises(kerf.Error, match="helix"):
        kerf.op.step_down(path, 2, entry="helix")


def test_transforms():
    part = kerf.op.engrave([[(10, 0), (30, 0)]], MILL, depth=1, feed=600)
    turned = kerf.op.transform(part, scale=2, rotate=90, move=(5, 0, -1))
    low, high = turned.toolpath.report()["cut_extent_mm"]
    assert low[:2] == (pytest.approx(5), pytest.approx(20)) and high[:2] == (
        pytest.approx(5),
        pytest.approx(60),
    )
    assert low[2] == pytest.approx(-2)
    mirrored = kerf.op.transform(part, mirror="x")
    assert mirrored.toolpath.report()["cut_extent_mm"][0][0] == pytest.approx(-30)
    loop = kerf.op.contour(PLATE, MILL, depth=1, feed=600)
    ends = [s["to"][:2] for s in steps(loop) if s["step"] in ("cut", "arc")]
    reversed_ends = [s["to"][:2] for s in steps(kerf.op.reverse_loops(loop)) if s["step"] in ("cut", "arc")]
    assert ends != reversed_ends and set(ends) == set(reversed_ends)


def test_resuming(tmp_path):
    file = tmp_path / "part.nc"
    file.write_text("G21 G90\nT102 M6\nS9000 M3\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\nG1 X50\nG1 Y30\nG0 Z5\nM2\n")
    rest = steps(kerf.op.resume(kerf.load(file), 8, safe_z=12))
    ends = [s["to"] for s in rest if "to" in s]
    assert ends[1:4] == [(50, 0, 12), (50, 0, -1), (50, 30, -1)]
    assert [s["step"] for s in rest].count("tool") == 1
    with pytest.raises(kerf.Error, match="no motion"):
        kerf.op.resume(kerf.load(file), 99, safe_z=12)


def test_levelling_follows_a_plane(tmp_path):
    # The plane z = 0.01 x: a straight cut over it stays one motion, its ends rise by 0 and 0.5.
    part = kerf.op.engrave([[(0, 10), (50, 10)]], MILL, depth=1, feed=600)
    corners = [(x, y, 0.01 * x) for x in (0, 60) for y in (0, 40)]
    levelled, report = kerf.op.level(part, corners)
    cuts = [s["to"] for s in steps(levelled) if s["step"] == "cut"]
    assert cuts[-1] == (50, 10, pytest.approx(-0.5, abs=2e-3))
    assert report["highest_mm"] == pytest.approx(0.5, abs=2e-3) and report["outside_mm"] == 0
    file = tmp_path / "heights.txt"
    file.write_text("".join(f"{x} {y} {z}\n" for x, y, z in corners))
    assert steps(kerf.op.level(part, file)[0]) == steps(levelled)
    with pytest.raises(kerf.Error):
        kerf.op.level(part, corners, max_correction=0.1)
    with pytest.raises(ValueError):
        kerf.op.level(part, [(0, 0, math.nan)])


def test_probing_covers_the_cuts():
    part = kerf.op.engrave([[(0, 10), (50, 30)]], MILL, depth=1, feed=600)
    probes = [s["to"] for s in steps(kerf.op.probing(part, 3, 2, margin=5)) if s["step"] == "probe"]
    assert {p[:2] for p in probes} == {(x, y) for x in (-5, 25, 55) for y in (5, 35)}
    assert kerf.op.probing([(0, 0), (10, 10)], 2, 2).toolpath.report()["rapids"] > 0
    with pytest.raises(ValueError, match="columns"):
        kerf.op.probing(part, 1, 2)
    with pytest.raises(ValueError, match="no cuts"):
        kerf.op.probing(kerf.Toolpath())
    with pytest.raises(ValueError, match="corner"):
        kerf.op.probing([(0, 0), (math.nan, 1)])
    with pytest.raises(ValueError, match="two opposite corners"):
        kerf.op.probing([])


def test_align_turns_a_program_to_where_its_points_were_measured(tmp_path):
    part = kerf.op.engrave([[(10, 0), (30, 0)]], MILL, depth=1, feed=600)
    turned = kerf.op.align(part, [((0, 0), (5, 0)), ((100, 0), (5, 100))])
    low, high = turned.toolpath.report()["cut_extent_mm"]
    assert low[:2] == (pytest.approx(5), pytest.approx(10)) and high[:2] == (
        pytest.approx(5),
        pytest.approx(30),
    )
    source = "(STOCK/BLOCK, 50, 40, 5, 0, 0, 5)\nG21 G90 G0 Z5\nG0 X1 Y1\nG1 Z-1 F100\nG1 X9\nM2\n"
    (tmp_path / "part.nc").write_text(source)
    program = kerf.load(tmp_path / "part.nc")
    assert program.stock is not None  # it is not that of the part where the part is now
    assert kerf.op.transform(program, move=(1, 0)).stock is None


@pytest.mark.parametrize("start", [kerf.Toolpath, lambda program: program.toolpath, None])
def test_programs_with_other_shapes_of_a_tool_are_not_appended(start):
    """What was appended is not changed by what is refused."""
    tools = (kerf.Tool(f"square d={d}", number) for d, number in ((6, 1), (3, 1), (3, 2)))
    wide, thin, other = (kerf.op.pocket(PLATE, tool, depth=2, stepdown=1, feed=600) for tool in tools)
    if start:
        path = start(wide)
    else:
        path = kerf.Toolpath()
        path.append(wide)
    path.append(other)
    path.append(wide)
    steps = len(path)
    for program in (thin, kerf.Toolpath(thin)):
        with pytest.raises(ValueError, match=r"tool 1 has different shapes.*6 mm and .*3 mm"):
            path.append(program)
    assert len(path) == steps
    path.append(path)
    assert len(path) > steps

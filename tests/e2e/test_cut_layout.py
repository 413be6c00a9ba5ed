"""kerf cut: units and formulas of keys, the layout of the art, depth by the stock, passes by the material."""
import json
import re

import pytest

JOB = """{top}
[tools]
1 = "square d=6 flute=20 teeth=2"

[[shape]]
rectangle = [0, 0, 60, "40mm"]

[[operation]]
op = "contour"
tool = 1
depth = {depth}
stepdown = 2
feed = "60ipm"
rpm = 10000
"""


def header(run):
    """The box of the cuts and of the stock as the program's comments state them."""
    cuts = [float(n) for n in re.findall(r"-?[\d.]+", re.search(r"cuts within (.*) mm", run.out)[1])]
    stock = re.findall(r"stockM(?:in|ax):(.*?)\)", run.out)
    return cuts, [[float(n) for n in re.findall(r"-?[\d.]+", s)] for s in stock]


def test_units_and_formulas_of_the_stock(kerf, program):
    run = kerf("cut", program(JOB.format(top='stock = "80x60x12"', depth='"stock.z + 0.2"'), "job.toml"))
    assert run.status == 0, run.out
    assert header(run)[0][4] == -12.2 and "F1524" in run.out
    run = kerf("cut", program(JOB.format(top="", depth='"stock.z"'), "job.toml"))
    assert run.status != 0 and "the job has none" in run.err
    run = kerf("cut", program(JOB.format(top="", depth='"6 furlong"'), "job.toml"))
    assert "job.toml:11:9" in run.err and "unknown unit furlong at character 3" in run.err


@pytest.mark.parametrize("top, cuts, stock", [
    ("", [-3, 63, -3, 43], None),
    ('origin = "centre"', [-33, 33, -23, 23], None),
    ("zero = [60, 40]", [-63, 3, -43, 3], None),
    ("move = [10, 20]", [7, 73, 17, 63], None),
    ("rotate = 90", [-43, 3, -3, 63], None),
    ('mirror = "x"', [-63, 3, -3, 43], None),
    ("fit-width = 30", [-3, 33, -3, 23], None),
    ('grid-columns = 2\ngrid-rows = 3\ngrid-gap = 10', [-3, 133, -3, 143], None),
    ('art-margin = 10\norigin = "lower-left"\nthickness = "1/2in"', [7, 73, 7, 53],
     [[0, 0, -12.7], [80, 60, 0]]),
])
def test_the_layout(kerf, program, top, cuts, stock):
    run = kerf("cut", program(JOB.format(top=top, depth=4), "job.toml"))
    assert run.status == 0, run.out
    assert header(run)[0][:4] == cuts
    if stock:
        assert header(run)[1] == stock


def test_layouts_that_contradict_themselves_are_refused(kerf, program):
    for top in ('origin = "centre"\nzero = [0, 0]', 'thickness = 3\nstock = "9x9x9"', 'origin = "corner"',
                "grid-columns = 3\ngrid-gap = 50\nfit-width = 90"):
        assert kerf("cut", program(JOB.format(top=top, depth=4), "job.toml")).status != 0, top


def test_through_and_deep_passes(kerf, program):
    job = JOB.format(top='stock = "80x60x12"', depth=9).replace("stepdown = 2\n", "")
    run = kerf("cut", program(job, "job.toml"))
    assert run.status == 0 and "one pass of 9 mm is deeper than the diameter" in run.err
    run = kerf("cut", program(job.replace("depth = 9", "through = 0.3"), "job.toml"))
    assert run.status == 0 and header(run)[0][4] == -12.3
    assert kerf("cut", program(job + "through = 0.3\n", "job.toml")).status != 0
    for same in ('depth = "through 0.3mm"', 'depth = "through 0.3"'):
        assert kerf("cut", program(job.replace("depth = 9", same), "job.toml")).out == run.out
    flush = kerf("cut", program(job.replace("depth = 9", "through = 0"), "job.toml"))
    assert kerf("cut", program(job.replace("depth = 9", 'depth = "through"'), "job.toml")).out == flush.out
    wrong = kerf("cut", program(job.replace("depth = 9", 'depth = "through it"'), "job.toml"))
    assert wrong.status != 0 and "through must be a number in mm of 0 or more" in wrong.err, wrong.err
    run = kerf("cut", program(job + 'material = "aluminium"\n', "job.toml"))
    assert run.status == 0 and "passes of at most 1.5 mm" in run.err  # a quarter of 6 mm


def test_coolant_and_the_position_at_the_end(kerf, program):
    text = """park = [-5, 90]
[tools]
1 = "square d=6"
2 = "square d=3"
[[shape]]
rectangle = [0, 0, 40, 25]
[defaults]
depth = 2
feed = 900
rpm = 16000
"""
    for tool, coolant in ((1, "flood"), (1, "flood"), (2, "mist"), (2, "none")):
        text += f'[[operation]]\nop = "contour"\ntool = {tool}\ncoolant = "{coolant}"\n'
    run = kerf("steps", program(text, "job.toml"))
    assert run.status == 0, run.err
    found = [json.loads(line) for line in run.out.splitlines()[1:]]
    words = [f"T{s['tool']}" if s["step"] == "tool" else s["turn"] if s["step"] == "spindle"
             else "flood" if s["flood"] else "mist" if s["mist"] else "dry"
             for s in found if s["step"] in ("tool", "spindle", "coolant")]
    assert words == ["T1", "cw", "flood", "dry", "off", "T2", "cw", "mist", "dry", "off"]
    motions = [s for s in found if s["step"] in ("rapid", "cut", "arc")]
    assert motions[-1]["step"] == "rapid" and motions[-1]["to"] == [-5, 90, 5]
    assert "coolant" in kerf("cut", program(text.replace('"mist"', '"oil"'), "wrong.toml")).err


FACE = """{top}
[tools]
1 = "square d=10 flute=20"
{shapes}
[[operation]]
op = "face"
tool = 1
depth = 1
feed = 900
rpm = 10000
{keys}
"""


def test_the_whole_top_of_the_stock_is_faced(kerf, program):
    stock = 'stock = "5,-7,-12 to 85,53,0"'
    line = "[[shape]]\nline = [[10, 10], [20, 20]]\n"
    inner = "[[shape]]\nrectangle = [20, 10, 40, 30]\n"
    for shapes, keys in (("", ""), (line, ""), (inner, 'outlines = ["stock"]')):
        job = program(FACE.format(top=stock, shapes=shapes, keys=keys), "job.toml")
        # 80 x 60 mm, 1 mm deep: all of the top is gone, and nothing below.
        run = kerf("simulate", job, "--json")
        assert run.status == 0, run.err
        assert run.json["removed_mm3"] == pytest.approx(80 * 60, rel=1e-3)
        x0, x1, y0, y1 = header(kerf("cut", job))[0][:4]
        assert x0 <= 0 and x1 >= 90  # the lines leave it by the radius, and those at its edges cover them
        assert y0 - 5 <= -7 and y1 + 5 >= 53
    inside = kerf("cut", program(FACE.format(top=stock, shapes=inner, keys=""), "job.toml"))
    assert inside.status == 0 and header(inside)[0][1] < 60
    run = kerf("cut", program(FACE.format(top="", shapes="", keys=""), "job.toml"))
    assert run.status == 1 and "no closed outline is selected" in run.err and "whole top" in run.err
    run = kerf("cut", "--op", "face", "--stock", "80x60x12", "--tool", "square d=10", "--depth", "1",
               "--feed", "900")
    assert run.status == 0 and header(run)[0][1] >= 85, run.err
    run = kerf("cut", job, "--stock", "80x60x12")
    assert run.status == 2 and "a job file states its stock" in run.err


def test_points_of_numbers_and_texts(kerf, program):
    run = kerf("cut", program(JOB.format(top='move = [10, "2cm"]', depth=4), "job.toml"))
    assert run.status == 0, run.err
    assert header(run)[0][:4] == [7, 73, 17, 63]
    run = kerf("cut", program(JOB.format(top='move = [10, "2 furlong"]', depth=4), "job.toml"))
    assert run.status == 1 and "move must be" in run.err


ORDER = """{top}
stock = "200x60x6"
[tools]
1 = "square d=6 flute=20"
2 = "square d=3 flute=20"

[[shape]]
layer = "part"
rectangle = [10, 10, 70, 50]
[[shape]]
layer = "part"
rectangle = [110, 10, 170, 50]
[[shape]]
layer = "hole"
circle = [40, 30, 10]
[[shape]]
layer = "hole"
circle = [140, 30, 10]
[[shape]]
layer = "slot"
line = [[20, 20], [30, 20]]
[[shape]]
layer = "slot"
line = [[120, 20], [130, 20]]

[defaults]
feed = 900
rpm = 10000
stepdown = 3

[[operation]]
op = "contour"
name = "cut out"
layers = ["part"]
tool = 1
depth = 6.2
[[operation]]
op = "engrave"
name = "slots"
layers = ["slot"]
tool = 2
depth = 1
[[operation]]
op = "pocket"
name = "holes"
layers = ["hole"]
tool = 1
depth = 2
"""


@pytest.mark.parametrize("top, names", [
    ("", ["slots", "holes", "cut out"]),
    ('order = "inner-first"', ["slots", "holes", "cut out"]),
    ('order = "by-tool"', ["slots", "holes", "cut out"]),
    ('order = "by-part"', ["slots", "holes", "cut out"] * 2),
    ('order = "as-written"', ["cut out", "slots", "holes"]),
])
def test_the_order_of_operations(kerf, program, top, names):
    job = program(ORDER.format(top=top), "job.toml")
    run = kerf("steps", job, "--json")
    assert run.status == 0, run.err
    steps = [json.loads(line) for line in run.out.splitlines()]
    assert [s["text"] for s in steps if s.get("text") in names] == names
    loose = [line for line in run.err.splitlines() if "has cut out before" in line]
    assert len(loose) == (2 if "as-written" in top else 0)


def test_an_order_of_few_tool_changes_keeps_work_before_it_is_cut_out(kerf, program):
    # As written: tools 2, 1, 2, 1; the drilling of the second part is free to come first.
    job = ORDER.format(top='order = "by-tool"') + """
[[operation]]
op = "drill"
name = "marks"
layers = ["slot"]
outlines = ["stop"]
tool = 2
depth = 1
[[shape]]
name = "stop"
point = [90, 50]
"""
    run = kerf("steps", program(job, "job.toml"), "--json")
    assert run.status == 0, run.err
    steps = [json.loads(line) for line in run.out.splitlines()]
    names = [s["text"] for s in steps if s.get("text") in ("cut out", "slots", "holes", "marks")]
    assert names == ["slots", "marks", "holes", "cut out"]
    assert sum(s.get("step") == "tool" for s in steps) == 2


def test_a_groove_that_is_no_cut_out_stays_where_it_is_written(kerf, program):
    job = ORDER.format(top="").replace("depth = 6.2", "depth = 2")
    steps = [json.loads(line) for line in kerf("steps", program(job, "job.toml"), "--json").out.splitlines()]
    names = [s["text"] for s in steps if s.get("text") in ("cut out", "slots", "holes")]
    assert names == ["cut out", "slots", "holes"]


CHANGES = """stock = "60x40x10"
change-height = 40
change-at = [-20, -10]
{more}
[tools]
1 = "square d=6 flute=20"
2 = "square d=3 flute=20"
[[shape]]
name = "a"
rectangle = [10, 10, 50, 30]
[[shape]]
name = "b"
rectangle = [20, 15, 40, 25]
[defaults]
feed = 900
rpm = 10000
[[operation]]
op = "pocket"
outlines = ["a"]
tool = 1
depth = 2
[[operation]]
op = "pocket"
outlines = ["b"]
tool = 2
depth = 4
stepdown = 2
"""


@pytest.mark.parametrize("more, expected", [
    ("", ["Z40", "X-20 Y-10", "M5", "(change to tool 2)"]),
    ('touch-off = "message"', ["Z40", "X-20 Y-10", "M5", "(MSG, tool 2: set its zero in Z as for tool 1)",
                               "(change to tool 2)"]),
    ('touch-off = "probe"\nprobe-at = [0, 50]\nprobe-height = 15', [
        "M0", "(tool 2)", "(tool 2: square, diameter 3 mm, flute 20 mm)", "G0 X0 Y50 Z40",
        "(touch-off of tool 2: the zero in Z stays)", "G38.2 Z-15 F100", "G10 L20 P1 Z15", "G0 X0 Y50 Z40"]),
])
def test_tool_changes_of_a_controller_without_them(kerf, program, tmp_path, more, expected):
    job = program(CHANGES.format(more=more), "job.toml")
    run = kerf("cut", job, "-o", "out.nc")
    assert run.status == 0, run.err
    lines = (tmp_path / "out.nc").read_text().splitlines()
    start = lines.index(expected[0])
    assert lines[start:start + len(expected)] == expected
    check = kerf("check", "out.nc")
    assert check.status == 0 and "no hazard found" in check.out and "warning" not in check.err, check.out
    removed = [kerf("simulate", "--json", file).json["removed_mm3"] for file in (job, "out.nc")]
    assert removed[1] == pytest.approx(removed[0], rel=1e-6)


def test_one_file_per_tool_of_a_job(kerf, program, tmp_path):
    job = program(CHANGES.format(more=""), "job.toml")
    run = kerf("cut", job, "--tool-change", "files", "-o", "out.nc")
    assert run.status == 0, run.err
    for tool in (1, 2):
        text = (tmp_path / f"out-T{tool}.nc").read_text()
        assert f"(tool {tool}: square" in text and "M0" not in text
        check = kerf("check", f"out-T{tool}.nc")
        assert check.status == 0, check.out + check.err


@pytest.mark.parametrize("more", ['touch-off = "probe"', 'touch-off = "probe"\nprobe-height = 50'])
def test_a_touch_off_needs_a_height_to_start_from(kerf, program, more):
    job = CHANGES.format(more=more)
    if "50" not in more:
        job = job.replace("change-height = 40\n", "")
    assert kerf("cut", program(job, "job.toml")).status == 1


def test_a_touch_off_without_the_words_of_kerf_stays_a_finding(kerf, program, tmp_path):
    job = program(CHANGES.format(more='touch-off = "probe"'), "job.toml")
    assert kerf("cut", job, "-o", "out.nc").status == 0
    text = (tmp_path / "out.nc").read_text()
    (tmp_path / "out.nc").write_text(text.replace("(touch-off of tool 2: the zero in Z stays)\n", ""))
    assert "zero changes here by an unknown distance" in kerf("check", "out.nc").out


def test_points_and_shapes_by_the_stock(kerf, program):
    job = """stock = "100x60x12"
park = ["stock.right + 5", "stock.y"]
[tools]
1 = "square d=6 flute=20"
[[shape]]
circle = ["stock.x / 2", "stock.y/2", "stock.y - 1in"]
[[operation]]
op = "contour"
tool = 1
depth = "stock.z + 0.2"
stepdown = 20
feed = "60ipm"
rpm = 10000
"""
    run = kerf("cut", program(job, "job.toml"))
    assert run.status == 0, run.err
    radius = (60 - 25.4) / 2 + 3
    expected = [50 - radius, 50 + radius, 30 - radius, 30 + radius, -12.2]
    assert header(run)[0][:5] == pytest.approx(expected, abs=0.006)
    assert "X105 Y60" in run.out
    bad = kerf("cut", program(job.replace('stock = "100x60x12"', ""), "job.toml"))
    assert bad.status == 1 and "job.toml:2:8" in bad.err
    bad = kerf("cut", program(job.replace('"stock.x / 2"', '"stock.width"'), "job.toml"))
    assert bad.status == 1 and "job.toml:6:10" in bad.err


def test_texts_and_options_by_the_stock(kerf):
    options = ["--op", "engrave", "--text", "stock.x", "--height", "stock.y/4", "--stock", "100x40x5",
               "--tool", "V d=6 angle=60", "--depth", "1/64in", "--feed", "60ipm",
               "--rpm", "16000"]
    left = kerf("cut", *options, "--at", "stock.left,0")
    moved = kerf("cut", *options, "--at", "stock.x/2,stock.back - 1in")
    assert left.status == 0 and moved.status == 0, left.err + moved.err
    shift = [b - a for a, b in zip(header(left)[0], header(moved)[0])]
    assert shift[:4] == pytest.approx([50, 50, 14.6, 14.6], abs=0.02)
    assert header(left)[0][3] - header(left)[0][2] == pytest.approx(10, abs=0.1)


def test_holes_that_are_too_narrow_are_one_message(kerf, program):
    holes = "".join(f"[[shape]]\ncircle = [{12 * i}, 0, {5 - 0.01 * i:.2f}]\n" for i in range(60))
    job = '[tools]\n1 = "square d=6 flute=20"\n' + holes
    job += '[[operation]]\nop = "bore"\ntool = 1\ndepth = 2\nfeed = 300\n'
    run = kerf("cut", program(job, "job.toml"))
    assert run.status == 1 and run.err.count("error") == 1
    assert "too wide to bore 60 holes, the narrowest of 4.41 mm at 708, 0" in run.err

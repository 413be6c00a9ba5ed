"""`kerf.Job`: a job's settings, the steps of its calls, and its results; hooks of posts."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest

import kerf
from kerf import _kerf


def steps(job, *kinds):
    return [s for s in (job.path[i] for i in range(len(job.path))) if s["step"] in kinds]


@pytest.fixture
def job():
    return kerf.Job((100, 60, 12), feed=900, plunge=300, rpm=16000)


def test_a_block_ends_the_program(job):
    with job:
        job.tool(102)
        job.move_to(10, 10)
        job.cut(z=-3)
        job.cut(x=90)
    last = [job.path[i] for i in (len(job.path) - 2, len(job.path) - 1)]
    assert [s["step"] for s in last] == ["rapid", "end"]
    assert last[0]["to"] == (90, 10, 5)
    with pytest.raises(ValueError, match="ended"):
        job.cut(x=10)
    job.close()
    assert len(steps(job, "end")) == 1


def test_a_block_that_raises_appends_nothing(job):
    with pytest.raises(RuntimeError):
        with job:
            job.tool(102)
            raise RuntimeError
    assert [s["step"] for s in steps(job, "tool", "spindle", "end")] == ["tool", "spindle"]


def test_the_first_motion_rises_before_it_crosses(job):
    job.tool(102)
    job.move_to(10, 20)
    first, second = steps(job, "rapid")
    assert (first["unknown_axes"], first["to"][2]) == (["X", "Y"], 5)
    assert second["to"] == (10, 20, 5)


def test_feeds_are_those_of_the_job_and_its_tools(job):
    job.tool(102)
    job.move_to(0, 0)
    job.cut(z=-1)
    job.cut(x=10)
    job.cut(x=20, feed=100)
    job.cut(x=30, z=-2)  # a ramp
    job.tool(201, rpm=12000, feed=1500, plunge=500)
    job.move_to(0, 0)
    job.cut(z=-1)
    job.cut(x=10)
    assert [s["feed"] for s in steps(job, "cut")] == [300, 900, 100, 900, 500, 1500]
    assert [s["rpm"] for s in steps(job, "spindle")] == [16000, 12000]
    assert steps(job, "rapid")[-2]["to"] == (30, 0, 5), "retracts before the tool change"


def test_plunges_without_a_feed_have_half_of_it():
    job = kerf.Job(feed=800)
    job.move_to(0, 0)
    job.cut(z=-1)
    assert steps(job, "cut")[0]["feed"] == 400


def test_inches():
    job = kerf.Job((4, 3, 0.5), units="inch", feed=30)
    job.tool(102)
    job.move_to(1, 1)
    job.cut(z=-0.1)
    job.arc(x=2, centre=(1.5, 1), turn="cw")
    assert job.position == pytest.approx((2, 1, -0.1))
    plunge, arc = steps(job, "cut", "arc")
    assert plunge["to"] == pytest.approx((25.4, 25.4, -2.54))
    assert (plunge["feed"], arc["feed"]) == pytest.approx((381, 762))
    assert arc["centre"] == pytest.approx((38.1, 25.4))
    assert job.stock.high == pytest.approx((101.6, 76.2, 0))
    text = job.post("grbl")
    assert "G20" in text and "G0 Z0.2\nX1 Y1" in text and "F30" in text


def test_outlines_are_followed(job):
    job.tool(102)
    job.follow([(0, 0), (10, 0), (15, 5, 10, 10), (0, 0)], z=-1)
    job.follow((50, 50, 5), z=-1)
    arcs = steps(job, "arc")
    assert arcs[0]["centre"] == pytest.approx((10, 5)) and arcs[0]["turn"] == "ccw"
    assert [a["centre"] for a in arcs[1:]] == [pytest.approx((50, 50))] * 2
    assert steps(job, "cut")[-2]["to"] == (0, 0, -1)


def test_steps_appended_to_the_path_move_the_job_too(job):
    job.tool(102)
    job.path.rapid((5, 6, 7))
    job.path.cut((5, 6, -1), 100)
    job.cut(x=20)
    assert job.position == (20, 6, -1)


def test_steps_name_the_line_of_the_script(job):
    job.tool(102)
    job.move_to(1, 2)
    assert all(s["origin"]["file"].endswith("test_job.py") for s in steps(job, "tool", "spindle", "rapid"))


def test_the_part_is_what_the_calls_say():
    with kerf.Job("40x20x10", tools="5=square d=4 flute=12", feed=600) as job:
        job.tool(5)
        job.move_to(10, 10)
        job.cut(z=-2)
        job.cut(x=30)
    # A slot of 20 mm with round ends.
    assert job.simulate(0.05).removed_mm3 == pytest.approx(2 * (20 * 4 + math.pi * 4), rel=2e-3)
    assert not job.simulate().hazards and not [f for f in job.check() if f["kind"] == "rapid_in_stock"]
    assert job.estimate()["total"] > 2


def test_files_by_their_endings(job, tmp_path):
    with job:
        job.tool(102)
        job.move_to(10, 10)
        job.cut(z=-3)
        job.cut(x=90)
    names = [tmp_path / f"part{e}" for e in (".nc", ".dxf", ".svg", ".png", ".stl")]
    job.save(*names, resolution=0.5)
    assert all(name.stat().st_size > 100 for name in names)
    assert "G1 Z-3 F300" in names[0].read_text()


@pytest.mark.parametrize(
    "call, error, text",
    [
        (lambda: kerf.Job(units="cm"), ValueError, "units"),
        (lambda: kerf.Job((1, 2)), ValueError, "stock"),
        (lambda: kerf.Job(stock="nonsense"), kerf.Error, "stock"),
        (lambda: kerf.Job(feed=-1), ValueError, "feed"),
        (lambda: kerf.Job(feed="fast"), ValueError, "feed"),
        (lambda: kerf.Job(retract=math.nan), ValueError, "retract"),
        (lambda: kerf.Job(feed=1).cut(x=1), ValueError, "y is required"),
        (lambda: kerf.Job(feed=1).move_to(1, [2]), TypeError, "y must be a number"),
        (lambda: kerf.Job().simulate(), ValueError, "stock is required"),
    ],
)
def test_wrong_values_name_the_argument(call, error, text):
    with pytest.raises(error, match=text):
        call()


def test_a_cut_without_any_feed_is_an_error():
    job = kerf.Job()
    job.move_to(0, 0)
    with pytest.raises(ValueError, match="feed is required"):
        job.cut(z=-1)


# ---- hooks of posts


def two_tools():
    path = kerf.Toolpath()
    for number in (102, 201):
        path.tool(number)
        path.spindle(16000)
        path.rapid((0, 0, 5))
        path.cut((0, 0, -1), 100)
        path.rapid((0, 0, 5))
    path.end()
    return path


def test_hooks_add_lines():
    path = two_tools()
    text = kerf.post(
        path,
        "linuxcnc",
        on_open=lambda: ["(vacuum on)", "M64 P0"],
        on_section=lambda number: [f"(MSG,tool {number})"],
        on_close=lambda: ["M65 P0"],
    )
    lines = text.splitlines()
    assert lines.index("M64 P0") < lines.index("(MSG,tool 102)") < lines.index("(MSG,tool 201)")
    assert lines.index("(MSG,tool 102)") < lines.index("T102 M6")
    assert lines.index("(MSG,tool 201)") < lines.index("T201 M6") < lines.index("M65 P0") < lines.index("M2")
    assert len(path) == 11, "the path stays as it is"


def test_the_linter_judges_what_hooks_return():
    with pytest.raises(kerf.Error, match="G0"):
        kerf.post(two_tools(), "grbl", on_close=lambda: ["G0 X0 Y0"])
    with pytest.raises(TypeError, match="on_open must return a list"):
        kerf.post(two_tools(), "grbl", on_open=lambda: "G4 P1")
    with pytest.raises(ValueError, match="line break"):
        kerf.post(two_tools(), "grbl", on_open=lambda: ["(a)\nG0 X0"])


# ---- simulation and notebooks


def test_stock_and_tools_as_texts_for_a_toolpath():
    path = kerf.Toolpath()
    path.tool(7)
    path.rapid((5, 5, 5))
    path.cut((5, 5, -2), 100)
    part = kerf.simulate(path, "10x10x5", ["7=square d=4 flute=9"], 0.05)
    assert part.removed_mm3 == pytest.approx(math.pi * 4 * 2, rel=5e-3)
    with pytest.raises(TypeError, match="stock"):
        kerf.simulate(path)


def volume(stl):
    """The volume that the triangles of a binary STL enclose."""
    record = np.dtype([("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    a, b, c = np.moveaxis(np.frombuffer(stl, record, offset=84)["p"].astype(float), 1, 0)
    return float(np.sum(np.cross(a, b) * c)) / 6


def test_columns_are_a_faster_mesh(job):
    with job:
        job.tool(202)
        job.move_to(10, 10)
        job.cut(z=-3)
        job.cut(x=90, y=50)
    part = job.simulate(0.2)
    exact, columns = part.mesh_file("stl"), part.mesh_file("stl", detail="columns")
    assert exact != columns
    for data in (exact, columns):
        assert volume(data) == pytest.approx(part.left_mm3, rel=1e-4)
    with pytest.raises(ValueError, match="detail"):
        part.mesh_file("stl", detail="rough")


def test_results_show_themselves_in_notebooks(job):
    with job:
        job.tool(102)
        job.rapid(10, 10, -5)  # a hazard
        job.move_to(10, 10)
        job.cut(z=-3)
    part = job.simulate(0.5)
    assert part._repr_png_().startswith(b"\x89PNG")
    page = part._repr_html_()
    assert "72,000.0 mm³" in page and "data:image/png;base64," in page
    assert "rapid in stock" in page and "test_job.py:" in page
    assert "cuts" in job.path._repr_html_() and "<svg" in job.path._repr_svg_()
    assert "data:image/png" in job._repr_html_()
    assert "data:image/png" not in kerf.Job()._repr_html_()
    region = kerf.Region([[(0, 0), (10, 0), (10, 5, 5, 10), (0, 0)]])
    assert " A" in region._repr_svg_() and kerf.Region()._repr_svg_() is None


def test_the_library_is_not_an_origin():
    assert hasattr(_kerf, "_library_file")


def test_numbers_without_bound_are_refused():
    job = kerf.Job((10, 10, 10))
    with pytest.raises(ValueError, match="x must be a number up to 1e308"):
        job.rapid(10**400, 0, 0)


def test_a_job_in_the_viewer(tmp_path):
    """kerf view runs a script with $KERF_VIEW_PROGRAM; options of a simulation are passed on."""
    script, made = tmp_path / "part.py", tmp_path / "made.kerf"
    script.write_text(
        "import kerf\n"
        "clamp = ('clamp', kerf.move_stock(kerf.Stock.block((5, 5, 10)), shift=(90, 50, 5)))\n"
        "with kerf.Job((100, 60, 12), feed=900, fixtures=[clamp]) as job:\n"
        "    job.tool(102)\n    job.move_to(10, 10)\n    job.cut(z=-3)\n    job.cut(x=40)\n"
        "part = job.simulate(0.5)\n"
        "kerf.simulate(job.path, job.stock, resolution=0.5, spoilboard=3)\n"
    )
    environment = dict(os.environ, KERF_VIEW_PROGRAM=str(made))
    done = subprocess.run([sys.executable, script], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    program = kerf.load(made)
    assert program.stock.high == pytest.approx((100, 60, 0))
    assert program.toolpath.report()["cut_bounds_mm"][1][:2] == pytest.approx((40, 10))


def test_tools_by_number():
    """A mill and a ball mill of 6 and 3 mm."""
    plate = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])
    tools = {1: "square d=6 flute=20", 2: kerf.Tool("ball d=3 flute=9")}
    with kerf.Job(stock="100x60x12", tools=tools) as job:
        job.pocket(plate, depth=2, tool=1, feed=900, rpm=12000)
        job.pocket(plate, depth=1, tool=2, feed=900, rpm=12000)
    part = kerf.simulate(job.path, "100x60x12", tools={1: "square d=6 flute=20", 2: "ball d=3 flute=9"})
    assert part.removed_mm3 > 60 * 40 * 2 * 0.95
    for wrong in ({"1": "square d=6"}, {1: 6}, {True: "square d=6"}):
        with pytest.raises(TypeError, match="dict of tools"):
            kerf.simulate(job.path, "100x60x12", tools=wrong)
    with pytest.raises(kerf.Error, match="sqare"):
        kerf.simulate(job.path, "100x60x12", tools={1: "sqare d=6"})


def through_a_board(beyond="1mm"):
    with kerf.Job((60, 40, 10), retract=5, feed=900, rpm=16000, spoilboard=2) as job:
        job.tool("square d=6 flute=20")
        job.contour(kerf.Region([(30, 20, 12)]), depth=f"through {beyond}", stepdown=3)
    return job


def test_cuts_into_the_spoilboard_are_no_hazards_of_any_call():
    job = through_a_board()
    assert job.check() == [] and job.simulate().findings == [] and job.simulate().hazards == []
    too_deep = through_a_board("3mm")
    assert {h["kind"] for h in too_deep.simulate().hazards} == {"below_floor"}
    assert {h["kind"] for h in too_deep.check()} == {"below_floor"}


def test_programs_of_a_job_state_its_stock_and_spoilboard(tmp_path):
    job = through_a_board()
    text = job.post("grbl")
    assert "stock" in text and "(spoilboard: 2.00mm)" in text
    again = kerf.load(job.post("grbl", tmp_path / "p.nc") and tmp_path / "p.nc")
    assert kerf.check(again) == []


def test_through_does_not_end_above_the_bottom():
    with pytest.raises(ValueError, match="0 or more below the stock"):
        through_a_board("-1mm")


def test_rapids_by_axis_are_those_of_every_call(tmp_path):
    """From X-10 Y70 to X20 Y200 at one rate per axis: 45 degrees to X20 Y100, over a corner of the stock."""
    machine = tmp_path / "m.toml"
    machine.write_text('rapids = "by-axis"\nrate = [3000, 3000, 3000]\n')
    program = tmp_path / "p.nc"
    program.write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X-10 Y-10 Z10\nG0 X50 Y40\nG1 Z-1 F100\nG0 Z5\n"
                       "G0 X-10 Y70\nG0 Z-5\nG0 X20 Y200\nG0 Z5\nM2\n")
    same = {"tools": "square d=6 flute=20", "stock": "0,0,-10 to 100,80,0"}
    found = kerf.check(kerf.load(program), machine=machine, **same)
    assert [f["kind"] for f in found] == ["rapid_in_stock"]
    assert kerf.check(kerf.load(program), **same) == []
    part = kerf.simulate(kerf.load(program), same["stock"], same["tools"], machine=machine)
    assert [h["kind"] for h in part.hazards] == ["rapid_in_stock"]

"""The operations as methods of `kerf.Job`: their arguments, its tools, feeds and units."""

import inspect
import math

import pytest

import kerf

PLATE = [(5, 5), (95, 5), (95, 55), (5, 55), (5, 5)]
TOOLS = ["1=square d=6mm flute=20", "2=V d=12 angle=60", "5=drill d=4 flute=20"]


def steps(job, *kinds):
    return [s for s in (job.path[i] for i in range(len(job.path))) if s["step"] in kinds]


@pytest.fixture
def job():
    return kerf.Job((100, 60, 12), tools=TOOLS, feed=900, plunge=300, rpm=16000)


def test_each_operation_is_a_method_with_the_same_arguments():
    functions = kerf.op._cuts.__all__
    assert len(functions) > 20
    for name in functions:
        method = inspect.signature(getattr(kerf.Job, name)).parameters
        function = inspect.signature(getattr(kerf.op, name)).parameters
        kinds = {key: parameter.kind for key, parameter in method.items() if key != "self"}
        assert kinds == {key: parameter.kind for key, parameter in function.items()}, name
        assert (
            list(kinds)[:2] == list(function)[:2] or kinds[list(kinds)[1]] == inspect.Parameter.KEYWORD_ONLY
        ), name


def test_a_workshop(tmp_path):
    with kerf.Job("100x60x12", tools=TOOLS, feed=900, plunge=300, rpm=16000) as job:
        job.pocket([(50, 30, 20)], depth=6, stepdown=3, tool="6mm")
        job.drill([(10, 10), (90, 50)], depth=8, tool="4mm")
    assert [s["tool"] for s in steps(job, "tool")] == [1, 5]
    part = job.simulate(0.1)
    tip = math.pi * 2**2 * 2 / math.tan(math.radians(59)) / 3  # of a drill of 118 degrees
    removed = math.pi * 20**2 * 6 + 2 * (math.pi * 2**2 * (8 - 2 / math.tan(math.radians(59))) + tip)
    assert part.removed_mm3 == pytest.approx(removed, rel=5e-3)
    assert not part.hazards
    job.save(tmp_path / "part.nc", tmp_path / "part.stl", post="grbl", resolution=0.5)
    assert "G1" in (tmp_path / "part.nc").read_text()
    assert (tmp_path / "part.nc").read_text() == job.post("grbl")


@pytest.mark.parametrize("units, board", [("mm", 12.0), ("inch", 0.5)])
def test_the_depth_of_the_stock(units, board):
    unit = kerf.inch if units == "inch" else 1.0
    job = kerf.Job((4, 3, board) if units == "inch" else (100, 60, board), units=units, feed=30, rpm=16000)
    job.drill([(1, 1)], "drill d=3mm flute=30", depth="through")
    job.contour([(2, 2, 1)], "square d=3mm flute=20", depth="through 0.5mm", top=-board / 2, stepdown="1.5mm")
    lowest = [min(s["to"][2] for s in steps(job, "cut", "arc") if s["tool"] == n) for n in (1, 2)]
    tip = 1.5 / math.tan(math.radians(59))  # the hole is whole at the bottom
    assert lowest == pytest.approx([-board * unit - tip, -board * unit - 0.5])
    with pytest.raises(ValueError, match="depth='through' needs a top above"):
        job.contour([(2, 2, 1)], 2, depth="through", top=-board)
    with pytest.raises(ValueError, match="depth='through' needs the stock"):
        kerf.Job(feed=900).pocket([(50, 30, 20)], "square d=6", depth="through")
    with pytest.raises(ValueError, match="depth"):
        job.contour([(2, 2, 1)], 2, depth="through wood")


def test_feeds_speed_and_heights_are_those_of_the_job(job):
    job.pocket([(50, 30, 20)], 1, depth=2, entry="plunge")
    job.pocket([(50, 30, 20)], depth=2, entry="plunge", feed=500, plunge="100", rpm=8000, retract=9)
    assert [s["rpm"] for s in steps(job, "spindle") if "rpm" in s and s["rpm"]] == [16000, 8000]
    assert {s["feed"] for s in steps(job, "cut", "arc")} == {900, 300, 500, 100}
    alone = kerf.op.pocket([(50, 30, 20)], "square d=6mm flute=20", depth=2, feed=900, plunge=300, rpm=16000)
    first = kerf.Job((100, 60, 12), tools=TOOLS, feed=900, plunge=300, rpm=16000)
    first.pocket([(50, 30, 20)], "6mm", depth=2)
    both = [[(s["step"], s["to"]) for s in steps(j, "cut", "arc")] for j in (first, kerf.Job())]
    both[1] = [
        (s["step"], s["to"]) for s in (alone.toolpath[i] for i in range(len(alone.toolpath))) if "feed" in s
    ]
    assert both[0] == both[1]
    assert max(s["to"][2] for s in steps(job, "rapid")) == 9


def test_a_feed_by_the_material_of_the_job():
    job = kerf.Job((100, 60, 12), tools=TOOLS, rpm=16000, material="plywood")
    job.pocket([(50, 30, 20)], "6mm", depth=2)
    alone = kerf.op.pocket([(50, 30, 20)], "square d=6mm flute=20", depth=2, rpm=16000, material="plywood")
    fed = [alone.toolpath[i]["feed"] for i in range(len(alone.toolpath)) if "feed" in alone.toolpath[i]]
    assert {s["feed"] for s in steps(job, "cut", "arc")} == set(fed)
    with pytest.raises(kerf.Error, match="feed is missing"):
        kerf.Job(tools=TOOLS).pocket([(50, 30, 20)], "6mm", depth=2)


def test_tools_by_number_diameter_description_and_as_texts(job):
    circle = [(50, 30, 20)]
    for tool in (
        1,
        "1",
        "6mm",
        "0.6cm",
        "square d=8",
        "square d=8",
        "square d=10",
        kerf.Tool("square d=3", 9),
        102,
    ):
        job.pocket(circle, tool, depth=1)
    numbers = [s["tool"] for s in steps(job, "tool")]
    assert numbers == [1, 1, 1, 1, 3, 3, 4, 9, 102]
    job.pocket(circle, depth=1)
    assert steps(job, "tool")[-1]["tool"] == 102, "the one in use"
    job.tool("4mm")
    assert steps(job, "tool")[-1]["tool"] == 5
    diameters = {n: tool.diameter for n, tool in job._tools.added.items()}
    assert diameters == pytest.approx({1: 6, 3: 8, 4: 10, 9: 3, 102: 3.175, 5: 4})
    job.pocket([PLATE], kerf.Tool("square d=3", 9), depth=1, rest_tool="square d=8")
    assert not [f for f in job.simulate(0.5).hazards if "tool" in f["kind"]]


@pytest.mark.parametrize(
    "tools, tool, error, text",
    [
        (
            TOOLS,
            "7mm",
            ValueError,
            "tool: no tool of the job has the diameter 7mm; describe it, as in 'square d=7mm'",
        ),
        (["1=square d=6", "2=drill d=6"], "6mm", ValueError, r"1 \(square\), 2 \(drill\)"),
        (TOOLS, "sqare d=7", kerf.Error, "unknown tool shape"),
        (TOOLS, 6.0, TypeError, "tool must be a Tool"),
        (TOOLS, 77, kerf.Error, "unknown tool 77"),
        (TOOLS, kerf.Tool("square d=3", 1), ValueError, "tool 1 has another shape"),
        (TOOLS, None, TypeError, "tool is missing"),
    ],
)
def test_wrong_tools(tools, tool, error, text):
    job = kerf.Job(tools=tools, feed=900)
    with pytest.raises(error, match=text):
        job.pocket([(50, 30, 20)], tool, depth=1)
    assert len(job.path) == 0


class Square:
    __geo_interface__ = {"type": "Polygon", "coordinates": (((0, 0), (2, 0), (2, 1), (0, 1), (0, 0)),)}


@pytest.mark.parametrize(
    "shapes",
    [
        [[(0, 0), (2, 0), (2, 1), (0, 1), (0, 0)]],
        kerf.Region([[(0, 0), (2, 0), (2, 1), (0, 1), (0, 0)]]),
        Square(),
    ],
)
def test_a_job_in_inches(shapes):
    job = kerf.Job((4, 3, 0.5), units="inch", tools="1=square d=1/4in", feed=60, plunge="20", rpm=16000)
    job.pocket(shapes, "1/4in", depth=0.25, stepdown="1/8", allowance="0.5mm")
    job.drill([(3, 2)], "drill d=1/8in", depth="12.7 mm")
    made = kerf.op.pocket(
        [[(0, 0), (50.8, 0), (50.8, 25.4), (0, 25.4), (0, 0)]],
        "square d=6.35",
        depth=6.35,
        stepdown=3.175,
        allowance=0.5,
        feed=1524,
        plunge=508,
        rpm=16000,
        retract=5.08,
    ).toolpath
    wanted = [made[i] for i in range(len(made)) if "feed" in made[i]]
    found = steps(job, "cut", "arc")
    for a, b in zip(found, wanted):
        assert (
            a["step"] == b["step"]
            and a["to"] == pytest.approx(b["to"])
            and a["feed"] == pytest.approx(b["feed"])
        )
    assert min(s["to"][2] for s in found[len(wanted) :]) == pytest.approx(-12.7)
    assert found[-1]["to"][:2] == pytest.approx((76.2, 50.8))


def test_steps_and_messages_name_the_line_of_the_script(job):
    job.pocket([(50, 30, 20)], "6mm", depth=1)
    assert all(
        s["origin"]["file"].endswith("test_job_operations.py") for s in steps(job, "cut", "rapid", "tool")
    )
    with pytest.raises(kerf.Error) as caught:
        job.pocket([(50, 30, 20)], depth=-1)
    assert caught.value.diagnostics[0].where.endswith("(depth)")
    assert "test_job_operations.py" in caught.value.diagnostics[0].where


def test_operations_of_lasers_and_meshes():
    job = kerf.Job((100, 60, 12), tools=TOOLS, feed=900, rpm=16000)
    roof = (
        [(0, 0, -7.5), (10, 0, 0), (20, 0, -7.5), (0, 10, -7.5), (10, 10, 0), (20, 10, -7.5)],
        [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)],
    )
    job.raster(roof, "ball d=3 flute=20", stepover=0.5, move=(20, 20, 0))
    assert min(s["to"][0] for s in steps(job, "cut")) > 15
    laser = kerf.Job((100, 60, 3), feed=600)
    laser.laser_cut([(50, 30, 20)], power=90)
    assert not steps(laser, "tool") and {s["feed"] for s in steps(laser, "cut", "arc")} == {600}


def test_holes_may_end_in_the_spoilboard():
    found = []
    for thickness in (0, "3mm"):
        job = kerf.Job((100, 60, 12), tools=TOOLS, feed=300, rpm=8000, spoilboard=thickness)
        job.drill([(10, 10)], 5, depth=13)
        found.append(sum("below the floor" in finding["message"] for finding in job.check()))
    assert found == [1, 0]


def test_an_ended_job_takes_no_operation(job):
    job.close()
    with pytest.raises(ValueError, match="ended"):
        job.face([PLATE], "6mm", depth=1)


def test_the_former_name_of_post_still_works(job, tmp_path):
    job.pocket([(50, 30, 20)], "6mm", depth=1)
    with pytest.warns(DeprecationWarning, match="post"):
        job.save(tmp_path / "part.nc", to="linuxcnc")
    assert "linuxcnc" in (tmp_path / "part.nc").read_text()

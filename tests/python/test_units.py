"""Units: `kerf.inch` and `kerf.mm`, and texts such as "1/4in" and "60ipm" where a job file takes them."""

import inspect

import pytest

import kerf

PLATE = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])


def cuts(program):
    path = getattr(program, "toolpath", program)
    return [s for s in (path[i] for i in range(len(path))) if s["step"] in ("cut", "arc")]


def lowest(program):
    return min(s["to"][2] for s in cuts(program))


def test_factors():
    assert 3 * kerf.inch == pytest.approx(76.2) and 3 * kerf.mm == 3


def test_operations_take_texts_with_units():
    pocket = kerf.op.pocket(PLATE, "square d=1/4in", depth="1/4in", stepdown="0.125 in", feed="60ipm")
    assert lowest(pocket) == pytest.approx(-6.35)
    assert max(s["feed"] for s in cuts(pocket)) == pytest.approx(1524)
    assert (
        pocket.toolpath
        == kerf.op.pocket(PLATE, "square d=6.35", depth=6.35, stepdown=3.175, feed=1524).toolpath
    )
    assert lowest(kerf.cut("pocket", PLATE, "square d=6", depth="6mm", feed="1 m/min")) == -6


def test_the_functions_take_texts_for_each_key_that_may_be_one_in_a_job_file():
    names = {"vcarve": "v_carve", "vcarve-floor": "v_carve_floor"}
    checked = 0
    for op, row in kerf.job_schema()["$defs"].items():
        function = getattr(kerf.op, names.get(op, op.replace("-", "_")))
        for key, value in row["properties"].items():
            parameter = inspect.signature(function).parameters.get(key.replace("-", "_"))
            if parameter is not None and "string" in value.get("type", "") and "number" in value["type"]:
                assert "float | str" in parameter.annotation, (op, key)
                checked += 1
    assert checked > 150


def test_points_take_texts_and_numbers():
    word = kerf.op.text_outlines("I", "1in", at=("1in", 0))
    numbers = kerf.op.text_outlines("I", 25.4, at=(25.4, 0))
    assert word == numbers
    pocket = kerf.op.pocket(PLATE, "square d=6", depth=2, feed=900)
    moved = kerf.op.transform(pocket, move=("1in", 0, "-1mm"))
    assert lowest(moved) == -3
    assert min(s["to"][0] for s in cuts(moved)) == pytest.approx(3 + 25.4)


def test_changes_of_programs_take_texts_with_units():
    pocket = kerf.op.pocket(PLATE, "square d=6", depth="1/4in", feed=900, entry="plunge")
    deeper = kerf.op.step_down(pocket, "1/8in")
    assert sorted({round(s["to"][2], 6) for s in cuts(deeper)}) == [-6.35, -3.175]
    assert kerf.rework(pocket, step_down="1/8 in").toolpath == deeper.toolpath
    turned = kerf.op.transform(pocket, rotate="90deg", centre="1in,0")
    assert turned.toolpath == kerf.op.transform(pocket, rotate=90, centre=(25.4, 0)).toolpath
    probed = kerf.op.probing([(0, 0), (60, 40)], depth="1/8in", feed="2ipm")
    steps = [probed.toolpath[i] for i in range(len(probed.toolpath))]
    assert [s["feed"] for s in steps if s["step"] == "probe"][0] == pytest.approx(50.8)


@pytest.mark.parametrize(
    "call, error, text",
    [
        (
            lambda: kerf.op.pocket(PLATE, "square d=6", depth="6 furlong", feed=900),
            kerf.Error,
            "unknown unit furlong",
        ),
        (
            lambda: kerf.op.pocket(PLATE, "square d=6", depth=6, feed="6mm"),
            kerf.Error,
            "feed.*units are mm/min",
        ),
        (lambda: kerf.op.step_down(kerf.Toolpath(), "2 yards"), ValueError, "depth: expected a number"),
        (lambda: kerf.op.probing([(0, 0), (6, 4)], depth="2 yards"), ValueError, "depth: unknown unit yards"),
        (lambda: kerf.Job(feed="60in"), ValueError, "feed: unknown unit in"),
        (lambda: kerf.Job(retract="high"), ValueError, "retract: unknown name high"),
        (lambda: kerf.Job(feed="-1ipm"), ValueError, "feed must be above 0"),
        (lambda: kerf.Job(feed=[1]), TypeError, "feed must be a number, or a str"),
    ],
)
def test_wrong_texts_name_the_argument(call, error, text):
    with pytest.raises(error, match=text):
        call()


@pytest.mark.parametrize("units, size", [("mm", 1), ("inch", 25.4)])
def test_a_text_without_unit_is_in_the_units_of_the_job(units, size):
    job = kerf.Job(
        ("4in", "3in", "12.7mm"), units=units, feed="60ipm", plunge="10", retract="1/4in", rpm="16krpm"
    )
    assert job.stock.high == pytest.approx((101.6, 76.2, 0)) and job.stock.low[2] == pytest.approx(-12.7)
    assert job.retract_plane * size == pytest.approx(6.35)
    job.tool(102, feed="1524 mm/min")
    job.move_to("1in", "25.4mm")
    job.cut(z="-1/8")
    job.cut(x="2in")
    down, across = cuts(job.path)
    assert down["to"] == pytest.approx((25.4, 25.4, -size / 8)) and down["feed"] == pytest.approx(10 * size)
    assert across["to"][0] == pytest.approx(50.8) and across["feed"] == pytest.approx(1524)
    assert [job.path[i]["rpm"] for i in range(len(job.path)) if job.path[i]["step"] == "spindle"] == [16000]

"""kerf cut: holes by their diameters, and holes and threads by the names of threads."""
import json
import math

import pytest

SHAPES = "".join(f"[[shape]]\ncircle = [{20 * i}, 0, {d}]\n" for i, d in enumerate((3, 5, 6.5, 10)))
HEAD = '[tools]\n1 = "drill d=5 flute=40"\n2 = "square d=3 flute=30"\n'
THREAD_MILL = '3 = "thread mill minor_diameter=2.4 major_diameter=3.8 pitch=1 length=15"\n'


def job(folder, operations, tools=HEAD, shapes=SHAPES, **keys):
    lines = tools + shapes
    for operation in operations:
        lines += "[[operation]]\nfeed = 200\nrpm = 3000\ndepth = 6\n"
        lines += "".join(f"{key} = {json.dumps(value)}\n" for key, value in operation.items())
    (folder / "job.toml").write_text(lines)
    return "job.toml"


def steps(kerf, file):
    run = kerf("steps", file)
    assert run.status == 0, run.err
    return [json.loads(line) for line in run.out.splitlines()[1:]]


def deep_points(found):
    return sorted({round(s["to"][0], 3) for s in found if s["step"] == "cut" and s["to"][2] < -5})


@pytest.mark.parametrize("keys, at", [
    ({}, [0, 20, 40, 60]),
    ({"max-diameter": 6}, [0, 20]),
    ({"min-diameter": 5, "max-diameter": 6.5}, [20, 40]),
    ({"min-diameter": "1/4in"}, [40, 60]),
])
def test_circles_are_drilled_by_their_diameter(kerf, tmp_path, keys, at):
    file = job(tmp_path, [{"op": "drill", "tool": 1, **keys}])
    assert deep_points(steps(kerf, file)) == at


def test_no_circle_within_the_diameters_is_an_error(kerf, tmp_path):
    for op in ("drill", "bore"):
        run = kerf("cut", job(tmp_path, [{"op": op, "tool": 1 if op == "drill" else 2, "min-diameter": 11}]))
        assert run.status == 1 and "no circle is within min-diameter and max-diameter" in run.err


def test_a_drill_for_a_thread_has_its_diameter(kerf, tmp_path):
    assert kerf("cut", job(tmp_path, [{"op": "drill", "tool": 1, "thread": "M6"}])).status == 0
    run = kerf("cut", job(tmp_path, [{"op": "drill", "tool": 1, "thread": "M8"}]))
    assert run.status == 1 and "not the drill for the thread M8, which has 6.8 mm" in run.err
    run = kerf("cut", job(tmp_path, [{"op": "drill", "tool": 1, "thread": "M9"}]))
    assert run.status == 1 and 'job.toml:' in run.err and 'no thread "M9" in the table' in run.err


def test_a_hole_and_its_thread_by_name(kerf, tmp_path):
    shapes = '[[shape]]\npoint = [0, 0]\n[[shape]]\ncircle = [20, 0, 3]\n[[shape]]\ncircle = [20, 0, 9]\n'
    hole, thread = ({"op": "bore", "tool": 2, "thread": "M6"}, {"op": "thread", "tool": 3, "thread": "M6"})
    tools = HEAD + THREAD_MILL
    bored = steps(kerf, job(tmp_path, [hole], tools, shapes))
    # Holes of 5 mm by a mill of 3: full circles of radius 1 at the bottom, one for each centre.
    bottom = [s for s in bored if s["step"] == "arc" and s["to"][2] == -6 and s.get("extra_turns", 0) >= 0]
    assert {round(s["centre"][0], 6) for s in bottom} == {0, 20}
    for s in bottom:
        assert math.dist(s["centre"], s["to"][:2]) == pytest.approx(1, abs=1e-6)
    threaded = steps(kerf, job(tmp_path, [thread], tools, shapes))
    # The tips reach the major diameter: (6 - 3.8) / 2 from the centre, and one turn rises by the pitch.
    arcs = [s for s in threaded if s["step"] == "arc"]
    turns = [s for s in arcs if math.dist(s["centre"], s["to"][:2]) == pytest.approx(1.1, abs=1e-6)]
    assert {round(s["centre"][0], 6) for s in turns} == {0, 20}
    run = kerf("cut", job(tmp_path, [{**thread, "pitch": 1}], tools, shapes))
    assert run.status == 1 and "either a pitch or a name" in run.err
    del thread["thread"]
    run = kerf("cut", job(tmp_path, [thread], tools, shapes))
    assert run.status == 1 and "either a pitch or a name" in run.err

"""Laser operations from Python: the same keys as the command's, with underscores."""
import math

import kerf
import pytest

PLATE = [[(0, 0), (40, 0), (40, 30), (0, 30), (0, 0)], (20, 15, 6)]  # a rectangle with a hole


def burns(program):
    """(length, S, feed) of the motions at feed."""
    s, at, found = 0.0, None, []
    path = program.toolpath
    for step in (path[i] for i in range(len(path))):
        if "to" in step:
            assert step["unknown_axes"] == ["Z"]
        if step["step"] == "laser":
            s = step.get("power", 0.0) if step.get("mode") != "off" else 0.0
        elif step["step"] in ("rapid", "cut", "arc"):
            to = step["to"]
            if step["step"] == "cut":
                found.append((math.dist(at[:2], to[:2]), s, step["feed"]))
            elif step["step"] == "arc":
                found.append((None, s, step["feed"]))
            else:
                assert s == 0
            at = to
    return found


def test_a_cut_with_its_kerf():
    program = kerf.cut("laser_cut", kerf.Region(PLATE), power=90, feed=300, kerf=0.2)
    found = burns(program)
    assert {(s, feed) for _, s, feed in found} == {(900, 300)}
    assert sum(length for length, _, _ in found if length) == pytest.approx(2 * (40 + 30), rel=1e-6)
    assert kerf.check(program) == []


def test_the_focus_test():
    program = kerf.cut("laser_test", power=100, feed=1200, feed_to=400, rows=5, cell_width=100,
                       cell_height=0, beam="constant")
    assert burns(program) == [(100, 1000, feed) for feed in (1200, 1000, 800, 600, 400)]


def test_what_is_refused():
    with pytest.raises(kerf.Error):
        kerf.cut("laser_cut", PLATE, power=float("nan"), feed=300)
    with pytest.raises(kerf.Error):
        kerf.cut("laser_picture", picture="no such file.png", picture_width=10, power=10, feed=300)
    with pytest.raises(kerf.Error):
        kerf.cut("laser_cut", PLATE, feed=300)  # without power
    with pytest.raises(TypeError):
        kerf.cut("pocket", PLATE, depth=3, feed=300)  # without a tool

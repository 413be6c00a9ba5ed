"""kerf.cut and kerf.rework: the operations and the changes of programs from Python."""
import math

import pytest

import kerf

PLATE = [(0, 0), (60, 0), (60, 40), (0, 40)]


def test_a_pocket_of_a_region():
    region = kerf.Region([PLATE, (30, 20, 8)])
    program = kerf.cut("pocket", region, "square d=6", depth=4, stepdown=2, feed=900)
    done = kerf.simulate(program, stock="70x50x10 at centre top", resolution=0.2)
    assert not done.hazards
    # The tool leaves the corners of the plate round; the simulated stock covers only a part of the plate.
    assert program.tools[1].diameter == 6
    assert len(program) > 10


def test_drilled_points_and_bored_circles():
    program = kerf.cut("drill", tool="drill d=3", points=[(5, 5), (9, 9)], depth=3, feed=100)
    deep = [s for s in program.toolpath.steps() if s.get("to") and s["to"][2] == -3] if hasattr(
        program.toolpath, "steps") else None
    assert deep is None or len(deep) == 2
    assert len(kerf.cut("bore", [(0, 0, 10)], "square d=6", depth=3, feed=100)) > 3


def test_errors_are_raised():
    with pytest.raises(kerf.Error, match="depth is missing"):
        kerf.cut("pocket", [PLATE], "square d=6", feed=900)
    with pytest.raises(kerf.Error, match="too wide"):
        kerf.cut("pocket", [PLATE], "square d=50", depth=1, feed=900)
    with pytest.raises(TypeError):
        kerf.cut("pocket", [PLATE], depth=1, feed=900)
    with pytest.raises(ValueError, match="wobble"):
        kerf.rework(kerf.Toolpath(), wobble=3)


def test_rework_repeats_and_adds_passes():
    program = kerf.cut("contour", [PLATE], "square d=4", depth=4, feed=600)
    figures = program.toolpath.report()
    panel = kerf.rework(program, columns=2, rows=3, pitch=(80, 60), step_down=2, order=True)
    after = panel.toolpath.report()
    cut = [key for key in figures if "cut" in key and isinstance(figures[key], float)]
    assert cut
    assert all(math.isfinite(after[key]) for key in cut)
    assert len(panel) > 6 * len(program)

"""kerf.cut and kerf.rework: the operations and the changes of programs from Python."""
import pytest

import kerf

PLATE = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])
MILL = "square d=6"


def test_operations_make_programs():
    pocket = kerf.cut("pocket", PLATE, MILL, depth=4, stepdown=2, feed=900)
    assert isinstance(pocket, kerf.Program)
    assert len(pocket) > 10
    assert len(kerf.cut("drill", tool="drill d=3", points=[(5, 5), (9, 9)], depth=3, feed=100)) > 5
    assert len(kerf.cut("bore", [(0, 0, 10)], MILL, depth=3, feed=100)) > 3
    assert len(kerf.cut("engrave", [[(0, 0), (30, 0)]], MILL, depth=1, feed=100)) > 3


def test_holes_are_drilled_at_the_centres_of_circles_of_a_region():
    holes = kerf.Region([(5, 5, 2.5), (20, 5, 2.5)])
    triangle = kerf.Region([[(50, 50), (60, 50), (60, 60), (50, 50)]])
    program = kerf.op.drill(holes | triangle, "drill d=5", depth=1, feed=100)
    assert [step["to"] for step in program.toolpath if step["step"] == "cut"] == [(5, 5, -1), (20, 5, -1)]
    with pytest.raises(kerf.Error, match="no points"):
        kerf.op.drill(PLATE, "drill d=5", depth=1, feed=100)


def test_carving_and_the_plug_of_an_inlay():
    carved = kerf.cut("vcarve", PLATE, "V d=20 angle=60", feed=900, depth=3)
    plug = kerf.cut("vcarve", PLATE, "V d=20 angle=60", feed=900, depth=3, part="plug", glue_gap=0.2)
    assert len(carved) > 10 and len(plug) > 10
    with pytest.raises(kerf.Error, match="cannot do the operation vcarve"):
        kerf.cut("vcarve", PLATE, MILL, feed=900)


def test_text_is_engraved():
    word = kerf.cut("engrave", tool="V d=6 angle=60", text="HI", height=10, at=(5, 5), depth=0.4, feed=600)
    assert len(word) > 10
    with pytest.raises(kerf.Error, match="no font"):
        kerf.cut("engrave", tool="V d=6 angle=60", text="HI", height=10, font="gothic", depth=0.4, feed=600)


def test_values_are_numbers_to_the_last_digit():
    import numpy as np

    deep = 1 / 3
    for depth in (deep, np.float64(deep), f"{deep!r}"):
        program = kerf.cut("engrave", [[(0, 0), (9, 0)]], MILL, depth=depth, feed=100)
        assert min(step["to"][2] for step in program.toolpath if "to" in step) == -deep
    moved = kerf.rework(kerf.cut("drill", tool="drill d=3", points=[(0, 0)], depth=3, feed=100),
                        move=np.array([deep, 2 * deep, 0]))
    assert any(tuple(step.get("to", [0])[:2]) == (deep, 2 * deep) for step in moved.toolpath)


def test_wrong_values_name_the_key():
    with pytest.raises(TypeError, match="depth must be a number, a str"):
        kerf.cut("pocket", PLATE, MILL, depth={}, feed=900)
    with pytest.raises(kerf.Error, match="0 is not a number in mm above 0"):
        kerf.cut("pocket", PLATE, MILL, depth=0, feed=900)
    with pytest.raises(kerf.Error, match='unknown key "stepdwon"; did you mean stepdown'):
        kerf.cut("pocket", PLATE, MILL, depth=1, feed=900, stepdwon=2)


def test_errors_are_raised():
    with pytest.raises(kerf.Error, match="depth is missing"):
        kerf.cut("pocket", PLATE, MILL, feed=900)
    with pytest.raises(kerf.Error, match="too wide"):
        kerf.cut("pocket", PLATE, "square d=50", depth=1, feed=900)
    with pytest.raises(TypeError):
        kerf.cut("pocket", PLATE, depth=1, feed=900)
    with pytest.raises(ValueError, match="wobble"):
        kerf.rework(kerf.Toolpath(), wobble=3)


def test_rework_repeats_and_adds_passes():
    program = kerf.cut("contour", PLATE, MILL, depth=4, feed=600)
    panel = kerf.rework(program, columns=2, rows=3, pitch=(80, 60), step_down=2, order=True)
    assert len(panel) > 6 * len(program)

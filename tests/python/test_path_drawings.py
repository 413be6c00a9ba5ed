"""Path drawings from Python: the options that change what is milled."""
import sys
from pathlib import Path

import kerf
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "e2e"))
from path_drawing import line, path, text  # noqa: E402


@pytest.fixture
def save(tmp_path):
    def write(name, content):
        (tmp_path / name).write_text(content)
        return tmp_path / name

    return write


def heights_of(program, kind):
    return [step["to"][2] for step in program.toolpath if step["step"] == kind]


def test_load_takes_the_options_of_drawings(save):
    """Rapids are at T + O = 4 unless the drawing or the caller says otherwise."""
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="M1 O2 T2 I1 B0"))
    heights = [max(heights_of(kerf.load(name, **keywords), "rapid"))
               for keywords in ({}, {"drawing": {"rapid_height": 15, "feed": 80}})]
    assert heights == pytest.approx([4, 15], abs=1e-3)
    with pytest.raises(kerf.Error, match="S must be above T"):
        kerf.load(name, drawing={"rapid_height": 1})
    with pytest.raises(TypeError, match="rapid_height"):
        kerf.load(name, drawing={"rapid_hight": 1})


def test_other_programs_refuse_the_options_of_drawings(save):
    name = save("part.nc", "G21 G90\nT1 M6\nG0 Z5\nG1 X10 F100\nM2\n")
    with pytest.raises(kerf.Error, match="path drawings"):
        kerf.load(name, drawing={"rapid_height": 15})


def test_variables_and_restrictions(save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="M1 O2 T2 I5 S5 B=D :D0.5~1.5"))
    assert "Z1.250" in kerf.pathdxf(name, defines=["D=1.25"])["_Milling.gcode"]
    assert min(heights_of(kerf.load(name, defines=["D=1.25"]), "cut")) == 1.25
    project = save("8998.1P.dxf", path(line(0, 0, 10, 0, "DASHDOT", "8998_1P"),
                                       text(5, 0, ">8999.1P M1 O2 T2 :D1", "8998_1P"), layer="8998_1P"))
    assert "_Milling.gcode" in kerf.pathdxf(project)
    with pytest.raises(kerf.Error, match="forbidden"):
        kerf.pathdxf(project, restrictions=["8998:8997"])

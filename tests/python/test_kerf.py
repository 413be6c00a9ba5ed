"""The Python module: building a toolpath, cutting it, and errors."""
import copy
import math

import pytest

import kerf
from jobs import SLOT, slot


def test_a_slot_removes_its_volume():
    result = kerf.simulate(slot(), kerf.Stock.block((40, 20, 6)), resolution=0.05)
    assert result.removed_mm3 == pytest.approx(SLOT, rel=2e-3)
    assert result.stock_mm3 == pytest.approx(4800)
    assert result.hazards == []
    assert result.removed_by_step.sum() == pytest.approx(result.removed_mm3, rel=1e-6)
    assert result.column(*(n // 2 for n in result.columns))[0][1] == pytest.approx(-2, abs=1e-3)


def test_the_mesh_is_closed_and_encloses_what_is_left():
    result = kerf.simulate(slot(), kerf.Stock.block((40, 20, 6)), resolution=0.2)
    points, triangles, step = result.mesh()
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    volume = (a * __import__("numpy").cross(b, c)).sum() / 6
    assert volume == pytest.approx(result.left_mm3, rel=5e-3)
    assert len(step) == len(triangles)
    assert {3, 4} & set(step.tolist()), "no face has the step of a cut"


def test_a_rapid_through_stock_names_the_line_of_the_script():
    path = slot()
    path.rapid((10, 15, -1))
    line = [path[i]["origin"] for i in range(len(path))][-1]
    result = kerf.simulate(path, kerf.Stock.block((40, 20, 6)), resolution=0.2)
    assert [h["kind"] for h in result.hazards] == ["rapid_in_stock"]
    assert result.hazards[0]["origin"] == line
    assert line["file"].endswith("test_kerf.py") and line["call"] == "rapid"


def test_arcs_and_reports():
    path = kerf.Toolpath()
    path.rapid((10, 0, 1))
    path.arc((10, 0, -1), centre=(0, 0), turn="cw", feed=300)
    figures = path.report()
    assert (figures["arcs"], figures["rapids"]) == (1, 1)
    assert figures["cut_mm"] == pytest.approx(math.hypot(2 * math.pi * 10, 2))


@pytest.mark.parametrize("call", [
    lambda p: p.rapid((0, 0)),
    lambda p: p.rapid((0, 0, float("nan"))),
    lambda p: p.cut((0, 0, 0), feed=0),
    lambda p: p.arc((1, 0, 0), centre=(0, 0), turn="left", feed=100),
    lambda p: p.dwell(-1),
])
def test_wrong_values_are_value_errors(call):
    with pytest.raises(ValueError):
        call(kerf.Toolpath())


def test_wrong_types_are_type_errors():
    with pytest.raises(TypeError):
        kerf.Toolpath().rapid("abc")
    with pytest.raises(TypeError):
        kerf.Toolpath().rapid((0, "x", 0))


def test_gcode_errors_have_their_lines():
    with pytest.raises(kerf.Error) as caught:
        kerf.read_gcode("G21\nG1 X1 F100\nG1 Xnan\nG2 X5 Y5\nM2\n", "bad.nc")
    lines = sorted({d.line for d in caught.value.diagnostics if d.severity == "error"})
    assert lines == [3, 4]
    assert "bad.nc:3" in str(caught.value)


def test_unknown_tool_is_an_error():
    path = kerf.Toolpath()
    path.tool(99999999)
    path.rapid((0, 0, 5))
    path.cut((0, 0, -1), feed=100)
    with pytest.raises(kerf.Error, match="99999999"):
        kerf.simulate(path, kerf.Stock.block((10, 10, 5)))


def test_tools():
    tool = kerf.Tool("V d=12.7 angle=90", number=301)
    assert tool.diameter_at(1.0) == pytest.approx(2.0)
    assert kerf.Tool.make("square", number=7, diameter=6, flute=20).flute == 20
    table = kerf.built_in_tools()
    assert 102 in table and table[102].diameter == pytest.approx(3.175)
    drawn = kerf.Tool.drawn([(0, 0, 0), (3, 0, 0), (3, 10, 0)], number=9)
    assert drawn.diameter == pytest.approx(6)
    with pytest.raises(kerf.Error):
        kerf.Tool("squale d=3")


@pytest.mark.parametrize("call, words", [
    (lambda p: p.rapid((1e308, 0, 0)), "to must be from -10000000 to 10000000 mm"),
    (lambda p: p.cut((0, 0, 0), feed=1e308), "feed must be from 0 to"),
    (lambda p: p.tool(-3), "number must be from 0 to 999999999"),
    (lambda p: p.tool(10**12), "number must be from 0 to 999999999"),
    (lambda p: p.spindle(1e308), "rpm must be from 0 to"),
    (lambda p: p.spindle(1000, "left"), "turn must be 'cw', 'ccw' or 'off', not 'left'"),
    (lambda p: p.dwell(1e308), "seconds must be from 0 to"),
    (lambda p: p.arc((1, 0, 0), (0, 0), "cw", 100, extra_turns=10**9), "extra_turns must be from 0 to"),
    (lambda p: (p.rapid((1, 0, 0)), p.arc((5, 0, 0), (0, 0), "cw", 100)),
     "the arc starts 1 mm from its centre and ends 5 mm from it"),
    (lambda p: kerf.Stock.block((1e308, 1, 1)), "size must be from"),
    (lambda p: kerf.Stock.block((1e6, 1, 1)), "size must be from 0 to 100000 mm"),
    (lambda p: kerf.Tool("square d=3", number=-5), "number must be from 0"),
    (lambda p: kerf.Tool(10**20), "spec must be from 0 to 999999999"),
    (lambda p: kerf.save_left_stock(None, "left.stl"), "written as .kstock, not as 'left.stl'"),
    (lambda p: kerf.ToolTable().__setitem__(-5, kerf.Tool(102)), "number must be from 0"),
    (lambda p: kerf.simulate(p, kerf.Stock.block((1, 1, 1)), threads=-1), "threads must be from 0 to 1024"),
])
def test_values_out_of_range_are_value_errors_that_say_the_range(call, words):
    with pytest.raises(ValueError) as caught:
        call(kerf.Toolpath())
    assert words in str(caught.value)


@pytest.mark.parametrize("call, words", [
    (lambda: kerf.load(3), "path"),
    (lambda: kerf.Tool.make("square", diameter="x"), "diameter must be a number"),
    (lambda: kerf.Tool(None), "spec must be a str"),
    (lambda: kerf.simulate(kerf.Toolpath(), None), "stock must be a stock"),
])
def test_values_of_a_wrong_type_say_what_is_expected(call, words):
    with pytest.raises(TypeError) as caught:
        call()
    assert words in str(caught.value).lower()


@pytest.mark.parametrize("number, words", [
    (999999999, "unknown tool 999999999"),
    ("99999999999", "unknown tool 99999999999; numbers have at most 9 digits"),
])
def test_an_unknown_number_is_no_shape(number, words):
    with pytest.raises(kerf.Error) as caught:
        kerf.Tool(number)
    assert words in str(caught.value)


def test_a_tool_by_its_number():
    assert kerf.Tool(301).number == kerf.Tool("301").number == 301
    assert kerf.Tool(102, number=4).number == 4


def test_copies_are_of_their_own():
    path = slot()
    for twin in (copy.copy(path), copy.deepcopy(path)):
        twin.dwell(1)
        assert len(twin) == len(path) + 1
    table = kerf.ToolTable()
    twin = copy.deepcopy(table)
    twin[3] = copy.copy(kerf.Tool(102))
    assert len(table) == 0 and twin[3].diameter == pytest.approx(3.175)
    assert copy.copy(kerf.Stock.block((1, 2, 3))).high == (1, 2, 0)


def test_everything_says_what_it_is():
    stock = kerf.Stock.block((40, 20, 6))
    assert repr(slot()) == "<kerf.Toolpath of 6 steps>"
    assert repr(stock) == "<kerf.Stock 40 x 20 x 6 mm>"
    assert repr(kerf.Tool(102)) == "<kerf.Tool 102 square 3.175 mm>"
    assert repr(kerf.ToolTable()) == "<kerf.ToolTable of 0 tools>"
    assert "mm3 removed, 0 hazards" in repr(kerf.simulate(slot(), stock, resolution=0.5))
    for kind in (kerf.Toolpath, kerf.Tool, kerf.ToolTable, kerf.Stock, kerf.Simulation, kerf.Diagnostic):
        for name in dir(kind):
            assert name.startswith("_") or getattr(kind, name).__doc__, f"{kind.__name__}.{name}"


def test_errors_of_a_tool_name_the_line_of_the_script():
    with pytest.raises(kerf.Error) as caught:
        kerf.Tool("spoon d=3")
    assert "test_kerf.py" in caught.value.diagnostics[0].where


@pytest.mark.parametrize("post", ["marlin", "klipper", "plain", "reprapfirmware"])
def test_the_filament_of_a_printer_reaches_every_writer(tmp_path, post):
    """2.85 mm: E is the volume by the section of this filament, not of 1.75 mm."""
    printer = kerf.Printer(0.45, 0.2, filament=2.85)
    printer.next_layer()
    printer.bead([(10, 10), (60, 10)])
    volume = ((0.45 - 0.2) * 0.2 + math.pi / 4 * 0.2 ** 2) * 50
    e = volume / (math.pi / 4 * 2.85 ** 2)
    kerf.post(printer.path, post, str(tmp_path / "a.gcode"))
    text = (tmp_path / "a.gcode").read_text()
    words = [float(w[1:]) for line in text.splitlines() if line.startswith("G1")
             for w in line.split() if w[0] == "E"]
    assert max(words) == pytest.approx(e, abs=2e-5) and "; filament_diameter = 2.85" in text

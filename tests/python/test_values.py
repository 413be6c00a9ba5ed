"""Values behave as Python's own: ==, hash, copies, pickle, slices, sums, geometries of other modules."""

import copy
import io
import multiprocessing
import pickle

import numpy
import pytest

import gcodepreview
import kerf

PLATE = [(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]


def a_path(depth=-2):
    path = kerf.Toolpath()
    path.tool(102)
    path.note("first part")
    path.rapid((0, 0, 5))
    path.cut((0, 0, depth), feed=100)
    path.arc((20, 0, depth), centre=(10, 0), turn="cw", feed=400)
    path.extrude((30, 0, depth), 900, volume=2, width=0.5, height=0.2, kind="infill")
    return path


def a_program():
    return kerf.op.pocket(kerf.Region([PLATE]), "square d=6", depth=2, stepdown=2, feed=900, rpm=8000)


def a_table():
    table = kerf.ToolTable()
    table[3] = kerf.Tool("square d=3.175 flute=12")
    return table


def a_diagnostic():
    with pytest.raises(kerf.Error) as found:
        kerf.read_gcode("G1 X\n", "part.nc")
    return found.value.diagnostics[0]


# (makes a value, makes another one)
KINDS = {
    "region": (lambda: kerf.Region([PLATE, (30, 20, 8)], fill="even_odd"), lambda: kerf.Region([PLATE])),
    "toolpath": (a_path, lambda: a_path(-3)),
    "program": (a_program, lambda: kerf.op.transform(a_program(), move=(1, 0))),
    "tool": (lambda: kerf.Tool("V d=12 angle=60"), lambda: kerf.Tool("V d=12 angle=90")),
    "table": (a_table, kerf.ToolTable),
    "stock": (lambda: kerf.Stock.block((9, 8, 7)), lambda: kerf.Stock.block((9, 8, 6))),
    "diagnostic": (
        a_diagnostic,
        lambda: pytest.raises(kerf.Error, kerf.read_gcode, "G1 Y\n").value.diagnostics[0],
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_equal_values_are_equal_and_others_are_not(kind):
    make, other = KINDS[kind]
    assert make() == make() and not make() != make()
    assert make() != other() and other() != make()
    assert make() != 3 and make() is not None and make() != "text"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "again",
    [
        copy.copy,
        copy.deepcopy,
        *(lambda v, p=p: pickle.loads(pickle.dumps(v, p)) for p in (2, 3, 4, 5)),
    ],
)
def test_a_copy_is_equal_and_of_the_same_class(kind, again):
    value = KINDS[kind][0]()
    made = again(value)
    assert made == value and type(made) is type(value) and made is not value


@pytest.mark.parametrize("kind", ["region", "tool", "stock", "diagnostic"])
def test_values_that_cannot_change_are_keys(kind):
    make, other = KINDS[kind]
    assert hash(make()) == hash(make())
    assert {make(): 1, other(): 2}[make()] == 1 and len({make(), make(), other()}) == 2


@pytest.mark.parametrize("kind", ["toolpath", "program", "table"])
def test_values_that_change_are_no_keys(kind):
    with pytest.raises(TypeError, match="unhashable"):
        hash(KINDS[kind][0]())


def test_a_copy_changes_alone():
    first = a_path()
    second = copy.deepcopy([first, first])
    assert second[0] is second[1]
    second[0].dwell(1)
    assert len(second[0]) == len(first) + 1 and second[0] != first


def test_a_pickle_keeps_what_equality_does_not_compare():
    path = a_path()
    again = pickle.loads(pickle.dumps(path))
    assert [again[i] for i in range(len(again))] == list(path)  # with the lines of the script


def test_a_damaged_pickle_is_an_error():
    data = pickle.dumps(a_path())
    with pytest.raises(kerf.Error):
        kerf.Toolpath.__new__(kerf.Toolpath).__setstate__(b"\x89KERF" + data[:20])


def test_errors_keep_their_diagnostics():
    with pytest.raises(kerf.Error) as found:
        kerf.read_gcode("G1 X\nG1 Y\n", "part.nc")
    again = pickle.loads(pickle.dumps(found.value))
    assert type(again) is kerf.Error and str(again) == str(found.value)
    assert again.diagnostics == found.value.diagnostics and again.diagnostics[0].line == 1
    assert copy.copy(found.value).diagnostics == found.value.diagnostics
    refused = gcodepreview.GcodePreviewError("no tool")
    assert str(pickle.loads(pickle.dumps(refused))) == "no tool"


@pytest.mark.parametrize(
    "make, instead",
    [
        (lambda: kerf.Printer(width=0.5, height=0.2, speed=1800), "`path`"),
        (lambda: gcodepreview.gcodepreview("no_preview"), "`toolpath`"),
        (lambda: kerf.simulate(a_path(), kerf.Stock.block((40, 20, 5)), resolution=1.0), "program and stock"),
        (kerf.LiveSimulation, "in each process"),
    ],
)
def test_what_cannot_be_copied_says_what_can(make, instead):
    value = make()
    for attempt in (copy.copy, copy.deepcopy, pickle.dumps, lambda v: pickle.Pickler(io.BytesIO()).dump(v)):
        with pytest.raises(TypeError, match="cannot be copied or pickled") as found:
            attempt(value)
        assert instead in str(found.value)


def work(depth):
    """A job of a pool: a program and its stock, or an error."""
    if depth % 2:
        kerf.read_gcode(f"G1 X{depth} Y\n", f"part{depth}.nc")
    plate = kerf.Region([PLATE])
    return kerf.op.contour(plate, "square d=6", depth=depth, stepdown=2, feed=900), kerf.Stock.block(
        (60, 40, 9)
    )


def attempted(depth):
    try:
        return work(depth)
    except kerf.Error as error:
        return error


def test_a_pool_returns_results_and_errors():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        found = pool.map(attempted, range(2, 10))
        with pytest.raises(kerf.Error, match="part3.nc:1") as raised:
            pool.apply(work, (3,))
    assert raised.value.diagnostics[0].name == a_diagnostic().name
    for depth, result in zip(range(2, 10), found):
        if depth % 2:
            assert isinstance(result, kerf.Error) and f"part{depth}.nc" in str(result)
            assert result.diagnostics[0].line == 1
        else:
            program, stock = result
            assert program == work(depth)[0] and stock.high[0] == 60


# ------------------------------------------------------------------------------------ toolpaths as sequences


def test_slices_and_sums_of_toolpaths():
    path = a_path()
    assert isinstance(path[1:3], kerf.Toolpath) and len(path[1:3]) == 2
    for part, whole in zip(path[1:3], [path[1], path[2]]):
        assert part == {k: v for k, v in whole.items() if k != "tool"}  # a slice starts without a tool
    assert path[:2] + path[2:] == path and path[:] == path and path[-2:] == path[len(path) - 2 :]
    assert len(path[99:]) == 0 and path[5:2] == kerf.Toolpath()
    assert len(path + path) == 2 * len(path) and path[0] in path and {"step": "none"} not in path
    with pytest.raises(ValueError, match="no stride"):
        path[::2]
    with pytest.raises(TypeError, match="unsupported operand"):
        path + 3
    with pytest.raises(TypeError, match="index must be a whole number or a slice, not 'a'"):
        path["a"]


def test_columns_of_a_toolpath():
    columns = a_path().columns()
    assert columns.dtype.names == ("step", "x", "y", "z", "feed", "tool", "line")
    assert list(columns["step"]) == [step["step"] for step in a_path()]
    assert list(columns["x"][2:]) == [0, 0, 20, 30] and columns["z"][3] == -2
    assert list(columns["feed"][3:]) == pytest.approx([100, 400, 900]) and numpy.isnan(columns["feed"][2])
    assert numpy.isnan(columns["x"][0]) and set(columns["tool"]) == {102}
    assert columns["line"][0] == a_path()[0]["origin"]["line"]
    assert numpy.asarray(a_path()).dtype == columns.dtype and len(numpy.asarray(a_path())) == 6
    assert len(kerf.Toolpath().columns()) == 0


# --------------------------------------------------------------------------------------------- geometries


class Shape:
    """What other modules call a geometry."""

    def __init__(self, kind, coordinates):
        self.__geo_interface__ = {"type": kind, "coordinates": coordinates}


SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0))
HOLE = ((2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0))


def turned(ring):
    return tuple(reversed(ring))


@pytest.mark.parametrize("rings", [(SQUARE, HOLE), (SQUARE, turned(HOLE)), (turned(SQUARE), turned(HOLE))])
def test_regions_of_geometries(rings):
    assert kerf.Region(Shape("Polygon", rings)).area == pytest.approx(96)
    assert kerf.Region([Shape("Polygon", rings), (20, 0, 1)]).area == pytest.approx(96 + numpy.pi)
    assert kerf.Region(Shape("MultiPolygon", [rings])).area == pytest.approx(96)
    feature = Shape("", None)
    feature.__geo_interface__ = {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": rings}}
    assert kerf.Region(feature).area == pytest.approx(96)


def test_lines_of_geometries_and_refusals():
    line = Shape("LineString", [(0, 0), (10, 0)])
    assert kerf.widen(line, 1, ends="butt").area == pytest.approx(20)
    assert len(kerf.op.engrave([line], "V d=6 angle=60", depth=0.4, feed=600)) > 2
    with pytest.raises(ValueError, match="a Polygon or a MultiPolygon is expected, not a LineString"):
        kerf.Region(line)


def test_a_region_is_a_geometry():
    found = kerf.Region([PLATE, (30, 20, 8)], fill="even_odd").__geo_interface__
    assert found["type"] == "MultiPolygon" and len(found["coordinates"]) == 1
    outside, hole = found["coordinates"][0]
    assert sorted(set(outside)) == sorted(set(map(tuple, PLATE))) and len(hole) > 32
    disc = kerf.Region([(0, 0, 5)])
    assert (
        kerf.Region(disc) == disc and kerf.Region([disc, Shape("Polygon", [SQUARE])]).area > 100
    )  # arcs stay
    shapely = pytest.importorskip("shapely.geometry")
    shape = shapely.shape(kerf.Region([PLATE, (30, 20, 8)], fill="even_odd"))
    assert shape.is_valid and shape.area == pytest.approx(2400 - numpy.pi * 64, abs=0.5)
    assert kerf.Region(shape).area == pytest.approx(shape.area)


@pytest.mark.parametrize("kind", KINDS)
def test_what_values_say_they_are(kind):
    assert repr(KINDS[kind][0]()).startswith("<kerf.")


def test_a_printer_says_what_it_has_printed():
    printer = kerf.Printer(0.45, 0.2)
    printer.next_layer()
    printer.bead([(0, 0), (10, 0)])
    volume = 10 * ((0.45 - 0.2) * 0.2 + numpy.pi * 0.1**2)  # a rectangle with half circles at its ends
    text = repr(printer)
    assert text.startswith("<kerf.Printer at Z0.2 mm: ")
    assert float(text.split("mm: ")[1].split()[0]) == pytest.approx(volume, abs=1e-3)

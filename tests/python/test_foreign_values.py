"""Values of other modules as arguments: geometries of shapely, arrays of NumPy, iterators, Decimal and
Fraction, and drawings that ezdxf writes; and the messages about those that cannot be used.
"""

import decimal
import fractions
import io
import math
import pathlib

import numpy as np
import pytest

import kerf

shapely = pytest.importorskip("shapely")
geometry = pytest.importorskip("shapely.geometry")

PLATE = [(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]
HOLE = [(20, 10), (40, 10), (40, 30), (20, 30), (20, 10)]
MILL = dict(depth=2, feed=900)


def lines_of(program):
    """Start and end of all cuts in X and Y."""
    path = program.toolpath
    steps = [path[i] for i in range(len(path))]
    at = [(step["step"], step["to"][:2]) for step in steps if "to" in step]
    return [(a[1], b[1]) for a, b in zip(at, at[1:]) if b[0] == "cut"]


def cut_area(program):
    """What a mill of 6 mm clears, by shapely."""
    lines = [geometry.LineString([a, b]) for a, b in lines_of(program) if a != b]
    return shapely.union_all([line.buffer(3, quad_segs=32) for line in lines]).area


# ---- shapely: areas


@pytest.mark.parametrize(
    "made",
    [
        geometry.Polygon(PLATE, [HOLE]),
        geometry.Polygon(PLATE[::-1], [HOLE]),
        geometry.MultiPolygon([geometry.Polygon(PLATE, [HOLE])]),
        geometry.GeometryCollection([geometry.Polygon(PLATE, [HOLE])]),
        geometry.GeometryCollection([geometry.GeometryCollection([geometry.Polygon(PLATE, [HOLE])])]),
    ],
    ids=["polygon", "clockwise", "multi", "collection", "nested"],
)
def test_areas_are_regions_and_what_is_pocketed(made):
    region = kerf.Region(made)
    assert region.area == pytest.approx(made.area) == 2000
    assert kerf.Region([made]) == region
    pocket = kerf.op.pocket(made, "square d=6", **MILL)
    assert lines_of(pocket) == lines_of(kerf.op.pocket(region, "square d=6", **MILL))
    assert lines_of(kerf.op.pocket([made], "square d=6", **MILL)) == lines_of(pocket)


def test_overlapping_polygons_are_one_area():
    both = geometry.GeometryCollection([geometry.box(0, 0, 30, 20), geometry.box(20, 0, 50, 20)])
    assert kerf.Region(both).area == pytest.approx(1000)
    program = kerf.op.pocket(both, "square d=6", **MILL)
    assert cut_area(program) == pytest.approx(1000 - (4 - math.pi) * 9, rel=0.002)


def test_a_list_of_areas_is_what_each_of_them_is():
    parts = [geometry.box(0, 0, 20, 20), kerf.Region([(40, 10, 10)])]
    program = kerf.op.contour(parts, "square d=6", **MILL)
    (low, *_), (high, *_) = program.toolpath.report()["cut_bounds_mm"]
    assert (low, high) == pytest.approx((-3, 53))


def test_an_invalid_polygon_is_what_make_valid_makes_of_it():
    bow = geometry.Polygon([(0, 0), (20, 20), (20, 0), (0, 20)])
    assert not bow.is_valid
    assert kerf.Region(bow).area == pytest.approx(shapely.make_valid(bow).area)


@pytest.mark.parametrize(
    "empty",
    [
        geometry.Polygon(),
        geometry.MultiPolygon(),
        geometry.GeometryCollection(),
        geometry.GeometryCollection([geometry.Polygon()]),
        [],
        iter(()),
    ],
)
def test_empty_geometry_is_an_empty_region(empty):
    region = kerf.Region(empty)
    assert not region and region.area == 0 and region.bounds is None
    with pytest.raises(kerf.Error):
        kerf.op.pocket(region, "square d=6", **MILL)


def test_a_feature_without_geometry_is_empty():
    class Feature:
        __geo_interface__ = {"type": "Feature", "geometry": None, "properties": {}}

    assert not kerf.Region(Feature())


# ---- shapely: lines and points


def test_lines_are_engraved():
    line = geometry.LineString([(0, 0), (30, 0), (30, 20)])
    expected = lines_of(kerf.op.engrave([list(line.coords)], "V d=6 angle=60", depth=0.4, feed=600))
    for made in (line, [line], geometry.MultiLineString([line]), geometry.GeometryCollection([line])):
        assert lines_of(kerf.op.engrave(made, "V d=6 angle=60", depth=0.4, feed=600)) == expected
    two = geometry.MultiLineString([line, geometry.LineString([(0, 40), (9, 40)])])
    assert len(lines_of(kerf.op.engrave(two, "V d=6 angle=60", depth=0.4, feed=600))) > len(expected)


def test_a_third_coordinate_is_left_out():
    assert kerf.widen(geometry.LineString([(0, 0, 7), (40, 0, 7)]), 3).area == pytest.approx(
        240 + 9 * math.pi, rel=1e-4
    )
    assert kerf.Region(geometry.Polygon([(x, y, 5) for x, y in PLATE])).area == pytest.approx(2400)


def test_points_are_drilled():
    wanted = lines_of(kerf.op.drill([(8, 8), (52, 32)], "drill d=4", depth=6, feed=100))
    points = [geometry.Point(8, 8), geometry.Point(52, 32)]
    for made in (geometry.MultiPoint(points), points, np.array([(8, 8), (52, 32)]), iter([(8, 8), (52, 32)])):
        assert lines_of(kerf.op.drill(made, "drill d=4", depth=6, feed=100)) == wanted


def test_points_are_asked_for():
    plate = kerf.Region([PLATE])
    assert plate.locate(geometry.Point(30, 20)) == "inside"
    assert plate.locate(geometry.MultiPoint([(30, 20), (90, 20)])) == ["inside", "outside"]
    assert plate.locate([geometry.Point(30, 20)]) == ["inside"]
    assert plate.locate(p for p in [(30, 20), (90, 20)]) == ["inside", "outside"]
    assert plate.clearance(np.array([[30.0, 20.0]])) == [20.0]


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: kerf.Region(geometry.LineString([(0, 0), (9, 9)])), "Polygon.*expected, not a LineString"),
        (lambda: kerf.Region(geometry.MultiPoint([(0, 0)])), "Polygon.*expected, not a MultiPoint"),
        (lambda: kerf.widen(geometry.box(0, 0, 9, 9), 1), "LineString is expected, not a Polygon"),
        (
            lambda: kerf.op.engrave(geometry.Point(1, 2), "V d=6 angle=60", depth=1, feed=600),
            "Point",
        ),
        (lambda: kerf.op.drill(geometry.box(0, 0, 9, 9), "drill d=4", depth=6, feed=100), "points.*expected"),
        (lambda: kerf.Region([[(0, 0, 1), (5, 0, 1), (5, 5, 1)]]), "2 numbers .* or 4 .* not 3"),
    ],
)
def test_what_cannot_be_used_is_named(call, text):
    with pytest.raises(ValueError, match=text):
        call()


# ---- lists, arrays, iterators, numbers


@pytest.mark.parametrize(
    "outlines",
    [
        [np.array(PLATE)],
        np.array([PLATE]),
        np.array([PLATE], dtype=np.float32),
        (outline for outline in [PLATE]),
        [iter(PLATE)],
        [map(tuple, PLATE)],
        [(iter(point) for point in PLATE)],
        [[(decimal.Decimal(x), fractions.Fraction(y)) for x, y in PLATE]],
        [list(zip(np.array(PLATE)[:, 0], np.array(PLATE)[:, 1]))],
    ],
    ids="array arrays float32 generator iterator map iterators decimal scalars".split(),
)
def test_outlines_may_be_anything_with_an_order(outlines):
    assert kerf.Region(outlines) == kerf.Region([PLATE])


@pytest.mark.parametrize("wrong", [{0: PLATE}, {tuple(PLATE)}, "plate", 3, None])
def test_what_has_no_order_is_refused(wrong):
    with pytest.raises(TypeError, match="list of outlines"):
        kerf.Region(wrong)
    with pytest.raises(TypeError, match="outline"):
        kerf.Region([wrong])


NUMBERS = [6, decimal.Decimal(6), fractions.Fraction(12, 2), np.float32(6), np.int64(6)]


@pytest.mark.parametrize("six", NUMBERS)
def test_numbers_of_all_kinds(six):
    plain = kerf.op.pocket([PLATE], "square d=6", depth=6, feed=900)
    assert lines_of(kerf.op.pocket([PLATE], "square d=6", depth=six, feed=900)) == lines_of(plain)
    stepped = kerf.op.step_down(plain, six)
    assert lines_of(stepped) == lines_of(kerf.op.step_down(plain, 6))
    assert kerf.Stock.block((six, six, six)).high == (6, 6, 0)
    assert kerf.Region([(0, 0, six)]).bounds == kerf.Region([(0, 0, 6)]).bounds
    for units in ("mm", "inch"):
        with kerf.Job((six, 4, 1), feed=six, rpm=9000, units=units) as job:
            job.tool(102)
            job.move_to(six, 0)
            job.cut(z=-six / 6)
        assert job.path.report()["cut_mm"] > 0


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: kerf.Stock.block((-60, 40, 10)), "size must be above 0"),
        (lambda: kerf.Region([(0, 0, -5)]), "radius must be above 0"),
        (lambda: kerf.widen([(0, 0), (9, 0)], -1), "half_width|half width|above 0"),
        (lambda: kerf.op.pocket([PLATE], "square d=6", depth=-2, feed=900), "depth"),
        (lambda: kerf.op.drill([], "drill d=4", depth=2, feed=100), "no point|no outline"),
        (lambda: kerf.Tool("square d=-6"), "above 0|diameter"),
        (lambda: kerf.Job((60, -40, 10)), "stock must be above 0"),
        (lambda: kerf.finger_slots(-50, 9, 5), "width"),
        (lambda: kerf.op.text_outlines("A", -4), "height"),
        (lambda: kerf.Region([[(0, 0), (math.nan, 0), (5, 5), (0, 0)]]), "finite"),
        (lambda: kerf.Region([[(0, 0), (9, 0), (5, 5)]]), "closed|open"),
    ],
)
def test_sizes_out_of_range_name_the_argument(call, text):
    with pytest.raises(ValueError, match=text):
        call()


# ---- files


def test_names_of_files_may_be_paths(tmp_path):
    (tmp_path / "part.nc").write_text("G21 G90 T102 M6 M3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM2\n")
    program = kerf.load(pathlib.Path(tmp_path / "part.nc"))
    assert kerf.post(program, "grbl", pathlib.Path(tmp_path / "out.nc"))
    with pytest.raises(TypeError):
        kerf.load(io.StringIO("G0 X0"))
    with pytest.raises(FileNotFoundError):
        kerf.load(tmp_path / "missing.nc")
    with pytest.raises((IsADirectoryError, OSError)):
        kerf.load(tmp_path)


@pytest.fixture
def drawn():
    """A drawing by ezdxf: a plate, a circle, an arc with a line, a spline, a block."""
    ezdxf = pytest.importorskip("ezdxf")
    made = ezdxf.new(units=4)
    space = made.modelspace()
    space.add_lwpolyline([*PLATE[:-1]], close=True, dxfattribs={"layer": "PLATE"})
    space.add_circle((30, 20), 8, dxfattribs={"layer": "PLATE"})
    space.add_lwpolyline([(70, 0, 0, 0, 1), (90, 0, 0, 0, 1)], close=True, dxfattribs={"layer": "DISC"})
    block = made.blocks.new("PAD")
    block.add_circle((0, 0), 2)
    space.add_blockref("PAD", (10, 60), dxfattribs={"layer": "PADS", "xscale": 2, "yscale": 2})
    space.add_point((5, 5), dxfattribs={"layer": "HOLES"})
    return made


def test_drawings_that_ezdxf_writes(drawn, tmp_path):
    drawn.saveas(tmp_path / "plate.dxf")
    drawing = kerf.load_drawing(tmp_path / "plate.dxf")
    assert drawing.unit == "mm"
    assert drawing.region("PLATE").area == pytest.approx(2400 - 64 * math.pi, rel=1e-6)
    assert drawing.region("DISC").area == pytest.approx(100 * math.pi, rel=1e-6)
    assert drawing.outlines("HOLES").points == [(5, 5)]


def test_a_drawing_in_memory_is_read_as_text_and_as_bytes(drawn):
    text = io.StringIO()
    drawn.write(text)
    for data in (text.getvalue(), text.getvalue().encode()):
        assert kerf.read_drawing(data).region("PLATE").area == pytest.approx(2400 - 64 * math.pi, rel=1e-6)


def test_what_kerf_writes_is_read_by_ezdxf(tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    writer = kerf.DrawingWriter()
    writer.circle("CUT", 20, 20, 8)
    (tmp_path / "hole.dxf").write_bytes(writer.dxf())
    (circle,) = ezdxf.readfile(tmp_path / "hole.dxf").modelspace()
    assert (circle.dxf.radius, circle.dxf.layer) == (8, "CUT")

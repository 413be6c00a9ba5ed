"""Outlines and regions from DXF drawings in Python."""

import math
import warnings

import pytest

ezdxf = pytest.importorskip("ezdxf", reason="ezdxf is not installed")
import kerf  # noqa: E402


def saved(tmp_path, fill, version="R2010", units=4):
    document = ezdxf.new(version)
    document.units = units
    document.layers.add("CUT", color=1)
    document.layers.add("NOTES").off()
    fill(document.modelspace())
    path = tmp_path / "part.dxf"
    document.saveas(path)
    return path


def plate(space):
    on = {"layer": "CUT"}
    space.add_line((0, 0), (60, 0), on)
    space.add_line((60, 40), (60, 0), on)
    space.add_arc((50, 40), 10, 0, 180, dxfattribs=on)
    space.add_line((40, 40), (0, 40), on)
    space.add_line((0, 40), (0, 0), on)
    space.add_circle((15, 20), 6, on)
    space.add_ellipse((40, 15), (8, 0), 0.5, dxfattribs=on)
    space.add_point((5, 5), on)
    space.add_text("side A", dxfattribs={"layer": "NOTES"})


def test_a_drawing_becomes_outlines_and_a_region(tmp_path):
    drawing = kerf.load_drawing(saved(tmp_path, plate))
    assert (drawing.version, drawing.unit) == ("AC1024", "mm")
    drawn = drawing.outlines("cut")
    assert len(drawn) == 3 and drawn.names == ["CUT.1", "CUT.2", "CUT.3"]
    assert drawn.outlines[1] == (15, 20, 6) and drawn.points == [(5, 5)]
    assert drawn.outlines[0][0] == drawn.outlines[0][-1][-2:] and len(drawn.handles[0]) == 5
    region = drawn.region()
    assert region.area == pytest.approx(2400 + 50 * math.pi - 36 * math.pi - 32 * math.pi, abs=0.1)
    assert drawing.region(["CUT"]).area == pytest.approx(region.area)
    assert drawing.outlines("CUT", tolerance=1e-4).region().area == pytest.approx(
        2400 - 18 * math.pi, abs=0.001
    )
    assert kerf.Region(drawn.outlines, fill="even_odd").area == pytest.approx(region.area)


def test_layers_are_listed(tmp_path):
    layers = {layer["name"]: layer for layer in kerf.load_drawing(saved(tmp_path, plate)).layers}
    assert layers["CUT"]["entities"] == {"LINE": 4, "ARC": 1, "CIRCLE": 1, "ELLIPSE": 1, "POINT": 1}
    assert layers["NOTES"]["off"] and layers["NOTES"]["entities"] == {"TEXT": 1}


def test_a_missing_unit_must_be_given(tmp_path):
    drawing = kerf.load_drawing(saved(tmp_path, plate, units=0))
    assert drawing.unit is None
    with pytest.raises(kerf.Error, match="does not specify its unit") as error:
        drawing.outlines()
    assert error.value.diagnostics[0].name == "drawing_unit"
    assert drawing.outlines("CUT", unit="inch").outlines[1] == pytest.approx((381, 508, 152.4))
    with pytest.raises(ValueError, match="unit must be"):
        drawing.outlines(unit="furlong")


def test_open_ends_are_warned_about_and_have_no_region(tmp_path):
    drawing = kerf.load_drawing(
        saved(tmp_path, lambda space: (space.add_line((0, 0), (10, 0)), space.add_line((10.5, 0), (0, 10))))
    )
    with pytest.warns(UserWarning, match="open end"):
        drawn = drawing.outlines()
    assert [round(end[4], 6) for end in drawn.open_ends] == [10, 0.5, 0.5, 10]
    with pytest.raises(kerf.Error, match="no closed outline"):
        drawn.region()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert len(drawing.outlines(join=0.6)) == 1


def test_what_is_no_drawing(tmp_path):
    with pytest.raises(kerf.Error, match="not a DXF file"):
        kerf.read_drawing(b"G1 X1\n", "part.nc")
    with pytest.raises(FileNotFoundError):
        kerf.load_drawing(tmp_path / "none.dxf")
    with pytest.raises(kerf.Error, match="no layer"):
        kerf.load_drawing(saved(tmp_path, plate)).outlines("CUTS")


# Each entity on a layer of its own; ezdxf flattens them.
CURVES = {
    "ellipse": lambda s, on: s.add_ellipse((3, 4), (8, 3), 0.3, dxfattribs=on),
    "arc": lambda s, on: s.add_ellipse((3, 4), (8, 3), 0.3, 1, 5, dxfattribs=on),
    "flipped": lambda s, on: s.add_ellipse(
        (3, 4), (8, 3), 0.3, 1, 5, dxfattribs={**on, "extrusion": (0, 0, -1)}
    ),
    "bspline": lambda s, on: s.add_open_spline([(0, 0), (5, 9), (9, -9), (20, 3), (22, 8)], dxfattribs=on),
    "degree5": lambda s, on: s.add_open_spline(
        [(0, 0), (5, 9), (9, -9), (20, 3), (22, 8), (30, 0)], degree=5, dxfattribs=on
    ),
    "rational": lambda s, on: s.add_rational_spline(
        [(0, 0), (5, 9), (9, -9), (20, 3)], [1, 3, 0.5, 1], dxfattribs=on
    ),
    "closed": lambda s, on: s.add_spline(dxfattribs=on).set_closed(
        [(0, 0, 0), (9, 9, 0), (18, 0, 0), (9, -9, 0)]
    ),
    "fit": lambda s, on: s.add_spline([(0, 0), (5, 5), (9, -2), (20, 3)], dxfattribs=on),
    "bulges": lambda s, on: s.add_lwpolyline(
        [(0, 0, 0.3), (9, 2, -1.5), (12, 9, 0)], format="xyb", close=True, dxfattribs=on
    ),
    "spline_pline": lambda s, on: s.add_polyline2d([(0, 0), (4, 4), (8, 0)], dxfattribs=on),
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("placing", ["", "turned", "mirrored", "stretched"])
def test_curves_run_where_ezdxf_has_them(tmp_path, name, placing):
    shapely = pytest.importorskip("shapely", reason="shapely is not installed")
    from ezdxf import disassemble

    document = ezdxf.new("R2010", units=4)
    document.layers.add("C")
    space = document.blocks.new("B", base_point=(2, 1)) if placing else document.modelspace()
    CURVES[name](space, {"layer": "C"})
    scale = {"turned": (2, 2), "mirrored": (-1.5, 1.5), "stretched": (3, 0.5)}.get(placing)
    if placing:
        document.modelspace().add_blockref(
            "B", (7, 7), {"rotation": 40, "xscale": scale[0], "yscale": scale[1]}
        )
    path = tmp_path / "curve.dxf"
    document.saveas(path)
    theirs = []
    for e in disassemble.recursive_decompose(ezdxf.readfile(path).modelspace()):
        # make_path approximates splines by Bézier curves of 0.03 mm deviation; the B-spline itself is exact.
        points = (e.construction_tool().approximate(5000) if e.dxftype() == "SPLINE"
                  else ezdxf.path.make_path(e).flattening(1e-4))
        points = [(p.x, p.y) for p in points]
        # A stretched arc is an ellipse, which ezdxf may run the other way round.
        if theirs and math.dist(theirs[-1], points[-1]) < math.dist(theirs[-1], points[0]):
            points.reverse()
        theirs += points
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (ours,) = kerf.load_drawing(path).outlines("C", tolerance=0.002).outlines
    mine = shapely.LineString(kerf.flattened(ours, 1e-4))
    other = shapely.LineString(theirs)
    assert mine.hausdorff_distance(other) < 0.01
    assert mine.length == pytest.approx(other.length, rel=1e-3)

"""Drawings of toolpaths, read by ezdxf: valid files, the same geometry in both versions, and in the SVG."""
import math
import os
import re
import subprocess
import xml.etree.ElementTree
from pathlib import Path

import pytest

ezdxf = pytest.importorskip("ezdxf", reason="ezdxf is not installed")
from ezdxf import bbox  # noqa: E402

KERF = os.environ["KERF"]
CASES = Path(os.environ.get("KERF_CASES_DIR") or "none", "gcode")
OWN = Path(__file__).parent.parent / "data/gcode/programs"
FILES = [p for folder in (OWN, CASES) for p in sorted(folder.glob("*.*"))
         if p.suffix in (".nc", ".ngc", ".gcode")]

# Lines, arcs, a circle, a helix, an arc in the XZ plane, a hole, two tools and a rapid between.
SHAPES = """G21 G90 G17
T1 M6
M3 S1000
G0 X0 Y0 Z5
G1 Z-1 F300
G1 X20
G3 X20 Y10 J5
G1 X0
G1 Y0
G0 Z5
G0 X40 Y5
G1 Z-1
G2 X40 Y5 Z-3 I5 J0
G0 Z5
T2 M6
M3 S1000
G0 X60 Y5
G1 Z-8
G0 Z5
G0 X70 Y0
G1 Z0
G18 G2 X80 Z0 I5 K0
G0 Z5
G0 X70 Y20
G1 Z-1
G17 G3 X70 Y26 J3
G0 Z5
M2
"""


def draw(source, target, *options):
    done = subprocess.run([KERF, "post", "--to", target.suffix[1:], source, "-o", target, "-q", *options],
                          capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr.decode()
    return target


def opened(path):
    document = ezdxf.readfile(path)
    audit = document.audit()
    assert not audit.errors and not audit.fixes, [e.message for e in audit.errors + audit.fixes]
    return document


@pytest.fixture
def shapes(tmp_path):
    path = tmp_path / "shapes.nc"
    path.write_text(SHAPES)
    return path


def kinds(document):
    return sorted(e.dxftype() for e in document.modelspace())


def test_dxf_2000(shapes, tmp_path):
    document = opened(draw(shapes, tmp_path / "a.dxf"))
    assert document.dxfversion == "AC1015" and document.header["$INSUNITS"] == 4
    assert kinds(document) == ["ARC", "CIRCLE", "CIRCLE", "LINE", "LWPOLYLINE"]
    chain, = document.modelspace().query("LWPOLYLINE")
    assert chain.closed and [round(p[4], 9) for p in chain.get_points()] == [0, 1, 0, 0]
    arc, = document.modelspace().query("ARC")
    assert (arc.dxf.radius, arc.dxf.start_angle % 360, arc.dxf.end_angle % 360) == pytest.approx((3, 270, 90))
    colours = {layer.dxf.name: layer.color for layer in document.layers}
    assert colours["T1"] != colours["T2"]
    assert {e.dxf.layer for e in document.modelspace()} == {"T1", "T2"}
    extents = bbox.extents(document.modelspace(), fast=False)
    assert tuple(extents.extmin)[:2] == pytest.approx((0, 0), abs=1e-6)
    assert tuple(extents.extmax)[:2] == pytest.approx((80, 26), abs=1e-6)


def test_r12(shapes, tmp_path):
    document = opened(draw(shapes, tmp_path / "a.dxf", "--dxf-version", "r12"))
    assert document.dxfversion == "AC1009"
    assert kinds(document) == ["ARC", "CIRCLE", "CIRCLE", "LINE", "POLYLINE"]
    chain, = document.modelspace().query("POLYLINE")
    assert chain.is_closed and [round(v.dxf.bulge, 9) for v in chain.vertices] == [0, 1, 0, 0]


def test_inches(shapes, tmp_path):
    document = opened(draw(shapes, tmp_path / "a.dxf", "--inch"))
    assert document.header["$INSUNITS"] == 1
    hole = min(document.modelspace().query("CIRCLE"), key=lambda c: c.dxf.radius)
    assert hole.dxf.center.x == pytest.approx(60 / 25.4)


def test_rapids_have_their_own_layer(shapes, tmp_path):
    document = opened(draw(shapes, tmp_path / "a.dxf", "--rapids"))
    rapids = [e for e in document.modelspace() if e.dxf.layer == "rapids"]
    assert rapids and document.layers.get("rapids").dxf.linetype == "DASHED"


def test_svg(shapes, tmp_path):
    root = xml.etree.ElementTree.parse(draw(shapes, tmp_path / "a.svg")).getroot()
    left, top, width, height = map(float, root.get("viewBox").split())
    assert root.get("width") == f"{width:g}mm" and root.get("height") == f"{height:g}mm"
    margin = -left
    assert (left + width, top, top + height) == pytest.approx((80 + margin, -26 - margin, margin))
    circles = root.findall(".//{*}circle")
    assert {(c.get("cx"), c.get("cy")) for c in circles} == {("45", "-5"), ("60", "-5")}  # y points down


def test_wrong_version(shapes, tmp_path):
    done = subprocess.run([KERF, "post", "--to", "dxf", "--dxf-version", "r14", shapes], capture_output=True)
    assert done.returncode == 2 and b"r12" in done.stderr


def flat_length(entity):
    """Length in plan, through ezdxf's own geometry."""
    path = ezdxf.path.make_path(entity)
    points = list(path.flattening(0.001))
    return sum(a.distance(b) for a, b in zip(points, points[1:]))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_programs(path, tmp_path):
    new = opened(draw(path, tmp_path / "new.dxf"))
    assert math.isfinite(new.header["$EXTMAX"][0])
    svg = draw(path, tmp_path / "new.svg").read_text()
    assert len(re.findall(r"<(?:path|circle) ", svg)) == len(new.modelspace()) > 0
    if len(new.modelspace()) > 5000:  # too slow in ezdxf
        return
    old = opened(draw(path, tmp_path / "old.dxf", "--dxf-version", "r12"))
    assert len(new.modelspace()) == len(old.modelspace())
    for a, b in zip(list(new.modelspace())[:40], list(old.modelspace())[:40]):
        assert flat_length(a) == pytest.approx(flat_length(b), rel=1e-6, abs=1e-6)

"""The bundled path drawings: as their script writes them, and each compiles and cuts what the manual says."""
import json
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
DRAWINGS = sorted((EXAMPLES / "path").glob("*.dxf"))


def test_the_script_writes_the_bundled_files(tmp_path):
    subprocess.run([sys.executable, EXAMPLES / "make_path_drawings.py", tmp_path], check=True)
    assert [p.name for p in sorted(tmp_path.iterdir())] == [p.name for p in DRAWINGS]
    for drawing in DRAWINGS:
        assert (tmp_path / drawing.name).read_bytes() == drawing.read_bytes()


@pytest.mark.parametrize("drawing", DRAWINGS, ids=lambda p: p.stem)
def test_each_compiles_without_warnings(kerf, drawing):
    run = kerf("pathdxf", "/len", "/f150", "/v500", "/s8", "/c", drawing)
    assert run.status == 0 and "****" not in run.err
    # Cores of helical circles are milled by a smaller circle, or held by support bars.
    assert "loose core" not in run.err


@pytest.mark.parametrize("name, deepest, cuts", [
    ("9001.1P", -0.1, 8), ("9002.1P", -0.1, 1), ("9004.1P", -0.1, 8), ("9005.1P", -0.1, 12),
    ("9006.1P", 0.5, 2), ("9008.1P", 0.5, 2), ("9009.1P", 2, 1)])
def test_depths(kerf, name, deepest, cuts):
    rows = [json.loads(row) for row in kerf("steps", EXAMPLES / "path" / f"{name}.dxf").out.splitlines()][1:]
    z = [s["to"][2] for s in rows if s["step"] in ("cut", "arc")]
    assert min(z) == pytest.approx(deepest) and len(z) >= cuts


def test_the_rapid_over_the_clamp_has_its_height(kerf):
    rows = [json.loads(row) for row in kerf("steps", EXAMPLES / "path" / "9004.1P.dxf").out.splitlines()][1:]
    assert max(s["to"][2] for s in rows if s["step"] == "rapid") == 15


def test_the_branches_of_the_star_are_milled_in_their_order(kerf):
    rows = [json.loads(row) for row in kerf("steps", EXAMPLES / "path" / "9005.1P.dxf").out.splitlines()][1:]
    first = []
    for s in rows:
        if s["step"] == "cut" and s["to"][2] == 2 and tuple(s["to"][:2]) not in first:
            first.append(tuple(s["to"][:2]))
    assert first == [(0, 0), (10, 0), (10, 10), (20, 10), (30, 0)] or first[1:] == [
        (10, 0), (10, 10), (20, 10), (30, 0)]

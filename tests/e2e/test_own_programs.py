"""The programs of tests/data/gcode/programs: their figures are those of LinuxCNC's interpreter (rs274 2.9,
recorded once; bounds with arcs sampled every 0.02 rad), and so are those of what the posts write of them."""
import json
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "data/gcode/programs"
RECORDED = json.loads((FOLDER / "expected.json").read_text())
SLACK = 0.01  # mm: lengths are recorded with two decimals, bounds with three
POSTS = ["grbl", "grblhal", "linuxcnc", "mach3"]


def assert_figures(motion, wanted, counts=("lines", "arcs", "rapids")):
    for key in counts:
        assert motion[key] == wanted[key], key
    for key in ("cut_mm", "rapid_mm"):
        assert motion[key] == pytest.approx(wanted[key], abs=SLACK), key
    for mine, theirs in zip(motion["cut_bounds_mm"], wanted["cut_bounds_mm"]):
        assert mine == pytest.approx(theirs, abs=SLACK)


def test_every_program_is_recorded():
    assert sorted(RECORDED) == sorted(p.name for p in FOLDER.glob("*.n*"))


@pytest.mark.parametrize("name", RECORDED)
def test_figures(kerf, name):
    run = kerf("info", "--json", FOLDER / name)
    assert run.status == 0, run.err
    assert_figures(run.json["motion"], RECORDED[name])


@pytest.mark.parametrize("post", POSTS)
@pytest.mark.parametrize("name", RECORDED)
def test_posts(kerf, tmp_path, name, post):
    """A full circle is written as two halves, cycles as single motions where the controller lacks them."""
    out = tmp_path / name
    unit = "--inch" if name.endswith("inch.nc") else "--mm"
    run = kerf("post", "--to", post, unit, FOLDER / name, "-o", out)
    assert run.status == 0, run.err
    motion = kerf("info", "--json", out).json["motion"]
    wanted = dict(RECORDED[name])
    wanted["arcs"] += 1 if name == "planes.nc" else 0
    assert_figures(motion, wanted)

"""kerf cut: V-carving, its floors, and the two parts of an inlay; written programs in an interpreter."""
import json
import math
import re
import shutil
import subprocess

import pytest

BOX = {"unit": "mm", "outlines": [{"name": "box", "closed": True, "first": {"at": [0, 0]}, "segments": [
    {"to": [20, 0]}, {"to": [20, 10]}, {"to": [0, 10]}, {"to": [0, 0]}]}]}
TOOL = ("--tool", "V d=20 angle=90")
STOCK = ("--stock", "-5,-5,-10 to 25,15,0", "--resolution", "0.05", *TOOL)
CARVE = ["--op", "vcarve", "--feed", "900"]


@pytest.fixture
def art(tmp_path):
    (tmp_path / "box.json").write_text(json.dumps(BOX))
    return "box.json"


def removed(kerf, file, *more):
    run = kerf("simulate", "--json", file, *more)
    assert run.status == 0, run.err + run.out
    assert run.json["hazards"] == []
    return run.json["removed_mm3"]


def accepted_by_linuxcnc(file, folder):
    """Whether LinuxCNC's interpreter reads a program to its end."""
    (folder / "tool.tbl").write_text("T1 P1 D0.2\nT2 P2 D0.2\n")
    done = subprocess.run(["rs274", "-t", "tool.tbl", "-g", file], cwd=folder, capture_output=True, text=True,
                          env={"HOME": str(folder), "PATH": "/usr/bin:/bin"}, timeout=60)
    return done.returncode == 0 and "PROGRAM_END" in done.stdout


def test_a_hip_roof_has_its_volume(kerf, art):
    run = kerf("cut", art, *CARVE, *TOOL, "-o", "part.nc")
    assert run.status == 0, run.err
    # Slopes of 45 degrees from all four edges.
    assert removed(kerf, "part.nc", *STOCK) == pytest.approx(10**2 * (3 * 20 - 10) / 12, rel=2e-3)


def test_a_limited_depth_and_its_floor(kerf, tmp_path, art):
    (tmp_path / "job.toml").write_text(f'''art = "{art}"
stock = "-5,-5,-10 to 25,15,0"
[tools]
1 = "V d=20 angle=90"
2 = "square d=2"
[defaults]
depth = 3
feed = 900
[[operation]]
op = "vcarve"
tool = 1
[[operation]]
op = "vcarve-floor"
tool = 2
carve-tool = 1
stepdown = 1
''')
    # A frustum, less the corners of the floor that a tool of 2 mm leaves: square, below the cone.
    whole = 3 / 6 * (20 * 10 + 4 * 17 * 7 + 14 * 4)  # by Simpson's rule, exact here
    left = 4 * (1 - math.pi / 4)
    got = removed(kerf, "job.toml", "--resolution", "0.05")
    assert whole - 3 * left < got < whole + 0.2
    for post in ("grbl", "linuxcnc"):
        assert kerf("cut", "job.toml", "--to", post, "-o", f"part-{post}.nc").status == 0
    if shutil.which("rs274") is None:
        pytest.skip("rs274 is not installed: not run in LinuxCNC's interpreter")
    assert accepted_by_linuxcnc("part-linuxcnc.nc", tmp_path)


@pytest.mark.parametrize("floor_depth, carved", [(3, True), (2, False)])
def test_the_corners_that_the_floor_of_the_job_keeps_are_carved(kerf, tmp_path, art, floor_depth, carved):
    """The corners of the floor are at 3 mm from the edges, the mill of 2 mm comes to 4 mm."""
    (tmp_path / "job.toml").write_text(f'''art = "{art}"
[tools]
1 = "V d=20 angle=90"
2 = "square d=2"
[defaults]
feed = 900
[[operation]]
op = "vcarve"
tool = 1
depth = 3
[[operation]]
op = "vcarve-floor"
tool = 2
carve-tool = 1
depth = {floor_depth}
''')
    assert kerf("cut", "job.toml", "-o", "part.nc").status == 0
    at, corners = {}, set()
    for line in (tmp_path / "part.nc").read_text().splitlines():
        at |= {axis: float(value) for axis, value in re.findall(r"([XYZ])(-?[\d.]+)", line)}
        x, y = at.get("X", 0), at.get("Y", 0)
        if at.get("Z") == -3 and all(3.02 < min(v, side - v) < 3.9 for v, side in ((x, 20), (y, 10))):
            corners.add((x > 10, y > 5))
    assert len(corners) == (4 if carved else 0)


def test_passes_cut_the_same(kerf, art):
    assert kerf("cut", art, *CARVE, *TOOL, "--stepdown", "1", "-o", "part.nc").status == 0
    assert removed(kerf, "part.nc", *STOCK) == pytest.approx(10**2 * (3 * 20 - 10) / 12, rel=2e-3)


def test_an_inlay_fits(kerf, tmp_path, art):
    inlay = ["--depth", "3", "--glue-gap", "0.5", "--base-gap", "0.7", "--margin", "4"]
    assert kerf("cut", art, *CARVE, *TOOL, "--depth", "3", "-o", "pocket.nc").status == 0
    assert kerf("cut", art, *CARVE, *TOOL, *inlay, "--part", "plug", "-o", "plug.nc").status == 0
    lowest = {}
    for name in ("pocket.nc", "plug.nc"):
        lowest[name] = min(float(z) for z in re.findall(r"Z(-?[\d.]+)", (tmp_path / name).read_text()))
    assert lowest == pytest.approx({"pocket.nc": -3, "plug.nc": -(3 - 0.5 + 0.7)})


@pytest.mark.parametrize("change, message", [
    (["--tool", "square d=6"], "cannot do the operation vcarve"),
    (["--depth", "11"], "at most 10 mm"),
    (["--part", "lid"], "one of: pocket, plug"),
    (["--part", "plug", "--depth", "2", "--glue-gap", "2"], "glue gap"),
    (["--carve-tool", "1"], "no effect"),
])
def test_errors(kerf, art, change, message):
    tool = () if "--tool" in change else TOOL
    run = kerf("cut", "--json", art, *CARVE, *tool, *change)
    assert run.status != 0 or message == "no effect"
    assert message in run.out + run.err


def test_a_floor_needs_its_carving_tool(kerf, art):
    floor = ["--json", art, "--op", "vcarve-floor", "--tool", "square d=2", "--depth", "3", "--feed", "900"]
    run = kerf("cut", *floor)
    assert run.status == 2 and "carve-tool is missing" in run.out
    run = kerf("cut", *floor, "--carve-tool", "2")
    assert run.status == 1 and "tool 2 has no shape" in run.out

"""Real programs written by the posts: LinuxCNC's interpreter accepts them where it accepts the original, with
the same lengths, bounds and counts."""
import importlib.util
import json
import math
import os
import re
import subprocess
from pathlib import Path

import pytest
import rs274

CASES = Path(os.environ.get("KERF_CASES_DIR") or "none", "gcode")
FILES = sorted(p for p in CASES.glob("*.*") if p.suffix in (".nc", ".ngc", ".gcode"))
if not FILES:
    pytest.skip("the given cases are not here (KERF_CASES_DIR)", allow_module_level=True)
if not rs274.is_installed():
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)
# Some programs have cuts without a feed: LinuxCNC refuses them, and so does the post without --feed.
FEED = ["--feed", "500"]


def canon():
    spec = importlib.util.spec_from_file_location("canon", CASES / "canon.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def figures(path, folder):
    with pytest.MonkeyPatch.context() as patch:
        for name, value in {**rs274.at_home_in(folder), "TOOL_TBL": str(CASES / "tool.tbl")}.items():
            patch.setenv(name, value)
        patch.chdir(folder)  # the interpreter writes its parameter file there
        return canon().run(str(path), timeout=300)


def original_figures(path, folder):
    given = json.loads((CASES / "expected.json").read_text()).get(path.name)
    return given if given and "accepted" in given else figures(path, folder)


# LinuxCNC prints four decimals, and programs have three or four. In chains of cuts that are hardly longer
# than the last decimal, each rounding adds to the length (camotics_vcarve: 4000 cuts of 0.014 mm, printed in
# inches); a tenth of the coarsest rounding is allowed for each move of a program in inches.
ROUNDING = {"inch": 0.1 * 0.00254, "mm": 1e-6}
# Arcs that the posts write as straight cuts, as they are shorter than 0.002 mm.
TINY_ARCS = {"ugs_communicator.nc": 16}


def alike(a, b, moves, unit):
    return math.isclose(a, b, rel_tol=2e-6, abs_tol=0.02 + ROUNDING[unit] * moves)


def unit_of(path):
    return "inch" if re.search(rb"(?i)G20\b", path.read_bytes()) else "mm"


def written_by_kerf(path, post, out):
    command = [os.environ["KERF"], "post", "--to", post, *FEED, str(path), "-o", str(out), "--json"]
    return subprocess.run(command, capture_output=True, timeout=300)


def info(path):
    done = subprocess.run([os.environ["KERF"], "info", "--json", str(path)], capture_output=True, timeout=300)
    return json.loads(done.stdout)["motion"]


@pytest.mark.parametrize("post", ["grbl", "linuxcnc"])
@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_post(path, post, tmp_path):
    out = tmp_path / "out.nc"
    done = written_by_kerf(path, post, out)
    original = original_figures(path, tmp_path)
    if done.returncode != 0:
        assert not original["accepted"], done.stdout.decode() + done.stderr.decode()
        pytest.skip("neither LinuxCNC nor Kerf takes the original")
    written = figures(out, tmp_path)
    assert written["accepted"], written["error"]
    # The post has corrected what LinuxCNC refuses: a missing end, a K word in XY, a cut without a feed.
    if not original["accepted"]:
        assert written["line"] + written["arc"] > 0
        return
    assert alike(written["cut_mm"], original["cut_mm"], original["line"] + original["arc"], unit_of(path))
    assert alike(written["rapid_mm"], original["rapid_mm"], original["rapid"], unit_of(path))
    assert written["line"] + written["arc"] == original["line"] + original["arc"]
    assert original["arc"] - written["arc"] == TINY_ARCS.get(path.name, 0)
    for mine, theirs in zip(written["cut_bounds_mm"], original["cut_bounds_mm"]):
        assert all(abs(a - b) < 0.01 for a, b in zip(mine, theirs)), (mine, theirs)


@pytest.mark.parametrize("post", ["grbl", "linuxcnc"])
@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_kerf_reads_what_it_writes(path, post, tmp_path):
    """Also the programs that LinuxCNC refuses."""
    out = tmp_path / "out.nc"
    assert written_by_kerf(path, post, out).returncode == 0
    before, after = info(path), info(out)
    moves = before["lines"] + before["arcs"]
    assert after["lines"] + after["arcs"] == moves
    assert before["arcs"] - after["arcs"] == TINY_ARCS.get(path.name, 0)
    assert math.isclose(after["cut_mm"], before["cut_mm"], rel_tol=1e-6, abs_tol=1e-4 * moves)
    assert math.isclose(after["rapid_mm"], before["rapid_mm"], rel_tol=1e-6, abs_tol=1e-3 * before["rapids"])
    for mine, theirs in zip(after["cut_bounds_mm"], before["cut_bounds_mm"]):
        assert all(abs(a - b) < 0.001 for a, b in zip(mine, theirs)), (mine, theirs)

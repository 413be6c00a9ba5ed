"""Given programs written again by the posts: LinuxCNC's interpreter takes them where it took the original,
and finds the same lengths, bounds and counts in them."""
import importlib.util
import json
import math
import os
import shutil
import subprocess
from pathlib import Path

import pytest

CASES = Path(os.environ.get("KERF_CASES_DIR") or "none", "gcode")
FILES = sorted(p for p in CASES.glob("*.*") if p.suffix in (".nc", ".ngc", ".gcode"))
if not FILES:
    pytest.skip("the given cases are not here (KERF_CASES_DIR)", allow_module_level=True)
if shutil.which("rs274") is None:
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)
# Programs with moves that no feed belongs to: LinuxCNC refuses them, and so does the post without --feed.
FEED = ["--feed", "500"]


def canon():
    spec = importlib.util.spec_from_file_location("canon", CASES / "canon.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def figures(path, folder):
    os.environ["TOOL_TBL"] = str(CASES / "tool.tbl")
    before = os.getcwd()
    os.chdir(folder)  # the interpreter keeps a file of parameters where it runs
    try:
        return canon().run(str(path), timeout=300)
    finally:
        os.chdir(before)


def original_figures(path, folder):
    given = json.loads((CASES / "expected.json").read_text()).get(path.name)
    return given if given and "accepted" in given else figures(path, folder)


# LinuxCNC prints four decimals, and programs have three or four. In chains of cuts that are hardly longer
# than the last decimal, each rounding adds to the length (camotics_vcarve: 4000 cuts of 0.014 mm, printed in
# inches); a tenth of the coarsest rounding is allowed for each move.
ROUNDING = 0.1 * 0.00254


def alike(a, b, moves):
    return math.isclose(a, b, rel_tol=1e-3, abs_tol=0.05 + ROUNDING * moves)


@pytest.mark.parametrize("post", ["grbl", "linuxcnc"])
@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_post(path, post, tmp_path):
    out = tmp_path / "out.nc"
    command = [os.environ["KERF"], "post", "--to", post, *FEED, str(path), "-o", str(out), "--json"]
    done = subprocess.run(command, capture_output=True, timeout=300)
    original = original_figures(path, tmp_path)
    if done.returncode != 0:
        assert not original["accepted"], done.stdout.decode() + done.stderr.decode()
        pytest.skip("neither LinuxCNC nor Kerf takes the original")
    written = figures(out, tmp_path)
    if not original["accepted"]:
        return
    assert written["accepted"], written["error"]
    assert alike(written["cut_mm"], original["cut_mm"], original["line"] + original["arc"])
    assert alike(written["rapid_mm"], original["rapid_mm"], original["rapid"])
    for mine, theirs in zip(written["cut_bounds_mm"], original["cut_bounds_mm"]):
        assert all(abs(a - b) < 0.01 for a, b in zip(mine, theirs)), (mine, theirs)

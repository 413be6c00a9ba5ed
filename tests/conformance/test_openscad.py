"""The echo tests of OpenSCAD 2021.01: what its programs print equals what it printed."""
import os
import subprocess
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
FOLDER = Path(os.environ.get("KERF_CASES_DIR", "")) / "openscad"
EXPECTED = {p.name.removesuffix("-expected.echo"): p for p in sorted(FOLDER.glob("expected/*.echo"))}
PROGRAMS = {p.stem: p for p in FOLDER.glob("testdata/**/*.scad")}
# Outputs without their program, and a program that measures in a drawing that is not there.
INCOMPLETE = {"echo", "import-FileDoesNotExist", "include-tests", "issue2342", "use-tests", "dim-all"}

pytestmark = pytest.mark.skipif(not EXPECTED, reason="needs the folder of cases")


def echoed(output):
    return [line for line in output.decode(errors="replace").splitlines() if line.startswith("ECHO:")]


@pytest.mark.parametrize("name", EXPECTED)
def test_prints_what_openscad_prints(name):
    if name in INCOMPLETE:
        pytest.skip("the cases lack an input of this test")
    program = PROGRAMS[name]
    done = subprocess.run([KERF, "run", program.name], cwd=program.parent, capture_output=True, timeout=120)
    assert done.returncode in (0, 1), done.stderr.decode(errors="replace")
    assert echoed(done.stdout) == echoed(EXPECTED[name].read_bytes())


def test_all_complete_programs_are_compared():
    assert len(EXPECTED) - len(INCOMPLETE) == 97

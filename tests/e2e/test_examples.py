"""The example programs in C++ and Python do what the command does, byte for byte."""
import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
PROGRAM = EXAMPLES / "plate.gcmc"
DEFINE = ["-D", "depth=3mm"]
RUNS = {
    "cxx": [Path(os.environ["KERF"]).parent / "examples" / "plate"],
    "python": [sys.executable, EXAMPLES / "python" / "plate.py"],
}


@pytest.fixture
def expected(kerf, tmp_path):
    """G-code, picture and number of steps as the command writes them."""
    assert kerf("post", "--to", "grbl", PROGRAM, *DEFINE, "-o", "kerf.nc").status == 0
    run = kerf("simulate", PROGRAM, *DEFINE, "--resolution", "0.2", "--view", "iso", "-o", "kerf.png")
    assert run.status == 0, run.err
    steps = kerf("info", "--json", PROGRAM, *DEFINE).json["steps"]
    return (tmp_path / "kerf.nc").read_text(), (tmp_path / "kerf.png").read_bytes(), steps


@pytest.mark.parametrize("language", RUNS)
def test_the_example_equals_the_command(language, expected, tmp_path):
    gcode, picture = tmp_path / "out.nc", tmp_path / "out.png"
    run = subprocess.run([*RUNS[language], PROGRAM, gcode, picture], capture_output=True, text=True,
                         timeout=120)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    assert run.stdout == f"{expected[2]} steps, about 0.3 minutes\n"
    # The command names the tool in a comment.
    assert [line for line in gcode.read_text().splitlines() if not line.startswith("(")] == [
        line for line in expected[0].splitlines() if not line.startswith("(")]
    assert picture.read_bytes() == expected[1]


@pytest.mark.parametrize("language", RUNS)
def test_the_example_reports_errors(language, tmp_path):
    bad = tmp_path / "bad.gcmc"
    bad.write_text("goto([1mm;\n")
    run = subprocess.run([*RUNS[language], bad, tmp_path / "a.nc", tmp_path / "a.png"], capture_output=True,
                         text=True, timeout=120)
    assert run.returncode != 0
    assert "bad.gcmc:1:" in run.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.gcmc"]

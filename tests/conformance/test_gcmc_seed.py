"""The six programs of the language's library, byte for byte as the real program wrote them, in every mode."""
import json
import os
import re
import subprocess
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
CASES = os.environ.get("KERF_CASES_DIR", "")
SEED = Path(CASES, "gcmc", "seed")
pytestmark = pytest.mark.skipif(not CASES or not SEED.is_dir(),
                                reason="KERF_CASES_DIR names no folder of cases; skipped")

PROGRAMS = ["canned", "engrave", "tracepath", "tracepath_comp", "varcs", "vbezier"]
MODES = {".ngc": [], ".imperial.ngc": ["-i"], ".relative.ngc": ["-r"], ".P4q.ngc": ["-P4", "-q"],
         ".svg": ["--svg"], ".dxf": ["--dxf"]}
# The real program's drawings of three of them were not recorded, nor a DXF of the engraving.
RECORDED = [(p, m) for p in PROGRAMS for m in MODES
            if m.endswith(".ngc") or p in ("canned", "tracepath") or (p, m) == ("engrave", ".svg")]
LAST_DIGIT = 1.01e-8  # of the eight decimals: another order of additions may round it the other way
NUMBER = re.compile(r"-?\d+\.\d+")


def is_date(line):
    return re.fullmatch(r"\(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\)", line) or line.startswith("<!-- Created with ")


def differs_in_last_digits(got, wanted):
    if NUMBER.sub("#", got) != NUMBER.sub("#", wanted):
        return False
    pairs = zip(NUMBER.findall(got), NUMBER.findall(wanted))
    return all(abs(float(a) - float(b)) <= LAST_DIGIT for a, b in pairs)


@pytest.mark.parametrize("version", [[], ["--compat", "1.8"], ["--compat", "1.9"]])
@pytest.mark.parametrize("program, mode", RECORDED)
def test_output_is_the_real_one(program, mode, version):
    run = subprocess.run([KERF, "gcmc", *MODES[mode], *version, f"{program}.gcmc"], cwd=SEED,
                         capture_output=True, timeout=60)
    assert run.returncode == 0
    got = run.stdout.decode().split("\n")
    wanted = (SEED / f"{program}{mode}").read_bytes().decode().split("\n")
    assert len(got) == len(wanted)
    rounded = 0
    for line, (a, b) in enumerate(zip(got, wanted), 1):
        if a == b or (is_date(a) and is_date(b)):
            continue
        assert differs_in_last_digits(a, b), f"line {line}: {a!r}, wanted {b!r}"
        rounded += 1
    assert rounded <= 2


def lines_of(text):
    """Lines of output and messages without positions, which were recorded in no fixed order."""
    return sorted(re.sub(r"^[^\s:]+:\d+:\d+: ", "", line) for line in text.splitlines() if line.strip())


@pytest.mark.parametrize("words", ["plane(PLANE_XZ); arc_cw([10,-,0],6)", "circle_ccw([5,0,3])",
                                   "arc_cw_r([2,-],1)"])
def test_arcs_of_version_1_8_are_the_recorded_ones(tmp_path, words):
    probes = json.loads((SEED.parent / "probes.json").read_text())
    recorded = next(p for p in probes if words in p["program"])
    (tmp_path / "one.gcmc").write_text(recorded["program"] + "\n")
    run = subprocess.run([KERF, "gcmc", "-q", "-P4", "--compat", "1.8", "one.gcmc"], cwd=tmp_path,
                         capture_output=True, text=True, timeout=60)
    assert run.returncode == recorded["rc"]
    assert lines_of(run.stderr + run.stdout) == lines_of(recorded["output"])

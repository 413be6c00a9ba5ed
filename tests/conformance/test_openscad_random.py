"""Random OpenSCAD programs print what the installed openscad 2021.01 prints; see random_scad.py."""
import os
import shutil
import subprocess

import pytest
import random_scad

KERF = os.environ["KERF"]
LONG = bool(os.environ.get("KERF_LONG"))
FIRST = 1


def is_there():
    if not shutil.which("openscad"):
        return False
    done = subprocess.run(["openscad", "--version"], capture_output=True, text=True, timeout=60)
    return "2021.01" in done.stdout + done.stderr


pytestmark = pytest.mark.skipif(not is_there(), reason="needs openscad 2021.01")


def test_expressions_print_what_openscad_prints(tmp_path):
    seeds = range(FIRST, FIRST + (4000 if LONG else 200))
    assert random_scad.differing(KERF, tmp_path, seeds,
                                 lambda seed: {"x.scad": random_scad.expressions(seed, 1)}) == []


def test_programs_print_what_openscad_prints(tmp_path):
    seeds = range(FIRST, FIRST + (500 if LONG else 100))
    assert random_scad.differing(KERF, tmp_path, seeds, random_scad.program) == []

"""Type checkers: correct code passes `mypy --strict`, each mistake of typing/mistakes.py is reported."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

import kerf

pytest.importorskip("mypy", reason="mypy is not installed")

HERE = pathlib.Path(__file__).parent / "typing"
MODULES = pathlib.Path(kerf.__file__).parents[1]


def checked(file, folder):
    """{line: message} of the errors in a file; as of installed modules, none of those inside of Kerf."""
    environment = {k: v for k, v in os.environ.items() if k != "MYPYPATH"}
    if "site-packages" not in str(MODULES) and "dist-packages" not in str(MODULES):
        environment["MYPYPATH"] = str(MODULES)
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--no-error-summary"]
    done = subprocess.run(
        [*command, "--cache-dir", folder / "cache", file],
        capture_output=True,
        text=True,
        cwd=folder,
        env=environment,
        timeout=280,
    )
    assert not done.stderr, done.stderr
    found = re.findall(rf"{re.escape(file.name)}:(\d+): error: (.*)", done.stdout)
    return {int(line): message for line, message in found}


def test_correct_code_passes(tmp_path):
    assert checked(HERE / "user_code.py", tmp_path) == {}


def test_each_mistake_is_reported_at_its_line(tmp_path):
    lines = (HERE / "mistakes.py").read_text().splitlines()
    wrong = {i for i, line in enumerate(lines, 1) if line.endswith("# wrong")}
    assert len(wrong) >= 60
    found = checked(HERE / "mistakes.py", tmp_path)
    assert set(found) == wrong, {lines[i - 1]: found.get(i) for i in set(found) ^ wrong}


@pytest.mark.parametrize("name", ["kerf", "gcodepreview", "kerf_cam", "cnc25d_api"])
def test_packages_state_that_they_have_types(name):
    assert (MODULES / name / "py.typed").exists()

"""Type checkers: correct code passes mypy and pyright, both strict; each mistake is reported by both."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import kerf

HERE = pathlib.Path(__file__).parent / "typing"
MODULES = pathlib.Path(kerf.__file__).parents[1]
INSTALLED = "site-packages" in str(MODULES) or "dist-packages" in str(MODULES)


def of_mypy(file, folder):
    """{line: message} of the errors in a file; as of installed modules, none of those inside of Kerf."""
    environment = {k: v for k, v in os.environ.items() if k != "MYPYPATH"}
    if not INSTALLED:
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


def of_pyright(file, folder):
    """As of mypy. That a value is not used is no mistake of its types."""
    shutil.copy(file, folder)
    settings = {"include": ["."], "typeCheckingMode": "strict", "reportUnusedExpression": False}
    if not INSTALLED:
        settings["extraPaths"] = [str(MODULES)]
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "--outputjson"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=280)
    try:
        report = json.loads(done.stdout)
    except ValueError:
        pytest.fail(done.stdout + done.stderr)
    assert report["summary"]["filesAnalyzed"] == 1
    found = [found for found in report["generalDiagnostics"] if found["severity"] == "error"]
    return {entry["range"]["start"]["line"] + 1: entry["message"] for entry in found}


@pytest.fixture(params=["mypy", "pyright"])
def checked(request):
    pytest.importorskip(request.param, reason=f"{request.param} is not installed")
    return of_mypy if request.param == "mypy" else of_pyright


def test_correct_code_passes(checked, tmp_path):
    assert len((HERE / "user_code.py").read_text().splitlines()) > 290
    assert checked(HERE / "user_code.py", tmp_path) == {}


def test_each_mistake_is_reported_at_its_line(checked, tmp_path):
    lines = (HERE / "mistakes.py").read_text().splitlines()
    wrong = {i for i, line in enumerate(lines, 1) if line.endswith("# wrong")}
    assert len(wrong) >= 60
    found = checked(HERE / "mistakes.py", tmp_path)
    assert set(found) == wrong, {lines[i - 1]: found.get(i) for i in set(found) ^ wrong}


@pytest.mark.parametrize("name", ["kerf", "gcodepreview", "kerf_cam", "cnc25d_api"])
def test_packages_state_that_they_have_types(name):
    assert (MODULES / name / "py.typed").exists()

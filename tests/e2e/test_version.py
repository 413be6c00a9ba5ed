"""One file has the version; all others read it."""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
VERSION = (ROOT / "VERSION").read_text().strip()
MODULES = Path(os.environ["KERF"]).resolve().parent / "python"

try:
    import tomllib
except ImportError:
    tomllib = None


def test_the_command_states_version_build_and_features(kerf):
    run = kerf("--version")
    assert run.status == 0
    version, build, features = run.out.splitlines()
    assert version == f"kerf {VERSION}"
    assert re.fullmatch(r"build: (GCC|Clang) [\d.]+, \w+, \w+ \w+(, sanitizers \S+)?, "
                        r"commit (unknown|[0-9a-f]{7,40}(-dirty)?)", build)
    modules = r"Python modules (by the interpreter|in .+)"
    assert re.fullmatch(rf"features: (full|simple) page of kerf view, {modules}", features)
    assert run.out == kerf("--version").out


def test_no_date_is_in_the_version(kerf):
    assert not re.search(r"20\d\d|\d\d:\d\d", re.sub(r"commit \S+", "", kerf("--version").out))


@pytest.mark.skipif(not list(MODULES.glob("kerf/_kerf.*.so")), reason="built without the Python modules")
def test_the_module_has_the_same_version():
    words = [sys.executable, "-c", "import kerf; print(kerf.__version__)"]
    environment = {**os.environ, "PYTHONPATH": str(MODULES)}
    done = subprocess.run(words, env=environment, capture_output=True, text=True)
    assert done.stdout.strip() == VERSION, done.stderr


def test_written_programs_have_the_same_version(kerf, program):
    assert f"Kerf {VERSION}" in kerf("post", "--to", "grbl", program()).out


@pytest.mark.skipif(tomllib is None, reason="Python 3.11 reads TOML")
def test_the_python_package_takes_its_version_from_the_file():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert project["project"]["name"] == "kerf-cam"
    assert "version" not in project["project"] and "version" in project["project"]["dynamic"]
    source = project["tool"]["scikit-build"]["metadata"]["version"]
    assert source["provider"] == "scikit_build_core.metadata.regex" and source["input"] == "VERSION"
    assert re.search(source["regex"], (ROOT / "VERSION").read_text())["value"] == VERSION


def test_the_page_has_no_version_of_its_own():
    package = json.loads((ROOT / "web" / "package.json").read_text())
    lock = json.loads((ROOT / "web" / "package-lock.json").read_text())
    assert package["private"]
    for texts in (package, lock, lock["packages"][""]):
        assert texts.get("version", VERSION) == VERSION


@pytest.mark.parametrize("name", ["README.md", "CMakeLists.txt", "cmake/KerfPackage.cmake", "pyproject.toml"])
def test_no_other_file_states_it(name):
    assert VERSION not in (ROOT / name).read_text()

"""The installed command: its files below a prefix, as in the Debian package, without the build folder."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

BUILD = Path(os.environ["KERF"]).resolve().parent
MODULES = sorted((BUILD / "python" / "kerf").glob("_kerf.*.so"))
COMPONENTS = ("app", "python", "doc")


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    if not (BUILD / "cmake_install.cmake").exists() or shutil.which("cmake") is None:
        pytest.skip("the command is not in its build folder, or CMake is missing")
    folder = tmp_path_factory.mktemp("prefix")
    for component in COMPONENTS:
        words = ["cmake", "--install", BUILD, "--prefix", folder, "--component", component]
        subprocess.run(words, check=True, capture_output=True)
    return folder


def run(prefix, folder, *words):
    """The installed command with nothing of the build on its path."""
    kept = {name: value for name, value in os.environ.items() if name not in ("KERF", "PYTHONPATH")}
    return subprocess.run([prefix / "bin" / "kerf", *words], cwd=folder, capture_output=True, text=True,
                          env={**kept, "KERF_PYTHON": sys.executable}, timeout=300)


def test_the_example_and_the_manual_are_installed(prefix, tmp_path):
    doc = prefix / "share" / "doc" / "kerf"
    pages = ("README.md", "copyright", "NOTICE", "docs/manual/command.md", "docs/manual/pictures/demo.png")
    for page in pages:
        assert (doc / page).is_file(), page
    assert not list(doc.rglob("*.pyc"))
    done = run(prefix, tmp_path, "simulate", doc / "examples" / "demo.nc", "-o", "demo.png")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG")
    # Posts, the tool table and the library of gcmc are in the command.
    assert "grbl" in run(prefix, tmp_path, "post", "--list").stdout
    plate = run(prefix, tmp_path, "post", "--to", "grbl", doc / "examples" / "plate.gcmc", "-o", "plate.nc")
    assert plate.returncode == 0, plate.stderr


@pytest.mark.skipif(not MODULES, reason="built without the Python modules")
def test_scripts_find_the_modules(prefix, tmp_path):
    (tmp_path / "part.py").write_text("import kerf, gcodepreview, cnc25d_api\nprint(kerf.__file__)\n")
    done = run(prefix, tmp_path, "run", "part.py")
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()).parents[1] == prefix / "lib" / "kerf" / "python"

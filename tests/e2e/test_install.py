"""The installed command: its files below a prefix, as in the Debian package, without the build folder."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

BUILD = Path(os.environ["KERF"]).resolve().parent
MODULES = sorted((BUILD / "python" / "kerf").glob("_kerf.*.so"))
COMPONENTS = ("app", "python", "doc", "data", "shell")


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


def test_links_of_the_documents_lead_to_documents(prefix):
    doc = prefix / "share" / "doc" / "kerf"
    pages = list(doc.rglob("*.md"))
    assert len(pages) > 50
    wrong = [f"{page.relative_to(doc)}: {link}" for page in pages
             for link in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text())
             if not re.match(r"\w+:", link) and not (page.parent / link).exists()]
    assert not wrong


def test_the_shell_finds_pages_and_completions(prefix):
    shared = prefix / "share"
    pages = {page.name for page in (shared / "man" / "man1").iterdir()}
    assert {"kerf.1.gz", "kerf-simulate.1.gz", "kerf-tools-show.1.gz", "kerf-pathdxf.1.gz"} <= pages
    for name in ("bash-completion/completions/kerf", "zsh/vendor-completions/_kerf",
                 "fish/vendor_completions.d/kerf.fish"):
        assert "simulate" in (shared / name).read_text()
    for name in ("kerf/machines/grbl_router.toml", "kerf/posts/grbl.toml",
                 "kerf/editors/gcmc.tmLanguage.json", "icons/hicolor/scalable/apps/kerf.svg"):
        assert (shared / name).is_file(), name


def test_the_desktop_entry_names_types_that_exist(prefix):
    shared = prefix / "share"
    entry = (shared / "applications" / "kerf.desktop").read_text()
    types = re.search(r"^MimeType=(.*)$", entry, re.M)[1].rstrip(";").split(";")
    own = re.findall(r'<mime-type type="([^"]+)"', (shared / "mime" / "packages" / "kerf.xml").read_text())
    assert {"text/x-gcode", "text/x-gcmc"} <= set(own) & set(types)
    command = re.search(r"^Exec=kerf (\w+) (--\w+) %f$", entry, re.M)
    words = [prefix / "bin" / "kerf", command[1], "--help"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert command[2] in done.stdout


@pytest.mark.skipif(not MODULES, reason="built without the Python modules")
def test_scripts_find_the_modules(prefix, tmp_path):
    script = "import kerf, gcodepreview, cnc25d_api, openscad\nprint(kerf.__file__)\n"
    (tmp_path / "part.py").write_text(script)
    done = run(prefix, tmp_path, "run", "part.py")
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()).parents[1] == prefix / "lib" / "kerf" / "python"

"""The examples of the manual run: the blocks of a page one after another, as a reader would enter them."""

import pathlib
import re

import pytest

import kerf

MANUAL = pathlib.Path(__file__).parents[2] / "docs" / "manual"
TOOLS = """[[tool]]
number = 102
shape = "square"
diameter = 3.175
flute = 12.7
"""


def blocks(page):
    text = (MANUAL / page).read_text(encoding="utf-8")
    return [
        (text[: m.start()].count("\n") + 2, m[1])
        for m in re.finditer(r"^```python\n(.*?)^```", text, re.M | re.S)
    ]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])
    return tmp_path


def run(page, names):
    found = blocks(page)
    assert found, page
    for line, text in found:
        # The line numbers of the page, for messages.
        exec(compile("\n" * (line - 1) + text, str(MANUAL / page), "exec"), names)
    return names


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_page_of_python(folder):
    (folder / "shop.toml").write_text(TOOLS)
    names = {"__name__": "manual"}
    run("python.md", names)
    assert (folder / "part.glb").stat().st_size > 1000
    # Two by two copies of a part of 60 by 40 mm with a path 3 mm around it.
    assert "X -3 to 143 Y -3 to 103 Z -7" in (folder / "panel.nc").read_text()
    assert names["png"].startswith(b"\x89PNG")
    # A circle of 8 mm, grown by 3 mm.
    assert names["ring"].area == pytest.approx(3.14159265 * 11**2, rel=1e-4)
    assert names["changed"], "the moved program cuts other columns"


def test_the_page_of_operations(folder):
    run("operations.md", {"kerf": kerf})
    assert (folder / "plate.nc").exists()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_page_of_gcodepreview(folder):
    run("gcodepreview.md", {"__name__": "manual"})
    assert (folder / "plate.nc").exists() and (folder / "plate.dxf").exists()

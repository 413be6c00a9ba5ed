"""The example notebook runs, and its cells show job, path and part."""

import base64
import html
import pathlib
import re
import subprocess
import sys
import zlib

import pytest

import kerf
import kerf_cam

NOTEBOOK = pathlib.Path(__file__).parents[2] / "examples" / "python" / "plate.ipynb"


def test_the_notebook_runs(tmp_path):
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    import nbformat

    done = subprocess.run(
        [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", tmp_path]
        + ["--output", "run.ipynb", NOTEBOOK],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    book = nbformat.read(tmp_path / "run.ipynb", 4)
    cells = [cell for cell in book.cells if cell.cell_type == "code"]
    shown = [{kind for out in cell.outputs for kind in out.get("data", {})} for cell in cells]
    assert "text/html" in shown[0]
    assert "image/svg+xml" in shown[1]
    assert {"image/png", "text/html"} <= shown[2]
    assert "image/png" in shown[3]
    assert cells[4].outputs[0]["text"].startswith("[]")
    assert all(not cell.outputs for cell in nbformat.read(NOTEBOOK, 4).cells if cell.cell_type == "code")


@pytest.fixture
def part():
    program = kerf.op.pocket(
        kerf.Region([(30, 20, 12)]), "square d=6", depth=4, stepdown=2, feed=900, rpm=9000, name="the pocket"
    )
    return kerf.simulate(program, kerf.Stock.block((60, 40, 10)))


def test_a_part_is_shown_as_the_page_of_the_viewer(part):
    try:
        kerf_cam.command()
    except FileNotFoundError:
        pytest.skip("built without the command")
    shown = part._repr_html_()
    frame = re.fullmatch(r".*<iframe ([^>]*)></iframe></div></div>", shown, re.S)[1]
    assert 'sandbox="allow-scripts' in frame and "allow-same-origin" not in frame
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', frame)[1])
    assert page.lstrip().lower().startswith("<!doctype html>")
    model = re.search(r'id="kerf-model"[^>]*>([^<]*)<', page)[1]
    assert b"the pocket" in zlib.decompress(base64.b64decode(model))
    # Without scripts, and where frames are removed: the picture.
    picture = re.search(r'<img [^>]*src="data:image/png;base64,([^"]*)"/>', shown)[1]
    assert base64.b64decode(picture) == part._repr_png_()
    assert "<body><noscript><img" in page and picture in page
    assert kerf.page(part).count("<noscript><img") == 0


def test_a_part_is_shown_as_a_picture_without_the_command(part, monkeypatch):
    def missing():
        raise FileNotFoundError("the command kerf was not built with these modules")

    monkeypatch.setattr(kerf_cam, "command", missing)
    shown = part._repr_html_()
    assert "<iframe" not in shown and "<img" in shown
    with pytest.raises(FileNotFoundError, match="command"):
        kerf.page(part)


def test_a_page_that_is_too_large_is_a_picture(part, monkeypatch):
    monkeypatch.setattr("kerf._notebook._LARGEST_PAGE", 1000)
    assert "<iframe" not in part._repr_html_()


def test_a_program_shows_its_figures_and_its_path():
    program = kerf.read_gcode("G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30\nM2\n", "part.nc")
    assert "<th>X</th><td>0.000 to 30.000 mm</td>" in program._repr_html_()
    assert program._repr_svg_().lstrip().startswith("<?xml")

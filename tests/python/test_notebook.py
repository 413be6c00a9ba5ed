"""The example notebooks run, and their cells show job, path and part."""

import base64
import html
import json
import pathlib
import re
import subprocess
import sys
import zlib

import pytest

import kerf
import kerf_cam

GALLERY = pathlib.Path(__file__).parents[2] / "examples" / "python"
NAMES = ["plate", "sign", "box", "relief", "pcb", "sweep"]


def run(name, folder):
    """The cells of code of a notebook after it ran."""
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    import nbformat

    done = subprocess.run(
        [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder]
        + ["--output", "run.ipynb", GALLERY / f"{name}.ipynb"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    book = nbformat.read(folder / "run.ipynb", 4)
    return [cell for cell in book.cells if cell.cell_type == "code"]


def kinds(cell):
    return {kind for out in cell.outputs for kind in out.get("data", {})}


def printed(cell):
    return "".join(out["text"] for out in cell.outputs if out.get("name") == "stdout")


def test_the_gallery_is_complete():
    assert sorted(path.stem for path in GALLERY.glob("*.ipynb")) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_are_stored_without_outputs(name):
    book = json.loads((GALLERY / f"{name}.ipynb").read_text(encoding="utf-8"))
    cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 3 and book["cells"][0]["cell_type"] == "markdown"
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)


def test_the_sign(tmp_path):
    region, job, part, figures = run("sign", tmp_path)
    assert "image/svg+xml" in kinds(region) and "text/html" in kinds(job)
    assert {"image/png", "text/html"} <= kinds(part)
    assert printed(figures).startswith("[]\n")


def test_the_box(tmp_path):
    board, joint, part = run("box", tmp_path)
    assert "image/svg+xml" in kinds(board)
    # Nothing overlaps, and nothing is left open.
    assert [float(word) for word in printed(joint).split()] == pytest.approx([0, 0], abs=1e-6)
    assert "image/png" in kinds(part)


def test_the_relief(tmp_path):
    _, job, part, volume = run("relief", tmp_path)
    assert "text/html" in kinds(job) and "image/png" in kinds(part)
    # The mean of the surface is -2 mm, or nearly so, over 40 x 30 mm.
    assert float(printed(volume).split()[0]) == pytest.approx(2.4, abs=0.3)


def test_the_circuit_board(tmp_path):
    copper, job, part, figures = run("pcb", tmp_path)
    assert "image/svg+xml" in kinds(copper) and "text/html" in kinds(job) and "image/png" in kinds(part)
    # Pads 1 and 4 have a track of their own, pad 2 a short one, pad 3 none.
    assert printed(figures) == "3 nets; 0 findings\n"


def test_the_sweep(tmp_path):
    _, table, best = run("sweep", tmp_path)
    assert table.outputs[0]["data"]["text/html"].count("<tr>") == 7
    assert printed(best).split() == ["8", "0.5"]


def test_the_plate(tmp_path):
    cells = run("plate", tmp_path)
    shown = [kinds(cell) for cell in cells]
    assert "text/html" in shown[0]
    assert "image/svg+xml" in shown[1]
    assert {"image/png", "text/html"} <= shown[2]
    assert "image/png" in shown[3]
    assert printed(cells[4]).startswith("[]")


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

"""The example notebook runs, and its cells show job, path and part."""

import pathlib
import subprocess
import sys

import pytest

pytest.importorskip("nbconvert")
pytest.importorskip("ipykernel")
NOTEBOOK = pathlib.Path(__file__).parents[2] / "examples" / "python" / "plate.ipynb"


def test_the_notebook_runs(tmp_path):
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

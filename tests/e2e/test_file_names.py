"""Names of files beyond ASCII, and on Linux names that are no text: files are read and written by them, and
files beside them are found."""
import os

import pytest
from conftest import VALID

TEXTS = [b"plain", "\u00e4 \u00f6".encode(), "\u65e5\u672c".encode(), "\U0001f529".encode()]
JOB = """art = "{name}.svg"
unit = "mm"

[tools]
1 = "square d=3"

[[operation]]
op = "engrave"
tool = 1
depth = 1
feed = 300
rpm = 10000
"""
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20">' \
      '<path d="M5 5 L15 5" stroke="black" fill="none"/></svg>\n'


@pytest.fixture(params=[*TEXTS, b"\xff\xc3"], ids=ascii)
def name(request, tmp_path):
    """A name without ending, in a folder of the same name."""
    try:
        os.mkdir(os.path.join(os.fsencode(tmp_path), request.param))
    except OSError:
        pytest.skip("the file system has no such names")
    return os.fsdecode(os.path.join(request.param, request.param))


def test_programs_and_outputs(kerf, tmp_path, name):
    (tmp_path / f"{name}.nc").write_text(VALID)
    assert kerf("simulate", "-q", f"{name}.nc", "-o", f"{name}.stl", "-o", f"{name}.png").status == 0
    assert kerf("post", "-q", f"{name}.nc", "--to", "grbl", "-o", f"{name}-grbl.nc").status == 0
    folder = (tmp_path / name).parent
    ends = {file.name[len(folder.name):] for file in folder.iterdir()}
    assert ends == {".nc", ".stl", ".png", "-grbl.nc"}  # and no temporary file
    assert kerf("check", "-q", f"{name}-grbl.nc").status == 0


@pytest.mark.parametrize("name", TEXTS, ids=ascii, indirect=True)
def test_a_job_finds_the_drawing_beside_it(kerf, tmp_path, name):
    (tmp_path / f"{name}.toml").write_text(JOB.format(name=os.path.basename(name)), encoding="utf-8")
    (tmp_path / f"{name}.svg").write_text(SVG)
    assert kerf("cut", f"{name}.toml", "-o", f"{name}.nc").status == 0
    assert "X15" in (tmp_path / f"{name}.nc").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", TEXTS, ids=ascii, indirect=True)
def test_included_files(kerf, tmp_path, name):
    text = f'include("{os.path.basename(name)}.inc");\ngoto([0mm, 0mm, 5mm]);\nfeedrate(100mm);\n'
    (tmp_path / f"{name}.gcmc").write_text(text + "move([depth, 0mm, -1mm]);\n", encoding="utf-8")
    (tmp_path / f"{name}.inc").write_text("depth = 7mm;\n")
    assert kerf("gcmc", "-q", "-I", os.path.dirname(name), "-o", f"{name}.nc", f"{name}.gcmc").status == 0
    assert "X7.0" in (tmp_path / f"{name}.nc").read_text(encoding="utf-8")

"""A program that is interrupted at any line and resumed there removes the same material as the whole."""
import random

import pytest

RESOLUTION = ("--resolution", "0.2")


@pytest.mark.parametrize("op", ["pocket", "contour"])
def test_ten_lines(kerf, tmp_path, op):
    (tmp_path / "job.toml").write_text(kerf("cut", "--example", op).out)
    tool = ("--tool", "1=square d=6")
    assert kerf("cut", "job.toml", "-o", "part.nc").status == 0
    lines = (tmp_path / "part.nc").read_text().splitlines(keepends=True)
    stock = ("--stock", "-8,-8,-8 to 68,48,0")
    assert kerf("simulate", "part.nc", *stock, *tool, *RESOLUTION, "-o", "whole.kstock").status == 0
    whole = (tmp_path / "whole.kstock").read_bytes()
    motions = [i for i, line in enumerate(lines) if line.startswith(("G1", "G2", "G3", "X", "Y", "I"))]
    for index in random.Random(15).sample(motions, 10):
        (tmp_path / "first.nc").write_text("".join(lines[:index]) + "M2\n")
        first = kerf("simulate", "--json", "first.nc", *stock, *tool, *RESOLUTION, "-o", "first.kstock")
        assert first.status == 0, first.err + first.out
        here = ("--from-line", str(index + 1), "--safe-z", "5")
        resumed = kerf("post", "--to", "grbl", *here, "part.nc", "-o", "rest.nc")
        assert resumed.status == 0, resumed.err
        left = ("--stock-left", "first.kstock")
        rest = kerf("simulate", "--json", "rest.nc", *left, *tool, "-o", "rest.kstock")
        assert rest.status == 0, rest.err
        assert rest.json["hazards"] == [], lines[index]
        assert (tmp_path / "rest.kstock").read_bytes() == whole, lines[index]

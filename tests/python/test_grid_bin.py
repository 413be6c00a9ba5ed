"""The example of a printed bin: its figures against those computed by hand from its dimensions."""
import math
import runpy
import sys
from pathlib import Path

import kerf
import numpy
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "python" / "grid_bin.py"
WIDTH, HEIGHT, LENGTH, DEPTH, RADIUS, TOP = 1.2, 0.4, 99.95, 199.95, 6.85, 13.2


@pytest.fixture(scope="module")
def bin_(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bin")
    argv, sys.argv = sys.argv, ["grid_bin.py", str(folder / "bin.gcode"), str(folder / "bin.png")]
    try:
        names = runpy.run_path(str(EXAMPLE))
    finally:
        sys.argv = argv
    return names["printer"], names["printed"], folder


def area(inset):
    """Of the rounded rectangle, `inset` smaller on all sides."""
    return (LENGTH - 2 * inset) * (DEPTH - 2 * inset) - (4 - math.pi) * (RADIUS - inset) ** 2


def solid():
    """Volume of the bin without any gap: two solid layers, then walls of two beads and of one."""
    volume, taper = 0.0, 0.4 * WIDTH
    pitch = WIDTH - 0.08 * HEIGHT  # of the beads
    for layer in range(1, round(TOP / HEIGHT) + 1):
        thickness = WIDTH + pitch if layer < 5 else WIDTH
        hole = 0.0 if layer <= 2 else area(taper + thickness)
        volume += HEIGHT * (area(taper) - hole)
        taper = max(taper - WIDTH * HEIGHT / 2, 0)
    return volume


def test_it_is_written_in_thirty_lines():
    text = EXAMPLE.read_text().split('"""')[2]
    assert sum(1 for line in text.splitlines() if line.strip()) <= 30


def test_no_overlap_beyond_two_percent_and_no_hazard(bin_):
    _, printed, _ = bin_
    total = printed.total
    assert total["overlap_mm3"] < 0.02 * total["extruded_mm3"]
    for layer in printed.layers:
        assert layer["overlap_mm3"] < 0.02 * layer["extruded_mm3"], layer
    assert printed.hazards == [] and total["blobs_mm3"] == 0


def test_the_beads_fill_the_bin_but_for_the_gaps_between_their_round_sides(bin_):
    _, printed, _ = bin_
    # Of a cell of one bead, pitch x height, a bead leaves this fraction open.
    pitch = WIDTH - 0.08 * HEIGHT
    bead = (WIDTH - HEIGHT) * HEIGHT + math.pi * (HEIGHT / 2) ** 2
    assert printed.total["laid_mm3"] / solid() == pytest.approx(bead / (pitch * HEIGHT), abs=0.015)
    # With gaps up to the height of a bead closed, only round sides and the grooves at the top are open.
    points, triangles, *_ = (numpy.asarray(part) for part in printed.mesh())
    a, b, c = (points[triangles[:, i]].astype(float) for i in range(3))
    volume = numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6
    assert volume == pytest.approx(solid(), rel=0.03)


def test_the_files(bin_):
    printer, _, folder = bin_
    assert (folder / "bin.png").read_bytes().startswith(b"\x89PNG")
    read = kerf.load(folder / "bin.gcode")
    assert kerf.check(read) == []
    assert kerf.simulate_print(read).total["extruded_mm3"] == pytest.approx(printer.printed_mm3, rel=1e-3)

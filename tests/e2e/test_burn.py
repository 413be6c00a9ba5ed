"""kerf simulate --show burn: energies computed by hand, and the picture."""
import math

import pytest
from test_first_try import pixels

# 2.5 W at 20 mm/s for 40 mm: 2 s, 5 J; then the same line again at twice the speed: 1 s, 2.5 J.
ENGRAVING = """; LightBurn 1.4
G21 G90
M4 S0
G0 X0 Y0
G1 X40 S500 F1200
G0 X0
G1 X40 S500 F2400
M5
M2
"""
LASER = ["--show", "burn", "--spot", "0.2", "--max-power", "5", "--max-s", "1000"]


def test_figures_are_those_computed_by_hand(kerf, program, files):
    run = kerf("simulate", "--json", program(ENGRAVING), *LASER)
    assert run.status == 0, run.err
    burn = run.json["burn"]
    assert burn["energy_j"] == pytest.approx(7.5, rel=1e-9)
    assert burn["beam_s"] == pytest.approx(3.0, rel=1e-9)
    centre = 4 / (math.pi * 0.2) * (2.5 / 20 + 2.5 / 40)  # J/mm2
    assert burn["highest_j_mm2"] == pytest.approx(centre, rel=1e-4)
    assert burn["burnt_mm2"] == pytest.approx(40 * 0.2, rel=0.05)
    assert burn["highest_at"][1] == pytest.approx(0, abs=0.01)
    assert files() == ["part.nc"]
    text = kerf("simulate", program(ENGRAVING), *LASER).out
    assert "7.5 J" in text and "3 s" in text


def test_the_picture_is_dark_along_the_cuts(kerf, program, folder_bytes):
    two_lines = program(ENGRAVING.replace("G0 X0\n", "G0 X0 Y20\n"))
    run = kerf("simulate", two_lines, "--show", "burn", "--spot", "1", "-o", "burn.png", "--size", "400x300")
    assert run.status == 0, run.err
    width, height, rows = pixels(folder_bytes()["burn.png"])
    assert (width, height) == (400, 300)
    sums = [sum(sum(p[:3]) for p in row) for row in rows]
    upper, lower = min(sums[:150]), min(sums[150:])
    assert lower < upper < 0.98 * max(sums)  # at twice the speed the upper line is lighter


@pytest.mark.parametrize("arguments, status, name", [
    (["-o", "burn.stl"], 1, "output_kind_unknown"),
    (["--spot", "0"], 2, "usage"),
    (["--max-power", "nan"], 2, "usage"),
    (["--max-s", "-1"], 2, "usage"),
])
def test_what_is_refused(kerf, program, files, arguments, status, name):
    run = kerf("simulate", "--json", program(ENGRAVING), "--show", "burn", *arguments)
    assert run.status == status and name in run.codes()
    assert files() == ["part.nc"]


def test_a_program_without_a_beam(kerf, program):
    run = kerf("simulate", "--json", program(), "--show", "burn")
    assert run.status == 1 and "nothing_to_cut" in run.codes()


def test_options_without_effect_are_reported(kerf, program):
    run = kerf("simulate", "--json", program(), "--spot", "0.2")
    assert run.status == 0 and "option_unused" in run.codes()
    run = kerf("simulate", "--json", program(ENGRAVING), "--show", "burn", "--stock", "50x50x3")
    assert run.status == 0 and "option_unused" in run.codes()

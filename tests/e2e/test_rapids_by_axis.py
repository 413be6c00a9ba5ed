"""Rapids whose axes move each at its own rate: the closed form of their path, against fixtures and stock."""
import pytest

RATES = "rate = [{}]\nrapids = \"{}\"\n"
PART = """G21 G90 G17
T1 M6
M3 S9000
G0 X0 Y0 Z5
G0 X100 Y50 Z{z}
G1 Z-1 F300
G0 Z20
M2
"""
TOOL = ("--tool", "1=square d=2 flute=10")


def contacts(kerf, program, machine, fixture, z=5):
    done = kerf("check", "--json", program(PART.format(z=z)), *TOOL, "--stock", "90,40,-9 to 110,60,0",
                "--machine", program(machine, "machine.toml"), "--fixture", fixture)
    return [found["kind"] for found in done.json["hazards"] if found["kind"] == "fixture_contact"]


@pytest.mark.parametrize("rates, at", [
    ("1000, 1000, 1000", (75, 50)),     # 45 degrees to (50, 50), then along X
    ("2000, 1000, 1000", (75, 37.5)),   # both arrive together: straight
    ("4000, 1000, 1000", (100, 37.5)),  # X arrives at (100, 25), then along Y
    ("1000, 2000, 1000", (60, 50)),     # Y arrives at (25, 50)
])
def test_contacts_are_those_of_the_path_with_corners(kerf, program, rates, at):
    x, y = at
    post = f"{x - 0.5},{y - 0.5},0 to {x + 0.5},{y + 0.5},10"
    straight = abs(y - x / 2) < 1
    assert bool(contacts(kerf, program, RATES.format(rates, "by-axis"), post))
    assert bool(contacts(kerf, program, RATES.format(rates, "straight"), post)) == straight


def test_height_is_an_axis_too(kerf, program):
    """Z goes down from 5 to 0.5 in a twentieth of the time of X, and is lower than on a straight way."""
    wall = "50,20,0 to 51,30,2"
    assert contacts(kerf, program, RATES.format("1000, 500, 1000", "by-axis"), wall, z=0.5)
    assert not contacts(kerf, program, RATES.format("1000, 500, 1000", "straight"), wall, z=0.5)


def test_a_rapid_with_corners_through_the_stock(kerf, program):
    text = "G21 G90\nT1 M6\nM3 S9000\nG0 X0 Y0 Z5\nG0 Y-20 Z-2\nG0 X40 Y0\nG0 Z20\nM2\n"
    stock = ("--stock", "10,-5,-9 to 25,9,0", *TOOL)  # the straight way passes over X10 at Y-15, X25 at Y-7.5
    for rapids, found in (("straight", False), ("by-axis", True)):
        machine = program(RATES.format("1000, 2000, 1000", rapids), "machine.toml")
        done = kerf("simulate", "--json", program(text), *stock, "--machine", machine)
        assert done.json["hazards"] != [] if found else done.json["hazards"] == [], done.out


def test_other_words_are_refused(kerf, program):
    done = kerf("check", program(PART.format(z=5)), *TOOL, "--machine",
                program('rapids = "fast"', "machine.toml"))
    assert done.status != 0 and 'rapids must be "straight" or "by-axis"' in done.err

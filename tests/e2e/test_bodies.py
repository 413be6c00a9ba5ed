"""Stock from files, fixtures, kerf compare and the fourth axis."""
import math
import struct

import pytest
from conftest import VALID

BOX = [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
       1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7]
REMOVED = 2 * 3.175 / 2 * 10 + math.pi * 5 * 3.175 + math.pi * 3.175**2 / 4  # by VALID, 1 mm deep
BLOCK = ((0, 0, -6), (40, 30, 0))


@pytest.fixture
def box(tmp_path):
    """box("a.stl", low, high): writes a box as binary STL."""

    def write(name, low, high):
        corners = [(x, y, z) for z in (low[2], high[2])
                   for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]
        data = bytes(80) + struct.pack("<I", 12)
        for t in range(0, 36, 3):
            data += bytes(12) + b"".join(struct.pack("<3f", *corners[v]) for v in BOX[t:t + 3]) + bytes(2)
        (tmp_path / name).write_bytes(data)
        return name

    return write


def test_a_mesh_is_stock(kerf, program, box):
    run = kerf("simulate", "--json", "--resolution", "0.05", "--stock-mesh", box("s.stl", *BLOCK), program())
    assert run.status == 0, run.err
    assert run.json["stock"] == {"block_mm": [list(map(float, c)) for c in BLOCK], "size_mm": [40, 30, 6],
                                 "source": "file"}
    assert run.json["stock_mm3"] == pytest.approx(7200, rel=1e-5)
    assert run.json["removed_mm3"] == pytest.approx(REMOVED, rel=5e-3)


def test_a_damaged_or_unknown_file_is_an_error(kerf, program, tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"\0" * 90)
    (tmp_path / "part.step").write_bytes(b"ISO")
    for name, code in (("bad.stl", "mesh_no_volume"), ("part.step", "mesh_file"),
                       ("none.stl", "file_unreadable")):
        run = kerf("simulate", "--json", "--stock-mesh", name, program())
        assert run.status == 1
        assert run.codes() == [code]


def test_left_over_stock_and_the_second_side(kerf, program, files):
    path = program()
    first = kerf("simulate", "--json", "--resolution", "0.1", path, "-o", "left.kstock")
    assert first.status == 0 and "left.kstock" in files()
    again = kerf("simulate", "--json", "--stock-left", "left.kstock", path)
    assert again.json["resolution_mm"] == 0.1
    assert again.json["removed_mm3"] == pytest.approx(0, abs=0.03 * REMOVED)
    second = kerf("simulate", "--json", "--stock-left", "left.kstock", "--flip", "x", path)
    assert second.json["removed_mm3"] == pytest.approx(REMOVED, rel=2e-2)
    moved = kerf("simulate", "--json", "--stock-left", "left.kstock", "--flip", "y x=0 z=0",
                 "--shift", "40,0,-6", path)
    assert moved.json["stock"]["block_mm"] == [[0, 0, -6], [40, 30, 0]]
    kept = kerf("simulate", "--stock-left", "left.kstock", "-o", "left.kstock", path)
    assert kept.status == 2 and "input" in kept.err


def test_invalid_option_values(kerf, program):
    path = program()
    for option, value, code in (("--flip", "z", 4117), ("--shift", "1,2", 4117), ("--fixture", "here", 4118),
                                ("--rotary", "40", 4119)):
        run = kerf("simulate", option, value, path)
        assert run.status == 2 and f"[{code}]" in run.err
    assert kerf("simulate", "--stock", "1x1x1", "--stock-mesh", "a.stl", path).status == 2


def test_fixtures_are_hazards(kerf, program, box):
    path = program()
    clamp = box("clamp.stl", (18, 8, 0), (30, 12, 4))
    run = kerf("check", "--json", "--fixture", clamp, "--fixture", "0,0,0 to 5,5,4", path)
    assert run.status == 3
    hazards = run.json["hazards"]  # the line that ends at X20 Y10, and the arc that starts there
    assert {h["kind"] for h in hazards} == {"fixture_contact"}
    assert [h["origin"]["line"] for h in hazards] == [9, 10]
    for hazard in hazards:
        assert hazard["depth_mm"] == pytest.approx(4, abs=0.01) and "clamp.stl" in hazard["message"]
    assert kerf("check", "--fixture", "0,0,0 to 5,5,4", path).status == 0


CLAMPED = ("G21 G90\nM6 T102\nM3 S9000\nG0 X-10 Y5 Z20\nG0 Z-2\nG1 X10 F500\nG0 X30\nG0 X50\nG0 Z20\n"
           "G0 X5\nG0 Z-2\nG0 Z20\nM2\n")


def test_every_move_through_a_clamp_is_reported(kerf, program):
    path = program(CLAMPED)
    job = ("check", "--stock", "0,0,-30 to 60,40,-20", "--fixture", "0,0,-5 to 6,10,0",
           "--fixture", "20,0,-5 to 26,10,0")
    run = kerf(*job, "--json", path)
    found = [(h["origin"]["line"], h["message"].split('"')[1]) for h in run.json["hazards"]
             if h["kind"] == "fixture_contact"]
    first, second = "0,0,-5 to 6,10,0", "20,0,-5 to 26,10,0"
    assert found == [(6, first), (7, second), (11, first), (12, first)]
    lines = [line for line in kerf(*job, path).out.splitlines() if "[fixture_contact]" in line]
    assert len(lines) == 3 and "in 2 motions" in lines[2]  # the two clamps are never one line


def test_fixtures_on_a_fourth_axis_are_refused(kerf, program):
    run = kerf("check", "--rotary", "d=20 length=30", "--fixture", "0,0,0 to 5,5,5", program(WRAP))
    assert run.status == 2 and "cannot be found on a fourth axis" in run.err


def test_a_fourth_axis_reports_its_default_resolution(kerf, program):
    path = program(WRAP)
    run = kerf("simulate", "--json", "--rotary", "d=10 length=60", path)
    assert run.json["resolution_mm"] == pytest.approx(0.137, abs=1e-3)
    assert "0.137 mm apart" in kerf("simulate", "--rotary", "d=10 length=60", path).out


def test_compare(kerf, program, box, files):
    path = program()
    target = box("target.stl", BLOCK[0], (40, 30, 0))
    run = kerf("compare", "--json", path, target, "-o", "map.png", "--resolution", "0.1")
    assert run.status == 0, run.err
    got = run.json
    assert not got["within_tolerance"] and got["region_count"] == 1
    assert got["gouge"]["largest_mm"] == pytest.approx(1, abs=1e-3)
    assert got["gouge"]["volume_mm3"] == pytest.approx(REMOVED, rel=2e-2)
    assert got["rest"]["volume_mm3"] == 0 and got["rest"]["at"] is None
    assert "map.png" in files()
    text = kerf("compare", path, target).out
    assert "gouge of 1 mm at X" in text
    assert kerf("compare", path, target, "--tolerance", "2", "--json").json["within_tolerance"]
    outside = kerf("compare", "--json", path, target, "--target-shift", "0,0,3")
    assert "target_outside" in outside.codes()
    assert kerf("compare", path, target, "-o", "part.stl").status == 2
    # --size and --section are those of --view's picture.
    assert kerf("compare", path, target, "-o", "map.png", "--section", "x=10").status == 2
    assert kerf("compare", path, target, "-o", "map.png", "--size", "10x10").status == 2
    assert kerf("compare", path, target, "-o", "cut.png", "--view", "iso", "--section", "x=10").status == 0
    beside = kerf("compare", path, target, "-o", "beside.png", "--view", "iso", "--section", "x=-1")
    assert beside.status == 1 and "[1017]" in beside.err and "beside.png" not in files()  # section_outside
    assert "saturated from 0.25 mm" in kerf("compare", path, target, "-o", "map.png").out


WRAP = ("G21 G90\nM6 T102\nM3 S9000\nG0 X15 Y0 Z20 A0\nG1 Z8 F200\nG1 A360 F2000\n"
        "G0 Z20\nG0 X5\nG0 Z9\nM2\n")


def test_a_fourth_axis(kerf, program, files):
    path = program(WRAP)
    run = kerf("simulate", "--json", "--rotary", "d=20 length=30", "--resolution", "0.2",
               "-o", "bar.stl", path)
    assert run.status == 0, run.err
    assert run.json["stock_mm3"] == pytest.approx(math.pi * 100 * 30, rel=1e-4)
    assert run.json["removed_mm3"] == pytest.approx(math.pi * 36 * 3.175 + 5, rel=0.06)
    hazard, = run.json["hazards"]
    assert hazard["kind"] == "rapid_in_stock" and hazard["origin"]["line"] == 9
    assert hazard["depth_mm"] == pytest.approx(1, abs=0.05)
    assert "bar.stl" in files()
    check = kerf("check", "--json", "--rotary", "d=20 length=30", path)
    assert check.status == 3 and [h["kind"] for h in check.json["hazards"]] == [
        "rapid_in_stock", "stop_low"]  # it ends at Z9 in the bar, with the spindle on
    assert kerf("simulate", "--rotary", "d=20 length=30", path, "-o", "bar.kstock").status == 1


@pytest.mark.parametrize("z, bar, resolution, hint", [
    (12, "d=20 length=30", "0.2", "--rotary"),        # 2 mm above a bar whose radius is 10 mm
    (9, "d=20 length=30 x=100", "0.2", "--rotary"),   # beside it
    (9, "d=20 length=30", "10", "--resolution"),      # 3.175 mm wide at X10, on the border of two rays
])
def test_a_program_that_removes_nothing_of_a_bar_is_reported(kerf, program, z, bar, resolution, hint):
    path = program("G21 G90\nM6 T102\nM3 S9000\nG0 X10 Y0 Z20 A0\n"
                   f"G1 Z{z} F200\nG1 A360 F2000\nG0 Z20\nM5\nM2\n")
    options = ("--rotary", bar, "--resolution", resolution, "--json")
    run = kerf("simulate", path, *options)
    warning, = [d for d in run.json["diagnostics"] if d["name"] == "stock_untouched"]
    assert run.json["removed_mm3"] == 0 and hint in warning["hint"]
    check = kerf("check", path, *options)
    assert check.status == 3 and [h["kind"] for h in check.json["hazards"]] == ["stock_untouched"]
    cuts = program(path.read_text().replace(f"Z{z} F", "Z9 F"))
    cut = kerf("check", cuts, "--rotary", "d=20 length=30", "--json")
    assert cut.status == 0, cut.out

"""Stock from meshes, left-over stock, fixtures, comparison and the fourth axis, from Python."""
import math
import struct

import kerf
import pytest
from jobs import SLOT, slot


def box_stl(low, high):
    """Binary STL of a box."""
    corners = [(x, y, z) for z in (low[2], high[2])
               for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]
    faces = [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
             1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7]
    data = bytes(80) + struct.pack("<I", 12)
    for t in range(0, 36, 3):
        data += bytes(12) + b"".join(struct.pack("<3f", *corners[v]) for v in faces[t:t + 3]) + bytes(2)
    return data


@pytest.fixture
def block(tmp_path):
    path = tmp_path / "block.stl"
    path.write_bytes(box_stl((0, 0, -6), (40, 20, 0)))
    return path


def test_a_mesh_is_stock(block):
    stock = kerf.load_stock(block)
    assert stock.low == (0, 0, -6) and stock.high == (40, 20, 0)
    result = kerf.simulate(slot(), stock, resolution=0.1)
    assert result.stock_mm3 == pytest.approx(4800, rel=1e-4)
    assert result.removed_mm3 == pytest.approx(SLOT, rel=5e-3)


def test_a_damaged_mesh_is_an_error(tmp_path):
    path = tmp_path / "bad.stl"
    path.write_bytes(b"solid nothing")
    with pytest.raises(kerf.Error) as error:
        kerf.load_stock(path)
    assert error.value.diagnostics[0].name == "mesh_no_volume"


def test_left_over_stock_is_turned_over(block, tmp_path):
    first = kerf.simulate(slot(), kerf.load_stock(block), resolution=0.1)
    kerf.save_left_stock(first, tmp_path / "left.kstock")
    for left in (kerf.left_stock(first), kerf.load_stock(tmp_path / "left.kstock")):
        again = kerf.simulate(slot(), left, resolution=0.1)
        assert again.removed_mm3 == pytest.approx(0, abs=0.05 * SLOT)
        turned = kerf.move_stock(left, "x", across=10, z=-3)
        both = kerf.simulate(slot(), turned, resolution=0.1)
        assert both.removed_mm3 == pytest.approx(SLOT, rel=1e-2)
        assert len(both.column(200, 100)) == 1
    with pytest.raises(ValueError):
        kerf.move_stock(left, "z")


def test_fixtures():
    clamp = kerf.Stock.block((5, 20, 4), zero="lower-left", zero_height="bottom")  # X0 to X5, 4 above Z0
    path = slot()
    path.rapid((2, 10, 5))
    path.rapid((2, 10, 3))
    contact, = kerf.fixture_contacts(path, [("clamp", clamp)])
    assert contact["fixture"] == "clamp" and contact["part"] is None
    assert contact["depth_mm"] == pytest.approx(1, abs=1e-3)
    assert contact["step"] == len(path) - 1


def test_compare(block):
    result = kerf.simulate(slot(), kerf.Stock.block((40, 20, 6)), resolution=0.1)
    found = kerf.compare(result, kerf.load_stock(block))
    assert found["map"].shape == (200, 400)
    assert found["gouge"]["volume_mm3"] == pytest.approx(SLOT, rel=2e-2)
    assert found["rest"]["volume_mm3"] == pytest.approx(0, abs=1e-3)
    region, = found["regions"]
    assert region["kind"] == "gouge" and 1.5 < region["depth_mm"] <= 2.001


def test_a_fourth_axis():
    text = "G21 G90\nM6 T102\nM3 S9000\nG0 X15 Y0 Z20 A0\nG1 Z8 F200\nG1 A360 F2000\nG0 Z20\nM2\n"
    path = kerf.read_gcode(text, "wrap.nc")
    result = kerf.simulate_rotary(path, 20, (0, 30), resolution=0.2)
    exact = math.pi * (100 - 64) * 3.175
    assert result.removed_mm3 == pytest.approx(exact, rel=0.05)
    assert result.hazards == []
    points, triangles, _ = result.mesh()
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    volume = (a * __import__("numpy").cross(b, c)).sum() / 6
    assert volume == pytest.approx(result.stock_mm3 - result.removed_mm3, rel=5e-3)

"""Printing in Python: beads added by calls and read from G-code."""
import math
import warnings

import kerf
import numpy
import pytest

AREA = (0.5 - 0.2) * 0.2 + math.pi * 0.1**2


def wall(layers):
    path = kerf.Toolpath()
    for n in range(1, layers + 1):
        path.rapid((0, 0, 0.2 * n))
        path.extrude((20, 3, 0.2 * n), feed=1200, width=0.5, height=0.2)
    return path


def test_a_wall_holds_what_is_extruded():
    result = kerf.simulate_print(wall(5), resolution=0.05)
    length = math.hypot(20, 3)
    assert result.total["extruded_mm3"] == pytest.approx(5 * AREA * length, rel=1e-9)
    assert result.total["overlap_mm3"] == pytest.approx(0, abs=1e-3)
    assert result.total["laid_mm3"] == pytest.approx(
        result.total["extruded_mm3"] + result.total["ends_mm3"], abs=1e-3)
    assert [layer["z_mm"] for layer in result.layers] == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    assert result.roads == 5 and result.hazards == [] and "5 layers" in repr(result)
    assert result.resolution_mm == 0.05 and result.seconds >= 0


def test_the_mesh_is_that_of_the_part():
    result = kerf.simulate_print(wall(5), resolution=0.05)
    for grooves in (False, True):
        points, triangles, step = result.mesh(grooves)
        a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
        volume = (a * numpy.cross(b, c)).sum() / 6
        assert volume == pytest.approx(result.total["laid_mm3"], rel=0.02 if grooves else 0.12)
        assert set(step.tolist()) <= set(range(len(wall(5))))


def test_hazards_name_the_line_of_the_script():
    path = wall(3)
    path.rapid((10, -5, 0.3))
    path.rapid((10, 5, 0.3))
    result = kerf.simulate_print(path)
    contact, = [h for h in result.hazards if h["kind"] == "nozzle_contact"]
    assert contact["depth_mm"] == pytest.approx(0.3, abs=0.01)
    assert contact["origin"] == path[len(path) - 1]["origin"]
    assert contact["origin"]["file"].endswith("test_simulate_print.py")


def test_steps_and_g_code():
    text = "M104 S200\nM109 S200\nM83\nG1 X0 Y0 Z0.2 F600\nG1 X10 E1\n"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no program end; the dialect is guessed
        path = kerf.read_gcode(text, filament=2.0)
    assert path[len(path) - 1]["volume"] == pytest.approx(math.pi)
    assert wall(1)[1]["width"] == 0.5 and wall(1)[1]["volume"] == pytest.approx(AREA * math.hypot(20, 3))


@pytest.mark.parametrize("call", [
    lambda: kerf.Toolpath().extrude((1, 0, 0), feed=100),
    lambda: wall(1).extrude((1, 0, 0), feed=100, width=0.1, height=0.2),
    lambda: wall(1).extrude((1, 0, 0), feed=100, volume=math.inf),
    lambda: kerf.simulate_print(wall(1), resolution=-1),
    lambda: kerf.simulate_print(wall(1), layer_height=0),
    lambda: kerf.simulate_print(wall(1), bed=math.nan),
    lambda: kerf.simulate_print(kerf.Toolpath()),
    lambda: kerf.read_gcode("M2", filament=0),
])
def test_what_cannot_be_is_refused(call):
    with pytest.raises(ValueError):
        call()

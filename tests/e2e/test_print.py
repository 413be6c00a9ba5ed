"""kerf simulate on printing programs: the volumes of a box, hazards, files, refusals."""
import math
import struct
from pathlib import Path

import pytest
from conftest import VALID

BOX = Path(__file__).parent.parent / "data" / "gcode" / "print_box.gcode"
AREA = (0.45 - 0.2) * 0.2 + math.pi * 0.1**2  # of a bead, mm2
FILAMENT = math.pi / 4 * 1.75**2

HEAD = "M104 S210\nM109 S210\nG28\nG90\nM83\n"


def extruded_in(text):
    """mm3 extruded by relative E words while the nozzle moves, and at rest."""
    moving = at_rest = 0.0
    for line in text.splitlines():
        words = line.split(";")[0].split()
        e = [float(w[1:]) for w in words if w[0] == "E"]
        if words[:1] == ["G1"] and e and e[0] > 0:
            if any(w[0] in "XY" for w in words):
                moving += e[0] * FILAMENT
            else:
                at_rest += e[0] * FILAMENT
    return moving, at_rest


def test_the_box(kerf, program):
    run = kerf("simulate", "--json", "--resolution", "0.03", BOX)
    assert run.status == 0, run.err
    got = run.json
    moving, at_rest = extruded_in(BOX.read_text())
    drawn_back = 2 * 0.8 * FILAMENT  # before each of the two layers
    assert got["kind"] == "print"
    assert got["blobs_mm3"] == pytest.approx(at_rest - drawn_back, rel=1e-6)
    assert got["extruded_mm3"] == pytest.approx(moving + got["blobs_mm3"], rel=1e-6)
    assert got["laid_mm3"] == pytest.approx(
        got["extruded_mm3"] - got["blobs_mm3"] - got["overlap_mm3"] + got["ends_mm3"], rel=1e-9)
    assert [layer["z_mm"] for layer in got["layers"]] == [0.2, 0.4]
    assert [layer["height_mm"] for layer in got["layers"]] == [0.2, 0.2]
    assert sum(layer["laid_mm3"] for layer in got["layers"]) == pytest.approx(got["laid_mm3"], rel=1e-9)
    # Walls side by side at 0.407 mm: nearly all of the floor is material, and little is laid twice.
    solid = got["layers"][0]
    assert 10 * 8 * 0.2 * 0.9 < solid["laid_mm3"] - 10 * AREA < 10 * 8 * 0.2
    assert solid["overlap_mm3"] < 0.06 * solid["extruded_mm3"]
    # The grid crosses itself six times in the second layer; all of it lies on the floor.
    assert got["layers"][1]["overlap_mm3"] > 6 * 0.25 * 0.25 * 0.2
    assert got["unsupported_mm"] == pytest.approx(0, abs=0.3)
    kinds = {h["kind"] for h in got["hazards"]}
    assert kinds == {"blob"}
    assert got["hazards"][0]["origin"]["line"] == BOX.read_text().splitlines().index(
        "G1 E0.8 F1800 ; a blob: nothing was drawn back before") + 1


def test_figures_agree_between_resolutions(kerf):
    fine = kerf("simulate", "--json", "--resolution", "0.025", BOX).json
    usual = kerf("simulate", "--json", BOX).json
    assert usual["resolution_mm"] == pytest.approx(0.09, abs=0.002)
    for key in ("laid_mm3", "extruded_mm3"):
        assert usual[key] == pytest.approx(fine[key], rel=0.01)
    assert usual["overlap_mm3"] == pytest.approx(fine["overlap_mm3"], abs=0.01 * fine["extruded_mm3"])
    one = kerf("simulate", "--json", "--threads", "1", BOX).json
    three = kerf("simulate", "--json", "--threads", "3", BOX).json
    del one["seconds"], three["seconds"]
    assert one == three


def test_summary_meshes_and_pictures(kerf, files, tmp_path):
    run = kerf("simulate", BOX, "-o", "box.stl", "-o", "box.3mf", "-o", "box.png", "--size", "320x200")
    assert run.status == 0, run.err
    assert "a print" in run.out and "overlap" not in run.err and "[blob]" in run.out
    assert files() == ["box.3mf", "box.png", "box.stl"]
    data = Path(tmp_path, "box.stl").read_bytes()
    triangles = struct.unpack_from("<I", data, 80)[0]
    volume = 0.0
    for t in range(triangles):
        a, b, c = (struct.unpack_from("<3f", data, 84 + 50 * t + 12 + 12 * k) for k in range(3))
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    laid = kerf("simulate", "--json", BOX).json["laid_mm3"]
    assert volume == pytest.approx(laid, rel=0.1)  # with the grooves between beads closed
    assert kerf("simulate", BOX, "-o", "grooved.stl", "--grooves").status == 0
    assert Path(tmp_path, "grooved.stl").stat().st_size > 1.3 * len(data)


def test_hazards_have_their_lines(kerf, program):
    wall = "".join(f"G1 Z{0.2 * n:.1f} F600\nG1 X0 Y0 F9000\nG1 X20 Y0 E0.7 F1800\n" for n in range(1, 11))
    text = HEAD + "G1 Z0.2 F600\nG1 X0 Y0 F9000\n" + wall
    lines = text.count("\n")
    path = program(text + "G1 Y-5 F9000\nG1 Z1\nG1 X10\nG1 Y5\nG1 Z8\nG1 X20 E0.4\n", "print.gcode")
    run = kerf("simulate", "--json", path)
    assert run.status == 0, run.err
    by_kind = {h["kind"]: h for h in run.json["hazards"]}
    assert set(by_kind) == {"nozzle_contact", "in_air"}
    assert by_kind["nozzle_contact"]["origin"]["line"] == lines + 4
    assert by_kind["nozzle_contact"]["depth_mm"] == pytest.approx(1.0, abs=0.01)
    assert by_kind["in_air"]["origin"]["line"] == lines + 6
    assert by_kind["in_air"]["length_mm"] == pytest.approx(10)
    text = kerf("simulate", path).out
    assert text.index("[nozzle_contact]") < text.index("[in_air]")


def test_filament_and_layer_height_can_be_given(kerf, program):
    path = program(HEAD + "G1 Z0.3 F600\nG1 X0 Y0 F9000\nG1 X20 E1 F1800\n", "print.gcode")
    thin = kerf("simulate", "--json", path).json
    assert thin["extruded_mm3"] == pytest.approx(FILAMENT, rel=1e-6)
    assert thin["layers"][0]["height_mm"] == pytest.approx(0.3)
    thick = kerf("simulate", "--json", "--filament", "2.85", "--layer-height", "0.25", path).json
    assert thick["extruded_mm3"] == pytest.approx(math.pi / 4 * 2.85**2, rel=1e-6)
    assert thick["layers"][0]["height_mm"] == pytest.approx(0.25)
    setting = "; filament_diameter = 2.85\n"
    given = kerf("simulate", "--json", program(setting + path.read_text(), "given.gcode"))
    assert given.json["extruded_mm3"] == pytest.approx(thick["extruded_mm3"], rel=1e-6)
    wrong = program(HEAD + "G1 Z0.2\nG1 X0 Y0\n;WIDTH:0.45\n;HEIGHT:0.2\nG1 X20 E0.25\n", "wrong.gcode")
    assert "print_width_differs" in kerf("simulate", "--json", wrong).codes()


def test_refusals_and_unused_options(kerf, program):
    path = program(HEAD + "G1 Z0.3 F600\nG1 X0 Y0 F9000\nG1 X20 E1 F1800\n", "print.gcode")
    assert kerf("simulate", "--json", "--stock", "10x10x10", path).codes().count("option_unused") == 1
    run = kerf("simulate", path, "-o", "left.kstock")
    assert run.status == 1 and "--stock-mesh" in run.err
    both = program(HEAD + "T102 M6\nM3 S9000\nG1 Z0.3 F600\nG1 X0 Y0 F9000\nG1 X20 E1 F1800\n", "both.gcode")
    assert "extrusion_not_simulated" in kerf("simulate", "--json", "--stock", "20x20x5", both).codes()
    assert "option_unused" in kerf("simulate", "--json", "--grooves", program(VALID)).codes()
    far = program(HEAD + "G1 Z0.3 F600\nG1 X0 Y0 F9000\nG1 X200000 E1000 F1800\n", "far.gcode")
    run = kerf("simulate", "--json", far)
    assert run.status == 1 and "print_too_large" in run.codes()

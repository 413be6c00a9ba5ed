"""kerf check and kerf info on printing programs: the exit status of good and bad prints;
filament, mass, layers. And programs whose unit is evidently wrong for their stock."""
import math
import re
from pathlib import Path

import pytest

PRINTS = Path(__file__).parent.parent / "data" / "gcode" / "prints"
BOX = Path(__file__).parent.parent / "data" / "gcode" / "print_box.gcode"
AREA = math.pi / 4 * 1.75**2  # of the filament, mm2
RELATIVE = (PRINTS / "relative.gcode").read_text()


def hazards(kerf, path, *options):
    run = kerf("check", "--json", *options, path)
    assert run.status == (3 if run.json["hazards"] else 0), run.out
    return {h["kind"]: h for h in run.json["hazards"]}


def line_of(text, part):
    return next(i for i, line in enumerate(text.splitlines(), 1) if part in line)


@pytest.mark.parametrize("path", [*sorted(PRINTS.glob("*.gcode")), BOX], ids=lambda p: p.stem)
def test_a_good_print_has_no_hazard(kerf, path):
    """Purge lines, bridges over sparse infill and the words of printers are none. No warning either."""
    run = kerf("check", "--json", path)
    assert run.status == 0, run.out
    assert run.json["hazards"] == []
    assert [d for d in run.json["diagnostics"] if d["severity"] != "note"] == []
    text = kerf("check", path)
    assert text.status == 0 and "no hazard found" in text.out + text.err


def test_the_nozzle_in_printed_material(kerf, program):
    """A travel through the box, 0.6 mm below its top."""
    end = "G1 E-0.8 F2400\nM73 P100"
    crash = RELATIVE.replace(end, "G1 X45 Y54 F9000\nG1 Z0.6\nG1 X65 F9000 ; crash\n" + end)
    found = hazards(kerf, program(crash, "crash.gcode"))
    assert set(found) == {"nozzle_contact"}
    assert found["nozzle_contact"]["origin"]["line"] == line_of(crash, "; crash")
    assert found["nozzle_contact"]["depth_mm"] == pytest.approx(0.6, abs=0.02)


def test_a_bead_in_the_air(kerf, program):
    end = "G1 E-0.8 F2400\nM73 P100"
    air = RELATIVE.replace(end, "G1 Z5 F720\nG1 X60 Y80 F9000\nG1 X90 E1 ; air\nG1 X120 F9000\n" + end)
    found = hazards(kerf, program(air, "air.gcode"))
    assert set(found) == {"in_air"}
    assert found["in_air"]["origin"]["line"] == line_of(air, "; air")


PRINT = "M104 S{heat}\n{between}G21\nG90\nM83\nG1 Z0.2 F600\nG1 X20 Y20 F6000\nG1 X60 E1.33 F1800 ; bead\n"


@pytest.mark.parametrize("between, heat, found", [
    ("M109 S200\n", 200, False), ("", 200, True), ("G28\nM190 S60\n", 200, True),
    ("", 0, True), ("M117 ready\nM73 P0\n", 0, True),
    ("PRINT_START HOTEND=230\n", 0, False), ("START_PRINT\n", 0, False), ("MY_HEATER\n", 0, False),
    ("SET_HEATER_TEMPERATURE HEATER=extruder TARGET=230\n", 0, False), ("M620 S0A\n", 0, False),
])
@pytest.mark.parametrize("flavour", ["klipper", "marlin"])
def test_a_nozzle_that_nothing_heats(kerf, program, between, heat, found, flavour):
    """A macro may heat; without one the first bead needs a wait for a temperature."""
    text = f"; gcode_flavor = {flavour}\n" + PRINT.format(between=between, heat=heat)
    kinds = hazards(kerf, program(text, "heat.gcode"))
    assert set(kinds) == ({"cold_extrusion"} if found else set())
    if found:
        assert kinds["cold_extrusion"]["origin"]["line"] == line_of(text, "; bead")


def test_a_bead_that_is_much_too_wide(kerf, program):
    """The others are 0.45 mm wide and 0.2 mm high."""
    area = (0.45 - 0.2) * 0.2 + math.pi * 0.01
    wide = (8.0 - 0.2) * 0.2 + math.pi * 0.01  # 8 mm wide
    rows = "".join(f"G1 X{60 if i % 2 == 0 else 20} E{40 * area / AREA:.5f} F1800\nG1 Y{21 + i} F6000\n"
                   for i in range(20))
    text = "M109 S200\nG90\nM83\nG1 Z0.2 F600\nG1 X20 Y20 F6000\n" + rows
    assert hazards(kerf, program(text, "good.gcode")) == {}
    at = text.index("G1 X60", len(text) // 2)
    bad = text[:at] + f"G1 X60 E{40 * wide / AREA:.5f} F1800 ; wide\n" + text[text.index("\n", at) + 1:]
    found = hazards(kerf, program(bad, "bad.gcode"))["wide_bead"]
    assert found["origin"]["line"] == line_of(bad, "; wide")
    assert "8 mm wide" in found["message"]


@pytest.mark.parametrize("length, found", [(1.5, False), (5, True)])
def test_short_beads_in_the_air_are_none(kerf, program, length, found):
    end = "G1 E-0.8 F2400\nM73 P100"
    bead = f"G1 Z5 F720\nG1 X60 Y80 F9000\nG1 X{60 + length} E{0.033 * length}\nG1 X120 F9000\n"
    air = RELATIVE.replace(end, bead + end)
    assert set(hazards(kerf, program(air, "air.gcode"))) == ({"in_air"} if found else set())


@pytest.mark.parametrize("depth, found", [(0.03, False), (0.3, True)])
def test_shallow_contacts_of_the_nozzle_are_none(kerf, program, depth, found):
    end = "G1 E-0.8 F2400\nM73 P100"
    crash = RELATIVE.replace(end, f"G1 X45 Y54 F9000\nG1 Z{1.2 - depth:.2f}\nG1 X65 F9000\n" + end)
    assert set(hazards(kerf, program(crash, "crash.gcode"))) == ({"nozzle_contact"} if found else set())


def test_a_code_that_moves_nothing_is_no_hazard(kerf, program):
    text = PRINT.format(heat=200, between="M109 S200\nG392 S0\n")
    assert hazards(kerf, program(text, "clog.gcode")) == {}


def test_tools_of_reprapfirmware(kerf, program):
    """G10 L2 is a work offset, G10 P S R are temperatures, G10 alone retracts, T-1 selects no tool."""
    text = ("; gcode_flavor = reprapfirmware\nG10 P0 S200 R180\nM116\nG10 L2 P1 X10\nT0\nG90\nM83\n"
            "G1 Z0.2 F600\nG1 X20 Y20 F6000\nG1 X60 E1.33 F1800\nG10\nG11\nT-1\n")
    run = kerf("check", "--json", program(text, "duet.gcode"))
    assert run.status == 0 and run.json["hazards"] == [], run.out
    steps = kerf("steps", program(text, "duet.gcode")).out
    assert steps.count('"step":"temperature"') == 2 and '"celsius":200' in steps
    assert "G10" in steps and "G10 P0" not in steps


@pytest.mark.parametrize("usage, slow", [("time_estimate_only", False), ("ignore", True)])
def test_limits_of_the_slicer_are_those_of_the_time(kerf, program, usage, slow):
    """The same values as commands give the same time."""
    rows = "".join(f"G1 X{60 if i % 2 == 0 else 20} Y{20 + i / 10:.1f} E1.3 F18000\n" for i in range(100))
    text = "M109 S200\nG90\nM83\nG1 X20 Y20 Z0.2 F6000\n" + rows
    comments = (f"; gcode_flavor = klipper\n; machine_limits_usage = {usage}\n"
                "; machine_max_acceleration_x = 16000,9000\n; machine_max_acceleration_y = 16000\n"
                "; machine_max_acceleration_extruding = 16000\n; machine_max_feedrate_x = 500\n"
                "; machine_max_feedrate_y = 500\n; machine_max_jerk_x = 9\n; machine_max_jerk_y = 9\n")
    codes = "M201 X16000 Y16000\nM203 X500 Y500\nM204 P16000\nM205 X9 Y9\n"

    def seconds(name, program_text):
        return kerf("info", "--json", program(program_text, name)).json["time_s"]["total"]

    given = seconds("comments.gcode", text + comments)
    exact = seconds("codes.gcode", "; gcode_flavor = marlin\n" + codes + text)
    assert (given > 1.3 * exact) if slow else given == pytest.approx(exact, rel=0.002)


def test_a_blob(kerf, program):
    """2 mm of filament at rest in the print: 4.8 mm3. A tenth of a mm, and one beside the print, are none."""
    where = ";Z:0.8\n"
    for e, x, expected in ((2, None, {"blob"}), (0.1, None, set()), (2, 150, set())):
        blob = f"G1 X{x} F9000\nG1 E{e} F100\n" if x else f"G1 E{e} F100 ; blob\n"
        text = RELATIVE.replace(where, where + blob)
        found = hazards(kerf, program(text, "blob.gcode"))
        assert set(found) == expected
        if expected:
            assert found["blob"]["origin"]["line"] == line_of(text, "; blob")


def test_twice_the_filament(kerf, program):
    def doubled(match):
        return f"E{2 * float(match.group(1)):.5f}"

    start = RELATIVE.index(";LAYER_CHANGE")
    double = RELATIVE[:start] + re.sub(r"(?<=\d )E([\d.]+)", doubled, RELATIVE[start:])
    hazards = kerf("check", "--json", program(double, "double.gcode")).json["hazards"]
    found = {h["kind"]: h for h in reversed(hazards)}
    assert {"overfill", "width_differs"} <= set(found)
    second = double.index(";Z:0.4")  # the purge lines are most of the first layer
    first_bead = double[:second].count("\n") + line_of(double[second:], "F1800")
    assert found["overfill"]["origin"]["line"] == first_bead
    assert found["overfill"]["hint"]
    thick = kerf("check", "--json", "--filament", "2.85", PRINTS / "relative.gcode")
    assert thick.status == 3 and "width_differs" in {h["kind"] for h in thick.json["hazards"]}


def test_words_of_printers_are_notes(kerf, program):
    words = kerf("check", "--json", PRINTS / "words.gcode")
    skipped = [d["message"] for d in words.json["diagnostics"] if d["name"] == "code_ignored"]
    assert any(m.startswith("G29 runs") for m in skipped)
    assert not any(m.startswith("G10") for m in skipped)  # retraction by the firmware is kept
    # E words alone make a print.
    beads = "".join(f"G1 X{10 + 10 * (i % 2)} Y{i} Z0.2 E0.3 F900\n" for i in range(4))
    cold = program("G28\nG90\nM83\n" + beads, "cold.gcode")
    assert kerf("simulate", "--json", cold).json["kind"] == "print"


def test_unused_options(kerf):
    assert "option_unused" in kerf("check", "--json", "--stock", "10x10x10", BOX).codes()


# ---- kerf info


def test_filament_mass_and_layers(kerf):
    """All E of the program by hand: what was extruded while moving or at rest, beyond what was drawn back.

    M221 S95 comes after the purge lines.
    """
    text = RELATIVE.split("G92 E0\n", 2)[2].split("M73 P100")[0]  # without the purge lines
    assert "M221 S95" in RELATIVE and RELATIVE.index("M221 S95") > RELATIVE.index("E12.5")
    e = [float(v) for v in re.findall(r"^G1 .*E(-?[\d.]+)", text, re.M)]
    drawn_back = length = 0.0
    for v in e:
        drawn_back -= v
        length += max(0.0, -drawn_back)
        drawn_back = max(drawn_back, 0.0)
    info = kerf("info", "--json", PRINTS / "relative.gcode").json
    length *= 0.95
    purge = 9 + 12.5  # two lines, the first from an unknown X
    got = info["print"]
    assert info["kind"] == "print" and "tools" not in info and "stock" not in info
    assert got["filament_mm"] == pytest.approx(length + purge, rel=1e-6)
    assert got["filament_mm3"] == pytest.approx((length + purge) * AREA, rel=1e-6)
    assert got["mass_g"] == pytest.approx((length + purge) * AREA * 1.27e-3, rel=1e-6)
    assert got["density_g_cm3"] == 1.27 and not got["density_assumed"]
    assert got["layers"] == 6 and got["layer_height_mm"] == {"min": 0.2, "max": 0.2}
    assert info["time_s"]["total"] > 10
    pla = kerf("info", "--json", PRINTS / "absolute.gcode").json["print"]
    assert pla["density_g_cm3"] == 1.24 and pla["density_assumed"]
    assert pla["mass_g"] == pytest.approx(pla["filament_mm"] * AREA * 1.24e-3, rel=1e-6)
    heavy = kerf("info", "--json", "--density", "2", PRINTS / "relative.gcode").json["print"]
    assert heavy["mass_g"] == pytest.approx(2 / 1.27 * got["mass_g"], rel=1e-6)


def test_info_of_a_print_has_no_words_of_milling(kerf):
    out = kerf("info", PRINTS / "absolute.gcode").out
    assert re.search(r"Filament +[\d.]+ mm of 1.75 mm", out)
    assert re.search(r"Mass +[\d.]+ g at 1.24 g/cm3", out)
    assert "assuming PLA" in out and re.search(r"Layers +7", out)
    for word in ("cut", "Tools", "Spindle", "Stock", "rapid ", "M30"):
        assert word not in out, word


# ---- units


POCKET = ("{unit}G90\nM3 S9000\nG0 Z{s}\nG0 X{a} Y{a}\nG1 Z-{d} F{f}\n"
          "G1 X{b}\nG1 Y{c}\nG1 X{a}\nG1 Y{a}\nG0 Z{s}\nM5\nM2\n")
INCHES = POCKET.format(unit="{unit}", s=0.2, a=0.25, b=3.75, c=2.5, d=0.05, f=20)
MM = POCKET.format(unit="{unit}", s=5, a=10, b=90, c=50, d=1, f=400)


@pytest.mark.parametrize("text, stock, doubtful", [
    (INCHES.format(unit=""), "100x70x12", True),
    (INCHES.format(unit="G20\n"), "100x70x12", False),
    (INCHES.format(unit="G21\n"), "100x70x12", False),  # an engraving of 3.5 mm, as it says
    (INCHES.format(unit="G20\n"), "4x3x0.5", True),  # mm: the stock was meant in inches
    (MM.format(unit="G20\n"), "100x60x12", True),
    (MM.format(unit=""), "100x60x12", False),
    (MM.format(unit=""), "1000x600x12", False),  # a small part of a large board
])
def test_a_wrong_unit_is_a_finding(kerf, program, text, stock, doubtful):
    found = hazards(kerf, program(text), "--stock", stock, "--tool", "square d=3 flute=12")
    assert ("units_doubtful" in found) == doubtful
    if doubtful:
        assert "units seem wrong" in found["units_doubtful"]["message"] and found["units_doubtful"]["hint"]


def test_a_prime_line_above_a_single_layer_is_no_reversed_axis(kerf, program):
    text = ("M109 S200\nM82\nG28\nG92 E0\nG1 Z2 F3000\nG1 X0.1 Y20 Z0.3 F5000\nG1 X0.1 Y200 Z0.3 F1500 E15\n"
            "G92 E0\nG0 F6000 X50 Y50 Z0.2\nG1 F1200 X90 Y50 E1.33\nG1 X90 Y90 E2.66\nM104 S0\nM84\n")
    run = kerf("check", "--json", program(";FLAVOR:Marlin\n" + text, "a.gcode"))
    assert [h["kind"] for h in run.json["hazards"]] == []

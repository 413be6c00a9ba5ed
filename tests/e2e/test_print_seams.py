"""Prints keep their retraction, filament, firmware and heating between reading, posting and reading back."""
import math

import pytest

AREA = math.pi / 4 * 1.75 ** 2  # mm2, of the filament
START = "; filament_diameter = 1.75\nM83\nG28\nM109 S200\n"
BODY = "G1 X10 Y10 Z0.2 F1200\nG1 X30 E1 F1200\nG10\nG0 X50\nG11\nG1 X80 E1\n"


@pytest.fixture
def post(kerf, program, tmp_path):
    def run(text, to, *options):
        done = kerf("post", program(text, "p.gcode"), *to, "-o", "out.gcode", *options)
        assert done.status == 0, done.err
        return (tmp_path / "out.gcode").read_text().splitlines()

    return run


def after_start(lines):
    """Motions and lines of retraction behind the header."""
    return [line for line in lines[lines.index("G92 E0"):]
            if line.startswith(("G0", "G1", "M207", "M208", "SET_"))]


@pytest.mark.parametrize("source", ["", "; Kerf 0.1.0, klipper\n", "; gcode_flavor = reprapfirmware\n"])
@pytest.mark.parametrize("to", ["marlin", "klipper", "reprapfirmware"])
def test_retraction_by_the_firmware_is_kept(post, source, to):
    assert after_start(post(source + START + BODY, ("--to", to)))[-6:] == [
        "G1 X10 Y10 Z0.2 F1200", "G1 X30 E1", "G10", "G0 X50", "G11", "G1 X80 E1"]


@pytest.mark.parametrize("given, to, written", [
    ("M207 S1.5 F2400", "marlin", ["M207 S1.5 F2400"]),
    ("M207 S1.5 F2400", "klipper", ["SET_RETRACTION RETRACT_LENGTH=1.5 RETRACT_SPEED=40"]),
    ("SET_RETRACTION RETRACT_LENGTH=1.5 UNRETRACT_SPEED=20", "reprapfirmware", ["M207 S1.5 T1200"]),
    ("SET_RETRACTION RETRACT_LENGTH=1.5 UNRETRACT_SPEED=20", "marlin", ["M207 S1.5", "M208 F1200"]),
    ("M208 S0.1 F900", "reprapfirmware", ["M207 R0.1 T900"]),
])
def test_lengths_of_retraction_have_the_form_of_the_firmware(post, given, to, written):
    lines = after_start(post(START + given + "\n" + BODY, ("--to", to)))
    assert [line for line in lines if line.startswith(("M20", "SET_"))] == written


@pytest.mark.parametrize("lengths, back, forth", [
    ("", "G1 E-0.8 F2100", "G1 E0.8"),
    ("M207 S1.5 F2400\nM208 S0.1 F1800\n", "G1 E-1.5 F2400", "G1 E1.6 F1800"),
])
def test_retraction_by_the_firmware_as_e_words(post, tmp_path, lengths, back, forth):
    (tmp_path / "mine.toml").write_text('base = "klipper"\n[printer]\nretraction = "extruder"\n')
    lines = after_start(post(START + lengths + BODY, ("--post", "mine.toml")))
    assert lines[-4:] == [back, "G0 X50", forth, "G1 X80 E1 F1200"]
    # Twice in a row it has no further effect.
    again = after_start(post(START + lengths + BODY.replace("G10\n", "G10\nG10\n"), ("--post", "mine.toml")))
    assert again == lines


def test_a_temperature_of_reprapfirmware_is_no_retraction(post):
    start = "; gcode_flavor = reprapfirmware\nM83\nG28\nG10 P0 S200\nM116\n"
    lines = post(start + BODY, ("--to", "reprapfirmware"))
    assert "M104 T0 S200" in lines and "M109 T0 S200" in lines and lines.count("G10") == 1


@pytest.mark.parametrize("name", ["; gcode_flavor = reprapfirmware", ";FLAVOR:RepRap (RepRap)",
                                  ";FLAVOR:RepRap", "; made for RepRapFirmware 3.5"])
@pytest.mark.parametrize("beads", [10, 20000])
def test_the_firmware_is_known_by_its_name_anywhere(kerf, program, name, beads):
    body = "".join(f"G1 X{10 + i % 50} Y{10 + i % 7} E{0.1 * i + 0.1:.3f} F1200\n" for i in range(beads))
    text = "; by a slicer\nM104 S200\nG28\nG10 S200 P0\nG1 X10 Y10 Z0.2 F3000\n" + body
    for file in (text + name + "\n", text.replace("G28\n", "G28\n" + name + "\n")):
        run = kerf("info", program(file, "p.gcode"))
        assert "RepRapFirmware" in run.err and "retract" not in run.err


@pytest.mark.parametrize("setting", ["; gcode_flavor = reprap", "; gcode_flavor = repetier",
                                     ";FLAVOR:Repetier", ";FLAVOR:RepRap (Marlin/Sprinter)"])
def test_sprinter_and_repetier_read_as_marlin(kerf, program, tmp_path, setting):
    moves = "\nM104 S200\nG28\nG1 X10 Y10 Z0.2 F3000\nG1 X30 E1 F1200\n"
    run = kerf("info", program(setting + moves, "p.gcode"))
    assert "Marlin" in run.err
    made = kerf("printer", "import", "p.gcode", "-o", "made.toml")
    assert made.status == 0, made.err
    assert 'firmware = "marlin"' in (tmp_path / "made.toml").read_text()


def test_m0_ends_a_job_of_reprapfirmware_and_m226_pauses_it(kerf, post, program):
    lines = post("; Kerf 0.1.0, marlin\n" + START + BODY + "M0\nG0 X5\n", ("--to", "reprapfirmware"))
    assert "M226" in lines and "M0" not in lines and "G0 X5" in lines
    lines = post("; gcode_flavor = reprapfirmware\n" + START + BODY + "M0\n", ("--to", "marlin"))
    assert "M0" not in lines
    text = "; gcode_flavor = reprapfirmware\n" + START + BODY + "M0\nG0 X5\n"
    steps = kerf("steps", program(text, "q.gcode"))
    assert steps.status == 0 and "pause" not in steps.out and "end" in steps.out


def test_prusa_keeps_checks_of_the_printer(post):
    lines = post("; gcode_flavor = marlin2\nM862.3 P \"MK4\"\n" + START + BODY, ("--to", "prusa"))
    assert 'M862.3 P "MK4"' in lines and "M109 S200" in lines


def test_a_file_of_kerf_has_the_dialect_of_its_post(kerf, program):
    run = kerf("info", program("; Kerf 0.1.0, klipper\n; gcode_flavor = marlin\n" + START + BODY, "p.gcode"))
    assert "Klipper" in run.err


@pytest.mark.parametrize("base", ["marlin", "reprapfirmware"])
def test_filament_by_volume(kerf, post, tmp_path, base):
    (tmp_path / "mine.toml").write_text(f'base = "{base}"\n[printer]\nextruder_unit = "volume"\n')
    lines = post(START + BODY, ("--post", "mine.toml"))
    assert "; use_volumetric_e = 1" in lines and "M200 D1.75" in lines
    assert f"G1 X30 E{AREA:.5f}" in lines
    volumes = [kerf("info", "--json", f).json["print"]["filament_mm3"] for f in ("p.gcode", "out.gcode")]
    assert volumes == pytest.approx([2 * AREA, 2 * AREA], rel=1e-5)


HEADER = 'base = "marlin"\n[variables]\n[templates]\nheader = ["G90", "{extruder}", "M140 S{bed}", "G28", ' \
         '"M190 S{bed}", "M109 S{nozzle}", "G92 E0"]\n'
HEATING = "M83\nM140 S50\nM104 S150\nG28\nM190 S50\nM109 S215\n" + BODY + "M104 S190\nG1 X10 E1\nM104 S0\n"


def test_heating_and_homing_of_the_header_are_not_repeated(post, tmp_path):
    (tmp_path / "mine.toml").write_text(HEADER)
    lines = post(HEATING, ("--post", "mine.toml"))
    codes = [line for line in lines if line.startswith(("M1", "G28"))]
    assert codes == ["M140 S50", "G28", "M190 S50", "M109 S215", "M104 S190", "M104 S0"]
    lines = post(HEATING, ("--post", "mine.toml"), "--set", "bed=65")
    assert [line for line in lines if line.startswith(("M140", "M190"))] == ["M140 S65", "M190 S65"]


def test_a_header_that_does_not_wait_leaves_the_program_its_waits(post, tmp_path):
    (tmp_path / "mine.toml").write_text(HEADER.replace("M109", "M104").replace('"G28", ', ""))
    lines = post(HEATING, ("--post", "mine.toml"))
    codes = [line for line in lines if line.startswith(("M10", "G28"))]
    assert codes == ["M104 S215", "G28", "M109 S215", "M104 S190", "M104 S0"]


def test_a_bead_with_filament_drawn_back(kerf, program):
    """The first 0.8 mm of filament fill the nozzle: 8 of 20 mm of the bead are missing."""
    first = "G1 X10 Y10 Z0.2 F1200\nG1 X30 E2\n"
    text = START + first + "G1 E-0.8 F2400\nG1 X10 Y12 F9000\nG1 X30 E2 F1200\nM84\n"
    found = kerf("check", "--json", program(text, "p.gcode"))
    faults = [h for h in found.json["hazards"] if h["kind"] == "extruded_drawn_back"]
    assert [h["origin"]["line"] for h in faults] == [9] and f"{0.8 * AREA:.2f} mm3" in faults[0]["message"]
    made = kerf("simulate", "--json", "p.gcode").json
    assert made["extruded_mm3"] == pytest.approx(3.2 * AREA, rel=1e-6)
    assert made["road_mm"] == pytest.approx(32.0, abs=1e-6)
    good = text.replace("G1 X30 E2 F1200", "G1 E0.8 F2400\nG1 X30 E2 F1200")
    assert "extruded_drawn_back" not in kerf("check", "--json", program(good, "p.gcode")).out
    firmware = START + first + "G10\nG1 X10 Y12 F9000\nG1 X30 E2 F1200\nM84\n"
    assert "extruded_drawn_back" in kerf("check", "--json", program(firmware, "p.gcode")).out


PART = """; filament_diameter = 1.75
M83
M104 S200
G28
M109 S200
G1 X0 Y0 Z0.2 F1200
G1 X50 E2 F1200
G1 E-0.8 F2400
;LAYER_CHANGE
;TYPE:Perimeter
M106 S255
G1 X10 Y10 Z0.2 F9000
G1 E0.8 F2400
G1 X30 E1 F1200
G1 X30 Y30 E1
G1 E-0.8 F2400
M106 S0
G1 Z5
G28 X
M84
"""


def test_a_print_is_repeated_without_its_start(post):
    """Each copy has its fan and its filament; homing and the purge line are those of the program, once."""
    lines = post(PART, ("--to", "marlin"), "--columns", "2", "--pitch", "40,0")
    assert lines.count("G28") == 1 and sum(line.startswith("G1 X50 E2") for line in lines) == 1
    codes = [line for line in lines if line.startswith(("G0", "G1", "M106", "M107"))]
    second = codes[codes.index("G0 Z7"):]  # 2 mm above the highest point of a copy
    assert second == ["G0 Z7", "M106 S255", "G0 X50 Y10", "G0 Z0.2", "G1 E0.8", "G1 X70 E1 F1200",
                      "G1 Y30 E1", "G1 E-0.8 F2400", "M107", "G1 Z5"]


def test_a_print_that_is_homed_within_is_not_repeated(kerf, program):
    text = PART.replace("G1 X30 Y30", "G28 X\nG1 X30 Y30")
    copies = ["--columns", "2", "--pitch", "40,0"]
    run = kerf("post", "--json", "--to", "marlin", *copies, program(text, "p.gcode"))
    assert run.status == 1 and "pass_refused" in run.codes()


@pytest.mark.parametrize("start", ["", "T0\n"])
def test_each_copy_starts_with_the_first_extruder(post, start):
    """A printer starts with extruder 0 (Marlin, Klipper); the copy before ends with another one."""
    text = (f"M104 T0 S210\nM104 T1 S200\nG28\nG90\nM83\n{start}G1 Z0.2 F600\n;TYPE:Perimeter\n"
            "G1 X10 Y10 F6000\nG1 X20 Y10 E0.5 F1200\nT1\nG1 X10 Y20 F6000\nG1 X20 Y20 E0.5\nG1 Z5\nM84\n")
    lines = post(text, ("--to", "marlin"), "--columns", "2", "--pitch", "40,0")
    extruder, beads = "T0", []
    for line in lines:
        if line in ("T0", "T1"):
            extruder = line
        if line.startswith("G1") and "E0.5" in line:
            beads.append((extruder, line.split()[1]))
    assert beads == [("T0", "X20"), ("T1", "X20"), ("T0", "X60"), ("T1", "X60")]


def test_a_laser_job_without_heights_is_repeated(post):
    text = "M4 S0\nG0 X0 Y0\nG1 X10 S300 F1000\nG0 X20 Y20\nM3 S200\nG1 X30 F500\nM5\nM2\n"
    lines = post(text, ("--to", "laser"), "--dialect", "laser", "--columns", "2", "--pitch", "40,0")
    second = lines[lines.index("G0 X40 Y0"):]
    assert second[1:3] == ["M4 S300", "G1 X50 F1000"] and "M3 S200" in second and "G1 X70 F500" in second


def test_cuts_around_the_fourth_axis_are_repeated_along_it(post, kerf, program):
    text = "G21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z30 A0\nG1 Z18 F100\nG1 A90 X5\nG0 Z30\nM30\n"
    lines = post(text, ("--to", "linuxcnc"), "--columns", "2", "--pitch", "20,0")
    assert lines[lines.index("X20 A0"):][:4] == ["X20 A0", "G1 Z18", "X25 A90", "G0 Z30"]
    refused = kerf("post", "--to", "linuxcnc", "--rows", "2", "--pitch", "20,20", program(text))
    assert refused.status == 1 and "columns only" in refused.err

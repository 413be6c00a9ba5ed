"""kerf check on programs of lasers: a beam in rapids, at rest, left on; GRBL's laser mode on and off."""
import pytest

LASER_MODE = "$30=1000\n$32=1\n"
SPINDLE_MODE = "$30=1000\n$32=0\n"

# The usual forms of programs for lasers: the beam switched by S on the motions (M4), by S on lines of its own
# (M3), by M3 and M5 alone; a raster in incremental coordinates.
ON_MOTIONS = """; LightBurn 1.4
; GRBL device profile, absolute coords
G00 G17 G40 G21 G54
G90
M4
; Cut @ 10 mm/sec, 80% power
M8
G0 X10 Y10
G1 X60 S800 F600
G1 Y40
G1 X10
G1 Y10
G0 X20 Y20
G1 X30 S800
M9
G1 S0
M5
G90
G0 X0 Y0
M2
"""
BY_POWER = """M3 S0
S0
G0X0Y16
S1000
G1X100F1200
S0
M5 S0
M3 S0
S0
G0X0Y12
S1000
G1X100F1000
S0
M5 S0
"""
BY_SWITCH = """G21
G90
G0 X10 Y10
M3 S255
G1 X60 F600
G2 X60 Y20 I0 J5
M5
G0 X10 Y30
M3 S255
G1 X60 F600
M5
G0 X0 Y0
M2
"""
RASTER = """; LightBurn 0.9
G90
G0 X0 Y0
G91
M4
G0X10Y60
G1X5F1500S255
G1X3S0
G1X2Y0.1S120
G1X-10S0
G0Y1
G1X-5S255
M5
G90
M2
"""
PROGRAMS = [ON_MOTIONS, BY_POWER, BY_SWITCH, RASTER]


def findings(run):
    """(kind, line) of the hazards of the beam."""
    return [(h["kind"], h["origin"]["line"]) for h in run.json["hazards"] if h["kind"].startswith("beam")]


@pytest.mark.parametrize("text", PROGRAMS)
@pytest.mark.parametrize("settings", [None, LASER_MODE])
def test_usual_programs_have_no_hazard_of_the_beam(kerf, program, text, settings):
    machine = ["--machine", program(settings, "grbl.txt")] if settings else []
    run = kerf("check", "--json", *machine, program(text))
    assert findings(run) == [], run.out
    assert {h["kind"] for h in run.json["hazards"]} <= {"no_program_end"}


@pytest.mark.parametrize("text, old, new, free, laser_mode, spindle_mode", [
    # M3: the beam is not switched off before a rapid
    (BY_POWER, "G1X100F1200\nS0\nM5 S0\nM3 S0\nS0\n", "G1X100F1200\n", [("beam_in_rapid", 6)], [],
     [("beam_in_rapid", 6)]),
    (BY_SWITCH, "M5\nG0 X10 Y30", "G0 X10 Y30", [("beam_in_rapid", 7)], [], [("beam_in_rapid", 7)]),
    # M4: without laser mode it is a spindle that turns to the left
    (ON_MOTIONS, "", "", [], [], [("beam_in_rapid", 13)]),
    # the beam is at rest
    (BY_SWITCH, "M3 S255\nG1 X60 F600\nG2", "M3 S255\nG4 P0.5\nG1 X60 F600\nG2", [("beam_standing", 5)], [],
     [("beam_standing", 5)]),  # laser mode: the motion before is G0, where it is off
    (BY_SWITCH, "I0 J5\n", "I0 J5\nG4 P2\n", [("beam_standing", 7)], [("beam_standing", 7)],
     [("beam_standing", 7)]),
    (ON_MOTIONS, "G1 Y40\n", "G1 Y40\nG4 P2\n", [], [], [("beam_standing", 11), ("beam_in_rapid", 14)]),
    (BY_SWITCH, "I0 J5\n", "I0 J5\nM0\n", [("beam_standing", 7)], [], [("beam_standing", 7)]),
    (ON_MOTIONS, "G1 Y40\n", "G1 Y40\nG1 Z-1\n", [("beam_standing", 11)], [("beam_standing", 11)],
     [("beam_standing", 11), ("beam_in_rapid", 14)]),
    # the beam is left on
    (BY_POWER, "G1X100F1000\nS0\nM5 S0\n", "G1X100F1000\n", [("beam_left_on", 12)], [("beam_left_on", 12)],
     [("beam_left_on", 12)]),
    (ON_MOTIONS, "M9\nG1 S0\nM5\nG90\nG0 X0 Y0\nM2\n", "", [("beam_left_on", 14)], [("beam_left_on", 14)],
     [("beam_in_rapid", 13), ("beam_left_on", 14)]),
    # M2 switches it off on GRBL
    (BY_SWITCH, "M5\nG0 X0 Y0\nM2", "M2", [("beam_left_on", 11)], [], []),
])
def test_each_hazard_has_its_line(kerf, program, text, old, new, free, laser_mode, spindle_mode):
    assert old in text
    path = program(text.replace(old, new, 1) if old else text)
    run = kerf("check", "--json", "--dialect", "laser", path)
    assert findings(run) == free, run.out
    assert all(h["hint"] for h in run.json["hazards"] if h["kind"].startswith("beam"))
    assert run.status == (3 if run.json["hazards"] else 0)
    for settings, expected in [(LASER_MODE, laser_mode), (SPINDLE_MODE, spindle_mode)]:
        machine = program(settings, "grbl.txt")
        run = kerf("check", "--json", "--dialect", "laser", "--machine", machine, path)
        assert findings(run) == expected, (settings, run.out)


def test_laser_mode_makes_the_program_one_of_a_laser(kerf, program):
    path = program("G21 G90\nM3 S500\nG1 X10 F600\nG4 P1\nM5\nM2\n")
    assert findings(kerf("check", "--json", path)) == []  # a spindle
    run = kerf("check", "--json", "--machine", program(LASER_MODE, "grbl.txt"), path)
    assert findings(run) == [("beam_standing", 4)]


def test_all_rapids_until_the_beam_is_switched_off_are_one_finding(kerf, program):
    thrice = "G1 X20 F900\nG0 X0\nG1 X10\nG0 X0 Y5\n" * 3
    text = f"; LaserGRBL\nG21 G90\nM3 S300\n{thrice}M5\nG0 X0\nM2\n"
    hazards = kerf("check", "--json", program(text)).json["hazards"]
    assert [(h["kind"], h["origin"]["line"], h["steps"]) for h in hazards] == [("beam_in_rapid", 5, 6)]
    assert "S 300 (M3)" in hazards[0]["message"] and "$32=1" in hazards[0]["hint"]


def test_a_power_above_the_machines_maximum(kerf, program):
    text = "; LaserGRBL\nG21 G90\nM4 S0\nG1 X20 S1000 F900\nG1 X0 S900\nM5\nM2\n"
    machine = program("$30=255\n$32=1\n", "grbl.txt")
    hazards = kerf("check", "--json", "--machine", machine, program(text)).json["hazards"]
    assert [(h["kind"], h["origin"]["line"]) for h in hazards] == [("spindle_range", 4)]
    assert "S 255" in hazards[0]["message"]


@pytest.mark.parametrize("line, found", [
    ("G1 Z-1", True), ("G1 X10 Z-1", False), ("G1 A90", False), ("G1 X0", False), ("G2 I5", False),
])
def test_only_motions_without_x_and_y_burn_deep(kerf, program, line, found):
    text = f"; LaserGRBL\nG21 G90\nG0 X0 Y0 Z0\nM4 S500\nG1 F300\n{line}\nM5\nM2\n"
    expected = [("beam_standing", 6)] if found else []
    assert findings(kerf("check", "--json", program(text))) == expected


def test_unknown_positions_may_move(kerf, program):
    """The position before the first motion is unknown: whether X moves is, too."""
    text = "; LaserGRBL\nG21 G90\nM4 S500\nG1 X0 F300\nG1 Z-1\nM5\nM2\n"
    assert findings(kerf("check", "--json", program(text))) == [("beam_standing", 5)]

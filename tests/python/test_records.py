"""What Python returns is what the command prints: one record for each kind of thing."""
import json
import subprocess

import kerf
import pytest
from kerf_command import command

MILLED = """G21 G90 G17 G54
T102 M6
M3 S10000
M8
G64 P0.01
G43 H1
G10 L2 P2 X5 Y5
G0 X10 Y10 Z5
G1 Z-1 F100
G1 X20 A30 F400
G3 X20 Y20 I0 J5
G4 P0.5
M0
G38.2 Z-3 F50
G92 Z0
G28.1
G31 Z-5
(MSG, done)
M30
"""
PRINTED = """; filament_diameter = 1.75
;LAYER:0
M104 S200
M109 S200 T0
M106 S128
M201 X500 Y500
T1
G28
G1 X10 Y10 Z0.2 F3000
G1 X30 E1 F1200
G1 E0.5 F1800
M117 done
"""
LAYERS = """feedrate(100mm); layer("outline"); goto([0mm, 0mm, 5mm]); move([-, -, -1mm]);
"""
BURNT = """G21 G90
M4 S300
G0 X0 Y0
G1 X10 F1000
M5
M2
"""
# Every kind of step but "closepath" and "unresolved" values, which no G-code makes.
KINDS = {"rapid", "cut", "arc", "dwell", "tool", "spindle", "coolant", "pathmode", "probe", "extrude",
         "temperature", "fan", "laser", "layer", "note", "verbatim", "pause", "end", "storehome", "workzero",
         "toollength", "unresolved", "limits", "extruder"}


def plain(value):
    """Tuples as lists, as JSON has them."""
    return json.loads(json.dumps(value))


def printed(*words):
    done = subprocess.run([command(), *map(str, words)], capture_output=True, text=True, timeout=120)
    assert done.returncode in (0, 3), done.stderr
    return done.stdout


@pytest.fixture
def files(tmp_path):
    made = {}
    texts = {"milled.nc": MILLED, "printed.gcode": PRINTED, "burnt.nc": BURNT, "layers.gcmc": LAYERS}
    for name, text in texts.items():
        made[name] = tmp_path / name
        made[name].write_text(text)
    return made


@pytest.mark.filterwarnings("ignore")
def test_each_step_is_its_line_of_kerf_steps(files):
    seen = set()
    for path in files.values():
        dialect = "laser" if path.name == "burnt.nc" else None
        words = ["--dialect", dialect] if dialect else []
        lines = [json.loads(line) for line in printed("steps", path, *words).splitlines()[1:]]
        toolpath = kerf.load(path, dialect=dialect).toolpath
        assert [plain(toolpath[i]) for i in range(len(toolpath))] == lines
        seen |= {line["step"] for line in lines}
    assert seen == KINDS


@pytest.mark.filterwarnings("ignore")
def test_hazards_are_those_of_the_command(files):
    bad = files["milled.nc"].with_name("bad.nc")
    bad.write_text("G21 G90\nT102 M6\nM3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20\nG0 X20 Y9\nM2\n")
    stock = "40x40x6 at centre top"
    want = json.loads(printed("simulate", bad, "--json", "--stock", stock, "--resolution", "0.2"))
    program = kerf.load(bad)
    result = kerf.simulate(program, kerf.Stock.read(stock), resolution=0.2)
    assert want["hazards"] and plain(result.hazards) == want["hazards"]
    times = json.loads(printed("info", bad, "--json"))["time_s"]
    assert plain(kerf.estimate(program)) == times
    assert plain(program.toolpath.report()) == json.loads(printed("info", bad, "--json"))["motion"]

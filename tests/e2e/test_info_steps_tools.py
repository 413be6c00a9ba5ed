"""kerf info, steps and tools: their JSON and text."""
import json
import math
import re
from pathlib import Path

import pytest
from conftest import VALID

GRBL = "$0=10\n$110=1000.000 (x max rate)\n$111=2000\n$112=500\n"


def test_info_json(kerf, program):
    run = kerf("info", "--json", program())
    assert run.status == 0, run.err
    got = run.json
    assert (got["motion"]["lines"], got["motion"]["arcs"]) == (2, 1)
    assert got["motion"]["cut_mm"] == pytest.approx(6 + 10 + 5 * math.pi)
    low, high = got["motion"]["cut_bounds_mm"]
    assert low == pytest.approx([10, 10, -1]) and high[:2] == pytest.approx([25, 20])
    assert got["units"] == "mm" and got["ended"] is True
    tool, = got["tools"]
    assert (tool["number"], tool["known"], tool["deepest_mm"], tool["flute_mm"]) == (102, True, -1, 12.7)
    assert got["feeds"] == {"min": 100, "max": 400}
    assert got["speeds"] == {"min": 10000, "max": 10000}
    assert got["stock"]["block_mm"] == [[0, 0, -6], [40, 30, 0]]
    time = got["time_s"]
    assert time["total"] == pytest.approx(time["motion"] + time["dwell"])
    assert time["cutting"] == pytest.approx(6 / 100 * 60 + (10 + 5 * math.pi) / 400 * 60)
    assert time["tools"][0]["number"] == 102
    assert isinstance(got["diagnostics"], list)


def test_info_text(kerf, program):
    run = kerf("info", program())
    assert run.status == 0
    for word in ("Motions", "Time", "T102", "square 3.175 mm", "100 to 400 mm/min", "10000 rpm"):
        assert word in run.out


def test_info_names_tools_that_cut_deeper_than_their_flute(kerf, program):
    for depth, deeper in ((-12.6, False), (-12.8, True)):  # the flute of tool 102 is 12.7 mm
        out = kerf("info", program(f"M6 T102\nM3 S1000\nG0 X0 Y0 Z2\nG1 Z{depth} F100\nM2\n")).out
        assert ("deeper than its flute" in out) == deeper


def test_info_of_inches(kerf, program):
    run = kerf("info", "--json", program("G20\nM6 T102\nM3 S1\nG1 X1 F10\nM2\n"))
    assert run.json["units"] == "inch"
    assert run.json["motion"]["cut_mm"] == pytest.approx(25.4)


def test_info_warns_of_an_unknown_tool(kerf, program):
    run = kerf("info", "--json", program(VALID.replace("T102", "T77")))
    assert run.status == 0
    assert "no_tool_shape" in run.codes()
    assert run.json["tools"][0]["known"] is False


def test_info_plans_with_grbl_settings(kerf, program):
    path = program()
    planned = kerf("info", "--json", "--machine", program(GRBL, "grbl.txt"), path)
    assert planned.status == 0
    assert "machine_incomplete" in planned.codes()
    plain = kerf("info", "--json", path).json["time_s"]
    time = planned.json["time_s"]
    assert "without acceleration" in plain["method"] and "planned" in time["method"]
    assert time["rapid"] > plain["rapid"] and time["cutting"] > plain["cutting"]
    assert time["total"] == pytest.approx(time["motion"] + time["dwell"] + time["halts"])
    assert sum(t["total"] for t in time["tools"]) == pytest.approx(time["total"])
    assert sum(o["total"] for o in time["operations"]) == pytest.approx(time["total"])


def test_info_plans_with_a_profile(kerf, program):
    machine = program("name = \"my mill\"\nacceleration = [10, 10, 10]\n", "m.toml")
    run = kerf("info", "--machine", machine, program())
    assert run.status == 0 and "on my mill, planned" in run.out


def test_a_grbl_reads_on_after_m2(kerf, program):
    path = program(VALID + "G0 X30\n")
    machine = program(GRBL, "grbl.txt")
    stopped = kerf("info", "--json", path).json["motion"]["rapids"]
    assert kerf("info", "--json", "--machine", machine, path).json["motion"]["rapids"] == stopped + 1


@pytest.mark.parametrize("text, code", [
    ("", "machine_file"), ("hello\n", "machine_file"), ("$110=0\n$111=1\n$112=1\n", "machine_value"),
    ("$110=nan\n", "machine_value"), ("$110=1e999\n", "machine_value"),
    ("rates = 5\n", "machine_key_unknown"),
])
def test_an_invalid_machine_file_is_an_error(kerf, program, text, code):
    run = kerf("info", "--json", "--machine", program(text, "grbl.txt"), program())
    assert run.status == 1
    assert run.codes() == [code]


def test_a_built_in_machine_needs_no_file(kerf, program, tmp_path):
    source = Path(__file__).parents[2] / "data" / "machines" / "grbl_router.toml"
    by_name = kerf("info", "--json", "--machine", "grbl_router", program())
    by_file = kerf("info", "--json", "--machine", source, program())
    assert by_name.status == 0 and by_name.json["time_s"] == by_file.json["time_s"]
    # A file of that name precedes it.
    (tmp_path / "grbl_router").write_text('name = "my mill"\n')
    assert "on my mill, planned" in kerf("info", "--machine", "grbl_router", program()).out


def test_an_unknown_machine_names_the_built_in_ones(kerf, program):
    run = kerf("info", "--machine", "grbl_ruoter", program())
    assert run.status == 1 and "grbl_laser, grbl_router" in run.err


MACHINES = Path(__file__).parents[2] / "data" / "machines"
# Of X, Y and Z, from the settings of each: $130 to $132.
TRAVEL = {"shapeoko_3": (425, 465, 80), "x_carve_1000": (740, 790, 100),
          "longmill_mk2_30x30": (810, 855, 120), "openbuilds_lead_1010": (810, 730, 90),
          "sherline_5400": (225, 125, 170)}


@pytest.mark.parametrize("name", sorted(path.stem for path in MACHINES.glob("*.toml")))
def test_each_built_in_machine_is_read_and_documented(kerf, program, name):
    text = (MACHINES / f"{name}.toml").read_text()
    run = kerf("info", "--machine", name, program())
    assert run.status == 0 and run.err == ""
    manual = (MACHINES.parents[1] / "docs" / "manual" / "machine.md").read_text()
    title = re.search(r'^name = "(.*)"', text, re.M)[1]
    assert f"on {title}, planned" in run.out
    assert f"| `{name}` | {title} |" in manual


@pytest.mark.parametrize("name", sorted(TRAVEL))
def test_a_program_longer_than_a_machine_is_found(kerf, program, name):
    for axis, length in zip("XYZ", TRAVEL[name]):
        for over, wanted in ((-1, False), (1, True)):
            text = f"G21 G90\nG0 X0 Y0 Z0\nG1 {axis}{length + over} F500\nM2\n"
            run = kerf("check", "--json", "--machine", name, program(text, "p.nc"))
            found = [h for h in run.json["hazards"] if h["kind"] == "outside_machine"]
            assert bool(found) == wanted, (axis, over)


FUSION = """{"data": [{"type": "flat end mill", "unit": "inches", "description": "quarter inch",
 "geometry": {"DC": 0.25, "LCF": 0.75, "NOF": 3, "SFDM": 0.25}, "post-process": {"number": 7}}]}"""


def test_tools_are_imported_and_exported(kerf, program, tmp_path):
    run = kerf("tools", "import", program(FUSION, "f.json"), "-o", "mine.toml")
    assert run.status == 0, run.err
    shown = kerf("tools", "show", "7", "--tools", "mine.toml", "--json").json
    got = [shown[key] for key in ("shape", "diameter_mm", "flute_mm", "teeth")]
    assert got == ["square", 6.35, pytest.approx(19.05), 3]
    run = kerf("tools", "export", "--tools", "mine.toml", "-o", "tool.tbl", "--unit", "inch")
    assert run.status == 0, run.err
    assert (tmp_path / "tool.tbl").read_text() == (
        "T7 P1 Z0 D0.25 ;square, diameter 6.35 mm, flute 19.05 mm, shank diameter 6.35 mm, "
        "shank length 20 mm, 3 teeth / quarter inch\n")


def test_other_files_are_not_imported(kerf, program, files):
    run = kerf("tools", "import", "--json", program("hello", "x.csv"), "-o", "mine.toml")
    assert run.status == 1 and run.codes() == ["tool_library_unknown"]
    assert files() == ["x.csv"]
    assert kerf("tools", "import", program(FUSION, "f.json"), "-o", "mine.xyz").status == 2


def test_the_wrong_kind_of_file_is_reported_first(kerf, program):
    run = kerf("tools", "import", program())
    assert run.status == 1 and "[3022]" in run.err and "--output" not in run.err  # tool_library_unknown
    run = kerf("tools", "import", program(FUSION, "f.json"))
    assert run.status == 0 and "[[tool]]" in run.out


def test_tools_shapes_lists_every_key(kerf):
    out = kerf("tools", "shapes").out
    for word in ("bull nose", "corner_radius", "neck_length", "head", "plunges", "(d, dia)", "thread mill"):
        assert word in out
    got = kerf("tools", "shapes", "--json").json
    keyhole = next(s for s in got["shapes"] if s["shape"] == "keyhole")
    assert [m["key"] for m in keyhole["measures"]] == ["diameter", "head", "neck_diameter", "flute"]
    keys = [k["key"] for k in got["keys"]]
    for key, value in (("neck_length", "5"), ("neck_diameter", "2"), ("shank_length", "5"), ("teeth", "3")):
        assert key in keys
    shown = kerf("tools", "show", "square d=3 flute=5 neck_diameter=2 neck_length=5 shank=3 teeth=3")
    assert shown.status == 0, shown.err
    assert "kerf tools shapes" in kerf("simulate", "--help").out


def test_info_has_the_figures_of_a_program_with_errors(kerf, program):
    run = kerf("info", "--json", program(VALID.replace("G1 X20 F400", "G1 X20 F400 X")))
    assert run.status == 1
    assert run.json["motion"]["lines"] >= 1
    error = next(d for d in run.json["diagnostics"] if d["severity"] == "error")
    assert error["origin"]["line"] == 9 and error["origin"]["column"] > 0


def test_steps_are_json_lines(kerf, program):
    path = program()
    run = kerf("steps", path)
    assert run.status == 0
    head, *steps = [json.loads(line) for line in run.out.splitlines()]
    assert head == {"kerf_steps": 1, "units": "mm", "source": str(path)}
    assert [s["step"] for s in steps if s["step"] in ("tool", "rapid", "cut", "arc")][:1] == ["tool"]
    arc = next(s for s in steps if s["step"] == "arc")
    assert arc["to"] == [20, 20, -1] and arc["centre"] == [20, 15]
    assert (arc["plane"], arc["turn"], arc["extra_turns"]) == ("XY", "ccw", 0)
    assert (arc["feed"], arc["tool"]) == (400, 102)
    assert arc["origin"]["line"] == 10
    spindle = next(s for s in steps if s["step"] == "spindle")
    assert (spindle["rpm"], spindle["turn"]) == (10000, "cw")
    cut = next(s for s in steps if s["step"] == "cut")
    assert cut["to"] == [10, 10, -1] and cut["feed"] == 100


def test_steps_prints_nothing_for_a_program_with_errors(kerf, program):
    run = kerf("steps", program("G1 X\n"))
    assert run.status == 1
    assert run.out == "" and "part.nc:1:" in run.err


def test_tools_list(kerf):
    run = kerf("tools", "list")
    assert run.status == 0 and "102" in run.out
    tools = kerf("tools", "list", "--json").json["tools"]
    by_number = {t["number"]: t for t in tools}
    assert by_number[102]["shape"] == "square"
    assert by_number[102]["diameter_mm"] == 3.175 and by_number[102]["flute_mm"] == 12.7


def test_tools_show(kerf):
    run = kerf("tools", "show", "102")
    assert run.status == 0
    assert "square" in run.out and "####" in run.out and "12.7" in run.out
    shown = kerf("tools", "show", "102", "--json").json
    assert shown["number"] == 102
    assert max(k["r"] for k in shown["profile_mm"]["cutting"]) == pytest.approx(1.5875)


def test_tools_show_a_shape_in_words(kerf):
    shown = kerf("tools", "show", "V d=12.7 angle=90", "--json")
    assert shown.status == 0
    assert shown.json["diameter_mm"] == 12.7


def test_tools_show_an_unknown_one(kerf):
    run = kerf("tools", "show", "4711471", "--json")
    assert run.status == 1
    assert run.json["diagnostics"]


def test_the_title_of_a_specification_is_its_shape(kerf):
    assert kerf("tools", "show", "square d=3").out.startswith("square 3 mm\n")
    assert kerf("tools", "show", "102").out.startswith("102 ")


def test_impossible_measures_are_reported_with_the_valid_keys(kerf):
    run = kerf("tools", "show", "square d=3 flute=0")
    assert run.status == 1
    assert run.err.startswith('"square d=3 flute=0": error: flute must be above 0')
    run = kerf("tools", "show", "V d=3 zzzz=1")
    assert "hint: its dimensions: diameter, flute, angle" in run.err


def test_the_help_of_tools_has_examples(kerf):
    out = kerf("tools", "--help").out
    assert "Examples:" in out and "kerf tools list" in out and "kerf tools show 102" in out


SIDE = "G21 G90 F100\nT7 M6\nG41\nG1 X20\nX40\nG40\nG1 Y20\nM2\n"


def ends_of(run):
    steps = [json.loads(line) for line in run.out.splitlines()]
    return [s["to"][:2] for s in steps if s.get("step") in ("rapid", "cut")]


def test_compensation_takes_the_tool_of_the_command(kerf, program):
    run = kerf("info", "--json", "--tool", "7=square d=6", program(SIDE))
    assert run.status == 0, run.err
    assert run.json["motion"]["cut_bounds_mm"][1][:2] == pytest.approx([40, 20])
    assert run.json["motion"]["cut_mm"] == pytest.approx(math.hypot(20, 3) + 20 + 17)
    run = kerf("info", "--json", program(SIDE))
    assert run.status == 0 and "compensation_no_tool" in run.codes()  # assumed, with a warning
    assert "--tool 7=" in run.json["diagnostics"][0]["hint"]
    run = kerf("steps", program(SIDE))
    assert run.status == 1 and "[2045]" in run.err and "--tool 7=" in run.err


def test_a_dialect_can_be_forced(kerf, program):
    path = program("G21 G90\nG4 P500\nM2\nG0 X1\nM2\n")
    seconds = {name: kerf("info", "--json", "--dialect", name, path).json["time_s"]["dwell"]
               for name in ("linuxcnc", "Marlin")}
    assert seconds == pytest.approx({"linuxcnc": 500, "Marlin": 0.5})
    wrong = kerf("steps", "--dialect", "siemens", path)
    assert wrong.status == 2 and "siemens" in wrong.err and "fanuc" in wrong.err
    near = kerf("steps", "--dialect", "grlb", path)
    assert near.status == 2 and "did you mean grbl?" in near.err and "klipper" in near.err


def test_several_programs_of_a_file(kerf, program):
    path = program("G21 G90\nG0 X1\nM2\nG0 X2\nM2\n")
    stopped = kerf("steps", path)
    assert len(ends_of(stopped)) == 1 and "--read-on" in stopped.err
    for option in (["--read-on"], ["--dialect", "grbl"]):
        assert [x for x, y in ends_of(kerf("steps", *option, path))] == [1, 2]


def test_strict_makes_errors_of_warnings(kerf, program):
    path = program("G21 G90\nG0 X1 P5\nM2\n")
    assert kerf("info", path).status == 0
    assert kerf("info", "--strict", path).status == 1

"""kerf info, steps and tools: the shapes of their JSON and what people read."""
import json
import math

import pytest
from conftest import SOUND

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
    for word in ("Moves", "Time", "T102", "square 3.175 mm", "100 to 400 mm/min", "10000 rpm"):
        assert word in run.out


def test_info_of_inches(kerf, program):
    run = kerf("info", "--json", program("G20\nM6 T102\nM3 S1\nG1 X1 F10\nM2\n"))
    assert run.json["units"] == "inch"
    assert run.json["motion"]["cut_mm"] == pytest.approx(25.4)


def test_info_warns_of_an_unknown_tool(kerf, program):
    run = kerf("info", "--json", program(SOUND.replace("T102", "T77")))
    assert run.status == 0
    assert "no_tool_shape" in run.codes()
    assert run.json["tools"][0]["known"] is False


def test_info_takes_rapid_rates_from_grbl_settings(kerf, program):
    path = program()
    slow = kerf("info", "--json", "--machine", program(GRBL, "grbl.txt"), path)
    assert slow.status == 0
    assert slow.json["time_s"]["rapid"] > kerf("info", "--json", path).json["time_s"]["rapid"]
    assert "without acceleration" in slow.json["time_s"]["method"]


@pytest.mark.parametrize("text", ["", "$110=0\n$111=1\n$112=1\n", "$110=nan\n", "$110=1e999\n", "hello\n"])
def test_a_machine_file_without_rates_is_an_error(kerf, program, text):
    run = kerf("info", "--json", "--machine", program(text, "grbl.txt"), program())
    assert run.status == 1
    assert run.codes() == ["machine_file"]


def test_info_still_tells_of_a_program_with_errors(kerf, program):
    run = kerf("info", "--json", program(SOUND.replace("G1 X20 F400", "G1 X20 F400 X")))
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

"""Codes that are left out and may move the tool: refused by `kerf post`, hazards of `kerf simulate`."""
import pytest

HEAD = "G21 G90\nT1 M6\nS9000 M3\n"
PART = HEAD + "G0 X10 Y10 Z5\nG1 Z-5 F100\n{}\nG0 X90\nG0 Z10\nM30\n"
TOOL = ["--tool", "square d=6 flute=20", "--stock", "100x60x12"]
CODES = ["G65 P9810 Z50.", "G31 Z-30\nG92 Z0", "G54.1 P3", "G154 P3", "G150 X5 Y5", "G12 I5", "G77.7 X1",
         "G66 P1", "$H", "M123", "M77"]


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("post", ["grbl", "linuxcnc", "mach3", "carbide"])
def test_a_code_that_may_move_the_tool_is_refused(kerf, program, files, code, post):
    path = program(PART.format(code))
    before = files()
    run = kerf("post", "--json", "--to", post, path, "-o", "out.nc")
    assert run.status == 1 and "post_code_left_out" in run.codes() and files() == before
    found = next(d for d in run.json["diagnostics"] if d["name"] == "post_code_left_out")
    assert found["origin"]["line"] == 6 and "--allow-left-out" in found["hint"]
    allowed = kerf("post", "--to", post, "--allow-left-out", path)
    assert allowed.status == 0 and "X90" in allowed.out, allowed.err


@pytest.mark.parametrize("code", [c for c in CODES if c != "$H"])
def test_simulate_shows_it_with_the_hazards(kerf, program, code):
    path = program(PART.format(code))
    how = [*TOOL, "--dialect", "linuxcnc"]  # G154 alone is Haas, which has it
    text = kerf("simulate", *how, path)
    assert text.status == 0 and "hazards  none" not in text.out + text.err
    run = kerf("simulate", "--json", *how, path).json
    assert [h["origin"]["line"] for h in run["hazards"] if h["kind"] == "left_out"] == [6]
    assert not [d for d in run["diagnostics"] if d["name"] == "unknown_g_code"]  # reported once


def test_a_simulation_around_the_fourth_axis_shows_it(kerf, program):
    path = program(HEAD + "G0 X10 Y0 Z30 A0\nG1 Z18 F100\nG1 A90\nG0 Z30\nG12 I5\nM30\n")
    run = kerf("simulate", "--rotary", "40x60", "--tool", "square d=6 flute=20", path)
    assert "hazards  none" not in run.out + run.err


@pytest.mark.parametrize("code", ["G110", "G129", "G154 P3", "G54.1 P3"])
def test_further_offsets_of_haas_are_refused(kerf, program, code):
    run = kerf("post", "--json", "--to", "linuxcnc", "--dialect", "haas", program(PART.format(code)))
    assert run.status == 1 and {"offset_unknown", "post_code_left_out"} <= set(run.codes())


def test_extended_offsets_are_unknown_on_fanuc_and_haas(kerf, program):
    path = program(HEAD + "G0 X10 Y10 Z5\nG1 Z-1 F100\nG0 Z5\nG54.1 P3 X0 Y0\nG1 Z-1\nG0 Z5\nM30\n")
    run = kerf("check", "--json", "--dialect", "haas", *TOOL, path).json
    assert [h["origin"]["line"] for h in run["hazards"] if h["kind"] == "offset_unknown"] == [7]
    assert kerf("post", "--to", "linuxcnc", "--dialect", "haas", path).status == 1


def test_procedures_of_printers_are_no_errors(kerf, program):
    path = program("M104 S200\nG28\nG29\nG1 X5 Y5 Z0.2 F3000\nG1 X20 E1\nM104 S0\n", "a.gcode")
    assert kerf("post", "--to", "marlin", path).status == 0

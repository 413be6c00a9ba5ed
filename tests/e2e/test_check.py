"""kerf check: exit status 3 with the hazards of the path and of the material; 0 for a sound program."""
import pytest
from conftest import SOUND


def kinds(run):
    return sorted({h["kind"] for h in run.json["hazards"]})


def test_a_sound_program(kerf, program, files):
    run = kerf("check", "--json", program())
    assert run.status == 0, run.out
    assert run.json["hazards"] == []
    assert files() == ["part.nc"]
    text = kerf("check", program())
    assert text.status == 0 and "no hazard found" in text.out
    assert kerf("check", "-q", program()).out == ""


@pytest.mark.parametrize("old, new, kind", [
    ("F100\nG1 X20 F400", "\nG1 X20", "no_feed"),
    ("M6 T102\n", "", "no_tool"),
    ("M3 S10000\n", "", "spindle_off"),
    ("M3 S10000\n", "M3 S10000\nM5\n", "spindle_off"),
    ("M2\n", "", "no_program_end"),
    ("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5", "rapid_in_stock"),
    ("G1 Z-1", "G1 Z-8", "below_floor"),
])
def test_each_hazard_is_found_with_its_kind(kerf, program, old, new, kind):
    assert old in SOUND
    run = kerf("check", "--json", program(SOUND.replace(old, new)))
    assert run.status == 3, run.out
    assert kind in kinds(run)
    for hazard in run.json["hazards"]:
        assert set(hazard) >= {"kind", "at", "depth_mm", "removed_mm3", "origin", "message", "step"}
        assert len(hazard["at"]) == 3 and hazard["origin"]["line"] > 0


@pytest.mark.parametrize("machine, kind", [
    ("travel_x = [0, 5]\n", "outside_machine"),
    ("spindle = [100, 8000]\n", "spindle_range"),
])
def test_hazards_of_the_machine(kerf, program, machine, kind):
    run = kerf("check", "--json", "--machine", program(machine, "m.toml"), program())
    assert run.status == 3, run.out
    assert kinds(run) == [kind]
    assert all(h["hint"] for h in run.json["hazards"])


def test_hazards_of_the_material(kerf, program):
    fast = program(SOUND.replace("F400", "F8000"))
    assert kinds(kerf("check", "--json", "--material", "steel", fast)) == ["chip_load"]
    assert kerf("check", "--material", "cheese", fast).status == 2


def test_a_tool_change_in_the_stock(kerf, program):
    run = kerf("check", "--json", program(SOUND.replace("G0 Z5\nM5\n", "M5\nM6 T201\nG0 Z5\n")))
    assert "tool_change_low" in kinds(run)


def test_a_cut_deeper_than_the_flute(kerf, program):
    text = SOUND.replace("-6.00mm", "-30.00mm").replace("G1 Z-1", "G1 Z-20")
    run = kerf("check", "--json", program(text))
    assert run.status == 3
    assert {"over_flute", "shank_contact"} & set(kinds(run))


def test_hazards_as_text_name_file_and_line(kerf, program):
    path = program(SOUND.replace("M3 S10000\n", ""))
    run = kerf("check", path)
    assert run.status == 3
    assert f"{path}:7" in run.out and "[spindle_off]" in run.out


def test_hazards_of_path_and_material_are_in_the_order_of_steps(kerf, program):
    run = kerf("check", "--json", program(SOUND.replace("G0 Z5\nM5\nM2\n", "G0 X30\nM5\nG1 X31\n")))
    steps = [h["step"] for h in run.json["hazards"]]
    assert steps == sorted(steps) and len(steps) >= 3


def test_errors_of_the_program_come_before_hazards(kerf, program):
    run = kerf("check", "--json", program(SOUND.replace("F400", "Fnan")))
    assert run.status == 1
    assert any(d["severity"] == "error" for d in run.json["diagnostics"])


def test_an_unknown_tool_is_a_hazard_and_the_rest_is_checked(kerf, program):
    two = SOUND.replace("G0 Z5\nM5", "G0 X30\nG0 Z5\nM6 T77\nM3 S9000\nG1 Z-1\nG1 X35 Z-20\nG0 Z5\nM5")
    run = kerf("check", "--json", program(two))
    assert run.status == 3
    assert kinds(run) == ["rapid_in_stock", "unknown_tool"]
    unknown = run.json["hazards"][1]
    assert unknown["origin"]["line"] == 15 and unknown["steps"] == 2
    assert '--tool 77=' in unknown["hint"]
    assert "not_simulated" in run.codes()


def test_a_program_with_an_unknown_tool_only(kerf, program):
    path = program(SOUND.replace("T102", "T77"))
    run = kerf("check", "--json", path)
    assert run.status == 3
    assert kinds(run) == ["unknown_tool"]
    assert kerf("check", path, "--tool", "77=102").status == 0


def test_an_empty_program_is_an_error(kerf, program):
    run = kerf("check", "--json", program("%\n%\n"))
    assert run.status == 1
    assert "nothing_to_cut" in run.codes()


def test_without_any_tool_the_material_is_left_out_and_said_so(kerf, program):
    run = kerf("check", "--json", program(SOUND.replace("M6 T102\n", "")))
    assert run.status == 3
    assert kinds(run) == ["no_tool"]
    assert "not_simulated" in run.codes()

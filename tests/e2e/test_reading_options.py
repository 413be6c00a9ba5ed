"""What a program leaves open: the centres of its arcs, the offsets of its compensation, its subroutines."""
import json

import pytest

HEAD = "G21 G90 G17\nT1 M6 (T1 D=6 CR=0 - flat end mill)\nS9000 M3\nG0 X50 Y40\n"
ABSOLUTE = "G1 X60 Y40 F900\nG3 X70 Y50 I60 J50\nG1 X70 Y60\nG3 X60 Y70 I60 J60\nG1 X50 Y70\nM30\n"


def motions(kerf, path, *options):
    run = kerf("steps", "--json", *options, path)
    assert run.status == 0, run.err
    steps = [s for s in map(json.loads, run.out.splitlines()[1:]) if s["step"] in ("cut", "arc")]
    return [(*s["to"][:2], *s.get("centre", ())) for s in steps]


def test_absolute_centres_are_detected(kerf, program):
    path = program(HEAD + ABSOLUTE)
    wanted = [(60, 40), (70, 50, 60, 50), (70, 60), (60, 70, 60, 60), (50, 70)]
    assert motions(kerf, path) == wanted
    found = kerf("check", "--json", path)
    guessed = [d for d in found.json["diagnostics"] if d["name"] == "arc_centres_guessed"]
    assert [d["origin"]["line"] for d in guessed] == [6]
    assert "arc_radii" not in [h["kind"] for h in found.json["hazards"]]
    assert motions(kerf, path, "--arc-centres", "absolute") == wanted
    refused = kerf("check", path, "--arc-centres", "offsets")
    assert refused.status == 1 and "--arc-centres" in refused.err


@pytest.mark.parametrize("text", [
    # one arc that fits as an offset, one that fits neither way, or a statement of the program
    ABSOLUTE.replace("G1 X50 Y70", "G3 X50 Y60 I0 J-10"),
    ABSOLUTE.replace("G1 X50 Y70", "G3 X50 Y60 I3 J3"),
    "G91.1\n" + ABSOLUTE,
])
def test_centres_are_offsets_if_the_program_shows_so(kerf, program, text):
    run = kerf("check", program(HEAD + text))
    assert run.status == 1 and "ends 64.0312 mm" in run.err


def test_offsets_remain_offsets(kerf, program):
    text = "G1 X60 Y40 F900\nG3 X70 Y50 I0 J10\nM30\n"
    assert motions(kerf, program(HEAD + text))[-1] == (70, 50, 60, 50)
    stated = program(HEAD + "G91.1\n" + text)
    assert motions(kerf, stated, "--arc-centres", "absolute")[-1] == (70, 50, 60, 50)


WEAR = "G1 Z-1 F200\nG41 D1 Y-8 F600\nY23\nX33\nY-3\nX-8\nG40 X-9\nG0 Z10\nM30\n"


@pytest.mark.parametrize("option, offset", [
    ("D1=0", 0), ("1=0.5", 0.5), ("D1=0.1in", 2.54), ("D1=-0.5", -0.5)])
def test_the_offset_of_compensation_is_an_option(kerf, program, option, offset):
    path = program("G21 G17 G90\nT1 M6\nS8000 M3\nG0 X-3 Y-20\n" + WEAR)
    assert motions(kerf, path, "--comp", option)[3][1] == pytest.approx(23 + offset)
    notes = kerf("check", "--json", path, "--comp", option).json["diagnostics"]
    assert [d["message"] for d in notes if d["name"] == "compensation_radius"] == [
        f"G41 offsets the path by {offset:g} mm"]


@pytest.mark.parametrize("option", ["D1", "D0=1", "D1.5=1", "D1=x", "D1=2m", "=3"])
def test_a_malformed_offset_is_an_error(kerf, program, option):
    run = kerf("check", program(HEAD + "M30\n"), "--comp", option)
    assert run.status == 2 and "D1=0" in run.err


def test_subroutines_are_found_in_other_folders(kerf, program, tmp_path):
    folder = tmp_path / "macros"
    folder.mkdir()
    (folder / "deep.ngc").write_text("o<deep> sub\nG1 X[#1] F100\no<deep> endsub\n")
    path = program(HEAD + "o<deep> call [77]\nM2\n")
    assert kerf("steps", path).status == 1
    assert motions(kerf, path, "-I", str(folder)) == [(77, 40)]

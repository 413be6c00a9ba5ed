"""kerf cut: operations on drawings and outline files, job files, and the programs that they make."""
import json
import math
import re

import pytest
from conftest import cut_operations

OUTLINES = {
    "unit": "mm",
    "outlines": [
        {
            "name": "frame",
            "closed": True,
            "first": {"at": [0, 0]},
            "segments": [{"to": [60, 0]}, {"to": [60, 40]}, {"to": [0, 40]}, {"to": [0, 0]}],
        },
        {
            "name": "island",
            "closed": True,
            "first": {"at": [25, 15]},
            "segments": [{"to": [35, 15]}, {"to": [35, 25]}, {"to": [25, 25]}, {"to": [25, 15]}],
        },
        {
            "name": "hole",
            "closed": True,
            "first": {"at": [15, 20]},
            "segments": [{"to": [5, 20], "via": [10, 25]}, {"to": [15, 20], "via": [10, 15]}],
        },
        {"name": "line", "closed": False, "first": {"at": [40, 5]}, "segments": [{"to": [55, 5]}]},
    ],
}

JOB = """art = "art.json"
stock = "-5,-5,-10 to 65,45,0"

[tools]
1 = "square d=6"
2 = "square d=3"

[defaults]
feed = 900
tool = 1
rpm = 16000

[[operation]]
op = "pocket"
outlines = ["frame", "island"]
depth = 4
stepdown = 2

[[operation]]
op = "bore"
outlines = ["hole"]
tool = 2
depth = 6
"""


@pytest.fixture
def art(tmp_path):
    (tmp_path / "art.json").write_text(json.dumps(OUTLINES))
    return "art.json"


def write_job(tmp_path, text=JOB):
    (tmp_path / "job.toml").write_text(text)
    return "job.toml"


POCKET = ["--op", "pocket", "--tool", "square d=6", "--depth", "4", "--stepdown", "2", "--feed", "900"]


def test_a_pocket_with_an_island_leaves_its_volume(kerf, art):
    run = kerf("cut", art, *POCKET, "--outlines", "frame,island", "-o", "part.nc")
    assert run.status == 0, run.err
    done = kerf("simulate", "--json", "part.nc", "--tool", "square d=6", "--stock", "-5,-5,-10 to 65,45,0",
                "--resolution", "0.1")
    assert done.status == 0, done.err
    # The area without the island, less what the tool leaves in the four inner corners.
    area = 60 * 40 - 10 * 10 - (4 - math.pi) * 3**2
    assert done.json["removed_mm3"] == pytest.approx(4 * area, rel=2e-3)
    assert done.json["hazards"] == []


def test_a_job_file_is_a_program_for_every_command(kerf, tmp_path, art):
    job = write_job(tmp_path)
    info = kerf("info", "--json", job)
    assert info.status == 0, info.err
    assert [t["number"] for t in info.json["tools"]] == [1, 2]
    simulated = kerf("simulate", "--json", job)
    assert simulated.status == 0, simulated.err
    assert simulated.json["stock_mm3"] == pytest.approx(70 * 50 * 10)
    assert simulated.json["hazards"] == []
    area = 60 * 40 - 10 * 10 - (4 - math.pi) * 3**2
    hole = math.pi * 5**2
    assert simulated.json["removed_mm3"] == pytest.approx(4 * area + 2 * hole, rel=3e-3)
    steps = [json.loads(line) for line in kerf("steps", job).out.splitlines()[1:]]
    assert {s["origin"]["line"] for s in steps if s["step"] in ("cut", "arc")} == {13, 19}
    posted = kerf("post", "--to", "linuxcnc", job)
    assert posted.status == 0 and "M2" in posted.out
    checked = kerf("check", job)
    assert checked.status == 0, checked.out + checked.err


def test_a_job_is_written_for_a_controller(kerf, tmp_path, art):
    job = write_job(tmp_path)
    assert kerf("cut", job, "--to", "linuxcnc", "-o", "part.ngc").status == 0
    text = (tmp_path / "part.ngc").read_text()
    assert "S16000" in text and text.count("M6") == 2


@pytest.mark.parametrize("change, line, message", [
    (("depth = 4", "depht = 4"), 16, 'unknown key "depht"'),
    (("depth = 4", 'depth = "deep"'), 16, "depth must be a number in mm"),
    (("stepdown = 2", 'entry = "slide"'), 17, "entry must be one of: helix, ramp, plunge"),
    (('op = "bore"', 'op = "weld"'), 19, 'there is no operation "weld"'),
    (("depth = 6", ""), 19, "depth is missing"),
    (('art = "art.json"', 'art = 5'), 1, "art must be a text"),
    (("[tools]", "[[shape]]\npoint = [1]\n[tools]"), 5, "point has 2 numbers"),
    (("[tools]", "tuned = 1\n[tools]"), 4, 'unknown key "tuned"'),
    (('2 = "square', 'two = "square'), 6, "the key of a tool is its number"),
])
def test_errors_name_line_and_key(kerf, tmp_path, art, change, line, message):
    job = write_job(tmp_path, JOB.replace(*change, 1))
    run = kerf("info", "--json", job)
    assert run.status == 1
    found = [d for d in run.json["diagnostics"] if message in d["message"]]
    assert found, run.out
    assert found[0]["origin"]["line"] == line
    assert found[0]["name"] == "cut_job_key"


def test_invalid_toml_is_an_error_with_its_line(kerf, tmp_path, art):
    run = kerf("info", "--json", write_job(tmp_path, JOB.replace("depth = 4", "depth = = 4")))
    assert run.status == 1
    assert run.json["diagnostics"][0]["name"] == "cut_job_syntax"
    assert run.json["diagnostics"][0]["origin"]["line"] == 16


@pytest.mark.parametrize("names, message", [
    ("line", "no closed outline"),
    ("nothing", 'no outline "nothing"'),
])
def test_unusable_selections_are_errors(kerf, art, names, message):
    run = kerf("cut", art, *POCKET, "--outlines", names, "--json")
    assert run.status == 1
    found = run.json["diagnostics"][-1]
    assert found["name"] == "cut_job_outlines" and message in found["message"]


def test_open_outlines_are_reported_and_the_closed_ones_are_cut(kerf, art):
    both, alone = (kerf("cut", art, *POCKET, "--outlines", names) for names in ("frame,line", "frame"))
    assert both.status == alone.status == 0 and "G1" in both.out
    assert "1 of 2 outlines is open and not cut, the first at" in both.err
    assert both.out == alone.out and "open" not in alone.err


def test_a_tool_too_wide_names_the_largest_that_fits(kerf, art):
    run = kerf("cut", art, "--op", "pocket", "--tool", "square d=12", "--depth", "2", "--feed", "900",
               "--outlines", "hole", "--json")
    assert run.status == 1
    found = run.json["diagnostics"][-1]
    assert found["name"] == "op_tool_wide"
    assert "has 10 mm" in found["message"]


def test_usage_errors(kerf, tmp_path, art):
    assert kerf("cut").status == 2
    assert kerf("cut", art).status == 2
    assert kerf("cut", art, *POCKET, "--to", "unknown").status == 2
    assert kerf("cut", art, *POCKET, "--depth", "deep").status == 2
    assert kerf("cut", art, *POCKET, "-o", art).status == 2
    assert kerf("cut", write_job(tmp_path), "--depth", "4").status == 2
    assert kerf("cut", "--example", "weld").status == 2


@pytest.mark.parametrize("op", ["pocket", "contour", "engrave", "face", "drill", "bore"])
def test_examples_run(kerf, tmp_path, art, op):
    example = kerf("cut", "--example", op)
    assert example.status == 0
    text = example.out.replace('# art = "part.dxf"', f'art = "{art}"')
    text = re.sub(r"\[\[shape\]\].*?\n\n", "", text, flags=re.DOTALL)
    select = {"engrave": '"line"', "drill": '"hole"', "bore": '"hole"'}.get(op, '"frame"')
    text += f"outlines = [{select}]\n"
    run = kerf("simulate", "--json", write_job(tmp_path, text))
    assert run.status == 0, run.err + run.out
    assert run.json["hazards"] == []
    assert run.json["removed_mm3"] > 0


@pytest.mark.parametrize("op", cut_operations(laser=False))
def test_examples_run_as_they_are(kerf, tmp_path, op):
    example = kerf("cut", "--example", op).out
    run = kerf("simulate", "--json", write_job(tmp_path, example))
    assert run.status == 0, run.err + run.out
    assert run.json["hazards"] == []
    assert run.json["removed_mm3"] > 0
    assert kerf("check", "job.toml").status == 0


def test_the_schema_accepts_a_job_and_names_its_keys(kerf):
    schema = json.loads(kerf("cut", "--schema").out)
    keys = schema["properties"]["operation"]["items"]["properties"]
    assert {"op", "depth", "stepdown", "stepover", "direction"} <= keys.keys()
    assert keys["direction"]["enum"] == ["climb", "conventional"]
    rows = schema["$defs"]
    assert rows["contour"]["properties"]["entry"]["default"] == "ramp"
    assert rows["pocket"]["properties"]["entry"]["default"] == "helix"
    assert rows["raster"]["properties"]["stepover"]["default"] == 0.1
    assert rows["pocket"]["properties"]["depth"]["exclusiveMinimum"] == 0
    assert "pitch" not in rows["pocket"]["properties"]


def test_the_help_has_the_defaults_of_the_operations(kerf):
    text = re.sub(r"\s+", " ", kerf("cut", "--help").out)
    assert "(helix, ramp, plunge) (default: helix; ramp for contour, engrave" in text
    assert "(default: 0.4; 0.1 for raster)" in text


def test_depth_per_pass_and_resuming_in_post(kerf, tmp_path):
    (tmp_path / "deep.nc").write_text(
        "G21 G90\nT1 M6\nM3 S9000\nG0 X0 Y0\nG0 Z5\nG1 Z-6 F100\nG1 X20 F400\nY20\nX0\nY0\nG0 Z5\nM2\n")
    run = kerf("post", "--to", "linuxcnc", "--step-down", "2", "deep.nc", "-o", "passes.ngc")
    assert run.status == 0, run.err
    info = kerf("info", "--json", "passes.ngc", "--tool", "square d=3").json
    assert info["motion"]["cut_mm"] == pytest.approx(3 * 80 + 11, abs=0.01)
    run = kerf("post", "--to", "linuxcnc", "--from-line", "8", "--safe-z", "5", "deep.nc", "-o", "rest.ngc")
    assert run.status == 0, run.err
    info = kerf("info", "--json", "rest.ngc", "--tool", "square d=3").json
    assert info["motion"]["cut_mm"] == pytest.approx(60 + 11, abs=0.01)
    text = (tmp_path / "rest.ngc").read_text()
    assert "S9000" in text and "M3" in text
    run = kerf("post", "--to", "linuxcnc", "--from-line", "99", "--safe-z", "5", "deep.nc", "--json")
    assert run.status == 1 and "resume_line" in run.codes()
    assert kerf("post", "--to", "linuxcnc", "--from-line", "8", "deep.nc").status == 2


def test_tabs_and_a_finishing_pass(kerf, art):
    run = kerf("cut", art, "--op", "contour", "--outlines", "frame", "--tool", "square d=4", "--depth", "6",
               "--stepdown", "2", "--feed", "900", "--finish", "0.3", "--tab-height", "2",
               "--tab-length", "6", "--tabs", "4", "--tab-shape", "triangular", "-o", "part.nc")
    assert run.status == 0, run.err
    stock = ("--stock", "-10,-10,-6 to 70,50,0", "--resolution", "0.1", "--tool", "square d=4")
    held = kerf("simulate", "--json", "part.nc", *stock)
    assert held.json["hazards"] == []
    # A ring of 4.3 mm around the part, less four tabs of triangles, 6 mm long and 2 mm high; their ends are
    # concave, which leaves a little more.
    width = 4.3
    ring = 2 * (60 + 40) * width + math.pi * width**2
    assert held.json["removed_mm3"] == pytest.approx(6 * ring - 4 * (0.5 * 6 * 2) * width, rel=1e-2)


PLATE = """G21 G90
T1 M6
M3 S9000
G0 Z5
G0 X0 Y0
G1 Z-3 F100
G1 X20 F400
Y20
X0
Y0
G0 Z5
G0 X5 Y5
G1 Z-3 F100
G1 X10 F400
Y10
X5
Y5
G0 Z5
M5
M2
"""


def simulated(kerf, name):
    run = kerf("simulate", "--json", name, "--tool", "square d=2", "--stock", "-100,-100,-5 to 200,200,0",
               "--resolution", "0.2")
    assert run.status == 0, run.err
    assert run.json["hazards"] == []
    return run.json


def test_changes_of_a_finished_program_in_post(kerf, tmp_path):
    (tmp_path / "plate.nc").write_text(PLATE)
    once = simulated(kerf, "plate.nc")["removed_mm3"]
    for options, factor in [
        (["--rotate", "90", "--move", "50,10"], 1),
        (["--mirror", "x", "--reverse-loops"], 1),
        (["--columns", "3", "--rows", "2", "--pitch", "40,30"], 6),
        (["--order"], 1),
        (["--step-down", "1", "--entry", "ramp", "--entry-angle", "10"], 1),
    ]:
        run = kerf("post", "--to", "linuxcnc", *options, "plate.nc", "-o", "new.ngc")
        assert run.status == 0, run.err
        assert simulated(kerf, "new.ngc")["removed_mm3"] == pytest.approx(factor * once, rel=1e-3)
    ordered = kerf("post", "--to", "linuxcnc", "--order", "plate.nc", "-o", "new.ngc", "--json").json
    assert ordered["order"]["blocks"] == 2
    run = kerf("post", "--to", "linuxcnc", "--tool", "1=square d=2", "--tab-height", "1", "--tabs", "4",
               "--tab-length", "2", "plate.nc", "-o", "tabs.ngc")
    assert run.status == 0, run.err
    # Eight tabs of 2 by 1 mm across the groove of 2 mm, and a little more: their ends are concave.
    left = once - simulated(kerf, "tabs.ngc")["removed_mm3"]
    assert 8 * 4 < left < 8 * 4 + 8 * 2
    for bad in (["--columns", "2"], ["--rows", "0"], ["--mirror", "z"], ["--move", "1"],
                ["--entry", "helix"]):
        assert kerf("post", "--to", "linuxcnc", *bad, "plate.nc").status != 0


@pytest.mark.parametrize("post", ["grbl", "linuxcnc", "mach3", "grblhal", "carbide"])
def test_a_written_program_has_its_tool(kerf, program, post):
    """The comment that the post writes describes the tool: no --tool is needed to simulate the file."""
    job = kerf("cut", "--example", "pocket").out
    file = program(job, "job.toml")
    assert kerf("cut", file, "--to", post, "-o", "part.nc").status == 0
    stock = ("--stock", "-2,-2,-7 to 62,42,0")
    written = kerf("simulate", "--json", "part.nc", *stock)
    assert written.status == 0 and not {"no_tool_shape", "tool_assumed"} & set(written.codes()), written.out
    assert written.json["removed_mm3"] == pytest.approx(
        kerf("simulate", "--json", file, *stock).json["removed_mm3"], rel=1e-4)


def test_a_program_without_a_speed_is_reported(kerf, program, tmp_path):
    art = program('<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
                  '<rect x="5" y="5" width="50" height="30" fill="none" stroke="red"/></svg>', "art.svg")
    command = ["cut", art, "--op", "pocket", "--tool", "square d=3", "--depth", "2", "--feed", "900", "-o",
               tmp_path / "part.nc", "--json"]
    assert kerf(*command).codes() == ["cut_job_key"]
    assert kerf(*command, "--rpm", "9000").codes() == []
    burnt = kerf("cut", art, "--op", "laser", "--power", "50", "--feed", "900", "-o", tmp_path / "laser.nc",
                 "--json")
    assert burnt.codes() == []


def test_tabs_without_a_height_are_named(kerf, tmp_path):
    (tmp_path / "plate.toml").write_text(
        '[[shape]]\nrectangle = [0, 0, 60, 40]\n[tools]\n1 = "square d=3"\n[[operation]]\nop = "contour"\n'
        "tool = 1\ndepth = 3\nfeed = 600\ntabs = 4\n"
    )
    run = kerf("cut", "plate.toml", "-o", "plate.nc")
    assert run.status == 0 and "tabs has no effect without tab-height" in run.err


@pytest.mark.parametrize("option, word", [
    (("--tool", "square d=3"), "[tools]"), (("--op", "contour"), "operations"), (("--unit", "inch"), "unit"),
    (("--strokes", "areas"), "strokes"), (("--depth", "3"), "operations"),
])
def test_a_job_file_decides_what_options_would(kerf, program, option, word):
    job = program(kerf("cut", "--example", "pocket").out, "job.toml")
    run = kerf("cut", job, *option, "-o", "job.nc")
    assert run.status == 2 and option[0] in run.err and word in run.err
    assert kerf("cut", job, "-o", "job.nc").status == 0


def test_the_tools_of_a_job_cannot_be_others(kerf, program):
    """Its paths keep the radius of its own tool: a thinner one would leave material everywhere."""
    job = program(kerf("cut", "--example", "pocket").out, "job.toml")
    for tool in ("1=square d=3", "square d=3", "1=ball d=6"):
        for command in (("simulate",), ("check",), ("post", "--to", "grbl")):
            run = kerf(*command, "--json", job, "--tool", tool)
            assert run.status == 1 and "option_unused" in run.codes(), (command, run.out)
            assert "made for tool 1" in run.out
    plain, held = (kerf("simulate", "--json", job, *options) for options in
                   ((), ("--tool", "1=square d=6 flute=25 holder=30 holder_length=20")))
    assert held.status == 0 and held.json["removed_mm3"] == plain.json["removed_mm3"]


# Beyond a right angle, in squares of the radius: what stays, two segments of a quarter circle, half a disc.
BEYOND = {"none": math.pi / 4 - 1, "dog-bone": math.pi / 2 - 1, "t-bone": math.pi / 2}


@pytest.mark.parametrize("bones", BEYOND)
def test_bones_remove_what_they_should(kerf, tmp_path, bones):
    (tmp_path / "bones.toml").write_text(
        'stock = "-10,-10,-9 to 50,35,0"\n[tools]\n1 = "square d=6"\n'
        "[[shape]]\nrectangle = [0, 0, 40, 25]\n"
        '[[operation]]\nop = "pocket"\ntool = 1\ndepth = 6\nstepdown = 2\nfeed = 900\nrpm = 16000\n'
        f'bones = "{bones}"\n'
    )
    done = kerf("simulate", "bones.toml", "--json")
    assert done.status == 0 and done.json["hazards"] == []
    assert done.json["removed_mm3"] == pytest.approx(6 * (40 * 25 + 4 * 9 * BEYOND[bones]), rel=2e-4)

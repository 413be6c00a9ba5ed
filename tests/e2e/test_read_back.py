"""What Kerf writes, it reads: a program written for a controller and read back is the same program."""
import json
import os
from pathlib import Path

import pytest

SOURCE = Path(os.environ.get("KERF_SOURCE_DIR", Path(__file__).parents[2]))
CASES = Path(os.environ.get("KERF_CASES_DIR", SOURCE.parent / "shared" / "cases"))

POSTS = {"carbide": 3, "carvera": 3, "centroid": 4, "estlcam": 3, "fanuc": 3, "fluidnc": 3, "g2core": 3,
         "grbl": 3, "grblhal": 3, "haas": 3, "linuxcnc": 4, "mach3": 4, "mach4": 4, "maslow": 3, "masso": 3,
         "smoothieware": 3, "tinyg": 3, "uccnc": 3}  # decimals of a mm
OPERATIONS = ["pocket", "contour", "chamfer", "isolation", "engrave", "face", "drill", "bore", "keyhole",
              "slot", "trochoidal-slot", "thread", "countersink", "vcarve", "vcarve-floor"]
FILES = ["demo.nc", "one_pass.nc", "plate.gcmc", "inlay.toml", "rest.toml", "text.toml"]
RESOLUTION = "0.1"


def figures(kerf, file):
    run = kerf("simulate", "--json", "--resolution", RESOLUTION, file)
    assert run.status in (0, 3), run.err
    return run.json


def hazards(found):
    return sorted((h["kind"], round(h.get("depth_mm", 0.0), 2)) for h in found["hazards"])


def expect_same(source, back, decimals, what):
    """Tools, stock, volume and hazards; coordinates are rounded to the decimals of the post."""
    def tools(found):
        return [(t["number"], t["name"]) for t in found["tools"]]

    assert tools(back) == tools(source), what
    assert all(t.get("source") != "assumed" for t in back["tools"]), what
    block, written = (sum(f["stock"]["block_mm"], []) for f in (source, back))
    assert written == pytest.approx(block, abs=2 * 10**-decimals), what
    if source["stock"]["source"] != "assumed":
        assert back["stock"]["source"] == "program", what
        assert written == pytest.approx(block, abs=1e-6), what
    area = max(source["removed_mm3"], 1.0) ** (2 / 3) * 6
    allowed = 1e-6 * source["removed_mm3"] + 0.5 * 10**-decimals * area
    assert abs(back["removed_mm3"] - source["removed_mm3"]) <= allowed, what
    assert hazards(back) == hazards(source), what


def program_of(kerf, tmp_path, name):
    if name in OPERATIONS or name.startswith("laser"):
        job = tmp_path / f"{name}.toml"
        job.write_text(kerf("cut", "--example", name).out)
        return job
    return SOURCE / "examples" / name


@pytest.mark.parametrize("name", OPERATIONS + FILES)
@pytest.mark.parametrize("post", POSTS)
def test_what_is_written_is_read_back(kerf, tmp_path, name, post):
    program = program_of(kerf, tmp_path, name)
    written = kerf("post", program, "--to", post, "-o", "out.nc")
    if written.status != 0:
        pytest.skip(f"{post} cannot carry it: {written.err.splitlines()[0]}")
    expect_same(figures(kerf, program), figures(kerf, tmp_path / "out.nc"), POSTS[post], f"{name} {post}")


def test_a_tool_change_by_hand_is_read_back(kerf, tmp_path):
    """The pause after "change to tool 2" is that change; the first tool is in the spindle."""
    (tmp_path / "two.nc").write_text(
        "G21 G90\nT1 M6\nM3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20\nG0 Z5\nT2 M6\nM3 S9000\nG0 X0 Y10\n"
        "G1 Z-2 F100\nG1 X20\nG0 Z5\nM2\n")
    tools = ["--tool", "1=V d=12 angle=90", "--tool", "2=square d=4 flute=9"]
    for post in ("grbl", "linuxcnc", "marlin", "klipper", "reprapfirmware", "plain"):
        out = f"{post}.gcode"
        run = kerf("post", "two.nc", "--to", post, "--tool-change", "pause", *tools, "-o", out)
        if run.status != 0:
            assert post in ("klipper", "plain", "reprapfirmware"), run.err
            continue
        steps = [s for s in map(str.strip, kerf("steps", out).out.splitlines()) if '"step":"tool"' in s]
        assert len(steps) == 2, (post, steps)
        found = [(t["number"], t["name"]) for t in kerf("info", "--json", out).json["tools"]]
        assert found == [(1, "V 12 mm, 90 degrees"), (2, "square 4 mm")], post


PROGRAM = "G21 G90\n{}\nM3 S9000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20\nG0 Z5\nM2\n"


@pytest.mark.parametrize("comment", ["(tool change at Z 30mm)", "(board 300mm x 200mm, cutter side up)",
                                    "(countersink 1)", "(-- canned_drill_peck R-plane=2.0 --)"])
def test_prose_does_not_change_the_tool_of_the_table(kerf, tmp_path, comment):
    (tmp_path / "a.nc").write_text(PROGRAM.format(f"T102 M6\n{comment}"))
    tool = kerf("info", "--json", "a.nc").json["tools"][0]
    assert (tool["name"], tool["source"]) == ("square 3.175 mm", "built in")


@pytest.mark.parametrize("comments, name", [
    ("T1 M6 (TOOL/MILL, 6, 0, 20, 0)\n(T1 D=3 CR=0 - flat end mill)", "square 6 mm"),
    ("(tool 1: ball, diameter 3 mm)\n(T1 D=6 CR=0 - flat end mill)\nT1 M6", "ball 3 mm"),
    ("T1 M6 (TOOL/MILL, 6, 0, 20, 0)\n(TOOL/MILL, 3, 0, 20, 0)\nT1 M6", "square 6 mm")])
def test_comments_that_contradict_each_other_are_a_finding(kerf, tmp_path, comments, name):
    (tmp_path / "a.nc").write_text(PROGRAM.format(comments))
    run = kerf("info", "--json", "a.nc")
    assert run.json["tools"][0]["name"] == name
    assert "tool_comment_differs" in run.codes()


def test_a_tool_table_counts_for_linuxcnc_only(kerf, tmp_path):
    (tmp_path / "tool.tbl").write_text("T301 P1 D4 ;square\n")
    (tmp_path / "a.ngc").write_text(PROGRAM.format("T301 M6"))
    (tmp_path / "b.nc").write_text("(for GRBL)\n" + PROGRAM.format("T301 M6"))
    assert kerf("info", "--json", "a.ngc").json["tools"][0]["name"] == "square 4 mm"
    assert kerf("info", "--json", "b.nc").json["tools"][0]["name"] == "V 12.7 mm, 90 degrees"


def test_an_exported_table_changes_no_tool(kerf, tmp_path):
    (tmp_path / "a.ngc").write_text(PROGRAM.format("T301 M6"))
    before = kerf("simulate", "--json", "a.ngc").json["removed_mm3"]
    assert kerf("tools", "export", "-o", "tool.tbl").status == 0
    assert kerf("simulate", "--json", "a.ngc").json["removed_mm3"] == before


PRINT = "G21\nG90\nM83\nG28\nM109 S200\nG1 X10 Y10 Z0.2 F1200\nG1 X60 E3 F1200\n"


@pytest.mark.parametrize("post", ["marlin", "klipper", "plain", "reprapfirmware"])
def test_the_filament_of_the_file_is_that_of_the_post(kerf, tmp_path, post):
    (tmp_path / "p.gcode").write_text("; filament_diameter = 2.85\n" + PRINT)
    assert kerf("post", "p.gcode", "--to", post, "-o", "out.gcode").status == 0
    text = (tmp_path / "out.gcode").read_text()
    assert "; filament_diameter = 2.85" in text and " E3" in text
    volumes = [kerf("info", "--json", f).json["print"]["filament_mm3"] for f in ("p.gcode", "out.gcode")]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-5)


def test_the_filament_of_the_printer_precedes_that_of_the_file(kerf, tmp_path):
    (tmp_path / "p.gcode").write_text("; filament_diameter = 2.85\n" + PRINT)
    (tmp_path / "mine.toml").write_text('base = "marlin"\n[printer]\nfilament = 1.75\n')
    assert kerf("post", "p.gcode", "--post", "mine.toml", "-o", "out.gcode").status == 0
    text = (tmp_path / "out.gcode").read_text()
    assert "; filament_diameter = 1.75" in text and "E7.95673" in text  # 3 mm * (2.85 / 1.75)^2


def test_volumes_of_filament_are_read(kerf, tmp_path):
    (tmp_path / "v.gcode").write_text("; use_volumetric_e = 1\n" + PRINT)
    assert kerf("info", "--json", "v.gcode").json["print"]["filament_mm3"] == pytest.approx(3.0)


LASER_POSTS = {"laser": 3, "centroid": 4, "estlcam": 3, "fanuc": 3, "fluidnc": 3, "g2core": 3, "grbl": 3,
               "grblhal": 3, "linuxcnc": 4, "mach3": 4, "marlin": 3, "masso": 3, "reprapfirmware": 3,
               "tinyg": 3, "uccnc": 3}


def beam(kerf, file):
    """The motions with the beam's mode and power at each, and the length that is cut at each power."""
    run = kerf("steps", file)
    assert run.status == 0, run.err
    state, motions = ("off", 0.0), []
    for step in map(json.loads, run.out.splitlines()[1:]):
        if step["step"] == "laser":
            state = (step["mode"], step["power"])
        elif "to" in step:
            on = state if step["step"] != "rapid" and state[1] > 0 else ("off", 0.0)
            motions.append((step["to"], step["step"], on, step.get("feed")))
    return motions


@pytest.mark.parametrize("operation", ["laser-cut", "laser-fill", "laser-picture", "laser-frame"])
@pytest.mark.parametrize("post", LASER_POSTS)
def test_a_program_for_a_laser_is_read_back(kerf, tmp_path, operation, post):
    """A post for mills states that the program is for a laser, so that M3, M4 and S are those of the beam."""
    job = program_of(kerf, tmp_path, operation)
    assert kerf("post", job, "--to", post, "-o", "out.nc").status == 0
    source, back = beam(kerf, job), beam(kerf, "out.nc")
    assert len(back) == len(source)
    for (to, *state), (to_back, *state_back) in zip(source, back, strict=True):
        assert state_back == state and to_back == pytest.approx(to, abs=10 ** -LASER_POSTS[post])
    found = [kerf("check", "--json", file).json["hazards"] for file in (job, "out.nc")]
    assert [h["kind"] for h in found[1]] == [h["kind"] for h in found[0]]

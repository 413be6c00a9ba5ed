"""-o - : the output to standard output, and nothing else there."""
import json
import subprocess

import pytest
from conftest import KERF, VALID
from test_outline import PLATE
from test_outline_drawing import PLATE as OUTLINE
from test_outline_drawing import drawing
from test_pathdxf import OPTIONS, circle, line, path, save  # noqa: F401

JOB = ["cut", "--op", "engrave", "--text", "A", "--height", "10", "--tool", "V d=6 angle=60",
       "--depth", "0.4", "--feed", "600", "--rpm", "16000"]


@pytest.mark.parametrize("command", [
    ["post", "part.nc", "--to", "grbl"],
    JOB,
    ["steps", "part.nc"],
    ["tools", "export"],
    ["gcmc", "part.gcmc"],
    ["level", "--over", "part.nc", "--margin", "5"],
])
def test_the_output_is_that_of_a_file(kerf, program, tmp_path, command):
    program()
    program("move([1mm, 2mm]);", "part.gcmc")
    ending = ".toml" if command[0] == "tools" else ".nc"
    assert kerf(*command, "-o", "file" + ending).status == 0
    sent = kerf(*command, "-o", "-")

    def rest(text):  # gcmc writes the time
        return text.splitlines()[4 if command[0] == "gcmc" else 0:]

    assert sent.status == 0 and rest(sent.out) == rest(kerf(*command).out)

    assert rest(sent.out) == rest((tmp_path / ("file" + ending)).read_text()) != []
    assert not (tmp_path / "-").exists()


def test_messages_and_summaries_go_to_standard_error(kerf, program):
    program(VALID.replace("G0 X10 Y10 Z5", "G0 X10 Y10 Z-1"))
    for options in (["--json"], []):
        run = subprocess.run([KERF, "simulate", "part.nc", "-o", "-", "--to", "stl", *options],
                             cwd=program().parent, capture_output=True, check=True)
        assert len(run.stdout) == 84 + 50 * int.from_bytes(run.stdout[80:84], "little")
        assert b"removed" in run.stderr and b"kerf-output" not in run.stderr


def test_a_picture_beside_a_file(program):
    folder = program().parent
    run = subprocess.run([KERF, "simulate", "part.nc", "-o", "-", "--to", "png", "-o", "part.png",
                          "--size", "64x64"], cwd=folder, capture_output=True, check=True)
    assert run.stdout == (folder / "part.png").read_bytes() and run.stdout[:4] == b"\x89PNG"


def test_hazards_go_to_standard_error(kerf, program):
    program(VALID.replace("G1 X20 F400", "G0 X20"))
    run = kerf("simulate", "part.nc", "-o", "-", "--to", "obj")
    assert "rapid" in run.err and "rapid" not in run.out and run.out.startswith(("#", "mtllib", "o ", "v "))


@pytest.mark.parametrize("command, expected", [
    (["post", "part.nc", "-o", "-"], "--to"),
    (["simulate", "part.nc", "-o", "-"], "--to"),
    (["simulate", "part.nc", "-o", "-", "-o", "-", "--to", "png"], "twice"),
    (["simulate", "part.nc", "--to", "png"], "--output"),
    (["simulate", "part.nc", "-o", "-", "--to", "gif"], "png"),
    (["run", "part.py", "-o", "-"], "specify a file"),
    (["run", "part.scad", "-o", "-"], "specify a file"),
])
def test_a_missing_format_is_asked_for(kerf, program, command, expected):
    program()
    run = kerf(*command)
    assert run.status == 2 and run.out == "" and expected in run.err


def test_nothing_is_sent_after_an_error(kerf, program):
    program("G1 X\n")
    for command in (["simulate", "part.nc", "--to", "png"], ["post", "part.nc", "--to", "grbl"],
                    ["steps", "part.nc"]):
        run = kerf(*command, "-o", "-", "--json")
        assert run.status == 1 and run.out == "" and "error" in run.err


def test_measured_heights(kerf, program):
    program("0 0 0.1\n10 0 0.2\n0 10 0.3\n10 10 0.4\n", "map.txt")
    rows = kerf("level", "--read", "map.txt", "-o", "-").out.splitlines()
    assert sorted([float(v) for v in row.split()] for row in rows) == [
        [0, 0, 0.1], [0, 10, 0.3], [10, 0, 0.2], [10, 10, 0.4]]


def test_steps_do_not_replace_the_program(kerf, program, tmp_path):
    program()
    assert kerf("steps", "part.nc", "-o", "part.nc").status == 2
    assert (tmp_path / "part.nc").read_text() == VALID
    assert kerf("steps", "part.nc", "-o", "steps.jsonl").out == ""
    assert json.loads((tmp_path / "steps.jsonl").read_text().splitlines()[0])["kerf_steps"] == 1


def test_the_only_file_of_a_path_drawing(kerf, save, tmp_path):  # noqa: F811
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    assert kerf("pathdxf", *OPTIONS, name).status == 0
    milling = tmp_path / "8999.1P_Milling.gcode"
    text = milling.read_text()
    milling.unlink()
    assert kerf("pathdxf", *OPTIONS, "--output", "-", name).out == text
    assert kerf("pathdxf", *OPTIONS, "--output", "own.nc", name).out == ""
    assert (tmp_path / "own.nc").read_text() == text and not milling.exists()
    assert kerf("pathdxf", *OPTIONS, "--output", name, name).status == 1
    assert kerf("pathdxf", *OPTIONS, "--output", "-", name, name).status == 2
    assert kerf("pathdxf", *OPTIONS, "--svg", "sheet.svg", name).status == 0
    assert kerf("pathdxf", *OPTIONS, "--svg", "-", name).out == (tmp_path / "sheet.svg").read_text()
    assert kerf("pathdxf", *OPTIONS, "--output", "-", "--svg", "-", name).status == 2
    probes = save("8997.1P.dxf", path(line(0, 0, 10, 0) + circle(0, 20, 6, "PHANTOM")))
    several = kerf("pathdxf", *OPTIONS, "/z50", "--output", "-", probes)
    assert several.status == 1 and several.out == "" and "several files" in several.err


def test_outlines_of_a_drawing(kerf, program, tmp_path):
    name = program(drawing(*OUTLINE), "part.dxf").name
    for option in ("--svg", "--dxf"):
        own = "own." + option[2:]
        assert kerf("outline", name, option, own).status == 0
        sent = kerf("outline", name, option, "-", "--json")
        assert sent.status == 0 and sent.out == (tmp_path / own).read_text() and sent.err
    assert kerf("outline", name, "--svg", "-", "--dxf", "-").status == 2
    assert not (tmp_path / "-").exists()


def test_outlines_of_a_file(kerf, program, tmp_path):
    program(json.dumps(PLATE), "plate.json")
    assert kerf("outline", "plate.json", "--dxf", "own.dxf").status == 0
    assert kerf("outline", "plate.json", "--dxf", "-").out == (tmp_path / "own.dxf").read_text()
    both = kerf("outline", "plate.json", "--svg", "-", "--dxf", "-")
    assert both.status == 1 and both.out == "" and "twice" in both.err


def test_the_page_of_view(kerf, program, tmp_path):
    program()
    assert kerf("view", "part.nc", "--export", "page.html").status == 0
    sent = kerf("view", "part.nc", "--export", "-")
    assert sent.status == 0 and sent.out.startswith("<!") and not (tmp_path / "-").exists()
    assert len(sent.out) == len((tmp_path / "page.html").read_text())

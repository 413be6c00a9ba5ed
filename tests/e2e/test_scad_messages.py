"""Messages of OpenSCAD programs: each code is provoked, with the line of its cause."""

import json
import os
import subprocess

import pytest

KERF = os.environ.get("KERF", "kerf")
START = "gcp = gcodepreview();\n"


def run(folder, text, *options):
    (folder / "part.scad").write_text(text)
    return subprocess.run(
        [KERF, "run", *options, "part.scad"], cwd=folder, capture_output=True, text=True, timeout=60
    )


CASES = {
    # name: program, exit status, number of the code, line
    "scad_argument": (START + 'rapid(1, "a", 2);\n', 1, 11001, 2),
    "scad_syntax": ("x = 1;\ny = ;\n", 1, 11002, 2),
    "scad_text": (START + 'rapid(1, 2, 3);\necho("a\\qb");\n', 0, 11003, 3),
    "scad_file": ("include <missing.scad>\n" + START, 1, 11004, 1),
    "scad_limit": (START + "function f(n) = 1 + f(n + 1);\necho(f(0));\n", 1, 11005, 2),
    "scad_unknown": (START + "drill_all(3);\n", 1, 11006, 2),
    "scad_operation": (START + 'rapid(1, 2, 3);\necho([1] + "a");\n', 0, 11007, 3),
    "scad_call": ("rapid(1, 2, 3);\n", 1, 11008, 1),
    "scad_assert": (START + 'assert(1 > 2, "no");\n', 1, 11009, 2),
    "scad_assigned_twice": (START + "rapid(1, 2, 3);\na = 1;\na = 2;\n", 0, 11010, 4),
    "scad_order": (START + "rapid(1, 2, 3);\nx = xpos();\n", 0, 11011, 3),
    "scad_children": (START + "rapid(1, 2, 3)\nrapidZ(0);\n", 0, 11012, 3),
    "scad_refused": (START + "surface(\"a.png\");\n", 1, 11013, 2),
    "scad_shape": (START + 'rapid(1, 2, 3);\ncircle("a");\n', 1, 11014, 3),
}


@pytest.mark.parametrize("name", CASES)
def test_messages_have_their_line(name, tmp_path):
    text, status, code, line = CASES[name]
    done = run(tmp_path, text)
    assert f"[{code}]" in done.stderr, done.stderr
    lines = [row for row in done.stderr.splitlines() if f"[{code}]" in row]
    assert lines[0].startswith(f"part.scad:{line}:"), done.stderr
    assert done.returncode == status, done.stderr


def test_a_set_of_parameters_requires_its_file(tmp_path):
    done = run(tmp_path, START, "-P", "small")
    assert done.returncode == 1 and "[11015]" in done.stderr, "scad_parameters"


def test_values_of_variables_are_given_by_options(tmp_path):
    text = "depth = 1;\n" + START + "rapid(0, 0, 0);\ncutline(5, 5, -depth);\necho(zpos());\n"
    done = run(tmp_path, text, "-D", "depth=4")
    assert done.stdout.splitlines()[0] == "ECHO: -4", done.stdout
    sets = '{"parameterSets": {"deep": {"depth": "6"}}, "fileFormatVersion": "1"}'
    (tmp_path / "sets.json").write_text(sets)
    done = run(tmp_path, text, "-p", "sets.json", "-P", "deep")
    assert done.stdout.splitlines()[0] == "ECHO: -6", done.stdout


def test_options_of_scad_programs_have_no_effect_on_scripts(tmp_path):
    (tmp_path / "part.py").write_text("print('done')\n")
    done = subprocess.run([KERF, "run", "-D", "x=1", "part.py"], cwd=tmp_path, capture_output=True, text=True)
    assert "done" in done.stdout and "not an OpenSCAD program" in done.stderr


def test_a_program_does_not_replace_itself(tmp_path):
    text = 'gcp = gcodepreview("cut", true, true);\nopendxffile("part");\nclosedxffile();\n'
    (tmp_path / "part.dxf").write_text("before")
    assert run(tmp_path, text).returncode == 0
    assert "before" not in (tmp_path / "part.dxf").read_text()
    script = 'gcp = gcodepreview("cut", true, true);\nsetpost("part.scad");\nopengcodefile("part");\n'
    assert run(tmp_path, script + "closegcodefile();\n").returncode == 1
    assert (tmp_path / "part.scad").read_text() == script + "closegcodefile();\n"


# ---- what commands do with other files


TWO_SIDES = """gcp = gcodepreview("cut", true, true);
setupstock(60, 40, 10, "Top", "Lower-Left", 9);
movetosafeZ(); toolchange(202, 12000);
opengcodefile("side1");
cutsurface(function(x, y) -2 - sin(x * 6), 5, 5, 50, 30, 0.5);
closegcodefile();
flipstock("x");
toolchange(201, 12000);
opengcodefile("side2");
cutpocket(zdepth=2) translate([30, 20]) circle(10);
closegcodefile();
stockandtoolpaths();
"""


def test_the_second_side_is_cut_from_what_the_first_has_left(tmp_path):
    done = run(tmp_path, TWO_SIDES, "-o", "left.kstock")
    assert done.returncode == 0, done.stderr
    assert "M6 T202" in (tmp_path / "side1.nc").read_text()
    second = (tmp_path / "side2.nc").read_text()
    assert "M6 T201" in second and "cuts within X 23.175 to 36.825" in second
    text = 'gcp = gcodepreview("cut");\nstockfromfile("left.kstock");\npreviewgcodefile("side2.nc");\n'
    assert run(tmp_path, text, "-o", "again.png").returncode == 0
    assert (tmp_path / "again.png").exists()


def test_the_mesh_has_the_tolerance_that_was_asked_for(tmp_path):
    sizes = []
    for options in [], ["--mesh-tolerance", "0.2"]:
        done = run(tmp_path, TWO_SIDES, "-o", "part.stl", *options)
        assert done.returncode == 0, done.stderr
        sizes.append((tmp_path / "part.stl").stat().st_size)
    assert sizes[1] < 0.6 * sizes[0]
    done = run(tmp_path, TWO_SIDES, "-o", "part.png", "--mesh-tolerance", "0.2")
    assert done.returncode == 0 and "no mesh is written" in done.stderr


def test_a_program_that_reads_itself_ends(tmp_path):
    done = run(tmp_path, START + 'previewgcodefile("part.scad");\n')
    assert done.returncode == 1 and "part.scad" in done.stderr


def test_texts_of_comments_stay_comments(tmp_path):
    text = 'gcp = gcodepreview("cut", true);\nsetupstock(60, 40, 10);\nopengcodefile("part");\n'
    text += 'writecomment("x)\\nG0 Z-50 (");\nrapid(0, 0, 5);\ncutline(0, 0, -1);\nclosegcodefile();\n'
    done = run(tmp_path, text)
    assert done.returncode == 0, done.stderr
    lines = (tmp_path / "part.nc").read_text().splitlines()
    assert not [line for line in lines if "Z-50" in line and not line.startswith("(")]


def test_texts_of_the_display_stay_one_line(tmp_path):
    text = 'gcp = gcodepreview("print", true);\ndisplaymessage("a\\nG28");\ndisplaymessage("a; G28");\n'
    done = run(tmp_path, text)
    assert done.returncode == 1
    assert "part.scad:2:1: error: displaymessage: message must be one line" in done.stderr
    assert "1 more in line 3" in done.stderr


def test_arguments_without_bounds_are_refused(tmp_path):
    text = START + 'cutpocket(shape("circle", 0, 0, 1e6), 0, 1, 1e-9);\n'
    text += "cutsurface(function(x, y) x, 0, 0, 1e5, 1e5);\ncutarcCC(0, 1e12, 0, 0, 1, 0);\n"
    text += "rapid(1e300, 0, 0);\n"
    done = run(tmp_path, text)
    assert done.returncode == 1
    for line in (2, 3, 4, 5):
        assert f"part.scad:{line}:1: error" in done.stderr


# ---- syntax


def test_an_assignment_after_for_is_named(tmp_path):
    done = run(tmp_path, "for (i = [1, 2])\n  x = i;\n")
    assert done.returncode == 1
    assert "part.scad:2:5: error" in done.stderr and "braces" in done.stderr
    assert run(tmp_path, "for (i = [1, 2]) {\n  x = i;\n  echo(x);\n}\n").stdout == "ECHO: 1\nECHO: 2\n"


# ---- parameters for the user


PARAMETERS = """/* [Size] */
// Width in mm
width = 40; // [10:100]
name = "box"; // [box, lid]
/* [Hidden] */
secret = 5;
echo(width);
"""


def test_parameters_are_listed(tmp_path):
    done = run(tmp_path, PARAMETERS, "--list-parameters")
    assert done.returncode == 0, done.stderr
    assert done.stdout == 'Size\n  width = 40  [10:100]  (Width in mm)\n  name = "box"  [box, lid]\n'
    done = run(tmp_path, PARAMETERS, "--list-parameters", "--json")
    listed = json.loads(done.stdout)
    assert listed["diagnostics"] == []
    assert [(p["name"], p["value"], p["group"], p["line"]) for p in listed["parameters"]] == [
        ("width", "40", "Size", 3),
        ("name", '"box"', "Size", 4),
    ]
    assert listed["parameters"][0]["choices"] == "[10:100]"
    assert os.listdir(tmp_path) == ["part.scad"]


def test_parameters_of_a_wrong_program_are_no_success(tmp_path):
    assert run(tmp_path, "width = ;\n", "--list-parameters").returncode == 1

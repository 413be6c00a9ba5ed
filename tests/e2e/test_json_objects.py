"""kerf run --json and kerf view --json: one JSON object on standard output, and nothing else."""
import os
import signal
import subprocess
from pathlib import Path

import pytest
from conftest import KERF, VALID

SCRIPT = """import sys
import gcodepreview
print("hello", *sys.argv[1:])
part = gcodepreview.gcodepreview("cut", False, False)
part.setupstock(20, 20, 5, "Top", "Lower-Left", 5)
part.toolchange(102)
part.rapidZ(5)
part.rapidXY(10, 10)
part.cutline(10, 10, -2)
part.stockandtoolpaths()
"""
SCAD = """gcp = gcodepreview("cut", false, false);
echo("hello");
setupstock(20, 20, 5, "Top", "Lower-Left", 5);
movetosafeZ();
toolchange(102, 16000);
rapid(10, 10, 2);
cutline(15, 10, -1);
stockandtoolpaths();
"""
has_modules = pytest.mark.skipif(not (Path(KERF).resolve().parent / "python" / "kerf").is_dir(),
                                 reason="built without the Python modules")


@has_modules
def test_a_script(kerf, program, tmp_path):
    script = program(SCRIPT, "part.py")
    run = kerf("run", "--json", script.name, "-o", "part.stl", "-o", "part.png", "world")
    assert run.status == 0, run.err
    assert run.json == {"status": 0, "outputs": ["part.stl", "part.png"], "hazards": [], "diagnostics": []}
    assert "hello world" in run.err
    run = kerf("run", script.name, "--json")
    assert run.json["outputs"] == ["part.glb"] and (tmp_path / "part.glb").exists()


@has_modules
def test_a_script_that_fails(kerf, program):
    run = kerf("run", "--json", program("import sys\nsys.exit(7)\n", "part.py"))
    assert run.status == 7 and run.json["status"] == 7 and run.json["outputs"] == []
    assert run.codes() == ["script_failed"]
    run = kerf("run", "--json", program("print(1)\n", "part.py"), "-o", "part.stl")
    assert run.status == 1 and run.codes() == ["file_unwritable"]
    run = kerf("run", "--json", "none.py")
    assert run.status == 1 and run.codes() == ["file_unreadable"]
    program("", "kerf.py")
    run = kerf("run", "--json", program("", "other.py"))
    assert run.status == 0 and run.codes() == ["module_hidden"]


def test_an_openscad_program(kerf, program, tmp_path):
    run = kerf("run", "--json", program(SCAD, "part.scad"), "-o", "part.stl")
    assert run.status == 0 and 'ECHO: "hello"' in run.err
    assert run.json["status"] == 0 and run.json["hazards"] == [] and run.json["outputs"] == ["part.stl"]
    assert (tmp_path / "part.stl").exists()


def test_the_page_as_a_file(kerf, program, tmp_path):
    run = kerf("view", "--json", program(VALID), "--export", "part.html")
    assert run.status == 0, run.err
    assert run.json["outputs"] == ["part.html"] and isinstance(run.json["diagnostics"], list)
    assert (tmp_path / "part.html").exists() and run.err == ""
    run = kerf("view", "--json", program("G1 X10 @\n", "bad.nc"), "--export", "bad.html")
    assert run.status == 1 and run.codes()


def test_the_address_of_the_server(program, tmp_path):
    import json

    words = [KERF, "view", "--json", str(program(VALID)), "--port", "0"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, cwd=tmp_path, env=os.environ)
    try:
        shown = json.loads(server.stdout.readline())
        assert shown["address"].startswith(f"http://127.0.0.1:{shown['port']}/?t=")
    finally:
        server.send_signal(signal.SIGTERM)
        server.wait(timeout=60)

"""The bundled example: free of hazards, and cut to a picture and a mesh."""
import json
import os
import struct
import subprocess
from pathlib import Path

KERF = os.environ["KERF"]
DEMO = Path(__file__).parents[2] / "examples" / "demo.nc"


def kerf(*arguments):
    return subprocess.run([KERF, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def test_the_example_has_no_hazard():
    run = kerf("check", "--json", DEMO)
    assert json.loads(run.stdout)["hazards"] == []
    assert run.returncode == 0, run.stderr


def test_the_example_becomes_a_picture_and_a_mesh(tmp_path):
    run = kerf("simulate", DEMO, "-o", tmp_path / "demo.png", "-o", tmp_path / "demo.stl")
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG\r\n")
    stl = (tmp_path / "demo.stl").read_bytes()
    triangles = struct.unpack_from("<I", stl, 80)[0]
    assert triangles > 10_000 and len(stl) == 84 + 50 * triangles

"""Program files (.kerf): written by every command with programs, read by every one, without loss."""
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = """G21 G90
(TOOL/MILL, 3.0, 0.0, 12.0, 0.0)
T1 M6
M3 S9000
G54
G0 X5 Y5 Z5
G1 Z-2 F100
G2 X15 Y5 I5 J0
G18 G3 X25 Z-2 I5 K0
G17 G0 Z5 A90
G38.2 Z-5 F50
G92 Z0
G1 X10 F200
G53 G0 Z0
M5
M30
"""


def steps(kerf, file, *options):
    """The lines of `kerf steps` without the first, which names the file."""
    done = kerf("steps", file, *options)
    assert done.status == 0, done.err
    return done.out.splitlines()[1:]


def saved(kerf, file, folder, *options):
    out = folder / "saved.kerf"
    done = kerf("post", file, *options, "-o", out)
    assert done.status == 0, done.err
    return out


KINDS = (".nc", ".ngc", ".gcmc", ".gcode", ".toml")
EXAMPLES = sorted(p for folder in ("examples", "tests/data/gcode") for p in (ROOT / folder).rglob("*")
                  if p.suffix in KINDS)


def test_steps_of_a_saved_program_are_the_same(kerf, tmp_path):
    file = tmp_path / "part.nc"
    file.write_text(PROGRAM)
    assert steps(kerf, saved(kerf, file, tmp_path)) == steps(kerf, file)


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda p: p.name)
def test_examples_are_saved_without_loss(kerf, file, tmp_path):
    done = kerf("steps", file)
    if done.status != 0:
        pytest.skip("no program")
    out = saved(kerf, file, tmp_path)
    assert steps(kerf, out) == done.out.splitlines()[1:]
    info, again = (kerf("info", "--json", f).json for f in (file, out))
    for key in ("motion", "time_s", "feeds", "speeds", "units", "front_end"):
        assert again.get(key) == info.get(key), key


def simulated(kerf, file, *options):
    done = kerf("simulate", file, "--json", *options)
    assert done.status == 0, done.err
    return done.json


def test_a_saved_program_has_its_tools_and_stock(kerf, tmp_path):
    """A holder that touches, and a block that G-code would assume to be another one."""
    file = tmp_path / "part.nc"
    file.write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X20 Y20 Z5\nG1 Z-14 F100\nG0 Z5\nM30\n")
    options = ("--stock", "40x40x20 at lower-left top", "--tool",
               "1=square d=3 flute=6 shank=3 shank_length=6 holder=30 holder_length=20")
    out = tmp_path / "part.kerf"
    done = kerf("simulate", file, *options, "-o", out)
    assert done.status == 0, done.err
    first, again = simulated(kerf, file, *options), simulated(kerf, out)
    # A hole of 3 mm, and the holder from 12 mm above the tip: 2 mm deep.
    assert first["removed_mm3"] == pytest.approx(3.14159265 * (1.5 ** 2 * 12 + 15 ** 2 * 2), rel=0.02)
    for key in ("removed_mm3", "left_mm3", "hazards"):
        assert again[key] == first[key], key
    assert [t["source"] for t in again["tools"]] == ["program"]
    assert "holder_contact" in [h["kind"] for h in again["hazards"]]
    assert again["hazards"][0]["origin"]["file"] == str(file)
    narrow = simulated(kerf, out, "--tool", "1=square d=3 flute=20")
    assert "holder_contact" not in [h["kind"] for h in narrow["hazards"]]


def test_a_mesh_stock_is_saved(kerf, tmp_path):
    file = tmp_path / "part.nc"
    file.write_text("G21 G90\nT102 M6\nM3 S9000\nG0 X-5 Y5 Z5\nG0 Z-1\nG1 X20 F500\nG0 Z5\nM30\n")
    mesh = tmp_path / "prism.stl"  # a prism over a triangle, 10 x 10, 5 high
    corners = [(0, 0), (10, 0), (0, 10)]
    low, high = [(x, y, -5) for x, y in corners], [(x, y, 0) for x, y in corners]
    faces = [(low[0], low[2], low[1]), tuple(high)]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        faces += [(low[a], low[b], high[b]), (low[a], high[b], high[a])]
    mesh.write_text("solid prism\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in face)
        + "endloop\nendfacet\n" for face in faces) + "endsolid\n")
    out = tmp_path / "part.kerf"
    assert kerf("simulate", file, "--stock-mesh", mesh, "-o", out).status == 0
    mesh.unlink()
    result = simulated(kerf, out)
    assert result["stock_mm3"] == pytest.approx(250, rel=0.01)


def test_other_outputs_and_endings(kerf, tmp_path):
    file = tmp_path / "part.nc"
    file.write_text(PROGRAM)
    wrong = kerf("post", "--to", "grbl", file, "-o", tmp_path / "part.kerf")
    assert wrong.status == 2 and ".kerf is for program files" in wrong.err
    nameless = kerf("post", "--to", "kerf", file)
    assert nameless.status == 2 and "ends in .kerf" in nameless.err
    out = saved(kerf, file, tmp_path)
    unknown = tmp_path / "part.data"
    out.rename(unknown)
    assert steps(kerf, unknown) == steps(kerf, file)  # recognised by its content


def test_damaged_and_newer_files_are_refused(kerf, tmp_path):
    file = tmp_path / "part.nc"
    file.write_text(PROGRAM)
    out = saved(kerf, file, tmp_path)
    good = out.read_bytes()
    out.write_bytes(good[:8] + bytes([9]) + good[9:])
    for command in ("simulate", "check", "info", "steps"):
        done = kerf(command, out)
        assert done.status == 1
        assert done.err.count("error") == 1 and "version 9" in done.err and "up to version 2" in done.err
    out.write_bytes(good[:-30])
    done = kerf("simulate", out)
    assert done.status == 1 and done.err.count("error") == 1 and "damaged" in done.err

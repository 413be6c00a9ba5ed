"""kerf cut on meshes: rasters, waterlines and projected paths, judged by the simulator and kerf compare."""
import math
import struct

import pytest


def write_stl(path, triangles):
    """Binary STL of triangles of three points each."""
    data = bytearray(80) + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(v for p in triangle for v in p), 0)
    path.write_bytes(data)


def solid(height, wide, deep, n, bottom):
    """A closed solid below z = height(x, y), over 0..wide and 0..deep, of n x n squares."""
    def top(i, j):
        x, y = wide * i / n, deep * j / n
        return (x, y, height(x, y))

    def low(i, j):
        return (*top(i, j)[:2], bottom)

    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
            triangles += [(top(*a), top(*b), top(*c)), (top(*a), top(*c), top(*d))]
            triangles += [(low(*a), low(*c), low(*b)), (low(*a), low(*d), low(*c))]
    for k in range(n):
        for a, b in (((k, 0), (k + 1, 0)), ((n, k), (n, k + 1)), ((k + 1, n), (k, n)), ((0, k + 1), (0, k))):
            triangles += [(low(*a), low(*b), top(*b)), (low(*a), top(*b), top(*a))]
    return triangles


def dome(x, y):
    """A ball of radius 14 that rises from a plane at Z-8, with its centre above the plane's centre."""
    square = 14**2 - (x - 20)**2 - (y - 20)**2
    return max(-8.0, math.sqrt(square) - 14.0 if square > 0 else -8.0)


@pytest.fixture
def part(tmp_path):
    path = tmp_path / "part.stl"
    write_stl(path, solid(dome, 40, 40, 120, -12))
    return path


STOCK = ("--stock", "0,0,-12 to 40,40,0")
TOOLS = {"ball": "ball d=4", "bull nose": "bull nose d=4 corner_radius=0.5", "square": "square d=4"}


@pytest.mark.parametrize("tool", TOOLS)
def test_a_raster_leaves_the_part_and_cuts_none_of_it(kerf, part, tool):
    made = kerf("cut", part, "--op", "raster", "--tool", TOOLS[tool], "--line-distance", "0.3",
                "--overhang", "2", "--rpm", "16000", "--feed", "1200", "-o", "part.nc")
    assert made.status == 0, made.err
    job = (*STOCK, "--tool", "1=" + TOOLS[tool])
    run = kerf("compare", "--json", "part.nc", part, *job, "--resolution", "0.1")
    assert run.status == 0, run.err
    assert run.json["gouge"]["largest_mm"] < 0.005
    # A ball leaves 0.006 mm between lines on level ground; a square mill leaves steps on the slope.
    assert run.json["rest"]["largest_mm"] < (0.6 if tool == "square" else 0.35)
    check = kerf("check", "part.nc", *job)
    assert check.status == 0, check.out


def test_a_raster_in_passes(kerf, part):
    made = kerf("cut", part, "--op", "raster", "--tool", "ball d=6", "--stepdown", "2", "--allowance", "0.5",
                "--stepover", "0.3", "--overhang", "3", "--rpm", "16000", "--feed", "1200", "-o", "part.nc")
    assert made.status == 0, made.err
    run = kerf("compare", "--json", "part.nc", part, *STOCK, "--tool", "1=ball d=6", "--resolution", "0.2")
    assert run.json["gouge"]["volume_mm3"] == 0
    assert 0.49 < run.json["rest"]["largest_mm"] < 1.6


def test_waterlines_do_not_cut_the_part(kerf, part):
    made = kerf("cut", part, "--op", "waterline", "--tool", "ball d=4", "--stepdown", "1", "--rpm", "16000",
                "--feed", "1200", "-o", "part.nc")
    assert made.status == 0, made.err
    run = kerf("compare", "--json", "part.nc", part, *STOCK, "--tool", "1=ball d=4", "--resolution", "0.1")
    assert run.json["gouge"]["largest_mm"] < 0.005
    levels = {w for w in (part.parent / "part.nc").read_text().split() if w.startswith("Z-")}
    assert levels == {f"Z-{k}" for k in range(1, 13)}


def test_an_engraving_is_projected_onto_the_part(kerf, part, tmp_path):
    (tmp_path / "ring.json").write_text(
        '{"unit": "mm", "outlines": [{"name": "ring", "closed": true, "first": {"at": [26, 20]},'
        ' "segments": [{"to": [14, 20], "via": [20, 26]}, {"to": [26, 20], "via": [20, 14]}]}]}')
    made = kerf("cut", "ring.json", "--mesh", part, "--op", "project", "--tool", "ball d=2", "--depth", "0.5",
                "--feed", "600", "--rpm", "16000")
    assert made.status == 0, made.err
    # A ball of radius 1 touches the ball of 14 at a height of the circle of 15, 6 mm from its axis.
    expected = math.sqrt(15**2 - 6**2) - 1 - 14 - 0.5
    words = [word for line in made.out.splitlines() for word in line.split()]
    depths = [float(word[1:]) for word in words if word.startswith("Z-")][1:]  # the first is above the part
    assert len(depths) > 10
    assert all(abs(z - expected) < 0.03 for z in depths)


def test_a_job_with_a_mesh(kerf, part, tmp_path):
    job = ('[surface]\nfile = "part.stl"\nmove = [5, 0, -1]\n[tools]\n1 = "ball d=6"\n'
           '[[operation]]\nop = "raster"\ntool = 1\nfeed = 900\nstepover = 0.5\n')
    (tmp_path / "job.toml").write_text(job)
    run = kerf("info", "--json", "job.toml")
    assert run.status == 0, run.err
    box = run.json["motion"]["cut_bounds_mm"]
    assert box["low"][0] == pytest.approx(5) if isinstance(box, dict) else box[0][0] == pytest.approx(5)
    (tmp_path / "bad.toml").write_text(job.replace("part.stl", "part.dxf"))
    bad = kerf("check", "bad.toml")
    assert bad.status == 1 and "not a mesh" in bad.err


@pytest.mark.parametrize("change, message", [
    ('move = [1, 2]', "move must be"),
    ('scale = 0', "scale must be"),
    ('heights = [[1, 2], [3]]', "row of heights"),
    ('heights = [[1, 2], [3, 4]]', "rectangle"),
    ('colour = 1', "unknown key"),
])
def test_errors_of_a_surface_name_the_line(kerf, tmp_path, change, message):
    (tmp_path / "job.toml").write_text(
        f'[surface]\n{change}\n[tools]\n1 = "ball d=6"\n[[operation]]\nop = "raster"\ntool = 1\nfeed = 900\n')
    run = kerf("check", "job.toml")
    assert run.status == 1
    assert "job.toml:" in run.err and message in run.err


def test_wrong_meshes(kerf, part, tmp_path):
    raster = ("--op", "raster", "--tool", "ball d=6", "--feed", "900")
    assert "no mesh is given" in kerf("cut", "--text", "A", "--height", "5", *raster).err
    assert "above the surface" in kerf("cut", part, *raster, "--top", "-2").err
    assert kerf("cut", part, *raster, "--mesh-move", "1,2").status == 2
    concave = ("--tool", "roundover tip_diameter=2 radius=3 flute=10", "--feed", "900")
    assert "cannot follow a surface" in kerf("cut", part, "--op", "raster", *concave).err
    write_stl(tmp_path / "empty.stl", [])
    assert kerf("cut", "empty.stl", *raster).status == 1

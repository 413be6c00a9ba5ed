"""kerf simulate: figures, tools, stock, files, and refusals."""
import json
import math
import random
import struct

import pytest
from conftest import VALID


def exact_removed():
    """mm3 that the valid program removes, 1 mm deep: a strip, half a ring, half a disc at both ends."""
    r = 3.175 / 2
    return 2 * r * 10 + math.pi * 5 * 2 * r + math.pi * r * r


def test_figures_of_a_valid_program(kerf, program):
    run = kerf("simulate", "--json", "--resolution", "0.02", program())
    assert run.status == 0, run.err
    got = run.json
    assert got["stock_mm3"] == pytest.approx(40 * 30 * 6, rel=1e-9)
    assert got["removed_mm3"] == pytest.approx(exact_removed(), rel=2e-3)
    assert got["left_mm3"] == pytest.approx(got["stock_mm3"] - got["removed_mm3"], abs=1e-6)
    assert got["resolution_mm"] == 0.02
    assert got["steps"] > 5 and got["seconds"] >= 0
    assert got["hazards"] == [] and got["outputs"] == []
    assert got["stock"]["source"] == "program"
    assert [t["number"] for t in got["tools"]] == [102]
    assert got["tools"][0]["removed_mm3"] == pytest.approx(got["removed_mm3"], rel=1e-3)
    assert got["tools"][0]["time_s"] > 0
    assert not [d for d in got["diagnostics"] if d["severity"] == "error"]
    assert run.err == ""


def test_quiet_omits_the_summary(kerf, program):
    run = kerf("simulate", program())
    assert run.status == 0
    assert "removed" in run.out and "hazards  none" in run.out
    assert kerf("simulate", "--quiet", program()).out == ""


def test_a_rapid_through_the_stock_is_reported_with_its_line(kerf, program):
    path = program(VALID.replace("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5"))
    run = kerf("simulate", "--json", path)
    assert run.status == 0
    hazard, = [h for h in run.json["hazards"] if h["kind"] == "rapid_in_stock"]
    assert hazard["origin"]["line"] == 11
    assert hazard["depth_mm"] == pytest.approx(1, abs=0.01) and hazard["removed_mm3"] > 1
    assert len(hazard["at"]) == 3 and "rapid" in hazard["message"]
    text = kerf("simulate", path).out
    assert f"{path}:11" in text and "[rapid_in_stock]" in text


def test_every_kind_of_output(kerf, program, files):
    path = program()
    run = kerf("simulate", "--json", "--resolution", "0.5", path, *sum((["-o", f"part.{e}"] for e in
               ("stl", "3mf", "glb", "obj", "png")), []), "--view", "top", "--size", "320x200")
    assert run.status == 0, run.err
    assert run.json["outputs"] == ["part.stl", "part.3mf", "part.glb", "part.obj", "part.png"]
    assert files() == sorted(["part.nc"] + run.json["outputs"])
    folder = path.parent
    stl = (folder / "part.stl").read_bytes()
    assert len(stl) == 84 + 50 * struct.unpack_from("<I", stl, 80)[0]
    assert (folder / "part.3mf").read_bytes()[:2] == b"PK"
    assert (folder / "part.glb").read_bytes()[:4] == b"glTF"
    assert "\nf " in (folder / "part.obj").read_text()
    png = (folder / "part.png").read_bytes()
    assert png[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", png[16:24]) == (320, 200)


@pytest.mark.parametrize("view", ["top", "front", "back", "left", "right", "iso", "-35,50", "120,-20"])
def test_views(kerf, program, files, view):
    run = kerf("simulate", "--resolution", "0.5", program(), "-o", "v.png", "--view", view, "--size", "64x48")
    assert run.status == 0, run.err
    assert "v.png" in files()


def test_views_differ(kerf, program, folder_bytes):
    pictures = {}
    for view in ("top", "front", "back", "left", "right", "iso", "40,30", "120,-20"):
        assert kerf("simulate", "--resolution", "0.5", program(), "-o", "v.png", "--view", view,
                    "--size", "64x48").status == 0
        pictures[view] = folder_bytes()["v.png"]
        assert struct.unpack(">II", pictures[view][16:24]) == (64, 48)
    assert len(set(pictures.values())) == len(pictures)


@pytest.mark.parametrize("plane, view", [("x=20", "left"), ("Y=15", "-35,50"), ("z=-0.5", "top"),
                                         ("x=0.5in", "iso")])
def test_a_section_changes_the_picture_alone(kerf, program, folder_bytes, plane, view):
    path = program()
    common = ["--resolution", "0.5", path, "-o", "v.png", "-o", "v.stl", "--view", view, "--size", "64x48"]
    assert kerf("simulate", *common).status == 0
    whole = folder_bytes()
    run = kerf("simulate", *common, "--section", plane)
    assert run.status == 0, run.err
    open_ = folder_bytes()
    assert open_["v.png"] != whole["v.png"] and open_["v.stl"] == whole["v.stl"]


@pytest.mark.parametrize("plane", ["w=3", "x", "x=", "x=left", "25", "x>25", "x=nan"])
def test_an_invalid_section_is_wrong_usage(kerf, program, files, plane):
    run = kerf("simulate", program(), "-o", "v.png", "--section", plane)
    assert run.status == 2
    assert "--section" in run.err and "x=25" in run.err
    assert files() == ["part.nc"]


def test_a_section_that_the_view_cannot_see(kerf, program):
    run = kerf("simulate", program(), "-o", "v.png", "--view", "top", "--section", "x=20")
    assert run.status == 2
    assert "parallel to the plane" in run.err and "--view" in run.err


def test_a_section_beside_the_part(kerf, program, files):
    run = kerf("simulate", program(), "-o", "v.png", "-o", "v.stl", "--section", "x=41")
    assert run.status == 1
    assert "[1017]" in run.err and "x=0 to 40" in run.err  # section_outside
    assert files() == ["part.nc"]


def test_a_section_without_a_picture_is_an_unused_option(kerf, program):
    assert "option_unused" in kerf("simulate", "--json", program(), "--section", "x=20").codes()


def test_the_result_is_the_same_for_any_number_of_threads(kerf, program):
    path = program()
    one = kerf("simulate", "--json", "--resolution", "0.1", "--threads", "1", path).json
    four = kerf("simulate", "--json", "--resolution", "0.1", "--threads", "4", path).json
    assert one["removed_mm3"] == four["removed_mm3"]


def test_a_block_of_a_few_columns_is_cut_again_for_a_mesh(kerf, program, files):
    """Three by four columns are too few for an exact mesh along the block's side."""
    path = program("G21 G90\nM6 T1\nM3 S1000\nG0 X-0.18 Y4.7 Z5\nG1 Z-1.2 F100\nG0 Z9\nM30\n")
    for resolution in ("2", "0.2"):
        run = kerf("simulate", "--json", "--tool", "roundover tip=2 radius=3 flute=9", "--stock",
                   "0,0,-3 to 6,8,0", "--resolution", resolution, path, "-o", "o.stl")
        assert run.status == 0, run.err
        assert "mesh_unsound" not in run.codes() and "o.stl" in files()


def test_standard_input_is_gcode(kerf):
    run = kerf("simulate", "--json", "-", stdin=VALID.encode())
    assert run.status == 0, run.err
    assert run.json["source"] == "<stdin>" and run.json["removed_mm3"] > 0


def test_stock_option_wins_over_comments(kerf, program):
    run = kerf("simulate", "--json", program(), "--stock", "50x50x10 at lower-left top")
    assert run.json["stock_mm3"] == pytest.approx(25000)
    assert run.json["stock"] == {"block_mm": [[0, 0, -10], [50, 50, 0]], "size_mm": [50, 50, 10],
                                 "source": "option"}


def test_an_assumed_stock_lies_around_the_cuts(kerf, program):
    text = "\n".join(line for line in VALID.split("\n") if "stock" not in line)
    run = kerf("simulate", "--json", program(text))
    assert run.status == 0
    assert "stock_assumed" in run.codes()
    low, high = run.json["stock"]["block_mm"]
    margin = 3.175 / 2 + 2
    assert low == pytest.approx([10 - margin, 10 - margin, -2])
    assert high[0] == pytest.approx(25 + margin) and high[1] == pytest.approx(20 + margin)


def test_an_unknown_tool_is_assumed_with_an_example(kerf, program, files):
    run = kerf("simulate", program(VALID.replace("T102", "T77")), "-o", "part.stl")
    assert run.status == 0
    assert "part.nc:8" in run.err and "[1009]" in run.err  # no_tool_shape, at the first cut
    assert '--tool 77="square d=3.175"' in run.err
    assert files() == ["part.nc", "part.stl"]


def test_tool_options(kerf, program):
    path = program(VALID.replace("T102", "T77"))
    by_number = kerf("simulate", "--json", path, "--tool", "77=square d=3.175 flute=12.7").json
    for_all = kerf("simulate", "--json", path, "--tool", "square d=3.175 flute=12.7").json
    of_table = kerf("simulate", "--json", path, "--tool", "77=102").json
    assert by_number["removed_mm3"] == for_all["removed_mm3"] == of_table["removed_mm3"]
    assert by_number["tools"][0]["source"] == "option"
    wider = kerf("simulate", "--json", program(), "--tool", "102=square d=6 flute=12").json
    assert wider["removed_mm3"] > 1.8 * by_number["removed_mm3"]


def test_one_tool_option_for_several_tools_is_noted(kerf, program):
    two = VALID.replace("M5\n", "M6 T101\nG1 X30 F100\nM5\n")
    run = kerf("simulate", "--json", program(two), "--tool", "square d=3 flute=9")
    assert "tool_option_wide" in run.codes()


def test_a_program_without_a_tool_change(kerf, program):
    path = program(VALID.replace("M6 T102\n", ""))
    run = kerf("simulate", path)
    assert run.status == 0
    assert "[1009]" in run.err and '--tool "square d=3.175"' in run.err  # no_tool_shape
    with_tool = kerf("simulate", "--json", path, "--tool", "square d=3.175 flute=12.7")
    assert with_tool.status == 0
    assert with_tool.json["removed_mm3"] == kerf("simulate", "--json", program()).json["removed_mm3"]


def test_tools_from_a_file(kerf, program):
    shop = program('[[tool]]\nnumber = 77\nshape = "square"\ndiameter = 6.0\nflute = 12.0\n', "shop.toml")
    run = kerf("simulate", "--json", program(VALID.replace("T102", "T77")), "--tools", shop)
    assert run.status == 0, run.out
    assert run.json["tools"][0]["source"] == "tool file"


def test_a_broken_tool_file_is_an_error_with_its_line(kerf, program):
    run = kerf("simulate", program(), "--tools", program("[[tool]\nnumber=", "shop.toml"))
    assert run.status == 1
    assert "shop.toml:1" in run.err


def test_nothing_to_cut(kerf, program):
    run = kerf("simulate", "--json", program("G21\nG0 X1 Y1 Z1\nM2\n"))
    assert run.status == 1
    assert "nothing_to_cut" in run.codes()


def test_a_resolution_that_is_too_fine_is_an_error(kerf, program):
    run = kerf("simulate", program(), "--stock", "5000x5000x10", "--resolution", "0.001")
    assert run.status == 1
    assert "[6004]" in run.err  # too_many_columns


def test_a_resolution_in_inches(kerf, program):
    run = kerf("simulate", "--json", program(), "--resolution", "0.01in")
    assert run.json["resolution_mm"] == pytest.approx(0.254)


def test_the_count_of_hazards_is_that_of_the_lines(kerf, program):
    text = VALID.replace("M3 S10000\n", "M5\n")
    text = text.replace("G1 X20 F400\n", "G1 X20 F400\nG0 Z5\nG0 X20\nG1 Z-1\n")
    run = kerf("simulate", program(text))
    lines = [line for line in run.out.split("\n") if line.endswith("]")]
    assert len(lines) == 1 and "[spindle_off]" in lines[0] and "in 3 motions" in lines[0]
    assert "hazards  1 in 3 motions\n" in run.out


def test_a_tool_that_cuts_nothing_has_no_line(kerf, program):
    run = kerf("simulate", program(VALID.replace("M6 T102\n", "M6 T101\nG0 X0\nM6 T102\n")))
    assert "tool 102" in run.out and "tool 101" not in run.out


SLOTS = """G21 G90
S1000 M3
G0 X0 Y0 Z2
G1 Z-1 F100
G1 X10
G0 Z2
T1 M6
M3
G0 X20
G1 Z-1
G1 X30
G0 Z2
T2 M6
M3
G0 X40
G1 Z-1
G0 Z2
M2
"""


def test_the_tool_before_the_first_change_has_a_number_of_its_own(kerf, program):
    """3, as the program uses 1 and 2: each tool has what it removes itself."""
    slot, hole = 3 * 10 + math.pi * 1.5**2, math.pi * 1.5**2
    run = kerf("simulate", "--json", "--stock", "-5,-5,-5 to 50,5,0", "--tool", "square d=3 flute=9",
               "--resolution", "0.02", program(SLOTS))
    assert [t["number"] for t in run.json["tools"]] == [3, 1, 2]
    assert [t["source"] for t in run.json["tools"]] == ["option"] * 3
    removed = [t["removed_mm3"] for t in run.json["tools"]]
    assert removed == pytest.approx([slot, slot, hole], rel=2e-3)


def test_a_numbered_tool_is_the_one_before_the_first_change_only_without_changes(kerf, program):
    stock = ("--stock", "-5,-5,-5 to 50,5,0")
    alone = "\n".join(SLOTS.splitlines()[:6]) + "\nM2\n"
    tool = ("--tool", "7=square d=2 flute=9")
    run = kerf("simulate", "--json", "--resolution", "0.02", *stock, *tool, program(alone))
    assert [(t["number"], t["source"]) for t in run.json["tools"]] == [(7, "option")]
    assert run.json["removed_mm3"] == pytest.approx(2 * 10 + math.pi, rel=2e-3)
    run = kerf("simulate", "--json", *stock, *tool, program(SLOTS))
    assert [t["source"] for t in run.json["tools"]][0] == "assumed"


def glb_volume(path):
    """mm3 that the triangles of a GLB enclose."""
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    scene, binary = json.loads(data[20:20 + size]), data[28 + size:]

    def numbers(index, kind, count):
        accessor = scene["accessors"][index]
        view = scene["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return struct.unpack_from(f"<{count * accessor['count']}{kind}", binary, start)

    six = 0.0
    for primitive in scene["meshes"][0]["primitives"]:
        at = numbers(primitive["attributes"]["POSITION"], "f", 3)
        corners = list(zip(*[iter(at)] * 3))
        if "indices" in primitive:
            corners = [corners[i] for i in numbers(primitive["indices"], "I", 1)]
        for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in zip(*[iter(corners)] * 3):
            six += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return six / 6


def test_a_glb_alone_is_coarser_than_beside_other_meshes(kerf, program, tmp_path):
    """Within 0.02 mm instead of 0.002: fewer triangles, and the volume of a slot of a ball, half a cylinder
    between two quarters of the ball, as deep as its radius, within its surface times 0.02."""
    slot = program("G21 G90\nT1 M6\nS9000 M3\nG0 X10 Y10 Z5\nG1 Z-3 F100\nX30 Y17\nG0 Z5\nM2\n")
    options = ("--resolution", "0.1", "--stock", "0,0,-5 to 40,30,0", "--tool", "ball d=6 flute=9")
    assert kerf("simulate", *options, slot, "-o", "alone.glb").status == 0
    assert kerf("simulate", *options, slot, "-o", "both.glb", "-o", "both.stl").status == 0
    alone, both = tmp_path / "alone.glb", tmp_path / "both.glb"
    assert alone.stat().st_size < 0.8 * both.stat().st_size
    long = math.hypot(20, 7)
    left = 40 * 30 * 5 - math.pi * 9 / 2 * long - 2 / 3 * math.pi * 27
    surface = math.pi * 3 * long + 2 * math.pi * 9
    assert glb_volume(both) == pytest.approx(left, abs=surface * 0.002)
    assert glb_volume(alone) == pytest.approx(left, abs=surface * 0.02)


def test_the_materials_of_a_glb_name_the_tools(kerf, program, tmp_path):
    two = VALID.replace("M5\n", "G0 X30 Y5\nM6 T101\nM3 S9000\nG1 Z-1\nG0 Z5\nM5\n")
    kerf("simulate", program(two), "-o", "part.glb")
    data = (tmp_path / "part.glb").read_bytes()
    scene = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    assert {"stock", "tool 102", "tool 101"} <= {m["name"] for m in scene["materials"]}


WITHOUT_STOCK = "\n".join(line for line in VALID.split("\n") if "stock" not in line)


def test_feeds_that_lift_do_not_raise_the_assumed_stock(kerf, program):
    run = kerf("simulate", "--json", program(WITHOUT_STOCK.replace("G0 Z5\nM5", "G1 Z15 F900\nG1 X-50\nM5")))
    low, high = run.json["stock"]["block_mm"]
    assert high[2] == 0 and low[0] == pytest.approx(10 - 3.175 / 2 - 2)
    assert run.json["hazards"] == []


def test_a_program_with_zero_on_the_bed_is_simulated_with_a_warning(kerf, program):
    slots = "".join(f"G0 X10 Z12\nG1 Z{z} F100\nG1 X20 F400\n" for z in (6, 4, 2, 0))
    run = kerf("simulate", "--json", program(f"M6 T102\nM3 S9000\nG0 Y10 Z12\n{slots}G0 Z12\nM5\nM2\n"))
    (low, high) = run.json["stock"]["block_mm"]
    assert (low[2], high[2]) == (0, 8)
    exact = 8 * (10 * 3.175 + math.pi * 3.175**2 / 4)
    assert run.json["removed_mm3"] == pytest.approx(exact, rel=0.01)
    assumed = next(d for d in run.json["diagnostics"] if d["name"] == "stock_assumed")
    assert assumed["severity"] == "warning" and "--stock" in assumed["hint"]


def test_the_hint_of_an_assumed_stock_gives_the_same_one(kerf, program):
    path = program(WITHOUT_STOCK)
    run = kerf("simulate", "--json", path)
    hint = next(d for d in run.json["diagnostics"] if d["name"] == "stock_assumed")["hint"]
    again = kerf("simulate", "--json", path, "--stock", hint.split('"')[1])
    assert again.json["removed_mm3"] == pytest.approx(run.json["removed_mm3"], rel=1e-3)


def test_a_program_that_cuts_nothing_below_zero_is_reported(kerf, program):
    run = kerf("simulate", program(WITHOUT_STOCK.replace("Z-1", "Z0")))
    assert run.status == 0
    assert "does not cut below Z0" in run.err and "[1011]" in run.err  # stock_assumed


def test_a_huge_stock_gets_a_coarser_resolution(kerf, program):
    run = kerf("check", "--json", program(), "--stock", "100000x100000x100 at centre top")
    hazard, = run.json["hazards"]  # its cuts are narrower than the distance of the columns
    assert run.status == 3 and hazard["kind"] == "stock_untouched" and "--resolution" in hazard["hint"]
    run = kerf("simulate", "--json", program(), "--stock", "100000x100000x100 at centre top")
    assert run.status == 0, run.out
    assert 1 < run.json["resolution_mm"] < 20


def slopes(count=120):
    """Sloped cuts with a ball of 6 mm, at most 3 mm deep; the ends of the ball's centre."""
    rng = random.Random(1)
    lines, segments = ["G21 G90", "T1 M6", "S9000 M3", "G0 Z5"], []
    for _ in range(count):
        (x, y), (u, v) = ((rng.uniform(10, 110), rng.uniform(10, 80)) for _ in range(2))
        low, high = (-round(rng.uniform(0.5, 3), 3) for _ in range(2))
        x, y, u, v = (round(c, 3) for c in (x, y, u, v))
        lines += [f"G0 X{x} Y{y}", f"G1 Z{low} F300", f"G1 X{u} Y{v} Z{high}", "G0 Z5"]
        segments.append(((x, y, low + 3), (u, v, high + 3)))
    return "\n".join(lines + ["M30", ""]), segments


def to_axis(p, segment):
    """Distance of a point from a segment."""
    a, b = segment
    d = [q - o for o, q in zip(a, b)]
    t = sum((c - o) * e for c, o, e in zip(p, a, d)) / max(sum(e * e for e in d), 1e-12)
    t = min(1.0, max(0.0, t))
    return math.dist(p, [o + t * e for o, e in zip(a, d)])


def centroids_of(stl):
    data = stl.read_bytes()
    for k in range(struct.unpack_from("<I", data, 80)[0]):
        corners = struct.unpack_from("<12f", data, 84 + 50 * k)[3:]
        yield [sum(corners[axis::3]) / 3 for axis in range(3)]


def test_a_coarse_resolution_makes_a_small_mesh(kerf, program):
    """Each point of a cut is 3 mm from the nearest path of the ball's centre, within the tolerance."""
    text, segments = slopes()
    path = program(text)
    common = ["--tool", "1=ball d=6 flute=20", "--stock", "0,0,-10 to 120,90,0", path]
    sizes = []
    for options, limit in (["--resolution", "0.4"], 0.1), (["--mesh-tolerance", "0.05"], 0.05):
        run = kerf("simulate", *options, "-o", "part.stl", *common)
        assert run.status == 0, run.err
        stl = path.parent / "part.stl"
        sizes.append(stl.stat().st_size)
        points = [p for p in centroids_of(stl)
                  if -9 < p[2] < -0.01 and 1 < p[0] < 119 and 1 < p[1] < 89][::23]
        errors = sorted(abs(min(to_axis(p, s) for s in segments) - 3) for p in points)
        assert len(points) > 1000
        assert errors[int(0.99 * len(errors))] < limit
    assert kerf("simulate", "-o", "part.stl", *common).status == 0
    assert sizes[0] < 8e6 and sizes[1] < 0.5 * (path.parent / "part.stl").stat().st_size


@pytest.mark.parametrize("options, tolerance", [
    (["--mesh-tolerance", "0.05"], 0.05), (["--resolution", "0.4"], 0.4 ** 2 / 4.8), ([], 0.002)])
def test_the_tolerance_of_a_mesh_is_stated(kerf, program, options, tolerance):
    run = kerf("simulate", "--json", *options, "-o", "part.stl", program())
    assert run.status == 0, run.err
    assert abs(run.json["mesh_tolerance_mm"] - tolerance) < 1e-6
    assert "mesh_tolerance_mm" not in kerf("simulate", "--json", *options[:-2], program()).json


def test_a_mesh_tolerance_without_a_mesh_is_unused(kerf, program):
    run = kerf("simulate", "--json", "--mesh-tolerance", "0.1", program())
    assert run.status == 0 and "option_unused" in run.codes()
    assert kerf("simulate", "--mesh-tolerance", "0", program()).status == 2

"""Programs of CAM programs without options: tools and stock of their comments, assumed tools, pictures."""
import re
import struct

import pytest
from png_pixels import PNG, pixels


START = "G21 G90\nT7 M6\nM3 S9000\n"
BODY = "G0 Z5\nG0 X10 Y10\nG1 Z-1 F100\nG1 X40 F300\nG1 Y30\nG0 Z5\nM5\nM30\n"

# The head of a program in the style of each CAM program, and the tool that it means: name and number.
CAM_PROGRAMS = {
    "fusion": (
        "(T4  D=3.175 CR=0 - ZMIN=-5.3 - flat end mill)\nG90 G94 G17\nG21\nT4 M6\nS9000 M3\n",
        "square 3.175 mm"),
    "vcarve": (
        "( part )\n(Tools used in this file: )\n(1 = End Mill {6 mm})\nG21\nT1 M6\nS9000 M3\n",
        "square 6 mm"),
    "aspire": ("G20\n(V-Bit {90 deg 0.5\"})\nT3 M6\nS9000 M3\n", "V 12.7 mm, 90 degrees"),
    "carbide create": (
        "(TOOL/MILL,3.17, 0.00, 0.00, 0.00)\nG90\nG21\nM6T7\nM3S9000\n",
        "square 3.17 mm"),
    "freecad": (
        "(Exported by FreeCAD)\nG21\n(3mm Endmill001)\nM6 T2\nM3 S9000\n",
        "square 3 mm"),
    "freecad grbl": ("(Exported by FreeCAD)\nG21\n(6mm Endmill)\nM3 S9000\n", "square 6 mm"),
    "estlcam": ("(HSS, 2-Flute Endmill, 2mm)\nG21\nG90\nM3 S9000\n", "square 2 mm"),
    "estlcam with T1": ("(HSS, 2-Flute Endmill, 2mm)\nG21\nG90\nT1 M6\nM3 S9000\n", "square 2 mm"),
    "easel": ("(Tool: 1/8 in Carbide End Mill)\nG20\nM3 S9000\n", "square 3.175 mm"),
    "cambam": ("( T3 : 0.125 )\nG20 G90\nT3 M6\nM3 S9000\n", "square 3.175 mm"),
    "pycam": (
        ";[Tool]\n;shape = CylindricalCutter\n;tool_radius = 1.5\nG21\nT4 M6\nM3 S9000\n",
        "square 3 mm"),
    "coppercam": (
        "( Tool #5 \"0.3mm30degree\" / Diameter 3.175 mm )\nG21\nT5 M06\nM03 S6000\n",
        "V 3.175 mm, 30 degrees"),
    "flatcam": ("(Units: MM)\nG21\n(TOOL DIAMETER: 0.4 mm)\nG90\nM03 S6000\n", "square 0.4 mm"),
    "pcb2gcode": (
        "G94\nG21\nT0\nM5\n(MSG, Change tool bit to cutter diameter 0.8mm)\nM6\nM3 S9000\n",
        "square 0.8 mm"),
    "makera": ("(T4  D=3.175 CR=0 - ZMIN=-5.3 - flat)\nG90\nG21\nM6 T4\nS9000 M3\n", "square 3.175 mm"),
    "meshcam": ("(TOOL #1 0.25 BALL MILL)\nG20\nT1 M6\nM3 S9000\n", None),
    "kiri": ("G21\nM6 T3 ; change tool to 'end 1/4'\nM3 S9000\n", "square 6.35 mm"),
    "inkscape": ("(Change tool to Cylindrical cutter)\nG21\nT1 M6\nM3 S9000\n", None),
    "openbuilds": (
        "; Tool 4: Flat End Mill 3 Flutes, Diam = 3mm, Len = 15.00mm\nG21\nT4 M6\nM3 S9000\n",
        "square 3 mm"),
    "mach3 wizard": ("(Tool Diameter = 0.25)\nG20\nT1 M6\nM3 S9000\n", "square 6.35 mm"),
    "ugs": ("G21\nM6 T1 (Change Tool: Diameter: 1.0000 mm)\nM3 S9000\n", "square 1 mm"),
    "sketchucam": ("(Bit diameter: 1/8\")\nG20\nM3 S9000\n", "square 3.175 mm"),
    "at the tool change": ("G21\nT1 M6 (FREZA D10)\nM3 S9000\n", "square 10 mm"),
    "pcb-gcode": ("(  Tool Size)\n(0.0030  )\nG20\nM3 S9000\n", "square 0.076 mm"),
}


def inch_body(head):
    return BODY if "G20" not in head else re.sub(
        r"([XYZF])(-?\d+)", lambda m: f"{m[1]}{int(m[2]) / 25.4:.4f}", BODY)


@pytest.mark.parametrize("name", CAM_PROGRAMS)
def test_the_tool_of_each_cam_program(kerf, program, name):
    head, tool = CAM_PROGRAMS[name]
    run = kerf("simulate", "--json", program(head + inch_body(head)), "-o", "part.png")
    assert run.status == 0, run.err
    used = [t for t in run.json["tools"] if t["removed_mm3"] > 0]
    assert len(used) == 1
    if tool:
        assert used[0]["name"] == tool and used[0]["source"] == "comment"
        assert "tool_from_remark" in run.codes() or "TOOL/" in head
    else:
        assert used[0]["source"] == "assumed" and "no_tool_shape" in run.codes()


def test_an_assumed_tool_is_a_warning_with_the_option_to_paste(kerf, program, files, folder_bytes):
    part = program("G21 G90\nT7 M6\nM3 S9000\n" + BODY)
    run = kerf("simulate", part, "-o", "part.png")
    assert run.status == 0, run.err
    assert "warning" in run.err and "[1009]" in run.err
    option = re.search(r'--tool (\d+)="([^"]+)"', run.err)
    assert option[1] == "7" and "part.png" in files()
    pasted = kerf("simulate", part, "--tool", f"{option[1]}={option[2]}", "--json")
    assert pasted.json["removed_mm3"] == kerf("simulate", part, "--json").json["removed_mm3"]
    assert "no_tool_shape" not in pasted.codes()


def test_without_a_tool_change_the_option_has_no_number(kerf, program):
    run = kerf("simulate", program("G21 G90\nM3 S9000\n" + BODY))
    assert run.status == 0 and '--tool "square d=3.175"' in run.err


def test_check_shows_an_assumed_tool_in_its_status_and_checks_the_rest(kerf, program):
    crash = "G21 G90\nT7 M6\nM3 S9000\n" + BODY.replace("G0 Z5\nM5", "G0 X10 Y10\nG0 Z5\nM5")
    kinds = [h["kind"] for h in kerf("check", "--json", program(crash)).json["hazards"]]
    assert "unknown_tool" in kinds and "rapid_in_stock" in kinds
    fine = program("G21 G90\nT7 M6\nM3 S9000\n" + BODY)
    run = kerf("check", "--json", fine)
    assert run.status == 3 and [h["kind"] for h in run.json["hazards"]] == ["unknown_tool"]
    assert kerf("check", fine, "--tool", "7=square d=3.175").status == 0


def test_compensation_without_a_diameter(kerf, program):
    side = program(START + "G0 X-10 Y-10 Z5\nG1 Z-1 F100\nG41 G1 X0 Y0\nG1 Y30\nG1 X20\nG40 G1 X40\n"
                   "G0 Z5\nM30\n")
    run = kerf("simulate", "--json", side, "-o", "part.png")
    assert run.status == 0 and "compensation_no_tool" in run.codes()
    assert run.json["tools"][0]["name"] == "square 3.175 mm"
    check = kerf("check", "--json", side)
    assert check.status == 3
    assert {h["kind"] for h in check.json["hazards"]} == {"unknown_tool", "unknown_diameter"}
    assert kerf("post", "--to", "grbl", side, "-o", "out.nc").status == 1
    # An inside corner of 0.8 mm: the usual diameter does not fit.
    tight = program(START + "G0 X-10 Y10 Z5\nG1 Z-1 F100\nG42 G1 X0 Y10\nG1 X10\nG2 X11.6 Y10 R0.8\n"
                    "G1 X30\nG40 G1 X40 Y0\nG0 Z5\nM30\n", "tight.nc")
    run = kerf("simulate", "--json", tight)
    assert run.status == 0, run.out


def test_the_stock_of_comments(kerf, program):
    text = "( Workpiece dimensions: 100 x 50 x 1.6 mm )\nG21 G90\nT102 M6\nM3 S9000\n" + BODY
    stock = kerf("info", "--json", program(text)).json["stock"]
    assert stock["source"] == "program" and stock["block_mm"] == [[0, 0, -1.6], [100, 50, 0]]


# ---- pictures of toolpaths

def count(rows, is_colour):
    return sum(is_colour(*p) for row in rows for p in row)


def reddish(r, g, b):
    return r > g + 60 and r > b + 60


def bluish(r, g, b):
    return b > r + 60


SMALL = ["--view", "top", "--size", "200x150"]
LASER = "; LightBurn\nG21 G90\nM4\nG0 X0 Y0\nG1 X60 S1000 F900\nG1 Y40\nG1 X0\nG1 Y0\nS0\nM5\nM30\n"


def test_a_laser_is_drawn(kerf, program, folder_bytes):
    run = kerf("simulate", "--json", program(LASER), "-o", "laser.png", *SMALL)
    assert run.status == 0, run.err
    assert "path_shown" in run.codes() and "no_tool_shape" not in run.codes()
    _, _, rows = pixels(folder_bytes()["laser.png"])
    assert count(rows, reddish) > 200
    weak_laser = program(LASER.replace("G1 Y40", "G1 Y40 S100"), "weak.nc")
    weak = kerf("simulate", weak_laser, "-o", "weak.png", *SMALL)
    assert weak.status == 0
    dark = lambda r, g, b: reddish(r, g, b) and g < 60
    assert count(pixels(folder_bytes()["weak.png"])[2], dark) < count(rows, dark)
    assert kerf("check", program(LASER)).status == 0


def test_show_path_draws_cuts_and_rapids(kerf, program, folder_bytes):
    part = program("G21 G90\nT102 M6\nM3 S9000\n" + BODY)
    assert kerf("simulate", part, "-o", "path.png", "--show", "path", *SMALL).status == 0
    assert kerf("simulate", part, "-o", "part.png", *SMALL).status == 0
    path, cut = pixels(folder_bytes()["path.png"])[2], pixels(folder_bytes()["part.png"])[2]
    assert 100 < count(path, bluish) < count(cut, bluish)  # lines; the cut surfaces
    assert kerf("simulate", part, "-o", "x.png", "--show", "all").status == 2


def test_a_program_at_z0_and_one_without_cuts_are_drawn(kerf, program, folder_bytes):
    plot = program("G21 G90\nT1 M6\nM3 S9000\n" + BODY.replace("Z-1", "Z0"))
    run = kerf("simulate", "--json", plot, "-o", "plot.png", *SMALL)
    assert run.status == 0 and "path_shown" in run.codes() and run.json["removed_mm3"] == 0
    assert count(pixels(folder_bytes()["plot.png"])[2], bluish) > 100
    shown = kerf("simulate", "--json", plot, "-o", "part.png", "--show", "part", *SMALL)
    assert shown.status == 0 and "path_shown" not in shown.codes()
    text = program('message("hello");\ngoto([1mm,1mm,5mm]);\n', "words.gcmc")
    run = kerf("simulate", "--json", text, "-o", "words.png", *SMALL)
    assert run.status == 0 and "path_shown" in run.codes() and run.json["outputs"] == ["words.png"]
    assert kerf("simulate", text, "-o", "words.stl").status == 1


# ---- manners

def test_lines_of_senders_are_skipped_with_a_note(kerf, program):
    text = "$H\n$X\n$110=500.000 (X-axis maximum rate, mm/min)\nG21 G90\nT102 M6\nM3 S9000\n?\n" + BODY
    run = kerf("check", "--json", program(text))
    assert run.status == 0, run.out
    notes = [d for d in run.json["diagnostics"] if d["name"] == "sender_line"]
    assert [d["origin"]["line"] for d in notes] == [1, 2, 3, 7] and notes[0]["severity"] == "note"


def test_texts_are_in_the_units_of_the_program_or_as_asked(kerf, program):
    inch = program("G20\n(STOCK/BLOCK, 4, 2, 0.75, 0, 0, 0.75)\nG90\nT102 M6\nM3 S9000\n"
                   "G0 X1 Y1 Z0.2\nG1 Z-0.1 F4\nG1 X2\n"
                   "G0 Z0.2\nM30\n")
    for command in ("info", "simulate"):
        assert "4 x 2 x 0.75 in" in kerf(command, inch).out
        assert "101.6 x 50.8 x 19.05 mm" in kerf(command, inch, "--mm").out
    assert "4 in/min" in kerf("info", inch).out and "101.6 mm/min" in kerf("info", "--mm", inch).out
    metric = program("(STOCK/BLOCK, 50.8, 50.8, 12.7, 0, 0, 12.7)\nG21 G90\nT102 M6\nM3 S9000\n" + BODY,
                     "metric.nc")
    assert "50.8 x 50.8 x 12.7 mm" in kerf("simulate", metric).out
    assert "2 x 2 x 0.5 in" in kerf("simulate", "--inch", metric).out
    short = kerf("check", "--inch", metric, "--tool", "102=square d=3 flute=0.5")
    assert " Z-0.0197 in, 0.00" in short.out  # where the shank starts to cut: 0.5 mm deep
    assert kerf("simulate", "--inch", "--mm", metric).status == 2
    assert kerf("info", "--json", "--inch", metric).json == kerf("info", "--json", metric).json


@pytest.mark.parametrize("stock", ["4x2x3/4in", "4 x 2 x 3/4 in", "4in 2in 0.75in", "4x2x.75\"",
                                   "101.6x50.8x19.05", "4x2x 3/4in"])
def test_one_grammar_of_lengths(kerf, program, stock):
    part = program("G21 G90\nM3 S9000\n" + BODY)
    run = kerf("simulate", "--json", part, "--stock", stock, "--tool", "square d=1-1/4in",
               "--resolution", "1/64in")
    assert run.status == 0, run.err
    assert run.json["stock"]["block_mm"][1][:2] == pytest.approx([101.6, 50.8])
    assert run.json["stock"]["block_mm"][0][2] == pytest.approx(-19.05)
    assert run.json["tools"][0]["name"] == "square 31.75 mm"
    assert run.json["resolution_mm"] == pytest.approx(25.4 / 64)


def test_tools_takes_libraries_of_other_programs(kerf, program):
    table = program("T7 P7 D4.000 Z0 ;end mill\n", "tool.tbl")
    part = program("G21 G90\nT7 M6\nM3 S9000\n" + BODY)
    run = kerf("simulate", "--json", part, "--tools", table)
    assert run.json["tools"][0]["name"] == "square 4 mm" and run.json["tools"][0]["source"] == "tool file"
    own = program('unit = "mm"\n[[tool]]\nnumber = 7\nshape = "square"\ndiameter = 5\n', "own.toml")
    assert kerf("simulate", "--json", part, "--tools", own).json["tools"][0]["name"] == "square 5 mm"
    broken = program("neither this nor that", "broken.toml")
    assert kerf("simulate", part, "--tools", broken).status == 1


@pytest.mark.parametrize("words,name", [
    ("D0.125", "square 3.175 mm"), ("D0.5", "square 0.5 mm"), ("D0.3", "square 0.3 mm"),
    ("D3.175", "square 3.175 mm")])
def test_a_table_of_a_machine_in_inches_beside_a_program_in_mm(kerf, program, words, name):
    program(f"T1 P1 Z0 {words}\nT2 P2 Z0 D0.25\n" if words != "D0.5" else "T1 P1 Z0 D0.5\n", "tool.tbl")
    part = program("G21 G90\nT1 M6\nM3 S9000\n" + BODY)
    assert kerf("info", "--json", part).json["tools"][0]["name"] == name


@pytest.mark.parametrize("shape", [
    "V d=20 angle=60 flute=17.320508", "drill d=3 angle=90", "ball d=6", "bull nose d=8 r=1.5",
    "chamfer d=10 angle=90 tip_diameter=0"])
def test_the_comments_of_posted_programs_describe_their_tools(kerf, program, tmp_path, shape):
    """A program of `post` removes the same material when it is read without the tool."""
    part = program("G21 G90\nT2 M6\nM3 S9000\n" + BODY)
    posted = tmp_path / "posted.nc"
    assert kerf("post", part, "--to", "grbl", "--tool", f"2 = {shape}", "-o", posted).status == 0
    stock = ["--stock", "-20,-20,-8 to 60,60,0", "--resolution", "0.1"]
    given = kerf("simulate", "--json", posted, "--tool", f"2 = {shape}", *stock).json["removed_mm3"]
    read = kerf("simulate", "--json", posted, *stock)
    assert read.json["removed_mm3"] == pytest.approx(given, rel=1e-3) and given > 0


@pytest.mark.parametrize("shape", [
    "T-slot d=20 thickness=5 neck_diameter=8 flute=10", "dovetail d=12 flute=8 angle=14",
    "corner rounding tip_diameter=4 diameter=12 radius=4", "flat groove d=6 flute=5 tip_diameter=2"])
def test_comments_of_other_shapes_describe_them(kerf, program, tmp_path, shape):
    part = program("G21 G90\nT2 M6\nM3 S9000\n" + BODY)
    posted = tmp_path / "posted.nc"
    done = kerf("post", part, "--to", "grbl", "--tool", f"2 = {shape}", "-o", posted)
    assert done.status == 0, done.err
    tool = kerf("info", "--json", posted).json["tools"][0]
    assert tool["source"] == "comment" and tool["name"].startswith(re.match(r"[A-Za-z -]+(?= )", shape)[0])


def test_a_drill_has_a_usual_point(kerf):
    given = kerf("tools", "show", "--json", "drill d=3 angle=118")
    assert given.status == 0 and kerf("tools", "show", "--json", "drill d=3").json == given.json


def test_a_file_that_only_defines_a_subroutine(kerf, program):
    sub = program("o<pocket> sub\nG1 X#1 F100\no<pocket> endsub\n", "pocket.ngc")
    run = kerf("simulate", "--json", sub)
    assert run.status == 1 and run.codes() == ["subroutine_only"]
    assert "pocket" in run.json["diagnostics"][0]["message"]
    assert "o<pocket> call" in run.json["diagnostics"][0]["hint"]


@pytest.mark.parametrize("resolution", ["3", "1"])
def test_coarse_columns_do_not_make_coarse_pictures(kerf, program, tmp_path, resolution):
    """Grooves 1 mm wide at columns of 3 mm: the picture shows them as at a fine resolution."""
    grooves = "".join(f"G0 X{x} Y-5\nG1 Z-2 F100\nG1 Y35\nG0 Z5\n" for x in range(4, 40, 8))
    part = program("G21 G90\nM3 S9000\nG0 Z5\n" + grooves + "M2\n")
    seen = []
    for pitch in (resolution, "0.05"):
        run = kerf("simulate", part, "--tool", "square d=1 flute=6", "--stock", "0,0,-6 to 40,30,0",
                   "--show", "part", "--view", "top", "--size", "400x300", "--resolution", pitch,
                   "-o", f"at_{pitch}.png")
        assert run.status == 0, run.err
        seen.append(pixels((tmp_path / f"at_{pitch}.png").read_bytes())[2])
    pairs = [(p, q) for one, other in zip(*seen) for p, q in zip(one, other)]
    differing = sum(max(abs(a - b) for a, b in zip(p, q)) > 40 for p, q in pairs)
    assert differing < 0.02 * 400 * 300


@pytest.mark.parametrize("resolution", ["3", "1"])
def test_coarse_columns_do_not_make_coarse_meshes(kerf, program, tmp_path, resolution):
    """Grooves 1 mm wide and 2 mm deep along the whole block; the volume by hand."""
    grooves = "".join(f"G0 X{x} Y-5\nG1 Z-2 F100\nG1 Y35\nG0 Z5\n" for x in range(4, 40, 8))
    part = program("G21 G90\nM3 S9000\nG0 Z5\n" + grooves + "M2\n")
    run = kerf("simulate", part, "--tool", "square d=1 flute=6", "--stock", "0,0,-6 to 40,30,0",
               "--resolution", resolution, "-o", "part.stl")
    assert run.status == 0, run.err
    data = (tmp_path / "part.stl").read_bytes()
    triangles = struct.unpack_from("<I", data, 80)[0]
    volume = 0.0
    for k in range(triangles):
        a, b, c = (struct.unpack_from("<3f", data, 84 + 50 * k + 12 * n) for n in (1, 2, 3))
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    assert volume == pytest.approx(40 * 30 * 6 - 5 * 1 * 2 * 30, rel=1e-4)


def test_gcmc_refuses_a_second_program(kerf, program):
    a, b = program("goto([1mm]);\n", "a.gcmc"), program("goto([2mm]);\n", "b.gcmc")
    run = kerf("gcmc", a, b)
    assert run.status == 1 and "b.gcmc" in run.err and run.out == ""


@pytest.mark.parametrize("arguments", [["check", "--json", "--bogus"], ["simulate", "--json"],
                                       ["simulate", "--json", "x.nc", "--view", "nowhere"],
                                       ["bogus", "--json"], ["check", "x.nc", "--json", "--stock", "huge"]])
def test_wrong_usage_is_json(kerf, arguments):
    run = kerf(*arguments)
    assert run.status == 2
    assert run.json["diagnostics"][0]["severity"] == "error" and run.json["diagnostics"][0]["message"]


def test_definitions_for_gcmc_in_every_command(kerf, program, tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "deep.inc.gcmc").write_text("low = -2mm;\n")
    part = program('include("deep.inc.gcmc");\nfeedrate(100mm);\ngoto([0mm,0mm,5mm]);\nmove([-,-,low]);\n'
                   "move([wide]);\ngoto([-,-,5mm]);\n", "part.gcmc")
    for command in (["simulate"], ["check"], ["info"], ["steps"], ["post", "--to", "grbl", "-o", "out.nc"]):
        run = kerf(*command, part, "-D", "wide=30mm", "-I", tmp_path / "lib", "--tool", "square d=3")
        assert run.status in (0, 3), f"{command}: {run.err}"
        assert "undefined" not in run.err


def test_a_program_with_a_byte_order_mark_and_no_ending(kerf, program):
    marked = program(b"\xef\xbb\xbf" + (START + BODY).encode(), "part")
    run = kerf("simulate", "--json", marked)
    assert run.status == 0, run.err


def test_cuts_too_far_apart_for_a_stock_are_drawn(kerf, program):
    far = program("G21 G90\nT102 M6\nM3 S9000\nG0 X0 Y0\nG1 Z-1 F100\nG1 X300000\nG0 Z5\n")
    run = kerf("simulate", "--json", far, "-o", "far.png", *SMALL)
    assert run.status == 0 and {"path_shown", "stock_assumed"} <= set(run.codes())
    assert run.json["outputs"] == ["far.png"]
    assert kerf("simulate", far).status == 1

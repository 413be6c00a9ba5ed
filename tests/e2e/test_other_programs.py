"""Files of other programs: tool bits and libraries, tables beside a program, meshes in all forms of zip,
programs in other languages, text after the end; and threads for controllers with and without them."""
import json
import os
import stat
import struct
import zlib
from pathlib import Path

import pytest

HEAD = "G21 G90\nT1 M6\nS1000 M3\n"
BODY = "G0 X10 Y10 Z5\nG1 Z-1 F100\nX30\nG0 Z5\nM2\n"


def tool_list(kerf, path):
    """The tools of a converted library, by number: key = value."""
    run = kerf("tools", "import", path)
    assert run.status == 0, run.err
    tools = []
    for line in run.out.splitlines():
        if line == "[[tool]]":
            tools.append({})
        elif " = " in line and tools:
            key, value = line.split(" = ", 1)
            tools[-1][key] = json.loads(value)
    return {t["number"]: t for t in tools}


# ---- FreeCAD

def bit(name, shape, **parameters):
    return json.dumps({"version": 2, "name": name, "shape": shape, "parameter": parameters, "attribute": {}})


def test_lengths_with_a_decimal_comma(kerf, program):
    """As FreeCAD writes them with German or Russian settings."""
    text = bit("12,65mm Endmill", "endmill.fcstd", CuttingEdgeHeight="30,5000 mm", Diameter="12,65 mm",
               ShankDiameter="3,0000 mm")
    tool = tool_list(kerf, program(text, "bit.fctb"))[1]
    assert (tool["diameter"], tool["flute"], tool["shank_diameter"]) == (12.65, 30.5, 3)


def test_shapes_of_freecad(kerf, program):
    """The angle of a dovetail is between its bottom and its side. A thread mill has a flat crest of 0.1 mm
    and flanks of 60 degrees from 6 to 4.1 mm."""
    dovetail = bit("dove", "dovetail.fcstd", CuttingEdgeAngle="60.00 °", CuttingEdgeHeight="9.0000 mm",
                   Diameter="20.0000 mm", NeckDiameter="8.0000 mm", NeckHeight="5.0000 mm",
                   ShankDiameter="8.0000 mm")
    tool = tool_list(kerf, program(dovetail, "dove.fctb"))[1]
    assert tool["shape"] == "dovetail" and tool["angle"] == pytest.approx(30) and tool["flute"] == 9
    assert tool["neck_diameter"] == 8 and tool["neck_length"] == 5
    torus = bit("torus", "torus.fcstd", CuttingEdgeHeight="40 mm", Diameter="6 mm", TorusRadius="1.5 mm",
                ShankDiameter="3 mm")
    tool = tool_list(kerf, program(torus, "torus.fctb"))[1]
    assert tool["shape"] == "bull nose" and tool["corner_radius"] == 1.5
    thread = bit("thread", "thread-mill.fcstd", Crest="0.10 mm", Diameter="6.00 mm", NeckDiameter="4.10 mm",
                 NeckLength="20.00 mm", ShankDiameter="6.00 mm", cuttingAngle="60.00 °")
    tool = tool_list(kerf, program(thread, "thread.fctb"))[1]
    assert tool["shape"] == "thread mill"
    assert (tool["minor_diameter"], tool["major_diameter"]) == (4.1, 6)
    assert tool["cut_height"] == pytest.approx(0.1 + (6 - 4.1) * 3 ** -0.5, abs=1e-4)


def test_the_name_of_a_skipped_bit_is_given(kerf, program):
    run = kerf("tools", "import", program(bit("my saw", "slittingsaw.fcstd", Diameter="60 mm"), "saw.fctb"))
    assert '"my saw" is skipped' in run.err


def test_a_freecad_library(kerf, tmp_path):
    """Default.fctl names bits in the folder Bit beside its own."""
    (tmp_path / "Library").mkdir()
    (tmp_path / "Bit").mkdir()
    (tmp_path / "Bit" / "5mm_Endmill.fctb").write_text(
        bit("5mm Endmill", "endmill.fcstd", Diameter="5 mm", CuttingEdgeHeight="30 mm"))
    library = tmp_path / "Library" / "Default.fctl"
    library.write_text(json.dumps({"label": "Default", "version": 1, "tools": [
        {"nr": 7, "path": "5mm_Endmill.fctb"}, {"nr": 8, "path": "gone.fctb"}]}))
    run = kerf("tools", "import", library)
    assert run.status == 0 and "number = 7" in run.out and "diameter = 5" in run.out
    assert '"gone.fctb" is skipped' in run.err
    part = tmp_path / "part.nc"
    part.write_text("G21 G90\nT7 M6\nS1000 M3\n" + BODY)
    tools = kerf("info", "--json", "--tools", library, part).json["tools"]
    assert tools[0]["name"] == "square 5 mm" and tools[0]["source"] == "tool file"


# ---- LinuxCNC's tool table

TABLE = ("T1 P1 D6 ;1/4 end mill\nT2 P2 D3 Z1 ;PROBE\nT3 P3 D6.35 ;1/4 ball mill\nT4 P4 D12.7 ;90 deg V-bit\n"
         "T5 P5 D3 ;drill\n")


def test_the_comments_of_a_tool_table_name_shapes(kerf, program):
    path = program(TABLE, "tool.tbl")
    tools = tool_list(kerf, path)
    assert {n: t["shape"] for n, t in tools.items()} == {1: "square", 3: "ball", 4: "V", 5: "drill"}
    assert tools[4]["angle"] == 90 and tools[5]["angle"] == 118
    assert "T2" in kerf("tools", "import", path).err


def test_a_tool_table_beside_a_program(kerf, program):
    program(TABLE, "tool.tbl")
    tools = kerf("info", "--json", program("G21 G90\nT3 M6\nS1000 M3\n" + BODY)).json["tools"]
    assert tools[0]["name"] == "ball 6.35 mm" and tools[0]["source"] == "tool file"
    # A comment and an option have precedence.
    described = program("(T3 D=4. CR=0. - flat end mill)\nG21 G90\nT3 M6\nS1000 M3\n" + BODY)
    tools = kerf("info", "--json", described).json["tools"]
    assert tools[0]["name"] == "square 4 mm" and tools[0]["source"] == "comment"
    tools = kerf("info", "--json", "--tool", "3=square d=2", described).json["tools"]
    assert tools[0]["name"] == "square 2 mm"
    # Its diameters are those of the program's unit, and those of its cutter compensation.
    inch = program("G20 G90\nT1 M6\nS1000 M3\n" + BODY)
    assert kerf("info", "--json", inch).json["tools"][0]["name"] == "square 152.4 mm"
    side = program(HEAD + "G0 X-10 Y-10 Z5\nG1 Z-1 F100\nG41 X0 Y0\nY30\nG40 X-10\nG0 Z5\nM2\n")
    run = kerf("steps", side)
    assert run.status == 0, run.err
    ends = [json.loads(line).get("to") for line in run.out.splitlines()]
    assert [-3.0, 30.0, -1.0] in ends


def test_a_tool_table_is_not_for_grbl(kerf, program):
    program(TABLE, "tool.tbl")
    run = kerf("info", "--json", "--dialect", "grbl", program(HEAD + BODY))
    assert run.json["tools"][0]["source"] != "tool file"


# ---- meshes

MODEL = """<?xml version="1.0"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/>
<vertex x="0" y="10" z="0"/><vertex x="0" y="0" z="10"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="0" v2="3" v3="2"/></triangles>
</mesh></object></resources><build><item objectid="1"/></build></model>"""
RELATIONS = """<?xml version="1.0"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship
Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""


def archive(descriptor, end64, packed=True, break_checksum=False):
    """A zip whose sizes and offsets are in zip64 fields; with `descriptor` the sizes follow the data."""
    out, directory, count = b"", b"", 0
    for name, text in (("_rels/.rels", RELATIONS), ("3D/3dmodel.model", MODEL)):
        data = text.encode()
        crc = zlib.crc32(data) ^ (1 if break_checksum else 0)
        deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
        body = deflate.compress(data) + deflate.flush() if packed else data
        name, method, at = name.encode(), 8 if packed else 0, len(out)
        flags, here = (8, (0, 0, 0)) if descriptor else (0, (crc, len(data), len(body)))
        out += struct.pack("<IHHHHHIIIHH", 0x04034b50, 45, flags, method, 0, 33, here[0], 0xffffffff,
                           0xffffffff, len(name), 20)
        out += name + struct.pack("<HHQQ", 1, 16, here[1], here[2]) + body
        if descriptor:
            out += struct.pack("<IIQQ", 0x08074b50, crc, len(body), len(data))
        directory += struct.pack("<IHHHHHHIIIHHHHHII", 0x02014b50, 45, 45, flags, method, 0, 33, crc,
                                 0xffffffff, 0xffffffff, len(name), 28, 0, 0, 0, 0, 0xffffffff)
        directory += name + struct.pack("<HHQQQ", 1, 24, len(data), len(body), at)
        count += 1
    start = len(out)
    out += directory
    if end64:
        at = len(out)
        out += struct.pack("<IQHHIIQQQQ", 0x06064b50, 44, 45, 45, 0, 0, count, count, len(directory), start)
        out += struct.pack("<IIQI", 0x07064b50, 0, at, 1)
        return out + struct.pack("<IHHHHIIH", 0x06054b50, 0, 0, 0xffff, 0xffff, 0xffffffff, 0xffffffff, 0)
    return out + struct.pack("<IHHHHIIH", 0x06054b50, 0, 0, count, count, len(directory), start, 0)


@pytest.mark.parametrize("form", [(d, e, p) for d in (0, 1) for e in (0, 1) for p in (0, 1)])
def test_3mf_in_every_form_of_zip(kerf, program, form):
    mesh = program(archive(*form), "mesh.3mf")
    run = kerf("simulate", "--json", "--stock-mesh", mesh, "--tool", "square d=3", program(HEAD + BODY))
    assert run.status == 0, run.out
    assert run.json["stock_mm3"] == pytest.approx(1000 / 6, rel=1e-3)


def test_a_damaged_3mf_is_refused(kerf, program):
    whole = archive(True, True)
    packed = whole.index(b"3D/3dmodel.model") + 16 + 20 + 40  # within the deflated data
    for name, data in {"crc.3mf": archive(False, False, True, True), "cut.3mf": whole[:-30],
                       "body.3mf": whole[:packed] + b"\xff" * 8 + whole[packed + 8:]}.items():
        run = kerf("simulate", "--json", "--stock-mesh", program(data, name), program(HEAD + BODY))
        assert run.status == 1 and "mesh_file" in run.codes(), name


def glb(pad):
    positions = struct.pack("<12f", 0, 0, 0, .01, 0, 0, 0, .01, 0, 0, 0, .01)
    triangles = struct.pack("<12H", 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2)
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                           {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
             "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                             {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
             "buffers": [{"byteLength": 72}]}
    text = json.dumps(scene).encode()
    text += b" " * (1 - len(text) % 4) if pad is None else b" " * (-len(text) % 4)
    while pad is None and len(text) % 4 != 1:
        text += b" "
    data = positions + triangles
    head = struct.pack("<4sII", b"glTF", 2, 12 + 16 + len(text) + len(data))
    chunks = [(text, b"JSON"), (data, b"BIN\0")]
    return head + b"".join(struct.pack("<I4s", len(body), kind) + body for body, kind in chunks)


@pytest.mark.parametrize("pad", [None, True])
def test_glb_with_and_without_padding(kerf, program, pad):
    mesh = program(glb(pad), "mesh.glb")
    run = kerf("simulate", "--json", "--stock-mesh", mesh, "--tool", "square d=3", program(HEAD + BODY))
    assert run.status == 0, run.out
    assert run.json["stock_mm3"] == pytest.approx(1000 / 6, rel=1e-3)


# ---- programs in other languages, and text after the end

DATA = Path(__file__).parent.parent / "data" / "gcode" / "languages"


@pytest.mark.parametrize("text, control", [
    ((DATA / "heidenhain.txt").read_text(), "Heidenhain"),
    ('G17 G90 G71\nWORKPIECE(,"",,"BOX",112,0,-51,,50,25,-50,-25)\nG0 X0 Y0\nM30\n', "Siemens"),
    ("G17 G90\nG0 X0 Y0 Z5\nG2 X10 Y0 CR=5 F100\nM30\n", "Siemens"),
    ("N10 G90\nN20 SUPA G0 Z0\nN30 M30\n", "Siemens"),
    ("G90\nMCALL CYCLE81(5,0,1,-5,)\nX5 Y5\nM30\n", "Siemens"),
    ("%_N_TEST_MPF\n;$PATH=/_N_WKS_DIR\nG54 G17\nT1 D1\nG0 X10 Y10\n", "Siemens"),
    (";$PATH=/_N_WKS_DIR\nG54 G17\nG0 X10 Y10\n", "Siemens"),
    ("R1=10\nG0 X0 Y0\nG1 Z-1 F100\nM30\n", "Siemens"),
    ("G0 X=R1 Y0\nM30\n", "Siemens"), ("G0 X=10 Y5\nM30\n", "Siemens"),
    ("G90\nX=IC(10) F100\nM30\n", "Siemens"),
    ("DEF REAL A\nA=3\nG0 X0\n", "Siemens"), ("G54\nTRANS X10\nG0 X0\nM30\n", "Siemens"),
    ("G54\nATRANS Y10\nG0 X0\nM30\n", "Siemens"),
    ("N1 G54\nFOR R1=1 TO 5\nG1 X1\nENDFOR\nM30\n", "Siemens"),
    ("N1 G54\nL1:\nG0 X1\nREPEAT L1 P=3\nM30\n", "Siemens"),
    ('T="MILL"\nM6\nG0 X0\nM30\n', "Siemens"),
    ("5 L X+10 Y+3 R0 FMAX\n6 L Z-5 F100\n", "Heidenhain"), ("5 L X+10 Y+3 R0 F200\n", "Heidenhain"),
    ("%TEST G71 *\nN10 G30 G17 X+0 Y+0 Z-20*\nN40 G00 G40 G90 Z+100*\nN99 %TEST G71 *\n", "Heidenhain"),
    ("%\nO1\n(WIRE EDM)\nG92 X0 Y0\nG41 D1\nG1 X10\nM02\n%\n", "wire machine"),
    ("G96 S200 M3\nT1 M6\nG0 X50 Z2\nG1 Z-20 F0.2\nM30\n", "lathe"),
    ("G50 S2500\nG97 S1800 M3\nG0 X50 Z2\nG1 Z-20 F0.2\nX60\nM30\n", "lathe"),
    ("T1\nG0 X50 Z2\nG71 U2. R1.\nG1 Z-20 F0.2\nM30\n", "lathe")])
@pytest.mark.parametrize("name", ["a.nc", "a.mpf"])
def test_the_language_of_another_control_is_named(kerf, program, text, control, name):
    path = program(text, name)
    run = kerf("info", "--json", path)
    assert run.status == 1 and run.codes() == ["other_language"]
    assert control in run.json["diagnostics"][0]["message"]
    for command in (["info"], ["check"], ["steps"], ["simulate", "-o", "a.png"],
                    ["post", "--to", "grbl", "-o", "b.nc"]):
        run = kerf(*command, path)
        assert run.status == 1 and run.err.count("error") == 1 and control in run.err, command
        assert run.out == "" and len(run.err.splitlines()) == 2, command  # the error and its hint


@pytest.mark.parametrize("text, evidence", [
    ("1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n3 L X+10 FMAX\n", "BLK FORM"),
    ("G54\nTrans  X10\nG0 X0\nM30\n", "Trans  X"),
    ("G90\nMCALL CYCLE81(5,0,1,-5,)\nX5 Y5\nM30\n", "MCALL"), ("G0 X = R1 Y0\nM30\n", "X =")])
def test_the_evidence_of_another_control_is_quoted_as_it_is_written(kerf, program, text, evidence):
    assert f"({evidence})" in kerf("info", "--json", program(text)).json["diagnostics"][0]["message"]


@pytest.mark.parametrize("line", ["#<x>=5", "#1=5", "G0 X#1", "o1 repeat [2]\nG0 X1\no1 endrepeat",
                                  "(X=5 FMAX R1=2)", "G50", "G96 S200\nG0 Y1", "G71.1", "; TRANS X1",
                                  "(MSG, R1=5)"])
def test_words_of_mills_name_no_other_control(kerf, program, line):
    assert "other_language" not in kerf("info", "--json", program(HEAD + line + "\n" + BODY)).codes()


TORCH = """({header})
G21 G90
F2000
{probe}
G92 Z0
G0 Z4
G0 X40 Y60
M3{speed}
G4 P0.3
G1 Z1.5 F1500
G1 X90 F2500
M5
G0 Z25
M30
"""


@pytest.mark.parametrize("header", ["Post processor: Mach3 plasma.scpost", "SheetCAM plasma TNG",
                                    "Torch: FineCut 40 A"])
@pytest.mark.parametrize("probe", ["G31 Z-100 F500", "G28.1 Z2.00"])
@pytest.mark.parametrize("speed", ["", " S1000"])
def test_a_torch_is_a_beam_and_its_touch_off_a_probe(kerf, program, header, probe, speed):
    path = program(TORCH.format(header=header, probe=probe, speed=speed))
    run = kerf("info", "--json", path)
    assert run.status == 0, run.out
    notes = [d["message"] for d in run.json["diagnostics"] if d["name"] == "dialect_guessed"]
    assert len(notes) == 1 and "laser" in notes[0]
    steps = [json.loads(line) for line in kerf("steps", path).out.splitlines()[1:]]
    assert [s["step"] for s in steps].count("laser") == 2, steps
    assert run.json["motion"]["cut_mm"] >= 50 + 2.5 and run.json["time_s"]["total"] > 1
    assert kerf("check", path).status == 0


def test_a_mill_that_cuts_a_part_of_a_torch_is_a_mill(kerf, program):
    text = "(torch holder)\n" + HEAD + BODY
    assert "dialect_guessed" not in kerf("info", "--json", program(text)).codes()


def test_words_of_other_controls_in_comments_are_comments(kerf, program):
    text = "(WORKPIECE(\n(CYCLE81( and CR=5)\n; TOOL CALL\n#<cr>=5\n" + HEAD + BODY
    assert "other_language" not in kerf("info", "--json", program(text)).codes()


@pytest.mark.parametrize("end", ["M30\n", "M30\n%\n"])
@pytest.mark.parametrize("tail", ["Some text: after [garbage 1.2.3.4 G1 X\nand {more}\n",
                                  "(unclosed\nX 1.2.3\n",
                                  "O100 foo\n#1=[\n"])
def test_text_after_the_end_need_not_be_gcode(kerf, program, end, tail):
    text = ("%\n" if "%" in end else "") + HEAD + BODY.replace("M2\n", end) + tail
    run = kerf("info", "--json", program(text))
    assert run.status == 0, run.out
    after = [d["severity"] for d in run.json["diagnostics"] if d["name"] == "text_after_end"]
    assert after == ([] if tail[0] == "O" else ["warning"])  # a subroutine may follow the end
    if tail[0] != "O":  # on Fanuc's controls subprograms follow the end
        assert kerf("info", program(text), "--dialect", "fanuc").status == 0


def test_an_offset_of_0_along_the_third_axis_is_silent(kerf, program):
    """FreeCAD writes K0.000 with every arc."""
    arc = HEAD + "G0 X0 Y0 Z5\nG2 X10 Y0 I5 J0 K{} F100\nM2\n"
    assert "word_unused" not in kerf("info", "--json", program(arc.format("0.000"))).codes()
    assert "word_unused" in kerf("info", "--json", program(arc.format("1.000"))).codes()


# ---- threads

def motions(kerf, path, post, *options):
    run = kerf("post", "--json", "--to", post, path, "-o", "out.nc", *options)
    if run.status:
        return run.codes()
    lines = (path.parent / "out.nc").read_text().splitlines()
    return [line for line in lines if line[:1] != "(" and not line.startswith("G21")]


def test_a_tapping_cycle_is_written_as_one(kerf, program):
    text = HEAD.replace("S1000", "S500") + "G0 X10 Y10 Z5\nG84 X10 Y10 Z-8 R2 F625\nX20\nG80\nG0 Z5\nM2\n"
    lines = motions(kerf, program(text), "linuxcnc")
    assert lines[2:] == ["G0 X10 Y10 Z5", "X10", "Z2", "G98 G17 G84 Z-8 R2 F625", "G80", "G0 X20",
                         "G98 G84 Z-8 R2", "G80", "G0 Z5", "M5", "M2"]
    left = text.replace("M3", "M4").replace("G84", "G74")
    assert "G98 G17 G74 Z-8 R2 F625" in motions(kerf, program(left), "linuxcnc")
    run = kerf("post", "--json", "--to", "grbl", program(text), "-o", "out.nc")
    assert run.status == 0 and run.codes().count("post_tap") == 1


def test_threads_are_written_or_refused(kerf, program):
    thread = HEAD + "G0 X10 Y10 Z5\nG33 Z-8 K1.25\nG0 Z5\nM2\n"
    assert "G33 Z-8 K1.25" in motions(kerf, program(thread), "linuxcnc")
    assert motions(kerf, program(thread), "grbl") == ["post_cannot"]
    rigid = HEAD + "G0 X10 Y10 Z5\nG33.1 Z-8 K1.25\nG0 X20\nM2\n"
    lines = motions(kerf, program(rigid), "linuxcnc")
    at = lines.index("G33.1 Z-8 K1.25")
    assert lines[at + 1:] == ["G0 X20", "M5", "M2"]
    assert set(motions(kerf, program(rigid), "mach3")) == {"post_cannot"}
    inch = motions(kerf, program(thread.replace("K1.25", "K1.27")), "linuxcnc", "--inch")
    assert any(line.startswith("G33 Z-0.31496 K0.05") for line in inch)


def test_steps_show_what_follows_the_spindle(kerf, program):
    thread = HEAD + "G0 X10 Y10 Z5\nG33 Z-8 K1.25\nG0 Z5\nM2\n"
    steps = [json.loads(line) for line in kerf("steps", program(thread)).out.splitlines()[1:]]
    locked = [s for s in steps if "spindle_lock" in s]
    assert [(s["spindle_lock"], s["per_turn"], s["feed"]) for s in locked] == [("thread", 1.25, 1250)]


# ---- outputs

def test_a_derived_name_does_not_replace_the_input(kerf, program):
    text = HEAD + BODY.replace("M2\n", "T2 M6\nS900 M3\n" + BODY)
    part = program(text, "part-T1.nc")
    run = kerf("post", "--json", "--to", "grbl", "--tool-change", "files", part, "-o", "part.nc")
    assert run.status != 0 and "output_is_input" in run.codes()
    assert part.read_text() == text


def test_putting_the_last_tool_away_makes_no_file(kerf, program, files):
    """T0 M6 at the end: no motion follows, so that no file is needed for tool 0."""
    text = HEAD + BODY.replace("M2\n", "M5\nT2 M6\nS900 M3\n" + BODY.replace("M2\n", "M5\nT0 M6\nM2\n"))
    run = kerf("post", "-q", "--to", "grbl", "--tool-change", "files", program(text), "-o", "out.nc")
    assert run.status == 0, run.err
    assert [name for name in files() if name.startswith("out")] == ["out-T1.nc", "out-T2.nc"]


def test_a_write_protected_file_is_not_replaced(kerf, program):
    target = program("keep\n", "out.nc")
    target.chmod(0o444)
    run = kerf("post", "--json", "--to", "grbl", program(HEAD + BODY), "-o", target)
    assert run.status == 1 and "file_unwritable" in run.codes()
    assert target.read_text() == "keep\n"


def test_the_permissions_of_a_replaced_file_are_kept(kerf, program):
    target = program("old\n", "out.nc")
    for mode in (0o600, 0o640, 0o755):
        target.chmod(mode)
        assert kerf("post", "-q", "--to", "grbl", program(HEAD + BODY), "-o", target).status == 0
        assert stat.S_IMODE(os.stat(target).st_mode) == mode


# ---- options

def test_options_before_the_command(kerf):
    run = kerf("--json", "simulate")
    assert run.status == 2 and "belongs after the command: kerf simulate --json" in run.err + run.out


def test_a_tool_option_with_a_word_for_its_number(kerf, program):
    run = kerf("info", "--tool", "x=square d=3", program(HEAD + BODY))
    assert run.status == 2 and '"x" is neither a tool number nor the name of a shape' in run.err


TURNING = ("G21 G18\nG96 S200 M3\nT0101\nG0 X50 Z5\nG71 U2 R1\nG71 P10 Q20 U0.5 W0.1 F0.2\n"
           "N10 G0 X20\nG1 Z-20\nN20 X50\nM30\n")
WIRE = "G92 X0 Y0\nG1 X10 Y10 U0.1 V0.1\nX20 U0.1 V0.2\nX30 U0.2 V0.2\nM2\n"


@pytest.mark.parametrize("text, named", [
    (TURNING, "a lathe (G71"), (TURNING.replace("G71", "(G71)"), "a lathe (T0101)"),
    (WIRE, "a wire machine (U and V)")])
@pytest.mark.parametrize("command", ["check", "simulate", "info", "steps", "post"])
def test_other_processes_are_one_line(kerf, program, command, text, named):
    to = ("--to", "grbl") if command == "post" else ()
    run = kerf(command, *to, program(text))
    assert run.status == 1 and named in run.err
    assert run.err.count("error") == 1 and "hazard" not in run.err


@pytest.mark.parametrize("text", [
    TURNING.replace("T0101", "T1 M6").replace("G71", "(G71)").replace("G96", "G97"),  # tools are changed
    TURNING.replace("G0 X50 Z5", "G0 X50 Y1 Z5"),                      # Y moves
    "G21 G90\nT0102\nG0 X1 Z5\nG1 Z-1 F100\nX5\nM2\n",             # no pair of numbers
    "G21 G90\nG0 X1 Y1 Z1\nG1 X2 U1 V1 F100\nX3 U1 V1\nX4 U1 V1\nM2\n"])
def test_mills_with_such_words_are_read(kerf, program, text):
    assert "other_language" not in kerf("info", "--json", program(text)).codes()


VECTRIC = """( sign1 )
( for Mach2/3 from Vectric )
(1 = End Mill {6 mm})
N110G00G21G17G90G40G49G80
N120G71G91.1
N130T1M06
N150G00G43Z20.000H1
N160S16000M03
N200X0.000Y0.000F1000.0
N210G00X97.000Y50.000Z6.000
N220G1Z-6.000F500.0
N230G3X103.000Y50.000I3.000J0.000F1000.0
N250G00Z20.000
N270M30
"""
SAFETY_LINE = ("%\nO0001\nG00 G17 G40 G49 G80 G90\nG21\nT1 M6\nS1000 M3\nG43 H1 Z50.\nX0. Y0.\n"
               "G1 Z-1. F100.\nG0 Z9.\nM30\n%\n")


def test_mach3_has_units_by_g70_and_g71(kerf, tmp_path):
    """G70 and G71 are G20 and G21 on Mach3 ("Using Mach3Mill", chapter 10); VCarve's posts write both."""
    (tmp_path / "part.nc").write_text(VECTRIC)
    run = kerf("steps", "part.nc")
    assert run.status == 0 and "warning" not in run.err and "error" not in run.err, run.err
    last = [json.loads(row) for row in run.out.splitlines()][1:]
    assert [103.0, 50.0, -6.0] in [s.get("to") for s in last]
    (tmp_path / "part.nc").write_text(VECTRIC.replace("G71", "G70"))
    assert kerf("info", "--json", "part.nc").json["motion"]["cut_bounds_mm"][0][2] == pytest.approx(-6 * 25.4)


def test_the_only_tool_of_a_header(kerf, tmp_path):
    """Programs without tool numbers, as from Estlcam, list the tool that they need."""
    (tmp_path / "part.nc").write_text("(Required tools:)\n(End mill 3mm)\nG21 G90\nM3 S9000\nG0 X0 Y0 Z5\n"
                                      "G1 Z-1 F100\nX20\nG0 Z5\nM2\n")
    run = kerf("check", "part.nc")
    assert run.status == 0 and "square, diameter 3 mm" in run.err


def test_a_program_number_before_all_words_is_that_of_fanuc(kerf, tmp_path):
    """The usual safety line has G0 and G80 of two groups (0i operator's manual, "Preparatory function")."""
    (tmp_path / "part.nc").write_text(SAFETY_LINE)
    run = kerf("steps", "part.nc")
    assert run.status == 0 and "Fanuc" in run.err and "warning" not in run.err, run.err
    steps = [json.loads(row) for row in run.out.splitlines()][1:]
    assert [0.0, 0.0, 50.0] in [s.get("to") for s in steps if s["step"] == "rapid"]
    (tmp_path / "part.nc").write_text(SAFETY_LINE.replace("%\nO0001\n", ""))
    assert "exclude each other" in kerf("steps", "part.nc").err


def test_a_rotary_axis_that_stays_at_0_turns_nothing(kerf, tmp_path):
    """Mastercam's posts write A0. at the start of programs of three axes."""
    text = "G21 G90\nT1 M6\nS5000 M3\nG0 A0.\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20 F300\nG0 Z5\nM30\n"
    for turn, status in (("A0.", 0), ("A90.", 3)):
        (tmp_path / "part.nc").write_text(text.replace("A0.", turn))
        assert kerf("check", "--tool", "square d=6", "part.nc").status == status, turn

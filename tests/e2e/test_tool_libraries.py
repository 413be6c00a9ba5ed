"""kerf tools import and export: each kind of library, and the use of imported tools."""
import io
import json
import zipfile

import pytest

TBL = """T1 P1 Z0 D6 ;square 6
T2 P2 X0 Y0 Z-12.5 D3.175 I0 J0 Q0 ;1/8 inch
"""

CARBIDE = (
    "number,vendor,model,URL,name,type,diameter,cornerradius,flutelength,shaftdiameter,angle,numflutes,"
    "stickout,coating,metric,notes,machine,material,plungerate,feedrate,rpm,depth,cutpower,finishallowance,"
    "3dstepover,3dfeedrate,3drpm\n"
    "201,Maker,,,Quarter square,end,0.25,0,0.75,0.25,0,3,0,,0,,,,20,60,18000,0.05,0,0,0,0,0\n"
    "302,Maker,,,Sixty degree V,vee,0.5,0,0.6,0.25,60,2,0,,0,,,,20,60,18000,0.05,0,0,0,0,0\n"
    "111,Maker,,,Ball 3 mm,ball,3,1.5,9,3,0,2,0,,1,,,,400,900,18000,1,0,0,0,0,0\n")

FUSION = json.dumps({"data": [
    {"type": "flat end mill", "unit": "inches", "description": "quarter inch",
     "geometry": {"DC": 0.25, "LCF": 0.75, "NOF": 3, "SFDM": 0.25}, "post-process": {"number": 201}},
    {"type": "ball end mill", "unit": "millimeters", "description": "three",
     "geometry": {"DC": 3, "LCF": 9, "NOF": 2, "SFDM": 3}, "post-process": {"number": 111}},
]})

FCTB = json.dumps({"version": 2, "name": "Five", "shape": "endmill.fcstd", "shape-type": "Endmill",
                   "parameter": {"Diameter": "5.0000 mm", "CuttingEdgeHeight": "30.0000 mm",
                                 "Length": "50.0000 mm", "ShankDiameter": "3.0000 mm", "Flutes": "2"},
                   "attribute": {}})

CAMOTICS = json.dumps({"units": "metric", "tools": {
    "1": {"units": "metric", "shape": "cylindrical", "length": 20, "diameter": 6, "description": "square"},
    "3": {"units": "metric", "shape": "ballnose", "length": 20, "diameter": 4, "description": "ball"},
}})


def zipped(text):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("tools.json", text)
    return out.getvalue()


LIBRARIES = [
    ("tool.tbl", TBL, {1: ("square", 6), 2: ("square", 3.175)}),
    ("carbide.csv", CARBIDE, {201: ("square", 6.35), 302: ("V", 12.7), 111: ("ball", 3)}),
    ("fusion.json", FUSION, {201: ("square", 6.35), 111: ("ball", 3)}),
    ("fusion.tools", zipped(FUSION), {201: ("square", 6.35), 111: ("ball", 3)}),
    ("five.fctb", FCTB, {1: ("square", 5)}),
    ("camotics.json", CAMOTICS, {1: ("square", 6), 3: ("ball", 4)}),
]


def shown(kerf, number, file):
    run = kerf("tools", "show", number, "--tools", file, "--json")
    assert run.status == 0, run.out
    return run.json


@pytest.mark.parametrize("name, content, tools", LIBRARIES, ids=[name for name, _, _ in LIBRARIES])
def test_import(kerf, program, name, content, tools):
    run = kerf("tools", "import", program(content, name), "-o", "mine.toml", "--json")
    assert run.status == 0, run.out
    for number, (shape, diameter) in tools.items():
        got = shown(kerf, number, "mine.toml")
        assert (got["shape"], got["diameter_mm"]) == (shape, pytest.approx(diameter))
    # The report uses the imported tool.
    number, (_, diameter) = next(iter(tools.items()))
    job = program(f"G21 G90\nT{number} M6\nM3 S1000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20\nG0 Z5\nM2\n", "job.nc")
    tool, = kerf("info", "--json", "--tools", "mine.toml", job).json["tools"]
    assert tool["known"] and tool["number"] == number


@pytest.mark.parametrize("unit", ["mm", "inch"])
def test_export_and_import_again(kerf, program, unit):
    kerf("tools", "import", program(CARBIDE, "carbide.csv"), "-o", "mine.toml")
    run = kerf("tools", "export", "--tools", "mine.toml", "-o", "tool.tbl", "--unit", unit)
    assert run.status == 0, run.err
    run = kerf("tools", "import", "tool.tbl", "--unit", unit, "-o", "again.toml")
    assert run.status == 0, run.err
    for number, diameter in ((201, 6.35), (302, 12.7), (111, 3)):
        assert shown(kerf, number, "again.toml")["diameter_mm"] == pytest.approx(diameter, abs=1e-4)


def test_several_libraries_at_once(kerf, program):
    run = kerf("tools", "import", program(TBL, "tool.tbl"), program(FUSION, "f.json"), "-o", "mine.toml")
    assert run.status == 0, run.err
    assert [shown(kerf, n, "mine.toml")["diameter_mm"] for n in (1, 201)] == [6, 6.35]


def test_tools_without_numbers_are_counted(kerf, program):
    run = kerf("tools", "import", program(FCTB, "five.fctb"), "--first", "40", "-o", "mine.toml")
    assert run.status == 0, run.err
    assert shown(kerf, 40, "mine.toml")["diameter_mm"] == 5


def test_an_impossible_tool_is_skipped_with_a_warning(kerf, program, tmp_path):
    odd = json.loads(FUSION)
    odd["data"][0]["geometry"]["DC"] = -1
    run = kerf("tools", "import", program(json.dumps(odd), "f.json"), "-o", "mine.toml", "--json")
    assert run.status == 0, run.out
    assert any(d["severity"] == "warning" for d in run.json["diagnostics"])
    assert shown(kerf, 111, "mine.toml")["diameter_mm"] == 3
    assert "201" not in (tmp_path / "mine.toml").read_text()


@pytest.mark.parametrize("name, content", [
    ("x.csv", "hello"), ("x.json", "{"), ("x.json", "[]"), ("x.tools", b"PK\x03\x04 broken"),
    ("x.fctb", "{}"), ("x.tbl", "G0 X1"), ("x.json", "[" * 100000),
])
def test_other_files_are_refused(kerf, program, files, name, content):
    path = program(content, name)
    run = kerf("tools", "import", "--json", path, "-o", "mine.toml")
    assert run.status == 1 and run.json["diagnostics"]
    assert files() == [name]

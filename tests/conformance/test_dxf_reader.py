"""The DXF reader against ezdxf: the same tables and entities, in every version, ASCII and binary."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ezdxf = pytest.importorskip("ezdxf", reason="ezdxf is not installed")
from ezdxf import disassemble  # noqa: E402

from ezdxf_entities import SHAPES, entities, handle_of, is_mesh, layers  # noqa: E402

DUMP = os.environ["KERF_DXF_DUMP"]
CASES = Path(os.environ.get("KERF_CASES_DIR") or "none", "pathdxf")
VERSIONS = ["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"]
# Names, which are compared without regard to case.
LOWER = ("layer", "linetype", "style", "block")


def dump(path, *options):
    done = subprocess.run([DUMP, *options, str(path)], capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr.decode()
    return json.loads(done.stdout)


def lowered(values):
    return {key: value.lower() if key in LOWER else value for key, value in values.items()}


def compare_entities(ours, theirs, where):
    assert [e["type"] for e in ours] == [e["type"] for e in theirs], where
    for mine, other in zip(ours, theirs):
        what = f"{where}: {other['type']} {other['handle']}"
        for key, value in other.items():
            if key != "shape":
                assert lowered(mine)[key] == value, f"{what}: {key}"
        shape = lowered(mine["shape"])
        for key, value in other["shape"].items():
            if key == "plain" and other["type"] == "MTEXT":
                shape[key] = shape[key].replace("\t", "    ").rstrip("\n")  # as ezdxf has it
            if key == "rotation" and other["type"] == "MTEXT":
                assert shape[key] == pytest.approx(value, abs=1e-9), f"{what}: {key}"
            else:
                assert shape[key] == value, f"{what}: {key}"


def compare(path):
    """Everything of a file that both readers have."""
    document = ezdxf.readfile(path)
    read = dump(path)
    assert read["read"], read["diagnostics"]
    assert not [d for d in read["diagnostics"] if d["severity"] == "error"], read["diagnostics"]
    assert read["version"] == document.dxfversion
    assert (read["unit"] or 0) == document.header.get("$INSUNITS", 0)
    mine = {layer["name"].lower(): layer for layer in read["layers"]}
    for name, layer in layers(document).items():
        if name == "defpoints" and name not in mine:
            continue  # ezdxf adds it
        for key, value in layer.items():
            assert lowered(mine[name])[key] == value, f"{path.name}: layer {name}: {key}"
    compare_entities(
        [e for e in read["entities"] if not e["paper"]], entities(document.modelspace()), path.name
    )
    blocks = {block["name"].lower(): block for block in read["blocks"]}
    for block in document.blocks:
        if block.is_any_layout:
            continue
        other = blocks[block.name.lower()]
        assert other["base"] == list(block.block.dxf.base_point)
        compare_entities(other["entities"], entities(block), f"{path.name}: block {block.name}")
    return read, document


# ----------------------------------------------------------------------------- files that ezdxf writes


def fill_tables(document):
    document.units = 4
    document.linetypes.add("SLOT", [2.0, 1.25, -0.25, 0.25, -0.25], description="slots")
    for name, colour in (("cut", 1), ("Gravur äöü", 3), ("off", 5), ("frozen", 6)):
        document.layers.add(name, color=colour, linetype="SLOT" if name == "cut" else "CONTINUOUS")
    document.layers.get("off").off()
    document.layers.get("frozen").freeze()
    document.layers.get("frozen").lock()
    if document.dxfversion > "AC1015":
        document.layers.get("cut").rgb = (10, 20, 30)


def add_shapes(space, r12):
    cut = {"layer": "cut"}
    space.add_line(
        (0, 0), (10.123456789012345, -5e-17, 3), {**cut, "color": 2, "linetype": "SLOT", "ltscale": 2.5}
    )
    space.add_line(
        (1e6 / 3, 1e-9), (-1e20, 2.5), {"layer": "off", "linetype": "ByBlock", "color": 0, "invisible": 1}
    )
    space.add_circle((5, 5, 1), 2.5, {"layer": "frozen"})
    space.add_circle((5, 5), 2.5, {**cut, "extrusion": (0, 0, -1)})
    space.add_arc((1, 2), 3, 350, 20.5, dxfattribs=cut)
    space.add_arc((1, 2), 3, 10, 20, dxfattribs={**cut, "extrusion": (0.3, -0.2, 0.9)})
    space.add_point((1, 2, 3), cut)
    line = space.add_polyline2d(
        [(0, 0), (10, 0), (10, 10)], dxfattribs={**cut, "elevation": (0, 0, 4)}, close=True
    )
    line.vertices[1].dxf.bulge = -0.41421356237309503
    line.vertices[2].dxf.start_width = 0.5
    space.add_polyline3d([(0, 0, 1), (10, 0, 2), (10, 10, 3)], dxfattribs=cut)
    space.add_polymesh((3, 3))
    for halign, valign, align in ((0, 0, None), (1, 2, (3, 4)), (2, 0, (5, 6, 7)), (4, 0, (1, 1))):
        attributes = {
            **cut,
            "height": 2.5,
            "rotation": 30,
            "insert": (1, 1),
            "halign": halign,
            "valign": valign,
        }
        if align:
            attributes["align_point"] = align
        space.add_text("%%c8 ±0.1 %%d äÖß %%uline%%u 100%%% ^I.", dxfattribs=attributes)
    if r12:
        return
    space.add_lwpolyline(
        [(0, 0, 0, 0, 1), (10, 0, 0.5, 0.25, 0), (10, 5, 0, 0, -0.5)],
        format="xyseb",
        close=True,
        dxfattribs={**cut, "elevation": 2},
    )
    space.add_lwpolyline(
        [(0, 0), (1, 1)], dxfattribs={"const_width": 0.3, "layer": "Gravur äöü", "lineweight": 35}
    )
    space.add_ellipse((1, 2), (5, 1), 0.4, 0.5, 5, dxfattribs={**cut, "extrusion": (0, 0, -1)})
    space.add_spline(dxfattribs=cut).apply_construction_tool(
        ezdxf.math.BSpline([(0, 0), (1, 3), (4, 3), (5, 0)], order=4, weights=[1, 2, 0.5, 1])
    )
    space.add_spline([(0, 0), (3, 4), (6, 0)], dxfattribs=cut)
    space.add_spline(dxfattribs=cut).set_closed([(0, 0, 0), (3, 4, 0), (6, 0, 0), (3, -4, 0)])
    space.add_mtext(
        r"\W1.13;{\fArial|b0;Bold \C1;red}\P2nd \S1/2; \L\o x \~y ^I\\ \{a\} %%d" + "x" * 300 + "äß €",
        {**cut, "char_height": 3, "attachment_point": 5, "rotation": 90, "insert": (1, 2)},
    )
    space.add_mtext("direction", {"char_height": 3, "text_direction": (1, 1)})
    space.add_hatch().paths.add_polyline_path([(0, 0), (1, 0), (1, 1)])


def sample(version):
    document = ezdxf.new(version)
    fill_tables(document)
    r12 = version == "R12"
    inner = document.blocks.new("Inner", base_point=(1, 1))
    inner.add_line((1, 1), (2, 1), {"layer": "0", "linetype": "ByBlock", "color": 0})
    inner.add_arc((0, 0), 1, 0, 90, dxfattribs={"layer": "cut"})
    inner.add_attdef("NR", (0, 0), "1", height=2)
    outer = document.blocks.new("OUTER")
    outer.add_blockref("Inner", (5, 0), {"rotation": 90, "layer": "0", "color": 0})
    outer.add_circle((0, 0), 1)
    space = document.modelspace()
    add_shapes(space, r12)
    space.add_blockref(
        "OUTER",
        (100, 50, 1),
        {
            "xscale": -2,
            "yscale": 2,
            "zscale": 2,
            "rotation": 30,
            "layer": "cut",
            "color": 4,
            "column_count": 3,
            "row_count": 2,
            "column_spacing": 20,
            "row_spacing": 30,
        },
    )
    space.add_blockref("inner", (0, 0), {"extrusion": (0, 0, -1), "layer": "off"}).add_attrib(
        "NR", "äö-7", (1, 1)
    )
    document.layout().add_line((0, 0), (1, 1))
    return document


@pytest.mark.parametrize("form", ["asc", "bin"])
@pytest.mark.parametrize("version", VERSIONS)
def test_every_version_reads_to_the_same_entities(tmp_path, version, form):
    path = tmp_path / f"{version}.dxf"
    sample(version).saveas(path, fmt=form)
    read, _ = compare(path)
    assert read["binary"] == (form == "bin")
    assert len(read["entities"]) > (15 if version == "R12" else 25)


def world_points(entity):
    """As dxf_dump --placed has them."""
    kind = entity.dxftype()
    if kind == "LINE":
        return [entity.dxf.start, entity.dxf.end]
    if kind == "POINT":
        return [entity.dxf.location]
    if kind == "CIRCLE":
        return [entity.ocs().to_wcs(entity.dxf.center)]
    if kind == "ARC":
        sweep = (entity.dxf.end_angle - entity.dxf.start_angle) % 360 or 360
        return list(entity.vertices([entity.dxf.start_angle + part * sweep for part in (0, 0.5, 1)]))
    if kind == "LWPOLYLINE":
        return list(entity.vertices_in_wcs())
    if kind == "POLYLINE":
        return list(entity.points_in_wcs())
    return None


@pytest.mark.parametrize("version", ["R12", "R2010"])
def test_blocks_are_inserted_as_by_ezdxf(tmp_path, version):
    path = tmp_path / "placed.dxf"
    sample(version).saveas(path)
    document = ezdxf.readfile(path)
    theirs = {}
    for e in disassemble.recursive_decompose(document.modelspace()):
        where = world_points(e) if e.dxftype() in ("LINE", "ARC", "CIRCLE", "POINT") else None
        if where is not None:
            theirs.setdefault(e.dxftype(), []).append([tuple(p) for p in where])
    ours = {}
    for e in dump(path, "--placed")["entities"]:
        ours.setdefault(e["type"], []).append([tuple(p) for p in e["points"]])
    assert len(theirs["LINE"]) == 2 + 6 + 1
    for kind, shapes in theirs.items():
        assert len(ours[kind]) == len(shapes), kind
        for mine, other in zip(ours[kind], shapes):
            # Mirrored arcs keep their points and may run the other way.
            for p, q in zip(sorted(mine), sorted(other)):
                assert p == pytest.approx(q, abs=1e-9, rel=1e-12), kind


def test_styles_of_block_entities_come_from_the_insert(tmp_path):
    path = tmp_path / "style.dxf"
    sample("R2010").saveas(path)
    placed = [e for e in dump(path, "--placed")["entities"] if e["depth"] == 2]
    lines = [e for e in placed if e["type"] == "LINE"]
    assert len(lines) == 6  # the array
    assert {(e["layer"], e["colour"], e["linetype"]) for e in lines} == {("cut", 4, "SLOT")}
    single = [e for e in dump(path, "--placed")["entities"] if e["depth"] == 1 and e["type"] == "LINE"]
    assert [(e["layer"], e["visible"]) for e in single] == [("off", False)]


@pytest.mark.parametrize("page", [874, 932, 936, 949, 950, *range(1250, 1259)])
def test_code_pages(tmp_path, page):
    codec = {936: "gbk", 949: "cp949", 950: "big5"}.get(page, f"cp{page}")
    letters = (
        bytes(range(0x80, 0x100)).decode(codec, "ignore")
        if page in (874, *range(1250, 1259))
        else {932: "日本語ｱｲｳ表", 936: "简体中文", 949: "한국어", 950: "繁體中文功"}[page]
    )
    text = (
        f"999\n-\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$DWGCODEPAGE\n3\nANSI_{page}\n0\nENDSEC\n"
        f"0\nSECTION\n2\nENTITIES\n0\nTEXT\n8\n{letters}\n10\n0\n20\n0\n40\n1\n1\n{letters}\n"
        "0\nENDSEC\n0\nEOF\n"
    )
    path = tmp_path / "page.dxf"
    path.write_bytes(text.encode(codec))
    read = dump(path)
    assert read["diagnostics"] == []
    assert read["entities"][0]["shape"]["text"] == letters
    assert read["entities"][0]["layer"] == letters.strip(" \t")


# ------------------------------------------------------------------------------------------------- real files


def real_files():
    return sorted(p for p in CASES.glob("**/*.dxf")) if CASES.is_dir() else []


def test_real_drawings_read_to_the_same_entities():
    files = real_files()
    if not files:
        pytest.skip("the cases of path drawings are not there; set KERF_CASES_DIR")
    compared = 0
    for path in files:
        try:
            ezdxf.readfile(path)
        except (ezdxf.DXFError, OSError):
            continue
        compare(path)
        compared += 1
    assert compared >= 0.9 * len(files), f"ezdxf reads only {compared} of {len(files)}"

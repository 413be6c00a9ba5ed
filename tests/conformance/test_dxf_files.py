"""The hand-made DXF files of tests/data/dxf: their contents, and the diagnostics with their lines."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

DUMP = os.environ["KERF_DXF_DUMP"]
DATA = Path(__file__).parent.parent / "data" / "dxf"
LINE = {"from": [0, 0, 0], "to": [10, 5, 0]}
NEXT = {"from": [10, 5, 0], "to": [20, 5, 0]}


def dump(name, *options):
    done = subprocess.run([DUMP, *options, str(DATA / f"{name}.dxf")], capture_output=True, timeout=60)
    assert done.returncode == 0, done.stderr.decode()
    return json.loads(done.stdout)


def shapes(read):
    return [e["shape"] for e in read["entities"]]


def reports(read):
    return [(d["code"], d["line"]) for d in read["diagnostics"]]


# file: (shapes of LINEs, what is reported)
LINES = {
    "crlf": ([LINE], []),
    "cr_only": ([LINE], []),
    "leading_blanks": ([{"from": [0.5, 0, 0], "to": [10, 5, 0]}], []),
    "byte_order_mark": ([LINE], []),
    "no_eof": ([LINE], [("dxf_truncated", 39)]),
    "cut_off_in_entity": ([LINE], [("dxf_group_code", 50), ("dxf_truncated", 49)]),
    "cut_off_after_group": ([LINE], [("dxf_truncated", 39)]),
    "cut_off_in_value": ([LINE], [("dxf_group_code", 50), ("dxf_truncated", 49)]),
    "no_header": ([LINE], []),
    "two_headers": ([LINE], [("dxf_structure", 22)]),
    "no_sections": ([LINE, NEXT], [("dxf_structure", 2), ("dxf_truncated", 31)]),
    "no_endsec": ([LINE], [("dxf_structure", 18)]),
    "comments": ([LINE], []),
    "blank_line": ([LINE, NEXT], [("dxf_group_code", 39)]),
    "missing_coordinate": ([LINE, NEXT], [("dxf_value", 39)]),
    "bad_group_code": ([LINE, NEXT], [("dxf_group_code", 45)]),
    "application_data": ([LINE], []),
    "unknown_version": ([LINE], [("dxf_version", 0)]),
    "number_forms": (
        [
            {"from": [15, -0.25, 0], "to": [3, 0.5, 0]},
            {"from": [12345678901234567890.5, 0, 0], "to": [0, 0, 0]},
        ],
        [("dxf_decimal_comma", 44), ("dxf_number", 50), ("dxf_number", 60)],
    ),
}


@pytest.mark.parametrize("name", LINES)
def test_lines(name):
    read = dump(name)
    expected, reported = LINES[name]
    assert shapes(read) == expected
    assert reports(read) == reported


def test_the_files_are_those_of_the_script(tmp_path):
    (tmp_path / "write_files.py").write_text((DATA / "write_files.py").read_text())
    subprocess.run([sys.executable, tmp_path / "write_files.py"], check=True)
    made = {p.name: p.read_bytes() for p in tmp_path.glob("*.dxf")}
    assert made == {p.name: p.read_bytes() for p in DATA.glob("*.dxf")}


@pytest.mark.parametrize("name", ["dwg", "utf16", "empty", "svg", "numbers"])
def test_other_files_are_refused(name):
    read = dump(name)
    assert not read["read"] and reports(read)[-1] == ("dxf_not_dxf", 0)


def test_polylines():
    read = dump("negative_bulge")
    assert [v[3] for v in shapes(read)[0]["vertices"]] == [-1, -0.41421356237309503, 0]
    assert shapes(read)[0]["closed"] and shapes(read)[0]["widths"] == [[0.5, 0.5]] * 3
    assert [(s["closed"], len(s["vertices"])) for s in shapes(dump("closed_polylines"))] == [
        (True, 4),
        (False, 4),
        (True, 5),
        (True, 4),
    ]
    spatial, flat = shapes(dump("polyline_3d"))
    assert spatial["spatial"] and [v[2] for v in spatial["vertices"]] == [1, 2, 3]
    assert not flat["spatial"] and [v[2] for v in flat["vertices"]] == [
        4,
        4,
    ]  # the POLYLINE's, not the VERTEX's
    assert len(shapes(dump("polyline_spline_frame"))[0]["vertices"]) == 3
    read = dump("polyline_without_seqend")
    assert [e["type"] for e in read["entities"]] == ["POLYLINE", "LINE"] and reports(read) == [
        ("dxf_structure", 23)
    ]
    assert shapes(dump("entities_only_lwpolyline"))[0]["vertices"] == [[0, 0, 0, 1], [10, 0, 0, 0]]


def test_layers_may_be_declared_after_their_use():
    read = dump("tables_after_entities")
    assert read["entities"][0]["layer"] == "CUT"
    layer = read["layers"][1]
    assert (layer["name"], layer["frozen"], layer["off"], layer["colour"]) == ("CUT", True, True, 3)
    assert layer["linetype"] == "DASHED"


def test_repeated_handles_are_counted():
    read = dump("repeated_handles")
    assert reports(read) == [("dxf_handle_repeated", 59)] and read["repeated_handles"] == 1
    assert [e["handle"] for e in read["entities"]] == ["2F", "30", "2F"]


def test_wrong_counts_are_ignored():
    read = dump("huge_counts")
    assert [e["type"] for e in read["entities"]] == ["LWPOLYLINE", "SPLINE", "INSERT"]
    assert [len(s) for s in (shapes(read)[0]["vertices"], shapes(read)[1]["control"])] == [3, 4]
    assert reports(dump("huge_counts", "--placed")) == [("dxf_limit", 151)]


def close(points, expected):
    return [pytest.approx(p, abs=1e-12) for p in expected] == points


def test_inserts_are_mirrored_and_repeated():
    placed = [e["points"] for e in dump("mirrored_inserts", "--placed")["entities"]]
    half = math.sqrt(0.5)
    # An extrusion of -z mirrors x: the block's +x, rotated by 90 degrees, is +y, and its +y is +x.
    assert close(placed[0], [[-10, 5, 0], [-10, 8, 0]])
    assert close(
        placed[1],
        [[-10, 8, 0], [-9 - half, 8 + half, 0], [-9, 9, 0]],
    )
    assert close(placed[2], [[10, 5, 0], [7, 5, 0]])
    # The array's spacing is turned, not scaled.
    starts = [placed[i][0] for i in (4, 6, 8, 10)]
    assert close(starts, [[0, 0, 0], [0, 10, 0], [-100, 0, 0], [-100, 10, 0]])


def test_blocks_that_contain_themselves_are_inserted_once():
    read = dump("blocks_in_rings", "--placed")
    assert len(read["entities"]) == 3
    assert {code for code, _ in reports(read)} == {"dxf_block"}
    messages = [d["message"] for d in read["diagnostics"]]
    assert any('"A" contains itself' in m for m in messages)
    assert any('"SELF" contains itself' in m for m in messages)
    assert any('"GONE" is not in the file' in m for m in messages)
    assert reports(dump("blocks_multiply", "--placed")) == [("dxf_limit", 1289)]


def test_extrusion_direction_turns_arcs():
    placed = [e["points"] for e in dump("flipped_arc", "--placed")["entities"]]
    half = math.sqrt(2)
    assert close(placed[0], [[7, 5, 0], [5 + half, 5 + half, 0], [5, 7, 0]])
    assert close(placed[1], [[-7, 5, 0], [-5 - half, 5 + half, 0], [-5, 7, 0]])
    assert [e["extrusion"] for e in dump("flipped_ellipse")["entities"]] == [[0, 0, 1], [0, 0, -1]]


def test_splines():
    closed, rational, fitted, tangents = shapes(dump("splines"))
    assert closed["closed"] and len(closed["knots"]) == 11 and len(closed["control"]) == 7
    assert rational["weights"] == [1, math.sqrt(0.5), 1] and rational["degree"] == 2
    assert fitted["control"] == [] and fitted["fit"] == [[0, 0, 0], [5, 5, 0], [10, 0, 0]]
    assert len(tangents["fit"]) == 2
    assert reports(dump("bad_splines")) == [("dxf_value", 23), ("dxf_value", 69), ("dxf_value", 89)]


def test_embedded_objects_and_application_data_are_skipped():
    shape = shapes(dump("embedded_object"))[0]
    assert (shape["text"], shape["at"], shape["height"]) == ("right", [1, 2, 0], 2.5)


def test_unsupported_entities_and_tags_are_counted():
    read = dump("unknown_entities")
    assert read["others"] == {"HATCH": 2, "DIMENSION": 1}
    assert read["unused"] == [["LINE", 39, 2]]
    assert read["entities"][1]["handle"] == "B"
    assert dump("comments")["comments"] == 4


def test_characters():
    first, second = dump("characters")["entities"]
    assert first["layer"] == "Lage ä"
    assert first["shape"]["text"] == "\u2300 5\U0001f600\\U+00 \u3042 \\M+9"  # three escapes, two invalid
    assert second["shape"]["plain"] == "Ø8±0.1 \u00f8% %%x \n^"
    assert shapes(dump("cad_2007_is_utf8"))[0]["text"] == "Ø 日本"
    read = dump("unknown_code_page")
    assert shapes(read)[0]["text"] == "Größe" and reports(read) == [("dxf_encoding", 0)]
    read = dump("utf8_that_is_none")
    assert shapes(read)[0]["text"] == "Gr\ufffd\ufffde" and "UTF-8" in read["diagnostics"][0]["message"]

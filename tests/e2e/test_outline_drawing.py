"""kerf outline with DXF drawings: layers, units, open ends, outputs."""

import math
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2]
CUT = [("LINE", (0, 0, 40, 0)), ("LINE", (40, 20, 40, 0)), ("LINE", (40, 20, 0, 20)), ("LINE", (0, 20, 0, 0))]


def tags(*rows):
    return "".join(f"{group}\n{value}\n" for group, value in rows)


def line(x1, y1, x2, y2, layer="CUT", handle=None):
    name = [(5, handle)] if handle else []
    return tags((0, "LINE"), *name, (8, layer), (10, x1), (20, y1), (11, x2), (21, y2))


def drawing(*entities, unit=4):
    units = tags((9, "$INSUNITS"), (70, unit)) if unit is not None else ""
    return (
        tags((0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"))
        + units
        + tags(
            (0, "ENDSEC"),
            (0, "SECTION"),
            (2, "TABLES"),
            (0, "TABLE"),
            (2, "LAYER"),
            (0, "LAYER"),
            (2, "CUT"),
            (70, 0),
            (62, 1),
            (6, "CONTINUOUS"),
            (0, "LAYER"),
            (2, "notes"),
            (70, 1),
            (62, 3),
            (6, "CONTINUOUS"),
            (0, "ENDTAB"),
            (0, "ENDSEC"),
            (0, "SECTION"),
            (2, "ENTITIES"),
        )
        + "".join(entities)
        + tags((0, "ENDSEC"), (0, "EOF"))
    )


PLATE = [line(*points) for _, points in CUT]
HOLE = tags((0, "CIRCLE"), (5, "2F"), (8, "CUT"), (10, 10), (20, 10), (40, 4))
ELLIPSE = tags((0, "ELLIPSE"), (8, "CUT"), (10, 28), (20, 10), (11, 8), (21, 0), (40, 0.5))


@pytest.fixture
def part(tmp_path):
    def write(*entities, unit=4):
        (tmp_path / "part.dxf").write_text(drawing(*entities, unit=unit))
        return "part.dxf"

    return write


def test_the_outlines_of_a_layer(kerf, part):
    run = kerf("outline", part(*PLATE, HOLE, ELLIPSE), "--layer", "cut", "--json")
    assert run.status == 0, run.err
    plate, hole, ellipse = run.json["outlines"]
    assert plate["closed"] and len(plate["segments"]) == 4 and plate["length_mm"] == 120
    assert hole["circle"] == {"at": [10, 10], "radius": 4} and hole["handles"] == ["2F"]
    assert ellipse["closed"] and all("via" in s for s in ellipse["segments"])
    assert run.json["unit"] == "mm" and run.json["drawing"] == {
        "version": "AC1015",
        "insunits": 4,
        "unit_mm": 1,
    }
    assert run.json["open_ends"] == [] and run.codes() == []


def test_the_tolerance_of_curves(kerf, part):
    file = part(ELLIPSE)
    coarse, fine = (
        len(kerf("outline", file, "--tolerance", t, "--json").json["outlines"][0]["segments"])
        for t in ("0.1", "0.0001")
    )
    assert 4 <= coarse < fine <= 200


def test_the_region_has_holes(kerf, part, tmp_path):
    run = kerf(
        "outline", part(*PLATE, HOLE), "--region", "--json", "--dxf", "clean.dxf", "--svg", "clean.svg"
    )
    assert run.json["region"]["area_mm2"] == pytest.approx(800 - 16 * math.pi)
    assert len(run.json["region"]["outlines"]) == 2 and run.json["outputs"] == ["clean.svg", "clean.dxf"]
    again = kerf("outline", "clean.dxf", "--region", "--json")
    assert again.json["region"]["area_mm2"] == pytest.approx(800 - 16 * math.pi)
    assert (tmp_path / "clean.svg").read_text().startswith("<?xml")


def test_a_missing_unit_must_be_given(kerf, part):
    file = part(*PLATE, unit=None)
    run = kerf("outline", file)
    assert run.status == 1 and "does not specify its unit" in run.err and "--unit inch" in run.err
    assert kerf("outline", file, "--unit", "inch", "--json").json["outlines"][0]["segments"][0]["to"] == [
        1016,
        0,
    ]
    assert kerf("outline", file, "--unit", "ell").status == 2


def test_open_ends_and_junctions_are_reported_with_their_coordinates(kerf, part, tmp_path):
    file = part(
        line(0, 0, 40, 0, handle="A1"), line(40.03, 0, 40, 20, handle="A2"), line(20, 0, 20, 5, handle="A3")
    )
    run = kerf("outline", file, "--svg", "faults.svg", "--json")
    assert run.status == 0
    assert {(tuple(e["at"]), e["entity"]) for e in run.json["open_ends"]} == {
        ((0, 0), "LINE A1"),
        ((40, 0), "LINE A1"),
        ((40.03, 0), "LINE A2"),
        ((40, 20), "LINE A2"),
        ((20, 5), "LINE A3"),
    }
    near = next(e for e in run.json["open_ends"] if e["at"] == [40, 0])
    assert near["nearest"] == [40.03, 0] and near["distance_mm"] == pytest.approx(0.03)
    assert run.json["junctions"] == [{"at": [20, 0], "layer": "CUT", "entities": ["LINE A3", "LINE A1"]}]
    assert (tmp_path / "faults.svg").read_text().count("<circle") == 6
    text = kerf("outline", file).err
    assert "layer CUT, handle A1, at 40, 0" in text and "0.03 mm away" in text
    assert len(kerf("outline", file, "--join", "0.05", "--json").json["open_ends"]) == 3


def test_layers_are_listed_without_a_unit(kerf, part):
    file = part(*PLATE, HOLE, line(0, 0, 1, 1, layer="notes"), unit=None)
    run = kerf("outline", file, "--list-layers")
    assert run.status == 0 and "4 LINE, 1 CIRCLE" in run.out and "frozen" in run.out
    layers = {
        layer["name"]: layer for layer in kerf("outline", file, "--list-layers", "--json").json["layers"]
    }
    assert layers["CUT"]["types"] == {"LINE": 4, "CIRCLE": 1} and layers["notes"]["frozen"]


def test_hidden_layers_are_used_by_name_only(kerf, part):
    file = part(*PLATE, line(0, 0, 1, 1, layer="notes"))
    run = kerf("outline", file, "--json")
    assert len(run.json["outlines"]) == 1 and run.codes() == ["drawing_hidden"]
    assert len(kerf("outline", file, "--layer", "notes", "--layer", "CUT", "--json").json["outlines"]) == 2


@pytest.mark.parametrize(
    "options, status, code",
    [
        (("--layer", "CUTS"), 1, "drawing_layer"),
        (("--layer", "notes"), 1, "drawing_empty"),
        (("--unit", "inch"), 0, "drawing_unit"),
    ],
)
def test_what_does_not_fit_the_drawing(kerf, part, options, status, code):
    run = kerf("outline", part(*PLATE), *options, "--json")
    assert run.status == status and code in run.codes()


def test_a_damaged_entity_does_not_refuse_the_drawing(kerf, part, tmp_path):
    file = part(*PLATE, tags((0, "CIRCLE"), (8, "CUT"), (10, 1), (20, "x"), (40, 3)), HOLE)
    run = kerf("outline", file, "--json", "--dxf", "out.dxf")
    assert run.status == 0 and run.codes() == ["dxf_number"] and len(run.json["outlines"]) == 2
    assert run.json["diagnostics"][0]["origin"]["line"] == drawing(*PLATE).count("\n") - 4 + 8
    assert (tmp_path / "out.dxf").exists()
    file = part(*PLATE, "0\nLINE\n8\nCUT\n10\n1\nx\n2\n11\n5\n21\n5\n", HOLE)  # no group code
    run = kerf("outline", file, "--json")
    assert run.status == 0 and "dxf_group_code" in run.codes() and len(run.json["outlines"]) == 2


def test_outputs_do_not_replace_the_drawing(kerf, part):
    file = part(*PLATE)
    assert kerf("outline", file, "--dxf", file).status == 2
    assert kerf("outline", file, "--dxf", "a.out", "--svg", "a.out").status == 2
    assert kerf("outline", "none.dxf").status == 1


def test_options_for_drawings_have_no_effect_on_other_files(kerf, tmp_path):
    (tmp_path / "plate.json").write_text(
        '{"unit": "mm", "outlines": [{"name": "a", "closed": true, '
        '"first": {"at": [0, 0]}, "segments": [{"to": [4, 0]}, {"to": [4, 2]}]}]}'
    )
    run = kerf("outline", "plate.json", "--layer", "CUT", "--json")
    assert run.status == 0 and run.codes() == ["option_unused"]


def test_a_file_that_librecad_saved_has_the_same_geometry(kerf):
    """examples/path/9001.1P.dxf opened in LibreCAD 2.2 (Debian 12) and saved by it as 2007 DXF."""
    layer = ("--layer", "9001_1P", "--unit", "mm", "--texts", "none", "--json")
    saved = kerf("outline", SOURCE / "tests/data/dxf_saved/librecad_2.2_9001.dxf", *layer)
    original = kerf("outline", SOURCE / "examples/path/9001.1P.dxf", *layer)
    assert saved.status == original.status == 0, saved.err + original.err
    assert saved.json["drawing"]["version"] == "AC1021" and saved.json["unit"] == "mm"
    shapes = lambda run: [{**outline, "handles": None} for outline in run.json["outlines"]]
    assert len(shapes(saved)) == 4 and shapes(saved) == shapes(original)


def test_what_is_not_read_has_its_handle_and_layer(kerf, tmp_path):
    """A block that is in another file (group 70: 4), and a circle without an area."""
    block = tags((0, "SECTION"), (2, "BLOCKS"), (0, "BLOCK"), (8, "0"), (2, "plan"), (70, 4), (10, 0),
                 (20, 0), (1, "plan.dwg"), (0, "ENDBLK"), (0, "ENDSEC"))
    insert = tags((0, "INSERT"), (5, "4A"), (8, "notes"), (2, "plan"), (10, 0), (20, 0))
    flat = tags((0, "CIRCLE"), (5, "4B"), (8, "CUT"), (10, 0), (20, 0), (40, 0))
    (tmp_path / "part.dxf").write_text(block + drawing(*PLATE, insert, flat))
    run = kerf("outline", "part.dxf", "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1
    messages = {d["name"]: d["message"] for d in run.json["diagnostics"]}
    assert "plan.dwg" in messages["dxf_block"] and "INSERT 4A on layer notes" in messages["dxf_block"]
    assert messages["dxf_value"].startswith("CIRCLE 4B on layer CUT: the radius")


def solid(kind, *corners):
    """Corners 10 to 13; the third is opposite to the second."""
    rows = [(group, value) for k, (x, y) in enumerate(corners) for group, value in ((10 + k, x), (20 + k, y))]
    return tags((0, kind), (5, "3A"), (8, "CUT"), *rows)


def nested_hatch(islands):
    """Squares of 30, 20 and 10 mm around one centre."""
    rows = [(0, "HATCH"), (8, "CUT"), (10, 0), (20, 0), (30, 0), (2, "SOLID"), (70, 1), (71, 0), (91, 3)]
    for half in (15, 10, 5):
        rows += [(92, 2), (72, 0), (73, 1), (93, 4)]
        for x, y in ((-half, -half), (half, -half), (half, half), (-half, half)):
            rows += [(10, x), (20, y)]
        rows += [(97, 0)]
    return tags(*rows, (75, islands), (76, 1), (98, 0))


@pytest.mark.parametrize("entity, area", [
    (solid("SOLID", (0, 0), (10, 0), (0, 5), (10, 5)), 50),
    (solid("TRACE", (0, 0), (10, 0), (0, 5), (10, 5)), 50),
    (solid("SOLID", (0, 0), (10, 0), (0, 5), (0, 5)), 25),
    (solid("SOLID", (0, 0), (10, 0), (0, 5)), 25),
    (nested_hatch(0), 900 - 400 + 100),
    (nested_hatch(1), 900 - 400),
    (nested_hatch(2), 900),
])
def test_filled_entities_are_areas(kerf, part, entity, area):
    run = kerf("outline", part(entity), "--region", "--json")
    assert run.status == 0 and math.isclose(run.json["region"]["area_mm2"], area, abs_tol=1e-6), run.out
    assert run.codes() == []


def test_the_boundary_of_a_filled_entity_is_drawn_once(kerf, part):
    edges = [line(0, 0, 10, 0), line(10, 0, 10, 5), line(10, 5, 0, 5), line(0, 5, 0, 0)]
    run = kerf("outline", part(*edges, solid("SOLID", (0, 0), (10, 0), (0, 5), (10, 5))), "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1 and run.codes() == []


def test_entities_of_no_length_are_named(kerf, tmp_path):
    """A line with equal ends, a polyline of one point and an ellipse without an axis draw nothing."""
    entities = [(0, "SECTION"), (2, "ENTITIES"), (0, "CIRCLE"), (5, "1A"), (8, "0"), (10, 5), (20, 5),
                (40, 3), (0, "LINE"), (5, "1B"), (8, "0"), (10, 5), (20, 5), (11, 5), (21, 5),
                (0, "LWPOLYLINE"), (5, "1D"), (8, "0"), (90, 1), (70, 0), (10, 3), (20, 3),
                (0, "ELLIPSE"), (5, "1E"), (8, "0"), (10, 0), (20, 0), (11, 0), (21, 0), (40, 1),
                (0, "ENDSEC"), (0, "EOF")]
    (tmp_path / "a.dxf").write_text(tags(*entities))
    run = kerf("outline", "--unit", "mm", "a.dxf")
    assert run.status == 0
    for name in ("LINE 1B", "LWPOLYLINE 1D", "ELLIPSE 1E"):
        assert f"layer 0, handle {name.split()[1]}" in run.err and f"{name} has no length" in run.err

"""kerf tools export: what a form holds comes back by kerf tools import; what it cannot hold is named once."""
import csv
import io
import json
import math
import random
import re
import sqlite3
import tomllib
import zipfile

import pytest

# What each form holds beside the cutting part, by its documents (docs/manual/tools.md).
FORMS = {
    "carbide": dict(file="t.csv", shapes={"square", "ball", "bull nose", "V", "drill", "tapered ball"},
                    shank=True, name=True, text=True, teeth=True),
    "fusion": dict(file="t.json", shapes={"square", "ball", "bull nose", "V", "drill", "tapered ball",
                                          "dovetail"},
                   shank=True, holder=True, neck=True, name=True, text=True, teeth=True),
    "freecad": dict(file="t.fctl", shapes={"square", "ball", "bull nose", "V", "drill", "tapered ball",
                                           "dovetail", "thread mill"}, shank=True, text=True, teeth=True),
    "camotics": dict(file="t.json", shapes={"square", "ball", "V"}, text=True),
    "vectric": dict(file="t.vtdb", shapes={"square", "ball", "bull nose", "V", "drill", "tapered ball"},
                    text=True, teeth=True),
    "linuxcnc": dict(file="t.tbl", shapes=None, shank=True, holder=True, neck=True, text=True, teeth=True),
    "kerf": dict(file="t.toml", shapes=None, shank=True, holder=True, neck=True, name=True, text=True,
                 teeth=True),
}


def some(rng, low, high):
    return round(rng.uniform(low, high), 3)


def cone_height(diameter, tip, angle):
    return (diameter - tip) / 2 / math.tan(math.radians(angle / 2))


def random_shape(rng, shape):
    """Dimensions of a possible tool, as text of a tool file's values."""
    d = some(rng, 1, 20)
    flute = some(rng, d, 3 * d)
    angle = some(rng, 20, 120)
    made = {"diameter": d}
    if shape in ("square", "ball"):
        made["flute"] = flute
    elif shape in ("bull nose", "bowl"):
        made |= {"corner_radius": round(d * rng.uniform(0.05, 0.45), 3), "flute": flute}
    elif shape in ("V", "chamfer"):
        made["angle"] = angle
        if shape == "chamfer" or rng.random() < 0.5:
            made["tip_diameter"] = round(d * rng.uniform(0.05, 0.5), 3)
    elif shape == "tapered ball":
        made |= {"tip_diameter": round(d * rng.uniform(0.1, 0.4), 3), "flute": some(rng, 2 * d, 4 * d)}
    elif shape == "drill":
        made |= {"angle": some(rng, 90, 140), "flute": flute + d}
    elif shape == "dovetail":
        made |= {"flute": some(rng, d / 4, d / 2), "angle": some(rng, 5, 20)}
    elif shape == "thread mill":
        made = {"major_diameter": d, "minor_diameter": round(0.7 * d, 3), "cut_height": round(0.2 * d, 3),
                "length": some(rng, d, 2 * d)}
    elif shape == "flat groove":
        made |= {"tip_diameter": round(0.5 * d, 3), "flute": some(rng, 1, d)}
    elif shape == "keyhole":
        made |= {"head": round(0.3 * d, 3), "neck_diameter": round(0.5 * d, 3)}
    elif shape == "roundover":
        made = {"radius": some(rng, 1, 8), "tip_diameter": some(rng, 1, 4)}
    elif shape == "lollipop":
        made |= {"neck_diameter": round(0.5 * d, 3), "flute": some(rng, d, 2 * d)}
    elif shape == "T-slot":
        made |= {"thickness": round(0.2 * d, 3), "neck_diameter": round(0.4 * d, 3),
                 "flute": some(rng, d, 2 * d)}
    elif shape == "centre drill":
        made = {"pilot_diameter": 2, "pilot_length": 3, "pilot_angle": 118, "diameter": 6, "angle": 60}
    elif shape == "corner rounding":
        made |= {"radius": round(0.2 * d, 3)}
    elif shape == "drawn":
        made = {"profile": [[0, 0], [d / 4, 0.5], [d / 2, flute, 0.2], [d / 2, flute + 2]]}
    return made


SHAPES = ["square", "ball", "bull nose", "bowl", "V", "tapered ball", "keyhole", "dovetail", "roundover",
          "thread mill", "lollipop", "T-slot", "drill", "centre drill", "flat groove", "chamfer",
          "corner rounding", "drawn"]


def random_tool(rng, number, shape, bodies):
    made = {"number": number, "shape": shape, "description": f"tool {number}, \"{shape}\"",
            "teeth": rng.randint(1, 6)}
    made |= random_shape(rng, shape)
    if "shank" in bodies:
        made |= {"shank_diameter": some(rng, 3, 12), "shank_length": some(rng, 5, 40)}
    if "holder" in bodies:
        made |= {"holder_diameter": some(rng, 20, 50), "holder_length": some(rng, 10, 60)}
    return made


def tool_file(tools):
    text = 'unit = "mm"\n'
    for tool in tools:
        text += "\n[[tool]]\n"
        for key, value in tool.items():
            text += f"{key} = {json.dumps(value)}\n"
    return text


def shown(kerf, number, file):
    run = kerf("tools", "show", str(number), "--tools", file, "--json")
    assert run.status == 0, run.out
    return run.json


def same(a, b, at=""):
    """Whether two values of --json are equal, numbers within a hundredth of a micrometre."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k], k) for k in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, float) and isinstance(b, float):
        return abs(a - b) < 2e-5
    return a == b


def export(kerf, form, source, *more):
    return kerf("tools", "export", source, "--to", form, "-o", FORMS[form]["file"], "--json", *more)


def lost(run):
    return [d for d in run.json["diagnostics"] if d["name"] == "tool_library_lost"]


def parts(shown_tool):
    """The corners of each part; two at one point, as rounding makes of the end of a cone, are one."""
    made = {}
    for part, knots in shown_tool["profile_mm"].items():
        made[part] = []
        for knot in ([k["r"], k["z"], k["bulge"]] for k in knots):
            if made[part] and same(made[part][-1][:2], knot[:2]):
                made[part].pop()
            made[part].append(knot)
    return made


# Carbide Create's V has no flat tip; CAMotics has V without tip and flat ones, both as high as their flutes.
SOME_LEFT_OUT = {("carbide", "V")}


def left_out(shape, message):
    return re.search(rf"[:;] {shape} left out", message) is not None


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("form", FORMS)
def test_random_tools_come_back(kerf, program, form, seed):
    """Every shape: equal where the form holds it, named in the one warning where it does not."""
    rng = random.Random(f"{form} {seed}")
    holds = FORMS[form]
    bodies = [part for part in ("shank", "holder") if rng.random() < 0.6]
    tools = [random_tool(rng, 10 + i, shape, bodies) for i, shape in enumerate(SHAPES)]
    source = program(tool_file(tools), "mine.toml")
    run = export(kerf, form, source)
    assert run.status == 0, run.out
    warnings = lost(run)
    assert len(warnings) <= 1
    message = warnings[0]["message"] if warnings else ""
    # The notes on lines of a tool.tbl, which are short.
    short = " ".join(d["message"] for d in run.json["diagnostics"] if d["name"] == "tool_not_written")
    back = kerf("tools", "import", holds["file"], "-o", "back.toml", "--json")
    assert back.status == 0, back.out
    for tool in tools:
        number, shape = tool["number"], tool["shape"]
        if f"tool {number} is without its sizes" in short:
            continue
        if number not in back.json["tools"]:
            assert holds["shapes"] is not None and left_out(shape, message), (shape, message)
            continue
        before, after = shown(kerf, number, source), shown(kerf, number, "back.toml")
        old, new = parts(before), parts(after)
        assert same(old["cutting"], new["cutting"]), (shape, old, new)
        if before["shape"] != after["shape"]:
            assert f"the {shape} as a {after['shape']}" in message
        for part, word in (("shank", "the exact shank"), ("holder", "the holder"), ("neck", "the neck")):
            if not same(old.get(part), new.get(part)):
                assert f"without {word}" in message, (shape, part, message)
        if not same(before["teeth"], after["teeth"]):
            assert "without the number of teeth" in message
        assert (before["description"] == after["description"] or "without the exact description" in message
                or f"tool {number} is without its description" in short)
    # A shape that a form holds is not left out.
    for shape in holds["shapes"] or ():
        assert not left_out(shape, message) or (form, shape) in SOME_LEFT_OUT, message


@pytest.mark.parametrize("form", FORMS)
def test_plain_tools_lose_nothing(kerf, program, form):
    """The shapes that a form holds, without what it cannot hold: no warning, and equal in all."""
    holds = FORMS[form]
    rng = random.Random(form)
    bodies = ["shank"] if holds.get("shank") else []
    if holds.get("holder"):
        bodies.append("holder")
    tools = []
    for i, shape in enumerate(sorted(holds["shapes"] or {"square", "ball", "V"})):
        if shape == "tapered ball" and form == "camotics":
            continue
        tool = random_tool(rng, 3 + i, shape, bodies)
        if shape == "V" and form == "carbide":
            tool.pop("tip_diameter", None)
        if shape == "tapered ball" and bodies:  # Fusion has one diameter for both
            tool["shank_diameter"] = tool["diameter"]
        if form == "camotics":
            tool["teeth"] = 2
        if holds.get("name"):
            tool["name"] = f"Maker {i}"
        tools.append(tool)
    source = program(tool_file(tools), "mine.toml")
    run = export(kerf, form, source)
    assert run.status == 0, run.out
    assert not lost(run), lost(run)
    back = kerf("tools", "import", holds["file"], "-o", "back.toml", "--json")
    assert back.json["tools"] == [t["number"] for t in tools] and not back.json["diagnostics"], back.out
    for tool in tools:
        before, after = shown(kerf, tool["number"], source), shown(kerf, tool["number"], "back.toml")
        assert parts(before).keys() == parts(after).keys()
        assert same(parts(before), parts(after)), tool
        for key in ("shape", "teeth", "plunges", "description"):
            assert before[key] == after[key]
        names = [[name for name in t["names"] if name != str(tool["number"])] for t in (before, after)]
        assert names[0] == names[1]


def test_what_is_lost_is_one_warning(kerf, program):
    source = program(tool_file([
        {"number": 1, "shape": "square", "diameter": 6, "shank_diameter": 6, "shank_length": 20,
         "holder_diameter": 30, "holder_length": 40, "names": ["A 1", "B 2"], "description": "one"},
        {"number": 2, "shape": "keyhole", "diameter": 9, "head": 3, "neck_diameter": 5},
        {"number": 3, "shape": "chamfer", "diameter": 9, "angle": 90, "tip_diameter": 2}]), "mine.toml")
    run = export(kerf, "vectric", source)
    assert run.status == 0
    only, = lost(run)
    for part in ("keyhole left out (tool 2)", "the chamfer as a V (tool 3)", "without the holder (tool 1)",
                 "without the exact shank (tool 1)", "without all names (tool 1)",
                 "the mark of plunging (tool 3)"):
        assert part in only["message"], only["message"]


def test_a_form_that_holds_no_tool_is_an_error(kerf, program, files):
    keyhole = {"number": 2, "shape": "keyhole", "diameter": 9, "head": 3, "neck_diameter": 5}
    source = program(tool_file([keyhole]), "mine.toml")
    run = export(kerf, "carbide", source)
    assert run.status == 1 and [d["name"] for d in run.json["diagnostics"]] == ["tool_not_written"]
    assert files() == ["mine.toml"]


# ---- The files, as other programs see them.

MINE = tool_file([
    {"number": 7, "shape": "square", "diameter": 6.35, "flute": 19.05, "teeth": 3, "shank_diameter": 6.35,
     "shank_length": 20, "holder_diameter": 30, "holder_length": 40, "name": "Maker 7",
     "description": "a, b"},
    {"number": 8, "shape": "V", "diameter": 12, "angle": 90, "description": "vee"}])


def test_carbide_csv_has_the_columns_of_carbide_create(kerf, program, tmp_path):
    assert export(kerf, "carbide", program(MINE, "mine.toml")).status == 0
    rows = list(csv.DictReader(io.StringIO((tmp_path / "t.csv").read_text())))
    assert [(r["number"], r["type"], r["name"], float(r["diameter"]), r["metric"]) for r in rows] == [
        ("7", "end", "a, b", 6.35, "1"), ("8", "vee", "vee", 12, "1")]
    assert float(rows[0]["stickout"]) == pytest.approx(39.05) and float(rows[1]["angle"]) == 90


@pytest.mark.parametrize("name", ["t.json", "t.tools"])
def test_fusion_has_the_lengths_in_order(kerf, program, tmp_path, name):
    assert kerf("tools", "export", program(MINE, "mine.toml"), "-o", name).status == 0
    data = (tmp_path / name).read_bytes()
    if name == "t.tools":
        data = zipfile.ZipFile(io.BytesIO(data)).read("tools.json")
    square, vee = json.loads(data)["data"]
    g = square["geometry"]
    assert (square["type"], square["unit"], g["DC"], g["NOF"]) == ("flat end mill", "millimeters", 6.35, 3)
    assert g["OAL"] > g["LB"] >= g["shoulder-length"] >= g["LCF"] == 19.05
    assert g["LB"] == pytest.approx(39.05)
    assert square["post-process"]["number"] == 7 and square["holder"]["segments"][0]["height"] == 40
    assert vee["type"] == "chamfer mill" and vee["geometry"]["TA"] == pytest.approx(45)


def test_freecad_bits_stand_beside_their_library(kerf, program, files, tmp_path):
    run = kerf("tools", "export", program(MINE, "mine.toml"), "--to", "freecad", "-o", "shop.fctl", "--json")
    assert run.status == 0 and run.json["outputs"] == ["shop.fctl", "shop-T7.fctb", "shop-T8.fctb"]
    assert files() == ["mine.toml", "shop-T7.fctb", "shop-T8.fctb", "shop.fctl"]
    assert json.loads((tmp_path / "shop.fctl").read_text())["tools"][0] == {"nr": 7, "path": "shop-T7.fctb"}
    bit = json.loads((tmp_path / "shop-T8.fctb").read_text())
    assert (bit["shape-type"], bit["parameter"]["Diameter"]) == ("VBit", "12 mm")


def test_one_bit_holds_one_tool(kerf, program):
    source = program(MINE, "mine.toml")
    run = kerf("tools", "export", source, "-o", "one.fctb", "--json")
    assert run.status == 1 and run.json["diagnostics"][0]["name"] == "tool_not_written"


def test_standard_output(kerf, program):
    source = program(MINE, "mine.toml")
    assert kerf("tools", "export", source, "--to", "carbide").out.startswith("number,vendor,")
    assert kerf("tools", "export", source, "--to", "carbide", "--json").json["tools"] == [7, 8]
    assert kerf("tools", "export", source).out.startswith('unit = "mm"')


def test_from_one_program_to_another(kerf, program):
    """FILE may be the library of another program."""
    text = "number,type,diameter,flutelength,metric\n5,end,6,20,1\n"
    assert kerf("tools", "export", program(text, "c.csv"), "-o", "t.vtdb").status == 0
    assert kerf("tools", "import", "t.vtdb", "-o", "back.toml").status == 0
    assert shown(kerf, 5, "back.toml")["diameter_mm"] == 6


@pytest.mark.parametrize("words, code", [
    (["-o", "t.xls"], "output_kind_unknown"), (["--to", "vectric"], "file_unwritable"),
    (["--to", "freecad"], "file_unwritable"), (["--to", "excel", "-o", "t.xls"], "usage")])
def test_wrong_use(kerf, program, files, words, code):
    run = kerf("tools", "export", program(MINE, "mine.toml"), *words, "--json")
    assert run.status == 2 and run.json["diagnostics"][0]["name"] == code
    assert files() == ["mine.toml"]


# ---- Vectric's database, made by the documented schema.

SCHEMA = """
CREATE TABLE version (version INTEGER NOT NULL UNIQUE, PRIMARY KEY(version));
CREATE TABLE machine (id TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE, make TEXT, model TEXT,
  controller_type TEXT, dimensions_units INTEGER, max_width REAL, max_height REAL, support_rotary INTEGER,
  support_tool_change INTEGER, has_laser_head INTEGER, PRIMARY KEY(id));
CREATE TABLE material (id TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE, PRIMARY KEY(id));
CREATE TABLE tool_geometry (id TEXT NOT NULL UNIQUE, name_format TEXT NOT NULL, notes TEXT,
  tool_type INTEGER NOT NULL, units INTEGER NOT NULL, diameter REAL, included_angle REAL, flat_diameter REAL,
  num_flutes INTEGER, flute_length REAL, thread_pitch REAL, outline BLOB, tip_radius REAL, laser_watt INTEGER,
  custom_attributes TEXT, tooth_size REAL, tooth_offset REAL, neck_length REAL, tooth_height REAL,
  threaded_length REAL, PRIMARY KEY(id));
CREATE TABLE tool_cutting_data (id TEXT NOT NULL UNIQUE, rate_units INTEGER NOT NULL, feed_rate REAL,
  plunge_rate REAL, spindle_speed INTEGER, spindle_dir INTEGER, stepdown REAL, stepover REAL,
  clear_stepover REAL, thread_depth REAL, thread_step_in REAL, laser_power REAL, laser_passes INTEGER,
  laser_burn_rate REAL, line_width REAL, length_units INTEGER NOT NULL DEFAULT 0, tool_number INTEGER,
  laser_kerf INTEGER, notes TEXT, PRIMARY KEY(id));
CREATE TABLE tool_entity (id TEXT NOT NULL UNIQUE, material_id TEXT, machine_id TEXT, tool_geometry_id TEXT,
  tool_cutting_data_id TEXT NOT NULL, PRIMARY KEY(tool_geometry_id, material_id, machine_id));
CREATE TABLE tool_tree_entry (id TEXT NOT NULL UNIQUE, parent_group_id TEXT, sibling_order INTEGER NOT NULL,
  tool_geometry_id TEXT UNIQUE, name TEXT, notes TEXT, expanded INTEGER,
  PRIMARY KEY(id, parent_group_id, sibling_order));
"""

# id, name_format, tool_type, units (1: inches), diameter, included_angle, flat_diameter, num_flutes,
# flute_length, tip_radius, number, name in the tree
VECTRIC = [
    ("a", "{Tool Type} ({Diameter|F} {Units Short})", 1, 1, 0.25, None, None, 2, 0.75, None, 201, ""),
    ("b", "ball", 0, 0, 3.0, None, None, 4, 9.0, None, 111, "Three ball"),
    ("c", "bowl", 2, 0, 12.0, None, None, 2, 20.0, 2.5, 3, ""),
    ("d", "vee", 3, 1, 0.5, 60.0, None, 2, None, None, 302, ""),
    ("e", "engraver", 4, 0, 6.0, 30.0, 0.5, 1, None, None, 5, ""),
    ("f", "tapered", 5, 0, 6.0, 10.0, None, 2, None, 0.5, 6, ""),
    ("g", "drill", 6, 0, 5.0, 118.0, None, 2, 40.0, None, 7, ""),
    ("h", "diamond drag", 8, 0, 5.0, 90.0, None, 1, 0.0, None, 8, ""),
    ("i", "no number", 1, 0, 2.0, None, None, 2, 6.0, None, None, ""),
]


def database(path, tools=VECTRIC, schema=SCHEMA, wal=False):
    with sqlite3.connect(path) as db:
        if wal:
            db.execute("PRAGMA journal_mode=WAL")
        db.executescript(schema)
        db.execute("INSERT INTO material VALUES ('m', 'MDF')")
        db.execute("INSERT INTO machine (id, name) VALUES ('x', 'Router')")
        db.execute("INSERT INTO tool_tree_entry VALUES ('root', NULL, 0, NULL, 'Mine', '', 1)")
        for n, tool in enumerate(tools):
            key, form, kind, units, d, angle, flat, flutes, flute, radius, number, name = tool
            db.execute("INSERT INTO tool_geometry (id, name_format, tool_type, units, diameter, "
                       "included_angle, flat_diameter, num_flutes, flute_length, tip_radius) "
                       "VALUES (?,?,?,?,?,?,?,?,?,?)",
                       (key, form, kind, units, d, angle, flat, flutes, flute, radius))
            db.execute("INSERT INTO tool_cutting_data (id, rate_units, length_units, feed_rate, tool_number) "
                       "VALUES (?, 1, 0, 800, ?)", ("c" + key, number))
            db.execute("INSERT INTO tool_entity VALUES (?, 'm', 'x', ?, ?)", ("e" + key, key, "c" + key))
            db.execute("INSERT INTO tool_tree_entry VALUES (?, 'root', ?, ?, ?, '', NULL)",
                       ("t" + key, n, key, name))
    db.close()


@pytest.mark.parametrize("wal", [False, True])
def test_vectric_database(kerf, tmp_path, wal):
    database(tmp_path / "tools.vtdb", wal=wal)
    run = kerf("tools", "import", "tools.vtdb", "-o", "mine.toml", "--json")
    assert run.status == 0, run.out
    assert sorted(run.json["tools"]) == [1, 3, 5, 6, 7, 111, 201, 302]  # 1: the one without a number
    skipped, = [d for d in run.json["diagnostics"] if d["name"] == "tool_library_shape"]
    assert "diamond drag" in skipped["message"] and "8" in skipped["message"]
    tool = {n: shown(kerf, n, "mine.toml") for n in run.json["tools"]}
    assert {n: (t["shape"], pytest.approx(t["diameter_mm"])) for n, t in tool.items()} == {
        1: ("square", 2), 201: ("square", 6.35), 111: ("ball", 3), 3: ("bull nose", 12), 302: ("V", 12.7),
        5: ("V", 6), 6: ("tapered ball", 6), 7: ("drill", 5)}
    assert tool[201]["description"] == "square (0.25 in)" and tool[111]["description"] == "Three ball"
    assert tool[201]["flute_mm"] == pytest.approx(19.05) and tool[111]["teeth"] == 4
    # The cone of the engraver: 30 degrees in all, from a flat of 0.5 mm.
    (r0, z0), (r1, z1), *rest = [(k[0], k[1]) for k in parts(tool[5])["cutting"] if k[0] > 0][:2]
    assert (r0, z0) == (0.25, 0)
    assert math.degrees(2 * math.atan((r1 - r0) / z1)) == pytest.approx(30, abs=1e-3)


def test_what_kerf_writes_has_vectrics_tables(kerf, program, tmp_path):
    assert export(kerf, "vectric", program(MINE, "mine.toml")).status == 0
    with sqlite3.connect(tmp_path / "t.vtdb") as db:
        assert db.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert db.execute("PRAGMA foreign_key_check").fetchall() == []
        rows = db.execute("SELECT g.name_format, g.tool_type, g.units, g.diameter, g.included_angle, "
                          "d.tool_number FROM tool_entity e "
                          "JOIN tool_geometry g ON g.id = e.tool_geometry_id "
                          "JOIN tool_cutting_data d ON d.id = e.tool_cutting_data_id "
                          "JOIN tool_tree_entry t ON t.tool_geometry_id = g.id "
                          "ORDER BY d.tool_number").fetchall()
    db.close()
    assert rows == [("a, b", 1, 0, 6.35, 0, 7), ("vee", 3, 0, 12, 90, 8)]


def test_the_same_tools_give_the_same_bytes(kerf, program, tmp_path):
    source = program(MINE, "mine.toml")
    for name in ("a.vtdb", "b.vtdb"):
        assert kerf("tools", "export", source, "-o", name).status == 0
    assert (tmp_path / "a.vtdb").read_bytes() == (tmp_path / "b.vtdb").read_bytes()


def test_damaged_and_other_databases(kerf, tmp_path):
    path = tmp_path / "tools.vtdb"
    database(path)
    whole = path.read_bytes()
    broken = {"short": whole[:700], "head": whole[:16] + bytes(200), "empty": b"",
              "noise": whole[:100] + bytes(len(whole) - 100), "text": b"number,type\n1,end\n"}
    other = tmp_path / "other.vtdb"
    with sqlite3.connect(other) as db:
        db.execute("CREATE TABLE tracks (id INTEGER)")
    db.close()
    broken["schema"] = other.read_bytes()
    view = tmp_path / "view.vtdb"
    # A view may compute without end.
    database(view, tools=[], schema=SCHEMA.replace("CREATE TABLE tool_geometry (", "CREATE TABLE geometry ("))
    with sqlite3.connect(view) as db:
        db.execute("CREATE VIEW tool_geometry AS WITH RECURSIVE n(i) AS "
                   "(SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i AS id FROM n")
    db.close()
    broken["view"] = view.read_bytes()
    for name, data in broken.items():
        (tmp_path / "bad.vtdb").write_bytes(data)
        run = kerf("tools", "import", "bad.vtdb", "-o", "mine.toml", "--json")
        assert run.status == 1, (name, run.out)
        assert [d["name"] for d in run.json["diagnostics"]] == ["tool_database_damaged"], (name, run.out)
        assert not (tmp_path / "mine.toml").exists()
    rng = random.Random(5)
    for _ in range(40):  # wrong bytes anywhere
        data = bytearray(whole)
        for _ in range(rng.randint(1, 40)):
            data[rng.randrange(16, len(data))] = rng.randrange(256)
        (tmp_path / "bad.vtdb").write_bytes(bytes(data))
        run = kerf("tools", "import", "bad.vtdb", "--json")
        assert run.status in (0, 1), run.out


# ---- Necks, numbers, counts and names.

NECKS = [
    {"number": 12, "shape": "lollipop", "diameter": 6, "neck_diameter": 3, "neck_length": 10},
    {"number": 13, "shape": "T-slot", "diameter": 12, "thickness": 3, "neck_diameter": 5, "neck_length": 10},
    {"number": 14, "shape": "thread mill", "major_diameter": 12, "minor_diameter": 8, "cut_height": 2,
     "length": 10, "neck_diameter": 7, "neck_length": 15},
    {"number": 15, "shape": "keyhole", "diameter": 9, "head": 3, "neck_diameter": 5, "shank_diameter": 6,
     "shank_length": 20},
    {"number": 16, "shape": "square", "diameter": 6, "flute": 12, "neck_diameter": 5, "neck_length": 10}]


@pytest.mark.parametrize("form", ["kerf", "linuxcnc"])
def test_necks_of_shapes_come_back(kerf, program, form):
    """A neck whose diameter is one of the shape's own sizes."""
    source = program(tool_file(NECKS), "mine.toml")
    assert export(kerf, form, source).status == 0
    back = kerf("tools", "import", FORMS[form]["file"], "-o", "back.toml", "--json")
    assert back.status == 0 and back.json["tools"] == [t["number"] for t in NECKS], back.out
    for tool in NECKS:
        before, after = (shown(kerf, tool["number"], file) for file in (source, "back.toml"))
        assert same(parts(before), parts(after)), tool
        if "neck_length" in tool:
            own = 8 if tool["shape"] == "thread mill" else 0  # mm, between its tooth and its length
            neck = parts(after)["neck"]
            assert neck[-1][1] - neck[0][1] == pytest.approx(tool["neck_length"] + own)


def test_tools_without_a_number_leave_those_that_others_state(kerf, program, tmp_path):
    """The tool without a number comes first in the file; what states a number keeps it."""
    database(tmp_path / "tools.vtdb", tools=[
        ("a", "vee", 3, 0, 12.0, 60.0, None, 2, None, None, 0, ""),
        ("b", "mill", 1, 0, 6.0, None, None, 2, 20.0, None, 1, ""),
        ("c", "ball", 0, 0, 3.0, None, None, 2, 9.0, None, None, ""),
        ("d", "second mill", 1, 0, 8.0, None, None, 2, 20.0, None, 2, "")])
    (tmp_path / "tools.json").write_text(json.dumps({"data": [
        {"type": "chamfer mill", "unit": "millimeters", "description": "vee",
         "geometry": {"DC": 12, "TA": 30, "NOF": 2}},
        {"type": "flat end mill", "unit": "millimeters", "description": "mill",
         "post-process": {"number": 1}, "geometry": {"DC": 6, "LCF": 20, "NOF": 2}},
        {"type": "ball end mill", "unit": "millimeters", "description": "ball",
         "post-process": {"number": 1}, "geometry": {"DC": 3, "LCF": 9, "NOF": 2}},
        {"type": "flat end mill", "unit": "millimeters", "description": "second mill",
         "post-process": {"number": 2}, "geometry": {"DC": 8, "LCF": 20, "NOF": 2}}]}))
    header = "number,name,type,diameter,angle,flutelength,metric\n"
    (tmp_path / "tools.csv").write_text(
        header + ",vee,vee,12,60,,1\n1,mill,end,6,,20,1\n1,ball,ball,3,,9,1\n2,second mill,end,8,,20,1\n")
    (tmp_path / "tool.tbl").write_text(
        "T1 P2 D6 ;mill\nP1 D12 ;vee 60 deg\nT1 P3 D3 ;ball\nT2 P4 D8 ;second mill\n")
    (tmp_path / "camotics.json").write_text(json.dumps({"units": "metric", "tools": {
        "": {"shape": "conical", "length": 10, "diameter": 12, "description": "vee"},
        "1": {"shape": "cylindrical", "length": 20, "diameter": 6, "description": "mill"},
        "2": {"shape": "cylindrical", "length": 20, "diameter": 8, "description": "second mill"}}}))
    for name in ("tools.vtdb", "tools.json", "tools.csv", "tool.tbl", "camotics.json"):
        run = kerf("tools", "import", name, "-o", "mine.toml", "--json")
        assert run.status == 0, run.out
        numbers = {n: shown(kerf, n, "mine.toml")["diameter_mm"] for n in run.json["tools"]}
        expected = {1: 6, 2: 8, 3: 12} | ({} if name.startswith("camotics") else {4: 3})
        assert numbers == {n: pytest.approx(d) for n, d in expected.items()}, name
        notes = [d["message"] for d in run.json["diagnostics"] if d["name"] == "tool_library_number"]
        assert len(notes) == len(expected) - 2 and "no number; it becomes 3" in notes[0], notes


def test_tool_0_has_no_number_in_a_database(kerf, program):
    source = program(tool_file([{"number": 0, "shape": "V", "diameter": 12, "angle": 60},
                                {"number": 1, "shape": "square", "diameter": 6, "flute": 20}]), "mine.toml")
    warning, = lost(export(kerf, "vectric", source))
    assert "without the number (tool 0)" in warning["message"]
    assert kerf("tools", "import", "t.vtdb", "-o", "back.toml", "--json").json["tools"] == [1, 2]
    assert [shown(kerf, n, "back.toml")["shape"] for n in (1, 2)] == ["square", "V"]


@pytest.mark.parametrize("form", FORMS)
def test_the_tools_that_are_written_are_counted(kerf, program, form):
    rng = random.Random(7)
    source = program(tool_file([random_tool(rng, 1 + i, shape, []) for i, shape in enumerate(SHAPES)]),
                     "mine.toml")
    file = FORMS[form]["file"]
    numbers = export(kerf, form, source).json["tools"]
    assert kerf("tools", "import", file, "--json").json["tools"] == numbers
    assert len(numbers) == len(SHAPES) if form in ("kerf", "linuxcnc") else 0 < len(numbers) < len(SHAPES)
    run = kerf("tools", "export", source, "--to", form, "-o", file)
    assert f"{file}: {len(numbers)} tools" in run.out + run.err
    one = program(tool_file([{"number": 3, "shape": "square", "diameter": 6}]), "one.toml")
    run = kerf("tools", "export", one, "--to", form, "-o", file)
    assert f"{file}: 1 tool\n" in run.out + run.err


@pytest.mark.parametrize("form", [form for form in FORMS if form not in ("kerf", "linuxcnc")])
def test_a_tool_without_a_description_has_a_name_in_other_programs(kerf, program, files, tmp_path, form):
    shapes = sorted(FORMS[form]["shapes"])
    rng = random.Random(form)
    tools = [random_tool(rng, 5 + i, shape, []) for i, shape in enumerate(shapes)]
    for tool in tools:
        tool.pop("description")
        if form == "carbide":
            tool.pop("tip_diameter", None) if tool["shape"] == "V" else None
    source = program(tool_file(tools), "mine.toml")
    run = export(kerf, form, source)
    assert run.status == 0, run.out
    written = run.json["tools"]
    names = names_in(form, tmp_path)
    for tool in tools:
        if tool["number"] not in written:
            continue
        diameter = shown(kerf, tool["number"], source)["diameter_mm"]
        assert names[tool["number"]] == f"{tool['shape']} {round(diameter, 3):g} mm"
    back = kerf("tools", "import", FORMS[form]["file"], "-o", "back.toml", "--json")
    assert back.json["tools"] == written
    for number in written:
        assert not shown(kerf, number, "back.toml").get("description"), number


def names_in(form, path):
    file = path / FORMS[form]["file"]
    if form == "carbide":
        return {int(row["number"]): row["name"] for row in csv.DictReader(io.StringIO(file.read_text()))}
    if form == "fusion":
        return {t["post-process"]["number"]: t["description"] for t in json.loads(file.read_text())["data"]}
    if form == "camotics":
        return {int(n): t["description"] for n, t in json.loads(file.read_text())["tools"].items()}
    if form == "freecad":
        return {t["nr"]: json.loads((path / t["path"]).read_text())["name"]
                for t in json.loads(file.read_text())["tools"]}
    with sqlite3.connect(file) as db:
        rows = db.execute("SELECT d.tool_number, g.name_format FROM tool_entity e "
                          "JOIN tool_geometry g ON g.id = e.tool_geometry_id "
                          "JOIN tool_cutting_data d ON d.id = e.tool_cutting_data_id").fetchall()
    db.close()
    return dict(rows)


# ---- What imports read since then.

def test_fusions_stick_out_neck_holder_and_tapered_mill(kerf, program):
    library = {"data": [
        {"type": "flat end mill", "unit": "inches", "description": "q", "post-process": {"number": 1},
         "geometry": {"DC": 0.25, "LCF": 0.5, "NOF": 2, "SFDM": 0.25, "LB": 1.5, "shoulder-length": 0.75,
                      "shoulder-diameter": 0.2},
         "holder": {"unit": "millimeters", "segments": [
             {"height": 10, "lower-diameter": 20, "upper-diameter": 30},
             {"height": 5, "lower-diameter": 30, "upper-diameter": 30}]}},
        {"type": "tapered mill", "unit": "millimeters", "description": "t", "post-process": {"number": 2},
         "geometry": {"DC": 1, "RE": 0.5, "TA": 5, "LCF": 20, "NOF": 2, "SFDM": 6, "LB": 30}}]}
    assert kerf("tools", "import", program(json.dumps(library), "f.json"), "-o", "mine.toml").status == 0
    one = parts(shown(kerf, 1, "mine.toml"))
    z = {part: (knots[0][1], knots[-1][1], max(k[0] for k in knots)) for part, knots in one.items() if knots}
    assert z["neck"] == pytest.approx((12.7, 19.05, 2.54))
    assert z["shank"] == pytest.approx((19.05, 38.1, 3.175))
    assert z["holder"] == pytest.approx((38.1, 53.1, 15))
    two = shown(kerf, 2, "mine.toml")
    # A ball of radius 0.5 on a cone of 5 degrees: they touch at the radius 0.5 cos 5, the height
    # 0.5 (1 - sin 5).
    a = math.radians(5)
    end = 0.5 * math.cos(a) + (20 - 0.5 * (1 - math.sin(a))) * math.tan(a)
    assert two["shape"] == "tapered ball" and two["diameter_mm"] == pytest.approx(2 * end, abs=1e-4)


def test_freecads_flat_radius_is_that_of_the_flat(kerf, program):
    """BIT_ATTRIBUTES.md of FreeCAD: "Radius of the bottom flat part"."""
    bit = {"version": 2, "name": "b", "shape": "bullnose.fcstd", "parameter": {
        "Diameter": "5.0 mm", "FlatRadius": "1.5 mm", "CuttingEdgeHeight": "40 mm", "Length": "50 mm",
        "ShankDiameter": "3 mm"}}
    assert kerf("tools", "import", program(json.dumps(bit), "b.fctb"), "-o", "mine.toml").status == 0
    tool = shown(kerf, 1, "mine.toml")
    assert [k[:2] for k in parts(tool)["cutting"]][:3] == [[0, 0], [1.5, 0], [2.5, 1]]
    shank = parts(tool)["shank"]
    assert shank[-1][1] == pytest.approx(50)


def test_another_tool_of_a_taken_number_gets_the_next_one(kerf, program):
    """Two libraries with a tool 1 each: both are kept. The same tool in two files is one."""
    for name, shape in (("a", "square"), ("b", "ball")):
        program(f'[[tool]]\nnumber = 1\nshape = "{shape}"\ndiameter = 6\n', f"{name}.toml")
    for name in "ab":
        assert kerf("tools", "export", f"{name}.toml", "--to", "fusion", "-o", f"{name}.json").status == 0
    for words in (["export", "a.toml", "b.toml", "a.toml"], ["import", "a.json", "b.json", "a.json"]):
        run = kerf("tools", *words)
        tools = tomllib.loads(run.out)["tool"]
        assert [(tool["number"], tool["shape"]) for tool in tools] == [(1, "square"), (2, "ball")]
        assert run.err.count("this one becomes 2") == 1, run.err

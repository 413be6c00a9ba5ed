"""Setup sheets: what they state against `kerf info --json`, the drawing against the job's own sizes, hostile
texts, and what has no sheet."""
import html.parser
import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

JOBS = Path(__file__).parents[2] / "examples" / "jobs"
SVG = "{http://www.w3.org/2000/svg}"
VOID = {"meta", "link", "br", "img", "input", "hr"}


class Page(html.parser.HTMLParser):
    """The tables of a page by their ids, as rows of texts; elements must close in order."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.tables, self.open, self.tags, self.text = {}, [], set(), ""
        self.rows = self.cell = None
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.add(tag)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.rows = self.tables[attributes["id"]] = []
        elif tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.cell = ""

    def handle_startendtag(self, tag, attributes):
        self.tags.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag
        if tag in ("td", "th"):
            self.rows[-1].append(self.cell)
            self.cell = None

    def handle_data(self, data):
        self.text += data
        if self.cell is not None:
            self.cell += data


def page_of(path):
    text = Path(path).read_text(encoding="utf-8")
    assert not re.search(r'(src|href)\s*=', text)  # one file, nothing else is loaded
    return Page(text)


def rows(page, table):
    head, *rest = page.tables[table]
    return [dict(zip(head, row)) for row in rest if len(row) == len(head)]


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", text)]


def seconds(clock):
    total = 0
    for part in clock.split(":"):
        total = 60 * total + int(part)
    return total


@pytest.mark.parametrize("name", ("sign", "pcb", "relief", "inlay", "box"))
def test_the_sheet_of_a_job_states_what_info_states(kerf, tmp_path, name):
    made = kerf("cut", JOBS / f"{name}.toml", "-o", "sheet.html")
    assert made.status == 0, made.err
    info = kerf("info", "--json", JOBS / f"{name}.toml").json
    page = page_of(tmp_path / "sheet.html")
    facts = dict(page.tables["facts"])
    assert numbers(facts["Stock"]) == pytest.approx(info["stock"]["size_mm"], abs=1e-3)
    low, high = info["motion"]["cut_extent_mm"]
    assert numbers(facts["Cuts"]) == pytest.approx([v for pair in zip(low, high) for v in pair], abs=1e-3)
    clock = re.search(r"about ([\d:]+)", facts["Time"])[1]
    assert seconds(clock) == pytest.approx(info["time_s"]["total"], abs=0.51)
    shown = {row["Tool"]: row for row in rows(page, "tools")}
    assert list(shown) == [f"T{tool['number']}" for tool in info["tools"] if tool["number"] is not None]
    top = info["stock"]["block_mm"][1][2]
    for tool in info["tools"]:
        row = shown[f"T{tool['number']}"]
        assert row["Shape"] == tool["shape"]
        assert float(row["Diameter"]) == pytest.approx(tool["diameter_mm"], abs=1e-3)
        assert numbers(row["Flute length"])[0] == pytest.approx(tool["flute_mm"], abs=1e-3)
        assert float(row["Deepest Z"]) == pytest.approx(tool["deepest_mm"], abs=1e-3)
        assert float(row["Stick-out, at least"]) == pytest.approx(top - tool["deepest_mm"], abs=1e-3)
        assert numbers(row["Feed"])[0] == pytest.approx(tool["feeds"]["min"], abs=0.06)
        assert numbers(row["Spindle rpm"])[-1] == pytest.approx(tool["speeds"]["max"], abs=0.6)
    times = {f"T{tool['number']}": tool["total"] for tool in info["time_s"]["tools"]}
    for number, row in shown.items():
        assert seconds(row["Time"]) == pytest.approx(times[number], abs=0.51)
    # The operations take the time of the whole, and reach as deep as the tools.
    operations = rows(page, "operations")
    assert sum(seconds(row["Time"]) for row in operations) == pytest.approx(
        info["time_s"]["total"], abs=0.6 * len(operations) + 2)
    deepest = min(float(row["Z to"]) for row in operations if row["Z to"] != "no cut")
    assert deepest == pytest.approx(min(tool["deepest_mm"] for tool in info["tools"]), abs=1e-3)
    assert int(facts["Tool changes"]) == sum(len(row) == 1 for row in page.tables["operations"])


def test_operations_are_in_the_order_of_the_program(kerf, tmp_path):
    assert kerf("cut", JOBS / "sign.toml", "-o", "sheet.html").status == 0
    assert kerf("cut", JOBS / "sign.toml", "--to", "linuxcnc", "-o", "sign.ngc").status == 0
    names = [row["Operation"] for row in rows(page_of(tmp_path / "sheet.html"), "operations")]
    program = (tmp_path / "sign.ngc").read_text()
    at = [program.index(f"({name})") for name in names]
    assert at == sorted(at) and len(names) > 1


def test_times_are_planned_for_a_machine(kerf, tmp_path):
    for command in (("cut", JOBS / "sign.toml"), ("simulate", JOBS / "sign.toml")):
        made = kerf(*command, "--machine", "grbl_router", "-o", "sheet.html")
        assert made.status == 0, made.err
        info = kerf("info", "--json", JOBS / "sign.toml", "--machine", "grbl_router").json
        facts = dict(page_of(tmp_path / "sheet.html").tables["facts"])
        assert info["time_s"]["machine"] in facts["Time"]
        assert seconds(re.search(r"about ([\d:]+)", facts["Time"])[1]) == pytest.approx(
            info["time_s"]["total"], abs=0.51)


def outline_of_stock(svg):
    """Width and height of the stock on paper, and where the zero is on it."""
    layers = {group.findtext(f"{SVG}title"): group for group in svg.iter(f"{SVG}g")}
    points = [tuple(map(float, p.split(","))) for p in
              re.findall(r"-?[\d.]+,-?[\d.]+", layers["stock"].find(f"{SVG}path").get("d"))]
    xs, ys = zip(*points)
    zero = layers["zero"].find(f"{SVG}circle")
    return (min(xs), max(xs)), (min(ys), max(ys)), (float(zero.get("cx")), float(zero.get("cy")))


@pytest.mark.parametrize("corner,at", [("lower-left", (0, 0)), ("centre", (0.5, 0.5)), ("top-right", (1, 1))])
def test_the_drawing_has_the_zero_where_it_is_on_the_stock(kerf, tmp_path, program, corner, at):
    part = program("G21 G90\nM3 S1000\nT102 M6\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG1 X2 Y2\nG0 Z5\nM2\n")
    for name in ("sheet.svg", "sheet.html"):
        made = kerf("simulate", part, "--stock", f"80x40x10 at {corner} top", "-o", name)
        assert made.status == 0, made.err
    drawing = ET.parse(tmp_path / "sheet.svg").getroot()
    xs, ys, zero = outline_of_stock(drawing)
    assert (xs[1] - xs[0]) / (ys[1] - ys[0]) == pytest.approx(2, abs=1e-3)
    part_x, part_y = (zero[0] - xs[0]) / (xs[1] - xs[0]), (ys[1] - zero[1]) / (ys[1] - ys[0])
    assert (part_x, part_y) == pytest.approx(at, abs=1e-3)
    texts = [t.text for t in drawing.iter(f"{SVG}text")]
    assert "80" in texts and "40" in texts  # the dimensions
    assert "T102" in texts
    width = float(drawing.get("width").removesuffix("mm"))
    assert drawing.get("width").endswith("mm") and 150 < width < 210
    facts = dict(page_of(tmp_path / "sheet.html").tables["facts"])
    words = {"lower-left": ("left", "front"), "centre": ("centre", "centre"), "top-right": ("right", "back")}
    x, y, z = facts["Work zero"].split(";")
    assert words[corner][0] in x and words[corner][1] in y and "top of the stock" in z


def test_fixtures_and_findings_are_listed(kerf, tmp_path, program):
    part = program("G21 G90\nT102 M6\nM3 S1000\nG0 X-5 Y5 Z5\nG1 Z-1 F100\nG0 X30 Y5\nG0 Z5\nM2\n")
    fixture = "-20,0,-10 to -10,20,5"
    made = kerf("simulate", part, "--stock", "40x20x10", "--fixture", fixture, "-o", "sheet.html")
    assert made.status == 0, made.err
    page = page_of(tmp_path / "sheet.html")
    fixture, = rows(page, "fixtures")
    assert numbers(fixture["Position"]) == [-20, -10, 0, 20, -10, 5]
    check = kerf("check", "--json", part, "--stock", "40x20x10")
    kinds = [row["Kind"] for row in rows(page, "findings")]
    assert check.status != 0 and check.json["hazards"] and "hazard" in kinds


def test_texts_of_users_are_no_markup(kerf, tmp_path, program):
    name = '<b>&"\'</b>'
    text = f"G21 G90\nT102 M6\nM3 S1000\n(MSG,{name})\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG1 X9\nG0 Z5\n"
    # Latin-1 and a control character, as older programs have them.
    part = program(text.encode() + b"(MSG,Fl\xe4che\x01)\nG0 X1 Y1\nG1 Z-1 F100\nG1 X5\nG0 Z5\nM2\n",
                   "a&b<i>.nc")
    for out in ("sheet.html", "sheet.svg"):
        made = kerf("post", part, "--to", "sheet", "-o", out)
        assert made.status == 0, made.err
    page = page_of(tmp_path / "sheet.html")
    assert page.tags.isdisjoint({"b", "i", "script"})
    assert name in [row["Operation"] for row in rows(page, "operations")]
    drawing = ET.parse(tmp_path / "sheet.svg").getroot()
    assert any(name in (t.text or "") for t in drawing.iter(f"{SVG}text"))
    assert "a&b<i>.nc" in page.text


def test_inches(kerf, tmp_path, program):
    part = program("G20 G90\nT102 M6\nM3 S1000\nG0 X0.5 Y0.5 Z0.2\nG1 Z-0.1 F10\nG1 X1\nG0 Z0.2\nM2\n")
    assert kerf("simulate", part, "--stock", "50.8x25.4x12.7", "-o", "sheet.html").status == 0
    page = page_of(tmp_path / "sheet.html")
    facts = dict(page.tables["facts"])
    assert facts["Stock"] == "2 x 1 x 0.5 in" and facts["Units"].startswith("inches")
    tool, = rows(page, "tools")
    assert float(tool["Diameter"]) == 0.125 and float(tool["Stick-out, at least"]) == 0.1
    assert numbers(tool["Feed"]) == [10]


def test_what_is_not_known_is_no_number(kerf, tmp_path, program):
    part = program("G21 G90\nT7 M6\nM3 S1000\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG1 X9\nG0 Z5\nM2\n")
    assert kerf("post", part, "-o", "sheet.html").status == 0
    tool, = rows(page_of(tmp_path / "sheet.html"), "tools")
    for column in ("Shape", "Diameter", "Flutes", "Flute length", "Stick-out, at least"):
        assert not numbers(tool[column]), (column, tool[column])


def test_a_print_has_no_sheet(kerf, files, program):
    text = "G21 G90 M83\nM104 S200\nG28\nG1 Z0.2 F3000\nG1 X50 Y10 E2 F1200\nG1 X50 Y50 E2\nG1 X10 Y50 E2\n"
    part = program(text, "print.gcode")
    before = set(files())
    for command in (("post", part), ("simulate", part)):
        made = kerf(*command, "-o", "sheet.html")
        assert made.status == 1 and "prints" in made.err
        assert set(files()) == before


def test_an_svg_of_post_is_asked_for_by_name(kerf, program):
    made = kerf("post", program(), "-o", "part.svg")
    assert made.status == 2 and "--to svg" in made.err and "--to sheet" in made.err
    assert kerf("post", program(), "--to", "svg", "-o", "part.svg").status == 0
    listed = [entry["name"] for entry in json.loads(kerf("post", "--list", "--json").out)]
    assert {"sheet", "svg"} <= set(listed)

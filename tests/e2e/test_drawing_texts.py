"""Texts of drawings as outlines. DejaVu Sans has 2048 units per em; its H is 1493 high, from 201 to 1339 of
an advance of 1540 (its tables glyf and hmtx). Positions are those of the DXF reference, TEXT and MTEXT."""
import math
from pathlib import Path

import pytest
from test_outline_drawing import drawing, line, tags

FONTS = Path("/usr/share/fonts/truetype/dejavu")
FONT = FONTS / "DejaVuSans.ttf"
needs_font = pytest.mark.skipif(not FONT.exists(), reason="DejaVu fonts are not installed")
HEIGHT = 14.93  # mm: a hundredth of a millimetre is a unit of the font
LEFT, RIGHT, ADVANCE = 2.01, 13.39, 15.40
STYLE = tags((0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "STYLE"), (0, "STYLE"), (2, "LETTERS"), (70, 0),
             (40, 0), (41, 1), (3, "DejaVuSans.ttf"), (0, "STYLE"), (2, "ABSENT"), (70, 0), (40, 0), (41, 1),
             (3, "nowhere.ttf"), (0, "ENDTAB"), (0, "ENDSEC"))


def text(value, *rows, kind="TEXT", style="LETTERS", height=HEIGHT):
    return tags((0, kind), (5, "2F"), (8, "CUT"), (10, 10), (20, 20), (40, height), (1, value), (7, style),
                *rows)


@pytest.fixture
def boxes(kerf, tmp_path):
    """The boxes of the outlines of a drawing, and the run."""
    def run(*entities, options=()):
        (tmp_path / "part.dxf").write_text(STYLE + drawing(*entities))
        done = kerf("outline", "part.dxf", "--json", "--tolerance", "0.0001", *options)
        found = []
        for outline in done.json.get("outlines", []):
            points = [outline["first"]["at"]] + [s["to"] for s in outline["segments"]]
            xs, ys = zip(*points)
            found.append((min(xs), min(ys), max(xs), max(ys)))
        return found, done
    return run


UP = 20 + HEIGHT
FIT = 30 / ADVANCE
POSITIONS = [
    ((), (10 + LEFT, 20, 10 + RIGHT, UP)),
    (((72, 2), (11, 10), (21, 20)), (10 + LEFT - ADVANCE, 20, 10 + RIGHT - ADVANCE, UP)),
    (((72, 1), (11, 10), (21, 20)), (10 + LEFT - ADVANCE / 2, 20, 10 + RIGHT - ADVANCE / 2, UP)),
    (((72, 4), (11, 10), (21, 20)),
     (10 + LEFT - ADVANCE / 2, 20 - HEIGHT / 2, 10 + RIGHT - ADVANCE / 2, 20 + HEIGHT / 2)),
    (((73, 3), (11, 10), (21, 20)), (10 + LEFT, 20 - HEIGHT, 10 + RIGHT, 20)),
    (((50, 90),), (10 - HEIGHT, 20 + LEFT, 10, 20 + RIGHT)),
    (((41, 2),), (10 + 2 * LEFT, 20, 10 + 2 * RIGHT, UP)),
    (((51, 45),), (10 + LEFT, 20, 10 + RIGHT + HEIGHT, UP)),
    (((72, 5), (11, 40), (21, 20)), (10 + FIT * LEFT, 20, 10 + FIT * RIGHT, UP)),
    (((72, 3), (11, 40), (21, 20)), (10 + FIT * LEFT, 20, 10 + FIT * RIGHT, 20 + FIT * HEIGHT)),
    (((72, 3), (11, 10), (21, 50)), (10 - FIT * HEIGHT, 20 + FIT * LEFT, 10, 20 + FIT * RIGHT)),
    (((71, 2),), (10 - RIGHT, 20, 10 - LEFT, UP)),
    (((71, 4),), (10 + LEFT, 20 - HEIGHT, 10 + RIGHT, 20)),
    (((210, 0), (220, 0), (230, -1)), (-10 - RIGHT, 20, -10 - LEFT, UP)),
]


@needs_font
@pytest.mark.parametrize("rows, box", POSITIONS)
def test_a_text_is_where_the_dxf_reference_states(boxes, rows, box):
    (found,), run = boxes(text("H", *rows))
    assert found == pytest.approx(box, abs=2e-4)
    note = next(d for d in run.json["diagnostics"] if d["name"] == "drawing_text")
    assert note["severity"] == "note" and "DejaVuSans.ttf" in note["message"]
    assert run.json["outlines"][0]["layer"] == "CUT" and run.json["outlines"][0]["closed"]


LINES = 5 / 3 * HEIGHT  # of MTEXT


@needs_font
@pytest.mark.parametrize("attached", range(1, 10))
def test_an_mtext_is_attached_at_nine_points(boxes, attached):
    found, _ = boxes(text("H\\PH", (71, attached), kind="MTEXT"))
    x = 10 - (attached - 1) % 3 * ADVANCE / 2
    top = 20 + (0, (LINES + HEIGHT) / 2, LINES + HEIGHT)[(attached - 1) // 3]
    want = [(x + LEFT, top - k * LINES - HEIGHT, x + RIGHT, top - k * LINES) for k in range(2)]
    assert len(found) == 2
    for one, box in zip(found, want):
        assert one == pytest.approx(box, abs=2e-4)


@needs_font
def test_an_mtext_is_wrapped_turned_and_spaced(boxes):
    """Two words do not fit in one line of 20 mm; group 11 is the direction of the lines, here up."""
    found, _ = boxes(text("{\\fArial|b0;H} H", (71, 1), (41, 20), (44, 2), (11, 0), (21, 1), kind="MTEXT"))
    assert found[0] == pytest.approx((10, 20 + LEFT, 10 + HEIGHT, 20 + RIGHT), abs=2e-4)
    x = 10 + 2 * LINES
    assert found[1] == pytest.approx((x, 20 + LEFT, x + HEIGHT, 20 + RIGHT), abs=2e-4)


@needs_font
def test_letters_are_areas_with_their_holes(boxes):
    """An O is its outer edge without its inner one: the area is that of the region."""
    _, run = boxes(text("O"), options=("--region",))
    assert len(run.json["outlines"]) == 2
    assert len(run.json["region"]["outlines"]) == 2
    _, both = boxes(text("H"), line(0, 0, 5, 0), options=("--region",))
    assert both.status == 0 and len(both.json["region"]["outlines"]) == 1


def test_strokes_of_the_built_in_font(boxes):
    """A text without an outline font is drawn in single strokes as high as the text; none are joined."""
    found, run = boxes(text("HI", style="STANDARD", height=10))
    assert run.status == 0 and len(found) == 4
    assert min(b[1] for b in found) == pytest.approx(20) and max(b[3] for b in found) == pytest.approx(30)
    assert "drawing_open_end" not in run.codes()
    assert all(not o["closed"] for o in run.json["outlines"])
    found, run = boxes(text("HI", style="ABSENT", height=10))
    (message,) = [d for d in run.json["diagnostics"] if d["name"] == "drawing_text"]
    assert len(found) == 4 and message["severity"] == "warning" and "nowhere.ttf" in message["message"]
    origin = message["origin"]
    assert origin["handle"] == "2F" and origin["layer"] == "CUT"
    assert origin["at"] == [10, 20]


def test_attributes_are_drawn_unless_they_are_invisible(boxes):
    """Group 70 of an ATTRIB: 1 is invisible."""
    attribute = [text("HI", (2, "TAG"), (70, flags), kind="ATTRIB", style="STANDARD") for flags in (0, 1)]
    assert len(boxes(attribute[0])[0]) == 4
    found, run = boxes(line(0, 0, 5, 0), attribute[1])
    assert len(found) == 1 and "drawing_hidden" in run.codes()


def test_texts_can_be_left_out_or_drawn_in_another_font(boxes):
    square = [line(0, 0, 5, 0), line(5, 0, 5, 5), line(5, 5, 0, 5), line(0, 5, 0, 0)]
    found, run = boxes(*square, text("HI"), options=("--texts", "none"))
    assert len(found) == 1
    message = next(d for d in run.json["diagnostics"] if d["name"] == "drawing_ignored")
    origin = message["origin"]
    assert message["message"] == "1 TEXT is not read as an outline: TEXT 2F on layer CUT" and origin["line"]
    found, run = boxes(*square, text("HI"), options=("--texts", "sans", "--region"))
    assert len(found) == 5 and run.status == 0
    (open_one,) = [d for d in run.json["diagnostics"] if d["name"] == "region_open_outline"]
    assert "single strokes" in open_one["message"]
    _, wrong = boxes(*square, options=("--texts", "sanss"))
    assert wrong.status == 1 and "did you mean sans" in wrong.out + wrong.err
    _, absent = boxes(*square, options=("--texts", "absent.ttf"))
    assert absent.status == 1 and "absent.ttf" in absent.out + absent.err


@needs_font
def test_a_font_file_for_all_texts(boxes):
    (found,), _ = boxes(text("H", style="STANDARD"), options=("--texts", FONT))
    assert found == pytest.approx((10 + LEFT, 20, 10 + RIGHT, UP), abs=2e-4)


SVG = ('<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">\n'
       '<rect width="5" height="5"/>\n{}</svg>\n')


@pytest.mark.parametrize("body, words, line_of", [
    ('<text x="9" y="9" font-family="Nothing">a</text>', 'the font "Nothing" is not installed', 3),
    ('\n <text x="9" y="9">\u0628</text>', "U+0628", 4),
    ('<text x="9" y="9" font-family="Nothing, Nowhere">a</text>', "Nothing, Nowhere", 3),
])
def test_a_text_that_is_not_drawn_is_named(kerf, program, body, words, line_of):
    run = kerf("outline", program(SVG.format(body), "a.svg"), "--json", env={"KERF_FONTS": str(FONTS)})
    assert run.status == 0 and len(run.json["outlines"]) == 1
    (message,) = [d for d in run.json["diagnostics"] if d["name"] == "drawing_text"]
    assert words in message["message"] and message["severity"] == "warning"
    assert message["origin"]["line"] == line_of and message["origin"]["column"] == (2 if line_of == 4 else 1)


@needs_font
def test_usual_fonts_stand_in_and_are_named(kerf, program):
    art = program(SVG.format('<text x="9" y="40" font-size="20" font-family="sans-serif">H</text>'), "a.svg")
    run = kerf("outline", art, "--json", env={"KERF_FONTS": str(FONTS)})
    (message,) = [d for d in run.json["diagnostics"] if d["name"] == "drawing_text"]
    assert message["severity"] == "warning" and "DejaVu Sans" in message["message"]
    assert 'instead of "sans-serif"' in message["message"]
    xs = [s["to"][0] for s in run.json["outlines"][1]["segments"]]
    assert max(xs) == pytest.approx(9 + 20 * 1339 / 2048, abs=1e-3)


@needs_font
def test_an_installed_font_for_all_texts(boxes):
    (found,), _ = boxes(text("H", style="STANDARD"), options=("--texts", "DejaVu Sans"))
    assert found == pytest.approx((10 + LEFT, 20, 10 + RIGHT, UP), abs=2e-4)
    _, wrong = boxes(text("H"), options=("--texts", "DejaVu Sans:wide"))
    assert wrong.status == 1 and 'has no style \\"wide\\"' in wrong.out + wrong.err


@needs_font
@pytest.mark.parametrize("families, weight, style, file", [
    ("Nothing, 'DejaVu Serif', serif", "bold", "normal", "DejaVuSerif-Bold.ttf"),
    ("DejaVu Sans", "700", "italic", "DejaVuSans-BoldOblique.ttf"),
    ("DejaVu Sans Mono", "normal", "oblique", "DejaVuSansMono-Oblique.ttf")])
@pytest.mark.parametrize("folders", [{}, {"KERF_FONTS": str(FONTS)}], ids=["fontconfig", "folders"])
def test_svg_chooses_family_weight_and_style(kerf, program, families, weight, style, file, folders):
    body = (f'<text x="9" y="40" font-size="20" font-family="{families}" font-weight="{weight}" '
            f'font-style="{style}">H</text>')
    run = kerf("outline", program(SVG.format(body), "a.svg"), "--json", env=folders)
    (message,) = [d for d in run.json["diagnostics"] if d["name"] == "drawing_text"]
    assert file in message["message"] and message["severity"] == "note"


@needs_font
def test_near_families_are_named_for_a_text_of_svg(kerf, program):
    body = '<text x="9" y="40" font-size="20" font-family="DejaVu Snas, Nothing">H</text>'
    run = kerf("outline", program(SVG.format(body), "a.svg"), "--json")
    (message,) = [d for d in run.json["diagnostics"] if d["name"] == "drawing_text"]
    assert "near: DejaVu Sans" in message["message"] and len(run.json["outlines"]) == 1


def test_a_job_engraves_the_texts_of_its_drawing(kerf, tmp_path):
    (tmp_path / "part.dxf").write_text(drawing(text("I", style="STANDARD", height=10)))
    (tmp_path / "job.toml").write_text('art = "part.dxf"\ntexts = "serif"\n[tools]\n1 = "V d=6 angle=60"\n'
                                       '[[operation]]\nop = "engrave"\ntool = 1\ndepth = 0.4\nfeed = 600\n'
                                       'rpm = 9000\n')
    run = kerf("cut", "job.toml", "-o", "part.nc")
    assert run.status == 0, run.err
    (low, high) = kerf("info", "part.nc", "--json").json["motion"]["cut_bounds_mm"]
    assert high[1] - low[1] == pytest.approx(10) and math.isclose(low[1], 20, abs_tol=1e-6)

"""kerf cut: texts in single strokes and of font files, and rest machining with a second tool."""
import json
import math
import re
from pathlib import Path

import pytest

ENGRAVE = ["--op", "engrave", "--tool", "V d=6 angle=60", "--depth", "0.4", "--feed", "600"]
FONT = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")


def positions(text):
    """The positions of all motions of a program for GRBL in the plane."""
    x = y = 0.0
    for line in text.splitlines():
        words = dict(re.findall(r"([XYZ])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line)))
        x, y = float(words.get("X", x)), float(words.get("Y", y))
        if {"X", "Y"} & words.keys():
            yield x, y


def test_a_word_in_single_strokes(kerf, tmp_path):
    run = kerf("cut", *ENGRAVE, "--text", "HI", "--height", "10", "--at", "20,30", "-o", "part.nc")
    assert run.status == 0, run.err
    points = list(positions((tmp_path / "part.nc").read_text()))
    assert min(y for _, y in points) == pytest.approx(30)
    assert max(y for _, y in points) == pytest.approx(40)
    assert min(x for x, _ in points) > 20


def test_a_text_in_a_job_file(kerf, tmp_path):
    (tmp_path / "job.toml").write_text('''
[tools]
1 = "V d=6 angle=60"
[[shape]]
text = "KERF"
font = "serif"
height = 8
at = [5, 5]
align = "centre"
text-angle = 90
[[operation]]
op = "engrave"
tool = 1
depth = 0.3
feed = 600
rpm = 9000
''')
    run = kerf("info", "--json", "job.toml")
    assert run.status == 0, run.err + run.out
    checked = kerf("check", "job.toml")
    assert checked.status == 0, checked.out + checked.err


@pytest.mark.skipif(not FONT.exists(), reason="DejaVu fonts are not installed")
def test_a_word_of_a_font_file_is_carved(kerf, tmp_path):
    run = kerf("cut", "--op", "vcarve", "--tool", "V d=20 angle=90", "--feed", "600", "--text", "HO",
               "--height", "20", "--font", FONT, "-o", "part.nc")
    assert run.status == 0, run.err
    # H: stems of 201 of 1493 units (the height of a capital), so half of it deep; a pocket keeps its volume.
    stem = 201 / 1493 * 20
    lowest = min(float(z) for z in re.findall(r"Z(-?[\d.]+)", (tmp_path / "part.nc").read_text()))
    assert -0.75 * stem < lowest < -0.49 * stem
    stock = ("--stock", "-5,-5,-10 to 60,30,0")
    done = kerf("simulate", "--json", "part.nc", "--tool", "V d=20 angle=90", *stock)
    assert done.status == 0 and done.json["hazards"] == []
    run = kerf("cut", "--op", "pocket", "--tool", "square d=0.5", "--depth", "1", "--feed", "600",
               "--text", "H", "--height", "20", "--font", FONT, "-o", "flat.nc")
    assert run.status == 0, run.err
    done = kerf("simulate", "--json", "flat.nc", "--tool", "square d=0.5", *stock, "--resolution", "0.05")
    width, bar = 1100 / 1493 * 20, 170 / 1493 * 20  # of the H, from its points in the font
    area = 2 * stem * 20 + (width - 2 * stem) * bar
    assert done.json["removed_mm3"] == pytest.approx(area, rel=0.03)


@pytest.mark.parametrize("change, status, message", [
    (["--text", "A"], 2, "a height above 0 mm is required"),
    (["--height", "10"], 2, "is given"),
    (["--text", "A", "--height", "0"], 2, "a height above 0 mm is required"),
    (["--text", "A", "--height", "10", "--font", "gothic"], 1, 'there is no font \\"gothic\\"'),
    (["--text", "\u2603", "--height", "10"], 1, "U+2603"),
    (["--text", "A", "--height", "10", "--font", "none.ttf"], 1, "none.ttf"),
    (["--text", "A", "--height", "10", "--at", "here"], 2, "is not a point, as [x, y] in mm"),
    (["--text", "A", "--height", "10", "--op", "pocket"], 1, "outlines are open"),
])
def test_unusable_texts_are_errors(kerf, change, status, message):
    arguments = [*ENGRAVE, *change]
    if "--op" in change:
        arguments = arguments[2:]
    run = kerf("cut", "--json", *arguments)
    assert run.status == status, run.out + run.err
    assert message in run.out + run.err


CARVE = ["--op", "vcarve", "--tool", "V d=20 angle=90", "--feed", "600", "--text", "HO", "--height", "20"]
needs_font = pytest.mark.skipif(not FONT.exists(), reason="DejaVu fonts are not installed")
# The fonts that Fontconfig lists, and those of given folders.
lists = pytest.mark.parametrize("folders", ["", str(FONT.parent)], ids=["fontconfig", "folders"])


def environment(folders):
    return {"KERF_FONTS": folders} if folders else {}


@needs_font
@lists
@pytest.mark.parametrize("font, file", [
    ("DejaVu Sans", "DejaVuSans.ttf"), ("dejavu sans:bold", "DejaVuSans-Bold.ttf"),
    ("DejaVu Sans:style=Bold Oblique", "DejaVuSans-BoldOblique.ttf"),
    ("DejaVu Sans:italic:bold", "DejaVuSans-BoldOblique.ttf"), ("DejaVu Serif Bold", "DejaVuSerif-Bold.ttf"),
    ("DejaVu Sans Mono:oblique", "DejaVuSansMono-Oblique.ttf"), ("DejaVuSerif", "DejaVuSerif.ttf")])
def test_fonts_by_family_and_style(kerf, folders, font, file):
    named = kerf("cut", *CARVE, "--font", font, env=environment(folders))
    of_file = kerf("cut", *CARVE, "--font", FONT.parent / file)
    assert named.status == 0 and named.out == of_file.out, named.err


@needs_font
@lists
@pytest.mark.parametrize("font, message", [
    ("DejaVu Sans:wide", 'has no style "wide"; it has: Bold, Bold Oblique, Book'),
    ("DejaVu Snas", "near: DejaVu Sans"), ("dejavu", "near: DejaVu"), ("DejaVu Serif:black", "has no style"),
    ("Helvetica Neue", 'there is no font "Helvetica Neue"'), (":bold", 'there is no font ""'),
    ("DejaVu Sans:", None)])
def test_no_other_font_is_taken_for_one_that_is_missing(kerf, folders, font, message):
    run = kerf("cut", *CARVE, "--font", font, env=environment(folders))
    if message is None:
        assert run.status == 0
    else:
        assert run.status == 1 and message in run.err and not run.out


@needs_font
def test_a_job_names_its_font(kerf, tmp_path):
    (tmp_path / "job.toml").write_text('[tools]\n1 = "V d=20 angle=90"\n[[shape]]\ntext = "HO"\nheight = 20\n'
                                       'font = "DejaVu Sans:bold"\n[[operation]]\nop = "vcarve"\ntool = 1\n'
                                       'feed = 600\nrpm = 9000\n')
    run = kerf("cut", "job.toml", "-o", "part.nc")
    assert run.status == 0, run.err


def test_a_file_that_is_no_font(kerf, tmp_path):
    (tmp_path / "bad.ttf").write_text("not a font")
    run = kerf("cut", "--json", *ENGRAVE, "--text", "A", "--height", "10", "--font", "bad.ttf")
    assert run.status == 1 and "not a font" in run.out


def test_rest_machining_with_a_second_tool(kerf, tmp_path):
    (tmp_path / "job.toml").write_text('''
stock = "-5,-5,-6 to 45,25,0"
[tools]
1 = "square d=8"
2 = "square d=2"
[[shape]]
rectangle = [0, 0, 40, 20]
[defaults]
depth = 3
feed = 600
[[operation]]
op = "pocket"
tool = 1
[[operation]]
op = "pocket"
tool = 2
rest-tool = 1
''')
    run = kerf("simulate", "--json", "job.toml", "--resolution", "0.05")
    assert run.status == 0, run.err + run.out
    assert run.json["hazards"] == []
    # The corners are as round as the small tool leaves them.
    assert run.json["removed_mm3"] == pytest.approx(3 * (40 * 20 - (4 - math.pi) * 1**2), rel=1e-3)
    tools = {t["number"]: t["removed_mm3"] for t in run.json["tools"]}
    assert tools[2] == pytest.approx(3 * (4 - math.pi) * (4**2 - 1**2), rel=0.03)
    job = (tmp_path / "job.toml").read_text()
    (tmp_path / "job.toml").write_text(job.replace("rest-tool = 1", "rest-tool = 3"))
    run = kerf("info", "--json", "job.toml")
    assert run.status == 1 and "tool 3 has no shape" in json.dumps(run.json)

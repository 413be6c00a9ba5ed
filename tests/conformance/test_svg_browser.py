"""SVG files as Chromium draws them: resvg's tests of shapes and structure, and Kerf's own."""
import os
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS / "svg"))
import browser  # noqa: E402
import pictures  # noqa: E402

RESVG = Path(os.environ.get("KERF_CASES_DIR", "")) / "svg"
# Lengths in units of a font's shapes: Kerf has no fonts of the page, takes usual proportions, and warns.
BY_FONT = {f"shapes__rect__{unit}-values.svg" for unit in ("cap", "ch", "ex", "ic", "lh")}


@pytest.mark.skipif(not browser.browser(), reason="chromium is not installed")
@pytest.mark.parametrize("folder", [RESVG, TESTS / "svg" / "cases"], ids=["resvg", "kerf"])
def test_outlines_are_where_the_browser_draws(folder):
    if not folder.is_dir():
        pytest.skip(f"there is no folder {folder}")
    differences = browser.compare(folder)
    wrong = {name: text for name, text in differences.items() if text and name not in BY_FONT}
    print(f"{len(differences) - len(wrong)} of {len(differences)} files agree")
    assert differences and not wrong


PICTURES = sorted((TESTS / "svg" / "pictures").glob("*.svg"))
FONTS = Path("/usr/share/fonts/truetype/dejavu")
# At 8 pixels for one of the page: single pixels at edges that both cover by half.
NOISE = 40


@pytest.mark.skipif(not browser.browser(), reason="chromium is not installed")
def test_areas_are_those_that_the_browser_paints():
    files = [f for f in PICTURES if FONTS.is_dir() or not f.name.startswith("text")]
    found = pictures.differing_pixels(files)
    print(found)
    assert len(found) == len(files)
    for name, one in found.items():
        assert one.get("painted", 0) > 10_000 and one["different"] <= NOISE, (name, one)

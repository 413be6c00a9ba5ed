"""What Kerf writes, it reads: a program written for a controller and read back is the same program."""
import os
import re
from pathlib import Path

import pytest

SOURCE = Path(os.environ.get("KERF_SOURCE_DIR", Path(__file__).parents[2]))
CASES = Path(os.environ.get("KERF_CASES_DIR", SOURCE.parent / "shared" / "cases"))

POSTS = {"carbide": 3, "grbl": 3, "grblhal": 3, "linuxcnc": 4, "mach3": 4}  # decimals of a mm
OPERATIONS = ["pocket", "contour", "engrave", "face", "drill", "bore", "keyhole", "slot", "trochoidal-slot",
              "thread", "countersink", "vcarve", "vcarve-floor"]
FILES = ["demo.nc", "one_pass.nc", "plate.gcmc", "inlay.toml", "rest.toml", "text.toml"]
RESOLUTION = "0.1"


def figures(kerf, file):
    run = kerf("simulate", "--json", "--resolution", RESOLUTION, file)
    assert run.status in (0, 3), run.err
    return run.json


def hazards(found):
    return sorted((h["kind"], round(h.get("depth_mm", 0.0), 2)) for h in found["hazards"])


def expect_same(source, back, decimals, what):
    """Tools, stock, volume and hazards; coordinates are rounded to the decimals of the post."""
    def tools(found):
        return [(t["number"], t["name"]) for t in found["tools"]]

    assert tools(back) == tools(source), what
    assert all(t["source"] != "assumed" for t in back["tools"]), what
    block, written = (sum(f["stock"]["block_mm"], []) for f in (source, back))
    assert written == pytest.approx(block, abs=2 * 10**-decimals), what
    if source["stock"]["source"] != "assumed":
        assert back["stock"]["source"] == "program", what
        assert written == pytest.approx(block, abs=1e-6), what
    area = max(source["removed_mm3"], 1.0) ** (2 / 3) * 6
    allowed = 1e-6 * source["removed_mm3"] + 0.5 * 10**-decimals * area
    assert abs(back["removed_mm3"] - source["removed_mm3"]) <= allowed, what
    assert hazards(back) == hazards(source), what


def program_of(kerf, tmp_path, name):
    if name in OPERATIONS:
        job = tmp_path / f"{name}.toml"
        job.write_text(kerf("cut", "--example", name).out)
        return job
    return SOURCE / "examples" / name


# Each example goes through two of the posts, so that all posts and all examples are met within a minute.
SAMPLE = [(name, post) for i, name in enumerate(OPERATIONS + FILES) for k, post in enumerate(POSTS)
          if (k - i) % len(POSTS) in (0, 2)]


@pytest.mark.parametrize("name, post", SAMPLE)
def test_what_is_written_is_read_back(kerf, tmp_path, name, post):
    program = program_of(kerf, tmp_path, name)
    written = kerf("post", program, "--to", post, "-o", "out.nc")
    if written.status != 0:
        pytest.skip(f"{post} cannot carry it: {written.err.splitlines()[0]}")
    expect_same(figures(kerf, program), figures(kerf, tmp_path / "out.nc"), POSTS[post], f"{name} {post}")

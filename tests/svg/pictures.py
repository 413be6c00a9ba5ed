"""SVG files as Chromium paints them, against the areas of `kerf outline --region`, pixel by pixel.

    KERF=build/kerf python3 tests/svg/pictures.py FOLDER

Both are painted black on a canvas with SCALE pixels for one of the page; a pixel counts as different where
the two cover it differently by more than half. Colours and opacity are not compared: any paint is black.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

from browser import PX, circle_through, run_page

PAGE = Path(__file__).with_name("pictures.html")
SCALE = 8


def path_of(outline, height):
    """Path data in pixels of the page, y down."""

    def text(p):
        return f"{p[0] / PX:.7f} {height - p[1] / PX:.7f}"

    at = outline["first"]["at"]
    data = ["M" + text(at)]
    for segment in outline["segments"]:
        to = segment["to"]
        arc = circle_through(at, segment["via"], to) if "via" in segment else None
        if arc:
            centre, _, sweep = arc
            radius = ((at[0] - centre[0]) ** 2 + (at[1] - centre[1]) ** 2) ** 0.5 / PX
            flags = f"{int(abs(sweep) > 3.14159265)} {int(sweep < 0)}"
            data.append(f"A{radius:.7f} {radius:.7f} 0 {flags} {text(to)}")
        else:
            data.append("L" + text(to))
        at = to
    return " ".join(data) + "Z"


def kerf_region(file, *options):
    command = [os.environ["KERF"], "outline", str(file), "--json", "--region", "--strokes", "areas",
               "--tolerance", "0.0005", *options]
    done = subprocess.run(command, capture_output=True, timeout=120)
    reported = json.loads(done.stdout)
    return reported["region"]["outlines"] if reported.get("region") else []


def differing_pixels(files, *options):
    """By file name: the pixels that differ, of how many that are painted."""
    cases = [{"name": f.name} for f in files]
    sizes = run_page(PAGE, files, cases)
    for file, case in zip(files, cases):
        _, height = sizes[file.name]["size"]
        case["path"] = " ".join(path_of(o, height) for o in kerf_region(file, *options))
        case["scale"] = SCALE
    return run_page(PAGE, files, cases)


if __name__ == "__main__":
    found = differing_pixels(sorted(Path(sys.argv[1]).glob("*.svg")), *sys.argv[2:])
    for name, one in found.items():
        print(name, one)

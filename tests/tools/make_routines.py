#!/usr/bin/env python3
"""Writes docs/manual/routines.md, the index of gcodepreview's routines, from their signatures and docstrings.

Usage: PYTHONPATH=build/python tests/tools/make_routines.py. tests/python/test_gcodepreview.py compares them.
"""

import inspect
import pathlib
import re

import gcodepreview
from gcodepreview import shapes

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "manual" / "routines.md"
HEAD = """# Index of gcodepreview's routines

Written by `tests/tools/make_routines.py`. Arguments with `=` may be left out. A routine without a
text does what its name says with the axes, the drawing (`dxf`) or the program (`gc`) that it names;
[gcodepreview](gcodepreview.md) groups them, and `examples/gcodepreview/commands.py` has an example of each.
"""


def row(name, function):
    stated = inspect.signature(function)
    untyped = [p.replace(annotation=p.empty) for p in stated.parameters.values()]
    plain = stated.replace(parameters=untyped, return_annotation=stated.empty)
    signature = re.sub(r"\(self(, /)?(, )?", "(", str(plain))
    text = re.sub(r"\\s+", " ", (inspect.getdoc(function) or "").split("\n\n")[0].replace("\n", " "))
    sentence = re.split(r"(?<=[.;])\s", text)[0].rstrip(";.") if text else ""
    return f"| `{name}{signature}` | {sentence.replace('|', '/')} |"


def page():
    methods = inspect.getmembers(gcodepreview.gcodepreview, inspect.isroutine)
    plain = [(n, f) for n, f in inspect.getmembers(shapes, inspect.isfunction)]
    lines = [HEAD, "## Methods\n", "| routine | does |", "|---|---|"]
    lines += [row(n, f) for n, f in methods if not n.startswith("_")]
    lines += ["", "## Shapes: outlines for `dxfoutline`, `cutoutline`, `cutpocket`\n"]
    lines += ["| routine | makes |", "|---|---|"]
    known = {*shapes.SHAPES, "annulus", "bezier", "bezier_surface", "polygon", "round_corners", "text"}
    lines += [row(f"shapes.{n}", f) for n, f in plain if n in known]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page())

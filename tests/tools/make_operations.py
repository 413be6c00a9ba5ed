#!/usr/bin/env python3
"""Writes python/kerf/_cuts.py: a function for each operation of the table of keys, with its keys as
arguments.

Usage: PYTHONPATH=build/python tests/tools/make_operations.py. tests/python/test_operations.py compares the
file with what this program writes now, and the defaults below with those of the operations.
"""

import pathlib
import textwrap

from kerf import _kerf

TARGET = pathlib.Path(__file__).parents[2] / "python" / "kerf" / "_cuts.py"

# Values of keys that are not given. None: the operation decides, as the text says.
DEFAULTS = {
    "top": 0.0,
    "stepdown": 0.0,
    "stepover": 0.4,
    "plunge": 0.0,
    "clearance": 0.5,
    "allowance": 0.0,
    "direction": "climb",
    "entry": "helix",
    "entry-angle": 3.0,
    "helix-radius": 0.0,
    "pattern": "offset",
    "engagement": 60.0,
    "angle": 0.0,
    "side": "outside",
    "finish": 0.0,
    "lead": 0.0,
    "lead-kind": "arc",
    "overlap": 0.0,
    "tab-height": 0.0,
    "tab-length": 0.0,
    "tabs": 4,
    "tab-spacing": 0.0,
    "tab-shape": "rectangular",
    "slot-clearance": 0.0,
    "width": 0.0,
    "hand": "right",
    "thread-passes": 1,
    "thread-teeth": 1,
    "cone-angle": 90.0,
    "cycle": "plain",
    "peck": 0.0,
    "dwell": 0.0,
    "part": "pocket",
    "glue-gap": 0.0,
    "base-gap": 0.0,
    "margin": 0.0,
    "power": 0.0,
    "max-s": 1000.0,
    "beam": "dynamic",
    "passes": 1,
    "kerf": 0.0,
    "interval": 0.1,
    "overscan": 2.0,
    "scan": "both",
    "tones": "grey",
    "min-power": 0.0,
    "gamma": 1.0,
    "negative": "no",
    "rows": 1,
    "feed-to": 0.0,
    "columns": 1,
    "cell-width": 10.0,
    "cell-height": 0.0,
    "gap": 4.0,
    "label-height": 0.0,
    "line-distance": 0.0,
    "overhang": 0.0,
    "rest-thickness": 0.1,
    "tolerance": 0.01,
}
# Those of single operations.
OTHER_DEFAULTS = {
    ("contour", "entry"): "ramp",
    ("engrave", "entry"): "ramp",
    ("vcarve", "entry"): "ramp",
    ("thread", "side"): "inside",
    ("raster", "stepover"): 0.1,
    ("raster", "top"): None,
    ("waterline", "top"): None,
}
# Keys without which an operation is an error, besides those of the table.
REQUIRED = {("keyhole", "length"), ("thread", "pitch")}
TEXTS = {
    "retract": "Z of rapids between cuts. Default: 5 above `top`.",
    "lead-out": "Size of the lead-out. Default: as `lead`.",
    "power-to": "Power of the last column of a test grid. Default: as `power`.",
    "feed": "Feed of cuts. Without it, the chip load in `material` gives it.",
    "material": "For a feed that is not given, such as 'MDF' or 'aluminium'.",
    "machine": "File of the machine whose limits a chosen feed keeps.",
    "depth": "Below the surface. Default: as deep as the outlines or the cone of the tool permit.",
    "top": "Z of the surface of the material. Default: the highest point of the mesh.",
}
MESH_DEPTH = "Below the surface. Default: down to the lowest point of the mesh."
TOOLS = {
    "rest-tool": "The tool of the same operation before: only what it left is cut.",
    "carve-tool": "The tool of the `vcarve` that leaves this floor.",
}
NAMES = {"vcarve": "v_carve", "vcarve-floor": "v_carve_floor"}
# Operations without a tool start with this; the arguments of one that has a picture.
LASER = "laser"
PICTURE_KEYS = [
    ("width", "float", "Width of the picture on the board; 0: by the resolution of its file, mm.", 0.0),
    ("at", "(float, float)", "Its lower left corner, mm.", (0, 0)),
]
LEFT_OUT = ("layers", "outlines", "tool", "name", "rpm")

REGION = ("region", "Region or list of outlines")
PATHS = ("outlines", "Region or list of outlines")
CIRCLES = ("circles", "list of (float, float, float)")
POINTS = ("points", "list of (float, float)")
MESH = ("mesh", "str, os.PathLike or (points, triangles)")
MESH_TEXT = (
    "A file (.stl, .3mf, .obj), or arrays of points, N x 3, mm, and of the indices of the corners of "
    "triangles, M x 3; `Simulation.mesh` returns such."
)
# Further arguments of operations on meshes.
MESH_KEYS = [
    ("move", "(float, float, float)", "By which the mesh is moved, mm.", (0, 0, 0)),
    ("scale", "float", "Factor of the mesh about its origin, before it is moved.", 1.0),
]
AREA = (
    "area",
    "Region or list of outlines, optional",
    "Where the axis of the tool stays. Default: the rectangle around the mesh, wider by `overhang`.",
    None,
)
# What an operation works on, and what it does.
OPERATIONS = {
    "pocket": (
        REGION,
        "Cut all inside a region; its holes are islands.",
        "What is cut out; outlines as in `Region`, mm.",
    ),
    "contour": (
        REGION,
        "Cut along the boundary of a region.",
        "The part (side 'outside': around it and inside its holes) or the opening ('inside'), mm.",
    ),
    "engrave": (
        PATHS,
        "Cut along outlines, open or closed, with the axis of the tool.",
        "Lists of points and arcs as in `Region`, mm; `text_outlines` makes those of texts.",
    ),
    "face": (
        REGION,
        "Cut all above a region with parallel lines that leave it on all sides.",
        "The surface, mm.",
    ),
    "drill": (POINTS, "Drill holes.", "Centres of the holes, mm."),
    "bore": (CIRCLES, "Mill round holes by helices.", "The holes: x, y and radius, mm."),
    "keyhole": (POINTS, "Cut keyholes: down, along a slot, back, and up.", "Where the tool goes down, mm."),
    "slot": (
        PATHS,
        "Cut slots between edges of the material, with dovetail or T-slot tools.",
        "Open outlines from edge to edge, mm; the tool goes down and up outside.",
    ),
    "trochoidal-slot": (
        PATHS,
        "Cut slots wider than the tool along outlines, by loops within a limit of the engagement angle.",
        "Centre lines of the slots, open or closed, mm.",
    ),
    "thread": (
        CIRCLES,
        "Cut threads with a thread mill. The hole or rod must be there.",
        "Major diameters: x, y and radius, mm.",
    ),
    "countersink": (
        CIRCLES,
        "Cut cones from circles down to a depth, with a ball mill.",
        "The circles at the surface: x, y and radius, mm.",
    ),
    "vcarve": (
        REGION,
        "Carve a region with a V tool: its edges at the surface are exactly those of the " "region.",
        "What is carved; with part 'plug' what fits into it, mirrored. mm.",
    ),
    "vcarve-floor": (REGION, "Clear the flat floor that `v_carve` leaves.", "As of `v_carve`."),
    "raster": (MESH, "Cut a mesh in parallel lines.", MESH_TEXT),
    "waterline": (MESH, "Cut around a mesh on levels that are the stepdown apart.", MESH_TEXT),
    "project": (MESH, "Engrave outlines on a mesh, `depth` below where the tool touches it.", MESH_TEXT),
    "laser": (PATHS, "Burn along outlines, open or closed.", "Lists of points and arcs as in `Region`, mm."),
    "laser-cut": (REGION, "Cut a region out with a laser, half a kerf beside it.", "As of `contour`."),
    "laser-fill": (REGION, "Burn all inside a region by parallel lines.", "What is burnt, mm."),
    "laser-picture": (
        ("picture", "str, os.PathLike or list of str"),
        "Burn a picture by lines.",
        "A PNG file, or rows of digits from 0, white, to 9, black.",
    ),
    "laser-test": (None, "Burn a grid of cells with increasing power and speed.", ""),
    "laser-frame": (PATHS, "Move around shapes, to show where the work will be.", "The shapes, mm."),
}


def wrapped(text, indent):
    return textwrap.fill(text, 110, initial_indent=indent, subsequent_indent=indent)


def sentence(text):
    return text[0].upper() + text[1:] + ("" if text.endswith(".") else ".")


def is_required(op, key, required):
    return required or (op, key) in REQUIRED


def default_of(op, key):
    return OTHER_DEFAULTS[op, key] if (op, key) in OTHER_DEFAULTS else DEFAULTS.get(key)


def type_text(op, key, kind, unit, required):
    if key in TOOLS:
        return "Tool or str" if required else "Tool or str, optional"
    if kind == "text" and unit:
        return "{" + ", ".join(f"'{word.strip()}'" for word in unit.split(",")) + "}"
    whole = isinstance(default_of(op, key), int)
    name = "str" if kind == "text" else "int" if whole else "float"
    return name if required or default_of(op, key) is not None else name + ", optional"


def parameter_text(op, key, kind, unit, meaning, required):
    heading = f"    {key.replace('-', '_')} : {type_text(op, key, kind, unit, required)}"
    text = TOOLS.get(key)
    if text is None and not required and default_of(op, key) is None:
        text = MESH_DEPTH if key == "depth" and OPERATIONS[op][0] == MESH else TEXTS.get(key)
    if text is None:
        text = sentence(meaning)
    if kind == "number" and unit:
        text = text[:-1] + f", {unit}."
    return heading + "\n" + wrapped(text, "        ")


def further_keys(op):
    """Arguments that are not in the table of keys."""
    if op == "laser-picture":
        return PICTURE_KEYS
    if OPERATIONS[op][0] != MESH:
        return []
    return [AREA, *MESH_KEYS] if op == "raster" else MESH_KEYS


def argument_lines(op, keys):
    """What an operation works on, its tool, and its keys, with their defaults."""
    first = OPERATIONS[op][0]
    lines = [f"    {first[0]},"] if first else []
    if op == "project":
        lines.append("    outlines,")
    if not op.startswith(LASER):
        lines.append("    tool,")
    lines.append("    *,")
    for key, _, _, _, required in keys:
        value = "" if required else f"={default_of(op, key)!r}".replace("'", '"')
        lines.append(f"    {key.replace('-', '_')}{value},")
    lines += [f"    {name}={value!r}," for name, _, _, value in further_keys(op)]
    if not op.startswith(LASER):
        lines.append("    rpm=0.0,")
    return [*lines, '    name="",']


def text_lines(op, keys):
    """The docstring."""
    first, summary, text = OPERATIONS[op]
    lines = [f'    """{summary}', "", "    Parameters", "    ----------"]
    if first:
        lines += [f"    {first[0]} : {first[1]}", wrapped(text, "        ")]
    if op == "project":
        lines += [f"    outlines : {PATHS[1]}", "        As of `engrave`."]
    if not op.startswith(LASER):
        lines += [
            "    tool : Tool, str or int",
            "        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.",
        ]
    lines += [parameter_text(op, *row) for row in keys]
    for name, kind, meaning, _ in further_keys(op):
        lines += [f"    {name} : {kind}", wrapped(meaning, "        ")]
    if not op.startswith(LASER):
        lines += ["    rpm : float", "        Spindle speed, clockwise; 0: none, rpm."]
    lines += ["    name : str", "        Name of the operation, in messages and in the program.", ""]
    lines += ["    Returns", "    -------", "    Program", "", "    Raises", "    ------", "    kerf.Error"]
    if op.startswith(LASER):
        return [*lines, "        If a value is out of range.", '    """']
    return [
        *lines,
        "        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are",
        "        warnings.",
        '    """',
    ]


def call_lines(op, keys):
    first = OPERATIONS[op][0]
    lines = ["    return _run(", f'        "{op}",']
    if first:
        known = first[0] if first[0] in ("points", "picture", "mesh") else "shapes"
        lines.append(f"        {known}={first[0]},")
    if first == MESH:
        lines += ["        move=move,", "        scale=scale,"]
    if op in ("raster", "project"):
        lines.append("        shapes=" + ("area," if op == "raster" else "outlines,"))
    if not op.startswith(LASER):
        lines.append("        tool=tool,")
    lines += [f"        {key.replace('-', '_')}={key.replace('-', '_')}," for key, *_ in keys]
    if op == "laser-picture":
        lines += ["        picture_width=width,", "        at=at,"]
    if not op.startswith(LASER):
        lines.append("        rpm=rpm or None,")
    return [*lines, "        name=name or None,", "    )"]


def function(op, rows):
    keys = [
        (key, kind, unit, meaning, is_required(op, key, required))
        for key, kind, unit, meaning, required in rows
        if key not in LEFT_OUT
    ]
    keys.sort(key=lambda row: not row[4])
    heading = f"def {NAMES.get(op, op.replace('-', '_'))}("
    return "\n".join([heading, *argument_lines(op, keys), "):", *text_lines(op, keys), *call_lines(op, keys)])


def module():
    operations = {}
    for op, key, kind, unit, meaning, required in _kerf._cut_keys():
        operations.setdefault(op, []).append((key, kind, unit, meaning, required))
    text = '"""Operations on regions, outlines, points and meshes, as of `kerf cut`. See `kerf.op`."""\n\n'
    text += "# Written by tests/tools/make_operations.py from the table of keys.\n\n"
    text += "from ._operations import run as _run\n"
    for op, rows in operations.items():
        text += "\n\n" + function(op, rows) + "\n"
    return text


if __name__ == "__main__":
    TARGET.write_text(module())

"""Writes kerf/_cuts.py, a function for each operation, from the schema of job files.

Usage: make_operations.py SCHEMA.json _cuts.py. The build runs it; what it writes is not part of the
repository. Functions have the keys of the operation as arguments, with annotations and numpydoc docstrings.
"""

import json
import pathlib
import re
import sys
import textwrap

NAMES = {"vcarve": "v_carve", "vcarve-floor": "v_carve_floor"}
KINDS = {"number": "float", "integer": "int", "string": "str"}
OF_JOB = ("feed", "plunge", "retract", "material", "machine")  # a job has them too
LEFT_OUT = ("op", "through", "layers", "outlines", "tool", "name", "rpm")
PATHS = "Region or list of outlines"
MESH_TEXT = (
    "A file (.stl, .3mf, .obj), or arrays of points, N x 3, mm, and of the indices of the corners of "
    "triangles, M x 3; `Simulation.mesh` returns such."
)
# Of what an operation works on: its argument, how run() calls it, its annotation, its type in the docstring.
INPUTS = {
    "region": ("region", "shapes", "Outlines", PATHS),
    "outlines": ("outlines", "shapes", "Outlines", PATHS),
    "shapes": ("outlines", "shapes", "Outlines", PATHS),
    "circles": ("circles", "shapes", "Points", "list of (float, float, float)"),
    "points": ("points", "points", "Points | Region", "list of (float, float) or Region"),
    "picture": ("picture", "picture", "Picture", "str, os.PathLike or list of str"),
    "mesh": ("mesh", "mesh", "Mesh", "str, os.PathLike or (points, triangles)"),
    "": None,
}
# Arguments that are no keys: name, how run() calls it, annotation, type, text, default.
PICTURE_KEYS = [
    (
        "width",
        "picture_width",
        "float | str",
        "float or str",
        "Width of the picture on the board; 0: by the resolution of its file, mm.",
        0.0,
    ),
    ("at", "at", "Position", "(float or str, float or str)", "Its lower left corner, mm.", (0, 0)),
]
MESH_KEYS = [
    (
        "move",
        "move",
        "Sequence[float]",
        "(float, float, float)",
        "By which the mesh is moved, mm.",
        (0, 0, 0),
    ),
    ("scale", "scale", "float", "float", "Factor of the mesh about its origin, before it is moved.", 1.0),
]
AREA = (
    "area",
    "shapes",
    "Outlines | None",
    PATHS + ", optional",
    "Where the axis of the tool stays. Default: the rectangle around the mesh, wider by `overhang`.",
    None,
)
PLATE = """>>> plate = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])
"""
MESH = """>>> points = [(0, 0, -8), (10, 0, 0), (20, 0, -8), (0, 10, -8), (10, 10, 0), (20, 10, -8)]
>>> roof = (points, [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)])
"""
# The section Examples of each function; tests/python/test_docstrings.py runs them.
EXAMPLES = {
    "pocket": PLATE + ">>> program = kerf.op.pocket(plate, 'square d=6', depth=4, stepdown=2, feed=900)",
    "contour": PLATE
    + ">>> program = kerf.op.contour(plate, 'square d=6', depth=6, stepdown=2, feed=900, tabs=4)",
    "chamfer": PLATE + ">>> program = kerf.op.chamfer(plate, 'V d=12 angle=90', width=1, feed=900)",
    "isolation": """>>> copper = kerf.Region([(5, 5, 1.1), (25, 5, 1.1)]) | kerf.widen([(5, 5), (25, 5)], 0.4)
>>> program = kerf.op.isolation(copper, 'square d=0.3 flute=1', depth=0.08, feed=200)""",
    "engrave": """>>> word = kerf.op.text_outlines("KERF", 12, at=(10, 10))
>>> program = kerf.op.engrave(word, 'V d=6 angle=60', depth=0.4, feed=600)""",
    "face": PLATE + ">>> program = kerf.op.face(plate, 'square d=12', depth=0.5, feed=1500)",
    "drill": """>>> points = [(8, 8), (52, 32)]
>>> program = kerf.op.drill(points, 'drill d=4', depth=7, feed=100, cycle='peck', peck=2)""",
    "bore": ">>> program = kerf.op.bore([(20, 20, 8)], 'square d=6', depth=4, feed=900)",
    "keyhole": """>>> tool = "keyhole d=9.5 head=4.8 neck=4.8 flute=12"
>>> program = kerf.op.keyhole([(20, 20)], tool, depth=6, feed=500, length=12)""",
    "slot": """>>> tool = "dovetail d=12.7 flute=9 angle=14"
>>> program = kerf.op.slot([[(0, 20), (60, 20)]], tool, depth=6, feed=500)""",
    "trochoidal-slot": """>>> line = [[(10, 20), (50, 20)]]
>>> program = kerf.op.trochoidal_slot(line, 'square d=6', depth=4, width=10, feed=900)""",
    "thread": """>>> tool = "thread mill minor_diameter=3 major_diameter=6 cut_height=2 length=12"
>>> program = kerf.op.thread([(20, 20, 5)], tool, depth=8, feed=200, pitch=1.25)""",
    "countersink": ">>> program = kerf.op.countersink([(20, 20, 5)], 'ball d=3', depth=3, feed=500)",
    "vcarve": PLATE + ">>> program = kerf.op.v_carve(plate, 'V d=20 angle=60', feed=900)",
    "vcarve-floor": PLATE
    + """>>> vee = kerf.Tool("V d=20 angle=60", number=2)
>>> program = kerf.op.v_carve_floor(plate, 'square d=6', depth=3, feed=900, carve_tool=vee)""",
    "raster": MESH + ">>> program = kerf.op.raster(roof, 'ball d=6', feed=900, stepover=0.2)",
    "waterline": MESH + ">>> program = kerf.op.waterline(roof, 'ball d=6', feed=900, stepdown=2)",
    "project": MESH
    + ">>> program = kerf.op.project(roof, [[(4, 5), (16, 5)]], 'V d=6 angle=60', feed=900, depth=0.5)",
    "laser": ">>> program = kerf.op.laser([[(0, 0), (50, 0)]], power=30, feed=2000)",
    "laser-cut": ">>> program = kerf.op.laser_cut([(24, 18, 12)], power=90, feed=300, kerf=0.15, lead=1)",
    "laser-fill": ">>> program = kerf.op.laser_fill([(24, 18, 12)], power=40, feed=3000)",
    "laser-picture": """>>> rows = ["0990", "9009"]
>>> program = kerf.op.laser_picture(rows, width=8, at=(20, 16), power=40, feed=3000)""",
    "laser-test": ">>> program = kerf.op.laser_test(power=100, feed=1200, feed_to=400, rows=5)",
    "laser-frame": PLATE + ">>> program = kerf.op.laser_frame(plate, feed=3000)",
}
HEAD = '''"""Operations on regions, outlines, points and meshes, as of `kerf cut`. See `kerf.op`."""

# Made by the build from the rows of the operations.
from __future__ import annotations

import os
from typing import Any, Iterable, Literal, Sequence, Tuple, Union

from ._kerf import Program, Region, Tool
from ._operations import run as _run
from ._types import Geometry, Outlines, Position, Row, Rows

Points = Union[Geometry, Iterable[Union[Row, Geometry]]]
Mesh = Union[str, "os.PathLike[str]", Tuple[Rows, Rows], Tuple[Rows, Rows, Any]]
Picture = Union[str, "os.PathLike[str]", Sequence[str]]
AnyTool = Union[Tool, str, int]
'''
METHODS_HEAD = '''class Operations:
    """The operations as methods of a job: each appends what the function of `kerf.op` makes."""

    def _add(self, op: str, **options: Any) -> None:
        raise NotImplementedError
'''


def wrapped(text, indent):
    return textwrap.fill(text, 110, initial_indent=indent, subsequent_indent=indent)


def sentence(text):
    return text[0].upper() + text[1:] + ("" if text.endswith(".") else ".")


def range_text(row):
    """ ", from 15 to 90": what a number may be."""
    low, above, high = row.get("minimum"), row.get("exclusiveMinimum"), row.get("maximum")
    if above is not None:
        return f", above {above:.10g}" + ("" if high is None else f", at most {high:.10g}")
    if low is not None and high is not None:
        return f", {low:.10g} to {high:.10g}"
    return "" if low is None else f", at least {low:.10g}"


class Key:
    """A key as an argument."""

    def __init__(self, name, row):
        self.name, self.row = name.replace("-", "_"), row
        self.required = "x-required" in row
        self.tool = "x-tool" in row
        # Of a number also "string", for one with a unit.
        self.types = [row["type"]] if isinstance(row["type"], str) else row["type"]
        self.type = self.types[0]
        self.default = row.get("default")

    def annotation(self):
        kind = " | ".join(KINDS[kind] for kind in self.types)
        if self.tool:
            kind = "AnyTool"
        elif "enum" in self.row:
            kind = "Literal[" + ", ".join(json.dumps(word) for word in self.row["enum"]) + "]"
        return kind if self.required or self.default is not None else kind + " | None"

    def argument(self):
        return f"{self.name}: {self.annotation()}" + ("" if self.required else f" = {literal(self.default)}")

    def scaled(self):
        """Whether its numbers are lengths, or lengths per minute."""
        return self.row.get("$comment") in ("mm", "mm/min")

    def of_job(self, through):
        """The key of a method of a job; `through`: the depth may be that of the stock."""
        row = {k: v for k, v in self.row.items() if k not in ("default", "x-required")}
        if self.name == "depth" and through:
            row["x-or"] = "``'through'``: to the bottom of the stock, ``'through 0.5mm'``: so far below it."
        if self.name in OF_JOB:
            row["x-otherwise"] = "that of the job"
        elif self.required:
            row["x-required"] = True
        elif self.default not in (None, ""):
            unit = " " + self.row["$comment"] if self.scaled() else ""
            row["x-otherwise"] = f"{self.default:.10g}{unit}" if self.type == "number" else str(self.default)
        if self.scaled():  # limits in mm say nothing of another unit
            row = {k: v for k, v in row.items() if k != "$comment" and not ("imum" in k and v)}
        return Key(self.name, row)

    def text(self):
        kind = " or ".join(KINDS[kind] for kind in self.types)
        if self.tool:
            kind = "Tool, str or int"
        elif "enum" in self.row:
            kind = "{" + ", ".join(f"'{word}'" for word in self.row["enum"]) + "}"
        if not self.required and self.default is None:
            kind += ", optional"
        meaning = sentence(self.row["description"])
        if self.type in ("number", "integer") and not self.tool:
            unit = self.row.get("$comment")
            meaning = meaning[:-1] + (f", {unit}" if unit else "") + range_text(self.row) + "."
        if "x-or" in self.row:
            meaning += f" {self.row['x-or']}"
        if "x-otherwise" in self.row:
            meaning += f" Default: {self.row['x-otherwise']}."
        return [f"    {self.name} : {kind}", wrapped(meaning, "        ")]


def literal(value):
    return json.dumps(value) if isinstance(value, str) else repr(value)


class Function:
    """The function of an operation."""

    def __init__(self, op, row):
        self.op, self.row = op, row
        self.name = NAMES.get(op, op.replace("-", "_"))
        self.laser = "x-laser" in row
        self.input = INPUTS[row["x-input"].split(" ")[0]]
        self.on_mesh = row["x-input"].startswith("mesh")
        keys = [Key(name, value) for name, value in row["properties"].items() if name not in LEFT_OUT]
        self.keys = sorted(keys, key=lambda key: not key.required)
        self.more = PICTURE_KEYS if row["x-input"] == "picture" else MESH_KEYS if self.on_mesh else []
        if row["x-input"] == "mesh in a region":
            self.more = [AREA, *MESH_KEYS]
        self.along = row["x-input"] == "mesh along outlines"

    def subjects(self):
        lines = [f"{self.input[0]}: {self.input[2]}"] if self.input else []
        return [*lines, "outlines: Outlines"] if self.along else lines

    def subject_texts(self, unit):
        lines = []
        if self.input:
            cuts = MESH_TEXT if self.on_mesh else sentence(self.row["x-cuts"])
            unit = "" if self.on_mesh or self.row["x-input"] == "picture" else unit
            lines = [f"    {self.input[0]} : {self.input[3]}", wrapped(cuts[:-1] + unit + ".", "        ")]
        return [*lines, f"    outlines : {PATHS}", "        As of `engrave`."] if self.along else lines

    def arguments(self):
        lines = self.subjects()
        if not self.laser:
            lines.append("tool: AnyTool")
        lines += ["*", *(key.argument() for key in self.keys)]
        lines += [f"{name}: {kind} = {value!r}" for name, _, kind, _, _, value in self.more]
        if not self.laser:
            lines.append("rpm: float | str = 0.0")
        return [*lines, 'name: str = ""']

    def text(self):
        lines = [self.row["description"], "", "    Parameters", "    ----------", *self.subject_texts(", mm")]
        if not self.laser:
            lines += [
                "    tool : Tool, str or int",
                "        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.",
            ]
        for key in self.keys:
            lines += key.text()
        for name, _, _, kind, meaning, _ in self.more:
            lines += [f"    {name} : {kind}", wrapped(meaning, "        ")]
        if not self.laser:
            lines += ["    rpm : float or str", "        Spindle speed, clockwise; 0: none, rpm."]
        lines += ["    name : str", "        Name of the operation, in messages and in the program."]
        lines += ["", "    Returns", "    -------", "    Program"]
        lines.append("        Its toolpath, in work coordinates, mm, Z up, with its tool.")
        return self.in_python("\n".join(lines + self.raised())) + self.example()

    def example(self):
        """The section of examples; each operation has a row."""
        return "\n\n    Examples\n    --------\n" + textwrap.indent(EXAMPLES[self.op], "    ")

    def raised(self):
        """The section of errors."""
        text = "If a value is out of range"
        if not self.laser:
            text += ", or the tool fits nowhere. Parts that are too narrow for it are warnings"
        return ["", "    Raises", "    ------", "    kerf.Error", wrapped(text + ".", "        ")]

    def in_python(self, text):
        """A text with the names of operations and arguments in Python."""
        for other, name in NAMES.items():
            text = text.replace(f"`{other}`", f"`{name}`")
        for key in self.row["properties"]:
            if "-" in key:
                text = re.sub(rf"(?<![\w'-]){key}(?![\w'-])", key.replace("-", "_"), text)
        return text

    def call(self, name):
        lines = [json.dumps(self.op)]
        if self.input:
            lines.append(f"{self.input[1]}={self.input[0]}")
        if self.along:
            lines.append("shapes=outlines")
        if not self.laser:
            lines += ["tool=tool", "rpm=rpm"]
        lines += [f"{key.name}={key.name}" for key in self.keys]
        return [*lines, *(f"{known}={argument}" for argument, known, *_ in self.more), name]

    def code(self):
        arguments = "".join(f"    {line},\n" for line in self.arguments())
        call = "".join(f"        {line},\n" for line in self.call("name=name or None"))
        return (
            f'\n\ndef {self.name}(\n{arguments}) -> Program:\n    """{self.text()}\n    """\n'
            f"    return _run(\n{call}    )\n"
        )


class Method(Function):
    """The method of a job for an operation; the job, else the operation decides what is not given."""

    def __init__(self, op, row):
        super().__init__(op, row)
        through = "through" in row["properties"]
        self.keys = sorted((key.of_job(through) for key in self.keys), key=lambda key: not key.required)

    def arguments(self):
        lines = ["self", *self.subjects()]
        if not self.laser:
            lines.append("tool: AnyTool | None = None")
        lines += ["*", *(key.argument() for key in self.keys)]
        for name, _, kind, _, _, value in self.more:
            lines.append(f"{name}: {kind.removesuffix(' | None')} | None = None")
        if not self.laser:
            lines.append("rpm: float | str | None = None")
        return [*lines, "name: str | None = None"]

    def text(self):
        lines = [self.row["description"], "", "    Parameters", "    ----------", *self.subject_texts("")]
        if not self.laser:
            lines += [
                "    tool : Tool, str or int, optional",
                "        As of `Job.tool`. Default: the one in use.",
            ]
        for key in self.keys:
            lines += key.text()
        for name, _, _, kind, meaning, value in self.more:
            end = "" if value is None else f" Default: {value}."
            lines.append(f"    {name} : {kind.removesuffix(', optional')}, optional")
            lines.append(wrapped(meaning + end, "        "))
        if not self.laser:
            lines += ["    rpm : float or str, optional"]
            lines += ["        Spindle speed, clockwise. Default: that of the job."]
        lines += [
            "    name : str, optional",
            "        Name of the operation, in messages and in the program.",
        ]
        return self.in_python("\n".join(lines + self.raised()))

    def code(self):
        arguments = "".join(f"    {line},\n" for line in self.arguments())
        call = "".join(f"        {line},\n" for line in self.call("name=name"))
        head = f'def {self.name}(\n{arguments}) -> None:\n    """{self.text()}\n    """\n'
        text = f"{head}    self._add(\n{call}    )\n"
        return "\n" + textwrap.indent(text, "    ")


def scaled_keys(schema):
    """Of the keys whose numbers are in the units of a job: whether they are per minute."""
    rows = [row["properties"] for row in schema["$defs"].values()]
    keys = [Key(name, value) for row in rows for name, value in row.items() if "type" in value]
    lengths = {name: False for _, name, _, kind, *_ in PICTURE_KEYS + MESH_KEYS if name != "scale"}
    return {**{key.name: key.row["$comment"] != "mm" for key in keys if key.scaled()}, **lengths}


def module(schema):
    rows = schema["$defs"].items()
    functions = [Function(op, row) for op, row in rows]
    names = "".join(f"    {json.dumps(function.name)},\n" for function in functions)
    methods = "".join(Method(op, row).code() for op, row in rows)
    scaled = "".join(f"    {json.dumps(name)}: {value},\n" for name, value in scaled_keys(schema).items())
    return (
        f"{HEAD}\n__all__ = [\n{names}]\n"
        f"\n# Arguments in the units of a job: whether they are per minute.\nSCALED = {{\n{scaled}}}\n"
        f"{''.join(function.code() for function in functions)}\n\n{METHODS_HEAD}{methods}"
    )


if __name__ == "__main__":
    source, target = map(pathlib.Path, sys.argv[1:])
    target.write_text(module(json.loads(source.read_text())))

"""The docstrings of the commands: what each argument means, its unit, the result and the errors.

The first paragraph of a command is that of the machine, which OpenSCAD has too; the sections are made from
the tables below, where an argument of many commands has one row. All positions are in work coordinates, mm,
with Z up and Z0 where `setupstock` says.
"""

from __future__ import annotations

import functools
import inspect
import re
import textwrap
from typing import Any, TypeVar

from kerf import _kerf

_Class = TypeVar("_Class")

# What arguments mean: type, text. A key "command.argument" is of that command alone.
ARGUMENTS = {
    # positions
    "ex": ("float", "X of the end point, mm."),
    "ey": ("float", "Y of the end point, mm."),
    "ez": ("float", "Z of the end point, mm."),
    "bx": ("float", "X of the lower left corner, mm."),
    "by": ("float", "Y of the lower left corner, mm."),
    "bz": ("float", "Z of the surface from which the depth counts, mm."),
    "xbegin": ("float", "X of the first point, mm."),
    "ybegin": ("float", "Y of the first point, mm."),
    "zbegin": ("float", "Z of the first point, mm."),
    "xend": ("float", "X of the point, mm."),
    "yend": ("float", "Y of the point, mm."),
    "zend": ("float", "Z of the point, mm."),
    "xcenter": ("float", "X of the centre, mm."),
    "ycenter": ("float", "Y of the centre, mm."),
    "xorigin": ("float", "X of the lower left corner, mm."),
    "yorigin": ("float", "Y of the lower left corner, mm."),
    "newxpos": ("float", "X, mm."),
    "newypos": ("float", "Y, mm."),
    "newzpos": ("float", "Z, mm."),
    "oXpos": ("float", "X of the entry, mm."),
    "oYpos": ("float", "Y of the entry, mm."),
    # motions
    "rapid.laser": ("float or str", "Other than 0, such as 'laser': the tool is off during the motion."),
    "feed": ("float", "Feed of the cut, mm/min."),
    "cutline.feed": ("float, optional", "Feed of the cut, mm/min. Default: that of the tool."),
    "f": ("float", "Feed, mm/min."),
    "cutoneaxis_setfeed.axis": ("{'X', 'Y', 'Z'}", "The axis."),
    "cutoneaxis_setfeed.depth": ("float", "The position on that axis, mm."),
    "setrotary.a": ("float or None", "Angle of the A axis, degrees."),
    "setlaserpower.power": ("float", "Power in the units of the S word of the controller; 0: no laser."),
    "setlaserpower.mode": ("{'dynamic', 'constant'}", "M4 or M3."),
    # arcs
    "radius": ("float", "Radius, mm; above 0."),
    "barc": ("float", "Angle of the start, degrees, counter-clockwise from +X."),
    "earc": ("float", "Angle of the end, degrees, counter-clockwise from +X."),
    "anglebegin": ("float", "Angle of the start, degrees, counter-clockwise from +X."),
    "endangle": ("float", "Angle of the end, degrees, counter-clockwise from +X."),
    "tpzreldim": ("float", "Change of Z along the arc, mm; below 0: downwards."),
    "stepsizearc": ("float", "Without effect: arcs are arcs. Above 0."),
    "cutcircle.bz": ("float", "Z of the start, mm."),
    "cutcircle.ez": ("float", "Z of the end, mm; other than `bz`: a turn of a helix."),
    # tools
    "tn": ("int", "Number of the tool whose drawing it is; may be left out."),
    "tool_num": ("int", "Number of the tool; may be left out."),
    "tool_number": ("int", "Number of the tool, of the maker or Kerf's; see the manual's page tools."),
    "toolnumber": ("int", "Number of the tool."),
    "toolchange.speed": ("float", "Speed of the spindle, rpm."),
    "ptd_tool": ("int", "Number of the tool."),
    "ptd_depth": ("float", "Height above the tip of the tool, mm; at least 0."),
    "diameter": ("float", "Diameter, mm; above 0."),
    "flute": ("float", "Length of the flute, mm; above 0."),
    "shaft": ("float", "Length of the shaft above the flute, mm."),
    "offset": ("float", "Without effect."),
    "shaftdiameter": ("float", "Diameter of the shaft, mm."),
    "shaftlength": ("float", "Length of the shaft above the flute, mm."),
    "narrowdiameter": ("float", "Diameter of the neck, mm."),
    "narrowflute": ("float", "Length of the neck, mm."),
    "tipdiameter": ("float", "Diameter of the tip, mm."),
    "toolingdiameter": ("float", "Diameter at the upper end of the flute, mm."),
    "transition": ("float", "Height of the cone between flute and shaft, mm."),
    "tooltype": ("{'mill', 'crmill', 'chamfer', 'drill'}", "The shape; it decides what the numbers are."),
    "first": ("float", "The first number of the shape, mm or degrees."),
    "second": ("float", "The second number of the shape, mm or degrees."),
    "third": ("float", "The third number of the shape, mm or degrees."),
    "fourth": ("float", "The fourth number of the shape, mm or degrees."),
    "settoolparameters.length": ("float", "Length of the shape, mm."),
    # rectangles, pockets, outlines
    "xwidth": ("float", "Size in X, mm; above 0."),
    "yheight": ("float", "Size in Y, mm; above 0."),
    "zdepth": ("float", "Depth below `bz`, mm; above 0."),
    "corners": (
        "{'Square', 'Fillet', 'Chamfer', 'Flipped Fillet'}",
        "Form of the corners; their size is `radius`.",
    ),
    "entry": (
        "{'plunge', 'ramp', 'trochoidal'}",
        "How the tool goes down: straight, along the outline, or by loops within a slot.",
    ),
    "cutpocket.entry": ("{'plunge', 'ramp', 'helix', 'trochoidal'}", "How the tool goes down."),
    "slot": ("float", "Width of the slot of 'trochoidal', mm; 0: 1.5 times the diameter of the tool."),
    "outline": (
        "list",
        "A closed outline: a point (x, y), then points (x, y) and arcs (via x, via y, x, y), mm, such as "
        "those of `gcodepreview.shapes`.",
    ),
    "stepover": ("float", "Distance of passes as a fraction of the tool's diameter, above 0."),
    "cutoutline.offset": ("{'none', 'outside', 'inside'}", "Side of the outline, by the tool's radius."),
    "cutoutline.corners": (
        "{'dog-bone', 't-bone'}, optional",
        "Room in the inner corners for a square part. Default: none.",
    ),
    "cutpocket.corners": (
        "{'dog-bone', 't-bone'}, optional",
        "Room in the corners for a square part. Default: none.",
    ),
    "control": ("list of (float, float)", "The control points, mm; the first and the last are its ends."),
    # text
    "string": ("str", "The text; lines are separated by line breaks."),
    "height": ("float", "Height of capitals, mm; above 0."),
    "font": ("str", "A font of single strokes: 'sans', or another; an unknown name lists them."),
    "spacing": ("float", "Added between letters, mm."),
    "width": ("float", "Factor of the letters' width; above 0."),
    "cuttext.bx": ("float", "X of the left end of the base line, mm."),
    "cuttext.by": ("float", "Y of the base line, mm."),
    "dxftext.bx": ("float", "X of the left end of the base line, mm."),
    "dxftext.by": ("float", "Y of the base line, mm."),
    # keyholes, holes
    "kh_tool_num": ("int", "Number of the keyhole cutter, which must be the tool in use."),
    "dxfKH.kh_tool_num": ("int", "Number of the keyhole cutter; may be left out."),
    "kh_start_depth": ("float", "Depth below Z0 down to which the tool moves rapidly, mm; above 0, or 0."),
    "kh_max_depth": ("float", "Depth of the slot below Z0, mm; above 0."),
    "kh_angle": ("float", "Direction of the slot from the entry, degrees, counter-clockwise from +X."),
    "kht_direction": ("{'N', 'S', 'E', 'W'}", "Direction of the slot from the entry: +Y, -Y, +X, -X."),
    "kh_distance": ("float", "Length of the slot from centre to centre, mm; above 0."),
    "cutcountersink.diameter": ("float", "Diameter at the surface `bz`, mm."),
    "cutcountersink.angle": ("float", "Angle between the sides, degrees."),
    "cutcountersink.bz": ("float", "Z of the surface, mm."),
    "cutthread.diameter": ("float", "Nominal diameter of the thread, mm."),
    "cutthread.pitch": ("float", "Rise of a turn, mm; above 0."),
    "cutthread.zdepth": ("float", "Depth of the lowest point of the tool below `bz`, mm; above 0."),
    "cutthread.hand": ("{'right', 'left'}", "Hand of the thread."),
    # joints
    "fit": ("float", "Clearance of the joint, mm; 0: none."),
    "Joint_Width": ("float", "Length of the joint, mm; above 0."),
    "stockZthickness": ("float", "Thickness of the boards, mm; above 0."),
    "Number_of_Dovetails": ("int", "Count of dovetails; at least 1."),
    "Spacing": ("float", "Distance between the two boards in the stock, mm; above 0."),
    "Proportion": ("float", "Depth of the sockets as a fraction of the thickness; above 0, below 1."),
    "DTT_diameter": ("float", "Diameter of the dovetail tool at its tip, mm."),
    "DTT_angle": ("float", "Angle of its side from its axis, degrees."),
    "orientation": ("{'Vertical', 'Horizontal'}", "Direction of the joint's line: along Y, along X."),
    "side": (
        "{'Left', 'Right', 'Both', 'Lower', 'Upper'}",
        "Side of the line: 'Left', 'Right' of a vertical one, 'Lower', 'Upper' of a horizontal one; or both.",
    ),
    "Joint.bx": ("float", "X of the start of the joint's line, mm."),
    "Joint.by": ("float", "Y of the start of the joint's line, mm."),
    "Joint.width": ("float", "Length of the joint, mm; above 0."),
    "thickness": ("float", "Thickness of the boards, mm; above `smallDiameter`."),
    "Number_of_Pins": ("int", "Count of pins; at least 1."),
    "Finger_Origin": ("float", "Distance of the first finger from the start of the line, mm."),
    "smallDiameter": ("float", "Diameter of the square tool, mm."),
    "largeVdiameter": ("float", "Diameter of the large V, mm: a V of 90 degrees cuts half of it deep."),
    "normalormirror": (
        "{'Default', 'Even', 'Odd'}",
        "Which slots are cut. 'Default': odd ones on the right or upper side, else even ones.",
    ),
    "squaretool": ("int", "Number of the square tool."),
    "smallV": ("int", "Number of the small V."),
    "largeV": ("int", "Number of the large V."),
    "cutfingers.width": ("float", "Length of the edge, mm; above 0."),
    "cutfingers.depth": ("float", "Thickness of the other board, mm; above 0."),
    "cutfingers.count": ("int", "Count of fingers and slots together; odd."),
    "cutfingers.first": ("bool", "Whether fingers are at both ends; the other board has False."),
    "cutfingers.fit": ("float", "Clearance between a finger and each side of its slot, mm."),
    "cutfingers.corners": (
        "{'dog-bone', 't-bone'} or None",
        "Room in the corners for square fingers; None: none.",
    ),
    "cutfingers.edge": ("{'lower', 'upper'}", "Which edge of the board it is."),
    "cutfingers.bx": ("float", "X of the left end of the edge, mm."),
    "cutfingers.by": ("float", "Y of the left end of the edge, mm."),
    # stock
    "stockXwidth": ("float", "Size of the block in X, mm; above 0."),
    "stockYheight": ("float", "Size of the block in Y, mm; above 0."),
    "shiftX": ("float", "Distance in X, mm."),
    "shiftY": ("float", "Distance in Y, mm."),
    "shiftZ": ("float", "Distance in Z, mm."),
    "addtostock.stockZthickness": ("float", "Size of the block in Z, mm; above 0."),
    "addtostock.shiftX": ("float", "X of the block's lowest corner, mm."),
    "addtostock.shiftY": ("float", "Y of the block's lowest corner, mm."),
    "addtostock.shiftZ": ("float", "Z of the block's lowest corner, mm."),
    "flipstock.axis": ("{'x', 'y'}", "Direction of the axis about which the stock is turned over."),
    "across": (
        "float, optional",
        "Position of the axis: its Y along 'x', its X along 'y', mm. Default: the " "centre of the block.",
    ),
    "z": ("float, optional", "Z of the axis, mm. Default: the centre of the block."),
    # files and choices
    "basefilename": ("str", "Name of the file without its ending."),
    "opengcodefile.currenttoolnum": ("int", "Number of the first tool."),
    "opengcodefile.toolradius": ("float", "Without effect: the tool has its own radius."),
    "opengcodefile.plunge": ("float", "Feed of cuts straight down, mm/min."),
    "opengcodefile.feed": ("float", "Feed of other cuts, mm/min."),
    "opengcodefile.speed": ("float", "Speed of the spindle, rpm."),
    "further": ("str", "Further parts of the line."),
    "text": ("str", "The text; one line."),
    "setpost.name": ("str", "A controller of `kerf.posts()`, or a post file (.toml)."),
    "setdebug.enable": ("bool", "Whether `debug` prints."),
    "setdxflayer.layer": ("str, optional", "Name of the layer. Default: a layer for each colour."),
    "setdxfoptions.version": ("{'r2000', 'r12'}", "Version of the DXF files."),
    "setdxfoptions.layers": ("{'colour', 'tool', 'depth'}", "What has a layer of its own."),
    "setdxfoptions.joined": ("bool", "Whether lines and arcs that meet become polylines."),
    "setdxfoptions.stagger": ("bool", "Whether colours are drawn beside each other."),
    "feedratio": ("float", "Percent of the feeds, 1 to 999."),
    "speedratio": ("float", "Percent of the extrusion, 1 to 999."),
    # printing
    "temperature": ("float", "Temperature, degrees C."),
    "percent": ("float", "Progress, 0 to 100 percent."),
    "command": (
        "str, optional",
        "The printer's macro, a line of G-code. Default: the command of the firmware.",
    ),
    "fan": ("int", "Number of the fan."),
    "setfanspeed.speed": ("float", "Speed, 0 to 255."),
    "message": ("str", "The text; one line."),
    "acceleration": ("float", "Acceleration, mm/s2."),
    "setextrusionabsolute.acceleration": ("bool", "Without effect."),
    "enabled": ("bool", "Whether the sensor stops the printer."),
    "nozzlediameter": ("float", "Diameter of the nozzle, mm."),
    "filamentdiameter": ("float", "Diameter of the filament, mm."),
    "extrusionwidth": ("float", "Width of the usual bead, mm."),
    "layerheight": ("float", "Height of the usual bead, mm."),
    "extrude.extrusionwidth": ("float", "Width of the bead, mm; 0: the usual one."),
    "extrude.layerheight": ("float", "Height of the bead, mm; 0: the usual one."),
    "extrude.feedrate": ("float", "Feed, mm/min; 0: the usual one."),
    "extrusiontype": ("{'relative', 'absolute'}, optional", "Mode of the extruder."),
    "extruder_temperature": ("float, optional", "Temperature of the nozzle, degrees C."),
    "bed_temperature": ("float, optional", "Temperature of the bed, degrees C."),
    "printer_name": ("str, optional", "Name of the printer."),
    "Base_filename": ("str, optional", "Name of the G-code file without its ending."),
    "liftfeed": ("float", "Feed of the lift, mm/min."),
    "extrusionfeed": ("float", "Feed of the filament, mm/min."),
    "length": ("float", "Length of filament, mm."),
    "feedrate": ("float", "Feed of the filament, mm/min."),
    "print_speed": ("float", "Feed of the beads, mm/min."),
}

# Other arguments, by the end of their name: "DT_tool_num".
OTHERS = {"num": ("int", "Number of the tool of a drawing of its own; 0: none.")}

# Families of commands with common rows "family.argument".
FAMILIES = {
    "cutcircle": re.compile(r"cutcircleC"),
    "Joint": re.compile(r"Full_Blind_Finger_Joint|Finger_Joint_square"),
}

# Commands with a value other than moves.
VALUES = {
    "xpos": ("float", "X, mm."),
    "ypos": ("float", "Y, mm."),
    "zpos": ("float", "Z, mm."),
    "tool_diameter": ("float", "The diameter, mm."),
    "tool_radius": ("float", "The radius, mm."),
}

_MOTIONS = re.compile(
    r"rapid|cut|arcC|movetosafeZ|moveatfeedrate|begintoolpath|endtoolpath|extrude|gcodearc"
    r"|(Full_Blind_)?Finger_Joint|liftandprime"
)

RAISES = [
    "GcodePreviewError",
    "    If a value is refused; the message names the argument.",
    "TypeError",
    "    If an argument is missing, unknown or of a wrong type.",
]

_START = """\
>>> from gcodepreview import *
>>> gcp = gcodepreview("cut", True, True)
>>> gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
>>> gcp.toolchange({tool}, 16000)
"""
_MILL = "201"
# What a user copies: the number of the tool, then the lines of the example.
EXAMPLES = {
    "rapid": (_MILL, ">>> moves = gcp.rapid(10, 10, 5)\n>>> moves[-1].end\n(10.0, 10.0, 5.0)"),
    "cutline": (
        _MILL,
        ">>> moves = gcp.rapid(10, 10, 5)\n>>> moves = gcp.cutline(10, 10, -3)\n"
        ">>> moves = gcp.cutline(90, 10, -3, feed=800)\n>>> gcp.xpos(), gcp.ypos(), gcp.zpos()\n"
        "(90.0, 10.0, -3.0)",
    ),
    "cutlinedxf": (
        _MILL,
        ">>> moves = gcp.rapid(10, 10, 5)\n>>> moves = gcp.cutline(10, 10, -3)\n"
        '>>> moves = gcp.cutlinedxf(90, 10, -3)\n>>> b"LINE" in gcp.dxf()\nTrue',
    ),
    "cutarcCC": (
        _MILL,
        ">>> moves = gcp.rapid(70, 30, 5)\n>>> moves = gcp.cutline(70, 30, -2)\n"
        ">>> moves = gcp.cutarcCC(0, 180, 50, 30, 20, 0)\n>>> round(gcp.xpos(), 6)\n30.0",
    ),
    "cutquarterCCNE": (
        _MILL,
        ">>> moves = gcp.rapid(70, 30, 5)\n>>> moves = gcp.cutline(70, 30, -2)\n"
        ">>> moves = gcp.cutquarterCCNE(50, 50, -2, 20)\n>>> round(gcp.ypos(), 6)\n50.0",
    ),
    "cutcircleCC": (
        _MILL,
        ">>> moves = gcp.rapid(65, 30, 5)\n>>> moves = gcp.cutcircleCC(50, 30, 0, -2, 15)\n"
        ">>> gcp.xpos(), gcp.zpos()\n(65.0, -2.0)",
    ),
    "cutrectangle": (
        _MILL,
        ">>> moves = gcp.rapid(20, 20, 5)\n>>> moves = gcp.cutrectangle(20, 20, 0, 60, 20, 3)\n"
        ">>> gcp.zpos()\n-3.0",
    ),
    "cutrectanglerounddxf": (
        _MILL,
        ">>> moves = gcp.rapid(20, 20, 5)\n>>> moves = gcp.cutrectanglerounddxf(20, 20, 0, 60, 20, 3, 5)\n"
        ">>> gcp.zpos()\n-3.0",
    ),
    "cutpocket": (
        _MILL,
        '>>> moves = gcp.cutpocket(shapes.circle(50, 30, 15), 0, 3, entry="helix")\n'
        ">>> result = gcp.simulate()\n>>> len(result.hazards)\n0",
    ),
    "cutoutline": (
        _MILL,
        '>>> moves = gcp.cutoutline(shapes.heart(50, 15, 30), 0, 3, offset="outside")\n'
        ">>> min(move.end[2] for move in moves)\n-3.0",
    ),
    "cuttext": (
        "301",
        '>>> moves = gcp.cuttext("Kerf", 10, 20, 15, 0, 1)\n>>> min(move.end[2] for move in moves)\n-1.0',
    ),
    "cutkeyholegcdxf": (
        "374",
        '>>> moves = gcp.rapid(50, 30, 5)\n>>> moves = gcp.cutkeyholegcdxf(374, 0, 6, "N", 15)\n'
        ">>> gcp.xpos(), gcp.ypos(), gcp.zpos()\n(50.0, 30.0, 5.0)",
    ),
    "cutfingers": (
        _MILL,
        ">>> moves = gcp.cutfingers(60, 10, 3, 0, 12.7, fit=0.1, bx=20, by=20)\n"
        ">>> round(min(move.end[2] for move in moves), 6)\n-12.7",
    ),
    "cut_tails": (
        "814",
        ">>> moves = gcp.cut_tails(60, 12.7, 2, 20, 0.6, 12.7, 14, fit=0.1)\n>>> len(moves) > 10\nTrue",
    ),
    "Full_Blind_Finger_Joint": (
        "102",
        '>>> moves = gcp.Full_Blind_Finger_Joint(20, 10, "Vertical", "Both", 40, 6, 12.7, 3.175)\n'
        ">>> sorted({move.tool for move in moves})\n[102, 301, 390]",
    ),
    "dxfline": (_MILL, '>>> gcp.dxfline(0, 0, 50, 30)\n>>> b"LINE" in gcp.dxf()\nTrue'),
    "dxfarc": (_MILL, '>>> gcp.dxfarc(50, 30, 10, 0, 90)\n>>> b"ARC" in gcp.dxf()\nTrue'),
    "dxfcircle": (_MILL, '>>> gcp.dxfcircle(50, 30, 10)\n>>> b"CIRCLE" in gcp.dxf()\nTrue'),
    "dxfrectangle": (
        _MILL,
        '>>> gcp.dxfrectangle(10, 10, 80, 40, "Fillet", 5)\n>>> b"LWPOLYLINE" in gcp.dxf()\nTrue',
    ),
    "beginpolyline": (
        _MILL,
        ">>> gcp.beginpolyline(10, 10)\n>>> gcp.addvertex(90, 10)\n>>> gcp.addvertex(50, 50)\n"
        '>>> gcp.closepolyline()\n>>> b"LWPOLYLINE" in gcp.dxf()\nTrue',
    ),
}


def _row(command, argument):
    """Type and text of an argument of a command, if it has a row."""
    families = [name for name, names in FAMILIES.items() if names.match(command)]
    for name in [command, *families]:
        if (found := ARGUMENTS.get(f"{name}.{argument}")) is not None:
            return found
    return ARGUMENTS.get(argument) or OTHERS.get(argument.rpartition("_")[2])


@functools.lru_cache(maxsize=None)
def _wrapped(text):
    return textwrap.fill(text, 100, initial_indent="    ", subsequent_indent="    ")


def _section(name, lines):
    return ["", name, "-" * len(name), *lines]


def with_sections(text: str, rows: Any, returns: Any, example: str = "") -> str:
    """A text with the sections of numpydoc: rows of (argument, type, meaning), the type and meaning of the
    result, and the lines of an example.
    """
    lines = [text.strip()]
    if rows and "Parameters\n" not in text:
        described = [f"{name} : {kind}\n{_wrapped(meaning)}" for name, kind, meaning in rows]
        lines += _section("Parameters", described)
    if returns:
        lines += _section("Returns", [returns[0], _wrapped(returns[1])])
    lines += _section("Raises", RAISES)
    if example:
        lines += _section("Examples", [example])
    return "\n".join(lines)


def docstring(name: str, signature: str, text: str) -> str:
    """The docstring of a command: its own text with the sections that it has not yet."""
    # "($self, ex, feed=None, *further)": the default values have no commas.
    rows = []
    for part in signature.strip("()").split(",")[1:]:
        argument = part.strip().split("=")[0]
        rows.append((argument, *(_row(name, argument.lstrip("*")) or ("object", ""))))
    tool, example = EXAMPLES.get(name, ("", ""))
    return with_sections(text, rows, _result(name), example and _START.format(tool=tool) + example)


def _result(name):
    if name in VALUES or not _MOTIONS.match(name):
        return VALUES.get(name)
    return ("Moves", "The motions that the call has appended to the toolpath.")


def _method(name, command):
    @functools.wraps(command)
    def call(self: Any, *args: Any, **kwargs: Any) -> Any:
        return command(self, *args, **kwargs)

    call.__doc__ = docstring(name, command.__text_signature__, command.__doc__ or "")
    return call


def with_commands(cls: type[_Class]) -> type[_Class]:
    """The class with a method for each command of the machine that it has not itself, with its sections."""
    for name, command in vars(_kerf.Machine).items():
        if not name.startswith("_") and inspect.ismethoddescriptor(command) and name not in vars(cls):
            setattr(cls, name, _method(name, command))
    return cls

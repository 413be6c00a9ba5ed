"""Operations: programs that cut regions, outlines, points and meshes, and changes of finished programs.

Each returns a `Program`, to be simulated, checked, changed, joined and posted. Lengths are mm, feeds mm/min,
angles degrees; a text has a unit of its own: ``"1/4in"``, ``"60ipm"``. Z points up.

Examples
--------
>>> plate = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)], (30, 20, 8)], fill="even_odd")
>>> holes = kerf.op.drill([(8, 8), (52, 32)], kerf.Tool("drill d=4", number=2), depth=6, feed=100)
>>> part = kerf.op.contour(plate, "square d=6", depth=6, stepdown=2, feed=900, tab_height=1.5)
>>> kerf.post(kerf.op.join(holes, part), "grbl", "plate.nc")
['plate.nc']
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal

from . import _cuts, _kerf, _operations
from ._cuts import *  # noqa: F403
from ._kerf import Program
from ._types import AnyProgram, AnyTools, PathName, Position, Row, Rows
from ._units import number

# Steps and messages name the line of the user's script, not lines of these files.
for _module in (_cuts, _operations):
    _kerf._library_file(_module.__file__)
_kerf._library_file(__file__)

__all__ = [
    *_cuts.__all__,
    "add_leads",
    "add_tabs",
    "align",
    "join",
    "level",
    "order",
    "probing",
    "repeat",
    "resume",
    "reverse_loops",
    "step_down",
    "text_outlines",
    "transform",
]


def text_outlines(
    text: str,
    height: float | str,
    *,
    font: str = "sans",
    at: Position = (0, 0),
    text_angle: float | str = 0.0,
    align: Literal["left", "centre", "right"] = "left",
    letter_spacing: float | str = 0.0,
) -> list[list[tuple[float, ...]]]:
    """The outlines of a text.

    Parameters
    ----------
    text : str
        A line feed starts the next line.
    height : float or str
        Height of capital letters, mm.
    font : str
        Single strokes for `engrave`: 'sans', 'sans-2', 'script', 'script-2', 'serif', 'serif-bold',
        'serif-italic', 'serif-bold-italic'. With a dot the path of an outline font (.ttf, .otf), for
        `v_carve`, `pocket` and `contour`.
    at : (float or str, float or str)
        The left end, centre or right end of the first baseline, mm.
    text_angle : float or str
        Direction of the baseline, from +X, degrees.
    align : {'left', 'centre', 'right'}
    letter_spacing : float or str
        Added between characters, mm.

    Returns
    -------
    list of outlines
        As in `Region`.

    Raises
    ------
    OSError
        If the font file cannot be read.
    kerf.Error
        If the font does not have a character, or a size is out of range.

    Examples
    --------
    >>> word = kerf.op.text_outlines("KERF", 12, at=(10, 10))
    >>> sign = kerf.op.engrave(word, "V d=6 angle=60", depth=0.4, feed=600)
    """
    options = dict(text=text, height=height, font=font, at=at, text_angle=text_angle, align=align)
    return _kerf._text({**options, "letter_spacing": letter_spacing})


def join(*programs: AnyProgram) -> Program:
    """One program after another.

    From the end of each the tool rises to the first height of the next, or stays higher, and moves across
    before it goes down. Spindle and coolants are switched off between them.

    Parameters
    ----------
    *programs : Program or Toolpath
        The programs in their order.

    Returns
    -------
    Program
        One program with the steps of all.

    Raises
    ------
    ValueError
        If a tool number has different shapes in two programs.
    kerf.Error
        If a program starts with a cut, or sets a work zero.

    Examples
    --------
    >>> holes = kerf.op.drill([(8, 8)], kerf.Tool("drill d=4", number=2), depth=6, feed=100)
    >>> pocket = kerf.op.pocket([(30, 20, 10)], "square d=6", depth=4, feed=900)
    >>> sorted(kerf.op.join(holes, pocket).tools)
    [1, 2]
    """
    return _kerf._joined(*programs)


_ARGUMENTS = {  # of the functions below, that are not called as the options of the command
    "step-down": "depth",
    "tab-height": "height",
    "tab-length": "length",
    "tabs": "count",
    "tab-spacing": "spacing",
    "tab-shape": "shape",
    "lead-kind": "kind",
    "from-line": "line",
}


def _changed(program, tools=None, **options):
    return _kerf._rework(program, options, tools, _ARGUMENTS)


def step_down(
    program: AnyProgram,
    depth: float | str,
    *,
    top: float | str = 0.0,
    entry: Literal["plunge", "ramp", "helix"] = "plunge",
    entry_angle: float | str = 3.0,
    helix_radius: float | str | None = None,
    part: Literal["right", "left"] = "right",
    tools: AnyTools | None = None,
) -> Program:
    """Cut each chain of cuts in passes.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    depth : float or str
        Maximum depth of a pass, mm.
    top : float or str
        Z of the surface, mm.
    entry : {'plunge', 'ramp', 'helix'}
        'ramp': chains that start with a plunge go down back and forth along their first part instead;
        'helix': around a circle beside their start, where that crosses no closed path.
    entry_angle : float or str
        Maximum descent of ramps and helices, degrees.
    helix_radius : float or str, optional
        Radius of the tool's axis in a helix, mm. Default: 0.45 times the diameter of the tool.
    part : {'right', 'left'}
        Side of the direction of travel on which the part is; helices are on the other one.
    tools : Tool, str, ToolTable or list of them, optional
        For the default radius; see `kerf.check`.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        A value is out of range.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> len(kerf.op.step_down(program, 1)) > len(program)
    True
    """
    return _changed(
        program,
        tools,
        step_down=depth,
        top=top,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        part=part,
    )


def add_leads(
    program: AnyProgram,
    lead: float | str | None = None,
    *,
    lead_out: float | str | None = None,
    kind: Literal["arc", "line"] = "arc",
    overlap: float | str | None = None,
    finish: float | str | None = None,
    top: float | str = 0.0,
    part: Literal["right", "left"] = "right",
) -> Program:
    """Give closed paths leads, an overlap and a finishing pass.

    Paths are changed that are chains of their own: straight down, then once around on one level, between
    rapids above the material.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    lead : float or str, optional
        Radius of the arcs, or length of the lines, that lead to a path and off it, mm.
    lead_out : float or str, optional
        Size of the way off the path, where it differs, mm; 0: none.
    kind : {'arc', 'line'}
    overlap : float or str, optional
        How far the tool continues along a path beyond its start, mm.
    finish : float or str, optional
        Distance from the part of all cuts but the last one around it, mm.
    top : float or str
        Z of the surface, mm.
    part : {'right', 'left'}
        Side of the direction of travel on which the part is.

    Returns
    -------
    Program
        Without depth per pass: for `finish` and `step_down` together see `kerf.rework`.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> led = kerf.op.add_leads(program, 3, overlap=1)
    """
    return _changed(
        program,
        lead=lead,
        lead_out=lead_out,
        lead_kind=kind,
        overlap=overlap,
        finish=finish,
        top=top,
        part=part,
    )


def add_tabs(
    program: AnyProgram,
    height: float | str,
    *,
    length: float | str | None = None,
    count: int = 4,
    spacing: float | str | None = None,
    shape: Literal["rectangular", "triangular"] = "rectangular",
    tools: AnyTools | None = None,
) -> Program:
    """Leave tabs on closed paths that are cut to the lowest level.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    height : float or str
        Height of tabs above the bottom, mm.
    length : float or str, optional
        Length of the material that remains, mm. Default: the diameter of the tool.
    count : int
        On each path.
    spacing : float or str, optional
        Distance of tabs instead of their number, mm.
    shape : {'rectangular', 'triangular'}
    tools : Tool, str, ToolTable or list of them, optional
        Their diameters must be known; see `kerf.check`.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        A value is out of range.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> held = kerf.op.add_tabs(program, 1.5, count=3)
    """
    return _changed(
        program, tools, tab_height=height, tab_length=length, tabs=count, tab_spacing=spacing, tab_shape=shape
    )


def order(program: AnyProgram, *, tools: AnyTools | None = None) -> Program:
    """Order the cuts of each tool by short rapids, inner contours before those around them.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    tools : Tool, str, ToolTable or list of them, optional
        Cuts nearer to each other than the tool is wide keep their order; see `kerf.check`.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> ordered = kerf.op.order(program)
    """
    return _changed(program, tools, order=True)


def transform(
    program: AnyProgram,
    *,
    scale: float = 1.0,
    mirror: Literal["x", "y"] | None = None,
    rotate: float | str = 0.0,
    centre: Position = (0, 0),
    move: Position = (0, 0, 0),
) -> Program:
    """Scale, mirror, rotate and move a program, in this order.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    scale : float
        Factor of X and Y, above 0.
    mirror : {'x', 'y'}, optional
        The axis that changes its sign. Climb becomes conventional: see `reverse_loops`.
    rotate : float or str
        Counter-clockwise, degrees.
    centre : (float or str, float or str)
        Centre of scale, mirror and rotate, mm.
    move : sequence of 2 or 3 float or str
        mm.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        A value is out of range.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> moved = kerf.op.transform(program, rotate=90, move=(100, 0))
    """
    return _changed(program, scale=scale, mirror=mirror, rotate=rotate, centre=centre, move=move)


def align(program: AnyProgram, points: Sequence[tuple[Row, Row]]) -> Program:
    """Rotate and move a program to where probed points show the workpiece.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    points : sequence of ((float, float), (float, float))
        Points of the program and where they were measured, mm. One moves the program; more rotate it too,
        by least squares. A point more than 0.1 mm from where it belongs is a warning.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        A value is out of range.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> aligned = kerf.op.align(program, [((0, 0), (0.2, -0.1)), ((60, 0), (60.2, -0.1))])
    """
    texts = (f"{float(a[0])!r},{float(a[1])!r}={float(b[0])!r},{float(b[1])!r}" for a, b in points)
    return _changed(program, align=";".join(texts))


def reverse_loops(program: AnyProgram) -> Program:
    """Cut closed paths in the opposite direction: climb becomes conventional and the other way round.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> conventional = kerf.op.reverse_loops(program)
    """
    return _changed(program, reverse_loops=True)


def repeat(program: AnyProgram, columns: int = 1, rows: int = 1, *, pitch: Position) -> Program:
    """Repeat a program in rows and columns; all copies are cut with one tool before the next is changed.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    columns, rows : int
        Along X and Y.
    pitch : (float or str, float or str)
        From one copy to the next, mm.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        A value is out of range.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> four = kerf.op.repeat(program, 2, 2, pitch=("3in", 50))
    """
    return _changed(program, columns=columns, rows=rows, pitch=pitch)


def resume(program: AnyProgram, line: int, *, safe_z: float | str) -> Program:
    """The rest of a program from a line on: tool, spindle and coolant as before it, and a safe approach.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    line : int
        Line in the program's text, from 1.
    safe_z : float or str
        Z at which rapids across are free, mm.

    Returns
    -------
    Program
        The program from that line on.

    Raises
    ------
    kerf.Error
        If no motion follows, or the position before the line is unknown.

    Examples
    --------
    >>> program = kerf.load("part.nc")
    >>> rest = kerf.op.resume(program, 4, safe_z=5)
    """
    return _changed(program, from_line=line, safe_z=safe_z)


def level(
    program: AnyProgram,
    heights: PathName | Rows,
    *,
    max_correction: float | str = 2.0,
    keep_above: float | str | None = None,
    work_offset: Row | None = None,
) -> tuple[Program, dict[str, Any]]:
    """Let a program follow a measured surface.

    Parameters
    ----------
    program : Program or Toolpath
        The program to level; it stays as it is.
    heights : str, os.PathLike or sequence of (float, float, float)
        A file (x y z lines, .probe, the log of a controller with its answers to `probing`), or the points,
        mm.
    max_correction : float or str
        A larger correction is an error, mm.
    keep_above : float or str, optional
        Motions whose ends are at this Z or above stay, mm.
    work_offset : (float, float, float), optional
        The work zero in machine coordinates, for a log without it, mm.

    Returns
    -------
    (Program, dict)
        `lowest_mm`, `highest_mm` (corrections of cuts) with `lowest_at`, `highest_at`; `divided` (motions
        that became several), `unchanged` (motions at unknown positions), `outside_mm` (distance of cuts
        from the measured area).

    Raises
    ------
    kerf.Error
        If the file cannot be read, or a correction is too large.

    Examples
    --------
    >>> disc = kerf.Region([(30, 20, 10)])
    >>> program = kerf.op.contour(disc, "square d=6", depth=4, feed=900)
    >>> points = [(0, 0, 0.1), (60, 0, 0.1), (60, 40, 0.1), (0, 40, 0.1)]
    >>> levelled, figures = kerf.op.level(program, points)
    >>> round(figures["highest_mm"], 6)
    0.1
    """
    if isinstance(heights, (str, bytes, os.PathLike)):
        heights = os.fsencode(heights)
    max_correction = number(max_correction, "max_correction")
    keep_above = None if keep_above is None else number(keep_above, "keep_above")
    return _kerf._level(program, heights, max_correction, keep_above, work_offset)


def probing(
    over: AnyProgram | Rows,
    columns: int = 5,
    rows: int = 5,
    *,
    margin: float | str = 0.0,
    clearance: float | str = 5.0,
    depth: float | str = 2.0,
    feed: float | str = 50.0,
) -> Program:
    """A program that measures the heights of a grid, for `level`.

    The work zero is on the surface when it starts.

    Parameters
    ----------
    over : Program, Toolpath or two points (float, float)
        The cuts that the grid covers, or opposite corners of its area, mm.
    columns, rows : int
        2 to 200.
    margin : float or str
        Around the cuts, mm.
    clearance : float or str
        Height of rapids, mm.
    depth : float or str
        Below zero, where probing ends, mm.
    feed : float or str
        Feed of probing, mm/min.

    Returns
    -------
    Program
        A program that probes the points.

    Examples
    --------
    >>> grid = kerf.op.probing([(0, 0), (60, 40)], 4, 3)
    >>> [grid.toolpath[i]["step"] for i in range(len(grid))].count("probe")
    12
    """
    margin, clearance = number(margin, "margin"), number(clearance, "clearance")
    depth, feed = number(depth, "depth"), number(feed, "feed", unit="mm/min")
    return _kerf._probing(over, columns, rows, margin, clearance, depth, feed)

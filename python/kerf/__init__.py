"""Kerf: toolpaths, tools and simulation from Python.

A toolpath is built by calls (`Toolpath`) or read from a file (`load`). `simulate` cuts it out of a `Stock`
and returns the workpiece and its hazards; `check` reports hazards, `estimate` the machining time; `post`
writes a program for a controller or a drawing. A `Region` is a part of the plane bounded by lines and arcs,
with boolean operations, offsets and queries. A `Job` keeps stock, tools, retract plane, feeds and units
together. Lengths are mm, feeds mm/min, angles degrees; Z points up. `inch` is the factor of inches,
``3 * kerf.inch``; operations and jobs take texts such as ``"1/4in"`` and ``"60ipm"`` too.
"""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Literal, Mapping, Sequence

from . import _calls, _kerf

_kerf._library_file(_calls.__file__)
_calls.install(_kerf)  # before the names below are taken from it

if "KERF_VIEW_PROGRAM" in os.environ:  # before the names below are taken from it
    from . import _view

    _view.install()

if "KERF_RUN_WRITTEN" in os.environ:
    from . import _run

    _run.install()

from ._kerf import (
    BezierSurface,
    Burn,
    Diagnostic,
    Drawing,
    DrawingOutlines,
    DrawingWriter,
    Error,
    JobResult,
    LiveSimulation,
    Printer,
    PrintSimulation,
    Program,
    Region,
    RotarySimulation,
    ScadResult,
    Simulation,
    Stock,
    Tool,
    ToolTable,
    Toolpath,
    __version__,
    adjust_heights,
    built_in_tools,
    burn,
    check,
    compare,
    compare_picture,
    config,
    estimate,
    finger_slots,
    fixture_contacts,
    fit_arcs,
    fit_bezier,
    fit_spline,
    flattened,
    job_example,
    parallel,
    path_picture,
    plane_shape,
    plane_shapes,
    point_at,
    posts,
    print_figures,
    printer_profile,
    printers,
    read_drawing,
    read_gcode,
    relieve_corners,
    segments,
    self_meetings,
    simulate,
    simulate_print,
    simulate_rotary,
    surface_rows,
    tool_shapes,
    widen,
)
from . import _compilers, _geometry, _job, _job_tools, _notebook, _operations, op
from ._compilers import adjust_path, check_gcmc, check_pathdxf, gcmc, path_sheet, pathdxf, scad
from ._files import bytes_of, existing, folders_of, texts
from ._job import Job
from ._page import page
from ._progress import progress
from ._sweep import SweepTable, in_background, sweep
from ._types import AnyProgram, AnyTools, Outlines, PathName, Row, Rows
from ._units import inch, mm

# Steps and messages name the line of the user's script, not lines of these files.
_kerf._library_file(__file__)
_kerf._library_file(_job.__file__)
_kerf._library_file(_job_tools.__file__)
_kerf._library_file(_compilers.__file__)
_geometry.install(Region)
_notebook.install((Simulation, PrintSimulation, RotarySimulation), Toolpath, Program, Region)

__all__ = [
    "BezierSurface",
    "Burn",
    "Diagnostic",
    "Drawing",
    "DrawingOutlines",
    "DrawingWriter",
    "Error",
    "Job",
    "JobResult",
    "LiveSimulation",
    "PrintSimulation",
    "Printer",
    "Program",
    "Region",
    "RotarySimulation",
    "ScadResult",
    "Simulation",
    "Stock",
    "SweepTable",
    "Tool",
    "ToolTable",
    "Toolpath",
    "__version__",
    "adjust_heights",
    "adjust_path",
    "built_in_tools",
    "burn",
    "check",
    "check_gcmc",
    "check_pathdxf",
    "compare",
    "compare_picture",
    "config",
    "cut",
    "estimate",
    "finger_slots",
    "fit_arcs",
    "fit_bezier",
    "fit_spline",
    "fixture_contacts",
    "flattened",
    "gcmc",
    "import_printer",
    "in_background",
    "inch",
    "job_example",
    "job_schema",
    "left_stock",
    "load",
    "load_drawing",
    "load_stock",
    "load_tools",
    "mm",
    "move_stock",
    "op",
    "page",
    "parallel",
    "path_picture",
    "path_sheet",
    "pathdxf",
    "plane_shape",
    "plane_shapes",
    "point_at",
    "post",
    "posts",
    "print_figures",
    "printer_profile",
    "printers",
    "progress",
    "read_drawing",
    "read_gcode",
    "relieve_corners",
    "rework",
    "save_left_stock",
    "save_tools",
    "scad",
    "segments",
    "self_meetings",
    "simulate",
    "simulate_print",
    "simulate_rotary",
    "surface_rows",
    "sweep",
    "tool_shapes",
    "widen",
]


def load(
    path: PathName,
    *,
    dialect: str | None = None,
    arc_centres: Literal["offsets", "absolute"] | None = None,
    comp: Mapping[int, float] | None = None,
    read_on: bool = False,
    strict: bool = False,
    filament: float | None = None,
    defines: str | Sequence[str] = (),
    include_paths: str | Sequence[str] = (),
    compat: str = "",
    tools: AnyTools | None = None,
    machine: PathName | None = None,
    measured: PathName | None = None,
    max_correction: float = 1.0,
    work_offset: Row | None = None,
    drawing: Mapping[str, Any] | None = None,
) -> Program:
    """Read a program: G-code, gcmc, a path drawing (.dxf), a cutting job (.toml) or Kerf's own file (.kerf).

    The ending of the file name decides; of an unknown one, the text.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    dialect : str, optional
        The controller of a G-code program: 'linuxcnc', 'grbl' ... Default: detected from its text.
    arc_centres : {'offsets', 'absolute'}, optional
        What I J K of arcs are where G-code does not say so (G90.1, G91.1). Default: offsets from the start,
        unless no arc fits so and all fit as coordinates.
    comp : mapping, optional
        Offsets of G41 and G42 by their D, mm, instead of the tool's radius: ``{1: 0}`` for a program that is
        compensated already (wear).
    read_on : bool
        Read a G-code file to its end, including text after M2 and M30, as senders do.
    strict : bool
        Report suspicious G-code as errors instead of warnings.
    filament : float, optional
        Diameter of a printer's filament, mm. Default: from the program's comments, else 1.75.
    defines : sequence of str
        Statements to run before a gcmc program: ``['depth=5mm']``; variables of a path drawing: ``['A=2']``.
    include_paths : sequence of str
        Folders to search for subroutines of G-code and files included by a gcmc program, after the folder of
        the program.
    compat : {'', '1.8', '1.9'}
        The version of gcmc whose arcs and angles a gcmc program expects; see the manual's page gcmc.
    tools : Tool, str, ToolTable or list of them, optional
        For cutter compensation (G41, G42); see `check`.
    machine : str or os.PathLike, optional
        The machine that will run the program: a profile (TOML), or GRBL's ``$$`` settings.
    measured : str or os.PathLike, optional
        Measured heights for a path drawing: its _Z.txt, or a controller's log.
    max_correction : float
        Maximum deviation of measured from expected heights, mm.
    work_offset : (float, float, float), optional
        The work zero in machine coordinates, for measured heights of a log without it, mm.
    drawing : mapping, optional
        Keywords of `pathdxf` that change what a path drawing mills: ``{'rapid_height': 15, 'feed': 150}``.
        On another program they are an error.

    Returns
    -------
    Program
        The program, with its tools, stock and warnings; positions in mm, work coordinates, Z up.

    Raises
    ------
    OSError
        If the file cannot be read.
    kerf.Error
        If its text has errors; all of them are in its `diagnostics`. Warnings are issued by the module
        `warnings`.

    Examples
    --------
    >>> program = kerf.load("part.nc")
    >>> program.units
    'mm'
    """
    name = existing(path)
    return _kerf._load(
        name,
        dialect=dialect,
        arc_centres=arc_centres,
        comp=dict(comp or {}),
        read_on=read_on,
        strict=strict,
        filament=filament,
        defines=texts(defines, "defines"),
        include_paths=folders_of(include_paths, "include_paths"),
        compat=compat,
        tools=tools,
        machine=machine,
        measured="" if measured is None else existing(measured),
        max_correction=max_correction,
        work_offset=work_offset,
        drawing=_compilers.drawing_options(drawing),
    )


def cut(
    op: str,
    shapes: Outlines | None = None,
    tool: Tool | str | int | None = None,
    *,
    points: Rows | None = None,
    **options: Any,
) -> Program:
    """Make the program of an operation; `kerf.op` has a function for each.

    Parameters
    ----------
    op : str
        'pocket', 'contour', 'engrave', 'drill', 'laser_cut', 'laser_picture' ... (`kerf cut --help`).
    shapes : Region or list, optional
        What is cut: a region, or a list of outlines, each a list of points and arcs or the three numbers of a
        circle, as in `Region`.
    tool : Tool, str or int, optional
        As for `kerf cut --tool`: 'square d=6'. Operations of lasers have none.
    points : sequence, optional
        Where holes are drilled.
    **options
        The keys of job files, with underscores: depth=6, stepdown=2, feed=900, tab_height=1.5.

    Returns
    -------
    Program
        The toolpath of the operation in work coordinates, mm, Z up, with its tool.

    Raises
    ------
    kerf.Error
        An option is missing or out of range, or the tool does not fit.

    Examples
    --------
    >>> plate = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])
    >>> program = kerf.cut('pocket', plate, 'square d=6', depth=4, stepdown=2, feed=900)
    >>> slots = kerf.cut('laser_cut', plate, power=90, feed=300, kerf=0.15, lead=1)
    >>> focus = kerf.cut('laser_test', power=100, feed=1200, feed_to=400, rows=5, cell_width=100)
    """
    return _operations.run(op, shapes, tool, points=points, **options)


def job_schema() -> dict[str, Any]:
    """The JSON schema of job files (.toml), with all operations and their keys.

    Returns
    -------
    dict
        The schema, as of `json.loads`.

    Examples
    --------
    >>> "pocket" in kerf.job_schema()["$defs"]
    True
    """
    return json.loads(_kerf._cut_schema())


def rework(program: AnyProgram, *, tools: AnyTools | None = None, **options: Any) -> Program:
    """Change a finished program: depth per pass, tabs, order, copies, and more.

    Parameters
    ----------
    program : Program or Toolpath
        The program to change; it stays as it is.
    tools : Tool, str, ToolTable or list of them, optional
        Their diameters are needed for tabs and for the order of cuts; see `check`.
    **options
        The options of `kerf post`, with underscores: step_down=2, entry='ramp', tab_height=1.5, tabs=4,
        order=True, rotate=90, mirror='x', move=(10, 0), columns=3, rows=2, pitch=(60, 40), from_line=1200.

    Returns
    -------
    Program
        The changed program.

    Raises
    ------
    ValueError
        An option is unknown or has an invalid value.
    kerf.Error
        The program has motions that cannot be changed.

    Examples
    --------
    >>> deep = kerf.op.engrave([[(0, 0), (50, 0)]], "square d=6", depth=4, feed=900)
    >>> len(kerf.rework(deep, step_down=2)) > len(deep)
    True
    """
    return _kerf._rework(program, options, tools)


def post(
    program: AnyProgram,
    to: str | None = None,
    path: PathName | None = None,
    *,
    unit: Literal["mm", "inch"] | None = None,
    tool_change: Literal["command", "pause", "files", "ignore"] | None = None,
    feed: float = 0.0,
    allow_left_out: bool = False,
    tools: AnyTools | None = None,
    fit_arcs: float = 0.0,
    join: float = 0.0,
    shorten_rapids: bool = False,
    rapids: bool = False,
    dxf_version: Literal["r2000", "r12"] = "r2000",
    variables: Mapping[str, Any] | None = None,
    thumbnails: Sequence[tuple[int, int]] = (),
    printer: str | None = None,
    on_open: Callable[[], Sequence[str]] | None = None,
    on_section: Callable[[int], Sequence[str]] | None = None,
    on_close: Callable[[], Sequence[str]] | None = None,
) -> str | list[str]:
    """Write a program for a controller, or as a drawing seen from above.

    Parameters
    ----------
    program : Program or Toolpath
        What is written.
    to : str, optional
        Required without `printer`: 'grbl', 'linuxcnc' ... (see `posts`), 'dxf', 'svg', 'kerf' (all of the
        program with its tools, for `load`), or the path of a post file (.toml).
    path : str or os.PathLike, optional
        The file to write.
    unit : {'mm', 'inch'}, optional
        Default: that of the post; mm in drawings.
    tool_change : {'command', 'pause', 'files', 'ignore'}, optional
        Default: that of the post; 'files' requires a path.
    feed : float
        Feed of cuts without one, mm/min; 0: such cuts are an error.
    allow_left_out : bool
        Write the program although codes that may move the tool are unknown and left out.
    tools : Tool, str, ToolTable or list of them, optional
        For names in comments, and the sizes of drilled holes in drawings; see `check`.
    fit_arcs : float
        Replace chains of chords by arcs that deviate by at most this distance, mm; 0: do not.
    join : float
        Join straight cuts whose corners deviate by at most this distance, mm; 0: do not.
    shorten_rapids : bool
        Remove rapids that return to their start point.
    rapids : bool
        Draw rapids in drawings.
    dxf_version : {'r2000', 'r12'}
    variables : dict, optional
        Texts and numbers for names in the templates of the post, before its own variables.
    thumbnails : sequence of (int, int)
        Sizes in pixels of pictures of a print in its program.
    printer : str, optional
        Instead of `to`, for prints: the firmware of this printer, with its start and end. A name, or a file
        (.toml), with a filament: ``'ender_3:PLA'``; see `printers`.
    on_open, on_section, on_close : callable, optional
        Return a list of lines to add: ``on_open()`` before the first step, ``on_section(number)`` before each
        change to the tool of that number, ``on_close()`` before the end of the program. Lines that move the
        machine or change how others are read are errors, as those of `Toolpath.verbatim`.

    Returns
    -------
    str or list of str
        The text; with `path` the names of the files written: that path, or with 'files' one per tool.

    Raises
    ------
    ValueError
        If `to` is unknown, if `to` and `printer` are both given or both missing, or if several
        files are to be written and no path is given.
    OSError
        If a file cannot be written.
    kerf.Error
        If the controller cannot run the program.

    Examples
    --------
    >>> program = kerf.load("part.nc")
    >>> "G1" in kerf.post(program, "linuxcnc")
    True
    >>> kerf.post(program, "grbl", "part.gcode", tool_change="pause")
    ['part.gcode']
    """
    if (to is None) == (printer is None):
        raise ValueError("one of to and printer is required, such as to='grbl'")
    name = b"program" if path is None else os.fsencode(path)
    if on_open is not None or on_section is not None or on_close is not None:
        program = _with_hooks(program, on_open, on_section, on_close)
    texts = _kerf._post(
        program,
        os.fsencode(to or ""),
        name,
        unit=unit,
        tool_change=tool_change,
        feed=feed,
        allow_left_out=allow_left_out,
        tools=tools,
        fit_arcs=fit_arcs,
        join=join,
        shorten_rapids=shorten_rapids,
        rapids=rapids,
        dxf_version=dxf_version,
        variables={key: str(value) for key, value in (variables or {}).items()},
        thumbnails=[tuple(size) for size in thumbnails],
        printer=printer,
    )
    if path is None:
        if len(texts) != 1:
            raise ValueError("one file per tool is written: path is required")
        if to == "kerf":
            raise ValueError("a .kerf file is no text: path is required")
        return texts[0][1].decode(errors="replace")
    _kerf._write_files(program, [(os.fsencode(file), text) for file, text in texts])
    return [file for file, text in texts]


def _with_hooks(program, on_open, on_section, on_close):
    """The program with the lines that hooks return."""
    path = program.toolpath if isinstance(program, Program) else program
    added, end = [], len(path)
    if on_open is not None:
        added.append((0, _lines(on_open(), "on_open")))
    for i in range(len(path)):
        step = path[i]
        if step["step"] == "tool" and on_section is not None:
            added.append((i, _lines(on_section(step["tool"]), "on_section")))
        if step["step"] == "end":
            end = min(end, i)
    if on_close is not None:
        added.append((end, _lines(on_close(), "on_close")))
    return _kerf._with_lines(program, sorted(added, key=lambda entry: entry[0]))


def _lines(value, hook):
    if value is None:
        return []
    if not isinstance(value, (list, tuple)) or not all(isinstance(line, str) for line in value):
        raise TypeError(f"{hook} must return a list of str, or None")
    return list(value)


def import_printer(path: PathName, to: PathName | None = None) -> str:
    """Make a printer file from a sliced program: what its comments and steps show of printer and filament.

    Parameters
    ----------
    path : str or os.PathLike
        The sliced program.
    to : str or os.PathLike, optional
        The file to write (.toml), for `printer_profile` and the arguments `printer`.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    OSError
        If a file cannot be read or written.
    ValueError
        If the program does not print.
    kerf.Error
        If it has errors.

    Examples
    --------
    >>> printer = kerf.Printer()
    >>> printer.start(nozzle=210, bed=60)
    >>> z = printer.next_layer()
    >>> left_out = printer.fill(kerf.Region([(50, 50, 10)]))
    >>> names = kerf.post(printer.path, "marlin", "disc.gcode")
    >>> text = kerf.import_printer("disc.gcode", "printer.toml")
    """
    text = _kerf._import_printer(existing(path))
    if to is not None:
        if os.path.exists(to) and os.path.samefile(path, to):
            raise ValueError("to must not be the program itself")
        _kerf._write_files(Toolpath(), [(os.fsencode(to), text.encode())])
    return text


def load_drawing(path: PathName) -> Drawing:
    """Read a drawing: DXF (R12 to R2018, ASCII or binary) or SVG; the content decides.

    Parameters
    ----------
    path : str or os.PathLike
        The file.

    Returns
    -------
    Drawing
        Its entities by layers, mm.

    Raises
    ------
    OSError
        If the file cannot be read.
    kerf.Error
        If it is neither, or entities are damaged.

    Examples
    --------
    >>> drawing = kerf.load_drawing("hole.dxf")
    >>> round(drawing.region("CUT").area, 2)
    201.06
    """
    return _kerf.read_drawing(bytes_of(path), os.fsencode(path))


def load_tools(*paths: PathName, unit: Literal["mm", "inch"] = "mm", first: int = 1) -> ToolTable:
    """Read tools from tool files, or from tool libraries of other programs.

    Parameters
    ----------
    *paths : str or os.PathLike
        Kerf's tool files (.toml), LinuxCNC's tool.tbl, Carbide Create's CSV, Fusion's JSON and .tools,
        FreeCAD's .fctb and .fctl, CAMotics' JSON; the content decides.
    unit : {'mm', 'inch'}
        Unit of a tool.tbl.
    first : int
        Number of the first tool without one.

    Returns
    -------
    ToolTable
        The tools by their numbers.

    Raises
    ------
    OSError
        If a file cannot be read.
    kerf.Error
        If one is damaged. Tools of unsupported shapes are skipped with a warning.

    Examples
    --------
    >>> table = kerf.load_tools("tools.toml")
    >>> table[102].diameter
    3.175
    """
    table = ToolTable()
    for path in paths:
        _kerf._read_tools(table, bytes_of(path), os.fsencode(path), unit, first)
    return table


def save_tools(table: ToolTable, path: PathName, *, unit: Literal["mm", "inch"] = "mm") -> None:
    """Write tools to a tool file (.toml) or LinuxCNC's tool table (.tbl).

    Parameters
    ----------
    table : ToolTable
        The tools.
    path : str or os.PathLike
        The file to write.
    unit : {'mm', 'inch'}
        Unit of a tool table.

    Raises
    ------
    ValueError
        If the path has another ending.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> table = kerf.ToolTable()
    >>> table[3] = kerf.Tool("square d=6 flute=20", number=3)
    >>> kerf.save_tools(table, "shop.toml")
    >>> kerf.load_tools("shop.toml").numbers()
    [3]
    """
    ending = os.path.splitext(os.fsdecode(path))[1].lower()
    if ending not in (".toml", ".tbl"):
        raise ValueError(f"tools are written as .toml or .tbl, not as {os.fspath(path)!r}")
    _kerf._write_files(Toolpath(), [(os.fsencode(path), _kerf._write_tools(table, ending[1:], unit))])


def load_stock(path: PathName) -> Stock:
    """Read stock, a fixture or a target from a file.

    Parameters
    ----------
    path : str or os.PathLike
        A closed mesh (.stl .3mf .glb .obj) or the left-over stock of an earlier job (.kstock).

    Returns
    -------
    Stock
        The stock in work coordinates, mm.

    Raises
    ------
    OSError
        If the file cannot be read.
    kerf.Error
        If it is damaged, or the mesh encloses no volume.

    Examples
    --------
    >>> part = kerf.simulate(kerf.load("part.nc"), "40x30x10", "square d=6")
    >>> part.save("part.stl")
    >>> round(kerf.load_stock("part.stl").low[2], 3)
    -10.0
    """
    return _kerf._read_stock(bytes_of(path), os.fsencode(path))


def move_stock(
    stock: Stock,
    flip: Literal["", "x", "y"] = "",
    across: float | None = None,
    z: float | None = None,
    shift: Row = (0, 0, 0),
) -> Stock:
    """Turn stock over and move it.

    Parameters
    ----------
    stock : Stock
        The stock; it stays as it is.
    flip : {'', 'x', 'y'}
        Turn by 180 degrees about an axis along X or Y; '': do not.
    across : float, optional
        Y of an axis along X, X of an axis along Y, mm. Default: the centre of the block.
    z : float, optional
        Z of the axis, mm. Default: the centre of the block.
    shift : sequence of 3 float
        Shift in X, Y and Z after that, mm.

    Returns
    -------
    Stock
        The moved stock.

    Examples
    --------
    >>> stock = kerf.Stock.block((100, 60, 12))
    >>> kerf.move_stock(stock, shift=(10, 0, 0)).low
    (10.0, 0.0, -12.0)
    """
    return _kerf._moved_stock(stock, flip, across, z, shift)


def left_stock(simulation: Simulation) -> Stock:
    """The left-over stock of a simulation, for the next job.

    Parameters
    ----------
    simulation : Simulation
        The simulation whose part it is.

    Returns
    -------
    Stock
        What the cuts left, as the stock of a further job.

    Examples
    --------
    >>> part = kerf.simulate(kerf.load("part.nc"), "40x30x10", "square d=6")
    >>> turned = kerf.move_stock(kerf.left_stock(part), flip="x")
    """
    return _kerf._left_stock(simulation)


def save_left_stock(simulation: Simulation, path: PathName) -> None:
    """Write the left-over stock of a simulation to a file for `load_stock`.

    Parameters
    ----------
    simulation : Simulation
        The simulation whose part is written.
    path : str or os.PathLike
        Its ending must be .kstock.

    Raises
    ------
    ValueError
        If the path has another ending.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> part = kerf.simulate(kerf.load("part.nc"), "40x30x10", "square d=6")
    >>> kerf.save_left_stock(part, "part.kstock")
    >>> second = kerf.load_stock("part.kstock")
    """
    if not os.fsdecode(path).lower().endswith(".kstock"):
        raise ValueError(f"left-over stock is written as .kstock, not as {os.fspath(path)!r}")
    _kerf._write_files(Toolpath(), [(os.fsencode(path), _kerf._write_left(simulation))])

"""Kerf: toolpaths, tools and a simulator, from Python.

A toolpath is built call by call (`Toolpath`) or read from a file (`load`), and cut out of a `Stock` by
`simulate`, which says what is left, which step made which surface, and which lines would break a tool or a
part. `check` lists hazards, `estimate` the time, `post` writes for a controller or draws. A `Region` is an
area bounded by lines and arcs: unions, offsets, questions. Lengths are mm, feeds mm/min, angles degrees; Z
points up.
"""

import os

from . import _kerf
from ._kerf import (
    Diagnostic,
    Drawing,
    DrawingOutlines,
    Error,
    JobResult,
    PrintSimulation,
    Program,
    Region,
    RotarySimulation,
    Simulation,
    Stock,
    Tool,
    ToolTable,
    Toolpath,
    __version__,
    built_in_tools,
    check,
    compare,
    estimate,
    fixture_contacts,
    fit_arcs,
    fit_bezier,
    fit_spline,
    flattened,
    parallel,
    posts,
    read_drawing,
    read_gcode,
    self_meetings,
    simulate,
    simulate_print,
    simulate_rotary,
    widen,
)

__all__ = [
    "Diagnostic",
    "Drawing",
    "DrawingOutlines",
    "Error",
    "JobResult",
    "PrintSimulation",
    "Program",
    "Region",
    "RotarySimulation",
    "Simulation",
    "Stock",
    "Tool",
    "ToolTable",
    "Toolpath",
    "__version__",
    "built_in_tools",
    "check",
    "compare",
    "estimate",
    "fit_arcs",
    "fit_bezier",
    "fit_spline",
    "fixture_contacts",
    "flattened",
    "left_stock",
    "load",
    "load_drawing",
    "load_stock",
    "move_stock",
    "parallel",
    "post",
    "posts",
    "read_drawing",
    "read_gcode",
    "save_left_stock",
    "self_meetings",
    "simulate",
    "simulate_print",
    "simulate_rotary",
    "widen",
]


def load(
    path,
    *,
    dialect=None,
    read_on=False,
    strict=False,
    filament=None,
    defines=(),
    include_paths=(),
    tools=None,
    machine=None,
):
    """Read a program of any kind: G-code or gcmc, by the file name's ending or its text.

    Parameters
    ----------
    path : str or os.PathLike
    dialect : str, optional
        The controller that a G-code program is for: 'linuxcnc', 'grbl' ...; determined from the text where
        omitted.
    read_on : bool
        Whether a G-code file is read to its end, past M2 and M30, as senders do.
    strict : bool
        Whether unusual G-code words are errors.
    filament : float, optional
        Diameter of a printer's filament, mm; what the program's comments say, else 1.75, where omitted.
    defines : sequence of str
        Statements that a gcmc program runs first: ``['depth=5mm']``.
    include_paths : sequence of str
        Folders searched for the files that a gcmc program includes, after the program's own.
    tools : Tool, str, ToolTable or list of them, optional
        For cutter compensation (G41, G42); see `check`.
    machine : str or os.PathLike, optional
        The machine that is to run the program: a profile (TOML), or GRBL's ``$$`` settings.

    Returns
    -------
    Program

    Raises
    ------
    OSError
        Where the file cannot be read.
    kerf.Error
        Where its text has errors; all of them are in its `diagnostics`. Warnings go to the `warnings` module.
    """
    name = os.fsdecode(path)
    with open(name, "rb"):
        pass  # raises what Python programs expect
    return _kerf._load(
        name,
        dialect=dialect,
        read_on=read_on,
        strict=strict,
        filament=filament,
        defines=list(defines),
        include_paths=[os.fsdecode(folder) for folder in include_paths],
        tools=tools,
        machine=machine,
    )


def post(
    program,
    to,
    path=None,
    *,
    unit=None,
    tool_change=None,
    feed=0.0,
    tools=None,
    fit_arcs=0.0,
    join=0.0,
    shorten_rapids=False,
    rapids=False,
    dxf_version="r2000",
):
    """Write a program for a controller, or as a drawing from above.

    Parameters
    ----------
    program : Program or Toolpath
    to : str
        'grbl', 'linuxcnc' ... (see `posts`), 'dxf', 'svg', or the path of a post file (.toml).
    path : str or os.PathLike, optional
        The file to write.
    unit : {'mm', 'inch'}, optional
        That of the post where omitted; mm in drawings.
    tool_change : {'command', 'pause', 'files', 'ignore'}, optional
        As the post has it where omitted; 'files' needs a path.
    feed : float
        For cutting moves without a feed, mm/min; 0: an error.
    tools : Tool, str, ToolTable or list of them, optional
        For names in comments, and the sizes of drilled holes in drawings; see `check`.
    fit_arcs : float
        Chains of chords become arcs that deviate at most this much, mm; 0: not.
    join : float
        Straight cuts are joined where the corner deviates at most this much, mm; 0: not.
    shorten_rapids : bool
        Whether rapids that return to where they started are omitted.
    rapids : bool
        Whether drawings show rapids.
    dxf_version : {'r2000', 'r12'}

    Returns
    -------
    str or list of str
        The text; with `path` the names of the files written: that path, or with 'files' one for each tool.

    Raises
    ------
    ValueError
        Where `to` is unknown, or several files are to be written and no path is given.
    OSError
        Where a file cannot be written.
    kerf.Error
        Where the controller cannot run the program.
    """
    name = "program" if path is None else os.fsdecode(path)
    options = dict(unit=unit, tool_change=tool_change, feed=feed, tools=tools, fit_arcs=fit_arcs, join=join,
                   shorten_rapids=shorten_rapids, rapids=rapids, dxf_version=dxf_version)
    texts = _kerf._post(program, os.fsdecode(to), name, **options)
    if path is None:
        if len(texts) != 1:
            raise ValueError("each tool gets a file of its own: path is needed")
        return texts[0][1].decode(errors="replace")
    _kerf._write_files(texts)
    return [file for file, text in texts]


def load_drawing(path):
    """Read a DXF drawing: R12 to R2018, ASCII or binary.

    Parameters
    ----------
    path : str or os.PathLike

    Returns
    -------
    Drawing

    Raises
    ------
    OSError
        Where the file cannot be read.
    kerf.Error
        Where it is no DXF file, or entities are damaged.
    """
    with open(path, "rb") as file:
        return _kerf.read_drawing(file.read(), os.fsdecode(path))


def load_stock(path):
    """Read stock, a fixture or a target from a file.

    Parameters
    ----------
    path : str or os.PathLike
        A closed mesh (.stl .3mf .glb .obj) or the left-over of an earlier job (.kstock).

    Returns
    -------
    Stock

    Raises
    ------
    OSError
        Where the file cannot be read.
    kerf.Error
        Where it is damaged, or the mesh encloses nothing.
    """
    with open(path, "rb") as file:
        return _kerf._read_stock(file.read(), os.fsdecode(path))


def move_stock(stock, flip="", across=None, z=None, shift=(0, 0, 0)):
    """Turn stock over and move it.

    Parameters
    ----------
    stock : Stock
    flip : {'', 'x', 'y'}
        Half a turn about an axis parallel to X or Y; '' for none.
    across : float, optional
        Y of an axis along X, X of one along Y, mm; the centre of the block where omitted.
    z : float, optional
        Z of the axis, mm; the centre of the block where omitted.
    shift : sequence of 3 float
        Movement after that, mm.

    Returns
    -------
    Stock
    """
    return _kerf._moved_stock(stock, flip, across, z, shift)


def left_stock(simulation):
    """What a simulation has left, as the stock of a following job.

    Parameters
    ----------
    simulation : Simulation

    Returns
    -------
    Stock
    """
    return _kerf._left_stock(simulation)


def save_left_stock(simulation, path):
    """Write what a simulation has left to a .kstock file, which `load_stock` reads.

    Parameters
    ----------
    simulation : Simulation
    path : str or os.PathLike
        Ends in .kstock, by which `load_stock` knows it.

    Raises
    ------
    ValueError
        Where the path ends otherwise.
    OSError
        Where the file cannot be written.
    """
    if not os.fspath(path).lower().endswith(".kstock"):
        raise ValueError(f"what is left is written as .kstock, not as {os.fspath(path)!r}")
    with open(path, "wb") as file:
        file.write(_kerf._write_left(simulation))

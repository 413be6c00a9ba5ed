"""Kerf: toolpaths, tools and a simulator, from Python.

A toolpath is built call by call (`Toolpath`) or read from G-code (`read_gcode`, `load`), and cut out of a
`Stock` by `simulate`, which says what is left, which step made which surface, and which lines would break a
tool or a part. A `Region` is a part of the plane bounded by lines and arcs: unions, offsets, questions.
Lengths are mm, feeds mm/min, angles degrees; Z points up.
"""

import os

from . import _kerf
from ._kerf import (
    Diagnostic,
    Error,
    PrintSimulation,
    Region,
    RotarySimulation,
    Simulation,
    Stock,
    Tool,
    ToolTable,
    Toolpath,
    __version__,
    built_in_tools,
    compare,
    fixture_contacts,
    fit_arcs,
    fit_bezier,
    fit_spline,
    flattened,
    parallel,
    read_gcode,
    self_meetings,
    simulate,
    simulate_print,
    simulate_rotary,
    widen,
)

__all__ = [
    "Diagnostic",
    "Error",
    "PrintSimulation",
    "Region",
    "RotarySimulation",
    "Simulation",
    "Stock",
    "Tool",
    "ToolTable",
    "Toolpath",
    "__version__",
    "built_in_tools",
    "compare",
    "fit_arcs",
    "fit_bezier",
    "fit_spline",
    "fixture_contacts",
    "flattened",
    "left_stock",
    "load",
    "load_stock",
    "move_stock",
    "parallel",
    "read_gcode",
    "save_left_stock",
    "self_meetings",
    "simulate",
    "simulate_print",
    "simulate_rotary",
    "widen",
]


def load(path, filament=None):
    """Read a G-code file into a Toolpath.

    Parameters
    ----------
    path : str or os.PathLike
    filament : float, optional
        Diameter of a printer's filament, mm; see `read_gcode`.

    Returns
    -------
    Toolpath

    Raises
    ------
    OSError
        Where the file cannot be read.
    kerf.Error
        Where its text has errors.
    """
    name = os.fspath(path)
    with open(name, encoding="latin-1") as file:
        return read_gcode(file.read(), os.fsdecode(name), filament)


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
        Y of an axis along X, X of one along Y, mm; the block's middle where left out.
    z : float, optional
        Z of the axis, mm; the block's middle where left out.
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

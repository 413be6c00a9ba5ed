"""Kerf: toolpaths, tools and a simulator, from Python.

A toolpath is built call by call (`Toolpath`) or read from G-code (`read_gcode`, `load`), and cut out of a
`Stock` by `simulate`, which says what is left, which step made which surface, and which lines would break a
tool or a part. A `Region` is a part of the plane bounded by lines and arcs: unions, offsets, questions.
Lengths are mm, feeds mm/min, angles degrees; Z points up.
"""

import os

from ._kerf import (
    Diagnostic,
    Error,
    Region,
    Simulation,
    Stock,
    Tool,
    ToolTable,
    Toolpath,
    __version__,
    built_in_tools,
    fit_arcs,
    fit_bezier,
    fit_spline,
    flattened,
    parallel,
    read_gcode,
    self_meetings,
    simulate,
    widen,
)

__all__ = [
    "Diagnostic",
    "Error",
    "Region",
    "Simulation",
    "Stock",
    "Tool",
    "ToolTable",
    "Toolpath",
    "__version__",
    "built_in_tools",
    "fit_arcs",
    "fit_bezier",
    "fit_spline",
    "flattened",
    "load",
    "parallel",
    "read_gcode",
    "self_meetings",
    "simulate",
    "widen",
]


def load(path):
    """Read a G-code file into a Toolpath.

    Parameters
    ----------
    path : str or os.PathLike

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
        return read_gcode(file.read(), os.fsdecode(name))

"""What other programs' languages compile to: gcmc, path drawings and OpenSCAD, as texts and files."""

from __future__ import annotations

import os
from typing import Any, Literal, Mapping, Sequence

from . import _kerf
from ._files import bytes_of, existing, folders_of, texts
from ._kerf import Diagnostic, ScadResult
from ._types import PathName, Row, Rows


def gcmc(
    path: PathName,
    to: Literal["gcode", "svg", "dxf"] = "gcode",
    *,
    defines: str | Sequence[str] = (),
    include_paths: str | Sequence[str] = (),
    compat: str = "",
    degrees: bool = False,
    imperial: bool = False,
    relative: bool = False,
    precision: int = 8,
    brief: bool = False,
    plane: Literal["XY", "XZ", "YZ"] = "XY",
    offsets: Mapping[str, float] | None = None,
    uvw: bool = False,
    bare: bool = False,
    prologue: str = "",
    epilogue: str = "",
    date: str = "",
    subroutine: str = "",
    m2: bool = True,
    flip: bool = True,
    rapids: bool = True,
    grid: bool = True,
    stroke: float = 0.0,
    opacity: float = 0.1,
    hex_handles: bool = False,
    max_output: float = 2048.0,
    max_steps: float = 500.0,
) -> tuple[str, list[str]]:
    """Compile a gcmc program to the text that gcmc writes; `load` reads it as a toolpath.

    Parameters
    ----------
    path : str or os.PathLike
        The program (.gcmc).
    to : {'gcode', 'svg', 'dxf'}
    defines : sequence of str
        Statements that run first: ``['depth=5mm']``.
    include_paths : sequence of str
        Folders to search for included files.
    compat : {'', '1.8', '1.9'}
        The version of gcmc whose arcs and angles the program expects; '': none is stated.
    degrees : bool
        Angles of A, B and C without unit are degrees, in any version.
    imperial : bool
        Inches are native.
    relative : bool
        G-code in G91.
    precision : int
        Decimals of the G-code, 1 to 15.
    brief : bool
        Omit words that repeat a modal value.
    plane : {'XY', 'XZ', 'YZ'}
        The plane at the start.
    offsets : dict of str to float, optional
        Added to axes, in native units or degrees: ``{'X': 10, 'A': 90}``.
    uvw : bool
        Write U, V and W words.
    bare : bool
        No prologue and no epilogue.
    prologue, epilogue : str
        Texts instead of the usual ones; '': the usual ones.
    date : str
        In the usual prologue; '': none.
    subroutine : str
        Write an O-word subroutine of this name; '': a program.
    m2 : bool
        M2 after the subroutine.
    flip : bool
        SVG: Y upwards, as on the machine.
    rapids, grid : bool
        SVG: draw the rapids; draw a grid.
    stroke : float
        SVG: width of the strokes, in native units; 0: 3 mm or 0.125 inch.
    opacity : float
        SVG: of the strokes, 0 to 1.
    hex_handles : bool
        DXF: entities with handles, as AutoCAD requires.
    max_output : float
        Maximum output in MB.
    max_steps : float
        Maximum of loop steps without output, in millions.

    Returns
    -------
    (str, list of str)
        The text, and the texts of its message() calls.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If an argument is out of range, or does not go with another.
    kerf.Error
        If the program has errors, or exceeds a limit.

    Examples
    --------
    >>> text, messages = kerf.gcmc("part.gcmc")
    >>> messages
    ['a slot']
    """
    options = dict(locals())
    return _kerf._gcmc(bytes_of(path), os.fsencode(path), to, _gcmc_options(options))


def _gcmc_options(given):
    """Keywords of `gcmc` for the compiled module."""
    del given["path"], given["to"]
    given["defines"] = texts(given["defines"], "defines")
    given["include_paths"] = folders_of(given["include_paths"], "include_paths")
    given["offsets"] = given["offsets"] or {}
    return given


_GCMC_DEFAULTS = dict(gcmc.__kwdefaults__, path=None, to=None)


def check_gcmc(
    path: PathName, *, defines: str | Sequence[str] = (), include_paths: str | Sequence[str] = ()
) -> list[Diagnostic]:
    """Report the syntax errors of a gcmc program, without running it.

    Parameters
    ----------
    path : str or os.PathLike
        The program (.gcmc).
    defines, include_paths : sequence of str
        As of `gcmc`.

    Returns
    -------
    list of Diagnostic
        Empty if there are none.

    Raises
    ------
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> kerf.check_gcmc("part.gcmc")
    []
    """
    options = _gcmc_options(dict(_GCMC_DEFAULTS, defines=defines, include_paths=include_paths))
    return _kerf._check_gcmc(bytes_of(path), os.fsencode(path), "gcode", options)


def pathdxf(
    path: PathName,
    *,
    feed: float = 0.0,
    probe_feed: float = 0.0,
    rapid_speed: float = 0.0,
    rapid_height: float = 0.0,
    folders: str | Sequence[str] = (),
    path_names: str | None = None,
    file_patterns: str | None = None,
    restrictions: str | Sequence[str] = (),
    defines: str | Sequence[str] = (),
    probe: Literal["g38.2", "g38.3"] = "g38.3",
) -> dict[str, str]:
    """Compile a path drawing to the texts that `kerf pathdxf` writes; `load` reads it as a toolpath.

    Parameters
    ----------
    path : str or os.PathLike
        The drawing (.dxf).
    feed : float
        Feed of paths that specify none, mm/min; 0: 150.
    probe_feed : float
        Feed of probes, mm/min; 0: `feed`.
    rapid_speed : float
        Speed of rapids, for the times in the comments, mm/min; 0: `feed`.
    rapid_height : float
        Height of rapids of paths that specify none, mm; 0: by thickness and tool.
    folders : sequence of str
        Searched for sub-paths after the drawing's folder.
    path_names, file_patterns : str, optional
        Expressions for the names of paths, and for patterns in names of files. Default:
        ``([0-9]{4})[.]([0-9]+)([A-Z])`` and ``([0-9]{4})(?:[.]([0-9]+))?``.
    restrictions : sequence of str
        ``['8001:80.*P']``: paths that match the first expression may embed only those that match the second.
    defines : sequence of str
        Values of variables of the path itself: ``['A=2']``.
    probe : {'g38.2', 'g38.3'}
        Whether a probe without contact is an error on the machine: it is with 'g38.2'.

    Returns
    -------
    dict of str to str
        By the ending of the file name: '_Milling.gcode', or, with points to be measured, '_Probing.gcode',
        '_Z.txt' and '_Clean.gcode'.

    Raises
    ------
    OSError
        If the file cannot be read.
    kerf.Error
        If the drawing has errors.

    Examples
    --------
    >>> sorted(kerf.pathdxf("9001.1P.dxf"))
    ['_Milling.gcode']
    """
    return _kerf._pathdxf(existing(path), _pathdxf_options(dict(locals())))[0]


def _pathdxf_options(given):
    """Keywords of `pathdxf` for the compiled module."""
    del given["path"]
    given["folders"] = folders_of(given["folders"], "folders")
    for name in ("restrictions", "defines"):
        given[name] = texts(given[name], name)
    given.setdefault("show_texts", None)
    return given


_PATHDXF_DEFAULTS = dict(pathdxf.__kwdefaults__, path=None)


def _known(keywords):
    for name in keywords:
        if name not in pathdxf.__kwdefaults__:
            raise TypeError(f"there is no keyword {name!r}; known: {', '.join(pathdxf.__kwdefaults__)}")


def drawing_options(given):
    """The keywords of `pathdxf` that `load` takes, for the compiled module."""
    if not given:
        return None
    names = ("feed", "rapid_height", "path_names", "file_patterns", "restrictions")
    for name in given:
        if name not in names:
            raise TypeError(f"drawing has no keyword {name!r}; known: {', '.join(names)}")
    return _pathdxf_options({**_PATHDXF_DEFAULTS, **given})


def check_pathdxf(
    path: PathName, *, show_texts: str | None = None, **keywords: Any
) -> tuple[dict[str, list[str]], list[Diagnostic], list[str]]:
    """Check all paths of a path drawing, with example values for their variables; write nothing.

    Parameters
    ----------
    path : str or os.PathLike
        The drawing (.dxf).
    show_texts : str, optional
        Report the elements whose texts match this expression.
    **keywords
        As of `pathdxf`.

    Returns
    -------
    (dict of str to list of str, list of Diagnostic, list of str)
        The statistics of each path by its name; the faults; the files read, paths checked and texts shown.

    Raises
    ------
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> statistics, faults, lines = kerf.check_pathdxf("9001.1P.dxf")
    >>> faults
    []
    """
    _known(keywords)
    options = _pathdxf_options({**_PATHDXF_DEFAULTS, **keywords, "show_texts": show_texts})
    return _kerf._check_pathdxf(existing(path), options)


def path_sheet(path: PathName, **keywords: Any) -> str:
    """Draw the sheet of a path drawing for the workshop, as SVG of true size.

    It shows the order of the cuts, their depths, probes and dimensions, and the elements with errors.

    Parameters
    ----------
    path : str or os.PathLike
        The drawing (.dxf).
    **keywords
        As of `pathdxf`.

    Returns
    -------
    str
        The sheet as text.

    Raises
    ------
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> "<svg" in kerf.path_sheet("9001.1P.dxf")
    True
    """
    _known(keywords)
    return _kerf._path_sheet(existing(path), _pathdxf_options({**_PATHDXF_DEFAULTS, **keywords}))


def adjust_path(
    path: PathName, *, max_correction: float, measured: PathName | None = None, work_offset: Row | None = None
) -> str:
    """Correct the heights of a path drawing's program by measured values; `adjust_heights` does so in texts.

    Parameters
    ----------
    path : str or os.PathLike
        The drawing, or one of the files that `pathdxf` makes of it: '_Z.txt' and '_Clean.gcode' are read, and
        with `measured` '_Probing.gcode'.
    max_correction : float
        Maximum deviation of measured from expected heights, mm.
    measured : str or os.PathLike, optional
        Heights by position: a console log of GRBL, a file of LinuxCNC's PROBEOPEN ... Default: the values in
        '_Z.txt'.
    work_offset : (float, float, float), optional
        The work zero in machine coordinates, for a log without it, mm.

    Returns
    -------
    str
        The program, '_Milling.gcode'.

    Raises
    ------
    OSError
        If a file cannot be read.
    kerf.Error
        If a height is missing, or deviates by more.

    Examples
    --------
    >>> text = kerf.adjust_path("measured.dxf", max_correction=0.1)
    >>> "Z0.849(" in text
    True
    """
    name = b"" if measured is None else existing(measured)
    return _kerf._adjusted(os.fsencode(path), max_correction, name, work_offset)


def scad(
    path: PathName,
    *,
    defines: str | Sequence[str] = (),
    include_paths: str | Sequence[str] = (),
    parameters: PathName | None = None,
    parameter_set: str = "",
) -> ScadResult:
    """Run an OpenSCAD program that makes a part with the commands of gcodepreview.

    Nothing is written: the texts of its files are in the result. `load` returns its program alone.

    Parameters
    ----------
    path : str or os.PathLike
        The program (.scad).
    defines : sequence of str
        Assignments that replace those of the program: ``['depth=5']``.
    include_paths : sequence of str
        Folders to search for included files.
    parameters : str or os.PathLike, optional
        Sets of values of OpenSCAD's customizer (JSON).
    parameter_set : str
        The name of the set of that file.

    Returns
    -------
    ScadResult
        What the program made: its files and messages.

    Raises
    ------
    OSError
        If a file cannot be read.
    kerf.Error
        If the program has errors, or the set is unknown.

    Examples
    --------
    >>> made = kerf.scad("part.scad", defines=["width=20"])
    >>> made.area.bounds
    (0.0, 0.0, 20.0, 20.0)
    """
    return _kerf._scad(
        existing(path),
        texts(defines, "defines"),
        folders_of(include_paths, "include_paths"),
        b"" if parameters is None else existing(parameters),
        parameter_set,
    )

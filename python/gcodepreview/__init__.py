"""gcodepreview: toolpaths for CNC machines from Python, with the commands of the PythonSCAD library of that
name.

The machine is Kerf's, once for Python and OpenSCAD programs: its commands are the methods of
`gcodepreview`. Each motion is a step of a `kerf.Toolpath`, tools are Kerf's built-in ones, files are written
by Kerf's posts and drawing writer, and `stockandtoolpaths()` is Kerf's simulation. Lengths are mm, feeds
mm/min, angles degrees; Z points up and depths of cuts are below 0.

Examples
--------
>>> from gcodepreview import *
>>> gcp = gcodepreview("cut", True, True)
>>> gcp.opengcodefile("part"); gcp.opendxffile("part")
>>> gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
>>> moves = gcp.movetosafeZ()
>>> gcp.toolchange(102, 16000)
>>> moves = gcp.rapid(10, 10, 5)
>>> moves = gcp.cutline(10, 10, -3)
>>> moves = gcp.cutlinedxfgc(90, 10, -3)
>>> part = gcp.stockandtoolpaths()
>>> gcp.closegcodefile(); gcp.closedxffile()
"""

from __future__ import annotations

import glob
import math
import os
import sys
import threading
from typing import Any

import kerf_cam

kerf_cam.require()  # before another module of that name fails with a message that names no cause

import kerf
from kerf import _kerf
from kerf._files import existing
from kerf._kerf import GcodePreviewError
from kerf._types import Points

from . import _shapes as shapes
from ._commands import with_commands
from ._moves import Move, Moves
from ._result import PathPicture, Result, show
from ._tools import Section, ToolFacts

__all__ = [
    "GcodePreviewError",
    "Move",
    "Moves",
    "Result",
    "Section",
    "gcodepreview",
    "pygcpversion",
    "shapes",
    "show",
]

_OPTIONS = ("stockandtoolpaths", "stock", "toolpaths", "rapids")

# Steps and hazards name the line of the user's script, not lines of these files.
for _file in glob.glob(os.path.join(os.path.dirname(__file__), "*.py")):
    _kerf._library_file(_file)


def pygcpversion() -> float:
    """The version of the library whose commands these are.

    Returns
    -------
    float
        Such as 0.93.
    """
    return _kerf._design_value("pygcpversion")


@with_commands
class gcodepreview(ToolFacts, _kerf.Machine):
    """A machine, its stock and its files.

    Positions are in work coordinates, mm, with Z up; Z0 is the top or the bottom of the stock, as
    `setupstock` says. Feeds are mm/min, angles degrees counter-clockwise from +X.

    Parameters
    ----------
    cutorprint : {'cut', 'print', 'no_preview'}
        Other values mean 'no_preview': motions and drawings are recorded, nothing is simulated.
    generategcode, generatedxf : bool or 0, 1
        Whether closegcodefile and closedxffile write their files.
    gcpfa, gcpfs : float
        Settings of PythonSCAD's circles, without effect; `gcpfs` is the resolution of the simulation, mm.
    steps : int
        Not used: arcs are arcs.

    Raises
    ------
    GcodePreviewError, TypeError
        By all methods, for wrong values and types; the message names the argument.
    kerf.Error
        If the controller cannot run the program, or the simulation is impossible.
    OSError
        If a file cannot be written or read.

    Examples
    --------
    >>> from gcodepreview import *
    >>> gcp = gcodepreview("cut")
    >>> gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
    >>> gcp.toolchange(201, 16000)
    >>> moves = gcp.rapid(10, 30, 5)
    >>> moves = gcp.cutline(10, 30, -3)
    >>> moves = gcp.cutline(90, 30, -3)
    >>> result = gcp.simulate()
    >>> result.hazards
    []
    """

    def __init__(
        self,
        cutorprint: str = "cut",
        generategcode: bool | int = False,
        generatedxf: bool | int = False,
        gcpfa: float = 2,
        gcpfs: float = 0.125,
        steps: float = 10,
    ) -> None:
        super().__init__()
        self._start(cutorprint, generategcode, generatedxf, gcpfa, gcpfs, steps)
        self.fa, self.fs, self.steps = float(gcpfa), float(gcpfs), float(steps)
        self.mc = "Initialized"
        self.on_open = self.on_section = self.on_close = None
        self.cutcolor, self.rapidcolor, self.shaftcolor = "green", "orange", "red"
        self._colours = []  # of setcolor: the step from which they hold, and those of cuts, rapids, shafts
        self._lock = threading.Lock()
        self._forget_moves()

    @property
    def generatecut(self) -> bool:
        """bool: whether cuts are simulated: the mode is 'cut'."""
        return self.mode == "cut"

    @property
    def generateprint(self) -> bool:
        """bool: whether beads are simulated: the mode is 'print'."""
        return self.mode == "print"

    # ---- moves

    def _forget_moves(self):
        self._rapids, self._cuts = Moves(), Moves()
        self._listed = (self.toolpath, 0)  # the path of the two lists, and how many of its steps they have

    def _list_moves(self):
        path, first = self._listed
        if path is not self.toolpath:
            self._forget_moves()
            path, first = self._listed
        if len(path) == first:
            return
        for move in self._moves(first):
            if move.kind == "rapid":
                self._rapids.append(move)
            elif self.generatecut or move.kind == "extrude":
                self._cuts.append(move)
        self._listed = (path, len(path))

    @property
    def rapids(self) -> Moves:
        """Moves: the rapids so far."""
        self._list_moves()
        return self._rapids

    @property
    def toolpaths(self) -> Moves:
        """Moves: the cuts or beads so far."""
        self._list_moves()
        return self._cuts

    def toolmovement(
        self, bx: float, by: float, bz: float, ex: float, ey: float, ez: float, step: float = 0
    ) -> Moves:
        """A cut between two points as a list of one `Move`, which is not run: no step is appended.

        Parameters
        ----------
        bx, by, bz : float
            The start point, mm.
        ex, ey, ez : float
            The end point, mm.
        step : float
            Without effect.

        Returns
        -------
        Moves
            One move of the kind 'cut' with the tool in use.

        Raises
        ------
        TypeError
            If an argument is no number.
        """
        super().toolmovement(bx, by, bz, ex, ey, ez, step)
        return Moves([Move("cut", (bx, by, bz), (ex, ey, ez), self.currenttoolnum)])

    def shaftmovement(self, bx: float, by: float, bz: float, ex: float, ey: float, ez: float) -> Moves:
        """As toolmovement, for the shaft: what it touches is a hazard of `simulate`.

        Parameters
        ----------
        bx, by, bz : float
            The start point, mm.
        ex, ey, ez : float
            The end point, mm.

        Returns
        -------
        Moves
            One move of the kind 'shaft' with the tool in use.

        Raises
        ------
        TypeError
            If an argument is no number.
        """
        super().shaftmovement(bx, by, bz, ex, ey, ez)
        return Moves([Move("shaft", (bx, by, bz), (ex, ey, ez), self.currenttoolnum)])

    # ---- choices

    def debug(self, *args: Any, sep: str = " ", end: str = "\n", **kwargs: Any) -> None:
        """Print, with the prefix "DEBUG: ", if `debugenable` is set.

        Parameters
        ----------
        *args
            What is printed.
        sep, end : str
            As of `print`.
        **kwargs
            Further arguments of `print`; `file` is `sys.stderr` unless given.
        """
        if self.debugenable:
            with self._lock:
                print("DEBUG:", *args, sep=sep, end=end, **{"file": sys.stderr, **kwargs})

    def setfeeds(self, plunge: float | None = None, feed: float | None = None, **ratios: float) -> None:
        """Set the base feeds in mm/min, and ratios by class of tool.

        Parameters
        ----------
        plunge : float, optional
            Feed of cuts straight down, mm/min; above 0. Default: as before.
        feed : float, optional
            Feed of other cuts, mm/min; above 0. Default: as before.
        **ratios : float
            Factors of both feeds while a tool of a class is in use. Classes: large_square, small_square,
            large_ball, small_ball, large_V, small_V, DT, KH, RO, MISC.

        Raises
        ------
        GcodePreviewError
            If a class is unknown, or a value is not above 0.
        TypeError
            If a value is no number.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.setfeeds(plunge=300, feed=1200, small_square=0.75)
        >>> gcp.feed, gcp.plunge
        (1200.0, 300.0)
        """
        try:
            super().setfeeds(plunge, feed, **ratios)
        except TypeError as error:
            if "keyword" not in str(error):
                raise
            raise GcodePreviewError(str(error)) from None

    def setcolor(self, cutcolor: str = "green", rapidcolor: str = "orange", shaftcolor: str = "red") -> None:
        """Colours of what the following motions cut, of what their rapids cut, and of what shafts touch.

        Before the first call each tool has a colour of its own.

        Parameters
        ----------
        cutcolor, rapidcolor, shaftcolor : str
            Names of CSS in any case, or `#rrggbb`.

        Raises
        ------
        GcodePreviewError
            If a colour is unknown.
        """
        super().setcolor(cutcolor, rapidcolor, shaftcolor)
        self.cutcolor, self.rapidcolor, self.shaftcolor = cutcolor, rapidcolor, shaftcolor
        self._colours.append((len(self.toolpath), cutcolor, rapidcolor, shaftcolor))

    def setdxfcolor(self, color: str) -> None:
        """Set the colour of the following entities, a drawing or web colour, in any case.

        Parameters
        ----------
        color : str
            Such as 'Red'; an unknown name lists them.

        Raises
        ------
        GcodePreviewError
            If the colour is unknown.
        """
        super().setdxfcolor(color)
        self.cutcolor = self.dxfcolor
        if self._colours:
            self._colours.append((len(self.toolpath), color, *self._colours[-1][2:]))

    def addtool(self, tool_number: int, shape: str, **sizes: float) -> None:
        """Add a tool of one's own, for toolchange: its shape and sizes as of kerf.Tool.make, mm and degrees.

        Parameters
        ----------
        tool_number : int
            Its number.
        shape : str
            A shape of `kerf.tool_shapes()`, such as 'square'.
        **sizes : float
            The sizes of the shape by their names, mm, and angles, degrees: diameter=6, flute=20.

        Raises
        ------
        GcodePreviewError
            If the shape or a size is unknown, missing or out of range.
        TypeError
            If a size is no number.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.addtool(901, "lollipop", diameter=10, neck_diameter=4, flute=14)
        >>> gcp.toolchange(901, 12000)
        """
        super().addtool(tool_number, shape, **sizes)

    def showtooloutline(self) -> Points:
        """Show the outline of tool and shaft: write it as SVG, named by the tool.

        Returns
        -------
        list of (float, float)
            Both sides: points (x, z), counter-clockwise, mm; Z0 at the tip.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.toolchange(201, 16000)
        >>> min(gcp.showtooloutline())
        (-3.175, 0.0)
        """
        super().showtooloutline()
        return self._section.whole_outline()

    def showtoolprofile(self) -> Points:
        """Show the half profile of tool and shaft: write it as SVG, named by the tool.

        Returns
        -------
        list of (float, float)
            One side, from the axis to the axis: points (r, z), mm; Z0 at the tip.
        """
        super().showtoolprofile()
        return self._section.whole_profile()

    def showtoolshape(self) -> list[Any]:
        """Show the solid of tool and shaft: write it as STL, named by the tool.

        Returns
        -------
        list of tuple
            Triangles of three points (x, y, z), mm; Z up, Z0 at the tip.
        """
        super().showtoolshape()
        return self._section.shape()

    def currenttoolnumber(self) -> int:
        """The tool number of the last change, as given: the maker's or the generated one.

        Returns
        -------
        int
            The number.
        """
        return self.currenttoolnum

    def currenttool(self) -> int:
        """As currenttoolnumber.

        Returns
        -------
        int
            The number.
        """
        return self.currenttoolnum

    @property
    def extrusion_normal_length(self) -> float:
        """float: length of filament that has a volume of 1 mm3, mm."""
        return 1 / (math.pi * (self.filamentdiameter / 2) ** 2)

    # ---- stock

    def setupstock(
        self,
        stockXwidth: float,
        stockYheight: float,
        stockZthickness: float,
        zeroheight: str = "Top",
        stockzero: str = "Lower-Left",
        retractheight: float | None = None,
    ) -> None:
        """The stock: a block, the height of its zero and its position.

        Parameters
        ----------
        stockXwidth, stockYheight, stockZthickness : float
            Size of the block in X, Y and Z, mm; above 0.
        zeroheight : {'Top', 'Bottom'}
            Where Z0 is.
        stockzero : {'Lower-Left', 'Center-Left', 'Top-Left', 'Center', ...}
            Which point of the block is at X0 Y0; an unknown name lists them.
        retractheight : float, optional
            Height of moves between cuts, mm. Default: as before.

        Raises
        ------
        GcodePreviewError
            If a size is not above 0, or a name is unknown.
        TypeError
            If an argument has a wrong type.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
        >>> gcp.retractheight
        9.0
        """
        super().setupstock(stockXwidth, stockYheight, stockZthickness, zeroheight, stockzero, retractheight)
        self.stockXwidth, self.stockYheight, self.stockZthickness = stockXwidth, stockYheight, stockZthickness
        self.zeroheight, self.stockzero = zeroheight, stockzero

    def setupcuttingarea(
        self, sizeX: float, sizeY: float, sizeZ: float, extentleft: float, extentfb: float, extentd: float
    ) -> kerf.Stock | None:
        """A block by its size and its lowest corner; the state is that before the first motion.

        Parameters
        ----------
        sizeX, sizeY, sizeZ : float
            Size of the block, mm; above 0.
        extentleft, extentfb, extentd : float
            X, Y and Z of its lowest corner, mm.

        Returns
        -------
        kerf.Stock or None
            The stock.

        Raises
        ------
        GcodePreviewError
            If a size is not above 0.
        TypeError
            If an argument is no number.
        """
        super().setupcuttingarea(sizeX, sizeY, sizeZ, extentleft, extentfb, extentd)
        return self.stock

    def stockfromfile(self, path: str | os.PathLike[str]) -> None:
        """The stock from a closed mesh (.stl .3mf .glb .obj) or from left-over stock (.kstock).

        Parameters
        ----------
        path : str or os.PathLike
            The file; its coordinates are work coordinates, mm.

        Raises
        ------
        OSError
            If the file cannot be read.
        GcodePreviewError
            If it is no closed mesh, or of another kind.
        """
        existing(path)
        super().stockfromfile(path)

    def _left_stock(self):
        """What the cuts leave, for the second side."""
        return kerf.left_stock(self.simulate().simulation)

    # ---- texts of files

    def gcode(self, to: str | None = None) -> str:
        """The G-code of the file that is open, or of all motions, for a controller of `kerf.posts()`.

        Parameters
        ----------
        to : str, optional
            The controller, or a post file (.toml). Default: `post`.

        Returns
        -------
        str
            The program.

        Raises
        ------
        ValueError
            If the controller is unknown.
        kerf.Error
            If the controller cannot run the program.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.setupstock(100, 60, 12.7)
        >>> gcp.toolchange(201, 16000)
        >>> moves = gcp.rapid(10, 30, 5)
        >>> moves = gcp.cutline(10, 30, -3)
        >>> "G1" in gcp.gcode("linuxcnc")
        True
        """
        return kerf.post(self._file_path(), to or self.post, tools=self._tools, feed=self.feed)

    def dxf(self) -> bytes:
        """The drawing so far as DXF.

        Returns
        -------
        bytes
            The file. It has no entities if `generatedxf` is false, and those since `opendxffile`.
        """
        return self._dxf()

    def svg(self) -> str:
        """The drawing so far as SVG.

        Returns
        -------
        str
            The file, in mm, Y up in the drawing. It has the entities of `dxf`.
        """
        return self._svg().decode()

    def pathsvg(self, rapids: bool = False) -> str:
        """The toolpath from above as SVG.

        Parameters
        ----------
        rapids : bool
            Whether rapids are drawn.

        Returns
        -------
        str
            The file, in mm.
        """
        return kerf.post(self.toolpath, "svg", rapids=rapids)

    # ---- results

    def simulate(self) -> Result:
        """Cut the toolpath out of the stock, and warn of each hazard with the script's line.

        Returns
        -------
        Result
            The part, with its hazards and volumes.

        Raises
        ------
        GcodePreviewError
            If `setupstock` was not called.
        kerf.Error
            If the simulation is impossible.

        Examples
        --------
        >>> from gcodepreview import *
        >>> gcp = gcodepreview("cut")
        >>> gcp.setupstock(100, 60, 12.7)
        >>> gcp.toolchange(201, 16000)
        >>> moves = gcp.cutpocket(shapes.rectangle(20, 20, 60, 20), 0, 3)
        >>> 3500 < gcp.simulate().simulation.removed_mm3 < 3600
        True
        """
        if self.stock is None:
            raise GcodePreviewError("stockandtoolpaths: setupstock must be called first")
        simulation = kerf.simulate(self.toolpath, self.stock, self._tools, self.resolution)
        result = Result(simulation, self._colours)
        result.warn()
        return result

    def returnstockandtoolpaths(self) -> Result:
        """The part after all cuts.

        Returns
        -------
        Result
            As of `simulate`, which raises the same.
        """
        return self.simulate()

    def stockandtoolpaths(self, option: str = "stockandtoolpaths") -> Any:
        """Show the part after all cuts, or the stock, the toolpaths or the rapids alone.

        Parameters
        ----------
        option : {'stockandtoolpaths', 'stock', 'toolpaths', 'rapids'}
            What is shown.

        Returns
        -------
        Result, kerf.Stock, Moves or None
            What was shown: the part, the stock, or the moves (also of a print); None in the mode
            'no_preview'.

        Raises
        ------
        GcodePreviewError
            If the option is unknown, or `setupstock` was not called.
        kerf.Error
            If the simulation is impossible.
        OSError
            If the picture or the mesh cannot be written.
        """
        super().stockandtoolpaths(option)
        wanted = "".join(c for c in option.lower() if c not in " -_")
        if self.mode == "no_preview":
            return None
        if wanted == "rapids":
            self._show_motions(self.rapids)
            return self.rapids
        if self.mode == "print":
            if self.toolpaths:
                self._beads().show()
            return self.toolpaths
        if wanted == "toolpaths":
            self._show_motions(self.toolpaths)
            return self.toolpaths
        if wanted == "stock":
            if self.stock is None:
                raise GcodePreviewError("stockandtoolpaths: setupstock must be called first")
            Result(kerf.simulate(kerf.Toolpath(), self.stock, self._tools, self.resolution)).show()
            return self.stock
        result = self.simulate()
        result.show()
        return result

    def _beads(self):
        """The print simulated: its beads."""
        result = Result(kerf.simulate_print(self.toolpath), self._colours)
        result.warn()
        return result

    def _show_motions(self, moves):
        """Show motions alone; what lies between them is at an unknown position, and is not drawn."""
        path, at, tool = kerf.Toolpath(), None, None
        for move in moves:
            if move.tool != tool:
                tool = move.tool
                path.tool(tool)
            if move.start != at:
                path.rapid(move.start, unknown="XYZ")
                path.rapid(move.start)
            at = move.end
            if move.kind == "rapid":
                path.rapid(at)
            elif move.centre is None:
                path.cut(at, self.feed)
            else:
                path.arc(at, move.centre, move.turn, self.feed)
        PathPicture(path, self.stock, self._tools).show()

    def simulaterotary(
        self, diameter: float, bx: float, ex: float, y: float = 0.0, z: float = 0.0
    ) -> kerf.RotarySimulation:
        """The part turned from a round bar from X `bx` to `ex` by the A axis; Y and Z are those of its axis.

        Parameters
        ----------
        diameter : float
            Diameter of the bar, mm; above 0.
        bx, ex : float
            X of its ends, mm.
        y, z : float
            Y and Z of its axis, mm.

        Returns
        -------
        kerf.RotarySimulation
            The part.

        Raises
        ------
        kerf.Error
            If the bar has no volume, or the simulation is impossible.
        """
        return kerf.simulate_rotary(self.toolpath, diameter, (bx, ex), (y, z), self._tools, self.resolution)

    def previewgcodefile(self, gc_file: str | os.PathLike[str]) -> Result:
        """Read a G-code file, its stock and its tools, and show the part.

        Parameters
        ----------
        gc_file : str or os.PathLike
            The file; without a stock a block around the cuts is assumed.

        Returns
        -------
        Result
            The part.

        Raises
        ------
        OSError
            If the file cannot be read.
        GcodePreviewError
            If its text has errors.
        kerf.Error
            If the simulation is impossible.
        """
        existing(gc_file)
        super().previewgcodefile(gc_file)
        if self.stock is None:  # a block around the cuts
            result = Result(kerf.simulate(kerf.load(gc_file), resolution=self.resolution))
            result.warn()
        else:
            result = self.simulate()
        result.show()
        return result

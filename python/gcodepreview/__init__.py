"""gcodepreview: toolpaths for CNC machines from Python, with the commands of the PythonSCAD library of that
name.

A thin layer over `kerf`: each motion is a step of a `kerf.Toolpath`, tools are Kerf's built-in ones, files
are written by Kerf's posts and drawing writer, and `stockandtoolpaths()` is Kerf's simulation. Lengths are
mm, feeds mm/min, angles degrees; Z points up and depths of cuts are below 0.

Examples
--------
>>> from gcodepreview import *
>>> gcp = gcodepreview("cut", True, True)
>>> gcp.opengcodefile("part"); gcp.opendxffile("part")
>>> gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
>>> gcp.movetosafeZ(); gcp.toolchange(102, 16000)
>>> gcp.rapid(10, 10, 5); gcp.cutline(10, 10, -3); gcp.cutlinedxfgc(90, 10, -3)
>>> gcp.stockandtoolpaths(); gcp.closegcodefile(); gcp.closedxffile()
"""

import glob
import os
import sys
import threading

import kerf
from kerf import _kerf

from . import _shapes as shapes
from ._arguments import GcodePreviewError, flag, positive
from ._drawing import Drawing
from ._further import Further
from ._joints import Joints
from ._motion import Motion, Move, Moves
from ._printing import Printing
from ._result import Files, Result, show
from ._shapes import Shapes
from ._tools import Section, Tools

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

_VERSION = 0.93
_MODES = ("cut", "print", "no_preview")

# Steps and hazards name the line of the user's script, not lines of these files.
for _file in glob.glob(os.path.join(os.path.dirname(__file__), "*.py")):
    _kerf._library_file(_file)


def pygcpversion():
    """The version of the library whose commands these are."""
    return _VERSION


class gcodepreview(Motion, Drawing, Tools, Joints, Printing, Shapes, Further, Files):
    """A machine, its stock and its files.

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
    """

    def __init__(
        self, cutorprint="cut", generategcode=False, generatedxf=False, gcpfa=2, gcpfs=0.125, steps=10
    ):
        self.mode = cutorprint if cutorprint in _MODES else "no_preview"
        self.generatecut, self.generateprint = self.mode == "cut", self.mode == "print"
        self.generategcode = flag(generategcode, "generategcode")
        self.generatedxf = flag(generatedxf, "generatedxf")
        self.fa, self.fs = positive(gcpfa, "gcpfa"), positive(gcpfs, "gcpfs")
        self.debugenable = False
        self._lock = threading.Lock()
        self.toolpath = kerf.Toolpath()
        self._start_motion()
        self._start_drawing()
        self._start_tools()
        self._start_printing()
        self._start_files()
        self.resolution = self.fs
        self.steps = positive(steps, "steps")
        if self.generatecut:
            self.toolpath.tool(self._tool_in_use)

    def debug(self, *args, sep=" ", end="\n", **kwargs):
        """Print, with the prefix "DEBUG: ", if `debugenable` is set."""
        if self.debugenable:
            with self._lock:
                print("DEBUG:", *args, sep=sep, end=end, **{"file": sys.stderr, **kwargs})

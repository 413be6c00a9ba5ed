"""Stock, simulation and outputs: G-code, DXF, meshes, pictures and what is shown."""

import os
import struct
import sys

import kerf
from kerf import _kerf

from ._arguments import ZEROS, GcodePreviewError, choice, drawing_colour, file_name, number, positive, warn
from ._motion import Move, Moves

_ENDINGS = {"print": ".gcode"}
_POSTS = {"print": "marlin"}
_OPTIONS = ("stockandtoolpaths", "stock", "toolpaths", "rapids")
_HAZARDS_SHOWN = 20


def _mm(value):
    """A length of a stock comment as the original writes it."""
    return "0.00" if value == 0 else str(round(value, 4))


def _box_stl(boxes):
    """Binary STL of closed blocks, each (low corner, high corner)."""
    faces = (
        (0, 2, 1),
        (1, 2, 3),
        (4, 5, 6),
        (5, 7, 6),
        (0, 1, 4),
        (1, 5, 4),
        (2, 6, 3),
        (3, 6, 7),
        (0, 4, 2),
        (2, 4, 6),
        (1, 3, 5),
        (3, 7, 5),
    )
    data = bytearray(b"stock".ljust(80) + struct.pack("<I", len(faces) * len(boxes)))
    for low, high in boxes:
        corner = [
            (high[0] if i & 1 else low[0], high[1] if i & 2 else low[1], high[2] if i & 4 else low[2])
            for i in range(8)
        ]
        for face in faces:
            data += struct.pack("<12fH", 0, 0, 0, *corner[face[0]], *corner[face[1]], *corner[face[2]], 0)
    return bytes(data)


def _block_size(stockXwidth, stockYheight, stockZthickness):
    """The checked size of a block."""
    named = {"stockXwidth": stockXwidth, "stockYheight": stockYheight, "stockZthickness": stockZthickness}
    return [positive(value, name) for name, value in named.items()]


class Result:
    """The part after the cuts: `simulation`, `hazards`, `report()`, `save(path, ...)`."""

    def __init__(self, simulation):
        self.simulation = simulation
        self.hazards = simulation.hazards

    def report(self):
        """Volumes and hazards as text, one line each; hazards with the line of the script."""
        s = self.simulation
        lines = [f"stock {s.stock_mm3:.1f} mm3, removed {s.removed_mm3:.1f} mm3, left {s.left_mm3:.1f} mm3"]
        lines += [
            f"{h['origin']}: {h['kind'].replace('_', ' ')}, {h['depth_mm']:.3f} mm deep" for h in self.hazards
        ]
        return "\n".join(lines)

    def save(self, *paths, **view):
        """Write the part as .stl .3mf .glb .obj .png or .kstock."""
        self.simulation.save(*paths, **view)

    def _repr_png_(self):
        return self.simulation._repr_png_()

    def _repr_html_(self):
        return self.simulation._repr_html_()

    def show(self):
        show(self)


def _is_stand_in(module):
    return getattr(module, "KERF_STAND_IN", False)


def show(result):
    """Hand the part to PythonSCAD, to the outputs of `kerf run`, or write it beside the script."""
    openscad = sys.modules.get("openscad")
    if openscad is not None and not _is_stand_in(openscad):
        points, triangles, _ = result.simulation.mesh()
        openscad.polyhedron(points.tolist(), triangles.tolist()).show()
        return
    outputs = os.environ.get("KERF_RUN_OUTPUTS", "").split("\n")
    outputs = [path for path in outputs if path]
    script = sys.argv[0] if sys.argv else ""
    if outputs:
        result.save(*outputs)
    elif script.endswith(".py"):
        result.save(os.path.splitext(script)[0] + ".glb", detail="columns")  # a preview, for a viewer


class Files:
    """The part of `gcodepreview` for stock, files and results."""

    def _start_files(self):
        self.stock = None
        self.folder = ""
        self.post = _POSTS.get(self.mode, "carbide")
        self.gcodefilext = _ENDINGS.get(self.mode, ".nc")
        self.on_open = self.on_section = self.on_close = None
        self.resolution = 0.0
        self.cutcolor, self.rapidcolor, self.shaftcolor = "green", "orange", "red"
        self._gcode_name = self._dxf_name = None
        self._blocks = []
        self._program = None

    def _call_hook(self, hook, *arguments):
        if hook is None:
            return
        for line in hook(self, *arguments) or ():
            self.toolpath.verbatim(str(line))

    def _write(self, name, data):
        """Writes a file whole or not at all."""
        source = self.toolpath if self._program is None else self._program
        _kerf._write_files(source, [(name, data)])

    # ---- stock

    def setupstock(
        self,
        stockXwidth,
        stockYheight,
        stockZthickness,
        zeroheight="Top",
        stockzero="Lower-Left",
        retractheight=None,
    ):
        """The stock: a block, the height of its zero (Top, Bottom) and its position (Lower-Left ... Top-
        Right).
        """
        size = _block_size(stockXwidth, stockYheight, stockZthickness)
        height = choice(zeroheight, ("Top", "Bottom"), "zeroheight")
        corner = choice(stockzero, tuple(ZEROS), "stockzero")
        if retractheight is not None:
            self.retractheight = positive(retractheight, "retractheight")
        self.stockXwidth, self.stockYheight, self.stockZthickness = stockXwidth, stockYheight, stockZthickness
        self.zeroheight, self.stockzero = height, corner
        self.stock = kerf.Stock.block(size, zero=ZEROS[corner], zero_height=height.lower())
        self._blocks = [(self.stock.low, self.stock.high)]
        self._note_stock()

    def _note_stock(self):
        x, y, z = self.stockXwidth, self.stockYheight, self.stockZthickness
        row, column = ("Center", "Center") if self.stockzero == "Center" else self.stockzero.split("-")
        dx = {"Left": 0, "Center": x / 2, "Right": x}[column]
        dy = {"Lower": 0, "Center": y / 2, "Top": y}[row]
        dz = z if self.zeroheight == "Top" else 0
        self.toolpath.note(f"stockMin:{_mm(-dx)}mm, {_mm(-dy)}mm, {_mm(-dz)}mm")
        self.toolpath.note(f"stockMax:{_mm(x - dx)}mm, {_mm(y - dy)}mm, {_mm(z - dz)}mm")
        self.toolpath.note(f"STOCK/BLOCK, {_mm(x)}, {_mm(y)}, {_mm(z)}, {_mm(dx)}, {_mm(dy)}, {_mm(dz)}")

    def setupcuttingarea(self, sizeX, sizeY, sizeZ, extentleft, extentfb, extentd):
        """A block by its size and its lowest corner; the state is that before the first motion."""
        size = [positive(v, n) for v, n in ((sizeX, "sizeX"), (sizeY, "sizeY"), (sizeZ, "sizeZ"))]
        low = [
            number(v, n)
            for v, n in ((extentleft, "extentleft"), (extentfb, "extentfb"), (extentd, "extentd"))
        ]
        self.toolpath = kerf.Toolpath()
        self._start_motion()
        self.stock = kerf.move_stock(kerf.Stock.block(size, zero_height="bottom"), shift=low)
        self._blocks = [(self.stock.low, self.stock.high)]
        return self.stock

    def _require_stock(self, call):
        if self.stock is None:
            raise GcodePreviewError(f"{call}: setupstock must be called first")

    def shiftstock(self, shiftX, shiftY, shiftZ):
        self._require_stock("shiftstock")
        shift = [number(v, n) for v, n in ((shiftX, "shiftX"), (shiftY, "shiftY"), (shiftZ, "shiftZ"))]
        self.stock = kerf.move_stock(self.stock, shift=shift)
        self._blocks = [
            tuple(tuple(c + d for c, d in zip(corner, shift)) for corner in block) for block in self._blocks
        ]

    def addtostock(self, stockXwidth, stockYheight, stockZthickness, shiftX=0, shiftY=0, shiftZ=0):
        """Add a further block with its lowest corner at the given position."""
        self._require_stock("addtostock")
        low = [number(v, n) for v, n in ((shiftX, "shiftX"), (shiftY, "shiftY"), (shiftZ, "shiftZ"))]
        size = _block_size(stockXwidth, stockYheight, stockZthickness)
        self._blocks.append((tuple(low), tuple(a + b for a, b in zip(low, size))))
        self.stock = _kerf._read_stock(_box_stl(self._blocks), "stock.stl")

    def stockfromfile(self, path):
        """The stock from a closed mesh (.stl .3mf .glb .obj) or from left-over stock (.kstock)."""
        self.stock, self._blocks = kerf.load_stock(path), []

    def flipstock(self, axis, across=None, z=None):
        """Turn over what is left of the stock about an axis along 'x' or 'y'; the following cuts are the
        second side.

        The axis is that of the block's centre unless given, mm.
        """
        self._require_stock("flipstock")
        if self._gcode_name is not None:
            raise GcodePreviewError("flipstock: closegcodefile must be called first, for the first side")
        left = kerf.left_stock(self.simulate().simulation)
        self.stock, self._blocks = kerf.move_stock(left, flip=axis, across=across, z=z), []
        self.toolpath = kerf.Toolpath()
        self.rapids, self.toolpaths = Moves(), Moves()
        self._commanded, self._unknown = None, ""
        self.toolpath.tool(self._tool_in_use)

    # ---- G-code

    def opengcodefile(
        self, basefilename="export", currenttoolnum=102, toolradius=3.175, plunge=400, feed=1600, speed=10000
    ):
        """Open the G-code file of the following motions, and set the feeds, mm/min."""
        name = file_name(basefilename, self.gcodefilext, self.folder)
        self.plunge, self.feed = positive(plunge, "plunge"), positive(feed, "feed")
        self.speed = number(speed, "speed")
        if not self.generategcode:
            return
        if self._gcode_name is not None:
            raise GcodePreviewError("opengcodefile: the file before is still open; call closegcodefile")
        folder = os.path.dirname(name) or "."
        if not os.access(folder, os.W_OK):
            raise PermissionError(f"opengcodefile: cannot write in {folder}")
        self._gcode_name = name
        self.toolpath.note(f"Design File: {basefilename}")
        self._call_hook(self.on_open)

    def writegc(self, *strings):
        """Write a line of G-code: a comment, or a line that neither moves the machine nor changes modes."""
        line = "".join(str(s) for s in strings)
        if line.startswith("(") and line.endswith(")"):
            self.toolpath.note(line[1:-1])
        else:
            self.toolpath.verbatim(line)

    def gcode(self, to=None):
        """The G-code of the motions so far, for a controller of `kerf.posts()`."""
        path = _kerf._without_unused_first_tool(self.toolpath)
        return kerf.post(path, to or self.post, tools=self._table.tools, feed=self.feed)

    def gcodepostamble(self):
        """The post writes the end of the program; before it the tool is lifted to the retract height.

        After a print, what is on is switched off, bed and chamber too, and X runs to its end switch.
        """
        if self.generateprint:
            self.toolpath.switch_off()
            self.toolpath.home("X")
            self._commanded = None
        if self.generatecut and self._commanded is not None and self.mpz < self.retractheight:
            self.rapidZ(self.retractheight)

    def closegcodefile(self):
        """Write the G-code file."""
        if not self.generategcode:
            return
        if self._gcode_name is None:
            raise GcodePreviewError("closegcodefile: no file is open")
        self.gcodepostamble()
        self._call_hook(self.on_close)
        text = self.gcode()
        self._write(self._gcode_name, text.encode())
        self._gcode_name = None

    # ---- DXF

    def opendxffile(self, basefilename="export"):
        """Open the DXF file of the following entities."""
        name = file_name(basefilename, ".dxf", self.folder)
        if not self.generatedxf:
            return
        if self._dxf_name is not None:
            raise GcodePreviewError("opendxffile: the file before is still open; call closedxffile")
        self._dxf_name, self.dxfclosed, self.dxfcolor = name, False, "Black"
        self._sketch = type(self._sketch)()

    def dxfpreamble(self, tn):
        """Part of the original's text output; the writer of the drawing does it."""

    dxfpostamble = dxfpreamble

    def _stagger(self):
        if not self.dxfstagger:
            return (0.0, 0.0)
        self._require_stock("dxfstagger")
        return tuple(h - l for l, h in zip(self.stock.low[:2], self.stock.high[:2]))

    def dxf(self):
        """The drawing so far as DXF."""
        return self._sketch.writer(self.dxfjoin, self._stagger()).dxf(self.dxfversion)

    def svg(self):
        """The drawing so far as SVG."""
        return self._sketch.writer(self.dxfjoin, self._stagger()).svg()

    def closedxffile(self):
        """Write the DXF file."""
        if not self.generatedxf:
            return
        if self._dxf_name is None:
            raise GcodePreviewError("closedxffile: no file is open")
        if self._polyline is not None:
            raise GcodePreviewError("closedxffile: a polyline is open; call closepolyline")
        self._write(self._dxf_name, self.dxf())
        self._dxf_name, self.dxfclosed = None, True

    def opendxffiles(
        self,
        basefilename="export",
        large_square_tool_num=0,
        small_square_tool_num=0,
        large_ball_tool_num=0,
        small_ball_tool_num=0,
        large_V_tool_num=0,
        small_V_tool_num=0,
        DT_tool_num=0,
        KH_tool_num=0,
        Roundover_tool_num=0,
        MISC_tool_num=0,
    ):
        """Also write one drawing for each of these tools, named by its number; 0: none."""
        numbers = (
            large_square_tool_num,
            small_square_tool_num,
            large_ball_tool_num,
            small_ball_tool_num,
            large_V_tool_num,
            small_V_tool_num,
            DT_tool_num,
            KH_tool_num,
            Roundover_tool_num,
            MISC_tool_num,
        )
        self._tools_base = file_name(basefilename, "", self.folder)
        self._tool_sketches = {n: type(self._sketch)() for n in numbers if n and self.generatedxf}

    def closedxffiles(self):
        """Write the drawings of opendxffiles."""
        _kerf._write_files(
            self.toolpath,
            [
                (f"{self._tools_base}{n}.dxf", sketch.writer(self.dxfjoin).dxf(self.dxfversion))
                for n, sketch in self._tool_sketches.items()
            ]
        )
        self._tool_sketches = {}

    # ---- results

    def setcolor(self, cutcolor="green", rapidcolor="orange", shaftcolor="red"):
        """Colours of the preview by web names."""
        for value in (cutcolor, rapidcolor, shaftcolor):
            drawing_colour(value)
        self.cutcolor, self.rapidcolor, self.shaftcolor = cutcolor, rapidcolor, shaftcolor

    def simulate(self):
        """Cut the toolpath out of the stock; returns a Result, and warns of each hazard with the script's
        line.
        """
        if self._program is not None:
            simulation = kerf.simulate(self._program, stock=self.stock, resolution=self.resolution)
        else:
            self._require_stock("stockandtoolpaths")
            simulation = kerf.simulate(self.toolpath, self.stock, self._table.tools, self.resolution)
        result = Result(simulation)
        for hazard in result.hazards[:_HAZARDS_SHOWN]:
            warn(f"{hazard['origin']}: {hazard['kind'].replace('_', ' ')}, {hazard['depth_mm']:.3f} mm deep")
        if len(result.hazards) > _HAZARDS_SHOWN:
            warn(f"{len(result.hazards) - _HAZARDS_SHOWN} more hazards")
        return result

    def returnstockandtoolpaths(self):
        """The part after all cuts."""
        return self.simulate()

    def stockandtoolpaths(self, option="stockandtoolpaths"):
        """Show the part after all cuts, or the stock, the toolpaths or the rapids alone."""
        wanted = choice(option, _OPTIONS, "option")
        if self.mode == "no_preview":
            return None
        if wanted == "rapids":
            return self.rapids
        if wanted == "toolpaths" or self.mode == "print":
            return self.toolpaths
        if wanted == "stock":
            self._require_stock("stockandtoolpaths")
            return self.stock
        result = self.simulate()
        result.show()
        return result

    def pathsvg(self, rapids=False):
        """The toolpath from above as SVG."""
        return kerf.post(self.toolpath, "svg", rapids=rapids)

    def previewgcodefile(self, gc_file):
        """Read a G-code file, its stock and its tools, and show the part. Returns a Result."""
        program = kerf.load(gc_file)
        self._program, self.toolpath = program, program.toolpath
        self.stock = program.stock
        self.rapids, self.toolpaths = Moves(), Moves()
        here, tool = (0.0, 0.0, 0.0), self.currenttoolnum
        for i in range(len(self.toolpath)):
            step = self.toolpath[i]
            tool = step.get("tool", tool)
            if "to" not in step:
                continue
            rapid = step["step"] == "rapid"
            move = Move(
                "rapid" if rapid else "cut", here, step["to"], tool, step.get("centre"), step.get("turn")
            )
            (self.rapids if rapid else self.toolpaths).append(move)
            here = step["to"]
        self.mpx, self.mpy, self.mpz = here
        result = self.simulate()
        result.show()
        return result

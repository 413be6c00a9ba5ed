"""Engraved text, Bézier curves, surfaces, countersinks, threads and a fourth axis."""

import functools
import math
import os
import tempfile

import kerf

from ._arguments import GcodePreviewError, choice, number, pairs, positive
from ._motion import Moves

FONTS = ("sans", "sans bold", "script", "script bold", "times", "times bold", "times italic")
_GCMC = dict(
    zip(
        FONTS,
        "HSANS_1 HSANS_2 HSCRIPT_1 HSCRIPT_2 HTIMES HTIMES_BOLD HTIMES_ITALIC".split(),
    )
)
_STROKES = """feedrate(100mm);
pen = 1;
foreach(typeset("%s", FONT_%s); v) {
  if(!isundef(v.z)) { pen = v.z; }
  elif(pen > 0) { goto([v.x * 1mm, v.y * 1mm, 1mm]); }
  else { move([v.x * 1mm, v.y * 1mm, 0mm]); }
}
"""
_CURVE = 0.005  # mm between a Bézier curve and its arcs


@functools.lru_cache(maxsize=256)
def _strokes(text, font):
    """The strokes of a line of text of height 1, starting at the origin: lists of points."""
    if not text.strip():
        return ()
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "text.gcmc")
        with open(name, "w", encoding="utf-8") as file:
            file.write(_STROKES % (escaped, _GCMC[font]))
        path = kerf.load(name).toolpath
    strokes = []
    for i in range(len(path)):
        step = path[i]
        if step["step"] == "rapid":
            strokes.append([step["to"][:2]])
        elif step["step"] == "cut" and strokes:
            strokes[-1].append(step["to"][:2])
    return tuple(tuple(stroke) for stroke in strokes if len(stroke) > 1)


def text(x, y, string, height, font="sans", spacing=0.0, width=1.0):
    """The strokes of a text in a single-line font: lists of points.

    (x, y) is the left end of the base line, `height` that of capitals, `width` a factor of the letters'
    width, `spacing` added between letters, mm. Lines are separated by line breaks.
    """
    h, w = positive(height, "height"), positive(width, "width")
    name, gap = choice(font, FONTS, "font"), number(spacing, "spacing")
    if not isinstance(string, str):
        raise TypeError(f"string must be a str, not {type(string).__name__}")
    made = []
    for row, line in enumerate(string.split("\n")):
        pieces = [(0.0, _strokes(line, name))]
        if gap:  # letter by letter, each where a bar after the letters before it would start
            bar = _bar_after("", name)
            pieces = [(_bar_after(line[:i], name) - bar, _strokes(c, name)) for i, c in enumerate(line)]
        for i, (offset, strokes) in enumerate(pieces):
            for stroke in strokes:
                made.append(
                    [(x + (u + offset) * h * w + i * gap, y + (v - 2 * row) * h) for u, v in stroke]
                )
    return made


def _bar_after(before, font):
    """Where a bar after some letters is, in heights."""
    return min(x for x, _ in _strokes(before + "|", font)[-1])


def bezier(control, within=_CURVE):
    """A Bézier curve of any degree through its control points as arcs: a point, then arcs and segments."""
    points = [(number(x, "control"), number(y, "control")) for x, y in pairs(control, "control")]
    if len(points) < 3:
        raise GcodePreviewError("control: at least three points are required")
    return kerf.fit_bezier(points, positive(within, "within"))


def bezier_surface(bx, by, width, height, heights):
    """The height above (x, y) of a bicubic Bézier surface over a rectangle.

    `heights` are the Z of its four rows of four control points, which are evenly spaced, from the lower left
    corner along X.
    """
    corner = number(bx, "bx"), number(by, "by")
    try:
        return kerf.BezierSurface(corner, positive(width, "width"), positive(height, "height"), heights)
    except ValueError as error:
        raise GcodePreviewError(str(error)) from None


class Further:
    """The part of `gcodepreview` for text, curves, surfaces, countersinks, threads and a fourth axis."""

    # ---- text and curves

    def cuttext(self, string, bx, by, height, bz, zdepth, font="sans", spacing=0.0, width=1.0):
        """Engrave a text in a single-line font, `zdepth` mm below `bz`; (bx, by) is the left end of its base
        line, `height` that of capitals.
        """
        z = self._bottom(bz, zdepth)
        moves = Moves()
        for stroke in text(number(bx, "bx"), number(by, "by"), string, height, font, spacing, width):
            moves = moves.union(
                self.rapidZ(self.retractheight), self.rapidXY(*stroke[0]), self.cutline(*stroke[0], z)
            )
            for point in stroke[1:]:
                moves.extend(self.cutline(*point, z))
        return moves.union(self.rapidZ(self.retractheight))

    def dxftext(self, tool_num, string, bx, by, height, font="sans", spacing=0.0, width=1.0):
        """Draw a text in a single-line font as polylines."""
        for stroke in text(number(bx, "bx"), number(by, "by"), string, height, font, spacing, width):
            self._draw(tool_num, "polyline", [(x, y, 0.0) for x, y in stroke], False)

    def cutbezier(self, control, bz, zdepth):
        """Cut along a Bézier curve, `zdepth` mm below `bz`; it is run as arcs."""
        from ._shapes import bulge_of

        z, curve = self._bottom(bz, zdepth), bezier(control)
        here = curve[0]
        moves = self.rapidZ(self.retractheight).union(self.rapidXY(*here), self.cutline(*here, z))
        for element in curve[1:]:
            end = element[-2:]
            bulge = bulge_of(here, element)
            moves = moves.union(self._cut_bulge(*here, *end, bulge, z))
            here = end
        return moves.union(self.rapidZ(self.retractheight))

    def dxfbezier(self, tool_num, control):
        """Draw a Bézier curve as a polyline of arcs."""
        from ._shapes import bulge_of

        curve = bezier(control)
        rows, here = [], curve[0]
        for element in curve[1:]:
            rows.append((*here, bulge_of(here, element)))
            here = element[-2:]
        self._draw(tool_num, "polyline", [*rows, (*here, 0.0)], False)

    # ---- surfaces

    def cutsurface(self, surface, bx, by, width, height, stepover=0.1, stepdown=0.0):
        """Cut a surface in rows along X with the tool in use, without cutting below it.

        Parameters
        ----------
        surface : callable
            The height (Z) above (x, y), mm: a function, or `shapes.bezier_surface(...)`.
        bx, by, width, height : float
            The rectangle, mm: its lower left corner and size. The tool's axis stays inside of it.
        stepover : float
            Stepover of the rows, as a fraction of the tool's diameter.
        stepdown : float
            Roughing passes of this depth from Z0 down, mm; 0: none.
        """
        x0, y0 = number(bx, "bx"), number(by, "by")
        w, h = positive(width, "width"), positive(height, "height")
        over = positive(stepover, "stepover")
        if over > 1:
            raise GcodePreviewError(f"stepover is at most 1, not {over:g}")
        down = number(stepdown, "stepdown")
        if down < 0:
            raise GcodePreviewError(f"stepdown must not be below 0, not {down:g}")
        if not callable(surface):
            raise TypeError("surface must be a function of x and y")
        try:
            tool = self._table[self.currenttoolnum]
            rows = kerf.surface_rows(surface, tool, (x0, y0), (x0 + w, y0 + h), stepover=over)
        except ValueError as error:
            raise GcodePreviewError(str(error)) from None
        lowest = min(z for row in rows for _, _, z in row)
        levels = [] if not down else [-down * i for i in range(1, math.ceil(-lowest / down))]
        moves = Moves()
        rough = rows[:: max(1, round(0.4 / over))]
        for level in levels:
            moves = moves.union(self._run_rows([[(x, y, max(z, level)) for x, y, z in row] for row in rough]))
        return moves.union(self._run_rows(rows))

    def _run_rows(self, rows):
        moves = self.rapidZ(self.retractheight).union(self.rapidXY(*rows[0][0][:2]))
        for row in rows:
            for point in row:
                moves.extend(self.cutline(*point))
        return moves.union(self.rapidZ(self.retractheight))

    # ---- holes

    def cutcountersink(self, xcenter, ycenter, diameter, angle, bz=0.0, stepover=0.1):
        """Cut a conical countersink with a ball nose, ring by ring from the inside out.

        `diameter` is that at the surface `bz`, `angle` that between its sides in degrees, `stepover` the
        distance of the rings as a fraction of the tool's diameter.
        """
        x, y, d = number(xcenter, "xcenter"), number(ycenter, "ycenter"), positive(diameter, "diameter")
        half, top = math.radians(positive(angle, "angle") / 2), number(bz, "bz")
        if not 5 <= math.degrees(half) <= 85:
            raise GcodePreviewError(f"angle must be from 10 to 170 degrees, not {angle:g}")
        if self.endmilltype != "ball":
            raise GcodePreviewError("cutcountersink: a ball nose must be in use")
        r = self.diameter / 2
        last = d / 2 - r * math.cos(half)  # radius of the ring at which the ball touches the edge
        if last <= 0:
            raise GcodePreviewError(f"diameter: the ball of {2 * r:g} mm does not fit into {d:g} mm")
        count = math.ceil(last / (positive(stepover, "stepover") * 2 * r * math.sin(half)))
        moves = self.rapidZ(self.retractheight).union(self.rapidXY(x, y))
        for i in range(count + 1):
            ring = last * i / count
            tip = top + (ring - d / 2 + r / math.cos(half)) / math.tan(half) - r
            moves = moves.union(self.cutline(x + ring, y, tip))
            if i:
                moves = moves.union(self._arc_to((x + ring, y, tip), (x, y), "ccw"))
        return moves.union(self.rapidZ(self.retractheight))

    def cutthread(self, xcenter, ycenter, diameter, pitch, bz, zdepth, hand="right"):
        """Cut an internal thread with a thread mill: a helix of whole turns from the bottom up.

        `diameter` is the nominal one; the hole must exist. `zdepth` mm below `bz` is the lowest point of the
        tool.
        """
        x, y = number(xcenter, "xcenter"), number(ycenter, "ycenter")
        d, p = positive(diameter, "diameter"), positive(pitch, "pitch")
        z = self._bottom(bz, zdepth)
        if hand not in ("right", "left"):
            raise GcodePreviewError(f"hand must be 'right' or 'left', not {hand!r}")
        radius = (d - self.diameter) / 2
        if radius <= 0:
            raise GcodePreviewError(f"diameter: the tool of {self.diameter:g} mm does not fit into {d:g} mm")
        self._expects("thread mill", "cutthread")
        # The last turn may end above the surface, so that the thread is open there.
        turns = math.ceil((number(bz, "bz") - z) / p - 1e-9)
        if turns < 1:
            raise GcodePreviewError("zdepth: the thread has no depth")
        moves = self.rapidZ(self.retractheight).union(self.rapidXY(x, y), self.rapidZ(number(bz, "bz")))
        moves = moves.union(self.cutline(x, y, z), self.cutline(x + radius, y, z))
        turn = "ccw" if hand == "right" else "cw"
        moves = moves.union(self._arc_to((x + radius, y, z + turns * p), (x, y), turn, turns - 1))
        return moves.union(self.cutline(x, y, z + turns * p), self.rapidZ(self.retractheight))

    # ---- a fourth axis

    def setrotary(self, a):
        """The angle of the A axis, degrees, at the end of the following motions; None: they have no A word.

        The post must have an A axis: `gcp.post = "linuxcnc"`.
        """
        self._rotary = None if a is None else (number(a, "a"), 0.0, 0.0)

    def simulaterotary(self, diameter, bx, ex, y=0.0, z=0.0):
        """The part turned from a round bar from X `bx` to `ex` by the A axis; Y and Z are those of its axis.

        Returns a kerf.RotarySimulation.
        """
        return kerf.simulate_rotary(
            self.toolpath,
            positive(diameter, "diameter"),
            (number(bx, "bx"), number(ex, "ex")),
            (number(y, "y"), number(z, "z")),
            self._table.tools,
            self.resolution,
        )

"""Motions: rapids, straight cuts and arcs, each a step of a Kerf toolpath with the line of the script."""

import collections
import math

from ._arguments import GcodePreviewError, number, positive, warn

# What a call adds: `kind` is 'rapid', 'cut', 'extrude' or 'shaft'; `centre` and `turn` are None but for arcs.
Move = collections.namedtuple("Move", "kind start end tool centre turn", defaults=(None, None))

_FAR = 1e-6  # mm: positions closer than this are equal


class Moves(list):
    """The moves of a call. `union` appends others, as scripts for PythonSCAD do with solids."""

    def union(self, *others):
        result = Moves(self)
        for other in others:
            result.extend(other or ())
        return result

    __or__ = union


class Motion:
    """The part of `gcodepreview` that moves the tool."""

    def _start_motion(self):
        self.mpx = self.mpy = self.mpz = 0.0
        self.mc = "Initialized"
        self.retractheight = 5.0
        self.feed, self.plunge, self.speed = 1600.0, 400.0, 10000.0
        self.feedratios = {}
        self.rapids, self.toolpaths = Moves(), Moves()
        self._commanded = None  # the end of the last step of the toolpath, None before the first
        self._unknown = ""  # its axes that were never commanded
        self._rotary = None  # of the following motions: A, B and C in degrees

    # ---- positions

    def xpos(self):
        return self.mpx

    def ypos(self):
        return self.mpy

    def zpos(self):
        return self.mpz

    def setxpos(self, newxpos):
        """Set the position in X without a motion; the next motion is preceded by a rapid to it, with a
        warning.
        """
        self.mpx = number(newxpos, "newxpos")

    def setypos(self, newypos):
        self.mpy = number(newypos, "newypos")

    def setzpos(self, newzpos):
        self.mpz = number(newzpos, "newzpos")

    def _position(self):
        return (self.mpx, self.mpy, self.mpz)

    def _catch_up(self):
        """Moves the tool to a position that was set without a motion, in Z first if that is upwards."""
        here, last = self._position(), self._commanded
        if last is None or (not self._unknown and (here == last or math.dist(here, last) <= _FAR)):
            return
        if math.dist(here, last) > _FAR:
            warn(
                f"the position was set to X{here[0]:g} Y{here[1]:g} Z{here[2]:g} without a motion from "
                f"X{last[0]:g} Y{last[1]:g} Z{last[2]:g}: a rapid to it is added"
            )
        if here[2] > last[2] + _FAR and not self._unknown:
            self.toolpath.rapid((last[0], last[1], here[2]))
        elif here[2] < last[2] - _FAR:
            self.toolpath.rapid((here[0], here[1], last[2]))
        self.toolpath.rapid(here)
        self._commanded, self._unknown = here, ""

    def _arrive(self, kind, end, centre=None, turn=None):
        move = Move(kind, self._position(), end, self.currenttoolnum, centre, turn)
        self.mpx, self.mpy, self.mpz = end
        self._commanded, self._unknown = end, ""
        if kind == "rapid":
            self.rapids.append(move)
        elif self.generatecut or kind == "extrude":
            self.toolpaths.append(move)
        return Moves([move])

    def _expects(self, shape, command):
        """Warns where a command for one shape of tool runs with another one."""
        if self.endmilltype != shape:
            warn(f"{command}: a {shape} should be in use, not a {self.endmilltype}")

    # ---- feeds

    def setfeeds(self, plunge=None, feed=None, **ratios):
        """Set the base feeds in mm/min, and ratios by class of tool.

        Classes: large_square, small_square, large_ball, small_ball, large_V, small_V, DT, KH, RO, MISC. A
        ratio multiplies both feeds while a tool of that class is in use.
        """
        if plunge is not None:
            self.plunge = positive(plunge, "plunge")
        if feed is not None:
            self.feed = positive(feed, "feed")
        for name, ratio in ratios.items():
            if name not in _CLASSES:
                raise GcodePreviewError(f"{name}: unknown class of tools; known: {', '.join(_CLASSES)}")
            self.feedratios[name] = positive(ratio, name)

    def _class_of_tool(self):
        shape, small = self.endmilltype, self.diameter <= 3.175 + _FAR
        if shape == "V":
            small = self.diameter <= 6.35 + _FAR
        for name, kinds in (("square", ("square", "O-flute")), ("ball", ("ball",)), ("V", ("V",))):
            if shape in kinds:
                return ("small_" if small else "large_") + name
        return {"dovetail": "DT", "keyhole": "KH", "roundover": "RO"}.get(shape, "MISC")

    def _feed_to(self, end, feed=None):
        """The feed of a cut to `end`: that given, else the base for plunges or cuts times the tool's ratio.
        """
        if feed is not None:
            return positive(feed, "feed")
        down = end[2] < self.mpz and math.hypot(end[0] - self.mpx, end[1] - self.mpy) <= _FAR
        base = self.plunge if down else self.feed
        return base * self.feedratios.get(self._class_of_tool(), 1.0) if self.feedratios else base

    # ---- rapids

    def rapid(self, ex, ey, ez, laser=0):
        """Move at rapid speed. With a `laser` other than 0 the tool is off, so that it may cross material."""
        end = (number(ex, "ex"), number(ey, "ey"), number(ez, "ez"))
        return self._rapid(end, self._only_z(end), laser)

    def _only_z(self, end):
        return self._commanded is None and abs(end[0] - self.mpx) <= _FAR and abs(end[1] - self.mpy) <= _FAR

    def _rapid(self, end, only_z=False, laser=0):
        if laser and self._commanded is not None:
            self.toolpath.laser(0, "off")
        if only_z:  # X and Y have no commanded position yet: they must not move
            self.toolpath.rapid((0.0, 0.0, end[2]), unknown="XY")
            moves = self._arrive("rapid", end)
            self._unknown = "XY"
            return moves
        self._catch_up()
        self.toolpath.rapid(end, rotary=self._rotary)
        return self._arrive("rapid", end)

    def movetosafeZ(self):
        """Move up to the retract height."""
        self.toolpath.note("Move to safe Z to avoid workholding")
        end = (self.mpx, self.mpy, self.retractheight)
        return self._rapid(end, self._commanded is None or bool(self._unknown))

    def rapidXYZ(self, ex, ey, ez):
        return self.rapid(ex, ey, ez)

    def rapidXY(self, ex, ey):
        return self.rapid(ex, ey, self.mpz)

    def rapidXZ(self, ex, ez):
        return self.rapid(ex, self.mpy, ez)

    def rapidYZ(self, ey, ez):
        return self.rapid(self.mpx, ey, ez)

    def rapidX(self, ex):
        return self.rapid(ex, self.mpy, self.mpz)

    def rapidY(self, ey):
        return self.rapid(self.mpx, ey, self.mpz)

    def rapidZ(self, ez):
        return self.rapid(self.mpx, self.mpy, ez)

    # ---- straight cuts

    def toolmovement(self, bx, by, bz, ex, ey, ez, step=0):
        """A cut between two points as a list of one `Move`, which is not run: no step is appended."""
        begin = (number(bx, "bx"), number(by, "by"), number(bz, "bz"))
        end = (number(ex, "ex"), number(ey, "ey"), number(ez, "ez"))
        return Moves([Move("cut", begin, end, self.currenttoolnum)])

    def shaftmovement(self, bx, by, bz, ex, ey, ez):
        """As toolmovement, for the shaft: what it touches is a hazard of `simulate`."""
        (move,) = self.toolmovement(bx, by, bz, ex, ey, ez)
        return Moves([move._replace(kind="shaft")])

    def cutline(self, ex, ey, ez, feed=None):
        """Cut a straight line from the current position; the feed is that of the tool unless given, mm/min.
        """
        end = (number(ex, "ex"), number(ey, "ey"), number(ez, "ez"))
        speed = self._feed_to(end, feed)
        self._catch_up()
        self.toolpath.cut(end, feed=speed, rotary=self._rotary)
        return self._arrive("cut", end)

    def cutlinedxf(self, ex, ey, ez):
        """As cutline, and the line in the drawing."""
        begin = self._position()
        moves = self.cutline(ex, ey, ez)
        if math.dist(begin[:2], self._position()[:2]) > _FAR:  # a plunge is no line of the drawing
            self.dxfline(self.currenttoolnum, begin[0], begin[1], self.mpx, self.mpy)
        return moves

    def cutlinegc(self, ex, ey, ez):
        return self.cutline(ex, ey, ez)

    def cutlinedxfgc(self, ex, ey, ez):
        return self.cutlinedxf(ex, ey, ez)

    def cutvertexdxf(self, ex, ey, ez):
        """As cutline, and a vertex of the polyline started with beginpolyline."""
        self.addvertex(self.currenttoolnum, ex, ey)
        return self.cutline(ex, ey, ez)

    def cutvertexdxfgc(self, ex, ey, ez):
        return self.cutvertexdxf(ex, ey, ez)

    def cutlineXYZwithfeed(self, ex, ey, ez, feed):
        return self.cutline(ex, ey, ez, feed)

    def cutlineXYZ(self, ex, ey, ez):
        return self.cutline(ex, ey, ez)

    def cutlineXYwithfeed(self, ex, ey, feed):
        return self.cutline(ex, ey, self.mpz, feed)

    def cutlineXY(self, ex, ey):
        return self.cutline(ex, ey, self.mpz)

    def cutlineXZwithfeed(self, ex, ez, feed):
        return self.cutline(ex, self.mpy, ez, feed)

    def cutlineXZ(self, ex, ez):
        return self.cutline(ex, self.mpy, ez)

    def cutlineYZwithfeed(self, ey, ez, feed):
        return self.cutline(self.mpx, ey, ez, feed)

    def cutlineYZ(self, ey, ez):
        return self.cutline(self.mpx, ey, ez)

    def cutlineXwithfeed(self, ex, feed):
        return self.cutline(ex, self.mpy, self.mpz, feed)

    def cutlineX(self, ex):
        return self.cutline(ex, self.mpy, self.mpz)

    def cutlineYwithfeed(self, ey, feed):
        return self.cutline(self.mpx, ey, self.mpz, feed)

    def cutlineY(self, ey):
        return self.cutline(self.mpx, ey, self.mpz)

    def cutlineZwithfeed(self, ez, feed):
        return self.cutline(self.mpx, self.mpy, ez, feed)

    def cutlineZ(self, ez):
        return self.cutline(self.mpx, self.mpy, ez)

    def cutlineZgcfeed(self, ez, feed):
        return self.cutlineZwithfeed(ez, feed)

    def moveatfeedrate(self, ex, ey, ez, f):
        """Move at a feed, which later extruding motions keep."""
        self.feedrate = positive(f, "f")
        return self.cutline(ex, ey, ez, f)

    def begintoolpath(self, ex, ey, ez):
        """Position for a plunge: the retract height, a rapid above the point, a rapid down to it."""
        moves = self.movetosafeZ()
        self.writecomment("PREPOSITION FOR RAPID PLUNGE")
        return moves.union(self.rapidXY(ex, ey), self.rapidZ(ez))

    def endtoolpath(self):
        return self.rapidZ(self.retractheight)

    def cutwithfeed(self, ex, ey, ez, feed):
        return self.cutline(ex, ey, ez, feed)

    def cutoneaxis_setfeed(self, axis, depth, feed):
        """Cut along one axis, 'X', 'Y' or 'Z', to a position, and keep the feed for the following cuts."""
        if axis not in ("X", "Y", "Z"):
            raise GcodePreviewError(f"axis must be 'X', 'Y' or 'Z', not {axis!r}")
        if axis == "Z":
            self.plunge = positive(feed, "feed")
        else:
            self.feed = positive(feed, "feed")
        end = dict(zip("XYZ", self._position()))
        end[axis] = number(depth, "depth")
        return self.cutline(end["X"], end["Y"], end["Z"], feed)

    def writecomment(self, text):
        self.toolpath.note(str(text))

    # ---- arcs

    def _arc(self, xcenter, ycenter, radius, barc, earc, dz, turn):
        """An arc between two angles in degrees; the tool cuts to its start first if it is elsewhere."""
        cx, cy, r = number(xcenter, "xcenter"), number(ycenter, "ycenter"), positive(radius, "radius")
        b, e = number(barc, "barc"), number(earc, "earc")
        sweep = e - b if turn == "ccw" else b - e
        if sweep <= 0:
            order = "above" if turn == "ccw" else "below"
            raise GcodePreviewError(f"earc must be {order} barc, not {e:g} with a barc of {b:g}")
        moves = Moves()
        start = _on_circle(cx, cy, r, b)
        if math.dist(start, self._position()[:2]) > _FAR:
            moves = self.cutline(start[0], start[1], self.mpz)
        x, y = start if sweep % 360 == 0 else _on_circle(cx, cy, r, e)
        return moves.union(
            self._arc_to(
                (x, y, self.mpz + number(dz, "tpzreldim")), (cx, cy), turn, math.ceil(sweep / 360) - 1
            )
        )

    def _arc_to(self, end, centre, turn, extra_turns=0):
        feed = self._feed_to((end[0], end[1], math.inf))
        self._catch_up()
        if self._commanded is None:  # an arc needs a commanded start
            self.toolpath.rapid(self._position())
        self.toolpath.arc(end, centre=centre, turn=turn, feed=feed, extra_turns=extra_turns)
        return self._arrive("cut", end, centre, turn)

    def cutarcCC(self, barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1):
        """Cut counter-clockwise from the angle `barc` to `earc`, degrees, while Z changes by `tpzreldim`."""
        positive(stepsizearc, "stepsizearc")
        return self._arc(xcenter, ycenter, radius, barc, earc, tpzreldim, "ccw")

    def cutarcCW(self, barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1):
        """Cut clockwise from the angle `barc` down to `earc`, degrees, while Z changes by `tpzreldim`."""
        positive(stepsizearc, "stepsizearc")
        return self._arc(xcenter, ycenter, radius, barc, earc, tpzreldim, "cw")

    def cutarcCCdxf(self, barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1):
        moves = self.cutarcCC(barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc)
        self.dxfarc(self.currenttoolnum, xcenter, ycenter, radius, barc, earc)
        return moves

    def cutarcCWdxf(self, barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1):
        moves = self.cutarcCW(barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc)
        self.dxfarc(self.currenttoolnum, xcenter, ycenter, radius, earc, barc)
        return moves

    def extrudearcCC(self, barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1):
        return self.cutarcCC(barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc)

    def _arc_about(self, ex, ey, ez, xcenter, ycenter, radius, turn, quadrant=None):
        """An arc of less than a turn from the current position to an end point."""
        end = (number(ex, "ex"), number(ey, "ey"), number(ez, "ez"))
        cx, cy, r = number(xcenter, "xcenter"), number(ycenter, "ycenter"), positive(radius, "radius")
        for name, p in (("the current position", self._position()), ("(ex, ey)", end)):
            off = math.dist(p[:2], (cx, cy)) - r
            if abs(off) > _ARC_ERROR:
                raise GcodePreviewError(f"radius: {name} is {r + off:.4f} mm from the centre, not {r:.4f} mm")
        begin = math.degrees(math.atan2(self.mpy - cy, self.mpx - cx))
        moves = self._arc_to(end, (cx, cy), turn)
        close = math.degrees(math.atan2(ey - cy, ex - cx))
        return moves, ((begin, close) if turn == "ccw" else (close, begin))

    def arcCCgc(self, ex, ey, ez, xcenter, ycenter, radius):
        """Cut counter-clockwise to a point about a centre."""
        return self._arc_about(ex, ey, ez, xcenter, ycenter, radius, "ccw")[0]

    def arcCWgc(self, ex, ey, ez, xcenter, ycenter, radius):
        """Cut clockwise to a point about a centre."""
        return self._arc_about(ex, ey, ez, xcenter, ycenter, radius, "cw")[0]

    # ---- circles

    def cutcircleCC(self, xcenter, ycenter, bz, ez, radius):
        """Cut a circle counter-clockwise from its right-most point, from the depth `bz` to the depth `ez`."""
        return self._circle(xcenter, ycenter, bz, ez, radius, "ccw")

    def cutcircleCW(self, xcenter, ycenter, bz, ez, radius):
        """Cut a circle clockwise from its right-most point, from the depth `bz` to the depth `ez`."""
        return self._circle(xcenter, ycenter, bz, ez, radius, "cw")

    def _circle(self, xcenter, ycenter, bz, ez, radius, turn):
        cx, cy, r = number(xcenter, "xcenter"), number(ycenter, "ycenter"), positive(radius, "radius")
        bottom = number(ez, "ez")
        moves, start = Moves(), (cx + r, cy, number(bz, "bz"))
        if math.dist(start, self._position()) > _FAR:
            moves = self.cutline(*start)
        return moves.union(self._arc_to((start[0], start[1], bottom), (cx, cy), turn))

    def cutcircleCCdxf(self, xcenter, ycenter, bz, ez, radius):
        moves = self.cutcircleCC(xcenter, ycenter, bz, ez, radius)
        self.dxfcircle(self.currenttoolnum, xcenter, ycenter, radius)
        return moves

    def cutcircleCWdxf(self, xcenter, ycenter, bz, ez, radius):
        moves = self.cutcircleCW(xcenter, ycenter, bz, ez, radius)
        self.dxfcircle(self.currenttoolnum, xcenter, ycenter, radius)
        return moves


_CLASSES = (
    "large_square",
    "small_square",
    "large_ball",
    "small_ball",
    "large_V",
    "small_V",
    "DT",
    "KH",
    "RO",
    "MISC",
)
_ARC_ERROR = 1e-3  # mm by which a given radius may differ


def _on_circle(cx, cy, r, degrees):
    """The point at an angle; exact at multiples of 90 degrees."""
    quarter = degrees / 90
    if quarter == round(quarter):
        cos, sin = ((1, 0), (0, 1), (-1, 0), (0, -1))[round(quarter) % 4]
    else:
        cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return cx + r * cos, cy + r * sin


# Quarter circles by the quadrant they lie in and their direction: the angles at their ends. The names give
# the end point (ex, ey); its angle and the radius give the centre.
_QUADRANTS = {"NE": 0, "NW": 90, "SW": 180, "SE": 270}


def _add_quarters(cls):
    for quadrant, low in _QUADRANTS.items():
        for turn in ("CC", "CW"):
            _add_quarter(cls, quadrant, turn, low)


def _add_quarter(cls, quadrant, turn, low):
    begin, close = (low, low + 90) if turn == "CC" else (low + 90, low)
    sense = "ccw" if turn == "CC" else "cw"

    def quarter(self, ex, ey, ez, radius):
        x, y, z = number(ex, "ex"), number(ey, "ey"), number(ez, "ez")
        r = positive(radius, "radius")
        dx, dy = _on_circle(0, 0, r, close)
        return self._arc(x - dx, y - dy, r, begin, close, z - self.mpz, sense)

    def quarter_dxf(self, ex, ey, ez, radius):
        moves = quarter(self, ex, ey, ez, radius)
        dx, dy = _on_circle(0, 0, radius, close)
        self.dxfarc(self.currenttoolnum, ex - dx, ey - dy, radius, low, low + 90)
        return moves

    def arc_dxf(self, ex, ey, ez, xcenter, ycenter, radius):
        moves, angles = self._arc_about(ex, ey, ez, xcenter, ycenter, radius, sense)
        self.dxfarc(self.currenttoolnum, xcenter, ycenter, radius, *angles)
        return moves

    way = "counter-clockwise" if turn == "CC" else "clockwise"
    quarter.__doc__ = f"Cut the {quadrant} quarter of a circle {way}; it ends at (ex, ey, ez)."
    arc_dxf.__doc__ = f"Cut an arc in the {quadrant} quadrant {way} to (ex, ey, ez), also in the drawing."
    quarter_dxf.__doc__ = quarter.__doc__[:-1] + ", also in the drawing."
    for name, function in (
        (f"cutquarter{turn}{quadrant}", quarter),
        (f"cutquarter{turn}{quadrant}dxf", quarter_dxf),
        (f"cutarc{quadrant}{turn}dxf", arc_dxf),
        (f"cutarc{quadrant}{turn}dxfgc", arc_dxf),
    ):
        setattr(cls, name, function)


_add_quarters(Motion)

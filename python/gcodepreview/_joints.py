"""Joints: half-blind dovetails, finger joints and full-blind box joints."""

import math

from ._arguments import GcodePreviewError, choice, number, positive, warn, whole
from ._motion import Moves

_SIDES = {"Vertical": ("Left", "Right", "Both"), "Horizontal": ("Lower", "Upper", "Both")}
# Between the fingers of a full-blind joint: the smaller tool's diameter times this.
_PITCH = 1.1
_SPEED = 17000  # rpm


class _Dovetail:
    """The figures of a dovetail joint."""

    def __init__(
        self,
        Joint_Width,
        stockZthickness,
        Number_of_Dovetails,
        Spacing,
        Proportion,
        DTT_diameter,
        DTT_angle,
        fit,
    ):
        self.width = positive(Joint_Width, "Joint_Width")
        self.thickness = positive(stockZthickness, "stockZthickness")
        self.count = whole(Number_of_Dovetails, "Number_of_Dovetails", 1)
        self.spacing = positive(Spacing, "Spacing")
        proportion = positive(Proportion, "Proportion")
        if proportion >= 1:
            raise GcodePreviewError(f"Proportion of a half-blind joint is below 1, not {proportion:g}")
        self.diameter = positive(DTT_diameter, "DTT_diameter")
        angle = positive(DTT_angle, "DTT_angle")
        self.depth = self.thickness * proportion
        self.taper = math.tan(math.radians(angle)) * self.depth
        self.neck = self.diameter / 2 - self.taper  # radius of the tool at the surface
        if self.neck <= 0:
            raise GcodePreviewError(f"DTT_angle: at {self.depth:g} mm depth the tool has no neck left")
        self.step = self.width / (2 * self.count)
        self.fit = number(fit, "fit")

    def positions(self):
        """X of each dovetail's centre, and of the boundary after it."""
        return [((2 * i + 1) * self.step, (2 * i + 2) * self.step) for i in range(self.count)]


class Joints:
    """The part of `gcodepreview` that cuts joints."""

    def cut_pins(
        self,
        Joint_Width,
        stockZthickness,
        Number_of_Dovetails,
        Spacing,
        Proportion,
        DTT_diameter,
        DTT_angle,
        fit=0.0,
    ):
        """The pin board of a half-blind dovetail joint, cut with the dovetail tool in use.

        `fit` is the clearance of the joint, mm: the sockets are lengthened by it.
        """
        j = _Dovetail(
            Joint_Width,
            stockZthickness,
            Number_of_Dovetails,
            Spacing,
            Proportion,
            DTT_diameter,
            DTT_angle,
            fit,
        )
        self._expects("dovetail", "cut_pins")
        n, row = self.currenttoolnum, j.thickness + j.spacing / 2
        end = j.thickness + j.spacing + j.depth - j.diameter / 2 + j.fit
        moves = self.rapidXY(0, row).union(self.cutlinedxfgc(0, row, -j.depth))
        for x, boundary in j.positions():
            moves = moves.union(
                self.cutlinedxfgc(x, row, -j.depth),
                self.cutlinedxfgc(x, end, -j.depth),
                self.cutlinedxfgc(x, row, -j.depth),
                self.cutlinedxfgc(boundary, row, -j.depth),
            )
            height = j.depth + j.spacing / 2 + 2 * j.neck - j.diameter / 2 + j.fit
            self.dxfrectangleround(n, x - j.neck, row - j.neck, 2 * j.neck, height, j.neck)
        return moves.union(self.rapidZ(0))

    def cut_tails(
        self,
        Joint_Width,
        stockZthickness,
        Number_of_Dovetails,
        Spacing,
        Proportion,
        DTT_diameter,
        DTT_angle,
        fit=0.0,
    ):
        """The tail board of a half-blind dovetail joint, cut with the dovetail tool in use.

        `fit` is the clearance of the joint, mm: the tails are narrower by it on each side.
        """
        j = _Dovetail(
            Joint_Width,
            stockZthickness,
            Number_of_Dovetails,
            Spacing,
            Proportion,
            DTT_diameter,
            DTT_angle,
            fit,
        )
        self._expects("dovetail", "cut_tails")
        n, z = self.currenttoolnum, -j.depth
        radius = j.diameter - j.taper - j.fit
        top = j.depth - j.diameter / 2
        moves = self.rapidXY(0, 0).union(self.cutlinedxfgc(0, 0, z))
        for x, boundary in j.positions():
            moves = moves.union(
                self.cutlinedxfgc(x - radius, 0, z),
                self.cutlinedxfgc(x - radius, top, z),
                self.cutarcCWdxf(180, 90, x, top, radius, 0),
                self.cutarcCWdxf(90, 0, x, top, radius, 0),
                self.cutlinedxfgc(x + radius, 0, z),
            )
            following = boundary + j.step - radius
            if x + radius > following:
                raise GcodePreviewError(f"Number_of_Dovetails: the tool does not fit between {j.count} tails")
            moves = moves.union(self.cutlinedxfgc(following, 0, z))
        moves = moves.union(self.rapidZ(0), self.rapidXY(0, 0), self.cutline(0, 0, z))
        back = j.thickness + j.taper
        moves = moves.union(self.cutline(0, back, z))
        for i, (_, boundary) in enumerate(j.positions()):
            moves = moves.union(self.cutline(boundary, back, z), self.cutline(boundary, 0, z))
            if i + 1 < j.count:
                moves = moves.union(self.cutline(boundary, back, z))
        self._draw_tails(n, j)
        return moves

    def _draw_tails(self, n, j):
        """The closed outline of the tails: round ends of the width between two sockets."""
        r, y = j.step - j.neck, j.depth - j.diameter / 2
        bulge = -math.tan(math.pi / 8)
        for x, _ in j.positions():
            self._draw(
                n,
                "polyline",
                [(x - r, 0.0, 0.0), (x - r, y, bulge), (x, y + r, bulge), (x + r, y, 0.0), (x + r, 0.0, 0.0)],
                True,
            )

    # ---- full-blind box joints

    def Full_Blind_Finger_Joint(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        largeVdiameter,
        smallDiameter,
        normalormirror="Default",
        squaretool=102,
        smallV=390,
        largeV=301,
        fit=0.0,
    ):
        """A full-blind box joint with its three tools: a square tool, a small and a large V."""
        joint = _box_joint(
            bx, by, orientation, side, width, thickness, largeVdiameter, smallDiameter, normalormirror
        )
        reach = positive(largeVdiameter, "largeVdiameter") / 2
        if reach < joint.thickness:
            warn(
                f"largeVdiameter: a 90 degree V of {2 * reach:g} mm cuts {reach:g} mm deep, "
                f"not {joint.thickness:g} mm"
            )
        moves = Moves()
        for number_of_tool, call in (
            (squaretool, self.Full_Blind_Finger_Joint_square),
            (smallV, self.Full_Blind_Finger_Joint_smallV),
            (largeV, self.Full_Blind_Finger_Joint_largeV),
        ):
            moves = moves.union(self.rapidZ(self.retractheight))
            self.toolchange(number_of_tool, _SPEED)
            extra = {"fit": fit} if call == self.Full_Blind_Finger_Joint_square else {}
            moves = moves.union(
                call(
                    bx,
                    by,
                    orientation,
                    side,
                    width,
                    thickness,
                    joint.pins,
                    largeVdiameter,
                    smallDiameter,
                    normalormirror,
                    **extra,
                )
            )
        return moves.union(self.rapidZ(self.retractheight))

    def Full_Blind_Finger_Joint_square(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        Number_of_Pins,
        largeVdiameter,
        smallDiameter,
        normalormirror="Default",
        fit=0.0,
    ):
        """The fingers and the frame around them, with the square tool."""
        j = _box_joint(
            bx,
            by,
            orientation,
            side,
            width,
            thickness,
            largeVdiameter,
            smallDiameter,
            normalormirror,
            Number_of_Pins,
        )
        s, t = j.small, j.thickness
        moves = self.Finger_Joint_square(
            bx,
            by,
            orientation,
            side,
            width,
            thickness,
            Number_of_Pins,
            j.origin,
            smallDiameter,
            normalormirror,
            fit,
        )
        moves = moves.union(self.rapidZ(self.retractheight))
        colour = self.dxfcolor
        self.setdxfcolor("Cyan")
        low = {"Both": -(t - s / 2), j.sides[0]: -s / 2, j.sides[1]: -(t - s / 2)}[j.side]
        across = 2 * t - s if j.side == "Both" else t
        x, y = j.at(-s / 2, low)
        x2, y2 = j.at(j.width + s / 2, low + across)
        x, y, w, h = min(x, x2), min(y, y2), abs(x2 - x), abs(y2 - y)
        moves = moves.union(
            self.rapidXY(x + s / 2, y),
            self.rapidZ(0),
            self.cutrectanglerounddxf(self.currenttoolnum, x, y, 0, w, h, s / 2, s / 2),
            self.rapidZ(self.retractheight),
        )
        self.setdxfcolor(colour)
        return moves

    def Finger_Joint_square(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        Number_of_Pins,
        Finger_Origin,
        smallDiameter,
        normalormirror="Default",
        fit=0.0,
    ):
        """The fingers of a joint: slots across the joint line, on one side of it or on both in turns.

        `fit` is the clearance of the joint, mm: each slot is wider by it.
        """
        j = _box_joint(
            bx, by, orientation, side, width, thickness, None, smallDiameter, normalormirror, Number_of_Pins
        )
        s, gap = j.small, j.small / 10 + number(fit, "fit")
        z, reach = -(j.thickness - s / 2), j.thickness - s
        along = number(Finger_Origin, "Finger_Origin")
        n, colour = self.currenttoolnum, self.dxfcolor
        self.setdxfcolor("Blue")
        start = j.at(along, 0)
        moves = self.rapidXY(*start).union(self.rapidZ(0), self.cutline(*start, z))
        self.beginpolyline(n)
        self.addvertex(n, *start)
        pitch = 2 * s * _PITCH / 2
        slots = 2 * j.pins - 1
        for i in range(slots):
            first = along + i * pitch + s / 2 - (gap - s / 10) / 2
            if not j.cuts(i):
                continue
            up = reach * j.direction(i)
            for u, v in ((first, 0), (first, up), (first + gap, up), (first + gap, 0)):
                moves = moves.union(self.cutvertexdxf(*j.at(u, v), z))
        moves = moves.union(self.cutvertexdxf(*j.at(along + slots * pitch, 0), z))
        self.closepolyline(n)
        self.setdxfcolor(colour)
        return moves.union(self.rapidZ(self.retractheight))

    def Full_Blind_Finger_Joint_smallV(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        Number_of_Pins,
        largeVdiameter,
        smallDiameter,
        normalormirror="Default",
    ):
        """The line of the joint to its full depth, with the small V."""
        j = _box_joint(
            bx,
            by,
            orientation,
            side,
            width,
            thickness,
            largeVdiameter,
            smallDiameter,
            normalormirror,
            Number_of_Pins,
        )
        return self._v_line(j, "Red", -j.small / 6, j.width + j.small / 6, 0, j.thickness)

    def Full_Blind_Finger_Joint_largeV(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        Number_of_Pins,
        largeVdiameter,
        smallDiameter,
        normalormirror="Default",
    ):
        """The mitres: the ends of the line to full depth, the edges, and the ends of the boards, with the
        large V.
        """
        j = _box_joint(
            bx,
            by,
            orientation,
            side,
            width,
            thickness,
            largeVdiameter,
            smallDiameter,
            normalormirror,
            Number_of_Pins,
        )
        s, t, w = j.small, j.thickness, j.width
        moves = self._v_line(j, "Blue", 0, j.origin, 0, t).union(
            self._v_line(j, "Blue", w - j.origin, w, 0, t)
        )
        for sign in (1, -1):
            if j.side != "Both" and sign != j.sign:
                continue
            edge = sign * (t - s / 2)
            moves = moves.union(
                self._v_line(j, "Dark Gray", -s / 2, w + s / 2, edge, s / 2),
                self._v_line(j, "Green", w, w - t, sign * t / 2, t / 2),
                self._v_line(j, "Green", 0, t, sign * t / 2, t / 2),
            )
        return moves

    def _v_line(self, j, colour, begin, close, across, depth):
        """A straight groove along the joint at a distance from its line."""
        start, end = j.at(begin, across), j.at(close, across)
        before = self.dxfcolor
        self.setdxfcolor(colour)
        moves = self.rapidZ(0).union(
            self.rapidXY(*start),
            self.cutline(*start, -depth),
            self.cutlinedxfgc(*end, -depth),
            self.rapidZ(0),
        )
        self.setdxfcolor(before)
        return moves


class _box_joint:
    """The figures of a box joint. `at` converts positions along the joint and across it to X and Y."""

    def __init__(
        self,
        bx,
        by,
        orientation,
        side,
        width,
        thickness,
        largeVdiameter,
        smallDiameter,
        normalormirror,
        pins=None,
    ):
        self.x, self.y = number(bx, "bx"), number(by, "by")
        self.vertical = choice(orientation, tuple(_SIDES), "orientation") == "Vertical"
        known = _SIDES["Vertical" if self.vertical else "Horizontal"]
        self.side, self.sides = choice(side, known, "side"), known[:2]
        self.width, self.thickness = positive(width, "width"), positive(thickness, "thickness")
        self.small = positive(smallDiameter, "smallDiameter")
        if largeVdiameter is not None:
            positive(largeVdiameter, "largeVdiameter")
        if self.thickness <= self.small:
            raise GcodePreviewError(f"smallDiameter: the boards must be thicker than {self.small:g} mm")
        room = self.width - 2 * self.thickness
        fitting = int(room / (2 * _PITCH * self.small) / 2) * 2 + 1
        self.pins = whole(pins, "Number_of_Pins", 1) if pins is not None else fitting
        self.fingers = (2 * self.pins - 1) * self.small * _PITCH  # the length of all fingers
        if self.fingers > self.width:
            raise GcodePreviewError(f"Number_of_Pins: {self.pins} pins are longer than the joint")
        self.origin = self.width / 2 - self.fingers / 2
        kind = choice(normalormirror, ("Default", "Even", "Odd"), "normalormirror")
        if kind == "Default":
            kind = "Odd" if self.side == self.sides[1] else "Even"
        self.odd = kind == "Odd"
        self.sign = -1 if self.side == self.sides[1] else 1

    def at(self, along, across):
        """Left is -X and Lower is -Y of the line of the joint."""
        return (self.x + across, self.y + along) if self.vertical else (self.x + along, self.y + across)

    def direction(self, i):
        """The side of the line on which slot `i` is: 1 or -1."""
        if self.side == "Both":
            return 1 if (i % 2 == 0) != self.odd else -1
        return self.sign

    def cuts(self, i):
        return self.side == "Both" or (i % 2 == 1) == self.odd

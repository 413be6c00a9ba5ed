"""Tools: the shafts and the names of variables that gcodepreview has for each, and the four descriptions.

The shapes are those of Kerf's tools.
"""

from __future__ import annotations

import math
from typing import Any

import kerf
from kerf._types import Points

# Shafts: diameter, and length from the flute to the collet, mm. A tool without an entry has the shaft of
# its diameter.
_SHAFTS = {
    102: (3.175, 19.5),
    112: (3.175, 12),
    122: (3.175, 12),
    282: (6.35, 12),
    111: (3.175, 20),
    121: (3.175, 20),
    301: (6.35, 20),
    302: (6.35, 20),
    327: (6.35, 20),
    374: (6.35, 20),
    375: (8, 20),
    376: (6.35, 20),
    378: (8, 20),
    45981: (6.35, 20),
    45982: (6.35, 20),
    1370: (6.35, 20),
    1372: (6.35, 20),
    501: (3.175, 10),
    502: (3.175, 10),
    56125: (6.35, 10),
    56142: (3.175, 10),
    814: (8, 20),
    45828: (6.35, 20),
    211: (8, 49),
    213: (8, 49),
    214: (8, 49),
    311: (8, 20),
    312: (8, 20),
    648: (2.4, 18),
}
_SHAFT_LENGTH = 20.0
# Included angle of V tools, of tapered balls and of dovetails (there from the axis), degrees.
_ANGLES = {
    301: 90,
    302: 60,
    390: 90,
    327: 60,
    323: 30,
    311: 90,
    312: 60,
    690: 90,
    501: 30,
    502: 40,
    204: 7.152,
    304: 4.772,
    814: 14,
    45828: 8,
    13921: 90,
}
# Diameter of the tip.
_TIPS = {
    501: 0.254,
    502: 0.254,
    204: 1.5875,
    304: 3.175,
    56125: 0.508,
    56142: 0.508,
    1568: 0.396875,
    1570: 0.396875,
    1572: 0.396875,
    1574: 0.396875,
    13921: 6.35,
}
# Radius of rounded shapes; of keyhole cutters the diameter of the neck.
_RADII = {
    45981: 3.175,
    45982: 6.35,
    1370: 3.175,
    1372: 6.35,
    56125: 2.921,
    56142: 1.3335,
    1568: 3.175,
    1570: 4.7625,
    1572: 6.35,
    1574: 9.525,
    374: 6.35,
    375: 8,
    376: 6.35,
    378: 8,
}
_HEADS = {374: 3.175, 375: 3.175, 376: 4.7625, 378: 4.7625}  # height of a keyhole cutter's head


def _flattened(knots, degrees=3.0):
    """The points (r, z) of a profile with arcs as chords."""
    points = []
    for (r, z, bulge), end in zip(knots, list(knots[1:]) + [None]):
        points.append((r, z))
        if end is None or bulge == 0:
            continue
        sweep = 4 * math.atan(bulge)
        chord = math.hypot(end[0] - r, end[1] - z)
        radius = chord / (2 * math.sin(sweep / 2))
        half = math.atan2(end[1] - z, end[0] - r)
        start = half - sweep / 2
        centre = (r - radius * math.sin(start), z + radius * math.cos(start))
        count = max(1, math.ceil(abs(math.degrees(sweep)) / degrees))
        for i in range(1, count):
            at = start + sweep * i / count
            points.append((centre[0] + radius * math.sin(at), centre[1] - radius * math.cos(at)))
    return points


class Section:
    """A half profile of a tool and its shaft: points from the tip upwards, mm; arcs as bulges.

    Parameters
    ----------
    knots : iterable of (float, float, float)
        The cutting part: r, z, and the bulge of the arc to the next point (0: straight), mm; Z up, Z0 at the
        tip. A bulge is the tangent of a quarter of the arc's angle, as in DXF.
    shaft : iterable of (float, float)
        The shaft: r, z, mm.
    name : str
        Title of its drawings.
    """

    def __init__(self, knots: Any, shaft: Any, name: str = "tool") -> None:
        self.knots = [tuple(k) for k in knots]
        self.shaft = [tuple(p) for p in shaft]
        self.name = name

    def profile(self) -> Points:
        """The cutting part from the axis: points (r, z).

        Returns
        -------
        list of (float, float)
            The points, mm; arcs as chords of at most 3 degrees.
        """
        points = _flattened(self.knots)
        if points and points[0][0] > 0:
            points.insert(0, (0.0, points[0][1]))
        if points and points[-1][0] > 0:
            points.append((0.0, points[-1][1]))
        return points

    def outline(self) -> Points:
        """Both sides of the cutting part: points (x, z), counter-clockwise, from the tip.

        Returns
        -------
        list of (float, float)
            The points, mm.
        """
        right = [p for p in self.profile() if p[0] > 0]
        return right + [(-r, z) for r, z in reversed(right)]

    def shaft_outline(self) -> Points:
        """Both sides of the shaft: points (x, z), counter-clockwise.

        Returns
        -------
        list of (float, float)
            The points, mm.
        """
        right = [p for p in self.shaft if p[0] > 0]
        return right + [(-r, z) for r, z in reversed(right)]

    def whole_profile(self) -> Points:
        """One side of the whole tool, from the axis at its tip to the axis at the end of its shaft.

        Returns
        -------
        list of (float, float)
            The points (r, z), mm.
        """
        side = [p for p in self.profile()[:-1] + self.shaft if p[0] > 0]
        points = [(0.0, side[0][1]), *side, (0.0, side[-1][1])]
        if self.profile()[0][0] == 0:
            points[0] = self.profile()[0]
        return [p for p, before in zip(points, [None, *points]) if p != before]

    def whole_outline(self) -> Points:
        """Both sides of the whole tool: points (x, z), counter-clockwise, from the tip.

        Returns
        -------
        list of (float, float)
            The points, mm.
        """
        points = self.whole_profile()[:-1]
        tip = points[:1] if points[0][1] < points[1][1] else []  # a flat tip has no point on the axis
        side = points[1:]
        return tip + side + [(-r, z) for r, z in reversed(side)]

    def shape(self, sides: int = 48) -> list[Any]:
        """A closed surface of the whole tool: triangles of three points each.

        Parameters
        ----------
        sides : int
            Count of corners of its circles.

        Returns
        -------
        list of tuple
            Triangles of three points (x, y, z), mm; Z up, Z0 at the tip.
        """
        points = [p for p in self.profile()[:-1] + self.shaft if p[0] > 0]
        low, high = self.profile()[0][1], points[-1][1]
        ring = [
            [
                (r * math.cos(2 * math.pi * k / sides), r * math.sin(2 * math.pi * k / sides), z)
                for k in range(sides)
            ]
            for r, z in points
        ]
        triangles = []
        for k in range(sides):
            m = (k + 1) % sides
            triangles.append(((0, 0, low), ring[0][m], ring[0][k]))
            triangles.append(((0, 0, high), ring[-1][k], ring[-1][m]))
            for below, above in zip(ring, ring[1:]):
                triangles.append((below[k], below[m], above[m]))
                triangles.append((below[k], above[m], above[k]))
        return [t for t in triangles if len(set(t)) == 3]

    def svg(self, what: str = "outline") -> str:
        """The outline or the profile, with the shaft, as SVG text in true size.

        Parameters
        ----------
        what : {'outline', 'profile'}
            Both sides, or the half from the axis.

        Returns
        -------
        str
            The file, in mm.
        """
        drawing = kerf.DrawingWriter()
        drawing.layer("tool", colour=3)
        drawing.layer("shaft", colour=1)
        parts = (
            (self.outline(), self.shaft_outline())
            if what == "outline"
            else (
                self.profile(),
                [(0.0, self.shaft[0][1]), *self.shaft, (0.0, self.shaft[-1][1])] if self.shaft else [],
            )
        )
        for layer, points in zip(("tool", "shaft"), parts):
            if len(points) > 2:
                drawing.polyline(layer, [(x, y, 0.0) for x, y in points], closed=True)
        return drawing.svg(title=f"{self.name} {what}")


class ToolFacts:
    """The variables of the tool in use. They change with it: by toolchange, by a description."""

    @property
    def flute(self) -> float:
        """float: length of the flute, mm; of a keyhole cutter that of its head."""
        n = self._tool_number
        return self._tool.flute if self._tool_is_described else _HEADS.get(n, self._tool.flute)

    @property
    def radius(self) -> float:
        """float: radius of rounded shapes, of keyhole cutters the diameter of the neck, mm; 0: none."""
        tool = self._tool
        rounded = tool.diameter / 2 if tool.shape == "ball" else 0.0
        return rounded if self._tool_is_described else _RADII.get(self._tool_number, rounded)

    @property
    def angle(self) -> float:
        """float: angle between the sides of a V, degrees; of a dovetail from its axis; 0: none."""
        return 0.0 if self._tool_is_described else _ANGLES.get(self._tool_number, 0.0)

    @property
    def tip(self) -> float:
        """float: diameter of the tip, mm; 0: none."""
        return 0.0 if self._tool_is_described else _TIPS.get(self._tool_number, 0.0)

    tipdiameter = tip

    @property
    def shaftdiameter(self) -> float:
        """float: diameter of the shaft, mm."""
        return self._shaft()[0]

    @property
    def shaftheight(self) -> float:
        """float: height of the shaft above the tip, mm."""
        return self.shaftprofile[0][1]

    @property
    def shaftlength(self) -> float:
        """float: length of the shaft, mm."""
        return self._shaft()[1]

    @property
    def toolprofile(self) -> Points:
        """list of (float, float): the cutting part from the axis: points (r, z), mm."""
        return self._section.profile()

    @property
    def tooloutline(self) -> Points:
        """list of (float, float): both sides of the cutting part: points (x, z), mm."""
        return self._section.outline()

    @property
    def shaftprofile(self) -> Points:
        """list of (float, float): one side of the shaft: points (r, z), mm."""
        return list(self._section.shaft)

    @property
    def shaftoutline(self) -> Points:
        """list of (float, float): both sides of the shaft: points (x, z), mm."""
        return self._section.shaft_outline()

    def _shaft(self):
        """Diameter and length of the shaft above the flute, mm."""
        shank = self._tool_parts[2]
        if self._tool_is_described and shank:
            return 2 * shank[-1][0], shank[-1][1] - shank[-2][1]
        return _SHAFTS.get(self._tool_number, (self._tool.diameter, _SHAFT_LENGTH))

    @property
    def _section(self):
        """The tool as drawn: the knots of its cutting part, and its shaft."""
        cutting, neck, shank, _ = self._tool_parts
        knots = cutting + neck
        shaft = [(r, z) for r, z, _ in shank]
        if not self._tool_is_described or len(shaft) < 2:
            top, height = 2 * knots[-1][0], self._tool.flute
            width, length = self._shaft()
            shaft = [(top / 2, height), (width / 2, height), (width / 2, height + length)]
        elif len(shaft) == 2:
            shaft = [(knots[-1][0], shaft[0][1]), *shaft]
        return Section(knots, shaft, str(self._tool_number))

"""Tools: the table of numbers, the change of tools, and the four descriptions of a tool.

The shapes are those of Kerf's built-in tools; this module adds the shafts and the names of variables.
"""

import math
import struct

import kerf

from ._arguments import GcodePreviewError, number, positive, whole

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
    1568: 0.79375,
    1570: 0.79375,
    1572: 0.79375,
    1574: 0.79375,
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
# Tools of makers that have the shape of another; Amana 45828 is listed with two generated numbers.
_SAME = {808079: 45828, 808071: 45828}
_O_FLUTES = (282, 274, 278)
_GENERATED = 100000  # generated numbers have six digits


class ToolTable:
    """Kerf's built-in tools with the maker's and the generated number of each."""

    def __init__(self):
        self.tools = kerf.built_in_tools()
        self.own = set()
        self._maker = {}
        for n in self.tools.numbers():
            if n < _GENERATED:
                for name in self.tools[n].names:
                    if name.isdigit() and len(name) == 6:
                        self._maker.setdefault(int(name), n)
        self._maker.update(_SAME)

    def maker_number(self, value):
        """The maker's number of a tool given by that or by its generated number."""
        n = whole(value, "tool_number")
        n = self._maker.get(n, n)
        if n not in self.tools:
            known = ", ".join(str(k) for k in self.tools.numbers() if k < _GENERATED)
            raise GcodePreviewError(f"tool_number: there is no tool {value}; known: {known}")
        return n

    def __getitem__(self, value):
        return self.tools[self.maker_number(value)]

    def generated_number(self, value):
        """The six-digit number as text; that of the maker for tools without one."""
        n = self.maker_number(value)
        names = [name for name in self.tools[n].names if name.isdigit() and len(name) == 6]
        return names[0] if names else str(n)

    def add(self, n, tool):
        self.tools[n] = tool
        self.own.add(n)


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
    """A half profile of a tool and its shaft: points from the tip upwards, mm; arcs as bulges."""

    def __init__(self, knots, shaft, name="tool"):
        self.knots = [tuple(k) for k in knots]
        self.shaft = [tuple(p) for p in shaft]
        self.name = name

    def profile(self):
        """The cutting part from the axis: points (r, z)."""
        points = _flattened(self.knots)
        if points and points[0][0] > 0:
            points.insert(0, (0.0, points[0][1]))
        if points and points[-1][0] > 0:
            points.append((0.0, points[-1][1]))
        return points

    def outline(self):
        """Both sides of the cutting part: points (x, z), counter-clockwise, from the tip."""
        right = [p for p in self.profile() if p[0] > 0]
        return right + [(-r, z) for r, z in reversed(right)]

    def shaft_outline(self):
        right = [p for p in self.shaft if p[0] > 0]
        return right + [(-r, z) for r, z in reversed(right)]

    def shape(self, sides=48):
        """A closed surface of the whole tool: triangles of three points each."""
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

    def svg(self, what="outline"):
        """The outline or the profile, with the shaft, as SVG text in true size."""
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

    def stl(self):
        """The shape as binary STL."""
        triangles = self.shape()
        data = bytearray(f"{self.name}".encode()[:80].ljust(80, b" ") + struct.pack("<I", len(triangles)))
        for a, b, c in triangles:
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            length = math.sqrt(sum(x * x for x in n)) or 1.0
            data += struct.pack("<12fH", *(x / length for x in n), *a, *b, *c, 0)
        return bytes(data)


class Tools:
    """The part of `gcodepreview` that is about tools."""

    def _start_tools(self):
        self._table = ToolTable()
        self.steps = 10
        self.currenttoolnum = 102
        self._set_tool(102)

    def _set_tool(self, value):
        n = self._table.maker_number(value)
        tool = self._table[n]
        self._tool_in_use = n
        self.toolnumber = self._table.generated_number(n)
        shape = "O-flute" if n in _O_FLUTES else tool.shape
        self.endmilltype = shape
        self.diameter = tool.diameter
        self.flute = _HEADS.get(n, tool.flute)
        self.radius = _RADII.get(n, tool.diameter / 2 if tool.shape == "ball" else 0.0)
        self.angle = _ANGLES.get(n, 0.0)
        self.tip = self.tipdiameter = _TIPS.get(n, 0.0)
        shaft, length = _SHAFTS.get(n, (tool.diameter, _SHAFT_LENGTH))
        self._describe(tool.profile, 2 * tool.profile[-1][0], tool.flute, 0.0, shaft, length, str(n))

    def _describe(self, knots, top, flute, transition, shaft, length, name):
        self.shaftdiameter, self.shaftheight, self.shaftlength = shaft, flute, length
        self._section = Section(knots, [], name)
        self.defineshaft(top, shaft, flute, transition, length)
        self._describe_parts()

    def _describe_parts(self):
        self.toolprofile, self.tooloutline = self._section.profile(), self._section.outline()
        self.shaftprofile = list(self._section.shaft)
        self.shaftoutline = self._section.shaft_outline()

    def currenttoolnumber(self):
        """The tool number of the last change, as given: the maker's or the generated one."""
        return self.currenttoolnum

    def currenttool(self):
        """The same as currenttoolnumber."""
        return self.currenttoolnum

    def toolchange(self, tool_number, speed=10000):
        """Change to a tool and start the spindle with `speed` rpm."""
        n = self._table.maker_number(tool_number)
        speed = number(speed, "speed")
        if speed < 0:
            raise GcodePreviewError(f"speed must not be below 0, not {speed:g}")
        self._catch_up()
        self.currenttoolnum = tool_number
        self._set_tool(n)
        self.speed = speed
        self.toolpath.note("Toolpath")
        self.toolpath.tool(n)
        self.toolpath.spindle(speed, "cw" if speed else "off")
        self._call_hook(self.on_section, n)

    def addtool(self, tool_number, shape, **sizes):
        """Add a tool of one's own, for toolchange: its shape and sizes as of kerf.Tool.make, mm and degrees.

        >>> gcp.addtool(901, "lollipop", diameter=10, neck_diameter=4, flute=14)
        """
        n = whole(tool_number, "tool_number", 1)
        self._table.add(n, kerf.Tool.make(shape, number=n, **sizes))

    def settoolparameters(self, tooltype, first, second, third, fourth, length=0):
        """Describe the tool of the following motions as a CutViewer comment does.

        'mill': diameter, corner radius, height, taper angle; 'crmill': two diameters, radius, height;
        'chamfer': diameter, point angle, height, length of the chamfer; 'drill': diameter, point angle,
        height. The tool gets the number of the current one.
        """
        a, b, c, d = (
            number(v, n)
            for v, n in ((first, "first"), (second, "second"), (third, "third"), (fourth, "fourth"))
        )
        tool = _cutviewer_tool(str(tooltype).lower(), a, b, c, d)
        n = self._tool_in_use
        self._table.add(n, tool)
        self._set_tool(n)
        if length:
            self.shaftlength = positive(length, "length")

    def defineshaft(self, toolingdiameter, shaftdiameter, flute, transition, shaft):
        """The shaft above the flute: its diameter and length, and the height of the cone between them."""
        top, height = number(toolingdiameter, "toolingdiameter"), number(flute, "flute")
        cone, length = number(transition, "transition"), number(shaft, "shaft")
        width = number(shaftdiameter, "shaftdiameter") or top
        self._section.shaft = [
            (top / 2, height),
            (width / 2, height + cone),
            (width / 2, height + cone + length),
        ]
        self.shaftdiameter, self.shaftlength = width, length
        self._describe_parts()

    def definesquaretool(self, diameter, flute, shaft, offset=0):
        r, h = positive(diameter, "diameter") / 2, positive(flute, "flute")
        self._define("square", [(0, 0, 0), (r, 0, 0), (r, h, 0)], 2 * r, h, shaft)

    def defineballnosetool(self, diameter, flute, shaft, offset=0):
        r, h = positive(diameter, "diameter") / 2, positive(flute, "flute")
        bulge = math.tan(math.pi / 8)
        self._define("ball", [(0, 0, bulge), (r, r, 0), (r, h, 0)], 2 * r, h, shaft)

    def defineVtool(self, diameter, flute, shaft, shaftdiameter=0):
        r, h = positive(diameter, "diameter") / 2, positive(flute, "flute")
        self._define("V", [(0, 0, 0), (r, h, 0)], 2 * r, h, shaft, shaftdiameter)

    def defineKeyholetool(self, diameter, flute, narrowdiameter, narrowflute, shaftdiameter, shaftlength):
        r, h = positive(diameter, "diameter") / 2, positive(flute, "flute")
        n, top = positive(narrowdiameter, "narrowdiameter") / 2, h + positive(narrowflute, "narrowflute")
        self._define(
            "keyhole",
            [(0, 0, 0), (r, 0, 0), (r, h, 0), (n, h, 0), (n, top, 0)],
            2 * n,
            top,
            shaftlength,
            shaftdiameter,
        )

    def definebowltool(self, diameter, flute, radius, shaftdiameter, shaftlength):
        r, h, c = (
            positive(v, n) for v, n in ((diameter / 2, "diameter"), (flute, "flute"), (radius, "radius"))
        )
        self._define(
            "bowl",
            [(0, 0, 0), (r - c, 0, math.tan(math.pi / 8)), (r, c, 0), (r, h, 0)],
            2 * r,
            h,
            shaftlength,
            shaftdiameter,
        )

    def defineRoundovertool(self, diameter, tipdiameter, flute, radius, shaftdiameter, shaftlength):
        """A concave quarter of `radius` from the tip's diameter outwards."""
        t, c, h = (
            positive(tipdiameter, "tipdiameter") / 2,
            positive(radius, "radius"),
            positive(flute, "flute"),
        )
        knots = [(0, 0, 0), (t, 0, -math.tan(math.pi / 8)), (t + c, c, 0), (t + c, max(h, c), 0)]
        self._define("roundover", knots, 2 * (t + c), max(h, c), shaftlength, shaftdiameter)

    def _define(self, shape, knots, top, flute, shaft, shaftdiameter=0):
        self.endmilltype, self.diameter, self.flute = shape, 2 * max(k[0] for k in knots), flute
        self._describe(
            knots,
            top,
            flute,
            0.0,
            number(shaftdiameter, "shaftdiameter") or top,
            number(shaft, "shaft"),
            str(self.currenttoolnum),
        )

    def tool_diameter(self, ptd_tool, ptd_depth):
        """The diameter of a tool at a height above its tip, mm."""
        tool = self._table[ptd_tool]
        depth = number(ptd_depth, "ptd_depth")
        if depth < 0:
            raise GcodePreviewError(f"ptd_depth is a height above the tip: 0 or more, not {depth:g}")
        return tool.diameter_at(min(depth, tool.flute))

    def tool_radius(self, ptd_tool, ptd_depth):
        """Half of tool_diameter."""
        return self.tool_diameter(ptd_tool, ptd_depth) / 2

    def showtooloutline(self):
        """Show the outline of tool and shaft; returns it."""
        return self._show_section("outline")

    def showtoolprofile(self):
        """Show the half profile of tool and shaft; returns it."""
        return self._show_section("profile")

    def showtoolshape(self):
        """Show the solid of tool and shaft; returns it."""
        return self._show_section("shape")

    def _show_section(self, what):
        name = f"{self._tool_in_use}_{what}"
        if what == "shape":
            self._write(name + ".stl", self._section.stl())
        else:
            self._write(name + ".svg", self._section.svg(what).encode())
        return self._section


def _cutviewer_tool(kind, a, b, c, d):
    """The tool of a TOOL/MILL, CRMILL, CHAMFER or DRILL comment."""
    if kind == "mill":
        if d > 0:
            top = a + 2 * c * math.tan(math.radians(d))
            return kerf.Tool.drawn(
                [(0, 0, 0), (a / 2, 0, 0), (top / 2, c, 0)] if a > 0 else [(0, 0, 0), (top / 2, c, 0)]
            )
        if b == 0:
            return kerf.Tool.make("square", diameter=a, flute=c or 2 * a)
        if abs(b) >= a / 2:
            return kerf.Tool.make("ball", diameter=a, flute=c or 2 * a)
        return kerf.Tool.make("bowl", diameter=a, corner_radius=b, flute=c or 2 * a)
    if kind == "crmill":
        return kerf.Tool.drawn(
            [(0, 0, 0), (a / 2, 0, -math.tan(math.pi / 8)), (a / 2 + c, c, 0), (a / 2 + c, max(c, d), 0)]
        )
    if kind in ("chamfer", "drill"):
        tip = a / 2 / math.tan(math.radians(b / 2))
        return kerf.Tool.drawn([(0, 0, 0), (a / 2, tip, 0), (a / 2, max(c, tip), 0)])
    raise GcodePreviewError(f"tooltype: {kind!r} is unknown; known: mill, crmill, chamfer, drill")

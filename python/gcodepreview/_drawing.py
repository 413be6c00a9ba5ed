"""Drawings: lines, arcs, polylines and rectangles that are written as DXF; rectangles and keyholes that are
cut too.
"""

import math

import kerf

from ._arguments import COLOURS, GcodePreviewError, choice, drawing_colour, number, positive, warn

_STYLES = ("Square", "Fillet", "Chamfer", "Flipped Fillet")
_JOIN = 1e-5  # mm: ends closer than this are joined
_DIRECTIONS = {"N": 90, "S": 270, "E": 0, "W": 180}


class Sketch:
    """The entities of a drawing by layer: ('line', x1, y1, x2, y2), ('arc', x, y, r, a, b), ('circle', x,
    y, r) and
    ('polyline', vertices, closed)."""

    def __init__(self):
        self.layers = {}  # name to colour index, in order of first use
        self.entities = []

    def add(self, layer, colour, *entity):
        self.layers.setdefault(layer, colour)
        self.entities.append((layer, entity))

    def writer(self, join=True, stagger=(0.0, 0.0)):
        """A kerf.DrawingWriter; with `join` chains of lines and arcs become polylines."""
        drawing = kerf.DrawingWriter()
        for layer, colour in self.layers.items():
            drawing.layer(layer, colour=colour)
            parts = [e for name, e in self.entities if name == layer]
            dx, dy = stagger[0] * colour, stagger[1] * colour
            for kind, *values in (joined(parts) if join else parts):
                if kind == "polyline":
                    vertices, closed = values
                    drawing.polyline(layer, [(x + dx, y + dy, b) for x, y, b in vertices], closed)
                elif kind == "line":
                    x1, y1, x2, y2 = values
                    drawing.line(layer, x1 + dx, y1 + dy, x2 + dx, y2 + dy)
                else:
                    getattr(drawing, kind)(layer, values[0] + dx, values[1] + dy, *values[2:])
        return drawing


def _ends(entity):
    """Start, end and bulge of a line or an arc."""
    if entity[0] == "line":
        return (entity[1], entity[2]), (entity[3], entity[4]), 0.0
    _, x, y, r, a, b = entity
    a, b = math.radians(a), math.radians(b)
    sweep = (b - a) % (2 * math.pi)
    return (
        (x + r * math.cos(a), y + r * math.sin(a)),
        (x + r * math.cos(b), y + r * math.sin(b)),
        math.tan(sweep / 4),
    )


def _cell(p):
    return round(p[0] / _JOIN), round(p[1] / _JOIN)


class _Ends:
    """The open ends of segments by position."""

    def __init__(self, segments):
        self.at = {}
        for i, (a, b, _) in enumerate(segments):
            for p in (a, b):
                self.at.setdefault(_cell(p), []).append(i)

    def partner(self, p, used):
        """The segment that is not `used` with an end at `p`, if just two segments meet there."""
        x, y = _cell(p)
        near = {i for u in (x - 1, x, x + 1) for v in (y - 1, y, y + 1) for i in self.at.get((u, v), ())}
        free = [i for i in near if i not in used]
        return free[0] if len(near) == 2 and len(free) == 1 else None


def joined(entities):
    """The entities with lines and arcs joined end to end, where just two of them meet."""
    whole_turn = [e for e in entities if e[0] == "arc" and (e[5] - e[4]) % 360 == 0]
    result = [("circle", *e[1:4]) for e in whole_turn]
    loose = [e for e in entities if e[0] in ("line", "arc") and e not in whole_turn]
    result = [e for e in entities if e[0] in ("polyline", "circle")] + result
    segments = [_ends(e) for e in loose]
    ends, used = _Ends(segments), set()
    for i in range(len(segments)):
        if i in used:
            continue
        used.add(i)
        chain = [segments[i]]
        closed = False
        for forwards in (True, False):
            while not closed:
                p = chain[-1][1] if forwards else chain[0][0]
                k = ends.partner(p, used)
                if k is None:
                    break
                used.add(k)
                a, b, bulge = segments[k]
                if math.dist(a if forwards else b, p) > 2 * _JOIN:
                    a, b, bulge = b, a, -bulge
                chain = [*chain, (a, b, bulge)] if forwards else [(a, b, bulge), *chain]
                closed = math.dist(chain[0][0], chain[-1][1]) <= 2 * _JOIN
        result.append(_entity(chain, closed, loose[i]))
    return result


def _entity(chain, closed, single):
    if len(chain) == 1:
        return single
    vertices = [(a[0], a[1], bulge) for a, _, bulge in chain]
    if not closed:
        vertices.append((*chain[-1][1], 0.0))
    return ("polyline", vertices, closed)


class Drawing:
    """The part of `gcodepreview` that draws."""

    def _start_drawing(self):
        self.dxfcolor = "Black"
        self.dxfversion = "r2000"  # or "r12"
        self.dxflayers = "colour"  # or "tool", or "depth"
        self.dxfjoin = True
        self.dxfstagger = False
        self.dxfclosed = True
        self._layer = None
        self._sketch = Sketch()
        self._tool_sketches = {}
        self._polyline = None

    # ---- state

    def setdxfcolor(self, color):
        """Set the colour of the following entities, a drawing or web colour, in any case."""
        self.dxfcolor = drawing_colour(color)
        self.cutcolor = self.dxfcolor

    def setdxflayer(self, layer=None):
        """Set the layer of the following entities by name; None: a layer for each colour."""
        if layer is not None and (not isinstance(layer, str) or not layer):
            raise TypeError(f"layer must be a name, not {layer!r}")
        try:
            kerf.DrawingWriter().layer(layer or "0")
        except ValueError as error:
            raise GcodePreviewError(str(error)) from None
        self._layer = layer

    def writedxfcolor(self, tn):
        """Part of the original's text output; entities get their colour when they are drawn."""

    def writedxf(self, toolnumber, *strings):
        raise GcodePreviewError("writedxf: text cannot be added to a drawing; use the dxf... calls")

    writedxfs = writedxf

    def _draw(self, tool, *entity):
        if not self.generatedxf:
            return
        colour = COLOURS[self.dxfcolor]
        name = "Layer_" + self.dxfcolor.replace(" ", "_")
        if self._layer is not None:
            name = self._layer
        elif self.dxflayers == "tool":
            name = f"Tool {tool}"
        elif self.dxflayers == "depth":
            name = f"Tool {tool} to {self.zpos():.3f}".replace(".", "_")
        self._sketch.add(name, colour, *entity)
        if tool in self._tool_sketches:
            self._tool_sketches[tool].add(name, colour, *entity)

    # ---- entities

    def dxfline(self, tn, xbegin, ybegin, xend, yend):
        values = [
            number(v, n) for v, n in ((xbegin, "xbegin"), (ybegin, "ybegin"), (xend, "xend"), (yend, "yend"))
        ]
        if math.dist(values[:2], values[2:]) > _JOIN:
            self._draw(tn, "line", *values)

    def dxfarc(self, tn, xcenter, ycenter, radius, anglebegin, endangle):
        """An arc counter-clockwise between two angles, degrees."""
        self._draw(
            tn,
            "arc",
            number(xcenter, "xcenter"),
            number(ycenter, "ycenter"),
            positive(radius, "radius"),
            number(anglebegin, "anglebegin"),
            number(endangle, "endangle"),
        )

    def gcodearc(self, tn, xcenter, ycenter, radius, anglebegin, endangle):
        """Cut an arc counter-clockwise at the current depth."""
        return self.cutarcCC(anglebegin, endangle, xcenter, ycenter, radius, 0)

    def dxfcircle(self, tool_num, xcenter, ycenter, radius):
        self._draw(
            tool_num,
            "circle",
            number(xcenter, "xcenter"),
            number(ycenter, "ycenter"),
            positive(radius, "radius"),
        )

    def beginpolyline(self, tn):
        self._polyline = []

    def addvertex(self, tn, xend, yend):
        if self._polyline is None:
            raise GcodePreviewError("addvertex: beginpolyline must be called first")
        vertex = (number(xend, "xend"), number(yend, "yend"), 0.0)
        if not self._polyline or math.dist(vertex[:2], self._polyline[-1][:2]) > _JOIN:
            self._polyline.append(vertex)

    def closepolyline(self, tn):
        """End the polyline; it is closed if its last vertex is the first."""
        if self._polyline is None:
            raise GcodePreviewError("closepolyline: beginpolyline must be called first")
        vertices, self._polyline = self._polyline, None
        if len(vertices) < 2:
            return
        closed = len(vertices) > 2 and math.dist(vertices[0][:2], vertices[-1][:2]) <= _JOIN
        self._draw(tn, "polyline", vertices[:-1] if closed else vertices, closed)

    beginopenpolyline, addopline, finishopenpolyline = beginpolyline, addvertex, closepolyline

    # ---- rectangles

    def dxfrectangle(self, tool_num, xorigin, yorigin, xwidth, yheight, corners="Square", radius=6):
        """A rectangle by its lower left corner; corners: Square, Fillet, Chamfer, Flipped Fillet."""
        style = choice(corners, _STYLES, "corners")
        x, y = number(xorigin, "xorigin"), number(yorigin, "yorigin")
        w, h = positive(xwidth, "xwidth"), positive(yheight, "yheight")
        r = 0.0 if style == "Square" else positive(radius, "radius")
        if 2 * r > min(w, h) + _JOIN:
            raise GcodePreviewError(f"radius: {r:g} mm does not fit into {w:g} x {h:g} mm")
        self._draw(tool_num, "polyline", rectangle(x, y, w, h, style, r), True)

    def dxfrectangleround(self, tool_num, xorigin, yorigin, xwidth, yheight, radius):
        self.dxfrectangle(tool_num, xorigin, yorigin, xwidth, yheight, "Fillet", radius)

    def dxfrectanglechamfer(self, tool_num, xorigin, yorigin, xwidth, yheight, radius):
        self.dxfrectangle(tool_num, xorigin, yorigin, xwidth, yheight, "Chamfer", radius)

    def dxfrectangleflippedfillet(self, tool_num, xorigin, yorigin, xwidth, yheight, radius):
        self.dxfrectangle(tool_num, xorigin, yorigin, xwidth, yheight, "Flipped Fillet", radius)

    dxfrectanglelwp = dxfrectangle

    def _bottom(self, bz, zdepth):
        depth = number(zdepth, "zdepth")
        if depth < 0:
            warn(f"zdepth counts downwards: {depth:g} is taken as {-depth:g}")
        return number(bz, "bz") - abs(depth)

    def cutrectangle(self, tool_num, bx, by, bz, xwidth, yheight, zdepth):
        """Cut along a rectangle, `zdepth` mm (above 0) below `bz`."""
        x, y, z = number(bx, "bx"), number(by, "by"), self._bottom(bz, zdepth)
        w, h = positive(xwidth, "xwidth"), positive(yheight, "yheight")
        moves = self.cutline(x, y, bz)
        for corner in ((x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)):
            moves = moves.union(self.cutline(*corner, z))
        return moves

    def cutrectangledxf(self, tool_num, bx, by, bz, xwidth, yheight, zdepth):
        moves = self.cutrectangle(tool_num, bx, by, bz, xwidth, yheight, zdepth)
        self.dxfrectangle(tool_num, bx, by, xwidth, yheight)
        return moves

    def cutrectangleround(self, tool_num, bx, by, bz, xwidth, yheight, zdepth, radius):
        """Cut along a rectangle with round corners, `zdepth` mm (above 0) below `bz`."""
        x, y, z = number(bx, "bx"), number(by, "by"), self._bottom(bz, zdepth)
        w, h, r = positive(xwidth, "xwidth"), positive(yheight, "yheight"), positive(radius, "radius")
        if 2 * r > min(w, h) + _JOIN:
            raise GcodePreviewError(f"radius: {r:g} mm does not fit into {w:g} x {h:g} mm")
        return self.cutline(x + r, y, z).union(
            self.cutline(x + w - r, y, z),
            self.cutquarterCCSE(x + w, y + r, z, r),
            self.cutline(x + w, y + h - r, z),
            self.cutquarterCCNE(x + w - r, y + h, z, r),
            self.cutline(x + r, y + h, z),
            self.cutquarterCCNW(x, y + h - r, z, r),
            self.cutline(x, y + r, z),
            self.cutquarterCCSW(x + r, y, z, r),
        )

    def cutrectanglerounddxf(self, tool_num, bx, by, bz, xwidth, yheight, zdepth, radius):
        moves = self.cutrectangleround(tool_num, bx, by, bz, xwidth, yheight, zdepth, radius)
        self.dxfrectangleround(tool_num, bx, by, xwidth, yheight, radius)
        return moves

    # ---- keyholes

    def cutkeyholegcdxf(self, kh_tool_num, kh_start_depth, kh_max_depth, kht_direction, kh_distance):
        """A keyhole slot towards 'N', 'S', 'E' or 'W'; see cutKHgcdxf."""
        name = kht_direction.strip().upper() if isinstance(kht_direction, str) else kht_direction
        if name not in _DIRECTIONS:
            raise GcodePreviewError(f"kht_direction must be 'N', 'S', 'E' or 'W', not {kht_direction!r}")
        return self.cutKHgcdxf(kh_tool_num, kh_start_depth, kh_max_depth, _DIRECTIONS[name], kh_distance)

    def cutKHgcdxf(self, kh_tool_num, kh_start_depth, kh_max_depth, kh_angle, kh_distance):
        """Plunge at the current point, traverse at an angle, and return to the entry and its height.

        The depths count downwards from Z0; the slot starts at `kh_start_depth` and is cut at `kh_max_depth`.
        """
        bottom, start = self._bottom(0, kh_max_depth), self._bottom(0, kh_start_depth)
        angle, length = math.radians(number(kh_angle, "kh_angle")), positive(kh_distance, "kh_distance")
        x, y, z = self._position()
        self._expects("keyhole", "cutKHgcdxf")
        self.dxfKH(kh_tool_num, x, y, kh_start_depth, kh_max_depth, kh_angle, kh_distance)
        moves = self.rapidZ(start) if z > start else type(self.rapids)()
        return moves.union(
            self.cutline(x, y, bottom),
            self.cutline(x + length * math.cos(angle), y + length * math.sin(angle), bottom),
            self.cutline(x, y, bottom),
            self.cutline(x, y, z),
        )

    def dxfKH(self, kh_tool_num, oXpos, oYpos, kh_start_depth, kh_max_depth, kh_angle, kh_distance):
        """Draw a keyhole: the entry hole with the slot of the neck, and the neck's circle at the entry."""
        x, y = number(oXpos, "oXpos"), number(oYpos, "oYpos")
        length, angle = positive(kh_distance, "kh_distance"), number(kh_angle, "kh_angle")
        tool = self._table[kh_tool_num]
        if tool.shape != "keyhole":
            raise GcodePreviewError(f"kh_tool_num: tool {kh_tool_num} is not a keyhole cutter")
        head, neck = tool.diameter_at(0.0) / 2, tool.profile[-1][0]
        self._draw(kh_tool_num, "circle", x, y, neck)
        self._draw(kh_tool_num, "polyline", keyhole(x, y, head, neck, angle, length), True)


def rectangle(x, y, w, h, style="Square", r=0.0):
    """The vertices (x, y, bulge) of a rectangle, counter-clockwise."""
    if style == "Square":
        return [(x, y, 0.0), (x + w, y, 0.0), (x + w, y + h, 0.0), (x, y + h, 0.0)]
    bulge = {"Fillet": 1, "Chamfer": 0, "Flipped Fillet": -1}[style] * math.tan(math.pi / 8)
    return [
        (x + r, y, 0.0),
        (x + w - r, y, bulge),
        (x + w, y + r, 0.0),
        (x + w, y + h - r, bulge),
        (x + w - r, y + h, 0.0),
        (x + r, y + h, bulge),
        (x, y + h - r, 0.0),
        (x, y + r, bulge),
    ]


def keyhole(x, y, head, neck, angle, length):
    """The vertices of an entry hole of radius `head` with a slot of radius `neck` towards `angle`, degrees.
    """
    a = math.radians(angle)
    along, across = (math.cos(a), math.sin(a)), (-math.sin(a), math.cos(a))

    def point(u, v):
        return x + u * along[0] + v * across[0], y + u * along[1] + v * across[1]

    out = math.sqrt(head**2 - neck**2)  # of the slot's start from the centre
    if length <= out:
        raise GcodePreviewError(f"kh_distance: a slot of {length:g} mm does not leave the entry hole")
    half = math.asin(neck / head)
    return [
        (*point(out, -neck), 0.0),
        (*point(length, -neck), 1.0),
        (*point(length, neck), 0.0),
        (*point(out, neck), math.tan((2 * math.pi - 2 * half) / 4)),
    ]

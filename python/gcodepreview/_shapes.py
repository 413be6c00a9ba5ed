"""Two-dimensional shapes as closed outlines: points and arcs as `kerf.Region` takes them.

An outline is a list: the first element is a point (x, y), each further one a straight segment to (x, y) or
an arc (via x, via y, x, y). `round_corners` makes the rounded form of any of them.
"""

import math

import kerf

from ._arguments import GcodePreviewError, choice, number, positive, whole
from ._further import bezier, bezier_surface, text

__all__ = ["SHAPES", "Shapes", "bezier", "bezier_surface", "bulge_of", "bulged", "round_corners", "text"]


def _p(x, y, r, degrees):
    a = math.radians(degrees)
    return x + r * math.cos(a), y + r * math.sin(a)


def _arc(x, y, r, begin, end):
    """The element of an arc about (x, y) between two angles."""
    return (*_p(x, y, r, (begin + end) / 2), *_p(x, y, r, end))


def _check(**values):
    return [positive(v, n) for n, v in values.items()]


def circle(x, y, radius):
    (r,) = _check(radius=radius)
    return [_p(x, y, r, 0), _arc(x, y, r, 0, 180), _arc(x, y, r, 180, 360)]


def _curve(point, begin, end, count=180):
    """A closed outline of arcs through points of a curve between two values of its parameter."""
    step = (end - begin) / (2 * count)
    return [
        point(begin),
        *((*point(begin + (2 * i + 1) * step), *point(begin + (2 * i + 2) * step)) for i in range(count)),
    ]


def ellipse(x, y, width, height):
    a, b = (v / 2 for v in _check(width=width, height=height))
    return _curve(lambda t: (x + a * math.cos(t), y + b * math.sin(t)), 0, 2 * math.pi)


def egg(x, y, width, height, point=0.2):
    """An oval that is narrower at its top; `point` 0 is an ellipse."""
    a, b = (v / 2 for v in _check(width=width, height=height))
    return _curve(
        lambda t: (x + a * math.cos(t) * (1 - point * math.sin(t)), y + b * math.sin(t)), 0, 2 * math.pi
    )


def superellipse(x, y, width, height, exponent=2.5):
    a, b, n = _check(width=width, height=height, exponent=exponent)

    def at(t):
        c, s = math.cos(t), math.sin(t)
        return (
            x + math.copysign(abs(c) ** (2 / n), c) * a / 2,
            y + math.copysign(abs(s) ** (2 / n), s) * b / 2,
        )

    return _curve(at, 0, 2 * math.pi)


def annulus(x, y, outer, inner):
    """Two outlines: the ring between two radii."""
    if inner >= outer:
        raise GcodePreviewError(f"inner must be below outer, not {inner:g}")
    return [circle(x, y, outer), circle(x, y, inner)]


def cone(x, y, width, height):
    """A triangle with a half circle at its wide end; its tip is at (x, y)."""
    w, h = _check(width=width, height=height)
    return [(x, y), (x + w / 2, y + h), (x, y + h + w / 2, x - w / 2, y + h), (x, y)]


def segment(x, y, radius, angle=180):
    """The part of a circle cut off by a chord under an angle at the centre; 180 is a half circle."""
    (r,) = _check(radius=radius)
    half = angle / 2
    return [_p(x, y, r, 90 - half), _arc(x, y, r, 90 - half, 90 + half), _p(x, y, r, 90 - half)]


def arch(x, y, width, height):
    """A rectangle with a half circle on top; (x, y) is its lower left corner."""
    w, h = _check(width=width, height=height)
    return [(x, y), (x + w, y), (x + w, y + h), (x + w / 2, y + h + w / 2, x, y + h), (x, y)]


def lens(x, y, radius, distance):
    """What two circles have in common; with a distance of the radius a vesica piscis."""
    r, d = _check(radius=radius, distance=distance)
    if d >= 2 * r:
        raise GcodePreviewError(f"distance must be below the diameter, not {d:g}")
    h = math.sqrt(r * r - d * d / 4)
    return [(x, y - h), (x + r - d / 2, y, x, y + h), (x - r + d / 2, y, x, y - h)]


def lune(x, y, radius, distance):
    """A crescent: a circle without another of the same radius at a distance to its right."""
    r, d = _check(radius=radius, distance=distance)
    if d >= 2 * r:
        raise GcodePreviewError(f"distance must be below the diameter, not {d:g}")
    h = math.sqrt(r * r - d * d / 4)
    return [(x + d / 2, y + h), (x - r, y, x + d / 2, y - h), (x + d - r, y, x + d / 2, y + h)]


def heart(x, y, width):
    """Two half circles over a tip at (x, y)."""
    (w,) = _check(width=width)
    return [
        (x, y),
        (x + w / 2, y + w * 0.7),
        (x + w / 4, y + w * 0.95, x, y + w * 0.7),
        (x - w / 4, y + w * 0.95, x - w / 2, y + w * 0.7),
        (x, y),
    ]


def tomoe(x, y, radius):
    """A comma of three half circles."""
    (r,) = _check(radius=radius)
    return [(x, y - r), (x + r, y, x, y + r), (x - r / 2, y + r / 2, x, y), (x + r / 2, y - r / 2, x, y - r)]


def polygon(points):
    points = [(number(a, "x"), number(b, "y")) for a, b in points]
    if len(points) < 3:
        raise GcodePreviewError("points: at least three are required")
    return [*points, points[0]]


def triangle(x, y, a, b, c):
    """A triangle by the lengths of its sides; `a` lies on the X axis from (x, y)."""
    a, b, c = _check(a=a, b=b, c=c)
    u = (a * a + c * c - b * b) / (2 * a)
    if c * c <= u * u:
        raise GcodePreviewError(f"a, b, c: {a:g}, {b:g} and {c:g} are not the sides of a triangle")
    return polygon([(x, y), (x + a, y), (x + u, y + math.sqrt(c * c - u * u))])


def sector(x, y, radius, angle=90, start=0):
    """A slice of a circle: quadrant 90, sextant 60, octant 45 degrees."""
    (r,) = _check(radius=radius)
    return [(x, y), _p(x, y, r, start), _arc(x, y, r, start, start + angle), (x, y)]


def deltoid(x, y, radius):
    """The curve with three cusps of a circle rolling in one of three times its radius."""
    (r,) = _check(radius=radius)
    b = r / 3
    return _curve(
        lambda t: (x + b * (2 * math.cos(t) + math.cos(2 * t)), y + b * (2 * math.sin(t) - math.sin(2 * t))),
        0,
        2 * math.pi,
    )


def astroid(x, y, radius):
    (r,) = _check(radius=radius)
    return _curve(lambda t: (x + r * math.cos(t) ** 3, y + r * math.sin(t) ** 3), 0, 2 * math.pi)


def reuleaux(x, y, width):
    """The curve of constant width on a triangle with its lower left corner at (x, y)."""
    (w,) = _check(width=width)
    a, b, c = (x, y), (x + w, y), (x + w / 2, y + w * math.sqrt(3) / 2)
    return [a, (*_p(*c, w, 270), *b), (*_p(*a, w, 30), *c), (*_p(*b, w, 150), *a)]


def arbelos(x, y, radius, at=0.5):
    """A half circle without two smaller ones on its diameter; `at`: the fraction at which they meet."""
    (r,) = _check(radius=radius)
    m = x - r + 2 * r * at
    u, v = r * at, r * (1 - at)
    return [(x + r, y), (x, y + r, x - r, y), (x - r + u, y + u, m, y), (m + v, y + v, x + r, y)]


def dart(x, y, width, height, depth):
    """Two straight sides and one concave arc; the tip is at (x, y + height)."""
    w, h, d = _check(width=width, height=height, depth=depth)
    return [(x - w / 2, y), (x, y + d, x + w / 2, y), (x, y + h), (x - w / 2, y)]


def arrowhead(x, y, width, height, depth):
    """Two convex sides and one concave arc; the tip is at (x, y + height)."""
    w, h, d = _check(width=width, height=height, depth=depth)
    side = 0.3
    return [
        (x - w / 2, y),
        (x, y + d, x + w / 2, y),
        (x + w * side, y + h * (1 - side), x, y + h),
        (x - w * side, y + h * (1 - side), x - w / 2, y),
    ]


def parallelogram(x, y, width, height, shift):
    w, h = _check(width=width, height=height)
    return polygon([(x, y), (x + w, y), (x + w + shift, y + h), (x + shift, y + h)])


def rhombus(x, y, width, height):
    w, h = _check(width=width, height=height)
    return polygon([(x, y - h / 2), (x + w / 2, y), (x, y + h / 2), (x - w / 2, y)])


def trapezoid(x, y, bottom, top, height):
    b, t, h = _check(bottom=bottom, top=top, height=height)
    return polygon([(x, y), (x + b, y), (x + (b + t) / 2, y + h), (x + (b - t) / 2, y + h)])


def kite(x, y, width, upper, lower):
    w, u, v = _check(width=width, upper=upper, lower=lower)
    return polygon([(x, y - v), (x + w / 2, y), (x, y + u), (x - w / 2, y)])


def annulus_segment(x, y, outer, inner, start, end):
    """The part of a ring between two angles, degrees."""
    r, q = _check(outer=outer, inner=inner)
    if q >= r:
        raise GcodePreviewError(f"inner must be below outer, not {q:g}")
    return [
        _p(x, y, r, start),
        _arc(x, y, r, start, end),
        _p(x, y, q, end),
        _arc(x, y, q, end, start),
        _p(x, y, r, start),
    ]


def salinon(x, y, radius, inner):
    """Four half circles on one line: the large one, two small ones cut out, and one below."""
    r, q = _check(radius=radius, inner=inner)
    if q >= r:
        raise GcodePreviewError(f"inner must be below radius, not {q:g}")
    s = (r - q) / 2
    return [
        (x + r, y),
        (x, y + r, x - r, y),
        (x - q - s, y + s, x - q, y),
        (x, y - q, x + q, y),
        (x + q + s, y + s, x + r, y),
    ]


def concave_square(x, y, width, height, depth):
    """Three straight sides and one concave arc on top."""
    w, h, d = _check(width=width, height=height, depth=depth)
    return [(x, y), (x + w, y), (x + w, y + h), (x + w / 2, y + h - d, x, y + h), (x, y)]


def rectangle(x, y, width, height):
    w, h = _check(width=width, height=height)
    return polygon([(x, y), (x + w, y), (x + w, y + h), (x, y + h)])


SHAPES = {
    f.__name__: f
    for f in (
        circle,
        ellipse,
        egg,
        superellipse,
        cone,
        segment,
        arch,
        lens,
        lune,
        heart,
        tomoe,
        triangle,
        sector,
        deltoid,
        astroid,
        reuleaux,
        arbelos,
        dart,
        arrowhead,
        rectangle,
        parallelogram,
        rhombus,
        trapezoid,
        kite,
        annulus_segment,
        salinon,
        concave_square,
    )
}


def round_corners(outline, radius):
    """The rounded form: convex corners by arcs of `radius`, concave ones too.

    Returns the outlines of a `kerf.Region`: the shape offset inwards, outwards twice as far, and inwards
    again.
    """
    (r,) = _check(radius=radius)
    region = kerf.Region([outline])
    return region.offset(-r).offset(2 * r).offset(-r).outlines


class Shapes:
    """The part of `gcodepreview` for outlines: draw them, cut along or beside them, and pocket them."""

    def dxfoutline(self, tool_num, outline):
        """Draw an outline as a closed polyline."""
        self._draw(tool_num, "polyline", bulged(outline), True)

    def cutoutline(self, outline, bz, zdepth, offset="none", corners=None):
        """Cut along an outline, `zdepth` mm below `bz`; offset: 'none', 'outside' or 'inside' by the tool's
        radius. With corners 'dog-bone' or 't-bone' the tool clears the inner corners of a cut inside.
        """
        if offset not in ("none", "outside", "inside"):
            raise GcodePreviewError(f"offset must be 'none', 'outside' or 'inside', not {offset!r}")
        z = self._bottom(bz, zdepth)
        r = {"none": 0.0, "outside": self.diameter / 2, "inside": -self.diameter / 2}[offset]
        if corners is not None and offset != "inside":
            raise GcodePreviewError(f"corners: {corners!r} requires the offset 'inside', not {offset!r}")
        outlines = self._relieved(kerf.Region([outline]), corners).offset(r).outlines if r else [outline]
        if not outlines:
            raise GcodePreviewError(f"offset: the tool of {self.diameter:g} mm does not fit into the outline")
        return self._cut_outlines(outlines, bz, z)

    def cutpocket(self, outline, bz, zdepth, stepover=0.4, corners=None):
        """Clear the inside of an outline, `zdepth` mm below `bz`; the stepover is a fraction of the tool's
        diameter. With corners 'dog-bone' or 't-bone' a square part fits into it.
        """
        return self._pocket(self._relieved(kerf.Region([outline]), corners), bz, zdepth, stepover)

    def cutfingers(
        self,
        width,
        depth,
        count,
        bz,
        zdepth,
        first=True,
        fit=0.0,
        corners="dog-bone",
        bx=0,
        by=0,
        edge="lower",
        stepover=0.4,
    ):
        """Cut the slots of a finger joint along an edge of a board, whose left end is (bx, by).

        `count` fingers and slots together (odd); the boards of a joint are cut with `first` True (fingers
        at both ends) and False. `depth` is the thickness of the other board, `fit` the clearance between a
        finger and each side of its slot, mm; `edge` is 'lower' or 'upper'.
        """
        try:
            slots = kerf.finger_slots(
                positive(width, "width"),
                positive(depth, "depth"),
                whole(count, "count", 3),
                first=bool(first),
                fit=number(fit, "fit"),
                overhang=self.diameter,
            )
        except ValueError as error:
            raise GcodePreviewError(str(error)) from None
        x, y = number(bx, "bx"), number(by, "by")
        board = kerf.Region([rectangle(0, 0, width, 2 * depth)])
        if choice(edge, ("lower", "upper"), "edge") == "upper":
            slots, board = (region.rotated(180, (width / 2, 0)) for region in (slots, board))
        region = self._relieved(slots, corners, board).moved(x, y)
        return self._pocket(region, bz, zdepth, stepover)

    def _relieved(self, region, corners, limits=None):
        """The region with relieved corners for the tool in use."""
        if corners is None:
            return region
        try:
            return kerf.relieve_corners(region, self.diameter, corners, limits=limits)
        except ValueError as error:
            raise GcodePreviewError(f"corners: {error}") from None

    def _pocket(self, region, bz, zdepth, stepover):
        z, step = self._bottom(bz, zdepth), positive(stepover, "stepover") * self.diameter
        if stepover > 1:
            raise GcodePreviewError(f"stepover is at most 1, not {stepover:g}")
        region, rings = region.offset(-self.diameter / 2), []
        while region.outlines:
            rings.append(region.outlines)
            region = region.offset(-step)
        if not rings:
            raise GcodePreviewError(f"outline: the tool of {self.diameter:g} mm does not fit into it")
        moves = type(self.rapids)()
        for outlines in reversed(rings):
            moves = moves.union(self._cut_outlines(outlines, bz, z))
        return moves

    def _cut_outlines(self, outlines, bz, z):
        moves = type(self.rapids)()
        for outline in outlines:
            rows = bulged(outline)
            moves = moves.union(
                self.rapidZ(self.retractheight), self.rapidXY(*rows[0][:2]), self.cutline(*rows[0][:2], z)
            )
            for (x, y, bulge), (u, v, _) in zip(rows, rows[1:] + rows[:1]):
                moves.extend(self._cut_bulge(x, y, u, v, bulge, z))
        return moves.union(self.rapidZ(self.retractheight))

    def _cut_bulge(self, x, y, u, v, bulge, z):
        if abs(bulge) < 1e-9:
            return self.cutline(u, v, z)
        midpoint = (x + u) / 2, (y + v) / 2
        k = (1 - bulge * bulge) / (4 * bulge)
        centre = midpoint[0] - k * (v - y), midpoint[1] + k * (u - x)
        return self._arc_to((u, v, z), centre, "ccw" if bulge > 0 else "cw")


def bulged(outline):
    """The vertices (x, y, bulge) of a closed outline, or of a circle (x, y, radius)."""
    if len(outline) == 3 and not isinstance(outline[0], (tuple, list)):
        outline = circle(*outline)
    rows, here = [], outline[0]
    for element in outline[1:]:
        end = element[-2:]
        if len(element) == 4:
            rows.append((*here, _bulge(here, element[:2], end)))
        elif math.dist(here, end) > 1e-9:
            rows.append((*here, 0.0))
        here = end
    return rows


def bulge_of(here, element):
    """The bulge of an element of an outline after the point `here`."""
    return _bulge(here, element[:2], element[2:]) if len(element) == 4 else 0.0


def _bulge(begin, via, end):
    """Tangent of a quarter of the sweep of the arc from a point through `via` to `end`; above 0: to the
    left.
    """
    ax, ay, bx, by = begin[0] - via[0], begin[1] - via[1], end[0] - via[0], end[1] - via[1]
    cross = ay * bx - ax * by
    seen = math.atan2(abs(cross), ax * bx + ay * by)  # the angle under which `via` sees the chord
    return math.copysign(math.tan((math.pi - seen) / 2), cross)

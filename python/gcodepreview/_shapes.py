"""Two-dimensional shapes as closed outlines: points and arcs as `kerf.Region` takes them.

An outline is a list: the first element is a point (x, y), each further one a straight segment to (x, y) or
an arc (via x, via y, x, y). `round_corners` makes the rounded form of any of them.
"""

import math

import kerf

from ._arguments import GcodePreviewError, choice, number, pairs, positive, whole
from ._further import bezier, bezier_surface, text

__all__ = ["SHAPES", "Shapes", "bezier", "bezier_surface", "bulge_of", "bulged", "round_corners", "text"]


def _made(name, *values):
    """The outline of a shape of `kerf.plane_shapes`."""
    try:
        return kerf.plane_shape(name, *values)
    except ValueError as error:
        raise GcodePreviewError(str(error)) from None


def circle(x, y, radius):
    """A circle about (x, y)."""
    return _made("circle", x, y, radius)


def ellipse(x, y, width, height):
    """An ellipse about (x, y)."""
    return _made("ellipse", x, y, width, height)


def egg(x, y, width, height, point=0.2):
    """An oval that is narrower at its top; `point` 0 is an ellipse."""
    return _made("egg", x, y, width, height, point)


def superellipse(x, y, width, height, exponent=2.5):
    """An oval between an ellipse (exponent 2) and a rectangle."""
    return _made("superellipse", x, y, width, height, exponent)


def cone(x, y, width, height):
    """A triangle with a half circle at its wide end; its tip is at (x, y)."""
    return _made("cone", x, y, width, height)


def segment(x, y, radius, angle=180):
    """The part of a circle cut off by a chord under an angle at the centre; 180 is a half circle."""
    return _made("segment", x, y, radius, angle)


def arch(x, y, width, height):
    """A rectangle with a half circle on top; (x, y) is its lower left corner."""
    return _made("arch", x, y, width, height)


def lens(x, y, radius, distance):
    """What two circles have in common; with a distance of the radius a vesica piscis."""
    return _made("lens", x, y, radius, distance)


def lune(x, y, radius, distance):
    """A crescent: a circle without another of the same radius at a distance to its right."""
    return _made("lune", x, y, radius, distance)


def heart(x, y, width):
    """Two half circles over a tip at (x, y)."""
    return _made("heart", x, y, width)


def tomoe(x, y, radius):
    """A comma of three half circles."""
    return _made("tomoe", x, y, radius)


def triangle(x, y, a, b, c):
    """A triangle by the lengths of its sides; `a` lies on the X axis from (x, y)."""
    return _made("triangle", x, y, a, b, c)


def sector(x, y, radius, angle=90, start=0):
    """A slice of a circle: quadrant 90, sextant 60, octant 45 degrees."""
    return _made("sector", x, y, radius, angle, start)


def deltoid(x, y, radius):
    """The curve with three cusps of a circle rolling in one of three times its radius."""
    return _made("deltoid", x, y, radius)


def astroid(x, y, radius):
    """The curve with four cusps of a circle rolling in one of four times its radius."""
    return _made("astroid", x, y, radius)


def reuleaux(x, y, width):
    """The curve of constant width on a triangle with its lower left corner at (x, y)."""
    return _made("reuleaux", x, y, width)


def arbelos(x, y, radius, at=0.5):
    """A half circle without two smaller ones on its diameter; `at`: the fraction at which they meet."""
    return _made("arbelos", x, y, radius, at)


def dart(x, y, width, height, depth):
    """Two straight sides and one concave arc; the tip is at (x, y + height)."""
    return _made("dart", x, y, width, height, depth)


def arrowhead(x, y, width, height, depth):
    """Two convex sides and one concave arc; the tip is at (x, y + height)."""
    return _made("arrowhead", x, y, width, height, depth)


def rectangle(x, y, width, height):
    """A rectangle; (x, y) is its lower left corner."""
    return _made("rectangle", x, y, width, height)


def parallelogram(x, y, width, height, shift):
    """A parallelogram with its top shifted to the right; (x, y) is its lower left corner."""
    return _made("parallelogram", x, y, width, height, shift)


def rhombus(x, y, width, height):
    """A rhombus about (x, y)."""
    return _made("rhombus", x, y, width, height)


def trapezoid(x, y, bottom, top, height):
    """A trapezoid with two equal sides; (x, y) is its lower left corner."""
    return _made("trapezoid", x, y, bottom, top, height)


def kite(x, y, width, upper, lower):
    """A kite; (x, y) is where its diagonals cross."""
    return _made("kite", x, y, width, upper, lower)


def annulus_segment(x, y, outer, inner, start, end):
    """The part of a ring between two angles, degrees."""
    return _made("annulus_segment", x, y, outer, inner, start, end)


def salinon(x, y, radius, inner):
    """Four half circles on one line: the large one, two small ones cut out, and one below."""
    return _made("salinon", x, y, radius, inner)


def concave_square(x, y, width, height, depth):
    """Three straight sides and one concave arc on top."""
    return _made("concave_square", x, y, width, height, depth)


def annulus(x, y, outer, inner):
    """Two outlines: the ring between two radii."""
    rings = [circle(x, y, outer), circle(x, y, inner)]
    if inner >= outer:
        raise GcodePreviewError(f"inner must be below outer, not {inner:g}")
    return rings


def polygon(points):
    """The outline through three points or more."""
    points = [(number(a, "x"), number(b, "y")) for a, b in pairs(points, "points")]
    if len(points) < 3:
        raise GcodePreviewError("points: at least three are required")
    return [*points, points[0]]


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
    r = positive(radius, "radius")
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
    if not isinstance(outline, (list, tuple)) or not outline:
        raise TypeError(f"outline must be a list of points and arcs, not {outline!r}")
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

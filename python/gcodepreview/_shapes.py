"""Two-dimensional shapes as closed outlines: points and arcs as `kerf.Region` takes them.

An outline is a list: the first element is a point (x, y), each further one a straight segment to (x, y) or
an arc (via x, via y, x, y). `round_corners` makes the rounded form of any of them.
"""

import kerf
from kerf import _kerf
from kerf._kerf import GcodePreviewError

__all__ = ["SHAPES", "bezier", "bezier_surface", "round_corners", "text"]


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
    return _kerf._design_value("annulus", x, y, outer, inner)


def polygon(points):
    """The outline through three points or more."""
    try:
        corners = [(float(a), float(b)) for a, b in points]
    except (TypeError, ValueError):
        raise TypeError("points must be a list of points (x, y)") from None
    if len(corners) < 3:
        raise GcodePreviewError("points: at least three are required")
    return [*corners, corners[0]]


def text(x, y, string, height, font="sans", spacing=0.0, width=1.0):
    """The strokes of a text in a single-line font: lists of points.

    (x, y) is the left end of the base line, `height` that of capitals, `width` a factor of the letters'
    width, `spacing` added between letters, mm. Lines are separated by line breaks.
    """
    return _kerf._design_value("textstrokes", x, y, string, height, font, spacing, width)


def bezier(control, within=0.005):
    """A Bézier curve of any degree through its control points as arcs: a point, then arcs and segments."""
    return _kerf._design_value("bezier", control, within)


def bezier_surface(bx, by, width, height, heights):
    """The height above (x, y) of a bicubic Bézier surface over a rectangle.

    `heights` are the Z of its four rows of four control points, which are evenly spaced, from the lower left
    corner along X.
    """
    try:
        return kerf.BezierSurface((bx, by), width, height, heights)
    except ValueError as error:
        raise GcodePreviewError(str(error)) from None


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
    return _kerf._design_value("round_corners", outline, radius)

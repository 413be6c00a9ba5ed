"""Two-dimensional shapes as closed outlines: points and arcs as `kerf.Region` takes them.

An outline is a list: the first element is a point (x, y), each further one a straight segment to (x, y) or
an arc (via x, via y, x, y). `round_corners` makes the rounded form of any of them.
"""

from __future__ import annotations

from typing import Sequence

import kerf
from kerf import _kerf
from kerf._kerf import GcodePreviewError
from kerf._types import Outline, Points, Rows

__all__ = ["SHAPES", "bezier", "bezier_surface", "round_corners", "text"]


def _made(name: str, *values: float) -> Points:
    """The outline of a shape of `kerf.plane_shapes`."""
    try:
        return kerf.plane_shape(name, *values)
    except ValueError as error:
        raise GcodePreviewError(str(error)) from None


def circle(x: float, y: float, radius: float) -> Points:
    """A circle about (x, y)."""
    return _made("circle", x, y, radius)


def ellipse(x: float, y: float, width: float, height: float) -> Points:
    """An ellipse about (x, y)."""
    return _made("ellipse", x, y, width, height)


def egg(x: float, y: float, width: float, height: float, point: float = 0.2) -> Points:
    """An oval that is narrower at its top; `point` 0 is an ellipse."""
    return _made("egg", x, y, width, height, point)


def superellipse(x: float, y: float, width: float, height: float, exponent: float = 2.5) -> Points:
    """An oval between an ellipse (exponent 2) and a rectangle."""
    return _made("superellipse", x, y, width, height, exponent)


def cone(x: float, y: float, width: float, height: float) -> Points:
    """A triangle with a half circle at its wide end; its tip is at (x, y)."""
    return _made("cone", x, y, width, height)


def segment(x: float, y: float, radius: float, angle: float = 180) -> Points:
    """The part of a circle cut off by a chord under an angle at the centre; 180 is a half circle."""
    return _made("segment", x, y, radius, angle)


def arch(x: float, y: float, width: float, height: float) -> Points:
    """A rectangle with a half circle on top; (x, y) is its lower left corner."""
    return _made("arch", x, y, width, height)


def lens(x: float, y: float, radius: float, distance: float) -> Points:
    """What two circles have in common; with a distance of the radius a vesica piscis."""
    return _made("lens", x, y, radius, distance)


def lune(x: float, y: float, radius: float, distance: float) -> Points:
    """A crescent: a circle without another of the same radius at a distance to its right."""
    return _made("lune", x, y, radius, distance)


def heart(x: float, y: float, width: float) -> Points:
    """Two half circles over a tip at (x, y)."""
    return _made("heart", x, y, width)


def tomoe(x: float, y: float, radius: float) -> Points:
    """A comma of three half circles."""
    return _made("tomoe", x, y, radius)


def triangle(x: float, y: float, a: float, b: float, c: float) -> Points:
    """A triangle by the lengths of its sides; `a` lies on the X axis from (x, y)."""
    return _made("triangle", x, y, a, b, c)


def sector(x: float, y: float, radius: float, angle: float = 90, start: float = 0) -> Points:
    """A slice of a circle: quadrant 90, sextant 60, octant 45 degrees."""
    return _made("sector", x, y, radius, angle, start)


def deltoid(x: float, y: float, radius: float) -> Points:
    """The curve with three cusps of a circle rolling in one of three times its radius."""
    return _made("deltoid", x, y, radius)


def astroid(x: float, y: float, radius: float) -> Points:
    """The curve with four cusps of a circle rolling in one of four times its radius."""
    return _made("astroid", x, y, radius)


def reuleaux(x: float, y: float, width: float) -> Points:
    """The curve of constant width on a triangle with its lower left corner at (x, y)."""
    return _made("reuleaux", x, y, width)


def arbelos(x: float, y: float, radius: float, at: float = 0.5) -> Points:
    """A half circle without two smaller ones on its diameter; `at`: the fraction at which they meet."""
    return _made("arbelos", x, y, radius, at)


def dart(x: float, y: float, width: float, height: float, depth: float) -> Points:
    """Two straight sides and one concave arc; the tip is at (x, y + height)."""
    return _made("dart", x, y, width, height, depth)


def arrowhead(x: float, y: float, width: float, height: float, depth: float) -> Points:
    """Two convex sides and one concave arc; the tip is at (x, y + height)."""
    return _made("arrowhead", x, y, width, height, depth)


def rectangle(x: float, y: float, width: float, height: float) -> Points:
    """A rectangle; (x, y) is its lower left corner."""
    return _made("rectangle", x, y, width, height)


def parallelogram(x: float, y: float, width: float, height: float, shift: float) -> Points:
    """A parallelogram with its top shifted to the right; (x, y) is its lower left corner."""
    return _made("parallelogram", x, y, width, height, shift)


def rhombus(x: float, y: float, width: float, height: float) -> Points:
    """A rhombus about (x, y)."""
    return _made("rhombus", x, y, width, height)


def trapezoid(x: float, y: float, bottom: float, top: float, height: float) -> Points:
    """A trapezoid with two equal sides; (x, y) is its lower left corner."""
    return _made("trapezoid", x, y, bottom, top, height)


def kite(x: float, y: float, width: float, upper: float, lower: float) -> Points:
    """A kite; (x, y) is where its diagonals cross."""
    return _made("kite", x, y, width, upper, lower)


def annulus_segment(x: float, y: float, outer: float, inner: float, start: float, end: float) -> Points:
    """The part of a ring between two angles, degrees."""
    return _made("annulus_segment", x, y, outer, inner, start, end)


def salinon(x: float, y: float, radius: float, inner: float) -> Points:
    """Four half circles on one line: the large one, two small ones cut out, and one below."""
    return _made("salinon", x, y, radius, inner)


def concave_square(x: float, y: float, width: float, height: float, depth: float) -> Points:
    """Three straight sides and one concave arc on top."""
    return _made("concave_square", x, y, width, height, depth)


def annulus(x: float, y: float, outer: float, inner: float) -> list[Points]:
    """Two outlines: the ring between two radii."""
    return _kerf._design_value("annulus", x, y, outer, inner)


def polygon(points: Rows) -> Points:
    """The outline through three points or more."""
    try:
        corners = [(float(a), float(b)) for a, b in points]
    except (TypeError, ValueError):
        raise TypeError("points must be a list of points (x, y)") from None
    if len(corners) < 3:
        raise GcodePreviewError("points: at least three are required")
    return [*corners, corners[0]]


def text(
    x: float,
    y: float,
    string: str,
    height: float,
    font: str = "sans",
    spacing: float = 0.0,
    width: float = 1.0,
) -> list[Points]:
    """The strokes of a text in a single-line font: lists of points.

    (x, y) is the left end of the base line, `height` that of capitals, `width` a factor of the letters'
    width, `spacing` added between letters, mm. Lines are separated by line breaks.
    """
    return _kerf._design_value("textstrokes", x, y, string, height, font, spacing, width)


def bezier(control: Rows, within: float = 0.005) -> Points:
    """A Bézier curve of any degree through its control points as arcs: a point, then arcs and segments."""
    return _kerf._design_value("bezier", control, within)


def bezier_surface(
    bx: float, by: float, width: float, height: float, heights: Sequence[Rows]
) -> kerf.BezierSurface:
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


def round_corners(outline: Outline, radius: float) -> list[Points]:
    """The rounded form: convex corners by arcs of `radius`, concave ones too.

    Returns the outlines of a `kerf.Region`: the shape offset inwards, outwards twice as far, and inwards
    again.
    """
    return _kerf._design_value("round_corners", outline, radius)

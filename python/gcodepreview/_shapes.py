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

from ._commands import with_sections

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
    """The outline through three points or more.

    Parameters
    ----------
    points : iterable of (float, float)
        The corners, mm.

    Returns
    -------
    list of (float, float)
        The closed outline: the corners, and the first one again.

    Raises
    ------
    TypeError
        If it is no list of points.
    GcodePreviewError
        If there are fewer than three.

    Examples
    --------
    >>> from gcodepreview import shapes
    >>> shapes.polygon([(0, 0), (10, 0), (0, 10)])
    [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (0.0, 0.0)]
    """
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

    Parameters
    ----------
    x, y : float
        The left end of the base line, mm.
    string : str
        The text; lines are separated by line breaks.
    height : float
        Height of capitals, mm; above 0.
    font : str
        A font of single strokes, such as 'sans'; an unknown name lists them.
    spacing : float
        Added between letters, mm.
    width : float
        Factor of the letters' width; above 0.

    Returns
    -------
    list of list
        The strokes: open lists of points (x, y), mm.

    Raises
    ------
    GcodePreviewError
        If a value is out of range, or the font is unknown.
    TypeError
        If an argument has a wrong type.

    Examples
    --------
    >>> from gcodepreview import shapes
    >>> len(shapes.text(0, 0, "I", 10))
    1
    """
    return _kerf._design_value("textstrokes", x, y, string, height, font, spacing, width)


def bezier(control: Rows, within: float = 0.005) -> Points:
    """A Bézier curve of any degree by its control points, as arcs.

    Parameters
    ----------
    control : list of (float, float)
        Three control points or more, mm; the first and the last are the ends of the curve.
    within : float
        Maximum deviation of the arcs from the curve, mm; above 0.

    Returns
    -------
    list
        An open path: a point (x, y), then arcs (via x, via y, x, y) and points, mm.

    Raises
    ------
    GcodePreviewError
        If there are too few points, or `within` is not above 0.
    TypeError
        If an argument has a wrong type.

    Examples
    --------
    >>> from gcodepreview import shapes
    >>> shapes.bezier([(0, 0), (10, 20), (30, 0)])[0]
    (0.0, 0.0)
    """
    return _kerf._design_value("bezier", control, within)


def bezier_surface(
    bx: float, by: float, width: float, height: float, heights: Sequence[Rows]
) -> kerf.BezierSurface:
    """The height above (x, y) of a bicubic Bézier surface over a rectangle.

    Parameters
    ----------
    bx, by : float
        The lower left corner of the rectangle, mm.
    width, height : float
        Its size in X and Y, mm; at least 0.001.
    heights : list of list of float
        Z of the control points, mm, 4 x 4: rows along X from the lower left corner. The points are evenly
        spaced.

    Returns
    -------
    kerf.BezierSurface
        A function of x and y, for `cutsurface`.

    Raises
    ------
    GcodePreviewError
        If the size is too small, or there are not four rows of four heights.

    Examples
    --------
    >>> from gcodepreview import shapes
    >>> shapes.bezier_surface(0, 0, 90, 60, [[-4.0] * 4] * 4)(45, 30)
    -4.0
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


# What the arguments of the shapes are, mm unless a row says degrees.
_SIZES = {
    "x": "X of the position, mm.",
    "y": "Y of the position, mm.",
    "radius": "Radius, mm; above 0.",
    "width": "Size in X, mm; above 0.",
    "height": "Size in Y, mm; above 0.",
    "point": "How much narrower the top is; 0: an ellipse.",
    "exponent": "Exponent of the curve; above 0, 2: an ellipse.",
    "angle": "Angle at the centre, degrees.",
    "distance": "Distance of the two centres, mm; above 0.",
    "a": "Length of the side along X, mm; above 0.",
    "b": "Length of the second side, mm; above 0.",
    "c": "Length of the third side, mm; above 0.",
    "start": "Angle of the start, degrees, counter-clockwise from +X.",
    "end": "Angle of the end, degrees, counter-clockwise from +X.",
    "at": "Fraction of the diameter at which the two smaller half circles meet; above 0, below 1.",
    "depth": "Depth of the arc, mm; above 0.",
    "shift": "Distance by which the top is shifted, mm.",
    "bottom": "Length of the lower side, mm; above 0.",
    "top": "Length of the upper side, mm; above 0.",
    "upper": "Height of the part above the crossing of the diagonals, mm; above 0.",
    "lower": "Height of the part below the crossing of the diagonals, mm; above 0.",
    "outer": "Outer radius, mm; above `inner`.",
    "inner": "Inner radius, mm; above 0.",
}
_OUTLINE = (
    "list",
    "The closed outline: a point (x, y), then points (x, y) and arcs (via x, via y, x, y), mm.",
)


def _add_sections(function, returns):
    code = function.__code__
    rows = [(name, "float", _SIZES[name]) for name in code.co_varnames[: code.co_argcount]]
    text = function.__doc__ or ""
    example = ""
    if function is circle:
        example = ">>> from gcodepreview import shapes\n>>> shapes.circle(10, 20, 5)[0]\n(15.0, 20.0)"
    function.__doc__ = with_sections(text, rows, returns, example)


for _shape in SHAPES.values():
    _add_sections(_shape, _OUTLINE)
_add_sections(annulus, ("list of list", "The two outlines, the outer one first."))


def round_corners(outline: Outline, radius: float) -> list[Points]:
    """The rounded form: convex corners by arcs of `radius`, concave ones too.

    The shape is offset inwards, outwards twice as far, and inwards again.

    Parameters
    ----------
    outline : list
        A closed outline, as the shapes return it, mm.
    radius : float
        Radius of the corners, mm; above 0.

    Returns
    -------
    list of list
        The outlines of a `kerf.Region`.

    Raises
    ------
    GcodePreviewError
        If the radius is not above 0, or does not fit into the outline.
    TypeError
        If an argument has a wrong type.

    Examples
    --------
    >>> from gcodepreview import shapes
    >>> len(shapes.round_corners(shapes.rectangle(0, 0, 40, 20), 3))
    1
    """
    return _kerf._design_value("round_corners", outline, radius)

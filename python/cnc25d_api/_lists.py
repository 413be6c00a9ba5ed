"""Functions that move, reverse, close and flatten outlines."""

import math

from . import _outline
from ._outline import OutlineError
from ._say import warn


# Maximum number of chords of a drawing; each is a tuple of four numbers.
_MAX_CHORDS = 1_000_000


def refuse(number, text, outline=""):
    """The OutlineError of a message number."""
    error = OutlineError(f"ERR{number}: Error, {text}")
    error.code, error.outline, error.element = number, outline, None
    return error


def _check_format(outline_format):
    if outline_format not in (None, "A", "B", "C"):
        raise refuse(264, f"outline_format must be 'A', 'B', 'C' or None, not {outline_format!r}")


def outline_shift_x(outline, x_offset, x_factor, *, outline_format=None):
    """x -> x_offset + x_factor * x; see `outline_shift_xy`."""
    return outline_shift_xy(outline, x_offset, x_factor, 0, 1, outline_format=outline_format)


def outline_shift_y(outline, y_offset, y_factor, *, outline_format=None):
    """y -> y_offset + y_factor * y; see `outline_shift_xy`."""
    return outline_shift_xy(outline, 0, 1, y_offset, y_factor, outline_format=outline_format)


def outline_shift_xy(outline, x_offset, x_factor, y_offset, y_factor, *, outline_format=None):
    """Shift, scale or mirror an outline (format A, B or a circle; format C with outline_format="C").

    A mirrored outline is also reversed, so that its orientation does not change. Requests are unchanged. The
    radius of a circle is scaled; with factors of different size it stays a circle, with a warning.

    Format C has three numbers per element, as format A. Only with `outline_format="C"` are its inclinations
    mirrored and reversed with the points.

    Raises
    ------
    OutlineError
        For malformed lists and factors of 0.
    """
    _check_format(outline_format)
    made = _outline.transform(outline, x_offset, x_factor, y_offset, y_factor, outline_format or "")
    if made and not isinstance(made[0], tuple) and abs(x_factor) != abs(y_factor):
        warn(358, f"factors {x_factor} and {y_factor} would make an ellipse: a circle is made")
    return made


def outline_rotate(outline, center_x, center_y, rotation_angle, *, outline_format=None):
    """Rotate an outline about a point by an angle in radians, with outline_format="C" inclinations too."""
    _check_format(outline_format)
    return _outline.rotate(outline, center_x, center_y, rotation_angle, outline_format or "")


def outline_close(outline):
    """A copy of the outline, closed by a line if it is open. A circle is returned unchanged."""
    kind = _outline.check(outline, 237, 247, "")
    if kind == "circle":
        return list(outline)
    end = -2 if kind == "B" else -3
    first, last = outline[0], outline[-1]
    made = list(outline)
    if first[0] == last[end] and first[1] == last[end + 1]:
        warn(421, "the outline is already closed!")
    else:
        made.append([first[0], first[1]] if kind == "B" else [first[0], first[1], 0])
    return made


def outline_reverse(outline, *, outline_format=None):
    """The same outline in the opposite direction; requests stay at their corners.

    With outline_format="C" inclinations are rotated by pi.
    """
    _check_format(outline_format)
    if outline_format == "C":
        return _outline.reverse_curve(outline)
    kind = _outline.check(outline, 257, 258, "")
    if kind == "circle":
        return list(outline)
    ends = [tuple(row[-2:]) if kind == "B" else tuple(row[-3:-1]) for row in outline]
    requests = [() if kind == "B" else (row[-1],) for row in outline]
    if kind == "A" and ends[0] == ends[-1]:
        if requests[-1] != (0,):
            warn(567, f"the last request of the closed outline is not zero: {requests[-1][0]}")
        requests = [(0,)] + requests[1:-1] + [requests[0]]
    made = [ends[-1] + requests[-1]]
    for i in range(len(outline) - 1, 0, -1):
        via = tuple(outline[i][:2]) if len(outline[i]) > 3 else ()
        made.append(via + ends[i - 1] + requests[i - 1])
    return made


def ideal_outline(outline, error_mark_string=""):
    """Format A or C without its last column: format B. Format B and circles are returned with a warning."""
    kind = _outline.check(outline, 868, 868, str(error_mark_string))
    if kind != "A":
        warn(441, f"{error_mark_string} is a circle or of format B already")
        return outline
    return [type(row)(row[:-1]) if type(row) in (list, tuple) else tuple(row[:-1]) for row in outline]


def outline_arc_line(outline, backend="tkinter"):
    """An outline of format B (or a circle) as chords, for drawing: a list of (x1, y1, x2, y2).

    A full circle has twelve chords per unit of radius, at least three. Other backends than "tkinter" drew
    into objects of other libraries; see `write_figure_in_svg` and `write_figure_in_dxf`.

    Raises
    ------
    OutlineError
        For malformed lists, and outlines with more than a million chords.
    """
    if backend != "tkinter":
        raise refuse(264, f"backend {backend!r}: only 'tkinter' gives a list; see write_figure_in_svg")
    kind = _outline.check(outline, 237, 247, "")
    if kind == "circle":
        return _circle_chords(*outline)
    if kind == "A":
        warn(231, "format A or C used in outline_arc_line(); ideal_outline() converts it")
        outline = ideal_outline(outline)
    chords = []
    start = tuple(outline[0])
    for row in outline[1:]:
        room = _MAX_CHORDS - len(chords)
        is_arc = len(row) == 4
        points = _arc_points(start, tuple(row[:2]), tuple(row[2:]), room) if is_arc else [tuple(row)]
        for point in points:
            chords.append(start + point)
            start = point
    return chords


def _check_chords(count, room):
    if count > room:
        raise refuse(264, f"more than {_MAX_CHORDS} chords would be made, twelve for each unit of radius: "
                     "choose a larger unit")


def _circle_chords(x, y, radius):
    if radius <= 0:
        raise refuse(409, f"the radius {radius} of a circle is not above 0")
    count = max(3, int(12 * radius))
    _check_chords(count, _MAX_CHORDS)
    points = [(x + radius * math.cos(2 * math.pi * i / count), y + radius * math.sin(2 * math.pi * i / count))
              for i in range(count)]
    return [points[i] + points[(i + 1) % count] for i in range(count)]


def _arc_points(start, via, end, room):
    """Points of an arc after its start, at most `room`, including its passing point and its end."""
    circle = _outline.arc_circle(start, via, end)
    if circle is None:
        return [end]
    x, y, radius, turn = circle
    step = 2 * math.pi / (12 * radius)
    points = []
    for first, stop in ((start, via), (via, end)):
        angle = math.atan2(first[1] - y, first[0] - x)
        sweep = (turn * (math.atan2(stop[1] - y, stop[0] - x) - angle)) % (2 * math.pi)
        count = int(sweep / step)
        _check_chords(len(points) + count, room)
        points += [(x + radius * math.cos(angle + turn * sweep * i / (count + 1)),
                    y + radius * math.sin(angle + turn * sweep * i / (count + 1)))
                   for i in range(1, count + 1)]
        points.append(stop)
    return points

"""cnc25d_api: outlines whose corners a router bit can make, curves as arcs, and figures of outlines.

The functions have the names, arguments and list formats of Cnc25D's outline interface; the geometry is
Kerf's.

Formats (lists or tuples, lengths in one unit of the user's choice, angles in radians):

A        [[x, y, rbrr], [x, y, rbrr] or [via_x, via_y, x, y, rbrr], ...]   an outline with corner requests
B        [[x, y], [x, y] or [via_x, via_y, x, y], ...]                      an outline
C        [[x, y, inclination], ...]                                         samples of a curve with tangents
circle   [centre_x, centre_y, radius]
figure   [outline, outline, ...]          the first is the outside of a part, the others are its holes

`rbrr`, the router-bit radius request of a corner: 0 leaves it, above 0 smooths it, below 0 enlarges it.

No function changes its arguments, none stops the process. What cannot be done is a warning on
`sys.stdout` (a line that begins with WARN and its number) where a useful answer remains, and the
exception `OutlineError` where none does.
"""

from . import _outline
from ._figure import (
    cnc_cut_figure,
    figure_mesh,
    figure_simple_display,
    flip_rotate_and_translate_figure,
    ideal_figure,
    rotate_and_translate_figure,
    write_figure_in_3mf,
    write_figure_in_dxf,
    write_figure_in_stl,
    write_figure_in_svg,
)
from ._lists import (
    ideal_outline,
    outline_arc_line,
    outline_close,
    outline_reverse,
    outline_rotate,
    outline_shift_x,
    outline_shift_xy,
    outline_shift_y,
)
from ._outline import OutlineError
from ._record import record_cut
from ._say import say

__all__ = [
    "OutlineError",
    "cnc_cut_figure",
    "cnc_cut_outline",
    "corner_reports",
    "figure_mesh",
    "figure_simple_display",
    "flip_rotate_and_translate_figure",
    "ideal_figure",
    "ideal_outline",
    "outline_arc_line",
    "outline_close",
    "outline_reverse",
    "outline_rotate",
    "outline_shift_x",
    "outline_shift_xy",
    "outline_shift_y",
    "rotate_and_translate_figure",
    "smooth_outline_b_curve",
    "smooth_outline_c_curve",
    "write_figure_in_3mf",
    "write_figure_in_dxf",
    "write_figure_in_stl",
    "write_figure_in_svg",
]


def cnc_cut_outline(outline, error_msg_id="", *, fair=False):
    """Make the corners of an outline millable.

    Parameters
    ----------
    outline : list or tuple, format A
    error_msg_id : str
        Names the outline in messages; corner 3 of "plank" is called "plank.3".
    fair : bool
        Who gets an edge that is too short for the corners at both of its ends. False: the corner of the
        smaller number. True: half of the edge is each one's own, so that the result does not depend on
        where the outline begins.

    Returns
    -------
    list of tuple, format B
        Arcs have their passing point in the middle. A corner that cannot be cut stays sharp; the warning
        names it, says why, and by how much the radius is too large.

    Raises
    ------
    OutlineError
        Malformed lists, numbers that are not finite, arcs that end where they begin.
    """
    made, messages, own_messages, _ = _outline.cut(outline, str(error_msg_id), bool(fair), False)
    if not record_cut(outline, str(error_msg_id)):
        say(messages)
    say(own_messages)
    return made


def corner_reports(outline, error_msg_id="", *, fair=False):
    """What `cnc_cut_outline` does to each corner that has a request.

    Returns
    -------
    list of dict
        `element` of the input; `outcome` ('smoothed', 'enlarged' or 'sharp'); `reason` where it stays sharp,
        else 'none'; `largest`, the largest radius that would fit where it stays sharp because the radius
        is too large, 0.0 elsewhere and for corners that were cut; `first` and `count`, the elements of
        the result that replace it.
    """
    return _outline.cut(outline, str(error_msg_id), bool(fair), True)[3]


def smooth_outline_c_curve(outline, precision, router_bit_request, error_msg_id):
    """Turn samples with tangents into a chain of arcs with a continuous tangent, two arcs a segment.

    Parameters
    ----------
    outline : list or tuple, format C
    precision : float
        A segment whose tangents are closer than this to its chord becomes a line. Typical: pi/1000.
    router_bit_request : float
        Arcs with a smaller radius are warned about (and kept).
    error_msg_id : str

    Returns
    -------
    list of tuple, format B

    Raises
    ------
    OutlineError
        Malformed lists, equal neighbours, a tangent more than a right angle off its chord.
    """
    made, messages = _outline.smooth_c(outline, precision, router_bit_request, str(error_msg_id))
    say(messages)
    return made


def smooth_outline_b_curve(outline, precision, router_bit_request, error_msg_id):
    """As `smooth_outline_c_curve`, for points without tangents (format B without arcs): they are guessed.

    A closed curve is smooth at its seam, too.
    """
    made, messages = _outline.smooth_b(outline, precision, router_bit_request, str(error_msg_id))
    say(messages)
    return made

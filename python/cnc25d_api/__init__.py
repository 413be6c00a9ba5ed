"""cnc25d_api: outlines with corners that a router bit can cut, curves as arcs, and figures of outlines.

The functions have the names, arguments and list formats of Cnc25D's outline interface; the geometry is
Kerf's.

Formats (lists or tuples, lengths in one unit of the user's choice, angles in radians):

A        [[x, y, rbrr], [x, y, rbrr] or [via_x, via_y, x, y, rbrr], ...]   an outline with corner requests
B        [[x, y], [x, y] or [via_x, via_y, x, y], ...]                      an outline
C        [[x, y, inclination], ...]                                         samples of a curve with tangents
circle   [centre_x, centre_y, radius]
figure   [outline, outline, ...]          the first is the outside of a part, the others are its holes

`rbrr`, the router-bit radius request of a corner: 0 leaves it, above 0 smooths it, below 0 enlarges it.

No function changes its arguments or stops the process. Problems with a usable result are warnings on
`sys.stdout` (a line that starts with WARN and its number), others raise `OutlineError`.
"""

import inspect as _inspect

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

OutlineError.__signature__ = _inspect.Signature(
    [_inspect.Parameter("message", _inspect.Parameter.POSITIONAL_ONLY)]
)


def cnc_cut_outline(outline, error_msg_id="", *, fair=False):
    """Smooth or enlarge the corners of an outline for a router bit.

    Parameters
    ----------
    outline : list or tuple, format A
    error_msg_id : str
        Names the outline in messages; corner 3 of "plank" is called "plank.3".
    fair : bool
        Division of an edge that is too short for the corners at both of its ends. False: the corner with
        the smaller index has priority. True: each corner has half of the edge, so that the result does not
        depend on the start point of the outline.

    Returns
    -------
    list of tuple, format B
        The passing point of an arc is its midpoint. A corner that cannot be cut stays sharp; the warning
        names it, the reason, and by how much the radius is too large.

    Raises
    ------
    OutlineError
        For malformed lists, numbers that are not finite, and arcs whose end point is their start point.
    """
    made, messages, own_messages, _ = _outline.cut(outline, str(error_msg_id), bool(fair), False)
    if not record_cut(outline, str(error_msg_id)):
        say(messages)
    say(own_messages)
    return made


def corner_reports(outline, error_msg_id="", *, fair=False):
    """The result of `cnc_cut_outline` at each corner with a request.

    Parameters
    ----------
    outline, error_msg_id, fair
        As for `cnc_cut_outline`.

    Returns
    -------
    list of dict
        `element`, index in the input; `outcome` ('smoothed', 'enlarged' or 'sharp'); `reason` of a sharp
        corner, else 'none'; `largest`, the largest radius that fits if the corner is sharp because its radius
        is too large, else 0.0; `first` and `count`, the elements of the result that replace it.

    Raises
    ------
    OutlineError
        As for `cnc_cut_outline`.
    """
    return _outline.cut(outline, str(error_msg_id), bool(fair), True)[3]


def smooth_outline_c_curve(outline, precision, router_bit_request, error_msg_id):
    """Convert samples with tangents to a chain of tangent arcs, two arcs per segment.

    Parameters
    ----------
    outline : list or tuple, format C
    precision : float
        A segment whose tangents deviate from its chord by less than this angle becomes a line. Typical:
        pi/1000.
    router_bit_request : float
        A warning is printed for arcs with a smaller radius.
    error_msg_id : str

    Returns
    -------
    list of tuple, format B

    Raises
    ------
    OutlineError
        For malformed lists, equal neighbours, and tangents that deviate from the chord by more than a right
        angle.
    """
    made, messages = _outline.smooth_c(outline, precision, router_bit_request, str(error_msg_id))
    say(messages)
    return made


def smooth_outline_b_curve(outline, precision, router_bit_request, error_msg_id):
    """As `smooth_outline_c_curve`, for points without tangents (format B without arcs), which are estimated.

    A closed curve is also smooth at its start point.
    """
    made, messages = _outline.smooth_b(outline, precision, router_bit_request, str(error_msg_id))
    say(messages)
    return made

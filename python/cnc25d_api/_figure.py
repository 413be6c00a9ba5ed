"""Figures: lists of outlines that belong to one part."""

import os
import tempfile

from . import _outline
from ._lists import ideal_outline, outline_rotate, outline_shift_xy, refuse


def _format(outline, name):
    return _outline.check(outline, 237, 247, name)


def _outlines(figure, name=""):
    name = str(name) or "figure"
    try:
        return list(figure)
    except TypeError:
        text = f"outline {name}: a figure is a list or a tuple of outlines, not {type(figure).__name__}"
        raise refuse(937, text, name) from None


def cnc_cut_figure(figure, error_figure_id="", *, fair=False):
    """`cnc_cut_outline` for each outline of format A; circles and format B stay as they are.

    Outline k is called "<error_figure_id>.ol<k>" in messages.
    """
    from . import cnc_cut_outline
    made = []
    for k, outline in enumerate(_outlines(figure, error_figure_id)):
        name = f"{error_figure_id}.ol{k}"
        made.append(cnc_cut_outline(outline, name, fair=fair) if _format(outline, name) == "A" else outline)
    return made


def ideal_figure(figure, error_figure_id=""):
    """`ideal_outline` for each outline of format A; circles and format B stay as they are."""
    made = []
    for k, outline in enumerate(_outlines(figure, error_figure_id)):
        name = f"{error_figure_id}.ol{k}"
        made.append(ideal_outline(outline, name) if _format(outline, name) == "A" else outline)
    return made


def rotate_and_translate_figure(figure, center_x, center_y, rotation_angle, translate_x, translate_y):
    """Rotate a figure about a point by an angle in radians, then shift it."""
    return [outline_shift_xy(outline_rotate(outline, center_x, center_y, rotation_angle),
                             translate_x, 1, translate_y, 1) for outline in _outlines(figure)]


def flip_rotate_and_translate_figure(figure, zero_x, zero_y, size_x, size_y, flip_x, flip_y, rotation_angle,
                                     translate_x, translate_y):
    """Flip a figure about its centre, rotate it about that, and shift it.

    Parameters
    ----------
    figure : list of outlines
    zero_x, zero_y, size_x, size_y : float
        Corner and size of the figure, which define its centre.
    flip_x, flip_y : {1, -1}
    rotation_angle : float
        Radians.
    translate_x, translate_y : float
        New position of the corner of an unrotated figure.

    Returns
    -------
    list of outlines

    Raises
    ------
    OutlineError
        For other values of flip_x and flip_y, and for malformed outlines.
    """
    for name, flip in (("flip_x", flip_x), ("flip_y", flip_y)):
        if flip not in (1, -1):
            raise refuse(264, f"{name} must be 1 or -1, not {flip!r}")
    made = []
    for outline in _outlines(figure):
        outline = outline_shift_xy(outline, -(zero_x + size_x / 2), 1, -(zero_y + size_y / 2), 1)
        outline = outline_shift_xy(outline, 0, flip_x, 0, flip_y)
        outline = outline_rotate(outline, 0, 0, rotation_angle)
        made.append(outline_shift_xy(outline, size_x / 2 + translate_x, 1, size_y / 2 + translate_y, 1))
    return made


def figure_simple_display(figure, overlay_figure=(), parameter_info="", *, filename=None):
    """Draw a figure (red) over another one (orange, dashed): the cut figure over the ideal one.

    Writes an SVG file and prints its name; no window is opened.

    Parameters
    ----------
    figure, overlay_figure : list of format-B outlines and circles
    parameter_info : str
        Title of the file.
    filename : str, optional
        The file to write. Default: a new file in the folder for temporary files.

    Returns
    -------
    str
        The name of the file.
    """
    text = _outline.figure_svg(figure, overlay_figure, str(parameter_info))
    if filename is None:
        handle, filename = tempfile.mkstemp(prefix="cnc25d_", suffix=".svg")
        os.close(handle)
    _write(filename, text)
    print(f"figure_simple_display: the picture is in {filename}")
    return filename


def write_figure_in_svg(figure, filename):
    """Write a figure as SVG at its true size in mm; arcs stay arcs, y points up."""
    _write(filename, _outline.figure_svg(figure, (), os.path.basename(str(filename))))


def write_figure_in_dxf(figure, filename, *, polylines=False, unit="mm"):
    """Write a figure as DXF (AutoCAD 2000), arcs as arcs.

    Parameters
    ----------
    figure : list of format-B outlines and circles
    filename : str or os.PathLike
    polylines : bool
        True: one LWPOLYLINE with bulges for each outline. False: LINE, ARC and CIRCLE.
    unit : {'mm', 'inch'}
        Unit of the coordinates, specified in the file.
    """
    _write(filename, _outline.figure_dxf(figure, bool(polylines), unit))


def figure_mesh(figure, height, *, chord=0.01):
    """Extrude a figure to a closed mesh between z = 0 and `height`.

    Parameters
    ----------
    figure : list of format-B outlines and circles
        The first outline is the outside, the others are holes.
    height : float
    chord : float
        Maximum distance of chords from arcs.

    Returns
    -------
    points : list of (x, y, z)
    triangles : list of (int, int, int)

    Raises
    ------
    OutlineError
        For outlines that are open or intersect.
    """
    return _outline.figure_mesh(figure, height, chord)


def write_figure_in_stl(figure, height, filename, *, chord=0.01):
    """Write an extruded figure as a binary STL file; see `figure_mesh`."""
    _write(filename, _outline.figure_solid_file(figure, height, chord, "stl"))


def write_figure_in_3mf(figure, height, filename, *, chord=0.01):
    """Write an extruded figure as a 3MF file; see `figure_mesh`."""
    _write(filename, _outline.figure_solid_file(figure, height, chord, "3mf"))


def _write(filename, content):
    with open(filename, "wb") as file:
        file.write(content.encode("utf-8") if isinstance(content, str) else content)

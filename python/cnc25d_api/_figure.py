"""Figures: lists of outlines that belong to one part."""

from . import _outline
from ._lists import ideal_outline, outline_rotate, outline_shift_xy


def _format(outline):
    return _outline.check(outline, 237, 247)


def cnc_cut_figure(figure, error_figure_id="", *, fair=False):
    """`cnc_cut_outline` for each outline of format A; circles and format B stay as they are.

    Outline k is called "<error_figure_id>.ol<k>" in messages.
    """
    from . import cnc_cut_outline
    return [cnc_cut_outline(outline, f"{error_figure_id}.ol{k}", fair=fair) if _format(outline) == "A" else outline
            for k, outline in enumerate(figure)]


def ideal_figure(figure, error_figure_id=""):
    """`ideal_outline` for each outline of format A; circles and format B stay as they are."""
    return [ideal_outline(outline, f"{error_figure_id}.ol{k}") if _format(outline) == "A" else outline
            for k, outline in enumerate(figure)]


def rotate_and_translate_figure(figure, center_x, center_y, rotation_angle, translate_x, translate_y):
    """Turn a figure about a point by an angle in radians, then shift it."""
    return [outline_shift_xy(outline_rotate(outline, center_x, center_y, rotation_angle),
                             translate_x, 1, translate_y, 1) for outline in figure]


def flip_rotate_and_translate_figure(figure, zero_x, zero_y, size_x, size_y, flip_x, flip_y, rotation_angle,
                                     translate_x, translate_y):
    """Flip a figure of a given corner and size about its middle, turn it, and shift its corner to (translate_x, _y).

    flip_x, flip_y are 1 or -1.
    """
    made = []
    for outline in figure:
        outline = outline_shift_xy(outline, -(zero_x + size_x / 2), 1, -(zero_y + size_y / 2), 1)
        outline = outline_shift_xy(outline, 0, flip_x, 0, flip_y)
        outline = outline_rotate(outline, 0, 0, rotation_angle)
        made.append(outline_shift_xy(outline, size_x / 2 + translate_x, 1, size_y / 2 + translate_y, 1))
    return made


def figure_simple_display(figure, overlay_figure=(), parameter_info=""):
    raise NotImplementedError


figure_mesh = write_figure_in_3mf = write_figure_in_dxf = write_figure_in_stl = write_figure_in_svg = figure_simple_display

"""All functions of cnc25d_api in one script, for editing.

    python3 cnc25d_api_example.py [FOLDER]

writes its drawings and meshes into FOLDER (default: the current one).
"""

import math
import sys
from pathlib import Path

import cnc25d_api


def plate(router_bit_radius):
    """A plate of format A: each corner has its request for the router bit."""
    r = router_bit_radius
    return [
        [0, 0, 2 * r],           # first-point: smoothed
        [80, 0, -r],             # enlarged, so that another part fits into the corner
        [80, 50, 0],             # unchanged
        [60, 50, r],
        [50, 35, 40, 50, r],     # an arc through (50, 35)
        [0, 50, -r],
        [0, 0, 0],               # closes the outline; this corner is that of the first-point
    ]


def crenels(width, height):
    """One corner, mirrored to the other three."""
    corner = [[0, 10, 0], [5, 10, 0], [5, 0, 0]]
    outline = [[0, 10, 0]] + corner[1:]
    outline.extend(cnc25d_api.outline_shift_x(corner, width, -1))
    outline.extend(cnc25d_api.outline_shift_xy(corner, width, -1, height, -1))
    outline.extend(cnc25d_api.outline_shift_y(corner, height, -1))
    return cnc25d_api.outline_close([[x, y, 1] for x, y, _ in outline])


def spiral():
    """A curve of format C: samples with their tangent inclinations."""
    samples = []
    for i in range(25):
        t = i * math.pi / 12
        r = 10 + 2 * t
        x, y = r * math.cos(t), r * math.sin(t)
        tangent = math.atan2(2 * math.sin(t) + r * math.cos(t), 2 * math.cos(t) - r * math.sin(t))
        samples.append([x, y, tangent])
    return samples


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(parents=True, exist_ok=True)

    # corners
    wished = plate(3)
    cut = cnc25d_api.cnc_cut_outline(wished, "plate")
    for report in cnc25d_api.corner_reports(wished, "plate"):
        print(f"plate.{report['element']}: {report['outcome']} {report['reason']}")

    # curves
    smooth = cnc25d_api.smooth_outline_c_curve(spiral(), math.pi / 1000, 3.0, "spiral")
    print(f"the spiral has {len(smooth) - 1} arcs")
    points = [[10 * math.cos(i * math.pi / 6), 6 * math.sin(i * math.pi / 6)] for i in range(12)]
    ellipse = cnc25d_api.smooth_outline_b_curve(points + points[:1], math.pi / 1000, 1.0, "ellipse")

    # moving
    ellipse = cnc25d_api.outline_shift_xy(ellipse, 30, 1, 20, 1)
    turned = cnc25d_api.outline_rotate(cut, 40, 25, math.radians(30))
    print(f"reversed, it starts at {cnc25d_api.outline_reverse(turned)[0]}")

    # figures: the first outline is the outside, the others are holes
    figure = [wished, ellipse, [62, 20, 6]]
    cut_figure = cnc25d_api.cnc_cut_figure(figure, "figure")
    cnc25d_api.figure_simple_display(cut_figure, cnc25d_api.ideal_figure(figure, "figure"),
                                     "cut over ideal", filename=str(folder / "overlay.svg"))
    cnc25d_api.write_figure_in_svg(cut_figure, folder / "figure.svg")
    cnc25d_api.write_figure_in_dxf(cut_figure, folder / "figure.dxf")
    cnc25d_api.write_figure_in_stl(cut_figure, 12.0, folder / "figure.stl")
    cnc25d_api.write_figure_in_3mf(cut_figure, 12.0, folder / "figure.3mf")
    frame = cnc25d_api.cnc_cut_outline(crenels(100, 80), "crenels")
    cnc25d_api.write_figure_in_svg(
        cnc25d_api.flip_rotate_and_translate_figure([frame], 0, 0, 100, 80, -1, 1, 0.0, 10, 10),
        folder / "crenels.svg")
    print(f"files are in {folder}")


if __name__ == "__main__":
    main()

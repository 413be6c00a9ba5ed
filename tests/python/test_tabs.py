"""Where tabs are: on straight spans away from the corners of the part, also of boards with finger joints."""
import math

import pytest
import shapely
from shapely.geometry import LineString, Point, Polygon
from shapely.ops import unary_union

import kerf


def board(finger, depth=6.0, width=120.0, count=11):
    """Fingers on both short sides; the long sides are straight."""
    height = finger * count
    right = [(width - depth * (k % 2), finger * (k + e)) for k in range(count) for e in (0, 1)]
    left = [(depth * (k % 2), finger * (k + e)) for k in reversed(range(count)) for e in (1, 0)]
    ring = right + left
    return [*ring, ring[0]], height


def left_at_the_bottom(program, outline, d, bottom):
    """Pieces beside the part that stay at the bottom."""
    here, discs = None, []
    for step in program.toolpath:
        if step["step"] not in ("rapid", "cut", "arc"):
            continue
        to = tuple(step["to"])
        if step["step"] == "cut" and max(here[2], to[2]) <= bottom + 1e-6:
            path = LineString([here[:2], to[:2]]) if here[:2] != to[:2] else Point(to[:2])
            discs.append(path.buffer(d / 2, quad_segs=32))
        elif step["step"] == "arc" and max(here[2], to[2]) <= bottom + 1e-6:
            cx, cy = step["centre"][:2]
            radius, first = math.dist(here[:2], (cx, cy)), math.atan2(here[1] - cy, here[0] - cx)
            sign = 1 if step["turn"] == "ccw" else -1
            sweep = (math.atan2(to[1] - cy, to[0] - cx) - first) * sign % (2 * math.pi)
            points = [(cx + radius * math.cos(first + sign * sweep * k / 32),
                       cy + radius * math.sin(first + sign * sweep * k / 32)) for k in range(33)]
            discs.append(LineString(points).buffer(d / 2, quad_segs=32))
        here = to
    part = Polygon(outline)
    band = part.buffer(d / 2).buffer(1e-6) - part
    # What the tool reaches: not the corners of the fingers.
    band &= shapely.geometry.box(-99, -99, 399, 399) - part
    rest = (band - unary_union(discs)).buffer(-0.2).buffer(0.2)
    return [piece for piece in getattr(rest, "geoms", [rest]) if piece.area > 1]


@pytest.mark.parametrize("finger,tabs", [(6.5, 4), (6.5, 8), (7, 6), (13, 8), (25, 5)])
def test_tabs_are_away_from_the_corners_of_fingers(finger, tabs):
    d, outline = 3.0, board(finger)[0]
    program = kerf.op.contour([outline], f"square d={d} flute=12", depth=6, feed=600, side="outside",
                              tab_height=1.5, tab_length=d, tabs=tabs)
    pieces = left_at_the_bottom(program, outline, d, -6.0)
    assert len(pieces) == tabs
    corners = shapely.geometry.MultiPoint(outline)
    for piece in pieces:
        # Half a diameter, less what a span that counts as straight has of the arc around a corner.
        assert piece.distance(corners) > d / 3, (finger, piece.centroid.wkt)


def test_tabs_on_a_disc_stay_at_equal_distances():
    program = kerf.op.contour(kerf.Region([(0, 0, 10)]), "square d=3 flute=12", depth=4, feed=600,
                              side="outside", tab_height=1, tab_length=3, tabs=3)
    here, starts = None, set()  # angles at which the tool rises onto a tab
    for step in program.toolpath:
        if step["step"] == "cut" and here[2] < -3.1 and abs(step["to"][2] + 3) < 1e-6:
            starts.add(round(math.degrees(math.atan2(here[1], here[0])) % 360, 1))
        if step["step"] in ("rapid", "cut", "arc"):
            here = step["to"]
    angles = sorted(starts)
    gaps = [b - a for a, b in zip(angles, angles[1:] + [angles[0] + 360])]
    assert gaps == pytest.approx([120] * 3, abs=0.5)


def test_paths_too_short_for_their_tabs_are_one_warning():
    parts = [[(x, 0), (x + 4, 0), (x + 4, 4 + x / 100), (x, 4 + x / 100), (x, 0)] for x in range(0, 400, 20)]
    with pytest.warns(UserWarning) as caught:
        kerf.op.contour(parts, "square d=3 flute=12", depth=4, feed=600, side="outside", tab_height=1, tabs=6)
    texts = [str(w.message) for w in caught if "too short" in str(w.message)]
    assert len(texts) == 1 and "20 paths" in texts[0]

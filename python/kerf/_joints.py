"""Joints of boards: slots of finger joints, and corners that a round tool can clear."""

import math

from ._kerf import Region, segments

# mm by which a relief is wider than the tool, so that a path for the tool remains inside.
_SPARE = 0.002
_STRAIGHT = math.radians(1)  # corners that turn by less are left alone


def finger_slots(width, depth, count, *, first=True, fit=0.0, overhang=0.0):
    """The slots of a finger joint along the edge of a board.

    The edge is at y = 0 from x = 0 to `width`, the board above it. The two boards of a joint are cut with
    ``first=True`` and ``first=False``, each with the thickness of the other as depth.

    Parameters
    ----------
    width : float
        Of the boards, mm.
    depth : float
        Of the slots, mm: the thickness of the other board.
    count : int
        Fingers and slots together, odd and at least 3; each is ``width / count`` wide.
    first : bool
        True: fingers at both ends of the edge; False: slots there.
    fit : float
        Clearance between a finger and each side of its slot, mm; below 0 the joint is pressed together.
    overhang : float
        How far the slots reach beyond the edge and the ends of the board, mm, for the tool to leave them: at
        least its radius.

    Returns
    -------
    kerf.Region
    """
    if not 0 < width < math.inf or not 0 < depth < math.inf:
        raise ValueError(f"width and depth must be above 0 mm, not {width} and {depth}")
    if count < 3 or count % 2 == 0 or count != int(count):
        raise ValueError(f"count must be an odd whole number of at least 3, not {count}")
    if not abs(fit) < width / count:
        raise ValueError(f"fit must be smaller than a finger of {width / count:g} mm, not {fit}")
    if not 0 <= overhang < math.inf:
        raise ValueError(f"overhang must be 0 mm or more, not {overhang}")
    step = width / count
    slots = []
    for i in range(1 if first else 0, count, 2):
        low = -overhang if i == 0 else i * step - fit / 2
        high = width + overhang if i == count - 1 else (i + 1) * step + fit / 2
        slots.append([(low, -overhang), (high, -overhang), (high, depth), (low, depth), (low, -overhang)])
    return Region(slots)


def relieve_corners(region, diameter, style="dog-bone", *, limits=None):
    """A region to cut out, with room for a round tool in its inner corners.

    A tool of `diameter` that clears the result also clears the corners of `region`, so that a square part
    fits into it.

    Parameters
    ----------
    region : kerf.Region
        What is cut out. Corners between straight sides are relieved.
    diameter : float
        Of the tool, mm.
    style : {'dog-bone', 't-bone'}
        'dog-bone': along the bisector of the corner, the smallest relief. 't-bone': into the shorter side
        alone, so that the longer one stays straight.
    limits : kerf.Region, optional
        Only corners inside of it are relieved; for slots that are open at the edge of a board: the board.

    Returns
    -------
    kerf.Region
    """
    if style not in ("dog-bone", "t-bone"):
        raise ValueError(f"style must be 'dog-bone' or 't-bone', not {style!r}")
    if not 0 < diameter < math.inf:
        raise ValueError(f"diameter must be above 0 mm, not {diameter}")
    import kerf  # of which this is a part

    radius = diameter / 2 + _SPARE
    reliefs = []
    for outline in region.outlines:
        parts = segments(outline)
        for before, after in zip(parts[-1:] + parts[:-1], parts):
            if before["kind"] != "line" or after["kind"] != "line":
                continue
            if limits is not None and limits.locate(after["start"]) == "outside":
                continue
            path = _relief(before, after, radius, style)
            if path is not None:
                reliefs.append(kerf.widen(path, radius))
    for relief in reliefs:
        region = region | relief
    return region


def _relief(before, after, radius, style):
    """The path of a tool's centre that clears a corner; None for outer and straight corners."""
    corner = after["start"]
    back, along = _unit(corner, before["start"]), _unit(corner, after["end"])
    # The region is on the left of its outlines: corners that turn left are inner ones for the tool.
    turn = math.atan2(along[0] * back[1] - along[1] * back[0], along[0] * back[0] + along[1] * back[1])
    if turn < _STRAIGHT or turn > math.pi - _STRAIGHT:
        return None
    bisector = _unit((0, 0), (back[0] + along[0], back[1] + along[1]))
    reach = radius / math.sin(turn / 2)  # of the centre of a tool that touches both sides
    if style == "dog-bone":
        toward, close = bisector, radius
    else:
        toward, close = (back if before["length"] < after["length"] else along), radius
    start = (corner[0] + toward[0] * close, corner[1] + toward[1] * close)
    return [start, (corner[0] + bisector[0] * reach, corner[1] + bisector[1] * reach)]


def _unit(a, b):
    length = math.dist(a, b)
    return (b[0] - a[0]) / length, (b[1] - a[1]) / length

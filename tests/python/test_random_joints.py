"""Joints with random sizes: either both boards go together, or the call is refused.

The sections of the boards are computed with shapely from the motions: what a tool of that radius removes.
Nothing of it is Kerf's own.
"""

import math
import random

import pytest
import shapely

from gcodepreview import GcodePreviewError, gcodepreview

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")
SMALL = 1e-3  # mm
CHORD = math.radians(2)
TRIALS = 170  # of each of three kinds


def paths_at(gcp, z):
    """The motions with a tool at the height z, as lists of points; arcs as chords."""
    found, here = [], (0.0, 0.0, 0.0)
    for step in gcp.toolpath:
        if "to" not in step:
            continue
        start, end = here, tuple(step["to"])
        here = end
        if abs(end[2] - z) > SMALL or step["step"] == "rapid":
            continue
        if abs(start[2] - z) > SMALL:
            found.append([end[:2], end[:2]])
        elif step["step"] == "arc":
            cx, cy = step["centre"]
            a = math.atan2(start[1] - cy, start[0] - cx)
            sweep = math.atan2(end[1] - cy, end[0] - cx) - a
            sweep = sweep % math.tau if step["turn"] == "ccw" else -(-sweep % math.tau)
            n = max(2, math.ceil(abs(sweep) / CHORD))
            radius = math.dist(start[:2], (cx, cy))
            found.append(
                [
                    (cx + radius * math.cos(a + sweep * k / n), cy + radius * math.sin(a + sweep * k / n))
                    for k in range(n + 1)
                ]
            )
        else:
            found.append([start[:2], end[:2]])
    return shapely.union_all([shapely.LineString(points) for points in found])


def machine(tool):
    gcp = gcodepreview("no_preview")
    gcp.setupstock(600, 600, 50, "Top", "Center", 9)
    gcp.toolchange(tool, 10000)
    gcp.rapid(0, 0, 0)
    return gcp


def cut_or_refused(tool, cut):
    """The machine after a cut; None if the call was refused, with a message that names an argument."""
    gcp = machine(tool)
    try:
        cut(gcp)
    except GcodePreviewError as error:
        assert len(str(error)) > 20
        return None
    return gcp


def both(cuts, tool):
    """Both boards; None if the joint is refused, which both calls have to agree on."""
    made = [cut_or_refused(tool, cut) for cut in cuts]
    assert (made[0] is None) == (made[1] is None), "one board of a joint is refused, the other is not"
    return None if made[0] is None else made


# ---- dovetails


def dovetail_overlap(arguments, fit, tool, boards):
    """The largest overlap of the boards and the largest distance between their flanks, mm."""
    width, thickness, _, spacing, proportion, diameter, angle = arguments
    depth, slope = thickness * proportion, math.tan(math.radians(angle))
    lines = [paths_at(gcp, -depth) for gcp in boards]
    start = thickness + spacing  # of the pin board
    deepest = gap = 0.0
    for height in (0.02 * depth, 0.5 * depth, 0.98 * depth):
        sockets = lines[0].buffer(diameter / 2 - slope * height, quad_segs=40)
        pins = shapely.box(0, start, width, start + 3 * depth + diameter).difference(sockets)
        # The tail board is turned over: its tails point down into the sockets.
        removed = lines[1].buffer(diameter / 2 - slope * (depth - height), quad_segs=40)
        tails = shapely.box(0, 0, width, thickness + slope * depth).difference(removed)
        tails = shapely.transform(tails, lambda p: [(width - x, y + start) for x, y in p])
        shared = pins.intersection(tails)
        deepest = max(deepest, 0.0 if shared.is_empty else shared.area / max(shared.length / 2, SMALL))
        assert tails.area > 0 and pins.buffer(-SMALL).area > 0
        # The flanks, beyond the groove from which the sockets start.
        groove = start + max(0.0, (diameter - spacing) / 2) + SMALL
        open_ = shapely.box(0, groove, width, start + depth).intersection(sockets)
        if not open_.is_empty:
            flanks = open_.intersection(shapely.box(0, groove, width, start + depth - diameter / 2))
            far = flanks.difference(tails.buffer(max(fit, 0) + 0.05))
            gap = max(gap, far.area)
    return deepest, gap


def test_random_dovetails():
    rng, accepted = random.Random(38), 0
    for _ in range(TRIALS):
        tool, diameter, angle = rng.choice([(814, 12.7, 14), (814, 12.7, 14), (45828, 7.9375, 8)])
        if rng.random() < 0.1:
            angle = rng.choice([8, 14, 30])
        thickness = rng.uniform(6, 22)
        count = rng.randint(1, 8)
        width = count * diameter * rng.uniform(1.2, 4)
        fit = rng.choice([0.0, 0.1, 0.3, -0.05, rng.uniform(-8, 8)])
        arguments = (width, thickness, count, rng.uniform(1, 20), rng.uniform(0.2, 0.95), diameter, angle)
        boards = both(
            [lambda g: g.cut_pins(*arguments, fit=fit), lambda g: g.cut_tails(*arguments, fit=fit)], tool
        )
        if boards is None:
            continue
        accepted += 1
        overlap, gap = dovetail_overlap(arguments, fit, tool, boards)
        assert overlap <= 2 * max(0.0, -fit) + 0.01, (tool, arguments, fit)
        assert gap <= 0.01, (tool, arguments, fit)
    assert accepted > TRIALS / 4


# ---- fingers of a full-blind box joint


def test_random_fingers_of_box_joints():
    rng, accepted = random.Random(39), 0
    for _ in range(TRIALS):
        tool, size = rng.choice([(102, 3.175), (201, 6.35), (112, 1.5875)])
        pins = rng.randint(1, 12)
        width = (2 * pins - 1) * size * 1.1 * rng.uniform(0.9, 2)
        fingers = (2 * pins - 1) * size * 1.1
        origin = rng.choice([(width - fingers) / 2, rng.uniform(0, max(0.0, width - fingers)), -3.0, width])
        fit = rng.choice([0.0, 0.1, 0.25, -0.05, rng.uniform(-2 * size, 2 * size)])
        thickness = size * rng.uniform(0.8, 5)
        vertical = rng.random() < 0.5
        sides = ("Left", "Right") if vertical else ("Lower", "Upper")
        given = ("Vertical" if vertical else "Horizontal", width, thickness, pins, origin, size, fit)
        make = lambda side: lambda g: g.Finger_Joint_square(
            0, 0, given[0], side, width, thickness, pins, origin, size, fit=fit
        )
        boards = both([make(side) for side in sides], tool)
        if boards is None:
            continue
        accepted += 1
        spans = []
        for gcp, sign in zip(boards, (1, -1)):
            removed = paths_at(gcp, -(thickness - size / 2)).buffer(size / 2, quad_segs=40)
            across = sign * (thickness - size / 2) / 2  # between the joint's line and the round ends
            line = [(across, -50), (across, width + 50)]
            line = line if vertical else [(y, x) for x, y in line]
            cut = removed.intersection(shapely.LineString(line))
            parts = getattr(cut, "geoms", [cut])
            axis = 1 if vertical else 0
            spans.append(sorted((p.bounds[axis], p.bounds[axis + 2]) for p in parts if p.length > SMALL))
        first, second = spans
        # Between the slots of one board are its fingers, and each lies in a slot of the other one.
        assert (len(first), len(second)) == (pins, pins - 1), given
        assert first[0][0] >= -SMALL - max(fit, 0) and first[-1][1] <= width + SMALL + max(fit, 0), given
        for a, b, slot in zip(first, first[1:], second):
            assert b[0] - a[1] > 0, given
            assert a[1] - slot[0] == pytest.approx(fit, abs=0.01), given
            assert slot[1] - b[0] == pytest.approx(fit, abs=0.01), given
    assert accepted > TRIALS / 4


# ---- finger joints with reliefs


def lengths(gcp, depth, thickness, radius, along):
    """How much material a board has at each position along the edge, within the depth of its slots."""
    removed = paths_at(gcp, -thickness).buffer(radius, quad_segs=40)
    shapely.prepare(removed)
    left = []
    for x in along:
        cut = removed.intersection(shapely.LineString([(x, 0), (x, depth)]))
        left.append(depth - cut.length)
    return left


def test_random_finger_joints():
    rng, accepted = random.Random(40), 0
    for _ in range(TRIALS):
        tool, size = rng.choice([(102, 3.175), (201, 6.35), (112, 1.5875)])
        count = rng.choice([1, 3, 4, 5, 7, 9, 13])
        width = count * size * rng.uniform(0.8, 4)
        depths = (size * rng.uniform(0.3, 4), size * rng.uniform(0.3, 4))
        fit = rng.choice([0.0, 0.1, 0.2, 0.3, rng.uniform(-size, size)])
        corners = rng.choice(["dog-bone", "t-bone"])
        cuts = [
            lambda g: g.cutfingers(width, depths[1], count, 0, depths[0], True, fit, corners),
            lambda g: g.cutfingers(width, depths[0], count, 0, depths[1], False, fit, corners),
        ]
        given = (tool, width, depths, count, fit, corners)
        boards = both(cuts, tool)
        if boards is None:
            continue
        accepted += 1
        along = [width * (k + 0.5) / 181 for k in range(181)]
        first = lengths(boards[0], depths[1], depths[0], size / 2, along)
        second = lengths(boards[1], depths[0], depths[1], size / 2, along)
        shared = sum(a * b for a, b in zip(first, second)) / (depths[0] * depths[1]) * width / 181
        pressed = max(0.0, -2 * fit) * (count - 1)  # mm of all flanks together
        assert shared <= pressed + 0.03 + width / 181 * (2 if fit < 0 else 0.01), given
        # Each board has its fingers.
        wanted = [(int(x / width * count) % 2 == 0) for x in along]
        full = [a > 0.5 * depths[1] for a in first]
        agree = sum(a == b for a, b in zip(full, wanted)) / 181
        assert agree > 1 - (2 * abs(fit) + 1.2 * size) * (count - 1) / 2 / width - 0.02, given
    assert accepted > TRIALS / 4

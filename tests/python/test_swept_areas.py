"""What operations sweep on random regions, measured with shapely: nothing that the tool reaches is left, and
nothing beyond the region is touched. KERF_REGIONS is the number of regions (2000: a full run), KERF_SEED the
first.

A disc of the tool's radius, at fine chords, is swept along the cuts. What it reaches is the opening of
the region.
"""
import math
import os
import random
import re
import warnings

import numpy as np
import pytest
import shapely
from shapely.geometry import LineString, Point, Polygon, box
from shapely.ops import unary_union

import kerf

COUNT = int(os.environ.get("KERF_REGIONS", "6"))
SEED = int(os.environ.get("KERF_SEED", "1"))
CHORD = 5e-4     # mm, of flattened arcs
TOUCHED = 0.004  # mm that a cut may be beyond a wall: chords here, and the tolerance of offsets
SPARED = 0.006   # mm of which all must be left around a point, that it counts
AREA = 0.02      # mm2 that may be left, in pieces of that width


def random_region(rng):
    """Rectangles, circles and polygons, some of them holes; in pieces, with necks and islands."""
    def shape():
        x, y, size = rng.uniform(-18, 18), rng.uniform(-18, 18), rng.uniform(3, 14)
        kind = rng.random()
        if kind < 0.35:
            w, h = size, rng.uniform(0.15, 1) * size
            return kerf.Region([[(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)]])
        if kind < 0.6:
            return kerf.Region([(x, y, size / 2)])
        turns = sorted(rng.uniform(0, 2 * math.pi) for _ in range(rng.randint(3, 9)))
        points = [(x + size * rng.uniform(0.3, 1) * math.cos(a), y + size * rng.uniform(0.3, 1) * math.sin(a))
                  for a in turns]
        return kerf.Region([[*points, points[0]]])

    region = shape()
    for _ in range(rng.randint(1, 6)):
        region = region | shape() if rng.random() < 0.65 else region - shape()
    return region if region.area > 30 else random_region(rng)


def polygon_of(region):
    def ring(outline):
        return shapely.make_valid(Polygon(kerf.flattened(outline, CHORD)))
    return unary_union([ring(f[0]) - unary_union([ring(h) for h in f[1:]]) for f in region.figures()])


def grown(shape, by):
    return shape.buffer(by, quad_segs=48)


def opened(shape, radius):
    return grown(grown(shape, -radius), radius)


def arc_points(start, step):
    """Points of an arc about its centre, by its turns."""
    (x0, y0, z0), (x1, y1, z1), (cx, cy) = start, step["to"], step["centre"]
    radius = math.hypot(x0 - cx, y0 - cy)
    first, last = math.atan2(y0 - cy, x0 - cx), math.atan2(y1 - cy, x1 - cx)
    sign = 1 if step["turn"] == "ccw" else -1
    sweep = (last - first) * sign % (2 * math.pi)
    if sweep < 1e-9:
        sweep += 2 * math.pi
    sweep += 2 * math.pi * step.get("extra_turns", 0)
    n = max(int(math.ceil(sweep / math.acos(max(1 - CHORD / radius, 0.5)) / 2)), 1)
    angles = [first + sign * sweep * i / n for i in range(1, n)]
    return [(cx + radius * math.cos(a), cy + radius * math.sin(a), z0 + (z1 - z0) * i / n)
            for i, a in enumerate(angles, 1)] + [tuple(step["to"])]


def cuts_of(program):
    """The cuts as polylines of points in space."""
    here, lines = None, []
    for step in program.toolpath:
        if step["step"] not in ("rapid", "cut", "arc"):
            continue
        if step["step"] != "rapid":
            lines.append([here] + ([tuple(step["to"])] if step["step"] == "cut" else arc_points(here, step)))
        here = tuple(step["to"])
    return lines


def swept(lines, radius, low=None):
    """The area below the discs, of those cuts that are at or below `low`."""
    paths = []
    for line in lines:
        flat = [p[:2] for p in line if low is None or p[2] <= low]
        if len(flat) < len(line) and low is not None and len(flat) < 2:
            continue
        # In parts: GEOS takes minutes for a helix of several turns.
        for part in (flat[i:i + 60] for i in range(0, max(len(flat) - 1, 1), 59)):
            paths.append(LineString(part) if len(set(part)) > 1 else Point(part[0]))
    discs = [grown(path, radius) for path in paths]
    whole = unary_union(discs)
    shapely.prepare(whole)
    inside = [grown(path, radius - 1e-3) for path in paths]
    edges = shapely.get_coordinates(shapely.segmentize(inside, radius))[::2]
    if not shapely.contains_xy(whole, edges).all():
        # GEOS 3.14 lost strips whose edges are nearly the same; on a grid it has them.
        whole = shapely.union_all(discs, grid_size=1e-6)
    return whole


def check(what, wanted, allowed, bottom, all_cuts):
    left = grown(wanted - bottom, -SPARED)
    assert left.area < AREA, f"{what}: {left.area:.4f} mm2 are left at {left.representative_point().wkt}"
    beyond = grown(all_cuts - grown(allowed, TOUCHED), -1e-4)
    assert beyond.is_empty or beyond.area < 1e-4, \
        f"{what}: {beyond.area:.5f} mm2 beyond the walls at {beyond.representative_point().wkt}"


def run_of(operation, *arguments, **keys):
    """Nothing where the tool does not fit in at all, which is an error."""
    try:
        return operation(*arguments, feed=600, **keys)
    except kerf.Error as error:
        assert any(text in str(error) for text in ("too wide", "does not fit", "does not keep")), str(error)
        return None


def numbers():
    return range(SEED, SEED + COUNT)


@pytest.mark.parametrize("pattern", ["offset", "spiral", "zigzag", "adaptive"])
def test_pockets(pattern):
    for seed in numbers():
        rng = random.Random(f"pocket {seed}")
        region, d = random_region(rng), rng.choice([1, 2, 3.175])
        keys = dict(pattern=pattern, stepdown=rng.choice([0, 0.8]),
                    direction=rng.choice(["climb", "conventional"]),
                    entry=rng.choice(["helix", "ramp", "plunge"]), finish=rng.choice([0, 0.2]),
                    angle=rng.choice([0, 30]) if pattern == "zigzag" else 0, stepover=rng.choice([0.4, 0.7]))
        program = run_of(kerf.op.pocket, region, f"square d={d} flute=9", depth=1.5, **keys)
        shape = polygon_of(region)
        reach = {"adaptive": 0.5 * d * 1.13}.get(pattern, 0.5 * d + 0.002)
        if program is None:
            assert opened(shape, reach).area < AREA, f"pocket {seed}: refused"
            continue
        lines = cuts_of(program)
        check(f"pocket {seed} {pattern} d={d} {keys}", opened(shape, reach), shape,
              swept(lines, d / 2, -1.5 + 1e-6), swept(lines, d / 2, 0))


# Thin parts beside wide ones, for which the largest tool had 0 mm.
THIN = (2023, 2063, 2098, 2138, 2181, 2218)


def test_the_largest_tool_for_a_narrow_part():
    """It touches the walls at the position that the warning gives."""
    for seed in (*THIN, *numbers()):
        rng = random.Random(f"pocket {seed}")
        region, d = random_region(rng), rng.choice([1, 2, 3.175])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            if run_of(kerf.op.pocket, region, f"square d={d} flute=9", depth=1.5) is None:
                continue
        for text in (str(warning.message) for warning in caught):
            found = re.search(r"at (\S+), (\S+); the largest that fits there has (\S+) mm", text)
            assert found, text
            x, y, fits = map(float, found.groups())
            radius = polygon_of(region).boundary.distance(Point(x, y))
            assert 0.002 < fits < d, f"{seed}: {text}"
            assert 2 * radius == pytest.approx(fits, rel=0.01, abs=0.002), f"{seed}: {text}"


@pytest.mark.parametrize("side", ["inside", "outside"])
def test_contours(side):
    for seed in numbers():
        rng = random.Random(f"contour {seed}")
        region, d = random_region(rng), rng.choice([1, 2, 3.175])
        tabs = dict(tab_height=0.5, tab_length=2, tabs=3) if rng.random() < 0.4 else {}
        keys = dict(side=side, stepdown=rng.choice([0, 0.6]),
                    direction=rng.choice(["climb", "conventional"]), entry=rng.choice(["ramp", "plunge"]),
                    finish=rng.choice([0, 0.15]), lead=rng.choice([0, 0.8, 2]),
                    lead_kind=rng.choice(["arc", "line"]), overlap=rng.choice([0, 1]), **tabs)
        program = run_of(kerf.op.contour, region, f"square d={d} flute=9", depth=1.5, **keys)
        shape = polygon_of(region)
        free = shape if side == "inside" else box(-99, -99, 99, 99) - shape
        open_area = opened(free, d / 2 + 0.002)
        if program is None:
            assert open_area.area < AREA, f"contour {seed}: refused"
            continue
        lines = cuts_of(program)
        # Beside the walls that the tool reaches, as wide as half its radius.
        band = open_area & grown(shape.boundary, d / 4)
        low = (-1.0 if tabs else -1.5) + 1e-6  # the top of tabs, or the bottom
        check(f"contour {seed} d={d} {keys}", band, free, swept(lines, d / 2, low), swept(lines, d / 2, 0))


def test_isolation():
    for seed in numbers():
        rng = random.Random(f"isolation {seed}")
        region, d, passes = random_region(rng), rng.choice([0.4, 0.8]), rng.choice([1, 2, 3])
        overlap = rng.choice([0.3, 0.5])
        program = run_of(kerf.op.isolation, region, f"square d={d} flute=3", depth=0.1, passes=passes,
                         overlap=overlap)
        shape = polygon_of(region)
        free = box(-99, -99, 99, 99) - shape
        width = d + (passes - 1) * d * (1 - overlap)
        lines = cuts_of(program)
        wanted = opened(free, d / 2 + 0.002) & grown(shape, width - 0.02)
        check(f"isolation {seed} d={d} passes={passes} overlap={overlap}", wanted, free,
              swept(lines, d / 2, -0.1 + 1e-6), swept(lines, d / 2, 0))


@pytest.mark.parametrize("passes", [1, 2, 3, 4, 5, 6, 7])
@pytest.mark.parametrize("overlap", [0, 0.25, 0.5, 0.6])
def test_the_rings_of_isolation_overlap_as_asked(passes, overlap):
    """Beside a straight edge: the first ring is a radius away, neighbours are at most a step apart."""
    d = 0.4
    board = kerf.Region([[(0, 0), (20, 0), (20, 10), (0, 10), (0, 0)]])
    program = run_of(kerf.op.isolation, board, f"square d={d} flute=3", depth=0.1, passes=passes,
                     overlap=overlap)
    low = [[(x, y) for x, y, z in line] for line in cuts_of(program) if max(p[2] for p in line) < -0.09]
    ray = LineString([(20, 5.3), (40, 5.3)])
    crossed = unary_union([LineString(line) for line in low if len(line) > 1]).intersection(ray)
    at = sorted({round(p.x - 20, 3) for p in getattr(crossed, "geoms", [crossed])})
    step = d * (1 - overlap)
    assert at[0] == pytest.approx(d / 2, abs=0.003)
    assert at[-1] == pytest.approx(d / 2 + (passes - 1) * step, abs=0.003)
    assert max((b - a for a, b in zip(at, at[1:])), default=0) <= step + 0.002


def coned(program, tangent, z, quad_segs=48):
    """The area that a cone removes at the height `z`."""
    pairs = []
    for line in cuts_of(program):
        for a, b in zip(line, line[1:]):
            low, high = (a, b) if a[2] < b[2] else (b, a)
            if low[2] >= z:
                continue
            part = min((z - low[2]) / (high[2] - low[2]), 1) if high[2] > low[2] else 1
            pairs.append((low, tuple(p + (q - p) * part for p, q in zip(low, high))))
    ends = np.array(pairs, dtype=float).reshape(-1, 2, 3)
    radii = np.maximum((z - ends[:, :, 2]) * tangent, 1e-6)
    discs = shapely.buffer(shapely.points(ends[:, :, :2]), radii, quad_segs=quad_segs)
    return unary_union(shapely.convex_hull(shapely.geometrycollections(discs)))


CARVED = 0.006  # mm across a wall: the tolerance of carving, and chords of the discs here
# Axes that ended before the centre of a circle: 1.76 mm, 0.026 mm and 0.038 mm were left.
ENDED_EARLY = (21, 43, 107)


def test_carving():
    tangent = math.tan(math.radians(30))
    for seed in (*ENDED_EARLY, *numbers()):
        region = random_region(random.Random(f"vcarve {seed}"))
        program = run_of(kerf.op.v_carve, region, "V d=40 angle=60")
        shape = polygon_of(region)
        for depth in (0, 0.4, 2):
            wanted, cut = grown(shape, -depth * tangent), coned(program, tangent, -depth)
            left = grown(grown(wanted, -CARVED) - cut, -1e-4)
            beyond = grown(cut - grown(wanted, CARVED), -1e-4)
            for what, part in (("left", left), ("cut too wide", beyond)):
                assert part.area < 1e-6, \
                    f"vcarve {seed}, {depth} mm deep: {what} at {part.representative_point().wkt}"


def random_line(rng):
    """An open line that may cross itself, of straight parts longer than a tool."""
    points, heading = [(rng.uniform(-20, 20), rng.uniform(-20, 20))], rng.uniform(0, 2 * math.pi)
    for _ in range(rng.randint(1, 6)):
        heading += rng.uniform(-2.2, 2.2)
        length = rng.uniform(6, 20)
        x, y = points[-1]
        points.append((x + length * math.cos(heading), y + length * math.sin(heading)))
    return points


def lengthened(points, by):
    def beyond(a, b):
        part = by / math.dist(a, b)
        return (b[0] + part * (b[0] - a[0]), b[1] + part * (b[1] - a[1]))
    return LineString([beyond(points[1], points[0]), *points, beyond(points[-2], points[-1])])


# Lines that end beside themselves or cross there: up to 4.9 mm2 were left; passes ended inside the slot.
# Of 2494, a straight line, GEOS loses a strip (`swept`).
NEAR_THEMSELVES = (2085, 2384, 2387, 2445, 2463, 2494)


def check_slot(what, points, d, **keys):
    """All within half the width is cut, with round ends, and passes start beyond the ends."""
    program = run_of(kerf.op.slot, [points], f"square d={d} flute=9", depth=1.5, **keys)
    half, line = keys["width"] / 2, LineString(points)
    # It comes from outside, down a slope as long as it is deep.
    beyond = max(0.6 * d, half)
    allowed = grown(lengthened(points, beyond + max(1.5, d / 2)), half)
    lines = cuts_of(program)
    check(f"{what} d={d} {keys}", grown(line, half - 0.002), allowed, swept(lines, d / 2, -1.5 + 1e-6),
          swept(lines, d / 2, 0))
    ends = [Point(points[0]), Point(points[-1])]
    for x, y, _ in (b for line in lines for a, b in zip(line, line[1:]) if a[2] > b[2]):
        away = min(end.distance(Point(x, y)) for end in ends)
        assert away < math.hypot(beyond, half) + 0.003, f"{what}: goes down at {x}, {y}"


def test_slots():
    for seed in (*NEAR_THEMSELVES, *numbers()):
        rng = random.Random(f"slot {seed}")
        points, d = random_line(rng), rng.choice([1, 2, 3.175])
        keys = dict(width=d * rng.choice([1, 1.3, 2, 3.1]), stepover=rng.choice([0.4, 0.7]),
                    direction=rng.choice(["climb", "conventional"]))
        check_slot(f"slot {seed}", points, d, **keys)


@pytest.mark.parametrize("stepover", [0.4, 0.7, 0.9, 1])
@pytest.mark.parametrize("turn", [30, 90, 135, 160, 175])
def test_slots_around_corners(turn, stepover):
    """At sharp corners the tips of passes are farther apart than the passes are."""
    a = math.radians(turn)
    points = [(-30, 0), (0, 0), (30 * math.cos(a), 30 * math.sin(a))]
    for direction in ("climb", "conventional"):
        for width in (4, 6.5, 9):
            check_slot(f"{turn} degrees", points, 2, width=width, stepover=stepover, direction=direction)


def test_trochoidal_slots():
    for seed in numbers():
        rng = random.Random(f"trochoidal {seed}")
        points, d = random_line(rng), rng.choice([1, 2, 3.175])
        width = d * rng.choice([1.4, 2, 3])
        program = run_of(kerf.op.trochoidal_slot, [points], f"square d={d} flute=9", depth=1.5, width=width)
        if program is None:
            continue
        slot = grown(LineString(points), width / 2)
        lines = cuts_of(program)
        check(f"trochoidal {seed} d={d} width={width}", opened(slot, 0.5 * d * 1.13), slot,
              swept(lines, d / 2, -1.5 + 1e-6), swept(lines, d / 2, 0))


def random_outlines(rng):
    """Closed outlines that overlap, as a drawing without fills has them."""
    outlines = []
    for _ in range(rng.randint(2, 6)):
        x, y, size = rng.uniform(-12, 12), rng.uniform(-12, 12), rng.uniform(5, 16)
        if rng.random() < 0.5:
            w, h = size, rng.uniform(0.3, 1) * size
            outlines.append([(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)])
        else:
            n = rng.randint(3, 8)
            ring = [(x + size / 2 * math.cos(2 * math.pi * k / n + x),
                     y + size / 2 * math.sin(2 * math.pi * k / n + x)) for k in range(n)]
            outlines.append([*ring, ring[0]])
    return outlines


@pytest.mark.parametrize("combine", ["drawn", "nested", "united"])
def test_outlines_without_fill_that_overlap(combine):
    for seed in numbers():
        rng = random.Random(f"overlap {seed}")
        outlines, d = random_outlines(rng), rng.choice([1, 2])
        shape = Polygon()
        for outline in outlines:
            part = Polygon(outline)
            shape = shape | part if combine == "united" else shape ^ part
        program = run_of(kerf.op.pocket, outlines, f"square d={d} flute=9", depth=1.5, combine=combine)
        if program is None:
            assert opened(shape, d / 2 + 0.002).area < AREA, f"overlap {seed}: refused"
            continue
        lines = cuts_of(program)
        check(f"overlap {seed} {combine} d={d}", opened(shape, d / 2 + 0.002), shape,
              swept(lines, d / 2, -1.5 + 1e-6), swept(lines, d / 2, 0))

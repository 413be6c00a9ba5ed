"""Kerf's regions against shapely (GEOS) on flattened copies of random ones.

    PYTHONPATH=build/python build/venv/bin/python tests/python/region_shapely.py [COUNT] [SEED]

Prints the seed, and each region that differs by more than flattening explains, as arguments that repeat it.
Exit status 1 if any does.
"""
import math
import random
import sys

import shapely
from shapely.geometry import LineString, Polygon
from shapely.ops import unary_union

import kerf

CHORD = 1e-3  # mm, of flattened arcs
GRID = 1e-7  # mm; without, GEOS now and then takes a part of nearly equal polygons for their difference


def random_outline(rng, size, on_grid):
    """A simple or self-crossing closed outline of lines and arcs."""
    def random_point():
        x, y = rng.uniform(-size, size), rng.uniform(-size, size)
        return (round(x), round(y)) if on_grid else (x, y)
    points = [random_point() for _ in range(rng.randint(3, 9))]
    outline = points[:1]
    for x, y in points[1:] + points[:1]:
        x0, y0 = outline[-1][-2:]
        if (x, y) == (x0, y0):
            continue
        if rng.random() < 0.5:
            bulge = rng.choice([-1, 1]) * (1 if on_grid else math.exp(rng.uniform(-4, 1)))
            outline.append(((x0 + x) / 2 + bulge * (y - y0) / 2, (y0 + y) / 2 - bulge * (x - x0) / 2, x, y))
        else:
            outline.append((x, y))
    return outline if len(outline) > 2 else random_outline(rng, size, on_grid)


def areas_of(geometry):
    """The areas of what shapely made: where shapes touch, it also gives lines and points."""
    return unary_union([part for part in shapely.get_parts(geometry) if part.area > 0])


def polygon_of(region):
    """A shapely polygon of a region, arcs as chords."""
    def ring(outline):  # chords may cross where arcs only touch
        return areas_of(shapely.make_valid(Polygon(kerf.flattened(outline, CHORD))))
    return areas_of(unary_union([ring(figure[0]) - unary_union([ring(hole) for hole in figure[1:]])
                                 for figure in region.figures()]))


def edge_of(region):
    """The outlines as lines: figures thinner than a chord's error are there too, which a polygon loses."""
    def line(outline):
        points = kerf.flattened(outline, CHORD)
        return LineString([*points, points[0]])
    return unary_union([line(outline) for figure in region.figures() for outline in figure])


def differences(rng):
    """What differs between Kerf and shapely for one random pair of regions."""
    on_grid = rng.random() < 0.3
    size = 8 if on_grid else math.exp(rng.uniform(1.5, 4.5))
    a, b = (kerf.Region([random_outline(rng, size, on_grid) for _ in range(rng.randint(1, 2))],
                        fill=rng.choice(["even_odd", "nonzero"])) for _ in range(2))
    flat_a, flat_b = polygon_of(a), polygon_of(b)
    found = []

    def compare(name, made, given, slack):
        expected = areas_of(given)
        if not abs(made.area - expected.area) <= slack:
            found.append(f"{name}: area {made.area} is {expected.area} for shapely, allowed {slack:.2g}")
        beyond = shapely.symmetric_difference(polygon_of(made), expected, grid_size=GRID).area
        if not beyond <= slack:
            found.append(f"{name}: {beyond} of area differs from shapely, allowed {slack:.2g}")

    slack = 3 * CHORD * (a.length + b.length) + 1e-6
    compare("a", a, flat_a, slack)
    compare("a | b", a | b, shapely.union(flat_a, flat_b, grid_size=GRID), slack)
    compare("a & b", a & b, shapely.intersection(flat_a, flat_b, grid_size=GRID), slack)
    compare("a - b", a - b, shapely.difference(flat_a, flat_b, grid_size=GRID), slack)
    compare("a ^ b", a ^ b, shapely.symmetric_difference(flat_a, flat_b, grid_size=GRID), slack)
    distance = rng.uniform(0.01, 0.3) * size * rng.choice([-1, 1])
    grown = a.offset(distance)
    # An eighth of a turn in 64 chords misses the circle by 0.02% of the radius.
    edge = edge_of(a).buffer(abs(distance), quad_segs=128)
    expected = flat_a | edge if distance > 0 else flat_a - edge
    compare(f"offset by {distance}", grown, expected,
            4 * (CHORD + 1e-4 * abs(distance)) * (grown.length + a.length) + 1e-6)
    return found


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(10**9)
    print(f"{count} random regions, seed {seed}, shapely {shapely.__version__}, "
          f"GEOS {shapely.geos_version_string}", flush=True)
    failed = 0
    for i in range(count):
        found = differences(random.Random(seed + i))
        for text in found:
            print(f"1 {seed + i}: {text}", flush=True)
        failed += bool(found)
    print(f"{failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())

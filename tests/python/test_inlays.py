"""The two parts of an inlay, put together: sections of what the tools have left of both, at several heights,
do not overlap by more than 0.01 mm. KERF_REGIONS is the number of random regions, KERF_SEED the first.

The sections are made by shapely from the cuts: discs of the tools' radius at that height, swept along them.
"""
import math
import random

import pytest
import shapely
from shapely.affinity import scale, translate
from shapely.geometry import LineString, Polygon
from shapely.ops import unary_union

import kerf
from test_swept_areas import COUNT, SEED, coned, cuts_of, grown, polygon_of, random_region

TANGENT = math.tan(math.radians(30))
VEE = kerf.Tool("V d=40 angle=60", 2)
DEPTH = 3
OVERLAP = 0.01  # mm, in a section: twice the tolerance of a carved wall
STAR = [(r * math.cos(k * math.pi / 5), r * math.sin(k * math.pi / 5)) for k, r in enumerate([8, 20] * 5)]
LEAF = [(0, 0), (9, 4), (19, 3), (30, 0), (18, -3), (8, -3.5)]


class Part:
    """What both tools remove of one part, by the height above the floor."""

    def __init__(self, region, mill, **keys):
        clearing = kerf.Tool(f"square d={mill} flute=9", 1)
        self.walls = kerf.op.v_carve(region, VEE, depth=DEPTH, feed=900, floor_tool=clearing, **keys)
        self.floor = Polygon()
        try:
            made = kerf.op.v_carve_floor(region, clearing, depth=DEPTH, feed=900, carve_tool=VEE,
                                         stepover=0.8, **keys)
        except kerf.Error as error:  # no floor, or none that the mill fits in
            refused = ("too wide", "does not fit", "encloses nothing")
            assert any(text in str(error) for text in refused), str(error)
            return
        lines = cuts_of(made)
        bottom = min(p[2] for line in lines for p in line)
        flat = [[p[:2] for p in line] for line in lines if max(p[2] for p in line) < bottom + 1e-6]
        self.floor = unary_union(shapely.buffer([LineString(line) for line in flat], mill / 2, quad_segs=16))

    def removed(self, z):
        return coned(self.walls, TANGENT, z, 16) | self.floor


def overlaps(region, mill, glue_gap, base_gap):
    """Where the two parts have more than OVERLAP in common: height and position."""
    shape = polygon_of(region)
    low, _, high, _ = shape.bounds
    pocket = Part(region, mill)
    plug = Part(region, mill, part="plug", glue_gap=glue_gap, base_gap=base_gap, margin=3)
    face = -DEPTH + glue_gap
    found = []
    for z in (face + 0.01, face + 0.3, -1.5, -0.01):
        of_plug = translate(scale(plug.removed(face - z), -1, 1, origin=(0, 0)), low + high, 0)
        common = grown(grown(shape, 1) - pocket.removed(z) - of_plug, -OVERLAP / 2)
        if not common.is_empty:
            found.append((z, common.area, common.representative_point().wkt))
    return found


@pytest.mark.parametrize("outline", [STAR, LEAF], ids=["star", "leaf"])
@pytest.mark.parametrize("mill, glue_gap, base_gap", [(1, 0.1, 0.1), (3, 0.4, 0.5)])
def test_a_plug_sits_in_the_corners_of_its_pocket(outline, mill, glue_gap, base_gap):
    assert overlaps(kerf.Region([[*outline, outline[0]]]), mill, glue_gap, base_gap) == []


def test_random_plugs():
    for seed in range(SEED, SEED + max(COUNT // 3, 1)):
        rng = random.Random(f"inlay {seed}")
        region = random_region(rng)
        mill, glue_gap, base_gap = rng.choice([1, 2, 3]), rng.choice([0.1, 0.4]), rng.choice([0.1, 0.5])
        assert overlaps(region, mill, glue_gap, base_gap) == [], seed

"""kerf.Region and its companions: comparison with shapely, known shapes, bad input."""
import math
import random

import pytest

import kerf

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)]
NAN = math.nan


def test_shapely_agrees_on_random_regions():
    pytest.importorskip("shapely", reason="shapely is not installed; skipped")
    from region_shapely import differences
    seed = 20261121  # `./dev test --long` draws others
    for i in range(200):
        found = differences(random.Random(seed + i))
        assert not found, f"seed {seed + i}: {found}"


def test_operators_are_those_of_sets():
    square, disc = kerf.Region([SQUARE]), kerf.Region([(10, 10, 4)])
    quarter = math.pi * 4
    assert (square | disc).area == pytest.approx(100 + 3 * quarter, abs=1e-10)
    assert (square & disc).area == pytest.approx(quarter, abs=1e-10)
    assert (square - disc).area == pytest.approx(100 - quarter, abs=1e-10)
    assert (square ^ disc).area == pytest.approx(100 + 2 * quarter, abs=1e-10)
    assert not (square & kerf.Region([(50, 50, 1)]))
    assert kerf.Region().bounds is None


def test_a_region_answers_questions():
    ring = kerf.Region([(0, 0, 10), (0, 0, 4)], fill="even_odd")
    assert len(ring.outlines) == 2 and len(ring.figures()) == 1
    assert ring.locate((7, 0)) == "inside"
    assert ring.locate((0, 0)) == "outside"
    assert ring.locate((0, 10.01), margin=0.1) == "boundary"
    assert ring.nearest((6, 0)) == pytest.approx((4, 0, 2))
    assert ring.bounds == pytest.approx((-10, -10, 10, 10))
    assert ring.length == pytest.approx(28 * math.pi)
    assert ring.offset(-2).area == pytest.approx(math.pi * (64 - 36))


def test_questions_for_operations():
    plate = kerf.Region([SQUARE, (5, 5, 2)], fill="even_odd")
    assert plate.locate([(1, 1), (5, 5), (10, 3)]) == ["inside", "outside", "boundary"]
    assert plate.nearest([(5, 1), (12, 5)])[1] == pytest.approx((10, 5, 2))
    assert plate.clearance((1, 5)) == pytest.approx(1)
    assert plate.clearance([(5, 5), (5, -3)]) == pytest.approx([-2, -3])
    assert plate.engagement((5, -2, 3), (1, 0)) == pytest.approx(math.degrees(math.acos(1 - 1 / 3)))
    assert plate.inside((0, 0, 1)) == [pytest.approx((0, 90))]
    outer = 0 if kerf.Region([plate.outlines[0]]).area > 50 else 1
    assert plate.nesting()[outer] == (None, 0) and plate.nesting()[1 - outer] == (outer, 1)
    assert plate.distance(kerf.Region([(14, 5, 1)])) == (pytest.approx(3), pytest.approx((10, 5)),
                                                         pytest.approx((13, 5)))
    assert plate.distance(kerf.Region()) is None and kerf.Region().clearance((0, 0)) is None
    pieces = plate.divide([(-1, 5), (11, 5)])
    assert [piece[0] for piece in pieces] == ["outside", "inside", "outside", "inside", "outside"]
    assert plate.clip([(-1, 5), (11, 5)]) == [[pytest.approx((0, 5)), pytest.approx((3, 5))],
                                              [pytest.approx((7, 5)), pytest.approx((10, 5))]]


def test_medial_axis():
    nodes, edges = kerf.Region([[(0, 0), (20, 0), (20, 10), (0, 10), (0, 0)]]).medial_axis()
    assert len(nodes) == 6 and len(edges) == 5
    assert max(radius for _, _, radius in nodes) == pytest.approx(5)
    for first, last, points in edges:
        assert points[0] == nodes[first] and points[-1] == nodes[last]
    x, y, radius = kerf.Region([[(0, 0), (4, 0), (0, 3), (0, 0)]]).largest_circle()
    assert (x, y, radius) == pytest.approx((1, 1, 1))
    assert kerf.Region().largest_circle() is None


def test_offsets_with_mitres_and_sources():
    square = kerf.Region([SQUARE])
    assert square.offset(1, join="mitre").area == pytest.approx(144)
    grown, sources = square.offset_with_sources(1)
    assert len(sources[0]) == len(grown.outlines[0]) - 1 == 8
    assert sum(corner for _, _, corner in sources[0]) == 4
    with pytest.raises(ValueError, match="unknown join"):
        square.offset(1, join="bevel")


def test_transforms_of_regions():
    square = kerf.Region([SQUARE])
    assert square.moved(5, -2).bounds == pytest.approx((5, -2, 15, 8))
    assert square.rotated(90).bounds == pytest.approx((-10, 0, 0, 10))
    assert square.rotated(90, about=(10, 10)).bounds == pytest.approx((10, 0, 20, 10))
    assert square.scaled(2).area == pytest.approx(400)
    mirrored = square.scaled((-1, 1))
    assert mirrored.bounds == pytest.approx((-10, 0, 0, 10)) and mirrored.area == pytest.approx(100)
    both = square | kerf.Region([[(10, 0), (20, 0), (20, 10), (10, 10), (10, 0)]])
    assert len(both.merged().outlines[0]) == 5


def test_segments_and_points_of_paths():
    line, arc = kerf.segments([(0, 0), (10, 0), (10 + math.sqrt(2), 2 - math.sqrt(2), 12, 2)])
    assert line["kind"] == "line" and line["length"] == 10 and "radius" not in line
    assert arc["centre"] == pytest.approx((10, 2)) and arc["radius"] == pytest.approx(2)
    assert arc["turn"] == "ccw" and arc["sweep"] == pytest.approx(90)
    path = [(0, 0), (10, 0), (10, 10)]
    assert kerf.point_at(path, 4) == pytest.approx((4, 0, 1, 0))
    assert kerf.point_at(path, [15, 99]) == [pytest.approx((10, 5, 0, 1)), pytest.approx((10, 10, 0, 1))]


def test_paths():
    assert kerf.widen([(0, 0), (10, 0)], 1).area == pytest.approx(20 + math.pi)
    assert kerf.widen([(0, 0), (10, 0)], 1, ends="butt").area == pytest.approx(20)
    assert kerf.parallel([(0, 0), (10, 0)], 2) == [[(0, 2), (10, 2)]]
    assert kerf.self_meetings([(0, 0), (4, 4), (4, 0), (0, 4)]) == [(2, 2, 0, 2)]


def test_a_circle_is_a_path():
    circle = (1, 2, 5)
    assert kerf.widen(circle, 1).area == pytest.approx(math.pi * (36 - 16))
    assert kerf.widen(list(circle), 6).area == pytest.approx(math.pi * 121)
    inner, outer = kerf.parallel(circle, 2), kerf.parallel(circle, -2)  # counter-clockwise: left is inside
    assert kerf.Region(inner).area == pytest.approx(math.pi * 9)
    assert kerf.Region(outer).area == pytest.approx(math.pi * 49)
    assert kerf.self_meetings(circle) == []
    points = kerf.flattened(circle, 0.01)
    assert points[0] == points[-1] and len(points) > 16
    assert all(math.hypot(x - 1, y - 2) == pytest.approx(5) for x, y in points)
    for path in [(0, 0, 0), (0, 0, -1), (0, 0, NAN), (0, 0), (0, 0, 1, 2)]:
        for call in (kerf.widen, kerf.parallel, kerf.flattened):
            with pytest.raises(ValueError):
                call(path, 1)
        with pytest.raises(ValueError):
            kerf.self_meetings(path)


@pytest.mark.parametrize("call, words", [
    (lambda r: kerf.widen(SQUARE, -1), "must be above 0"),
    (lambda r: kerf.widen(SQUARE, 0), "must be above 0"),
    (lambda r: kerf.parallel(SQUARE, 0), "must not be 0"),
    (lambda r: r.offset(1e300), "must be a number within 1e60 of 0, not 1e\\+300"),
    (lambda r: kerf.widen(SQUARE, 1e300), "must be a number within 1e60 of 0, not 1e\\+300"),
    (lambda r: r.offset(1, tolerance=1e300), "must be from 0 to 1e60, not 1e\\+300"),
    (lambda r: kerf.fit_arcs(SQUARE, 1e300), "must be above 0 and at most 1e60, not 1e\\+300"),
    (lambda r: kerf.fit_bezier(SQUARE, math.inf), "must be above 0 and at most 1e60, not inf"),
    (lambda r: kerf.fit_bezier([(0, 0), (1e300, 0)], 1), "point 1: a number is not finite or beyond 1e60"),
], ids=range(9))
def test_a_bad_number_is_reported_with_its_range(call, words):
    with pytest.raises((kerf.Error, ValueError), match=words):
        call(kerf.Region([SQUARE]))


def test_curves_become_arcs():
    circle = [(math.cos(a / 50 * math.pi), math.sin(a / 50 * math.pi)) for a in range(101)]
    assert len(kerf.fit_arcs(circle, 0.01)) <= 5
    assert kerf.fit_bezier([(0, 0), (10, 10), (20, 0)], 0.01)[-1][-2:] == pytest.approx((20, 0))
    spline = kerf.fit_spline([(0, 0), (1, 2), (3, 2), (4, 0)], [0, 0, 0, 0, 1, 1, 1, 1], within=0.001)
    assert spline[0] == (0, 0)
    assert spline[-1][-2:] == pytest.approx((4, 0))
    # A clamped spline of one span is a Bezier curve: its points by Bernstein's formula.
    curve = [(3 * t * (1 - t) ** 2 * 1 + 3 * t * t * (1 - t) * 3 + t ** 3 * 4,
              3 * t * (1 - t) ** 2 * 2 + 3 * t * t * (1 - t) * 2) for t in (k / 5000 for k in range(5001))]
    ends = [segment[-2:] for segment in spline]
    assert len(ends) > 3
    assert all(min(math.dist(end, point) for point in curve) < 0.0015 for end in ends)
    assert all(math.hypot(*p) == pytest.approx(1) for p in kerf.flattened([(1, 0), (0, 1, -1, 0)], 0.1))


class Endless:
    """A sequence that says it has more than it gives."""

    def __len__(self):
        return 5

    def __getitem__(self, index):
        raise IndexError(index)


@pytest.mark.parametrize("outlines", [
    None, 5, "square", [5], [[]], [["ab"]], [[(0, 0), "to"]], [[(0, 0), (1,)]], [[(0, 0), (1, 2, 3)]],
    [[(0, 0), None]], [[(0, 0), ((1, 2), (3, 4))]], [[[[[]]]]], [{}], [[(0, 0), {1: 2, 3: 4}]], [(1, 2)],
    [(1, 2, 3, 4)], [(0, 0, -1)],
    [(0, 0, NAN)], [[(0, 0), (1, 0), (NAN, 1), (0, 0)]], [[(0, 0), (1, 0), (math.inf, 1), (0, 0)]],
    [[(0, 0), (1e300, 0), (0, 1), (0, 0)]], [[(0, 0), (1, 0), (1, 1)]], [SQUARE, [(0, 0), (0, 0)]], Endless(),
    [Endless()], [[(0, 0), Endless()]], [[(0, 0), (10 ** 400, 0), (0, 0)]],
], ids=repr)
def test_bad_outlines_are_refused(outlines):
    with pytest.raises((kerf.Error, TypeError, ValueError, IndexError, OverflowError)):
        kerf.Region(outlines)


@pytest.mark.parametrize("call", [
    lambda r: r.offset(NAN),
    lambda r: r.offset(math.inf),
    lambda r: r.offset("1"),
    lambda r: r.offset(1, tolerance=-1),
    lambda r: r.offset(1, tolerance=NAN),
    lambda r: r.locate((1,)),
    lambda r: r.locate((NAN, 1)),
    lambda r: r | 5,
    lambda r: r.nearest("ab"),
    lambda r: kerf.Region([SQUARE], fill="odd"),
    lambda r: kerf.widen(SQUARE, 0),
    lambda r: kerf.widen(SQUARE, -1),
    lambda r: kerf.widen([(0, 0)], 1),
    lambda r: kerf.widen(SQUARE, 1, ends="flat"),
    lambda r: kerf.parallel(SQUARE, 0),
    lambda r: kerf.fit_arcs([(0, 0)], 1),
    lambda r: kerf.fit_arcs(SQUARE, 0),
    lambda r: kerf.fit_arcs([(0, 0), (0, 1, 2, 3)], 1),
    lambda r: kerf.fit_bezier(SQUARE * 20, 1),
    lambda r: kerf.fit_bezier([(0, 0), (NAN, 0)], 1),
    lambda r: kerf.fit_spline(SQUARE, [0, 1, 2]),
    lambda r: kerf.fit_spline(SQUARE, [0] * 9),
    lambda r: kerf.fit_spline(SQUARE, [NAN] * 9),
    lambda r: kerf.fit_spline(SQUARE, list(range(9)), degree=100),
    lambda r: kerf.flattened(SQUARE, NAN),
    lambda r: kerf.flattened(SQUARE, 0),
], ids=range(26))
def test_bad_arguments_are_refused(call):
    with pytest.raises((kerf.Error, TypeError, ValueError)):
        call(kerf.Region([SQUARE]))


def test_an_error_names_outline_and_element():
    with pytest.raises(kerf.Error, match="element 2"):
        kerf.Region([SQUARE, [(0, 0), (1, 0), (NAN, 1), (0, 0)]])


def test_a_million_points_are_no_trouble():
    count = 10**6
    circle = [(math.cos(a) * (1 + 0.1 * math.sin(50 * a)), math.sin(a))
              for a in (2 * math.pi * i / count for i in range(count))]
    region = kerf.Region([circle + circle[:1]])
    assert region.area == pytest.approx(math.pi, rel=0.1)

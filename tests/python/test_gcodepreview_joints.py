"""Joints of gcodepreview: both boards are cut in the simulator and fit into each other."""

import math

import pytest

import kerf
from gcodepreview import gcodepreview
from gcodepreview_motion import motions

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")
RESOLUTION = 0.05


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])


def machine(size, zero="Lower-Left", number=814):
    gcp = gcodepreview("cut", False, True)
    gcp.setupstock(*size, "Top", zero, 9)
    gcp.movetosafeZ()
    gcp.toolchange(number, 10000)
    gcp.resolution = RESOLUTION
    return gcp


def removed_spans(gcp, along, fixed, z):
    """The spans without material at height `z` on a line along X (or Y) at the fixed Y (or X)."""
    result = gcp.simulate().simulation
    (x0, y0, _), (x1, y1, _) = gcp.stock.low, gcp.stock.high
    columns = result.columns
    steps = ((x1 - x0) / columns[0], (y1 - y0) / columns[1])
    axis = 0 if along == "x" else 1
    other = int((fixed - (y0, x0)[axis]) / steps[1 - axis])
    spans, open_at = [], None
    for i in range(columns[axis]):
        column = result.column(i, other) if axis == 0 else result.column(other, i)
        material = any(low <= z <= high for low, high in column)
        at = (x0, y0)[axis] + i * steps[axis]
        if not material and open_at is None:
            open_at = at
        elif material and open_at is not None:
            spans.append((open_at, at))
            open_at = None
    return spans + ([(open_at, (x1, y1)[axis])] if open_at is not None else [])


DOVETAIL = (100, 12.7, 4, 8, 0.75, 12.7, 14)


@pytest.mark.parametrize("fit", [0.0, 0.2])
def test_dovetails_interlock(fit):
    # A tail is left between two passes of the tool; at each height it is as wide as the socket that the
    # tool cuts.
    pins, tails = machine((100, 60, 12.7)), machine((100, 60, 12.7))
    pins.rapidZ(0)
    pins.cut_pins(*DOVETAIL)
    tails.rapidZ(0)
    tails.cut_tails(*DOVETAIL, fit=fit)
    depth, taper = 9.525, math.tan(math.radians(14)) * 9.525
    neck = 6.35 - taper
    for height in (0.2, 5.0, 9.0):  # above the bottom of the cut
        radius = 6.35 - math.tan(math.radians(14)) * height
        sockets = [s for s in removed_spans(pins, "x", 23.5, -depth + height)]
        assert len(sockets) == 4
        for (low, high), x in zip(sockets, (12.5, 37.5, 62.5, 87.5)):
            assert (low + high) / 2 == pytest.approx(x, abs=RESOLUTION)
            assert high - low == pytest.approx(2 * radius, abs=3 * RESOLUTION)
        gaps = removed_spans(tails, "x", 2.0, -depth + height)
        left = [(a[1], b[0]) for a, b in zip(gaps, gaps[1:])]
        assert len(left) == 4
        for (low, high), x in zip(left, (12.5, 37.5, 62.5, 87.5)):
            assert (low + high) / 2 == pytest.approx(x, abs=RESOLUTION)
            # The upper side of the tail lies on the bottom of the socket, where the tool is widest.
            socket = 2 * (neck + math.tan(math.radians(14)) * height)
            assert high - low == pytest.approx(socket - 2 * fit, abs=3 * RESOLUTION)


@pytest.mark.parametrize("count", [2, 3])
def test_nothing_is_left_between_tails(count):
    """With few tails the spaces between them are wider than two passes of the tool."""
    tails = machine((120, 60, 12.7))
    tails.rapidZ(0)
    tails.cut_tails(120, 12.7, count, 8, 0.75, 12.7, 14)
    for height in (0.2, 5.0, 9.0):
        gaps = removed_spans(tails, "x", 2.0, -9.525 + height)
        assert len(gaps) == count + 1
        assert gaps[0][0] == pytest.approx(0, abs=RESOLUTION)
        assert gaps[-1][1] == pytest.approx(120, abs=RESOLUTION)


@pytest.mark.parametrize("fit", [0.0, 0.15])
@pytest.mark.parametrize(
    "orientation, sides, along",
    [("Vertical", ("Left", "Right"), "y"), ("Horizontal", ("Lower", "Upper"), "x")],
)
def test_fingers_interlock(orientation, sides, along, fit):
    boards = []
    for side, sign in zip(sides, (1, -1)):
        gcp = machine((140, 140, 12.7), "Center", 102)
        at = (0, -50) if orientation == "Vertical" else (-50, 0)
        gcp.Finger_Joint_square(
            *at, orientation, side, 100, 12.7, 11, 100 / 2 - 21 * 3.175 * 1.1 / 2, 3.175, fit=fit
        )
        boards.append(removed_spans(gcp, along, sign * 5.0, -8.0))
    (first, second), pitch = boards, 3.175 * 1.1
    assert (len(first), len(second)) == (11, 10)
    fingers = [(a[1], b[0]) for a, b in zip(first, first[1:])]
    for finger, slot in zip(fingers, second):
        assert (finger[0] + finger[1]) / 2 == pytest.approx((slot[0] + slot[1]) / 2, abs=RESOLUTION)
        clearance = (slot[1] - slot[0]) - (finger[1] - finger[0])
        assert clearance == pytest.approx(2 * fit, abs=3 * RESOLUTION)
        assert slot[1] - slot[0] == pytest.approx(pitch + fit, abs=2 * RESOLUTION)


@pytest.mark.parametrize("orientation, side", [("Vertical", "Left"), ("Horizontal", "Both")])
def test_a_box_joint_is_its_three_parts(orientation, side):
    at = (0, -50) if orientation == "Vertical" else (-50, 0)
    whole = machine((140, 140, 6.35), "Center", 102)
    whole.Full_Blind_Finger_Joint(*at, orientation, side, 100, 6.35, 12.7, 3.175)
    parts = []
    for part in ("square", "smallV", "largeV"):
        gcp = machine((140, 140, 6.35), "Center", 102)
        pins = int((100 - 2 * 6.35) / (2 * 1.1 * 3.175) / 2) * 2 + 1
        getattr(gcp, f"Full_Blind_Finger_Joint_{part}")(
            *at, orientation, side, 100, 6.35, pins, 12.7, 3.175
        )
        parts += [end for kind, end, *_ in motions(gcp.toolpath) if kind == "cut"]
    made = [end for kind, end, *_ in motions(whole.toolpath) if kind == "cut"]
    near = lambda rows: {tuple(round(v, 6) + 0.0 for v in row) for row in rows}
    assert near(made) == near(parts)


@pytest.mark.parametrize(
    "orientation, side",
    [("Vertical", s) for s in ("Left", "Right", "Both")]
    + [("Horizontal", s) for s in ("Lower", "Upper", "Both")],
)
def test_box_joints_in_all_orientations(orientation, side):
    gcp = machine((140, 140, 6.35), "Center", 102)
    at = (0, -50) if orientation == "Vertical" else (-50, 0)
    gcp.Full_Blind_Finger_Joint(*at, orientation, side, 100, 6.35, 12.7, 3.175)
    low, high = gcp.toolpath.report()["cut_bounds_mm"]
    assert low[2] == pytest.approx(-6.35), "the V lines reach the full depth"
    across = 0 if orientation == "Vertical" else 1
    reach = 6.35 - 3.175 / 2
    expected = {
        "Both": (-reach, reach),
        "Left": (-3.175 / 2, reach),
        "Lower": (-3.175 / 2, reach),
        "Right": (-reach, 3.175 / 2),
        "Upper": (-reach, 3.175 / 2),
    }[side]
    assert (low[across], high[across]) == pytest.approx(expected, abs=1e-6)
    kinds = [h["kind"] for h in gcp.simulate().hazards]
    assert "rapid_in_stock" not in kinds


def test_a_large_v_that_does_not_reach_the_depth_is_flagged():
    gcp = machine((140, 140, 12.7), "Center", 102)
    with pytest.warns(UserWarning, match="largeVdiameter: a 90 degree V of 12.7 mm cuts 6.35 mm deep"):
        gcp.Full_Blind_Finger_Joint(-50, 0, "Horizontal", "Both", 100, 12.7, 12.7, 3.175)

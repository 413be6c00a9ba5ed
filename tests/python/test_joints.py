"""Joints: both boards are cut in the simulator, assembled, and compared with each other.

The target of a board is its stock without the assembled mesh of the other one (by manifold3d): what the board
has more is an overlap of both, what it has less is a gap, and the depth of that is the clearance.
"""

import math

import manifold3d
import numpy as np
import pytest

import kerf
from gcodepreview import GcodePreviewError, gcodepreview, shapes
from kerf import _kerf

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")
PITCH = 0.05  # mm of the columns
ERROR = 1.1 * PITCH  # a gap is measured at the columns in it
TOOL = 3.175
WIDTH, COUNT, A, B = 40.0, 5, 6.0, 9.0  # mm: the boards, and their thicknesses


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])


def board(size, cut, tool=102, rapids="free", pitch=PITCH):
    """The simulation of a board that `cut` cuts."""
    gcp = gcodepreview("cut")
    gcp.setupstock(*size, "Top", "Lower-Left", 9)
    gcp.movetosafeZ()
    gcp.toolchange(tool, 10000)
    cut(gcp)
    gcp.resolution = pitch
    result = gcp.simulate()
    assert rapids != "free" or not [h for h in result.hazards if h["kind"] == "rapid_in_stock"]
    return result.simulation


def solid(simulation, matrix=None):
    """The part as a solid of manifold3d, moved by a 3 x 4 matrix."""
    points, triangles, _ = simulation.mesh()
    points = np.asarray(points, dtype=np.float32)
    if matrix is not None:
        matrix = np.asarray(matrix, dtype=float)
        assert np.linalg.det(matrix[:, :3]) == pytest.approx(1), "a board is turned, not mirrored"
        points = (points @ matrix[:, :3].T + matrix[:, 3]).astype(np.float32)
    made = manifold3d.Manifold(manifold3d.Mesh(vert_properties=points, tri_verts=triangles))
    assert made.status() == manifold3d.Error.NoError
    return made


def block(low, high):
    size = [h - l for l, h in zip(low, high)]
    return manifold3d.Manifold.cube(size).translate(low)


def stock_of(made):
    """A solid as a target of kerf.compare."""
    mesh = made.to_mesh()
    corners = np.asarray(mesh.vert_properties, dtype="<f4")[mesh.tri_verts]
    record = np.zeros(len(corners), np.dtype([("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")]))
    record["p"] = corners
    data = b"target".ljust(80) + len(corners).to_bytes(4, "little") + record.tobytes()
    return _kerf._read_stock(data, "target.stl")


def clearances(part, size, other, where):
    """Depths of the gaps and the overlaps in the columns within `where` (low x, low y, high x, high y)."""
    space = block((0, 0, -size[2]), (size[0], size[1], 0))
    target = stock_of(space - other)
    found = kerf.compare(part, target, 0.001)["map"]
    rows, columns = found.shape
    x = (np.arange(columns) + 0.5) * size[0] / columns
    y = (np.arange(rows) + 0.5) * size[1] / rows
    columns = (x >= where[0]) & (x <= where[2])
    depths = found[(y >= where[1]) & (y <= where[3])][:, columns]
    return max(0.0, -float(depths.min())), max(0.0, float(depths.max()))


# ---- finger joints

# The second board is upright on the edge of the first, and its height is the first one's Y.
STANDING = [[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, -A]]


def fingers(fit, corners):
    first = board(
        (WIDTH, 25, A), lambda gcp: gcp.cutfingers(WIDTH, B, COUNT, 0, A, True, fit, corners, stepover=0.3)
    )
    second = board(
        (WIDTH, 25, B), lambda gcp: gcp.cutfingers(WIDTH, A, COUNT, 0, B, False, fit, corners, stepover=0.3)
    )
    return first, second


@pytest.mark.parametrize("corners", ["dog-bone", "t-bone"])
@pytest.mark.parametrize("fit", [0.0, 0.15])
def test_finger_joints_go_together(fit, corners):
    first, second = fingers(fit, corners)
    # The flanks of the inner fingers. A t-bone lies beyond the ends of the fingers, a dog-bone reaches into
    # the flank by up to r (1 - 1 / sqrt 2).
    relief = TOOL / 2 * (1 - math.sqrt(0.5)) if corners == "dog-bone" else 0.0
    other = solid(second, STANDING)
    gap, overlap = clearances(first, (WIDTH, 25, A), other, (10, 3, WIDTH - 10, B - 3))
    assert fit + 0.5 * relief - ERROR <= gap <= fit + relief + ERROR
    assert overlap <= ERROR
    # The whole joint: nowhere do the boards overlap, and what is open are the reliefs.
    gap, overlap = clearances(first, (WIDTH, 25, A), other, (0, 0, WIDTH, 25))
    assert overlap <= ERROR
    assert gap <= TOOL / 2 + fit + ERROR
    # Moved sideways they touch at the clearance, all flanks of one direction at once.
    flanks = A * B * (COUNT - 1) / 2  # mm2; dog-bones take up to half of it
    here = solid(first)

    def shared(x):
        return (here ^ other.translate((x, 0, 0))).volume()

    for sign in (-1, 1):
        assert shared(sign * fit) <= 0.005 * flanks
        assert 0.4 * flanks <= shared(sign * (fit + 0.05)) / 0.05 <= 1.1 * flanks


def test_a_finger_joint_without_reliefs_does_not_go_together():
    first, second = fingers(0.1, None)
    _, overlap = clearances(first, (WIDTH, 25, A), solid(second, STANDING), (0, 0, WIDTH, 25))
    # A round corner of the tool's radius in a square one: r (1 - 1 / sqrt 2), less the fit in the flank.
    assert overlap > 0.2
    assert (solid(first) ^ solid(second, STANDING)).volume() > 1


def test_a_pressed_joint_overlaps_by_its_fit():
    first, second = fingers(-0.2, "t-bone")
    gap, overlap = clearances(first, (WIDTH, 25, A), solid(second, STANDING), (10, 3, WIDTH - 10, B - 3))
    assert overlap == pytest.approx(0.2, abs=ERROR) and gap <= ERROR


@pytest.mark.parametrize(
    "arguments, text",
    [
        ((40, 6, 4), "odd"),
        ((40, 6, 1), "at least 3"),
        ((40, -6, 5), "depth"),
        ((40, 6, 5, 0, 6, True, 9), "fit"),
        ((40, 6, 5, 0, 6, True, 0, "cat-bone"), "corners.*dog-bone"),
    ],
)
def test_wrong_finger_joints_name_the_argument(arguments, text):
    gcp = gcodepreview("cut")
    with pytest.raises(GcodePreviewError, match=text):
        gcp.cutfingers(*arguments, *(() if len(arguments) > 3 else (0, 6)))


# ---- corners


@pytest.mark.parametrize("style", ["dog-bone", "t-bone"])
@pytest.mark.parametrize("angle", [90, 60, 120])
def test_a_part_with_the_same_corners_fits(style, angle):
    # A parallelogram cut as a pocket; the tool reaches each of its corners.
    shape = shapes.parallelogram(12, 5, 30, 20, 20 / math.tan(math.radians(angle)))
    pocket = board((70, 30, 5), lambda gcp: gcp.cutpocket(shape, 0, 3, corners=style))
    outline = [(x, y) for x, y in shape[:-1]]
    plug = manifold3d.CrossSection([outline]).extrude(2.9).translate((0, 0, -2.95))
    assert (solid(pocket) ^ plug).volume() < 0.02
    plain = board((70, 30, 5), lambda gcp: gcp.cutpocket(shape, 0, 3))
    assert (solid(plain) ^ plug).volume() > 1


def test_reliefs_have_the_size_of_their_tool():
    square = kerf.Region([shapes.rectangle(0, 0, 20, 30)])
    for style in ("dog-bone", "t-bone"):
        made = kerf.relieve_corners(square, 4, style)
        for corner in ((0, 0), (20, 0), (20, 30), (0, 30)):
            assert made.offset(-2).distance(kerf.Region([(*corner, 1e-4)]))[0] == pytest.approx(2, abs=0.01)
    low, high = kerf.relieve_corners(square, 4, "t-bone").bounds[1::2]
    assert (low, high) == pytest.approx((-2, 32), abs=0.01), "into the shorter sides"
    low, high = kerf.relieve_corners(square, 4, "t-bone").bounds[::2]
    assert (low, high) == pytest.approx((0, 20), abs=0.01)


def test_outer_corners_stay():
    # An L: five corners for the tool to reach, and one that remains.
    ell = kerf.Region([shapes.polygon([(0, 0), (30, 0), (30, 10), (10, 10), (10, 30), (0, 30)])])
    assert kerf.relieve_corners(ell, 2).locate((10.2, 10.2)) == "outside"
    with pytest.raises(ValueError, match="diameter"):
        kerf.relieve_corners(ell, 0)
    with pytest.raises(GcodePreviewError, match="corners"):
        gcodepreview("cut").cutoutline(shapes.rectangle(0, 0, 9, 9), 0, 1, "outside", "dog-bone")


# ---- dovetails

DOVETAIL = (25, 12.7, 1, 8, 0.75, 12.7, 14)
DEPTH, SOCKETS = 9.525, 12.7 + 8.0  # mm: of the cut, and where the sockets start


@pytest.mark.parametrize("fit", [0.0, 0.2])
def test_dovetails_go_together(fit):
    size, pitch = (25, 36, 12.7), 0.1
    made = (814, "recorded", pitch)
    pins = board(size, lambda gcp: (gcp.rapidZ(0), gcp.cut_pins(*DOVETAIL)), *made)
    tails = board(size, lambda gcp: (gcp.rapidZ(0), gcp.cut_tails(*DOVETAIL, fit=fit)), *made)
    # The tail board is turned about Y: its tails point down into the sockets.
    turned = [[-1, 0, 0, size[0]], [0, 1, 0, SOCKETS], [0, 0, -1, -DEPTH]]
    # Beyond the groove across the whole board that the sockets start from.
    where = (1, SOCKETS + 2.5, size[0] - 1, SOCKETS + DEPTH + 3)
    gap, overlap = clearances(pins, size, solid(tails, turned), where)
    assert overlap <= 0.6 * pitch
    assert gap == pytest.approx(fit * math.cos(math.radians(14)), abs=pitch)

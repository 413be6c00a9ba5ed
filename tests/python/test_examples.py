"""The parametric examples of examples/python: they run as scripts, and are right for other sizes too."""

import importlib.util
import math
import pathlib
import subprocess
import sys

import pytest

import kerf

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
NAMES = ["sign", "box", "tray", "hanger", "relief", "pcb"]


def example(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def rectangle(width, height):
    return kerf.Region([[(0, 0), (width, 0), (width, height), (0, height), (0, 0)]])


@pytest.mark.parametrize("name", NAMES)
def test_it_runs_as_a_script(name, tmp_path):
    script = [sys.executable, "-W", "error", EXAMPLES / f"{name}.py", tmp_path]
    done = subprocess.run(script, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    program = kerf.load(tmp_path / f"{name}.nc")
    assert len(program) > 50


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_found_against_it(name):
    made = getattr(example(name), name)()
    job = made[0] if isinstance(made, tuple) else made
    assert job.check() == []
    assert [h for h in job.simulate(0.2).hazards if h["kind"] != "below_floor"] == []


@pytest.mark.parametrize("text, height", [("WORKSHOP", 24), ("AB", 40)])
def test_the_sign_is_as_wide_as_its_text(text, height):
    job, board = example("sign").sign(text, height)
    _, _, width, depth = board.bounds
    assert depth == pytest.approx(height + 30, rel=0.15)
    high = job.path.report()["cut_bounds_mm"][1]
    assert high[:2] == pytest.approx((width + 3.175, depth + 3.175), abs=1e-6)


@pytest.mark.parametrize("height, thickness, fingers", [(48, 9, 5), (60, 6, 7), (30, 12, 3)])
def test_the_boards_of_the_box_go_together(height, thickness, fingers):
    module = example("box")
    job, boards = module.box(150, 90, height, thickness, fingers)
    assert len(boards) == 4 and job.check() == []
    ends = []
    for made in (boards[0], boards[2]):
        low_x, low_y, *_ = made.bounds
        ends.append(made.moved(-low_x, -low_y) & rectangle(thickness, height))
    assert (ends[0] & ends[1]).area == 0, "fingers are where the other board has slots"
    clearance = 0.05 * thickness * 2 * (fingers - 1)  # on both sides of each slot between fingers
    gap = thickness * height - (ends[0] | ends[1]).area
    assert clearance * 0.8 <= gap <= clearance + 2 * (fingers - 1) * math.pi * 1.5**2


@pytest.mark.parametrize("columns, rows, depth", [(3, 2, 15), (1, 1, 8)])
def test_the_pockets_of_the_tray(columns, rows, depth):
    job, pockets = example("tray").tray(columns, rows, depth=depth)
    area = columns * rows * (50**2 - (4 - math.pi) * 6**2)
    assert pockets.area == pytest.approx(area, rel=1e-4)
    # Around the board a slot of 6 mm, along a path with corners of 9 mm, but for six tabs 2 mm high.
    width, height = columns * 56 + 6, rows * 56 + 6
    slot = 20 * 6 * (2 * (width + height - 24) + 2 * math.pi * 9)
    removed = job.simulate(0.2).removed_mm3
    assert area * depth + slot - 6 * (2 * 6 * 14) <= removed <= area * depth + slot


def test_the_slots_of_the_hanger_are_in_inches():
    job, points = example("hanger").hanger(width=10, screws=3, distance=8)
    assert points == [(1, 1.25), (5, 1.25), (9, 1.25)]
    starts = [job.path[i]["to"] for i in range(len(job.path)) if job.path[i]["step"] == "cut"]
    for x, y in points:
        assert any(
            math.dist(to[:2], (25.4 * x, 25.4 * y)) < 1e-6 and abs(to[2] + 9.525) < 1e-6 for to in starts
        )


def test_the_relief_is_the_surface():
    module = example("relief")
    job = module.relief(width=40, height=30, stepover="10%")
    points, _, _ = job.simulate(0.2).mesh()
    inside = [p for p in points.tolist() if 2 < p[0] < 38 and 2 < p[1] < 28 and p[2] > -7]
    errors = [z - module.waves(x, y) for x, y, z in inside]
    assert len(errors) > 1000 and -0.06 < min(errors) and max(errors) < 0.15


def test_the_copper_of_the_board_stays():
    module = example("pcb")
    job, copper = module.pcb(track=1.0)
    part = job.simulate(0.05)
    rest = 2 * (math.pi * 1.1**2)  # two pads without a track, at least
    assert copper.area > rest + (10 + 10 + 10 + 5) * 1.0 - 4 * 1.1
    cuts = [job.path[i] for i in range(len(job.path)) if "feed" in job.path[i]]
    for step in cuts:
        x, y, z = step["to"]
        if -0.1 < z < 0:  # isolation: the mill of 0.3 mm stays beside the copper
            assert copper.offset(0.149).locate((x, y)) == "outside"
    assert part.removed_mm3 > 0

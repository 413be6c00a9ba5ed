"""A box with finger joints: four boards of any size and thickness, cut from one panel."""

import pathlib
import sys

import kerf

MILL = 3.0  # mm


def board(width, height, thickness, fingers, first):
    """A board with the fingers of a joint at its ends; its lower left corner is at 0, 0."""
    region = kerf.Region([[(0, 0), (width, 0), (width, height), (0, height), (0, 0)]])
    slots = kerf.finger_slots(height, thickness, fingers, first=first, fit=0.05, overhang=MILL)
    left = kerf.relieve_corners(slots.rotated(-90).moved(0, height), MILL, "dog-bone", limits=region)
    return region - left - left.scaled((-1, 1)).moved(width, 0)


def box(width=120.0, depth=80.0, height=48.0, thickness=9.0, fingers=5):
    """The job, and the boards where they are on the panel: two for the front and back, two for the sides."""
    gap = 3 * MILL
    boards = []
    for size, first in ((width, True), (depth, False)):
        for _ in range(2):
            low = gap + len(boards) * (height + gap)
            boards.append(board(size, height, thickness, fingers, first).moved(gap, low))
    panel = (max(width, depth) + 2 * gap, gap + len(boards) * (height + gap), thickness)
    with kerf.Job(panel, tools=f"1=square d={MILL} flute=12", feed=900, plunge=250, rpm=18000) as job:
        for made in boards:
            job.contour(made, 1, depth=thickness, stepdown=1.5, tabs=4, tab_height=1)
    return job, boards


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    job, _ = box()
    job.save(folder / "box.nc", folder / "box.png", post="grbl")

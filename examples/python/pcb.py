"""A circuit board: tracks and pads by isolation milling, drilled, cut out of copper-clad board."""

import pathlib
import sys

import kerf

PADS = [(5, 5), (5, 15), (25, 5), (25, 15)]
TRACKS = [[(5, 5), (15, 5), (15, 15), (25, 15)], [(5, 15), (10, 15)]]


def pcb(pads=PADS, tracks=TRACKS, size=(30, 20), track=0.8, pad=2.2, hole=0.9, thickness=1.6, tip=0.3):
    """The job, and the copper that stays connected as a region."""
    copper = kerf.Region([(x, y, pad / 2) for x, y in pads])
    for line in tracks:
        copper = copper | kerf.widen(line, track)
    width, height = size
    board = [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    stock = kerf.move_stock(kerf.Stock.block((width + 8, height + 8, thickness)), shift=(-4, -4, 0))
    tools = [f"1=square d={tip} flute=1", f"2=drill d={hole} flute=10", "3=square d=2 flute=6"]
    setup = dict(retract=2, feed=200, plunge=60, rpm=20000, spoilboard=3)
    with kerf.Job(stock, tools=tools, **setup) as job:
        job.contour(copper, 1, depth=0.08)
        job.contour(copper, 1, depth=0.08, allowance=0.7 * tip)  # a second way around: a wider gap
        job.drill(pads, 2, depth=thickness + 0.2)
        job.contour([board], "2mm", depth=thickness, stepdown=0.6, tabs=2, tab_height=0.6)
    return job, copper


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    job, _ = pcb()
    job.save(folder / "pcb.nc", folder / "pcb.png", post="grbl", resolution=0.05)

"""A board with keyhole slots, by which it hangs on screws, in inches."""

import pathlib
import sys

import kerf


def hanger(width=8.0, height=2.5, screws=2, distance=6.0, depth=0.375):
    """The job, and where the screws enter; all in inches."""
    first = (width - distance) / 2
    step = distance / max(screws - 1, 1)
    points = [(first + i * step, height / 2) for i in range(screws)]
    tools = ["1=keyhole d=3/8in head=3/16in neck=3/16in flute=1/2in", "2=square d=1/4in flute=3/4in"]
    board = [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    block = kerf.Stock.block([kerf.inch * v for v in (width + 1, height + 1, 0.75)])
    stock = kerf.move_stock(block, shift=(-kerf.inch / 2, -kerf.inch / 2, 0))
    with kerf.Job(stock, units="inch", tools=tools, feed=40, plunge="10ipm", rpm=16000) as job:
        job.keyhole(points, 1, depth=depth, length="1/2in", angle=90)
        job.contour([board], "1/4in", depth="3/4in", stepdown="1/8in", tabs=4, tab_height="1/16in")
    return job, points


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    job, _ = hanger()
    job.save(folder / "hanger.nc", folder / "hanger.png", post="linuxcnc")

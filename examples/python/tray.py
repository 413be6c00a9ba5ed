"""A tray with pockets in rows and columns: finished along their walls, and its edge cut last."""

import pathlib
import sys

import kerf


def rounded(x, y, width, height, radius):
    """A rectangle with round corners; x and y are its lower left corner."""
    sharp = kerf.Region([[(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)]])
    return sharp.offset(-radius).offset(radius)


def tray(columns=3, rows=2, pocket=50.0, depth=15.0, wall=6.0, thickness=20.0, radius=6.0):
    """The job, and its pockets as a region."""
    width, height = (n * (pocket + wall) + wall for n in (columns, rows))
    pockets = kerf.Region()
    for column in range(columns):
        for row in range(rows):
            x, y = (wall + n * (pocket + wall) for n in (column, row))
            pockets = pockets | rounded(x, y, pocket, pocket, radius)
    stock = kerf.move_stock(kerf.Stock.block((width + 20, height + 20, thickness)), shift=(-10, -10, 0))
    with kerf.Job(stock, tools="1=square d=6 flute=25", feed=1500, plunge=400, rpm=18000) as job:
        job.pocket(pockets, "6mm", depth=depth, stepdown=3, stepover="45%", finish=0.3)
        job.contour(rounded(0, 0, width, height, radius), depth=thickness, stepdown=3, tabs=6, tab_height=2)
    return job, pockets


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    job, _ = tray()
    job.save(folder / "tray.nc", folder / "tray.png", post="grbl")

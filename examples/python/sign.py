"""A sign: a text in single strokes, a groove around it, and the board cut out, for any text and size."""

import pathlib
import sys

import kerf


def sign(text="WORKSHOP", height=24.0, margin=15.0, thickness=12.0):
    """The job, and the board as a region; the text has capital letters of `height` mm."""
    letters = kerf.op.text_outlines(text, height, font="serif-bold")
    x = [point[-2] for letter in letters for point in letter]
    y = [point[-1] for letter in letters for point in letter]
    width, depth = max(x) - min(x) + 2 * margin, max(y) - min(y) + 2 * margin
    letters = kerf.op.text_outlines(text, height, font="serif-bold", at=(margin - min(x), margin - min(y)))
    board = kerf.Region([[(0, 0), (width, 0), (width, depth), (0, depth), (0, 0)]])
    stock = kerf.move_stock(kerf.Stock.block((width + 20, depth + 20, thickness)), shift=(-10, -10, 0))
    tools = ["1=V d=12 angle=60", "2=square d=1/4in flute=20"]
    with kerf.Job(stock, tools=tools, feed="1.2 m/min", plunge=400, rpm=16000) as job:
        job.engrave(letters, 1, depth=1.5)
        job.engrave(board.offset(-margin / 3).outlines, depth=1)
        job.contour(board, "1/4in", depth=thickness, stepdown=3, tabs=4, tab_height=1.5)
    return job, board


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    job, _ = sign()
    job.save(folder / "sign.nc", folder / "sign.png", post="grbl")

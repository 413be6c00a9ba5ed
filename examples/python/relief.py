"""A relief from a function of x and y: roughed by a square mill, finished by a ball."""

import math
import pathlib
import sys

import kerf


def waves(x, y):
    """Z of the surface, -6 to 0 mm."""
    return 3 * math.cos(x / 8) * math.cos(y / 8) - 3


def mesh_of(surface, width, height, pitch=1.0):
    """Points and triangles of a surface over a rectangle."""
    columns, rows = round(width / pitch) + 1, round(height / pitch) + 1
    points = [
        (i * pitch, j * pitch, surface(i * pitch, j * pitch)) for j in range(rows) for i in range(columns)
    ]
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, b = j * columns + i, (j + 1) * columns + i
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return points, triangles


def relief(surface=waves, width=60.0, height=40.0, allowance=0.4, stepover="15%"):
    """The job; the stock ends at Z0."""
    mesh = mesh_of(surface, width, height)
    tools = ["1=square d=6 flute=20", "2=ball d=4 flute=16"]
    with kerf.Job((width, height, 12), tools=tools, feed=1800, plunge=600, rpm=18000) as job:
        job.waterline(mesh, 1, top=0, stepdown=2, allowance=allowance)
        job.raster(mesh, 2, top=0, stepover=stepover)
    return job


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    relief().save(folder / "relief.nc", folder / "relief.png", post="grbl")

#!/usr/bin/env python3
"""Compares operations with other libraries on the same input, in one run.

    bench/op_peers.py BUILD_FOLDER [--runs N] [--mesh N] [--only WORD] [--venv FOLDER]

BUILD_FOLDER/python has the module `kerf`. The others are installed from PyPI into a new environment, in
FOLDER if that is given: pyclipr (Clipper2), pyvoronoi (the Voronoi diagrams of Boost), opencamlib. Figures
are the least seconds of processor time of N runs, of all threads. The others do less, as the last column
states.
"""
import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PEERS = ("numpy", "pyclipr==0.1.8", "pyvoronoi==1.2.8", "opencamlib==2023.1.11")
RADIUS, DIAMETER, STEPOVER = 60.0, 10.0, 0.4  # mm, of a pocket with 15 rings
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
CHORD = 0.01  # mm, of arcs as chords, where a library has no arcs
UNIT = 1e-4   # mm, of whole numbers


def wavy(arcs):
    """A circle of arcs that bulge in and out by turns, as in op.cpp: (via_x, via_y, x, y) each."""
    step = 2 * math.pi / arcs
    bulge = [(1 if i % 2 == 0 else -1) * 0.05 * RADIUS * step for i in range(1, arcs + 1)]
    at = [(RADIUS * math.cos(i * step), RADIUS * math.sin(i * step)) for i in range(arcs)] + [(RADIUS, 0.0)]
    via = [((RADIUS + b) * math.cos((i + 0.5) * step), (RADIUS + b) * math.sin((i + 0.5) * step))
           for i, b in enumerate(bulge)]
    return [at[0], *[(*v, *p) for v, p in zip(via, at[1:])]]


def chords(arc_from, arc):
    """The points of an arc after its first, with chords at most CHORD from it."""
    (ax, ay), (bx, by, cx, cy) = arc_from, arc
    d = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    mx, my = ((a2 * (by - cy) + b2 * (cy - ay) + c2 * (ay - by)) / d,
              (a2 * (cx - bx) + b2 * (ax - cx) + c2 * (bx - ax)) / d)
    radius, start = math.hypot(ax - mx, ay - my), math.atan2(ay - my, ax - mx)
    sweep = (math.atan2(cy - my, cx - mx) - start + math.pi) % (2 * math.pi) - math.pi
    count = max(1, math.ceil(abs(sweep) / (2 * math.acos(max(0.0, 1 - CHORD / radius)))))
    return [(mx + radius * math.cos(start + sweep * k / count),
             my + radius * math.sin(start + sweep * k / count)) for k in range(1, count + 1)]


def flattened(outline):
    points = [outline[0]]
    for arc in outline[1:]:
        points += chords(points[-1], arc) if len(arc) == 4 else [arc]
    return points


def rings(outline):
    """As op.pocket makes them: each from the one before, until nothing is left."""
    import pyclipr
    made, left, by = 0, [flattened(outline)[:-1]], 0.5 * DIAMETER
    while left:
        offset = pyclipr.ClipperOffset()
        offset.scaleFactor, offset.arcTolerance = int(1 / UNIT), CHORD / UNIT
        offset.addPaths(left, pyclipr.JoinType.Round, pyclipr.EndType.Polygon)
        left = [path for path in offset.execute(-by) if len(path) > 2]
        made, by = made + len(left), STEPOVER * DIAMETER
    return made


def letters():
    import kerf
    lines = ["abcdefghijklmnopqrstuvwxy", "ABCDEFGHIJKLMNOPQRSTUVWXY"] * 2
    region = None
    for i, line in enumerate(lines):
        one = kerf.Region(kerf.op.text_outlines(line, height=12, font=FONT, at=(0, -18 * i)), fill="nonzero")
        region = one if region is None else region | one
    return region


def voronoi(outlines):
    import pyvoronoi
    diagram = pyvoronoi.Pyvoronoi(1 / UNIT)
    for outline in outlines:
        points = [(round(x, 4), round(y, 4)) for x, y in flattened(outline)]
        for a, b in zip(points, points[1:]):
            if a != b:
                diagram.AddSegment([a, b])
    diagram.Construct()
    return len(diagram.GetVertices())


def hills(n):
    """As in op.cpp: points and triangles of n x n squares on 100 x 100 mm."""
    import numpy
    x, y = numpy.meshgrid(numpy.linspace(0, 100, n + 1), numpy.linspace(0, 100, n + 1))
    z = 5 * numpy.sin(0.13 * x) * numpy.cos(0.1 * y) + 1.2 * numpy.sin(0.9 * x + 0.7 * y) + 0.3 * numpy.sin(
        3.1 * x) * numpy.sin(2.7 * y) - 8
    a = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
    b = a + n + 1
    triangles = numpy.concatenate([numpy.stack([a, a + 1, b + 1], 1), numpy.stack([a, b + 1, b], 1)])
    return numpy.stack([x.ravel(), y.ravel(), z.ravel()], 1), triangles.astype("uint32")


def strip(lines):
    """Where the axis goes along `lines` lines, 0.2 mm apart."""
    low = 50.0
    return [[(0, low), (100, low), (100, low + 0.2 * lines), (0, low + 0.2 * lines), (0, low)]]


def surface_of(mesh):
    import opencamlib as ocl
    points, triangles = mesh
    surface, at = ocl.STLSurf(), [ocl.Point(*map(float, p)) for p in points]
    for a, b, c in triangles:
        surface.addTriangle(ocl.Triangle(at[a], at[b], at[c]))
    return surface


def drop(surface, lines):
    import opencamlib as ocl
    cutter, path = ocl.BallCutter(6, 20), ocl.Path()
    for i in range(lines):
        y = 50.0 + 0.2 * i + 0.1
        path.append(ocl.Line(ocl.Point(0, y, 0), ocl.Point(100, y, 0)))
    dropped = ocl.AdaptivePathDropCutter()
    dropped.setSTL(surface), dropped.setCutter(cutter), dropped.setPath(path)
    dropped.setSampling(0.15), dropped.setMinSampling(0.01), dropped.setZ(-20)
    dropped.run()
    return len(dropped.getCLPoints())


def best(runs, work):
    """The least processor time of some runs, and what the work returned."""
    times = []
    for _ in range(runs):
        before = time.process_time()
        made = work()
        times.append(time.process_time() - before)
    return min(times), made


def compare(name, kerf_work, peer, runs, note):
    own, _ = best(runs, kerf_work)
    other, made = best(1 if name.startswith("raster") else runs, peer) if peer else (None, None)
    ratio = f"{other:10.3f} {other / own:8.1f}" if peer else f"{'':10} {'':8}"
    print(f"{name:<34} {own:8.3f} {ratio}  {note.format(made)}", flush=True)


def run_all(runs, squares, only):
    import kerf
    import kerf.op
    from kerf import op
    print(f"{'':<34} {'Kerf, s':>8} {'other, s':>10} {'ratio':>8}")

    def wanted(name):
        return only in name

    for arcs in (10, 100, 1_000, 10_000, 100_000):
        name = f"pocket of {arcs:,} arcs"
        if wanted(name):
            outline = wavy(arcs)
            region = kerf.Region([outline])
            compare(name, lambda: op.pocket(region, f"square d={DIAMETER}", depth=1, stepover=STEPOVER,
                                            feed=900, rpm=9000),
                    lambda: rings(outline), runs if arcs < 1e5 else 1,
                    "Clipper2: {} rings alone")
    if wanted("V-carving of 100 letters"):
        region = letters()
        compare("V-carving of 100 letters", lambda: op.v_carve(region, "v d=12 angle=60", feed=900, rpm=9000),
                lambda: voronoi(region.outlines), runs, "Boost: {} vertices of the diagram alone")
    for name, lines in (("raster of the mesh, 5 lines", 5), ("raster of the mesh, 500 lines", 500)):
        if wanted(name):
            mesh = hills(squares)
            surface = surface_of(mesh) if lines == 5 else None
            compare(name, lambda: op.raster(mesh, "ball d=6", line_distance=0.2, feed=900, rpm=9000,
                                            area=strip(lines) if lines == 5 else None),
                    (lambda: drop(surface, lines)) if surface else None, runs,
                    "opencamlib: {} points on the lines alone" if surface else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--mesh", type=int, default=707,
                        help="squares of the mesh on a side (707: a million triangles)")
    parser.add_argument("--only", default="", help="benchmarks whose names contain this")
    parser.add_argument("--venv", help="environment of the other libraries; made if it is not there")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inside:
        return run_all(options.runs, options.mesh, options.only)
    with tempfile.TemporaryDirectory() as scratch:
        venv = Path(options.venv or scratch, "venv")
        python = venv / "bin" / "python"
        if not python.exists():
            subprocess.run([sys.executable, "-m", "venv", venv], check=True)
            subprocess.run([python, "-m", "pip", "install", "-q", *PEERS], check=True)
        environment = {**os.environ, "PYTHONPATH": str(Path(options.build, "python").resolve())}
        return subprocess.run([python, *sys.argv, "--inside"], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())

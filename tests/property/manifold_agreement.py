"""Random jobs cut by kerf and by exact mesh booleans (manifold3d): what is removed has to agree.

    python tests/property/manifold_agreement.py KERF [COUNT] [SEED] [--resolutions 0.02,0.1] [--meshes N]

Every job is cut at each resolution. The booleans have polygonal tools and chords of arcs; each job is
computed with two numbers of corners, and the error, proportional to the square of the corners' angle, is
extrapolated to zero. `--meshes N` compares the mesh of every Nth job as well: the volume in which it
differs from the exact part, over the area of the part, and the distances of its vertices from the part's
surface.

Needs the package manifold3d. Exit status 1 if a job at 0.02 mm differs by more than 2e-4 of its removed
volume, or a mesh is not closed; 77 if manifold3d is not installed.
"""
import argparse
import json
import math
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import manifold3d
    import numpy
except ImportError:
    print("manifold3d is not installed: nothing is compared")
    sys.exit(77)

FINE = 0.02  # mm, the resolution that is checked
TOLERANCE = 2e-4  # of the removed volume, there
ENOUGH = 1.0  # mm3: less is not judged by fractions
BLOCK = (14.0, 11.0, 6.0)
SAMPLES = 400  # vertices of a mesh whose distance is measured


def arc(r, z, radius, start, end, steps):
    """Points of a half profile about (r, z), angles in degrees from the axis' outside."""
    angles = (math.radians(start + (end - start) * k / steps) for k in range(steps + 1))
    return [(max(0.0, r + radius * math.cos(a)), z + radius * math.sin(a)) for a in angles]


def stacked(points):
    """A concave profile as convex parts, one per chord."""
    return [list(pair) for pair in zip(points, points[1:])]


# Convex parts as half profiles [(r, z), ...] from the tip upwards, for a number of steps of a quarter turn.
TOOLS = {
    "square d=3 flute=20": lambda n: [[(1.5, 0), (1.5, 20)]],
    "ball d=3 flute=20": lambda n: [arc(0, 1.5, 1.5, -90, 0, n) + [(1.5, 20)]],
    "bull nose d=4 r=1 flute=20": lambda n: [arc(1, 1, 1, -90, 0, n) + [(2, 20)]],
    "bowl d=6 r=2 flute=20": lambda n: [arc(1, 2, 2, -90, 0, n) + [(3, 20)]],
    "V d=6 angle=90 flute=20": lambda n: [[(0, 0), (3, 3), (3, 20)]],
    "drill d=3 angle=118 flute=20": lambda n: [[(0, 0), (1.5, 1.5 / math.tan(math.radians(59))), (1.5, 20)]],
    "chamfer d=6 angle=90 tip=1 flute=20": lambda n: [[(0.5, 0), (3, 2.5), (3, 20)]],
    "keyhole d=5 neck=2.5 head=2 flute=20": lambda n: [[(2.5, 0), (2.5, 2)], [(1.25, 0), (1.25, 20)]],
    "dovetail d=5 angle=14 flute=4": lambda n: [[(2.5, 0), (2.5 - 4 * math.tan(math.radians(14)), 4)]],
    "lollipop d=4 neck=2": lambda n: [arc(0, 2, 2, -90, 60, 2 * n)],
    "T-slot d=5 thickness=1.5 neck=2.5": lambda n: [[(2.5, 0), (2.5, 1.5)]],
    "thread mill minor_diameter=2.5 major_diameter=4 cut_height=1":
        lambda n: [[(1.25, 0), (2, 0.5), (1.25, 1)]],
    "roundover tip=1 r=2 flute=20": lambda n: stacked(arc(0.5, 2, 2, -90, -90, 1)[:1] + [
        (2.5 - 2 * math.cos(math.pi / 2 * k / n), 2 * math.sin(math.pi / 2 * k / n)) for k in range(n + 1)]
        + [(2.5, 20)]),
}
UNDERCUT = ("keyhole", "dovetail", "lollipop", "T-slot", "thread mill")
SHALLOW = {"T-slot": 1.4, "thread mill": 0.9, "lollipop": 3.5, "dovetail": 3.9}  # mm of flutes
ROUND = ("ball", "bull nose", "bowl", "lollipop", "roundover")


def piece_points(piece, corners):
    points = []
    for r, z in piece:
        count = corners if r > 0 else 1
        for k in range(count):
            angle = 2 * math.pi * (k + 0.5) / count
            points.append((r * math.cos(angle), r * math.sin(angle), z))
    return numpy.array(points)


def chords_of(move, count):
    start, end, turn = move
    if turn is None:
        return [(start, end)]
    points = turn.points(start, end, count)
    return list(zip(points, points[1:]))


class Turn:
    """An arc, or a helix, about a centre in a plane: axes u, v and the normal w."""

    def __init__(self, plane, centre, angle):
        self.plane, self.centre, self.angle = plane, centre, angle
        self.u, self.v, self.w = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}[plane]

    def points(self, start, end, count):
        made = []
        du, dv = start[self.u] - self.centre[0], start[self.v] - self.centre[1]
        for k in range(count + 1):
            a = self.angle * k / count
            point = numpy.array(start, dtype=float)
            point[self.u] = self.centre[0] + du * math.cos(a) - dv * math.sin(a)
            point[self.v] = self.centre[1] + du * math.sin(a) + dv * math.cos(a)
            point[self.w] = start[self.w] + (end[self.w] - start[self.w]) * k / count
            made.append(point)
        return made

    def words(self, start):
        names = {17: "IJ", 18: "KI", 19: "JK"}[self.plane]
        offsets = (self.centre[0] - start[self.u], self.centre[1] - start[self.v])
        centre = " ".join(f"{name}{value:.9f}" for name, value in sorted(zip(names, offsets)))
        return f"G{self.plane} G{'3' if self.angle > 0 else '2'}", centre


def exact_part(tool, moves, corners):
    block = manifold3d.Manifold.cube(BLOCK).translate((0, 0, -BLOCK[2]))
    sweeps = []
    steps = corners // 4 if tool.startswith(ROUND) else 1
    for piece in TOOLS[tool](steps):
        points = piece_points(piece, corners)
        for move in moves:
            for start, end in chords_of(move, corners // 2):
                both = numpy.concatenate([points + start, points + end])
                sweeps.append(manifold3d.Manifold.hull_points(both))
    return manifold3d.Manifold.batch_boolean([block] + sweeps, manifold3d.OpType.Subtract)


def exactly(tool, moves, times=1):
    """The removed volume, and the finer of the two parts, with `times` the usual corners."""
    corners = 32 if tool.startswith("roundover") else 72 if tool.startswith(ROUND) else 120
    if any(move[2] for move in moves):
        corners = min(corners, 48)
    corners *= times
    coarse, fine = (exact_part(tool, moves, n) for n in (corners, 2 * corners))
    block = math.prod(BLOCK)
    return block - fine.volume() + (coarse.volume() - fine.volume()) / 3, fine


def random_turn(rng, at, plane_choice):
    """An arc from `at` that stays within sensible heights; None: try another."""
    plane = rng.choice(plane_choice)
    u, v, w = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}[plane]
    radius = rng.choice([0.8, 2.0, rng.uniform(0.5, 5)])
    direction = rng.uniform(0, 2 * math.pi)
    centre = (at[u] + radius * math.cos(direction), at[v] + radius * math.sin(direction))
    angle = rng.choice([-1, 1]) * rng.choice([math.pi / 2, math.pi, 2 * math.pi, rng.uniform(0.3, 6)])
    turn = Turn(plane, centre, angle)
    end = numpy.array(at, dtype=float)
    if plane == 17 and len(plane_choice) > 1 and rng.random() < 0.4:
        end[2] = rng.uniform(-4.5, -0.3)
    points = turn.points(at, end, 48)
    if not all(-5 < p[2] < -0.2 and -3 < p[0] < BLOCK[0] + 3 and -3 < p[1] < BLOCK[1] + 3 for p in points):
        return None
    return turn, points[-1]


def random_moves(rng, tool):
    """Cuts that follow each other, (start, end, turn); the first goes straight down. Undercutting tools stay
    level."""
    level = tool.startswith(UNDERCUT)
    deepest = min([4.5] + [depth for name, depth in SHALLOW.items() if tool.startswith(name)])

    def point(z=None):
        return numpy.array([rng.uniform(-1, BLOCK[0] + 1), rng.uniform(-1, BLOCK[1] + 1),
                            z if z is not None else rng.uniform(-deepest, -0.3)]).round(6)
    at = point()
    moves = [(numpy.array([at[0], at[1], 5.0]), at, None)]
    for _ in range(rng.randint(1, 8)):
        turned = random_turn(rng, at, [17] if level else [17, 18, 19]) if rng.random() < 0.4 else None
        to = turned[1] if turned else point(at[2] if level or rng.random() < 0.3 else None)
        moves.append((at, to, turned[0] if turned else None))
        at = to
    return moves


def program_of(moves):
    lines = ["G21 G90 G17", "T1 M6", "S9000 M3"]
    start = moves[0][0]
    lines.append(f"G0 Z{start[2]:.4f}")
    lines.append(f"G0 X{start[0]:.6f} Y{start[1]:.6f}")
    for start, end, turn in moves:
        words = f"X{end[0]:.9f} Y{end[1]:.9f} Z{end[2]:.9f}"
        if turn is None:
            lines.append(f"G1 {words} F500")
        else:
            code, centre = turn.words(start)
            lines.append(f"{code} {words} {centre} F500")
    return "\n".join(lines + ["M30", ""])


def cut_by_kerf(kerf, tool, moves, folder, resolution, mesh):
    """The removed volume, and the part as a mesh if that is asked for."""
    program, part = Path(folder) / "job.nc", Path(folder) / "part.stl"
    program.write_text(program_of(moves))
    size = f"0,0,{-BLOCK[2]} to {BLOCK[0]},{BLOCK[1]},0"
    output = ["-o", str(part)] if mesh else []
    words = ["--resolution", str(resolution), "--tool", f"1={tool}", "--stock", size, str(program)]
    run = subprocess.run([kerf, "simulate", "--json", "--no-config"] + words + output, text=True, check=False,
                         stdout=subprocess.PIPE)
    return json.loads(run.stdout)["removed_mm3"], read_stl(part) if mesh else None


def read_stl(path):
    facets = numpy.frombuffer(path.read_bytes()[84:], dtype=[("n", "<3f4"), ("p", "<9f4"), ("a", "<u2")])
    corners = facets["p"].reshape(-1, 3)
    points, index = numpy.unique(corners, axis=0, return_inverse=True)
    mesh = manifold3d.Mesh(vert_properties=numpy.ascontiguousarray(points, dtype=numpy.float32),
                           tri_verts=numpy.ascontiguousarray(index.reshape(-1, 3), dtype=numpy.uint32))
    return manifold3d.Manifold(mesh)


def distances(points, solid):
    """Of the points from the triangles of a solid."""
    mesh = solid.to_mesh()
    corners = numpy.asarray(mesh.vert_properties, dtype=float)[:, :3][numpy.asarray(mesh.tri_verts)]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = numpy.cross(b - a, c - a)
    length = numpy.linalg.norm(normal, axis=1)
    keep = length > 1e-12
    a, b, c, normal = a[keep], b[keep], c[keep], normal[keep] / length[keep, None]
    found = []
    for p in points:
        height = numpy.einsum("ij,ij->i", p - a, normal)
        foot = p - height[:, None] * normal
        inside = numpy.ones(len(a), dtype=bool)
        near = numpy.full(len(a), numpy.inf)
        for s, e in ((a, b), (b, c), (c, a)):
            edge = e - s
            inside &= numpy.einsum("ij,ij->i", numpy.cross(edge, foot - s), normal) >= 0
            t = numpy.clip(numpy.einsum("ij,ij->i", p - s, edge) /
                           numpy.maximum(numpy.einsum("ij,ij->i", edge, edge), 1e-30), 0, 1)
            near = numpy.minimum(near, numpy.linalg.norm(p - s - t[:, None] * edge, axis=1))
        found.append(min(near.min(), numpy.abs(height[inside]).min(initial=numpy.inf)))
    return numpy.array(found)


class Report:
    """What was found at one resolution."""

    def __init__(self):
        self.volumes, self.mean, self.vertices = [], [], []

    def line(self, resolution):
        text = f"{resolution:5g} mm: volumes off by " + quantiles(self.volumes, 100, "%")
        if self.mean:
            text += "; meshes by " + quantiles(self.mean, 1000, " um") + " on average"
            text += ", their vertices by " + quantiles(self.vertices, 1000, " um")
        return text


def quantiles(values, scale, unit):
    if not values:
        return "nothing"
    at = [numpy.quantile(values, q) * scale for q in (0.5, 0.95, 1.0)]
    return f"{at[0]:.2g}, {at[1]:.2g}, {at[2]:.2g}{unit}"


def compare_mesh(mesh, exact, rng, report):
    """False if the mesh is not closed."""
    if mesh.status() != manifold3d.Error.NoError:
        return False
    differing = (mesh - exact).volume() + (exact - mesh).volume()
    report.mean.append(differing / exact.surface_area())
    points = numpy.asarray(mesh.to_mesh().vert_properties, dtype=float)[:, :3]
    chosen = points[rng.sample(range(len(points)), min(SAMPLES, len(points)))]
    report.vertices.extend(distances(chosen, exact))
    return True


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("kerf")
    parser.add_argument("count", nargs="?", type=int, default=200)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("--resolutions", default=str(FINE))
    parser.add_argument("--meshes", type=int, default=0)
    given = parser.parse_args()
    resolutions = [float(text) for text in given.resolutions.split(",")]
    reports = {resolution: Report() for resolution in resolutions}
    failed = 0
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(given.seed, given.seed + given.count):
            rng = random.Random(number)
            tool = rng.choice(sorted(TOOLS))
            moves = random_moves(rng, tool)
            print(f"\r{number}: {tool}", end="        ", file=sys.stderr, flush=True)
            want, exact = exactly(tool, moves)
            for resolution, report in reports.items():
                with_mesh = given.meshes > 0 and number % given.meshes == 0
                have, mesh = cut_by_kerf(given.kerf, tool, moves, folder, resolution, with_mesh)
                error = abs(have - want) / max(want, ENOUGH)
                if resolution == FINE and error > TOLERANCE:  # which of the two is not exact?
                    want, exact = exactly(tool, moves, 2)
                    error = abs(have - want) / max(want, ENOUGH)
                report.volumes.append(error)
                if resolution == FINE and error > TOLERANCE:
                    failed += 1
                    print(f"\nseed {number}: {tool}, {len(moves)} moves: kerf {have:.5f}, booleans "
                          f"{want:.5f} mm3, off by {error:.1e}", flush=True)
                if mesh is not None and not compare_mesh(mesh, exact, rng, report):
                    failed += 1
                    print(f"seed {number}, {resolution} mm: the mesh is not closed", flush=True)
    seconds = time.monotonic() - started
    print(f"\n{given.count} jobs in {seconds:.0f} s, {failed} failed; median, 95% and maximum:")
    for resolution, report in reports.items():
        print(report.line(resolution))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

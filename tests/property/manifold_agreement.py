"""Random jobs cut by kerf and by exact mesh booleans (manifold3d): the removed volumes have to agree.

    python tests/property/manifold_agreement.py KERF [COUNT] [SEED]

Needs the package manifold3d. The booleans use polygonal tools; each job is computed with two numbers of
corners, and the error, proportional to the square of the corners' angle, is extrapolated to zero. Exit
status 1 if a job differs by more than 2e-4 of its removed volume, 77 if manifold3d is not installed.
"""
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import manifold3d
    import numpy
except ImportError:
    print("manifold3d is not installed: nothing is compared")
    sys.exit(77)

RESOLUTION = 0.02  # mm
TOLERANCE = 2e-4  # of the removed volume
BLOCK = (14.0, 11.0, 6.0)

# Convex parts as half profiles [(r, z), ...] from the tip upwards, or a ball of a radius up to a height.
TOOLS = {
    "square d=3 flute=20": [[(1.5, 0), (1.5, 20)]],
    "ball d=3 flute=20": [["ball", 1.5, 20]],
    "V d=6 angle=90 flute=20": [[(0, 0), (3, 3), (3, 20)]],
    "keyhole d=5 neck=2.5 head=2 flute=20": [[(2.5, 0), (2.5, 2)], [(1.25, 0), (1.25, 20)]],
    "dovetail d=5 angle=14 flute=4": [[(2.5, 0), (2.5 - 4 * math.tan(math.radians(14)), 4)]],
}


def profile_points(piece, corners):
    if piece[0] != "ball":
        return piece
    radius, top = piece[1], piece[2]
    steps = corners // 4
    arc = [(radius * math.sin(a), radius - radius * math.cos(a)) for a in
           (0.5 * math.pi * k / steps for k in range(steps + 1))]
    return arc + [(radius, top)]


def piece_points(piece, corners):
    points = []
    for r, z in profile_points(piece, corners):
        count = corners if r > 0 else 1
        for k in range(count):
            angle = 2 * math.pi * (k + 0.5) / count
            points.append((r * math.cos(angle), r * math.sin(angle), z))
    return numpy.array(points)


def removed_exactly(tool, moves, corners):
    block = manifold3d.Manifold.cube(BLOCK).translate((0, 0, -BLOCK[2]))
    sweeps = []
    for piece in TOOLS[tool]:
        points = piece_points(piece, corners)
        for start, end in moves:
            sweeps.append(manifold3d.Manifold.hull_points(numpy.concatenate([points + start, points + end])))
    left = manifold3d.Manifold.batch_boolean([block] + sweeps, manifold3d.OpType.Subtract)
    return block.volume() - left.volume()


def extrapolated(tool, moves):
    corners = 96 if tool.startswith("ball") else 180
    coarse, fine = (removed_exactly(tool, moves, n) for n in (corners, 2 * corners))
    return fine + (fine - coarse) / 3


def random_moves(rng, tool):
    """Cuts that follow each other; the first goes straight down. Undercutting tools stay level."""
    def point(z=None):
        return numpy.array([rng.uniform(-1, BLOCK[0] + 1), rng.uniform(-1, BLOCK[1] + 1),
                            z if z is not None else rng.uniform(-4.5, -0.3)])
    level = tool.startswith(("keyhole", "dovetail"))
    at = point(rng.uniform(-3.9, -0.3) if level else None)  # a dovetail's flutes are 4 mm long
    moves = [(numpy.array([at[0], at[1], 5.0]), at)]
    for _ in range(rng.randint(1, 8)):
        to = point(at[2] if level or rng.random() < 0.3 else None)
        moves.append((at, to))
        at = to
    return moves


def removed_by_kerf(kerf, tool, moves, folder):
    lines = ["G21 G90 G17", "T1 M6", "S9000 M3"]
    start = moves[0][0]
    lines.append(f"G0 Z{start[2]:.4f}")
    lines.append(f"G0 X{start[0]:.6f} Y{start[1]:.6f}")
    lines += [f"G1 X{to[0]:.6f} Y{to[1]:.6f} Z{to[2]:.6f} F500" for _, to in moves]
    program = Path(folder) / "job.nc"
    program.write_text("\n".join(lines + ["M30", ""]))
    size = f"0,0,{-BLOCK[2]} to {BLOCK[0]},{BLOCK[1]},0"
    run = subprocess.run([kerf, "simulate", "--json", "--resolution", str(RESOLUTION), "--tool", f"1={tool}",
                          "--stock", size, str(program)], stdout=subprocess.PIPE, text=True)
    return json.loads(run.stdout)["removed_mm3"]


def main():
    kerf = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    worst, failed = 0.0, 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(seed, seed + count):
            rng = random.Random(number)
            tool = rng.choice(sorted(TOOLS))
            moves = [(start.round(6), end.round(6)) for start, end in random_moves(rng, tool)]
            want, have = extrapolated(tool, moves), removed_by_kerf(kerf, tool, moves, folder)
            error = abs(have - want) / max(want, 1e-9)
            worst = max(worst, error)
            if error > TOLERANCE:
                failed += 1
                print(f"seed {number}: {tool}, {len(moves)} moves: kerf {have:.5f}, booleans {want:.5f} mm3, "
                      f"off by {error:.1e}", flush=True)
    print(f"{count} jobs, {failed} off by more than {TOLERANCE:g}; worst {worst:.1e}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

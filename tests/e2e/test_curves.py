"""G5, G5.1 and G5.2: the interiors of curves. The points come from de Casteljau's and de Boor's rules."""
import json
import math
import random

import pytest

CHORD = 0.002    # mm, the documented deviation of chords
ROUNDING = 1e-9


def bezier(points, t):
    while len(points) > 1:
        points = [tuple(a + t * (b - a) for a, b in zip(p, q)) for p, q in zip(points, points[1:])]
    return points[0]


def nurbs(points, weights, order, t):
    """The point of a clamped uniform rational curve with the parameter t in [0, 1], by de Boor's rule."""
    count, degree = len(points), order - 1
    inner = count - degree
    knots = [0.0] * degree + [k / inner for k in range(inner + 1)] + [1.0] * degree
    k = min(max(i for i in range(count) if knots[i] <= t), count - 1)
    d = [(points[i][0] * weights[i], points[i][1] * weights[i], weights[i]) for i in range(k - degree, k + 1)]
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            i = j + k - degree
            span = knots[i + degree - r + 1] - knots[i]
            a = (t - knots[i]) / span if span else 0.0
            d[j] = tuple((1 - a) * u + a * v for u, v in zip(d[j - 1], d[j]))
    x, y, w = d[degree]
    return x / w, y / w


def cuts_of(kerf, path):
    """The ends of the cuts of each line, with the point before."""
    run = kerf("steps", "--dialect", "linuxcnc", path)
    assert run.status == 0, run.err
    lines, at = {}, (0.0, 0.0)
    for text in run.out.splitlines()[1:]:
        step = json.loads(text)
        if step["step"] not in ("cut", "rapid"):
            continue
        to = tuple(step["to"][:2])
        if step["step"] == "cut":
            lines.setdefault(step["origin"]["line"], [at]).append(to)
        at = to
    return lines


def distance_to_chords(point, chords):
    best = math.inf
    for (ax, ay), (bx, by) in zip(chords, chords[1:]):
        dx, dy = bx - ax, by - ay
        length = dx * dx + dy * dy
        t = 0.0 if length == 0 else max(0.0, min(1.0, ((point[0] - ax) * dx + (point[1] - ay) * dy) / length))
        best = min(best, math.hypot(point[0] - ax - t * dx, point[1] - ay - t * dy))
    return best


def check(chords, curve):
    dense = [curve(n / 1500) for n in range(1501)]
    assert max(distance_to_chords(p, chords) for p in dense[::15]) < CHORD + 1e-6
    assert max(distance_to_chords(p, dense) for p in chords[::7]) < 1e-3
    assert chords[-1] == pytest.approx(dense[-1], abs=ROUNDING)


@pytest.mark.parametrize("seed", range(4))
def test_cubic_and_quadratic_curves(kerf, program, seed):
    make = random.Random(seed)
    number = lambda: round(make.uniform(-30, 30), 3)
    lines, curves, at = ["G21 G90 G17 F500", "G0 X0 Y0"], {}, (0.0, 0.0)
    for _ in range(5):
        i, j, p, q, x, y = (number() for _ in range(6))
        end = (round(at[0] + x, 3), round(at[1] + y, 3))
        if make.random() < 0.6:
            lines.append(f"G5 I{i} J{j} P{p} Q{q} X{end[0]} Y{end[1]}")
            curves[len(lines)] = [at, (at[0] + i, at[1] + j), (end[0] + p, end[1] + q), end]
        else:
            lines.append(f"G5.1 I{i} J{j} X{end[0]} Y{end[1]}")
            curves[len(lines)] = [at, (at[0] + i, at[1] + j), end]
        at = end
    cuts = cuts_of(kerf, program("\n".join(lines) + "\nM2\n"))
    for line, points in curves.items():
        check(cuts[line], lambda t: bezier(points, t))


def test_a_chained_cubic_continues_the_tangent(kerf, program):
    """Without I and J the first control point mirrors the last one of the curve before."""
    text = "G21 G90 G17 F500\nG0 X0 Y0\nG5 I5 J10 P-4 Q6 X30 Y0\nG5 P-3 Q-8 X60 Y5\nM2\n"
    cuts = cuts_of(kerf, program(text))
    check(cuts[4], lambda t: bezier([(30, 0), (34, -6), (57, -3), (60, 5)], t))


@pytest.mark.parametrize("order", [3, 4])
def test_nurbs(kerf, program, order):
    points, weights = [(0, 0), (10, 15), (25, -5), (30, 20), (45, 5)], [1, 2, 0.5, 1, 1]
    lines = ["G21 G90 G17 F500", "G0 X0 Y0", f"G5.2 X10 Y15 P2 L{order}", "X25 Y-5 P0.5", "X30 Y20 P1",
             "X45 Y5 P1", "G5.3", "M2"]
    cuts = cuts_of(kerf, program("\n".join(lines) + "\n"))
    chords = [point for line in sorted(cuts) for point in cuts[line]]
    check(chords, lambda t: nurbs(points, weights, order, t))

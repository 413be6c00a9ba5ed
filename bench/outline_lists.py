"""Corners and curves through the Python lists: ten thousand of each kind.

    PYTHONPATH=build/python python3 bench/outline_lists.py

Prints milliseconds (the best of many runs) beside what Cnc25D's own code needs on CPython 3.11 for the same.
"""
import math
import time

import cnc25d_api as api

CORNERS = 10000
PEER_MS = {"line-line smooth": 28, "line-arc smooth": 136, "line-arc enlarge": 249, "arc-arc smooth": 203,
           "arc-arc enlarge": 362, "curve c": 73, "curve b": 97, "rotate": 7, "reverse": 4, "unchanged": 9}


def saw(kind, request):
    outline = [[0, 0, 0]]
    for i in range(1, CORNERS + 2):
        (x0, y0), (x, y) = outline[-1][-3:-1], (20.0 * i, 0.0 if i % 2 == 0 else 15.0)
        hx, hy = (x - x0) / 2, (y - y0) / 2
        arc = kind == "arc-arc" or (kind == "line-arc" and i % 2 == 0)
        via = [x0 + hx - 0.2 * hy, y0 + hy + 0.2 * hx] if arc else []
        outline.append(via + [x, y, request if i <= CORNERS else 0])
    return outline


def spiral():
    samples = []
    for i in range(CORNERS + 1):
        t = 0.05 * i
        samples.append([(50 + t) * math.cos(t), (50 + t) * math.sin(t),
                        math.remainder(t + math.atan2(50 + t, 1), 2 * math.pi)])
    return samples


def best(call, runs=15):
    times = []
    for _ in range(runs):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def main():
    jobs = {"unchanged": lambda o=saw("line-line", 0): api.cnc_cut_outline(o, "bench")}
    for kind in ("line-line", "line-arc", "arc-arc"):
        for what, request in (("smooth", 2), ("enlarge", -2)):
            jobs[f"{kind} {what}"] = lambda o=saw(kind, request): api.cnc_cut_outline(o, "bench")
    curve = spiral()
    points = [p[:2] for p in curve]
    jobs["curve c"] = lambda: api.smooth_outline_c_curve(curve, math.pi / 1000, 0, "bench")
    jobs["curve b"] = lambda: api.smooth_outline_b_curve(points, math.pi / 1000, 0, "bench")
    jobs["rotate"] = lambda: api.outline_rotate(points, 1, 2, 0.3)
    jobs["reverse"] = lambda: api.outline_reverse(points)
    for name, job in jobs.items():
        ms = best(job)
        peer = PEER_MS.get(name)
        print(f"{name:<18} {ms:8.3f} ms" + (f"   Cnc25D {peer} ms, {peer / ms:.0f} times" if peer else ""))


if __name__ == "__main__":
    main()

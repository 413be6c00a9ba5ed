"""Brings a cut outline into the form that verify.py of the given cases checks: one record per corner."""
import math


def circle_of(a, b, c):
    ux, uy, vx, vy = a[0] - b[0], a[1] - b[1], c[0] - b[0], c[1] - b[1]
    d = 2 * (ux * vy - uy * vx)
    if abs(d) <= 2e-6 * math.hypot(ux, uy) * math.hypot(vx, vy):
        return None
    uu, vv = ux * ux + uy * uy, vx * vx + vy * vy
    return b[0] + (vy * uu - uy * vv) / d, b[1] + (ux * vv - vx * uu) / d, 1 if d < 0 else -1


def midpoint(row, start, a, b):
    """The midpoint of the part a..b of the arc that `row` describes, which starts at `start`; None for a
    line."""
    if len(row) != 5:
        return None
    circle = circle_of(start, row[:2], row[2:4])
    if circle is None:
        return None
    x, y, turn = circle
    start_angle = math.atan2(a[1] - y, a[0] - x)
    sweep = (turn * (math.atan2(b[1] - y, b[0] - x) - start_angle)) % (2 * math.pi)
    angle, radius = start_angle + turn * sweep / 2, math.hypot(start[0] - x, start[1] - y)
    return x + radius * math.cos(angle), y + radius * math.sin(angle)


def point(outline, i):
    return tuple(outline[i][-3:-1])


def corner_records(outline, result, reports):
    """The records of all corners with a request, in order of elements."""
    n = len(outline)
    closed = point(outline, 0) == point(outline, n - 1)
    by = {r["element"]: r for r in reports}
    records, here = [], tuple(result[0])
    if closed and 0 in by and by[0]["count"]:
        here = tuple(result[by[0]["count"] - 1][-2:])
    for i in range(0 if closed else 1, n - 1):
        report = by.get(i)
        before, start = (n - 1, point(outline, n - 2)) if i == 0 else (i, point(outline, i - 1))
        at = point(outline, i)
        pre = start if i == 0 else here
        post = tuple(result[0]) if closed and i == n - 2 else point(outline, i + 1)
        out = [list(at)]
        if report and report["count"]:
            out = [list(row) for row in result[report["first"]:report["first"] + report["count"]]]
            out[0] = out[0][-2:]
        if i > 0:
            here = tuple(out[-1][-2:])
        if report:
            request = outline[i][-1]
            records.append({"corner": i, "at": at, "request": request, "out": out, "pre": pre, "post": post,
                            "pre_mid": midpoint(outline[before], start, pre, at),
                            "post_mid": midpoint(outline[i + 1], at, at, post), "report": report})
    return records

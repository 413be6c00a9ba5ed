"""Comparison of a toolpath with recorded motions, which have chords where the toolpath has arcs."""

import json
import math

EQUAL = 1e-6  # mm


def recorded(path):
    """The recorded motions that have a length: (kind, start, end)."""
    with open(path) as file:
        events = json.load(file)
    return [
        (e["kind"], tuple(e["b"]), tuple(e["e"]))
        for e in events
        if e["ev"] == "move" and math.dist(e["b"], e["e"]) > EQUAL
    ]


def motions(path):
    """The motions of a toolpath that have a length: (kind, end, centre, turn, origin)."""
    result, here = [], None
    for i in range(len(path)):
        step = path[i]
        if "to" not in step or (step["step"] == "extrude" and step["volume"] < 0):
            continue
        if here is None or step["step"] == "arc" or math.dist(step["to"], here) > EQUAL:
            at = f"{step['origin']['file']}:{step['origin']['line']}"
            result.append((step["step"], step["to"], step.get("centre"), step.get("turn"), at))
        here = step["to"]
    return result


def _angle(p, centre, start, turn):
    a = math.degrees(
        math.atan2(p[1] - centre[1], p[0] - centre[0])
        - math.atan2(start[1] - centre[1], start[0] - centre[0])
    )
    return (a if turn == "ccw" else -a) % 360


def _follow_arc(rows, k, start, end, centre, turn):
    """The index after the chords of an arc; each must end on its helix, and may stop one step before its
    end.
    """
    radius, sweep = math.dist(start[:2], centre), _angle(end, centre, start, turn)
    while k < len(rows):
        kind, _, at = rows[k]
        passed = _angle(at, centre, start, turn)
        if kind != "cut" or abs(math.dist(at[:2], centre) - radius) > EQUAL or passed > sweep + EQUAL:
            break
        k += 1
        if math.dist(at, end) < EQUAL:
            return k
    return k


def differences(path, rows):
    """Texts, one for each motion that differs; empty if the motions are the same."""
    found, k, here = [], 0, (0.0, 0.0, 0.0)
    for kind, end, centre, turn, origin in motions(path):
        if kind == "arc":
            before = k
            k = _follow_arc(rows, k, here, end, centre, turn)
            if k == before:
                found.append(f"{origin}: arc to {end} is not recorded")
        elif k < len(rows) and math.dist(rows[k][2], end) <= EQUAL and rows[k][0][0] == kind[0]:
            k += 1
        elif math.dist(here, end) > EQUAL:
            found.append(f"{origin}: {kind} to {end}; recorded: {rows[k] if k < len(rows) else 'nothing'}")
        here = end
    found += [f"recorded {row} is missing" for row in rows[k : k + 3]]
    return found

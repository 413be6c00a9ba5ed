"""Kerf's moves of a G-code program, in the form of rs274.moves_of: (kind, x, y, z), None for an axis whose
position is unknown in work coordinates; of arcs also (u, v, turns)."""
import json
import os
import subprocess

KINDS = {"rapid": "R", "cut": "C", "arc": "A", "dwell": "D"}


def kerf_moves(path, *options):
    """The moves, the exit status and the messages."""
    command = [os.environ["KERF"], "steps", *options, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    moves = []
    for line in done.stdout.splitlines():
        step = json.loads(line)
        kind = KINDS.get(step.get("step"))
        lost = step.get("unknown_axes", [])
        to = [None if axis in lost else at for axis, at in zip("XYZ", step.get("to", []))]
        if kind == "D":
            moves.append((kind, step["seconds"]))
        elif kind == "A":
            turns = (step["extra_turns"] + 1) * (-1 if step["turn"] == "cw" else 1)
            moves.append((kind, *to, *step["centre"], turns))
        elif kind:
            moves.append((kind, *to))
    return moves, done.returncode, done.stderr


def same_move(one, other, slack):
    """Whether both moves are the same, as far as the position of `one` is known."""
    return len(one) == len(other) and one[0] == other[0] and all(
        a is None or abs(a - b) <= slack for a, b in zip(one[1:], other[1:]))

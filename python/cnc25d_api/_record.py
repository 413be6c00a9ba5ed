"""Outlines of a script for `kerf outline FILE.py`: those that it cuts are written to $KERF_OUTLINES."""

import atexit
import json
import os

_noted = []


def record_cut(outline, name):
    """Record an outline of format A that has been cut; False without $KERF_OUTLINES.

    `kerf outline` cuts the recorded outlines again and prints the warnings.
    """
    target = os.environ.get("KERF_OUTLINES")
    if not target:
        return False
    if not _noted:
        atexit.register(_write, target)
    _noted.append(_described(outline, name or f"outline{len(_noted)}"))
    return True


def _described(outline, name):
    rows = [[float(number) for number in row] for row in outline]
    segments = []
    for row in rows[1:]:
        segment = {"to": row[-3:-1], "corner": row[-1]}
        if len(row) == 5:
            segment["via"] = row[:2]
        segments.append(segment)
    first = {"at": rows[0][:2], "corner": rows[0][2]}
    return {"name": name, "closed": rows[0][:2] == rows[-1][-3:-1], "first": first, "segments": segments}


def _write(target):
    with open(target, "w", encoding="utf-8") as file:
        json.dump({"unit": "mm", "outlines": _noted}, file)

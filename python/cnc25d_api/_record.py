"""`kerf outline FILE.py` asks a script for its outlines: those that it cuts are noted in a file."""

import atexit
import json
import os

_noted = []


def record_cut(outline, name):
    """Note an outline of format A that was cut. False where nobody asked; who asks cuts it again and says
    what stays sharp."""
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

"""Every word of LinuxCNC's quick reference: the expectations of tests/data/gcode/words.txt are what LinuxCNC
does, or the row explains the difference."""
import re
from pathlib import Path

import pytest
import rs274

if not rs274.is_installed():
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)

KEYS = ("show", "run ", "=   ", "othe")
TABLE = Path(__file__).parent.parent / "data" / "gcode" / "words.txt"
SLACK = 1e-4       # mm, of four printed decimals
INCH_SLACK = 3e-3  # the same in inches


def rows():
    """(name, program, events, what LinuxCNC does instead or None) for each program of the table."""
    found = []
    for block in TABLE.read_text().split("\n\n"):
        lines = dict(line.split(None, 1) for line in block.splitlines() if line[:4] in KEYS)
        if "run" in lines:
            name = lines["show"].split(" | ")[0]
            found.append((name, lines["run"], lines["="].split("; "), lines.get("other")))
    return found


def comparable(events, program):
    """Without what only the interpreter has: path modes switched by its cycles, a stop before each reversal
    of the spindle, what the end switches off, and the points of curves."""
    kept = []
    for event in events:
        if event.startswith("P ") and not re.search(r"G6[14]", program):
            continue
        if event.startswith("S ") and kept[-1:] == ["S 0 off"]:
            kept.pop()
        if event == "end":
            while kept and kept[-1] in ("S 0 off", "K off", "M60"):  # a pallet change belongs to M30
                kept.pop()
            return kept + [event]
        kept.append("N" if event.startswith("N ") else event)
    return kept


def same(one, other, slack):
    a, b = one.split(), other.split()
    if len(a) != len(b):
        return False
    for left, right in zip(a, b):
        try:
            if abs(float(left) - float(right)) > slack:
                return False
        except ValueError:
            if left != right:
                return False
    return True


@pytest.mark.parametrize("program, events, other", [pytest.param(*row[1:], id=row[0]) for row in rows()])
def test_word(program, events, other):
    done, refused = rs274.events_of(program.replace("|", "\n") + "\n")
    slack = INCH_SLACK if "G20" in program else SLACK
    wanted, got = comparable(events, program), comparable(done, program)
    agree = not refused and len(got) == len(wanted) and all(same(a, b, slack) for a, b in zip(got, wanted))
    if other:
        assert not agree, "LinuxCNC does the same now; the row's 'other' can go"
    else:
        assert not refused, refused
        assert agree, (got, wanted)

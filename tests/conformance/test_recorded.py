"""Random programs with the moves that LinuxCNC's interpreter made of them, recorded in
tests/data/gcode/recorded.txt: Kerf's moves equal them, and so do those of the programs that the posts write
of them, as a plain reader reads these."""
import math
import os
import subprocess
from pathlib import Path

import pytest
from kerf_moves import kerf_moves, same_move
from plain_gcode import Reader

TABLE = Path(__file__).parent.parent / "data" / "gcode" / "recorded.txt"
SLACK = 2e-4          # mm: four decimals are recorded
INCH_SLACK = 6e-3     # the same in inches, and the sum of two
POST_SLACK = 1e-3     # mm: posts write three decimals
OTHER_VERDICTS = {"compensated": 2}  # see test_interpreter.py
MIN_COMPARED = {"moves": 14, "arcs": 8, "cycles": 8, "computed": 14, "compensated": 3, "offsets": 12}


def numbers(move):
    kind, *words = move.split()
    return (kind, *(float(w) for w in words if w not in ("c", "t")))


def records():
    found = {}
    for block in TABLE.read_text().split("\n\n")[1:]:
        head, program, moves = block.strip().split("\n")
        _, family, seed = head.split()
        wanted = None if moves == "!" else [numbers(m) for m in moves[2:].split("; ") if m]
        found.setdefault(family, []).append((seed, program.replace("|", "\n") + "\n", wanted))
    return found


RECORDS = records()


@pytest.mark.parametrize("family", RECORDS)
def test_moves(family, tmp_path):
    path, compared, other_verdicts = tmp_path / "part.ngc", 0, []
    for seed, text, wanted in RECORDS[family]:
        path.write_text(text)
        found, status, messages = kerf_moves(path, "--dialect", "linuxcnc")
        if (wanted is None) != (status != 0):
            other_verdicts.append((seed, messages))
        elif wanted is not None:
            assert len(found) == len(wanted), (seed, text)
            for i, (mine, theirs) in enumerate(zip(found, wanted)):
                slack = INCH_SLACK if "G20" in text else SLACK
                assert same_move(mine, theirs, slack), (seed, i, mine, theirs, text)
            compared += 1
    assert len(other_verdicts) <= OTHER_VERDICTS.get(family, 0), other_verdicts
    assert compared >= MIN_COMPARED[family]


def length_of(moves):
    """The lengths of cuts and rapids of the recorded moves that start at X0 Y0 Z0."""
    at, cut, rapid = (0.0, 0.0, 0.0), 0.0, 0.0
    for kind, *words in moves:
        if kind == "D":
            continue
        end = tuple(words[:3])
        assert kind != "A"
        if kind == "R":
            rapid += math.dist(at, end)
        else:
            cut += math.dist(at, end)
        at = end
    return cut, rapid


def visits(read, wanted):
    """Whether the end points of the recorded moves are visited in their order; arcs may be divided."""
    rest = iter(m for m in read if m[0] != "D")
    for kind, *words in wanted:
        if kind == "D":
            continue
        end = words[:3]
        for _, *at in rest:
            if all(abs(a - b) <= POST_SLACK for a, b in zip(at, end)):
                break
        else:
            return kind, end
    return None


@pytest.mark.parametrize("post", ["linuxcnc", "grbl"])
@pytest.mark.parametrize("family", ["arcs", "cycles", "compensated"])  # work offsets are not written
def test_posts(family, post, tmp_path):
    path, out, compared = tmp_path / "part.ngc", tmp_path / "out.nc", 0
    for seed, text, wanted in RECORDS[family]:
        if wanted is None:
            continue
        path.write_text(text)
        command = [os.environ["KERF"], "post", "--to", post, "--dialect", "linuxcnc", str(path), "-o"]
        done = subprocess.run([*command, str(out)], capture_output=True, text=True, timeout=60)
        if done.returncode != 0:  # a path that this controller cannot run
            continue
        reader = Reader().read(out.read_text())
        missed = visits(reader.moves, wanted)
        assert missed is None, (seed, missed, text, out.read_text())
        if all(m[0] != "A" for m in wanted):
            cut, rapid = length_of(wanted)
            assert math.isclose(reader.cut_length, cut, abs_tol=0.01 * len(wanted)), (seed, text)
            assert math.isclose(reader.rapid_length, rapid, abs_tol=0.01 * len(wanted)), (seed, text)
        compared += 1
    assert compared >= MIN_COMPARED[family]

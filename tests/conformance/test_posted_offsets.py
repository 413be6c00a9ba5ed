"""Programs that use stored work offsets, homes and lengths of tools: what the post for LinuxCNC
writes of them moves a machine with random ones as the program itself does."""
import os
import subprocess

import pytest
import random_gcode
import rs274

if not rs274.is_installed():
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)

PROGRAMS = 60
SLACK = 6e-3         # mm: four decimals of an inch in the interpreter's output, of mm in the post
MIN_MOVES = 300      # compared in each run
# What cannot be written, as part of its message, and how many programs of each run may have it.
REFUSED = {"G52 after a G92 at an unknown position": 6,
           "axes move in machine coordinates and in work coordinates at once": 24}


def visited(moves):
    """Without moves to the position of the tool, which the post may leave out."""
    kept = []
    for move in moves:
        stays = kept and move[0] != "A" and close(move[1:], kept[-1][1:4])
        if move[0] != "D" and not stays:
            kept.append(move)
    return kept


def close(one, other):
    return len(one) == len(other) and all(abs(a - b) <= SLACK for a, b in zip(one, other))


@pytest.mark.parametrize("unit", ["--mm", "--inch"])
@pytest.mark.parametrize("make", [random_gcode.unset_offsets, random_gcode.offsets], ids=lambda f: f.__name__)
def test_machine_moves(make, unit, tmp_path):
    path, out = tmp_path / "part.ngc", tmp_path / "out.ngc"
    compared, refusals = 0, dict.fromkeys(REFUSED, 0)
    for seed in range(PROGRAMS):
        text, machine = make(seed), random_gcode.machine(seed)
        path.write_text(text)
        wanted, error = rs274.machine_moves_of(text, *machine)
        if error:
            continue
        command = [os.environ["KERF"], "post", "--to", "linuxcnc", "--dialect", "linuxcnc", unit, str(path)]
        done = subprocess.run([*command, "-o", str(out)], capture_output=True, text=True, timeout=60)
        if done.returncode != 0:
            reasons = [reason for reason in REFUSED if reason in done.stderr]
            assert reasons, (seed, done.stderr, text)
            refusals[reasons[0]] += 1
            continue
        found, error = rs274.machine_moves_of(out.read_text(), *machine)
        assert not error, (seed, error, text, out.read_text())
        wanted, found = visited(wanted), visited(found)
        assert len(found) == len(wanted), (seed, text, out.read_text())
        for i, (mine, theirs) in enumerate(zip(found, wanted)):
            assert mine[0] == theirs[0] and close(mine[1:], theirs[1:]), (seed, i, mine, theirs, text)
        compared += len(wanted)
    assert compared >= MIN_MOVES
    assert all(refusals[reason] <= limit for reason, limit in REFUSED.items()), refusals

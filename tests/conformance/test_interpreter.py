"""Random programs: Kerf's moves equal those of LinuxCNC's interpreter; what it refuses is an error."""
import pytest
import random_gcode
import rs274
from kerf_moves import kerf_moves, same_move

if not rs274.is_installed():
    pytest.skip("rs274 is not installed (linuxcnc-uspace)", allow_module_level=True)

PROGRAMS = 80
MIN_MOVES = 300  # compared in each family
SLACK = 2e-4  # mm at sizes of random_gcode.SCALE: rounding to four printed decimals
# Compensated paths that only one of the two refuses as gouges: LinuxCNC does not examine every segment that
# is shortened beyond its start point, and its test is coarser.
OTHER_VERDICTS = {"compensated": 4}
INCH = {"offsets"}  # families with inches: rounding to four decimals of an inch
INCH_SLACK = 6e-3   # mm; the sum of two rounded numbers
LOSE = {"offsets"}  # families after whose lines the position of an axis may be unknown
MIN_KNOWN = 0.8     # of the coordinates of these


@pytest.mark.parametrize("family", random_gcode.FAMILIES)
def test_moves(family, tmp_path):
    path = tmp_path / "part.ngc"
    other_verdicts, compared, unknown = [], 0, 0
    slack = INCH_SLACK if family in INCH else SLACK
    for seed in range(PROGRAMS):
        text = random_gcode.FAMILIES[family](seed)
        path.write_text(text)
        plain = random_gcode.without_checksums(text) if family == "checksums" else text
        wanted, refused = rs274.moves_of(plain)
        found, status, messages = kerf_moves(path, "--dialect", "linuxcnc")
        if refused == "Command too long":
            continue  # its limit of 255 characters is not Kerf's
        if bool(refused) != (status != 0):
            other_verdicts.append((seed, refused, messages))
            continue
        if refused:
            continue
        assert len(found) == len(wanted), (seed, text)
        for i, (mine, theirs) in enumerate(zip(found, wanted)):
            assert same_move(mine, theirs, slack), (seed, i, mine, theirs, text)
        compared += len(wanted)
        unknown += sum(word is None for move in found for word in move)
    assert compared >= MIN_MOVES
    assert unknown <= (3 * compared * (1 - MIN_KNOWN) if family in LOSE else 0)
    assert len(other_verdicts) <= OTHER_VERDICTS.get(family, 0), other_verdicts

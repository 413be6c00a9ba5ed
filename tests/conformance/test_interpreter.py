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


@pytest.mark.parametrize("family", random_gcode.FAMILIES)
def test_moves(family, tmp_path):
    path = tmp_path / "part.ngc"
    other_verdicts, compared = [], 0
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
            assert same_move(mine, theirs, SLACK), (seed, i, mine, theirs, text)
        compared += len(wanted)
    assert compared >= MIN_MOVES
    assert len(other_verdicts) <= OTHER_VERDICTS.get(family, 0), other_verdicts


@pytest.mark.parametrize("post", ["linuxcnc", "mach3"])
def test_several_work_offsets_through_posts(post, tmp_path):
    """The program that the post writes moves in LinuxCNC as the original does."""
    path, out = tmp_path / "part.ngc", tmp_path / "out.ngc"
    written = 0
    for seed in range(PROGRAMS // 2):
        text = random_gcode.offsets(seed)
        path.write_text(text)
        wanted, refused = rs274.moves_of(text)
        if refused:
            continue
        command = [os.environ["KERF"], "post", "-q", "--dialect", "linuxcnc", "--to", post]
        command += [str(path), "-o", str(out)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        if done.returncode != 0:
            continue  # refused, with the line
        posted = "\n".join(line for line in out.read_text().splitlines() if not line.startswith("("))
        found, refused = rs274.moves_of(posted + "\n")
        assert not refused, (seed, refused, text, posted)
        assert ends(found) == pytest.approx(ends(wanted), abs=2e-3), (seed, text, posted)
        written += 1
    assert written > PROGRAMS // 8


def ends(moves):
    """The distinct ends of straight moves, in order: posts divide circles and write moves of length 0."""
    points = []
    for kind, *to in moves:
        if kind in "RC" and (not points or max(abs(a - b) for a, b in zip(points[-1], to)) > 1e-3):
            points.append(to)
    return [value for point in points for value in point]

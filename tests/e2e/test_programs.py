"""Reading programs: the options of all commands, and the files that a program was read from."""
import pytest

FEED = 'feedrate(200mm);\ntoolchange(102);\ngoto([-, -, 5mm]);\n'
HOLE = 'goto([x, 0mm]);\nmove([-, -, -1mm]);\ngoto([-, -, 5mm]);\n'


@pytest.fixture
def folder(tmp_path):
    """A program that needs a define and a file from another folder."""
    (tmp_path / "library").mkdir()
    (tmp_path / "library" / "hole.inc.gcmc").write_text(HOLE)
    (tmp_path / "part.gcmc").write_text(FEED + 'include("hole.inc.gcmc");\n')
    return tmp_path


# A hole, the program's end, and another hole.
TWO_PROGRAMS = """(STOCK/BLOCK, 20, 10, 5, 0, 0, 5)
G21 G90
T102 M6
M3 S9000
G0 X5 Y5 Z2
G1 Z-2 F100
G0 Z2
M30
G0 X15 Y5
G1 Z-2 F100
G0 Z2
M30
"""
GIVEN = ["-D", "x=7mm", "--include", "library"]


@pytest.mark.parametrize("command", [["info"], ["steps"], ["post", "--to", "grbl"],
                                     ["simulate", "--tool", "square d=3 flute=9"]])
def test_defines_and_include_folders(kerf, folder, command):
    assert kerf(*command, "part.gcmc").status == 1
    run = kerf(*command, "part.gcmc", *GIVEN)
    assert run.status == 0, run.err


def test_a_define_sets_the_position(kerf, folder):
    run = kerf("info", "--json", "part.gcmc", *GIVEN)
    low, high = run.json["motion"]["cut_bounds_mm"]
    assert (low[0], high[0]) == (7, 7)


def test_an_included_file_is_not_overwritten(kerf, folder):
    run = kerf("post", "--to", "grbl", "part.gcmc", *GIVEN, "-o", "library/../library/hole.inc.gcmc")
    assert run.status == 2
    assert "[1008]" in run.err  # output_is_input
    assert (folder / "library" / "hole.inc.gcmc").read_text() == HOLE


def test_compare_reads_as_simulate_does(kerf, tmp_path):
    (tmp_path / "two.nc").write_text(TWO_PROGRAMS)
    assert kerf("simulate", "two.nc", "-o", "one.stl").status == 0
    first = kerf("compare", "--json", "two.nc", "one.stl").json["part_mm3"]
    both = kerf("compare", "--json", "--read-on", "two.nc", "one.stl").json["part_mm3"]
    hole = 2 * 3.14159 / 4 * 3.175**2
    assert first - both == pytest.approx(hole, rel=0.05)


@pytest.mark.parametrize("name, options", [
    ("two.nc", ["-D", "x=7mm"]), ("two.nc", ["--compat", "1.8"]), ("two.nc", ["--rapid-height", "5"]),
    ("hole.gcmc", ["--dialect", "grbl"]), ("hole.gcmc", ["--read-on"]),
    ("hole.gcmc", ["--comp", "D1=0"]), ("hole.gcmc", ["--arc-centres", "absolute"])])
def test_an_option_for_other_programs_is_refused(kerf, tmp_path, name, options):
    """A define that has no effect is no program with that define."""
    (tmp_path / "two.nc").write_text(TWO_PROGRAMS)
    (tmp_path / "hole.gcmc").write_text(FEED + "x = 7mm;\n" + HOLE)
    assert kerf("info", name).status == 0
    run = kerf("info", name, *options)
    assert run.status == 1 and "the option is for" in run.err and "[1016]" in run.err


@pytest.mark.parametrize("name, kind", [
    ("part.svg", "a drawing"), ("part.stl", "a mesh"), ("part.png", "a picture")])
@pytest.mark.parametrize("command", [["info"], ["simulate"], ["check"], ["post", "--to", "grbl"]])
def test_what_has_no_motions_is_for_kerf_cut(kerf, tmp_path, name, kind, command):
    (tmp_path / name).write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    run = kerf(*command, name)
    assert run.status == 1 and f"{kind} has no motions of a tool" in run.err and "kerf cut" in run.err

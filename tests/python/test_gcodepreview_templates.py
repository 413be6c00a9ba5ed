"""The templates and joint programs of gcodepreview, unmodified, against recorded motions.

The recorded motions are those of gcodepreview 0.93. Each difference is one that docs/differences.md lists.
"""

import os
import pathlib
import runpy
import shutil
import subprocess
import sys
import warnings

import ezdxf
import pytest

import gcodepreview
import kerf
from gcodepreview_motion import differences, motions, recorded
from kerf_command import command
from test_gcodepreview_examples import read_by_librecad, rs274_errors

CASES = pathlib.Path(os.environ.get("KERF_CASES_DIR") or "/nowhere") / "gcodepreview"
if not CASES.is_dir():
    pytest.skip("the cases are not given", allow_module_level=True)

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # Templates delete the module and import it again: later tests have to find the one that they imported.
    monkeypatch.setitem(sys.modules, "gcodepreview", gcodepreview)
    return tmp_path


def run(name, here, kind="templates"):
    """Runs a script from a copy beside its files; returns its object."""
    script = here / f"{name}.py"
    shutil.copyfile(CASES / kind / f"{name}.py", script)
    return runpy.run_path(str(script))["gcp"]


def reference(name):
    return recorded(CASES / "reference" / name)


def test_the_template_moves_as_recorded(here):
    gcp = run("gcodepreviewtemplate", here)
    found = differences(gcp.toolpath, reference("gcodepreviewtemplate.motion.json"))
    # setzpos(retractheight) of line 133 was a jump; it is a rapid, before the tool change of line 134.
    assert len(found) == 1, found
    assert "rapid to (68.75, 75.0, 9.0)" in found[0]
    assert "gcodepreviewtemplate.py:134" in found[0]


def test_the_template_writes_its_files(here):
    run("gcodepreviewtemplate", here)
    assert (here / "aexport.nc").exists() and (here / "aexport.dxf").exists()
    text = (here / "aexport.nc").read_text()
    assert "(STOCK/BLOCK, 220, 150, 8.35, 110.0, 75.0, 8.35)" in text
    assert "M6 T814" in text and "814071" not in text, "the maker's number is the program's"
    again = kerf.load(here / "aexport.nc")
    assert again.stock is not None
    assert again.stock.high == pytest.approx((110, 75, 0))


def test_the_gcode_of_the_template_reads_back_to_the_same_motion(here):
    gcp = run("gcodepreviewtemplate", here)
    again = motions(kerf.load(here / "aexport.nc").toolpath)
    made = motions(gcp.toolpath)
    ends = [end for kind, end, *_ in made]
    read = [end for kind, end, *_ in again]
    assert len(read) == len(ends)
    for a, b in zip(ends, read):
        assert a == pytest.approx(b, abs=2e-3)


@pytest.mark.parametrize(
    "kind, name",
    [
        ("templates", "gcodepreviewtemplate"),
        ("jobs", "joint_dovetail_pins"),
        ("jobs", "joint_dovetail_tails"),
        ("jobs", "fbfj_Horizontal_Both"),
    ],
)
def test_controllers_accept_what_is_written(here, kind, name):
    """LinuxCNC's interpreter runs the file as it is; GRBL's rules hold for it and its posts."""
    run(name, here, kind)
    (file,) = here.glob("*.nc")
    assert rs274_errors(file.read_text()) is None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        program = kerf.load(file, dialect="grbl", strict=True)
    for controller in ("grbl", "linuxcnc"):
        posted = kerf.post(program, controller)
        assert rs274_errors(posted) is None, controller
    ends = [end for _, end, *_ in motions(program.toolpath)]
    low, high = ([f(end[k] for end in ends) for k in range(3)] for f in (min, max))
    (here / "posted.nc").write_text(kerf.post(program, "grbl"))
    again = kerf.load(here / "posted.nc", dialect="grbl", strict=True)
    ends = [end for _, end, *_ in motions(again.toolpath)]
    assert [min(end[k] for end in ends) for k in range(3)] == pytest.approx(low, abs=2e-3)
    assert [max(end[k] for end in ends) for k in range(3)] == pytest.approx(high, abs=2e-3)


@pytest.mark.parametrize("name", ["gcodepreviewtemplate", "gcpdxf"])
def test_drawings_of_templates_are_read(here, name):
    run(name, here)
    (drawing,) = here.glob("*.dxf")
    assert not ezdxf.readfile(drawing).audit().errors
    assert read_by_librecad(drawing)


@pytest.mark.parametrize("name", ["joint_dovetail_pins", "joint_dovetail_tails"])
def test_dovetails_move_as_recorded(here, name):
    gcp = run(name, here, "jobs")
    found = differences(gcp.toolpath, reference(f"{name}/{name}.motion.json"))
    # closegcodefile lifts the tool to the retract height.
    assert len(found) == 1 and "9.0); recorded: nothing" in found[0], found


def test_the_box_joint_cuts_what_is_recorded_once(here):
    gcp = run("fbfj_Horizontal_Both", here, "jobs")
    rows = reference("fbfj_Horizontal_Both/fbfj_Horizontal_Both.motion.json")
    key = lambda p: tuple(round(v, 5) + 0.0 for v in p)
    known = {key(e) for kind, b, e in rows if kind == "cut"}
    made = [key(end) for kind, end, *_ in motions(gcp.toolpath) if kind == "cut"]
    frame = [p for p in made if p[2] == -1.5875 and p not in known]
    assert all(abs(p[1]) <= 11.1126 and abs(p[0]) <= 51.5876 for p in frame)
    # The plunge at the first finger, and the frame, are cut where the recorded ones are not.
    others = [p for p in made if p not in known and p not in frame]
    assert len(others) <= 1, others
    fingers = [p for p in made if abs(abs(p[1]) - 9.525) < 1e-6 and p[2] == -11.1125]
    assert len(fingers) == 2 * 21, "21 slots, each cut once"
    grooves = [p for p in made if p[2] == -12.7]
    assert {(-50.52917, 0.0, -12.7), (50.52917, 0.0, -12.7)} <= set(grooves)


def test_the_drawing_template_is_read_by_ezdxf(here):
    run("gcpdxf", here)
    document = ezdxf.readfile(here / "gcpdxf.dxf")
    assert document.dxfversion == "AC1015"
    assert not document.audit().errors
    layers = {e.dxf.layer for e in document.modelspace()}
    assert {
        "Layer_Black",
        "Layer_Red",
        "Layer_Blue",
        "Layer_White",
        "Layer_Dark_Gray",
        "Layer_Light_Gray",
    } <= layers
    red = [e for e in document.modelspace() if e.dxf.layer == "Layer_Red"]
    assert len(red) == 1 and red[0].closed, "four arcs and four lines are one closed outline"


def test_the_printing_template_writes_its_file(here):
    gcp = run("gcpthreedp", here)
    text = (here / "aexport.gcode").read_text()
    assert "M109 S200" in text
    # What the script has switched on is off at the end: the original's postamble.
    lines = text.splitlines()
    assert lines.index("G28") < lines.index("M109 S200") < lines.index("M104 S0") < lines.index("G28 X0")
    bead = [gcp.toolpath[i] for i in range(len(gcp.toolpath)) if gcp.toolpath[i]["step"] == "extrude"][-1]
    area = 0.2 * 0.4 + 3.141592653589793 * 0.1**2
    assert bead["volume"] == pytest.approx(area * 500**0.5, rel=1e-9)
    assert bead["to"] == (10, 20, 0.2)


def test_the_reading_template_shows_a_program(here):
    (here / "part.nc").write_text(
        "(stockMin:0.00mm, 0.00mm, -10mm)\n(STOCK/BLOCK, 50, 30, 10, 0, 0, 10)\nG21 G90\n"
        "M6 T102\nM3 S10000\nG0 X5 Y5\nG0 Z5\nG1 Z-2 F200\nX45 F800\nG0 Z5\nM5\nM2\n"
    )
    text = (CASES / "templates" / "gcpgc.py").read_text()
    before = [line for line in text.splitlines() if line.startswith("gc_file =")][0]
    script = here / "gcpgc.py"
    script.write_text(text.replace(before, 'gc_file = "part.nc"'))
    gcp = runpy.run_path(str(script))["gcp"]
    assert [m.end for m in gcp.toolpaths] == [(5, 5, -2), (45, 5, -2)]


@pytest.mark.parametrize("name", ["gcpdxf", "gcodepreviewtemplate", "gcpthreedp"])
def test_templates_run_by_plain_python_and_by_kerf(here, name):
    script = here / f"{name}.py"
    shutil.copyfile(CASES / "templates" / f"{name}.py", script)
    plain = subprocess.run([sys.executable, script], cwd=here, capture_output=True, text=True)
    assert plain.returncode == 0, plain.stderr
    written = {p.name: p.read_bytes() for p in here.iterdir() if p.suffix in (".nc", ".dxf", ".gcode")}
    assert written
    for file in written:
        (here / file).unlink()
    environment = dict(os.environ, KERF_PYTHON=sys.executable)
    outputs = ["-o", here / "part.png"] if name == "gcodepreviewtemplate" else []
    by_kerf = subprocess.run(
        [command(), "run", script, *outputs], cwd=here, capture_output=True, text=True, env=environment
    )
    assert by_kerf.returncode == 0, by_kerf.stderr
    assert {p: (here / p).read_bytes() for p in written} == written
    if outputs:
        assert (here / "part.png").read_bytes().startswith(b"\x89PNG")


def run_by_kerf(here, *words):
    environment = dict(os.environ, KERF_PYTHON=sys.executable)
    words = [command(), "run", *words]
    return subprocess.run(words, cwd=here, capture_output=True, text=True, env=environment)


@pytest.mark.parametrize(
    "given, passed",
    [
        (("--width", "40"), ["--width", "40"]),
        (("a", "-b", "--help"), ["a", "-b", "--help"]),
        (("-q", "x"), ["x"]),
        (("--", "-q"), ["-q"]),
        ((), []),
    ],
)
def test_what_follows_a_script_is_its_own(here, given, passed):
    (here / "part.py").write_text("import sys\nprint(sys.argv[1:])\n")
    run = run_by_kerf(here, "part.py", *given)
    assert (run.returncode, run.stdout) == (0, f"{passed}\n"), run.stderr


def test_an_output_that_no_part_was_shown_for_is_an_error(here):
    (here / "part.py").write_text("print('no part')\n")
    run = run_by_kerf(here, "part.py", "-o", "part.png")
    assert run.returncode == 1
    assert "the script shows no part; part.png was not written" in run.stderr

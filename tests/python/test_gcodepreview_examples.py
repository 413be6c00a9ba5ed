"""The example programs in examples/gcodepreview, and the command sheet.

They run, LinuxCNC's interpreter and the rules of GRBL accept their G-code, ezdxf and LibreCAD read their
drawings.
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import warnings

import ezdxf
import pytest

import kerf
from kerf_command import command

ROOT = pathlib.Path(__file__).parents[2]
EXAMPLES = ROOT / "examples" / "gcodepreview"
# The files of each, and bounds of the volume that its first G-code file removes in cm3, by hand.
FILES = {
    "sign": ({"sign.nc", "sign.dxf"}, (18, 30)),
    "box": ({"box.nc"}, (15, 35)),
    "tray": ({"tray-top.nc", "tray-bottom.nc", "tray-top.png"}, (225, 265)),
    "hanger": ({"hanger.nc", "hanger.dxf"}, (2, 5)),
    "relief": ({"relief.nc"}, (35, 75)),
}


def rs274_errors(text):
    """What LinuxCNC's interpreter says about a program; None if it accepts it."""
    spec = importlib.util.spec_from_file_location("rs274", ROOT / "tests" / "conformance" / "rs274.py")
    rs274 = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rs274)
    if not rs274.is_installed():
        return None
    numbers = {102, *(int(word[1:]) for word in text.split() if word[0] == "T" and word[1:].isdigit())}
    tools = "".join(f"T{n} P{i + 1} D0.125\n" for i, n in enumerate(sorted(numbers)))
    moves, error = rs274.moves_of(text, tools)
    assert moves or error
    return error


def accepted(name):
    """LinuxCNC's interpreter and the linter of GRBL accept a program, and it reads back."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        program = kerf.load(name)
    assert rs274_errors(kerf.post(program, "linuxcnc")) is None
    assert "G1" in kerf.post(program, "grbl")


def read_by_librecad(drawing):
    """LibreCAD converts a drawing without an error; True if it is not installed."""
    if shutil.which("librecad") is None:
        return True
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen", HOME=str(drawing.parent))
    done = subprocess.run(
        ["librecad", "dxf2pdf", drawing.name],
        cwd=drawing.parent,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    pdf = drawing.with_suffix(".pdf")
    return done.returncode == 0 and "ERROR" not in done.stderr.upper() and pdf.stat().st_size > 1000


def run(script, folder, *outputs):
    environment = dict(os.environ, KERF_PYTHON=sys.executable)
    done = subprocess.run(
        [command(), "run", script, *(word for path in outputs for word in ("-o", path))],
        cwd=folder,
        capture_output=True,
        text=True,
        env=environment,
        timeout=500,
    )
    assert done.returncode == 0, done.stderr
    return done


@pytest.mark.parametrize("name", sorted(FILES))
def test_examples_run(name, tmp_path):
    assert sorted(FILES) == sorted(p.stem for p in EXAMPLES.glob("*.py") if p.stem != "commands")
    script = tmp_path / f"{name}.py"
    shutil.copyfile(EXAMPLES / script.name, script)
    done = run(script, tmp_path, tmp_path / "part.png")
    assert done.stderr == "", "no hazard, no warning"
    files, (low, high) = FILES[name]
    assert {p.name for p in tmp_path.iterdir()} == files | {"part.png", script.name}
    first = max(file for file in files if file.endswith(".nc"))
    assert low <= kerf.simulate(kerf.load(tmp_path / first), resolution=0.3).removed_mm3 / 1000 <= high
    for file in files:
        if file.endswith(".nc"):
            accepted(tmp_path / file)
        elif file.endswith(".dxf"):
            assert not ezdxf.readfile(tmp_path / file).audit().errors
            assert read_by_librecad(tmp_path / file)


def test_every_command_has_an_example(tmp_path):
    """The command sheet runs, and names each public command."""
    import inspect

    from gcodepreview import gcodepreview

    sheet = (EXAMPLES / "commands.py").read_text()
    public = {n for n, f in inspect.getmembers(gcodepreview, inspect.isroutine) if not n.startswith("_")}
    missing = sorted(n for n in public if f".{n}(" not in sheet and f'"{n}"' not in sheet)
    assert not missing
    shutil.copyfile(EXAMPLES / "commands.py", tmp_path / "commands.py")
    run(tmp_path / "commands.py", tmp_path, tmp_path / "part.stl")
    accepted(tmp_path / "commands.nc")
    assert not ezdxf.readfile(tmp_path / "commands.dxf").audit().errors
    assert read_by_librecad(tmp_path / "commands.dxf")

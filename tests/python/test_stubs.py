"""The types of the compiled module: each name is in the stub, and a type checker accepts it."""

import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest

import kerf
from kerf import _kerf

STUB = pathlib.Path(kerf.__file__).parent / "_kerf.pyi"


def members(cls):
    return {n for n in vars(cls) if not n.startswith("_")}


def test_the_stub_has_every_name():
    text = STUB.read_text()
    classes = dict(re.findall(r"^class (\w+).*:\n((?:    .*\n)+)", text, re.M))
    for name, value in vars(_kerf).items():
        if inspect.isclass(value) and name != "Error":
            assert name in classes, f"class {name}: run tests/tools/make_stubs.py"
            stated = set(re.findall(r"    def (\w+)", classes[name])) - {"__init__"}
            stated = {n for n in stated if not n.startswith("_")}
            assert stated == members(value), f"class {name}: run tests/tools/make_stubs.py"
        elif inspect.isroutine(value):
            assert re.search(rf"^def {name}\(", text, re.M), f"{name}: run tests/tools/make_stubs.py"


def test_the_stub_is_what_its_program_writes():
    tools = pathlib.Path(__file__).parents[1] / "tools"
    if "List[" not in inspect.unwrap(_kerf.simulate).__doc__:
        pytest.skip("another version of pybind11, which names types differently")
    code = "import sys, make_stubs; sys.stdout.write(make_stubs.stub())"
    path = os.pathsep.join([str(tools), str(pathlib.Path(kerf.__file__).parents[1])])
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": path}
    )
    assert done.stdout == STUB.read_text(), "run tests/tools/make_stubs.py " + done.stderr


def test_a_type_checker_accepts_the_stub(tmp_path):
    pytest.importorskip("mypy")
    script, stub = tmp_path / "part.py", tmp_path / "copied" / "_kerf.pyi"
    # A copy: mypy refuses files in site-packages, where the module is after an installation.
    stub.parent.mkdir()
    for name in ("_kerf.pyi", "_types.py"):
        (stub.parent / name).write_text((STUB.parent / name).read_text())
    (stub.parent / "__init__.py").write_text("")
    script.write_text(
        "import kerf\npath = kerf.Toolpath()\npath.coolant(flood=True)\npath.rapid((0, 0, 5))\n"
        "reveal_type(path.report())\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", tmp_path / "cache", script, stub],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stdout
    assert re.search(r'Revealed type is "(builtins\.)?dict', done.stdout), done.stdout
    script.write_text("import kerf\nkerf.Toolpath().coolant(flod=True)\n")
    wrong = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", tmp_path / "cache", script],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    assert wrong.returncode == 1 and "flod" in wrong.stdout

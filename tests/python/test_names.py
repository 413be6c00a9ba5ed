"""The names of distribution and modules: another `kerf`, a real `openscad`, the command from Python."""
import os
import subprocess
import sys
from pathlib import Path

import kerf
import kerf_cam
import pytest


def python(folder, *words, path=(), **variables):
    """A Python that has Kerf's modules behind the folders of `path`."""
    modules = [str(Path(module.__file__).parents[1]) for module in (kerf, kerf_cam)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*map(str, path), *modules]), **variables}
    return subprocess.run([sys.executable, *map(str, words)], cwd=folder, env=environment,
                          capture_output=True, text=True, timeout=120)


def test_a_script_named_kerf_is_reported(tmp_path):
    script = tmp_path / "kerf.py"
    script.write_text("from gcodepreview import *\n")
    done = python(tmp_path, script)
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert last.startswith("ImportError: the module kerf of ") and str(script) in last
    assert last.endswith("rename it, or remove it from the path")


@pytest.mark.parametrize("first", ["import gcodepreview", "import kerf, gcodepreview"])
def test_the_workflow_engine_of_that_name_is_reported(tmp_path, first):
    other = tmp_path / "site-packages" / "kerf"
    other.mkdir(parents=True)
    (other / "__init__.py").write_text("class Workflow: pass\n")
    done = python(tmp_path, "-c", first, path=[other.parent])
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert str(other / "__init__.py") in last and "pip uninstall -y kerf" in last and "kerf-cam" in last


def test_a_package_written_over_by_the_other_one_is_reported(tmp_path):
    other = tmp_path / "kerf"
    other.mkdir()
    (other / "__init__.py").write_text("class Workflow: pass\n")
    (other / Path(kerf._kerf.__file__).name).write_bytes(b"")  # left behind
    done = python(tmp_path, "-c", "import gcodepreview", path=[tmp_path])
    assert "ImportError: the module kerf of " in done.stderr


def test_kerf_itself_is_accepted(tmp_path):
    for first in ("import gcodepreview", "import kerf, gcodepreview", "import kerf_cam; kerf_cam.require()"):
        done = python(tmp_path, "-c", first)
        assert done.returncode == 0, done.stderr


def test_a_real_openscad_wins_wherever_it_is(tmp_path):
    (tmp_path / "openscad.py").write_text("def cube(size): return ('real', size)\n")
    words = ["-c", f"import sys; sys.path.append({str(tmp_path)!r})\nfrom openscad import *\nprint(cube(3))"]
    done = python("/", *words)
    assert done.stdout == "('real', 3)\n", done.stderr


def test_copies_of_the_stand_in_do_not_call_each_other(tmp_path):
    """Several installations have each a copy; a real module behind them still wins."""
    import openscad

    stand_in = Path(openscad.__file__).read_text()
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "openscad.py").write_text(stand_in)
    append = f"import sys; sys.path += [{str(tmp_path / 'a')!r}, {str(tmp_path / 'b')!r}]\n"
    done = python("/", "-c", append + "import openscad; print(openscad.KERF_STAND_IN)")
    assert done.stdout == "True\n", done.stderr
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "openscad.py").write_text("def cube(size): return ('real', size)\n")
    append += f"sys.path.append({str(tmp_path / 'c')!r})\n"
    done = python("/", "-c", append + "from openscad import *\nprint(cube(3))")
    assert done.stdout == "('real', 3)\n", done.stderr


def test_a_folder_of_that_name_is_no_module(tmp_path):
    (tmp_path / "openscad").mkdir()
    done = python(tmp_path, "-c", "import openscad; print(openscad.KERF_STAND_IN)")
    assert done.stdout == "True\n", done.stderr


@pytest.mark.parametrize("module", ["kerf", "kerf_cam"])
def test_the_command_from_python(tmp_path, module):
    try:
        kerf_cam.command()
    except FileNotFoundError:
        pytest.skip("built without the command")
    done = python(tmp_path, "-m", module, "--version")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f"kerf {kerf.__version__}\n")
    (tmp_path / "part.py").write_text("import kerf, sys\nprint(sys.executable)\n")
    done = python(tmp_path, "-m", module, "run", "part.py", VIRTUAL_ENV="", KERF_PYTHON="")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["kerf.py", "kerf/__init__.py"])
def test_the_command_warns_of_a_file_that_hides_the_module(tmp_path, name):
    try:
        command = kerf_cam.command()
    except FileNotFoundError:
        pytest.skip("built without the command")
    file = tmp_path / name
    file.parent.mkdir(exist_ok=True)
    file.write_text("")
    (tmp_path / "part.py").write_text("import kerf\nprint(hasattr(kerf, 'simulate'))\n")
    done = subprocess.run([command, "run", tmp_path / "part.py"], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "KERF_PYTHON": sys.executable})
    assert done.stdout == "False\n"
    assert f"{file}: warning" in done.stderr and "[1038]" in done.stderr  # module_hidden

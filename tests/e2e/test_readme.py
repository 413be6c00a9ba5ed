"""README's commands, word for word."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
KERF = Path(os.environ["KERF"]).resolve()


def commands_of(title):
    """The lines of the shell blocks of a section, without comments."""
    section = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", (ROOT / "README.md").read_text(), re.M | re.S)[1]
    blocks = re.findall(r"^```sh\n(.*?)^```", section, re.M | re.S)
    lines = [re.sub(r"\s+#.*", "", line) for block in blocks for line in block.splitlines()]
    return [line for line in lines if line]


COMMANDS = commands_of("A first simulation")
STATUS = {"kerf check part.nc": (0, 3)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """part.nc, and a `kerf` on the path."""
    folder = tmp_path_factory.mktemp("first")
    shutil.copy(ROOT / "examples" / "demo.nc", folder / "part.nc")
    (folder / "bin").mkdir()
    (folder / "bin" / "kerf").symlink_to(Path(os.environ["KERF"]).absolute())
    return folder


def environment(folder):
    """The commands on the path; Python with the modules of the build folder, if the command is there."""
    modules = KERF.parent / "python"
    variables = {**os.environ, "PATH": f"{folder / 'bin'}:{Path(sys.executable).parent}:{os.environ['PATH']}"}
    if modules.is_dir():
        variables["PYTHONPATH"] = str(modules)
    return variables


def test_there_are_commands():
    assert len(COMMANDS) >= 6 and all(re.match(r"(kerf|python3?) ", command) for command in COMMANDS)


@pytest.mark.parametrize("command", [c for c in COMMANDS if not c.startswith("kerf view")])
def test_command(folder, command):
    if command.startswith("python") and not (KERF.parent / "python" / "kerf").is_dir():
        if "site-packages" not in str(KERF) and KERF.parent.name != "bin":
            pytest.skip("built without the Python modules")
    done = subprocess.run(command, shell=True, cwd=folder, env=environment(folder), capture_output=True,
                          text=True, timeout=300)
    assert done.returncode in STATUS.get(command, (0,)), done.stderr
    for name in re.findall(r"-o (\S+)", command):
        assert (folder / name).stat().st_size > 100


@pytest.mark.parametrize("command", [c for c in COMMANDS if c.startswith("kerf view")])
def test_view(folder, command):
    server = subprocess.Popen(command.split(), cwd=folder, env=environment(folder), stdout=subprocess.PIPE,
                              text=True)
    try:
        assert server.stdout.readline().startswith("http://127.0.0.1:")
    finally:
        server.terminate()
        server.wait(timeout=60)

"""Common to the tests of the command: running it, and a valid program."""
import json
import os
import subprocess
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
os.environ.setdefault("KERF_NO_CONFIG", "1")  # the configuration of whoever runs the tests is not read

# Tool 102 of the built-in table: square, 3.175 mm, flute 12.7 mm. A plunge, a line, a half circle: 1 mm deep.
VALID = """(a little job)
(stockMin:0.00mm, 0.00mm, -6.00mm)
(stockMax:40.00mm, 30.00mm, 0.00mm)
G21 G90 G17
M6 T102
M3 S10000
G0 X10 Y10 Z5
G1 Z-1 F100
G1 X20 F400
G3 X20 Y20 I0 J5
G0 Z5
M5
M2
"""


def cut_operations(laser):
    """Names of the operations of `kerf cut`: of lasers, or of mills."""
    schema = subprocess.run([KERF, "cut", "--schema"], capture_output=True, check=True).stdout
    return [op for op, row in json.loads(schema)["$defs"].items() if row.get("x-laser", False) == laser]


class Run:
    """A finished run of the command."""

    def __init__(self, done):
        self.status = done.returncode
        self.out = done.stdout.decode("utf-8")
        self.err = done.stderr.decode("utf-8")

    @property
    def json(self):
        return json.loads(self.out)

    def codes(self):
        """Names of the diagnostics in the JSON object."""
        return [d["name"] for d in self.json["diagnostics"]]


@pytest.fixture
def kerf(tmp_path):
    """kerf("info", "--json", file): runs the command in the test's own folder."""

    def run(*arguments, stdin=b"", env=None, timeout=120):
        done = subprocess.run([KERF, *map(str, arguments)], input=stdin, capture_output=True, cwd=tmp_path,
                              env={**os.environ, **(env or {})}, timeout=timeout)
        result = Run(done)
        assert result.status >= 0, f"ended by signal {-result.status}: {result.err}"
        return result

    return run


@pytest.fixture
def program(tmp_path):
    """program(text): writes it to a file of the test's folder and returns the path."""

    def write(text=VALID, name="part.nc"):
        path = Path(tmp_path, name)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@pytest.fixture
def files(tmp_path):
    """The names of all files in the test's folder."""
    return lambda: sorted(p.name for p in tmp_path.iterdir())


@pytest.fixture
def folder_bytes(tmp_path):
    """The contents of all files in the test's folder, by their names."""
    return lambda: {p.name: p.read_bytes() for p in tmp_path.iterdir()}

"""kerf view: what scripts print, write and leave running; slow connections; where the address comes from."""
import json
import os
import re
import socket
import subprocess
import time

import pytest

from conftest import KERF, VALID
from test_view_scripts import MODULES, view  # noqa: F401 - a fixture
from test_view_server import TOKEN, View

SCRIPT = """import kerf
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((5, 5, 5))
path.cut((5, 5, -2), feed=100)
path.cut((25, 5, -2), feed=400)
path.rapid((25, 5, 5))
kerf.simulate(path, kerf.Stock.block((30, 10, 6)))
"""
needs_module = pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")


@needs_module
def test_what_a_script_prints_is_in_the_model(view, tmp_path):
    server = view("print('pitch', 2.5)\n" + SCRIPT, name="part.py")
    assert server.ready()["console"] == "pitch 2.5\n"
    (tmp_path / "part.py").write_text("print('before')\nraise ValueError('no depth')\n")
    model = server.wait(lambda m: m["state"] == "failed")
    assert model["console"].startswith("before\n") and "ValueError: no depth" in model["console"]


GCMC = """message("depth ", 2mm);
function dip(x) { message("at ", x); goto([x, 5mm, 5mm]); move([x, 5mm, -2mm]); goto([x, 5mm, 5mm]); }
feedrate(100mm);
dip(5mm);
warning("deep");
"""
SCAD = """use <gcodepreview.py>
echo("size", 3);
module plate() { echo(inner = true); linear_extrude(3) square(10); }
plate();
cutline(5, 5, -1);
"""


def gcmc_messages(name):
    """What the command of the real program's form prints: an independent path to the same messages."""
    run = subprocess.run([KERF, "gcmc", "-o", os.devnull, name], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return [line for line in run.stderr.splitlines() if "Runtime" in line]


def test_messages_of_gcmc_are_in_the_model(view, tmp_path):
    server = view(GCMC, name="part.gcmc")
    lines = server.ready()["console"].splitlines()
    assert lines == gcmc_messages(str(tmp_path / "part.gcmc"))
    assert [re.sub(r"^.*part\.gcmc:(\d+):\d+:", r"\1:", line) for line in lines] == [
        "1: Runtime message(): depth 2mm", "2: Runtime message(): at 5mm", "5: Runtime warning(): deep"]
    # An error leaves what was printed before it, and a program that prints nothing has no console.
    (tmp_path / "part.gcmc").write_text('message("before");\nmove(nothing);\n')
    model = server.wait(lambda m: m["state"] == "failed")
    assert re.search(r"part\.gcmc:1:\d+: Runtime message\(\): before\n$", model["console"])
    (tmp_path / "part.gcmc").write_text("feedrate(100mm);\ngoto([5mm, 5mm, 5mm]);\nmove([9mm, 5mm, -2mm]);\n")
    assert "console" not in server.wait(lambda m: m["state"] == "ready" and m["revision"] == 2)


def test_a_page_has_the_end_of_many_messages(view):
    text = GCMC + 'for (i = 0; i < 20000; i++) { message("number ", i); }\n'
    console = view(text, name="part.gcmc").ready()["console"]
    assert len(console) == 65536 and console.endswith("Runtime message(): number 19999\n")


def test_echo_of_openscad_is_in_the_model(view, tmp_path):
    server = view(SCAD, name="part.scad")
    lines = server.wait(lambda m: m["state"] != "loading")["console"].splitlines()
    assert [line.split("part.scad:")[1] for line in lines] == ['2: ECHO: "size", 3', "3: ECHO: inner = true"]
    # kerf run prints the same without locations, as OpenSCAD does.
    run = subprocess.run([KERF, "run", str(tmp_path / "part.scad")], capture_output=True, text=True)
    assert run.stdout.splitlines()[:2] == ['ECHO: "size", 3', "ECHO: inner = true"]


@needs_module
def test_a_script_writes_a_file_of_any_size(view, tmp_path):
    """A file of 65 MB is no output that is printed."""
    write = "with open('large.bin', 'wb') as file:\n    file.seek(65 << 20)\n    file.write(b'x')\n"
    server = view(write + SCRIPT, name="part.py")
    assert server.ready()["errors"] == []
    assert (tmp_path / "large.bin").stat().st_size > 65 << 20


@needs_module
def test_what_a_script_leaves_running_ends_with_it(view, tmp_path):
    left = "import subprocess\np = subprocess.Popen(['sleep', '300'])\nopen('pid', 'w').write(str(p.pid))\n"
    view(left + SCRIPT, name="part.py").ready()
    pid = int((tmp_path / "pid").read_text())
    end = time.monotonic() + 10
    while is_running(pid):
        assert time.monotonic() < end
        time.sleep(0.05)


def is_running(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


@needs_module
def test_a_script_of_the_folder_runs_only_if_it_is_allowed(view, tmp_path):
    server = view("G21\nG0 X0 Y0 Z5\nM2\n", name="part.nc")
    server.ready()
    (tmp_path / "other.py").write_text("open('ran', 'w')\n" + SCRIPT)
    status, _, body = server.request("/open?src=other.py", "POST")
    assert status == 409 and "rights" in json.loads(body)["error"]
    time.sleep(0.3)
    assert not (tmp_path / "ran").exists()
    for query in ("&run=yes", ""):  # once allowed it can be opened again
        assert server.request("/open?src=other.py" + query, "POST")[0] == 200
        server.wait(lambda m: m.get("name") == "other.py")
    assert (tmp_path / "ran").exists()


def test_slow_connections_without_a_token_do_not_delay_others(program):
    server = View(program(VALID))
    slow = []
    try:
        server.ready()
        for _ in range(60):
            slow.append(socket.create_connection(("127.0.0.1", server.port), timeout=20))
            slow[-1].sendall(b"GET /model HTTP/1.1\r\nHost: ")
        started = time.monotonic()
        server.get("/model")
        assert time.monotonic() - started < 1
    finally:
        for connection in slow:
            connection.close()
        server.end()


def address_of(*options, env=None):
    """The first line of a server that is ended at once, or its exit status and message."""
    process = subprocess.Popen([KERF, "view", *map(str, options)], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env={**os.environ, **(env or {})})
    line = process.stdout.readline()
    process.terminate()
    _, err = process.communicate(timeout=20)
    return line.strip() or err


def test_the_token_comes_from_a_file_or_the_environment(program, tmp_path):
    part = program(VALID)
    secret = tmp_path / "secret"
    secret.write_text("from-the-file-0123\n")
    assert address_of(part, "--token-file", secret).endswith("?t=from-the-file-0123")
    given = {"KERF_VIEW_TOKEN": "from-the-environment"}
    assert address_of(part, env=given).endswith("?t=from-the-environment")
    assert address_of(part, "--token", TOKEN, env=given).endswith("?t=" + TOKEN)
    secret.write_text("short\n")
    assert "expected 16 to 100 letters" in address_of(part, "--token-file", secret)
    assert "expected 16 to 100 letters" in address_of(part, env={"KERF_VIEW_TOKEN": "short"})


def test_the_first_server_has_the_same_port_each_time(program):
    """Browsers keep settings by port."""
    part = program(VALID)
    ports = [re.search(r":(\d+)/", address_of(part)).group(1) for _ in range(3)]
    assert all(8347 <= int(port) < 8355 for port in ports)

"""kerf view: its server, what it refuses, and how it follows the file."""
import base64
import http.client
import json
import math
import os
import random
import re
import select
import signal
import socket
import struct
import subprocess
import threading
import time
import zlib
from pathlib import Path

import pytest

from conftest import KERF, VALID

TOKEN = "a-token-for-the-tests"
EDITS = int(os.environ.get("KERF_VIEW_EDITS", "25"))  # at random; 200 take a minute
SAVES = int(os.environ.get("KERF_VIEW_SAVES", "600"))  # in quick succession; 60,000 take five minutes


class View:
    """A running server on a file."""

    def __init__(self, file, *options):
        self.process = subprocess.Popen(
            [KERF, "view", str(file), "--json", "--token", TOKEN, "--resolution", "0.3", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=Path(file).parent)
        ready, _, _ = select.select([self.process.stdout], [], [], 20)
        assert ready, "no address within 20 s"
        line = self.process.stdout.readline()
        assert line, self.process.stderr.read().decode()
        self.port = json.loads(line)["port"]
        self.address = json.loads(line)["address"]

    def request(self, path, method="GET", headers=None, token=TOKEN, timeout=60):
        """Status, headers and body."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            if token is not None:
                path += ("&" if "?" in path else "?") + "t=" + token
            connection.request(method, path, headers=headers or {})
            answer = connection.getresponse()
            return answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read()
        finally:
            connection.close()

    def get(self, path, **arguments):
        status, _, body = self.request(path, **arguments)
        assert status == 200, body[:300]
        return body

    def model(self):
        return json.loads(self.get("/model"))

    def wait(self, test, seconds=30):
        """The model once it fulfils the test."""
        end = time.monotonic() + seconds
        while True:
            model = self.model()
            if test(model):
                return model
            assert time.monotonic() < end, {k: model.get(k) for k in ("revision", "state", "errors")}
            time.sleep(0.03)

    def ready(self, after=0):
        return self.wait(lambda m: m["state"] == "ready" and m["revision"] > after)

    def mesh(self, since=0):
        return read_mesh(self.get(f"/mesh?since={since}"))

    def end(self, how=signal.SIGINT):
        if self.process.poll() is None:
            self.process.send_signal(how)
        out, err = self.process.communicate(timeout=20)
        return self.process.returncode, err.decode()


def read_mesh(body):
    """Revision, flags, step and the tiles: id, level, positions, index, step."""
    assert body[:4] == b"KMSH"
    version, revision, flags, step, count, tables = struct.unpack_from("<6I", body, 4)
    assert version == 1
    tiles, at = {}, 28
    for _ in range(tables):
        at += 8 + 8 * struct.unpack_from("<I", body, at + 4)[0]
    for _ in range(count):
        number, level, vertices, triangles = struct.unpack_from("<4I", body, at)
        at += 16
        positions = struct.unpack_from(f"<{3 * vertices}f", body, at)
        index = struct.unpack_from(f"<{3 * triangles}I", body, at + 12 * vertices)
        steps = struct.unpack_from(f"<{triangles}I", body, at + 12 * (vertices + triangles))
        at += 12 * vertices + 16 * triangles
        tiles[number] = (level, positions, index, steps)
    assert at == len(body)
    return revision, flags, step, tiles


class Column:
    """Numbers of a toolpath's block, in the fewest bytes that hold all of them."""

    def __init__(self, body, at):
        self.body, self.at = body, at

    def take(self, form):
        values = struct.unpack_from("<" + form, self.body, self.at)
        self.at += struct.calcsize(form)
        return values

    def numbers(self, count):
        size, = self.take("I")
        if size == 0:
            return self.take("I") * count
        values = self.take(f"{count}{ {1: 'B', 2: 'H', 4: 'I'}[size]}")
        self.at += -self.at % 4
        return values

    def signed(self, count):
        return [v // 2 if v % 2 == 0 else -(v + 1) // 2 for v in self.numbers(count)]

    def floats(self, count):
        return struct.unpack(f"<{count}f", struct.pack(f"<{count}I", *self.numbers(count)))


def read_path(body):
    """The revision and the motions of an answer with all blocks."""
    assert body[:4] == b"KPTH"
    version, revision, motions, points, count, groups, reserved = struct.unpack_from("<7I", body, 4)
    assert (version, reserved) == (2, 0)
    table = [struct.unpack_from("<7I", body, 32 + 28 * b) for b in range(count)]
    lines = list(struct.unpack_from(f"<{groups}I", body, 32 + 28 * count))
    read, found, blocks = Column(body, 32 + 28 * count + 4 * groups), [], {}
    for number, n, own_points, origins, own_groups, first_step, size in table:
        first_lines, lines = lines[:own_groups], lines[own_groups:]
        after = read
        if size > 0:
            blocks[number] = read.at
            after = Column(body, read.at + size)
        read = Column(body, blocks[number])
        found += read_block(read, n, own_points, origins, first_lines, first_step)
        assert size == 0 or read.at == after.at
        read = after
    assert read.at == len(body) and len(found) == motions and not lines
    assert sum(entry[2] for entry in table) == points
    return revision, found


def read_block(read, n, points, origins, first_lines, first_step):
    steps = [first_step + k + s for k, s in enumerate(read.numbers(n))]
    counts, kinds, tools, differences = (read.numbers(n), read.numbers(n), read.numbers(n), read.signed(n))
    seconds, feed, flow, power = (read.floats(n) for _ in range(4))
    beads = read.numbers(n)
    files = read.take(f"{len(first_lines)}I")
    groups, line_differences, callers = read.numbers(origins), read.signed(origins), read.numbers(origins)
    xyz = read.take(f"{3 * points}f")
    last, lines = [line - 1 for line in first_lines], []
    for group, by in zip(groups, line_differences):
        last[group] += by
        lines.append((files[group], last[group]))
    found, origin, point = [], -1, 0
    for k in range(n):
        origin += differences[k]
        chain, at = [], origin + 1
        while at > 0:
            if lines[at - 1][0] != 0xffffffff:
                chain.append(lines[at - 1])
            at = callers[at - 1]
        first = point - (1 if kinds[k] & 8 else 0)
        point += counts[k]
        found.append({"step": steps[k], "kind": kinds[k] & 7, "tool": tools[k] - 1, "seconds": seconds[k],
                      "feed": feed[k], "flow": flow[k], "power": power[k], "bead": beads[k], "chain": chain,
                      "points": [xyz[3 * p:3 * p + 3] for p in range(first, point)]})
    return found


def volume_of(tiles):
    """The volume that all tiles together enclose, mm3."""
    volume = 0.0
    for _, p, index, _ in tiles.values():
        for t in range(0, len(index), 3):
            a, b, c = (p[3 * v:3 * v + 3] for v in index[t:t + 3])
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                       + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return volume


@pytest.fixture
def view(program):
    """view(text, options...): a server on the program; ended after the test."""
    started = []

    def start(text=VALID, *options, name="part.nc"):
        started.append(View(program(text, name), *options))
        return started[-1]

    yield start
    for each in started:
        if each.process.poll() is None:
            each.process.kill()
        each.process.communicate(timeout=20)


class EventReader(threading.Thread):
    """Reads /events in the background."""

    def __init__(self, server):
        super().__init__(daemon=True)
        self.connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30)
        self.connection.request("GET", f"/events?t={TOKEN}")
        self.answer = self.connection.getresponse()
        assert self.answer.status == 200
        assert self.answer.getheader("Content-Type") == "text/event-stream"
        assert self.answer.getheader("Content-Encoding") is None
        self.events = []
        self.start()

    def run(self):
        name = None
        try:
            for line in self.answer:
                line = line.decode().rstrip("\n")
                if line.startswith("event: "):
                    name = line[7:]
                elif line.startswith("data: "):
                    self.events.append((name, json.loads(line[6:])))
        except (OSError, ValueError, http.client.HTTPException, AttributeError):
            pass  # the server has ended

    def wait(self, test, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for event in list(self.events):
                if test(*event):
                    return event
            time.sleep(0.01)
        raise AssertionError(self.events[-5:])


def test_shows_a_part_with_its_path(view):
    server = view()
    model = server.ready()
    assert model["protocol"] == 1 and model["revision"] == 1 and model["errors"] == []
    assert model["name"] == "part.nc" and model["kind"] == "milling" and model["units"] == "mm"
    assert model["bounds"] == [[0, 0, -6], [40, 30, 0]]
    assert model["stock"]["block"] == [[0, 0, -6], [40, 30, 0]] and model["stock"]["shape"] == "block"
    assert [f["text"] for f in model["files"]] == [VALID]
    tool = next(t for t in model["tools"] if t["number"] == 102)
    flute = next(p for p in tool["profiles"] if p["part"] == "flute")
    assert max(r for r, _ in flute["points"]) == pytest.approx(3.175 / 2)
    assert tool["flute_length"] == pytest.approx(12.7)

    revision, flags, step, tiles = server.mesh()
    assert (revision, flags & 1, step) == (1, 1, 0xffffffff)
    assert len(tiles) == model["tiles"]["count"]
    left = model["report"]["volumes"]["left_mm3"]
    # Heights are interpolated between columns, so that a wall leans by half a column on both sides.
    assert volume_of(tiles) == pytest.approx(left, rel=0.01)
    assert all(s < model["steps"] or s == 0xffffffff for t in tiles.values() for s in t[3])

    revision, path = read_path(server.get("/path"))
    assert (revision, len(path)) == (1, model["motions"])
    steps = [m["step"] for m in path]
    assert sorted(steps) == steps and {m["tool"] for m in path} == {102}
    # G0 X10 Y10 Z5, G1 Z-1 F100, G1 X20 F400, G3, G0 Z5: lines 7 to 11
    assert [m["chain"] for m in path] == [[(0, line)] for line in range(7, 12)]
    assert [m["kind"] for m in path] == [0, 1, 1, 2, 0]
    assert [m["feed"] for m in path] == [0, 100, 400, 400, 0]
    assert path[0]["points"] == []  # the start of the first motion is unknown
    ends = [m["points"][-1] for m in path[1:]]
    assert ends[0] == (10, 10, -1) and ends[1] == (20, 10, -1) and ends[3] == (20, 20, 5)
    assert ends[2] == pytest.approx((20, 20, -1))
    assert [m["points"][0] for m in path[2:]] == ends[:3]
    assert path[1]["seconds"] == pytest.approx(6 / 100 * 60)
    assert path[2]["seconds"] == pytest.approx(10 / 400 * 60)
    assert path[3]["seconds"] == pytest.approx(3.14159265 * 5 / 400 * 60)
    arc = path[3]["points"]
    assert len(arc) > 5 and all(abs(((x - 20) ** 2 + (y - 15) ** 2) ** 0.5 - 5) < 1e-4 for x, y, _ in arc)


def test_large_sources_are_in_blocks(view, tmp_path):
    lines = VALID.splitlines()[:-1] + [f"(comment {k})" for k in range(40000)] + ["M2"]
    server = view("\n".join(lines))
    model = server.ready()
    source = model["files"][0]
    assert source["text"] is None and source["complete"]
    text = b"".join(server.get(f"/source?id={number}") for number, _ in source["blocks"])
    assert text.decode() == "\n".join(lines)
    assert sum(count for _, count in source["blocks"]) == len(lines)
    assert server.request("/source?id=999999")[0] == 404 and server.request("/source?id=x")[0] == 400
    # A program with an error has its own blocks, and shares the unchanged ones.
    lines[20000] = "G1 X(nothing"
    (tmp_path / "part.nc").write_text("\n".join(lines))
    failed = server.wait(lambda m: m["state"] == "failed")["failed"]["files"][0]
    assert b"".join(server.get(f"/source?id={n}") for n, _ in failed["blocks"]).decode() == "\n".join(lines)
    before, after = ({n for n, _ in f["blocks"]} for f in (source, failed))
    assert 0 < len(after - before) <= 2
    # An exported page cannot ask.
    exported = json.loads(zlib.decompress(base64.b64decode(
        re.search(rb'id="kerf-model"[^>]*>([^<]*)<', server.get("/export"))[1])))
    assert exported["files"][0]["text"].startswith(VALID[:20]) and "blocks" not in exported["files"][0]


def test_the_path_has_the_calls_of_subroutines(view):
    server = view("G21 G90\nT102 M6\nM3 S9000\nG0 X0 Y0 Z5\nM98 P100\nM98 P100\nM2\n"
                  "O100\nG91\nG1 X1 F300\nG90\nM99\n")
    server.ready()
    path = read_path(server.get("/path"))[1]
    assert [m["chain"] for m in path] == [[(0, 4)], [(0, 10), (0, 5)], [(0, 10), (0, 6)]]


def test_only_changed_blocks_of_the_path_are_sent(view, tmp_path):
    lines = ["G21 G90", "T102 M6", "M3 S9000", "G0 X0 Y0 Z5", "G1 Z0 F900"]
    lines += [f"G1 X{20 + 19 * math.sin(k):.3f} Y{15 + 14 * math.cos(1.7 * k):.3f}" for k in range(20000)]
    server = view("\n".join(lines))
    first = server.ready()["revision"]
    whole = server.get("/path")
    lines.insert(8000, "G1 X30")
    (tmp_path / "part.nc").write_text("\n".join(lines))
    second = server.ready(after=first)["revision"]
    changed = server.get(f"/path?since={first}")
    assert len(changed) < len(whole) / 5
    assert server.get(f"/path?since={second}")[:4] == b"KPTH"
    path = read_path(server.get("/path"))[1]
    assert [m["chain"][0][1] for m in path] == list(range(4, len(lines) + 1))
    assert server.request("/path?since=x")[0] == 400


def test_a_program_without_a_z_is_drawn_at_zero(view):
    server = view("G21 G90\nM4 S0\nG0 X1 Y2\nG1 X11 Y2 F600 S500\nG1 X11 Y9\nM5\nM2\n", "--dialect", "laser")
    model = server.ready()
    assert model["bounds"][1][:2] == [11, 9] and model["bounds"][1][2] == 0
    ends = [m["points"][-1] for m in read_path(server.get("/path"))[1][1:]]
    assert ends[-2:] == [(11, 2, 0), (11, 9, 0)]


def test_a_pipe_instead_of_the_file_does_not_stop_the_server(view, tmp_path):
    server = view()
    part, changed = tmp_path / "part.nc", VALID.replace("X20 F400", "X25 F400")
    server.ready()
    part.unlink()
    os.mkfifo(part)
    time.sleep(1)
    part.unlink()
    part.write_text(changed)
    server.wait(lambda m: m["state"] == "ready" and m["files"][0]["text"] == changed)
    server.process.send_signal(signal.SIGINT)
    server.process.wait(timeout=5)


def test_errors_are_on_the_terminal_too(kerf, tmp_path):
    server = subprocess.Popen([KERF, "view", "nofile.nc"], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    try:
        assert "nofile.nc: error: cannot read the file" in server.stderr.readline()
    finally:
        server.kill()


def test_the_page_has_a_policy_and_needs_nothing_else(view):
    server = view()
    status, headers, body = server.request("/")
    assert status == 200 and headers["content-type"] == "text/html; charset=utf-8"
    policy = headers["content-security-policy"]
    nonce = re.search(r"script-src 'nonce-([^']+)'", policy).group(1)
    assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy
    assert headers["cache-control"] == "no-store" and headers["x-content-type-options"] == "nosniff"
    assert "set-cookie" not in headers
    text = body.decode()
    assert "KERF_NONCE" not in text and "KERF_DATA" not in text
    for tag in re.findall(r"<script[^>]*>", text):
        assert f'nonce="{nonce}"' in tag and "src=" not in tag
    assert nonce not in server.request("/")[2].decode()


def test_refuses_other_pages_and_hosts(view):
    server = view()
    server.ready()
    for path in ("/", "/model", "/mesh", "/path", "/at?step=1", "/events", "/export", "/download/stl",
                 "/nothing"):
        for token in (None, "", "wrong", TOKEN[:-1], TOKEN + "x"):
            assert server.request(path, token=token)[0] == 403, path
        assert server.request(path, headers={"Host": "example.com"})[0] == 403
        assert server.request(path, headers={"Host": f"example.com:{server.port}"})[0] == 403
        assert server.request(path, headers={"Origin": "http://example.com"})[0] == 403
    assert server.request("/stop", method="POST", token="wrong")[0] == 403
    own = {"Host": f"localhost:{server.port}", "Origin": f"http://localhost:{server.port}"}
    assert server.request("/model", headers=own)[0] == 200
    assert server.request("/model", token=None, headers={"X-Kerf-Token": TOKEN})[0] == 200


def test_answers_on_the_loopback_interface_alone(view):
    server = view()
    listening = Path("/proc/net/tcp").read_text() + Path("/proc/net/tcp6").read_text()
    rows = [line.split() for line in listening.splitlines()]
    ours = [row[1] for row in rows if row[1].endswith(f":{server.port:04X}") and row[3] == "0A"]
    assert ours == [f"0100007F:{server.port:04X}"]


def test_gives_out_no_files(view, tmp_path):
    (tmp_path / "secret.txt").write_text("a secret")
    server = view()
    server.ready()
    for path in ("/secret.txt", "/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "//secret.txt",
                 "/download/../secret.txt", "/download/%2e%2e%2fsecret.txt", "/etc/passwd",
                 "/../../../../etc/passwd",
                 "/download/nc", "/mesh/../secret.txt", "/part.nc", "/%00", "/index.html"):
        status, _, body = server.request(path)
        assert status == 404, path
        assert b"secret" not in body and b"root:" not in body and "error" in json.loads(body)


def test_wrong_parameters_are_errors(view):
    server = view()
    server.ready()
    for path in ("/mesh?since=-1", "/mesh?since=x", "/mesh?since=99999999999", "/at", "/at?step=",
                 "/at?step=1.5", "/at?step=1&from=-2", "/at?from=1"):
        assert server.request(path)[0] == 400, path
    assert server.request("/download/gcode?post=nonsense")[0] == 404
    assert server.request("/download/png?view=nonsense")[0] == 404
    assert server.request("/model", method="POST")[0] == 404
    assert server.request("/stop")[0] == 404
    assert server.mesh(since=4294967295)[3] == {}


def raw(server, request, wait=8):
    """Bytes sent as they are; the answer's bytes."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=wait) as connection:
        answer = b""
        try:
            connection.sendall(request)
            while chunk := connection.recv(65536):
                answer += chunk
        except (TimeoutError, ConnectionError):
            pass
        return answer


def test_oversized_and_malformed_requests(view):
    server = view()
    server.ready()
    host = f"Host: 127.0.0.1:{server.port}\r\n".encode()
    close = b"Connection: close\r\n"
    long_path = b"GET /" + b"x" * 100_000 + b" HTTP/1.1\r\n" + host + close + b"\r\n"
    long_header = b"GET /model HTTP/1.1\r\n" + host + close + b"X-Long: " + b"y" * 200_000 + b"\r\n\r\n"
    body = (f"POST /stop?t={TOKEN} HTTP/1.1\r\n".encode() + host + close + b"Content-Length: 100000\r\n\r\n"
            + b"z" * 100_000)
    huge = (f"POST /stop?t={TOKEN} HTTP/1.1\r\n".encode() + host + close
            + b"Content-Length: 99999999999999\r\n\r\n")
    for request in (long_path, long_header, body, huge, b"\x00\xff\xfe\r\n\r\n", b"GET\r\n\r\n", b"\r\n\r\n",
                    b"GET / HTTP/9.9\r\n\r\n", b"GET /model HTTP/1.1\r\n" + close + b"\r\n"):
        answer = raw(server, request)
        assert not answer.startswith(b"HTTP/1.1 200"), request[:60]
        assert server.request("/model")[0] == 200  # and it continues


def test_slow_requests_do_not_block_others(view):
    server = view()
    server.ready()
    slow = []
    for _ in range(10):
        connection = socket.create_connection(("127.0.0.1", server.port))
        connection.sendall(b"GET /model HTTP/1.1\r\nHost: 127")
        slow.append(connection)
    start = time.monotonic()
    assert server.request("/model")[0] == 200
    assert time.monotonic() - start < 3
    for connection in slow:  # ended by the server after its limit
        connection.settimeout(20)
        answer = connection.recv(1000)
        assert answer == b"" or b"200" not in answer.split(b"\r\n")[0]
    for connection in slow:
        connection.close()


def test_cuts_again_after_a_save(view, program):
    server = view()
    server.ready()
    events = EventReader(server)
    events.wait(lambda name, data: name == "model" and data["revision"] == 1)
    before = server.mesh()
    program(VALID.replace("G1 Z-1 F100", "G1 Z-3 F100"))
    events.wait(lambda name, data: name == "model" and data["revision"] == 2)
    model = server.ready()
    assert model["revision"] == 2
    revision, flags, _, changed = server.mesh(since=1)
    assert (revision, flags) == (2, 0) and 0 < len(changed)
    all_tiles = {**before[3], **changed}
    assert all_tiles == server.mesh()[3]
    assert volume_of(all_tiles) < volume_of(before[3]) - 50


def test_a_small_edit_changes_a_few_tiles(view, program):
    lines = "".join(f"G0 Z2\nG0 X{10 + 20 * (k % 10)} Y{10 + 20 * (k // 10)}\nG1 Z-1 F100\n"
                    f"G1 X{15 + 20 * (k % 10)}\n" for k in range(100))
    text = ("(stockMin:0mm, 0mm, -6mm)\n(stockMax:220mm, 220mm, 0mm)\nG21 G90\nM6 T102\nM3 S9000\n" + lines
            + "G0 Z5\nM2\n")
    server = view(text)
    count = server.ready()["tiles"]["count"]
    program(text.replace("G0 X30 Y10\nG1 Z-1", "G0 X30 Y10\nG1 Z-2"))
    server.ready(after=1)
    assert 0 < len(server.mesh(since=1)[3]) <= count / 10


def test_an_error_keeps_the_last_part_until_it_is_repaired(view, program):
    server = view()
    first = server.ready()
    events = EventReader(server)
    program(VALID.replace("G1 X20 F400", "G1 X20 F400 Y"))
    _, data = events.wait(lambda name, data: name == "errors" and data["diagnostics"])
    error = data["diagnostics"][0]
    assert error["severity"] == "error" and error["origin"]["line"] == 9
    assert error["origin"]["file"].endswith("part.nc")
    model = server.model()
    assert (model["state"], model["revision"]) == ("failed", first["revision"])
    assert model["errors"][0]["message"] == error["message"] and model["name"] == "part.nc"
    assert len(server.mesh()[3]) == first["tiles"]["count"]
    late = EventReader(server)  # a page that is opened now
    late.wait(lambda name, data: name == "model")
    late.wait(lambda name, data: name == "errors")
    program(VALID)
    model = server.ready(after=first["revision"])
    assert model["errors"] == []


def test_a_program_that_is_wrong_at_first(view, program):
    server = view("G1 X Y\n")
    model = server.wait(lambda m: m["state"] == "failed")
    assert model["revision"] == 0 and model["errors"]
    assert server.request("/export")[0] == 404 and server.request("/download/stl")[0] == 404
    assert server.request("/at?step=0")[0] == 404
    assert server.mesh()[3] == {} and server.get("/path") == b""
    program(VALID)
    server.ready()


def test_files_that_vanish_or_become_folders(view, tmp_path):
    server = view()
    server.ready()
    part = tmp_path / "part.nc"
    part.unlink()
    assert server.wait(lambda m: m["state"] == "failed")["errors"][0]["message"]
    part.mkdir()
    time.sleep(0.3)
    assert server.wait(lambda m: m["state"] == "failed")
    part.rmdir()
    part.write_text(VALID)
    after = server.ready()["revision"]
    new = tmp_path / "new.nc"  # as editors save: a new file renamed over the old one
    new.write_text(VALID.replace("Z-1", "Z-2"))
    new.rename(part)
    server.ready(after=after)
    part.write_bytes(b"\x00\x01\x02\xff" * 1000)
    server.wait(lambda m: m["state"] == "failed")
    part.write_text("")
    time.sleep(0.3)
    assert server.model()["state"] == "failed"


def test_half_saved_files_end_in_the_whole_one(view, tmp_path):
    server = view()
    server.ready()
    text = VALID.replace("G1 Z-1", "G1 Z-2").encode()
    for _ in range(5):
        with open(tmp_path / "part.nc", "wb") as file:
            for k in range(0, len(text), 40):
                file.write(text[k:k + 40])
                file.flush()
                time.sleep(0.01)
    server.wait(lambda m: m["state"] == "ready" and m["files"][0]["text"].encode() == text)


def test_a_file_that_is_emptied_before_it_is_written_is_no_error(view, tmp_path):
    server = view()
    server.ready()
    events = EventReader(server)
    draw = random.Random(5)
    for turn in range(24):
        text = VALID.replace("G1 Z-1", f"G1 Z-{1 + turn % 3}").encode()
        written = [0, len(text) // 4, 3 * len(text) // 4][turn % 3]  # before the pause
        with open(tmp_path / "part.nc", "wb", buffering=0) as file:
            file.write(text[:written])
            time.sleep(draw.uniform(0.005, 0.08))
            file.write(text[written:])
        time.sleep(draw.choice([0.02, 0.12, 0.3]))
        server.wait(lambda m: m["state"] == "ready" and m["files"][0]["text"].encode() == text)
    assert [data for name, data in events.events if name == "errors" and data["diagnostics"]] == []


@pytest.mark.parametrize("rest", [b"", b"G1 X"], ids=["empty", "cut off"])
def test_a_file_that_stays_empty_or_cut_off_is_an_error(view, tmp_path, rest):
    server = view()
    server.ready()
    events = EventReader(server)
    start = time.monotonic()
    (tmp_path / "part.nc").write_bytes(rest)
    events.wait(lambda name, data: name == "errors" and data["diagnostics"])
    assert 0.2 < time.monotonic() - start < 3  # 0.25 s and the time of the reading
    assert server.model()["state"] == "failed"


def test_errors_of_a_file_that_never_rests_are_shown(view, tmp_path):
    server = view()
    server.ready()
    end = time.monotonic() + 15
    while server.model()["state"] != "failed":
        (tmp_path / "part.nc").write_text(f"G1 X Y ({time.monotonic()})\n")
        assert time.monotonic() < end
        time.sleep(0.08)


def save_at_random(file, text, draw):
    """Saves a part of the text: over the file, by a rename as many editors do, or not at all."""
    part = text[:draw.choice([0, 1, len(text), draw.randrange(len(text))])]
    how = draw.random()
    if how < 0.8:
        file.write_bytes(part)
    elif how < 0.95:
        beside = file.with_suffix(".new")
        beside.write_bytes(part)
        beside.replace(file)
    else:
        file.unlink(missing_ok=True)


def test_saves_in_quick_succession_end_in_the_last_one(view, tmp_path):
    text = (Path(__file__).parents[2] / "examples" / "demo.nc").read_bytes()
    servers = [view(text.decode(), name=f"part{k}.nc") for k in range(3)]
    draw = random.Random(3)
    for _ in range(SAVES // len(servers)):
        for k in range(len(servers)):
            save_at_random(tmp_path / f"part{k}.nc", text, draw)
            time.sleep(draw.uniform(0, 0.006))
    for k, server in enumerate(servers):
        assert server.process.poll() is None
        (tmp_path / f"part{k}.nc").write_bytes(text)
        server.wait(lambda m: m["state"] == "ready" and m["files"][0]["text"].encode() == text)
        assert server.end()[0] == 0


def test_included_files_are_watched(view, tmp_path):
    (tmp_path / "depth.inc.gcmc").write_text("depth = -2mm;\n")
    main = ('include("depth.inc.gcmc");\ncomment("stockMin:0mm,0mm,-6mm");\n'
            'comment("stockMax:40mm,30mm,0mm");\n'
            'feedrate(200mm);\ngoto([10mm,10mm,5mm]);\nmove([-,-,depth]);\nmove([30mm,-,-]);\n')
    server = view(main, "--tool", "square d=6 flute=20", name="part.gcmc")
    first = server.ready()
    assert [Path(f["path"]).name for f in first["files"]] == ["part.gcmc", "depth.inc.gcmc"]
    (tmp_path / "depth.inc.gcmc").write_text("depth = -4mm;\n")
    second = server.ready(after=first["revision"])
    removed = [m["report"]["volumes"]["removed_mm3"] for m in (first, second)]
    assert removed[1] == pytest.approx(2 * removed[0], rel=0.02)
    (tmp_path / "depth.inc.gcmc").unlink()
    server.wait(lambda m: m["state"] == "failed")
    (tmp_path / "depth.inc.gcmc").write_text("depth = -2mm;\n")
    server.ready(after=second["revision"])


def test_tool_files_are_watched(view, tmp_path):
    tools = tmp_path / "tools.toml"
    tools.write_text('[[tool]]\nnumber = 7\nshape = "square"\ndiameter = 4\nflute = 20\n')
    server = view(VALID.replace("T102", "T7"), "--tools", str(tools))
    first = server.ready()
    tools.write_text('[[tool]]\nnumber = 7\nshape = "square"\ndiameter = 8\nflute = 20\n')
    second = server.ready(after=first["revision"])
    assert second["report"]["volumes"]["removed_mm3"] > 1.5 * first["report"]["volumes"]["removed_mm3"]


def test_a_program_without_end_is_stopped(view, program):
    server = view("a = 1;\nwhile(1) { a = a + 1; }\n", "--limit", "1", name="part.gcmc")
    start = time.monotonic()
    model = server.wait(lambda m: m["state"] == "failed")
    assert "stopped" in json.dumps(model["errors"])
    assert time.monotonic() - start < 15
    server.request("/model")
    program("goto([1mm,1mm,1mm]);\nmove([5mm,1mm,1mm]);\n", "part.gcmc")
    server.ready()


def test_work_can_be_stopped(view, program):
    server = view("a = 1;\nwhile(1) { a = a + 1; }\n", "--limit", "50", name="part.gcmc")
    time.sleep(0.5)
    assert server.request("/stop", method="POST")[0] == 200
    assert "stopped" in json.dumps(server.wait(lambda m: m["state"] == "failed")["errors"])


def test_reading_a_drawing_can_be_stopped(view):
    shape = '<path d="M{0} {0} c1 0 2 1 2 2 s-1 2 -2 2 z" fill="none" stroke="black"/>'
    shapes = "\n".join(shape.format(k % 997) for k in range(300_000))
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="999mm" height="999mm">'
    server = view(f"{head}\n{shapes}\n</svg>\n", name="many.svg")
    time.sleep(0.5)
    start = time.monotonic()
    assert server.request("/stop", method="POST")[0] == 200
    assert "stopped" in json.dumps(server.wait(lambda m: m["state"] == "failed")["errors"])
    assert time.monotonic() - start < 2  # reading takes longer


def test_a_drawing_without_a_unit(view):
    line = "0\nLINE\n8\n0\n10\n0\n20\n0\n11\n10\n21\n5\n"
    text = f"0\nSECTION\n2\nENTITIES\n{line}0\nENDSEC\n0\nEOF\n"
    server = view(text, name="plan.dxf")
    assert server.wait(lambda m: m["state"] == "failed")["errors"][0]["code"] == 7121
    assert server.request("/unit?unit=furlong", method="POST")[0] == 400
    assert server.request("/unit?unit=inch", method="POST")[0] == 200
    assert server.ready()["bounds"] == [[0, 0, 0], [254, 127, 0]]
    assert server.request("/unit?unit=pt", method="POST")[0] == 200
    server.wait(lambda m: m["state"] == "ready" and m["bounds"][1][0] < 100)
    assert server.ready()["bounds"][1] == pytest.approx([10 * 25.4 / 72, 5 * 25.4 / 72, 0])
    given = view(text, "--unit", "mm", name="other.dxf")
    assert given.ready()["bounds"] == [[0, 0, 0], [10, 5, 0]]


def test_the_burn_of_a_laser(view):
    server = view("G21 G90\nM4 S0\nG0 X0 Y0\nG1 X20 S500 F600\nM5\nM2\n", "--spot", "1", "--max-power", "10",
                  name="laser.nc")
    server.ready()
    body = server.get("/download/burn")
    magic, version, _, nx, ny, x, y, cell, black, highest, joules, beam, power, full_s = struct.unpack_from(
        "<4s4I9f", body)
    assert (magic, version, beam, power, full_s) == (b"KBRN", 1, 1, 10, 1000)
    assert len(body) == 56 + 4 * nx * ny
    energy = struct.unpack_from(f"<{nx * ny}f", body, 56)
    # 5 W for 2 s; on the centre line 4 P / (pi d v).
    assert joules == pytest.approx(10, rel=1e-3) and sum(energy) * cell * cell == pytest.approx(10, rel=0.05)
    assert highest == pytest.approx(4 * 5 / (3.14159 * 1 * 10), rel=0.03) and black <= highest
    assert max(energy) == pytest.approx(highest, rel=0.05)
    assert x == pytest.approx(-0.5, abs=0.5) and y == pytest.approx(-0.5, abs=0.5)
    milled = view()
    milled.ready()
    status, _, reason = milled.request("/download/burn")
    assert status == 404 and b"laser" in reason


def test_a_save_stops_the_work_of_the_one_before(view, program):
    server = view("a = 1;\nwhile(1) { a = a + 1; }\n", "--limit", "50", name="part.gcmc")
    time.sleep(0.5)
    start = time.monotonic()
    program("goto([1mm,1mm,1mm]);\nmove([5mm,1mm,1mm]);\n", "part.gcmc")
    server.ready()
    assert time.monotonic() - start < 15


def test_states_on_the_way(view):
    server = view()
    model = server.ready()
    final = server.mesh()[3]
    steps = model["steps"]
    _, _, at, start = read_mesh(server.get("/at?step=0"))
    assert at == 0
    shown = {**final, **start}
    assert volume_of(shown) == pytest.approx(40 * 30 * 6, rel=1e-4)  # the stock
    volumes, state = [], 0
    for step in range(1, steps + 1):
        _, _, at, tiles = read_mesh(server.get(f"/at?step={step}&from={state}"))
        shown.update(tiles)
        volumes.append(volume_of(shown))
        state = step
    assert at == 0xffffffff and shown == final
    assert all(a >= b - 1e-3 for a, b in zip(volumes, volumes[1:]))
    assert read_mesh(server.get("/at?step=4000000000"))[2] == 0xffffffff
    assert read_mesh(server.get(f"/at?step={steps}&from={steps}"))[3] == {}


def test_exports_one_file(view, kerf, tmp_path):
    server = view()
    server.ready()
    status, headers, body = server.request("/export")
    assert status == 200 and headers["content-disposition"] == 'attachment; filename="part.nc.html"'
    result = kerf("view", "part.nc", "--resolution", "0.3", "--export", "out.html")
    assert result.status == 0, result.err
    text = (tmp_path / "out.html").read_text()
    for page in (body.decode(), text):
        blocks = dict(re.findall(r'<script type="text/plain" id="kerf-(\w+)" '
                                 r'data-encoding="deflate-base64"[^>]*>([A-Za-z0-9+/=]*)</script>', page))
        assert set(blocks) == {"model", "mesh", "path", "instants", "gcode"}
        unpacked = {name: zlib.decompress(base64.b64decode(block)) for name, block in blocks.items()}
        assert json.loads(unpacked["model"])["name"] == "part.nc"
        assert read_mesh(unpacked["mesh"])[3] == server.mesh()[3]
        assert unpacked["path"] == server.get("/path")
        assert "127.0.0.1" not in page and TOKEN not in page


def test_export_refuses_what_it_cannot_write(kerf, program, files):
    part = program()
    assert kerf("view", part, "--export", "part.nc").status == 1
    assert part.read_text() == VALID
    assert kerf("view", part, "--export", "no/such/folder/x.html").status == 1
    assert kerf("view", program("G1 X Y\n", "bad.nc"), "--export", "x.html").status == 1
    assert kerf("view", "missing.nc", "--export", "x.html").status == 1
    assert files() == ["bad.nc", "part.nc"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_export_to_a_full_disk(kerf, program):
    result = kerf("view", program(), "--export", "/dev/full")
    assert result.status == 1 and result.err


def test_downloads(view):
    server = view()
    server.ready()
    start = {"stl": None, "3mf": b"PK", "glb": b"glTF", "obj": None, "png": b"\x89PNG", "gcode": None}
    for name, mark in start.items():
        status, headers, body = server.request(f"/download/{name}")
        assert status == 200, name
        ending = "nc" if name == "gcode" else name
        assert headers["content-disposition"] == f'attachment; filename="part.{ending}"'
        assert len(body) > 50 and (mark is None or body.startswith(mark)), name
    assert b"G1" in server.get("/download/gcode?post=linuxcnc")


def test_texts_of_files_are_data(view):
    """Names and comments with markup arrive as JSON texts, and cannot leave their block in an export."""
    evil = "</script><script>alert(1)</script>"
    text = f"({evil})\n(MSG, {evil})\n" + VALID
    server = view(text, name="a<b>&'.nc")
    model = server.ready()
    assert model["name"] == "a<b>&'.nc" and model["files"][0]["text"] == text
    assert any(evil in mark["text"] for mark in model["marks"])
    status, headers, body = server.request("/export")
    assert headers["content-disposition"] == 'attachment; filename="a_b___.nc.html"'
    assert b"alert(1)" not in body


def test_two_pages_at_once_and_not_too_many(view, program):
    server = view()
    server.ready()
    pages = [EventReader(server) for _ in range(8)]
    assert server.request("/events")[0] == 503
    program(VALID.replace("Z-1", "Z-2"))
    for page in pages:
        page.wait(lambda name, data: name == "model" and data["revision"] == 2)
    for page in pages[1:]:
        page.connection.sock.shutdown(socket.SHUT_RDWR)
    end = time.monotonic() + 20
    while time.monotonic() < end:  # the server notices at its next sign of life
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=5)
        connection.request("GET", f"/events?t={TOKEN}")
        status = connection.getresponse().status
        connection.close()
        if status == 200:
            break
        time.sleep(0.5)
    assert status == 200


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_ends_cleanly(view, how, tmp_path):
    server = view()
    server.ready()
    events = EventReader(server)
    start = time.monotonic()
    status, err = server.end(how)
    assert status == 0 and err == ""
    assert time.monotonic() - start < 5
    events.join(5)
    assert not events.is_alive()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["part.nc"]


def test_ends_while_it_works(view):
    server = view("a = 1;\nwhile(1) { a = a + 1; }\n", "--limit", "50", name="part.gcmc")
    time.sleep(0.3)
    start = time.monotonic()
    assert server.end()[0] == 0
    assert time.monotonic() - start < 5


def test_a_port_in_use_is_an_error(view, kerf, program):
    server = view()
    result = kerf("view", program(), "--port", server.port)
    assert result.status == 1 and f"port {server.port} is in use" in result.err
    assert server.request("/model")[0] == 200


def test_wrong_usage(kerf, program):
    part = program()
    for options in (["--port", "70000"], ["--port", "x"], ["--token", "short"],
                    ["--token", "has spaces in it, 16"], ["--limit", "0"], ["--resolution", "0"]):
        assert kerf("view", part, *options).status == 2, options
    assert kerf("view").status == 2


def test_other_kinds_of_input(view, kerf):
    rapids = view("G21 G90\nG0 X1 Y1 Z1\nG0 X5\nM2\n", name="rapids.nc").ready()
    assert rapids["kind"] == "drawing" and rapids["tiles"]["count"] == 0 and rapids["stock"] is None
    printed = view("M82\nG28\nG1 X10 Y10 Z0.2 F3000\nG1 X30 Y10 E1.0 F1200\nG1 X30 Y30 E2.0\nG1 X10 Y30 E3\n",
                   name="print.gcode")
    model = printed.ready()
    assert model["kind"] == "print" and model["tiles"]["count"] == 1
    assert model["report"]["volumes"]["beads"] == 3
    assert printed.mesh()[3][0][2]
    assert printed.request("/at?step=1")[0] == 404
    turned = view("G21 G90\nM6 T102\nM3 S9000\nG0 X0 Y0 Z12\nG1 Z8 F100\nG1 A360 F2000\nG0 Z12\nM2\n",
                  "--rotary", "d=20 length=40 x=-20", name="turned.nc")
    model = turned.wait(lambda m: m["state"] != "loading")
    assert model["kind"] == "rotary" and model["stock"]["shape"] == "bar", model["errors"]
    assert turned.mesh()[3][0][2]


ROUTER = Path(__file__).parents[2] / "data" / "machines" / "grbl_router.toml"


@pytest.mark.parametrize("options", [[], ["--machine", str(ROUTER)]])
def test_the_times_of_the_motions_add_up_to_that_of_the_report(view, options):
    """With dwells between motions, before the first and after the last, and a first rapid from nowhere."""
    server = view("G21 G90\nG4 P1\nT102 M6\nG0 X30 Y40 Z5\nG4 P2\nG1 Z-1 F100\nG1 X40\nG4 P4\nM2\n", *options)
    model = server.ready()
    seconds = [m["seconds"] for m in read_path(server.get("/path"))[1]]
    assert len(seconds) == 3 and sum(seconds) == pytest.approx(model["times"]["total_s"], abs=1e-3)
    if not options:  # 50 mm at 3000 mm/min and 5 mm up from Z0; 6 and 10 mm at 100 mm/min
        rapid = (30 ** 2 + 40 ** 2 + 5 ** 2) ** 0.5 / 50
        assert seconds == pytest.approx([1 + rapid, 2 + 3.6, 6 + 4], abs=1e-3)


def test_opens_files_of_its_folder_alone(view, tmp_path):
    server = view()
    server.ready()
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "inner.nc").write_text(VALID.replace("Z-1", "Z-2"))
    (tmp_path / "other.nc").write_text(VALID.replace("Z-1", "Z-3"))
    (tmp_path / "notes.md").write_text("text")
    (tmp_path / ".hidden.nc").write_text(VALID)
    outside = tmp_path.parent / f"{tmp_path.name}-beside"
    outside.mkdir()
    (outside / "secret.nc").write_text(VALID)
    (tmp_path / "link.nc").symlink_to(outside / "secret.nc")
    assert json.loads(server.get("/files"))["files"] == ["link.nc", "other.nc", "part.nc"]
    secret = outside / "secret.nc"
    for name in ("", "..", f"../{outside.name}/secret.nc", str(secret), "link.nc", "missing.nc",
                 "/etc/passwd", "below", "..%2f..%2fetc%2fpasswd", "a%00b", "%2e%2e/x.nc"):
        assert server.request(f"/open?src={name}", method="POST")[0] == 404, name
    assert server.model()["name"] == "part.nc"
    assert server.request("/open?src=other.nc", method="POST", token=None)[0] == 403
    assert server.request("/open?src=other.nc")[0] == 404  # GET
    for name in ("other.nc", "below/inner.nc"):
        assert server.request(f"/open?src={name}", method="POST")[0] == 200
        shown = server.wait(lambda m, name=name: m.get("name") == Path(name).name and m["state"] == "ready")
        assert shown["errors"] == []


def upload(server, name, body, token=TOKEN):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    try:
        connection.request("POST", f"/drop?name={name}&t={token}", body=body,
                           headers={"Content-Type": "application/octet-stream"})
        return connection.getresponse().status
    except (BrokenPipeError, ConnectionResetError):
        return None  # refused before the whole body was sent
    finally:
        connection.close()


def test_files_that_a_page_uploads(view, tmp_path):
    server = view()
    server.ready()
    assert upload(server, "new.nc", VALID.encode(), token="wrong") == 403
    assert upload(server, "new.exe", b"MZ") == 400
    assert upload(server, "new.toml", b"[[operation]]") == 400
    assert upload(server, "new.py", b"print()") == 400
    assert upload(server, "big.nc", b"(" * (65 << 20)) in (413, None)
    assert server.model()["name"] == "part.nc"
    assert upload(server, "..%2f..%2fnew.nc", VALID.replace("Z-1", "Z-2").encode()) == 200
    shown = server.wait(lambda m: m["name"] != "part.nc" and m["state"] == "ready")
    kept = Path(shown["source"])
    assert kept.name == "_.._.._new.nc"[1:] or kept.name.endswith("new.nc")
    assert kept.is_file() and kept.parent.stat().st_mode & 0o077 == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["part.nc"]
    status, _ = server.end()
    assert status == 0 and not kept.parent.exists()


def test_a_target_is_compared_after_each_save(view, kerf, program, tmp_path):
    target = tmp_path / "target.stl"
    assert kerf("simulate", program(VALID, "nominal.nc"), "-o", target).status == 0
    server = view(VALID.replace("Z-1", "Z-2"), "--target", str(target))
    model = server.ready()
    deepest = max(model["target"]["regions"], key=lambda r: r["depth_mm"])
    assert deepest["kind"] == "gouge" and deepest["depth_mm"] == pytest.approx(1, abs=0.02)
    body = server.get("/target")
    nx, ny = struct.unpack_from("<2I", body, 12)
    x, y, pitch = struct.unpack_from("<3f", body, 20)
    depth = struct.unpack_from(f"<{nx * ny}f", body, 32)
    assert body[:4] == b"KDIF" and len(body) == 32 + 4 * nx * ny and (x, y) == (0, 0)
    at = int(10 / pitch) * nx + int(15 / pitch)  # on the slot from X10 to X20 at Y10
    assert depth[at] == pytest.approx(-1, abs=0.02) and depth[int(25 / pitch) * nx + int(5 / pitch)] == 0
    (tmp_path / "part.nc").write_text(VALID)
    model = server.ready(after=model["revision"])
    assert model["target"]["region_count"] == 0 and model["target"]["gouged_mm3"] == 0
    (tmp_path / "target.stl").write_bytes(b"broken")
    assert server.wait(lambda m: m["state"] == "failed")["errors"]


def test_outlines_and_meshes(view, kerf, program, tmp_path):
    outline = {"unit": "mm", "outlines": [{"name": "p", "closed": True, "first": {"at": [0, 0]},
               "segments": [{"to": [40, 0]}, {"to": [40, 20], "via": [50, 10]}, {"to": [0, 20]}]}]}
    drawn = view(json.dumps(outline), name="plate.json").ready()
    assert drawn["kind"] == "drawing" and drawn["findings"] == [] and drawn["front_end"] == "outlines"
    assert drawn["bounds"][1][0] == pytest.approx(50) and drawn["motions"] == 5
    broken = view('{"outlines": 1}', name="broken.json").wait(lambda m: m["state"] == "failed")
    assert broken["errors"]
    mesh = tmp_path / "part.stl"
    assert kerf("simulate", program(VALID, "nominal.nc"), "-o", mesh).status == 0
    server = view(mesh.read_bytes(), name="again.stl")
    model = server.ready()
    assert model["kind"] == "milling" and model["stock"]["shape"] == "mesh" and model["motions"] == 0
    assert model["findings"] == []
    assert volume_of(server.mesh()[3]) == pytest.approx(model["report"]["volumes"]["left_mm3"], rel=0.02)


class PageTiles:
    """The tiles of a page that follows the protocol: asks for what is newer and renumbers what it has."""

    def __init__(self):
        self.revision, self.tiles = 0, {}

    def update(self, server):
        body = server.get(f"/mesh?since={self.revision}")
        tables, at = struct.unpack_from("<I", body, 24)[0], 28
        runs = []
        for _ in range(tables):
            count = struct.unpack_from("<I", body, at + 4)[0]
            runs.append([struct.unpack_from("<Ii", body, at + 8 + 8 * k) for k in range(count)])
            at += 8 + 8 * count
        self.revision, flags, _, changed = read_mesh(body)
        if flags & 1:
            self.tiles = {}
        for table in runs:
            for number, (level, positions, index, steps) in self.tiles.items():
                self.tiles[number] = (level, positions, index, tuple(renumbered(s, table) for s in steps))
        self.tiles.update(changed)


def renumbered(step, table):
    by = 0
    for first, shift in table:
        if step != 0xffffffff and first <= step:
            by = shift
    return step if step == 0xffffffff else step + by


def test_random_edits_show_what_a_fresh_start_shows(view, tmp_path):
    """Lines changed, inserted, removed and moved, tools changed, the stock too: the page always has the tiles
    of a server that has just started."""
    chance = random.Random(19)
    lines = ["G21 G90", "T102 M6", "M3 S10000", "G0 Z5", "G0 X5 Y5", "G1 Z-1 F200"]
    lines += [f"G1 X{chance.uniform(2, 38):.2f} Y{chance.uniform(2, 28):.2f} F600" for _ in range(30)]
    head = ["(stockMin:0.00mm, 0.00mm, -6.00mm)", "(stockMax:40.00mm, 30.00mm, 0.00mm)"]
    end = ["G0 Z5", "M2", ""]

    def edit():
        at = chance.randrange(5, len(lines))
        kind = chance.randrange(7)
        x, y, depth = chance.uniform(-2, 42), chance.uniform(-2, 32), chance.uniform(0, 5)
        new = f"G1 X{x:.2f} Y{y:.2f} Z-{depth:.2f} F600"
        if kind < 2:
            lines[at] = new
        elif kind == 2:
            lines.insert(at, new)
        elif kind == 3 and len(lines) > 10:
            del lines[at]
        elif kind == 4:
            other = chance.randrange(5, len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == 5:
            lines.insert(at, chance.choice(["G0 Z3", "T201 M6", "T102 M6", "(a comment)", "G4 P0.1"]))
        else:
            head[0] = f"(stockMin:0.00mm, 0.00mm, -{chance.choice(['6.00', '7.00'])}mm)"

    def text():
        return "\n".join(head + lines + end)

    server = view(text(), "--columns")
    page, revision = PageTiles(), server.ready()["revision"]
    for turn in range(EDITS):
        page.update(server)
        before = text()
        while text() == before:
            edit()
        (tmp_path / "part.nc").write_text(text())
        revision = server.ready(after=revision)["revision"]
        page.update(server)
        if turn % 5 == 4 or turn + 1 == EDITS:
            fresh = view(text(), "--columns", name="fresh.nc")
            fresh.ready()
            expected = fresh.mesh()[3]
            assert {n for n, t in page.tiles.items() if t[3]} == {n for n, t in expected.items() if t[3]}
            for number, tile in expected.items():
                assert page.tiles[number] == tile, (turn, number)
            fresh.end()


SCRIPT = """import kerf
import depths
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((5, 5, 5))
path.cut((5, 5, -depths.SLOT), feed=100)
path.cut((25, 5, -depths.SLOT), feed=400)
path.rapid((25, 5, 5))
kerf.simulate(path, kerf.Stock.block((30, 10, 6)))
"""


MODULES = Path(KERF).parent / "python" / "kerf"


@pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")
def test_python_scripts(view, tmp_path):
    (tmp_path / "depths.py").write_text("SLOT = 2\n")
    server = view(SCRIPT, "--limit", "20", name="part.py")
    model = server.wait(lambda m: m["state"] != "loading")
    assert model["errors"] == [] and model["front_end"] == "Python" and model["name"] == "part.py"
    assert model["bounds"] == [[0, 0, -6], [30, 10, 0]]
    # The slot: 20 mm long, 3.175 mm wide, with two half circles at its ends, 2 mm deep.
    removed = (20 * 3.175 + 3.14159265 * 3.175 ** 2 / 4) * 2
    # By columns of 0.3 mm, whose walls are not measured finer.
    assert model["report"]["volumes"]["removed_mm3"] == pytest.approx(removed, rel=0.06)
    assert [Path(f["path"]).name for f in model["files"]] == ["part.py"]
    time.sleep(0.2)
    assert server.model()["revision"] == 1  # what the script writes is not watched
    (tmp_path / "depths.py").write_text("SLOT = 4\n")
    model = server.ready(after=1)
    assert model["report"]["volumes"]["removed_mm3"] == pytest.approx(2 * removed, rel=0.06)
    (tmp_path / "part.py").write_text(SCRIPT.replace("depths.SLOT), feed=100", "depths.WRONG), feed=100"))
    errors = server.wait(lambda m: m["state"] == "failed")["errors"]
    assert errors[0]["origin"]["line"] == 7 and "WRONG" in errors[0]["message"]
    (tmp_path / "part.py").write_text("import kerf\n")
    assert "no toolpath" in server.wait(lambda m: "WRONG" not in str(m["errors"]))["errors"][0]["message"]


@pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")
def test_an_error_of_a_script_with_a_relative_name_has_its_line(tmp_path, monkeypatch):
    """Tracebacks name the whole path."""
    (tmp_path / "part.py").write_text("x = 0\ny = 1 / x\n")
    monkeypatch.chdir(tmp_path)
    server = View("part.py", "--limit", "20")
    try:
        error = server.wait(lambda m: m["state"] == "failed")["errors"][0]
    finally:
        server.process.kill()
        server.process.communicate(timeout=20)
    assert error["origin"]["file"] == "part.py" and error["origin"]["line"] == 2


@pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")
def test_errors_of_scripts_have_their_lines(view, tmp_path):
    """A function of the script calls a module beside it."""
    (tmp_path / "depths.py").write_text("def deep(d):\n    return 1 / d\n")
    script = "import depths\n\ndef cut(d):\n    return depths.deep(d)\n\ncut(0)\n"
    server = view(script, "--limit", "20", name="part.py")
    error = server.wait(lambda m: m["state"] == "failed")["errors"][0]
    assert Path(error["origin"]["file"]).name == "depths.py" and error["origin"]["line"] == 2
    assert "ZeroDivisionError" in error["message"]
    assert error["hint"] == "called from part.py:4, called from part.py:6"
    (tmp_path / "part.py").write_text("x = 1\ny = (2,\n")
    error = server.wait(lambda m: "SyntaxError" in str(m["errors"]))["errors"][0]
    assert Path(error["origin"]["file"]).name == "part.py" and error["origin"]["line"] == 2
    (tmp_path / "part.py").write_text("\nexec(compile('1 / 0', '', 'exec'))\n")  # a file without a name
    error = server.wait(lambda m: "ZeroDivisionError" in str(m["errors"]))["errors"][0]
    assert Path(error["origin"]["file"]).name == "part.py" and error["origin"]["line"] == 2
    (tmp_path / "part.py").write_text("while True: print('x' * 1_000_000)\n")
    error = server.wait(lambda m: "prints" in str(m["errors"]))["errors"][0]
    assert error["message"] == "the script prints more than 64 MB"


@pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")
def test_a_script_gives_its_stock_as_a_text(view, tmp_path):
    (tmp_path / "depths.py").write_text("SLOT = 2\n")
    server = view(SCRIPT.replace("kerf.Stock.block((30, 10, 6))", "'-5,-2,-8 to 30,10,0'"), "--limit", "20",
                  name="part.py")
    assert server.ready()["bounds"] == [[-5, -2, -8], [30, 10, 0]]


def runs(pid):
    try:
        return "(zombie)" not in Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False


def test_scripts_without_end_are_stopped(view, tmp_path):
    started = tmp_path / "started"
    text = ("import os\nos.fork()\n"
            f"with open({str(started)!r}, 'a') as file: file.write(f'{{os.getpid()}}\\n')\n"
            "while True: print('x')\n")
    server = view(text, "--limit", "1.5", name="endless.py")
    errors = server.wait(lambda m: m["state"] == "failed")["errors"]
    assert "not read within 1 s" in errors[0]["message"]
    pids = [int(line) for line in started.read_text().split()]
    assert len(pids) == 2
    end = time.monotonic() + 5
    while any(runs(pid) for pid in pids):
        assert time.monotonic() < end, "a process of the script still runs"
        time.sleep(0.05)


OWN_POST = 'name = "mine"\ntitle = "My mill"\nbase = "grbl"\nfile_ending = ".tap"\n'


def post_list(folder):
    """The names of kerf post --list in a folder."""
    listed = subprocess.run([KERF, "post", "--list", "--json"], capture_output=True, text=True, cwd=folder)
    return [one["name"] for one in json.loads(listed.stdout)]


def test_the_posts_of_a_page_are_those_of_the_command(view, tmp_path, monkeypatch):
    """Own posts of the configured folder and beside the program, languages of machines, drawings."""
    monkeypatch.setenv("KERF_NO_CONFIG", "")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "user"))
    (tmp_path / "mills").mkdir()
    (tmp_path / "kerf.toml").write_text('[folders]\nposts = "mills"\n')
    (tmp_path / "mills" / "shed.toml").write_text(OWN_POST)
    (tmp_path / "router.toml").write_text(OWN_POST.replace(".tap", ".cnc"))
    (tmp_path / "job.toml").write_text('[job]\nart = "a.svg"\n')
    server = view()
    posts = server.ready()["posts"]
    assert posts == ["router.toml", *post_list(tmp_path)]
    assert "shed" in posts and {"shopbot", "rml", "rml100", "dxf", "kerf"} < set(posts)
    options = {"router.toml": ["--post", "router.toml"]}
    for post, ending in (("shed", "tap"), ("router.toml", "cnc"), ("shopbot", "sbp"), ("rml", "rml"),
                         ("linuxcnc", "ngc"), ("dxf", "dxf"), ("sheet", "html"), ("kerf", "kerf")):
        status, headers, body = server.request("/download/gcode?post=" + post)
        assert status == 200, (post, body)
        assert headers["content-disposition"].endswith(f'.{ending}"')
        wanted = subprocess.run([KERF, "post", *options.get(post, ["--to", post]), "part.nc", "-o",
                                 str(tmp_path / f"out.{ending}")], capture_output=True, cwd=tmp_path)
        assert wanted.returncode == 0, wanted.stderr
        if post != "kerf":  # which names its source by its path
            assert body == (tmp_path / f"out.{ending}").read_bytes(), post


@pytest.mark.parametrize("name", ["../mine.toml", "mills/shed.toml", "job.toml", "/etc/passwd", "none",
                                  "a%00b"])
def test_a_page_names_no_other_files_as_posts(view, tmp_path, name):
    (tmp_path / "mills").mkdir()
    for file in ("mills/shed.toml", "../mine.toml"):
        (tmp_path / file).write_text(OWN_POST)
    (tmp_path / "job.toml").write_text('[job]\nart = "a.svg"\n')
    server = view()
    server.ready()
    status, _, body = server.request("/download/gcode?post=" + name)
    assert status == 404 and "there is no post" in json.loads(body)["error"]

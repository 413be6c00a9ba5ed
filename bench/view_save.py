#!/usr/bin/env python3
"""Times `kerf view` on a large relief: from a save to the answer complete at a client, by stage.

    bench/view_save.py KERF [--moves N] [--runs N] [--resolution MM] [--web BUILD/web] [-o FILE]

The program is a relief cut by a ball of 3.175 mm: lines 0.15 mm apart on 150 mm for a million moves, over
waves of 3.7 mm. Each save changes one thing halfway: a depth (same number of lines), one line more,
or a feed. The client asks by web/PROTOCOL.md for what a page asks for. Figures in Markdown, the median of N
runs: ms from the save to the announcement and to the last byte, ms of processor time of the server, the
stages of the server as it states them (header Server-Timing), bytes of each answer. With --web also the
page in Chromium: ms from a save to the picture, and the memory of the page.

On a machine with other work only the processor time and the bytes are meaningful.
"""
import argparse
import contextlib
import http.client
import json
import math
import os
import re
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

WEB = Path(__file__).resolve().parent.parent / "web"
TOKEN = "a-token-for-the-benchmark"
SIDE = 150.0  # mm
WAVE = 3.7  # mm from crest to crest
OPTIONS = ["--tool", "ball d=3.175 flute=12.7", "--stock", f"0,0,-6 to {SIDE:g},{SIDE:g},0"]
TICKS = os.sysconf("SC_CLK_TCK")


def relief(moves):
    """The lines of a program: rows along X to and fro."""
    rows = math.isqrt(moves)
    pitch = SIDE / rows
    lines = ["G21 G90 G17", "M6 T1", "M3 S16000", "G0 X0 Y0 Z5", "F1000"]
    for r in range(rows):
        y = pitch * (r + 0.5)
        across = math.cos(2 * math.pi * y / WAVE)
        for s in range(rows):
            x = pitch * ((s if r % 2 == 0 else rows - 1 - s) + 0.5)
            z = -1.0 + 0.6 * math.sin(2 * math.pi * x / WAVE) * across
            lines.append(f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}")
    return [*lines, "G0 Z5", "M30"]


def changed(lines, kind, run):
    """The lines with one change halfway, another one in each run."""
    out = list(lines)
    at = len(lines) // 2 + 37 * run
    if kind == "depth":
        out[at] = re.sub(r"Z\S+", f"Z{-1.9 - 0.01 * run:.3f}", out[at])
    elif kind == "line more":
        out.insert(at, re.sub(r"Z\S+", f"Z{-1.8 - 0.01 * run:.3f}", out[at]))
    else:
        out[at] += f" F{900 + run}"
    return out


def text_of(lines):
    return "\n".join(lines) + "\n"


class Client:
    """Follows a server as a page does, and keeps what a page keeps."""

    def __init__(self, kerf, file, resolution):
        command = [kerf, "view", file, "--json", "--columns", "--token", TOKEN,
                   "--resolution", str(resolution), *OPTIONS]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.address = json.loads(self.process.stdout.readline())["address"]
        self.port = int(re.search(r":(\d+)", self.address)[1])
        self.http = http.client.HTTPConnection("127.0.0.1", self.port, timeout=600)
        self.events = http.client.HTTPConnection("127.0.0.1", self.port, timeout=600)
        self.events.request("GET", f"/events?t={TOKEN}")
        self.stream = self.events.getresponse()
        self.revision = {"mesh": 0, "path": 0}

    def end(self):
        self.process.terminate()
        self.process.wait()

    def processor_ms(self):
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) * 1000 / TICKS

    def memory_mb(self):
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024

    def wait(self, after):
        """Until a revision above `after` is announced."""
        name = ""
        for line in self.stream:
            line = line.decode().rstrip("\n")
            if line.startswith("event: "):
                name = line[7:]
            elif line.startswith("data: ") and name == "errors":
                sys.exit(line)
            elif line.startswith("data: ") and name == "model" and json.loads(line[6:])["revision"] > after:
                return
        sys.exit("the server has ended")

    def get(self, what, **query):
        self.http.request("GET", f"/{what}?t={TOKEN}" + "".join(f"&{k}={v}" for k, v in query.items()))
        answer = self.http.getresponse()
        body = answer.read()
        assert answer.status == 200, body
        return body, answer.getheader("Server-Timing") or ""

    def load(self):
        """Bytes and ms of each answer, and the server's stages."""
        sizes, times, stages = {}, {}, {}
        for what in ("model", "mesh", "path"):
            begin = time.perf_counter()
            query = {} if what == "model" else {"since": self.revision[what]}
            body, timing = self.get(what, **query)
            times[what] = (time.perf_counter() - begin) * 1000
            sizes[what] = len(body)
            stages.update({k: float(v) for k, v in re.findall(r"(\w+);dur=([\d.]+)", timing)})
            if what in self.revision:
                self.revision[what] = struct.unpack_from("<I", body, 8)[0]
        return sizes, times, stages


def one_save(client, file, text):
    """Figures of one save, by name."""
    before, cpu = client.revision["mesh"], client.processor_ms()
    beside = file.with_suffix(".new")
    beside.write_text(text)
    begin = time.perf_counter()
    beside.replace(file)  # whole at once, as editors save
    client.wait(before)
    announced = time.perf_counter()
    sizes, _, stages = client.load()
    ended = time.perf_counter()
    return {"announced ms": (announced - begin) * 1000, "complete ms": (ended - begin) * 1000,
            "server CPU ms": client.processor_ms() - cpu, **{f"{k} ms": v for k, v in stages.items()},
            **{f"{what} bytes": size for what, size in sizes.items()}}


def row(cells):
    return "| " + " | ".join(cells) + " |"


def table(figures):
    """`figures`: {column: [one dict a run]}."""
    names = list(dict.fromkeys(name for runs in figures.values() for run in runs for name in run))
    print(row(["", *figures]))
    print(row(["---"] * (1 + len(figures))))
    for name in names:
        cells = [[run[name] for run in runs if name in run] for runs in figures.values()]
        print(row([name, *(f"{statistics.median(c):,.0f}" if c else "" for c in cells)]), flush=True)


def server_figures(options, lines, work):
    file = work / "relief.nc"
    file.write_text(text_of(lines))
    client = Client(options.kerf.resolve(), file, options.resolution)
    try:
        client.wait(0)
        first, _, stages = client.load()
        figures = {"opening": [{**{f"{k} ms": v for k, v in stages.items()},
                                **{f"{k} bytes": v for k, v in first.items()}}]}
        for kind in ("depth", "line more", "feed"):
            figures[kind] = []
            for run in range(options.runs):
                figures[kind].append(one_save(client, file, text_of(changed(lines, kind, run))))
                one_save(client, file, text_of(lines))
        size = file.stat().st_size / 1e6
        print(f"\n{len(lines):,} lines, {size:.1f} MB; server {client.memory_mb():.0f} MB\n")
        table(figures)
    finally:
        client.end()


def page_figures(options, lines, work):
    """By web/tests/bench/large.test.ts."""
    for name, text in (("before", text_of(lines)), ("after", text_of(changed(lines, "line more", 0)))):
        (work / f"{name}.nc").write_text(text)
    out = work / "page.json"
    environment = {**os.environ, "KERF": str(options.kerf.resolve()), "KERF_BENCH_OUT": str(out),
                   "KERF_BENCH_LARGE": str(work), "KERF_BENCH_OPTIONS": json.dumps(
                       ["--resolution", str(options.resolution), *OPTIONS])}
    done = subprocess.run([WEB / "test.sh", "bench", options.web.resolve(), "large.test"], env=environment,
                          stdout=sys.stderr)
    if done.returncode == 0:
        print()
        table({"page": [json.loads(out.read_text())]})


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kerf", type=Path)
    parser.add_argument("--moves", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--resolution", type=float, default=0.15)
    parser.add_argument("--web", type=Path, help="the folder of the built page: measures it in Chromium too")
    parser.add_argument("-o", "--output", type=Path, help="write the tables to this file")
    options = parser.parse_args()
    lines = relief(options.moves)
    with contextlib.ExitStack() as stack:
        work = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if options.output:
            stack.enter_context(contextlib.redirect_stdout(stack.enter_context(options.output.open("w"))))
        server_figures(options, lines, work)
        if options.web:
            page_figures(options, lines, work)


if __name__ == "__main__":
    sys.exit(main())

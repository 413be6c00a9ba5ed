"""Calls per second of a script that builds a toolpath, start and exit of Python included, beside the same
script on a plain list and on FullControl; then the time of `import kerf`, and of a script to a GLB.

    PYTHONPATH=build/python python3 bench/python/calls.py [--benchmark_format=json]
        [--benchmark_filter=REGEX] [SCRIPT.py ...]

SCRIPT.py is a script of gcodepreview that shows its part (the template of 448 moves); its files are written
to a temporary folder. FullControl is measured if it is installed. Processor time and elapsed time, the best
of some runs. The options are those of Google Benchmark, for `./dev bench`.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

MOVES = 300_000
RUNS = 3
LOOP = "for i in range({n}):\n    x, y = i % 500 * 0.2, i // 500 * 0.1\n    {call}\n"
SCRIPTS = {
    "plain list of tuples": ("path = []\nadd = path.append\n", 'add(("cut", (x, y, -1.0), 800.0))'),
    "kerf.Toolpath": (
        "import kerf\npath = kerf.Toolpath()\npath.tool(102)\ncut = path.cut\n",
        "cut((x, y, -1.0), 800.0)",
    ),
    "kerf.Toolpath, beads": (
        "import kerf\npath = kerf.Toolpath()\npath.rapid((-1, 0, 0.2))\nextrude = path.extrude\n",
        "extrude((x, y, 0.2), 3000.0, width=0.45, height=0.2)",
    ),
    "gcodepreview": (
        "from gcodepreview import *\ngcp = gcodepreview('no_preview')\n",
        "gcp.cutline(x, y, -1.0)",
    ),
    "FullControl": (
        "import fullcontrol as fc\npath = []\nadd = path.append\n",
        "add(fc.Point(x=x, y=y, z=-1.0))",
    ),
}


def measured(words, folder=None, runs=RUNS):
    """The least processor time and the least elapsed time, s."""
    best_cpu = best_wall = float("inf")
    for _ in range(runs):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run([sys.executable, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best_cpu, best_wall = min(best_cpu, cpu), min(best_wall, wall)
    return best_cpu, best_wall


def rows(pattern, scripts):
    """(name, processor time, elapsed time, calls): of what the pattern names."""
    empty = measured(["-c", "pass"])
    for name, (head, call) in SCRIPTS.items():
        if not re.search(pattern, f"python/{name}"):
            continue
        if name == "FullControl" and importlib.util.find_spec("fullcontrol") is None:
            continue
        yield name, *measured(["-c", head + LOOP.format(n=MOVES, call=call)]), MOVES
    if re.search(pattern, "python/import kerf"):
        cpu, wall = measured(["-c", "import kerf"])
        yield "import kerf, less an empty script", cpu - empty[0], wall - empty[1], 0
    for script in scripts:
        if not re.search(pattern, f"python/{pathlib.Path(script).name}"):
            continue
        with tempfile.TemporaryDirectory() as folder:
            copy = shutil.copy(script, folder)
            cpu, wall = measured([pathlib.Path(copy).name], folder)
        yield pathlib.Path(script).name + " to GLB", cpu, wall, 0


def row_json(name, cpu, wall, calls):
    row = {"name": f"python/{name}", "real_time": wall, "cpu_time": cpu, "time_unit": "s"}
    return {**row, "items_per_second": calls / cpu} if calls else row


def main():
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--benchmark_format", default="console", choices=["console", "json"])
    parser.add_argument("--benchmark_filter", default="")
    parser.add_argument("scripts", nargs="*")
    options = parser.parse_args()
    os.environ["PYTHONPATH"] = os.pathsep.join(os.path.abspath(p) for p in sys.path if p)
    found = rows(options.benchmark_filter, options.scripts)
    if options.benchmark_format == "json":
        print(json.dumps({"benchmarks": [row_json(*row) for row in found]}))
        return
    for name, cpu, wall, calls in found:
        rate = f"{calls / cpu:10,.0f} calls/s" if calls else ""
        print(f"{name:34s} {cpu * 1e3:8.1f} ms cpu  {wall * 1e3:8.1f} ms {rate}".rstrip(), flush=True)


if __name__ == "__main__":
    main()

"""Calls per second of a script that builds a toolpath, start and exit of Python included, beside the same
script on a plain list and on FullControl; then the time of `import kerf`, and of a script to a GLB.

    PYTHONPATH=build/python python3 bench/python/calls.py [SCRIPT.py]

SCRIPT.py is a script of gcodepreview that shows its part (the template of 448 moves); its files are written
to a temporary folder. FullControl is measured if it is installed. Processor time and elapsed time, the best
of some runs.
"""

import importlib.util
import os
import pathlib
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
        "import kerf\npath = kerf.Toolpath()\nextrude = path.extrude\n",
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


def main():
    os.environ["PYTHONPATH"] = os.pathsep.join(os.path.abspath(p) for p in sys.path if p)
    empty = measured(["-c", "pass"])
    print(f"{'empty script':34s} {empty[0] * 1e3:8.1f} ms cpu  {empty[1] * 1e3:8.1f} ms")
    for name, (head, call) in SCRIPTS.items():
        if name == "FullControl" and importlib.util.find_spec("fullcontrol") is None:
            print(f"{name:34s} not installed")
            continue
        cpu, wall = measured(["-c", head + LOOP.format(n=MOVES, call=call)])
        print(f"{name:34s} {MOVES / cpu:10,.0f} calls/s cpu  {MOVES / wall:10,.0f} calls/s")
    cpu, wall = measured(["-c", "import kerf"])
    cpu, wall = cpu - empty[0], wall - empty[1]
    print(f"{'import kerf, less an empty script':34s} {cpu * 1e3:8.1f} ms cpu  {wall * 1e3:8.1f} ms")
    for script in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as folder:
            copy = shutil.copy(script, folder)
            cpu, wall = measured([pathlib.Path(copy).name], folder)
            size = sum(p.stat().st_size for p in pathlib.Path(folder).glob("*.glb"))
        name = pathlib.Path(script).name + " to GLB"
        print(f"{name:34s} {cpu * 1e3:8.1f} ms cpu  {wall * 1e3:8.1f} ms, {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()

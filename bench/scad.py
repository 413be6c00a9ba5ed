#!/usr/bin/env python3
"""Compares `kerf run` with openscad on programs that compute.

    bench/scad.py KERF [--openscad PROGRAM] [--runs N] [--only WORD] [--template FILE.scad]

Each program is generated, and echoes a result, which must be that of openscad. The two run in turn, N times;
a figure is the least processor time (user) of the runs, which other work on the machine disturbs little. The
last column is the time of openscad divided by that of Kerf; both include the start of the program. --template
adds the time from an OpenSCAD program of gcodepreview to its toolpath.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAMS = {
    "loop of 1,000,000, sums": """
values = [for (s = 0, i = 0; i < 1000000; s = s + i * 2 % 7, i = i + 1) if (i == 999999) s];
echo(values);
""",
    "loop of 1,000,000, a list": """
list = [for (i = [0:999998]) i * 0.5 + sin(i)];
echo(len(list), list[77777]);
""",
    "loop of 1,000,000, statement": """
for (i = [0:999], j = [0:999]) if (i * j == 999 * 999) echo(i + j);
""",
    "loop of 1,000,000, filter": """
list = [for (i = [0:999998]) if (i % 3 == 0 && i % 5 != 0) i];
echo(len(list), list[777]);
""",
    "nested list comprehensions": """
m = [for (i = [0:999]) [for (j = [0:499]) i * j - (i > j ? i : j)]];
echo(len(m), m[500][250]);
points = [for (a = [0:0.01:720]) [cos(a) * 10, sin(a) * 10, a / 360]];
echo(len(points), points[12345]);
""",
    "recursion": """
function fib(n) = n < 2 ? n : fib(n - 1) + fib(n - 2);
echo(fib(25));
""",
    "tail recursion": """
function sum(i, s = 0) = i == 0 ? s : sum(i - 1, s + i);
echo(sum(900000));
""",
    "strings": """
function join(list, i = 0, s = "") = i == len(list) ? s : join(list, i + 1, str(s, list[i]));
words = [for (i = [0:19999]) str("G1 X", i / 10, " Y", i % 100)];
echo(len(join([for (i = [0:1999]) words[i]])), len(words), search("Y", words[100]));
""",
    "vectors": """
function walk(i, p, d) = i == 0 ? p : walk(i - 1, p + d * 0.5, [d[1], -d[0], d[2] / 2]);
echo(walk(300000, [0, 0, 0], [1, 2, 3]));
""",
    "function literals": """
apply = function(f, list) [for (x = list) f(x)];
twice = function(g) function(y) g(g(y));
list = apply(twice(function(z) z * 2 + 1), [1:200000]);
echo(len(list), list[1234]);
""",
    "calls of modules": """
module leaf(i, k) { x = i + k; if (x < 0) echo(x); }
module row(i) for (j = [0:299]) leaf(i, j);
for (i = [0:299]) row(i);
echo("end");
""",
}


def run(command):
    """(user seconds, what the program echoes)"""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    output = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.stdout.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime, "".join(line + "\n" for line in output.splitlines() if line.startswith("ECHO"))


def compare(kerf, openscad, program, folder, runs):
    """(seconds of Kerf, seconds of openscad, whether both echo the same)"""
    echo = folder / "out.echo"
    ours, theirs = [], []
    same = True
    for _ in range(runs):
        seconds, text = run([kerf, "run", program])
        ours.append(seconds)
        if openscad:
            theirs.append(run([openscad, "-o", echo, program])[0])
            same = same and text == echo.read_text()
    return min(ours), min(theirs, default=None), same


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kerf", type=Path)
    parser.add_argument("--openscad", default="openscad", help="empty: Kerf alone")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--only", default="", help="only programs with this in their name")
    parser.add_argument("--template", type=Path, help="an OpenSCAD program of gcodepreview")
    options = parser.parse_args()
    kerf = options.kerf.resolve()
    all_same = True
    print("| program | kerf, s | openscad, s | ratio |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = folder / "program.scad"
        for title, text in PROGRAMS.items():
            if options.only not in title:
                continue
            program.write_text(text.lstrip())
            own, other, same = compare(kerf, options.openscad, program, folder, options.runs)
            all_same = all_same and same
            figures = f"{other:.3f} | {other / own:.1f}" if other else "| "
            title += "" if same else " (NOT THE SAME RESULT)"
            print(f"| {title} | {own:.3f} | {figures} |", flush=True)
        if options.template:
            seconds = min(run([kerf, "info", options.template])[0] for _ in range(options.runs))
            print(f"| {options.template.name} | {seconds:.3f} | | |")
    return 0 if all_same else 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Times whole commands, from the program's file to the picture, the mesh or the report.

    bench/first_picture.py KERF [--programs FOLDER] [--runs N] [--only WORD]
                           [--tables files,relief,sweep] [-o FILE]

Tables, in Markdown:
  files   a picture, a sharp STL and a GLB of ten real programs of FOLDER and of the template of
          gcodepreview, or, without FOLDER, of the programs of examples/
  relief  `simulate --json` of 1,000,000 relief moves at 0.1 mm
  sweep   a picture and an STL of reliefs of 10,000 to 3,000,000 moves at 0.4 to 0.05 mm: time and
          memory should not grow towards coarser columns

Each figure is the least of N runs: elapsed seconds on at most two processors, seconds of processor time
(user and system), and the largest memory in MB. On a machine with other work only the processor time is
meaningful.
"""
import argparse
import contextlib
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REAL = ["freecad_Base_board.nc", "makera_coppercam_pcb.nc", "mach3_pcbgcode_etch.nc",
        "camotics_locket_outside.ngc", "camotics_bear.nc", "ugs_communicator.nc", "gsender_SheepTile-v2.nc",
        "webgcode_tux_ocl.ngc", "camotics_vcarve.ngc", "cambam_inch_bulkhead.nc"]
TEMPLATE = "gcodepreviewtemplate.motion.json"  # recorded motions of the template
OUTPUTS = {"picture": ["part.png"], "sharp STL": ["part.stl"], "GLB": ["part.glb"]}
SWEEP_MOVES = [10_000, 100_000, 1_000_000, 3_000_000]
SWEEP_PITCHES = [0.4, 0.2, 0.1, 0.05]
PROCESSORS = 2


def on_two_processors():
    with contextlib.suppress(AttributeError, OSError):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:PROCESSORS])


def measure(command, runs):
    """(elapsed s, processor s, MB), the least of `runs` runs; None if the command fails."""
    best = None
    for _ in range(runs):
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   preexec_fn=on_two_processors)
        _, status, used = os.wait4(process.pid, 0)
        elapsed = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 3):  # 3: the program has hazards
            return None
        found = (elapsed, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
        best = found if best is None else tuple(map(min, best, found))
    return best


def cell(figures):
    return "failed" if figures is None else f"{figures[0]:.2f} / {figures[1]:.2f} s, {figures[2]:.0f} MB"


def row(cells):
    return "| " + " | ".join(cells) + " |"


def template_program(motions, path):
    """The recorded motions of the template as G-code: one event per line of its list."""
    lines, here = ["G21 G90 G17"], None
    for event in json.loads(Path(motions).read_text()):
        if event["ev"] == "toolchange":
            lines += [f"M6 T{event['number']}", "M3 S16000"]
        if event["ev"] != "move":
            continue
        begin, end = ("X{:.6f} Y{:.6f} Z{:.6f}".format(*event[key]) for key in "be")
        if begin != here:
            lines += ["G0 Z50", "G0 " + begin.rsplit(" ", 1)[0], "G0 " + begin]
        lines.append(("G1 F1000 " if event["kind"] == "cut" else "G0 ") + end)
        here = end
    path.write_text("\n".join(lines + ["G0 Z50", "M30", ""]))


def relief_program(path, moves):
    """Rows of a ball over a wavy surface between 0.3 and 6 mm deep in a board of 220 x 150 mm."""
    rows = round(math.sqrt(moves))
    segments = moves // rows
    with path.open("w") as out:
        out.write("G21 G90 G17\nM6 T1\nM3 S16000\nG0 X0 Y0 Z5\nF1000\n")
        for r in range(rows):
            y = 150.0 * (r + 0.5) / rows
            for s in range(segments):
                x = 220.0 * (s if r % 2 == 0 else segments - 1 - s) / (segments - 1)
                z = (-3.15 + 1.4 * math.sin(0.11 * x + 0.3) * math.cos(0.09 * y) +
                     0.9 * math.sin(0.31 * x + 0.17 * y) + 0.55 * math.sin(0.53 * y - 0.23 * x))
                out.write(f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f}\n")
        out.write("G0 Z5\nM30\n")


RELIEF_OPTIONS = ["--tool", "ball d=3.175 flute=12.7", "--stock", "0,0,-8.35 to 220,150,0"]


def table_of_files(kerf, folder, runs, only, work):
    template = work / "template.nc"
    if folder:
        folder_of_programs = folder / "gcode" if (folder / "gcode").is_dir() else folder
        programs = [folder_of_programs / name for name in REAL]
        motions = list(folder.rglob(TEMPLATE))
        if motions:
            template_program(motions[0], template)
            programs.append(template)
    else:
        programs = sorted([*(ROOT / "examples").glob("*.nc"), *(ROOT / "examples").glob("*.gcmc")])
    print(row(["program", *OUTPUTS]))
    print(row(["---"] * (1 + len(OUTPUTS))), flush=True)
    for program in programs:
        if not program.exists() or only not in program.name:
            continue
        extra = ["--stock", "220x150x8.35 at centre top"] if program == template else []
        figures = [measure([kerf, "simulate", "-q", program, *extra,
                            *(a for name in names for a in ("-o", work / name))], runs)
                   for names in OUTPUTS.values()]
        print(row([program.name, *map(cell, figures)]), flush=True)


def table_of_relief(kerf, runs, work):
    program = work / "relief.nc"
    relief_program(program, 1_000_000)
    command = [kerf, "simulate", "--json", program, *RELIEF_OPTIONS, "--resolution", "0.1"]
    print(row(["1,000,000 relief moves", "elapsed / processor time, memory"]))
    print(row(["---", "---"]))
    print(row(["kerf simulate --json --resolution 0.1", cell(measure(command, runs))]))
    print(row(["kerf info", cell(measure([kerf, "info", "--json", program], runs))]), flush=True)


def table_of_sweep(kerf, runs, only, work):
    print(row(["moves, output", *(f"{pitch} mm" for pitch in SWEEP_PITCHES)]))
    print(row(["---"] * (1 + len(SWEEP_PITCHES))), flush=True)
    for moves in SWEEP_MOVES:
        program = work / f"relief_{moves}.nc"
        relief_program(program, moves)
        for name in ("part.png", "part.stl"):
            if only not in name:
                continue
            command = [kerf, "simulate", "-q", program, *RELIEF_OPTIONS, "-o", work / name, "--resolution"]
            figures = [measure([*command, str(pitch)], runs) for pitch in SWEEP_PITCHES]
            print(row([f"{moves:,} {name[-3:]}", *map(cell, figures)]), flush=True)
        program.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kerf", type=Path)
    parser.add_argument("--programs", type=Path, help="folder of the real programs")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--only", default="", help="only programs (sweep: outputs) with this in their name")
    parser.add_argument("--tables", default="files,relief,sweep")
    parser.add_argument("-o", "--output", type=Path, help="write the tables to this file")
    options = parser.parse_args()
    tables = options.tables.split(",")
    kerf = options.kerf.resolve()
    with contextlib.ExitStack() as stack:
        work = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if options.output:
            stack.enter_context(contextlib.redirect_stdout(stack.enter_context(options.output.open("w"))))
        if "files" in tables:
            table_of_files(kerf, options.programs, options.runs, options.only, work)
        if "relief" in tables:
            print()
            table_of_relief(kerf, options.runs, work)
        if "sweep" in tables:
            print()
            table_of_sweep(kerf, options.runs, options.only, work)


if __name__ == "__main__":
    sys.exit(main())

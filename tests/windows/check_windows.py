#!/usr/bin/env python3
"""Runs kerf.exe under Wine. Its results must be those of the command of this system: texts, G-code and
pictures byte by byte, meshes within 1e-6 mm, because sines and roots of the two C libraries differ in their
last digit.

Usage: check_windows.py SOURCE KERF_EXE KERF FOLDER
"""

import argparse
import array
import pathlib
import re
import shutil
import subprocess
import zipfile

WINE = "/usr/lib/wine/wine64"
COMMANDS = (
    ("simulate", "demo.nc", "-o", "demo.stl", "-o", "demo.png", "-o", "demo.3mf"),
    ("check", "demo.nc"),
    ("check", "--machine", "grbl_router", "demo.nc"),
    ("info", "demo.nc"),
    ("post", "--to", "grbl", "demo.nc", "-o", "demo_grbl.nc"),
    ("post", "--to", "linuxcnc", "demo.nc"),
    ("cut", "--op", "engrave", "--text", "AB", "--height", "10", "--tool", "V d=6 angle=60", "--depth", "0.4",
     "--feed", "600", "--rpm", "9000", "-o", "text.nc"),
    ("post", "--to", "grbl", "größe 日本.nc", "-o", "größe 日本 😀.nc"),
    ("gcmc", "plate.gcmc"),
    ("simulate", "plate.gcmc"),
    ("cut", "rest.toml", "-o", "rest.nc"),
    ("check", "missing.nc"),
    ("check", "wrong.nc"),
)
WRONG = "G21 G90\nG1 X10 Y\n"
SAME_MM = 1e-6
TIMES = re.compile(rb"simulated in [0-9.]+ s|\(20[0-9-]+ [0-9:]+\)")
NUMBER = re.compile(rb"-?[0-9]+(?:\.[0-9]+)?(?:e[-+][0-9]+)?")


def expect(condition, what):
    print("ok    " if condition else "WRONG ", what, flush=True)
    return condition


def results(program, source, folder):
    """For each command its status, output and messages; then each file that was written."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in ("demo.nc", "plate.gcmc", "rest.toml"):
        shutil.copy(source / "examples" / name, folder)
    shutil.copy(source / "examples/demo.nc", folder / "größe 日本.nc")
    (folder / "wrong.nc").write_text(WRONG)
    runs = [subprocess.run([*program, *words], cwd=folder, capture_output=True, timeout=1200)
            for words in COMMANDS]
    made = {" ".join(words): (run.returncode, TIMES.sub(b"", run.stdout), run.stderr)
            for words, run in zip(COMMANDS, runs, strict=True)}
    return made | {path.name: path for path in sorted(folder.iterdir())}


def parts_of(path):
    """The bytes of a file without its coordinates, and these in mm."""
    if path.suffix == ".3mf":
        with zipfile.ZipFile(path) as archive:
            data = b"\n".join(archive.read(name) for name in sorted(archive.namelist()))
        return NUMBER.sub(b"", data), [float(number) for number in NUMBER.findall(data)]
    data = path.read_bytes()
    if path.suffix != ".stl":
        return data, []
    header, triangle = 84, 50  # a triangle: twelve numbers and two bytes
    numbers = array.array("f", b"".join(data[k:k + 48] for k in range(header, len(data), triangle)))
    return data[:header], numbers


def is_same(here, there):
    if not isinstance(here, pathlib.Path):
        return here == there
    (text, numbers), (text_there, numbers_there) = parts_of(here), parts_of(there)
    return (text == text_there and len(numbers) == len(numbers_there) and
            all(abs(a - b) <= SAME_MM for a, b in zip(numbers, numbers_there, strict=True)))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("windows", type=pathlib.Path)
    parser.add_argument("here", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    windows = [WINE, options.windows.resolve()]
    version = subprocess.run([*windows, "--version"], capture_output=True, text=True, timeout=600).stdout
    print(version)
    good = expect(version.startswith("kerf "), "kerf.exe --version")
    here = results([options.here.resolve()], options.source, options.folder / "here")
    there = results(windows, options.source, options.folder / "windows")
    good &= expect(list(here) == list(there), f"the same files: {', '.join(list(here)[len(COMMANDS):])}")
    for name, made in here.items():
        good &= expect(name in there and is_same(made, there[name]), name)
    if not good:
        raise SystemExit(f"check_windows: the results in {options.folder} differ")


if __name__ == "__main__":
    main()

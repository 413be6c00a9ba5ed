#!/usr/bin/env python3
"""Compiles the sources for another system: what does not compile there, or with warnings, is reported.

Usage: compile_elsewhere.py SOURCE FOLDER TARGET [FILTER]

TARGET is macos (Clang with libc++ and Apple's headers, by the PyPI package ziglang), windows (MinGW-w64) or
clang (Clang 14 with this system's headers). The headers of the libraries are those of this system. FOLDER
receives links to them and the objects; FOLDER/generated contains the headers that a build makes
(embedded_*.h, build_info.h). FILTER is a regular expression for names of files. The last lines count the
files of each folder that compile. Exit status 1: a file does not compile; 77: the compiler is not installed.
"""

import collections
import concurrent.futures
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading

SKIPPED = 77
HEADERS = ("fmt", "nlohmann", "toml++", "hwy", "boost", "CLI", "minizip", "freetype2", "httplib.h", "png.h",
           "pngconf.h", "pnglibconf.h", "zlib.h", "zconf.h", "expat.h", "expat_external.h")
FLAGS = ["-std=c++20", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wnon-virtual-dtor"]


def compiler(target):
    """The command, or nothing."""
    if target == "windows":
        found = shutil.which("x86_64-w64-mingw32-g++-posix")
        return [found, "-D_WIN32_WINNT=0x0A00", "-DUNICODE", "-D_UNICODE"] if found else None
    if target == "macos":
        if not importlib.util.find_spec("ziglang"):
            return None
        # After <cmath> ziglang's <cfloat> lacks FLT_RADIX, which toml++ uses.
        return [sys.executable, "-m", "ziglang", "c++", "-target", "aarch64-macos",
                "-DFLT_RADIX=__FLT_RADIX__", "-Wno-builtin-macro-redefined", "-Wno-macro-redefined"]
    found = shutil.which("clang++-14")
    return [found] if found else None


def links(folder):
    """A folder with the headers of the libraries alone: those of this system's C library stay outside."""
    include = folder / "include"
    include.mkdir(parents=True, exist_ok=True)
    for name in HEADERS:
        for root in (pathlib.Path("/usr/include"), *pathlib.Path("/usr/include").glob("*-linux-gnu")):
            if (root / name).exists() and not (include / name).exists():
                (include / name).symlink_to(root / name)
    return include


def compile_one(words, file, folder):
    # An object for each thread: zig makes none with -fsyntax-only, and fails.
    made = ["-c", "-O0", "-o", str(folder / f"{threading.get_ident()}.o")]
    check = ["-fsyntax-only"] if "clang" in words[0] else made
    done = subprocess.run([*words, *check, str(file)], capture_output=True, text=True, timeout=600)
    return file, done.returncode, done.stderr


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    source, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    target, wanted = sys.argv[3], re.compile(sys.argv[4] if len(sys.argv) == 5 else "")
    command = compiler(target)
    if command is None:
        print("the compiler is not installed")
        return SKIPPED
    include = links(folder)
    roots = [source / "include", source / "src", *(path for path in (folder / "generated",) if path.exists())]
    defined = [f"-DKERF_WITH_{part}=1" for part in ("PNG", "ZIP", "FREETYPE", "SVG", "3MF")]
    words = [*command, *FLAGS, *(f"-I{root}" for root in roots), f"-isystem{include}",
             f"-isystem{include}/freetype2", *defined, "-DKERF_VERSION=\"\"", "-DTOML_HEADER_ONLY=1",
             "-DFMT_HEADER_ONLY=1"]
    files = [file for file in sorted((source / "src").rglob("*.cpp"))
             if "wasm" not in file.parts and wanted.search(str(file.relative_to(source)))]
    failed, total, good = [], collections.Counter(), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, status, text in pool.map(lambda file: compile_one(words, file, folder), files):
            room = file.relative_to(source).parts[1]
            total[room] += 1
            good[room] += status == 0
            if status:
                failed.append(file)
            if text:
                print(f"{file.relative_to(source)}\n{text[:2000]}", flush=True)
    for room, count in sorted(total.items()):
        print(f"{room:8} {good[room]:4} of {count}")
    print(f"{target}: {len(files) - len(failed)} of {len(files)} files compile")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

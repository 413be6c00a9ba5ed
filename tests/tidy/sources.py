"""Which files the checks read, and how they report: shared by all of tests/tidy. Standard library only."""
import os
import re
import subprocess
import sys
from pathlib import Path

# Made by builds and tools, never part of the repository.
PASSED_OVER = re.compile(
    r"^(\.git|build(-.*)?|demo-output|dist|node_modules|__pycache__|\.pytest_cache|.*\.egg-info)$")
CPP = {".h", ".cpp"}


def root_of(argv):
    """The repository: the first argument, else two folders above this file."""
    return Path(argv[1] if len(argv) > 1 else Path(__file__).parents[2]).resolve()


def files(root, suffixes=None):
    """Every file of the repository as a path relative to `root`, sorted; `suffixes` chooses some."""
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if not PASSED_OVER.match(f)]
        for name in names:
            path = (Path(folder) / name).relative_to(root)
            if suffixes is None or path.suffix in suffixes:
                found.append(path)
    return sorted(found)


def blank_comments_and_strings(text):
    """C++ text with comments and literals replaced by spaces, so that places stay where they are."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"([^()\s\\]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"'
        r"|(?<![0-9A-Za-z_])'(?:\\.|[^'\\\n])*'", re.S)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def git(root, *arguments):
    """What git answers in the repository, or None where it refuses or is not installed."""
    try:
        run = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return run.stdout if run.returncode == 0 else None


def finish(check, problems):
    """Prints what is wrong, one a line, and ends the program."""
    for problem in problems:
        print(problem)
    print(f"{check}: {len(problems)} problem(s)" if problems else f"{check}: in order")
    sys.exit(1 if problems else 0)

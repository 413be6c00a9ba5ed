"""Rules for every text: line length, opening comment, nothing stray in the root, no place of one machine."""
import re
import sys

from sources import CPP, files, finish, git, root_of

COLUMNS = 110
LENGTH_SUFFIXES = CPP | {".py", ".def", ".cmake", ".ts"}
IN_ROOT = {
    ".clang-format", ".gitignore", "ARCHITECTURE.md", "CHANGELOG.md", "CMakeLists.txt", "CMakePresets.json",
    "CONTRIBUTING.md", "LICENSE", "NOTICE", "README.md", "dev", "pyproject.toml",
}
FOLDERS_IN_ROOT = {
    ".ci", "bench", "cmake", "data", "docs", "editors", "examples", "fuzz", "include", "posts", "python",
    "src", "tests", "web",
}
# Paths of one machine have no place in what others read. (Written so that this file does not contain them.)
FORBIDDEN = re.compile(r"(?<![\w.])/" + "(work/|root/|home/[a-z]|Users/[a-z])")
BINARY = {".png", ".stl", ".glb", ".3mf", ".gz", ".zip"}


def check_text(path, text):
    """Problems of one file's text; `path` is relative and decides which rules hold."""
    problems = []
    suffix = "." + path.rsplit(".", 1)[-1] if "." in path else ""
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        if suffix in LENGTH_SUFFIXES and len(line) > COLUMNS:
            problems.append(f"{path}:{number}: {len(line)} columns, the limit is {COLUMNS}")
        if place := FORBIDDEN.search(line):
            problems.append(f"{path}:{number}: names a place of one machine: {place.group()}")
    if suffix in CPP and not (lines and lines[0].startswith("//")):
        problems.append(f"{path}:1: a file opens with a comment that says what it is for")
    return problems


def stray(names, folders):
    """Problems of the root: names of files and folders that are not known there."""
    problems = [f"{name}: stray file in the root" for name in sorted(set(names) - IN_ROOT)]
    unknown = sorted(set(folders) - FOLDERS_IN_ROOT)
    return problems + [f"{name}/: stray folder in the root" for name in unknown]


def main():
    root = root_of(sys.argv)
    every = files(root)
    names = {p.parts[0] for p in every if len(p.parts) == 1}
    # In a working tree of git, what is git's own or ignored is nobody's stray file.
    names = {n for n in names if n != ".git" and git(root, "check-ignore", n) is None}
    problems = stray(names, {p.parts[0] for p in every if len(p.parts) > 1})
    for path in every:
        if path.suffix in BINARY or path.parts[:2] == ("fuzz", "corpus") or path.name == ".git":
            continue
        problems += check_text(path.as_posix(), (root / path).read_text(errors="replace"))
    finish("text_rules", problems)


if __name__ == "__main__":
    main()

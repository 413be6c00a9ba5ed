"""Every text: line length, opening comment, links, no stray file in the root, no absolute paths."""
import posixpath
import re
import sys

from sources import CPP, files, finish, git, root_of

COLUMNS = 110
LENGTH_SUFFIXES = CPP | {".py", ".def", ".cmake", ".ts"}
IN_ROOT = {
    ".clang-format", ".gitignore", "ARCHITECTURE.md", "CHANGELOG.md", "CMakeLists.txt", "CMakePresets.json",
    "CONTRIBUTING.md", "LICENSE", "NOTICE", "README.md", "VERSION", "dev",
    "SECURITY.md", "pyproject.toml",
}
FOLDERS_IN_ROOT = {
    ".ci", "bench", "cmake", "data", "docs", "editors", "examples", "fuzz", "include", "licences", "posts",
    ".github", "python", "src", "tests", "web",
}
# Absolute paths of one machine. (Written so that this file does not contain them.)
FORBIDDEN = re.compile(r"(?<![\w.])/" + "(work/|root/|home/[a-z]|Users/[a-z])")
# A decision fits on about a screen; what is longer belongs in docs/benchlog.
DECISION_LINES = 80
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
NAMED_DOCUMENT = re.compile(r"\bdocs/[\w/-]+\.md\b")
# Documents that are not in the repository. (Written so that this file does not name them.)
ELSEWHERE = re.compile("spec" + r"/[a-z0-9_]+\.md")
# The constants of POSIX in <cmath>, which Windows' headers do not have in standard C++; <numbers> has them.
POSIX_CONSTANT = re.compile(r"\bM_(?:PI|E|SQRT|LN|LOG|[12]_)\w*")
# What takes a file's name in the encoding of the system, on Windows not UTF-8. Only src/base calls it.
OTHER_NAMES = re.compile(r"\bstd::(?:filesystem\b|rename\()|<filesystem>|\b[io]?fstream\b|\bf(?:re)?open\(")
HAS_NAMES = ("src/", "python/", "include/")
# Texts that a user reads start with a noun or a verb: help, keys of jobs, descriptions of parameters.
IN_DOCSTRING = re.compile(r"^ +Of [a-z]")
FRAGMENTS = {".cpp": [re.compile(r'"[Oo]f [a-z]'), IN_DOCSTRING], ".py": [IN_DOCSTRING]}
BINARY = {".png", ".stl", ".glb", ".3mf", ".gz", ".zip"}


def check_text(path, text):
    """Problems of one file's text; `path` is relative and decides which rules hold."""
    problems = []
    suffix = "." + path.rsplit(".", 1)[-1] if "." in path else ""
    lines = text.splitlines()
    names_files = path.startswith(HAS_NAMES) and not path.startswith("src/base/")
    shown = suffix in FRAGMENTS and path.startswith(("src/", "python/"))
    for number, line in enumerate(lines, 1):
        if suffix in LENGTH_SUFFIXES and len(line) > COLUMNS:
            problems.append(f"{path}:{number}: {len(line)} columns, the limit is {COLUMNS}")
        if match := FORBIDDEN.search(line):
            problems.append(f"{path}:{number}: names a path of one machine: {match.group()}")
        if match := ELSEWHERE.search(line):
            problems.append(f"{path}:{number}: cites {match.group()}, which is not in the repository")
        if shown and any(rule.search(line) for rule in FRAGMENTS[suffix]):
            problems.append(f"{path}:{number}: a text starts with \"of\" instead of a noun or a verb")
        if suffix in CPP and (match := POSIX_CONSTANT.search(line)):
            problems.append(f"{path}:{number}: {match.group()} is not in standard C++: use <numbers>")
        if suffix in CPP and names_files and (match := OTHER_NAMES.search(line)):
            problems.append(f"{path}:{number}: {match.group()} takes no names in UTF-8 on Windows: use "
                            "base/file_names.h, InputFile or OutputSet")
    if suffix in CPP and not (lines and lines[0].startswith("//")):
        problems.append(f"{path}:1: a file starts with a comment that states its purpose")
    return problems


def check_links(path, text, exists):
    """Problems of a file's references to documents; `exists` says whether a path of the repository does."""
    if path == "tests/tidy/tidy_test.py":  # its documents are invented
        return []
    named = {(match.group(), match.group(), match.start()) for match in NAMED_DOCUMENT.finditer(text)}
    if path.endswith(".md"):
        folder = posixpath.dirname(path)
        named |= {(match.group(1), posixpath.normpath(posixpath.join(folder, match.group(1))), match.start())
                  for match in LINK.finditer(text)}
    return [f"{path}:{text.count(chr(10), 0, at) + 1}: no such document: {shown}"
            for shown, target, at in sorted(named, key=lambda n: n[2]) if not exists(target)]


def check_decision(path, text, index):
    """Problems of a page of docs/decisions; `index` is the text of its README."""
    problems = []
    if text.count("\n") > DECISION_LINES:
        problems.append(f"{path}: {text.count(chr(10))} lines, the limit is {DECISION_LINES}")
    if not re.search(r"^Status: (in force|partly replaced by \[|replaced by \[)", text, re.M) \
            and not path.endswith("README.md"):
        problems.append(f"{path}: no line with its status")
    if path.rsplit("/", 1)[-1] not in index:
        problems.append(f"{path}: not listed in docs/decisions/README.md")
    return problems


def stray(names, folders):
    """Problems of the root: unknown files and folders."""
    problems = [f"{name}: stray file in the root" for name in sorted(set(names) - IN_ROOT)]
    unknown = sorted(set(folders) - FOLDERS_IN_ROOT)
    return problems + [f"{name}/: stray folder in the root" for name in unknown]


def main():
    root = root_of(sys.argv)
    every = files(root)
    names = {p.parts[0] for p in every if len(p.parts) == 1}
    # Files of git itself and ignored files are not stray.
    names = {n for n in names if n != ".git" and git(root, "check-ignore", n) is None}
    problems = stray(names, {p.parts[0] for p in every if len(p.parts) > 1})
    decisions = (root / "docs/decisions/README.md").read_text()
    for path in every:
        if path.suffix in BINARY or path.parts[:2] == ("fuzz", "corpus") or path.name == ".git":
            continue
        text = (root / path).read_text(errors="replace")
        problems += check_text(path.as_posix(), text)
        problems += check_links(path.as_posix(), text, lambda target: (root / target).exists())
        if path.parts[:2] == ("docs", "decisions"):
            problems += check_decision(path.as_posix(), text, decisions)
    finish("text_rules", problems)


if __name__ == "__main__":
    main()

"""Examples that provoke diagnostics: the tables of docs/site/examples, one for each table of codes.

A table is named as the code. Its keys are files and their text, `run`, a line of the shell in their folder
(`kerf info FILE` of the first file where it is missing), and `cannot`: why no file provokes the code.
"""
import os
import re
import subprocess
import tempfile
from pathlib import Path

try:
    import tomllib
except ImportError:  # Python 3.10 and older
    tomllib = None

FOLDER = Path(__file__).parent / "examples"
OWN_KEYS = ("run", "cannot")
LIMIT = 60  # s


def read(kind):
    """The examples of one table of codes by their names, in its order."""
    path = FOLDER / f"{kind}.toml"
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() and tomllib else {}


def files_of(example):
    return {name: text for name, text in example.items() if name not in OWN_KEYS}


def command_of(example):
    return example.get("run") or f"kerf info {next(iter(files_of(example)))}"


def run(example, kerf):
    """Runs an example in a folder of its own. Returns the exit status and all that was printed."""
    with tempfile.TemporaryDirectory() as folder:
        work, tools = Path(folder, "work"), Path(folder, "bin")
        work.mkdir(), tools.mkdir()
        (tools / "kerf").symlink_to(Path(kerf).resolve())
        for name, text in files_of(example).items():
            (work / name).write_text(text, encoding="utf-8")
        path = os.pathsep.join([str(tools), os.environ["PATH"]])
        environment = {**os.environ, "PATH": path, "XDG_CONFIG_HOME": folder, "COLUMNS": "100",
                       "KERF_NO_CONFIG": "" if "kerf.toml" in example else "1"}
        environment.pop("KERF_FONTS", None)
        done = subprocess.run(command_of(example), shell=True, cwd=work, env=environment, timeout=LIMIT,
                              check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
    return done.returncode, done.stdout.decode("utf-8", errors="replace").replace(str(work) + "/", "")


def message_of(output, number, name):
    """The lines of a diagnostic and its hint: by its number, in a JSON object, or as a hazard by its name."""
    lines = output.splitlines()
    marks = (f"[{number}]", f'"code": {number},', f"[{name.split('_', 1)[-1]}]")
    for mark in marks:
        for i, line in enumerate(lines):
            if mark in line:
                hint = lines[i + 1: i + 2] if i + 1 < len(lines) and "hint:" in lines[i + 1] else []
                return [line, *hint]
    return []


def section(number, name, meaning, example, kerf):
    """The section of the reference for a code with an example."""
    lines = [f"({name})=", f"### {number} {name.replace('_', ' ')}", "", meaning, ""]
    if "cannot" in example:
        return [*lines, f"No file provokes it. {example['cannot']}", ""]
    longest = 40  # lines of a file on the page
    for file, text in files_of(example).items():
        if text.count("\n") > longest:
            lines += [f"`{file}` is that of `{name}` in docs/site/examples.", ""]
        else:
            fence = "````" if "```" in text else "```"
            lines += [f"`{file}`:", "", f"{fence}text", text.rstrip("\n"), fence, ""]
    _, output = run(example, kerf)
    return [*lines, "```text", f"$ {command_of(example)}", *message_of(output, number, name), "```", ""]


def codes(text):
    """[(number, name, meaning)] of a table of codes."""
    rows = re.findall(r'^KERF_CODE\((\d+), (\w+),\s*"((?:[^"\\]|\\.|"\s*")*)"\)', text, re.M)
    return [(int(number), name, re.sub(r'"\s*"', "", meaning).replace('\\"', '"'))
            for number, name, meaning in rows]

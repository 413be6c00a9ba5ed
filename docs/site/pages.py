"""Pages of the documentation that are made from the sources: commands, diagnostics, headers, Python.

`./dev docs` copies this folder into the build folder, with the headers as its folder `include`; the pages are
written there.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import examples  # noqa: E402

ROOT = Path(os.environ["KERF_SOURCE_DIR"])
DOCS = ROOT / "docs"

# The order of the pages of diagnostics, and their titles.
KINDS = {"files": "Files", "gcode": "G-code", "gcmc": "gcmc", "scad": "OpenSCAD",
         "pathdxf": "Path drawings", "outline": "Drawings and outlines", "op": "Operations and passes",
         "tools": "Tools", "stock": "Stock", "path": "Toolpaths", "sim": "Simulation"}


def version():
    return (ROOT / "VERSION").read_text().strip()


def write(path, text):
    """Writes a page if it differs, so that Sphinx reads only what changed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def command_help(kerf, *words):
    """The help as text; the drop-in commands have the status of the original programs."""
    done = subprocess.run([kerf, *words, "--help"], capture_output=True, text=True, timeout=60, check=False,
                          env={**os.environ, "COLUMNS": "100", "KERF_NO_CONFIG": "1"})
    return (done.stdout or done.stderr).rstrip()


def commands(kerf):
    """The page of all commands, with their help."""
    overview = command_help(kerf)
    names = re.findall(r"^  ([a-z]+) {2,}\S", overview, re.M)
    lines = ["# Commands", "", "The help of each command, as the command prints it.", "", "```text", overview,
             "```", ""]
    for name in names:
        lines += [f"## kerf {name}", "", "```text", command_help(kerf, name), "```", ""]
    return "\n".join(lines)


def diagnostics(kerf):
    """The page of all codes: number, name and meaning, and a program that provokes each."""
    lines = ["# Diagnostics", "",
             "Each error, warning and note has a number and a name, which never change. `--json` has both;",
             "the text has the message. Hazards of `kerf check` have the name without its first word.", "",
             "The tables link to examples: files, a command, and its message. A test runs each.", ""]
    sections = []
    for kind, title in KINDS.items():
        known = examples.read(kind)
        lines += [f"## {title}", "", "| number | name | meaning |", "|---|---|---|"]
        sections += [f"## Examples: {title}", ""]
        table = (ROOT / "src" / "base" / "codes" / f"{kind}.def").read_text()
        for number, name, text in examples.codes(table):
            meaning = re.sub(r"([<>*_`])", r"\\\1", text)
            link = f"[`{name}`](#{name})" if name in known else f"`{name}`"
            lines.append(f"| {number} | {link} | {meaning.replace('|', chr(92) + '|')} |")
            if name in known:
                sections += examples.section(number, name, meaning, known[name], kerf)
        lines.append("")
    return "\n".join(lines + sections)


def headers():
    """The page of the C++ library: its public headers, whole."""
    lines = ["# C++ headers", "",
             "The headers are the reference: each states what its functions take, return and report, in",
             "which units and frame. [Installing](../manual/install.md) has the lines for CMake.", ""]
    include = ROOT / "include"
    for path in sorted(include.rglob("*.h")):
        name = path.relative_to(include).as_posix()
        lines += [f"## {name}", "", f"```{{literalinclude}} /include/{name}", ":language: cpp", "```",
                  ""]
    return "\n".join(lines)


PYTHON = """# {module}

The calls of the module, from their docstrings. [Kerf from Python](../manual/python.md) is the introduction.

```{{eval-rst}}
.. automodule:: {module}
{options}```
"""
# The modules with their options of autodoc. Each has its own page, because each has a section of examples.
MODULES = {"kerf": "   :imported-members:\n", "kerf.op": "", "gcodepreview": "", "cnc25d_api": ""}


def write_generated(app):
    """Writes the pages of the reference; KERF names the command, and Python's path has the modules."""
    folder = Path(app.srcdir) / "reference"
    write(folder / "commands.md", commands(os.environ["KERF"]))
    write(folder / "diagnostics.md", diagnostics(os.environ["KERF"]))
    write(folder / "headers.md", headers())
    for module, options in MODULES.items():
        write(folder / f"{module}.md", PYTHON.format(module=module, options=options))


def title_without_section(app, what, name, obj, options, lines):
    """Makes "Examples" of a module a title without a section: several pages with one label are a warning."""
    if what != "module":
        return
    for i in range(len(lines) - 1):
        if lines[i] and set(lines[i + 1]) == {"-"}:
            lines[i], lines[i + 1] = f".. rubric:: {lines[i]}", ""


LINK = re.compile(r"(?<!\!)\[([^\]]+)\]\(([^)#:\s]+)\)")


def link_to_repository(app, docname, source):
    """Links to files and folders that are no page of the documentation become their names."""
    folder = (DOCS / docname).parent

    def shown(match):
        text, target = match.groups()
        path = (folder / target).resolve()
        is_page = path.suffix == ".md" and DOCS in path.parents and "benchlog" not in path.parts
        return match[0] if is_page or not path.exists() else f"{text} (`{path.relative_to(ROOT)}`)"

    source[0] = LINK.sub(shown, source[0])

"""Commands and blocks of the manual, the how-tos and README: they run as written, on files of their names."""
import os
import re
import shutil
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import pytest
from conftest import VALID

ROOT = Path(__file__).parents[2]
KERF = Path(os.environ["KERF"]).resolve()
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "manual").glob("*.md")),
         *sorted((ROOT / "docs" / "how-to").glob("*.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
STARTS = re.compile(r"(kerf|gcmc|python3?|\./dev|sudo|git|build/kerf|~/kerf/bin/\w+|PYTHONPATH=\S+) ")
# What is not run, and why.
NOT_RUN = {
    r"^\./dev |build/": "builds Kerf itself",
    r"^python3 -m venv|pip install|^sudo |^~/kerf/bin/kerf": "installs Kerf",
    r"^gcmc ": "shows what another program calls",
    r"^kerf view": "is a server: test_readme.py and test_view_server.py start it",
}
# Where a status other than 0 is right: hazards are what a check is for.
CHECKS = re.compile(r"kerf check ")


def commands_of(text):
    """(line of the page, command, the lines that follow it as its output)."""
    fences = [(m.start(), m.end()) for m in FENCE.finditer(text)]
    found = []
    for m in FENCE.finditer(text):
        if m[1] not in ("", "sh"):
            continue
        at = text[: m.start(2)].count("\n") + 1
        body = re.sub(r"\\\n\s*", lambda join: " \0", m[2])  # a command over several lines
        for line in body.split("\n"):
            if STARTS.match(line):
                found.append((at, re.split(r"\s+#| {4,}", line.replace("\0", ""))[0], []))
            elif line and found and not line.startswith("#"):
                found[-1][2].append(line)
            at += 1 + line.count("\0")
    for m in re.finditer(r"^    (kerf .*|gcmc .*)$", text, re.M):
        if not any(low <= m.start() < high for low, high in fences):
            found.append((text[: m.start()].count("\n") + 1, re.split(r" {3,}", m[1])[0], []))
    return sorted(found)


def svg(body):
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="60mm" viewBox="0 0 100 60">'
            f'{body}</svg>\n')


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes(8 * (x + y) % 256 for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def tags(*rows):
    return "".join(f"{group}\n{value}\n" for group, value in rows)


RED = '<rect x="10" y="10" width="40" height="30" fill="none" stroke="red"/>'
BLUE = '<rect x="60" y="10" width="20" height="30" fill="none" stroke="blue"/>'
CIRCLE = tags((0, "CIRCLE"), (8, "CUT"), (10, 20), (20, 20), (40, 15))
DXF = (tags((0, "SECTION"), (2, "HEADER"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"))
       + tags((0, "SECTION"), (2, "ENTITIES")) + CIRCLE + tags((0, "ENDSEC"), (0, "EOF")))
PRINT = "M104 S210\nM140 S60\nM190 S60\nM109 S210\nG90\nM83\nG28\n" + "".join(
    f";LAYER_CHANGE\n;Z:{z / 10}\nG1 Z{z / 10} F3000\nG1 X20 Y20 F6000\n;TYPE:External perimeter\n"
    "G1 X60 E1.4 F1800\nG1 Y60 E1.4\nG1 X20 E1.4\nG1 Y20 E1.4\n"
    for z in range(2, 9, 2)) + "M104 S0\nM140 S0\nM84\n"
LOG = "[G54:0.000,0.000,-10.000]\n[G92:0.000,0.000,0.000]\n" + "".join(
    f"[PRB:{x},{y},-10.{abs(x - y) % 10},0.000:1]\n" for y in (0, 10, 20, 30) for x in (0, 10, 20, 30, 40))
SCRIPT = ('import gcodepreview\ngcp = gcodepreview.gcodepreview("cut", False, False)\n'
          'gcp.setupstock(40, 30, 10, "Top", "Lower-Left", 5)\ngcp.movetosafeZ()\n'
          'gcp.toolchange(102, 16000)\n'
          'gcp.rapid(10, 10, 2)\ngcp.cutline(20, 10, -2)\ngcp.stockandtoolpaths()\n')
SCAD = re.search(r"^```openscad\n(.*?)^```", (ROOT / "docs/manual/scad.md").read_text(), re.M | re.S)[1]
SETS = '{"parameterSets": {"small": {"depth": "2"}}, "fileFormatVersion": "1"}\n'
FILES = {
    **{name: VALID for name in ("part.nc", "part.ngc", "side1.nc", "side2.nc", "around.nc")},
    "slots.nc": VALID.replace("-6.00mm", "-12.00mm").replace("Z-1", "Z-8"),
    "part.dxf": DXF, "part.svg": svg(RED + BLUE), "art.svg": svg(RED.replace("red", "#ff0000")),
    "line.svg": svg('<path d="M10 10 L60 10" fill="none" stroke="red"/>'),
    "ring.svg": svg('<circle cx="40" cy="30" r="8" fill="none" stroke="red"/>'),
    "engraving.nc": "G21 G90\nM4 S0\nG0 X0 Y0\nG1 X20 S500 F1000\nG1 Y20\nS0\nM5\nM2\n",
    "print.gcode": PRINT, "console.log": LOG, "part.py": SCRIPT,
    "plate.scad": "depth = 3;\n" + SCAD, "plate.json": SETS,
    "printer.toml": 'base = "reprapfirmware"\nname = "mine"\n[variables]\nbed = 60\n',
}


@pytest.fixture
def folder(tmp_path):
    """All files that the commands name, with `kerf`, `python3` and a sender on the path."""
    folder, tools = tmp_path / "work", tmp_path / "bin"
    folder.mkdir(), tools.mkdir(), (folder / "card").mkdir()
    (tools / "kerf").symlink_to(KERF)
    (tools / "python3").symlink_to(sys.executable)
    (tools / "sender").write_text("#!/bin/sh\nexec cat > sent.nc\n")
    (tools / "sender").chmod(0o755)
    for name in (".zfunc", ".config/fish/completions", ".local/share/bash-completion/completions"):
        (tmp_path / name).mkdir(parents=True)
    shutil.copytree(ROOT / "examples", folder / "examples")
    for name, text in FILES.items():
        (folder / name).write_text(text)
    (folder / "photo.png").write_bytes(png(16, 12))
    shutil.copy(ROOT / "examples" / "plate.gcmc", folder / "part.gcmc")
    shutil.copy(ROOT / "examples" / "shell.stl", folder / "part.stl")
    shutil.copy(ROOT / "examples" / "path" / "9009.1P.dxf", folder / "8001.1P.dxf")
    shutil.copy(ROOT / "tests" / "data" / "gcode" / "slicer" / "box.gcode", folder / "sliced.gcode")
    return folder


@pytest.fixture
def shell(folder):
    def run(command):
        tools = folder.parent / "bin"
        variables = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "HOME": str(folder.parent),
                     "PYTHONPATH": str(KERF.parent / "python")}
        return subprocess.run(command, shell=True, cwd=folder, env=variables, capture_output=True, text=True,
                              timeout=300, check=False)
    return run


# Files that a page takes for granted, by commands that make them.
BEFORE = {
    "command": ["kerf cut --example pocket > job.toml", "kerf simulate part.nc -o casting.stl"],
    "stock": ["kerf simulate part.nc -o target.stl"],
    "editors": ["git init -q .", "git add part.nc"],
    "posts": ["kerf level --grid 5x4 --over part.nc --to grbl -o probe.nc"],
}
# What a user does by hand before a command: enter the heights that were measured.
BY_HAND = {"kerf adjustz": "sed -i 's/=$/=3.1/' 8001.1P_Z.txt"}


def reason_of(command):
    return next((reason for pattern, reason in NOT_RUN.items() if re.search(pattern, command)), None)


WITH_COMMANDS = [page for page in PAGES if commands_of(page.read_text())]


@pytest.mark.parametrize("page", WITH_COMMANDS, ids=lambda page: page.stem)
def test_commands_of_a_page(page, shell, folder):
    if not (KERF.parent / "python" / "kerf").is_dir():
        pytest.skip("built without the Python modules")
    for command in BEFORE.get(page.stem, ()):
        assert shell(command).returncode == 0, command
    made, faults = set(), []
    for line, command, printed in commands_of(page.read_text()):
        if reason_of(command):
            continue
        command = command.replace("/media/card/", "card/")
        for start, other in BY_HAND.items():
            if command.startswith(start):
                assert shell(other).returncode == 0
        done = shell(command)
        output = " ".join((done.stdout + done.stderr).split())
        right = (0, 3) if CHECKS.match(command) else (0,)
        if done.returncode not in right:
            faults.append(f"{page.name}:{line}: {command}: {done.returncode}\n{output[-700:]}")
        faults += [f"{page.name}:{line}: {text} is not in\n{output[-700:]}" for text in printed
                   if " ".join(text.split()) not in output]
        made |= set(re.findall(r"-o ([\w.-]+\.\w+)", command)) if done.returncode in right else set()
    assert not faults, "\n".join(faults)
    assert all((folder / name).stat().st_size > 0 for name in made)


def test_reasons_are_of_commands_that_exist():
    all_commands = [command for page in PAGES for _, command, _ in commands_of(page.read_text())]
    assert len(all_commands) > 90
    for pattern in NOT_RUN:
        assert any(re.search(pattern, command) for command in all_commands), pattern


WITH_SUBCOMMANDS = ("tools", "printer")


def test_commands_and_options_in_the_text_exist(shell):
    """`kerf post --level MAP` within a sentence: the command and each of its options."""
    known, faults = {}, []
    for page in PAGES:
        for span in re.findall(r"`(kerf [a-z]+[^`\n]*)`", FENCE.sub("", page.read_text())):
            words = span.split()
            name = " ".join(words[1:3] if words[1] in WITH_SUBCOMMANDS and len(words) > 2 else words[1:2])
            if name not in known:
                done = shell(f"kerf {name} --help")
                known[name] = set(re.findall(r"--?[a-z][\w-]*", done.stdout + done.stderr))
            if not known[name]:
                faults.append(f"{page.name}: {span}")
            options = re.findall(r"(?<=\s)--[a-z][\w-]*", span)
            faults += [f"{page.name}: {span}: {option}" for option in options if option not in known[name]]
    assert not faults, "\n".join(faults)


# ---- blocks that are no commands, in the order of their page: a line of the shell that uses the file `block`

PART = "[tools]\\n1 = \"square d=8\"\\n2 = \"square d=2\"\\n[[shape]]\\nrectangle = [0, 0, 40, 30]\\n"
JOB = f"(printf '{PART}'; cat block) > job.toml; kerf cut job.toml -o out.nc"
CARVE = ("(cat block; printf '[[shape]]\\nrectangle = [0, 0, 40, 30]\\n') > job.toml; "
         "kerf cut job.toml -o out.nc")
PYTHON = "(printf 'import kerf\\nregion = kerf.Region([(20, 20, 15)])\\n'; cat block) > b.py; python3 b.py"
BLOCKS = {
    ("command", "json"): ["kerf info --json broken.nc | tr -d '\\n' | "
                          "grep -q '\"code\": 2002,.*\"name\": \"number_missing\"'"],
    ("command", "toml"): ["cp block kerf.toml; echo 'name = \"router\"' > router.toml; "
                         "mkdir machines posts printers materials; touch shop.toml; "
                          "KERF_NO_CONFIG= kerf config | grep -c kerf.toml: | grep -qx 11"],
    ("drawings", "python"): [PYTHON],
    ("editors", "toml"): ["python3 -c 'import tomllib; tomllib.load(open(\"block\", \"rb\"))'"],
    ("editors", "json"): ["python3 -m json.tool block"],
    ("gcodepreview", "toml"): ["cp block p.toml; kerf post --post p.toml print.gcode -o out.gcode"],
    ("machine", "toml"): ["cp block shop.toml; kerf check part.nc --material shop.toml:betula; [ $? != 1 ]"],
    ("operations", "toml"): ["cp block job.toml; kerf cut job.toml -o out.nc", JOB, JOB, CARVE],
    ("outlines", "python"): ["cp block b.py; python3 b.py", "cp block b.py; python3 b.py"],
    ("outlines", "json"): ["cp block plate.json; kerf outline plate.json --json"],
    ("posts", "toml"): ["cp block p.toml; kerf post --post p.toml part.nc -o out.nc"],
    ("printing", "toml"): ["cp block p.toml; kerf post --post p.toml print.gcode -o out.gcode",
                           "cp block p.toml; kerf info --printer p.toml:PLA print.gcode"],
    ("printing", "python"): [PYTHON, PYTHON],
    ("scad", "openscad"): ["cp block b.scad; kerf run b.scad",
                           "cp block b.scad; kerf run b.scad | grep -q 'ECHO: \\[35, 10\\]'"],
    ("tools", ""): ["sed 's/   .*//' block | "
                    "while read -r t; do kerf info part.nc --tool \"$t\" || exit 1; done"],
    ("tools", "toml"): ["cp block t.toml; kerf simulate part.nc --tools t.toml"],
    ("viewer-embedding", "python"): ["kerf view part.nc --export part.html; cp block b.py; "
                                     "python3 b.py | grep -q part.nc"],
    ("editors", ""): ["printf 'G21 G90\\nM3 S9000\\nT1 M6\\nG0 Z5\\nG1 Z-1 F100\\nG0 Z5\\nM2\\n' > part.nc; "
                      "kerf check part.nc --format gcc | grep -qF \"$(cut -c1-58 block)\""],
}
# Blocks that are not used here, and why.
OTHERS = {("editors", "lua"): "Neovim's", ("editors", "elisp"): "Emacs's",
          ("viewer-embedding", "html"): "a browser's",
          **{(page, "python"): "test_manual.py runs it" for page in ("python", "operations", "gcodepreview")}}


def other_blocks(page):
    """The blocks of each language without commands."""
    found = {}
    for m in FENCE.finditer(page.read_text()):
        if m[1] not in ("", "sh") or not commands_of(m[0]):
            found.setdefault((page.stem, m[1]), []).append(m[2])
    return found


ALL_BLOCKS = {key: bodies for page in PAGES for key, bodies in other_blocks(page).items()}


def test_each_block_is_used():
    for key, bodies in ALL_BLOCKS.items():
        assert key in OTHERS or len(BLOCKS.get(key, ())) == len(bodies), key
    assert set(BLOCKS) | set(OTHERS) == set(ALL_BLOCKS)


@pytest.mark.parametrize("key, number", [(key, i) for key, uses in BLOCKS.items() for i in range(len(uses))],
                         ids=lambda value: "-".join(value) if isinstance(value, tuple) else str(value))
def test_a_block_of_a_page(key, number, shell, folder):
    if not (KERF.parent / "python" / "kerf").is_dir():
        pytest.skip("built without the Python modules")
    (folder / "block").write_text(ALL_BLOCKS[key][number])
    (folder / "broken.nc").write_text("G21\nG90\nG1 X10 F\nM2\n")
    done = shell(BLOCKS[key][number])
    assert done.returncode == 0, done.stdout[-1500:] + done.stderr[-1500:]

"""What LinuxCNC's interpreter makes of a program: its moves in mm, in coordinates of G54 as they were when the
program began.  python3 rs274.py FILE... prints them, in the notation of tests/data/gcode/moves.txt."""
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

CALL = re.compile(r"^\s*\d+\s+N\S*\s+([A-Z0-9_]+)\((.*)\)\s*$")
TOOLS = "T1 P1 D0.23622047244094488\nT2 P2 D0.39370078740157480\n"  # 6 mm and 10 mm; the program reads inches
AXES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}  # first, second, third of a plane


def is_installed():
    return shutil.which("rs274") is not None


class Canon:
    """Follows the canonical calls and collects moves: (kind, x, y, z) and for arcs also (u, v, turns)."""

    def __init__(self):
        self.scale, self.plane, self.moves = 1.0, "XY", []
        self.system, self.shift, self.turn = [0.0] * 3, [0.0] * 3, 0.0

    def rotate(self, x, y):
        c, s = math.cos(math.radians(self.turn)), math.sin(math.radians(self.turn))
        return x * c - y * s, x * s + y * c

    def place(self, p):
        x, y = self.rotate(p[0] + self.shift[0], p[1] + self.shift[1])
        return (x + self.system[0], y + self.system[1], p[2] + self.shift[2] + self.system[2])

    def numbers(self, text):
        return [float(word) for word in text.split(",")]

    def call(self, name, text):
        if name == "USE_LENGTH_UNITS":
            self.scale = 25.4 if "INCH" in text else 1.0
        elif name == "SELECT_PLANE":
            self.plane = text[-2:]
        elif name == "SET_G5X_OFFSET":
            self.system = [v * self.scale for v in self.numbers(text)[1:4]]
        elif name == "SET_G92_OFFSET":
            self.shift = [v * self.scale for v in self.numbers(text)[:3]]
        elif name == "SET_XY_ROTATION":
            self.turn = float(text)
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            kind = "R" if name.endswith("TRAVERSE") else "C"
            self.moves.append((kind, *self.place([v * self.scale for v in self.numbers(text)[:3]])))
        elif name == "ARC_FEED":
            self.arc(self.numbers(text))
        elif name == "DWELL" and float(text) > 0:
            self.moves.append(("D", float(text)))

    def arc(self, v):
        first, second, third = AXES[self.plane]
        end, centre = [0.0] * 3, [0.0] * 3
        end[first], end[second], end[third] = (v[i] * self.scale for i in (0, 1, 5))
        centre[first], centre[second] = v[2] * self.scale, v[3] * self.scale
        centre = self.place(centre)
        in_name_order = [centre["XYZ".index(letter)] for letter in self.plane]
        self.moves.append(("A", *self.place(end), *in_name_order, int(v[4])))


def moves_of(text):
    """The moves of a program, and the interpreter's complaint or None."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "tool.tbl").write_text(TOOLS)
        Path(folder, "v.var").write_text("")
        Path(folder, "part.ngc").write_text(text)
        done = subprocess.run(["rs274", "-v", "v.var", "-t", "tool.tbl", "-g", "part.ngc"], cwd=folder,
                              capture_output=True, text=True, timeout=60)
    canon = Canon()
    for line in done.stdout.splitlines():
        match = CALL.match(line)
        if match:
            canon.call(*match.groups())
    complaint = done.stderr.replace("executing", "").strip()
    return canon.moves, complaint or (None if done.returncode == 0 else "refused")


def number(value):
    return f"{round(value, 4) + 0.0:.4f}".rstrip("0").rstrip(".")


def written(move):
    text = " ".join([move[0], *map(number, move[1:4])])
    if move[0] == "A":
        text += f" c {number(move[4])} {number(move[5])} t {move[6]}"
    return text


if __name__ == "__main__":
    for path in sys.argv[1:]:
        program = Path(path).read_text()
        found, wrong = moves_of(program)
        print(program.strip().replace("\n", "|"))
        print("=", "; ".join(written(m) for m in found), f"# {wrong}" if wrong else "")

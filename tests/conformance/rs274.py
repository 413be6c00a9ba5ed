"""The moves that LinuxCNC's interpreter makes of a program, in mm, in the coordinates of G54 at its
start.  python3 rs274.py FILE... prints them, in the notation of tests/data/gcode/moves.txt."""
import math
import os
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


def at_home_in(folder):
    """The environment of an interpreter that runs in this folder.  It keeps its tool table in the home
    folder; two that run at the same time need one each."""
    return {**os.environ, "HOME": str(folder)}


class Canon:
    """Follows the canonical calls and collects moves: (kind, x, y, z) and for arcs also (u, v, turns)."""

    def __init__(self):
        self.scale, self.plane, self.moves = 1.0, "XY", []
        self.system, self.shift, self.turn = [0.0] * 3, [0.0] * 3, 0.0

    def rotate(self, x, y):
        c, s = math.cos(math.radians(self.turn)), math.sin(math.radians(self.turn))
        return x * c - y * s, x * s + y * c

    def position(self, p):
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
            self.moves.append((kind, *self.position([v * self.scale for v in self.numbers(text)[:3]])))
        elif name == "ARC_FEED":
            self.arc(self.numbers(text))
        elif name == "DWELL" and float(text) > 0:
            self.moves.append(("D", float(text)))

    def arc(self, v):
        first, second, third = AXES[self.plane]
        end, centre = [0.0] * 3, [0.0] * 3
        end[first], end[second], end[third] = (v[i] * self.scale for i in (0, 1, 5))
        centre[first], centre[second] = v[2] * self.scale, v[3] * self.scale
        centre = self.position(centre)
        in_name_order = [centre["XYZ".index(letter)] for letter in self.plane]
        self.moves.append(("A", *self.position(end), *in_name_order, int(v[4])))


class Machine(Canon):
    """The same moves in machine coordinates, with the tool's length: where the spindle goes."""

    def __init__(self):
        super().__init__()
        self.length = [0.0] * 3

    def position(self, p):
        return tuple(a + b for a, b in zip(super().position(p), self.length))

    def call(self, name, text):
        if name == "USE_TOOL_LENGTH_OFFSET":
            self.length = [float(v) * self.scale for v in text.split(",")[0].split()]
        super().call(name, text)


class Events(Canon):
    """The events of a program, in the notation of tests/data/gcode/words.txt."""

    STOPS = {"PROGRAM_STOP": "M0", "OPTIONAL_PROGRAM_STOP": "M1", "PALLET_SHUTTLE": "M60"}
    PATHS = {"CANON_EXACT_PATH": "exact path", "CANON_EXACT_STOP": "exact stop", "CANON_CONTINUOUS": "blend"}

    def __init__(self):
        super().__init__()
        self.events, self.feed, self.per_turn = [], 0.0, False
        self.speed, self.turn_of_spindle, self.spindle = 0.0, "off", "S 0 off"
        self.synchronous = 0.0  # units per turn of the spindle, of G33 and G76
        self.mist = self.flood = False
        self.coolant = "K off"
        self.at, self.rotary = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)

    def call(self, name, text):
        before = len(self.moves)
        super().call(name, text)
        for move in self.moves[before:]:
            self.move(move, [float(v) for v in text.split(",")][-3:])
        if name in self.STOPS:
            if not (name == "PROGRAM_STOP" and self.events[-1:] == ["M60"]):  # a pallet change stops too
                self.events.append(self.STOPS[name])
        elif name == "PROGRAM_END":
            self.events.append("end")
        elif name in ("CHANGE_TOOL", "CHANGE_TOOL_NUMBER"):
            self.events.append(f"T {text}")
        elif name == "SET_MOTION_CONTROL_MODE":
            kind, *tolerance = text.split(",")
            self.events.append(" ".join(["P", self.PATHS[kind], *(number(float(t)) for t in tolerance)]))
        elif name == "NURBS_FEED":
            self.events.append("N")
        elif name == "RIGID_TAP":
            self.tap(self.position([v * self.scale for v in self.numbers(text)[:3]]))
        elif name == "STRAIGHT_PROBE":
            to = self.position([v * self.scale for v in self.numbers(text)[:3]])
            self.events.append(" ".join(["Q", *map(number, to)]) + self.feed_text())
        else:
            self.set_state(name, text)

    def tap(self, bottom):
        """Cuts in, and out again with the spindle reversed."""
        turns = [self.spindle, self.spindle.replace("ccw", "x").replace("cw", "ccw").replace("x", "cw")]
        for to, spindle in ((bottom, turns[1]), (self.at, turns[0])):
            self.events += [" ".join(["C", *map(number, to)]) + self.feed_text(), spindle]

    def set_state(self, name, text):
        if name == "SET_FEED_RATE":
            self.feed = float(text)
        elif name == "SET_FEED_MODE":
            self.per_turn = text.endswith("1")
        elif name == "STOP_SPEED_FEED_SYNCH":
            self.synchronous = 0.0
        elif name == "START_SPEED_FEED_SYNC":
            self.synchronous = self.numbers(text)[0]
        elif name == "SET_SPINDLE_SPEED":
            self.speed = float(text.split(",")[1])
        elif "SPINDLE" in name and ("START" in name or "STOP" in name):
            self.turn_of_spindle = ("off" if name.startswith("STOP") else
                                    "ccw" if "COUNTER" in name else "cw")
        elif name in ("MIST_ON", "MIST_OFF"):
            self.mist = name.endswith("ON")
            if not self.mist:
                return  # FLOOD_OFF follows
        elif name in ("FLOOD_ON", "FLOOD_OFF"):
            self.flood = name.endswith("ON")
        self.add_changes()

    def add_changes(self):
        turns = self.turn_of_spindle != "off"
        spindle = f"S {number(self.speed) if turns else 0} {self.turn_of_spindle}"
        coolant = "K" + (" mist" * self.mist + " flood" * self.flood or " off")
        if spindle != self.spindle:
            self.events.append(spindle)
        if coolant != self.coolant:
            self.events.append(coolant)
        self.spindle, self.coolant = spindle, coolant

    def feed_text(self):
        if self.synchronous:
            return f" f {number(self.synchronous * self.scale * self.speed)}"
        return f" f {number(self.feed * self.scale * (self.speed if self.per_turn else 1.0))}"

    def move(self, move, rotary):
        text = written(move)
        if move[0] == "D":
            self.events.append(text)
            return
        if move[0] in "CA":
            text += self.feed_text()
        if move[0] in "RC" and any(rotary):
            text += " a " + " ".join(map(number, rotary))
        self.events.append(text)
        self.at = move[1:4]


def events_of(text, canon=None):
    """The events of a program, and the interpreter's error message or None."""
    canon = canon or Events()
    error = follow(text, canon)
    return canon.events, error


def moves_of(text, tools=TOOLS):
    """The moves of a program, and the interpreter's error message or None."""
    canon = Canon()
    error = follow(text, canon, tools=tools)
    return canon.moves, error


def machine_moves_of(text, stored, tools):
    """As moves_of, in the coordinates of a machine with stored offsets, homes and lengths of tools."""
    canon = Machine()
    error = follow(text, canon, stored, tools)
    return canon.moves, error


def follow(text, canon, stored="", tools=TOOLS):
    """Runs a program in the interpreter, whose calls go to `canon`; returns the error message or None.
    `stored` and `tools` are the machine's parameter file and tool table."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "tool.tbl").write_text(tools)
        Path(folder, "v.var").write_text(stored)
        Path(folder, "part.ngc").write_text(text)
        done = subprocess.run(["rs274", "-v", "v.var", "-t", "tool.tbl", "-g", "part.ngc"], cwd=folder,
                              env=at_home_in(folder), capture_output=True, text=True, timeout=300)
    for line in done.stdout.splitlines():
        match = CALL.match(line)
        if match:
            canon.call(*match.groups())
    error = done.stderr.replace("executing", "").strip()
    return error or (None if done.returncode == 0 else "refused")


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

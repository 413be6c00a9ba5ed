"""A reader of plain G-code, independent of Kerf's: G0 to G3 with I, J and K, G4, planes, units, absolute and
incremental coordinates. Any other code that moves the machine is an error, so that nothing is misread."""
import math
import re

WORD = re.compile(r"([A-Z])([-+]?\d*\.?\d+|[-+]?\d+\.?)")
IGNORED_G = {21, 40, 49, 54, 61, 64, 80, 90.1, 91.1, 94, 97}
IGNORED_M = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 30}
AXES = {17: "XYZ", 18: "ZXY", 19: "YZX"}  # first, second and third axis
OFFSETS = {"X": "I", "Y": "J", "Z": "K"}


class Reader:
    def __init__(self):
        self.at, self.plane, self.motion = {"X": 0.0, "Y": 0.0, "Z": 0.0}, 17, None
        self.scale, self.absolute = 1.0, True
        self.moves, self.cut_length, self.rapid_length = [], 0.0, 0.0

    def read(self, text):
        for line in text.splitlines():
            self.line(re.sub(r"\([^)]*\)", "", line).split(";")[0].strip().upper())
        return self

    def line(self, line):
        if not line or line == "%":
            return
        words = WORD.findall(line)
        assert "".join(a + b for a, b in words) == line.replace(" ", ""), line
        dwell = False
        for letter, value in words:
            if letter == "G":
                dwell = self.code(float(value)) or dwell
            assert letter != "M" or float(value) in IGNORED_M, line
        values = {letter: float(value) * self.scale for letter, value in words if letter in "XYZIJK"}
        if dwell:
            self.moves.append(("D", float(dict(words)["P"])))
        elif any(axis in values for axis in "XYZIJK"):
            self.move(values)

    def code(self, code):
        if code in (0, 1, 2, 3):
            self.motion = int(code)
        elif code in AXES:
            self.plane = int(code)
        elif code in (20, 21):
            self.scale = 25.4 if code == 20 else 1.0
        elif code in (90, 91):
            self.absolute = code == 90
        else:
            assert code == 4 or code in IGNORED_G, code
        return code == 4

    def move(self, values):
        end = {axis: values.get(axis, 0.0 if not self.absolute else self.at[axis])
               + (0.0 if self.absolute else self.at[axis]) for axis in "XYZ"}
        if self.motion in (0, 1):
            length = math.dist(list(self.at.values()), list(end.values()))
        else:
            length = self.arc_length(end, values)
        if self.motion == 0:
            self.rapid_length += length
        else:
            self.cut_length += length
        self.at = end
        self.moves.append(("RCAA"[self.motion], end["X"], end["Y"], end["Z"]))

    def arc_length(self, end, values):
        u, v, w = AXES[self.plane]
        centre = [self.at[axis] + values.get(OFFSETS[axis], 0.0) for axis in (u, v)]
        start = (self.at[u] - centre[0], self.at[v] - centre[1])
        stop = (end[u] - centre[0], end[v] - centre[1])
        sweep = math.atan2(stop[1], stop[0]) - math.atan2(start[1], start[0])
        sweep = sweep % (2 * math.pi) if self.motion == 3 else -((-sweep) % (2 * math.pi))
        if math.isclose(sweep, 0.0, abs_tol=1e-9):
            sweep = 2 * math.pi
        assert math.isclose(math.hypot(*start), math.hypot(*stop), rel_tol=1e-3, abs_tol=6e-3), (start, stop)
        return math.hypot(sweep * math.hypot(*start), end[w] - self.at[w])

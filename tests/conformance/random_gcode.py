"""Random G-code programs that combine many words; LinuxCNC accepts some of them and refuses others."""
import random

SCALE = 100.0  # mm; large, so that the fourth printed decimal is a millionth of it


class Maker:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.lines = []

    def line(self, *words):
        self.lines.append(" ".join(word for word in words if word))

    def number(self, low=-1.0, high=1.0):
        return round(self.random.uniform(low, high) * SCALE, 3)

    def word(self, letter, low=-1.0, high=1.0, chance=1.0):
        return f"{letter}{self.number(low, high)}" if self.random.random() < chance else ""

    def either(self, *choices):
        return self.random.choice(choices)

    def axes(self, chance=0.6):
        words = [self.word(letter, chance=chance) for letter in "XYZ"]
        return " ".join(w for w in words if w) or self.word("X")

    def header(self):
        self.line("G21 G90 G94 G17 G40 G49 G54 G80 F500 S1000")
        self.line("G0", "X0 Y0 Z0")

    def text(self):
        return "\n".join([*self.lines, "M2", ""])


def moves(seed):
    """Straight moves, distance modes, work offsets, shifts. Systems are rotated only without G92 and G52:
    LinuxCNC drops that shift when it recomputes its position."""
    make = Maker(seed)
    for system in (1, 2, 3, 7, 9):  # an offset that the program does not set is unknown
        make.line(f"G21 G10 L2 P{system} X0 Y0 Z0")
    make.header()
    make.line("G28.1")
    make.line("G30.1")
    turns = seed % 2 == 1
    for _ in range(25):
        kind = make.random.randrange(14)
        if kind < 5:
            make.line(make.either("G0", "G1", "G1", ""), make.axes())
        elif kind == 5:
            make.line(make.either("G90", "G91"))
        elif kind == 6:
            make.line(make.either("G54", "G55", "G56", "G59.1", "G59.3"))
        elif kind == 7:
            turn = make.either("", "R0", "R30") if turns else ""
            make.line("G10 L2", make.either("P0", "P1", "P2", "P9"), make.axes(), turn)
            make.line("G17")
        elif kind == 8:
            make.line("G10 L20", make.either("P1", "P2"), make.axes())
        elif kind == 9 and not turns:
            make.line(make.either("G92", "G52"), make.axes())
        elif kind == 10:
            make.line(make.either("G92.1", "G92.2", "G92.3"))
        elif kind == 11:
            make.line(make.either("G28", "G30"), make.either("", make.word("Z"), make.word("X")))
        elif kind == 12:
            make.line(make.either("G28.1", "G30.1"))
        else:
            make.line("G1", f"@{abs(make.number()) + 1} ^{make.number()}")
    return make.text()


def arcs(seed):
    make = Maker(seed)
    make.header()
    make.line("G1", make.axes(1.0))
    planes = {"G17": ("XY", "IJ", "Z"), "G18": ("XZ", "IK", "Y"), "G19": ("YZ", "JK", "X")}
    for _ in range(12):
        plane = make.either(*planes)
        (first, second), (i, j), third = planes[plane]
        turn = make.either("G2", "G3")
        make.line(plane, "G91.1")
        way = make.random.randrange(4)
        if way == 0:  # a full circle, or several
            make.line(turn, make.word(i), make.word(j), make.word(third, chance=0.5),
                      make.either("", "P2", "P3"))
        elif way == 1:  # half circles with both words
            u, v = make.number(), make.number()
            make.line("G91", turn, f"{first}{2 * u:.3f} {second}{2 * v:.3f} {i}{u} {j}{v}",
                      make.word(third, chance=0.5), make.either("", "", "P2"))
            make.line("G90")
        elif way == 2:
            u, v = make.number(0.1, 1), make.number(0.1, 1)
            radius = round((u * u + v * v) ** 0.5 * make.random.uniform(0.51, 3), 3) * make.either(1, -1)
            make.line("G91", turn, f"{first}{u} {second}{v} R{radius}", make.word(third, chance=0.5))
            make.line("G90")
        else:
            make.line("G1", make.axes())
    return make.text()


def cycles(seed):
    make = Maker(seed)
    make.header()
    make.line("M3")
    make.line("G0 Z", str(make.number(0.5, 1)))
    for _ in range(8):
        make.line(make.either("G98", "G99", ""))
        make.line(make.either("G90", "G91"))
        code = make.either("G81", "G82", "G83", "G73", "G85", "G86", "G89")
        incremental = make.lines[-1] == "G91"
        r = make.number(-0.3, 0.4)
        bottom = make.number(-0.9, -0.1) if incremental else round(r - abs(make.number()) - 1, 3)
        extra = ""
        if code in ("G82", "G86", "G89"):
            extra = "P0.5"
        elif code in ("G83", "G73"):
            extra = f"Q{abs(make.number(0.1, 0.5))}"
        make.line(code, make.word("X"), make.word("Y", chance=0.7), f"Z{bottom} R{r}", extra,
                  make.either("", "", "L2", "L3"))
        for _ in range(make.random.randrange(3)):
            make.line(make.word("X"), make.word("Y", chance=0.5))
        make.line("G80")
        if make.random.random() < 0.5:
            make.line("G90 G0", make.axes())
    return make.text()


def computed(seed):
    make = Maker(seed)
    make.header()
    functions = ("ABS", "SIN", "COS", "TAN", "ROUND", "FIX", "FUP")
    binary = ("+", "-", "*", "EQ", "LT", "GE", "AND", "OR", "XOR")

    def value(depth=0):
        kind = make.random.randrange(6 if depth < 2 else 2)
        if kind == 0:
            return f"{abs(make.number(0, 1)):.3f}"
        if kind == 1:
            return f"#{make.random.randrange(1, 6)}"
        if kind == 2:
            return f"{make.either(*functions)}[{value(depth + 1)}]"
        terms = [value(depth + 1) for _ in range(make.random.randrange(2, 4))]
        return "[" + f" {make.either(*binary)} ".join(terms) + "]"

    for number in range(1, 6):
        make.line(f"#{number} = {make.number()}")
    for label in range(100, 112):
        kind = make.random.randrange(6)
        if kind == 0:
            make.line(f"o{label} if [{value()} GT {value()}]")
            make.line(f"G1 X[{value()} MOD 90]")
            make.line(f"o{label} else")
            make.line(f"G1 Y[{value()} MOD 90]")
            make.line(f"o{label} endif")
        elif kind == 1:
            make.line(f"o{label} repeat [{make.random.randrange(4)}]")
            make.line(f"G91 G1 X[{value()} MOD 50] Y1")
            make.line("G90")
            make.line(f"o{label} endrepeat")
        elif kind == 2:
            make.line("#9 = 0")
            make.line(f"o{label} while [#9 LT {make.random.randrange(5)}]")
            make.line("#9 = [#9 + 1]")
            make.line(f"G1 Z[#9 * {value()} MOD 70]")
            make.line(f"o{label} endwhile")
        elif kind == 3:
            make.line(f"o{label} sub")
            make.line("G1 X[#1 MOD 80] Y[#2 MOD 60]")
            make.line(f"o{label} endsub [#1 + #2]")
            make.line(f"o{label} call [{value()}] [{value()}]")
            make.line("G1 Z[#<_value> MOD 30]")
        else:
            make.line(f"#{make.random.randrange(1, 6)} = [{value()} MOD 100]")
            make.line(f"G1 X[{value()} MOD 100] Y[[{value()}] MOD 100] (comment)")
    return make.text()


def compensated(seed):
    """A contour with cutter compensation; many of them cannot be cut."""
    make = Maker(seed)
    make.header()
    radius = round(abs(make.number(0.005, 0.12)), 3)
    make.line(f"{make.either('G41.1', 'G42.1')} D{2 * radius}")
    if make.random.random() < 0.8:
        make.line("G1 X60", make.word("Y", -0.5, 0.5))
    else:
        make.line("G3 X40 Y40 J40")
    for _ in range(8):
        kind = make.random.randrange(10)
        if kind < 5:
            make.line(make.either("G1", "G1", "G0"), make.word("X"), make.word("Y"),
                      make.word("Z", chance=0.3))
        elif kind < 8:
            u, v = make.number(), make.number()
            make.line("G91", make.either("G2", "G3"), f"X{2 * u:.3f} Y{2 * v:.3f} I{u} J{v}",
                      make.word("Z", chance=0.2))
            make.line("G90")
        elif kind == 8:
            make.line("G1", make.word("Z"))
        else:
            make.line(make.either("G2", "G3"), make.word("I"), make.word("J"))
    make.line("G40")
    make.line("G1 X200 Y200")
    return make.text()


def checksums(seed):
    """Straight moves as senders number them: "N5 G1 X3*87". LinuxCNC has no checksums."""
    lines = []
    for number, line in enumerate(moves(seed).splitlines()):
        line = f"N{number} {line}"
        value = 0
        for byte in line.encode():
            value ^= byte
        lines.append(f"{line}*{value}")
    return "\n".join([*lines, ""])


def without_checksums(text):
    return "\n".join(line.split("*")[0] for line in text.splitlines()) + "\n"

class Offsets(Maker):
    """Lines that change coordinates, in mm and inches, with degenerate values among them. `lost`: the axes
    whose position in work coordinates is unknown after them."""

    SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")

    def __init__(self, seed):
        super().__init__(seed)
        self.inch = self.absolute = self.measured = False
        self.lost = ""

    def number(self, low=-1.0, high=1.0):
        kind = self.random.randrange(12)
        if kind < 3:
            return self.either(0, 0, 0.0001, -0.001, 1, 25.4)
        return round(super().number(low, high) * self.either(1, 1, 1, 10) / (25.4 if self.inch else 1), 4)

    def some_axes(self):
        return self.either("X", "Y", "Z", "XY", "XZ", "YZ", "XYZ")

    def words(self, axes):
        return " ".join(f"{axis}{self.number():g}" for axis in axes)

    def mode(self, absolute):
        self.absolute = absolute
        self.line("G90" if absolute else "G91")

    def unit(self, inch):
        if self.measured and inch != self.inch:
            return  # rs274 without a machine does not convert the length of the tool here
        self.inch = inch
        self.line("G20 F20" if inch else "G21 F500")

    def find(self):
        """Moves to a known position."""
        if self.lost:
            self.mode(True)
            self.line("G0", self.words(self.lost))
            self.lost = ""

    def lose(self, axes):
        self.lost = "".join(a for a in "XYZ" if a in self.lost + axes)

    def start(self):
        self.line("G17 G40 G49 G54 G80 G92.1 G94 S1000")
        self.unit(self.either(True, False))
        self.mode(True)

    def move(self):
        self.line(self.either("G0", "G1", "G1"), self.words(self.some_axes()))

    def shift(self):
        self.find()
        self.line(self.either("G92", "G92", "G52"), self.words(self.some_axes()))
        for _ in range(self.random.randrange(3)):
            self.line(self.either("G92.1", "G92.2", "G92.2", "G92.3", "G92.3"))

    def touch_off(self):
        self.find()
        self.line("G10 L20", f"P{self.random.randrange(10)}", self.words(self.some_axes()))

    def length(self):
        word = self.either("G43 H1", "G43 H2", "G43", "G49", f"G43.1 Z{self.number():g}")
        self.line(word)
        self.measured = word != "G49"
        self.lose("Z")

    def change_tool(self):
        self.line(self.either("T1 M6", "T2 M6"))

    def machine(self):
        axes = self.some_axes()
        self.mode(True)
        self.line("G53", self.either("G0", "G1"), self.words(axes))
        self.lose(axes)


def offsets(seed):
    """All work offsets, each set by the program, with the lengths of tools, homes and machine coordinates."""
    make = Offsets(seed)
    make.start()
    for system in range(1, 10):
        make.line(f"G10 L2 P{system}", make.words("XYZ"))
    make.line("G0", make.words("XYZ"))
    make.line("G28.1")
    make.line("G30.1")
    for _ in range(30):
        kind = make.random.randrange(20)
        if kind < 6:
            make.move()
        elif kind < 9:
            make.line(make.either(*make.SYSTEMS))
        elif kind < 11:
            make.line("G10 L2", f"P{make.random.randrange(10)}", make.words(make.some_axes()))
        elif kind == 11:
            make.either(make.touch_off, make.shift)()
        elif kind == 12:
            make.line(make.either("G92.1", "G92.2", "G92.3"))
        elif kind == 13:
            make.mode(not make.absolute)
        elif kind == 14:
            make.unit(not make.inch)
        elif kind == 15:
            make.find()
            make.line(make.either("G28", "G30"), make.either("", make.words(make.some_axes())))
            make.lose("XYZ")
        elif kind == 16:
            make.find()
            make.line(make.either("G28.1", "G30.1"))
        elif kind == 17:
            make.length()
        elif kind == 18:
            make.change_tool()
        else:
            make.machine()
    make.find()
    make.line("G90 G0 X0 Y0 Z0")
    return make.text()


class UnsetOffsets(Offsets):
    """The same where the machine has offsets, homes and lengths of its own."""

    def find(self):
        """Some positions stay unknown here."""
        if self.random.randrange(3) == 0:
            super().find()

    def arc(self):
        """Half a circle from a known position."""
        super().find()
        u, v = self.number(), self.number()
        self.mode(False)
        self.line(self.either("G2", "G3"), f"X{2 * u:.4f} Y{2 * v:.4f} I{u:.4f} J{v:.4f}")
        self.mode(True)


def unset_offsets(seed):
    make = UnsetOffsets(seed)
    make.start()
    make.lost = "XYZ"
    steps = [make.move] * 6 + [make.arc, make.touch_off, make.shift, make.length, make.change_tool,
                               make.machine]
    for _ in range(make.random.randrange(4, 30)):
        kind = make.random.randrange(20)
        if kind < 12:
            steps[kind]()
        elif kind < 15:
            make.line(make.either(*make.SYSTEMS[:3], make.either(*make.SYSTEMS)))
            make.lost = "XYZ"
        elif kind == 15:
            make.line("G10 L2", f"P{make.random.randrange(4)}", make.words(make.some_axes()))
            make.lost = "XYZ"
        elif kind == 16:
            make.line(make.either("G92.1", "G92.2", "G92.3"))
            make.lost = "XYZ"
        elif kind == 17:
            make.either(make.mode, make.unit)(make.either(True, False))
        elif kind == 18:
            make.line(make.either("G28", "G30"), make.either("", make.words(make.some_axes())))
            make.lost = "XYZ"
        else:
            make.line(make.either("G28.1", "G30.1"))
    return make.text()


def machine(seed):
    """Numbers that a machine has stored: homes and work offsets, in its parameter file, and a tool table;
    both in inches."""
    make = Offsets(seed)
    numbers = [(first + axis, make.number() / 25.4) for first in (5161, 5181) for axis in range(3)]
    for first in range(5221, 5382, 20):
        numbers += [(first + axis, make.number() / 25.4) for axis in range(3)]
    stored = "".join(f"{number} {value:.6f}\n" for number, value in numbers)
    lengths = [abs(make.number()) / 25.4 for _ in range(2)]
    return stored, "".join(f"T{i} P{i} D0.25 Z{z:.6f}\n" for i, z in enumerate(lengths, 1))


FAMILIES = {f.__name__: f for f in (moves, arcs, cycles, computed, compensated, offsets, checksums)}

"""Random OpenSCAD programs whose echoes show what was computed, and in which order: expressions of all kinds
of values, and programs with scopes, `$`-variables, modules, children, loops, literals and further files.

As a program it compares Kerf with the installed openscad, and prints what differs:
    random_scad.py KERF [COUNT OF EXPRESSIONS] [COUNT OF PROGRAMS] [FIRST SEED]"""
import random
import subprocess
import sys
import tempfile
from pathlib import Path

LETTERS = ["", "a", "b", "ab", "abc", "Zz", "\u00e4", "\u20ac", "x\\ty", "\\\"q", "12", "a b"]
NUMBERS = """0 1 2 3 4 -1 -2 0.5 1.5 -0.25 7 10 30 45 90 180 -90 1e3 1e-3 123456789 0.1 3.7 1e300 -1e300
    1e-300 100 360 2.5 -3""".split()
OPERATORS = "+ - * / % ^ < <= > >= == != && ||".split()
OF_ONE = """abs sign sin cos tan asin acos atan floor ceil round ln log exp sqrt len norm str chr ord min max
    concat is_undef is_bool is_num is_string is_list is_function""".split()
OF_TWO = "atan2 pow min max cross concat str lookup search chr norm len ord abs log is_num".split()
MEMBERS = ["x", "y", "z", "be" + "gin", "step", "end"]


class Maker:
    """Expressions; `names` are variables in scope."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.names = []
        self.functions = []
        self.fresh = 0

    def either(self, *choices):
        return self.random.choice(choices)

    def chance(self, p):
        return self.random.random() < p

    def new_name(self, start="v"):
        self.fresh += 1
        return f"{start}{self.fresh}"

    def number(self):
        r = self.random
        kind = r.random()
        if kind < 0.5:
            return r.choice(NUMBERS)
        if kind < 0.6:
            return self.either("1/0", "-1/0", "0/0", "PI", "-0")
        return f"{r.uniform(-100, 100):.{r.randint(0, 6)}f}"

    def leaf(self):
        r = self.random
        if self.names and r.random() < 0.45:
            return r.choice(self.names)
        kind = r.random()
        if kind < 0.5:
            return self.number()
        if kind < 0.62:
            return f'"{r.choice(LETTERS)}"'
        if kind < 0.7:
            return self.either("true", "false", "undef", "undef")
        if kind < 0.92:
            return "[" + ", ".join(self.number() for _ in range(r.randint(0, 4))) + "]"
        return self.range()

    def range(self):
        r = self.random
        first = r.choice([0, 1, -2, 0.5, 3])
        last = first + r.choice([0, 1, 2, 3, 2.5, -1])
        step = r.choice(["", "", "1", "2", "0.5", "-1", "0.3"])
        return f"[{first}:{step}:{last}]" if step else f"[{first}:{last}]"

    def expression(self, depth):
        if depth <= 0:
            return self.leaf()
        kinds = [self.binary] * 6 + [self.vector, self.comprehension] * 2 + [self.call] * 3
        kinds += [self.unary, self.choice, self.index, self.member, self.let, self.literal, self.traced,
                  self.matrices, self.user_call]
        return self.random.choice(kinds)(depth - 1)

    def binary(self, depth):
        text = f"{self.expression(depth)} {self.random.choice(OPERATORS)} {self.expression(depth)}"
        return f"({text})" if self.chance(0.8) else text

    def unary(self, depth):
        return f"{self.either('-', '!', '+')}({self.expression(depth)})"

    def choice(self, depth):
        return f"({self.expression(depth)} ? {self.expression(depth)} : {self.expression(depth)})"

    def vector(self, depth):
        return "[" + ", ".join(self.expression(depth) for _ in range(self.random.randint(0, 4))) + "]"

    def matrices(self, depth):
        r = self.random

        def matrix(rows, columns):
            return "[" + ", ".join("[" + ", ".join(self.number() for _ in range(columns)) + "]"
                                   for _ in range(rows)) + "]"
        n, m, k = r.randint(1, 3), r.randint(1, 3), r.randint(1, 3)
        return f"({matrix(n, m)} {self.either('*', '+', '-', '/', '==', '<')} " \
               f"{self.either(matrix(m, k), matrix(n, m), self.expression(depth))})"

    def index(self, depth):
        at = self.either("0", "1", "2", "-1", "0.7", self.expression(depth))
        return f"({self.expression(depth)})[{at}]"

    def member(self, depth):
        return f"({self.expression(depth)}).{self.random.choice(MEMBERS)}"

    def bound(self, depth, count):
        """Assignments whose names stay in scope."""
        items = []
        for _ in range(count):
            name = self.either(self.new_name(), "x", "y", "$s")
            items.append(f"{name} = {self.expression(depth)}")
            self.names.append(name)
        return ", ".join(items)

    def let(self, depth):
        mark = len(self.names)
        text = f"(let({self.bound(depth, self.random.randint(1, 3))}) {self.expression(depth)})"
        del self.names[mark:]
        return text

    def element(self, depth):
        """Of a vector's for."""
        kind = self.random.random()
        if kind < 0.15:
            return f"if ({self.expression(depth)}) {self.expression(depth)}"
        if kind < 0.3:
            return f"if ({self.expression(depth)}) {self.expression(depth)} else {self.expression(depth)}"
        if kind < 0.45:
            return f"each {self.expression(depth)}"
        if kind < 0.55:
            mark = len(self.names)
            text = f"let({self.bound(depth, 1)}) {self.expression(depth)}"
            del self.names[mark:]
            return text
        if kind < 0.65 and depth > 0:
            return "(" + self.element(depth - 1) + ")" if self.chance(0.3) else self.element(depth - 1)
        return self.expression(depth)

    def comprehension(self, depth):
        mark = len(self.names)
        if self.chance(0.25):
            name = self.new_name("i")
            self.names.append(name)
            text = f"[for ({name} = 0; {name} < {self.random.randint(0, 3)}; {name} = {name} + 1) " \
                   f"{self.element(depth)}]"
        else:
            names = [self.either(self.new_name("i"), "x", "$s") for _ in range(self.random.randint(1, 2))]
            parts = []
            for name in names:
                values = self.either(self.range(), self.range(), self.vector(depth - 1), self.leaf())
                parts.append(f"{name} = {values}")
                self.names.append(name)
            text = f"[for ({', '.join(parts)}) {self.element(depth)}]"
        del self.names[mark:]
        return text

    def call(self, depth):
        r = self.random
        kind = r.random()
        if kind < 0.5:
            return f"{r.choice(OF_ONE)}({self.expression(depth)})"
        if kind < 0.85:
            return f"{r.choice(OF_TWO)}({self.expression(depth)}, {self.expression(depth)})"
        if kind < 0.9:
            pairs = ", ".join(f"[{self.number()}, {self.number()}]" for _ in range(r.randint(0, 4)))
            return f"lookup({self.expression(depth)}, [{pairs}])"
        if kind < 0.95:
            table = self.either('"abcabc"', '["a", "b", "ab"]', '[["a", 1], ["b", 2], ["a", 3]]',
                                "[1, 2, 3, 1]", "[[1, 2], [2, 3]]")
            what = self.either('"a"', '"ab"', '["a", "b"]', "1", "[1, 2]", '"c"', self.expression(depth))
            more = self.either("", ", 0", ", 1", ", 2", ", 0, 1", ", 1, 1")
            return f"search({what}, {table}{more})"
        if kind < 0.97:
            return f"rands({r.randint(-5, 5)}, {r.randint(6, 9)}, {r.randint(0, 3)}, {r.randint(0, 99)})"
        return f"{self.either('min', 'max', 'concat', 'str')}({self.expression(depth)}, " \
               f"{self.expression(depth)}, {self.expression(depth)})"

    def arguments(self, depth, parameters):
        """Of a call, by position and name, also wrong ones."""
        out = []
        for name in parameters[:self.random.randint(0, len(parameters))]:
            out.append(self.expression(depth))
        for name in parameters:
            if self.chance(0.2):
                out.append(f"{name} = {self.expression(depth)}")
        if self.chance(0.2):
            out.append(f"{self.either('$s', '$t1', '$t2')} = {self.expression(depth)}")
        if self.chance(0.1):
            out.append(self.expression(depth))
        if self.chance(0.5):
            self.random.shuffle(out)
        return ", ".join(out)

    def parameters(self, depth):
        names = [self.either(self.new_name("p"), "x", "y") for _ in range(self.random.randint(0, 3))]
        names = list(dict.fromkeys(names))
        if self.chance(0.15):
            names.append("$s")
        return names, ", ".join(n if self.chance(0.6) else f"{n} = {self.expression(depth - 1)}"
                                for n in names)

    def literal(self, depth):
        names, text = self.parameters(depth)
        mark = len(self.names)
        self.names += names
        body = self.expression(depth)
        del self.names[mark:]
        function = f"function({text}) {body}"
        kind = self.random.random()
        if kind < 0.2:
            return f"({function})"
        if kind < 0.6:
            return f"({function})({self.arguments(depth - 1, names)})"
        name = self.new_name("f")
        return f"(let({name} = {function}) {name}({self.arguments(depth - 1, names)}))"

    def user_call(self, depth):
        if not self.functions:
            return self.expression(depth)
        name, parameters = self.random.choice(self.functions)
        return f"{name}({self.arguments(depth, parameters)})"

    def traced(self, depth):
        """An echo within the expression: shows the order of evaluation."""
        return f"(echo({self.random.randint(0, 99)}, {self.expression(depth - 1)}) {self.expression(depth)})"


def expressions(seed, count):
    make = Maker(seed)
    return "".join(f"echo({make.expression(make.random.randint(1, 4))});\n" for _ in range(count))


class Program(Maker):
    """Statements."""

    def __init__(self, seed):
        super().__init__(seed)
        self.modules = []
        self.lines = []
        self.level = 0
        self.defines = True  # definitions are possible here

    def line(self, text):
        self.lines.append("  " * self.level + text)

    def block(self, depth, opening, closing="}"):
        """Statements in braces; what they define ends with it."""
        self.line(opening + " {")
        before, self.defines = self.defines, opening.startswith("module ")
        mark = len(self.names), len(self.functions), len(self.modules)
        self.level += 1
        for _ in range(self.random.randint(1, 4)):
            self.statement(depth)
        self.level -= 1
        self.defines = before
        del self.names[mark[0]:], self.functions[mark[1]:], self.modules[mark[2]:]
        self.line(closing)

    def statement(self, depth):
        if depth <= 0:
            self.either(self.echo, self.echo, self.assignment)(depth)
            return
        kinds = [self.echo] * 3 + [self.assignment] * 4 + [self.instance] * 2
        kinds += [self.loop, self.condition, self.bare, self.let_module, self.group, self.children]
        if self.defines:
            kinds += [self.define_module] * 3 + [self.define_function, self.recursion]
        self.random.choice(kinds)(depth - 1)

    def echo(self, _):
        names = "$s $t1 $t2 x y $fn $children $parent_modules".split()
        shown = [self.either(self.expression(1), self.leaf(), self.random.choice(names))
                 for _ in range(self.random.randint(1, 3))]
        if self.chance(0.2):
            shown.append(f"n = {self.leaf()}")
        self.line(f"echo({', '.join(shown)});")

    def assignment(self, _):
        name = self.either(self.new_name(), self.new_name(), "x", "y", "$s", "$t1", "$t2", "$fn")
        self.line(f"{name} = {self.expression(2)};")
        self.names.append(name)

    def define_function(self, depth):
        name = self.either(self.new_name("f"), "f", "g")
        parameters, text = self.parameters(1)
        mark = len(self.names)
        self.names += parameters
        self.line(f"function {name}({text}) = {self.expression(2)};")
        del self.names[mark:]
        self.functions.append((name, parameters))

    def recursion(self, _):
        """A function that calls itself, in tail position or not; its default values are constants."""
        name = self.new_name("r")
        parameters = ["n"] + list(dict.fromkeys(self.either("x", "y", "a", "$s") for _ in range(2)))
        head = ", ".join(p if p == "n" or self.chance(0.6) else f"{p} = {self.number()}" for p in parameters)
        mark = len(self.names)
        self.names += parameters
        last = self.either("$s", "[x, y, $s]", self.expression(1))
        arguments = self.arguments(0, parameters[1:])
        call = f"{name}(n - 1{', ' if arguments else ''}{arguments})"
        again = self.either(call, call, f"let({self.bound(0, 1)}) {call}", f"[n, {call}]")
        del self.names[mark:]
        self.line(f"function {name}({head}) = n <= 0 ? {last} : {again};")
        given = self.arguments(1, parameters[1:])
        self.line(f"echo({name}({self.random.randint(0, 3)}{', ' if given else ''}{given}));")

    def define_module(self, depth):
        name = self.either(self.new_name("m"), "m", "n")
        parameters, text = self.parameters(1)
        mark = len(self.names)
        self.names += parameters
        modules, self.modules = self.modules, [m for m in self.modules if m[0] not in ("m", "n")]
        functions = list(self.functions)
        self.block(depth, f"module {name}({text})")
        self.modules, self.functions = modules, functions
        del self.names[mark:]
        self.modules.append((name, parameters))

    def instance(self, depth):
        if not self.modules:
            self.echo(depth)
            return
        name, parameters = self.random.choice(self.modules)
        call = f"{name}({self.arguments(1, parameters)})"
        if self.chance(0.5):
            self.line(call + ";")
        else:
            self.block(depth, call)

    def loop(self, depth):
        word = self.either("for", "for", "for", "intersection_for")
        names = [self.either(self.new_name("i"), "x", "$s") for _ in range(self.random.randint(1, 2))]
        parts = ", ".join(f"{n} = {self.either(self.range(), self.vector(0), self.leaf())}" for n in names)
        mark = len(self.names)
        self.names += names
        self.block(depth, f"{word} ({parts})")
        del self.names[mark:]

    def condition(self, depth):
        self.block(depth, f"if ({self.expression(1)})", "}")
        if self.chance(0.4):
            self.block(depth, "else")

    def bare(self, depth):
        self.block(depth, "")

    def let_module(self, depth):
        mark = len(self.names)
        word = self.either("let", "let", "assign")
        self.block(depth, f"{word}({self.bound(1, self.random.randint(1, 3))})")
        del self.names[mark:]

    def group(self, depth):
        special = f"{self.either('$s', '$t1', '$fn')} = {self.leaf()}"
        self.block(depth, self.either("union()", "translate([1, 0])", f"union({special})", "difference()",
                                      f"render({special})", f"translate([0, 3], {special})", "rotate(30)"))

    def children(self, depth):
        self.line(self.either("children();", "children(0);", "children([0, 1]);", "children([0:1]);",
                              "echo(parent_module(0));", "children($s = 5);"))

    def text(self, count):
        for _ in range(count):
            self.statement(3)
        return "\n".join([*self.lines, ""])


def program(seed):
    """The files of a program, by name."""
    make = Program(seed)
    if make.chance(0.7):
        return {"x.scad": make.text(make.random.randint(4, 12))}
    for _ in range(make.random.randint(2, 5)):
        make.random.choice([make.assignment, make.define_function, make.define_module])(2)
    library = "\n".join([*make.lines, ""])
    make.lines, make.names = [f"{make.either('use', 'include')} <l.scad>"], []
    return {"l.scad": library, "x.scad": make.text(make.random.randint(4, 12))}


def echoes(output):
    """The echoed lines."""
    return [line for line in output.decode(errors="replace").splitlines() if line.startswith("ECHO:")]


def run_both(kerf, folder, files):
    """What openscad and Kerf echo, and Kerf's messages. A program that openscad does not end within half a
    minute has None for its echoes."""
    for name, text in files.items():
        Path(folder, name).write_text(text, encoding="utf-8")
    out = Path(folder, "x.echo")
    out.unlink(missing_ok=True)
    done = subprocess.run([kerf, "run", "x.scad"], cwd=folder, capture_output=True, timeout=120)
    messages = done.stderr.decode(errors="replace")
    try:
        subprocess.run(["openscad", "-o", out.name, "x.scad"], cwd=folder, capture_output=True, timeout=30)
    except subprocess.TimeoutExpired:
        return None, echoes(done.stdout), messages
    return echoes(out.read_bytes()), echoes(done.stdout), messages


def differing(kerf, folder, seeds, files_of):
    """Descriptions of the programs of these seeds whose echoes differ."""
    wrong = []
    for seed in seeds:
        files = files_of(seed)
        theirs, ours, messages = run_both(kerf, folder, files)
        if theirs is not None and theirs != ours:
            text = "".join(f"---- {name} of seed {seed}\n{text}" for name, text in files.items())
            wrong.append(f"{text}  openscad {theirs}\n  kerf     {ours}\n{messages}")
    return wrong


def main():
    kerf = str(Path(sys.argv[1]).resolve())
    count, programs, first = (int(a) for a in [*sys.argv[2:], *["4000", "500", "1"][len(sys.argv) - 2:]][:3])
    with tempfile.TemporaryDirectory() as folder:
        wrong = differing(kerf, folder, range(first, first + count), lambda s: {"x.scad": expressions(s, 1)})
        wrong += differing(kerf, folder, range(first, first + programs), program)
    print("\n".join([*wrong, f"{len(wrong)} differ of {count} expressions and {programs} programs"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

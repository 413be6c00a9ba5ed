"""Random expressions of OpenSCAD programs against an evaluator of the language's rules in Python, which has
nothing in common with Kerf: numbers, truth values, strings, vectors, let, choices, and loops in vectors."""
import math
import random
import re

import pytest

COUNT = 500  # expressions of a program
UNDEF = None


class Range(tuple):
    """begin, step, end"""


def is_number(v):
    return isinstance(v, float)


def truth(v):
    return bool(v) if not is_number(v) else v != 0.0


def divided(x, y):
    if y == 0.0:
        return math.nan if x == 0.0 or math.isnan(x) else math.copysign(math.inf, x) * math.copysign(1.0, y)
    return x / y


def remainder(x, y):
    return math.nan if y == 0.0 or math.isinf(x) or math.isnan(x + y) else math.fmod(x, y)


def power(x, y):
    try:
        value = math.pow(x, y)
    except ValueError:
        return math.inf if x == 0.0 else math.nan
    except OverflowError:
        return math.inf
    return value


NUMERIC = {"+": lambda x, y: x + y, "-": lambda x, y: x - y, "*": lambda x, y: x * y, "/": divided,
           "%": remainder, "^": power}


def operated(sign, a, b):
    """An arithmetic operator on any two values."""
    if is_number(a) and is_number(b):
        return NUMERIC[sign](a, b)
    if sign in "+-" and isinstance(a, list) and isinstance(b, list):
        return [operated(sign, x, y) for x, y in zip(a, b)]
    if sign in "*/" and isinstance(a, list) and is_number(b):
        return [operated(sign, x, b) for x in a]
    if sign in "*/" and is_number(a) and isinstance(b, list):
        return [operated(sign, a, x) for x in b]
    if sign == "*" and isinstance(a, list) and isinstance(b, list):
        if a and len(a) == len(b) and all(map(is_number, a + b)):
            return math.fsum(x * y for x, y in zip(a, b)) if len(a) < 2 else sum(x * y for x, y in zip(a, b))
    return UNDEF


def same(a, b):
    if type(a) is not type(b):
        return False
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b


def compared(sign, a, b):
    """Of numbers, truth values or strings; undef for values of different types."""
    if sign == "==":
        return same(a, b)
    if sign == "!=":
        return not same(a, b)
    if type(a) is not type(b) or a is UNDEF:
        return UNDEF
    return {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[sign]


def literal(v):
    if v is UNDEF:
        return "undef"
    if isinstance(v, bool):
        return str(v).lower()
    if isinstance(v, str):
        return f'"{v}"'
    if isinstance(v, list):
        return "[" + ", ".join(map(literal, v)) + "]"
    return repr(v) if v >= 0 else f"({v!r})"


class Maker:
    """Expressions as text with their values; `names` are variables in scope."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.names = []

    def leaf(self):
        r = self.random
        if self.names and r.random() < 0.4:
            return r.choice(self.names)
        kind = r.random()
        if kind < 0.7:
            v = float(r.randint(-9, 9)) if r.random() < 0.5 else r.randint(-99, 99) / 8.0
        elif kind < 0.88:
            v = [float(r.randint(-5, 5)) for _ in range(r.randint(0, 3))]
        else:
            v = r.choice([True, False, "", "a", "bc", "abc", UNDEF])
        return literal(v), v

    def make(self, depth):
        if depth == 0:
            return self.leaf()
        kinds = [self.arithmetic] * 4 + [self.comparison, self.logic, self.choice, self.vector, self.index,
                                         self.let, self.loop, self.call, self.sign]
        text, value = self.random.choice(kinds)(depth - 1)
        # Most of what has no value is left out: all operations with it have none.
        return self.leaf() if value is UNDEF and self.random.random() < 0.8 else (text, value)

    def arithmetic(self, depth):
        (a, x), (b, y) = self.make(depth), self.make(depth)
        sign = self.random.choice("++--**/%^")
        return f"({a} {sign} {b})", operated(sign, x, y)

    def sign(self, depth):
        a, x = self.make(depth)
        if self.random.random() < 0.3:
            return f"(!{a})", not truth(x)
        if isinstance(x, list):
            return (f"(-{a})", [-v for v in x]) if all(map(is_number, x)) else self.leaf()
        return f"(-{a})", -x if is_number(x) else UNDEF

    def comparison(self, depth):
        (a, x), (b, y) = self.make(depth), self.make(depth)
        sign = self.random.choice(["==", "!=", "<", "<=", ">", ">="])
        ordered = sign in ("==", "!=") or not (isinstance(x, list) and isinstance(y, list))
        nan = any(is_number(v) and math.isnan(v) for v in (x, y))
        if not ordered or nan:  # the order of vectors and of no numbers is tested elsewhere
            return self.leaf()
        return f"({a} {sign} {b})", compared(sign, x, y)

    def logic(self, depth):
        (a, x), (b, y) = self.make(depth), self.make(depth)
        if self.random.random() < 0.5:
            return f"({a} && {b})", truth(x) and truth(y)
        return f"({a} || {b})", truth(x) or truth(y)

    def choice(self, depth):
        (c, z), (a, x), (b, y) = self.make(depth), self.make(depth), self.make(depth)
        return f"({c} ? {a} : {b})", x if truth(z) else y

    def vector(self, depth):
        items = [self.make(depth) for _ in range(self.random.randint(0, 3))]
        return "[" + ", ".join(t for t, _ in items) + "]", [v for _, v in items]

    def index(self, depth):
        a, x = self.make(depth)
        i = self.random.randint(0, 3)
        return f"({a})[{i}]", x[i] if isinstance(x, (list, str)) and i < len(x) else UNDEF

    def let(self, depth):
        a, x = self.make(depth)
        name = f"v{len(self.names)}"
        self.names.append((name, x))
        b, y = self.make(depth)
        self.names.pop()
        return f"(let({name} = {a}) {b})", y

    def loop(self, depth):
        first, count = self.random.randint(-3, 3), self.random.randint(0, 3)
        name = f"v{len(self.names)}"
        state, values, text = self.random.getstate(), [], "0"
        for i in range(max(count, 1)):
            self.random.setstate(state)
            self.names.append((name, float(first + i)))
            body, y = Maker.fixed(self, depth)
            self.names.pop()
            text = body
            values.append(y)
        return f"[for ({name} = [{first}:1:{first + count - 1}]) {text}]", values[:count]

    def fixed(self, depth):
        """The same text for each value of a loop's variable: an arithmetic expression of it."""
        name, x = self.names[-1]
        sign, y = self.random.choice("+-*"), float(self.random.randint(-9, 9))
        inner, z = (name, x) if depth == 0 else self.fixed(depth - 1)
        return f"({inner} {sign} {literal(y)})", operated(sign, z, y)

    def call(self, depth):
        a, x = self.make(depth)
        name = self.random.choice(["len", "is_num", "is_list", "is_undef", "abs", "floor", "str"])
        if name == "len":
            return f"len({a})", float(len(x)) if isinstance(x, (list, str)) else UNDEF
        if name in ("abs", "floor"):
            whole = is_number(x) and math.isfinite(x)
            value = abs(x) if name == "abs" and is_number(x) else float(math.floor(x)) if whole else x
            return f"{name}({a})", value if is_number(x) else UNDEF
        if name == "str" and isinstance(x, str):
            return f"str({a}, \"-\")", x + "-"
        types = {"is_num": is_number(x) and not math.isnan(x), "is_list": isinstance(x, list),
                 "is_undef": x is UNDEF}
        return (f"{name}({a})", types[name]) if name in types else self.leaf()


def shown(v):
    """As echo prints it, numbers as nan, inf or with all digits."""
    if is_number(v):
        return "nan" if math.isnan(v) else f"{v:.17g}"
    return "[" + ", ".join(map(shown, v)) + "]" if isinstance(v, list) else literal(v)


NUMBER = re.compile(r"-?(?:\d+\.?\d*(?:e[+-]?\d+)?|inf|nan)")


def equals(printed, expected):
    if NUMBER.sub("#", printed) != NUMBER.sub("#", expected):
        return False
    pairs = zip(map(float, NUMBER.findall(printed)), map(float, NUMBER.findall(expected)))
    return all(p == q or (p != p and q != q) or math.isclose(p, q, rel_tol=6e-6, abs_tol=1e-12)
               for p, q in pairs)


@pytest.mark.parametrize("seed", range(8))
def test_expressions_have_the_values_of_the_rules(kerf, program, seed):
    maker = Maker(seed)
    made = [maker.make(maker.random.randint(1, 4)) for _ in range(COUNT)]
    run = kerf("run", program("".join(f"echo({text});\n" for text, _ in made), "e.scad"))
    printed = [line.removeprefix("ECHO: ") for line in run.out.splitlines()]
    assert run.status == 0 and len(printed) == COUNT, run.err[:2000]
    wrong = [(text, line, shown(v)) for line, (text, v) in zip(printed, made) if not equals(line, shown(v))]
    assert wrong == []

"""Random calls of all commands of gcodepreview, wrong ones too, from Python and from OpenSCAD: the same
positions, steps, files and messages.
"""

import inspect
import math
import os
import pathlib
import random
import re
import subprocess
import warnings

import pytest

import kerf
from gcodepreview import GcodePreviewError, gcodepreview
from kerf import _kerf
from kerf_command import command

CALLS = int(os.environ.get("KERF_RANDOM_CALLS") or 5000)
PER_PROGRAM = 50  # so that no message is dropped
# They read files, or cut the part; their own tests compare them.
LEFT_OUT = {"stockfromfile", "previewgcodefile", "flipstock", "stockandtoolpaths", "simulate"}
LEFT_OUT |= {"returnstockandtoolpaths", "debug", "gcpversion"}

ROWS = {
    name: list(inspect.signature(method).parameters.values())[1:]
    for name, method in vars(_kerf.Machine).items()
    if inspect.ismethoddescriptor(method) and name[0] != "_" and name not in LEFT_OUT
}
TOOLS = (102, 201, 202, 301, 374, 814, 112, 390, 100047, 282)
HEART = kerf.plane_shape("heart", 50, 20, 30)
OUTLINES = (HEART, [(10, 10), (40, 10), (40, 30), (10, 10)], [50, 30, 12], [(0, 0), (30, 0), (30, 30)])
CURVES = ([(0, 0), (10, 20), (30, -5), (40, 0)], [(0, 0), (10, 20), (40, 0)])
TEXTS = {
    "axis": ("X", "Y", "Z"),
    "basefilename": ("part", "other"),
    "color": ("red", "Dark Gray", "aqua", "BLACK"),
    "corners": ("dog-bone", "t-bone", "Square", "Fillet", "chamfer", None),
    "edge": ("lower", "upper"),
    "font": ("sans", "times", "Script Bold"),
    "hand": ("right", "left"),
    "kht_direction": ("N", "S", "E", "W"),
    "layer": ("own", None, "a/b"),
    "layers": ("colour", "tool", "depth"),
    "message": ("Layer 2", "a; b", 12),
    "mode": ("dynamic", "constant"),
    "name": ("grbl", "linuxcnc"),
    "normalormirror": ("Default", "Even", "Odd"),
    "offset": ("none", "outside", "inside"),
    "orientation": ("Vertical", "Horizontal"),
    "shape": ("square", "ball", "V", "lollipop"),
    "side": ("Left", "Right", "Both", "Lower", "Upper"),
    "stockzero": ("Lower-Left", "center", "Top-Right", "Somewhere"),
    "string": ("HI", "a b", " "),
    "text": ("a note", 12),
    "tooltype": ("mill", "crmill", "chamfer", "drill"),
    "version": ("r2000", "r12"),
    "zeroheight": ("Top", "bottom"),
}
TEXTS.update({name: ("green", "Red", "orange") for name in ("cutcolor", "rapidcolor", "shaftcolor")})
NUMBERS = {
    "DTT_angle": (14, 8, 100),
    "DTT_diameter": (12.7, 6.35),
    "Joint_Width": (100, 80),
    "Number_of_Dovetails": (3, 4, 2.5),
    "Number_of_Pins": (3, 5),
    "Proportion": (0.75, 0.5, 1.5),
    "Spacing": (8,),
    "count": (3, 5, 4),
    "largeVdiameter": (25.4, 12.7),
    "power": (0, 500),
    "smallDiameter": (3.175, 2),
    "stepover": (0.1, 0.4, 0.7, 2),
    "stockZthickness": (12.7, 20),
    "stepsizearc": (1, 5),
    "thickness": (12.7, 6.35),
    "temperature": (60, 200),
    "width": (100, 60, 1, 0.6),
    "speed": (0, 12000, 100),
}
WRONG = (None, "a", True, math.nan, math.inf, 1e8, -1, 0, [], [[0, 0], [1, 1]], "")
FLAGS = {"joined", "stagger", "first", "enabled", "enable", "acceleration"}


def value_for(parameter, draw):
    name = parameter.name
    if draw.random() < 0.02:
        return draw.choice(WRONG)
    if name in TEXTS:
        return draw.choice(TEXTS[name])
    if name in NUMBERS:
        return draw.choice(NUMBERS[name])
    if name == "outline":
        return draw.choice(OUTLINES)
    if name == "control":
        return draw.choice(CURVES)
    if name in FLAGS:
        return draw.choice((True, False))
    if re.search(r"^(tn|tool|squaretool|smallV|largeV)$|tool_?num|ptd_tool|number$", name):
        return draw.choice(TOOLS)
    if re.search(r"arc$|angle", name):
        return draw.choice((0, 30, 90, 180, 270, 400))
    if re.search(r"diameter|radius|height|flute|feed|^f$|length|depth|pitch|stock|size|shaft|ratio", name):
        return draw.choice((0.5, 2, 3.175, 6, 12.7, 60))
    return draw.choice((0, 1, 5, 10.25, 20, -1.5, -3, 50))


def random_call(draw):
    name = draw.choice(sorted(ROWS))
    values = []
    for parameter in ROWS[name]:
        if parameter.kind == parameter.VAR_POSITIONAL:
            values += [draw.choice(("(a comment)", "M400", 5)) for _ in range(draw.randrange(3))]
        elif parameter.default is parameter.empty or draw.random() < 0.5:
            values.append(value_for(parameter, draw))
        else:
            break
    if name == "addtool":
        return name, [draw.randrange(900, 910), draw.choice(TEXTS["shape"]), draw.choice((4, 6, 0))]
    if name == "setfeeds":
        return name, values[:2]  # in Python the ratios have names
    if draw.random() < 0.02:
        values = values[:-1] if draw.random() < 0.5 else [*values, 1]
    return name, values


def random_calls(seed):
    draw = random.Random(seed)
    mode = draw.choice(("cut", "cut", "cut", "print", "no_preview"))
    start = [("setupstock", [100, 60, 12.7, "Top", "Lower-Left", 9])] if draw.random() < 0.8 else []
    if draw.random() < 0.8:
        start += [("opengcodefile", ["first"]), ("opendxffile", ["first"])]
    return mode, start + [random_call(draw) for _ in range(PER_PROGRAM)]


def literal(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "undef"
    if isinstance(value, str):
        return '"' + value + '"'
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(map(literal, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return "(0/0)" if math.isnan(value) else "(1/0)"
    return repr(value)


def program_of(mode, calls):
    """Each call is on a line of its own, with the position after it."""
    lines = [f'gcp = gcodepreview("{mode}", true, true);']
    for name, values in calls:
        texts = [literal(value) for value in values]
        if name == "addtool":  # its sizes have names
            texts[2] = f"diameter={texts[2]}"
        lines.append(f"{name}({', '.join(texts)}); echo(xpos(), ypos(), zpos());")
    return "\n".join(lines) + "\n"


def plain(message):
    """A message without what the languages write differently: marks, names of values."""
    location = r"^[^ ]*:\d+ \(\w+\): \w+: |^[^ ]*part\.scad:\d+:\d+: \w+: | \[\d+\]$"
    message = re.sub(location, "", message.split("\n")[0])
    message = message.replace("'", '"').replace("a vector", "a list")
    message = re.sub(r"\bundef\b", "None", message)
    return re.sub(r"\b(t)rue\b|\b(f)alse\b", lambda m: m.group(0).capitalize(), message)


def by_python(mode, calls):
    """The object, and of each call its position, errors and warnings."""
    gcp = gcodepreview(mode, True, True)
    rows = []
    for name, values in calls:
        errors = []
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            try:
                if name == "addtool":
                    gcp.addtool(*values[:2], diameter=values[2])
                else:
                    getattr(gcp, name)(*values)
            except (GcodePreviewError, TypeError, kerf.Error, OSError) as error:
                errors = str(error).split("\n")
        at = (gcp.xpos(), gcp.ypos(), gcp.zpos())
        rows.append((at, errors, [plain(str(w.message)) for w in found]))
    return gcp, rows


def messages_of(program):
    """The texts of errors and warnings of an OpenSCAD program by line and severity, and its toolpath."""
    loaded, rows = None, []
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        try:
            loaded = kerf.load(program)
        except kerf.Error as error:
            rows = [(d.line, d.severity, d.message) for d in error.diagnostics]
    for warning in found:
        text = str(warning.message).split("\n")[0]
        match = re.match(r".*part\.scad:(\d+):\d+: warning: (.*?)(?: \[\d+\])?$", text)
        if match:
            rows.append((int(match.group(1)), "warning", match.group(2)))
    messages = {}
    for line, severity, text in rows:
        messages.setdefault((line, severity), []).append(plain(text))
    return loaded, messages


def by_openscad(mode, calls, folder):
    program = folder / "part.scad"
    program.write_text(program_of(mode, calls))
    done = subprocess.run([command(), "run", "part.scad"], cwd=folder, capture_output=True, text=True)
    echoed = [line for line in done.stdout.splitlines() if line.startswith("ECHO:")]
    positions = [tuple(map(float, line[6:].split(","))) for line in echoed]
    return done, positions


def same_text(a, b):
    """Whether two messages are equal, apart from how many digits a number has."""
    number = r"-?\d+\.?\d*(?:e[+-]?\d+)?"
    pairs = zip(re.findall(number, a), re.findall(number, b))
    near = [math.isclose(float(x), float(y), rel_tol=1e-4) for x, y in pairs]
    return all(near) and re.sub(number, "#", a) == re.sub(number, "#", b)


def wrong_count(errors):
    return any(re.search(r"missing|takes (at most|from|\d+ positional)|keyword", e) for e in errors)


def compare_messages(mode, calls, folder):
    os.chdir(folder)
    _, rows = by_python(mode, calls)
    done, positions = by_openscad(mode, calls, folder)
    _, messages = messages_of(folder / "part.scad")
    assert len(positions) == len(rows), done.stderr
    for i, ((at, errors, found), (name, values)) in enumerate(zip(rows, calls)):
        what = f"{name}({', '.join(map(repr, values))})"
        assert positions[i] == pytest.approx(at, rel=1e-5, abs=1e-5), what
        others = messages.get((i + 2, "error"), [])
        if name in ("closegcodefile", "shutdownafterprinting") and errors and not others:
            continue  # a post refuses the toolpath: OpenSCAD programs are posted at their end
        assert bool(errors) == bool(others), (what, errors, others)
        if not wrong_count(errors):
            pairs = list(zip(map(plain, errors), others))
            assert len(errors) == len(others) and all(same_text(a, b) for a, b in pairs), (what, pairs)
        warned = messages.get((i + 2, "warning"), [])
        # Python writes a file when it is closed, OpenSCAD at the end of the program: its post may warn.
        texts = [w for w in found if not w.startswith(("the controller has no", "the post is for"))]
        assert len(warned) == len(texts), (what, texts, warned)
        assert all(same_text(a, b) for a, b in zip(texts, warned)), (what, texts, warned)


def valid_calls(mode, calls):
    """The calls without those that fail."""
    while True:
        _, rows = by_python(mode, calls)
        kept = [call for call, (_, errors, _) in zip(calls, rows) if not errors]
        if len(kept) == len(calls):
            return kept
        calls = kept


def steps_of(path):
    steps = [dict(path[i]) for i in range(len(path))]
    for step in steps:
        step.pop("origin")
    return steps


def same(a, b):
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float) or isinstance(b, float):
        return a == b or math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-12)
    return a == b


def files_in(folder):
    kept = {p.name: p.read_bytes() for p in folder.iterdir() if p.suffix != ".scad"}
    return {name: re.sub(rb"part\.scad", b"", data) for name, data in kept.items()}


def compare_results(mode, calls, folder):
    os.chdir(folder)
    calls = valid_calls(mode, calls)
    for name in ("python", "scad"):
        (folder / name).mkdir()
    os.chdir(folder / "python")
    gcp, _ = by_python(mode, calls)
    done, _ = by_openscad(mode, calls, folder / "scad")
    assert done.returncode == 0, done.stderr
    loaded, _ = messages_of(folder / "scad" / "part.scad")
    made, expected = steps_of(loaded.toolpath), steps_of(gcp.toolpath)
    for i, (a, b) in enumerate(zip(made, expected)):
        assert same(a, b), (i, a, b)
    assert len(made) == len(expected)
    assert files_in(folder / "scad") == files_in(folder / "python")


@pytest.mark.parametrize("seed", range(CALLS // PER_PROGRAM))
def test_random_calls(seed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])
    mode, calls = random_calls(seed)
    for name in ("messages", "results"):
        (tmp_path / name).mkdir()
    compare_messages(mode, calls, tmp_path / "messages")
    compare_results(mode, calls, tmp_path / "results")
    assert pathlib.Path.cwd().name == "python"


def test_every_command_is_called():
    drawn = {name for seed in range(CALLS // PER_PROGRAM) for name, _ in random_calls(seed)[1]}
    assert drawn == set(ROWS)

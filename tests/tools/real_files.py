#!/usr/bin/env python3
"""Real programs through the posts and the passes: each result is read back and compared with its source.

Usage: real_files.py KERF FOLDER [--count 60] [--only TEXT] [--pass NAME] [--max-bytes 300000]

FOLDER is searched for G-code. Programs are chosen by variety: one of each folder in turn, from large to
small. Each is written by `kerf post`, first for every controller without a pass, then with each pass
alone. The result is read by `kerf steps` and `kerf simulate` at a coarse resolution. What is compared:
the length of the cuts in each state (tool, spindle, coolant, work offset, laser), the time of the cuts,
the extents, the volume of beads, and the removed volume if the pass must keep it. A pass that adds or
removes motion has bounds instead of an equal value.

Prints a table of the passes (equal, refused, differs), the reasons of refusals, and the command of each
difference. A refusal is an exit status of 1 with an error; anything else is a difference. Exit status
1: something differs.
"""

import argparse
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile

ENDINGS = {".nc", ".ngc", ".gcode", ".tap", ".gc", ".cnc"}
TOOL = ["--tool", "square d=3.175 flute=60"]
AXES = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (0, 2, 1)}


def run(command):
    """Exit status (None: too slow), standard output, standard error."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return None, "", "more than 60 s"
    return done.returncode, done.stdout.decode("utf8", "replace"), done.stderr.decode("utf8", "replace")


def points_of_arc(start, step):
    """Points along an arc, dense enough for its extents, and its length."""
    first, second, along = AXES[step["plane"]]
    centre, end = step["centre"], step["to"]
    radius = math.hypot(start[first] - centre[0], start[second] - centre[1])
    begin = math.atan2(start[second] - centre[1], start[first] - centre[0])
    finish = math.atan2(end[second] - centre[1], end[first] - centre[0])
    # The plane XZ is seen from -Y here, from +Y by the turn of a G-code arc.
    left = (step["turn"] == "ccw") != (step["plane"] == "XZ")
    sweep = (finish - begin if left else begin - finish) % (2 * math.pi)
    closed = math.hypot(start[first] - end[first], start[second] - end[second]) < 1e-6
    sweep = (2 * math.pi if closed else sweep) + 2 * math.pi * step.get("extra_turns", 0)
    count = max(8, min(720, int(sweep * 60)))
    points = []
    for i in range(1, count):
        angle = begin + (sweep if left else -sweep) * i / count
        point = [0.0, 0.0, 0.0]
        point[first] = centre[0] + radius * math.cos(angle)
        point[second] = centre[1] + radius * math.sin(angle)
        point[along] = start[along] + (end[along] - start[along]) * i / count
        points.append(point)
    return points + [end], math.hypot(radius * sweep, end[along] - start[along])


class Figures:
    """What a program cuts: by state, in all, and where."""

    def __init__(self):
        self.by_state = collections.Counter()
        self.length = self.minutes = self.beads = 0.0
        self.low, self.high = [math.inf] * 3, [-math.inf] * 3
        self.lines = []  # (line, state, length) of each cut
        self.top = -math.inf

    def add_cut(self, state, step, start):
        points, length = [step["to"]], math.dist(start, step["to"])
        if step["step"] == "arc":
            points, length = points_of_arc(start, step)
        known = not step.get("unknown_axes")
        for point in points + [start] if known and length > 0 else []:
            self.low = [min(a, b) for a, b in zip(self.low, point)]
            self.high = [max(a, b) for a, b in zip(self.high, point)]
        self.by_state[state] += length
        self.length += length
        self.minutes += length / step["feed"] if step.get("feed") else 0.0
        self.beads += (step.get("bead") or {}).get("volume", 0.0)
        self.lines.append((step["origin"].get("line"), state, length))

    def extents(self):
        return self.low + self.high


def figures_of(text):
    """The figures of the output of `kerf steps`."""
    figures, here = Figures(), [0.0, 0.0, 0.0]
    state = {"spindle": ("off", 0), "coolant": (False, False), "system": 1, "laser": ("off", 0)}
    for line in text.splitlines():
        step = json.loads(line)
        kind = step.get("step")
        if kind == "spindle":
            state["spindle"] = (step["turn"], round(step["rpm"], 1) if step["turn"] != "off" else 0)
        elif kind == "coolant":
            state["coolant"] = (step["mist"], step["flood"])
        elif step.get("sets") == "select":
            state["system"] = step["system"]
        elif "power" in step and "mode" in step:
            power = round(step["power"], 1) if step["mode"] != "off" else 0
            state["laser"] = (step["mode"] if power else "off", power)
        if "to" not in step:
            continue
        if kind in ("cut", "arc"):
            figures.add_cut((step.get("tool"),) + tuple(sorted(state.items())), step, here)
        here = step["to"]
        figures.top = max(figures.top, here[2])
    return figures


class Source:
    """A program, its figures, its stock and the kind of machine."""

    def __init__(self, kerf, path, index):
        self.kerf, self.path, self.index = kerf, path, index
        self.error = ""
        code, out, err = run([kerf, "info", "--json", str(path)])
        if code != 0:
            self.error = first_error(out, err)
            return
        info = json.loads(out)
        code, out, err = run([kerf, "steps", "-q", str(path)] + TOOL)
        self.figures = figures_of(out)
        self.printed = self.figures.beads > 0
        self.laser = any(dict(s[1:])["laser"][0] != "off" for s in self.figures.by_state)
        self.cuts = self.figures.length > 0 and math.isfinite(self.figures.low[0])
        if not self.cuts:
            self.error = "cuts nothing"
            return
        block = (info.get("stock") or {}).get("block_mm")
        low, high = self.figures.low, self.figures.high
        # A block of its own, so that source and result are cut from the same one: 4 mm around the cuts.
        top = block[1][2] if block else max(0.0, min(high[2], 0.0))
        self.block = [[low[0] - 4, low[1] - 4, min(low[2], top - 1) - 1], [high[0] + 4, high[1] + 4, top]]
        self.milled = not self.printed and not self.laser and low[2] < top - 0.01
        self.volume = None

    def targets(self):
        return ["marlin"] if self.printed else ["grbl"] if self.laser else ["linuxcnc", "grbl", "mach3"]

    def removed(self):
        if self.volume is None:
            self.volume = removed_by(self.kerf, self.path, self.block, [])
        return self.volume


def first_error(out, err):
    try:
        errors = [d for d in json.loads(out)["diagnostics"] if d["severity"] == "error"]
        return f"{errors[0]['name']}: {errors[0]['message']}" if errors else "no error stated"
    except (ValueError, KeyError):
        return (err.strip().splitlines() or ["no text"])[0]


def removed_by(kerf, path, block, options):
    """The removed volume, from a block, at 80 columns or more along its longer side."""
    size = max(block[1][0] - block[0][0], block[1][1] - block[0][1])
    text = " to ".join(",".join(f"{v:.6f}" for v in corner) for corner in block)
    pitch = f"{max(min(size / 80, 0.8), 0.05):.4f}"
    command = [kerf, "simulate", "--json", "--resolution", pitch, "--stock", text, str(path)]
    code, out, err = run(command + TOOL + options)
    return json.loads(out)["removed_mm3"] if code == 0 else f"not simulated: {first_error(out, err)}"


class Pass:
    """Options of a pass, and what the result must be."""

    def __init__(self, name, options, move=None, grows=None, volume="same", copies=1, near=0.0):
        self.name, self.options, self.volume, self.copies = name, options, volume, copies
        self.move = move or (lambda point: point)
        self.grows = grows  # None: as long as the source; (low, high): times its length
        self.near = near  # deviation of extents that the pass may cause, mm


def level_map(source, folder):
    """A surface that rises by 0.3 mm along X, from 0 at the lower left corner."""
    low, high = source.figures.low, source.figures.high
    width = max(high[0] - low[0], 1.0)
    path = pathlib.Path(folder) / "map.txt"
    rows = [(low[0] - 20 + (width + 40) * i / 6, low[1] - 20 + (high[1] - low[1] + 40) * j / 6)
            for j in range(7) for i in range(7)]
    path.write_text("".join(f"{x:.6f} {y:.6f} {0.3 * (x - low[0]) / width:.6f}\n" for x, y in rows))
    return [str(path), "--map-unit", "mm", "--map-zero", f"{low[0]:.4f},{low[1]:.4f}"]


def passes_of(source, folder):
    low, high = source.figures.low, source.figures.high
    top = source.block[1][2]
    pitch = ",".join(f"{high[i] - low[i] + 12:.4f}" for i in (0, 1))
    step = max((top - low[2]) / 2.5, 0.2)
    at_top = ["--top", f"{top:.4f}"]
    return [
        Pass("columns and rows", ["--columns", "2", "--rows", "2", "--pitch", pitch], copies=4),
        Pass("level", ["--level"] + level_map(source, folder), grows=(0.99, 1.02), volume=None, near=0.31),
        Pass("rotate", ["--rotate", "90"], move=lambda p: [-p[1], p[0], p[2]]),
        Pass("mirror", ["--mirror", "x"], move=lambda p: [-p[0], p[1], p[2]]),
        Pass("scale", ["--scale", "0.5"], move=lambda p: [p[0] / 2, p[1] / 2, p[2]], grows=(0.499, 1.001),
             volume=None),
        Pass("step-down", ["--step-down", f"{step:.3f}"] + at_top, grows=(0.999, 99), near=math.inf),
        Pass("lead", ["--lead", "1"] + at_top, grows=(0.999, 1.6), volume="more", near=3),
        Pass("tabs", ["--tab-height", "0.4"] + at_top, grows=(0.999, 1.6), volume="less", near=0.01),
        Pass("finish", ["--finish", "0.2"] + at_top, grows=(0.9, 3), near=1.2,
             volume="more"),
        Pass("order", ["--order"]),
        Pass("shorten-rapids", ["--shorten-rapids"]),
        Pass("one file per tool", ["--tool-change", "files"], volume=None),
        Pass("fit-arcs", ["--fit-arcs", "0.01"], grows=(0.98, 1.002), near=0.02),
        Pass("join", ["--join", "0.01"], grows=(0.98, 1.0005), near=0.02),
    ]


def close(a, b, relative=5e-4, absolute=0.05):
    return abs(a - b) <= absolute + relative * max(abs(a), abs(b))


def named(state):
    return f"T{state[0]} " + " ".join(f"{k}={v}" for k, v in state[1:])


def compare_states(expected, result, low, high, slack=0.0):
    """The states in which something is cut, each with its length."""
    for state in sorted(set(expected) | set(result), key=repr):
        a, b = expected.get(state, 0.0), result.get(state, 0.0)
        if a * low - slack - 0.05 - 5e-4 * a > b or b > a * high + slack + 0.05 + 5e-4 * a:
            return f"{named(state)}: cuts {b:.3f} mm, expected {a:.3f} times {low:g} to {high:g}"
    return ""


def moved_extents(source, way):
    corners = [way.move(source.figures.low), way.move(source.figures.high)]
    return [min(c[i] for c in corners) for i in range(3)] + [max(c[i] for c in corners) for i in range(3)]


def compare_extents(source, way, result):
    if way.near == math.inf:
        return ""
    expected = moved_extents(source, way)
    if way.copies > 1:
        pitch = [float(v) for v in way.options[way.options.index("--pitch") + 1].split(",")]
        expected = expected[:3] + [expected[3] + pitch[0], expected[4] + pitch[1], expected[5]]
    names = ("low X", "low Y", "low Z", "high X", "high Y", "high Z")
    for name, a, b in zip(names, expected, result.extents()):
        if name != "high Z" and not abs(a - b) <= 0.003 + way.near:
            return f"{name} of the cuts is {b:.4f}, expected {a:.4f}"
    return ""


def compare_volume(source, way, outputs, dialect):
    if way.volume is None or not source.milled:
        return ""
    before = source.removed()
    block = [way.move(corner) for corner in source.block]
    block = [[min(a, b) for a, b in zip(*block)], [max(a, b) for a, b in zip(*block)]]
    if way.copies > 1:
        pitch = [float(v) for v in way.options[way.options.index("--pitch") + 1].split(",")]
        block[1] = [block[1][0] + pitch[0], block[1][1] + pitch[1], block[1][2]]
    after = removed_by(source.kerf, outputs[0], block, dialect)
    if isinstance(before, str) or isinstance(after, str):
        return "" if isinstance(before, str) else after
    expected = before * way.copies
    slack = 0.03 * expected + 1
    more, less = after > expected + slack, after < expected - slack
    if (more and way.volume != "more") or (less and way.volume != "less"):
        return f"removes {after:.1f} mm3, expected {expected:.1f} ({way.volume})"
    return ""


def compare(source, way, outputs, target):
    """The first difference between source and result, or nothing."""
    dialect = ["--dialect", target]
    result = Figures()
    for output in outputs:
        code, out, err = run([source.kerf, "steps", "-q", str(output)] + TOOL + dialect)
        if code != 0:
            return f"the result is not read: {first_error(out, err)}"
        part = figures_of(out)
        result.by_state.update(part.by_state)
        result.minutes += part.minutes
        result.beads += part.beads
        result.lines += part.lines
        result.low = [min(a, b) for a, b in zip(result.low, part.low)]
        result.high = [max(a, b) for a, b in zip(result.high, part.high)]
    expected, grows = collections.Counter(), way.grows or (1, 1)
    for state, length in source.figures.by_state.items():
        expected[state] = length * way.copies
    rounding = 1e-4 * len(result.lines)  # motions below the last decimal become steps of it
    different = compare_states(expected, result.by_state, *grows, rounding)
    different = different or compare_extents(source, way, result)
    if not different and way.grows is None:
        minutes = source.figures.minutes * way.copies
        if not close(minutes, result.minutes, 2e-3, 0.01):
            different = f"cuts for {result.minutes:.3f} min, expected {minutes:.3f}"
        elif not close(source.figures.beads * way.copies, result.beads, 2e-3):
            different = f"beads of {result.beads:.2f} mm3, expected {source.figures.beads * way.copies:.2f}"
    return different or compare_volume(source, way, outputs, dialect)


def trial_from_line(source, target, folder):
    """Resumes at the line of the median cut."""
    cuts = [c for c in source.figures.lines if c[2] > 0.01]
    line = cuts[len(cuts) // 2][0]
    first = next(i for i, c in enumerate(source.figures.lines) if c[0] == line)
    expected = collections.Counter()
    for _, state, length in source.figures.lines[first:]:
        expected[state] += length
    safe = source.figures.top + 2
    way = Pass("from-line", ["--from-line", str(line), "--safe-z", f"{safe:.4f}"])
    outputs, status, reason, command = write(source, way, target, folder)
    if status == "equal":
        code, out, err = run([source.kerf, "steps", "-q", str(outputs[0])] + TOOL + ["--dialect", target])
        slack = safe - source.figures.low[2] + 0.1
        rest = figures_of(out).by_state
        reason = first_error(out, err) if code else compare_states(expected, rest, 1, 1, slack)
        status = "differs" if reason else status
    return way.name, status, reason, command


def write(source, way, target, folder):
    """Files written, status so far, reason, command."""
    output = pathlib.Path(folder) / "result.nc"
    command = [source.kerf, "post", "--json", str(source.path), "--to", target, "-o", str(output)]
    command += TOOL + way.options
    code, out, err = run(command)
    text = " ".join(f"'{c}'" if " " in c else c for c in command)
    if code == 0:
        done = json.loads(out)
        kept = [d["message"] for d in done["diagnostics"] if d["name"] == "pass_refused"]
        return [pathlib.Path(p) for p in done["outputs"]], "equal", "kept: " + kept[0] if kept else "", text
    return [], "refused" if code == 1 else "differs", first_error(out, err), text


def trial(source, way, target):
    """(pass, equal | refused | differs, reason, command)"""
    with tempfile.TemporaryDirectory() as folder:
        if way is None:
            return trial_from_line(source, target, folder)
        if "--level" in way.options:
            level_map(source, folder)
            way.options[way.options.index("--level") + 1] = str(pathlib.Path(folder) / "map.txt")
        outputs, status, reason, command = write(source, way, target, folder)
        if status == "equal":
            different = compare(source, way, outputs, target)
            status, reason = ("differs", different) if different else (status, reason)
        return way.name, status, reason, command


def trials_of(kerf, path, index, only):
    """All trials of one program: (file, pass, status, reason, command)."""
    source = Source(kerf, path, index)
    if source.error:
        return [(path, "reading", "refused", source.error, "")]
    targets = source.targets()
    done = []
    posted = {t: trial(source, Pass("to " + t, []), t) for t in targets}
    if not only:
        done = [(path,) + result for result in posted.values()]
    written = [t for t in targets if posted[t][1] == "equal"] or targets
    target = written[index % len(written)]  # a controller that refuses the program says nothing about passes
    with tempfile.TemporaryDirectory() as folder:
        ways = passes_of(source, folder) + [None]
    for way in ways:
        name = way.name if way else "from-line"
        if not only or only in name:
            done.append((path,) + trial(source, way, target))
    return done


def chosen(folder, count, largest, only):
    """Programs of each folder in turn, from small to large."""
    groups = collections.defaultdict(list)
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.suffix.lower() in ENDINGS and path.is_file() and only in str(path):
            if path.stat().st_size <= largest:
                groups[re.sub(r"/observed/.*", "/observed", str(path.parent))].append(path)
    for group in groups.values():
        group.sort(key=lambda p: p.stat().st_size, reverse=True)
    picked = []
    while len(picked) < count and any(groups.values()):
        picked += [group.pop(0) for group in groups.values() if group]
    return picked[:count]


def print_table(results):
    table = collections.defaultdict(collections.Counter)
    for _, name, status, _, _ in results:
        table[name][status] += 1
    print(f"{'pass':20}{'equal':>8}{'refused':>9}{'differs':>9}")
    for name, row in table.items():
        print(f"{name:20}{row['equal']:8}{row['refused']:9}{row['differs']:9}")
    stated = [r for r in results if r[2] == "refused" or (r[2] == "equal" and r[3])]
    reasons = collections.Counter((n, s, re.sub(r"-?\d+(\.\d+)?", "N", r)) for _, n, s, r, _ in stated)
    print("\nReasons")
    for (name, status, reason), number in sorted(reasons.items()):
        print(f"{number:4} {name}, {status}: {reason[:160]}")
    print("\nDifferences")
    for path, name, status, reason, command in results:
        if status == "differs":
            print(f"{path.name}, {name}: {reason}\n    {command}")


def main():
    raw = argparse.RawDescriptionHelpFormatter
    options = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    options.add_argument("kerf")
    options.add_argument("folder")
    options.add_argument("--count", type=int, default=60)
    options.add_argument("--only", default="", help="programs whose path has this text")
    options.add_argument("--pass", dest="way", default="", help="passes whose name has this text")
    options.add_argument("--max-bytes", type=int, default=300000)
    given = options.parse_args()
    paths = chosen(given.folder, given.count, given.max_bytes, given.only)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        kerf = os.path.abspath(given.kerf)
        jobs = [pool.submit(trials_of, kerf, p, i, given.way) for i, p in enumerate(paths)]
        results = [result for job in jobs for result in job.result()]
    print_table(results)
    return 1 if any(r[2] == "differs" for r in results) else 0


if __name__ == "__main__":
    raise SystemExit(main())

"""OpenSCAD programs: what they echo, compared with OpenSCAD 2021.01; errors with their lines; limits.

tests/data/scad has small programs, each with the messages that Debian's openscad wrote (-o NAME.echo).
"""
import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
PROGRAMS = Path(__file__).resolve().parent.parent / "data" / "scad"
NAMES = sorted(p.stem for p in PROGRAMS.glob("*.scad"))
OTHER_MESSAGE = r"(WARNING|ERROR|TRACE|DEPRECATED)[: ]|Execution aborted|\\"


def echoes(text):
    """The echoed lines; a string may contain line ends. Kerf prints control characters as "?"."""
    lines = []
    for line in text.replace("\t", "?").splitlines():
        if re.match(r"ECHO: |ECHO:$", line):
            lines.append(line)
        elif lines and line and not re.match(OTHER_MESSAGE, line):
            lines[-1] += "\n" + line
    return lines


def run_here(name):
    done = subprocess.run([KERF, "run", f"{name}.scad"], capture_output=True, cwd=PROGRAMS, timeout=60)
    assert done.returncode in (0, 1), done.stderr.decode()
    return done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def test_there_are_sixty_programs():
    assert len(NAMES) >= 60
    assert all((PROGRAMS / f"{name}.echo").exists() for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_echoes_as_openscad(name):
    reference = (PROGRAMS / f"{name}.echo").read_text(errors="replace")
    out, err = run_here(name)
    assert echoes(out) == echoes(reference)
    # Where OpenSCAD warns, Kerf has a message about the same line.
    warned = {int(n) for line in reference.splitlines() if line.startswith(("WARNING", "ERROR"))
              for n in re.findall(r"line (\d+)", line)[-1:]}
    named = {int(n) for n in re.findall(r"[\w/]*\.scad:(\d+):", err)}
    named |= {int(n) for more in re.findall(r"more in line ([\d, ]+)", err) for n in more.split(", ")}
    assert warned - named == set()


@pytest.mark.skipif(not os.environ.get("KERF_LONG") or not shutil.which("openscad"),
                    reason="--long, with openscad")
@pytest.mark.parametrize("name", NAMES)
def test_openscad_still_writes_the_same(name, tmp_path):
    if name == "rands":  # has values without a seed
        return
    subprocess.run(["openscad", "-o", tmp_path / "x.echo", f"{name}.scad"], cwd=PROGRAMS, capture_output=True,
                   timeout=60)
    assert echoes((tmp_path / "x.echo").read_text(errors="replace")) == echoes(
        (PROGRAMS / f"{name}.echo").read_text(errors="replace"))


def test_reports_all_syntax_errors(kerf, program):
    run = kerf("run", program("a = ;\nb = 1;\nc = (2;\nmodule m( { }\nd = 4 5;\necho(b);\n", "bad.scad"))
    assert run.status == 1 and "ECHO" not in run.out
    lines = re.findall(r"^\S*bad\.scad:(\d+):\d+: error: .*\[11002\]", run.err, re.M)
    assert lines == ["1", "3", "4", "5"]


@pytest.mark.parametrize("text, code", [
    ("for (i = [0:1e9]) echo(i);", 11005),
    ("for (i = [0:0:1]) echo(i);", 11005),
    ("nope();", 11006),
    ("echo(nope());", 11006),
    ("difference() { cube(9); sphere(2); }", 11013),
    ("rotate([45, 0, 0]) circle(5);", 11013),
    ("hull() { cube(1); sphere(2); }", 11013),
    ("minkowski() { cube(1); sphere(2); }", 11013),
    ("surface(\"a.png\");", 11013),
    ("text(\"a\", direction = \"rtl\");", 11013),
    ("import(\"a.doc\");", 11013),
    ("import(\"missing.dxf\");", 11004),
    ("import(\"missing.stl\");", 11004),
    ("rotate_extrude() square(5, center = true);", 11014),
    ("polyhedron([[0, 0, 0]], [[0, 1, 2]]);", 11014),
    ("text(\"a\", halign = \"inner\");", 11014),
    ("linear_extrude(5) for (i = [0:300000]) translate([i, 0]) circle(0.4);", 11005),
    ("cube(-1);", 11014),
    ("circle(r = 1 / 0);", 11014),
    ("scale(0) cube(5);", 11014),
    ("polygon([[0, 0], [1, undef]]);", 11014),
    ("linear_extrude(0) circle(5);", 11014),
])
def test_has_an_error_with_its_line(kerf, program, text, code):
    run = kerf("run", program(text + "\n", "code.scad"))
    assert run.status == 1
    assert re.search(rf"code\.scad:1:\d+: error: .*\[{code}\]", run.err)


def test_names_the_modules_around_an_error(kerf, program):
    text = "module a(x) { b(x); }\nmodule b(x) { echo(x + \"s\"); }\na(1);\n"
    run = kerf("run", program(text, "chain.scad"))
    assert re.search(r"chain\.scad:2:\d+: warning: number \+ string", run.err)
    assert re.search(r"note: \S*chain\.scad:1:15: in b\(\), called here\n"
                     r".*chain\.scad:3:1: in a\(\), called here", run.err)


def test_definitions_replace_those_of_the_text(kerf, program):
    name = program("width = 10;\ndouble = width * 2;\necho(width, double);\n", "d.scad")
    for options in ([name, "-D", "width=5"], ["-D", "width=5", name]):
        assert "ECHO: 5, 10" in kerf("run", *options).out
    assert "ECHO: [1, 2], [2, 4]" in kerf("run", "-Dwidth=[1, 2]", name).out
    assert kerf("run", "-D", "width=", name).status == 1


def test_values_of_a_set_are_no_code(kerf, program, tmp_path):
    name = program("width = 10; name = \"a\"; on = false;\necho(width, name, on);\n", "p.scad")
    (tmp_path / "sets.json").write_text(json.dumps({"parameterSets": {
        "big": {"width": "20", "name": "b\"; echo(1); //", "on": "true"}, "bad": {"a b": "1"}}}))
    assert 'ECHO: 20, "b"; echo(1); //", true' in kerf("run", name, "-p", "sets.json", "-P", "big").out
    assert "ECHO: 3, " in kerf("run", name, "-p", "sets.json", "-P", "big", "-D", "width=3").out
    for wrong in ("none", "bad"):
        run = kerf("run", name, "-p", "sets.json", "-P", wrong)
        assert run.status == 1 and "[11015]" in run.err


TOO_MUCH = {
    "recursion": "function f(n) = 1 + f(n + 1); echo(f(0));",
    "modules": "module m(n) { m(n + 1); } m(0);",
    "children": "module m() { children(); } module n() { m() n(); } n();",
    "literal": "f = function(n) 1 + f(n + 1); echo(f(0));",
    "tail_calls": "function f(n) = f(n + 1); echo(f(0));",
    "c_loop": "echo([for (i = 0; true; i = i + 1) i]);",
    "no_step": "for (i = [0:0:1]) echo(i);",
    "long_range": "echo([for (i = [0:1e9]) i]);",
    "long_string": "function d(s, n) = n == 0 ? s : d(str(s, s), n - 1); echo(len(d(\"ab\", 60)));",
    "long_vector": "function d(v, n) = n == 0 ? v : d(concat(v, v), n - 1); echo(len(d([1], 60)));",
    "nested_vectors": "echo([for (i = 0, v = []; i < 1e6; v = [v], i = i + 1) if (i == 999999) v]);",
    "shared_values": "function d(v, n) = n == 0 ? v : d([v, v], n - 1); echo(d([1], 60));",
    "shared_values_compared": "function d(v, n) = n == 0 ? v : d([v, v], n - 1); "
                              "echo(d([1], 60) == d([1], 60));",
    "shared_values_as_text": "function d(v, n) = n == 0 ? v : d([v, v], n - 1); echo(len(str(d([1], 60))));",
    "shared_values_of_chr": "function d(v, n) = n == 0 ? v : d([v, v], n - 1); echo(len(chr(d([], 60))));",
    "long_search": "function d(s, n) = n == 0 ? s : d(str(s, s), n - 1); "
                   "a = d(\"ab\", 18); echo(len(search(\"c\", a)), len(search(d(\"c\", 18), a)));",
    "parentheses": "echo(" + "(" * 100000 + "1" + ")" * 100000 + ");",
    "sum": "echo(" + "+".join(["1"] * 100000) + ");",
    "brackets": "echo(" + "[" * 100000,
    "signs": "x = " + "-" * 100000 + "1;",
    "conditions": "if (true) " * 50000 + "echo(1);",
    "open_string": "a = \"never closed",
    "open_comment": "/* never closed",
    "long_number": "echo(" + "9" * 1000 + ");",
}


@pytest.mark.parametrize("name", TOO_MUCH)
def test_is_an_error_within_bounds(kerf, program, name):
    name = program(TOO_MUCH[name] + "\n", "ring.scad")
    start = time.monotonic()
    run = kerf("run", name, timeout=110)
    assert run.status == 1
    assert re.search(r"ring\.scad:1:\d+: error: ", run.err)
    assert time.monotonic() - start < 100  # seconds, also on a busy machine


def test_a_ring_of_uses_is_none(kerf, program):
    program("use <two.scad>\nfunction one() = 1;\n", "one.scad")
    program("use <one.scad>\nfunction two() = one() + 1;\n", "two.scad")
    assert kerf("run", program("use <two.scad>\necho(two());\n", "main.scad")).out.startswith("ECHO: 2\n")


def test_finds_files_in_folders(kerf, program, tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "l.scad").write_text("function l() = 7;\n")
    name = program("use <l.scad>\necho(l());\n", "main.scad")
    assert kerf("run", name).status == 1
    assert kerf("run", name, "-I", "lib").out.startswith("ECHO: 7\n")


def test_control_characters_do_not_reach_the_terminal(kerf, program, tmp_path):
    name = program('echo("a\\x1b[31mb\\x07\\rc");\n', "c.scad")
    ours, theirs = os.openpty()
    subprocess.run([KERF, "run", name], cwd=tmp_path, stdout=theirs, stderr=subprocess.DEVNULL, timeout=60)
    os.close(theirs)
    shown = os.read(ours, 1000)
    os.close(ours)
    assert b"\x1b" not in shown and b"\x07" not in shown and b"a?[31mb??c" in shown
    # A pipe or file has what the program prints.
    assert kerf("run", name).out == 'ECHO: "a\x1b[31mb\x07\rc"\n'


@pytest.mark.parametrize("text, box, volume", [
    ("cube([40, 30, 8]);", (0, 0, 0, 40, 30, 8), 9600),
    ("translate([-20, -15, -8]) cube([40, 30, 8]);", (-20, -15, -8, 20, 15, 0), 9600),
    ("cube(10, center = true);", (-5, -5, -5, 5, 5, 5), 1000),
    ("union() { cube([20, 10, 5]); translate([20, 0, 0]) cube([20, 10, 5]); }", (0, 0, 0, 40, 10, 5), 2000),
    ("difference() { cube([40, 30, 8]); translate([-1, -1, 4]) cube([42, 32, 9]); }",
     (0, 0, 0, 40, 30, 4), 4800),
    ("rotate([90, 0, 0]) cube([40, 30, 8]);", (0, -8, 0, 40, 0, 30), 9600),
    ("rotate(90) cube([40, 30, 8]);", (-30, 0, 0, 0, 40, 8), 9600),
    ("mirror([1, 0, 0]) cube([40, 30, 8]);", (-40, 0, 0, 0, 30, 8), 9600),
    ("scale([2, 1, 0.5]) cube(10);", (0, 0, 0, 20, 10, 5), 1000),
    ("linear_extrude(6) square([30, 20], center = true);", (-15, -10, 0, 15, 10, 6), 3600),
    ("linear_extrude(6) offset(delta = 5) square([30, 20]);", (-5, -5, 0, 35, 25, 6), 40 * 30 * 6),
    ("linear_extrude(5) polygon([[0, 0], [40, 0], [40, 30], [0, 30]]);", (0, 0, 0, 40, 30, 5), 6000),
])
def test_solids_are_the_material(kerf, program, text, box, volume):
    above = "gcp = gcodepreview();\nrapid(1, 1, 50);\ncutline(1, 1, 49);\n"
    run = kerf("simulate", "--json", program(above + text + "\n", "solid.scad"))
    low, high = run.json["stock"]["block_mm"]
    assert [*low, *high] == pytest.approx(box)
    assert run.json["stock_mm3"] == pytest.approx(volume, rel=1e-6)

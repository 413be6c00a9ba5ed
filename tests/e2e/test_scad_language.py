"""The language of OpenSCAD programs in its corners. The expected lines are those that OpenSCAD 2021.01 prints
in its own tests, or follow from them."""
import re
import time

import pytest

PRINTED = {
    # ---- ranges
    "no_step": ("echo([for (i = [0:0:0]) i], [for (i = [1:0:1]) i]);", "[], []"),
    "infinite_step": ("inf = 1/0; echo([for (i = [0:inf:1]) i], [for (i = [1:-inf:0]) i]);", "[0], [1]"),
    "undefined_step": ("echo([for (i = [0:0/0:1]) i]);", "[]"),
    "steps_of_fractions": ("echo([for (d = [1:1000]) if (len([for (x = [0:1/d:1]) 0]) != d + 1) d]);", "[]"),
    "empty_ranges_are_equal": ("echo([1:-1:3] == [-1:-1:1], [1:-1:3] < [1:-1:-1]);", "true, true"),
    # ---- numbers
    "tangent": ("echo(1/tan(-180), tan(-150) == sqrt(3)/3, tan(30) == sqrt(3)/3, tan(150) == -sqrt(3)/3,"
                " 1/tan(180), tan(270), 1/tan(360));", "-inf, true, true, true, -inf, -inf, inf"),
    "random": ("echo(rands(1, 2, 3, 4.1)); echo(rands(1, 2, 3, -4.1));",
               "[1.96977, 1.55343, 1.99383]", "[1.19758, 1.92189, 1.67397]"),
    "random_without_bounds": ("echo(rands(-1/0, 1/0, 1/0, 1/0), rands(0, 10, 0/0, 1), rands(0, 0, 2, 0/0));",
                              "[-7.59217e+307], [9.97185], [0, 0]"),
    "extremes": ("echo(min([5, 4, 0, 1]), max([2, 5, 1]), max([[1, 2], [3, 4]]), min([[1, 2], [1, 1]]),"
                 ' max(["a", "b"]), min([]), min("a", "b"));', '0, 5, [3, 4], [1, 1], "b", undef, undef'),
    # ---- strings
    "invalid_text": ('echo([for (c = "\u00a4\u00c4\u00d6\u00dc\u00df") ord(c)]);', "[undef, undef, undef]"),
    "no_break_spaces": ("a\u00a0=\u00a01;//\u00a0\necho(a);", "1"),
    "search_of_invalid_tables": (
        'echo(search("a", [["a", 1], 123], 0), search("a", [["a", 1], 123]), search("ab", [["a", 1]], 0));',
        "[], [0], [[0], []]"),
    # ---- variables and calls
    "undeclared_arguments": ("module m() { echo(d); } m(d = 6); d = 1; m();"
                             "function f() = d; echo(f(d = 2), f());", "6", "1", "2, 1"),
    "assign": ("a = 1; assign(a = 5, b = a) echo(a, b);", "5, 1"),
    "child": ("module m() { child(); child(1); } m() { echo(0); echo(1); }", "0", "1"),
    "special_arguments_hold_for_those_before": (
        "$fn = 64; function f(r) = [r, $fn]; echo(f(r = $fn, $fn = 6), f($fn = 7, r = $fn));"
        "module m(r) echo(r, $fn); m($fn, $fn = 5);", "[6, 6], [64, 7]", "5, 5"),
    "special_functions": ("$f = function(x) x; echo($f(1));", "undef"),
    "field_of_view": ("echo($vpf);", "22.5"),
}


@pytest.mark.parametrize("name", PRINTED)
def test_prints(kerf, tmp_path, name):
    text, *lines = PRINTED[name]
    (tmp_path / "p.scad").write_bytes(text.encode("latin-1"))
    run = kerf("run", "p.scad")
    assert run.out == "".join(f"ECHO: {line}\n" for line in lines), run.err
    assert run.status == 0, run.err


WARNINGS = {
    "[5:1:1]": "the range starts above its end, but its step is positive",
    "[1:-1:5]": "the range starts below its end, but its step is negative",
    "[5:1]": "deprecated: the range .5:1. starts above its end",
}


@pytest.mark.parametrize("values", WARNINGS)
def test_warns_of_reversed_ranges(kerf, program, values):
    run = kerf("run", program(f"x = 1;\nfor (i = {values}) x = 2;\n".replace(" x = 2", "{}"), "r.scad"))
    assert run.status == 0 and re.search(rf"r\.scad:2:\d+: warning: {WARNINGS[values]}", run.err)


def test_computed_ranges_may_be_empty(kerf, program):
    run = kerf("run", program("n = 0;\nfor (i = [0:1:n - 1]) echo(i);\n", "r.scad"))
    assert run.status == 0 and "warning" not in run.err and run.out == ""


@pytest.mark.parametrize("text", [
    "for (i = [0:1/0]) echo(i);", "for (i = [1:0:5]) echo(i);", "for (i = [0:1:4294967296]) echo(i);",
    "echo([for (b = 0; b != 1; b = 0) b]);",
    "function f(n) = f(n + undef);\necho(f(0));",
])
def test_endless_work_is_ended(kerf, program, text):
    start = time.monotonic()
    run = kerf("run", program(text + "\n", "e.scad"), env={"MALLOC_ARENA_MAX": "1"})
    assert run.status == 1 and re.search(r"e\.scad:\d:\d+: error: ", run.err) and run.out == ""
    assert time.monotonic() - start < 60


# ---- include


def test_include_is_possible_anywhere(kerf, program):
    program("7 + 1", "number.scad")
    program("echo(\"in block\");", "statement.scad")
    main = "x = 2 * (include <number.scad>);\nif (true) { include <statement.scad> }\necho(x);\n"
    assert kerf("run", program(main, "main.scad")).out == 'ECHO: "in block"\nECHO: 16\n'


def test_a_file_includes_itself_once(kerf, program, tmp_path):
    text = f"include <ring.scad>\ninclude <../{tmp_path.name}/ring.scad>\necho(1);\n"
    run = kerf("run", program(text, "ring.scad"))
    assert run.status == 0 and "warning: cannot open include file" in run.err
    assert run.out == "ECHO: 1\n" * 3


def test_an_error_in_an_included_file_names_it(kerf, program):
    program("a = ;\n", "bad.scad")
    run = kerf("run", program("include <bad.scad>\nb = 4 5;\n", "main.scad"))
    assert run.status == 1
    assert re.search(r"bad\.scad:1:5: error", run.err) and re.search(r"main\.scad:2:7: error", run.err)

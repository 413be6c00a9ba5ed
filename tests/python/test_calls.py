"""Compiled calls as of Python functions: signatures, docstrings, and messages that name the argument."""

import inspect
import re

import gcodepreview
import pytest

import kerf

PATH = kerf.Toolpath()


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: PATH.cut((0, 0, 0), "fast"), "feed must be a number, not 'fast'; in Toolpath.cut(to, feed"),
        (lambda: PATH.cut((0, 0, 0)), "Toolpath.cut(): missing a required argument: 'feed'"),
        (lambda: PATH.cut((0, 0, 0), 1, flod=True), "unexpected keyword argument 'flod'"),
        (
            lambda: PATH.cut(1, 2, 3),
            "too many positional arguments; expected Toolpath.cut(to, feed, *, rotary=None)",
        ),
        (lambda: kerf.Region([], fill=7), "fill must be a str, not 7"),
        (lambda: kerf.Region([], tolerance=[]), "tolerance must be a number, not list"),
        (lambda: kerf.simulate(3), "path must be a Program or a Toolpath, not 3"),
        (lambda: kerf.simulate(PATH, fixtures=[1]), "fixtures[0] must be (a str, a Stock), not 1"),
        (lambda: kerf.Toolpath("part.nc"), "program must be a Program, not 'part.nc'"),
        (lambda: kerf.Tool(), "Tool(): missing a required argument: 'spec'"),
        (lambda: kerf.Tool("square d=3", number="one"), "number must be a whole number, not 'one'"),
        (lambda: kerf.Stock.block((1, 2, 3), zero=3), "zero must be a str, not 3"),
        (lambda: kerf.fit_spline([(0, 0)], [1, "a"]), "knots[1] must be a number, not 'a'"),
        (lambda: kerf.printer_profile(3), "printer must be a str, not 3"),
        (lambda: kerf.load(__file__, strict="yes"), "strict must be True or False, not 'yes'; in load()"),
        (lambda: kerf.post(PATH, "grbl", feed="x"), "feed must be a number, not 'x'; in post()"),
        (lambda: kerf.Program(), "a Program is made by Kerf, not by a call"),
        (lambda: kerf.Stock(), "a Stock is made by Kerf, not by a call"),
        (lambda: kerf.Region([]) | 3, "unsupported operand type(s) for |"),
        (lambda: kerf.Printer(width="w", height=1, speed=1), "width must be a number, not 'w'"),
    ],
)
def test_a_wrong_call_names_the_argument(call, text):
    with pytest.raises(TypeError) as found:
        call()
    assert text in str(found.value)
    assert "incompatible" not in str(found.value) and "(self: " not in str(found.value)


def test_a_wrong_value_of_an_attribute_is_named():
    machine = gcodepreview.gcodepreview("no_preview")
    with pytest.raises(TypeError, match="feed must be a number, not 'fast'"):
        machine.feed = "fast"


def test_one_outline_instead_of_a_list_shows_the_right_form():
    with pytest.raises(ValueError) as found:
        kerf.Region([(0, 0), (1, 1), (2, 2)])
    assert "outlines must be a list of outlines, and outline 0 is the row of numbers (0, 0)" in str(
        found.value
    )
    assert "Region([[(0, 0), (40, 0), (40, 20), (0, 0)]])" in str(found.value)


def public():
    """(name, value) of all public functions, classes and methods."""
    for name in kerf.__all__:
        value = getattr(kerf, name)
        if not callable(value):
            continue
        yield name, value
        if inspect.isclass(value):
            for member, function in vars(value).items():
                if not member.startswith("_") and (callable(function) or isinstance(function, staticmethod)):
                    yield f"{name}.{member}", getattr(value, member)
    for name in dir(kerf.op):
        if not name.startswith("_") and inspect.isfunction(getattr(kerf.op, name)):
            yield f"op.{name}", getattr(kerf.op, name)


@pytest.mark.parametrize("name, value", list(public()))
def test_every_public_call_has_a_signature_and_a_docstring(name, value):
    signature = inspect.signature(value)
    assert signature.parameters or "(" in str(signature)
    text = inspect.getdoc(value)
    assert text, f"{name} has no docstring"
    assert not re.match(r"^\w+\(", text), f"{name} starts with a signature"
    for title, line in re.findall(r"^(\w+(?: \w+)?)\n(-{3,})$", text, re.M):
        assert title in (
            "Parameters",
            "Returns",
            "Raises",
            "Examples",
            "Notes",
            "Attributes",
            "Yields",
        ), title
        assert len(line) == len(title), f"{name}: the line below {title}"
    part = re.search(r"^Parameters\n-+\n(.*?)(?=\n\n\w[\w ]*\n-+\n|\Z)", text, re.M | re.S)
    if part and not any(p.kind == p.VAR_KEYWORD for p in signature.parameters.values()):
        stated = re.findall(r"^(\*{0,2}\w+(?:, \w+)*)(?: :.*)?$", part.group(1), re.M)
        for parameter in filter(None, ", ".join(stated).split(", ")):
            assert parameter.lstrip("*") in signature.parameters, f"{name} has no parameter {parameter}"


def test_messages_name_the_line_of_the_script():
    path = kerf.Toolpath()
    path.tool(3)
    assert path[0]["origin"]["line"] == inspect.currentframe().f_lineno - 1
    assert path[0]["origin"]["file"] == __file__

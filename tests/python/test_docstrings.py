"""Docstrings and signatures: every public name of `kerf`, `kerf.op` and `gcodepreview` has both, and they
agree.
"""

import doctest
import importlib
import inspect
import re

import pytest

import gcodepreview
import kerf

# Of numpydoc's checks: there is a docstring with a summary of one line, and the sections Parameters (all, in
# their order, with types), Returns and Yields. Attributes are documented as "type: meaning".
CHECKS = "GL08 SS01 SS04 SS06 PR01 PR02 PR03 PR04 RT01 YD01".split()
# Also: each parameter and each result has a meaning. The summary may have two lines.
FINISHED_CHECKS = sorted({*CHECKS, "PR07", "RT03"} - {"SS06"})


def public_names(*modules):
    found = []
    for module in modules:
        for name in importlib.import_module(module).__all__:
            value = getattr(importlib.import_module(module), name)
            if inspect.ismodule(value) or not callable(value):
                continue  # the module itself is checked by its own name; constants have no docstring
            found.append(f"{module}.{name}")
            if inspect.isclass(value):
                members = [member for member in dir(value) if is_own(value, member, module)]
                found += [f"{module}.{name}.{member}" for member in members]
    return found


def is_of(value, package):
    return (getattr(value, "__module__", None) or package).startswith(package.partition(".")[0])


def is_own(cls, member, package="kerf"):
    """Whether it is a public method or attribute of the class, and none of Python's own classes."""
    owners = [base for base in getattr(cls, "__mro__", ()) if member in vars(base)]
    return not member.startswith("_") and bool(owners) and is_of(owners[0], package)


NAMES = public_names("kerf", "kerf.op")
SHAPES = "annulus bezier bezier_surface polygon round_corners text".split()
PREVIEW_NAMES = [
    *(name for name in public_names("gcodepreview") if name != "gcodepreview.GcodePreviewError"),
    *(f"gcodepreview.shapes.{name}" for name in [*gcodepreview.shapes.SHAPES, *SHAPES]),
]


def value_of(name):
    value = importlib.import_module(name.partition(".")[0])
    for part in name.split(".")[1:]:
        value = getattr(value, part)
    return value


def sections_of(name):
    """The names of the sections of a docstring."""
    lines = (inspect.getdoc(value_of(name)) or "").splitlines()
    return {line for line, under in zip(lines, lines[1:]) if under and set(under) == {"-"}}


def test_all_names_are_found():
    assert len(NAMES) > 300
    assert {"kerf.Toolpath.cut", "kerf.Job.pocket", "kerf.op.drill", "kerf.Region.area", "kerf.load"} <= set(
        NAMES
    )


def test_the_docstrings_pass_numpydocs_validator():
    validate = pytest.importorskip("numpydoc.validate").validate
    problems = []
    for name in NAMES:
        for code, text in validate(name)["errors"]:
            if code in CHECKS:
                problems.append(f"{name}: {code}: {text}")
    assert not problems, "\n".join(problems)


def is_written_in_python(name):
    value = inspect.unwrap(value_of(name)) if callable(value_of(name)) else value_of(name)
    return inspect.isfunction(value)


def test_docstrings_state_the_meaning_of_all_parameters_and_results():
    validate = pytest.importorskip("numpydoc.validate").validate
    problems = []
    for name in [*PREVIEW_NAMES, *NAMES]:
        for code, text in validate(name)["errors"]:
            if code in FINISHED_CHECKS:
                problems.append(f"{name}: {code}: {text}")
    assert len(PREVIEW_NAMES) > 250
    assert not problems, "\n".join(problems)


# Without the validator, which may not be installed: that each parameter is in the section, with a text.
@pytest.mark.parametrize("name", PREVIEW_NAMES)
def test_parameters_are_described(name):
    value = value_of(name)
    if not callable(value) or inspect.isclass(value) and not inspect.getdoc(value).count("Parameters\n"):
        return
    parameters = [p for p in inspect.signature(value).parameters if p != "self"]
    text = (inspect.getdoc(value) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    rows = re.findall(r"^(\*{0,2}\w+(?:, \w+)*)(?: : .+)?\n    \S", text, re.M)
    assert [row.lstrip("*") for names in rows for row in names.split(", ")] == parameters


# Functions that raise in their own text, and all commands.
@pytest.mark.parametrize("name", [*PREVIEW_NAMES, *filter(is_written_in_python, NAMES)])
def test_errors_are_stated(name):
    value = value_of(name)
    if not inspect.isfunction(value):
        return
    command = name in PREVIEW_NAMES and hasattr(value, "__wrapped__")
    if command or re.search(r"\braise \w", inspect.getsource(value)):
        assert "Raises" in sections_of(name)


# Compiled classes with examples that use a name before it is defined.
INCOMPLETE = {"kerf.DrawingWriter", "kerf.Toolpath"}

WITH_EXAMPLES = [*PREVIEW_NAMES, *sorted({*NAMES} - INCOMPLETE), "gcodepreview", "kerf.op"]


@pytest.mark.parametrize("name", WITH_EXAMPLES)
@pytest.mark.filterwarnings("ignore")
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.nc").write_text("G21 G90 T1 M6 M3 S9000\nG0 Z5\nG0 X10 Y10\nG1 Z-1 F100\nM2\n")
    text = inspect.getdoc(value_of(name)) or ""
    assert ">>>" not in text or "Examples" in sections_of(name)
    names = {"kerf": kerf} if name.startswith("kerf") else {}
    test = doctest.DocTestParser().get_doctest(text, names, name, name, 0)
    assert doctest.DocTestRunner(verbose=False).run(test).failed == 0


def test_the_most_used_commands_have_examples():
    with_examples = {name.split(".")[-1] for name in PREVIEW_NAMES if "Examples" in sections_of(name)}
    used = "gcodepreview setupstock addtool setfeeds gcode simulate rapid cutline cutlinedxf cutarcCC"
    used += " cutcircleCC cutrectangle cutpocket cutoutline cuttext cutkeyholegcdxf cutfingers cut_tails"
    used += " dxfline dxfarc dxfcircle dxfrectangle beginpolyline Full_Blind_Finger_Joint"
    used += " circle polygon bezier text"
    assert set(used.split()) <= with_examples


def test_no_row_of_an_argument_is_left_over():
    """Each row of the table of arguments is that of an argument of a command."""
    commands = importlib.import_module("gcodepreview._commands")
    used = set()
    for name in PREVIEW_NAMES:
        value = value_of(name)
        if not hasattr(value, "__wrapped__"):
            continue
        command = name.split(".")[-1]
        families = [key for key, names in commands.FAMILIES.items() if names.match(command)]
        for argument in inspect.signature(value).parameters:
            keys = [f"{prefix}.{argument}" for prefix in (command, *families)] + [argument]
            used |= {key for key in keys if key in commands.ARGUMENTS}
    assert set(commands.ARGUMENTS) == used


def test_the_validator_finds_what_is_missing():
    validate = pytest.importorskip("numpydoc.validate").validate
    found = {code for code, _ in validate("test_docstrings.is_own")["errors"]}
    assert {"PR01", "RT01"} <= found


def test_methods_state_their_result_in_a_section():
    for name in NAMES:
        value = value_of(name)
        if not callable(value) or inspect.isclass(value):
            continue
        result = inspect.signature(value).return_annotation
        if result not in (None, "None", inspect.Signature.empty) and "Returns\n" not in inspect.getdoc(value):
            assert "Iterator" in str(result), f"{name} returns {result}"


@pytest.mark.parametrize("name", NAMES)
def test_callables_have_a_signature(name):
    value = value_of(name)
    if not callable(value):
        assert isinstance(value, property) or inspect.isdatadescriptor(value)
        return
    parameters = inspect.signature(value).parameters
    assert "args" not in parameters and "kwargs" not in parameters, "the names of the arguments are stated"
    for parameter in parameters.values():
        assert not parameter.name.startswith("arg"), parameter


@pytest.mark.parametrize("module", ["gcodepreview", "cnc25d_api"])
def test_the_other_modules_have_signatures(module):
    package = importlib.import_module(module)
    names = getattr(package, "__all__", None) or [name for name in vars(package) if not name.startswith("_")]
    found = []
    for name in names:
        value = getattr(package, name)
        members = [getattr(value, member) for member in dir(value) if is_own(value, member, package.__name__)]
        found += [entry for entry in [value, *members] if callable(entry) and is_of(entry, package.__name__)]
    assert found
    for entry in found:
        inspect.signature(entry)

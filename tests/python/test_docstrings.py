"""Docstrings and signatures: every public name of `kerf`, `kerf.op` and `gcodepreview` has both, and they
agree.
"""

import doctest
import importlib
import inspect
import pathlib
import re
import shutil

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


PATHS = pathlib.Path(__file__).parents[2] / "examples" / "path"
# The files that the examples read.
FILES = {
    "part.nc": "G21 G90 T102 M6 M3 S9000\nG0 Z5\nG0 X10 Y10\nG1 Z-1 F100\nM2\n",
    "part.gcmc": 'message("a slot");\nfeedrate(400mm);\ngoto([0mm, 0mm, 5mm]);\nmove([10mm, 0mm, -1mm]);\n',
    "part.scad": "width = 10;\nsquare(width);\n",
    "tools.toml": '[[tool]]\nnumber = 102\nshape = "square"\ndiameter = 3.175\nflute = 12.7\n',
    "measured_Clean.gcode": "G01 Z0.800(=0.800+1.000*[#51-2.000]) F100\n",
    "measured_Z.txt": "([1.000 2.000]/T=2.000) #51=2.049\n",
    "print.gcode": "G21 G90 M82\nG92 E0\nG1 X10 Y10 Z0.2 F6000\n"
    + "".join(
        f"G1 X{x} Y{y} E{0.7 * i} F1200\n"
        for i, (x, y) in enumerate([(30, 10), (30, 30), (10, 30), (10, 10)], 1)
    ),
}


def write_files(folder):
    for name, text in FILES.items():
        (folder / name).write_text(text)
    for name in ("9001.1P.dxf", "9009.1P.dxf"):
        shutil.copy(PATHS / name, folder)
    drawing = kerf.DrawingWriter()
    drawing.circle("CUT", 20, 20, 8)
    (folder / "hole.dxf").write_bytes(drawing.dxf())


@pytest.mark.parametrize("name", [*PREVIEW_NAMES, *NAMES, "gcodepreview", "kerf.op"])
@pytest.mark.filterwarnings("ignore")
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_files(tmp_path)
    text = inspect.getdoc(value_of(name)) or ""
    assert ">>>" not in text or "Examples" in sections_of(name)
    names = {"kerf": kerf} if name.startswith("kerf") else {}
    test = doctest.DocTestParser().get_doctest(text, names, name, name, 0)
    assert doctest.DocTestRunner(verbose=False).run(test).failed == 0


# Functions and classes of kerf and kerf.op; methods are shown by the examples of their classes.
OWN = [name for name in NAMES if callable(value_of(name)) and name.split(".")[-2] in ("kerf", "op")]


def test_functions_and_classes_of_kerf_have_examples_of_a_few_lines():
    assert len(OWN) > 110
    without = [name for name in OWN if "Examples" not in sections_of(name)]
    assert not without
    for name in OWN:
        text = inspect.getdoc(value_of(name))
        statements = doctest.DocTestParser().get_examples(text)
        assert 1 <= len(statements) <= 12, name
        assert sum(example.source.count("\n") for example in statements) <= 16, name


def test_the_validator_finds_the_examples():
    validate = pytest.importorskip("numpydoc.validate").validate
    problems = [name for name in OWN if "EX01" in {code for code, _ in validate(name)["errors"]}]
    assert not problems


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

"""Docstrings and signatures: every public name of `kerf` and `kerf.op` has both, and they agree."""

import importlib
import inspect

import pytest

# Of numpydoc's checks: there is a docstring with a summary of one line, and the sections Parameters (all, in
# their order, with types), Returns and Yields. Attributes are documented as "type: meaning".
CHECKS = "GL08 SS01 SS04 SS06 PR01 PR02 PR03 PR04 RT01 YD01".split()


def public_names():
    found = []
    for module in ("kerf", "kerf.op"):
        for name in importlib.import_module(module).__all__:
            value = getattr(importlib.import_module(module), name)
            if inspect.ismodule(value) or not callable(value):
                continue  # the module itself is checked by its own name; constants have no docstring
            found.append(f"{module}.{name}")
            if inspect.isclass(value):
                found += [f"{module}.{name}.{member}" for member in dir(value) if is_own(value, member)]
    return found


def is_of(value, package):
    return (getattr(value, "__module__", None) or package).startswith(package.partition(".")[0])


def is_own(cls, member, package="kerf"):
    """Whether it is a public method or attribute of the class, and none of Python's own classes."""
    owners = [base for base in getattr(cls, "__mro__", ()) if member in vars(base)]
    return not member.startswith("_") and bool(owners) and is_of(owners[0], package)


NAMES = public_names()


def value_of(name):
    value = importlib.import_module("kerf")
    for part in name.split(".")[1:]:
        value = getattr(value, part)
    return value


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

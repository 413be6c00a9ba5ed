#!/usr/bin/env python3
"""Writes the types of the compiled module, python/kerf/_kerf.pyi, from the signatures in its docstrings.

Usage: PYTHONPATH=build/python tests/tools/make_stubs.py. tests/python/test_stubs.py compares the names.
"""

import inspect
import pathlib
import re

import doc_types

from kerf import _kerf

STUB = pathlib.Path(__file__).parents[2] / "python" / "kerf" / "_kerf.pyi"
SIGNATURE = re.compile(r"^(?:\d+\. )?(\w+)\((.*)\) -> (.+)$")
SPECIAL = {
    "__init__",
    "__len__",
    "__getitem__",
    "__setitem__",
    "__contains__",
    "__bool__",
    "__or__",
    "__and__",
    "__sub__",
    "__add__",
    "__iter__",
    "__eq__",
    "__hash__",
    "__xor__",
    "__repr__",
    "__str__",
    "__call__",
    "__geo_interface__",
}
# Parameters of commands of gcodepreview that are no numbers.
ROW_TYPES = {
    **dict.fromkeys(("axis", "color", "kht_direction", "orientation", "side", "string", "name"), "str"),
    **dict.fromkeys(("tooltype", "shape"), "str"),
    **dict.fromkeys(("layer", "corners"), "str | None"),
    **dict.fromkeys(("basefilename", "path", "gc_file"), "str | os.PathLike[str]"),
    **dict.fromkeys(("control", "outline", "surface", "text", "message", "cutorprint", "laser"), "Any"),
}
TYPES = [
    (r"kerf\._kerf\.", ""),
    (r"\b(handle|object|buffer|function)\b", "Any"),
    (r"numpy\.ndarray\[[^\]]*\]", "Any"),
    (r"os\.PathLike", "Any"),
    (r"\b(List|Tuple|Dict|Callable|Sequence)\b", lambda m: m.group(1).lower()),
    (r"collections\.abc\.Sequence|typing\.Sequence|\bsequence\b", "Any"),
    (r"typing\.", ""),
    (r"Any\[[^\]]*\]", "Any"),
    (r"kerf::[\w:]+", "Any"),
    (r"Optional\[([^\]]+)\]", r"\1 | None"),
    (r": (\w+) = None", r": \1 | None = ..."),
    (r"= (\([^)]*\)|'[^']*'|<[^>]*>|[^,]+)", "= ..."),
    (r"typing_extensions\.SupportsFloat|SupportsFloat", "float"),
    (r"typing_extensions\.SupportsIndex|SupportsIndex", "int"),
    (r"numpy\.\w+\[[^\]]*\]", "Any"),
]


def plain(text):
    for pattern, replacement in TYPES:
        text = re.sub(pattern, replacement, text)
    text = re.sub(r"(\*{1,2}\w+)(?=,|$)", r"\1: Any", text)
    text = re.sub(r"\bdict\b(?!\[)", "dict[str, Any]", text)
    text = re.sub(r"\b(list|Iterator)\b(?!\[)", r"\1[Any]", text)
    return re.sub(r"\btuple\b(?!\[)", "tuple[Any, ...]", text)


def row_signature(function, first=1):
    """(parameters, result) of a command of gcodepreview, which is a row of a table."""
    parts = ["self"]
    for p in list(inspect.signature(function).parameters.values())[first:]:
        if p.kind == p.VAR_POSITIONAL:
            parts.append(f"*{p.name}: Any")
        else:
            parts.append(f"{p.name}: {row_type(p)}" + (" = ..." if p.default is not p.empty else ""))
    return ", ".join(parts), "Any"


def row_type(parameter):
    """The type of a parameter: that of its default, or what its name says."""
    if isinstance(parameter.default, (bool, str)):
        return type(parameter.default).__name__
    if parameter.name in ROW_TYPES:
        return ROW_TYPES[parameter.name]
    return "float | None" if parameter.default is None else "float"


def signatures(function):
    """(parameters, result) of each overload."""
    if inspect.ismethoddescriptor(function) and getattr(function, "__text_signature__", None):
        forms = [row_signature(function)]
        if function.__name__ in _kerf._TWO_FORMS:
            forms.append(row_signature(function, first=2))
        return forms
    compiled = inspect.unwrap(function)
    lines = (compiled.__doc__ or "").splitlines()
    found = [m.groups() for m in map(SIGNATURE.match, lines) if m and m.group(1) == compiled.__name__]
    return [(plain(parameters), plain(result)) for _, parameters, result in found] or [("*args: Any", "Any")]


def with_further(parameters, text):
    """The parameters with what the docstring states of **kwargs: their type, or their names."""
    stated, kinds = re.search(r"^ *\*\*(\w+) : ", text, re.M), doc_types.parameters_of(text)
    if positional := re.search(r"^ *\*(\w+) : ", text, re.M):
        name = positional.group(1)
        parameters = parameters.replace("*args: Any", f"*{name}: {kinds.get(name, 'Any')}")
    if stated:
        kind = kinds.get(stated.group(1), "Any")
        return parameters.replace("**kwargs: Any", f"**{stated.group(1)}: {kind}")
    names = set(re.findall(r"\*{0,2}(\w+): ", parameters))
    further = ", ".join(f"{name}: {kind} = ..." for name, kind in kinds.items() if name not in names)
    star = "" if re.search(r"\*, |\*\w+: ", parameters.replace("**", "")) else "*, "
    return parameters.replace("**kwargs: Any", star + further) if further else parameters


def with_stated_types(parameters, result, text):
    """The types that the docstring states, where they say more than the compiled ones."""
    for name, kind in doc_types.parameters_of(text).items():
        vague = r"Any(?: \| None)?|str(?: \| None)?|Toolpath|list\[.*?\]|dict\[.*?\]"
        parameters = re.sub(
            rf"\b({name}): (?:{vague})(?=,|$| = )", lambda m: f"{m.group(1)}: {kind}", parameters
        )
    parameters = with_further(parameters, text)
    if re.search(r"\bAny\b", result):
        result = doc_types.result_of(text) or result
    return parameters, result


def one_and_several(parameters, result, text):
    """The forms of a function for one value and for several, if the docstring states the results of both."""
    stated = doc_types.results_of(text)
    if stated is None:
        return [(parameters, result)]
    both = next(kind for kind in doc_types.ONE_OR_SEVERAL if f": {kind}" in parameters)
    kinds = doc_types.ONE_OR_SEVERAL[both]
    return [(parameters.replace(f": {both}", f": {kind}"), made) for kind, made in zip(kinds, stated)]


def written(name, function, indent, static=False, class_text=""):
    overloads = signatures(function)
    out = []
    text = function.__doc__ or ""
    if not (inspect.ismethoddescriptor(function) and getattr(function, "__text_signature__", None)):
        if name == "__init__":
            text += "\n" + class_text
        overloads = [with_stated_types(*overload, text) for overload in overloads]
        overloads = [form for overload in overloads for form in one_and_several(*overload, text)]
    for parameters, result in overloads:
        if len(overloads) > 1:
            out.append(f"{indent}@overload")
        if static:
            out.append(f"{indent}@staticmethod")
        parameters = re.sub(r"^self: \w+", "self", parameters)
        if name == "__eq__":
            parameters = "self, other: object"
        out.append(f"{indent}def {name}({parameters}) -> {result}: ...")
    return out


def class_stub(name, cls):
    base = cls.__mro__[1].__name__
    known = base in vars(_kerf) or issubclass(cls, Exception)
    heading = f"class {name}({base}):" if known else f"class {name}:"
    out = [heading]
    for member, value in sorted(vars(cls).items()):
        if member.startswith("_") and member not in SPECIAL:
            continue
        if isinstance(value, property):
            stated = re.search(r"-> (.+)", (value.fget.__doc__ or "").split("\n")[0])
            result = plain(stated.group(1)) if stated else "Any"
            out += [
                "    @property",
                f"    def {member}(self) -> {with_stated_types('', result, value.__doc__ or '')[1]}: ...",
            ]
            if value.fset is not None:
                out += [f"    @{member}.setter", f"    def {member}(self, value: {result}) -> None: ..."]
        elif isinstance(value, staticmethod) or inspect.isbuiltin(value):
            out += written(member, value.__func__ if isinstance(value, staticmethod) else value, "    ", True)
        elif callable(value) and (
            member != "__init__" or "__init__(" in (getattr(inspect.unwrap(value), "__doc__", "") or "")
        ):
            out += written(member, value, "    ", class_text=cls.__doc__ or "")
    return out + (["    ..."] if len(out) == 1 else [])


def stub():
    lines = [
        "# Written by tests/tools/make_stubs.py.",
        "import os",
        "from typing import Any, Callable, Iterator, Literal, Mapping, Sequence, overload",
        "",
        "import numpy",
        "from numpy.typing import NDArray",
        "",
        "from ._types import AnyProgram, AnyTools, Outline, Outlines, PathName, Row, Rows, ZeroPosition",
        "",
        "__version__: str",
        "",
    ]
    lines += ["class Error(ValueError):", "    diagnostics: list[Diagnostic]", ""]
    for name, value in sorted(vars(_kerf).items()):
        if inspect.isclass(value) and name != "Error":
            lines += [*class_stub(name, value), ""]
    for name, value in sorted(vars(_kerf).items()):
        if inspect.isroutine(value):
            lines += written(name, value, "")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    STUB.write_text(stub())

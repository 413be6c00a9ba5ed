"""The types that the docstrings state, in numpydoc form, as annotations: for the stub of the compiled module.

A parameter takes what behaves like a point or an outline (kerf/_types.py); a result is what it is.
"""

import re

CLASSES = (
    "BezierSurface Burn Diagnostic Drawing DrawingOutlines Region Stock Tool ToolTable Toolpath Program "
    "Simulation PrintSimulation RotarySimulation ScadResult Job"
).split()
PLAIN = {
    "float": "float",
    "int": "int",
    "str": "str",
    "bool": "bool",
    "bytes": "bytes",
    "os.PathLike": "os.PathLike[str]",
}
ARGUMENTS = {
    "str or os.PathLike": "PathName",
    "Program or Toolpath": "AnyProgram",
    "Toolpath or Program": "AnyProgram",
    "Toolpath": "AnyProgram",
    "Tool, str, ToolTable or list of them": "AnyTools",
    "Stock, str or sequence of 3 float": "Stock | str | Row",
    "list of points and arcs, or a circle": "Outline",
    "sequence of outlines": "Outlines",
    "Region or list": "Outlines",
    "list of (x, y)": "Rows",
    "sequence of (float, float, float)": "Rows",
    "(float, float) or sequence of (float, float)": "Row | Rows",
    "Program, Toolpath or two points (float, float)": "AnyProgram | Rows",
    "str, os.PathLike or sequence of (float, float, float)": "PathName | Rows",
    "float, or sequence of float": "float | Row",
    "list of float": "Row",
    "sequence": "Rows",
    "sequence of (int, int)": "Sequence[tuple[int, int]]",
    "sequence of str": "str | Sequence[str]",
    "list of (str, Stock)": "Sequence[tuple[str, Stock]]",
    "list of (int, str, str, str)": "Sequence[tuple[int, str, str, str]]",
    "sequence of 4 sequences of 4 float": "Rows | Sequence[Sequence[float]]",
    "str, a position": "ZeroPosition",
    "str or list of str": "str | Sequence[str]",
    "callable(float, float)": "Callable[[float, float], float]",
    "dict": "Mapping[str, Any]",
    "dict of int to float": "Mapping[int, float]",
    "dict of str to float": "Mapping[str, float]",
}
RESULTS = {
    "dict": "dict[str, Any]",
    "list of dict": "list[dict[str, Any]]",
    "list of outlines": "list[list[tuple[float, ...]]]",
    "list of outlines and circles": "list[list[tuple[float, ...]] | tuple[float, float, float]]",
    "iterator of int": "Iterator[int]",
    "structured ndarray": "NDArray[numpy.void]",
    "list of paths": "list[list[tuple[float, ...]]]",
    "list of lists of outlines": "list[list[list[tuple[float, ...]]]]",
    "list of points and arcs": "list[tuple[float, ...]]",
    "list of (x, y)": "list[tuple[float, float]]",
    "list of (r, z, bulge)": "list[tuple[float, float, float]]",
    "list of list of (float, float, float)": "list[list[tuple[float, float, float]]]",
    "list": "list[Any]",
    "tuple": "tuple[Any, ...]",
    "tuple (Region, list)": "tuple[Region, list[list[tuple[int, int, bool]]]]",
}


def split(text, between=(",", "or")):
    """The parts between commas and 'or' that are in no bracket."""
    parts, depth, part = [], 0, ""
    for word in re.findall(r"[()\[\]{},]|[^()\[\]{},\s]+|\s+", text):
        depth += (word in "([{") - (word in ")]}")
        if depth == 0 and word in between:
            parts.append(part.strip())
            part = ""
        else:
            part += word
    return [p for p in [*parts, part.strip()] if p]


def argument(text):
    """The annotation of a parameter of this type; None where the text is none of the known ones."""
    if text.endswith(", optional"):
        kind = argument(text[: -len(", optional")])
        return kind and kind + " | None"
    if text in ARGUMENTS:
        return ARGUMENTS[text]
    if words := _words(text):
        return words
    if re.fullmatch(r"sequence of [\d or]+ float|\((float, )+float\)", text):
        return "Row"
    if text == "(int, int)":
        return "tuple[int, int]"
    if text == "callable":
        return "Callable[..., Any]"
    if text in PLAIN or text in CLASSES:
        return PLAIN.get(text, text)
    parts = split(text)
    kinds = [argument(part) for part in parts] if len(parts) > 1 else [None]
    return None if None in kinds else " | ".join(kinds)


def _words(text):
    """Of "{'a', 'b'}" the Literal."""
    if re.fullmatch(r"\{('[^']*'(, )?)+\}", text):
        return f"Literal[{text[1:-1]}]".replace("'", '"')
    return None


def result(text):
    """The annotation of a result; None where the text is none of the known ones."""
    text = text.strip()
    if text in RESULTS:
        return RESULTS[text]
    if text in PLAIN or text in CLASSES or text == "None":
        return PLAIN.get(text, text)
    if words := _words(text):
        return words
    if match := re.fullmatch(r"ndarray(?: \([^()]*\))? (\w+)", text):
        return f"NDArray[numpy.{match.group(1)}]"
    if match := re.fullmatch(r"dict of (.+) to (.+)", text):
        return _inside("dict[{}, {}]", match.groups())
    parts = split(text)
    if len(parts) == 1 and text[:1] + text[-1:] == "()":
        members = split(text[1:-1], ",")
        return _inside("tuple[" + ", ".join("{}" for _ in members) + "]", members)
    if len(parts) > 1:
        return _inside(" | ".join("{}" for _ in parts), parts)
    if match := re.fullmatch(r"list of (.+)", text):
        return _inside("list[{}]", match.groups())
    return None


def _inside(form, parts):
    kinds = [result(part) for part in parts]
    return None if None in kinds else form.format(*kinds)


def parameters_of(text):
    """{name: annotation} of the section Parameters of a docstring."""
    found = {}
    section = re.search(r"^\s*Parameters\n\s*-+\n(.*?)(?=\n\n *\w[\w ]*\n *-+\n|\Z)", text or "", re.M | re.S)
    for names, kind in re.findall(r"^ *([\w*][\w, *]*?) : (.*)$", section.group(1) if section else "", re.M):
        for name in names.split(", "):
            if known := argument(kind.strip()):
                found[name.lstrip("*")] = known
    return found


def _returns(text):
    section = re.search(r"^ *Returns\n *-+\n *(.+)$", text or "", re.M)
    return section and section.group(1)


# Parameters that are one value or several, and the annotations of both.
ONE_OR_SEVERAL = {"Row | Rows": ("Row", "Rows"), "float | Row": ("float", "Row")}


def results_of(text):
    """The annotations for one value and for several, of a result "T, or a list of them for several ..."."""
    match = re.fullmatch(r"(.+), or a list of them for several \w+", _returns(text) or "")
    one = match and result(match.group(1))
    return one and (one, f"list[{one}]")


def result_of(text):
    """The annotation of the section Returns, or of a first line such as 'list of int: the numbers'."""
    if stated := _returns(text):
        return result(stated)
    first = re.match(r"\s*([\w .,()]+?):(?: |\n)", text or "")
    return result(first.group(1)) if first else None

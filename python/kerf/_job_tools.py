"""The tools of a `Job`: those that it is given, and those that its operations use."""

from __future__ import annotations

from . import _kerf
from ._kerf import Tool, ToolTable


def _numbered(tool, number):
    table = ToolTable()
    table[number] = tool
    return table[number]


def _given(tools):
    """The tools of an argument as of `kerf.check`, by number; 0: a tool for every number."""
    if isinstance(tools, ToolTable):
        return {number: tools[number] for number in tools.numbers()}
    if isinstance(tools, (list, tuple)):
        return {number: tool for entry in tools for number, tool in _given(entry).items()}
    return _kerf._tools_of(tools)


def _diameter(text, units):
    """The mm of a text such as '6mm' or '1/4in'; None if it is no length."""
    try:
        return _kerf._quantity(text, units, "tool") * (25.4 if units == "inch" else 1)
    except ValueError:
        return None


class JobTools:
    """Tools by number; `given` is what the caller states, and has priority."""

    def __init__(self, given, units):
        self.given, self._units = given, units
        self.added = {}  # of programs and operations, by number

    def all(self):
        """As the argument `tools` of a simulation; those that nothing uses are no reason for a warning."""
        given, table = _given(self.given), ToolTable()
        for number, tool in {**self.added, **given}.items():
            if number:
                table[number] = tool
        return [table, *(table[number] for number in self.added), *(given[n] for n in given if n == 0)]

    def add(self, tools):
        """Adds the tools of a program."""
        given = _given(self.given)
        for number, tool in tools.items():
            known, stated = self.added.get(number, tool), given.get(number, tool)
            other = (stated.shape, stated.diameter) != (tool.shape, tool.diameter)
            if other or known.parts != tool.parts:
                raise ValueError(f"tool {number} has another shape in this job; give it another number")
        self.added.update(tools)

    def tool_of(self, value, argument="tool"):
        """The tool that an argument of a call means, with its number."""
        known = {**self.added, **_given(self.given)}
        if isinstance(value, str) and value.strip().isdigit():
            value = int(value)
        if isinstance(value, int) and not isinstance(value, bool):
            return _numbered(known[value], value) if value in known else self._other(value, known)
        if isinstance(value, str):
            value = self._of_text(value, known, argument)
        if not isinstance(value, Tool):
            raise TypeError(f"{argument} must be a Tool, a str such as 'square d=6', or a tool's number")
        if value.number:
            return value
        same = (n for n, tool in known.items() if n and _numbered(tool, n) == _numbered(value, n))
        number = next(same, None) or next(n for n in range(1, len(known) + 2) if n not in known)
        return _numbered(value, number)

    def _other(self, number, known):
        """The tool of a number that no one has stated."""
        return _numbered(known[0], number) if 0 in known else Tool(number)

    def _of_text(self, text, known, argument):
        """The tool of the job with this description, name or diameter, else what the text describes."""
        word = text.strip().casefold()
        for number, tool in known.items():
            if number and word in (name.casefold() for name in (tool.description, *tool.names)):
                return _numbered(tool, number)
        diameter = _diameter(text, self._units)
        if diameter is None:
            return Tool(text)
        fitting = [n for n, tool in known.items() if n and abs(tool.diameter - diameter) <= 1e-6]
        if len(fitting) == 1:
            return _numbered(known[fitting[0]], fitting[0])
        if fitting:
            listed = ", ".join(f"{n} ({known[n].shape})" for n in fitting)
            raise ValueError(
                f"{argument}: tools {listed} of the job have the diameter {text}; give the number"
            )
        shown = f"'square d={text.strip()}'"
        raise ValueError(
            f"{argument}: no tool of the job has the diameter {text}; describe it, as in {shown}"
        )

"""What arguments may be, for type checkers: anything that behaves like a point, an outline, a geometry."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Iterable, List, Literal, Mapping, Protocol, Sequence, Tuple, Union

if TYPE_CHECKING:
    from ._kerf import Program, Region, Tool, Toolpath, ToolTable


class Row(Protocol):
    """Numbers: a point, an arc (via x, via y, x, y) or a circle (x, y, radius); a tuple, list or array."""

    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> float: ...


class Rows(Protocol):
    """Points and arcs one after another; a list or an array."""

    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Row: ...


class Geometry(Protocol):
    """A shape of shapely, GeoPandas and others."""

    @property
    def __geo_interface__(self) -> Any: ...


Points = List[Tuple[float, ...]]
Position = Union[Row, Sequence[Union[float, str]]]  # a text has a unit: "1/4in"
ZeroPosition = Literal[
    "lower-left",
    "lower-centre",
    "lower-right",
    "centre-left",
    "centre",
    "centre-right",
    "top-left",
    "top-centre",
    "top-right",
]
PathName = Union[str, "os.PathLike[str]"]
Outline = Union[Rows, Row, Geometry]
Outlines = Union["Region", Geometry, Iterable[Union[Rows, Row, Geometry]]]
AnyProgram = Union["Program", "Toolpath"]
AnyTools = Union[
    "Tool", str, "ToolTable", Sequence[Union["Tool", str]], Mapping[int, Union["Tool", str]]
]

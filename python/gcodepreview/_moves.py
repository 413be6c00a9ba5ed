"""Moves: what a call adds to the toolpath."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Tuple

from kerf import _kerf


# `kind` is 'rapid', 'cut', 'extrude' or 'shaft'; `centre` and `turn` are None but for arcs.
class Move(NamedTuple):
    """A motion from `start` to `end`, mm, with the number of its tool."""

    kind: str
    start: Tuple[float, float, float]
    end: Tuple[float, float, float]
    tool: int
    centre: Optional[Tuple[float, ...]] = None
    turn: Optional[str] = None


class Moves(list[Move]):
    """The moves of a call. `union` appends others, as scripts for PythonSCAD do with solids."""

    def union(self, *others: Any) -> Moves:
        result = Moves(self)
        for other in others:
            result.extend(other or ())
        return result

    __or__ = union


_kerf._set_move_classes(Move, Moves)

"""Moves: what a call adds to the toolpath."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Tuple

from kerf import _kerf


class Move(NamedTuple):
    """A motion from `start` to `end`, mm, with the number of its tool.

    Parameters
    ----------
    kind : {'rapid', 'cut', 'extrude', 'shaft'}
        What it does.
    start, end : (float, float, float)
        Its ends in work coordinates, mm.
    tool : int
        Number of the tool.
    centre : tuple of float, optional
        Centre of an arc, mm; None for a straight line.
    turn : str, optional
        Direction of an arc seen from above: 'cw' or 'ccw'; None for a straight line.
    """

    kind: str
    start: Tuple[float, float, float]
    end: Tuple[float, float, float]
    tool: int
    centre: Optional[Tuple[float, ...]] = None
    turn: Optional[str] = None


class Moves(list[Move]):
    """The moves of a call. `union` appends others, as scripts for PythonSCAD do with solids.

    Parameters
    ----------
    iterable : iterable of Move
        The moves.
    """

    def union(self, *others: Any) -> Moves:
        """These moves and further ones, in this order.

        Parameters
        ----------
        *others : Moves or None
            Lists of moves; None is empty.

        Returns
        -------
        Moves
            A new list.
        """
        result = Moves(self)
        for other in others:
            result.extend(other or ())
        return result

    __or__ = union


_kerf._set_move_classes(Move, Moves)

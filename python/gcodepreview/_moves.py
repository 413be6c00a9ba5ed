"""Moves: what a call adds to the toolpath."""

import collections

from kerf import _kerf

# `kind` is 'rapid', 'cut', 'extrude' or 'shaft'; `centre` and `turn` are None but for arcs.
Move = collections.namedtuple("Move", "kind start end tool centre turn", defaults=(None, None))


class Moves(list):
    """The moves of a call. `union` appends others, as scripts for PythonSCAD do with solids."""

    def union(self, *others):
        result = Moves(self)
        for other in others:
            result.extend(other or ())
        return result

    __or__ = union


_kerf._set_move_classes(Move, Moves)

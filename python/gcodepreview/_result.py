"""The part after all cuts: the result of a simulation, and where it is shown."""

from __future__ import annotations

import os
import sys
import warnings
from typing import Any

import kerf
from kerf._notebook import _location

_HERE = os.path.dirname(__file__)
_HAZARDS_SHOWN = 20


def _warn(message):
    """Issues a UserWarning at the line of the user's script."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        frame = frame.f_back
    warnings.warn_explicit(message, UserWarning, frame.f_code.co_filename, frame.f_lineno)


def _text_of(hazard):
    where = _location(hazard["origin"])
    return f"{where}: {hazard['kind'].replace('_', ' ')}, {hazard['depth_mm']:.3f} mm deep"


class PathPicture:
    """The motions alone, over the stock before the first cut: `save(path, ...)` writes .png or .svg.

    Parameters
    ----------
    path : kerf.Toolpath
        The motions, mm.
    stock : kerf.Stock or None
        What is drawn below them.
    tools : kerf.ToolTable
        The tools.
    """

    def __init__(self, path: kerf.Toolpath, stock: kerf.Stock | None, tools: Any) -> None:
        self._path, self._stock, self._tools = path, stock, tools

    def save(self, *paths: Any, **view: Any) -> None:
        """Write the motions as .png, or from above as .svg.

        Parameters
        ----------
        *paths : str or os.PathLike
            The files.
        **view
            Keywords of `kerf.path_picture`, such as size=(720, 450), for .png.

        Raises
        ------
        ValueError
            If a name has another ending.
        OSError
            If a file cannot be written.
        """
        for path in map(os.fspath, paths):
            if path.endswith(".svg"):
                data = kerf.post(self._path, "svg", rapids=True).encode()
            elif path.endswith(".png"):
                data = self._png(**view)
            else:
                raise ValueError(f"'{path}' must end in .png or .svg: motions are no solid")
            with open(path, "wb") as file:
                file.write(data)

    def _png(self, **view):
        return kerf.path_picture(self._path, tools=self._tools, stock=self._stock, **view)

    def _repr_png_(self) -> bytes:
        return self._png(size=(720, 450))

    def show(self) -> None:
        """Hand the picture to `kerf run`, or write it beside the script."""
        show(self)


class Result:
    """The part after the cuts: `simulation`, `hazards`, `report()`, `save(path, ...)`.

    Parameters
    ----------
    simulation : kerf.Simulation or kerf.PrintSimulation
        What was simulated.
    colours : list
        Of `setcolor`: the step from which they hold, and those of cuts, rapids and shafts.
    """

    def __init__(self, simulation: kerf.Simulation | kerf.PrintSimulation, colours: Any = ()) -> None:
        self.simulation = simulation
        self.hazards = simulation.hazards
        self._colours = list(colours)

    def warn(self) -> None:
        """Issue a UserWarning for each hazard, with the line of the script; at most 20 in full."""
        for hazard in self.hazards[:_HAZARDS_SHOWN]:
            _warn(_text_of(hazard))
        if len(self.hazards) > _HAZARDS_SHOWN:
            _warn(f"{len(self.hazards) - _HAZARDS_SHOWN} more hazards")

    def report(self) -> str:
        """Volumes and hazards as text, one line each; hazards with the line of the script.

        Returns
        -------
        str
            The lines; volumes in mm3, depths in mm.
        """
        s = self.simulation
        if not isinstance(s, kerf.Simulation):
            lines = [", ".join(f"{k} {v:.1f}" for k, v in s.total.items() if isinstance(v, float))]
            return "\n".join(lines + [*map(_text_of, self.hazards)])
        lines = [f"stock {s.stock_mm3:.1f} mm3, removed {s.removed_mm3:.1f} mm3, left {s.left_mm3:.1f} mm3"]
        lines += map(_text_of, self.hazards)
        return "\n".join(lines)

    def save(self, *paths: Any, **view: Any) -> None:
        """Write the part as .stl .3mf .glb .obj .png or .kstock.

        Parameters
        ----------
        *paths : str or os.PathLike
            The files.
        **view
            Keywords of `kerf.Simulation.save`, such as detail='columns'.

        Raises
        ------
        ValueError
            If a name has another ending, or a keyword a wrong value.
        OSError
            If a file cannot be written.
        """
        if self._colours:
            view = {"motion_colours": self._colours, **view}
        self.simulation.save(*paths, **view)

    def _repr_png_(self) -> bytes:
        return self.simulation._repr_png_()

    def _repr_html_(self) -> str:
        return self.simulation._repr_html_()

    def show(self) -> None:
        """Hand the part to PythonSCAD or to `kerf run`, or write it beside the script."""
        show(self)


def _is_stand_in(module):
    return getattr(module, "KERF_STAND_IN", False)


def show(result: Result | PathPicture) -> None:
    """Hand the part to PythonSCAD, to the outputs of `kerf run`, or write it beside the script.

    Parameters
    ----------
    result : Result or PathPicture
        What is shown. Beside the script a part is a .glb, a picture of motions a .png.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    openscad = sys.modules.get("openscad")
    if openscad is not None and not _is_stand_in(openscad) and isinstance(result, Result):
        points, triangles, _ = result.simulation.mesh()
        openscad.polyhedron(points.tolist(), triangles.tolist()).show()
        return
    outputs = os.environ.get("KERF_RUN_OUTPUTS", "").split("\n")
    outputs = [path for path in outputs if path]
    tolerance = os.environ.get("KERF_RUN_MESH_TOLERANCE")
    within = {"mesh_tolerance": float(tolerance)} if tolerance else {}
    script = sys.argv[0] if sys.argv else ""
    if outputs and isinstance(result, PathPicture):
        result.save(*[path for path in outputs if path.endswith((".png", ".svg"))])  # motions are no solid
    elif outputs:
        result.save(*outputs, **within)
    elif script.endswith(".py"):
        base = os.path.splitext(script)[0]
        if isinstance(result, PathPicture):
            result.save(base + ".png")
        else:
            result.save(base + ".glb", detail="columns", **within)  # a preview, for a viewer

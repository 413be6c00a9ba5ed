"""How operations are run: tools by number, meshes as files or arrays."""

import os

from . import _kerf
from ._kerf import Tool

OTHER_TOOLS = ("rest_tool", "carve_tool", "floor_tool")


def tool_of(value, argument="tool"):
    """The tool that an argument describes."""
    if isinstance(value, Tool):
        return value
    if isinstance(value, bool) or not isinstance(value, (str, int)):
        raise TypeError(
            f"{argument} must be a Tool, a str such as 'square d=6', or a number of a built-in tool"
        )
    return Tool(value)


def _file_or_arrays(mesh):
    """The name of a mesh's file, or its points and triangles as bytes."""
    if isinstance(mesh, (str, os.PathLike)):
        return os.path.abspath(os.fspath(mesh))
    if not isinstance(mesh, (list, tuple)) or len(mesh) < 2:
        raise TypeError("mesh must be a path, or points and triangles")
    import numpy

    points = numpy.asarray(mesh[0], dtype=numpy.float64)
    triangles = numpy.asarray(mesh[1])
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError("the points of a mesh are an array of N x 3")
    if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
        raise ValueError("the triangles of a mesh are an array of M x 3 whole numbers")
    if triangles.size and not (0 <= triangles.min() and triangles.max() < len(points)):
        raise ValueError(f"a triangle of the mesh has a corner that is not one of its {len(points)} points")
    return points.tobytes(), triangles.astype(numpy.uint32).tobytes()


def run(
    op, shapes=None, tool=None, *, points=None, picture=None, mesh=None, move=(0, 0, 0), scale=1.0, **options
):
    """The program of an operation of this name; those of lasers have no tool."""
    if not isinstance(op, str):
        raise TypeError(f"op must be a str such as 'pocket', not {type(op).__name__}")
    op = op.replace("_", "-")
    if isinstance(picture, (str, os.PathLike)):
        options["picture"] = os.fspath(picture)
    elif picture is not None:
        options["pixels"] = list(picture)
    if op.startswith("laser") and tool is None:
        return _kerf._cut(op, shapes, points, 1, {}, options)
    if tool is None:
        raise TypeError("tool is missing, as in tool='square d=6'")
    tool = tool_of(tool)
    number = tool.number or 1
    tools = {number: tool}
    for key in OTHER_TOOLS:
        if options.get(key) is not None:
            other = tool_of(options[key], key)
            at = other.number or next(n for n in range(1, len(tools) + 2) if n not in tools)
            if at in tools:
                raise ValueError(f"{key} has the number {at}, as another tool of the operation")
            tools[at] = other
            options[key] = at
    surface = None if mesh is None else (_file_or_arrays(mesh), move, scale)
    return _kerf._cut(op, shapes, points, number, tools, options, surface)

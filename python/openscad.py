"""A stand-in for PythonSCAD's module, so that scripts for it run without it.

It has what scripts of gcodepreview use: `show`, and `nimport`, which yields the built-in gcodepreview
without a network. A real module of this name wins: PythonSCAD's own one precedes this file, and one that is
installed (PyPI's pythonscad) replaces it wherever it lies on the path.
"""

import importlib.machinery
import importlib.util
import os
import sys

import gcodepreview as _gcodepreview

__all__ = ["nimport", "show"]

KERF_STAND_IN = True


def show(part):
    """Show what `stockandtoolpaths` returned."""
    if isinstance(part, _gcodepreview.Result):
        part.show()


def nimport(url):
    """Import a module by its address: only gcodepreview's is known."""
    if "gcodepreview" not in str(url):
        raise ImportError(f"{url}: only gcodepreview can be imported by its address")
    names = sys._getframe(1).f_globals
    for name in _gcodepreview.__all__:
        names[name] = getattr(_gcodepreview, name)


def _is_stand_in(spec):
    """Whether a module is a copy of this file, as another installation of Kerf has one."""
    try:
        with open(spec.origin, encoding="utf-8") as file:
            return "\nKERF_STAND_IN = True\n" in file.read()
    except (OSError, TypeError, UnicodeDecodeError):
        return False  # a compiled or a built-in module


def _find_real():
    """The module of this name in the other folders of the path."""
    here = os.path.dirname(os.path.abspath(__file__))
    for folder in sys.path:
        if os.path.abspath(folder) == here:
            continue
        spec = importlib.machinery.PathFinder.find_spec("openscad", [folder])
        if spec is not None and not _is_stand_in(spec):
            return spec
    return None


def _make_way():
    """Replace this module by a real one, if there is one."""
    spec = _find_real()
    if spec is None or spec.loader is None:
        return
    real = importlib.util.module_from_spec(spec)
    sys.modules["openscad"] = real
    spec.loader.exec_module(real)


if __name__ == "openscad":
    _make_way()

"""A stand-in for PythonSCAD's module, so that scripts for it run without it.

It has what scripts of gcodepreview use: `show`, and `nimport`, which yields the built-in gcodepreview
without a network. In PythonSCAD its own module precedes this one.
"""

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

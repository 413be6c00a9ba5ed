"""What a script makes, for `kerf view`: the toolpath that it simulates, writes or ends last, as G-code.

The command sets $KERF_VIEW_PROGRAM to the file that is to be written.
"""

import atexit
import os
import sys

from . import _kerf

_noted = None  # toolpath, stock, tools


def note(path, stock=None, tools=None):
    """Keep a toolpath; stock and tools of an earlier call for it stay where they are not given."""
    global _noted
    if isinstance(path, _kerf.Program):
        path = path.toolpath
    if _noted is not None and _noted[0] is path:
        stock = _noted[1] if stock is None else stock
        tools = _noted[2] if tools is None else tools
    _noted = (path, stock, tools)


def install():
    """Note the toolpaths of all simulations and programs of the script."""
    simulate, post = _kerf.simulate, _kerf._post

    def noting_simulate(path, stock=None, tools=None, *further, **options):
        note(path, stock, tools)
        return simulate(path, stock, tools, *further, **options)

    def noting_post(program, to, name, **options):
        note(program, None, options.get("tools"))
        return post(program, to, name, **options)

    _kerf.simulate, _kerf._post = noting_simulate, noting_post
    _kerf._library_file(__file__)
    target = os.environ["KERF_VIEW_PROGRAM"]
    atexit.register(lambda: _noted is not None and _write(target, post))


def _write(target, post):
    path, stock, tools = _noted
    lines = []
    if isinstance(stock, str):
        stock = _kerf.Stock.read(stock)
    if stock is not None:
        for name, corner in (("stockMin", stock.low), ("stockMax", stock.high)):
            lines.append(f"({name}: " + ", ".join(f"{v:.6f}mm" for v in corner) + ")")
    options = dict(unit="mm", tool_change="command", feed=0.0, tools=tools, fit_arcs=0.0, join=0.0,
                   shorten_rapids=False, rapids=False, dxf_version="r2000", variables={}, thumbnails=[])
    text = post(path, "linuxcnc", "program", **options)[0][1].decode(errors="replace")
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join([*lines, text]))
    with open(target + ".imports", "w", encoding="utf-8") as file:
        file.write("\n".join(_own_modules()))


def _own_modules():
    """The files of the modules in the folder of the script, which the viewer watches as well."""
    folder = os.path.dirname(os.path.abspath(sys.argv[0])) + os.sep
    files = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    return sorted(file for file in files if file and file.startswith(folder) and "\n" not in file)

"""The distribution kerf-cam: starts the command `kerf`, and finds out whether the module `kerf` is Kerf's.

PyPI's distribution `kerf` is another project, a workflow engine, whose module has the same name. A script
named kerf.py hides the module as well.
"""

import importlib.machinery
import importlib.util
import os
import sys

__all__ = ["command", "main", "require"]

_HERE = os.path.dirname(os.path.abspath(__file__))


def command():
    """The path of the command: inside of this package (a wheel), in the build folder, or below the prefix."""
    folders = ("bin", os.path.join("..", ".."), os.path.join("..", "..", "..", "..", "bin"))
    for folder in folders:
        path = os.path.normpath(os.path.join(_HERE, folder, "kerf"))
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    raise FileNotFoundError("the command kerf was not built with these modules")


def main():
    """Become the command, with the arguments of this process; scripts run with this Python."""
    path = command()
    if not os.environ.get("KERF_PYTHON"):
        os.environ["KERF_PYTHON"] = sys.executable
    os.execv(path, [path, *sys.argv[1:]])


def _hidden_by():
    """The file of another module `kerf` that would be imported, or has been; None if it is Kerf's."""
    loaded = sys.modules.get("kerf")
    if loaded is not None:
        return None if hasattr(loaded, "_kerf") else getattr(loaded, "__file__", None) or repr(loaded)
    spec = importlib.util.find_spec("kerf")
    if spec is None:
        return None  # the import reports it
    folders = spec.submodule_search_locations or []
    if importlib.machinery.PathFinder.find_spec("_kerf", folders) is None:
        return spec.origin or next(iter(folders), "an unknown folder")
    with open(spec.origin, encoding="utf-8", errors="replace") as file:  # replaced by the other distribution?
        return None if "_kerf" in file.read() else spec.origin


def require():
    """Raise ImportError, with what to do, if another module than Kerf's would be imported as `kerf`."""
    hidden_by = _hidden_by()
    if hidden_by is None:
        return
    advice = "rename it, or remove it from the path"
    if {"site-packages", "dist-packages"} & set(os.path.normpath(hidden_by).split(os.sep)):
        advice = (
            "it is another project's; in this environment run: python -m pip uninstall -y kerf, then "
            "python -m pip install --force-reinstall kerf-cam"
        )
    raise ImportError(
        f"the module kerf of {hidden_by} is not that of Kerf (kerf-cam): {advice}",
        name="kerf",
        path=hidden_by,
    )

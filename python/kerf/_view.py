"""What a script makes, for `kerf view`: the program that it simulates, writes or ends last, as a .kerf file.

The command sets $KERF_VIEW_PROGRAM to the file that is to be written.
"""

import atexit
import os
import sys

from . import _kerf

_noted = None  # program, what is known of its set-up


def note(program, **setup):
    """Keep a program or toolpath; what earlier calls for it gave stays where it is not given."""
    global _noted
    given = {key: value for key, value in setup.items() if value is not None}
    if _noted is not None and _noted[0] is program:
        given = {**_noted[1], **given}
    _noted = (program, given)


def _bar(diameter, x, axis=(0.0, 0.0), tools=None, resolution=0.0):
    """The bar and the tools of the arguments of simulate_rotary."""
    return {"bar": (diameter, *x, *axis), "tools": tools}


def _block(
    stock=None, tools=None, resolution=0.0, threads=0, *, fixtures=None, spoilboard=None, machine=None
):
    """Stock, tools and more of the arguments of simulate; the machine is no part of a program."""
    return {"stock": stock, "tools": tools, "fixtures": fixtures, "spoilboard": spoilboard}


def _noting(function, setup_of):
    """The function, which notes its program once it has accepted the arguments."""

    def call(path, *arguments, **options):
        result = function(path, *arguments, **options)
        note(path, **setup_of(*arguments, **options))
        return result

    call.__doc__ = function.__doc__
    return call


def install():
    """Note the programs of all simulations and posts of the script."""
    _kerf.simulate = _noting(_kerf.simulate, _block)
    _kerf.simulate_rotary = _noting(_kerf.simulate_rotary, _bar)
    _kerf.simulate_print = _noting(_kerf.simulate_print, lambda *arguments, **options: {})
    _kerf._post = _noting(_kerf._post, lambda to, name, *, tools=None, **options: {"tools": tools})
    _kerf._library_file(__file__)
    target = os.environ["KERF_VIEW_PROGRAM"]
    atexit.register(lambda: _noted is not None and _write(target))


def _write(target):
    program, setup = _noted
    _kerf._write_program_file(os.fsencode(target), program, **setup)
    with open(target + ".imports", "w", encoding="utf-8") as file:
        file.write("\n".join(_own_modules()))


def _own_modules():
    """The files of the modules in the folder of the script, which the viewer watches as well."""
    folder = os.path.dirname(os.path.abspath(sys.argv[0])) + os.sep
    files = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    return sorted(file for file in files if file and file.startswith(folder) and "\n" not in file)

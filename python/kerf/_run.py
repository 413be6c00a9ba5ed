"""What a script writes, for `kerf run`: the names of its files, one per line.

The command sets $KERF_RUN_WRITTEN to the file that gets them.
"""

import functools
import os

from . import _kerf


def _note(paths):
    with open(os.environ["KERF_RUN_WRITTEN"], "ab") as file:
        file.writelines(os.fsencode(path).replace(b"\n", b"?") + b"\n" for path in paths)


def _noting_save(save):
    @functools.wraps(save)
    def call(self, *paths, **options):
        result = save(self, *paths, **options)
        _note(paths)
        return result

    return call


def install():
    """Note the files of all calls that write some."""
    write = _kerf._write_files

    def write_files(program, files):
        write(program, files)
        _note(name for name, _ in files)

    _kerf._write_files = write_files
    for kind in vars(_kerf).copy().values():
        if isinstance(kind, type) and "save" in vars(kind):
            kind.save = _noting_save(kind.save)
    _kerf._library_file(__file__)

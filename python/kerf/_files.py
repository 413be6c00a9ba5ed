"""Names and contents of files for the compiled module."""

import os


def existing(path):
    """The name of a file; raises OSError if it cannot be read."""
    with open(os.fsdecode(path), "rb"):  # an int is no path
        return os.fsencode(path)


def bytes_of(path):
    """The content of a file."""
    with open(os.fsdecode(path), "rb") as file:
        return file.read()


def texts(values, argument):
    """A sequence of str as a list."""
    if isinstance(values, (str, bytes)):
        raise TypeError(f"{argument} must be a sequence of str, not one str")
    return list(values)


def folders_of(values, argument):
    """A sequence of paths as a list of names."""
    return [os.fsencode(folder) for folder in texts(values, argument)]

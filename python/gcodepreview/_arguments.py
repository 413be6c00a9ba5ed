"""Checks of arguments: numbers, names of positions and styles, colours."""

import math
import numbers
import os
import sys
import warnings

_HERE = os.path.dirname(__file__)


def warn(message):
    """Issues a UserWarning at the line of the user's script."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        frame = frame.f_back
    warnings.warn_explicit(message, UserWarning, frame.f_code.co_filename, frame.f_lineno)


_LARGEST = 2**31 - 1  # of whole numbers: those of tools


class GcodePreviewError(ValueError):
    """A call with a wrong value, or at a time when it is impossible; the message names the argument or the
    call.
    """


def number(value, name):
    """`value` as a float; TypeError or GcodePreviewError naming the argument unless it is a finite number."""
    if type(value) is not float:  # the usual type first: the test for others takes most of a call's time
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise TypeError(f"{name} must be a number, not {type(value).__name__}")
        try:
            value = float(value)
        except OverflowError:
            raise GcodePreviewError(f"{name} must be a number up to 1e308") from None
    if not math.isfinite(value):
        raise GcodePreviewError(f"{name} must be a finite number, not {value}")
    return value


def positive(value, name):
    value = number(value, name)
    if value <= 0:
        raise GcodePreviewError(f"{name} must be above 0, not {value:g}")
    return value


def whole(value, name, low=0):
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a whole number, not {value!r}")
    if not float(number(value, name)).is_integer():
        raise TypeError(f"{name} must be a whole number, not {value!r}")
    if value < low:
        raise GcodePreviewError(f"{name} must be at least {low}, not {value}")
    if value > _LARGEST:
        raise GcodePreviewError(f"{name} must be at most {_LARGEST}, not {float(value):g}")
    return int(value)


def pairs(value, name):
    """`value` as a list of pairs; TypeError naming the argument otherwise."""
    try:
        return [(a, b) for a, b in value]
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a list of points (x, y)") from None


def flag(value, name):
    """True, False, 1 or 0; OpenSCAD passes numbers."""
    if value in (0, 1):
        return bool(value)
    raise TypeError(f"{name} must be True, False, 1 or 0, not {value!r}")


def folded(text):
    """A name without case, blanks, hyphens and underscores, by which names are compared."""
    return "".join(c for c in str(text).lower() if c not in " -_")


def choice(value, known, name):
    """The entry of `known` that `value` names; GcodePreviewError with the known ones otherwise."""
    if isinstance(value, str):
        for entry in known:
            if folded(entry) == folded(value):
                return entry
    raise GcodePreviewError(f"{name}: {value!r} is unknown; known: {', '.join(known)}")


# The colours of drawings: name, AutoCAD colour index. Index 7 is black on white paper and white on a black
# screen.
COLOURS = {
    "Black": 7,
    "Red": 1,
    "Yellow": 2,
    "Green": 3,
    "Cyan": 4,
    "Blue": 5,
    "Magenta": 6,
    "White": 7,
    "Dark Gray": 8,
    "Light Gray": 9,
}
# Web colours that are others of the names above, or have a near one in the index.
WEB = {
    "Aqua": "Cyan",
    "Fuchsia": "Magenta",
    "Gray": "Dark Gray",
    "Grey": "Dark Gray",
    "Silver": "Light Gray",
    "Dark Grey": "Dark Gray",
    "Light Grey": "Light Gray",
    "Lime": "Green",
    "Maroon": "Red",
    "Olive": "Yellow",
    "Teal": "Cyan",
    "Navy": "Blue",
    "Purple": "Magenta",
    "Orange": "Yellow",
}


def drawing_colour(name):
    """The name of a drawing colour for one of these or a web colour."""
    found = choice(name, [*COLOURS, *WEB], "color")
    return WEB.get(found, found)


# Positions of the stock's zero, as kerf.Stock.block names them.
ZEROS = {
    "Lower-Left": "lower-left",
    "Lower-Center": "lower-centre",
    "Lower-Right": "lower-right",
    "Center-Left": "centre-left",
    "Center": "centre",
    "Center-Right": "centre-right",
    "Top-Left": "top-left",
    "Top-Center": "top-centre",
    "Top-Right": "top-right",
}


def file_name(base, ending, folder):
    """The path of an output named `base`; relative names are in `folder`."""
    if not isinstance(base, (str, os.PathLike)) or not os.fspath(base):
        raise TypeError(f"basefilename must be a file name, not {base!r}")
    return os.path.join(folder, os.fspath(base) + ending)

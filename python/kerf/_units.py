"""Lengths and feeds: factors of units, and numbers that may be texts such as "1/4in" and "60ipm"."""

from __future__ import annotations

import math
import numbers
from typing import Final

from . import _kerf

mm: Final = 1.0
inch: Final = 25.4


def number(value: float | str, name: str, low: float = -math.inf, unit: str = "mm") -> float:
    """`value` in `unit` as a float above `low`; the message names the argument."""
    if isinstance(value, str):
        value = _kerf._quantity(value, unit, name)
    elif isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a number, or a str such as '1/4in', not {type(value).__name__}")
    try:
        value = float(value)
    except OverflowError:
        raise ValueError(f"{name} must be a number up to 1e308") from None
    if not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, not {value}")
    if value <= low:
        raise ValueError(f"{name} must be above {low:g}, not {value:g}")
    return value

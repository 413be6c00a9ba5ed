"""Lengths and feeds: factors of units, and numbers that may be texts such as "1/4in" and "60ipm"."""

from __future__ import annotations

import math
import numbers
from typing import Any, Final

from . import _kerf

mm: Final = 1.0
inch: Final = 25.4


def is_number(value: object) -> bool:
    """Whether it is a real number; `decimal.Decimal` is a Number that is not registered as Real."""
    if isinstance(value, bool):
        return False
    return isinstance(value, numbers.Real) or (
        isinstance(value, numbers.Number) and not isinstance(value, numbers.Complex)
    )


def number(value: float | str, name: str, low: float = -math.inf, unit: str = "mm") -> float:
    """`value` in `unit` as a float above `low`; the message names the argument."""
    if isinstance(value, str):
        value = _kerf._quantity(value, unit, name)
    elif not is_number(value):
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


def scaled(value: Any, factor: float, name: str = "", unit: str = "") -> Any:
    """Numbers and texts in `unit`, points, outlines, a Region or a geometry, multiplied by a factor."""
    if factor == 1 or value is None or isinstance(value, bool):
        return value
    if isinstance(value, _kerf.Region):
        return value.scaled(factor)
    if is_number(value) or isinstance(value, str):
        return number(value, name, unit=unit) * factor if unit or not isinstance(value, str) else value
    if isinstance(value, dict):
        return {key: scaled(entry, factor) for key, entry in value.items()}
    if hasattr(value, "__geo_interface__"):
        return _Geometry(scaled(value.__geo_interface__, factor))
    return [scaled(entry, factor, name, unit) for entry in value]


class _Geometry:
    def __init__(self, content: Any) -> None:
        self.__geo_interface__ = content

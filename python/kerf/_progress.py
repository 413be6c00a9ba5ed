"""`progress`: shows how far long calls are."""

from __future__ import annotations

import contextlib
import sys
from typing import Callable, Iterator

from . import _kerf

_WIDTH = 30  # characters of the bar


class _Bar:
    """A bar on stderr; one line for each phase."""

    def __init__(self) -> None:
        self._phase = None

    def __call__(self, phase, fraction):
        if phase != self._phase:
            self.end()
            self._phase = phase
        full = round(_WIDTH * min(max(fraction, 0.0), 1.0))
        sys.stderr.write(f"\r{phase:<24} [{'#' * full}{' ' * (_WIDTH - full)}] {100 * fraction:3.0f}%")
        sys.stderr.flush()

    def end(self) -> None:
        if self._phase is not None:
            sys.stderr.write("\n")
        self._phase = None


@contextlib.contextmanager
def progress(show: Callable[[str, float], object] | None = None) -> Iterator[None]:
    """Show the progress of the calls in a ``with`` block.

    Parameters
    ----------
    show : callable, optional
        ``show(phase, fraction)`` is called about ten times a second while a call works: a text such as
        'cutting', and 0 to 1. An exception that it raises stops the work and is raised by the call.
        Default: a bar on stderr.

    Yields
    ------
    None

    Raises
    ------
    TypeError
        If `show` is not callable.

    Examples
    --------
    >>> program = kerf.cut("pocket", [(50, 30, 20)], "square d=6", depth=4, feed=900)
    >>> with kerf.progress():
    ...     part = kerf.simulate(program, resolution=0.2)
    """
    if show is not None and not callable(show):
        raise TypeError("show must be callable: show(phase, fraction)")
    bar = _Bar() if show is None else None
    token = _kerf._progress.set(show or bar)
    try:
        yield
    finally:
        _kerf._progress.reset(token)
        if bar is not None:
            bar.end()

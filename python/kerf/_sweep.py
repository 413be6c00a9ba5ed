"""`sweep` and `in_background`: many variants of a job, and long calls beside an event loop."""

from __future__ import annotations

import contextvars
import html
import itertools
import threading
from typing import Any, Callable, Iterable, TypeVar

from . import _kerf
from ._progress import _Bar

_Result = TypeVar("_Result")


class SweepTable(list[dict[str, Any]]):
    """The rows of a sweep: a dict for each variant, with its parameters and its results.

    A row whose call failed has the exception as ``'error'``. `pandas.DataFrame` takes the table as it is.

    Parameters
    ----------
    rows : iterable of dict, optional
        The rows. Default: none.

    Examples
    --------
    >>> table = kerf.SweepTable([{"d": 3, "seconds": 90.0}, {"d": 6, "seconds": 45.0}])
    >>> table.best("seconds")["d"]
    6
    >>> print(table)
    d  seconds
    3  90
    6  45
    """

    def __init__(self, rows: Iterable[dict[str, Any]] = ()) -> None:
        super().__init__(rows)

    def best(self, name: str) -> dict[str, Any]:
        """The row with the lowest value of a result.

        Parameters
        ----------
        name : str
            The name of the result; rows without it do not count.

        Returns
        -------
        dict
            The row.

        Raises
        ------
        ValueError
            If no row has the result.
        """
        rows = [row for row in self if row.get(name) is not None]
        if not rows:
            raise ValueError(f"no row has a result {name!r}")
        return min(rows, key=lambda row: row[name])

    def _names(self):
        return list(dict.fromkeys(name for row in self for name in row))

    def __str__(self) -> str:
        lines = [self._names(), *([_shown(row.get(name)) for name in self._names()] for row in self)]
        widths = [max(map(len, column)) for column in zip(*lines)]
        return "\n".join(
            "  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines
        )

    def _repr_html_(self) -> str:
        cells = lambda tag, line: "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in line)
        rows = "".join(f"<tr>{cells('td', [_shown(row.get(n)) for n in self._names()])}</tr>" for row in self)
        return f"<table><tr>{cells('th', self._names())}</tr>{rows}</table>"


def _shown(value):
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def sweep(
    make: Callable[..., Any],
    *,
    show: Callable[[str, float], object] | None = None,
    threads: int = 1,
    **values: Iterable[Any],
) -> SweepTable:
    """Call a function with each combination of values, and collect what it returns.

    Parameters
    ----------
    make : callable
        Called with one value of each parameter by name. It returns a dict of results, or one result, which is
        named ``'result'``.
    show : callable, optional
        ``show(text, fraction)`` after each variant. Default: a bar on stderr.
    threads : int
        Count of calls at the same time; long calls of Kerf release the interpreter's lock.
    **values : iterable
        The values of each parameter, by its name.

    Returns
    -------
    SweepTable
        A row for each combination, in the order of `itertools.product`. An exception of Kerf or of the
        function is the ``'error'`` of its row; the others are calculated.

    Raises
    ------
    TypeError
        If a parameter has no list of values.
    ValueError
        If `threads` is below 1.

    Examples
    --------
    >>> def variant(stepover, d):
    ...     program = kerf.op.pocket([(50, 30, 20)], f"square d={d}", depth=2, stepover=stepover, feed=900)
    ...     return {"seconds": kerf.estimate(program)["total"]}
    >>> table = kerf.sweep(variant, stepover=[0.3, 0.6], d=[3, 6], show=lambda text, fraction: None)
    >>> len(table), table.best("seconds")["d"]
    (4, 6)
    """
    import concurrent.futures  # takes longer than all of Kerf to import

    for name, given in values.items():
        if isinstance(given, (str, bytes)) or not hasattr(given, "__iter__"):
            raise TypeError(f"{name} must be a list of values, not {given!r}")
    if threads < 1:
        raise ValueError(f"threads must be at least 1, not {threads}")
    variants = [dict(zip(values, chosen)) for chosen in itertools.product(*map(list, values.values()))]
    bar = _Bar() if show is None else None
    report: Callable[[str, float], object] = show or bar  # type: ignore[assignment]
    table = SweepTable()
    try:
        with concurrent.futures.ThreadPoolExecutor(threads) as pool:
            # Each call has its own context: what `progress` and `decimal` have set.
            running = [
                pool.submit(contextvars.copy_context().run, _row, make, variant) for variant in variants
            ]
            for done, future in enumerate(running, 1):
                table.append(future.result())
                report(f"{done} of {len(variants)}", done / len(variants))
    finally:
        if bar is not None:
            bar.end()
    return table


def _row(make, variant):
    try:
        made = make(**variant)
    except Exception as error:
        return {**variant, "error": error}
    return {**variant, **(made if isinstance(made, dict) else {"result": made})}


class _Stopped(Exception):
    """Stops a call whose task was cancelled."""


async def in_background(function: Callable[..., _Result], *given: Any, **options: Any) -> _Result:
    """Run a long call in a thread, while the event loop continues.

    If the task is cancelled, the call is stopped and leaves nothing.

    Parameters
    ----------
    function : callable
        Such as `kerf.simulate`.
    *given
        Its arguments.
    **options
        Its keyword arguments.

    Returns
    -------
    object
        What the function returns.

    Raises
    ------
    asyncio.CancelledError
        If the task is cancelled.

    Examples
    --------
    >>> import asyncio
    >>> program = kerf.cut("pocket", [(50, 30, 20)], "square d=6", depth=2, feed=900)
    >>> part = asyncio.run(kerf.in_background(kerf.simulate, program))
    >>> part.removed_mm3 > 2400
    True
    """
    import asyncio  # likewise

    stop = threading.Event()
    outer = _kerf._progress.get(None)

    def show(phase: str, fraction: float) -> None:
        if stop.is_set():
            raise _Stopped
        if outer is not None:
            outer(phase, fraction)

    def work() -> _Result:
        _kerf._progress.set(show)
        return function(*given, **options)

    loop = asyncio.get_running_loop()
    task = loop.run_in_executor(None, contextvars.copy_context().run, work)
    try:
        return await asyncio.shield(task)
    except asyncio.CancelledError:
        stop.set()
        await asyncio.wait([task])
        if not task.cancelled():
            task.exception()  # it is not reported as one that was not seen
        raise

"""The page of `kerf view` with a simulated part, as one text of HTML."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import JobResult

_SECONDS = 60  # the page cuts the part again


def page(result: JobResult) -> str:
    """The interactive page with a part: it can be turned, cut open, and played step by step.

    Parameters
    ----------
    result : Simulation, PrintSimulation or RotarySimulation
        Its program is cut again, at the resolution of `kerf view`.

    Returns
    -------
    str
        A file of HTML that loads nothing else. It contains the texts of the program's files.

    Raises
    ------
    FileNotFoundError
        If the command `kerf` was not built with these modules.
    RuntimeError
        If the command fails; the message is its own.

    Examples
    --------
    >>> part = kerf.simulate(kerf.load("part.nc"), "100x60x12")
    >>> with open("part.html", "w", encoding="utf-8") as file:
    ...     length = file.write(kerf.page(part))
    """
    import subprocess
    import tempfile

    import kerf_cam

    command = kerf_cam.command()
    with tempfile.TemporaryDirectory(prefix="kerf-page") as folder:
        program, target = os.path.join(folder, "part.kerf"), os.path.join(folder, "part.html")
        with open(program, "wb") as file:
            file.write(result._program_file())
        done = subprocess.run(
            [command, "view", program, "--export", target], capture_output=True, text=True, timeout=_SECONDS
        )
        if done.returncode or not os.path.exists(target):
            raise RuntimeError(done.stderr.strip() or f"kerf view ended with {done.returncode}")
        with open(target, encoding="utf-8") as file:
            return file.read()

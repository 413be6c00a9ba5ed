"""`Job`: stock, tools, retract plane, feeds and units of one job, and the toolpath that its calls append."""

from __future__ import annotations

import math
import os
import warnings
from typing import Any, Literal, Sequence

from . import _kerf, _operations
from ._cuts import SCALED, Operations
from ._job_tools import JobTools
from ._kerf import Simulation, Stock, Tool, Toolpath
from ._types import AnyProgram, AnyTools, Outline, PathName, Position
from ._units import inch, mm, number, scaled

_RETRACT = {"mm": 5.0, "inch": 0.2}
_FAR = 1e-9  # mm: positions closer than this are equal
_PROGRAMS = (".nc", ".ngc", ".gcode", ".tap", ".cnc")
_DRAWINGS = (".dxf", ".svg")


class Job(Operations):
    """A job with its stock, tools, retract plane, feeds and units.

    Calls append steps to `path`. Coordinates that are not given stay as they are. A ``with`` block ends the
    program: the tool rises to the retract plane, the spindle stops. If the block raises an exception, nothing
    is appended. A job can also be used without ``with``, and ended by `close`. The operations of `kerf.op`
    are methods, which append what they make.

    Parameters
    ----------
    stock : Stock, str or sequence of 3 float or str, optional
        Such as ``"100x60x12 at centre top"``; a size in the units of the job is a block with its zero at the
        lower left corner of its top. Required by `simulate`.
    tools : Tool, str, ToolTable, list of them or dict by number, optional
        As in `kerf.check`; other tools are the built-in ones.
    retract : float or str, optional
        Z of rapids across. Default: 5 mm or 0.2 inch.
    feed, plunge : float or str, optional
        Feeds of cuts, and of cuts straight down (default: half of `feed`), per minute.
    rpm : float or str, optional
        Spindle speed after each tool change; without it the spindle is started by hand.
    units : {'mm', 'inch'}
        Unit of all lengths and feeds of this object, and of the programs that it writes. Texts can have
        another one: ``'1/4in'``, ``'6mm'``, ``'60ipm'``.
    fixtures : list of (str, Stock)
        Bodies that no tool may touch, for `check`.
    machine : str or os.PathLike, optional
        A profile (TOML), or GRBL's ``$$`` settings, for `check` and `estimate`.
    material : str, optional
        For `check`: ``'plywood'``, ``'aluminium'`` ...; and for feeds of operations where the job has none.
    spoilboard : float or str
        Thickness of the board below the stock that may be cut into.

    Raises
    ------
    ValueError, TypeError
        By all methods, for wrong values and types; the message names the argument.
    kerf.Error
        If stock or tools are invalid.

    Examples
    --------
    >>> with kerf.Job((100, 60, 12), retract=5, feed=900, rpm=16000) as job:
    ...     job.tool(102)
    ...     job.move_to(10, 10)
    ...     job.cut(z=-3)
    ...     job.cut(x=90)
    >>> job.simulate().save("part.png")
    >>> job.post("grbl", "part.nc")
    ['part.nc']

    >>> tools = ["1=square d=6mm", "2=V d=12 angle=60"]
    >>> with kerf.Job((100, 60, 12), tools=tools, feed=900, rpm=16000) as job:
    ...     job.pocket([(50, 30, 20)], depth=6, stepdown=2, tool="6mm")
    ...     job.contour([[(5, 5), (95, 5), (95, 55), (5, 55), (5, 5)]], depth=12, stepdown=3)
    ...     job.v_carve([(15, 15, 4), (85, 15, 4)], tool=2)
    >>> job.save("part.nc", "part.png", post="grbl")
    """

    def __init__(
        self,
        stock: Stock | str | Position | None = None,
        *,
        tools: AnyTools | None = None,
        retract: float | str | None = None,
        feed: float | str | None = None,
        plunge: float | str | None = None,
        rpm: float | str | None = None,
        units: Literal["mm", "inch"] = "mm",
        fixtures: Sequence[tuple[str, Stock]] = (),
        machine: PathName | None = None,
        material: str | None = None,
        spoilboard: float | str = 0.0,
    ) -> None:
        if units not in ("mm", "inch"):
            raise ValueError(f"units must be 'mm' or 'inch', not {units!r}")
        self.units = units
        self._scale = inch if units == "inch" else mm
        self._tools, self.fixtures = JobTools(tools, units), list(fixtures)
        self.machine, self.material = machine, material
        self.stock = self._to_stock(stock)
        self.spoilboard = self._length(spoilboard, "spoilboard")
        self.retract_plane = self._length(_RETRACT[units] if retract is None else retract, "retract")
        self.feed: float | None = None
        self.plunge: float | None = None
        self.rpm: float | None = None
        self._set_feeds(feed, plunge, rpm)
        self.path = Toolpath()
        self._ended = False
        self._seen = 0  # steps of `path` that `_at` takes into account
        self._at = [None, None, None]  # mm; None: not commanded yet

    def _length(self, value, name, low=-math.inf):
        """A length in the units of the job."""
        return number(value, name, low, self.units)

    def _set_feeds(self, feed, plunge, rpm):
        if feed is not None:
            self.feed = self._length_per_minute(feed, "feed")
        if plunge is not None:
            self.plunge = self._length_per_minute(plunge, "plunge")
        if rpm is not None:
            self.rpm = number(rpm, "rpm", 0, "rpm")

    def _length_per_minute(self, value, name):
        return number(value, name, 0, self.units + "/min")

    def _to_stock(self, stock):
        if stock is None or isinstance(stock, Stock):
            return stock
        if isinstance(stock, str):
            return _kerf._stock_of_text(stock)
        size = [self._length(v, "stock", 0) * self._scale for v in stock]
        if len(size) != 3:
            raise ValueError("stock must have three sizes")
        return Stock.block(size)

    # ---- start and end

    def __enter__(self) -> Job:
        return self

    def __exit__(self, kind: Any, value: Any, traceback: Any) -> Literal[False]:
        if kind is None:
            self.close()
        return False

    def close(self) -> None:
        """End the program: retract, stop the spindle. Further motions are errors."""
        if self._ended:
            return
        if len(self.path):
            self.retract()
            self.path.end()
        self._ended = True
        if "KERF_VIEW_PROGRAM" in os.environ:
            from . import _view

            _view.note(self.path, stock=self.stock, tools=self._tools.all(), fixtures=self.fixtures or None)

    def _open(self):
        if self._ended:
            raise ValueError("the job has ended: no steps can be appended")

    @property
    def tools(self) -> AnyTools | None:
        """Tool, str, ToolTable or list of them: those that the job was given."""
        return self._tools.given

    @tools.setter
    def tools(self, tools: AnyTools | None) -> None:
        self._tools.given = tools

    # ---- positions

    def _position(self):
        """The position after the last motion of `path`, mm; None where it is unknown."""
        count = len(self.path)
        for i in range(count - 1, self._seen - 1, -1):
            step = self.path[i]
            if "to" in step:
                unknown = step.get("unknown_axes", [])
                self._at = [None if "XYZ"[k] in unknown else step["to"][k] for k in range(3)]
                break
        self._seen = count
        return self._at

    @property
    def position(self) -> tuple[float | None, ...]:
        """tuple: X, Y and Z in the units of the job; None where no motion has commanded it."""
        return tuple(None if v is None else v / self._scale for v in self._position())

    def _end_point(self, x, y, z):
        at = self._position()
        end = []
        for axis, value, here in zip("xyz", (x, y, z), at):
            if value is None and here is None:
                raise ValueError(f"{axis} is required: no motion has commanded it yet")
            end.append(here if value is None else self._length(value, axis) * self._scale)
        return at, tuple(end)

    def _moved(self, end):
        self._at, self._seen = list(end), len(self.path)

    def _feed_to(self, end, feed):
        at = self._at
        down = end[2] < at[2] - _FAR and math.hypot(end[0] - at[0], end[1] - at[1]) <= _FAR
        value = feed
        if value is None and down:
            value = self.plunge if self.plunge is not None or self.feed is None else self.feed / 2
        if value is None:
            value = self.feed
        if value is None:
            raise ValueError("feed is required: neither the call nor the job has one")
        return self._length_per_minute(value, "feed") * self._scale

    # ---- steps

    def tool(
        self,
        number: int | str | Tool,
        *,
        rpm: float | str | None = None,
        feed: float | str | None = None,
        plunge: float | str | None = None,
    ) -> None:
        """Retract, change to a tool, and start the spindle.

        Parameters
        ----------
        number : int, str or Tool
            A number; the diameter, description or name of a tool of the job, such as ``'6mm'``; or a tool
            such as ``'square d=6'``, which has its own number or the next free one.
        rpm, feed, plunge : float or str, optional
            Replace those of the job from here on.
        """
        self._open()
        self.retract()
        self._set_feeds(feed, plunge, rpm)
        if not isinstance(number, int):
            tool = self._tools.tool_of(number, "number")
            self._tools.add({tool.number: tool})
            number = tool.number
        self.path.tool(number)
        if self.rpm is not None:
            self.path.spindle(self.rpm)

    def retract(self) -> None:
        """Rise to the retract plane; nothing if the tool is there or higher, or has not moved yet."""
        self._open()
        x, y, z = self._position()
        plane = self.retract_plane * self._scale
        if z is not None and z < plane - _FAR:
            if x is None or y is None:
                self.path.rapid((x or 0.0, y or 0.0, plane), unknown="XY")
            else:
                self.path.rapid((x, y, plane))
                self._moved((x, y, plane))

    def rapid(
        self, x: float | str | None = None, y: float | str | None = None, z: float | str | None = None
    ) -> None:
        """Append a rapid straight to a position.

        Parameters
        ----------
        x, y, z : float or str, optional
            End point; those not given stay.
        """
        self._open()
        _, end = self._end_point(x, y, z)
        self.path.rapid(end)
        self._moved(end)

    def move_to(self, x: float | str, y: float | str) -> None:
        """Rise to the retract plane and append a rapid across.

        Parameters
        ----------
        x, y : float or str
            End point.
        """
        self._open()
        x, y = self._length(x, "x") * self._scale, self._length(y, "y") * self._scale
        self.retract()
        z = self._position()[2]
        if z is None:  # the first motion: up before across
            z = self.retract_plane * self._scale
            self.path.rapid((0.0, 0.0, z), unknown="XY")
        end = (x, y, z)
        self.path.rapid(end)
        self._moved(end)

    def cut(
        self,
        x: float | str | None = None,
        y: float | str | None = None,
        z: float | str | None = None,
        *,
        feed: float | str | None = None,
    ) -> None:
        """Append a straight cut.

        Parameters
        ----------
        x, y, z : float or str, optional
            End point; those not given stay.
        feed : float or str, optional
            Default: `plunge` straight down, else `feed` of the job.

        Raises
        ------
        ValueError
            If the position before the cut is unknown, or the job has no such feed.

        Examples
        --------
        >>> with kerf.Job((100, 60, 12), retract=5, feed=900, rpm=16000) as job:
        ...     job.tool("square d=6")
        ...     job.move_to(10, 10)
        ...     job.cut(z=-3)
        ...     job.cut(x=90, feed=600)
        >>> [step["to"] for step in job.path if step["step"] == "cut"]
        [(10.0, 10.0, -3.0), (90.0, 10.0, -3.0)]
        """
        self._open()
        _, end = self._end_point(x, y, z)
        if None in self._at:
            raise ValueError("a motion to a known position must precede the first cut")
        self.path.cut(end, self._feed_to(end, feed))
        self._moved(end)

    def arc(
        self,
        x: float | str | None = None,
        y: float | str | None = None,
        z: float | str | None = None,
        *,
        centre: Position,
        turn: Literal["cw", "ccw"] = "ccw",
        feed: float | str | None = None,
    ) -> None:
        """Append an arc or helix in the XY plane.

        Parameters
        ----------
        x, y, z : float or str, optional
            End point; those not given stay.
        centre : (float or str, float or str)
            Centre of the arc.
        turn : {'cw', 'ccw'}
            Direction, seen from above.
        feed : float or str, optional
            Default: `feed` of the job.

        Raises
        ------
        ValueError
            If the position before the arc is unknown, `centre` is no pair or not equally far from
            both ends, or the job has no feed.
        """
        self._open()
        _, end = self._end_point(x, y, z)
        if None in self._at:
            raise ValueError("a motion to a known position must precede the first arc")
        if len(centre) != 2:
            raise ValueError("centre must have two coordinates")
        about = tuple(self._length(v, "centre") * self._scale for v in centre)
        self.path.arc(end, about, turn, self._feed_to((*end[:2], math.inf), feed))
        self._moved(end)

    def follow(self, outline: Outline, z: float | str, *, feed: float | str | None = None) -> None:
        """Move to the start of an outline, plunge to `z` and cut along it.

        Parameters
        ----------
        outline : list
            As of `kerf.Region`: a point, then points and arcs (via x, via y, x, y); or a circle (x, y,
            radius). In the units of the job.
        z : float or str
            Z of the cut, in the units of the job.
        feed : float or str, optional
            Feed of the cuts along the outline.
        """
        if len(outline) == 3 and not hasattr(outline[0], "__len__"):
            x, y, r = (self._length(v, "outline") for v in outline)
            outline = [(x + r, y), (x, y + r, x - r, y), (x, y - r, x + r, y)]
        self.move_to(*outline[0])
        self.cut(z=z)
        here = outline[0]
        for element in outline[1:]:
            if len(element) == 2:
                self.cut(*element, feed=feed)
            else:
                centre, turn = _circle_through(here, element[:2], element[2:])
                if centre is None:
                    self.cut(*element[2:], feed=feed)
                else:
                    self.arc(*element[2:], centre=centre, turn=turn, feed=feed)
            here = element[-2:]

    def add(self, program: AnyProgram) -> None:
        """Append a program, such as one of `kerf.op`, with its tools.

        The tool first rises to the retract plane, and then as `kerf.Toolpath.append` says.

        Parameters
        ----------
        program : Program or Toolpath
            In mm, whatever the units of the job.

        Raises
        ------
        ValueError
            If a tool of the program has the number of another tool of the job.
        """
        self._open()
        self._tools.add(getattr(program, "tools", {}))
        self.retract()
        self.path.append(program)
        self._at, self._seen = [None, None, None], 0

    def _add(self, op: str, *, shapes: Any = None, tool: Any = None, **options: Any) -> None:
        self._open()
        factor = self._scale
        self._resolve_depth(options)
        for key, per_minute in SCALED.items():
            if options.get(key) is not None and factor != mm:
                options[key] = scaled(options[key], factor, key, self.units + ("/min" if per_minute else ""))
        self._complete(options)
        for key in _operations.OTHER_TOOLS:
            if options.get(key) is not None:
                options[key] = self._tools.tool_of(options[key], key)
        if not op.startswith("laser"):
            options["tool"] = self._tools.tool_of(self._in_use() if tool is None else tool)
        if options.get("points") is not None:
            options["points"] = scaled(options["points"], factor)
        given = {key: value for key, value in options.items() if value is not None}
        self.add(_operations.run(op, None if shapes is None else scaled(shapes, factor), **given))

    def _resolve_depth(self, options):
        """Replaces the depth "through", or "through 0.5mm", by a length in the units of the job."""
        depth = options.get("depth")
        word, _, beyond = depth.strip().partition(" ") if isinstance(depth, str) else ("", "", "")
        if word != "through":
            return
        if self.stock is None:
            raise ValueError("depth='through' needs the stock, and the job has none")
        top = self._length(options.get("top") or 0.0, "top")
        further = self._length(beyond, "depth") if beyond else 0.0
        if further < 0:
            raise ValueError(f"depth='{depth}' must be 'through', and 0 or more below the stock")
        options["depth"] = top - self.stock.low[2] / self._scale + further
        if not options["depth"] > 0:
            raise ValueError(f"depth='{depth}' needs a top above the bottom of the stock, not {top:g}")
        if "depth_of" in options and options["depth_of"] is None:
            options["depth_of"] = "diameter"  # of a drill: the hole is whole at the bottom

    def _complete(self, options):
        """Adds what the job states of feeds, speed and heights to the options of an operation, in mm."""
        job = {"retract": self.retract_plane * self._scale, "rpm": self.rpm}
        if options["feed"] is None and options.get("material") is None and self.feed is not None:
            job["feed"] = self.feed * self._scale
        elif options["feed"] is None:
            job["material"], job["machine"] = self.material, self.machine
        if self.plunge is not None:
            job["plunge"] = self.plunge * self._scale
        for key, value in job.items():
            if key in options and options[key] is None:
                options[key] = value

    def _in_use(self):
        """The number of the tool that the last step has."""
        number = int(self.path.columns()["tool"][-1]) if len(self.path) else -1
        if number < 0:
            raise TypeError("tool is missing, as in tool='square d=6': the job has none in use yet")
        return number

    def note(self, text: str) -> None:
        """Append a comment.

        Parameters
        ----------
        text : str
            One line.
        """
        self._open()
        self.path.note(text)

    # ---- results

    def simulate(self, resolution: float = 0.0, threads: int = 0) -> Simulation:
        """Cut the toolpath out of the stock.

        Parameters
        ----------
        resolution : float
            As of `kerf.simulate`, mm.
        threads : int
            As of `kerf.simulate`.

        Returns
        -------
        Simulation
            The part, with its hazards and volumes.

        Raises
        ------
        ValueError
            The job has no stock.
        kerf.Error
            The simulation is impossible.
        """
        if self.stock is None:
            raise ValueError("stock is required for a simulation")
        tools = self._tools.all()
        board = self.spoilboard * self._scale
        return _kerf.simulate(
            self.path,
            self.stock,
            tools,
            resolution,
            threads,
            fixtures=self.fixtures,
            spoilboard=board,
            machine=self.machine,
        )

    def check(self) -> list[dict[str, Any]]:
        """Check for hazards to tool, part and machine.

        Returns
        -------
        list of dict
            As of `kerf.check`.
        """
        return _kerf.check(
            self.path,
            tools=self._tools.all(),
            stock=self.stock,
            fixtures=self.fixtures,
            machine=self.machine,
            material=self.material,
            spoilboard=self.spoilboard * self._scale,
        )

    def estimate(self) -> dict[str, Any]:
        """Estimate the machining time.

        Returns
        -------
        dict
            As of `kerf.estimate`.
        """
        return _kerf.estimate(self.path, machine=self.machine)

    def post(self, to: str, path: PathName | None = None, **options: Any) -> str | list[str]:
        """Write the program for a controller or as a drawing.

        Parameters
        ----------
        to : str
            As of `kerf.post`.
        path : str or os.PathLike, optional
            The file to write.
        **options
            As of `kerf.post`.

        Returns
        -------
        str or list of str
            As of `kerf.post`.
        """
        from . import post

        program = _kerf._program_with(
            self.path,
            stock=self.stock,
            tools=self._tools.all(),
            fixtures=self.fixtures,
            spoilboard=self.spoilboard * self._scale,
        )
        return post(program, to, path, **{"unit": self.units, **options})

    def save(self, *paths: PathName, post: str = "grbl", resolution: float = 0.0, **view: Any) -> None:
        """Write files by their endings.

        Parameters
        ----------
        *paths : str or os.PathLike
            Programs (.nc .ngc .gcode .tap .cnc), drawings of the path (.dxf .svg), and what
            `kerf.Simulation.save` writes (.stl .3mf .glb .obj .png .kstock).
        post : str
            The controller of programs, see `kerf.posts`.
        resolution : float
            Resolution of the simulation, mm; 0: by the size of the stock.
        **view
            As of `kerf.Simulation.save`.
        """
        if "to" in view:  # as it was called in version 0.2
            warnings.warn("to is called post: job.save(..., post=...)", DeprecationWarning, stacklevel=2)
            post = view.pop("to")
        parts = []
        for name in map(os.fsdecode, paths):
            ending = os.path.splitext(name)[1].lower()
            if ending in _PROGRAMS:
                self.post(post, name)
            elif ending in _DRAWINGS:
                self.post(ending[1:], name, unit="mm")
            else:
                parts.append(name)
        if parts:
            self.simulate(resolution).save(*parts, **view)

    def __repr__(self) -> str:
        return f"<kerf.Job: {len(self.path)} steps{', ended' if self._ended else ''}>"

    def _repr_html_(self) -> str:
        from ._notebook import job_html

        return job_html(self)

    def _result(self):
        """The simulation for a notebook; None without stock or steps."""
        if self.stock is None or not len(self.path):
            return None
        return self.simulate()


def _circle_through(a, via, b):
    """Centre and direction of the arc through three points; (None, None) on a line."""
    ax, ay, bx, by = via[0] - a[0], via[1] - a[1], b[0] - a[0], b[1] - a[1]
    cross = ax * by - ay * bx
    if abs(cross) <= 1e-12 * max(math.hypot(ax, ay) * math.hypot(bx, by), 1e-300):
        return None, None
    p, q = ax * ax + ay * ay, bx * bx + by * by
    x, y = (by * p - ay * q) / (2 * cross), (ax * q - bx * p) / (2 * cross)
    return (a[0] + x, a[1] + y), "ccw" if cross > 0 else "cw"

"""How results show themselves in notebooks: pictures as PNG and SVG, figures as HTML tables."""

import base64
import html
import math

_SIZE = (720, 450)  # pixels of pictures
_FINDINGS = 10  # rows of hazards shown
_LARGEST_PAGE = 6_000_000  # characters; notebooks keep what they show


def _table(rows):
    cells = "".join(f"<tr><th>{html.escape(k)}</th><td>{html.escape(v)}</td></tr>" for k, v in rows)
    return f"<table>{cells}</table>"


def _image(png):
    data = base64.b64encode(png).decode("ascii")
    return f'<img width="{_SIZE[0]}" height="{_SIZE[1]}" src="data:image/png;base64,{data}"/>'


def _frame(result):
    """The page of `kerf view` in a frame; "" where the command is missing, or the page is too large."""
    import subprocess

    from ._page import page

    try:
        text = page(result)
    except (OSError, RuntimeError, subprocess.SubprocessError):
        return ""
    if len(text) > _LARGEST_PAGE:
        return ""
    style = "position:absolute;left:0;top:0;border:0;background:white"
    return (
        f'<iframe style="{style}" width="{_SIZE[0]}" height="{_SIZE[1]}" title="the part" '
        f'sandbox="allow-scripts allow-downloads" srcdoc="{html.escape(text)}"></iframe>'
    )


def _shown(result):
    """The picture, and over it the page where scripts run."""
    frame = _frame(result)
    image = _image(result_png(result))
    if not frame:
        return image
    # Without scripts the frame shows the picture; a viewer that removes frames leaves the one below.
    plain = html.escape(f"<body><noscript>{image}</noscript>")
    frame = frame.replace("&lt;body&gt;", plain, 1)
    return f'<div style="position:relative;width:{_SIZE[0]}px;height:{_SIZE[1]}px">{image}{frame}</div>'


def _location(origin):
    """A file with its line, as messages have it; "" where there is none."""
    if origin is None:
        return ""
    where = f":{origin['line']}" if "line" in origin else f": {origin['handle']}"
    return origin["file"] + where


def _hazards(hazards):
    if not hazards:
        return ""
    rows = "".join(
        "<tr>"
        + "".join(
            f"<td>{html.escape(str(v))}</td>"
            for v in (_location(h["origin"]), h["kind"].replace("_", " "), f"{h['depth_mm']:.2f} mm")
        )
        + "</tr>"
        for h in hazards[:_FINDINGS]
    )
    more = f"<p>and {len(hazards) - _FINDINGS} more</p>" if len(hazards) > _FINDINGS else ""
    return f"<table><tr><th>origin</th><th>hazard</th><th>depth</th></tr>{rows}</table>{more}"


def result_png(result):
    """The part as a PNG, of the size of a notebook's column."""
    return result.picture(size=_SIZE)


def result_html(result):
    """Volumes, hazards and the picture of a simulation."""
    rows = []
    for name, title in (("stock_mm3", "stock"), ("removed_mm3", "removed"), ("left_mm3", "left")):
        value = getattr(result, name, None)
        if value is not None:
            rows.append((title, f"{value:,.1f} mm³"))
    hazards = getattr(result, "hazards", [])
    rows.append(("hazards", str(len(hazards))))
    return f"<div>{_table(rows)}{_hazards(hazards)}{_shown(result)}</div>"


def path_html(path):
    """The figures of a toolpath."""
    report = path.report()
    rows = [("steps", str(len(path)))]
    for name, title in (("cut_mm", "cuts"), ("rapid_mm", "rapids")):
        rows.append((title, f"{report[name]:,.1f} mm"))
    bounds = report.get("cut_bounds_mm")
    if bounds:
        for axis in range(3):
            rows.append(("XYZ"[axis], f"{bounds[0][axis]:.3f} to {bounds[1][axis]:.3f} mm"))
    return _table(rows)


def program_html(program):
    """The figures of a program's toolpath."""
    return path_html(program.toolpath)


def program_svg(program):
    """The toolpath of a program from above; None without motions."""
    return path_svg(program.toolpath)


def path_svg(path):
    """The toolpath from above; None without motions."""
    from . import Error, post

    try:
        return post(path, "svg")
    except Error:
        return None


def region_svg(region):
    """The outlines of a region; None if it is empty."""
    from ._kerf import DrawingWriter, segments

    if not region.outlines:
        return None
    writer = DrawingWriter()
    writer.layer("region")
    for outline in region.outlines:
        vertices = [(*part["start"], _bulge(part)) for part in segments(outline)]
        writer.polyline("region", vertices, True)
    return writer.svg()


def _bulge(part):
    if part["kind"] != "arc":
        return 0.0
    bulge = math.tan(math.radians(abs(part["sweep"])) / 4)
    return bulge if part["turn"] == "ccw" else -bulge


def job_html(job):
    """The figures of a job, and the part if it has stock."""
    result = job._result()
    return path_html(job.path) + (result_html(result) if result is not None else "")


def install(results, toolpath, program, region):
    """Gives the compiled classes the methods that notebooks call."""
    for cls in results:
        cls._repr_png_ = result_png
        cls._repr_html_ = result_html
    toolpath._repr_html_ = path_html
    toolpath._repr_svg_ = path_svg
    program._repr_html_ = program_html
    program._repr_svg_ = program_svg
    region._repr_svg_ = region_svg

"""Correct user code, which `mypy --strict` accepts: tests/python/test_typing.py."""

from __future__ import annotations

import os
import pathlib
from typing import Iterable

import gcodepreview
import kerf

PLATE = [(0.0, 0.0), (60.0, 0.0), (60.0, 40.0), (0.0, 40.0), (0.0, 0.0)]


def plate(hole: float = 8) -> kerf.Region:
    """A plate with a hole, as outlines: lists of points, and a circle."""
    region = kerf.Region([PLATE, (30, 20, hole)])
    region = region | kerf.Region([[(0, 0), (5, 5, 10, 0), (0, 0)]], fill="even_odd")
    grown = region.offset(2, join="mitre", mitre_limit=3)
    low_x, low_y, high_x, high_y = grown.bounds or (0.0, 0.0, 0.0, 0.0)
    assert high_x > low_x and high_y > low_y and grown.area > 0
    for outline in grown.outlines:
        print(len(outline), outline[0])
    return region & grown - kerf.widen([(0, 0), (10, 0)], 1, ends="butt") ^ kerf.Region()


def motions() -> kerf.Toolpath:
    """Each kind of step."""
    path = kerf.Toolpath()
    path.tool(102)
    path.spindle(16000, "cw")
    path.coolant(flood=True)
    path.path_mode("blend", tolerance=0.05)
    path.rapid((0, 0, 5))
    path.rapid([1, 2, 5], rotary=(0, 0, 90))
    path.cut((0, 0, -1), feed=100)
    path.arc((20, 0, -1), centre=(10, 0), turn="cw", feed=400, plane="XY", extra_turns=1)
    path.probe((0, 0, -5), 50, until="contact")
    path.dwell(1.5)
    path.extrude((30, 0, 1), 900, volume=2.5, width=0.5, height=0.2, kind="infill")
    path.temperature("nozzle", 210, wait=True)
    path.fan(0.5, 1)
    path.laser(100, "dynamic")
    path.layer("base", colour=3)
    path.motion_limits("acceleration", beads=500.0)
    path.note("a note")
    path.verbatim("M8")
    path.pause("optional")
    path.close_path()
    path.end(rewind=True)
    part = path[1:4] + path[4:]
    first = path[0]
    print(first["step"], len(part), part == path, path.columns()["x"])
    return part


def operations(tool: kerf.Tool | str) -> kerf.Program:
    """Operations of kerf.op, and changes."""
    pocket = kerf.op.pocket(plate(), tool, depth=4, stepdown=2, feed=900, rpm=8000)
    holes = kerf.op.drill([(8, 8), (52, 32)], kerf.Tool("drill d=4", number=2), depth=6, feed=100)
    contour = kerf.op.contour(plate(), tool, depth=6, stepdown=2, feed=900, side="outside")
    program = kerf.op.join(pocket, holes, contour)
    program = kerf.op.add_tabs(program, 1.5, count=3, shape="triangular")
    program = kerf.op.step_down(program, 2, entry="ramp", entry_angle=5)
    program = kerf.op.transform(program, mirror="x", rotate=90, move=(10, 0))
    program = kerf.op.repeat(program, 2, 2, pitch=(80, 60))
    word = kerf.op.text_outlines("KERF", 12, font="sans", at=(10, 10), align="centre")
    sign = kerf.op.engrave(word, "V d=6 angle=60", depth=0.4, feed=600)
    return kerf.op.order(kerf.op.join(program, sign), tools=[kerf.Tool("square d=6")])


def job(folder: pathlib.Path) -> str | list[str]:
    """A job with its stock."""
    with kerf.Job((100, 60, 12), retract=5, feed=900, plunge=300, rpm=16000, units="mm") as made:
        made.tool(102, feed=800)
        made.move_to(10, 10)
        made.cut(z=-3)
        made.cut(x=90, feed=500)
        made.arc(y=30, centre=(90, 20), turn="ccw")
        made.follow((50, 30, 8), z=-2)
        made.add(operations("square d=6"))
        made.note("done")
    x, y, z = made.position
    print(x, y, z, made.estimate()["total"], [finding["message"] for finding in made.check()])
    made.simulate(resolution=0.5).save(os.fspath(folder / "part.png"))
    return made.post("grbl", folder / "part.nc")


def workshop(folder: pathlib.Path) -> list[str]:
    """Operations as methods of a job, lengths with units."""
    tools: list[kerf.Tool | str] = ["1=square d=6mm flute=20", kerf.Tool("drill d=4", number=2)]
    with kerf.Job(("4in", 60, 12), tools=tools, feed="60ipm", plunge=300, material="plywood") as made:
        made.pocket(plate(), depth="1/4in", stepdown=0.1 * kerf.inch, tool="6mm", direction="climb")
        made.drill([(8, 8), (52, 32)], tool=2, depth=6 * kerf.mm, cycle="peck", peck=2)
        made.contour(plate(), "square d=3", depth=6, side="outside", tabs=3, tab_height=1.5)
        made.tool("6mm", rpm="16krpm")
        made.face([PLATE], depth=0.5, rpm=12000, name="top")
    made.tools = kerf.built_in_tools()
    made.save(folder / "part.nc", folder / "part.png", post="linuxcnc", resolution=0.5)
    return [finding["message"] for finding in made.check()]


def results(file: pathlib.Path, tools: Iterable[str]) -> float:
    """Files, checks, simulation."""
    program = kerf.load(file, dialect="grbl", strict=True, include_paths=["."])
    table = kerf.load_tools(*tools, unit="inch", first=10)
    table[3] = kerf.Tool.make("square", number=3, diameter=6, flute=20)
    stock = kerf.Stock.block((100, 60, 12), zero="centre", zero_height="top")
    part = kerf.simulate(program, stock, table, resolution=0.2, fixtures=[("clamp", stock)])
    for hazard in part.hazards:
        print(hazard["kind"], hazard["origin"])
    for finding in kerf.check(program, tools=table, stock="100x60x12", material="plywood"):
        print(finding["message"])
    png: bytes = part.picture(view="iso", size=(800, 500), section="y=30", colour="speed")
    mesh: bytes = part.mesh_file("stl", detail="columns")
    second = kerf.move_stock(kerf.left_stock(part), flip="x", shift=(0, 0, 1))
    print(len(png), len(mesh), second.low[2], program.tools, program.stock, program.files)
    text = kerf.post(program, "grbl", unit="mm", tool_change="pause", tools=table, variables={"name": "x"})
    kerf.post(program, to="dxf", path="plan.dxf", dxf_version="r12", rapids=True)
    print(text, kerf.posts(), sorted(kerf.built_in_tools().numbers())[0])
    return part.removed_mm3 + part.left_mm3


def drawings(file: str) -> kerf.Region:
    """Drawings as regions."""
    drawing = kerf.load_drawing(file)
    outlines = drawing.outlines(["cut", "engrave"], unit="mm", strokes="lines")
    print(len(outlines), outlines.names, drawing.version.lower())
    return drawing.region("cut", combine="nested")


def guarded(text: str) -> kerf.Toolpath | None:
    """Errors with their diagnostics, and a bar of progress."""
    try:
        with kerf.progress():
            return kerf.read_gcode(text, name="part.nc")
    except kerf.Error as error:
        for diagnostic in error.diagnostics:
            print(diagnostic.severity, diagnostic.code, diagnostic.line or 0, diagnostic.message.upper())
        return None


def prints() -> kerf.PrintSimulation:
    """A print by calls."""
    printer = kerf.Printer(width=0.5, height=0.2, speed=1800, seam="rear")
    printer.start(nozzle=210, bed=60)
    z: float = printer.next_layer()
    printer.fill(plate(), pattern="zigzag", angle=45, density=0.3)
    printer.finish()
    print(z, printer.printed_mm3, len(printer.path))
    return kerf.simulate_print(printer.path, layer_height=0.2)


def machine() -> gcodepreview.Result:
    """Commands of gcodepreview."""
    gcp = gcodepreview.gcodepreview("cut", True, True)
    gcp.opengcodefile("part")
    gcp.setupstock(100, 60, 12.7, "Top", "Lower-Left", 9)
    gcp.setfeeds(plunge=100, feed=300, small_square=0.5)
    gcp.movetosafeZ()
    gcp.toolchange(102, 16000)
    gcp.rapid(10, 10, 5)
    gcp.cutline(10, 10, -3)
    gcp.cutpocket(gcodepreview.shapes.circle(20, 20, 8), 0, -2)
    gcp.closegcodefile()
    for move in gcp.toolpaths:
        print(move.kind, move.end[2])
    result = gcp.simulate()
    print(gcp.gcode("grbl").splitlines()[0], result.report().upper(), gcp.diameter + 1)
    return result

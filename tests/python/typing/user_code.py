"""Correct user code, which type checkers accept: tests/python/test_typing.py."""

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


def questions(region: kerf.Region) -> list[float]:
    """What a region answers, and how it is changed."""
    figures: list[float] = [region.area, region.length]
    for figure in region.figures():
        figures.append(float(len(figure)))
    if region.locate((1.0, 2.0)) == "inside" and (clearance := region.clearance((1, 2))) is not None:
        figures.append(clearance)
    for start, sweep in region.inside((1, 2, 3)):
        figures.append(start + sweep)
    figures += [found[2] for found in region.nearest([(1, 2), (3, 4)]) if found is not None]
    nodes, edges = region.medial_axis()
    figures += [node[2] for node in nodes] + [points[0][0] for _, _, points in edges]
    for location, piece, first in region.divide([(0, 0), (50, 50)]):
        print(location.upper(), piece[0][0], first + 1)
    placed = region.moved(10, 0).rotated(90, about=(5, 5)).scaled((1, -1)).scaled(2)
    apart = region.distance(placed)
    if placed != region and apart is not None and apart[0] > 1:
        figures.append(apart[1][0])
    dog_bones = kerf.relieve_corners(placed, 6, "dog-bone")
    slots = kerf.finger_slots(60, 6, 5, first=True, fit=0.1)
    print(repr(dog_bones), slots.bounds, region.__geo_interface__["type"])
    for part in kerf.segments(region.outlines[0]):
        print(part["kind"], part["start"])
    rounded = kerf.fit_arcs([(0, 0), (1, 0.1), (2, 0)], 0.2)
    print(len(rounded), kerf.flattened(rounded, 0.01)[0][0])
    return figures


def workpieces(tools: kerf.ToolTable) -> kerf.Stock:
    """Tools, tables and stock."""
    mill = kerf.Tool("square d=1/4in", number=7)
    ball = kerf.Tool.make("ball", number=8, diameter=3, flute=12)
    tools[mill.number] = mill
    tools[8] = ball
    if 8 in tools and tools[8].diameter == ball.diameter_at(1.5):
        print(mill.shape, mill.flute, mill.teeth, mill.plunges, mill.names, [n for n in tools.numbers()])
    found = tools.find("Amana 46200-K")
    if found is not None:
        print(found.description.upper())
    for row in kerf.tool_shapes():
        print(row["name"])
    stock = kerf.Stock.block((4 * kerf.inch, 60, 12), zero="centre", zero_height="bottom")
    print(stock.low[0], stock.high[2], {mill: 1, ball: 2}[mill])
    return kerf.move_stock(stock, shift=(0, 0, 12))


def live(program: kerf.Program) -> float:
    """A part that is cut again where an edit has changed it."""
    simulation = kerf.LiveSimulation(stock="100x60x12", resolution=0.5)
    changed = simulation.update(program)
    print(changed["columns"], simulation.removed_mm3)
    surface = simulation.heights(steps=5)
    print(surface.shape)
    return simulation.removed_mm3


def laser() -> kerf.Burn:
    """Cuts and pictures of lasers, and what they burn."""
    picture = kerf.op.laser_picture(["0990", "9009"], width=8, at=(20, 16), power=40, feed=3000)
    outside = kerf.op.laser_cut(kerf.Region([(24, 18, 12)]), power=90, feed="300 mm/min", kerf=0.15)
    burnt = kerf.burn(kerf.op.join(picture, outside), beam=0.2, power=10)
    energy: float = burnt.at((24, 18)) + burnt.highest_j_mm2
    print(energy, burnt.map.shape, burnt.picture(size=(400, 300))[:4])
    return burnt


def rotary() -> kerf.RotarySimulation:
    """A bar that a fourth axis turns."""
    bar = kerf.Toolpath()
    bar.tool(102)
    bar.spindle(12000, turn="cw")
    bar.rapid((10, 0, 30), rotary=(0, 0, 0))
    bar.cut((10, 0, 18), feed=300)
    bar.cut((10, 0, 18), feed=2000, rotary=(360, 0, 0))
    return kerf.simulate_rotary(bar, diameter=40, x=(0, 60))


def drawn(file: str) -> bytes:
    """A drawing that is written, and read again."""
    writer = kerf.DrawingWriter()
    writer.layer("CUT", colour=5)
    writer.line("CUT", 0, 0, 10, 0)
    writer.arc("CUT", 10, 5, 5, -90, 90)
    writer.circle("CUT", 20, 20, 8)
    writer.polyline("CUT", [(0, 0), (10, 0), (10, 5, 0.5)], True)
    print(writer.svg(title="plate").splitlines()[0])
    ring = kerf.read_drawing(writer.dxf("r12"), file).region("CUT").offset(3)
    print(ring.area)
    return writer.dxf()


def surfaces() -> list[list[tuple[float, float, float]]]:
    """A smooth surface, and the positions of a tool on it."""
    heights = [[0.0, 1.0, 1.0, 0.0]] * 4
    surface = kerf.BezierSurface((0, 0), 60, 40, heights)
    top: float = surface(30, 20)
    rows = kerf.surface_rows(surface, kerf.Tool("ball d=6"), (0, 0), (60, 40), stepover=0.2)
    hill = kerf.surface_rows(lambda x, y: top - x * y / 1000, kerf.Tool("ball d=6"), (0, 0), (60, 40))
    return rows + hill


def measured(program: kerf.Program) -> kerf.Program:
    """Heights that are probed, and a program that follows them."""
    probing = kerf.op.probing(program, 5, 5, margin="1/4in", clearance=5, depth=2, feed=50)
    print(kerf.post(probing, "grbl"))
    levelled, figures = kerf.op.level(program, [(0, 0, 0.1), (60, 0, 0.0), (0, 40, -0.1), (60, 40, 0.0)])
    print(figures["lowest_mm"])
    aligned = kerf.op.align(levelled, [((0, 0), (0.1, 0)), ((60, 0), (60.1, 0.2))])
    return kerf.op.resume(aligned, 12, safe_z="10mm")


def hooks(program: kerf.Program) -> str | list[str]:
    """Lines that a script adds to a program, and the targets of posts."""
    assert "grbl" in kerf.posts()
    return kerf.post(
        program,
        "linuxcnc",
        on_open=lambda: ["(vacuum on)", "M64 P0"],
        on_section=lambda number: [f"(tool {number}: check its length)"],
        on_close=lambda: ["M65 P0"],
    )


def shown(phase: str, fraction: float) -> None:
    """A handler of progress."""
    print(phase, round(100 * fraction))


def compared(part: kerf.Simulation, target: kerf.Stock) -> float:
    """A part beside its target, with progress."""
    with kerf.progress(shown):
        figures = kerf.compare(part, target, tolerance=0.1)
    picture: bytes = kerf.compare_picture(part, target, 0.1, view="iso", size=(640, 480))
    print(figures, len(picture), len(kerf.path_picture(kerf.Toolpath(), stock="100x60x12")))
    return part.removed_mm3

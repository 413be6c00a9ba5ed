"""One mistake in each line that ends with its mark; tests/python/test_typing.py."""

import gcodepreview
import kerf

path = kerf.Toolpath()
region = kerf.Region()
tool = kerf.Tool("square d=6")
stock = kerf.Stock.block((1, 2, 3))
program = kerf.load("part.nc")
part = kerf.simulate(path, stock)
job = kerf.Job((1, 2, 3))
gcp = gcodepreview.gcodepreview("cut", True, True)

path.cut((0, 0, 0))  # wrong
path.cut((0, 0, 0), "fast")  # wrong
path.cut(3, 100)  # wrong
path.cut((0, 0, 0), feed=1, flod=2)  # wrong
path.cut(("a", "b", "c"), 100)  # wrong
path.rapid("origin")  # wrong
path.rapid((0, 0, 0), rotary=90)  # wrong
path.arc((0, 0, 0), centre=(1, 0), turn="left", feed=1)  # wrong
path.arc((0, 0, 0), centre=(1, 0), turn="cw", feed=1, plane="ZX")  # wrong
path.arc((0, 0, 0), centre=1, turn="cw", feed=1)  # wrong
path.coolant(True)  # wrong
path.coolant(flod=True)  # wrong
path.tool("102")  # wrong
path.spindle("16000")  # wrong
path.path_mode("smooth")  # wrong
path.probe((0, 0, 0), 10, until="touch")  # wrong
path.dwell("1 s")  # wrong
path.temperature("table", 60)  # wrong
path.laser(10, "pulsed")  # wrong
path.layer(3)  # wrong
path.note(3)  # wrong
path.verbatim(b"M8")  # wrong
path.extrude((0, 0, 0), 900, volume="2")  # wrong
path.append(3)  # wrong
path.lines()  # wrong
path["a"]  # wrong
path + 3  # wrong
path.report().upper()  # wrong
len(3)  # wrong
kerf.Region(3)  # wrong
kerf.Region([(0, 0), "a"])  # wrong
kerf.Region([], fill="odd")  # wrong
kerf.Region([], tolerance="small")  # wrong
region | 3  # wrong
region.area()  # wrong
region.offset("2")  # wrong
region.offset(2, join="bevel")  # wrong
region.offset(2, 3)  # wrong
region.locate("centre")  # wrong
region.bounds[0]  # wrong
region.inside((1, 2, 3))[0].start  # wrong
region.inside((1, 2, 3))[0][2]  # wrong
region.clearance((1, 2)) + 1  # wrong
region.distance(region) > 1  # wrong
region.nearest([(1, 2)]).x  # wrong
region.nearest((1, 2))[0]  # wrong
region.medial_axis().nodes  # wrong
region.divide([(0, 0), (1, 1)])[0].location  # wrong
region.nesting()[0].parent  # wrong
region.largest_circle()[2]  # wrong
region.outlines[0].area  # wrong
kerf.point_at([(0, 0), (1, 0)], 0.5).x  # wrong
kerf.plane_shape("circle", "wide")  # wrong
kerf.plane_shape("circle", 0, 0, 5).area  # wrong
kerf.BezierSurface((0, 0), 1, 1, 3)  # wrong
region.area = 3  # wrong
kerf.widen([(0, 0)], 1, ends="square")  # wrong
kerf.Tool(6.0)  # wrong
kerf.Tool("square d=6", number="1")  # wrong
tool.diameter = 3  # wrong
tool.diameter_at("tip")  # wrong
kerf.Stock.block(3)  # wrong
kerf.Stock.block((1, 2, 3), zero_height="half")  # wrong
kerf.Stock.block((1, 2, 3), zero="left")  # wrong
stock.low.x  # wrong
kerf.load(3)  # wrong
kerf.load("part.nc", strict="yes")  # wrong
kerf.load("part.nc", dialekt="grbl")  # wrong
kerf.simulate("part.nc")  # wrong
kerf.simulate(path, stock, resolution="fine")  # wrong
part.picture(colour="red")  # wrong
part.picture(size="800x600")  # wrong
part.mesh_file("obj3")  # wrong
part.hazards.depth  # wrong
part.save(3)  # wrong
part.save("part.png", motion_colours=["red"])  # wrong
part.mesh()[3]  # wrong
part.mesh()[0].length  # wrong
part.removed_by_step.total  # wrong
path.columns().x  # wrong
path[0].kind  # wrong
kerf.post(program, "grbl", unit="cm")  # wrong
kerf.post(program, "grbl", tool_change="stop")  # wrong
kerf.post("part.nc", "grbl")  # wrong
kerf.post(program, 3)  # wrong
kerf.check(3)  # wrong
kerf.op.pocket(region, tool, depth=[4], stepdown=2, feed=900)  # wrong
kerf.op.pocket(region, depth=4, stepdown=2, feed=900)  # wrong
kerf.op.contour(region, tool, depth=4, stepdown=2, feed=900, side="left-hand")  # wrong
kerf.op.step_down(program, 2, entry="steep")  # wrong
kerf.op.transform(program, mirror="z")  # wrong
kerf.inch("3")  # wrong
kerf.op.repeat(program, 2, 2)  # wrong
job.cut(w=3)  # wrong
job.arc(1, 2, centre=(0, 0), turn="clockwise")  # wrong
job.simulate(resolution="fine")  # wrong
kerf.Job((1, 2, 3), units="cm")  # wrong
job.pocket(region, tool)  # wrong
job.pocket(region, tool, dept=4)  # wrong
job.pocket(region, tool, depth=4, direction="up")  # wrong
job.drill([(1, 2)], 3.5, depth=4)  # wrong
job.pockets(region, depth=4)  # wrong
job.save("part.nc", post=3)  # wrong
job.pocket(region, depth=4).toolpath  # wrong
kerf.post(program, "grbl", on_section=lambda: ["M8"])  # wrong
kerf.progress(lambda phase: None)  # wrong
kerf.surface_rows(lambda x: 0.0, tool, (0, 0), (1, 1))  # wrong
kerf.Printer(widht=0.4)  # wrong
kerf.Printer(retract="far")  # wrong
kerf.simulat(path)  # wrong
gcp.cutline("a", 1, 2)  # wrong
gcp.setupstock(100, 60, "thick")  # wrong
gcp.rapids.kind  # wrong
gcodepreview.shapes.circle(0, 0, "wide")  # wrong

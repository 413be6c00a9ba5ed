"""Every command of gcodepreview once, with a comment: a sheet to copy from. It runs, with

kerf run commands.py -o part.png
"""

from gcodepreview import *

# ---- A machine, its files and its stock

gcp = gcodepreview("cut", True, True)  # "cut", "print" or "no_preview"; write G-code; write DXF
gcp.gcpversion()
gcp.setdebug(False)  # or gcp.debugenable = False
gcp.debug("shown if gcp.debugenable is True")
gcp.setpost("carbide")  # or gcp.post = "carbide": the controller
gcp.setdxfoptions("r2000", "colour", True, False)  # version, layers, joined chains, colours beside each other
gcp.setfeeds(plunge=300, feed=1200, small_square=0.75)  # mm/min; factors by class of tool
gcp.opengcodefile("commands", plunge=400, feed=1600)  # commands.nc, written by closegcodefile
gcp.opendxffile("commands")  # commands.dxf, written by closedxffile
gcp.opendxffiles("tools", small_square_tool_num=102)  # tools102.dxf: what is drawn with that tool
gcp.setupcuttingarea(100, 50, 10, 0, 0, -10)  # a block by its size and lowest corner ...
gcp.setupstock(240, 160, 20, "Top", "Lower-Left", 6)  # ... or by size, height and position of its zero
gcp.shiftstock(0, 0, 0)  # by X, Y, Z
gcp.addtostock(240, 20, 20, 0, 160, -20)  # one more block: its size and lowest corner
gcp.setcolor(cutcolor="green", rapidcolor="orange", shaftcolor="red")

# ---- Tools

gcp.toolchange(201, 16000)  # number, rpm
gcp.addtool(901, "lollipop", diameter=10, neck_diameter=4, flute=14)  # a tool of one's own
print(gcp.currenttoolnumber(), gcp.currenttool(), gcp.tool_diameter(301, 2), gcp.tool_radius(301, 2))
outlines = gcodepreview("no_preview")  # another object, for descriptions of tools
outlines.settoolparameters("mill", 6.35, 0, 19.05, 0)  # as a CutViewer comment
outlines.definesquaretool(6.35, 19.05, 20)
outlines.defineballnosetool(6.35, 19.05, 20)
outlines.defineVtool(12.7, 6.35, 20, 6.35)
outlines.defineKeyholetool(9.525, 3.175, 6.35, 6.35, 6.35, 20)
outlines.definebowltool(12.7, 12.7, 3.175, 6.35, 20)
outlines.defineRoundovertool(5.842, 0.508, 7.492, 2.921, 6.35, 10)
outlines.defineshaft(6.35, 6.35, 19.05, 0, 20)
outlines.showtooloutline()  # SVG of the whole section, of its right half, and the solid as STL
outlines.showtoolprofile()
outlines.showtoolshape()

# ---- Rapids and positions

gcp.movetosafeZ()  # up to the retract height
gcp.rapid(10, 10, 6)
gcp.rapidXYZ(12, 10, 6)
gcp.rapidXY(12, 12)
gcp.rapidXZ(10, 5)
gcp.rapidYZ(10, 6)
gcp.rapidX(12)
gcp.rapidY(12)
gcp.rapidZ(1)
gcp.setlaserpower(0)  # above 0: the beam of a laser during cuts; then gcp.post = "laser"
print(gcp.xpos(), gcp.ypos(), gcp.zpos())
gcp.setxpos(gcp.xpos())  # a position without a motion: the next motion starts with a rapid to it
gcp.setypos(gcp.ypos())
gcp.setzpos(gcp.zpos())

# ---- Straight cuts

gcp.cutline(12, 12, -1)
gcp.cutlinedxf(20, 12, -1)  # also in the drawing
gcp.cutlinegc(20, 20, -1)
gcp.cutlinedxfgc(12, 20, -1)
gcp.cutlineXYZ(12, 22, -1)
gcp.cutlineXY(20, 22)
gcp.cutlineXZ(12, -2)
gcp.cutlineYZ(24, -1)
gcp.cutlineX(20)
gcp.cutlineY(26)
gcp.cutlineZ(-2)
gcp.cutlineXYZwithfeed(12, 26, -2, 800)  # the last argument is the feed, mm/min
gcp.cutlineXYwithfeed(20, 26, 800)
gcp.cutlineXZwithfeed(12, -1, 800)
gcp.cutlineYZwithfeed(28, -2, 800)
gcp.cutlineXwithfeed(20, 800)
gcp.cutlineYwithfeed(30, 800)
gcp.cutlineZwithfeed(-3, 200)
gcp.cutlineZgcfeed(-2, 200)
gcp.moveatfeedrate(12, 30, -2, 900)
gcp.begintoolpath(12, 34, 0.25)  # safe height, above the point, down to it
gcp.cutoneaxis_setfeed("Z", -1, 150)  # keeps the feed
gcp.cutwithfeed(20, 34, -1, 700)
gcp.endtoolpath()
gcp.writecomment("a comment in the program")
gcp.writegc("(another one)")
moves = gcp.toolmovement(0, 0, 0, 10, 0, -1).union(gcp.shaftmovement(0, 0, 0, 10, 0, -1))  # lists, not run

# ---- Arcs: each starts where the tool is

gcp.rapid(40, 20, 6)
gcp.cutline(40, 20, -1)
gcp.cutarcCC(0, 90, 30, 20, 10, -0.5)  # angles in degrees, centre, radius, change of Z
gcp.cutarcCW(90, 0, 30, 20, 10, 0)
gcp.cutarcCCdxf(0, 90, 30, 20, 10, 0)  # also in the drawing
gcp.cutarcCWdxf(90, 0, 30, 20, 10, 0)
gcp.extrudearcCC(0, 90, 30, 20, 10, 0)
gcp.arcCWgc(40, 20, -1, 30, 20, 10)  # to a point about a centre
gcp.arcCCgc(30, 30, -1, 30, 20, 10)
gcp.cutcircleCC(60, 20, -1, -1, 8)  # centre, Z at its start and end, radius
gcp.cutcircleCW(60, 20, -1, -2, 8)
gcp.cutcircleCCdxf(60, 20, -2, -2, 8)
gcp.cutcircleCWdxf(60, 20, -2, -2, 8)
gcp.gcodearc(201, 60, 20, 8, 0, 90)

# Quarters of a circle counter-clockwise, to an end point with a radius: the right, upper, left, lower end ...
gcp.rapidZ(6)
gcp.rapidXY(100, 20)
gcp.cutlineZ(-1)
gcp.cutquarterCCNE(90, 30, -1, 10)
gcp.cutquarterCCNW(80, 20, -1, 10)
gcp.cutquarterCCSW(90, 10, -1, 10)
gcp.cutquarterCCSE(100, 20, -1, 10)
gcp.cutquarterCCNEdxf(90, 30, -1, 10)
gcp.cutquarterCCNWdxf(80, 20, -1, 10)
gcp.cutquarterCCSWdxf(90, 10, -1, 10)
gcp.cutquarterCCSEdxf(100, 20, -1, 10)
gcp.cutquarterCWSE(90, 10, -1, 10)  # ... and clockwise
gcp.cutquarterCWSW(80, 20, -1, 10)
gcp.cutquarterCWNW(90, 30, -1, 10)
gcp.cutquarterCWNE(100, 20, -1, 10)
gcp.cutquarterCWSEdxf(90, 10, -1, 10)
gcp.cutquarterCWSWdxf(80, 20, -1, 10)
gcp.cutquarterCWNWdxf(90, 30, -1, 10)
gcp.cutquarterCWNEdxf(100, 20, -1, 10)
# The same with the centre: end point, centre, radius.
gcp.cutarcNECCdxf(90, 30, -1, 90, 20, 10)
gcp.cutarcNWCCdxf(80, 20, -1, 90, 20, 10)
gcp.cutarcSWCCdxf(90, 10, -1, 90, 20, 10)
gcp.cutarcSECCdxf(100, 20, -1, 90, 20, 10)
gcp.cutarcSECWdxf(90, 10, -1, 90, 20, 10)
gcp.cutarcSWCWdxf(80, 20, -1, 90, 20, 10)
gcp.cutarcNWCWdxf(90, 30, -1, 90, 20, 10)
gcp.cutarcNECWdxf(100, 20, -1, 90, 20, 10)
gcp.cutarcNECCdxfgc(90, 30, -1, 90, 20, 10)
gcp.cutarcNWCCdxfgc(80, 20, -1, 90, 20, 10)
gcp.cutarcSWCCdxfgc(90, 10, -1, 90, 20, 10)
gcp.cutarcSECCdxfgc(100, 20, -1, 90, 20, 10)
gcp.cutarcSECWdxfgc(90, 10, -1, 90, 20, 10)
gcp.cutarcSWCWdxfgc(80, 20, -1, 90, 20, 10)
gcp.cutarcNWCWdxfgc(90, 30, -1, 90, 20, 10)
gcp.cutarcNECWdxfgc(100, 20, -1, 90, 20, 10)
gcp.rapidZ(6)

# ---- Drawings: the first argument is the tool

gcp.setdxfcolor("Blue")  # a colour and its layer; Web names too
gcp.setdxflayer("my layer")  # a layer of one's own; None: that of the colour
gcp.setdxflayer(None)
gcp.dxfline(102, 0, 0, 30, 0)
gcp.dxfarc(102, 30, 5, 5, 270, 360)
gcp.dxfcircle(102, 10, 20, 4)
gcp.beginpolyline(102)
gcp.addvertex(102, 40, 0)
gcp.addvertex(102, 50, 0)
gcp.addvertex(102, 50, 10)
gcp.closepolyline(102)
gcp.beginopenpolyline(102)
gcp.addopline(102, 60, 0)
gcp.addopline(102, 70, 5)
gcp.finishopenpolyline(102)
gcp.rapidXY(120, 10)
gcp.beginpolyline(102)
gcp.cutvertexdxf(120, 10, -1)  # a cut and a vertex
gcp.cutvertexdxfgc(130, 10, -1)
gcp.cutvertexdxf(130, 20, -1)
gcp.cutpolylinedxf(130, 20, -1)
gcp.closepolyline(102)
gcp.rapidZ(6)
gcp.dxfrectangle(102, 0, 30, 20, 10, "Fillet", 3)  # "Square", "Fillet", "Chamfer", "Flipped Fillet"
gcp.dxfrectanglelwp(102, 0, 45, 20, 10)
gcp.dxfrectangleround(102, 0, 60, 20, 10, 3)
gcp.dxfrectanglechamfer(102, 0, 75, 20, 10, 3)
gcp.dxfrectangleflippedfillet(102, 0, 90, 20, 10, 3)
gcp.dxfpreamble(102)  # the next three write nothing: the drawing's writer does it
gcp.dxfpostamble(102)
gcp.writedxfcolor(102)
for add in (gcp.writedxf, gcp.writedxfs):
    try:
        add(102, "0")  # "writedxf" and "writedxfs" are errors: text cannot be added to a drawing
    except GcodePreviewError:
        pass

# ---- Rectangles and any other shape; depths count downwards from a start height

gcp.toolchange(102, 16000)
gcp.rapidXY(20, 50)
gcp.cutrectangle(102, 20, 50, 0, 20, 10, 2)
gcp.rapidZ(6)
gcp.rapidXY(50, 50)
gcp.cutrectangledxf(102, 50, 50, 0, 20, 10, 2)
gcp.rapidZ(6)
gcp.rapidXY(83, 50)
gcp.cutrectangleround(102, 80, 50, 0, 20, 10, 2, 3)
gcp.rapidZ(6)
gcp.rapidXY(113, 50)
gcp.cutrectanglerounddxf(102, 110, 50, 0, 20, 10, 2, 3)
gcp.cutpocketrectangleround(102, 80, 50, 0, 20, 10, 2, 3)
gcp.cutpocketrectanglerounddxf(110, 50, 0, 20, 10, 2, 3)  # the tool in use
heart = shapes.heart(160, 20, 25)
gcp.cutoutline(heart, 0, 1, "outside")  # "none", "inside"; corners="dog-bone" or "t-bone" inside
gcp.cutpocket(shapes.lens(160, 60, 14, 12), 0, 2, stepover=0.4)
gcp.dxfoutline(102, heart)
gcp.cutfingers(66, 8, 5, 0, 4, True, 0.1, "dog-bone", 165, 0)  # slots of a finger joint
gcp.cuttext("gcodepreview", 20, 75, 8, 0, 0.5, "script")
gcp.dxftext(102, "gcodepreview", 20, 75, 8, "script")
gcp.cutbezier([(20, 90), (40, 110), (60, 70), (80, 95)], 0, 1)
gcp.dxfbezier(102, [(20, 90), (40, 110), (60, 70), (80, 95)])

# ---- Surfaces, countersinks, threads

gcp.cutpocket(shapes.circle(150, 90, 3.3), 0, 8)  # the hole of the thread below
gcp.toolchange(101, 16000)
dish = shapes.bezier_surface(190, 20, 30, 30, [[0] * 4, [0, -6, -6, 0], [0, -6, -6, 0], [0] * 4])
gcp.cutsurface(dish, 192, 22, 26, 26, stepover=0.3, stepdown=2)
gcp.cutcountersink(150, 90, 12, 90)
gcp.toolchange(648, 16000)
gcp.cutthread(150, 90, 8, 1.25, 0, 6)  # nominal diameter, pitch, start height, depth

# ---- Keyholes and joints

gcp.toolchange(374, 10000)
gcp.rapidXY(190, 80)
gcp.rapidZ(0)
gcp.cutkeyholegcdxf(374, 0, 5, "N", 12)  # N, E, S, W
gcp.rapidZ(6)
gcp.rapidXY(215, 80)
gcp.rapidZ(0)
gcp.cutKHgcdxf(374, 0, 5, 45, 12)  # any angle, degrees
gcp.dxfKH(374, 215, 80, 0, 5, 45, 12)
gcp.rapidZ(6)
joint = ("Vertical", "Both", 50, 6.35)  # orientation, side, width of the joint, thickness of the boards
gcp.toolchange(102, 17000)
gcp.rapidXY(40, 100)
gcp.Finger_Joint_square(40, 100, *joint, 5, 8, 3.175)
gcp.Full_Blind_Finger_Joint_square(80, 100, *joint, 5, 12.7, 3.175)
gcp.Full_Blind_Finger_Joint_smallV(80, 100, *joint, 5, 12.7, 3.175)
gcp.Full_Blind_Finger_Joint_largeV(80, 100, *joint, 5, 12.7, 3.175)
gcp.rapidZ(6)
gcp.Full_Blind_Finger_Joint(120, 100, *joint, 12.7, 3.175, fit=0.1)  # all three with their tools
pins, tails = gcodepreview("cut"), gcodepreview("cut")
for board, cut in ((pins, pins.cut_pins), (tails, tails.cut_tails)):
    board.setupstock(100, 60, 12.7)
    board.movetosafeZ()
    board.toolchange(814, 10000)
    board.rapidZ(0)
    # Width of the joint, thickness of the boards, number of dovetails, spacing, proportion; the tool's
    # diameter and angle.
    cut(100, 12.7, 4, 8, 0.75, 12.7, 14)
pins.cut_pins, tails.cut_tails  # noqa: B018 - both are commands: pins.cut_pins(...), tails.cut_tails(...)

# ---- Results

gcp.gcodepostamble()  # closegcodefile calls it
text = gcp.gcode("grbl")  # the program for any controller
sketch, svg, path = gcp.dxf(), gcp.svg(), gcp.pathsvg()  # the drawing as DXF and SVG; the path from above
gcp.stockandtoolpaths("toolpaths")  # or "stock", "rapids"
print(gcp.simulate().report())
part = gcp.returnstockandtoolpaths()
gcp.stockandtoolpaths()  # shows the part
gcp.closegcodefile()
gcp.closedxffile()
gcp.closedxffiles()

# ---- Read G-code; two sides; a fourth axis

reader = gcodepreview("cut")
reader.previewgcodefile("commands.nc")
other = gcodepreview("cut")
other.setupstock(60, 40, 10)
other.simulate().save("block.stl")
other.stockfromfile("block.stl")
other.flipstock("x")  # turn over what is left; the following cuts are the second side
bar = gcodepreview("cut")
bar.setrotary(90)  # degrees of A at the end of the following motions
bar.rapid(10, 0, 30)
bar.cutline(10, 0, 8)
bar.simulaterotary(20, 0, 40)  # diameter, from X, to X

# ---- Printing

printer = gcodepreview("print", True)
printer.opengcodefile("commands")
printer.initializeforprinting(0.4, 1.75, 0.6, 0.2)  # nozzle, filament, width and height of a bead, mm
printer.setbedtemperature(60)
printer.setandwaitforbedtemperature(60)
printer.setextrudertemperature(200)
printer.setandwaitforextrudertemperature(200)
printer.setextrusionabsolute()
printer.setfanspeed(0, 255)
printer.setfansoff()
printer.setfeedratio(100)
printer.setspeedratio(100)
printer.setacceleration(1000)
printer.setbuildpercentage(10)
printer.pauseforclearbuffer()
printer.setchambertemperature(40)
printer.setandwaitforchambertemperature(40)
printer.setfilamentsensor(True)
printer.displaymessage("Layer 1 of 10")
printer.clearmessage()
printer.liftandprimenozzle()
printer.rapid(0, 0, 0.2)
printer.extrude(10, 20, 0.2, feedrate=1200)
printer.retract(0.8)
printer.unretract(0.8)
printer.closegcodefile()

second = gcodepreview("print", True)  # as gcodepreview 0.9313 starts and ends a print
second.initializeforprinting(0.4, 1.75, 0.6, 0.2, "relative", 200, 60, "generic", "commands-2")
second.extrude(20, 30, 0.2)
second.shutdownafterprinting(1000)

third = gcodepreview("print", True)  # a printer with further devices
third.setpost("klipper")
third.opengcodefile("commands-3")
third.initializeforprinting(0.4, 1.75, 0.6, 0.2)
third.cleannozzle("CLEAN_NOZZLE")  # the printer's macro
third.tareloadcell()
third.readaccelerometer()
third.extrude(20, 30, 0.2)
third.cutfilament("CUT_TIP")
third.closegcodefile()

"""A house sign: engraved letters, a line around them, two holes to hang it, and round corners."""

from gcodepreview import *

gcp = gcodepreview("cut", True, True)
gcp.opengcodefile("sign", plunge=400, feed=1500)
gcp.opendxffile("sign")
gcp.setupstock(220, 90, 12, "Top", "Lower-Left", 5)
gcp.movetosafeZ()

# The letters with a V of 60 degrees.
gcp.toolchange(302, 18000)
gcp.setdxfcolor("Red")
lines = (("Oak Cottage", 24, 46, 18, "times bold"), ("est. 1894", 70, 20, 12, "script"))
for text, x, y, height, font in lines:
    gcp.cuttext(text, x, y, height, 0, 1.6, font)
    gcp.dxftext(302, text, x, y, height, font)

# A frame 1 mm deep, with corners of 8 mm.
gcp.toolchange(112, 16000)
gcp.setdxfcolor("Blue")
frame = shapes.round_corners(shapes.rectangle(8, 8, 204, 74), 8)[0]
gcp.cutoutline(frame, 0, 1)
gcp.dxfoutline(112, frame)

# Holes of 5 mm through the board, then the outline in three passes.
gcp.toolchange(102, 16000)
gcp.setdxfcolor("Black")
for x in (15, 205):
    gcp.cutpocket(shapes.circle(x, 75, 2.5), 0, 12)
    gcp.dxfcircle(102, x, 75, 2.5)
outline = shapes.round_corners(shapes.rectangle(3.5, 3.5, 213, 83), 10)[0]
for depth in (4, 8, 11.6):  # a skin of 0.4 mm holds the sign; it is cut with a knife
    gcp.cutoutline(outline, 0, depth, "outside")
gcp.dxfoutline(102, outline)

gcp.stockandtoolpaths()
gcp.closegcodefile()
gcp.closedxffile()

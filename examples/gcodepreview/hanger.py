"""The back of a shelf: two keyhole slots to hang it from screws, and a countersunk hole between them."""

from gcodepreview import *

gcp = gcodepreview("cut", True, True)
gcp.opengcodefile("hanger", plunge=250, feed=900)
gcp.opendxffile("hanger")
gcp.setupstock(200, 70, 18, "Top", "Center", 6)
gcp.movetosafeZ()

# Entries at the lower ends; the screws slide 15 mm towards the upper edge (north), 6 mm below the surface.
gcp.toolchange(374, 10000)
gcp.setdxfcolor("Green")
for x in (-70, 70):
    gcp.rapidZ(6)
    gcp.rapidXY(x, -8)
    gcp.rapidZ(1)
    gcp.cutkeyholegcdxf(374, 0, 6, "N", 15)

# A hole of 5 mm with a countersink of 11 mm for a screw from this side.
gcp.toolchange(102, 16000)
gcp.cutpocket(shapes.circle(0, 0, 2.5), 0, 12)
gcp.toolchange(101, 16000)
gcp.cutcountersink(0, 0, 11, 90)

# Rounded upper edge, with a roundover bit along it.
gcp.toolchange(56125, 16000)
gcp.rapidZ(6)
gcp.rapidXY(-106, 35)
gcp.cutline(-106, 35, -3.175)
gcp.cutline(106, 35, -3.175)

gcp.stockandtoolpaths()
gcp.closegcodefile()
gcp.closedxffile()

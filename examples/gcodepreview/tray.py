"""A tray cut from two sides: two compartments with round edges on one, a recess with a mark on the other."""

from gcodepreview import *

gcp = gcodepreview("cut", True)
gcp.setupstock(180, 110, 25, "Top", "Lower-Left", 6)

# The upper side.
gcp.opengcodefile("tray-top", plunge=500, feed=1800)
gcp.movetosafeZ()
compartments = ((10, 95), (115, 55))  # left edge and width


def inside(x, width, margin):
    """A compartment without a margin at its walls, with round corners."""
    plan = shapes.rectangle(x + margin, 10 + margin, width - 2 * margin, 90 - 2 * margin)
    return shapes.round_corners(plan, 12 - margin)[0]


gcp.toolchange(201, 16000)  # square: up to 1 mm from the walls, and clear of their round edges
for depth in (4, 8, 11):
    for x, width in compartments:
        gcp.cutpocket(inside(x, width, 1), 0, depth)
gcp.toolchange(45982, 16000)  # a bowl bit: walls, floor and the round edges between them
for depth in (14, 18):
    for x, width in compartments:
        gcp.cutpocket(inside(x, width, 0), 0, depth, stepover=0.3)
gcp.simulate().save("tray-top.png")
gcp.closegcodefile()

# The lower side: turned over about an axis along X; its surface is Z0 again.
gcp.flipstock("x")
gcp.opengcodefile("tray-bottom", plunge=500, feed=1800)
gcp.movetosafeZ()
gcp.toolchange(201, 16000)
gcp.cutpocket(shapes.round_corners(shapes.rectangle(15, 15, 150, 80), 12)[0], 0, 2)
gcp.toolchange(301, 16000)
gcp.cuttext("Walnut 25 mm", 40, 50, 12, -2, 0.8, "script")
gcp.stockandtoolpaths()
gcp.closegcodefile()

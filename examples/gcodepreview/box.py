"""Two boards of a box with finger joints, side by side in one piece of plywood, with a groove for the bottom.

Cut it twice: front and back, left and right side. The front has fingers at its corners, the side has slots.
"""

from gcodepreview import *

thickness, width, length = 9, 72, 130  # mm: of the plywood; height and length of the boards
gap, fit, fingers = 6.35, 0.1, 7  # mm between the boards; clearance of the joint; fingers and slots
second = width + gap

gcp = gcodepreview("cut", True, True)
gcp.opengcodefile("box", plunge=300, feed=1200)
gcp.setupstock(2 * width + gap, length, thickness, "Top", "Lower-Left", 5)
gcp.movetosafeZ()

# The joints with a tool of 1/8"; its dog-bones leave room for square fingers.
gcp.toolchange(102, 16000)
for depth in (3, 6, 9):
    for x, first in ((0, True), (second, False)):
        for y, edge in ((0, "lower"), (length, "upper")):
            gcp.cutfingers(width, thickness, fingers, 0, depth, first, fit, "dog-bone", x, y, edge)

# The groove for a bottom of 3 mm, 8 mm above the lower edge of the box, half as deep as the boards are thick.
# It stays within the fingers of the front, and runs through the side.
for x, margin in ((width - 8 - 3.2, thickness / 2), (second + 8, 0)):
    groove = shapes.rectangle(x, margin, 3.2, length - 2 * margin)
    gcp.cutpocket(groove, 0, thickness / 2)

# The cut between the boards.
gcp.toolchange(201, 16000)
for depth in (3, 6, 9):
    gcp.rapidZ(5)
    gcp.rapidXY(width + gap / 2, -4)
    gcp.cutline(width + gap / 2, -4, -depth)
    gcp.cutline(width + gap / 2, length + 4, -depth)

gcp.stockandtoolpaths()
gcp.closegcodefile()

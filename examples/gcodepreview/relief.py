"""A relief: a flower in a round dish, roughed with a square tool of 1/4" and finished with a ball nose."""

import math

from gcodepreview import *

gcp = gcodepreview("cut", True)
gcp.opengcodefile("relief", plunge=600, feed=2000)
gcp.setupstock(120, 120, 20, "Top", "Center", 6)
gcp.movetosafeZ()


def flower(x, y):
    """Z of the surface: petals that rise from a dish with a radius of 52 mm."""
    r, angle = math.hypot(x, y), math.atan2(y, x)
    if r >= 52:
        return 0.2  # the tool does not touch the board there
    dish = -9 * math.cos(r / 52 * math.pi / 2) ** 0.5
    petal = 40 * (0.62 + 0.38 * math.cos(6 * angle))
    rise = max(0.0, 1 - (r / petal) ** 2)
    bud = 3.5 * max(0.0, 1 - (r / 9) ** 2)
    return min(0.0, dish + 4.5 * rise**0.5 + bud)


gcp.toolchange(201, 16000)
gcp.cutsurface(lambda x, y: flower(x, y) + 0.4, -54, -54, 108, 108, stepover=0.4, stepdown=4)
gcp.toolchange(101, 16000)
gcp.cutsurface(flower, -54, -54, 108, 108, stepover=0.2)

gcp.stockandtoolpaths()
gcp.closegcodefile()

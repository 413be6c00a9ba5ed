"""Jobs that several tests of the Python module cut."""
import math

import kerf


def slot():
    path = kerf.Toolpath()
    path.tool(102)
    path.spindle(16000)
    path.rapid((10, 10, 5))
    path.cut((10, 10, -2), feed=100)
    path.cut((30, 10, -2), feed=400)
    path.rapid((30, 10, 5))
    return path


SLOT = 2 * (20 * 3.175 + math.pi * 3.175**2 / 4)  # mm3 that it removes

"""Writes demo.nc, the example of `./dev demo`: dish, drilled holes, lettering, relief, T-slot.

    python3 examples/make_demo.py > examples/demo.nc

Millimetres, work zero on the top at the lower left corner of a block of 110 x 80 x 14.
"""
import math

SAFE = 5.0  # mm, safe Z
BLOCK = (110.0, 80.0, 14.0)


def number(value):
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Program:
    """Collects lines of G-code; words are given as keywords, x=1.5 becomes X1.5."""

    def __init__(self):
        self.lines = []

    def say(self, comment):
        self.lines.append(f"({comment})")

    def block(self, *codes, **words):
        self.lines.append(" ".join([*codes, *(f"{k.upper()}{number(v)}" for k, v in words.items())]))

    def tool(self, number_, speed, comment=None):
        self.block("G0", z=SAFE)
        self.block("M5")
        if comment:
            self.say(comment)
        self.block("M6", f"T{number_}")
        self.block("M3", f"S{speed}")

    def above(self, x, y):
        """Rapid to a position at safe Z, then down to just above the stock."""
        self.block("G0", z=SAFE)
        self.block("G0", x=x, y=y)
        self.block("G0", z=1)


def ring_pocket(p, centre, outer, inner, top, bottom, step_down=1.5, cutter=3.175, feed=1000):
    """Clears the ring between two radii: a helix down at the outer wall, then full circles inwards."""
    x, y = centre
    far, near = outer - cutter / 2, inner + cutter / 2
    depth = top
    p.above(x + far, y)
    p.block("G1", z=top, f=300)
    while depth > bottom + 1e-9:
        depth = max(depth - step_down, bottom)
        p.block("G3", x=x + far, y=y, z=depth, i=-far, j=0, f=400)
        radius = far
        while True:
            p.block("G3", x=x + radius, y=y, i=-radius, j=0, f=feed)
            if radius <= near + 1e-9:
                break
            radius = max(radius - 0.45 * cutter, near)
            p.block("G1", x=x + radius, y=y)
        p.block("G1", x=x + far, y=y)


def dish(p):
    p.say("stepped dish with a post in the centre")
    ring_pocket(p, (70, 55), outer=17, inner=3.5, top=0, bottom=-3)
    ring_pocket(p, (70, 55), outer=11, inner=3.5, top=-3, bottom=-6)


def holes(p):
    p.say("drilled holes")
    p.block("G0", z=SAFE)
    p.block("G98", "G81", x=92, y=64, z=-6, r=1, f=200)
    p.block(x=100)
    p.block("G83", x=96, y=71, z=-9, r=1, q=2.5, f=200)
    p.block("G80")


def slot_for_the_neck(p, x, entry_y, depth):
    """Clearance for the keyhole cutter: a slot for its neck, open to the front, and a hole for its head."""
    p.say("slot and entry hole for the keyhole cutter")
    ring_pocket(p, (x, entry_y), outer=5.6, inner=0.0, top=0, bottom=depth, step_down=2)
    side = (7 - 3.175) / 2
    p.above(x - side, entry_y)
    level = 0.0
    while level > depth + 1e-9:
        level = max(level - 2, depth)
        p.block("G1", x=x - side, y=entry_y, z=level, f=300)
        p.block("G1", y=-4, f=1000)
        p.block("G1", x=x + side)
        p.block("G1", y=entry_y)
        p.block("G1", x=x - side)


def keyhole(p, x, entry_y, depth):
    p.say("T-slot with the keyhole cutter: down the entry hole, out at the front")
    p.above(x, entry_y)
    p.block("G1", z=depth, f=300)
    p.block("G1", y=-8, f=600)


# Strokes of the letters in a box of 10 x 14; each is a list of points.
LETTERS = {
    "K": [[(0, 14), (0, 0)], [(9, 14), (0, 6)], [(3, 8.6), (9.5, 0)]],
    "E": [[(9, 14), (0, 14), (0, 0), (9, 0)], [(0, 7.4), (7, 7.4)]],
    "R": [[(0, 0), (0, 14), (5, 14)], [(5, 7), (0, 7)], [(4.5, 7), (9.5, 0)]],
    "F": [[(9, 14), (0, 14), (0, 0)], [(0, 7.4), (7, 7.4)]],
}


def stroke(p, points, deep):
    """A groove whose depth ramps from 0 within 1.5 mm at both ends, like a chisel cut."""
    (x0, y0), (x1, y1) = points[0], points[1]
    fraction = min(1.5 / math.dist(points[0], points[1]), 0.5)
    p.above(x0, y0)
    p.block("G1", z=0, f=300)
    p.block("G1", x=x0 + fraction * (x1 - x0), y=y0 + fraction * (y1 - y0), z=-deep, f=700)
    for x, y in points[1:-1]:
        p.block("G1", x=x, y=y)
    (xa, ya), (xb, yb) = points[-2], points[-1]
    back = min(1.5 / math.dist(points[-2], points[-1]), 0.5)
    p.block("G1", x=xb - back * (xb - xa), y=yb - back * (yb - ya))
    p.block("G1", x=xb, y=yb, z=0)


def lettering(p):
    p.say("lettering")
    for index, letter in enumerate("KERF"):
        dx, dy = 14 + 17 * index, 10
        for points in LETTERS[letter]:
            stroke(p, [(x + dx, y + dy) for x, y in points], 1.3)
        if letter == "R":  # its bowl is a half circle
            p.above(dx + 5, dy + 14)
            p.block("G1", z=-1.3, f=300)
            p.block("G2", x=dx + 5, y=dy + 7, i=0, j=-3.5, f=700)


def chamfer(p, width=1.2):
    p.say("chamfer around the top")
    p.above(-8, 0)
    p.block("G1", z=-width, f=600)
    for x, y in [(BLOCK[0], 0), (BLOCK[0], BLOCK[1]), (0, BLOCK[1]), (0, -8)]:
        p.block("G1", x=x, y=y, f=1200)


def ripple(x, y):
    """Height of the relief: rings that decay from the centre of a field of 40 x 40."""
    r = math.hypot(x - 26, y - 54)
    return -1.9 + 1.6 * math.cos(0.55 * r) * math.exp(-r / 22)


def thinned(points, tolerance=0.004):
    """The points of a raster line (x, z) without those that interpolation gives within the tolerance."""
    (x0, z0), (x1, z1) = points[0], points[-1]
    worst, at = 0.0, 0
    for i, (x, z) in enumerate(points[1:-1], 1):
        off = abs(z - (z0 + (z1 - z0) * (x - x0) / (x1 - x0)))
        if off > worst:
            worst, at = off, i
    if worst <= tolerance:
        return [points[0], points[-1]]
    return thinned(points[:at + 1], tolerance)[:-1] + thinned(points[at:], tolerance)


def relief(p, radius=1.5875, step_over=0.4, step=0.25):
    p.say("relief")
    reach = [i * 0.3 for i in range(-5, 6)]
    ball = [(dx, dy, math.sqrt(radius**2 - dx**2 - dy**2) - radius)
            for dx in reach for dy in reach if dx**2 + dy**2 < radius**2]

    def tip(x, y):  # the lowest tip that does not gouge the surface
        return max(ripple(x + dx, y + dy) + lift for dx, dy, lift in ball)

    count, rows = round(40 / step), round(40 / step_over)
    for row in range(rows + 1):
        y = 34 + row * step_over
        points = thinned([(6 + i * step, tip(6 + i * step, y)) for i in range(count + 1)])
        if row % 2:
            points.reverse()
        if row == 0:
            p.above(points[0][0], y)
        for i, (x, z) in enumerate(points):
            p.block("G1", x=x, y=y, z=z, f=300 if (row, i) == (0, 0) else 1500)


def main():
    p = Program()
    p.say("Kerf demo: dish, holes, lettering, relief, T-slot")
    p.say(f"stockMin: 0.00mm, 0.00mm, {-BLOCK[2]:.2f}mm")
    p.say(f"stockMax: {BLOCK[0]:.2f}mm, {BLOCK[1]:.2f}mm, 0.00mm")
    p.say(f"STOCK/BLOCK, {BLOCK[0]:.2f}, {BLOCK[1]:.2f}, {BLOCK[2]:.2f}, 0.00, 0.00, {BLOCK[2]:.2f}")
    p.block("G21", "G90", "G17", "G94", "G40", "G49")
    p.tool(102, 16000, "TOOL/MILL, 3.175, 0.00, 12.70, 0.00")
    dish(p)
    holes(p)
    slot_for_the_neck(p, 96, 44, -6)
    p.tool(301, 18000, "TOOL/MILL, 0.10, 0.05, 6.35, 45.00")
    lettering(p)
    chamfer(p)
    p.tool(101, 18000, "TOOL/MILL, 3.175, 1.5875, 12.70, 0.00")
    relief(p)
    p.tool(374, 14000)  # an undercutting tool of the built-in table: CutViewer's comments cannot describe it
    keyhole(p, 96, 44, -6)
    p.block("G0", z=SAFE)
    p.block("M5")
    p.block("M30")
    print("\n".join(p.lines))


if __name__ == "__main__":
    main()

"""Makes shell.stl: a scallop shell in low relief on a plate, as a closed mesh.

    make_shell.py > shell.stl
"""
import math
import struct
import sys

WIDE, DEEP, BOTTOM = 60.0, 50.0, -8.0  # mm
NX, NY = 48, 40  # squares
HINGE = (30.0, 4.0)  # where the ribs meet
RIBS = 9


def height(x, y):
    """Z of the surface: ribs from the hinge, highest at two thirds of their length; the plate is at Z-5."""
    dx, dy = x - HINGE[0], y - HINGE[1]
    r, angle = math.hypot(dx, dy), math.atan2(dx, dy)
    spread = math.radians(66)
    edge = 41.0 + 0.9 * math.cos(angle / spread * math.pi * RIBS)
    if abs(angle) >= spread or r >= edge:
        return -5.0
    along, across = r / edge, math.cos(angle / spread * math.pi / 2)
    arch = math.sin(math.pi * along**0.75) ** 0.7 * across**0.5
    rib = 1 + 0.16 * along * math.cos(angle / spread * math.pi * RIBS)
    return round(-5.0 + 4.3 * arch * rib, 3)


def triangles():
    top = [[(WIDE * i / NX, DEEP * j / NY, height(WIDE * i / NX, DEEP * j / NY)) for i in range(NX + 1)]
           for j in range(NY + 1)]
    for j in range(NY):
        for i in range(NX):
            a, b, c, d = top[j][i], top[j][i + 1], top[j + 1][i + 1], top[j + 1][i]
            yield from ((a, b, c), (a, c, d))
    rim = ([top[0][i] for i in range(NX)] + [top[j][NX] for j in range(NY)]
           + [top[NY][i] for i in range(NX, 0, -1)] + [top[j][0] for j in range(NY, 0, -1)])
    centre = (WIDE / 2, DEEP / 2, BOTTOM)
    for a, b in zip(rim, rim[1:] + rim[:1]):
        low_a, low_b = (*a[:2], BOTTOM), (*b[:2], BOTTOM)
        yield from ((low_a, low_b, b), (low_a, b, a), (centre, low_b, low_a))


def main():
    data = list(triangles())
    out = bytearray(b"shell".ljust(80)) + struct.pack("<I", len(data))
    for triangle in data:
        out += struct.pack("<12fH", 0, 0, 0, *(v for p in triangle for v in p), 0)
    sys.stdout.buffer.write(out)


if __name__ == "__main__":
    main()

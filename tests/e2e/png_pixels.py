"""The pixels of a PNG, decoded here: what pictures are compared with."""
import struct
import zlib

PNG = b"\x89PNG\r\n\x1a\n"


def pixels(data):
    """Width, height and rows of RGB tuples of a PNG with 8 bits and no interlacing."""
    assert data.startswith(PNG)
    at, packed, size = len(PNG), b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    width, height, _, colour = size
    per = {2: 3, 6: 4}[colour]
    raw, rows, above = zlib.decompress(packed), [], bytes(width * per)
    for y in range(height):
        start = y * (width * per + 1)
        kind, line = raw[start], bytearray(raw[start + 1:start + 1 + width * per])
        for i in range(len(line)):
            left = line[i - per] if i >= per else 0
            corner = above[i - per] if i >= per else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + above[i]) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                p = left + above[i] - corner
                best = min((abs(p - v), order, v) for order, v in enumerate((left, above[i], corner)))
                line[i] = (line[i] + best[2]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, len(line), per)])
        above = bytes(line)
    return width, height, rows

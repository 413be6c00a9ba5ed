"""Writes the path drawings of docs/manual/pathdxf.md: one small DXF file (R2000) for each kind of element.

    python3 examples/make_path_drawings.py examples/path

Each is simulated with: kerf simulate examples/path/9001.1P.dxf -o part.png
"""
import sys
from pathlib import Path

LINETYPES = "CONTINUOUS DIVIDE BORDER DASHED HIDDEN DASHDOT DOT PHANTOM".split()


def tags(*pairs):
    return "".join(f"{group:>3}\n{value}\n" for group, value in pairs)


class PathDrawing:
    """The elements of one path; its layer is the path's name with _ instead of the point."""

    def __init__(self, name, parameters, to, at=(0, 0)):
        self.layer = name.replace(".", "_")
        self.body = ""
        self.circle(*at, 1, "PHANTOM")
        self.text(*at, parameters)
        self.circle(*to, 2, "PHANTOM")

    def entity(self, kind, linetype, *pairs):
        style = [(6, linetype)] if linetype else []
        self.body += tags((0, kind), (8, self.layer), *style, *pairs)

    def line(self, x1, y1, x2, y2, linetype="CONTINUOUS"):
        self.entity("LINE", linetype, (10, x1), (20, y1), (30, 0), (11, x2), (21, y2), (31, 0))

    def arc(self, x, y, radius, start, end, linetype="CONTINUOUS"):
        self.entity("ARC", linetype, (10, x), (20, y), (30, 0), (40, radius), (50, start), (51, end))

    def circle(self, x, y, diameter, linetype="CONTINUOUS"):
        self.entity("CIRCLE", linetype, (10, x), (20, y), (30, 0), (40, diameter / 2))

    def text(self, x, y, value):
        self.entity("MTEXT", None, (10, x), (20, y), (30, 0), (40, 1.5), (71, 5),
                    (1, value.replace("\n", "\\P")))


def dxf(*paths):
    head = tags((0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 4),
                (0, "ENDSEC"), (0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LTYPE"),
                (70, len(LINETYPES)))
    for name in LINETYPES:
        head += tags((0, "LTYPE"), (2, name), (70, 0), (3, name.lower()), (72, 65), (73, 0), (40, 0))
    head += tags((0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES"))
    return head + "".join(path.body for path in paths) + tags((0, "ENDSEC"), (0, "EOF"))


PARAMETERS = "M20x3 O2 T3\nI1 B-0.1 D2 S8"


def contour():
    """A part milled around its outline: lines and an arc as one chain of passes."""
    p = PathDrawing("9001.1P", PARAMETERS, (30, 0))
    p.line(0, 0, 0, 20)
    p.line(0, 20, 20, 20)
    p.arc(20, 10, 10, -90, 90)
    p.line(20, 0, 0, 0, "DIVIDE")
    p.line(0, 0, 30, 0, "HIDDEN")
    return dxf(p)


def holes():
    """A drilled hole, a helical circle, and two around one centre, the smaller one first."""
    p = PathDrawing("9002.1P", PARAMETERS, (40, 0))
    p.line(0, 0, 10, 0, "HIDDEN")
    p.circle(10, 0, 2)
    p.line(10, 0, 20, 0, "HIDDEN")
    p.circle(20, 0, 4)
    p.line(20, 0, 30, 0, "HIDDEN")
    p.circle(30, 0, 8)
    p.circle(30, 0, 4)
    p.line(30, 0, 40, 0, "HIDDEN")
    return dxf(p)


def bars():
    """Support bars along a line and a circle."""
    p = PathDrawing("9003.1P", "M20x3 O2 T3 P3 U8\nI1 B-0.1 D2 S8 A20", (50, 0))
    p.line(0, 0, 30, 0, "BORDER")
    p.line(30, 0, 40, 0, "HIDDEN")
    p.circle(40, 0, 12, "BORDER")
    p.line(40, 0, 50, 0, "HIDDEN")
    return dxf(p)


def rapids():
    """A rapid at its own height over a clamp, DASHED with S, and one that takes no text, HIDDEN."""
    p = PathDrawing("9004.1P", PARAMETERS, (60, 0))
    p.line(0, 0, 20, 0)
    p.line(20, 0, 40, 0, "DASHED")
    p.text(30, 0.5, "S15")
    p.line(40, 0, 50, 0)
    p.line(50, 0, 60, 0, "HIDDEN")
    return dxf(p)


def star():
    """Branches at one point: N1 first, then N2, then the element without N."""
    p = PathDrawing("9005.1P", PARAMETERS, (30, 0))
    p.line(0, 0, 10, 0)
    p.line(10, 0, 10, 10)
    p.text(10, 5, "N1")
    p.line(10, 10, 20, 10)
    p.line(20, 10, 10, 0)
    p.line(10, 0, 30, 0)
    return dxf(p)


def slow():
    """W: milled without rapids between the passes, as a T-slot cutter needs."""
    p = PathDrawing("9006.1P", "M20x3 O2 T3 W2.5\nI1 B0.5 S8", (20, 15))
    p.line(0, 0, 20, 0)
    p.line(20, 0, 20, 15)
    return dxf(p)


def parts():
    """A part with a variable, embedded by the project."""
    p = PathDrawing("9007.1P", "M20x3 O2 T3 :D0.5~2.5\nI1 B=D S8", (15, 0))
    p.line(0, 0, 5, 8)
    p.line(5, 8, 15, 0)
    return dxf(p)


def project():
    """The part twice, at different depths; a rapid leads from one to the other."""
    p = PathDrawing("9008.1P", "M20x3 O2 T3 S8", (40, 0))
    p.line(0, 0, 15, 0, "DASHDOT")
    p.text(7.5, 0, ">9007.1P M20x3\nO2 T3 :D0.5")
    p.line(15, 0, 25, 0, "HIDDEN")
    p.line(25, 0, 40, 0, "DASHDOT")
    p.text(32.5, 0, ">9007.1P M20x3\nO2 T3 :D2")
    return dxf(p)


def probes():
    """Two points whose height is measured before milling."""
    p = PathDrawing("9009.1P", "M20x3 O2 T3 Z50\nI1 B2 S8", (30, 0))
    p.line(0, 0, 30, 0)
    p.circle(5, 10, 6, "PHANTOM")
    p.text(5, 10, "Lleft")
    p.circle(25, 10, 6, "PHANTOM")
    p.text(25, 10, "Lright")
    return dxf(p)


DRAWINGS = {"9001.1P": contour, "9002.1P": holes, "9003.1P": bars, "9004.1P": rapids, "9005.1P": star,
            "9006.1P": slow, "9007.1P": parts, "9008.1P": project, "9009.1P": probes}

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in DRAWINGS.items():
        (folder / f"{name}.dxf").write_text(make(), encoding="utf-8", newline="\n")

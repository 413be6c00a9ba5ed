"""Writes the hand-made DXF files of this folder: each has one thing that real programs do or get wrong.

    python3 write_files.py

tests/conformance/test_dxf_files.py says how each is to be read.
"""

from pathlib import Path

HERE = Path(__file__).parent


def tags(*rows):
    """Lines of a DXF file from pairs of group code and value."""
    return "".join(f"{group}\n{value}\n" for group, value in rows)


def section(name, body):
    return tags((0, "SECTION"), (2, name)) + body + tags((0, "ENDSEC"))


def header(version="AC1015", unit=4):
    rows = [(9, "$ACADVER"), (1, version), (9, "$DWGCODEPAGE"), (3, "ANSI_1252")]
    if unit is not None:
        rows += [(9, "$INSUNITS"), (70, unit)]
    return section("HEADER", tags(*rows))


def entities(*parts, before=""):
    return header() + before + section("ENTITIES", "".join(parts)) + tags((0, "EOF"))


def line(x1, y1, x2, y2, *more):
    return tags((0, "LINE"), (8, "0"), *more, (10, x1), (20, y1), (30, 0), (11, x2), (21, y2), (31, 0))


def polyline(points, flags=1, vertex_flags=0, seqend=True, *more):
    made = tags((0, "POLYLINE"), (8, "0"), (66, 1), (70, flags), (10, 0), (20, 0), (30, 0), *more)
    for x, y, z, bulge in points:
        made += tags((0, "VERTEX"), (8, "0"), (10, x), (20, y), (30, z), (42, bulge), (70, vertex_flags))
    return made + (tags((0, "SEQEND"), (8, "0")) if seqend else "")


def spline(flags, degree, knots, control, weights=(), fit=(), *more):
    rows = [
        (0, "SPLINE"),
        (8, "0"),
        (70, flags),
        (71, degree),
        (72, len(knots)),
        (73, len(control)),
        (74, len(fit)),
    ]
    rows += [(40, k) for k in knots]
    for i, (x, y) in enumerate(control):
        rows += [(10, x), (20, y), (30, 0)] + ([(41, weights[i])] if weights else [])
    for x, y in fit:
        rows += [(11, x), (21, y), (31, 0)]
    return tags(*rows, *more)


SQUARE = [(0, 0, 0, 0), (10, 0, 0, 0), (10, 10, 0, 0), (0, 10, 0, 0)]
BLOCK = section(
    "BLOCKS",
    tags((0, "BLOCK"), (8, "0"), (2, "HOOK"), (70, 0), (10, 1), (20, 1), (30, 0))
    + line(1, 1, 4, 1)
    + tags((0, "ARC"), (8, "0"), (10, 4), (20, 2), (40, 1), (50, 270), (51, 0))
    + tags((0, "ENDBLK"), (8, "0")),
)

FILES = {
    "crlf": entities(line(0, 0, 10, 5)).replace("\n", "\r\n"),
    "cr_only": entities(line(0, 0, 10, 5)).replace("\n", "\r"),
    "leading_blanks": "".join(
        "  " + row + " \n" if i % 2 == 0 else row + "\n"
        for i, row in enumerate(entities(line(" 0.5", " 0", "10 ", 5)).splitlines())
    ),
    "byte_order_mark": "\ufeff" + entities(line(0, 0, 10, 5)),
    "no_eof": header() + section("ENTITIES", line(0, 0, 10, 5)),
    "cut_off_in_entity": (
        header() + tags((0, "SECTION"), (2, "ENTITIES")) + line(0, 0, 10, 5) + line(10, 5, 20, 5)
    )[:-12],
    "cut_off_after_group": header() + tags((0, "SECTION"), (2, "ENTITIES")) + line(0, 0, 10, 5) + "0\n",
    "cut_off_in_value": (
        header() + tags((0, "SECTION"), (2, "ENTITIES")) + line(0, 0, 10, 5) + line(10, 5, 20, 55)
    ).replace("31\n0\n", "")[:-2],
    "no_header": section("ENTITIES", line(0, 0, 10, 5)) + tags((0, "EOF")),
    "two_headers": header() + header(unit=1) + section("ENTITIES", line(0, 0, 10, 5)) + tags((0, "EOF")),
    "no_sections": line(0, 0, 10, 5) + line(10, 5, 20, 5),
    "no_endsec": header().replace("0\nENDSEC\n", "")
    + section("ENTITIES", line(0, 0, 10, 5))
    + tags((0, "EOF")),
    "entities_only_lwpolyline": section(
        "ENTITIES",
        tags((0, "LWPOLYLINE"), (8, "0"), (90, 2), (70, 0), (10, 0), (20, 0), (42, 1), (10, 10), (20, 0)),
    )
    + tags((0, "EOF")),
    "tables_after_entities": header()
    + section("ENTITIES", tags((0, "LINE"), (8, "cut"), (10, 0), (20, 0), (11, 1), (21, 1)))
    + section(
        "TABLES",
        tags(
            (0, "TABLE"),
            (2, "LAYER"),
            (70, 1),
            (0, "LAYER"),
            (2, "CUT"),
            (70, 1),
            (62, -3),
            (6, "DASHED"),
            (0, "ENDTAB"),
        ),
    )
    + tags((0, "EOF")),
    "repeated_handles": entities(
        line(0, 0, 1, 0, (5, "2F")), line(1, 0, 2, 0, (5, "30")), line(2, 0, 3, 0, (5, "2f"))
    ),
    "huge_counts": entities(
        tags(
            (0, "LWPOLYLINE"),
            (8, "0"),
            (90, 2147483647),
            (70, 1),
            (10, 0),
            (20, 0),
            (10, 5),
            (20, 0),
            (10, 5),
            (20, 5),
        ),
        spline(8, 3, [0] * 4 + [1] * 4, [(0, 0), (1, 2), (3, 2), (4, 0)]).replace(
            "72\n8\n73\n4\n", "72\n2147483647\n73\n-5\n"
        ),
        tags(
            (0, "INSERT"), (8, "0"), (2, "HOOK"), (10, 0), (20, 0), (70, 30000), (71, 30000), (44, 1), (45, 1)
        ),
        before=BLOCK,
    ),
    "comments": "999\nmade by hand\n" + entities(line(0, 0, 10, 5, (999, "0"), (999, "LINE")), "999\n\n"),
    "number_forms": entities(
        line("1.5E+1", "-2.5e-1", "+3.", ".5"),
        line("1,5", "2", "1d5", "0"),
        line("1e400", "0", "0", "0"),
        line("12345678901234567890.5", "0", "0", "-0.0"),
    ),
    "missing_coordinate": entities(
        line(0, 0, 10, 5),
        tags((0, "LINE"), (8, "0"), (5, "A1"), (10, 1), (20, 2), (11, 3)),
        line(10, 5, 20, 5),
    ),
    "bad_group_code": entities(
        line(0, 0, 10, 5),
        tags((0, "CIRCLE"), (8, "0"), (10, 1)) + "2O\n5\n" + tags((40, 3)),
        line(10, 5, 20, 5),
    ),
    "blank_line": entities(line(0, 0, 10, 5), "\n", line(10, 5, 20, 5)),
    "negative_bulge": entities(
        tags(
            (0, "LWPOLYLINE"),
            (8, "0"),
            (90, 3),
            (70, 1),
            (43, 0.5),
            (10, 0),
            (20, 0),
            (42, -1),
            (10, 10),
            (20, 0),
            (42, -0.41421356237309503),
            (10, 10),
            (20, 10),
        )
    ),
    "closed_polylines": entities(
        polyline(SQUARE, 1), polyline(SQUARE, 0), polyline(SQUARE + SQUARE[:1], 1), polyline(SQUARE, 129)
    ),
    "polyline_3d": entities(
        polyline([(0, 0, 1, 0), (10, 0, 2, 0), (10, 10, 3, 0)], 8, 32),
        polyline([(0, 0, 9, 0), (10, 0, 9, 0)], 0).replace("30\n0\n0\nVERTEX", "30\n4\n0\nVERTEX", 1),
    ),
    "polyline_spline_frame": entities(
        polyline([(0, 0, 0, 0), (2, 2, 0, 0), (4, 0, 0, 0)], 4, 8).replace(
            "0\nSEQEND", tags((0, "VERTEX"), (8, "0"), (10, 2), (20, 4), (70, 16)) + "0\nSEQEND"
        )
    ),
    "polyline_without_seqend": entities(polyline(SQUARE, 1, 0, False), line(0, 0, 10, 5)),
    "mirrored_inserts": entities(
        tags(
            (0, "INSERT"), (8, "0"), (2, "HOOK"), (10, 10), (20, 5), (50, 90), (210, 0), (220, 0), (230, -1)
        ),
        tags((0, "INSERT"), (8, "0"), (2, "hook"), (10, 10), (20, 5), (41, -1), (42, 2)),
        tags(
            (0, "INSERT"),
            (8, "0"),
            (2, "HOOK"),
            (10, 0),
            (20, 0),
            (50, 90),
            (70, 2),
            (71, 2),
            (44, 10),
            (45, 100),
        ),
        before=BLOCK,
    ),
    "blocks_in_rings": header()
    + section(
        "BLOCKS",
        "".join(
            tags((0, "BLOCK"), (8, "0"), (2, name), (10, 0), (20, 0))
            + line(0, 0, 1, 0)
            + tags((0, "INSERT"), (8, "0"), (2, other), (10, 1), (20, 0), (0, "ENDBLK"))
            for name, other in (("A", "B"), ("B", "A"), ("SELF", "SELF"))
        ),
    )
    + section(
        "ENTITIES",
        "".join(tags((0, "INSERT"), (8, "0"), (2, name), (10, 0), (20, 0)) for name in ("A", "SELF", "GONE")),
    )
    + tags((0, "EOF")),
    "blocks_multiply": header()
    + section(
        "BLOCKS",
        "".join(
            tags((0, "BLOCK"), (8, "0"), (2, f"B{i}"), (10, 0), (20, 0))
            + (
                line(0, 0, 1, 0)
                if i == 0
                else "".join(
                    tags((0, "INSERT"), (8, "0"), (2, f"B{i - 1}"), (10, k), (20, 0)) for k in range(10)
                )
            )
            + tags((0, "ENDBLK"))
            for i in range(12)
        ),
    )
    + section("ENTITIES", tags((0, "INSERT"), (8, "0"), (2, "B11"), (10, 0), (20, 0)))
    + tags((0, "EOF")),
    "flipped_ellipse": entities(
        *(
            tags(
                (0, "ELLIPSE"),
                (8, "0"),
                (10, 5),
                (20, 5),
                (30, 0),
                (11, 4),
                (21, 0),
                (31, 0),
                (210, 0),
                (220, 0),
                (230, z),
                (40, 0.5),
                (41, 0),
                (42, 1.5707963267948966),
            )
            for z in (1, -1)
        )
    ),
    "flipped_arc": entities(
        *(
            tags(
                (0, "ARC"),
                (8, "0"),
                (10, 5),
                (20, 5),
                (30, 0),
                (40, 2),
                (50, 0),
                (51, 90),
                (210, 0),
                (220, 0),
                (230, z),
            )
            for z in (1, -1)
        )
    ),
    "splines": entities(
        spline(
            11,
            3,
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10],
            [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (10, 0), (10, 10)],
        ),
        spline(12, 2, [0, 0, 0, 1, 1, 1], [(10, 0), (10, 10), (0, 10)], [1, 0.7071067811865476, 1]),
        spline(8, 3, [], [], [], [(0, 0), (5, 5), (10, 0)]),
        spline(8, 3, [], [], [], [(0, 0), (10, 0)], (12, 0), (22, 1), (32, 0), (13, 0), (23, -1), (33, 0)),
    ),
    "bad_splines": entities(
        spline(8, 3, [0, 0, 1, 1], [(0, 0), (1, 2), (3, 2), (4, 0)]),
        spline(8, 3, [], [], [], [(0, 0)]),
        spline(12, 2, [0, 0, 0, 1, 1, 1], [(10, 0), (10, 10), (0, 10)], [1, 1, 1]).replace("41\n1\n", "", 1),
    ),
    "embedded_object": entities(
        tags(
            (0, "MTEXT"),
            (8, "0"),
            (10, 1),
            (20, 2),
            (40, 2.5),
            (71, 1),
            (1, "right"),
            (101, "Embedded Object"),
            (70, 1),
            (10, 99),
            (20, 99),
            (1, "wrong"),
            (40, 99),
        )
    ),
    "application_data": entities(
        line(
            0,
            0,
            10,
            5,
            (5, "A1"),
            (102, "{ACAD_REACTORS"),
            (330, "1F"),
            (10, 77),
            (102, "}"),
            (330, "1F"),
            (100, "AcDbEntity"),
        )
        + tags((1001, "PROG"), (1010, 5), (1020, 5), (1030, 5), (1070, 3))
    ),
    "unknown_entities": entities(
        tags((0, "HATCH"), (8, "0"), (10, 1)),
        tags((0, "DIMENSION"), (8, "0"), (5, "B")),
        tags((0, "HATCH"), (8, "0")),
        line(0, 0, 10, 5, (39, 2), (39, 3)),
    ),
    "characters": entities(
        tags(
            (0, "TEXT"),
            (8, "Lage \\U+00E4"),
            (10, 0),
            (20, 0),
            (40, 1),
            (1, "\\U+2300 5\\U+D83D\\U+DE00\\U+00 \\M+182A0 \\M+9"),
        ),
        tags((0, "TEXT"), (8, "0"), (10, 0), (20, 0), (40, 1), (1, "%%c8%%p0.1 %%248%%% %%x ^J^ ")),
    ),
    "cad_2007_is_utf8": entities(
        tags((0, "TEXT"), (8, "Größe"), (10, 0), (20, 0), (40, 1), (1, "Ø 日本"))
    ).replace("AC1015", "AC1021"),
    "unknown_version": entities(line(0, 0, 10, 5)).replace("AC1015", "AC1099"),
    "unknown_code_page": entities(
        tags((0, "TEXT"), (8, "0"), (10, 0), (20, 0), (40, 1), (1, "Größe"))
    ).replace("ANSI_1252", "ANSI_4711"),
}
BYTES = {
    "utf8_that_is_none": entities(tags((0, "TEXT"), (8, "0"), (10, 0), (20, 0), (40, 1), (1, "Gr")))
    .replace("AC1015", "AC1021")
    .replace("1\nGr\n", "1\nGr\udcf6\udcdfe\n")
    .encode("utf-8", "surrogateescape"),
    "dwg": b"AC1032\0\0\0\0\0\0",
    "utf16": "0\nSECTION\n".encode("utf-16"),
    "empty": b"",
    "svg": b"<svg xmlns='http://www.w3.org/2000/svg'/>\n",
    "numbers": b"1\n2\n3\n4\n",
}


def main():
    for name, text in FILES.items():
        (HERE / f"{name}.dxf").write_bytes(text.encode())
    for name, data in BYTES.items():
        (HERE / f"{name}.dxf").write_bytes(data)


if __name__ == "__main__":
    main()

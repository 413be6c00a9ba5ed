"""Path drawings for tests: DXF files with the few entities that paths consist of."""

HEADER = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n{unit}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
FOOTER = "0\nENDSEC\n0\nEOF\n"
LAYER = "8999_1P"


def tags(*rows):
    return "".join(f"{group}\n{value}\n" for group, value in rows)


def entity(kind, layer, linetype, *rows):
    return tags((0, kind), (8, layer), *([(6, linetype)] if linetype else []), *rows)


def line(x1, y1, x2, y2, linetype="CONTINUOUS", layer=LAYER):
    return entity("LINE", layer, linetype, (10, x1), (20, y1), (11, x2), (21, y2))


def arc(x, y, radius, start, end, linetype="CONTINUOUS", layer=LAYER):
    return entity("ARC", layer, linetype, (10, x), (20, y), (40, radius), (50, start), (51, end))


def circle(x, y, diameter, linetype="CONTINUOUS", layer=LAYER):
    return entity("CIRCLE", layer, linetype, (10, x), (20, y), (40, diameter / 2))


def text(x, y, value, layer=LAYER, height=1.0, attachment=5, **groups):
    return entity("MTEXT", layer, None, (10, x), (20, y), (40, height), (71, attachment),
                  *[(int(key[1:]), v) for key, v in groups.items()], (1, value))


def start(x, y, parameters, layer=LAYER):
    return circle(x, y, 1, "PHANTOM", layer) + (text(x, y, parameters, layer) if parameters else "")


def end(x, y, layer=LAYER):
    return circle(x, y, 2, "PHANTOM", layer)


def drawing(*entities, unit=None):
    units = "" if unit is None else tags((9, "$INSUNITS"), (70, unit))
    return HEADER.format(unit=units) + "".join(entities) + FOOTER


PARAMETERS = "M1 O2 T2 I1 B0 S5"


def path(*entities, to=(10, 0), parameters=PARAMETERS, layer=LAYER, unit=None):
    """A drawing of one path from (0, 0) to `to`."""
    return drawing(start(0, 0, parameters, layer), *entities, end(*to, layer), unit=unit)

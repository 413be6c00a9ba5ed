"""A drawing as ezdxf reads it, in the form of tests/tools/dxf_dump.cpp."""

BY_LAYER, BY_BLOCK = "bylayer", "byblock"


def handle_of(entity):
    return entity.dxf.handle.upper().lstrip("0")


def common(entity):
    dxf = entity.dxf
    return {
        "type": dxf.dxftype,
        "handle": handle_of(entity),
        "layer": dxf.layer.strip().lower(),
        "linetype": dxf.get("linetype", BY_LAYER).strip().lower(),
        "linetype_scale": dxf.get("ltscale", 1.0),
        "colour": dxf.get("color", 256),
        "true_colour": dxf.get("true_color", -1),
        "lineweight": dxf.get("lineweight", -1),
        "hidden": bool(dxf.get("invisible", 0)),
        "extrusion": list(dxf.get("extrusion", (0, 0, 1))),
    }


def points(values):
    return [list(p) for p in values]


def line(e):
    return {"from": list(e.dxf.start), "to": list(e.dxf.end)}


def circle(e):
    return {"centre": list(e.dxf.center), "radius": e.dxf.radius}


def arc(e):
    return {**circle(e), "start": e.dxf.start_angle, "end": e.dxf.end_angle}


def point(e):
    return {"at": list(e.dxf.location)}


def lwpolyline(e):
    rows = list(e.get_points("xyseb"))
    widths = [[row[2], row[3]] for row in rows]
    if e.dxf.get("const_width", 0.0) and not any(w for pair in widths for w in pair):
        widths = [[e.dxf.const_width] * 2] * len(rows)
    return {
        "closed": e.closed,
        "spatial": False,
        "widths": widths if any(w for p in widths for w in p) else [],
        "vertices": [[row[0], row[1], e.dxf.get("elevation", 0.0), row[4]] for row in rows],
    }


def polyline(e):
    elevation = e.dxf.get("elevation", (0, 0, 0))[2]
    default = e.dxf.get("default_start_width", 0.0), e.dxf.get("default_end_width", 0.0)
    vertices, widths = [], []
    for v in e.vertices:
        if v.dxf.get("flags", 0) & 16:
            continue
        at = v.dxf.location
        vertices.append([at.x, at.y, at.z if e.is_3d_polyline else elevation, v.dxf.get("bulge", 0.0)])
        widths.append([v.dxf.get("start_width", default[0]), v.dxf.get("end_width", default[1])])
    return {
        "closed": e.is_closed,
        "spatial": e.is_3d_polyline,
        "vertices": vertices,
        "widths": widths if any(w for p in widths for w in p) else [],
    }


def text(e):
    dxf = e.dxf
    aligned = dxf.get("halign", 0) != 0 or dxf.get("valign", 0) != 0
    anchor = dxf.align_point if aligned and dxf.hasattr("align_point") else dxf.insert
    return {
        "text": dxf.text,
        "plain": e.plain_text(),
        "at": list(dxf.insert),
        "anchor": list(anchor),
        "height": dxf.height,
        "rotation": dxf.get("rotation", 0.0),
        "style": dxf.get("style", "standard").lower(),
        "width_factor": dxf.get("width", 1.0),
        "oblique": dxf.get("oblique", 0.0),
        "horizontal": dxf.get("halign", 0),
        "vertical": dxf.get("valign", 0),
    }


def mtext(e):
    dxf = e.dxf
    direction = dxf.get("text_direction")
    return {
        "text": e.text,
        "plain": e.plain_text(fast=False),
        "at": list(dxf.insert),
        "height": dxf.char_height,
        "rotation": direction.angle_deg if direction else dxf.get("rotation", 0.0),
        "attachment": dxf.attachment_point,
        "style": dxf.get("style", "standard").lower(),
    }


def insert(e):
    dxf = e.dxf
    return {
        "block": dxf.name.lower(),
        "at": list(dxf.insert),
        "rotation": dxf.get("rotation", 0.0),
        "scale": [dxf.get("xscale", 1.0), dxf.get("yscale", 1.0), dxf.get("zscale", 1.0)],
        "columns": dxf.get("column_count", 1),
        "rows": dxf.get("row_count", 1),
        "spacing": [dxf.get("column_spacing", 0.0), dxf.get("row_spacing", 0.0)],
    }


def ellipse(e):
    dxf = e.dxf
    return {
        "centre": list(dxf.center),
        "major": list(dxf.major_axis),
        "ratio": dxf.ratio,
        "start": dxf.start_param,
        "end": dxf.end_param,
    }


def spline(e):
    return {
        "degree": e.dxf.degree,
        "closed": e.closed,
        "control": points(e.control_points),
        "knots": list(e.knots),
        "weights": list(e.weights),
        "fit": points(e.fit_points),
    }


SHAPES = {
    "LINE": line,
    "CIRCLE": circle,
    "ARC": arc,
    "POINT": point,
    "LWPOLYLINE": lwpolyline,
    "POLYLINE": polyline,
    "TEXT": text,
    "ATTRIB": text,
    "ATTDEF": text,
    "MTEXT": mtext,
    "INSERT": insert,
    "ELLIPSE": ellipse,
    "SPLINE": spline,
}


def is_mesh(e):
    return e.dxftype() == "POLYLINE" and not (e.is_2d_polyline or e.is_3d_polyline)


def entities(layout):
    """Each entity of a layout or block, attributes after their INSERT; other types have an empty shape."""
    made = []
    for e in layout:
        shape = SHAPES.get(e.dxftype()) if not is_mesh(e) else None
        made.append({**common(e), "shape": shape(e) if shape else {}})
        if is_mesh(e):
            made[-1]["type"] = "POLYLINE (mesh)"
        if e.dxftype() == "INSERT":
            made += [{**common(a), "shape": text(a)} for a in e.attribs]
    return made


def layers(document):
    made = {}
    for layer in document.layers:
        made[layer.dxf.name.strip().lower()] = {
            "colour": abs(layer.dxf.color),
            "true_colour": layer.dxf.get("true_color", -1),
            "linetype": layer.dxf.linetype.strip().lower(),
            "off": layer.is_off(),
            "frozen": layer.is_frozen(),
            "locked": layer.is_locked(),
        }
    return made

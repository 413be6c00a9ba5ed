"""Regions as geometries of other modules (shapely, GeoPandas): `__geo_interface__`."""

from ._kerf import flattened

_CHORD = 0.005  # mm, the deviation of the chords of arcs


def _ring(outline):
    return tuple(flattened(outline, _CHORD))


def geometry(region):
    """dict: the region as a MultiPolygon (GeoJSON); arcs become chords that deviate by at most 0.005 mm."""
    return {
        "type": "MultiPolygon",
        "coordinates": [tuple(_ring(outline) for outline in figure) for figure in region.figures()],
    }


def install(region):
    """Gives the compiled class the attribute that other modules ask for."""
    region.__geo_interface__ = property(geometry)

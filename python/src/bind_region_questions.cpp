// Questions about regions and outlines in Python: nesting, clearance, engagement, clipping, the medial axis,
// segments with their circles, points at a length; and transforms of regions.
#include <cmath>

#include "geom/medial/medial_axis.h"
#include "region_binding.h"

namespace kerf::python {
namespace py = pybind11;
namespace {

// Docstrings.
constexpr const char* kClearance = R"(The distance of a point from the boundary, or of each of several points.

Below 0 outside. For a point inside it is the radius of the largest tool whose centre may be there.

Parameters
----------
point : (float, float) or sequence of (float, float)
    x and y, mm.

Returns
-------
float or None, or a list of them for several points
    The distance from the boundary, mm; below 0 outside. None for an empty region.
)";

constexpr const char* kInside = R"(The angles at which a circle lies inside the region.

Parameters
----------
circle : (float, float, float)
    x, y and radius in mm.

Returns
-------
list of (float, float)
    Start and sweep, degrees, counter-clockwise from +x.
)";

constexpr const char* kEngagement = R"(The engagement angle of a tool, where the region is the material.

Parameters
----------
tool : (float, float, float)
    x, y and radius in mm.
direction : (float, float)
    The direction of feed; its length does not matter.

Returns
-------
float
    Degrees from 0 to 180: how much of the leading half of the circle lies inside.
)";

constexpr const char* kNesting = R"(Which outline is around which.

Returns
-------
list of (int or None, int)
    By outline: the index of the smallest outline around it, or None, and the number of outlines around it.
)";

constexpr const char* kDistance = R"(The distance from another region.

Parameters
----------
other : Region
    The other region.

Returns
-------
(float, (float, float), (float, float)) or None
    The distance, mm, and the nearest points of both; 0 where they overlap or touch. None where a region is
    empty.
)";

constexpr const char* kDivide = R"(A path divided where it enters and leaves the region.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
tolerance : float
    Points closer than this are one point, mm.

Returns
-------
list of ({'inside', 'outside', 'boundary'}, list of points and arcs, int)
    In the direction of the path: the location, the piece, and the index of the segment of the path on which
    it starts.
)";

constexpr const char* kClip = R"(The pieces of a path with one location.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
location : {'inside', 'outside', 'boundary'}
tolerance : float
    Points closer than this are one point, mm.

Returns
-------
list of paths
    The pieces in the direction of the path, as points and arcs, mm.
)";

constexpr const char* kMedialAxis =
    R"(The centres and radii of the circles inside that touch the boundary twice.

The tip of a V-shaped tool that follows it, at a depth for each radius, cuts the region to its boundary.

Parameters
----------
chord : float
    mm, above 0: the tolerance of chords for arcs, and of the result.
smooth : float
    Degrees: the axis does not reach into corners that turn by less.

Returns
-------
(list of (float, float, float), list of (int, int, list of (float, float, float)))
    The nodes, each x, y and radius. The edges: the indices of two nodes, and points (x, y, radius) from one
    to the other.
)";

constexpr const char* kLargestCircle = R"(The largest circle inside the region.

Parameters
----------
chord : float
    mm, above 0: the radius is at most a few times this below the largest possible.

Returns
-------
(float, float, float) or None
    x, y and radius, mm; None for an empty region.
)";

constexpr const char* kMerged = R"(The region with neighbouring segments of one line or circle as one segment.

Parameters
----------
within : float
    mm: the maximum distance of the removed points from the result.

Returns
-------
Region
    A new one; mm.
)";

constexpr const char* kSegments = R"(The segments of an outline.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.

Returns
-------
list of dict
    ``start``, ``end``, ``length`` and ``kind``, which is ``'line'`` or ``'arc'``; of arcs also ``centre``,
    ``radius``, ``turn`` (``'cw'`` or ``'ccw'``) and ``sweep`` in degrees.

Examples
--------
>>> line, arc = kerf.segments([(0, 0), (10, 0), (15, 5, 10, 10)])
>>> line["length"], arc["centre"], arc["turn"]
(10.0, (10.0, 5.0), 'ccw'))";

constexpr const char* kPointAt = R"(The point at a length from the start of a path, with its direction.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
length : float, or sequence of float
    mm from the start; the ends beyond the path.

Returns
-------
(float, float, float, float), or a list of them for several lengths
    The position, mm, and the unit direction of travel: x, y, dx, dy.

Examples
--------
>>> kerf.point_at([(0, 0), (40, 0)], 10)
(10.0, 0.0, 1.0, 0.0))";

py::tuple pair_of(Point2 p) { return py::make_tuple(p.x, p.y); }

Circle circle_of(const py::object& value, const char* argument) {
  const Point3 numbers = to_point3(value, argument);
  if (!(numbers.z > 0.0)) throw py::value_error(std::string(argument) + ": the radius must be above 0");
  return {{numbers.x, numbers.y}, mm(numbers.z)};
}

Location location_of(const std::string& name) {
  if (name == "inside") return Location::inside;
  if (name == "outside") return Location::outside;
  if (name == "boundary") return Location::boundary;
  throw py::value_error("unknown location '" + name + "'; known: inside, outside, boundary");
}

py::object clearance_of(const PyRegion& region, const py::object& point) {
  return each_point(point, [&](Point2 p) -> py::object {
    const auto found = region.search().clearance(p);
    if (!found) return py::none();
    return py::float_(found->mm());
  });
}

py::list inside(const PyRegion& region, const py::object& circle) {
  py::list list;
  for (const AngleRange& range : region.search().inside(circle_of(circle, "circle")))
    list.append(py::make_tuple(range.start.deg(), range.sweep.deg()));
  return list;
}

double engagement_of(const PyRegion& region, const py::object& tool, const py::object& direction) {
  const Point2 towards = to_point2(direction, "direction");
  if (towards == Point2{}) throw py::value_error("direction must have a length");
  return region.search().engagement(circle_of(tool, "tool"), towards).deg();
}

py::list nesting_of(const PyRegion& region) {
  const Nesting tree = nesting(region.region);
  py::list list;
  for (std::size_t i = 0; i < tree.parents.size(); ++i) {
    const std::uint32_t parent = tree.parents[i];
    list.append(py::make_tuple(
        parent == Nesting::kNone ? py::object(py::none()) : py::object(py::int_(parent)), tree.depths[i]));
  }
  return list;
}

py::object distance_of(const PyRegion& a, const PyRegion& b) {
  const auto found = nearest_points(a.region, b.region);
  if (!found) return py::none();
  return py::make_tuple(found->distance.mm(), pair_of(found->first), pair_of(found->second));
}

py::list pieces_of(const PyRegion& region, const py::object& path, double tolerance) {
  const Outline outline = path_of(path);
  py::list list;
  for (const PathPiece& piece :
       compute(options_of(tolerance, "divide"),
               [&](const RegionOptions&o, Diagnostics&d) { return divide(outline, region.region, o, d); }))
    list.append(py::make_tuple(name_of(piece.location), rows_of(piece.path), piece.first_segment));
  return list;
}

py::list clipped(const PyRegion& region, const py::object& path, const std::string& location,
                 double tolerance) {
  const Outline outline = path_of(path);
  const Location wanted = location_of(location);
  return list_of(compute(options_of(tolerance, "clip"), [&](const RegionOptions& o, Diagnostics& d) {
    return clip(outline, region.region, wanted, o, d);
  }));
}

py::tuple row_of(const MedialPoint& p) { return py::make_tuple(p.at.x, p.at.y, p.radius.mm()); }

py::tuple axis_of(const PyRegion& region, double chord, double smooth) {
  RegionOptions options = options_of(kDefaultTolerance, "medial_axis");
  options.tolerance.chord = mm(finite_number(chord, "chord"));
  const Angle angle = degrees(finite_number(smooth, "smooth"));
  const MedialAxis axis = compute(options, [&](const RegionOptions& o, Diagnostics& d) {
    return medial_axis(region.region, {o, angle}, d);
  });
  py::list nodes, edges;
  for (const MedialPoint& node : axis.nodes) nodes.append(row_of(node));
  for (const MedialEdge& edge : axis.edges) {
    py::list points;
    for (const MedialPoint& p : edge.points) points.append(row_of(p));
    edges.append(py::make_tuple(edge.from, edge.to, points));
  }
  return py::make_tuple(nodes, edges);
}

py::object largest_circle(const PyRegion& region, double chord) {
  RegionOptions options = options_of(kDefaultTolerance, "largest_circle");
  options.tolerance.chord = mm(finite_number(chord, "chord"));
  if (region.region.empty()) return py::none();
  const Circle circle = compute(options, [&](const RegionOptions& o, Diagnostics& d) {
    return largest_inscribed_circle(region.region, o, d);
  });
  return py::make_tuple(circle.centre.x, circle.centre.y, circle.radius.mm());
}

PyRegion rotated_by(const PyRegion& region, double angle, const py::object& about) {
  return PyRegion(rotated(region.region, to_point2(about, "about"), degrees(finite_number(angle, "angle"))));
}

PyRegion scaled_by(const PyRegion& region, const py::object& factor, const py::object& about) {
  const Point2 fixed = to_point2(about, "about");
  if (!py::isinstance<py::sequence>(factor) && PyNumber_Check(factor.ptr()) == 0)
    throw py::type_error("factor must be a number, or (factor x, factor y)");
  const Point2 by = py::isinstance<py::sequence>(factor)
                        ? to_point2(factor, "factor")
                        : Point2{factor.cast<double>(), factor.cast<double>()};
  for (const double f : {by.x, by.y})
    if (!std::isfinite(f) || f == 0.0) throw py::value_error("factor must be a number other than 0");
  return PyRegion(placed(region.region, {{fixed.x - by.x * fixed.x, fixed.y - by.y * fixed.y}, by}));
}

py::list segments_of(const py::object& path) {
  const Outline outline = path_of(path);
  py::list list;
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const Point2 from = outline.point(i);
    const Segment& s = outline.segments[i];
    py::dict row;
    row["kind"] = "line";
    row["start"] = pair_of(from);
    row["end"] = pair_of(s.to);
    row["length"] = length(Outline{from, {s}}).mm();
    if (const auto arc = arc_circle(from, s)) {
      row["kind"] = "arc";
      row["centre"] = pair_of(arc->centre);
      row["radius"] = arc->radius;
      row["turn"] = arc->turn == Turn::ccw ? "ccw" : "cw";
      row["sweep"] = arc->sweep.deg();
    }
    list.append(row);
  }
  return list;
}

py::object points_at(const py::object& path, const py::object& length) {
  const Outline outline = path_of(path);
  if (kerf::length(outline).mm() == 0.0) throw py::value_error("the path has no length");
  const auto at = [&](const py::handle& value) {
    const CurvePoint p = at_length(outline, mm(finite_number(value.cast<double>(), "length")));
    return py::make_tuple(p.at.x, p.at.y, std::cos(p.heading.rad()), std::sin(p.heading.rad()));
  };
  if (!py::isinstance<py::sequence>(length)) return at(length);
  py::list list;
  for (const py::handle& value : length) list.append(at(value));
  return list;
}

}  // namespace

void bind_region_questions(py::class_<PyRegion>& region) {
  const auto origin = py::make_tuple(0.0, 0.0);
  region.def("clearance", &clearance_of, py::arg("point"), kClearance)
      .def("inside", &inside, py::arg("circle"), kInside)
      .def("engagement", &engagement_of, py::arg("tool"), py::arg("direction"), kEngagement)
      .def("nesting", &nesting_of, kNesting)
      .def("distance", &distance_of, py::arg("other"), kDistance)
      .def("divide", &pieces_of, py::arg("path"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance,
           kDivide)
      .def("clip", &clipped, py::arg("path"), py::arg("location") = "inside", py::kw_only(),
           py::arg("tolerance") = kDefaultTolerance, kClip)
      .def("medial_axis", &axis_of, py::kw_only(), py::arg("chord") = 0.001, py::arg("smooth") = 0.18,
           kMedialAxis)
      .def("largest_circle", &largest_circle, py::kw_only(), py::arg("chord") = 0.001, kLargestCircle)
      .def(
          "moved",
          [](const PyRegion& r, double x, double y) {
            return PyRegion(placed(r.region, {{finite_number(x, "x"), finite_number(y, "y")}, {1.0, 1.0}}));
          },
          py::arg("x"), py::arg("y"), R"(Move the region.

Parameters
----------
x, y : float
    mm.

Returns
-------
Region
    A new one; mm.)")
      .def("rotated", &rotated_by, py::arg("angle"), py::arg("about") = origin,
           R"(Rotate the region counter-clockwise.

Parameters
----------
angle : float
    Degrees.
about : (float, float)
    Centre, mm.

Returns
-------
Region
    A new one; mm.)")
      .def("scaled", &scaled_by, py::arg("factor"), py::arg("about") = origin,
           R"(Scale the region; a negative factor mirrors it.

Parameters
----------
factor : float, or sequence of float
    One for both axes, or (factor x, factor y).
about : (float, float)
    Centre, mm.

Returns
-------
Region
    A new one; mm.)")
      .def(
          "merged",
          [](const PyRegion& r, double within) {
            return PyRegion(merged(r.region, mm(finite_number(within, "within"))));
          },
          py::arg("within") = kDefaultTolerance, kMerged);
}

void bind_outline_questions(py::module_& m) {
  m.def("segments", &segments_of, py::arg("path"), kSegments);
  m.def("point_at", &points_at, py::arg("path"), py::arg("length"), kPointAt);
}

}  // namespace kerf::python

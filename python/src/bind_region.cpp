// Regions, paths and fitted curves in Python. Outlines are lists as in cnc25d_api: points (x, y), and arcs
// (via x, via y, x, y) from the point before; three numbers alone are a circle.
#include <algorithm>
#include <memory>
#include <utility>

#include "base/number.h"
#include "bindings.h"
#include "region_binding.h"

#include "kerf/geom/fit.h"

namespace kerf::python {
namespace py = pybind11;

py::list rows_of(const Outline& outline) {
  py::list list;
  list.append(py::make_tuple(outline.start.x, outline.start.y));
  for (const Segment& s : outline.segments) {
    if (s.via)
      list.append(py::make_tuple(s.via->x, s.via->y, s.to.x, s.to.y));
    else
      list.append(py::make_tuple(s.to.x, s.to.y));
  }
  return list;
}

RegionOptions options_of(double tolerance, const char* call) {
  RegionOptions options;
  options.tolerance.weld = mm(finite_number(tolerance, "tolerance"));
  options.name = call;
  options.where = script_location(call);
  return options;
}

FillRule rule_of(const std::string& name) {
  if (name == "even_odd") return FillRule::even_odd;
  if (name == "nonzero") return FillRule::nonzero;
  if (name == "positive") return FillRule::positive;
  throw py::value_error("unknown fill '" + name + "'; known: even_odd, nonzero, positive");
}

namespace {

// Docstrings.
constexpr const char* kRegion = R"(A part of the plane bounded by lines and arcs.

Regions are immutable. ``a | b`` is the union, ``a & b`` the intersection, ``a - b`` the difference, ``a ^ b``
the symmetric difference. Arcs stay arcs.

Parameters
----------
outlines : sequence of outlines
    An outline is a list of points ``(x, y)`` in mm; ``(via_x, via_y, x, y)`` is an arc from the previous
    point through the via point. The last point equals the first one. Three numbers ``(x, y, radius)`` are a
    circle. Outlines may intersect themselves and each other.
fill : {'nonzero', 'even_odd', 'positive'}
    A point is inside if the winding number of the outlines about it is not 0, is odd, or is above 0
    (counter-clockwise).
tolerance : float
    Points closer than this are one point, mm.

Raises
------
kerf.Error
    If an outline is open or its numbers are not finite. ``diagnostics`` names the element.

Examples
--------
>>> plate = kerf.Region([[(0, 0), (60, 0), (60, 40), (0, 40), (0, 0)]])
>>> ring = plate - kerf.Region([(30, 20, 8)])
>>> round(ring.area, 2), ring.bounds
(2198.94, (0.0, 0.0, 60.0, 40.0)))";

constexpr const char* kOffset =
    R"(The region grown or shrunk by a distance.

Parameters
----------
distance : float
    mm; above 0: all points within this distance of the region; below 0: all points of the region that are at
    least this far from its boundary.
join : {'round', 'mitre'}
    The shape of corners: outer ones if the region grows, inner ones if it shrinks.
mitre_limit : float
    The maximum distance of a mitre's tip from the corner as a multiple of the offset distance, at least 1;
    longer mitres are cut off square at the limit.
tolerance : float
    Points closer than this are one point, mm.

Returns
-------
Region
    A new one; mm.
)";

constexpr const char* kOffsetWithSources =
    R"(An offset, with the segment of this region to which each of its segments is parallel.

Parameters
----------
distance : float
    As of `offset`, mm.
join : {'round', 'mitre'}
    Corners, as of `offset`.
mitre_limit : float
    As of `offset`.
tolerance : float
    Maximum deviation of arcs, mm.

Returns
-------
tuple (Region, list)
    By outline and segment of the offset, a tuple (outline, segment, corner): the indices of the segment of
    this region that it is parallel to, or (if corner is True) around whose end it goes.
)";

constexpr const char* kLocate = R"(The location of a point, or of each of several points.

Parameters
----------
point : (float, float) or sequence of (float, float)
    mm.
margin : float
    Points up to this distance from the boundary are on it, mm.

Returns
-------
{'inside', 'outside', 'boundary'}, or a list of them for several points
    On the boundary is within `margin` of it.
)";

constexpr const char* kNearest =
    R"(The point of the boundary that is nearest to a point, or to each of several.

Parameters
----------
point : (float, float) or sequence of (float, float)
    mm.

Returns
-------
(float, float, float) or None, or a list of them for several points
    x, y and the distance, mm; None for an empty region.
)";

constexpr const char* kFigures = R"(The connected parts of the region.

Returns
-------
list of lists of outlines
    For each part its outer boundary, then its holes.
)";

constexpr const char* kBuffer =
    R"(The buffer of a path: all points within a distance, as cleared by a mill of that radius.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed. It may intersect itself.
half_width : float
    mm, above 0.
ends : {'round', 'butt'}
    Shape of the ends of an open path; 'butt' ends at its end points.
tolerance : float
    Points closer than this are one point, mm.

Returns
-------
Region
    A new one; mm.

Examples
--------
>>> slot = kerf.widen([(0, 0), (40, 0)], 3)
>>> round(slot.area, 2)
268.27)";

constexpr const char* kOffsetPath =
    R"(The offset curve of a path: the curve on one side of it at a constant distance.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
to_left : float
    Distance to the left of the path, mm; below 0 to the right.
tolerance : float
    Points closer than this are one point, mm.

Returns
-------
list of outlines
    In the direction of the path; several if it is divided, none if nothing remains.

Examples
--------
>>> kerf.parallel([(0, 0), (40, 0)], 5)
[[(0.0, 5.0), (40.0, 5.0)]])";

constexpr const char* kSelfIntersections =
    R"(The self-intersections of an outline, including points where it touches itself.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
tolerance : float
    Segments up to this distance touch, mm.

Returns
-------
list of (float, float, int, int)
    x and y in mm, and the indices of both segments, from 0.

Examples
--------
>>> kerf.self_meetings([(0, 0), (10, 10), (10, 0), (0, 10)])
[(5.0, 5.0, 0, 2)])";

constexpr const char* kFitArcs = R"(Lines and arcs along a polyline.

Parameters
----------
points : list of (x, y)
    mm; a closed polyline repeats its first point at the end.
within : float
    Maximum distance between polyline and result, mm, above 0.

Returns
-------
list of points and arcs
    The path, mm.

Examples
--------
>>> import math
>>> points = [(10 * math.cos(i / 50), 10 * math.sin(i / 50)) for i in range(100)]
>>> len(kerf.fit_arcs(points, 0.01))
2)";

constexpr const char* kFitBezier = R"(A Bezier curve as a chain of tangent arcs.

Parameters
----------
control : list of (x, y)
    2 to 26 control points in mm.
within : float
    Maximum distance of the arcs from the curve, mm, above 0.

Returns
-------
list of points and arcs
    The path, mm.

Examples
--------
>>> path = kerf.fit_bezier([(0, 0), (10, 20), (30, 20), (40, 0)], 0.01)
>>> path[0], path[-1][-2:]
((0.0, 0.0), (40.0, 0.0)))";

constexpr const char* kFitSpline = R"(A B-spline as a chain of tangent arcs.

Parameters
----------
control : list of (x, y)
    mm.
knots : list of float
    len(control) + degree + 1 numbers, not decreasing.
degree : int
    1 to 25.
weights : list of float
    Empty, or one from 0.001 to 1000 for each control point.
within : float
    Maximum distance of the arcs from the curve, mm, above 0.

Returns
-------
list of points and arcs
    The path, mm.

Examples
--------
>>> path = kerf.fit_spline([(0, 0), (10, 20), (30, 20), (40, 0)], [0, 0, 0, 0, 1, 1, 1, 1])
>>> path[0], path[-1][-2:]
((0.0, 0.0), (40.0, 0.0)))";

constexpr const char* kFlattened = R"(An outline as a polyline: arcs become chords.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed.
chord : float
    Maximum distance of a chord from its arc, mm. A full circle has 16 to 4096 chords.

Returns
-------
list of (x, y)
    Points of the path, mm, from its start to its end.

Examples
--------
>>> points = kerf.flattened([(0, 0), (5, 5, 10, 0)], 0.1)
>>> points[0], points[-1]
((0.0, 0.0), (10.0, 0.0)))";

}  // namespace

py::list list_of(const std::vector<Outline>& outlines) {
  py::list list;
  for (const Outline& outline : outlines) list.append(rows_of(outline));
  return list;
}

const char* name_of(Location location) {
  switch (location) {
    case Location::inside: return "inside";
    case Location::boundary: return "boundary";
    case Location::outside: break;
  }
  return "outside";
}

namespace {

py::list points_list(const std::vector<Point2>& points) {
  py::list list;
  for (const Point2 p : points) list.append(py::make_tuple(p.x, p.y));
  return list;
}

PyRegion region_of(const py::object& outlines, const std::string& fill, double tolerance) {
  const RegionOptions options = options_of(tolerance, "Region");
  const FillRule rule = rule_of(fill);
  const Figure figure = figure_of(outlines);
  std::vector<Outline> loops;
  for (const auto& shape : figure) {
    if (const auto* outline = std::get_if<Outline>(&shape)) {
      loops.push_back(*outline);
    } else {
      const Region disc = compute(
          options, [&](const RegionOptions& o, Diagnostics& d) { return make_region(Figure{shape}, o, d); });
      loops.insert(loops.end(), disc.loops.begin(), disc.loops.end());
    }
  }
  return PyRegion(compute(
      options, [&](const RegionOptions& o, Diagnostics& d) { return make_region(loops, rule, o, d); }));
}

PyRegion combined(const PyRegion& a, const PyRegion& b, Boolean what, const char* call) {
  const RegionOptions options = options_of(kDefaultTolerance, call);
  return PyRegion(compute(options, [&](const RegionOptions& o, Diagnostics& d) {
                    return combine(a.region, b.region, what, o, d);
                  }).region);
}

py::object location_of(const PyRegion& region, const py::object& point, double margin) {
  const Length within = mm(finite_number(margin, "margin"));
  return each_point(
      point, [&](Point2 p) -> py::object { return py::str(name_of(region.search().locate(p, within))); });
}

py::object bounds_of(const PyRegion& region) {
  const Box2 box = bounds(region.region);
  if (box.empty()) return py::none();
  return py::make_tuple(box.low.x, box.low.y, box.high.x, box.high.y);
}

py::object nearest_to(const PyRegion& region, const py::object& point) {
  return each_point(point, [&](Point2 p) -> py::object {
    const auto found = region.search().nearest(p);
    if (!found) return py::none();
    return py::make_tuple(found->at.x, found->at.y, found->distance.mm());
  });
}

PathEnds ends_of(const std::string& name) {
  if (name == "round") return PathEnds::round;
  if (name == "butt") return PathEnds::butt;
  throw py::value_error("unknown ends '" + name + "'; known: round, butt");
}

Offset offset_of(const PyRegion& r, double distance, const std::string& join, double limit, double tolerance,
                 const char* call) {
  const RegionOptions options = options_of(tolerance, call);
  if (join != "round" && join != "mitre")
    throw py::value_error("unknown join '" + join + "'; known: round, mitre");
  const JoinOptions joins{join == "mitre" ? Join::mitre : Join::round, finite_number(limit, "mitre_limit")};
  finite_number(distance, "distance");
  return compute(options, [&](const RegionOptions& o, Diagnostics& d) {
    return offset(r.region, mm(distance), joins, o, d);
  });
}

/// Equal regions have equal ones.
py::tuple hashable(const Region& region) {
  py::list outlines;
  for (const Outline& outline : region.loops) outlines.append(py::tuple(rows_of(outline)));
  return py::tuple(outlines);
}

/// A region of a list of its outlines, as they are.
PyRegion region_of_state(const py::list& outlines) {
  Region region;
  for (const py::handle outline : outlines) region.loops.push_back(path_of(outline));
  return PyRegion(std::move(region));
}

/// Equality, copies, pickling, operators.
void bind_region_values(py::class_<PyRegion>& region) {
  region
      .def(
          "__or__", [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::unite, "|"); },
          py::is_operator())
      .def(
          "__and__",
          [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::intersect, "&"); },
          py::is_operator())
      .def(
          "__sub__",
          [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::subtract, "-"); },
          py::is_operator())
      .def(
          "__xor__",
          [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::exclude, "^"); },
          py::is_operator())
      .def(
          "__eq__", [](const PyRegion& a, const PyRegion& b) { return a.region == b.region; },
          py::is_operator())
      .def("__hash__", [](const PyRegion& r) { return py::hash(hashable(r.region)); })
      .def("__copy__", [](const PyRegion& r) { return PyRegion(r.region); })
      .def(
          "__deepcopy__", [](const PyRegion& r, const py::dict&) { return PyRegion(r.region); },
          py::arg("memo"))
      .def(py::pickle([](const PyRegion& r) { return list_of(r.region.loops); }, &region_of_state));
}

void bind_region_class(py::module_& m) {
  py::class_<PyRegion> region(m, "Region", kRegion);
  region
      .def(py::init(&region_of), py::arg("outlines") = py::tuple(), py::kw_only(),
           py::arg("fill") = "nonzero", py::arg("tolerance") = kDefaultTolerance)
      .def_property_readonly(
          "outlines", [](const PyRegion& r) { return list_of(r.region.loops); },
          "list of outlines: closed, not intersecting; outer ones counter-clockwise, holes clockwise.")
      .def_property_readonly(
          "area", [](const PyRegion& r) { return area(r.region); }, "float: mm2.")
      .def_property_readonly(
          "length", [](const PyRegion& r) { return length(r.region).mm(); },
          "float: length of the boundary, mm.")
      .def_property_readonly(
          "bounds", &bounds_of,
          "(float, float, float, float) or None: low x, low y, high x, high y, mm; None if empty.")
      .def("__bool__", [](const PyRegion& r) { return !r.region.empty(); })
      .def("__repr__",
           [](const PyRegion& r) {
             return "<kerf.Region of " + std::to_string(r.region.loops.size()) + " outlines, " +
                    number_text(area(r.region), 4) + " mm2>";
           })
      .def(
          "offset",
          [](const PyRegion& r, double distance, const std::string& join, double limit, double tolerance) {
            return PyRegion(offset_of(r, distance, join, limit, tolerance, "offset").region);
          },
          py::arg("distance"), py::kw_only(), py::arg("join") = "round", py::arg("mitre_limit") = 2.0,
          py::arg("tolerance") = kDefaultTolerance, kOffset)
      .def(
          "offset_with_sources",
          [](const PyRegion& r, double distance, const std::string& join, double limit, double tolerance) {
            Offset made = offset_of(r, distance, join, limit, tolerance, "offset_with_sources");
            py::list loops;
            for (const auto& sources : made.sources) {
              py::list list;
              for (const BoundaryElement& s : sources)
                list.append(py::make_tuple(s.loop, s.segment, s.corner));
              loops.append(list);
            }
            return py::make_tuple(PyRegion(std::move(made.region)), loops);
          },
          py::arg("distance"), py::kw_only(), py::arg("join") = "round", py::arg("mitre_limit") = 2.0,
          py::arg("tolerance") = kDefaultTolerance, kOffsetWithSources)
      .def("locate", &location_of, py::arg("point"), py::kw_only(), py::arg("margin") = 0.0, kLocate)
      .def("nearest", &nearest_to, py::arg("point"), kNearest)
      .def(
          "figures",
          [](const PyRegion& r) {
            py::list list;
            for (const Figure& figure : figures(r.region)) {
              py::list outlines;
              for (const auto& shape : figure) outlines.append(rows_of(std::get<Outline>(shape)));
              list.append(outlines);
            }
            return list;
          },
          kFigures);
  bind_region_values(region);
  bind_region_questions(region);
}

void bind_paths(py::module_& m) {
  m.def(
      "widen",
      [](const py::object& path, double half_width, const std::string& ends, double tolerance) {
        const RegionOptions options = options_of(tolerance, "widen");
        const PathEnds how = ends_of(ends);
        const Outline outline = path_of(path);
        finite_number(half_width, "half_width");
        return PyRegion(compute(options, [&](const RegionOptions& o, Diagnostics& d) {
          return buffer(outline, mm(half_width), how, o, d);
        }));
      },
      py::arg("path"), py::arg("half_width"), py::kw_only(), py::arg("ends") = "round",
      py::arg("tolerance") = kDefaultTolerance, kBuffer);
  m.def(
      "parallel",
      [](const py::object& path, double to_left, double tolerance) {
        const RegionOptions options = options_of(tolerance, "parallel");
        const Outline outline = path_of(path);
        finite_number(to_left, "to_left");
        return list_of(compute(options, [&](const RegionOptions& o, Diagnostics& d) {
          return offset_path(outline, mm(to_left), o, d);
        }));
      },
      py::arg("path"), py::arg("to_left"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance,
      kOffsetPath);
  m.def(
      "self_meetings",
      [](const py::object& path, double tolerance) {
        const RegionOptions options = options_of(tolerance, "self_meetings");
        const Outline outline = path_of(path);
        py::list list;
        for (const SelfIntersection& s : compute(options, [&](const RegionOptions&o, Diagnostics&d) {
               return self_intersections(outline, o, d);
             }))
          list.append(py::make_tuple(s.at.x, s.at.y, s.first, s.second));
        return list;
      },
      py::arg("path"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance, kSelfIntersections);
}

/// Binds a function that takes points and a tolerance in mm.
template <class Fit>
void bind_point_fit(py::module_& m, const char* name, const char* points_name, const char* text, Fit fit) {
  m.def(
      name,
      [name, fit](const py::object& points, double within) {
        const std::vector<Point2> read = points_of(points);
        const FitOptions options{name, script_location(name)};
        return rows_of(compute([&](Diagnostics& d) { return fit(read, mm(within), options, d); }));
      },
      py::arg(points_name), py::arg("within"), text);
}

void bind_fits(py::module_& m) {
  bind_point_fit(m, "fit_arcs", "points", kFitArcs,
                 [](const auto& points, Length within, const FitOptions& options, Diagnostics& d) {
                   return fit_arcs(points, within, options, d);
                 });
  bind_point_fit(m, "fit_bezier", "control", kFitBezier,
                 [](const auto& points, Length within, const FitOptions& options, Diagnostics& d) {
                   return fit_bezier(points, within, options, d);
                 });
  m.def(
      "fit_spline",
      [](const py::object& control, const std::vector<double>& knots, int degree,
         const std::vector<double>& weights, double within) {
        const Spline spline{degree, points_of(control), knots, weights};
        const FitOptions options{"fit_spline", script_location("fit_spline")};
        return rows_of(compute([&](Diagnostics& d) { return fit_spline(spline, mm(within), options, d); }));
      },
      py::arg("control"), py::arg("knots"), py::kw_only(), py::arg("degree") = 3,
      py::arg("weights") = std::vector<double>(), py::arg("within") = 0.01, kFitSpline);
  m.def(
      "flattened",
      [](const py::object& path, double chord) {
        if (finite_number(chord, "chord") <= 0.0) throw py::value_error("chord must be above 0 mm");
        return points_list(flattened(path_of(path), mm(chord)));
      },
      py::arg("path"), py::arg("chord"), kFlattened);
}

}  // namespace

void bind_region(py::module_& m) {
  bind_region_class(m);
  bind_paths(m);
  bind_fits(m);
  bind_outline_questions(m);
}

}  // namespace kerf::python

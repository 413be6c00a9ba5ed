// Regions, paths and fitted curves in Python. Outlines are lists as in cnc25d_api: points (x, y), and arcs
// (via x, via y, x, y) from the point before; three numbers alone are a circle.
#include <memory>

#include "bindings.h"
#include "region_binding.h"

#include "kerf/fit.h"

namespace kerf::python {
namespace py = pybind11;

py::list rows_of(const Outline& outline) {
  py::list list;
  list.append(py::make_tuple(outline.start.x, outline.start.y));
  for (const Segment& s : outline.segments)
    list.append(s.via ? py::make_tuple(s.via->x, s.via->y, s.to.x, s.to.y) : py::make_tuple(s.to.x, s.to.y));
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

// The texts of help().
constexpr const char* kRegion = R"(A part of the plane bounded by lines and arcs.

Regions do not change; operators and methods make new ones. ``a | b`` is the union, ``a & b`` what both have
in common, ``a - b`` the first without the second, ``a ^ b`` what exactly one of them has. Arcs stay arcs.

Parameters
----------
outlines : sequence of outlines
    An outline is a list of points ``(x, y)`` in mm, where ``(via_x, via_y, x, y)`` makes an arc from the
    point before through the via point; its last point is its first. Three numbers ``(x, y, radius)`` are a
    circle.
    Outlines may cross themselves and each other.
fill : {'nonzero', 'even_odd', 'positive'}
    What is inside: what an outline goes around at all, what outlines go around an odd number of times, or
    what they go around counter-clockwise more often than clockwise.
tolerance : float
    Points closer than this are one, in mm.

Raises
------
kerf.Error
    Where an outline is open or its numbers are not finite. ``diagnostics`` has the element.
)";

constexpr const char* kOffset =
    R"(All points within a distance of the region, or those at least so far inside.

Parameters
----------
distance : float
    mm; above 0 the region grows, with round outer corners, below 0 it shrinks.
tolerance : float
    Points closer than this are one, in mm.

Returns
-------
Region
)";

constexpr const char* kLocate = R"(Where a point lies.

Parameters
----------
point : (float, float)
margin : float
    What is no further than this from the boundary counts as on it, in mm.

Returns
-------
str
    ``'inside'``, ``'outside'`` or ``'boundary'``.
)";

constexpr const char* kNearest = R"(The point of the boundary that is nearest to a point.

Parameters
----------
point : (float, float)

Returns
-------
tuple (x, y, distance), or None for an empty region
)";

constexpr const char* kFigures = R"(Each connected part by itself.

Returns
-------
list of lists of outlines
    The first of each is the outside, the others are its holes.
)";

constexpr const char* kWiden =
    R"(All points within a distance of a path: what a mill of that radius clears along it.

Parameters
----------
path : list of points and arcs, or a circle
    As an outline of `Region`; open or closed, and it may cross itself.
half_width : float
    mm, above 0.
ends : {'round', 'butt'}
    Butt ends stop exactly at the path's ends.
tolerance : float
    Points closer than this are one, in mm.

Returns
-------
Region
)";

constexpr const char* kParallel = R"(The curve beside a path that keeps a distance from all of it.

Parameters
----------
path : list of points and arcs, or a circle
to_left : float
    mm; below 0 it runs on the right.
tolerance : float
    Points closer than this are one, in mm.

Returns
-------
list of outlines
    In the sense of the path; several where it is cut up, none where nothing is left.
)";

constexpr const char* kSelfMeetings = R"(Where an outline crosses or touches itself.

Parameters
----------
path : list of points and arcs, or a circle
tolerance : float
    What is no further apart than this touches, in mm.

Returns
-------
list of (x, y, first, second)
    Place, and the numbers of both segments, from 0.
)";

constexpr const char* kFitArcs = R"(Lines and arcs along a polyline.

Parameters
----------
points : list of (x, y)
    mm; a closed polyline repeats its first point at the end.
within : float
    mm, above 0: neither strays further from the other.

Returns
-------
list of points and arcs
)";

constexpr const char* kFitBezier = R"(A Bezier curve as arcs that keep its direction where they meet.

Parameters
----------
control : list of (x, y)
    2 to 26 control points in mm.
within : float
    mm, above 0: how far the arcs may stray.

Returns
-------
list of points and arcs
)";

constexpr const char* kFitSpline = R"(A B-spline as arcs that keep its direction where they meet.

Parameters
----------
control : list of (x, y)
    mm.
knots : list of float
    As many as control points and degree and 1; never falling.
degree : int
    1 to 25.
weights : list of float
    None, or one from 0.001 to 1000 for each control point.
within : float
    mm, above 0: how far the arcs may stray.

Returns
-------
list of points and arcs
)";

constexpr const char* kFlattened = R"(An outline with chords for its arcs.

Parameters
----------
path : list of points and arcs, or a circle
chord : float
    mm: how far a chord may stray from its arc. At least 16 chords are made of a full circle, at most 4096.

Returns
-------
list of (x, y)
)";

/// A row of numbers: points and arcs of outlines, circles.
struct Row {
  double number[4];
  std::size_t count;
};

bool is_row_of_numbers(const py::handle& value) {
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) return false;
  const auto sequence = py::reinterpret_borrow<py::sequence>(value);
  return sequence.size() > 0 && PyNumber_Check(py::object(sequence[0]).ptr()) != 0 &&
         !py::isinstance<py::sequence>(py::object(sequence[0]));
}

Row row_of(const py::handle& value, const std::string& place) {
  const std::string expected = place + ": 2 numbers (a point) or 4 (an arc's via point and end) are expected";
  const auto fast = py::reinterpret_steal<py::object>(
      py::isinstance<py::str>(value) ? nullptr : PySequence_Fast(value.ptr(), ""));
  if (!fast) {
    PyErr_Clear();
    throw py::type_error(expected);
  }
  Row row{{}, static_cast<std::size_t>(PySequence_Fast_GET_SIZE(fast.ptr()))};
  if (row.count != 2 && row.count != 4) throw py::value_error(expected);
  for (std::size_t i = 0; i < row.count; ++i) {
    row.number[i] = PyFloat_AsDouble(PySequence_Fast_GET_ITEM(fast.ptr(), static_cast<Py_ssize_t>(i)));
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw py::type_error(expected);
    }
  }
  return row;
}

py::sequence sequence_of(const py::handle& value, const std::string& what) {
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) throw py::type_error(what);
  return py::reinterpret_borrow<py::sequence>(value);
}

Outline outline_of(const py::handle& value, const std::string& name) {
  const py::sequence rows = sequence_of(value, name + ": an outline is a list of points and arcs");
  Outline outline;
  const std::size_t n = rows.size();
  if (n == 0) throw py::value_error(name + ": the outline is empty");
  outline.segments.reserve(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    const Row row = row_of(rows[i], name + ", element " + std::to_string(i));
    const double* end = row.number + (row.count - 2);
    if (i == 0) {
      if (row.count != 2) throw py::value_error(name + ": the first element is a point");
      outline.start = {end[0], end[1]};
      continue;
    }
    Segment& segment = outline.segments.emplace_back();
    segment.to = {end[0], end[1]};
    if (row.count == 4) segment.via = Point2{row.number[0], row.number[1]};
  }
  return outline;
}

Circle circle_of(const py::handle& value, const std::string& name) {
  const Point3 numbers = to_point3(value, name.c_str());
  const Circle circle{{numbers.x, numbers.y}, mm(numbers.z)};
  if (!(circle.radius.mm() > 0.0)) throw py::value_error(name + ": a circle's radius must be above 0");
  return circle;
}

/// A list of points and arcs, or the three numbers of a circle.
Outline path_of(const py::handle& value) {
  return is_row_of_numbers(value) ? as_outline(circle_of(value, "path")) : outline_of(value, "path");
}

Figure figure_of(const py::handle& value) {
  Figure figure;
  const py::sequence outlines = sequence_of(value, "a list of outlines is expected");
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const py::object item = outlines[i];
    const std::string name = "outline " + std::to_string(i);
    if (is_row_of_numbers(item)) {
      figure.push_back(circle_of(item, name));
    } else {
      figure.push_back(outline_of(item, name));
    }
  }
  return figure;
}

py::list list_of(const std::vector<Outline>& outlines) {
  py::list list;
  for (const Outline& outline : outlines) list.append(rows_of(outline));
  return list;
}

py::list list_of(const std::vector<Point2>& points) {
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
      const Region disc = compute([&](Diagnostics& d) { return make_region(Figure{shape}, options, d); });
      loops.insert(loops.end(), disc.loops.begin(), disc.loops.end());
    }
  }
  return PyRegion(compute([&](Diagnostics& d) { return make_region(loops, rule, options, d); }));
}

PyRegion combined(const PyRegion& a, const PyRegion& b, Boolean what, const char* call) {
  const RegionOptions options = options_of(kDefaultTolerance, call);
  return PyRegion(
      compute([&](Diagnostics& d) { return combine(a.region, b.region, what, options, d); }).region);
}

std::string place_of(const PyRegion& region, const py::object& point, double margin) {
  switch (region.search().locate(to_point2(point, "point"), mm(finite_number(margin, "margin")))) {
    case Place::inside: return "inside";
    case Place::boundary: return "boundary";
    case Place::outside: break;
  }
  return "outside";
}

py::object bounds_of(const PyRegion& region) {
  const Box2 box = bounds(region.region);
  if (box.empty()) return py::none();
  return py::make_tuple(box.low.x, box.low.y, box.high.x, box.high.y);
}

py::object nearest_to(const PyRegion& region, const py::object& point) {
  const auto found = region.search().nearest(to_point2(point, "point"));
  if (!found) return py::none();
  return py::make_tuple(found->at.x, found->at.y, found->distance.mm());
}

PathEnds ends_of(const std::string& name) {
  if (name == "round") return PathEnds::round;
  if (name == "butt") return PathEnds::butt;
  throw py::value_error("unknown ends '" + name + "'; known: round, butt");
}

std::vector<Point2> points_of(const py::object& points) {
  std::vector<Point2> made;
  const py::sequence rows = sequence_of(points, "points must be a list of points (x, y)");
  made.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row row = row_of(rows[i], "point " + std::to_string(i));
    if (row.count != 2) throw py::value_error("point " + std::to_string(i) + ": 2 numbers are expected");
    made.push_back({row.number[0], row.number[1]});
  }
  return made;
}

void bind_region_class(py::module_& m) {
  py::class_<PyRegion>(m, "Region", kRegion)
      .def(py::init(&region_of), py::arg("outlines") = py::tuple(), py::kw_only(),
           py::arg("fill") = "nonzero", py::arg("tolerance") = kDefaultTolerance)
      .def_property_readonly(
          "outlines", [](const PyRegion& r) { return list_of(r.region.loops); },
          "list: closed outlines that do not cross, outer ones counter-clockwise, holes clockwise.")
      .def_property_readonly(
          "area", [](const PyRegion& r) { return area(r.region); }, "float: square mm.")
      .def_property_readonly(
          "length", [](const PyRegion& r) { return length(r.region).mm(); }, "float: mm of boundary.")
      .def_property_readonly("bounds", &bounds_of, "tuple (x low, y low, x high, y high), or None if empty.")
      .def("__bool__", [](const PyRegion& r) { return !r.region.empty(); })
      .def("__or__", [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::unite, "|"); })
      .def("__and__",
           [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::intersect, "&"); })
      .def("__sub__",
           [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::subtract, "-"); })
      .def("__xor__",
           [](const PyRegion& a, const PyRegion& b) { return combined(a, b, Boolean::exclude, "^"); })
      .def("__repr__",
           [](const PyRegion& r) {
             return "<kerf.Region of " + std::to_string(r.region.loops.size()) + " outlines>";
           })
      .def(
          "offset",
          [](const PyRegion& r, double distance, double tolerance) {
            const RegionOptions options = options_of(tolerance, "offset");
            finite_number(distance, "distance");
            return PyRegion(
                compute([&](Diagnostics& d) { return offset(r.region, mm(distance), options, d); }).region);
          },
          py::arg("distance"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance, kOffset)
      .def("locate", &place_of, py::arg("point"), py::kw_only(), py::arg("margin") = 0.0, kLocate)
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
}

void bind_paths(py::module_& m) {
  m.def(
      "widen",
      [](const py::object& path, double half_width, const std::string& ends, double tolerance) {
        const RegionOptions options = options_of(tolerance, "widen");
        const PathEnds how = ends_of(ends);
        const Outline outline = path_of(path);
        finite_number(half_width, "half_width");
        return PyRegion(
            compute([&](Diagnostics& d) { return widen(outline, mm(half_width), how, options, d); }));
      },
      py::arg("path"), py::arg("half_width"), py::kw_only(), py::arg("ends") = "round",
      py::arg("tolerance") = kDefaultTolerance, kWiden);
  m.def(
      "parallel",
      [](const py::object& path, double to_left, double tolerance) {
        const RegionOptions options = options_of(tolerance, "parallel");
        const Outline outline = path_of(path);
        finite_number(to_left, "to_left");
        return list_of(compute([&](Diagnostics& d) { return parallel(outline, mm(to_left), options, d); }));
      },
      py::arg("path"), py::arg("to_left"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance,
      kParallel);
  m.def(
      "self_meetings",
      [](const py::object& path, double tolerance) {
        const RegionOptions options = options_of(tolerance, "self_meetings");
        const Outline outline = path_of(path);
        py::list list;
        for (const SelfMeeting& s :
             compute([&](Diagnostics& d) { return self_meetings(outline, options, d); }))
          list.append(py::make_tuple(s.at.x, s.at.y, s.first, s.second));
        return list;
      },
      py::arg("path"), py::kw_only(), py::arg("tolerance") = kDefaultTolerance, kSelfMeetings);
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
        return list_of(flattened(path_of(path), mm(chord)));
      },
      py::arg("path"), py::arg("chord"), kFlattened);
}

}  // namespace

void bind_region(py::module_& m) {
  bind_region_class(m);
  bind_paths(m);
  bind_fits(m);
}

}  // namespace kerf::python

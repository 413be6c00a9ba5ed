// Outlines, points and geometries as arguments from Python: lists, arrays and iterators of rows of numbers,
// and objects with __geo_interface__ (shapely, GeoPandas).
#include <algorithm>
#include <utility>

#include "bindings.h"
#include "region_binding.h"

namespace kerf::python {
namespace py = pybind11;

bool has_geometry(const py::handle& value) { return py::hasattr(value, "__geo_interface__"); }

namespace {

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

Row row_of(const py::handle& value, const std::string& where) {
  const std::string expected = where + ": 2 numbers (a point) or 4 (an arc's via point and end) are expected";
  const auto fast = py::reinterpret_steal<py::object>(
      py::isinstance<py::str>(value) ? nullptr : PySequence_Fast(value.ptr(), ""));
  if (!fast) {
    PyErr_Clear();
    throw py::type_error(expected);
  }
  Row row{{}, static_cast<std::size_t>(PySequence_Fast_GET_SIZE(fast.ptr()))};
  if (row.count != 2 && row.count != 4)
    throw py::value_error(expected + ", not " + std::to_string(row.count));
  for (std::size_t i = 0; i < row.count; ++i) {
    row.number[i] = PyFloat_AsDouble(PySequence_Fast_GET_ITEM(fast.ptr(), static_cast<Py_ssize_t>(i)));
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw py::type_error(expected);
    }
  }
  return row;
}

/// The elements of a sequence or of an iterator, which have an order.
py::sequence sequence_of(const py::handle& value, const std::string& what) {
  const bool ordered = !py::isinstance<py::str>(value) && !py::isinstance<py::bytes>(value) &&
                       !py::isinstance<py::dict>(value) && !py::isinstance<py::anyset>(value);
  if (ordered && py::isinstance<py::sequence>(value)) return py::reinterpret_borrow<py::sequence>(value);
  if (!ordered || !py::isinstance<py::iterable>(value)) throw py::type_error(what);
  return py::reinterpret_borrow<py::sequence>(py::list(py::reinterpret_borrow<py::object>(value)));
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

// ---- objects with __geo_interface__

/// What a geometry consists of.
struct Parts {
  Figure areas;  // rings: outsides counter-clockwise, holes clockwise
  std::vector<Outline> lines;
  std::vector<Point2> points;
  std::string line, point;  // the kind of the first line and point, for messages
};

/// A position of a geometry; its third coordinate is left out.
Point2 position_of(const py::handle& p) {
  return {py::cast<double>(p[py::int_(0)]), py::cast<double>(p[py::int_(1)])};
}

Outline line_of(const py::handle& coordinates) {
  Outline outline;
  bool first = true;
  for (const py::handle p : coordinates) {
    if (std::exchange(first, false))
      outline.start = position_of(p);
    else
      outline.segments.push_back({position_of(p), {}});
  }
  if (first) throw py::value_error("__geo_interface__: a line is empty");
  return outline;
}

/// The outline of a ring, counter-clockwise or clockwise.
Outline ring_of(const py::handle& ring, bool counter_clockwise) {
  const Outline given = line_of(ring);
  std::vector<Point2> points{given.start};
  for (const Segment& s : given.segments) points.push_back(s.to);
  double twice_area = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    twice_area += points[i - 1].x * points[i].y - points[i].x * points[i - 1].y;
  if ((twice_area > 0.0) != counter_clockwise) std::reverse(points.begin(), points.end());
  Outline outline;
  outline.start = points.front();
  for (std::size_t i = 1; i < points.size(); ++i) outline.segments.push_back({points[i], {}});
  return outline;
}

void add_polygon(const py::handle& rings, Parts& parts) {
  bool outside = true;
  for (const py::handle ring : rings) {
    if (py::len(ring) == 0) continue;  // an empty polygon
    parts.areas.push_back(ring_of(ring, std::exchange(outside, false)));
  }
}

void add_parts_of(const py::handle& geometry, Parts& parts) {
  if (geometry.is_none()) return;  // of a Feature without one
  const auto kind = py::cast<std::string>(geometry[py::str("type")]);
  if (kind == "Feature") return add_parts_of(geometry[py::str("geometry")], parts);
  const bool features = kind == "FeatureCollection";
  if (features || kind == "GeometryCollection") {
    for (const py::handle part : geometry[py::str(features ? "features" : "geometries")])
      add_parts_of(part, parts);
    return;
  }
  const py::object coordinates = geometry[py::str("coordinates")];
  const bool several = kind.rfind("Multi", 0) == 0;
  const std::string one = several ? kind.substr(5) : kind;
  const auto each = [&](const auto& add) {
    if (!several) return add(coordinates);
    for (const py::handle part : coordinates) add(part);
  };
  if (one == "Polygon") return each([&](const py::handle& rings) { add_polygon(rings, parts); });
  if (one == "LineString" || one == "LinearRing") {
    if (parts.line.empty()) parts.line = kind;
    return each([&](const py::handle& line) {
      if (py::len(line) > 0) parts.lines.push_back(line_of(line));
    });
  }
  if (one != "Point") throw py::value_error("__geo_interface__: the type " + kind + " is not known");
  if (parts.point.empty()) parts.point = kind;
  each([&](const py::handle& point) {
    if (py::len(point) > 0) parts.points.push_back(position_of(point));
  });
}

Parts parts_of(const py::handle& value) {
  Parts parts;
  add_parts_of(value.attr("__geo_interface__"), parts);
  return parts;
}

/// Appends the outlines of a Region, or the polygons of another module's geometry.
void add_areas(const py::handle& value, Figure& figure) {
  if (py::isinstance<PyRegion>(value)) {
    for (const Outline& loop : value.cast<const PyRegion&>().region.loops) figure.push_back(loop);
    return;
  }
  const Parts parts = parts_of(value);
  const std::string& other = parts.line.empty() ? parts.point : parts.line;
  if (!other.empty())
    throw py::value_error("__geo_interface__: a Polygon or a MultiPolygon is expected, not a " + other);
  figure.insert(figure.end(), parts.areas.begin(), parts.areas.end());
}

/// A point where an outline is expected: the list around the outline is missing.
[[noreturn]] void missing_list(const py::handle& item, const std::string& name) {
  throw py::value_error(
      "outlines must be a list of outlines, and " + name + " is the row of numbers " +
      py::cast<std::string>(py::repr(item)) +
      "; a single outline is in a list of its own: Region([[(0, 0), (40, 0), (40, 20), (0, 0)]]), and a "
      "circle is (x, y, radius)");
}

}  // namespace

Figure figure_of(const py::handle& value) {
  Figure figure;
  if (has_geometry(value)) {
    add_areas(value, figure);
    return figure;
  }
  const py::sequence outlines = sequence_of(value, "a list of outlines is expected");
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const py::object item = outlines[i];
    const std::string name = "outline " + std::to_string(i);
    if (has_geometry(item)) {
      add_areas(item, figure);
    } else if (is_row_of_numbers(item)) {
      if (py::len(item) != 3) missing_list(item, name);
      figure.push_back(circle_of(item, name));
    } else {
      figure.push_back(outline_of(item, name));
    }
  }
  return figure;
}

Outline path_of(const py::handle& value) {
  if (!has_geometry(value))
    return is_row_of_numbers(value) ? as_outline(circle_of(value, "path")) : outline_of(value, "path");
  const Parts parts = parts_of(value);
  if (parts.lines.size() == 1 && parts.areas.empty() && parts.points.empty()) return parts.lines.front();
  throw py::value_error("path: a LineString is expected, not a " +
                        py::cast<std::string>(value.attr("__geo_interface__")[py::str("type")]));
}

std::vector<Outline> paths_of(const py::handle& value, const char* expected) {
  std::vector<Outline> paths;
  if (py::isinstance<PyRegion>(value)) return value.cast<const PyRegion&>().region.loops;
  if (has_geometry(value)) {
    Parts parts = parts_of(value);
    if (!parts.point.empty())
      throw py::value_error("__geo_interface__: areas or lines are expected, not a " + parts.point);
    std::vector<Outline> rings;
    for (const auto& ring : parts.areas) rings.push_back(std::get<Outline>(ring));
    const RegionOptions options = options_of(kDefaultTolerance, "__geo_interface__");
    paths = compute(options, [&](const RegionOptions& o, Diagnostics& d) {
              return make_region(rings, FillRule::nonzero, o, d);
            }).loops;
    std::move(parts.lines.begin(), parts.lines.end(), std::back_inserter(paths));
    return paths;
  }
  const py::sequence items = sequence_of(value, expected);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const py::object item = items[i];
    if (has_geometry(item)) {
      std::vector<Outline> more = paths_of(item, expected);
      std::move(more.begin(), more.end(), std::back_inserter(paths));
    } else {
      paths.push_back(path_of(item));
    }
  }
  return paths;
}

std::vector<Point2> points_of(const py::object& points) {
  if (has_geometry(points)) {
    const Parts parts = parts_of(points);
    if (!parts.areas.empty() || parts.lines.size() + (parts.points.empty() ? 0 : 1) > 1)
      throw py::value_error("__geo_interface__: points, or one line, are expected");
    if (parts.lines.empty()) return parts.points;
    std::vector<Point2> made{parts.lines.front().start};
    for (const Segment& s : parts.lines.front().segments) made.push_back(s.to);
    return made;
  }
  std::vector<Point2> made;
  const py::sequence rows = sequence_of(points, "points must be a list of points (x, y)");
  made.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const py::object item = rows[i];
    const std::string name = "point " + std::to_string(i);
    if (has_geometry(item)) {
      const std::vector<Point2> one = points_of(item);
      if (one.size() != 1) throw py::value_error(name + ": a Point is expected");
      made.push_back(one.front());
      continue;
    }
    const Row row = row_of(item, name);
    if (row.count != 2) throw py::value_error(name + ": 2 numbers are expected");
    made.push_back({row.number[0], row.number[1]});
  }
  return made;
}

bool are_several_points(const py::handle& value) {
  if (has_geometry(value))
    return py::cast<std::string>(value.attr("__geo_interface__")[py::str("type")]) != "Point";
  if (py::isinstance<py::str>(value)) return false;
  if (!py::isinstance<py::sequence>(value)) return py::isinstance<py::iterable>(value);
  if (py::len(value) == 0) return true;
  const py::object first = value[py::int_(0)];
  return py::isinstance<py::sequence>(first) || has_geometry(first);
}

}  // namespace kerf::python

// Regions in Python: the class, and helpers of functions that return regions.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"

#include "kerf/geom/offset.h"

namespace kerf::python {

inline constexpr double kDefaultTolerance = 1e-6;  // mm, as Tolerance::weld

/// Calls `work` without the GIL and raises its errors; returns its result.
template <class Work>
auto compute(Work work) {
  Diagnostics diagnostics;
  auto made = [&] {
    const pybind11::gil_scoped_release release;
    return work(diagnostics);
  }();
  raise_or_warn(diagnostics);
  return std::move(*made);
}

/// The same for calls of work(options, diagnostics), which Ctrl-C cancels.
template <class Work>
auto compute(RegionOptions options, Work work) {
  Diagnostics diagnostics;
  SignalProgress progress;
  options.progress = &progress;
  auto made = [&] {
    const pybind11::gil_scoped_release release;
    return work(options, diagnostics);
  }();
  progress.rethrow();
  raise_or_warn(diagnostics);
  return std::move(*made);
}

/// A region, and the search tree for its queries, which is made by the first one.
class PyRegion {
 public:
  explicit PyRegion(Region made) : region(std::move(made)) {}
  const RegionSearch& search() const {
    if (!search_) search_ = std::make_shared<RegionSearch>(region);
    return *search_;
  }
  Region region;

 private:
  mutable std::shared_ptr<RegionSearch> search_;  // made with the GIL held
};

/// A list of points (x, y) and arcs (via x, via y, x, y).
pybind11::list rows_of(const Outline& outline);
/// The options of a call; `call` is its name in messages.
RegionOptions options_of(double tolerance, const char* call);
/// Raises ValueError for an unknown name.
FillRule rule_of(const std::string& name);
/// Whether an object has a geometry as shapely's have, `__geo_interface__`; path_of takes its lines.
bool has_geometry(const pybind11::handle& value);
/// The outlines and circles of a list or iterator, of a Region, or the polygons of a geometry.
Figure figure_of(const pybind11::handle& value);
/// The boundary of a Region, of the polygons of a geometry, and its lines; or those of a list of paths and
/// such. `expected` is the message for other values.
std::vector<Outline> paths_of(const pybind11::handle& value, const char* expected);
/// A list of points and arcs, or the three numbers of a circle.
Outline path_of(const pybind11::handle& value);
pybind11::list list_of(const std::vector<Outline>& outlines);
const char* name_of(Location location);
/// A list of points (x, y), or points or a line of a geometry.
std::vector<Point2> points_of(const pybind11::object& points);
/// Whether a value is points rather than a point.
bool are_several_points(const pybind11::handle& value);
/// answer(point), or a list of the answers for a sequence of points.
template <class Answer>
pybind11::object each_point(const pybind11::object& value, Answer answer) {
  namespace py = pybind11;
  if (!are_several_points(value)) {
    if (has_geometry(value)) return answer(points_of(value).at(0));
    return answer(to_point2(value, "point"));
  }
  py::list list;
  for (const Point2 p : points_of(value)) list.append(answer(p));
  return list;
}

/// Nesting, clearance, clipping, medial axis and transforms of Region.
void bind_region_questions(pybind11::class_<PyRegion>& region);
/// Segments and points of outlines.
void bind_outline_questions(pybind11::module_& m);

}  // namespace kerf::python

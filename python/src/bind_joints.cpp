// Slots of finger joints, reliefs of corners, and rows over surfaces in Python.
#include "bind_joints.h"

#include <algorithm>

#include "base/codes/op.h"
#include "op/mesh/surface_rows.h"
#include "region_binding.h"

#include "kerf/geom/shapes.h"

namespace kerf::python {
namespace py = pybind11;

void raise_value_errors(const Diagnostics& diagnostics) {
  std::string wrong;
  for (const Diagnostic& d : diagnostics.list())
    if (d.code == codes::op_option || d.code == codes::op_limit)
      wrong += (wrong.empty() ? "" : "; ") + d.message;
  if (!wrong.empty()) throw py::value_error(wrong);
  raise_or_warn(diagnostics);
}

namespace {

/// The region of a call with its errors raised.
template <class Work>
PyRegion region_by(const char* call, Work work) {
  Diagnostics diagnostics;
  const RegionOptions options = options_of(kDefaultTolerance, call);
  std::optional<Region> made = work(options, diagnostics);
  raise_value_errors(diagnostics);
  return PyRegion(std::move(*made));
}

PyRegion slots(double width, double depth, long long count, bool first, double fit, double overhang) {
  FingerJoint joint;
  joint.width = mm(width);
  joint.depth = mm(depth);
  constexpr long long kOther = 1'000'000'000;  // refused as well
  joint.count = static_cast<int>(std::clamp(count, -kOther, kOther));
  joint.ends = first ? FingerJoint::Ends::fingers : FingerJoint::Ends::slots;
  joint.fit = mm(fit);
  joint.overhang = mm(overhang);
  return region_by("finger_slots",
                   [&](const RegionOptions& o, Diagnostics& d) { return finger_slots(joint, o, d); });
}

PyRegion relieved(const PyRegion& region, double diameter, const std::string& style, const PyRegion* limits) {
  ReliefOptions relief;
  relief.diameter = mm(diameter);
  const auto named = relief_style_named(style);
  if (!named) throw py::value_error("style must be 'dog-bone' or 't-bone', not '" + style + "'");
  relief.style = *named;
  relief.limits = limits == nullptr ? nullptr : &limits->region;
  return region_by("relieve_corners", [&](const RegionOptions& o, Diagnostics& d) {
    return relieve_corners(region.region, relief, o, d);
  });
}

py::list rows_over(const py::function& surface, const Tool& tool, const py::object& low,
                   const py::object& high, double stepover) {
  SurfaceRowOptions options;
  options.low = to_point2(low, "low");
  options.high = to_point2(high, "high");
  options.stepover = stepover;
  options.where = script_location("surface_rows");
  SignalProgress progress;
  options.progress = &progress;
  Diagnostics diagnostics;
  const auto rows =
      surface_rows([&](Point2 p) { return py::cast<double>(surface(p.x, p.y)); }, tool, options, diagnostics);
  progress.rethrow();
  raise_value_errors(diagnostics);
  py::list list;
  for (const std::vector<Point3>& row : *rows) {
    py::list points;
    for (const Point3 p : row) points.append(to_tuple(p));
    list.append(points);
  }
  return list;
}

}  // namespace

constexpr const char* kFingerSlots = R"(The slots of a finger joint along the edge of a board.

The edge is at y = 0 from x = 0 to `width`, the board above it. The two boards of a joint are cut with
``first=True`` and ``first=False``, each with the thickness of the other as depth.

Parameters
----------
width : float
    Width of the boards, mm.
depth : float
    Width of the slots, mm: the thickness of the other board.
count : int
    Fingers and slots together, odd and at least 3; each is ``width / count`` wide.
first : bool
    True: fingers at both ends of the edge; False: slots there.
fit : float
    Clearance between a finger and each side of its slot, mm; below 0 the joint is pressed together.
overhang : float
    How far the slots reach beyond the edge and the ends of the board, mm: at least the tool's radius.

Returns
-------
Region
    A new one; mm.

Examples
--------
>>> board = kerf.Region([[(0, 0), (50, 0), (50, 80), (0, 80), (0, 0)]])
>>> slots = kerf.finger_slots(50, 9, 5, fit=0.1, overhang=3)
>>> round((board - slots).area)
3818)";

constexpr const char* kRelieveCorners =
    R"(A region to cut out, with room for a round tool in its inner corners.

A tool of `diameter` that clears the result also clears the corners of `region`, so that a square part fits
into it.

Parameters
----------
region : Region
    What is cut out. Corners between straight sides are relieved.
diameter : float
    Diameter of the tool, mm.
style : {'dog-bone', 't-bone'}
    'dog-bone': along the bisector of the corner, the smallest relief. 't-bone': into the shorter side alone,
    so that the longer one stays straight.
limits : Region, optional
    Only corners inside of it are relieved; for slots that are open at the edge of a board: the board.

Returns
-------
Region
    A new one; mm.

Examples
--------
>>> slot = kerf.Region([[(0, 0), (30, 0), (30, 20), (0, 20), (0, 0)]])
>>> len(slot.outlines[0]), len(kerf.relieve_corners(slot, 3, "t-bone").outlines[0]) > 8
(5, True))";

constexpr const char* kSurfaceRows =
    R"(Rows along X in which a tool touches a surface, without cutting below it.

Parameters
----------
surface : callable(float, float)
    The height (Z) above (x, y), mm.
tool : Tool
    That touches it.
low, high : (float, float)
    Corners of the rectangle in which the axis of the tool moves, mm.
stepover : float
    Distance of the rows as a fraction of the tool's diameter.

Returns
-------
list of list of (float, float, float)
    Positions of the tip, row by row in alternating directions.

Examples
--------
>>> rows = kerf.surface_rows(lambda x, y: -x / 10, kerf.Tool("ball d=6"), (0, 0), (40, 30), stepover=0.5)
>>> rows[0][0][:2], rows[-1][0][1]
((0.0, 0.0), 30.0))";

void bind_joints(py::module_& m) {
  m.def("finger_slots", &slots, py::arg("width"), py::arg("depth"), py::arg("count"), py::kw_only(),
        py::arg("first") = true, py::arg("fit") = 0.0, py::arg("overhang") = 0.0, kFingerSlots);
  m.def("relieve_corners", &relieved, py::arg("region"), py::arg("diameter"), py::arg("style") = "dog-bone",
        py::kw_only(), py::arg("limits") = py::none(), kRelieveCorners);
  m.def("surface_rows", &rows_over, py::arg("surface"), py::arg("tool"), py::arg("low"), py::arg("high"),
        py::kw_only(), py::arg("stepover") = 0.1, kSurfaceRows);
}

}  // namespace kerf::python

// The compiled part of cnc25d_api: lists in, lists and messages out. The functions users call are in
// cnc25d_api/__init__.py, which prints the messages.
#include <cmath>

#include "back/drawing/outline_drawing.h"
#include "base/codes/outline.h"
#include "geom/solid/extrude.h"
#include "lists.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/formats/mesh_files.h"

namespace cnc25d {
namespace {

namespace codes = kerf::codes;
using kerf::Code;
using kerf::SharpReason;

PyObject* error_type =
    nullptr;  // OutlineError; never released, so that no destructor runs after the interpreter's end

std::string quoted(const std::string& name) { return name.empty() ? "outline" : "outline " + name; }

void raise(const Refusal& refusal) {
  std::string text =
      "ERR" + (refusal.code < 100 ? "0" + std::to_string(refusal.code) : std::to_string(refusal.code)) +
      ": Error, " + quoted(refusal.outline);
  if (refusal.element >= 0) text += ", element " + std::to_string(refusal.element);
  text += ": " + refusal.text;
  py::object error = py::handle(error_type)(text);
  error.attr("code") = refusal.code;
  error.attr("outline") = refusal.outline;
  error.attr("element") = refusal.element >= 0 ? py::object(py::int_(refusal.element)) : py::none();
  PyErr_SetObject(error_type, error.ptr());
}

/// The number of a message in Cnc25D; Kerf's code if it has none.
int catalogue_number(Code code) {
  switch (code) {
    case codes::outline_arc_straight: return 810;
    case codes::outline_arc_undetermined: return 682;
    case codes::outline_end_request: return 947;
    case codes::curve_turns_fast: return 639;
    case codes::curve_turns_much: return 649;
    case codes::curve_piece_straight: return 659;
    case codes::curve_inflexion: return 669;
    case codes::curve_radius_small: return 446;
    default: return static_cast<int>(code);
  }
}

/// The same for a corner that stays sharp.
int catalogue_number(SharpReason reason, bool enlarge, int arcs) {
  switch (reason) {
    case SharpReason::straight: return arcs == 0 ? (enlarge ? 573 : 673) : arcs == 1 ? 942 : 932;
    case SharpReason::folded: return arcs == 0 ? (enlarge ? 574 : 674) : 933;
    case SharpReason::short_segment: return arcs == 0 ? (enlarge ? 575 : 675) : arcs == 1 ? 684 : 693;
    case SharpReason::no_circle: return arcs == 1 ? 684 : 693;
    case SharpReason::no_neighbour: return enlarge ? 506 : 406;
    case SharpReason::shared: return static_cast<int>(codes::corner_shared);
    default: return static_cast<int>(codes::corner_radius_tiny);
  }
}

std::string warning_text(int number, const std::string& message) {
  return "WARN" + std::to_string(number) + ": Warning, " + message;
}

/// The Refusal of an error of the geometry. Messages start with the location, `NAME.3: ` or
/// `outline "NAME", element 3: `, which an OutlineError has in its attributes.
Refusal refusal_of(const kerf::Diagnostic& error, const std::string& name) {
  Refusal refusal{catalogue_number(error.code), name, -1, error.message};
  for (const std::string& prefix : {name + ".", "outline \"" + name + "\", element "}) {
    if (error.message.rfind(prefix, 0) != 0) continue;
    const std::size_t first = prefix.size(), end = error.message.find_first_not_of("0123456789", first);
    constexpr std::size_t kMaxDigits = 10;  // of an element
    if (end == std::string::npos || end == first || end - first > kMaxDigits) continue;
    if (error.message.compare(end, 2, ": ") != 0) continue;
    refusal.element = static_cast<Py_ssize_t>(std::stoll(error.message.substr(first, end - first)));
    refusal.text = error.message.substr(end + 2);
    break;
  }
  return refusal;
}

/// The lines to print for diagnostics; an error becomes a Refusal.
class Messages {
 public:
  void add(const std::string& text) { list_.append(py::str(text)); }
  void add(const kerf::Diagnostics& diagnostics, const std::string& name) {
    for (const kerf::Diagnostic& d : diagnostics.list()) {
      if (d.severity == kerf::Severity::error) throw refusal_of(d, name);
      if (!about_corner(d.code)) add(warning_text(catalogue_number(d.code), d.message));
    }
    for (const Code code : diagnostics.dropped_codes())
      if (!about_corner(code))
        add(warning_text(catalogue_number(code), "and " + std::to_string(diagnostics.dropped(code)) +
                                                     " more: " + std::string(kerf::meaning_of(code))));
  }
  py::list list() const { return list_; }

 private:
  static bool about_corner(Code code) {
    return code >= codes::corner_straight && code <= codes::corner_shared;
  }
  py::list list_;
};

void add_corner_messages(Messages& messages, const RequestedOutline& shape, const kerf::CutOutline& cut,
                         const std::string& name) {
  std::size_t reported = 0, omitted = 0;
  int number = 0;
  for (const kerf::CornerReport& report : cut.corners) {
    if (report.reason == SharpReason::none) continue;
    const std::vector<kerf::Segment>& segments = shape.outline.segments;
    const std::size_t i = report.element, n = segments.size();
    const kerf::Length request = shape.corners[i];
    const int arcs = (segments[i == 0 ? n - 1 : i - 1].via ? 1 : 0) + (segments[i].via ? 1 : 0);
    if (reported == kerf::limits::kMaxMessagesPerCode && omitted++ > 0) continue;
    number = catalogue_number(report.reason, request < kerf::Length(), arcs);
    if (reported == kerf::limits::kMaxMessagesPerCode) continue;
    ++reported;
    messages.add(warning_text(number, kerf::corner_message(report, request, name)));
  }
  if (omitted == 0) return;
  messages.add(warning_text(number, "and " + std::to_string(omitted) +
                                        (omitted == 1 ? " more corner stays" : " more corners stay") +
                                        " sharp"));
}

py::list report_list(const kerf::CutOutline& cut) {
  py::list list;
  for (const kerf::CornerReport& r : cut.corners) {
    py::dict d;
    d["element"] = r.element;
    d["outcome"] = std::string(kerf::to_string(r.outcome));
    d["reason"] = std::string(kerf::to_string(r.reason));
    d["first"] = r.first;
    d["count"] = r.count;
    d["largest"] = r.largest.mm();
    list.append(d);
  }
  return list;
}

/// (format B, messages that `kerf outline` has as well, messages of this module, reports or None)
py::tuple cut(const py::object& list, const std::string& name, bool even, bool report) {
  const FormatCodes codes{.single = 202, .first_length = 564, .segment_a = 563};
  const RequestedOutline shape = read_outline(list.ptr(), Format::a, codes, name);
  const kerf::Outline& outline = shape.outline;
  if (outline.segments.empty()) throw Refusal{202, name, 0, "at least one segment is needed"};
  if (outline.closed() && outline.segments.size() < 2)
    throw Refusal{203, name, 1, "a closed outline needs two segments"};
  require_finite(shape, name);
  kerf::CornerOptions options;
  options.tolerance = tolerance_for(outline);
  options.sharing = even ? kerf::EdgeSharing::even : kerf::EdgeSharing::in_order;
  options.name = name;
  kerf::Diagnostics diagnostics;
  const auto made = kerf::cut_corners(outline, shape.corners, options, diagnostics);
  Messages messages, own;
  messages.add(diagnostics, name);
  if (diagnostics.warnings() > 0) add_corner_messages(messages, shape, *made, name);
  const double gap = distance(outline.start, outline.segments.back().to);
  if (!outline.closed() && gap <= 1e3 * options.tolerance.weld.mm())
    own.add(warning_text(static_cast<int>(codes::outline_malformed),
                         quoted(name) + ": its ends differ by " + std::to_string(gap) +
                             ", so it counts as open; outline_close() closes it"));
  return py::make_tuple(make_list(made->outline), messages.list(), own.list(),
                        report ? py::object(report_list(*made)) : py::none());
}

kerf::CurveOptions curve_options(double precision, double min_radius, const std::string& name) {
  if (!std::isfinite(precision) || !std::isfinite(min_radius) || precision < 0.0)
    throw Refusal{7002, name, -1,
                  "precision and router_bit_request must be finite numbers, precision not below 0"};
  kerf::CurveOptions options;
  options.straight = kerf::radians(precision);
  options.min_radius = kerf::mm(min_radius);
  options.name = name;
  return options;
}

py::tuple smooth(const kerf::Curve& curve, const kerf::CurveOptions& options, Messages& messages) {
  kerf::Diagnostics diagnostics;
  const auto made = kerf::smooth_curve(curve, options, diagnostics);
  messages.add(diagnostics, options.name);
  return py::make_tuple(make_list(*made), messages.list());
}

py::tuple smooth_c(const py::object& list, double precision, double min_radius, const std::string& name) {
  const FormatCodes codes{.empty = 609, .single = 609, .first_length = 619, .segment_a = 629};
  const kerf::CurveOptions options = curve_options(precision, min_radius, name);
  const kerf::Curve curve = read_curve(list.ptr(), codes, name);
  if (curve.size() < 2) throw Refusal{609, name, 0, "at least two samples are needed"};
  require_finite(curve, name);
  Messages messages;
  constexpr double kHalfTurn = 3.1415926535898;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (std::abs(curve[i].heading.rad()) <= kHalfTurn) continue;
    messages.add(warning_text(639, name + "." + std::to_string(i) +
                                       ": a tangent inclination beyond pi; whole turns are taken off"));
    break;
  }
  return smooth(curve, options, messages);
}

py::tuple smooth_b(const py::object& list, double precision, double min_radius, const std::string& name) {
  const FormatCodes codes{.empty = 309, .single = 309, .first_length = 319, .segment_b = 319};
  const kerf::CurveOptions options = curve_options(precision, min_radius, name);
  const RequestedOutline shape = read_outline(list.ptr(), Format::b, codes, name);
  const kerf::Outline& outline = shape.outline;
  if (outline.segments.empty()) throw Refusal{309, name, 0, "at least two points are needed"};
  require_finite(shape, name);
  std::vector<kerf::Point2> points;
  points.reserve(outline.elements());
  for (std::size_t i = 0; i < outline.elements(); ++i) {
    if (i > 0 && outline.segments[i - 1].via)
      throw Refusal{319, name, static_cast<Py_ssize_t>(i),
                    "2 numbers are expected, not 4: a curve has no arcs yet"};
    points.push_back(outline.point(i));
  }
  kerf::Diagnostics diagnostics;
  const auto curve = kerf::guess_headings(points, options, diagnostics);
  Messages messages;
  messages.add(diagnostics, name);
  return smooth(*curve, options, messages);
}

/// A transformed list in the format of the original; "C" must be given, because it cannot be distinguished
/// from A.
template <class Move>
py::list moved(const py::object& list, const std::string& format, const FormatCodes& codes, const Move& move,
               bool mirrors = false) {
  const std::string name;
  if (format == "C") {
    const kerf::Curve curve = read_curve(list.ptr(), codes, name);
    require_finite(curve, name);
    return make_list(move(curve));
  }
  const Format kind = format_of(list.ptr(), codes, name);
  if (kind == Format::circle) return make_list(move(read_circle(list.ptr(), codes, name)));
  const RequestedOutline shape = read_outline(list.ptr(), kind, codes, name);
  require_finite(shape, name);
  if (kind == Format::b) return make_list(move(shape.outline));
  const kerf::CornerRequests corners = mirrors ? reversed(shape.corners, shape.outline) : shape.corners;
  return make_list(move(shape.outline), &corners);
}

double finite(double value, const char* what) {
  if (!std::isfinite(value)) throw Refusal{7002, {}, -1, std::string(what) + " must be a finite number"};
  return value;
}

py::list transform(const py::object& list, double dx, double fx, double dy, double fy,
                   const std::string& format) {
  const kerf::Placement placement{{finite(dx, "the offset"), finite(dy, "the offset")},
                                  {finite(fx, "the factor"), finite(fy, "the factor")}};
  if (fx == 0.0 || fy == 0.0) throw Refusal{439, {}, -1, "a factor of 0 would flatten the outline"};
  return moved(
      list, format, {}, [&](const auto& shape) { return placed(shape, placement); }, placement.mirrors());
}

py::list rotate(const py::object& list, double x, double y, double angle, const std::string& format) {
  const kerf::Point2 centre{finite(x, "the centre"), finite(y, "the centre")};
  finite(angle, "the angle");
  return moved(list, format, {},
               [&](const auto& shape) { return rotated(shape, centre, kerf::radians(angle)); });
}

py::list reverse_curve(const py::object& list) {
  return moved(list, "C", {}, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, kerf::Curve>)
      return reversed(shape);
    else
      return shape;
  });
}

/// A figure of format-B outlines and circles; requests of format A are ignored.
kerf::Figure read_figure(const py::object& list) {
  if (!PyList_Check(list.ptr()) && !PyTuple_Check(list.ptr()))
    throw Refusal{937, "figure", -1, "a figure is a list or a tuple of outlines"};
  kerf::Figure figure;
  for (const py::handle item : list) {
    const std::string name = "figure.ol" + std::to_string(figure.size());
    const FormatCodes codes;
    const Format kind = format_of(item.ptr(), codes, name);
    if (kind == Format::circle) {
      const kerf::Circle circle = read_circle(item.ptr(), codes, name);
      if (circle.radius <= kerf::Length())
        throw Refusal{409, name, -1, "the radius of a circle is not above 0"};
      figure.emplace_back(circle);
    } else {
      RequestedOutline shape = read_outline(item.ptr(), kind, codes, name);
      require_finite(shape, name);
      figure.emplace_back(std::move(shape.outline));
    }
  }
  return figure;
}

py::str figure_svg(const py::object& figure, const py::object& under, const std::string& title) {
  return kerf::write_svg(kerf::overlay_picture(read_figure(figure), read_figure(under), title));
}

py::str figure_dxf(const py::object& figure, bool polylines, const std::string& unit) {
  kerf::Drawing drawing;
  if (unit == "inch")
    drawing.unit = kerf::DrawingUnit::inch;
  else if (unit != "mm")
    throw Refusal{264, {}, -1, "unit must be 'mm' or 'inch', not '" + unit + "'"};
  draw(drawing, 0, read_figure(figure),
       polylines ? kerf::OutlineEntities::polyline : kerf::OutlineEntities::pieces);
  return kerf::write_dxf(drawing);
}

kerf::SolidMesh solid_of(const py::object& list, double height, double chord) {
  if (!(chord > 0.0) || !std::isfinite(chord))
    throw Refusal{7002, {}, -1, "chord must be a finite number above 0"};
  kerf::Tolerance tolerance;
  tolerance.chord = kerf::mm(chord);
  kerf::Diagnostics diagnostics;
  auto solid = kerf::extrude(read_figure(list), kerf::mm(height), tolerance, diagnostics);
  for (const kerf::Diagnostic& d : diagnostics.list())
    if (d.severity == kerf::Severity::error) throw Refusal{catalogue_number(d.code), {}, -1, d.message};
  return std::move(*solid);
}

/// (list of (x, y, z), list of (a, b, c))
py::tuple figure_mesh(const py::object& list, double height, double chord) {
  const kerf::SolidMesh solid = solid_of(list, height, chord);
  py::list points, triangles;
  for (std::size_t i = 0; i + 2 < solid.positions.size(); i += 3)
    points.append(py::make_tuple(solid.positions[i], solid.positions[i + 1], solid.positions[i + 2]));
  for (std::size_t i = 0; i + 2 < solid.triangles.size(); i += 3)
    triangles.append(py::make_tuple(solid.triangles[i], solid.triangles[i + 1], solid.triangles[i + 2]));
  return py::make_tuple(points, triangles);
}

py::bytes figure_solid_file(const py::object& list, double height, double chord, const std::string& ending) {
  const auto format = kerf::mesh_format_of("figure." + ending);
  if (!format) throw Refusal{264, {}, -1, "no mesh is written as ." + ending};
  const kerf::SolidMesh solid = solid_of(list, height, chord);
  kerf::MeshView view;
  view.positions = solid.positions;
  view.triangles = solid.triangles;
  return kerf::write_mesh(view, *format);
}

/// (centre x, centre y, radius, turn) or None for three points on a line.
py::object arc_circle(std::pair<double, double> from, std::pair<double, double> via,
                      std::pair<double, double> to) {
  const kerf::Segment segment{{to.first, to.second}, kerf::Point2{via.first, via.second}};
  const auto circle = kerf::arc_circle({from.first, from.second}, segment);
  if (!circle) return py::none();
  return py::make_tuple(circle->centre.x, circle->centre.y, circle->radius,
                        circle->turn == kerf::Turn::ccw ? 1 : -1);
}

/// "A", "B" or "circle", after a complete check of the list.
std::string check(const py::object& list, int segment_b, int segment_a, const std::string& name) {
  const FormatCodes codes{.segment_b = segment_b, .segment_a = segment_a};
  const Format kind = format_of(list.ptr(), codes, name);
  if (kind == Format::circle) {
    read_circle(list.ptr(), codes, name);
    return "circle";
  }
  require_finite(read_outline(list.ptr(), kind, codes, name), name);
  return kind == Format::a ? "A" : "B";
}

}  // namespace
}  // namespace cnc25d

PYBIND11_MODULE(_outline, m) {
  namespace py = pybind11;
  using namespace cnc25d;
  m.doc() = "The compiled part of cnc25d_api.";
  error_type =
      PyErr_NewExceptionWithDoc("cnc25d_api.OutlineError",
                                "An invalid outline. `code` is the number of the message, `outline` the name "
                                "given in the call, `element` the index in the list or None.",
                                PyExc_ValueError, nullptr);
  if (error_type == nullptr) throw py::error_already_set();
  m.add_object("OutlineError", error_type);
  py::register_local_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const Refusal& refusal) {
      raise(refusal);
    }
  });
  m.def("cut", &cut);
  m.def("smooth_c", &smooth_c);
  m.def("smooth_b", &smooth_b);
  m.def("transform", &transform);
  m.def("rotate", &rotate);
  m.def("reverse_curve", &reverse_curve);
  m.def("check", &check);
  m.def("arc_circle", &arc_circle);
  m.def("figure_svg", &figure_svg);
  m.def("figure_dxf", &figure_dxf);
  m.def("figure_mesh", &figure_mesh);
  m.def("figure_solid_file", &figure_solid_file);
}

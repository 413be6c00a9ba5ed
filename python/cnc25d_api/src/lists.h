// Outlines as Python lists: the formats A, B and C and circles of cnc25d_api. With Python's C interface,
// because pybind11 would take longer for long lists than the geometry.
#pragma once

#include <pybind11/pybind11.h>
#include <string>

#include "kerf/geom/outline.h"

namespace cnc25d {
namespace py = pybind11;

/// An error in the arguments of a call: becomes the Python exception OutlineError.
struct Refusal {
  int code = 0;         // of the message catalogue, e.g. 564 for ERR564
  std::string outline;  // name of the outline, may be empty
  Py_ssize_t element = -1;
  std::string text;
};

/// The numbers of the error messages of a reader, which differ between functions.
struct FormatCodes {
  int not_a_list = 937, empty = 75, single = 402, first_length = 457, circle_length = 758;
  int segment_b = 237, segment_a = 247;
};

enum class Format { a, b, c, circle };

/// Format A or B by the length of the first element, circle if that is a number. An error if the object is
/// not a list or tuple.
Format format_of(PyObject* list, const FormatCodes& codes, const std::string& name);

/// An outline with the requests for its corners, one for each element; none of format B.
struct RequestedOutline {
  kerf::Outline outline;
  kerf::CornerRequests corners;
};

/// Reads format A or B. Coordinates must be numbers; see require_finite.
RequestedOutline read_outline(PyObject* list, Format format, const FormatCodes& codes,
                              const std::string& name);
kerf::Circle read_circle(PyObject* list, const FormatCodes& codes, const std::string& name);
kerf::Curve read_curve(PyObject* list, const FormatCodes& codes, const std::string& name);

/// Format B: a list of tuples. With requests, one for each element, format A.
py::list make_list(const kerf::Outline& outline, const kerf::CornerRequests* corners = nullptr);
py::list make_list(const kerf::Curve& curve);
py::list make_list(const kerf::Circle& circle);

/// Weld tolerance of an outline: 1e-11 of its size, plus the rounding error of its coordinates.
kerf::Tolerance tolerance_for(const kerf::Outline& outline);

/// An error that names the element if a number is not finite or beyond 1e60.
void require_finite(const RequestedOutline& shape, const std::string& name);
void require_finite(const kerf::Curve& curve, const std::string& name);

}  // namespace cnc25d

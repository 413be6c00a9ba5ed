// Outlines as Python lists: the formats A, B and C and circles of cnc25d_api, read and made with Python's C
// interface (a list of ten thousand corners must not cost more than the geometry).
#pragma once

#include <pybind11/pybind11.h>
#include <string>

#include "kerf/outline.h"

namespace cnc25d {
namespace py = pybind11;

/// What a call refuses: becomes the Python exception OutlineError.
struct Refusal {
  int code = 0;         // of the message catalogue, e.g. 564 for ERR564
  std::string outline;  // name of the outline, may be empty
  Py_ssize_t element = -1;
  std::string text;
};

/// The numbers of the messages that a reader uses; they differ from function to function.
struct FormatCodes {
  int not_a_list = 937, empty = 75, single = 402, first_length = 457, circle_length = 758;
  int segment_b = 237, segment_a = 247;
};

enum class Format { a, b, c, circle };

/// A or B by the length of the first element, circle where it is a number. Refuses what is no list or tuple.
Format format_of(PyObject* list, const FormatCodes& codes, const std::string& name);

/// Reads format A or B. Coordinates must be numbers; whether they are finite is the geometry's to say.
kerf::Outline read_outline(PyObject* list, Format format, const FormatCodes& codes, const std::string& name);
kerf::Circle read_circle(PyObject* list, const FormatCodes& codes, const std::string& name);
kerf::Curve read_curve(PyObject* list, const FormatCodes& codes, const std::string& name);

/// Format B (or A, with the requests): a list of tuples.
py::list make_list(const kerf::Outline& outline, Format format = Format::b);
py::list make_list(const kerf::Curve& curve);
py::list make_list(const kerf::Circle& circle);

/// Points of an outline closer than this are one: a hundred thousand millionth of its size, and never less
/// than what rounding does to its coordinates.
kerf::Tolerance tolerance_for(const kerf::Outline& outline);

/// Refuses what is not finite or beyond 1e60, naming the element.
void require_finite(const kerf::Outline& outline, const std::string& name);
void require_finite(const kerf::Curve& curve, const std::string& name);

}  // namespace cnc25d

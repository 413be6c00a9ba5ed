// Values in Python: ==, hash, copies and pickling of what Kerf's classes hold, or a refusal with the reason.
#pragma once

#include <string>

#include "bindings.h"

#include "kerf/path/toolpath.h"

namespace kerf::python {

/// A toolpath without its origins, as bytes: equal for equal steps, wherever they come from.
std::string steps_as_bytes(const Toolpath& path);
/// A toolpath of the same steps without origins.
Toolpath without_origins(const Toolpath& path);

/// The columns of a toolpath as a structured NumPy array.
pybind11::object columns_of(const Toolpath& path);

/// Equality and pickling of a value that `write` makes bytes of and `read` makes again; `comparable` gives
/// the bytes that are compared.
template <class Class, class Write, class Read, class Comparable>
void bind_stored(Class& c, Write write, Read read, Comparable comparable) {
  namespace py = pybind11;
  using Value = typename Class::type;
  c.def(
      "__eq__", [comparable](const Value& a, const Value& b) { return comparable(a) == comparable(b); },
      py::is_operator());
  c.def(py::pickle([write](const Value& value) { return py::bytes(write(value)); },
                   [read](const py::bytes& state) {
                     Diagnostics diagnostics;
                     const std::string bytes = state;
                     auto value = read(bytes, "<pickled value>", diagnostics);
                     raise_or_warn(diagnostics);
                     return std::move(*value);
                   }));
}

/// The hash of a value that cannot change: that of the same bytes.
template <class Class, class Comparable>
void bind_hash(Class& c, Comparable comparable) {
  using Value = typename Class::type;
  c.def("__hash__",
        [comparable](const Value& value) { return pybind11::hash(pybind11::bytes(comparable(value))); });
}

/// Copies and pickling raise TypeError with the reason and what to copy instead.
template <class Class>
void refuse_copies(Class& c, const char* reason) {
  c.def(
      "__reduce_ex__",
      [reason](const pybind11::object&, int) -> pybind11::object { throw pybind11::type_error(reason); },
      pybind11::arg("protocol"));
}

}  // namespace kerf::python

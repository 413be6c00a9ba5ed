// What the bindings of the simulators share: a finished simulation, its hazards and arrays for Python.
#pragma once

#include <memory>
#include <vector>

#include "bindings.h"

#include "kerf/mesh.h"
#include "kerf/simulate.h"

namespace kerf::python {

/// A finished simulation with the toolpath it came from (for origins and colours).
struct Result {
  Simulation simulation;
  std::shared_ptr<const Toolpath> path;
  std::shared_ptr<const ToolTable> tools;
  Stock stock;
};

/// A hazard as the dictionary that Python gets.
pybind11::dict describe(const Toolpath& path, const Hazard& hazard);

/// A numpy array of its own memory. Made through numpy's Python interface, which does not depend on the
/// binding library and numpy agreeing on the layout of numpy's structures.
template <class T>
pybind11::object to_array(const std::vector<T>& values, const char* type, pybind11::ssize_t columns) {
  const pybind11::object bytes = pybind11::reinterpret_steal<pybind11::object>(
      PyByteArray_FromStringAndSize(reinterpret_cast<const char*>(values.data()),
                                    static_cast<pybind11::ssize_t>(values.size() * sizeof(T))));
  if (!bytes) throw pybind11::error_already_set();
  const pybind11::object array = pybind11::module_::import("numpy").attr("frombuffer")(bytes, type);
  return columns == 1 ? array : array.attr("reshape")(-1, columns);
}

/// Points, triangles and steps.
pybind11::tuple mesh_tuple(const Mesh& mesh);

}  // namespace kerf::python

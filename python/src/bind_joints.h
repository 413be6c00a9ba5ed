// Slots of finger joints, reliefs of corners, rows over surfaces, and plane shapes in Python.
#pragma once

#include "bindings.h"

namespace kerf::python {

/// Raises the errors of a call: those of its arguments as one ValueError.
void raise_value_errors(const Diagnostics& diagnostics);

void bind_joints(pybind11::module_& m);
void bind_plane_shapes(pybind11::module_& m);

}  // namespace kerf::python

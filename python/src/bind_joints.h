// Slots of finger joints, reliefs of corners, and rows over surfaces in Python.
#pragma once

#include "bindings.h"

namespace kerf::python {

void bind_joints(pybind11::module_& m);

}  // namespace kerf::python

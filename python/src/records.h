// What Kerf reports, as Python values.
#pragma once

#include "bindings.h"
#include "job/record/record.h"

namespace kerf::python {

/// A dict for named members, a tuple for a list of fixed length, else a list; None, bool, int, float, str.
pybind11::object to_python(const Record& record);

}  // namespace kerf::python

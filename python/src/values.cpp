// Values in Python: what toolpaths are compared by, and their columns for NumPy.
#include "values.h"

#include <limits>
#include <pybind11/numpy.h>

#include "job/stored/access.h"

#include "kerf/job/program_file.h"

namespace kerf::python {
namespace py = pybind11;

Toolpath without_origins(const Toolpath& path) {
  Toolpath bare;
  bare.reserve(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) bare.add_copy(path, i);
  std::vector<Step>& steps = std::get<0>(stored::Access::members(bare));
  for (Step& step : steps) {
    stored::Row row = stored::Access::row_of(step);
    row.origin = 0;
    step = stored::Access::step_of(row);
  }
  bare.origins() = OriginTable();
  return bare;
}

std::string steps_as_bytes(const Toolpath& path) { return write_toolpath(without_origins(path)); }

namespace {

constexpr std::size_t kNameLength = 20;  // of the names of steps

/// A row of the array, without padding as NumPy's default is.
#pragma pack(push, 1)
struct ColumnRow {
  char32_t name[kNameLength];
  double x, y, z, feed;
  std::int32_t tool;
  std::uint32_t line;
};
#pragma pack(pop)

py::dtype row_type() {
  py::list fields;
  fields.append(py::make_tuple("step", "U" + std::to_string(kNameLength)));
  for (const char* name : {"x", "y", "z", "feed"}) fields.append(py::make_tuple(name, "f8"));
  fields.append(py::make_tuple("tool", "i4"));
  fields.append(py::make_tuple("line", "u4"));
  return py::dtype::from_args(fields);
}

void fill(const Toolpath& path, ColumnRow* rows) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::int32_t tool = -1;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& step = path[i];
    ColumnRow row{{}, kNone, kNone, kNone, kNone, 0, path.origins().line(step.origin())};
    const std::string_view name = name_of(step.kind());
    for (std::size_t k = 0; k < name.size() && k < kNameLength; ++k)
      row.name[k] = static_cast<unsigned char>(name[k]);
    if (step.kind() == StepKind::tool_change) tool = step.tool_change().tool;
    row.tool = tool;
    if (step.is_motion()) {
      const unsigned unknown = step.unknown_axes();
      const Point3 to = step.to();
      if ((unknown & 1) == 0) row.x = to.x;
      if ((unknown & 2) == 0) row.y = to.y;
      if ((unknown & 4) == 0) row.z = to.z;
      if (step.kind() != StepKind::rapid && step.feed().mm_per_min() > 0.0)
        row.feed = step.feed().mm_per_min();
    }
    rows[i] = row;
  }
}

}  // namespace

py::object columns_of(const Toolpath& path) {
  // Made by NumPy itself: pybind11 before 2.12 reads another size of the type from NumPy 2.
  const py::object made = py::module_::import("numpy").attr("empty")(path.size(), row_type());
  auto columns = py::reinterpret_borrow<py::array>(made);
  fill(path, static_cast<ColumnRow*>(columns.mutable_data()));
  return columns;
}

}  // namespace kerf::python

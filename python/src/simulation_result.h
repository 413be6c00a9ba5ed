// Common to the bindings of the simulators: a finished run, its hazards, and numpy arrays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.h"

#include "kerf/job/findings.h"
#include "kerf/job/outputs.h"
#include "kerf/sim/mesh.h"

namespace kerf::python {

/// A finished run and its job, the base of the three kinds of simulation. The run refers to the toolpath of
/// the job.
struct JobResult {
  std::shared_ptr<const Job> job;
  std::shared_ptr<const JobRun> run;
  const Toolpath& path() const { return job->program.path; }
};
struct MillingResult : JobResult {
  const Simulation& simulation() const { return run->milling(); }
};
struct RotaryResult : JobResult {
  const RotarySimulation& simulation() const { return run->rotary(); }
};
struct PrintResult : JobResult {
  const PrintSimulation& simulation() const { return run->print(); }
};
/// A result of a simulation that was run without make_job; `further` findings precede others of the same
/// step.
template <class Result, class Simulated>
Result result_of(std::shared_ptr<const Job> job, Simulated simulation, std::vector<Finding> further = {}) {
  Result result;
  result.job = std::move(job);
  std::vector<Finding> findings =
      merged(std::move(further), findings_of(simulation.hazards, result.job->program.path));
  result.run = std::make_shared<const JobRun>(JobRun{std::move(simulation), std::move(findings)});
  return result;
}

/// The view of a picture: a name or two angles, (width, height) in pixels, a plane such as "x=25".
View to_view(const pybind11::object& view, const pybind11::object& size,
             const std::optional<std::string>& section);
/// Hazards as their records in `kerf simulate --json`.
pybind11::object hazards_of(const Toolpath& path, const std::vector<Hazard>& hazards);

/// A numpy array with a copy of the values. Made through numpy's Python interface, so that the binding
/// library need not support the installed version of numpy.
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

// OpenSCAD programs with all that they make, as of `kerf run part.scad`, in Python.
#include "bindings.h"
#include "job/scad_job.h"
#include "region_binding.h"

#include "kerf/base/limits.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

/// A program that was run, with the texts of its files.
struct ScadResult {
  ScadJob job;
  std::vector<DesignFile> files;
};

ScadResult run(const std::string& path, std::vector<std::string> defines,
               std::vector<std::string> include_paths, const std::string& parameters,
               const std::string& parameter_set) {
  ProgramOptions options;
  options.defines = std::move(defines);
  options.include_paths = std::move(include_paths);
  const ScadParameterSet set{parameters, parameter_set};
  Diagnostics diagnostics;
  SignalProgress progress;
  ScadResult result;
  {
    const py::gil_scoped_release release;
    if (const auto file = InputFile::open(path, diagnostics, limits::kMaxGcmcSourceBytes, &progress))
      result.job = run_scad_file(*file, options, set, diagnostics, &progress);
    if (!diagnostics.has_errors())
      if (auto files = scad_files(result.job, diagnostics, &progress)) result.files = std::move(*files);
  }
  progress.rethrow();
  raise_os_error_or_warn(diagnostics);
  result.job.program.files.push_back(path);
  return result;
}

py::list parameters_of(const ScadResult& result) {
  py::list list;
  for (const ScadParameter& p : result.job.parameters) {
    py::dict d;
    d["name"] = to_str(p.name);
    d["value"] = to_str(p.value);
    d["group"] = to_str(p.group);
    d["description"] = to_str(p.description);
    d["choices"] = to_str(p.choices);
    d["line"] = p.line;
    list.append(d);
  }
  return list;
}

}  // namespace

void bind_scad(py::module_& m) {
  py::class_<ScadResult>(m, "ScadResult", R"(What an OpenSCAD program makes. Made by `scad`.

Examples
--------
>>> result = kerf.scad("part.scad")
>>> result.output, round(result.area.area)
('', 100))")
      .def("__repr__",
           [](const ScadResult& r) {
             return to_str("<kerf.ScadResult " + r.job.program.source + ": " +
                           std::to_string(r.job.program.path.size()) + " steps, " +
                           std::to_string(r.files.size()) + " files>");
           })
      .def_property_readonly(
          "program", [](const ScadResult& r) { return r.job.program; },
          "Program: its toolpath, tools and stock, as `load` returns it.")
      .def_property_readonly(
          "output", [](const ScadResult& r) { return to_str(r.job.output); },
          "str: what echo() prints, a line each.")
      .def_property_readonly(
          "files",
          [](const ScadResult& r) {
            py::dict files;
            for (const DesignFile& file : r.files) files[to_str(file.name)] = py::bytes(file.bytes);
            return files;
          },
          "dict of str to bytes: the drawings and programs that it writes, by the names that it gives them.")
      .def_property_readonly("parameters", &parameters_of,
                             "list of dict: its variables for the user, with `name`, `value`, `group`, "
                             "`description`, `choices` (as in their comments) and `line`.")
      .def_property_readonly(
          "area",
          [](const ScadResult& r) {
            return r.job.area ? std::optional(PyRegion(*r.job.area)) : std::nullopt;
          },
          "Region or None: the areas of its top level.")
      .def_property_readonly(
          "shown", [](const ScadResult& r) { return r.job.shown; },
          "bool: whether it asks for its part to be shown, by stockandtoolpaths().")
      .def_property_readonly(
          "resolution_mm", [](const ScadResult& r) { return r.job.resolution.mm(); },
          "float: of the simulation that it asks for, mm; 0: automatic.");
  m.def("_scad", &run, py::arg("path"), py::arg("defines"), py::arg("include_paths"), py::arg("parameters"),
        py::arg("parameter_set"));
}

}  // namespace kerf::python

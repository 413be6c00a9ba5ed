// Operations on regions and outlines, and changes of finished programs, in Python. Both take the options of
// the command by name, so that an option exists at the same time in the command, in job files and here.
#include <filesystem>

#include "bindings.h"
#include "program_arguments.h"
#include "region_binding.h"

#include "kerf/cut_program.h"
#include "kerf/op/rework.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

using Texts = std::vector<std::pair<std::string, std::string>>;

/// The outlines of a Region, of one path, or of a list of them.
std::vector<ArtShape> shapes_of(const py::object& value, const py::object& points) {
  std::vector<ArtShape> shapes;
  const auto add = [&](Outline outline) { shapes.push_back({"", "", std::move(outline), {}, {}}); };
  if (py::isinstance<PyRegion>(value)) {
    for (const Outline& loop : value.cast<const PyRegion&>().region.loops) add(loop);
  } else if (!value.is_none()) {
    for (const py::handle path : value) add(path_of(path));
  }
  if (!points.is_none())
    for (const Point2 p : points_of(points)) shapes.push_back({"", "", {}, {}, p});
  return shapes;
}

Program cut(const std::string& op, const py::object& shapes, const py::object& points,
            const std::string& tool, Texts options) {
  options.emplace_back("op", op);
  Diagnostics diagnostics;
  auto job = cut_job_of(options, diagnostics);
  raise_or_warn(diagnostics);
  job->shapes = shapes_of(shapes, points);
  if (!tool.empty()) job->tools[1] = tool;
  for (PictureShape& picture : job->pictures)
    if (!picture.file.empty()) picture.file = std::filesystem::absolute(picture.file).string();
  SignalProgress progress;
  Diagnostics found;
  std::optional<Program> program;
  {
    const py::gil_scoped_release release;
    program = load_cut_job(*job, "", op, found, &progress);
  }
  progress.rethrow();
  raise_or_warn(found);
  program->source = op;
  program->front_end = "cutting job";
  return std::move(*program);
}

Program reworked(const py::object& value, const Texts& options, const py::object& tools) {
  Program program = to_program(value);
  ReworkOptions how;
  for (const auto& [name, text] : options)
    if (!set_rework(how, name, text))
      throw py::value_error("there is no option '" + name + "', or it cannot be '" + text + "'");
  std::map<int, Length> diameters;
  for (const auto& [number, tool] : used_tools(program, to_tool_choices(tools)))
    diameters[number] = tool.diameter;
  auto changed = compute(
      [&](Diagnostics& diagnostics) { return rework(std::move(program.path), diameters, how, diagnostics); });
  program.path = std::move(changed.path);
  return program;
}

}  // namespace

void bind_operations(py::module_& m) {
  m.def("_cut", &cut, py::arg("op"), py::arg("shapes"), py::arg("points"), py::arg("tool"),
        py::arg("options"));
  m.def("_rework", &reworked, py::arg("program"), py::arg("options"), py::arg("tools"));
}

}  // namespace kerf::python

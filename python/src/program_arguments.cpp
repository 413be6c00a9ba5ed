// Conversion of arguments of several functions: programs, tools, stock, machines.
#include "program_arguments.h"

#include "job/load_printer.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

constexpr double kThinnestLayer = 0.02;                                   // mm
constexpr double kSmallestCorrection = 1e-3, kLargestCorrection = 100.0;  // mm, of measured heights

/// {1: "square d=6", 2: kerf.Tool("ball d=3")}
void add_numbered_tools(const py::dict& tools, ToolChoices& choices, Diagnostics& diagnostics) {
  for (const auto& [key, value] : tools) {
    const bool is_number = py::isinstance<py::int_>(key) && !py::isinstance<py::bool_>(key);
    if (!is_number) throw py::type_error("a dict of tools has their numbers as keys: {1: 'square d=6'}");
    if (py::isinstance<Tool>(value)) {
      Tool tool = py::cast<const Tool&>(value);
      tool.number = py::cast<int>(key);
      choices.numbered.insert_or_assign(tool.number, tool);
    } else if (py::isinstance<py::str>(value)) {
      add_tool(py::cast<std::string>(py::str(key)) + "=" + py::cast<std::string>(value),
               script_location("tools"), choices, diagnostics);
    } else {
      throw py::type_error("a dict of tools has Tools or texts as values: {1: 'square d=6'}");
    }
  }
}

void add_tools(const py::handle& value, ToolChoices& choices, Diagnostics& diagnostics) {
  if (py::isinstance<ToolTable>(value)) {
    for (const auto& [number, tool] : py::cast<const ToolTable&>(value).tools())
      choices.table.set(number, tool);
  } else if (py::isinstance<Tool>(value)) {
    const Tool& tool = py::cast<const Tool&>(value);
    if (tool.number == 0)
      choices.any_number = tool;
    else
      choices.numbered.insert_or_assign(tool.number, tool);
  } else if (py::isinstance<py::str>(value)) {
    add_tool(py::cast<std::string>(value), script_location("tools"), choices, diagnostics);
  } else if (py::isinstance<py::dict>(value)) {
    add_numbered_tools(py::cast<py::dict>(value), choices, diagnostics);
  } else if (py::isinstance<py::sequence>(value)) {
    for (const py::handle item : value) add_tools(item, choices, diagnostics);
  } else {
    throw py::type_error(
        "tools must be a Tool, a str such as '2=square d=3 flute=9', a ToolTable, a list of them, or a dict "
        "by number");
  }
}

}  // namespace

Program to_program(const py::handle& value) {
  if (py::isinstance<Program>(value)) return py::cast<const Program&>(value);
  if (!py::isinstance<Toolpath>(value)) throw py::type_error("program must be a Program or a Toolpath");
  Program program;
  program.source = "toolpath";
  program.front_end = "Python";
  program.path = py::cast<const Toolpath&>(value);
  return program;
}

ToolChoices to_tool_choices(const py::handle& value) {
  ToolChoices choices;
  if (value.is_none()) return choices;
  Diagnostics diagnostics;
  add_tools(value, choices, diagnostics);
  raise_or_warn(diagnostics);
  return choices;
}

JobSettings to_settings(const py::handle& tools, const py::handle& stock,
                        const std::vector<std::pair<std::string, Stock>>& fixtures) {
  JobSettings settings;
  settings.tools = to_tool_choices(tools);
  if (py::isinstance<py::str>(stock)) {
    Diagnostics diagnostics;
    settings.stock = read_stock_option(py::cast<std::string>(stock), script_location("stock"), diagnostics);
    raise_or_warn(diagnostics);
  } else if (py::isinstance<Stock>(stock)) {
    settings.stock = py::cast<const Stock&>(stock);
  } else if (!stock.is_none()) {
    throw py::type_error("stock must be a Stock or a str such as '100x60x12 at centre top'");
  }
  for (const auto& [name, solid] : fixtures) settings.fixtures.push_back({name, solid});
  return settings;
}

std::string to_file_name(const py::handle& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fsencode")(path));
}

std::optional<Machine> to_machine(const py::handle& value) {
  if (value.is_none()) return std::nullopt;
  const std::string name = to_file_name(value);
  Diagnostics diagnostics;
  const std::optional<Machine> machine = load_machine(name, diagnostics);
  raise_os_error_or_warn(diagnostics);
  return machine;
}

std::optional<PrinterChoice> to_printer(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  Diagnostics diagnostics;
  auto choice = load_printer(*name, diagnostics);
  raise_os_error_or_warn(diagnostics);
  return choice;
}

MeasuredOptions to_measured_options(const py::handle& work_offset) {
  MeasuredOptions options;
  if (work_offset.is_none()) return options;
  const Point3 zero = to_point3(work_offset, "work_offset");
  options.work_offset = {zero.x, zero.y, zero.z};
  return options;
}

Length to_max_correction(double value) {
  return mm(number_within(value, kSmallestCorrection, kLargestCorrection, "max_correction", "mm"));
}

Length to_spoilboard(double value) {
  return mm(number_within(value, 0.0, limits::kThickestSpoilboard, "spoilboard", "mm"));
}

std::optional<RoundBar> to_bar(const py::handle& value) {
  if (value.is_none()) return std::nullopt;
  if (!py::isinstance<py::str>(value)) throw py::type_error("rotary must be a str such as 'd=40 length=100'");
  Diagnostics diagnostics;
  const auto bar = read_rotary_option(py::cast<std::string>(value), script_location("rotary"), diagnostics);
  raise_or_warn(diagnostics);
  return bar;
}

std::optional<Length> to_layer_height(const std::optional<double>& value) {
  if (!value) return std::nullopt;
  return mm(number_within(*value, kThinnestLayer, limits::kMaxBeadWidth, "layer_height", "mm"));
}

Length to_resolution(double value) {
  if (finite_number(value, "resolution") < 0.0)
    throw py::value_error("resolution must be 0 (automatic) or above, mm");
  return mm(value);
}

unsigned to_threads(long long value) {
  return static_cast<unsigned>(whole_within(value, 0, limits::kMaxThreads, "threads"));
}

}  // namespace kerf::python

// gcodepreview's machine in Python: its commands as methods, its state as attributes.
#include <deque>
#include <utility>

#include "base/codes/files.h"
#include "job/design_services.h"
#include "machine_binding.h"
#include "values.h"

#include "kerf/base/files.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

using design::Machine;

// ------------------------------------------------------------------------------------- services of a machine

/// The lines that a function of the script returns for a moment.
std::vector<std::string> further_lines(const py::handle& self, design::Moment moment, int tool) {
  static constexpr const char* kHooks[] = {"on_open", "on_section", "on_close"};
  const py::object hook = py::getattr(self, kHooks[static_cast<std::size_t>(moment)], py::none());
  std::vector<std::string> lines;
  if (hook.is_none()) return lines;
  const py::object made = moment == design::Moment::tool_changed ? hook(self, tool) : hook(self);
  if (!made.is_none())
    for (const py::handle line : made) lines.push_back(py::cast<std::string>(py::str(line)));
  return lines;
}

/// The name of an output: relative ones are in the folder of the object.
std::string in_folder(const PyMachine& object, const std::string& name) {
  const py::object join = py::module_::import("os.path").attr("join");
  return py::cast<std::string>(join(object.folder, name));
}

void check_folder(const PyMachine& object, const std::string& name, Diagnostics& diagnostics) {
  const py::object os = py::module_::import("os");
  const std::string file = in_folder(object, name);
  std::string folder = py::cast<std::string>(os.attr("path").attr("dirname")(file));
  if (folder.empty()) folder = ".";
  if (!py::cast<bool>(os.attr("access")(folder, os.attr("W_OK"))))
    diagnostics.error(codes::file_unwritable, {}, "opengcodefile: cannot write in " + folder);
}

design::MachineOptions services_of(PyMachine& object) {
  design::MachineOptions options = machine_services(&object.progress);
  const auto load_stock = options.load_stock;
  options.load_stock = [&object, load_stock](const std::string& file, Diagnostics& diagnostics) {
    object.inputs.push_back(file);
    return load_stock(file, diagnostics);
  };
  const auto read_program = options.read_program;
  options.read_program = [&object, read_program](const std::string& file, Diagnostics& diagnostics) {
    object.inputs.push_back(file);
    return read_program(file, diagnostics);
  };
  // The simulation of the script's object, which warns of hazards.
  options.left_stock = [&object](const design::CutSide&, Diagnostics&) {
    return std::optional(py::cast<Stock>(object.self.attr("_left_stock")()));
  };
  options.further_lines = [&object](design::Moment moment, int tool) {
    return further_lines(object.self, moment, tool);
  };
  options.check_output = [&object](const std::string& name, Diagnostics& diagnostics) {
    check_folder(object, name, diagnostics);
  };
  return options;
}

// ------------------------------------------------------------------------------------ commands as methods

constexpr std::size_t kMaxCommands = 256;
PyTypeObject* machine_type = nullptr;  // of the class Machine

PyMachine& machine_of(PyObject* self) {
  auto* held = reinterpret_cast<py::detail::instance*>(self);
  auto* object = static_cast<PyMachine*>(held->get_value_and_holder().value_ptr());
  if (object == nullptr) throw py::type_error("the object has no machine: super().__init__() was not called");
  return *object;
}

PyObject* called(std::size_t row, PyObject* self, PyObject* const* args, Py_ssize_t count, PyObject* names) {
  return call_command(design::commands()[row], self, args, count, names, machine_of);
}

/// The function of a row: Python's methods have no other memory for its number.
template <std::size_t row>
PyObject* method(PyObject* self, PyObject* const* args, Py_ssize_t count, PyObject* names) {
  return called(row, self, args, count, names);
}
template <std::size_t... rows>
auto method_table(std::index_sequence<rows...>) {
  return std::array<PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*), sizeof...(rows)>{
      method<rows>...};
}

/// Adds each command to the class, under its name; gcodepreview() itself as `_start`.
void add_methods(const py::object& type) {
  static const auto functions = method_table(std::make_index_sequence<kMaxCommands>());
  static std::deque<std::string> texts;
  static std::deque<PyMethodDef> methods;
  const std::vector<design::Command>& table = design::commands();
  assert(table.size() <= kMaxCommands);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool starts = table[i].name == "gcodepreview";
    if (!table[i].needs_start && !starts) continue;  // shapes, which need no object
    const std::string& name = texts.emplace_back(starts ? "_start" : std::string(table[i].name));
    const std::string& text = texts.emplace_back(docstring_of(table[i]));
    methods.push_back({name.c_str(), reinterpret_cast<PyCFunction>(reinterpret_cast<void*>(functions[i])),
                       METH_FASTCALL | METH_KEYWORDS, text.c_str()});
    PyObject* descriptor = PyDescr_NewMethod(machine_type, &methods.back());
    if (descriptor == nullptr || PyObject_SetAttrString(type.ptr(), name.c_str(), descriptor) != 0)
      throw py::error_already_set();
    Py_DECREF(descriptor);
  }
}

/// A command that needs no object, by its name.
py::object design_value(const std::string& name, const py::args& args) {
  static PyMachine object;
  for (const design::Command& command : design::commands()) {
    if (command.name != name) continue;
    std::vector<PyObject*> given;
    for (const py::handle argument : args) given.push_back(argument.ptr());
    PyObject* result =
        call_command(command, object, nullptr, given.data(), static_cast<Py_ssize_t>(given.size()), nullptr);
    if (result == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(result);
  }
  throw py::value_error("there is no command " + name);
}

// ------------------------------------------------------------------------------------------- attributes

using Class = py::class_<PyMachine>;

template <class Field>
void add_number(Class& c, const char* name, Field field, const char* text) {
  c.def_property(
      name, [field](PyMachine& m) { return field(m.machine); },
      [field, name](PyMachine& m, double value) { field(m.machine) = finite_number(value, name); }, text);
}

void add_positions(Class& c) {
  static constexpr const char* kNames[] = {"mpx", "mpy", "mpz"};
  for (int axis = 0; axis < 3; ++axis)
    c.def_property(
        kNames[axis], [axis](const PyMachine& m) { return m.machine.position()[axis]; },
        [axis](PyMachine& m, double value) { m.machine.set_axis(axis, finite_number(value, kNames[axis])); },
        "float: the current position, mm.");
}

void add_numbers(Class& c) {
  add_number(
      c, "retractheight", [](Machine& m) -> double& { return m.retract_height; },
      "float: of moves between cuts, mm.");
  add_number(
      c, "feed", [](Machine& m) -> double& { return m.feed; }, "float: of cuts, mm/min.");
  add_number(
      c, "plunge", [](Machine& m) -> double& { return m.plunge; }, "float: of cuts straight down, mm/min.");
  add_number(
      c, "resolution", [](Machine& m) -> double& { return m.resolution; }, "float: of the simulation, mm.");
  add_number(
      c, "feedrate", [](Machine& m) -> double& { return m.print.feed; }, "float: of beads, mm/min.");
  add_number(
      c, "nozzlediameter", [](Machine& m) -> double& { return m.print.nozzle; }, "float: mm.");
  add_number(
      c, "filamentdiameter", [](Machine& m) -> double& { return m.print.filament; }, "float: mm.");
  add_number(
      c, "extrusionwidth", [](Machine& m) -> double& { return m.print.width; }, "float: of beads, mm.");
  add_number(
      c, "layerheight", [](Machine& m) -> double& { return m.print.height; }, "float: of beads, mm.");
}

template <class Field>
void add_flag(Class& c, const char* name, Field field, const char* text) {
  c.def_property(
      name, [field](PyMachine& m) { return field(m.machine); },
      [field](PyMachine& m, bool value) { field(m.machine) = value; }, text);
}

void add_text(Class& c, const char* name, std::string design::FileSettings::*field, const char* text) {
  c.def_property(
      name, [field](const PyMachine& m) { return to_str(m.machine.settings.*field); },
      [field](PyMachine& m, std::string value) { m.machine.settings.*field = std::move(value); }, text);
}

void set_version(PyMachine& m, const std::string& name) {
  if (name != "r2000" && name != "r12") throw py::value_error("dxfversion must be 'r2000' or 'r12'");
  m.machine.settings.version = name == "r12" ? DxfVersion::r12 : DxfVersion::r2000;
}

constexpr const char* kLayers[] = {"colour", "tool", "depth"};
void set_layers(PyMachine& m, const std::string& name) {
  for (std::size_t i = 0; i < 3; ++i)
    if (name == kLayers[i]) {
      m.machine.settings.layers = static_cast<design::FileSettings::Layers>(i);
      return;
    }
  throw py::value_error("dxflayers must be 'colour', 'tool' or 'depth'");
}

constexpr const char* kModes[] = {"cut", "print", "no_preview"};

void add_settings(Class& c) {
  add_flag(
      c, "generategcode", [](Machine& m) -> bool& { return m.settings.gcode; }, "bool: of the constructor.");
  add_flag(
      c, "generatedxf", [](Machine& m) -> bool& { return m.settings.dxf; }, "bool: of the constructor.");
  add_flag(
      c, "dxfstagger", [](Machine& m) -> bool& { return m.settings.stagger; },
      "bool: whether colours are drawn beside each other.");
  add_flag(
      c, "debugenable", [](Machine& m) -> bool& { return m.debug; }, "bool: whether `debug` prints.");
  add_text(c, "post", &design::FileSettings::post, "str: the controller for which G-code is written.");
  add_text(c, "gcodefilext", &design::FileSettings::ending, "str: the ending of G-code files.");
  c.def_property(
      "dxfversion",
      [](const PyMachine& m) { return m.machine.settings.version == DxfVersion::r12 ? "r12" : "r2000"; },
      &set_version, "str: 'r2000' or 'r12'.");
  c.def_property(
      "dxflayers",
      [](const PyMachine& m) { return kLayers[static_cast<std::size_t>(m.machine.settings.layers)]; },
      &set_layers, "str: 'colour', 'tool' or 'depth': what has a layer of its own.");
  c.def_property(
      "dxfjoin",
      [](const PyMachine& m) { return m.machine.settings.chains == design::Sketch::Chains::joined; },
      [](PyMachine& m, bool joined) {
        m.machine.settings.chains = joined ? design::Sketch::Chains::joined : design::Sketch::Chains::loose;
      },
      "bool: whether lines and arcs that meet become polylines.");
  c.def_property(
      "dxfcolor", [](const PyMachine& m) { return to_str(m.machine.colour.name); },
      [](const py::object& self, const py::object& name) { self.attr("setdxfcolor")(name); },
      "str: the colour of the following entities.");
  c.def_property_readonly(
      "dxfclosed", [](const PyMachine& m) { return !m.machine.dxf_name; },
      "bool: whether no drawing is open.");
  c.def_property_readonly(
      "mode", [](const PyMachine& m) { return kModes[static_cast<std::size_t>(m.machine.mode())]; },
      "str: 'cut', 'print' or 'no_preview'.");
  c.def_readwrite("folder", &PyMachine::folder, "str: the folder of outputs with a relative name.");
}

py::list parts_of(const Tool& tool) {
  py::list parts;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    py::list knots;
    for (const Knot& k : tool.silhouette.part(part).knots) knots.append(py::make_tuple(k.r, k.z, k.bulge));
    parts.append(knots);
  }
  return parts;
}

void add_tools(Class& c) {
  c.def_property_readonly(
      "currenttoolnum", [](const PyMachine& m) { return m.machine.tool().given; },
      "int: the number of the tool in use, as it was given.");
  c.def_property_readonly(
      "toolnumber",
      [](const PyMachine& m) { return m.machine.tool_numbers().generated_number(m.machine.tool().number); },
      "str: the generated number of the tool in use.");
  c.def_property_readonly(
      "endmilltype", [](const PyMachine& m) { return to_str(m.machine.tool().shape()); },
      "str: the shape of the tool in use.");
  c.def_property_readonly(
      "diameter", [](const PyMachine& m) { return m.machine.tool().diameter(); },
      "float: of the tool in use, mm.");
  c.def_property_readonly(
      "speed", [](const PyMachine& m) { return m.machine.speed(); }, "float: of the spindle, rpm.");
  c.def_property_readonly(
      "feedratios",
      [](const PyMachine& m) {
        py::dict ratios;
        for (const auto& [name, ratio] : m.machine.ratios) ratios[to_str(name)] = ratio;
        return ratios;
      },
      "dict: ratios of feeds by class of tool.");
  c.def_property_readonly("_tool", [](const PyMachine& m) { return m.machine.tool().tool; });
  c.def_property_readonly("_tool_number", [](const PyMachine& m) { return m.machine.tool().number; });
  c.def_property_readonly("_tool_is_described",
                          [](const PyMachine& m) { return m.machine.tool().described; });
  c.def_property_readonly("_tool_parts", [](const PyMachine& m) { return parts_of(m.machine.tool().tool); });
  c.def_property_readonly("_tools", [](const PyMachine& m) { return m.machine.tool_numbers().all(); });
}

/// The drawing of colours beside each other needs the stock: its error is that of the machine.
template <class Make>
py::bytes drawn(PyMachine& m, Make make) {
  try {
    return make(m.machine);
  } catch (const design::Refusal& refusal) {
    raise_machine_error(refusal.message);
  }
}

void add_results(Class& c) {
  c.def_property(
      "stock", [](const PyMachine& m) { return m.machine.stock; },
      [](PyMachine& m, std::optional<Stock> stock) {
        m.machine.stock = std::move(stock);
        m.machine.blocks.clear();
      },
      "Stock or None: the material before the first cut.");
  c.def_property(
      "toolpath", [](const PyMachine& m) { return m.machine.shared_path(); },
      [](PyMachine& m, std::shared_ptr<Toolpath> path) { m.machine.set_path(std::move(path)); },
      "Toolpath: the steps so far.");
  c.def("_dxf", [](PyMachine& m) { return drawn(m, [](const Machine& made) { return made.dxf(); }); });
  c.def("_svg", [](PyMachine& m) { return drawn(m, [](const Machine& made) { return made.svg(); }); });
  c.def("_file_path", [](const PyMachine& m) { return m.machine.program(); });
  c.def("_moves", [](const PyMachine& m, std::size_t first) {
    const Toolpath& path = m.machine.path();
    return moves_of(path, first, start_of(path, first), m.machine.tool().number);
  });
}

}  // namespace

PyMachine::PyMachine() : folder(""), machine(services_of(*this)) {}

void PyMachine::write_outputs() {
  std::vector<DesignFile> files = machine.take_files();
  Diagnostics diagnostics;
  for (const DesignProgram& made : machine.take_programs())
    post_design(made, machine.tool_numbers().own(), files, diagnostics, &progress);
  progress.finish();
  raise_or_warn(diagnostics);
  OutputSet set(inputs);
  bool written = true;
  for (const DesignFile& file : files)
    written = written && set.write(in_folder(*this, file.name), file.bytes, diagnostics);
  if (written) set.commit(diagnostics);
  raise_os_error_or_warn(diagnostics);
}

void bind_machine(py::module_& m) {
  add_machine_error(m);
  Class c(m, "Machine", "The machine of gcodepreview, without its results: the base of `gcodepreview`.");
  machine_type = reinterpret_cast<PyTypeObject*>(c.ptr());
  c.def(py::init<>());
  add_methods(c);
  add_positions(c);
  add_numbers(c);
  add_settings(c);
  add_tools(c);
  add_results(c);
  refuse_copies(c,
                "a machine of gcodepreview cannot be copied or pickled: it may write files at its end; "
                "its `toolpath` and `stock` can");
  m.def("_set_move_classes", &set_move_classes, py::arg("move"), py::arg("moves"));
  m.def("_design_value", &design_value, py::arg("name"));
  py::list two_forms;
  for (const design::Command& command : design::commands())
    if (command.numbers_without_tool) two_forms.append(std::string(command.name));
  m.attr("_TWO_FORMS") = py::frozenset(two_forms);
}

}  // namespace kerf::python

// The printer in Python: layers, walls, fills and travel as calls (kerf/op/printer.h).
#include <functional>

#include "base/names.h"
#include "base/number.h"
#include "bindings.h"
#include "job/load_printer.h"
#include "path/motion_limits.h"
#include "region_binding.h"
#include "values.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/job/program.h"
#include "kerf/op/printer.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

/// A printer with the diagnostics that it appends to.
class PyPrinter {
 public:
  explicit PyPrinter(const PrinterSettings& settings)
      : printer_(settings, diagnostics_, script_location("Printer")) {
    raise();
  }
  /// Runs `work(printer)` for a call of this name and raises its errors.
  template <class Work>
  auto call(const char* name, Work work) {
    printer_.set_origin(script_location(name));
    auto made = work(printer_);
    raise();
    return made;
  }
  const Printer& printer() const { return printer_; }
  Toolpath& path() { return printer_.path(); }

 private:
  void raise() {
    const Diagnostics found = std::move(diagnostics_);
    diagnostics_ = Diagnostics();
    raise_or_warn(found);
  }

  Diagnostics diagnostics_;
  Printer printer_;
};

BeadKind to_kind(const std::string& name) {
  if (const auto kind = bead_kind_named(name)) return *kind;
  throw py::value_error("there is no kind of bead '" + clipped(name, 60) + "'");
}

Seam to_seam(const std::string& name) {
  if (name == "nearest") return Seam::nearest;
  if (name == "rear") return Seam::rear;
  throw py::value_error("seam must be 'nearest' or 'rear', not '" + clipped(name, 60) + "'");
}

FillPattern to_pattern(const std::string& name) {
  if (name == "zigzag") return FillPattern::zigzag;
  if (name == "concentric") return FillPattern::concentric;
  throw py::value_error("pattern must be 'zigzag' or 'concentric', not '" + clipped(name, 60) + "'");
}

PyRegion region_of(std::optional<Region> made) { return PyRegion(made ? std::move(*made) : Region()); }

std::string text_of(PyPrinter& p) {
  return "<kerf.Printer at Z" + number_text(p.printer().z(), 3) +
         " mm: " + number_text(p.printer().printed().mm3(), 3) + " mm3 printed, " +
         std::to_string(p.path().size()) + " steps>";
}

void bind_state(py::class_<PyPrinter>& c) {
  c.def("__repr__", &text_of);
  c.def_property_readonly(
      "path", [](PyPrinter& p) -> Toolpath& { return p.path(); }, py::return_value_policy::reference_internal,
      "The toolpath so far; steps such as fans can be appended to it between calls.");
  c.def_property_readonly(
      "z", [](const PyPrinter& p) { return p.printer().z(); }, "Top of the present layer, mm.");
  c.def_property_readonly(
      "spacing", [](const PyPrinter& p) { return p.printer().spacing().mm(); },
      "Distance of neighbouring beads, mm.");
  c.def_property_readonly(
      "printed_mm3", [](const PyPrinter& p) { return p.printer().printed().mm3(); },
      "Volume of all beads so far, mm3.");
  c.def(
      "start",
      [](PyPrinter& p, double nozzle, double bed, double lift) {
        p.call("start", [&](Printer& printer) { return printer.start({nozzle, bed, lift}), 0; });
      },
      py::arg("nozzle") = 0.0, py::arg("bed") = 0.0, py::arg("lift") = 5.0,
      R"(Heat the nozzle and the bed, run to the end switches, lift the nozzle.

Parameters
----------
nozzle, bed : float
    C; 0: not heated.
lift : float
    mm.)");
  c.def(
      "finish",
      [](PyPrinter& p, double lift) {
        p.call("finish", [&](Printer& printer) { return printer.finish({lift}), 0; });
      },
      py::arg("lift") = 10.0,
      R"(Draw the filament back, lift the nozzle, switch heaters and fan off.

Parameters
----------
lift : float
    mm.)");
  c.def(
      "next_layer",
      [](PyPrinter& p, const std::optional<double>& height) {
        const auto wanted = height ? std::optional(mm(*height)) : std::nullopt;
        p.call("next_layer", [&](Printer& printer) { return printer.next_layer(wanted); });
        return p.printer().z();
      },
      py::arg("height") = py::none(), R"(Start a layer above the last one.

Parameters
----------
height : float, optional
    mm. Default: that of the printer.

Returns
-------
float
    Z of its top, mm.)");
  c.def(
      "travel",
      [](PyPrinter& p, const py::object& to) {
        const Point2 end = to_point2(to, "to");
        p.call("travel", [&](Printer& printer) { return printer.travel(end); });
      },
      py::arg("to"), R"(Move to a point of the layer without printing.

Parameters
----------
to : (float, float)
    x and y, mm.)");
}

void bind_beads(py::class_<PyPrinter>& c) {
  c.def(
      "bead",
      [](PyPrinter& p, const py::object& path, const std::string& kind, double width, double speed) {
        const Outline outline = path_of(path);
        const BeadOptions how{to_kind(kind), mm(width), mm_per_min(speed)};
        p.call("bead", [&](Printer& printer) { return printer.bead(outline, how); });
      },
      py::arg("path"), py::arg("kind") = "", py::arg("width") = 0.0, py::arg("speed") = 0.0,
      R"(Print a bead along a path.

Parameters
----------
path : list of points and arcs, or a circle
    As of `Region`, mm.
kind : str
    Such as 'infill', for comments.
width, speed : float
    mm and mm/min; 0: those of the printer.)");
  c.def(
      "walls",
      [](PyPrinter& p, const PyRegion& region, int count) {
        return region_of(
            p.call("walls", [&](Printer& printer) { return printer.walls(region.region, count); }));
      },
      py::arg("region"), py::arg("count") = 1,
      R"(Print walls inside the boundary of a region, the outermost first.

Parameters
----------
region : Region
    What the walls bound.
count : int
    Number of walls.

Returns
-------
Region
    What is inside the walls.)");
  c.def(
      "fill",
      [](PyPrinter& p, const PyRegion& region, const std::string& pattern, double angle, double density,
         const std::string& kind, double speed) {
        const FillOptions how{to_pattern(pattern), degrees(finite_number(angle, "angle")), density,
                              to_kind(kind), mm_per_min(speed)};
        return region_of(p.call("fill", [&](Printer& printer) { return printer.fill(region.region, how); }));
      },
      py::arg("region"), py::arg("pattern") = "zigzag", py::arg("angle") = 0.0, py::arg("density") = 1.0,
      py::arg("kind") = "", py::arg("speed") = 0.0,
      R"(Fill a region up to its boundary.

Parameters
----------
region : Region
    What is filled.
pattern : {'zigzag', 'concentric'}
angle : float
    Angle of the beads of a zigzag, degrees from +x.
density : float
    Above 0 and at most 1, which is solid.
kind : str
    As of `Toolpath.extrude`; default: 'solid_infill' or 'infill'.
speed : float
    mm/min; 0: that of the printer.

Returns
-------
Region
    The parts that beads are too wide for.)");
}

void bind_other_beads(py::class_<PyPrinter>& c) {
  c.def(
      "brim",
      [](PyPrinter& p, const PyRegion& region, int loops, double gap) {
        p.call("brim", [&](Printer& printer) { return printer.brim(region.region, loops, mm(gap)); });
      },
      py::arg("region"), py::arg("loops") = 5, py::arg("gap") = 0.0,
      R"(Print loops around a region, from the outside.

Parameters
----------
region : Region
    What is inside the loops.
loops : int
    Number of loops.
gap : float
    Between the region and the last loop, mm.)");
  c.def(
      "vase",
      [](PyPrinter& p, const py::object& path, double top) {
        const Outline outline = path_of(path);
        p.call("vase", [&](Printer& printer) { return printer.vase(outline, top); });
      },
      py::arg("path"), py::arg("top"),
      R"(Print a wall along a closed path, rising without a seam from the present layer.

Parameters
----------
path : list of points and arcs, or a circle
    As of `Region`, mm.
top : float
    Z at which it ends, mm.)");
  c.def(
      "iron",
      [](PyPrinter& p, const PyRegion& region, double spacing, double angle, double flow, double speed) {
        const IroningOptions how{mm(spacing), degrees(finite_number(angle, "angle")), flow,
                                 mm_per_min(speed)};
        p.call("iron", [&](Printer& printer) { return printer.iron(region.region, how); });
      },
      py::arg("region"), py::arg("spacing") = 0.1, py::arg("angle") = 0.0, py::arg("flow") = 0.0,
      py::arg("speed") = 1200.0,
      R"(Run over a region at the height of the layer, in rows.

Parameters
----------
region : Region
    What is ironed.
spacing : float
    Distance of rows, mm.
angle : float
    Direction of rows, from +X, degrees.
flow : float
    What is extruded, as a fraction of a layer.
speed : float
    mm/min.)");
}

PrinterSettings settings_of(double width, double height, double speed, const py::kwargs& more) {
  PrinterSettings s;
  s.width = mm(width), s.height = mm(height), s.speed = mm_per_min(speed);
  const std::pair<const char*, std::function<void(double)>> numbers[] = {
      {"filament", [&](double v) { s.filament = mm(v); }},
      {"first_layer_speed", [&](double v) { s.first_layer_speed = mm_per_min(v); }},
      {"travel_speed", [&](double v) { s.travel_speed = mm_per_min(v); }},
      {"max_flow", [&](double v) { s.max_flow = mm3_per_s(v); }},
      {"flow", [&](double v) { s.flow = v; }},
      {"side_overlap", [&](double v) { s.side_overlap = v; }},
      {"retract", [&](double v) { s.retract = mm(v); }},
      {"retract_speed", [&](double v) { s.retract_speed = mm_per_min(v); }},
      {"min_travel", [&](double v) { s.min_travel = mm(v); }},
      {"hop", [&](double v) { s.hop = mm(v); }},
      {"wipe", [&](double v) { s.wipe = mm(v); }},
      {"chord", [&](double v) { s.chord = mm(v); }}};
  for (const auto& [key, value] : more) {
    const auto name = py::cast<std::string>(key);
    bool known = name == "seam";
    if (known) s.seam = to_seam(py::cast<std::string>(value));
    for (const auto& [number, set] : numbers)
      if (name == number) set(py::cast<double>(value)), known = true;
    if (!known) throw py::type_error("Printer has no setting '" + clipped(name, 60) + "'");
  }
  return s;
}

}  // namespace

py::dict profile_of(const std::string& name) {
  Diagnostics diagnostics;
  const auto choice = load_printer(name, diagnostics);
  raise_or_warn(diagnostics);
  const PrinterProfile& printer = choice->printer;
  const FilamentProfile& filament = choice->filament;
  py::dict settings, profile;
  const auto set = [&](const char* key, double value) {
    if (value > 0.0) settings[key] = value;
  };
  set("width", printer.width.mm());
  set("height", printer.layer.mm());
  set("speed", printer.speed.mm_per_min());
  set("filament", (filament.diameter > Length{} ? filament.diameter : printer.filament).mm());
  set("first_layer_speed", printer.first_layer_speed.mm_per_min());
  set("travel_speed", printer.travel_speed.mm_per_min());
  set("max_flow", in_mm3_per_s(limits_of(*choice).max_flow));
  set("retract", printer.retract.mm());
  set("retract_speed", printer.retract_speed.mm_per_min());
  set("hop", printer.hop.mm());
  profile["name"] = printer.name;
  profile["firmware"] = printer.firmware;
  profile["settings"] = settings;
  profile["nozzle"] = filament.first_nozzle > 0.0 ? filament.first_nozzle : filament.nozzle;
  profile["bed"] = filament.first_bed > 0.0 ? filament.first_bed : filament.bed;
  return profile;
}

py::dict known_printers() {
  const PrinterTable& table = built_in_printers();
  const auto stated = [](double value) { return value > 0.0 ? py::object(py::float_(value)) : py::none(); };
  py::list printers, filaments;
  for (const PrinterProfile& p : table.printers) {
    py::dict d;
    d["name"] = p.name;
    d["names"] = p.names;
    d["firmware"] = p.firmware;
    d["bed_mm"] =
        p.bed ? py::object(py::make_tuple(to_tuple(p.bed->low), to_tuple(p.bed->high))) : py::none();
    d["max_flow_mm3_s"] = stated(in_mm3_per_s(p.max_flow));
    printers.append(d);
  }
  for (const FilamentProfile& f : table.filaments) {
    py::dict d;
    d["name"] = f.name;
    d["nozzle"] = stated(f.nozzle);
    d["bed"] = stated(f.bed);
    filaments.append(d);
  }
  py::dict all;
  all["printers"] = printers;
  all["filaments"] = filaments;
  return all;
}

/// The text of a printer file from a sliced program.
std::string imported(const std::string& name) {
  Diagnostics diagnostics;
  const auto file = InputFile::open(name, diagnostics);
  raise_os_error_or_warn(diagnostics);
  SignalProgress progress;
  std::optional<Program> program;
  {
    const py::gil_scoped_release release;
    program = load_program(name, {}, diagnostics, &progress);
  }
  progress.rethrow();
  raise_or_warn(diagnostics);
  if (!program->path.has(StepKind::extrude))
    throw py::value_error("the program does not print; a printer is imported from a sliced program");
  return write_printer_file(import_printer(file->bytes(), program->path));
}

constexpr const char* kProfile = R"(Look up a printer and a filament.

Parameters
----------
printer : str
    'ender_3', 'ender_3:PLA', 'printer.toml' or 'printer.toml:PLA'; `printers` lists the names.

Returns
-------
dict
    'name', 'firmware' (a post), 'settings' (of `Printer`, as far as they are known), 'nozzle' and 'bed' (C;
    0: not known).

Raises
------
kerf.Error
    For an unknown name or an invalid file.

Examples
--------
>>> profile = kerf.printer_profile('prusa_i3:PETG')
>>> printer = kerf.Printer(**profile['settings'])
>>> printer.start(nozzle=profile['nozzle'], bed=profile['bed']))";

void bind_printer(py::module_& m) {
  m.def("printer_profile", &profile_of, py::arg("printer"), kProfile);
  m.def("printers", &known_printers,
        R"(List the printers and filaments that are known.

Returns
-------
dict
    Lists of dict: `printers` (`name`, other `names`, `firmware`, `bed_mm` as low and high corner,
    `max_flow_mm3_s`) and `filaments` (`name`, `nozzle` and `bed` in C); None: not stated.

Examples
--------
>>> "ender_3" in [printer["name"] for printer in kerf.printers()["printers"]]
True)");
  m.def("_import_printer", &imported, py::arg("name"));
  py::class_<PyPrinter> c(m, "Printer", R"(Prints layers of beads into a toolpath.

Parameters
----------
width, height : float
    Width of beads, mm.
speed : float
    Speed of beads, mm/min.
filament : float
    Diameter, mm (1.75).
first_layer_speed, travel_speed : float
    mm/min; 0: `speed`; 9000.
max_flow : float
    Highest flow of the hot end, mm3/s, which limits the speed; 0: no limit.
flow : float
    Factor of all volumes (1).
side_overlap : float
    Overlap of neighbouring beads, as a fraction of the height (0.08).
retract, retract_speed, min_travel, hop, wipe : float
    Filament drawn back before a travel, mm (0.8), at mm/min (2400), from this length of travel on, mm (1.5);
    the rise of the nozzle, mm (0), and the way back along the bead over which it is drawn back, mm (0).
seam : {'nearest', 'rear'}
chord : float
    Deviation of the straight beads that arcs are printed as, mm (0.01).

Raises
------
kerf.Error
    For a setting out of range.

Examples
--------
>>> printer = kerf.Printer(width=0.45, height=0.2, speed=3000)
>>> printer.start(nozzle=210, bed=60)
>>> for _ in range(3):
...     z = printer.next_layer()
...     inside = printer.walls(kerf.Region([(50, 50, 20)]), 2))");
  refuse_copies(c, "a Printer cannot be copied or pickled: it is between two beads; its `path` can");
  c.def(py::init([](double width, double height, double speed, const py::kwargs& more) {
          return std::make_unique<PyPrinter>(settings_of(width, height, speed, more));
        }),
        py::arg("width") = 0.45, py::arg("height") = 0.2, py::arg("speed") = 3000.0);
  bind_state(c);
  bind_beads(c);
  bind_other_beads(c);
}

}  // namespace kerf::python

// Printers and filaments from files: data/printers.toml, compiled in, and files of the same form.
//
//   Diagnostics diagnostics;
//   const auto chosen = printer_named("ender_3:PLA", diagnostics);
//   check_print(path, limits_of(*chosen));
//
// docs/manual/printing.md lists the keys. Values that a printer does not have stay unknown: a bed without a
// size and a hot end without a flow are not checked.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/check.h"
#include "kerf/path/estimate.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct FilamentProfile {
  std::string name;
  std::vector<std::string> names;  ///< others that it is found by
  double nozzle = 0.0, bed = 0.0;  ///< C; 0: not stated
  double first_nozzle = 0.0;       ///< of the first layer; 0: as `nozzle`
  double first_bed = 0.0;          ///< likewise
  double min_nozzle = 0.0;         ///< C, below which it must not be extruded; 0: not stated
  Length diameter{};               ///< 0: not stated
  double density = 0.0;            ///< g/cm3; 0: not stated
  VolumeFlow max_flow{};           ///< 0: not stated
};

/// Settings that are 0 or empty are not stated.
struct PrinterProfile {
  std::string name;
  std::vector<std::string> names;          ///< others that it is found by
  std::string firmware = "marlin";         ///< the name of its post: marlin, klipper, reprapfirmware, plain
  std::optional<Box3> bed;                 ///< where the nozzle may be, mm
  Length nozzle{}, filament{};             ///< diameters
  VolumeFlow max_flow{};                   ///< of the hot end
  double max_nozzle = 0.0, max_bed = 0.0;  ///< C
  PrintPlanner planner{};
  bool has_planner = false;                ///< limits of motions are stated
  Length width{}, layer{}, first_layer{};  ///< of beads
  Feed speed{}, first_layer_speed{}, travel_speed{};
  Length retract{}, hop{};
  Feed retract_speed{};
  std::vector<std::string> start, end;  ///< lines of a post's header and footer; {nozzle} and {bed} are in C
};

/// A printer with a filament.
struct PrinterChoice {
  PrinterProfile printer;
  FilamentProfile filament;
};

struct PrinterTable {
  std::vector<PrinterProfile> printers;
  std::vector<FilamentProfile> filaments;
};
const PrinterTable& built_in_printers();
/// Reads a file with [[printer]] and [[filament]]. All errors are reported with their location.
PrinterTable read_printer_file(std::string_view text, std::string_view file_name, Diagnostics& diagnostics);
/// A printer and a filament by their names, "ender_3" or "ender_3:PLA", compared by fold_name. Names that are
/// not in `table` are searched in the built-in one; without a name the first printer of `table` and, if it
/// has only one, its filament. An unknown name is an error with a hint.
std::optional<PrinterChoice> printer_named(std::string_view name, const PrinterTable& table,
                                           Diagnostics& diagnostics);

PrinterLimits limits_of(const PrinterChoice& choice);

/// The text of a file with one printer and one filament.
std::string write_printer_file(const PrinterChoice& choice);
/// The text of a post file (docs/manual/posts.md) for its firmware, start and end.
std::string post_of(const PrinterChoice& choice);

/// The printer and the filament of a sliced program: settings that slicers write as comments, and what the
/// steps show. `text` is the program, `path` its toolpath.
PrinterChoice import_printer(std::string_view text, const Toolpath& path);

}  // namespace kerf

// The time of a print as its firmware plans it, and its highest flow beside that of the hot end.
//
//   const PlannedPrint plan = planned_print(program.path, printer ? &*printer : nullptr, mm(1.75));
//   plan.total().seconds();
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "kerf/base/units.h"
#include "kerf/formats/printer_files.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct PlannedPrint {
  Duration motion, dwell;
  std::string_view method;  ///< such as "as Marlin plans, by jerk"
  std::string printer;      ///< whose limits are used; empty: those of the program and the default
  VolumeFlow highest{};
  std::size_t step = 0;  ///< with the highest flow
  VolumeFlow limit{};    ///< of the hot end; 0: unknown
  Duration total() const { return motion + dwell; }
};

/// `printer` may be nullptr; `filament` is the diameter of the filament.
PlannedPrint planned_print(const Toolpath& path, const PrinterChoice* printer, Length filament);

}  // namespace kerf

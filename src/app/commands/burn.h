// kerf simulate --show burn: the burn of a laser, as figures and as a picture from above.
#pragma once

#include <vector>

#include "app/options/parser.h"
#include "app/report/status.h"

#include "kerf/job/outputs.h"
#include "kerf/job/program.h"
#include "kerf/sim/burn.h"

namespace kerf::app {

struct BurnCommand {
  double beam = 0.1;      // mm
  double power = 5.0;     // W
  double max_s = 1000.0;  // S of full power
  double black = 0.0;     // J/mm2; 0: by the map
  std::vector<Option> options;
};

/// Adds --spot, --max-power, --max-s and --black.
void add_burn_options(CommandParser& parser, BurnCommand& burn);
/// Maps the burn of a program, writes it into `files`, all of which must be pictures, and prints it.
Status run_burn(Console& console, const BurnCommand& burn, const Program& program,
                const std::vector<PartFile>& files, const View& view, TerminalProgress& progress,
                Diagnostics& diagnostics);

}  // namespace kerf::app

// Findings: the hazards of a job in one form: those of the toolpath, of the material, of fixtures and of a
// print.
//
//   std::vector<Finding> findings = check_job(job, {}, diagnostics);
//   for (const Finding& f : findings) use(f.kind, f.origin, f.message);
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/check.h"
#include "kerf/sim/print.h"
#include "kerf/sim/simulate.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/tool/material.h"
#include "kerf/tool/tool.h"

namespace kerf {

struct Job;
struct PrinterChoice;

struct Finding {
  std::string kind;          // "rapid_in_stock", "no_feed" ...
  std::size_t step = 0;      // index in the toolpath
  std::size_t steps = 1;     // number of motions: this one and those that follow it
  Point3 at;                 // mm
  double depth_mm = 0.0;     // 0 for hazards of the toolpath
  double removed_mm3 = 0.0;  // 0 for hazards of the toolpath
  Origin origin;
  std::string message;
  std::vector<Origin> callers;  // the calls that led to the origin, innermost first
  std::string hint;             // may be empty
  std::string about = {};       // the fixture; findings with different ones are not grouped
};

std::vector<Finding> findings_of(const std::vector<PathHazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<Hazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<PrintHazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<FixtureContact>& contacts,
                                 const std::vector<Fixture>& fixtures, const Toolpath& path);
/// Both lists in the order of steps. A "spindle_off" of the path replaces that of the material.
std::vector<Finding> merged(std::vector<Finding> of_path, std::vector<Finding> of_material);
/// Adjacent steps with the same kind and subject as one finding, with the message of the deepest contact.
std::vector<Finding> grouped(const std::vector<Finding>& findings);

/// Replaces cuts deeper than a flute of assumed length by one warning per tool. Contacts of a shank or neck
/// above such a flute stay, with a hint.
void warn_assumed_flutes(std::vector<Finding>& findings, const Toolpath& path, const ToolTable& tools,
                         Diagnostics& diagnostics);
/// "3 diameters" or "usual for its size": the basis of an assumed flute length.
std::string_view reason_of_flute(const Tool& tool);

struct JobCheckOptions {
  Length resolution = {};  // of the material; 0: coarse, by the stock's size
  unsigned threads = 0;    // 0: all
  const Machine* machine = nullptr;
  const Material* material = nullptr;       // of the stock, for the chip load
  const PrinterChoice* printer = nullptr;   // of a print: its bed, flow and filament
  std::optional<Length> layer_height = {};  // of a print; nothing: by the program
};
/// All hazards of a job, in the order of steps: those of the toolpath, of the material or print and of the
/// fixtures, assumed tools, and skipped codes that may be motions. `diagnostics` are those of reading the
/// program: warnings that are also findings are removed from it, and warnings of skipped checks are added. If
/// it has errors, only the toolpath is checked.
std::vector<Finding> check_job(const Job& job, const JobCheckOptions& options, Diagnostics& diagnostics,
                               Progress* progress = nullptr);

/// The codes of the program that were left out and may move the machine, which `diagnostics` report: these
/// warnings are removed from it.
std::vector<Finding> left_out_codes(Diagnostics& diagnostics, const Toolpath& path);

/// What a printer cannot do of a print, without simulating it: extruding while it is cold, motions outside of
/// its space, more flow than its hot end melts. `printer` may be null: what every printer cannot do.
std::vector<Finding> printer_findings(const Toolpath& path, const PrinterChoice* printer);

}  // namespace kerf

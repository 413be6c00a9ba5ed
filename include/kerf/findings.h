// Findings: the hazards of a job in one form, whether they are the toolpath's own or were met in the
// material, at a fixture or in a print.
//
//   std::vector<Finding> findings = check_job(job, {}, diagnostics);
//   for (const Finding& f : findings) use(f.kind, f.origin, f.message);
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/check.h"
#include "kerf/diagnostics.h"
#include "kerf/fixtures.h"
#include "kerf/hazard.h"
#include "kerf/material.h"
#include "kerf/print.h"
#include "kerf/progress.h"
#include "kerf/tool.h"

namespace kerf {

struct Job;

struct Finding {
  std::string kind;          // "rapid_in_stock", "no_feed" ...
  std::size_t step = 0;      // index in the toolpath
  std::size_t steps = 1;     // moves concerned, this one and following ones
  Point3 at;                 // mm
  double depth_mm = 0.0;     // 0 for the toolpath's own
  double removed_mm3 = 0.0;  // 0 for the toolpath's own
  Origin origin;
  std::string message;
  std::vector<Origin> callers;  // the calls that led to the origin, innermost first
  std::string hint;             // may be empty
  std::string about = {};       // what else must be equal for two findings to be one line: the fixture
};

std::vector<Finding> findings_of(const std::vector<PathHazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<Hazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<PrintHazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<FixtureContact>& contacts,
                                 const std::vector<Fixture>& fixtures, const Toolpath& path);
/// Both lists in the order of steps. The path's own "spindle_off" covers that of the material.
std::vector<Finding> merged(std::vector<Finding> of_path, std::vector<Finding> of_material);
/// Adjacent steps with the same kind and subject as one finding, with the message of the deepest contact.
std::vector<Finding> grouped(const std::vector<Finding>& findings);

/// Removes cuts deeper than a flute whose length is assumed, and warns of them instead, once for each tool.
/// Contacts of a shank or neck above such a flute stay, with a hint.
void warn_assumed_flutes(std::vector<Finding>& findings, const Toolpath& path, const ToolTable& tools,
                         Diagnostics& diagnostics);
/// "3 diameters" or "usual for its size": where an assumed flute's length comes from.
std::string_view reason_of_flute(const Tool& tool);

struct JobCheckOptions {
  Length resolution = {};  // of the material; 0: coarse, by the stock's size
  unsigned threads = 0;    // 0: all
  const Machine* machine = nullptr;
  const Material* material = nullptr;  // of the stock, for the chip load
};
/// All hazards of a job, in the order of steps: those of the toolpath, those met in the material and at the
/// fixtures, tools of unknown shape, and codes that may be motions but were skipped. `diagnostics` holds what
/// reading the program has reported; warnings that are hazards as well are removed from it, and what could
/// not be checked is added. With errors in it only the toolpath itself is checked.
std::vector<Finding> check_job(const Job& job, const JobCheckOptions& options, Diagnostics& diagnostics,
                               Progress* progress = nullptr);

}  // namespace kerf

// Hazards of both kinds (the toolpath's own, and those met in the material) in one form, as text and as JSON.
#pragma once

#include <string>
#include <vector>

#include "app/report/console.h"
#include "app/report/json.h"

#include "kerf/check.h"
#include "kerf/simulate.h"
#include "kerf/tool.h"

namespace kerf::app {

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
  std::string about = {};       // what else must be the same for two findings to be one line: the fixture
};

std::vector<Finding> findings_of(const std::vector<PathHazard>& hazards, const Toolpath& path);
std::vector<Finding> findings_of(const std::vector<Hazard>& hazards, const Toolpath& path);
/// Both lists in the order of steps. The path's own "spindle_off" covers that of the material.
std::vector<Finding> merged(std::vector<Finding> of_path, std::vector<Finding> of_material);

/// Takes out cuts deeper than a flute whose length nobody told, and warns of them instead, once a tool. What
/// meets a shank or neck that stands above such a flute stays a hazard, with a hint.
void tell_assumed_flutes(std::vector<Finding>& findings, const Toolpath& path, const ToolTable& tools,
                         Diagnostics& diagnostics);
/// "3 diameters" or "usual for its size": where an assumed flute's length comes from.
std::string_view reason_of_flute(const Tool& tool);

Json json_of(const Finding& finding);
Json json_of(const std::vector<Finding>& findings);

/// How many there are, as text: "none", "3", "2 in 57 moves". Counts the lines that show() makes.
std::string count_text(const std::vector<Finding>& findings);
/// One line a hazard, neighbouring moves with the same hazard as one, to stdout.
void show(Console& console, const std::vector<Finding>& findings);

}  // namespace kerf::app

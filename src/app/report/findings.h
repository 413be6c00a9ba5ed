// Hazards as text.
#pragma once

#include <string>
#include <vector>

#include "app/report/console.h"

#include "kerf/job/findings.h"

namespace kerf::app {

/// Their number as text: "none", "3", "2 in 57 motions". Counts the lines that show() prints.
std::string count_text(const std::vector<Finding>& findings);
/// One line per hazard to stdout; adjacent motions with the same hazard are one line.
void show(Console& console, const std::vector<Finding>& findings);

}  // namespace kerf::app

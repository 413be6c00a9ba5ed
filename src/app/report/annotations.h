// Findings and diagnostics in the forms of other tools: compilers' lines for editors, GitHub's commands,
// SARIF.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "job/record/value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/job/findings.h"

namespace kerf::app {

/// One hazard or message. A hazard counts as an error.
struct Annotation {
  Severity severity = Severity::error;
  std::string file;
  std::uint32_t line = 0, column = 0;  // 0: the whole file, the whole line
  std::string rule;                    // "rapid_in_stock", "no_number"
  std::string text;
};
/// `file`: of what has no location.
std::vector<Annotation> annotations_of(const std::vector<Finding>& findings, const Diagnostics& diagnostics,
                                       const std::string& file);

/// "part.nc:3:7: error: rapid through the stock [rapid_in_stock]"
std::string gcc_line(const Annotation& annotation);
/// "::error file=part.nc,line=3,col=7,title=rapid_in_stock::rapid through the stock"
std::string github_line(const Annotation& annotation);
/// A SARIF 2.1.0 log of one run.
Record sarif_log(const std::vector<Annotation>& annotations);

}  // namespace kerf::app

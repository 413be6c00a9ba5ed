// From a path to steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "front/pathdxf/compile/emitter.h"
#include "front/pathdxf/model/path.h"
#include "front/pathdxf/text/report.h"

#include "kerf/base/progress.h"

namespace kerf::pathdxf {

struct Compiled {
  Toolpath milling;
  std::optional<Toolpath> probing;  // where the path or an embedded one has probes
  std::vector<PlacedProbe> probes;  // in the order of the probing run
  Statistics statistics;
  double top = 0.0;       // mm, the highest T, with H, of the paths that cut
  bool is_empty = false;  // no operations: nothing was compiled
};

/// Compiles a path and those embedded in it. Operations that lack a depth or infeed are reported and left
/// out.
Compiled compile(const Path& path, const PathdxfOptions& options, Report& report, Progress* progress);

/// The statistics as lines of text.
std::vector<std::string> statistics_lines(const Statistics& statistics, const Report& report);

}  // namespace kerf::pathdxf

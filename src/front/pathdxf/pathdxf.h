// Path drawings: DXF drawings of milling paths as toolpaths (docs/manual/pathdxf.md), as PathDxf2GCode by
// H. M. Müller understands them.
//
//   Diagnostics diagnostics;
//   PathdxfOptions options;
//   options.rapid_height = mm(15);
//   PathdxfRun run = compile_pathdxf("8001.1P.dxf", options, diagnostics);
//   const PathdxfProgram& program = run.programs.front();
//
// Coordinates are mm, X0 Y0 at the start marker, Z0 at the bottom of the material. A step's origin is the
// element of the drawing that caused it, its callers are the embeddings of the path that the element belongs
// to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "front/pathdxf/text/pathdxf_options.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// A point whose height is measured before milling.
struct PathdxfProbe {
  std::string name;   ///< "#51", the variable of the corrections
  std::string label;  ///< L
  Point2 at;          ///< work coordinates
  Point2 drawn;       ///< coordinates of its drawing
  Length height;      ///< that is expected
};

struct PathdxfProgram {
  std::string path;    ///< "8001.1P"
  std::string suffix;  ///< R: appended to the names of output files
  /// The steps. With probes, their Z have corrections (MotionExtra::z_correction).
  Toolpath milling;
  std::optional<Toolpath> probing;
  std::vector<PathdxfProbe> probes;  ///< in the order of the probing run
  Point2 start;                      ///< of the path, in its drawing: X0 Y0 of the steps
  Length tool_diameter;              ///< O
  Length thickness, rapid_height;    ///< T and S of the path itself
  std::string material;              ///< M
  Length top;             ///< the highest T, with H, of the paths that cut: this one and those embedded
  bool is_empty = false;  ///< the path has no element; there are no steps
  std::vector<std::string> statistics;
};

struct PathdxfRun {
  std::vector<PathdxfProgram> programs;  ///< one for the drawing's path; with check_all, one for each
  std::vector<std::string> files;        ///< all files read
};

/// Compiles a drawing. Without a program in the result, errors were reported. A program may come with errors
/// too: operations without depth or infeed are left out.
PathdxfRun compile_pathdxf(const std::string& file, const PathdxfOptions& options, Diagnostics& diagnostics,
                           Progress* progress = nullptr);

/// The list of probes into which measured values are written, one line each: "([1.000 2.000]/T=5.000) #51=".
/// Lines of the same text have the work position as well: "([1.000 2.000]/at [11.000 2.000]/T=5.000) #52=".
std::string pathdxf_probe_list(const PathdxfProgram& program);

/// A diagnostic as PathDxf2GCode prints it: "LINE @ [0.000 0.000] # 8001.1P[8001.1P.dxf]: B value missing".
std::string pathdxf_line(const Diagnostic& diagnostic);

}  // namespace kerf

// The programs of path drawings as files: what `kerf pathdxf` and `kerf adjustz` write.
//
//   const PathdxfRun run = compile_pathdxf("8001.1P.dxf", options, diagnostics);
//   for (const PathFile& file : path_files(run.programs.front(), "8001.1P.dxf", diagnostics))
//     ...  // "8001.1P" + file.ending
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/pathdxf.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/formats/measured.h"

namespace kerf {

/// Endings of the files of a program, after the drawing's name and the suffix of R.
namespace path_endings {
inline constexpr const char* kMilling = "_Milling.gcode";
inline constexpr const char* kProbing = "_Probing.gcode";
inline constexpr const char* kProbeList = "_Z.txt";
inline constexpr const char* kClean = "_Clean.gcode";
}  // namespace path_endings

struct PathFile {
  std::string ending;  ///< of its name, after that of the drawing: "_Milling.gcode"
  std::string text;
};
/// "_Milling.gcode"; of a program with probes "_Probing.gcode", "_Z.txt" and "_Clean.gcode". `drawing` is the
/// file's name, for the comments.
std::vector<PathFile> path_files(const PathdxfProgram& program, const std::string& drawing,
                                 Diagnostics& diagnostics);

/// The endings of files that only another run of a drawing than one that made `written` writes, and that
/// exist beside `base`: they belong to an earlier run.
std::vector<std::string> stale_path_files(const std::string& base, const PathdxfProgram& program,
                                          const std::vector<PathFile>& written);

/// The sheet for the workshop (back/pathdxf/path_sheet.h) of a drawing, as SVG. `run` may have no program;
/// elements that `diagnostics` names are marked.
std::string path_sheet_svg(const std::string& drawing, const PathdxfRun& run, const Diagnostics& diagnostics);

/// How the heights of a program are corrected.
struct AdjustOptions {
  Length max_correction = mm(1);  ///< larger deviations from the expected heights are errors
  std::string measured;           ///< file of measured positions; empty: the values are in "_Z.txt"
  MeasuredOptions reading = {};   ///< of that file; its language is that of the messages
  /// Takes the name of each file before it is read; may be empty.
  std::function<void(const std::string&)> report = {};
};
/// A program with its heights corrected: the text of "_Milling.gcode".
struct AdjustedProgram {
  std::string base;   ///< name of the files without what is appended to it
  std::string clean;  ///< text before the correction
  std::string text;
};
/// Reads "_Z.txt" and "_Clean.gcode" beside a drawing, or, where `name` is one of them, beside each other.
/// Nothing, with errors, if a file is missing or invalid, or a height is not measured.
std::optional<AdjustedProgram> adjust_path_program(const std::string& name, const AdjustOptions& options,
                                                   Diagnostics& diagnostics, Progress* progress = nullptr);

}  // namespace kerf

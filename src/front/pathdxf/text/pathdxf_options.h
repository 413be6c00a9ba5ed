// How path drawings are compiled: see pathdxf.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"
#include "kerf/program/path_drawing.h"

namespace kerf {

/// Of messages and of the statistics in the program's comments.
using PathdxfLanguage = Language;
/// Comments in the toolpath. `brief`: the path, its embeddings, texts of Q. `trace`: one for each operation
/// and the statistics, as PathDxf2GCode writes them.
enum class PathdxfComments : std::uint8_t { brief, trace };
/// Which paths of a drawing are compiled: the only one, or each, with example values for its variables (/c).
enum class PathdxfSelection : std::uint8_t { only_path, check_all };

/// Variables of the main path without a value: errors where they are used, or the first of the values that
/// their definitions permit, with a note.
enum class FreeVariables : std::uint8_t { error, example };

/// A drawing whose bytes are known already.
struct OpenedDrawing {
  std::string file;
  std::string_view bytes;
};

struct PathdxfOptions : PathDrawingOptions {
  PathdxfSelection selection = PathdxfSelection::only_path;
  FreeVariables free_variables = FreeVariables::error;
  std::optional<std::string> shown_texts;  ///< /x: reports the elements of texts that match this expression
  std::vector<std::string> folders;  ///< /d: searched for sub-paths after the referencing drawing's folder
  ProbeKind probe = ProbeKind::contact;
  PathdxfLanguage language = PathdxfLanguage::english;
  PathdxfComments comments = PathdxfComments::brief;
  std::size_t max_steps = limits::kMaxGeneratedSteps;  ///< of the toolpath, comments included
  /// Where drawings come from instead of the file system: the bytes of a file, and the names of the files in
  /// a folder. Both are given, or none.
  std::function<std::optional<std::string>(const std::string& file)> read_file;
  std::function<std::vector<std::string>(const std::string& folder)> list_files;
  std::optional<OpenedDrawing> opened;  ///< is not opened again
  /// Takes lines about files read, paths checked and shown texts; may be empty.
  std::function<void(std::string_view)> report;
};

inline constexpr Feed kDefaultPathdxfFeed =
    mm_per_min(150);  ///< the modal feed of the original's program header

}  // namespace kerf

// Writing programs for a controller (kerf/program/post.h) or as a drawing from above
// (kerf/drawing/toolpath_drawing.h), after optional passes over the toolpath (kerf/path/passes.h).
//
//   std::optional<PostTarget> target = find_post_target("grbl");
//   improve(program->path, {.fit_arcs = mm(0.005)});
//   std::vector<PostedFile> files = post_program(*program, *target, {}, diagnostics);
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/drawing/toolpath_drawing.h"
#include "kerf/formats/printer_files.h"
#include "kerf/job/program.h"
#include "kerf/path/machine.h"
#include "kerf/path/passes.h"
#include "kerf/program/post.h"
#include "kerf/tool/tool.h"

namespace kerf {

struct DrawingFormat {
  std::string_view name, title, file_ending;
};
const std::vector<DrawingFormat>& drawing_formats();
/// A language of machines that do not read G-code: OpenSBP, RML-1.
enum class NativeLanguage { opensbp, rml };
struct NativeFormat {
  std::string_view name, title, file_ending;
  NativeLanguage language;
  double step = 0.0;     // mm, of RML-1
  double fastest = 0.0;  // mm/s, of RML-1
};
const std::vector<NativeFormat>& native_formats();
/// Of .kerf files: "kerf".
const DrawingFormat& program_format();

/// Whether the format is a setup sheet, as a page (.html) or as one drawing (.svg).
bool is_setup_sheet(const DrawingFormat& format);

/// The target of a program: a controller, a drawing format, Kerf's own program file, or a machine's language.
struct PostTarget {
  std::optional<PostProfile> profile;
  const DrawingFormat* drawing = nullptr;  // instead of `profile`
  bool is_program = false;                 // instead of both: kerf/job/program_file.h
  const NativeFormat* native = nullptr;    // instead of all
  std::string name() const;
};
/// Whether programs for it can be written in this unit.
bool has_unit(const PostTarget& target, LengthUnit unit);
/// A drawing format, "kerf", a machine's language, or a built-in post by its name; nothing for other names.
std::optional<PostTarget> find_post_target(std::string_view name);
/// The target that the ending of an output alone determines: that of .kerf, a setup sheet for .html; nothing
/// for others.
std::optional<PostTarget> post_target_of_ending(const std::string& file);
/// The names that find_post_target accepts.
std::vector<std::string> post_target_names();
/// The user's post file; nothing, with an error, if it cannot be read.
std::optional<PostTarget> load_post_target(const std::string& file, Diagnostics& diagnostics);

/// The post of a printer: its firmware with its start and end. Nothing, with errors, if they are invalid.
std::optional<PostTarget> printer_post_target(const PrinterChoice& printer, Diagnostics& diagnostics);

/// "command", "pause", "files" or "ignore".
std::optional<ToolChangePolicy> tool_change_policy_named(std::string_view name);
/// "r2000" or "r12".
std::optional<DxfVersion> dxf_version_named(std::string_view name);

/// The passes to apply; 0 or false: none.
struct PassChoices {
  Length fit_arcs = {};  // tolerance of arcs that replace chains of chords
  Length join = {};      // tolerance of straight cuts that are joined
  bool shorten_rapids = false;
};
struct PassSaving {
  std::string name;  // "arcs", "join", "rapids"
  PassFigures before, after;
};
/// Applies the passes to a toolpath and returns the savings of each.
std::vector<PassSaving> improve(Toolpath& path, const PassChoices& passes);

/// The size of a picture of the print in its program, pixels.
struct ThumbnailSize {
  int width = 0, height = 0;
};
inline constexpr int kMaxThumbnailSide = 1000;  // pixels
/// "220x124"; nothing for other texts and for sides outside of 1 to kMaxThumbnailSide pixels.
std::optional<ThumbnailSize> thumbnail_size(std::string_view text);

struct PostingOptions {
  std::optional<LengthUnit> unit = {};  // nothing: the profile's; mm in a drawing
  std::optional<ToolChangePolicy> tool_change = {};
  LeftOutCodes left_out = LeftOutCodes::refused;
  Feed missing_feed = {};  // for cutting moves without one; 0: an error
  // By number: for comments, and sizes of drilled holes; none: used_tools() of job.h.
  std::map<int, Tool> tools = {};
  // For a comment in the header; nothing: start_tool() of job.h.
  std::optional<std::pair<int, Tool>> start_tool = {};
  RapidLines rapids = RapidLines::left_out;  // of a drawing
  DxfVersion dxf_version = DxfVersion::r2000;
  std::map<std::string, std::string> variables = {};  // of templates, before those of the post
  std::vector<ThumbnailSize> thumbnails = {};         // of a print; it is simulated for them
  std::optional<Machine> machine = {};                // of a setup sheet, for its times
};
/// The text of a program for a target, checked by its rules (lint_gcode). With an error in `diagnostics` it
/// must not be used. Empty if stopped.
std::vector<PostedFile> post_program(const Program& program, const PostTarget& target,
                                     const PostingOptions& options, Diagnostics& diagnostics,
                                     Progress* progress = nullptr);

/// The names of the files of post_program: "part.nc", or with one file per tool "part-T201.nc", and
/// "part-T201-2.nc" for the second use of a tool.
std::vector<std::string> posted_file_names(const std::string& name, const std::vector<PostedFile>& files);

}  // namespace kerf

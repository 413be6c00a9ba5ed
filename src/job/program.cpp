// Selects the front end of a file.
#include "kerf/job/program.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/ending.h"
#include "base/names.h"
#include "job/front_ends.h"
#include "job/heights.h"

#include "kerf/base/limits.h"
#include "kerf/program/gcode_options.h"

namespace kerf {
namespace {

constexpr std::size_t kFirstBytes = 4096;  // examined where the ending is unknown

const FrontEnd* by_ending(std::string_view ending) {
  for (const FrontEnd& f : front_ends())
    if (std::find(f.endings.begin(), f.endings.end(), ending) != f.endings.end()) return &f;
  return nullptr;
}

/// The front end of a file with an unknown ending, by its text, with a note.
const FrontEnd* by_text(const InputFile& file, Diagnostics& diagnostics) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  std::string_view text = file.bytes().substr(0, kFirstBytes);
  if (text.substr(0, kMark.size()) == kMark) text.remove_prefix(kMark.size());
  const FrontEnd& gcode = *by_ending(".nc");
  for (const FrontEnd& f : front_ends()) {
    if (!f.looks_like(text)) continue;
    if (f.read == gcode.read && find_foreign_language(text)) return &f;  // an error names the control
    diagnostics.note(codes::input_kind_guessed, TextLocation{file.path(), 0, 0},
                     fmt::format("unknown file ending; the text is read as {}", f.name));
    return &f;
  }
  if (find_foreign_language(text)) return &gcode;
  diagnostics
      .error(codes::input_kind_unknown, TextLocation{file.path(), 0, 0},
             "unrecognised file type, by file name extension and by content")
      .hint = "known endings: " + known_endings();
  return nullptr;
}

/// An error for each option of path drawings, on a program that is none.
void refuse_drawing_options(const FrontEnd& front_end, const PathDrawingOptions& options,
                            Diagnostics& diagnostics) {
  for (const std::string& name : options.given)
    diagnostics.error(codes::option_unused, CallLocation{"", 0, name},
                      fmt::format("the option is for path drawings; the program is {}", front_end.name));
}

}  // namespace

const std::vector<FrontEnd>& front_ends() {
  static const std::vector<FrontEnd> all{kerf_front_end(),  pathdxf_front_end(), cut_front_end(),
                                         gcode_front_end(), gcmc_front_end(),    scad_front_end()};
  return all;
}

std::string known_endings() {
  std::string text;
  for (const FrontEnd& f : front_ends()) {
    if (!text.empty()) text += ", ";
    text += joined(f.endings, " ") + " (" + std::string(f.name) + ")";
  }
  return text;
}

std::optional<Program> load_program(const std::string& path, const ProgramOptions& options,
                                    Diagnostics& diagnostics, Progress* progress) {
  if (progress != nullptr) progress->phase("reading");
  const std::optional<InputFile> file =
      InputFile::open(path, diagnostics, limits::kMaxProgramBytes, progress);
  if (!file) return std::nullopt;
  const FrontEnd* front_end = path == "-" ? by_ending(".nc") : by_ending(ending_of(path));
  if (front_end == nullptr) front_end = by_text(*file, diagnostics);
  if (front_end == nullptr) return std::nullopt;
  if (!front_end->reads_drawings) refuse_drawing_options(*front_end, options.drawing, diagnostics);
  Program program = front_end->read(*file, options, diagnostics, progress);
  program.source = file->path();
  if (program.front_end.empty()) program.front_end = front_end->name;  // a stored program keeps its own
  program.files.insert(program.files.begin(), file->path());
  if (!options.measured.file.empty() && !diagnostics.has_errors())
    apply_measured(program, options.measured, diagnostics);
  if (program.path.size() == 0 && !diagnostics.has_errors())
    diagnostics.error(codes::nothing_to_cut, TextLocation{program.source, 0, 0},
                      "the program is empty: it has no steps");
  return program;
}

}  // namespace kerf

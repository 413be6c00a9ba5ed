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

/// "a drawing", "a mesh" or "a picture", of which kerf cut makes a program; empty for other endings.
std::string_view kind_without_motions(std::string_view ending) {
  const auto is_one_of = [&](std::initializer_list<std::string_view> all) {
    return std::find(all.begin(), all.end(), ending) != all.end();
  };
  if (ending == ".svg") return "a drawing";
  if (is_one_of({".stl", ".3mf", ".obj", ".glb"})) return "a mesh";
  return is_one_of({".png", ".jpg", ".jpeg"}) ? "a picture" : "";
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
  const std::string_view kind = kind_without_motions(ending_of(file.path()));
  diagnostics
      .error(codes::input_kind_unknown, TextLocation{file.path(), 0, 0},
             kind.empty() ? std::string("unrecognised file type, by file name extension and by content")
                          : fmt::format("{} has no motions of a tool", kind))
      .hint = kind.empty()
                  ? "known endings: " + known_endings()
                  : "kerf cut makes a program of it, such as kerf cut FILE --op contour --tool \"square "
                    "d=3\" --depth 3 --feed 800";
  return nullptr;
}

/// An option that some front ends read, as a user writes it.
struct GivenOption {
  std::string name;
  OptionGroup group;
  std::string_view programs;  // that it is for
};

std::vector<GivenOption> options_given(const ProgramOptions& options) {
  std::vector<GivenOption> given;
  for (const std::string& name : options.drawing.given)
    given.push_back({name, OptionGroup::drawing, "path drawings"});
  const auto add = [&](bool is_given, const char* name, OptionGroup group, std::string_view programs) {
    if (is_given) given.push_back({name, group, programs});
  };
  add(!options.defines.empty(), "--define", OptionGroup::define,
      "gcmc and OpenSCAD programs and path drawings");
  add(!options.gcmc_version.empty(), "--compat", OptionGroup::gcmc, "gcmc programs");
  add(options.dialect.has_value(), "--dialect", OptionGroup::gcode, "G-code programs");
  add(options.arc_centres != ArcCentres::detect, "--arc-centres", OptionGroup::gcode, "G-code programs");
  add(!options.compensation_radii.empty(), "--comp", OptionGroup::gcode, "G-code programs");
  add(options.read_on, "--read-on", OptionGroup::gcode, "G-code programs");
  return given;
}

/// An error for each option that has no effect on programs of this kind: the user meant something by it.
void refuse_unused_options(const FrontEnd& front_end, const ProgramOptions& options,
                           Diagnostics& diagnostics) {
  for (const GivenOption& option : options_given(options)) {
    const auto& reads = front_end.reads;
    if (std::find(reads.begin(), reads.end(), option.group) != reads.end()) continue;
    diagnostics.error(
        codes::option_unused, CallLocation{"", 0, option.name},
        fmt::format("the option is for {}; the program is {}", option.programs, front_end.name));
  }
}

}  // namespace

const std::vector<FrontEnd>& front_ends() {
  static const std::vector<FrontEnd> all{kerf_front_end(),    pathdxf_front_end(), cut_front_end(),
                                         opensbp_front_end(), rml_front_end(),     gcode_front_end(),
                                         gcmc_front_end(),    scad_front_end()};
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
  return load_program(*file, options, diagnostics, progress);
}

std::optional<Program> load_program(const InputFile& file, const ProgramOptions& options,
                                    Diagnostics& diagnostics, Progress* progress) {
  const std::string& path = file.path();
  const FrontEnd* front_end = path == "-" ? by_ending(".nc") : by_ending(ending_of(path));
  if (front_end == nullptr) front_end = by_text(file, diagnostics);
  if (front_end == nullptr) return std::nullopt;
  refuse_unused_options(*front_end, options, diagnostics);
  Program program = front_end->read(file, options, diagnostics, progress);
  program.source = path;
  if (program.front_end.empty()) program.front_end = front_end->name;  // a stored program keeps its own
  program.files.insert(program.files.begin(), path);
  if (!options.measured.file.empty() && !diagnostics.has_errors())
    apply_measured(program, options.measured, diagnostics);
  if (program.path.size() == 0 && !diagnostics.has_errors() && !stop_requested(progress))
    diagnostics.error(codes::nothing_to_cut, TextLocation{program.source, 0, 0},
                      "the program is empty: it has no steps");
  return program;
}

}  // namespace kerf

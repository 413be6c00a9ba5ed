// The front end for G-code.
#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/codes/gcode.h"
#include "base/file_names.h"
#include "base/number.h"
#include "job/front_ends.h"
#include "path/assumed_tool.h"

#include "kerf/base/limits.h"
#include "kerf/program/gcode.h"

namespace kerf {
namespace {

constexpr double kSmallestDiameter = 0.1;  // mm, assumed for cutter compensation

/// Text in which a line starts with a word such as G0, M3, T1, N10 or X5, or with % or a comment and then
/// such a line.
bool looks_like_gcode(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return false;
  constexpr std::string_view kLetters = "GMTNXYZFSO";
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.size() < 2) continue;
    const auto letter = static_cast<char>(std::toupper(static_cast<unsigned char>(line[0])));
    const bool number =
        std::isdigit(static_cast<unsigned char>(line[1])) != 0 || line[1] == '-' || line[1] == '.';
    if (kLetters.find(letter) != std::string_view::npos && number) return true;
    if (letter != '(' && letter != ';' && letter != '%') return false;
  }
  return false;
}

/// The text of a subroutine's file in the folder of the program or in one of `folders`; nothing if there is
/// none.
std::optional<std::string> find_subroutine(const std::string& program, const std::string& name,
                                           const std::vector<std::string>& folders,
                                           std::vector<std::string>& files) {
  constexpr std::size_t kLargestSub = std::size_t{64} << 20;
  Diagnostics ignored;  // the call itself is reported
  auto file = InputFile::open(folder_of(program) + name, ignored, kLargestSub);
  for (std::size_t i = 0; !file && i < folders.size(); ++i)
    file = InputFile::open(folders[i] + "/" + name, ignored, kLargestSub);
  if (!file) return std::nullopt;
  if (std::find(files.begin(), files.end(), file->path()) == files.end()) files.push_back(file->path());
  return std::string(file->bytes());
}

bool has_compensation_error(const Diagnostics& diagnostics) {
  const auto& list = diagnostics.list();
  return std::any_of(list.begin(), list.end(), [](const Diagnostic& d) {
    return d.severity == Severity::error &&
           (d.code == codes::compensation_entry || d.code == codes::compensation_gouge);
  });
}

/// Reads with the largest of the diameters to assume that fits into the corners of the program.
GcodeProgram read_assuming(std::string_view text, GcodeReadOptions& options, Diagnostics& diagnostics,
                           Progress* progress) {
  const Diagnostics before = diagnostics;
  for (const double diameter : {kUsualDiameter.mm(), 1.0}) {
    options.assumed_diameter = diameter;
    GcodeProgram read = read_gcode(text, options, diagnostics, progress);
    if (!read.assumed_diameter || !has_compensation_error(diagnostics) || stop_requested(progress))
      return read;
    diagnostics = before;
  }
  options.assumed_diameter = kSmallestDiameter;
  return read_gcode(text, options, diagnostics, progress);
}

/// The board below the stock that Kerf states in the header of a file: "(spoilboard: 3.00mm)"; 0: none.
Length spoilboard_of(std::string_view text) {
  constexpr std::string_view kBefore = "spoilboard: ", kAfter = "mm";
  constexpr std::size_t kHeader = 4096;  // bytes
  text = text.substr(0, kHeader);
  const std::size_t at = text.find(kBefore);
  if (at == std::string_view::npos) return {};
  const std::size_t line = text.rfind('\n', at) + 1;  // npos + 1 is 0
  if (text.substr(line, at - line).find_first_not_of("(; ") != std::string_view::npos) return {};
  text.remove_prefix(at + kBefore.size());
  const auto thickness = parse_number(text.substr(0, text.find(kAfter)));
  const bool valid = thickness && *thickness >= 0.0 && *thickness <= limits::kThickestSpoilboard;
  return valid ? mm(*thickness) : Length();
}

Program read(const InputFile& file, const ProgramOptions& input, Diagnostics& diagnostics,
             Progress* progress) {
  Program program;
  GcodeReadOptions options;
  const bool streamed = input.machine && input.machine->controller == Controller::grbl;
  if (input.read_on || streamed) options.after_end = AfterEnd::read_on;
  options.dialect = input.dialect;
  if (!input.dialect && streamed && input.machine->laser == LaserDrive::follows)
    options.dialect = GcodeDialect::laser;
  options.strict = input.strict;
  options.arc_centres = input.arc_centres;
  options.compensation_radii = input.compensation_radii;
  options.filament_diameter = input.filament_diameter;
  const GcodeDialect dialect = options.dialect.value_or(guess_dialect(file.bytes()).dialect);
  if (dialect == GcodeDialect::rs274) program.tools_beside = tool_table_beside(file, diagnostics);
  options.tool_diameter = [&](int number, const Tool* described) -> std::optional<double> {
    const auto given = input.tool_diameter ? input.tool_diameter(number, described) : std::nullopt;
    const Tool* beside = program.tools_beside.find(number);
    return given || beside == nullptr ? given : beside->diameter.mm();
  };
  options.file_name = file.path();
  options.read_file = [&](const std::string& name) {
    return find_subroutine(file.path(), name, input.include_paths, program.files);
  };
  GcodeProgram read = input.unknown_diameter == UnknownDiameter::assume
                          ? read_assuming(file.bytes(), options, diagnostics, progress)
                          : read_gcode(file.bytes(), options, diagnostics, progress);
  program.path = std::move(read.path);
  program.units = read.inch ? ProgramUnits::inch : ProgramUnits::mm;
  program.tools = std::move(read.tools);
  program.stock = read.stock;
  program.spoilboard = spoilboard_of(file.bytes());
  program.states_tool_lengths = true;
  program.units_given = read.units_given;
  const bool printer = is_printer(read.dialect);
  if (printer) program.filament_diameter = read.filament_diameter;
  program.filament_density = read.filament_density;
  const bool needs_end = !printer && !read.cut_short;
  program.end = !needs_end ? ProgramEnd::not_asked : read.ended ? ProgramEnd::seen : ProgramEnd::missing;
  if (read.assumed_diameter) program.assumed_diameter = options.assumed_diameter;
  return program;
}

}  // namespace

FrontEnd gcode_front_end() {
  return {"G-code",
          {".nc", ".ngc", ".gcode", ".tap", ".gc", ".cnc", ".txt"},
          looks_like_gcode,
          read,
          {OptionGroup::gcode}};
}

}  // namespace kerf

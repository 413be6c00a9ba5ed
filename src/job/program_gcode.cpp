// G-code as a way in.
#include <cctype>
#include <optional>
#include <string>
#include <utility>

#include "kerf/gcode.h"
#include "kerf/program.h"

namespace kerf {
namespace {

/// Text in which a line begins with a word such as G0, M3, T1, N10 or X5, or with % or a comment and then
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

/// Text of a subroutine's file beside the program; nothing where there is none.
std::optional<std::string> read_beside(const std::string& program, const std::string& name) {
  constexpr std::size_t kLargestSub = std::size_t{64} << 20;
  Diagnostics unheard;  // the call itself is reported
  const auto file = InputFile::open(folder_of(program) + name, unheard, kLargestSub);
  if (!file) return std::nullopt;
  return std::string(file->bytes());
}

LoadedProgram read(const InputFile& file, const InputOptions& input, Diagnostics& diagnostics,
                   Progress* progress) {
  GcodeReadOptions options;
  const bool streamed = input.machine && input.machine->controller == Controller::grbl;
  if (input.read_on || streamed) options.after_end = AfterEnd::read_on;
  options.dialect = input.dialect;
  options.strict = input.strict;
  options.filament_diameter = input.filament_diameter;
  options.tool_diameter = input.tool_diameter;
  options.file_name = file.path();
  options.read_file = [&file](const std::string& name) { return read_beside(file.path(), name); };
  GcodeProgram program = read_gcode(file.bytes(), options, diagnostics, progress);
  LoadedProgram loaded;
  loaded.path = std::move(program.path);
  loaded.units = program.inch ? InputUnits::inch : InputUnits::mm;
  loaded.tools = std::move(program.tools);
  loaded.stock = program.stock;
  loaded.end = program.cut_short ? ProgramEnd::not_asked
               : program.ended   ? ProgramEnd::seen
                                 : ProgramEnd::missing;
  return loaded;
}

}  // namespace

FrontEnd gcode_front_end() {
  return {"G-code", {".nc", ".ngc", ".gcode", ".tap", ".gc", ".cnc", ".txt"}, looks_like_gcode, read};
}

}  // namespace kerf

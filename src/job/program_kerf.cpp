// The front end for Kerf's own program files.
#include "job/front_ends.h"

#include "kerf/job/program_file.h"

namespace kerf {
namespace {

Program read(const InputFile& file, const ProgramOptions& input, Diagnostics& diagnostics, Progress*) {
  std::optional<Program> program = read_program(file.bytes(), file.path(), diagnostics);
  if (!program) return {};
  if (input.filament_diameter && program->filament_diameter)
    program->filament_diameter = input.filament_diameter;
  return std::move(*program);
}

}  // namespace

FrontEnd kerf_front_end() { return {"Kerf program", {".kerf"}, is_program_file, read}; }

}  // namespace kerf

// The front ends for the languages of machines that do not read G-code.
#include "front/native/native_program.h"
#include "job/front_ends.h"
#include "job/program_comments.h"

namespace kerf {
namespace {

Program program_of(NativeProgram read, Diagnostics& diagnostics) {
  Program program;
  program.path = std::move(read.path);
  program.units = read.inch ? ProgramUnits::inch : ProgramUnits::mm;
  program.units_given = read.units_given;
  program.end = read.ended ? ProgramEnd::seen : ProgramEnd::missing;
  read_comments(program, diagnostics);
  return program;
}

Program read_shopbot(const InputFile& file, const ProgramOptions&, Diagnostics& diagnostics, Progress*) {
  return program_of(read_opensbp(file.bytes(), file.path(), diagnostics), diagnostics);
}

Program read_roland(const InputFile& file, const ProgramOptions&, Diagnostics& diagnostics, Progress*) {
  return program_of(read_rml(file.bytes(), file.path(), diagnostics), diagnostics);
}

}  // namespace

FrontEnd opensbp_front_end() { return {"ShopBot OpenSBP", {".sbp"}, looks_like_opensbp, read_shopbot}; }
FrontEnd rml_front_end() { return {"Roland RML-1", {".rml"}, looks_like_rml, read_roland}; }

}  // namespace kerf

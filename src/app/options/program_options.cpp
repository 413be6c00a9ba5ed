// The reading options of a program.
#include "app/options/program_options.h"

#include <fmt/format.h>

#include "app/options/adjustz_options.h"
#include "app/options/common.h"
#include "app/options/pathdxf_options.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "front/gcmc/gcmc.h"

#include "kerf/base/limits.h"

namespace kerf::app {
void add_reading_options(CommandParser& parser, ReadingOptions& options) {
  const auto known = [](const std::string& name) {
    if (dialect_named(name)) return std::string();
    return fmt::format("unknown controller \"{}\"; expected {}{}", name, joined(dialect_names(), ", "),
                       guess_at_end(name, dialect_names()));
  };
  parser
      .add_text("--dialect", options.dialect,
                "The controller of a G-code program (default: detected from its text): " +
                    joined(dialect_names(), ", "))
      .value_name("NAME")
      .check(known);
  parser.add_flag("--read-on", options.read_on,
                  "Read a G-code file to its end, including text after M2 and M30, as senders do");
  add_length(parser, "--filament", options.filament, limits::kThinnestFilament, limits::kThickestFilament,
             "Diameter of a printer's filament, mm (default: from comments, else 1.75)");
  parser.add_flag("--strict", options.strict, "Report suspicious G-code as errors instead of warnings");
  add_repeated(
      parser, "-D,--define", options.defines, "STMT",
      "A statement to run before a gcmc program, such as depth=5mm, or a variable of a path drawing: A=2");
  parser
      .add_text("--compat", options.gcmc_version,
                "The version of gcmc, 1.8 or 1.9, whose arcs and angles a gcmc program expects")
      .value_name("VERSION")
      .check([](const std::string& text) {
        return gcmc_version_named(text) ? std::string() : std::string("expected 1.8 or 1.9");
      });
  add_repeated(parser, "-I,--include", options.include_paths, "PATH",
               "A folder to search for files included by a gcmc program, or for sub-paths");
  parser
      .add_text("--measured", options.measured,
                "Measured heights for a path drawing: its _Z.txt, or a controller's log")
      .value_name("FILE");
  add_number(parser, "--max-correction", options.max_correction, 1e-3, 100, "MM",
             "Maximum deviation of measured from expected heights (default: 1)");
  add_work_offset(parser, options.work_offset);
  add_drawing_options(parser, options.drawing);
}

void add_work_offset(CommandParser& parser, std::string& offset) {
  parser
      .add_text("--work-offset", offset,
                "The work zero in machine coordinates, for measured heights of a log without it")
      .value_name("X,Y,Z")
      .check([](const std::string& text) {
        return parse_offset(text) ? std::string() : std::string("expected three numbers: X,Y,Z");
      });
}

MeasuredOptions measured_options(const std::string& work_offset) {
  MeasuredOptions out;
  if (!work_offset.empty()) out.work_offset = parse_offset(work_offset);
  return out;
}

ProgramOptions read_reading_options(const ReadingOptions& options) {
  ProgramOptions out;
  out.dialect = dialect_named(options.dialect);
  out.read_on = options.read_on;
  out.strict = options.strict;
  if (options.filament > 0.0) out.filament_diameter = options.filament;
  out.defines = options.defines;
  out.include_paths = options.include_paths;
  out.gcmc_version = options.gcmc_version;
  out.drawing = options.drawing;
  out.measured = {options.measured, mm(options.max_correction), measured_options(options.work_offset)};
  return out;
}

}  // namespace kerf::app

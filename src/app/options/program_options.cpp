// The reading options of a program.
#include "app/options/program_options.h"

#include <fmt/format.h>

#include "app/options/common.h"

#include "kerf/names.h"
#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr double kThinnestFilament = 0.1, kThickestFilament = 20.0;  // mm

}  // namespace

void add_reading_options(CommandParser& parser, ReadingOptions& options) {
  const auto known = [](const std::string& name) {
    if (dialect_named(name)) return std::string();
    const auto meant = did_you_mean(name, dialect_names());
    return fmt::format("unknown controller \"{}\"; {}expected {}", name,
                       meant ? fmt::format("did you mean {}? ", *meant) : "", joined(dialect_names(), ", "));
  };
  parser
      .add_text("--dialect", options.dialect,
                "The controller of a G-code program (default: detected from its text): " +
                    joined(dialect_names(), ", "))
      .value_name("NAME")
      .check(known);
  parser.add_flag("--read-on", options.read_on,
                  "Read a G-code file to its end, including text after M2 and M30, as senders do");
  add_length(parser, "--filament", options.filament, kThinnestFilament, kThickestFilament,
             "Diameter of a printer's filament, mm (default: from comments, else 1.75)");
  parser.add_flag("--strict", options.strict, "Report suspicious G-code as errors instead of warnings");
  add_repeated(parser, "-D,--define", options.defines, "STMT",
               "A statement to run before a gcmc program, such as depth=5mm");
  add_repeated(parser, "-I,--include", options.include_paths, "PATH",
               "A folder to search for files included by a gcmc program");
}

ProgramOptions read_reading_options(const ReadingOptions& options) {
  ProgramOptions out;
  out.dialect = dialect_named(options.dialect);
  out.read_on = options.read_on;
  out.strict = options.strict;
  if (options.filament > 0.0) out.filament_diameter = options.filament;
  out.defines = options.defines;
  out.include_paths = options.include_paths;
  return out;
}

}  // namespace kerf::app

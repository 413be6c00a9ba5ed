// The options of reading a program.
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
    return fmt::format("\"{}\" is no controller that is known; {}expected {}", name,
                       meant ? fmt::format("did you mean {}? ", *meant) : "", joined(dialect_names(), ", "));
  };
  parser
      .add_text("--dialect", options.dialect,
                "The controller a G-code program is for (default: told by its text): " +
                    joined(dialect_names(), ", "))
      .value_name("NAME")
      .check(known);
  parser.add_flag("--read-on", options.read_on,
                  "Read a G-code file to its end, the programs behind M2 and M30 too, as senders do");
  add_length(parser, "--filament", options.filament, kThinnestFilament, kThickestFilament,
             "Diameter of a printer's filament, mm (default: told by the program, else 1.75)");
  parser.add_flag("--strict", options.strict, "Take what is unusual in a G-code program as an error");
  add_repeated(parser, "-D,--define", options.defines, "STMT",
               "A statement that a gcmc program runs first, such as depth=5mm");
  add_repeated(parser, "-I,--include", options.include_paths, "PATH",
               "A folder to search for the files that a gcmc program includes");
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

// The reading options of a program.
#include "app/options/program_options.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "app/options/adjustz_options.h"
#include "app/options/common.h"
#include "app/options/pathdxf_options.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "front/gcmc/gcmc.h"

#include "kerf/base/limits.h"

namespace kerf::app {
namespace {

constexpr double kLargestOffset = 1000.0;  // mm, of cutter compensation
constexpr double kLargestNumber = 1e6;     // of its D

/// "D1=0", "1=0.1in": the offset of G41 and G42 with this D. The error, empty if there is none.
std::string read_compensation(const std::string& text, std::map<int, double>& radii) {
  const std::size_t sign = std::min(text.find('='), text.size());
  std::string_view number = std::string_view(text).substr(0, sign);
  if (!number.empty() && (number[0] == 'D' || number[0] == 'd')) number.remove_prefix(1);
  const double none = -1.0, which = parse_number(number).value_or(none);
  const std::string_view value = std::string_view(text).substr(std::min(sign + 1, text.size()));
  const double radius = parse_length(value, 1.0).value_or(2.0 * kLargestOffset);
  const bool is_whole = which == std::floor(which) && which >= 1.0 && which <= kLargestNumber;
  if (!is_whole || !(std::abs(radius) <= kLargestOffset))
    return fmt::format("expected D, its number and the offset in mm: D1=0, not \"{}\"", text);
  radii[static_cast<int>(which)] = radius;
  return {};
}

void add_compensation(CommandParser& parser, std::vector<std::string>& offsets) {
  add_repeated(
      parser, "--comp", offsets, "D1=MM",
      "By how much G41 and G42 with D1 offset the path, instead of the tool's radius: D1=0 for a program "
      "that is compensated already (wear)")
      .check([](const std::string& text) {
        std::map<int, double> radii;
        return read_compensation(text, radii);
      });
}

}  // namespace

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
  parser
      .add_text(
          "--arc-centres", options.arc_centres,
          "What I J K of arcs are where G-code does not say so (G90.1, G91.1): offsets from the start, or "
          "absolute coordinates (default: offsets, unless no arc fits so and all fit absolutely)")
      .one_of({"offsets", "absolute"});
  add_compensation(parser, options.compensation);
  parser.add_flag("--read-on", options.read_on,
                  "Read a G-code file to its end, including text after M2 and M30, as senders do");
  add_length(parser, "--filament", options.filament, limits::kThinnestFilament, limits::kThickestFilament,
             "Diameter of a printer's filament, mm (default: from comments, else 1.75)");
  parser.add_flag("--strict", options.strict, "Report suspicious G-code as errors instead of warnings");
  add_repeated(parser, "-D,--define", options.defines, "STMT",
               "A statement to run before a gcmc program, such as depth=5mm, or a variable of an OpenSCAD "
               "program or a path drawing: A=2");
  parser
      .add_text("--compat", options.gcmc_version,
                "The version of gcmc, 1.8 or 1.9, whose arcs and angles a gcmc program expects")
      .value_name("VERSION")
      .check([](const std::string& text) {
        return gcmc_version_named(text) ? std::string() : std::string("expected 1.8 or 1.9");
      });
  add_repeated(
      parser, "-I,--include", options.include_paths, "PATH",
      "A folder to search for subroutines of G-code, for files included by a gcmc program, or for sub-paths");
  parser
      .add_text("--measured", options.measured,
                "Measured heights for a path drawing: its _Z.txt, or a controller's log")
      .value_name("FILE");
  add_length(parser, "--max-correction", options.max_correction, 1e-3, 100,
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
  out.arc_centres = arc_centres_named(options.arc_centres).value_or(ArcCentres::detect);
  for (const std::string& text : options.compensation) read_compensation(text, out.compensation_radii);
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

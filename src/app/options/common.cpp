// Options that several commands have.
#include "app/options/common.h"

#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/number.h"
#include "base/quantity.h"

#include "kerf/job/program.h"

namespace kerf::app {

CommandParser new_command(CommandParser& parent, const std::string& name, const std::string& summary,
                          const std::string& examples, OutputOptions& output) {
  CommandParser parser = parent.add_command(name, summary);
  parser.set_footer("\nExamples:\n" + examples);
  parser.add_flag("--json", output.json, "Print one JSON object (messages included) instead of text");
  parser.add_flag("-q,--quiet", output.quiet,
                  "Print warnings, errors and hazards only, no progress bar, notes or summary");
  return parser;
}

namespace {

/// An option with a number that `parse` reads; the error of an invalid value names `kind` and the range.
template <class Parse>
Option add_parsed(CommandParser& parser, const std::string& name, double& value, double low, double high,
                  const std::string& kind, const std::string& summary, Parse parse) {
  const auto read = [&value, low, high, kind, parse](const std::string& text) {
    const std::optional<double> number = parse(text);
    if (!number || *number < low || *number > high)
      return fmt::format("\"{}\" is not {} from {} to {}", text.substr(0, 40), kind, exact_text(low),
                         exact_text(high));
    value = *number;
    return std::string();
  };
  return parser.add_parsed(name, read, summary);
}

}  // namespace

Option add_number(CommandParser& parser, const std::string& name, double& value, double low, double high,
                  const std::string& unit, const std::string& summary) {
  return add_parsed(parser, name, value, low, high, "a number", summary, parse_number).value_name(unit);
}

Option add_length(CommandParser& parser, const std::string& name, double& mm, double low, double high,
                  const std::string& summary) {
  const auto parse = [](const std::string& text) { return parse_length(text, 1.0); };
  return add_parsed(parser, name, mm, low, high, "a length in mm, or with \"in\",", summary, parse)
      .value_name("MM");
}

Option add_feed(CommandParser& parser, const std::string& name, double& mm_per_min, double low, double high,
                const std::string& summary) {
  const auto parse = [](const std::string& text) {
    std::string fault;
    return read_quantity(text, "mm/min", {}, fault);
  };
  return add_parsed(parser, name, mm_per_min, low, high, "a feed in mm/min, or with \"ipm\",", summary, parse)
      .value_name("MM/MIN");
}

Option add_threads(CommandParser& parser, double& threads) {
  constexpr double kMaxThreads = 1024;
  return add_number(parser, "--threads", threads, 0, kMaxThreads, "N",
                    "Number of threads (default: all); the result does not depend on it");
}

Option add_program(CommandParser& parser, std::string& file) {
  return parser
      .add_text("FILE", file, "The program: " + known_endings() + "; - reads G-code from standard input")
      .required()
      .value_name("");
}

/// Keeps standard output for an output named "-".
static std::function<std::string(const std::string&)> dash_noted(OutputOptions& output) {
  return [&output](const std::string& path) {
    output.sends_output = output.sends_output || path == "-";
    return std::string();
  };
}

Option add_output(CommandParser& parser, std::string& out, OutputOptions& output,
                  const std::string& summary) {
  const auto read = [&out, &output](const std::string& path) {
    output.sends_output = path == "-";
    out = output.sends_output ? "" : path;
    return std::string();
  };
  return parser.add_parsed("-o,--output", read, summary).value_name("PATH");
}

Option add_outputs(CommandParser& parser, std::vector<std::string>& out, OutputOptions& output,
                   const std::string& summary) {
  return add_repeated(parser, "-o,--output", out, "PATH", summary).check(dash_noted(output));
}

Option add_other_output(CommandParser& parser, const std::string& name, std::string& out,
                        OutputOptions& output, const std::string& summary) {
  return parser.add_text(name, out, summary + "; - is standard output")
      .value_name("PATH")
      .check(dash_noted(output));
}

Option add_programs(CommandParser& parser, std::vector<std::string>& files) {
  return parser
      .add_texts("FILE", files, "The programs: " + known_endings() + "; - reads G-code from standard input")
      .required();
}

Option add_repeated(CommandParser& parser, const std::string& name, std::vector<std::string>& values,
                    const std::string& kind, const std::string& summary) {
  return parser.add_repeated(name, values, summary).value_name(kind);
}

Option add_mesh_tolerance(CommandParser& parser, double& mm) {
  constexpr double kFinest = 0.0005, kCoarsest = 10.0;  // mm
  return add_length(
      parser, "--mesh-tolerance", mm, kFinest, kCoarsest,
      "Distance of the triangles of a mesh from the part's surfaces (default: 0.002, or by --resolution: "
      "0.033 at 0.4 mm); edges between cuts that lie closer than the columns may be farther off");
}

Option add_layer_height(CommandParser& parser, double& mm) {
  constexpr double kThinnest = 0.02, kThickest = 20.0;  // mm
  return add_length(parser, "--layer-height", mm, kThinnest, kThickest,
                    "Layer height of a print in mm (default: from comments, else the steps in Z)");
}

void warn_unused(const std::vector<Option>& options, const std::string& why, const std::string& hint,
                 Diagnostics& diagnostics) {
  for (const Option& option : options)
    if (option.is_given())
      diagnostics.warning(codes::option_unused, CallLocation{"", 0, option.name()}, why).hint = hint;
}

}  // namespace kerf::app

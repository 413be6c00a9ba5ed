// kerf tools import, kerf tools export: reads tools from files of other programs and writes tools for them.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "base/codes/files.h"
#include "formats/tool_libraries.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/base/units.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::vector<std::string> files;
  std::string target;
  std::string unit = "mm";
  double first = 1;
};

constexpr double kHighestNumber = 99'999'999;

double unit_mm(const Options& options) { return options.unit == "inch" ? kMmPerInch : 1.0; }

bool ends_with(const std::string& text, std::string_view ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// The tools in the format of the target's ending; a tool file for standard output.
std::string written(const ToolTable& table, const Options& options, Diagnostics& diagnostics) {
  if (ends_with(options.target, ".tbl")) return write_linuxcnc_table(table, unit_mm(options), diagnostics);
  return write_tool_file(table);
}

void print_text(Console& console, const std::string& text) {
  if (!console.json()) console.print_output(text);
}

Status show_result(Console& console, const ToolTable& table, const Options& options,
                   const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    Record numbers = Record::array();
    for (const auto& [number, tool] : table.tools()) numbers.push_back(number);
    const bool none = diagnostics.has_errors() || options.target.empty();
    const Record outputs = none ? Record(Record::array()) : Record(std::vector<std::string>{options.target});
    console.print_json(
        text_of(Record{{"tools", numbers}, {"outputs", outputs}, {"diagnostics", record_of(diagnostics)}},
                Layout::indented));
  } else if (!diagnostics.has_errors() && !options.target.empty()) {
    console.summary(fmt::format("{}: {} tools", options.target, table.tools().size()));
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

Status write(Console& console, const ToolTable& table, const Options& options, Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) {
    const std::string text = written(table, options, diagnostics);
    OutputSet outputs(options.files);
    if (options.target.empty())
      print_text(console, text);
    else if (outputs.write(options.target, text, diagnostics))
      outputs.commit(diagnostics);
  }
  return show_result(console, table, options, diagnostics);
}

/// Checks the options before any file is read; false, with an error, if they are wrong.
bool check_usage(const Options& options, Diagnostics& usage) {
  if (!options.target.empty() && !ends_with(options.target, ".toml") && !ends_with(options.target, ".tbl"))
    usage.error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
                "tools are written as .toml (Kerf's tool file) or .tbl (LinuxCNC's tool table)");
  for (const std::string& file : options.files)
    if (file == options.target)
      usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
  return !usage.has_errors();
}

Status run_import(Console& console, const Options& options) {
  Diagnostics diagnostics;
  if (!check_usage(options, diagnostics)) return fail(console, diagnostics, Status::wrong_usage);
  ToolTable table;
  ToolLibraryOptions how{unit_mm(options), static_cast<int>(options.first)};
  for (const std::string& name : options.files)
    if (const auto file = InputFile::open(name, diagnostics)) {
      how.read_bit = tool_bits_of(name);
      read_tool_library(file->bytes(), name, how, table, diagnostics);
    }
  return write(console, table, options, diagnostics);
}

Status run_export(Console& console, const Options& options) {
  Diagnostics diagnostics;
  if (!check_usage(options, diagnostics)) return fail(console, diagnostics, Status::wrong_usage);
  ToolTable table;
  for (const std::string& name : options.files)
    if (const auto file = InputFile::open(name, diagnostics))
      read_tool_file(file->bytes(), name, table, diagnostics);
  return write(console, options.files.empty() ? built_in_tools() : table, options, diagnostics);
}

void add_target(CommandParser& parser, Options& options) {
  add_output(parser, options.target, options.output,
             "The file to write: .toml or .tbl (default: -, a tool file to standard output)");
  parser.add_text("--unit", options.unit, "Unit of a tool.tbl: mm or inch")
      .one_of({"mm", "inch"})
      .value_name("UNIT");
}

const char* const kImportExamples = R"(  kerf tools import library.json -o tools.toml
  kerf tools import tool.tbl --unit inch -o tools.toml
  kerf simulate part.nc --tools tools.toml -o part.png

Reads LinuxCNC's tool.tbl, Carbide Create's CSV, Fusion's JSON and .tools, FreeCAD's .fctb and .fctl, and
CAMotics' JSON.
The format is detected from the content. Tools of unsupported shapes are skipped with a warning.
)";
const char* const kExportExamples = R"(  kerf tools export -o tool.tbl --unit inch
  kerf tools export --tools tools.toml -o tool.tbl
)";

}  // namespace

Command add_tools_import(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(tools, "import", "Convert the tool library of another program to a tool file",
                  kImportExamples, options->output);
  parser.add_texts("FILE", options->files, "Tool libraries").required().value_name("");
  add_target(parser, *options);
  add_number(parser, "--first", options->first, 0, kHighestNumber, "N",
             "Number for the first tool without one (default 1)");
  return {parser, &options->output, [options](Console& console) { return run_import(console, *options); }};
}

Command add_tools_export(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(tools, "export", "Write the built-in tools or tool files in the format of other programs",
                  kExportExamples, options->output);
  add_repeated(parser, "--tools", options->files, "PATH", "A tool file (TOML) instead of the built-in tools");
  add_target(parser, *options);
  return {parser, &options->output, [options](Console& console) { return run_export(console, *options); }};
}

}  // namespace kerf::app

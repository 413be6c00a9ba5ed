// kerf tools import, kerf tools export: reads tools from files of other programs and writes tools for them.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "base/codes/files.h"
#include "base/codes/tools.h"
#include "base/names.h"
#include "formats/tool_libraries.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/base/units.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::vector<std::string> files, more_files;
  std::string target;
  std::string unit = "mm";
  std::string form;  // of the export; empty: that of the target's ending
  double first = 1;
};

constexpr double kHighestNumber = 99'999'999;

double unit_mm(const Options& options) { return options.unit == "inch" ? kMmPerInch : 1.0; }

std::vector<std::string> form_names() {
  std::vector<std::string> names;
  for (const LibraryForm& form : library_forms()) names.emplace_back(form.name);
  return names;
}

bool ends_with(const std::string& text, std::string_view ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// The form of --to, else that of the target's ending, else a tool file; nullptr, with an error, if unknown.
const LibraryForm* form_of(const Options& options, Diagnostics& usage) {
  if (!options.form.empty()) return library_form_named(options.form);
  if (options.target.empty()) return library_form_named("kerf");
  if (const LibraryForm* form = library_form_of_ending(options.target)) return form;
  std::vector<std::string> endings;
  for (const LibraryForm& form : library_forms())
    for (const std::string_view ending : form.endings)
      if (std::find(endings.begin(), endings.end(), ending) == endings.end()) endings.emplace_back(ending);
  usage
      .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
             fmt::format("tools are written as {}", list_text(endings)))
      .hint = "--to names the form, whatever the ending: " + list_text(form_names());
  return nullptr;
}

Status show_result(Console& console, const WrittenLibrary& written, const Options& options,
                   const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    Record numbers = Record::array();
    for (const int number : written.tools) numbers.push_back(number);
    const bool none = diagnostics.has_errors() || options.target.empty();
    Record outputs = Record::array();
    for (const LibraryFile& file : written.files)
      if (!none) outputs.push_back(file.name);
    console.print_json(
        text_of(Record{{"tools", numbers}, {"outputs", outputs}, {"diagnostics", record_of(diagnostics)}},
                Layout::indented));
  } else if (!diagnostics.has_errors() && !options.target.empty()) {
    const std::size_t count = written.tools.size();
    console.summary(fmt::format("{}: {} tool{}", options.target, count, count == 1 ? "" : "s"));
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

Status write(Console& console, const ToolTable& table, const LibraryForm& form, const Options& options,
             Diagnostics& diagnostics) {
  WrittenLibrary library;
  if (!diagnostics.has_errors())
    library = write_tool_library(table, form, options.target, unit_mm(options), diagnostics);
  if (!diagnostics.has_errors()) {
    OutputSet outputs(options.files);
    bool written = true;
    const bool printed = options.target.empty() && !console.json();
    if (printed && form.kind == ToolLibraryKind::kerf)
      console.print_output(library.files[0].bytes);
    else if (printed)
      console.print_json(library.files[0].bytes);  // unchanged
    for (const LibraryFile& file : library.files)
      written = written && !options.target.empty() && outputs.write(file.name, file.bytes, diagnostics);
    if (written) outputs.commit(diagnostics);
  }
  return show_result(console, library, options, diagnostics);
}

/// Checks the options before any file is read; false, with an error, if they are wrong.
bool check_usage(const Options& options, Diagnostics& usage) {
  for (const std::string& file : options.files)
    if (file == options.target)
      usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
  return !usage.has_errors();
}

void check_import_target(const Options& options, Diagnostics& usage) {
  if (!options.target.empty() && !ends_with(options.target, ".toml") && !ends_with(options.target, ".tbl"))
    usage
        .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
               "tools are written as .toml (Kerf's tool file) or .tbl (LinuxCNC's tool table)")
        .hint = "kerf tools export FILE --to FORM writes those of other programs";
}

/// A form of several files, or of bytes that no terminal shows, needs a name.
void check_export_target(const Options& options, const LibraryForm* form, Diagnostics& usage) {
  const bool files =
      form != nullptr && (form->kind == ToolLibraryKind::vectric || form->kind == ToolLibraryKind::freecad);
  if (files && options.target.empty())
    usage.error(codes::file_unwritable, CallLocation{"", 0, "-o"},
                fmt::format("a {} is not written to standard output; specify its name with -o", form->title));
}

/// Reads a tool file, or the library of another program.
void read_any(const InputFile& file, const std::string& name, ToolLibraryOptions& how, ToolTable& table,
              Diagnostics& diagnostics) {
  const auto kind = library_kind_of(file.bytes());
  how.read_bit = tool_bits_of(name);
  if (kind && *kind != ToolLibraryKind::kerf)
    read_tool_library(file.bytes(), name, how, table, diagnostics);
  else
    read_tool_file(file.bytes(), name, table, diagnostics);
}

bool same_tool(const Tool& a, const Tool& b) {
  const Silhouette &s = a.silhouette, &t = b.silhouette;
  return s.cutting == t.cutting && s.neck == t.neck && s.shank == t.shank && s.holder == t.holder &&
         a.teeth == b.teeth && a.plunges == b.plunges && a.names == b.names && a.description == b.description;
}

/// Adds the tools of one file. A tool whose number is taken by another one gets the next free number, with a
/// note.
void merge(const ToolTable& more, const std::string& name, ToolTable& table, Diagnostics& diagnostics) {
  for (const auto& [number, tool] : more.tools()) {
    const Tool* before = table.find(number);
    if (before != nullptr && same_tool(*before, tool)) continue;
    int free = number;
    while (table.find(free) != nullptr || (free != number && more.find(free) != nullptr)) ++free;
    if (free != number)
      diagnostics.note(codes::tool_library_number, TextLocation{name, 0, 0},
                       fmt::format("an earlier file has another tool {}; this one becomes {}", number, free));
    Tool kept = tool;
    kept.number = free;
    table.set(free, std::move(kept));
  }
}

Status run_import(Console& console, const Options& options) {
  Diagnostics diagnostics;
  check_import_target(options, diagnostics);
  if (!check_usage(options, diagnostics)) return fail(console, diagnostics, Status::wrong_usage);
  ToolTable table;
  ToolLibraryOptions how{unit_mm(options), static_cast<int>(options.first)};
  for (const std::string& name : options.files)
    if (const auto file = InputFile::open(name, diagnostics)) {
      how.read_bit = tool_bits_of(name);
      ToolTable own;
      read_tool_library(file->bytes(), name, how, own, diagnostics);
      merge(own, name, table, diagnostics);
    }
  return write(console, table, *form_of(options, diagnostics), options, diagnostics);
}

Status run_export(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const LibraryForm* form = form_of(options, diagnostics);
  check_export_target(options, form, diagnostics);
  if (!check_usage(options, diagnostics)) return fail(console, diagnostics, Status::wrong_usage);
  ToolTable table;
  ToolLibraryOptions how{unit_mm(options), static_cast<int>(options.first)};
  for (const std::string& name : options.files)
    if (const auto file = InputFile::open(name, diagnostics)) {
      ToolTable own;
      read_any(*file, name, how, own, diagnostics);
      merge(own, name, table, diagnostics);
    }
  return write(console, options.files.empty() ? built_in_tools() : table, *form, options, diagnostics);
}

void add_target(CommandParser& parser, Options& options, const char* meaning) {
  add_output(parser, options.target, options.output, meaning);
  parser.add_text("--unit", options.unit, "Unit of a tool.tbl: mm or inch")
      .one_of({"mm", "inch"})
      .value_name("UNIT");
}

const char* const kImportExamples = R"(  kerf tools import library.json -o tools.toml
  kerf tools import tool.tbl --unit inch -o tools.toml
  kerf simulate part.nc --tools tools.toml -o part.png

Reads LinuxCNC's tool.tbl, Carbide Create's CSV, Fusion's JSON and .tools, FreeCAD's .fctb and .fctl,
CAMotics' JSON, and Vectric's .vtdb.
The format is detected from the content. Tools of unsupported shapes are skipped with a warning.
)";
const char* const kExportExamples = R"(  kerf tools export -o tool.tbl --unit inch
  kerf tools export --tools tools.toml -o tool.tbl
  kerf tools export tools.toml --to fusion -o tools.json
  kerf tools export tools.toml --to freecad -o tools.fctl       tools-T1.fctb and so on beside it
  kerf tools export tools.vtdb --to carbide -o tools.csv        from one program to another

Importing what was written gives the same tools. One warning names what the form cannot hold; tools whose
cutting part it cannot hold are left out.
)";

}  // namespace

Command add_tools_import(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(tools, "import", "Convert the tool library of another program to a tool file",
                  kImportExamples, options->output);
  parser.add_texts("FILE", options->files, "Tool libraries").required().value_name("");
  add_target(parser, *options,
             "The file to write: .toml or .tbl (default: -, a tool file to standard output)");
  add_number(parser, "--first", options->first, 0, kHighestNumber, "N",
             "Number for the first tool without one (default 1)");
  return {parser, &options->output, [options](Console& console) { return run_import(console, *options); }};
}

Command add_tools_export(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(tools, "export", "Write the built-in tools or tool files in the format of other programs",
                  kExportExamples, options->output);
  parser
      .add_texts("FILE", options->files,
                 "Tool files, or libraries of other programs, instead of the built-in tools")
      .value_name("");
  add_repeated(parser, "--tools", options->more_files, "PATH", "The same, as an option");
  parser.add_text("--to", options->form, "The form to write (default: that of the ending of -o)")
      .one_of(form_names())
      .value_name("FORM");
  add_target(parser, *options,
             "The file to write: .toml .tbl .csv .json .tools .fctl .fctb .vtdb (default: -, a tool file to "
             "standard output)");
  return {parser, &options->output, [options](Console& console) {
            options->files.insert(options->files.end(), options->more_files.begin(),
                                  options->more_files.end());
            return run_export(console, *options);
          }};
}

}  // namespace kerf::app
